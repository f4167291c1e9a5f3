"""The sections of the page, each there only where its results are."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from rotorgear.export.solids import LIGHT, build_solids
from rotorgear.page.cells import Cell, Figure, Numbers, Section, Table, words
from rotorgear.page.contents import Contents, error_of
from rotorgear.page.curves import draw_errors, draw_unbalance
from rotorgear.page.figures import Painter, svg_of
from rotorgear.plots.campbell import campbell as draw_campbell
from rotorgear.plots.critical_map import critical_map as draw_map
from rotorgear.plots.mesh_cycle import mesh as draw_mesh
from rotorgear.plots.run_up import response as draw_response
from rotorgear.plots.static import static as draw_static

# Pictures of so many modes, those with the most energy in meshes and bending first in the table's order.
_PICTURES = 8
_PARTS = 3
_LARGEST = 12
_R = "results"


def sections(found: Contents, numbers: Numbers, studies: list[Any]) -> Iterator[Section]:
    """Yield the sections of a report in the order of the page."""
    made = found.results
    painter = None
    if "modal" in made:
        painter = Painter(build_solids(found.model, made["modal"].nodes, LIGHT), (9.6, 5.2))
    if "check" in made:
        yield _model(made, numbers, painter)
    if "static" in made:
        yield _static(made, numbers)
    if "modal" in made:
        yield _modes(made, numbers, painter)
    shown: dict[str, Callable[[dict[str, Any], Numbers], Section]] = {
        "campbell": _campbell,
        "critical": _critical,
        "standards": _standards,
        "response": _response,
    }
    for name, section in shown.items():
        if name in made:
            yield section(made, numbers)
    teeth = [name for name in made if name.startswith("mesh ")]
    if teeth:
        yield _teeth(made, numbers, teeth)
    casings = [name for name in made if name.startswith("casing ")]
    if casings:
        yield _casings(numbers, casings)
    if "rig" in made:
        yield _rig(made, numbers)
    yield _costs(found, numbers, studies)
    yield _left_out(found)


def _model(made: dict[str, Any], numbers: Numbers, painter: Painter | None) -> Section:
    section = Section("model", "The gearbox")
    if painter is not None:
        section.figures.append(
            Figure("The model, seen from an end; a casing is drawn transparent.", painter.image("The gearbox"))
        )
    top = (_R, "check")
    rows = [
        [
            numbers.word(*top, "shafts", k, "name"),
            numbers.cell(".6g", *top, "shafts", k, "speed_rpm"),
            numbers.cell(".5g", *top, "shafts", k, "speed_ratio"),
            numbers.cell(".1f", *top, "shafts", k, "length_m", factor=1e3),
            numbers.cell(".3f", *top, "shafts", k, "shaft_mass_kg"),
            numbers.cell(".3f", *top, "shafts", k, "body_mass_kg"),
        ]
        for k in range(len(made["check"].shafts))
    ]
    heads = ("shaft", "speed, rpm", "of the input", "length, mm", "mass, kg", "gears and disks, kg")
    section.tables.append(Table("Shafts", heads, rows))
    if made["check"].meshes:
        rows = [
            [
                numbers.word(*top, "meshes", k, "name"),
                Cell(f"{mesh.pinion} / {mesh.gear}"),
                numbers.cell(".5g", *top, "meshes", k, "ratio"),
                numbers.cell(".2f", *top, "meshes", k, "mesh_frequency_hz"),
                numbers.cell(".3f", *top, "meshes", k, "transverse_contact_ratio"),
                numbers.cell(".3f", *top, "meshes", k, "overlap_ratio"),
                numbers.cell(".4g", *top, "meshes", k, "stiffness_n_per_m", factor=1e-6),
            ]
            for k, mesh in enumerate(made["check"].meshes)
        ]
        mesh_heads = ("mesh", "gears", "ratio", "mesh frequency, Hz", "ε_α", "ε_β", "stiffness, N/µm")
        section.tables.append(Table("Meshes", mesh_heads, rows, left=2))
    if made["check"].torques:
        rows = [
            [
                numbers.word(*top, "torques", k, "name"),
                numbers.word(*top, "torques", k, "shaft"),
                numbers.cell(".2f", *top, "torques", k, "torque_n_m"),
                numbers.cell(".3f", *top, "torques", k, "power_w", factor=1e-3),
            ]
            for k in range(len(made["check"].torques))
        ]
        section.tables.append(Table("Torques about +z", ("torque", "shaft", "N m", "kW"), rows, left=2))
    return section


def _static(made: dict[str, Any], numbers: Numbers) -> Section:
    result = made["static"]
    section = Section("statics", "Statics")
    section.figures.append(Figure("Forces, load sharing and deflections.", svg_of(draw_static(result), "Statics")))
    top = (_R, "static")
    helices = [
        (mesh, helix, len(result.contacts_of(mesh)))
        for mesh in dict.fromkeys(result.contact_mesh)
        for helix in range(len(result.contacts_of(mesh)))
    ]
    rows = [
        [
            Cell(mesh),
            Cell("" if count == 1 else ("smaller z", "larger z")[helix]),
            numbers.cell(".1f", *top, "mesh_force_n", mesh, helix),
            numbers.cell(".1f", *top, "helix_share", mesh, helix, factor=100.0),
            numbers.cell(".2f", *top, "mesh_deflection_m", mesh, helix, factor=1e6),
        ]
        for mesh, helix, count in helices
    ]
    if rows:
        heads = ("mesh", "helix", "normal force, N", "share of the mesh, %", "deflection, µm")
        section.tables.append(Table("Forces between the teeth", heads, rows, left=2))
    if result.shares:
        rows = [
            [
                numbers.word(*top, "shares", k, "gear"),
                numbers.word(*top, "shares", k, "mesh"),
                numbers.cell(".3f", *top, "shares", k, "share", factor=100.0),
                numbers.cell(".4f", *top, "shares", k, "factor"),
                numbers.word(*top, "shares", k, "decided_by"),
            ]
            for k in range(len(result.shares))
        ]
        heads = ("gear", "mesh", "share, %", "times the mean", "decided by")
        section.tables.append(Table("Load sharing", heads, rows, left=2))
    if result.bearing_force:
        rows = [
            [Cell(name), *(numbers.cell(".1f", *top, "bearing_force_n", name, axis) for axis in range(3))]
            for name in result.bearing_force
        ]
        section.tables.append(Table("Bearings: force on the shaft, N", ("bearing", "x", "y", "z"), rows))
    return section


def _modes(made: dict[str, Any], numbers: Numbers, painter: Painter | None) -> Section:
    result = made["modal"]
    section = Section("modes", "Natural frequencies and modes")
    section.words.append(
        "Undamped, at standstill. Error: estimated relative error of the frequency by the finite elements."
    )
    top = (_R, "modal")
    rows = []
    for k in range(len(result)):
        shares = sorted(((part, share[k]) for part, share in result.strain_energy.items()), key=lambda row: -row[1])
        held = ", ".join(f"{part} {100.0 * share:.0f} %" for part, share in shares[:_PARTS] if share > 0.005)
        rows.append(
            [
                Cell(str(k + 1)),
                numbers.cell(".3f", *top, "frequency_hz", k),
                numbers.cell(".0e", *top, "error_estimate", k),
                numbers.word(*top, "description", k),
                Cell(held),
            ]
        )
    section.tables.append(
        Table(
            "Modes, with the parts that hold most of the strain energy",
            ("mode", "Hz", "error", "what moves", "strain energy"),
            rows,
        )
    )
    if painter is not None:
        small = Painter(painter.solids, (4.6, 2.9))
        elastic = [k for k in range(len(result)) if not result.rigid[k]][:_PICTURES]
        for k in elastic:
            label = f"Mode {k + 1}: {result.frequency_hz[k]:.2f} Hz"
            words_of = f"{label}, {result.description[k]}"
            section.figures.append(Figure(words_of, small.mode(label, np.real(result.shapes[:, :, k])), small=True))
    return section


def _campbell(made: dict[str, Any], numbers: Numbers) -> Section:
    result = made["campbell"]
    section = Section("campbell", "Campbell diagram and margins")
    section.figures.append(
        Figure(
            "Natural frequencies over speed, and lines of excitation.",
            svg_of(draw_campbell(result), "Campbell diagram"),
        )
    )
    top = (_R, "campbell", "margins")
    rows = [
        [
            numbers.word(*top, k, "line"),
            numbers.cell(".2f", *top, k, "frequency_hz"),
            numbers.cell(".2f", *top, k, "mode_hz"),
            numbers.cell("+.2f", *top, k, "margin", factor=100.0),
            numbers.word(*top, k, "whirl"),
            numbers.cell(".1f", *top, k, "crossing_speed_rpm"),
        ]
        for k in range(len(result.margins))
    ]
    heads = ("line at the operating speed", "Hz", "nearest mode, Hz", "margin, %", "whirl", "meets at, rpm")
    section.tables.append(Table("Margins of modes that the line can excite", heads, rows))
    if result.onsets:
        rows = [
            [
                numbers.cell("d", _R, "campbell", "onsets", k, "branch"),
                numbers.cell(".1f", _R, "campbell", "onsets", k, "speed_rpm"),
                numbers.cell(".3f", _R, "campbell", "onsets", k, "frequency_hz"),
            ]
            for k in range(len(result.onsets))
        ]
        section.tables.append(Table("Onset of instability", ("branch", "from, rpm", "Hz"), rows))
    else:
        section.words.append("Stability: no branch grows in this range of speeds.")
    return section


def _critical(made: dict[str, Any], numbers: Numbers) -> Section:
    result = made["critical"]
    section = Section("critical", "Critical speeds")
    if "critical_map" in made and np.isfinite(made["critical_map"].critical_speeds).any():
        caption = (
            "Undamped critical speeds over one stiffness of all bearings; vertical lines: the bearings of the model."
        )
        section.figures.append(Figure(caption, svg_of(draw_map(made["critical_map"]), "Critical speed map")))
    top = (_R, "critical")
    rows = [
        [
            numbers.word(*top, "line", k),
            numbers.cell(".2f", *top, "critical_speed_rpm", k),
            numbers.cell(".3f", *top, "frequency_hz", k),
            numbers.cell(".4f", *top, "damping_ratio", k),
            numbers.word(*top, "whirl", k),
            Cell("yes" if result.speeds[k].excited else "no"),
            numbers.cell(".0e", *top, "error_estimate", k),
            numbers.word(*top, "description", k),
        ]
        for k in range(len(result))
    ]
    heads = ("line", "rpm of the input", "Hz", "damping ratio", "whirl", "excited", "error", "what moves")
    if rows:
        section.tables.append(Table("Speeds at which 1x of a shaft meets a mode", heads, rows))
    else:
        section.words.append("No line meets a mode in the range of speeds.")
    return section


def _standards(made: dict[str, Any], numbers: Numbers) -> Section:
    result = made["standards"]
    section = Section("standards", "Unbalance response and rules of standards")
    section.words.append(
        "Each verdict speaks of the one rule beside it. None says that the machine meets a standard: that takes more than these."
    )
    if result.curves:
        caption = (
            "Response to the rules' unbalance in the shape of each shaft's first peak; dashed: the operating speed."
        )
        section.figures.append(Figure(caption, svg_of(draw_unbalance(result), "Unbalance response")))
    top = (_R, "standards")
    rows = [
        [
            numbers.word(*top, "criticals", k, "shaft"),
            numbers.cell(".1f", *top, "criticals", k, "shaft_rpm"),
            numbers.cell(".1f", *top, "criticals", k, "below_rpm"),
            numbers.cell(".1f", *top, "criticals", k, "above_rpm"),
            numbers.cell(".5g", *top, "criticals", k, "amplification_factor"),
            numbers.cell(".2f", *top, "criticals", k, "margin_percent"),
            numbers.cell(".2f", *top, "criticals", k, "required_percent"),
            numbers.word(*top, "criticals", k, "description"),
        ]
        for k in range(len(result.criticals))
    ]
    if rows:
        heads = ("shaft", "peak, rpm", "N₁, rpm", "N₂, rpm", "AF", "separation, %", "asked for, %", "what moves")
        section.tables.append(Table("Peaks of the unbalance response, speeds of the shaft", heads, rows))
    rows = [
        [
            numbers.word(*top, "checks", k, "rule"),
            numbers.word(*top, "checks", k, "part"),
            numbers.cell(".4g", *top, "checks", k, "value"),
            numbers.cell(".4g", *top, "checks", k, "limit"),
            numbers.word(*top, "checks", k, "unit"),
            numbers.word(*top, "checks", k, "verdict"),
            numbers.word(*top, "checks", k, "note"),
        ]
        for k in range(len(result.checks))
    ]
    rule_heads = ("rule", "part", "value", "limit", "unit", "verdict", "about")
    section.tables.append(Table("Rules", rule_heads, rows, left=2, verdict=5))
    rows = [words(rule.name, rule.source, rule.formula) for rule in result.rules]
    section.tables.append(Table("What the rules say", ("rule", "standard", "formula"), rows, left=3))
    return section


def _response(made: dict[str, Any], numbers: Numbers) -> Section:
    result = made["response"]
    section = Section("run-up", "Run-up")
    section.words.append(
        "Linear response to the unbalances, transmission errors and stiffness variation that the model has."
    )
    if not result.damping_ratio and not np.any(result.model.damping.model_dump(exclude_defaults=True)):
        section.words.append(
            "No damping is given to the model as a whole: heights near resonances are those of the nearest speed."
        )
    section.figures.append(Figure("Amplitudes over speed.", svg_of(draw_response(result), "Run-up")))
    top = (_R, "response", "largest")
    rows = [
        [
            numbers.word(*top, k, "quantity"),
            numbers.word(*top, k, "part"),
            Cell(result.orders[peak.order]),
            numbers.cell(".1f", *top, k, "speed_rpm"),
            numbers.cell(".2f", *top, k, "frequency_hz"),
            numbers.cell(".4g", *top, k, "amplitude"),
            numbers.word(*top, k, "unit"),
        ]
        for k, peak in enumerate(result.largest[:_LARGEST])
    ]
    heads = ("quantity", "part", "order", "rpm of the input", "Hz", "amplitude", "unit")
    section.tables.append(Table("Largest amplitudes at the speeds that were computed", heads, rows, left=3))
    return section


def _teeth(made: dict[str, Any], numbers: Numbers, names: list[str]) -> Section:
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
                numbers.cell(".5g", _R, name, "mean_stiffness_n_per_m", factor=1e-6),
                numbers.cell(".4g", _R, name, "peak_to_peak_stiffness_n_per_m", factor=1e-6),
                numbers.cell(".4g", _R, name, "ste_peak_to_peak_m", factor=1e6),
                numbers.cell(".4g", _R, name, "helix", 0, "largest_pressure_pa", factor=1e-6),
                numbers.cell(".3f", _R, name, "helix", 0, "contact_ratio"),
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


def _casings(numbers: Numbers, names: list[str]) -> Section:
    section = Section("casings", "Casings")
    rows = []
    for name in names:
        casing = name.partition(" ")[2]
        top = (_R, name, "casings", casing)
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


def _rig(made: dict[str, Any], numbers: Numbers) -> Section:
    result = made["rig"]
    section = Section("rig", "Comparison with the rig")
    top = (_R, "rig", "matches")
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


def _costs(found: Contents, numbers: Numbers, studies: list[Any]) -> Section:
    section = Section("errors", "Error against run time")
    section.words.append(
        "The largest estimated relative error of each section's numbers beside the CPU seconds that they took on one thread. "
        "Where nothing is discretised, or no estimate is known, there is a dash."
    )
    rows = []
    for name, result in found.results.items():
        known = error_of(result)
        rows.append(
            [
                Cell(name),
                numbers.cell(".2f", "cpu_seconds", name),
                numbers.cell(".1e", "largest_error_estimate", name) if known is not None else Cell("–"),
                numbers.cell("d", _R, name, "dofs") if getattr(result, "dofs", None) else Cell("–"),
                Cell(result.method),
            ]
        )
    rows.append([Cell("all"), numbers.cell(".2f", "cpu_seconds_of_all"), Cell(""), Cell(""), Cell("")])
    section.tables.append(Table("Cost and error", ("analysis", "CPU s", "largest error", "dofs", "method"), rows))
    section.figures.append(
        Figure(
            "Estimated error against CPU seconds, an analysis a point.",
            svg_of(draw_errors(found), "Error against run time"),
        )
    )
    for k, study in enumerate(studies):
        picture = svg_of(study.plot(), f"study {k + 1}")
        section.figures.append(Figure(f"Stored convergence study: {getattr(study, 'title', study.kind)}.", picture))
    if not studies:
        section.words.append(
            "Convergence studies over meshes are not run for a page: give stored ones (rotorgear accuracy --save, --study)."
        )
    return section


def _left_out(found: Contents) -> Section:
    section = Section("left-out", "What was left out, and why")
    rows = [words(name, reason) for name, reason in found.missing.items()]
    if rows:
        section.tables.append(Table("Sections that are not there", ("section", "reason"), rows, left=2))
    notes: dict[str, list[str]] = {}
    for name, result in found.results.items():
        for note in result.left_out:
            notes.setdefault(note, []).append(name)
    if notes:
        rows = [words(", ".join(names), note) for note, names in notes.items()]
        section.tables.append(Table("Left out of the analyses", ("analysis", "what"), rows, left=2))
    warned: dict[str, list[str]] = {}
    for name, result in found.results.items():
        for note in result.warnings:
            warned.setdefault(note, []).append(name)
    if warned:
        rows = [words(", ".join(names), note) for note, names in warned.items()]
        section.tables.append(Table("Warnings", ("analysis", "warning"), rows, left=2))
    return section
