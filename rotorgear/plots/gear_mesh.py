"""Draws two gears in mesh in the transverse plane: both outlines, pitch and base circles, line of action, contact points.

The pinion drives counter-clockwise with its axis at the origin, the gear's axis is right of it, that of a ring left; a tooth
pair touches at the pitch point.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.outline import tooth_outline
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.plots.figure import BLUE, ORANGE, figure_for, name_axes
from rotorgear.results.gear_sheet import GearSheet

_POINTS = 40
# A ring is drawn with so much rim, in normal modules.
_RIM = 1.5


def gear_contour(teeth: ToothPair, gear: int) -> np.ndarray:
    """Closed contour (n, 2) in m of gear 1 or 2, the pinion's axis at the origin, the gear's at (a_w, 0), of a ring a_w < 0."""
    g = teeth.first if gear == 1 else teeth.second
    outline = tooth_outline(g)
    radii, angles = outline.tooth(_POINTS)
    half = float(outline.involute(g.base_radius * math.tan(teeth.pair.working_transverse_pressure_angle))[1])
    # The flanks that touch are the pinion's upper one and the gear's lower one; a ring is on the pinion's side of the gap.
    middle = -half if gear == 1 else half if g.is_internal else math.pi - half
    count = abs(g.teeth)
    turned = middle + angles[:-1] + 2.0 * math.pi / count * np.arange(count)[:, None]
    radius = np.broadcast_to(radii[:-1], turned.shape)
    xy = np.stack([radius * np.cos(turned), radius * np.sin(turned)], axis=-1).reshape(-1, 2)
    xy = np.vstack([xy, xy[:1]])
    return xy if gear == 1 else xy + np.array([teeth.pair.centre_distance, 0.0])


def _filled(contour: np.ndarray, centre: tuple[float, float], g: GearGeometry) -> np.ndarray:
    """What of a gear is solid: inside its contour, of a ring between the contour and a circle around its roots."""
    if not g.is_internal:
        return contour
    turn = np.linspace(2.0 * math.pi, 0.0, len(contour))
    around = 0.5e3 * abs(g.root_diameter) + _RIM * 1e3 * g.normal_module
    circle = np.column_stack([centre[0] + around * np.cos(turn), centre[1] + around * np.sin(turn)])
    return np.vstack([contour, circle, contour[:1]])


def contact_points(teeth: ToothPair) -> np.ndarray:
    """Where tooth pairs touch in the middle of the face while one touches at the pitch point, shape (k, 2) in m."""
    pair = teeth.pair
    step = teeth.first.transverse_base_pitch
    first = math.ceil(pair.start_of_contact / step - 1e-12)
    last = math.floor(pair.end_of_contact / step + 1e-12)
    return np.array([on_line_of_action(teeth, k * step) for k in range(first, last + 1)])


def on_line_of_action(teeth: ToothPair, position: float) -> tuple[float, float]:
    """Point (m) on the line of action at a position from the pitch point, positive towards recess."""
    angle = teeth.pair.working_transverse_pressure_angle
    pitch = teeth.first.base_radius / math.cos(angle)
    return pitch + position * math.sin(angle), position * math.cos(angle)


def gear(result: GearSheet, fig: Any = None, *, mesh: str | None = None) -> np.ndarray:
    """Draw the teeth of a mesh in the transverse plane: both gears whole, and what happens near the pitch point.

    Args:
        result: a gear sheet.
        fig: figure to draw on; a new one for None.
        mesh: name of the mesh; the first one for None.

    Returns:
        Both axes.

    Raises:
        AnalysisError: no such mesh. MissingExtraError: matplotlib is not installed.
    """
    name = mesh or next(iter(result.pairs), None)
    if name not in result.pairs:
        raise AnalysisError("There is no mesh between gears with teeth to draw.")
    row = next(row for row in result.meshes if row.name == name)
    figure = figure_for(fig, (11.0, 5.6), "")
    whole, near = figure.subplots(1, 2, width_ratios=[1.0, 1.25])
    teeth = result.pairs[name]
    # Both gears with their circles and the path of contact, in mm.
    angle = teeth.pair.working_transverse_pressure_angle
    turn = np.linspace(0.0, 2.0 * math.pi, 721)
    centres = ((0.0, 0.0), (1e3 * teeth.pair.centre_distance, 0.0))
    for axis in (whole, near):
        gears = ((1, row.pinion, teeth.first, BLUE), (2, row.gear, teeth.second, ORANGE))
        for (number, gear_name, g, colour), centre in zip(gears, centres, strict=True):
            xy = 1e3 * gear_contour(teeth, number)
            axis.fill(*_filled(xy, centre, g).T, facecolor=colour, alpha=0.16)
            axis.plot(*xy.T, color=colour, lw=1.2, label=gear_name)
            circles = {
                "working pitch circles": abs(g.base_radius) / math.cos(angle),
                "base circles": abs(g.base_radius),
            }
            for (circle, radius), style in zip(circles.items(), ("-.", ":"), strict=True):
                x = 1e3 * radius * np.cos(turn) + centre[0]
                y = 1e3 * radius * np.sin(turn)
                axis.plot(x, y, style, color="#555555", lw=0.8, label=circle if number == 1 else None)
            axis.plot(*centre, "+", color=colour, ms=8)
        tangents = [-teeth.first.base_radius * math.tan(angle), teeth.second.base_radius * math.tan(angle)]
        ends = 1e3 * np.array([on_line_of_action(teeth, x) for x in tangents])
        axis.plot(*ends.T, "--", color="#333333", lw=0.9, label="line of action")
        contact = (teeth.pair.start_of_contact, teeth.pair.end_of_contact)
        path = 1e3 * np.array([on_line_of_action(teeth, x) for x in contact])
        axis.plot(*path.T, color="#111111", lw=2.4, label="path of contact")
        axis.plot(*(1e3 * contact_points(teeth)).T, "o", color="#c00000", ms=4.5, label="contact points")
        axis.set_aspect("equal")
        axis.tick_params(labelsize=8)
        name_axes(axis, "x, mm", "y, mm")
    # A few teeth around the pitch point.
    pitch = 1e3 * on_line_of_action(teeth, 0.0)[0]
    reach = 5.0e3 * teeth.first.transverse_module
    near.set_xlim(pitch - 1.25 * reach, pitch + 1.25 * reach)
    near.set_ylim(-reach, reach)
    name_axes(whole, title=f"{name}: centre distance {1e3 * row.centre_distance_m:.3f} mm")
    ratios = f"eps_alpha {row.transverse_contact_ratio:.3f}, eps_beta {row.overlap_ratio:.3f}"
    name_axes(near, title=f"working pressure angle {row.working_pressure_angle_deg:.3f} deg, {ratios}")
    handles = dict(zip(*near.get_legend_handles_labels()[::-1], strict=True))
    first = {row.pinion: handles[row.pinion], row.gear: handles[row.gear]} | handles
    figure.legend(first.values(), first.keys(), loc="outside lower center", ncols=7, frameon=False, fontsize=8)
    return np.array([whole, near])
