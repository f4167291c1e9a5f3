"""Sections of the page on the machine at rest: its parts, its statics, its modes."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.page.cells import RESULTS, Cell, Figure, Numbers, Section, Table
from rotorgear.page.figures import Painter, svg_of
from rotorgear.plots.static import static as draw_static

# Pictures of so many elastic modes, the first of the table, and so many parts named beside each.
_PICTURES = 8
_PARTS = 3


def model_section(made: dict[str, Any], numbers: Numbers, painter: Painter | None) -> Section:
    """Shafts, meshes and torques, with a picture of the whole."""
    section = Section("model", "The gearbox")
    if painter is not None:
        section.figures.append(
            Figure("The model, seen from an end; a casing is drawn transparent.", painter.image("The gearbox"))
        )
    top = (RESULTS, "check")
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


def static_section(made: dict[str, Any], numbers: Numbers) -> Section:
    """Forces between the teeth, load sharing and bearings."""
    result = made["static"]
    section = Section("statics", "Statics")
    section.figures.append(Figure("Forces, load sharing and deflections.", svg_of(draw_static(result), "Statics")))
    top = (RESULTS, "static")
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


def modes_section(made: dict[str, Any], numbers: Numbers, painter: Painter | None) -> Section:
    """Natural frequencies, what holds their energy, and pictures of the first elastic modes."""
    result = made["modal"]
    section = Section("modes", "Natural frequencies and modes")
    section.words.append(
        "Undamped, at standstill. Error: estimated relative error of the frequency by the finite elements."
    )
    top = (RESULTS, "modal")
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
