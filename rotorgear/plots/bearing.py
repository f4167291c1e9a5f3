"""Draws the sheet of a bearing: pressure of its film or loads of its rolling elements, stiffness and damping over speed."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.plots.figure import COLOURS, figure_for, label, name_axes, plain_axis, values
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.bearing import BearingSheet, BearingSpeed, RollingElementRow


def bearing(result: BearingSheet, fig: Any = None) -> np.ndarray:
    """Draw what carries inside the bearing, and its stiffness and damping across the shaft over speed.

    Args:
        result: sheet of one bearing.
        fig: figure to draw on; a new one for None.

    Returns:
        The axes: inside, beside it (gap of a film, pressures of rolling elements), stiffness and damping over speed.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    figure = figure_for(fig, (10.0, 7.2), f"{result.bearing}: {result.law} at {result.speed * RPM_PER_RAD_S:.6g} rpm")
    inside, beside, stiffness, damping = figure.subplots(2, 2).ravel()
    if result.oil is not None:
        # Pressure over angle and place, and the gap over the angle.
        film = result.oil
        largest = 1e-6 * film.largest_pressure
        # Several patches have the colours of one scale.
        field = {"shading": "gouraud", "vmin": 0.0, "vmax": largest or 1.0} if film.smooth else {"shading": "nearest"}
        line = {"lw": 1.4} if film.smooth else {"ls": "", "marker": ".", "ms": 2}
        picture = None
        for angle, place, gap, pressures in film.patches():
            picture = inside.pcolormesh(angle, 1e3 * place, 1e-6 * pressures.T, cmap="viridis", **field)
            beside.plot(angle, 1e6 * gap, color=COLOURS[0], **line)
        figure.colorbar(picture, ax=inside, label=label(film, "pressure", "MPa"))
        name_axes(inside, "", label(film, film.place, "mm"), title=f"Pressure, at most {largest:.3g} MPa")
        beside.set_ylim(bottom=0.0)
        name_axes(beside, "", label(film, "gap", "um"), title=film.over_gap.format(film))
    else:
        angle = np.degrees([row.angle for row in result.rolling_elements])
        loads = [row.load for row in result.rolling_elements]
        inside.bar(angle, loads, width=0.5 * 360.0 / max(len(angle), 1), color=COLOURS[0])
        name_axes(inside, "", label(RollingElementRow, "load"), title="Loads of the rolling elements")
        for ring, colour in zip(("inner", "outer"), COLOURS, strict=False):
            pressure = [values(row, f"{ring}_pressure", "MPa") for row in result.rolling_elements]
            beside.plot(angle, pressure, "o", color=colour, label=f"{ring} ring")
        name_axes(beside, "", "largest Hertz pressure, MPa", legend=1)
    for axis in (inside, beside):
        axis.set_xlabel("angle from +x, deg")
    rpm = [row.speed * RPM_PER_RAD_S for row in result.over_speed]
    own = (2,) if result.along_shaft else range(min(2, len(result.components)))
    pairs = [(i, j) for i in own for j in own]
    for axis, key, factor, unit in ((stiffness, "stiffness", 1e-6, "N/um"), (damping, "damping", 1e-3, "kN s/m")):
        for (i, j), colour in zip(pairs, COLOURS, strict=False):
            entries = [factor * float(getattr(row, key)[i, j]) for row in result.over_speed]
            axis.plot(rpm, entries, "o-", ms=3, lw=1.4, color=colour, label=result.components[i] + result.components[j])
        name_axes(axis, label(BearingSpeed, "speed"), label(BearingSpeed, key, unit), legend=2)
        if result.threshold_speed is not None:
            axis.axvline(result.threshold_speed * RPM_PER_RAD_S, color="#999999", lw=0.8, ls=":")
    threshold = " (dotted: whirl threshold)" if result.threshold_speed is not None else ""
    name_axes(stiffness, title=f"Stiffness{threshold}")
    name_axes(damping, title="Damping")
    axes = np.array([inside, beside, stiffness, damping])
    for axis in axes[1:]:
        plain_axis(axis)
    return axes
