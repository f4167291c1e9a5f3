"""Sections of the page on single parts, teeth and casings, and on the rig beside the model."""

from __future__ import annotations

from typing import Any

from rotorgear.page.cells import RESULTS, Cell, Figure, Numbers, Section, Table
from rotorgear.page.figures import svg_of
from rotorgear.plots.mesh import mesh as draw_mesh


def teeth_section(made: dict[str, Any], numbers: Numbers, names: list[str]) -> Section:
    """Stiffness, transmission error and pressure of each mesh `names` over its cycle."""
    section = Section("teeth", "Teeth in contact")
    rows = []
    for name in names:
        result = made[name]
        label = name.partition(" ")[2]
        caption = f"{label}: stiffness k(t), transmission error, load sharing and pressure over the mesh cycle."
        section.figures.append(Figure(caption, svg_of(draw_mesh(result), name)))
        rows.append(
            [
                Cell(label),
                numbers.cell(".5g", RESULTS, name, "mean_stiffness_n_per_m", factor=1e-6),
                numbers.cell(".4g", RESULTS, name, "peak_to_peak_stiffness_n_per_m", factor=1e-6),
                numbers.cell(".4g", RESULTS, name, "ste_peak_to_peak_m", factor=1e6),
                numbers.cell(".4g", RESULTS, name, "helix", 0, "largest_pressure_pa", factor=1e-6),
                numbers.cell(".3f", RESULTS, name, "helix", 0, "contact_ratio"),
            ]
        )
    heads = (
        "mesh",
        "mean stiffness, N/µm",
        "peak to peak, N/µm",
        "STE peak to peak, µm",
        "pressure, MPa",
        "pairs in contact",
    )
    section.tables.append(Table("Loaded teeth at the mean load, transverse stiffness", heads, rows))
    return section


def casings_section(numbers: Numbers, names: list[str]) -> Section:
    """Meshes of the casings `names` and what their reduction left."""
    section = Section("casings", "Casings")
    rows = []
    for name in names:
        casing = name.partition(" ")[2]
        top = (RESULTS, name, "casings", casing)
        rows.append(
            [
                Cell(casing),
                numbers.word(*top, "element"),
                numbers.cell("d", *top, "dofs"),
                numbers.cell(".3f", *top, "mass_kg"),
                numbers.cell(".2f", *top, "free_frequency_hz", 0),
                numbers.cell(".1e", *top, "free_mesh_error", 0),
                numbers.cell("d", *top, "coordinates"),
                numbers.cell(".1e", *top, "reduction_error", 0),
            ]
        )
    heads = (
        "casing",
        "element",
        "dofs",
        "mass, kg",
        "first free mode, Hz",
        "its mesh error",
        "coordinates kept",
        "reduction error",
    )
    section.tables.append(Table("Meshes of the casings and their reduction", heads, rows, left=2))
    return section


def rig_section(made: dict[str, Any], numbers: Numbers) -> Section:
    """Lines of the rig beside modes, and what chance would have matched."""
    result = made["rig"]
    section = Section("rig", "Comparison with the rig")
    top = (RESULTS, "rig", "matches")
    rows = [
        [
            numbers.cell(".2f", *top, k, "rig", "frequency_hz"),
            Cell(match.rig.label or ""),
            numbers.cell("d", *top, k, "mode_number"),
            numbers.cell(".2f", *top, k, "mode_frequency_hz"),
            numbers.cell("+.2f", *top, k, "error_percent"),
            numbers.word(*top, k, "mode_description"),
        ]
        for k, match in enumerate(result.matches)
    ]
    heads = ("rig, Hz", "label", "mode", "model, Hz", "error, %", "what moves")
    if rows:
        section.tables.append(Table("Lines of the rig and their modes", heads, rows, left=0))
    lines = result.text().splitlines()
    start = next((k for k, line in enumerate(lines) if line.startswith("Chance")), len(lines))
    paragraphs = "\n".join(lines[start:]).split("\n\n")
    section.words += [" ".join(paragraph.split()) for paragraph in paragraphs if paragraph.strip()]
    return section
