"""Draws a static result: how branches and helices share the load, bearing forces, and the deflection of every shaft."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.plots.figure import COLOURS, figure_for, label, name_axes, plain_axis, values
from rotorgear.results.static import MeshFace, StaticResult

# Meshes beyond which their names stand upright.
_UPRIGHT = 5


def static(result: StaticResult, fig: Any = None) -> np.ndarray:
    """Draw how branches and helices share the load, the forces of bearings, loads along faces, and the deflection of every shaft.

    Args:
        result: a static result.
        fig: figure to draw on; a new one for None.

    Returns:
        All axes, those of meshes and bearings first.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    shafts = [name for name in result.model.shafts if result.nodes.on_shaft(name).size > 1]
    upper = bool(result.contact_mesh) or bool(result.bearing_force)
    figure = figure_for(fig, (10.0, (3.6 if upper else 0.0) + 1.9 * max(len(shafts), 1)), result.model.title)
    top, bottom = figure.subfigures(2, 1, height_ratios=[3.4, 1.8 * max(len(shafts), 1)]) if upper else (None, figure)
    axes = []
    if top is not None:
        faces = [row for row in result.faces if row.fed_back]
        forces, bearings, *along = top.subplots(1, 3 if faces else 2, width_ratios=[1.0, 1.1, 1.1][: 3 if faces else 2])
        meshes = list(dict.fromkeys(result.contact_mesh))
        helices = max((int(h) for h in result.contact_helix), default=0) + 1
        for helix in range(helices):
            at = [k for k in range(len(result.contact_mesh)) if result.contact_helix[k] == helix]
            x = [meshes.index(result.contact_mesh[k]) + (helix - 0.5 * (helices - 1)) * 0.38 for k in at]
            side = ("helix at smaller z", "helix at larger z")[helix] if helices == 2 else None
            force = values(result, "mesh_force", "kN")[at]
            bars = forces.bar(x, force, width=0.36, color=COLOURS[helix], label=side)
            forces.bar_label(bars, fmt="%.1f", fontsize=8, padding=1)
        shares = {row.mesh: row.share for row in result.shares}
        names = [f"{mesh}\n{100.0 * shares[mesh]:.1f} %" if mesh in shares else mesh for mesh in meshes]
        many = len(meshes) > _UPRIGHT
        forces.set_xticks(range(len(meshes)), names, fontsize=9, rotation=90 if many else 0)
        title = "Meshes, with the share of each branch" if shares else "Meshes"
        name_axes(forces, "", label(result, "mesh_force", "kN"), title=title, legend=int(helices == 2))
        forces.margins(y=0.15)
        plain_axis(forces)
        radial = [float(np.hypot(*force[:2])) / 1e3 for force in result.bearing_force.values()]
        axial = [abs(float(force[2])) / 1e3 for force in result.bearing_force.values()]
        y = np.arange(len(result.bearing_force))
        bearings.barh(y - 0.19, radial, height=0.36, color=COLOURS[0], label="radial")
        bearings.barh(y + 0.19, axial, height=0.36, color=COLOURS[1], label="axial")
        bearings.set_yticks(y, list(result.bearing_force), fontsize=9)
        bearings.invert_yaxis()
        name_axes(bearings, "force, kN", title="Bearings", legend=int(bool(result.bearing_force)))
        plain_axis(bearings)
        axes += [forces, bearings, *along]
        for axis in along:
            _along_faces(axis, faces)
    axes += _deflections(bottom, result, shafts)
    if not axes:
        axes = [figure.subplots()]
        axes[0].set_axis_off()
        axes[0].text(0.5, 0.5, "no meshes, no bearings, and no shaft with a length", ha="center")
    return np.array(axes)


def _along_faces(axis: Any, faces: list[MeshFace]) -> None:
    """Load per width over the face of each helix, and where its resultant stands."""
    for number, row in enumerate(faces):
        colour = COLOURS[number % len(COLOURS)]
        side = f" {'LR'[row.helix]}" if [other.mesh for other in faces].count(row.mesh) == 2 else ""
        name = f"{row.mesh}{side}, $K_{{H\\beta}}$ {row.face_load_factor:.2f}"
        load = values(row, "line_load_n_per_m", "N/mm")
        axis.plot(values(row, "z_m", "mm"), load, color=colour, lw=1.6, label=name)
        if row.load_place_m is not None:
            axis.axvline(1e3 * row.load_place_m, color=colour, lw=0.8, ls=":")
    axis.set_ylim(bottom=0.0)
    title = "Along the face (dotted: resultant)"
    up = label(MeshFace, "line_load_n_per_m", "N/mm")
    name_axes(axis, label(MeshFace, "z_m", "mm"), up, title=title, legend=1)
    plain_axis(axis)


def _deflections(figure: Any, result: StaticResult, shafts: list[str]) -> list[Any]:
    if not shafts:
        return []
    axes = np.atleast_1d(figure.subplots(len(shafts), 1, sharex=True))
    for axis, name in zip(axes, shafts, strict=True):
        nodes = result.nodes.on_shaft(name)
        z = 1e3 * result.nodes.along[nodes]
        for dof, direction in enumerate("xy"):
            axis.plot(z, 1e6 * result.displacement[nodes, dof], color=COLOURS[dof], label=direction, lw=1.6)
        layout = result.model.layout
        parts_on_shafts = [(gear.shaft, gear.z, "#999999") for gear in layout.gears]
        parts_on_shafts += [(*layout.place(f"bearings.{bearing}"), "#009E73") for bearing in result.model.bearings]
        for shaft, at, colour in parts_on_shafts:
            if shaft == name:
                axis.axvline(1e3 * at, color=colour, lw=0.8, ls=":")
        axis.set_ylabel(f"{name}\num", fontsize=9)
        plain_axis(axis)
    axes[0].legend(frameon=False, fontsize=8, ncols=2, loc="best")
    axes[0].set_title("Deflection of the shafts (dotted: gears grey, bearings green)", fontsize=10)
    axes[-1].set_xlabel("z, mm")
    return list(axes)
