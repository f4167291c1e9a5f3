"""Draws the sheet of a bearing: pressure of its film or loads of its rolling elements, stiffness and damping over speed."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.plots.colours import COLOURS
from rotorgear.plots.figure import figure_for
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.parts.bearing import BearingSheet, FilmState, ThrustState

# Steps of the grid: a leap from one pad to the next.
_APART = 1.5


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
    if result.thrust_film is not None:
        _sectors(figure, inside, beside, result.thrust_film)
    elif result.film is not None:
        _pressure(figure, inside, result.film)
        order = np.argsort(np.degrees(result.film.angle) % 360.0)
        angle = (np.degrees(result.film.angle) % 360.0)[order]
        beside.plot(angle, 1e6 * result.film.gap[order], ".", ms=2, color=COLOURS[0])
        beside.set_ylim(bottom=0.0)
        beside.set_ylabel("gap, um")
        beside.set_xlabel("angle from +x, deg")
        beside.set_title(f"Film: eccentricity {result.film.eccentricity:.3f} of the clearance", fontsize=10)
    else:
        angle = np.degrees([row.angle for row in result.rolling_elements])
        inside.bar(
            angle,
            [row.load for row in result.rolling_elements],
            width=0.5 * 360.0 / max(len(angle), 1),
            color=COLOURS[0],
        )
        inside.set_ylabel("load, N")
        inside.set_title("Loads of the rolling elements", fontsize=10)
        for number, (key, label) in enumerate((("inner_pressure", "inner ring"), ("outer_pressure", "outer ring"))):
            pressure = [1e-6 * getattr(row, key) for row in result.rolling_elements]
            beside.plot(angle, pressure, "o", color=COLOURS[number], label=label)
        beside.set_ylabel("largest Hertz pressure, MPa")
        beside.legend(frameon=False, fontsize=8)
        for axis in (inside, beside):
            axis.set_xlabel("angle from +x, deg")
    rpm = [row.speed * RPM_PER_RAD_S for row in result.over_speed]
    pairs = ((2, 2),) if result.thrust_film is not None else ((0, 0), (0, 1), (1, 0), (1, 1))
    for axis, key, factor, label in (
        (stiffness, "stiffness", 1e-6, "K, N/um"),
        (damping, "damping", 1e-3, "C, kN s/m"),
    ):
        for number, (i, j) in enumerate(pairs):
            values = [factor * float(getattr(row, key)[i, j]) for row in result.over_speed]
            axis.plot(rpm, values, "o-", ms=3, lw=1.4, color=COLOURS[number], label=f"{'xyz'[i]}{'xyz'[j]}")
        axis.set_xlabel("speed of the input shaft, rpm")
        axis.set_ylabel(label)
        axis.legend(frameon=False, fontsize=8, ncols=2)
        if result.threshold_speed is not None:
            axis.axvline(result.threshold_speed * RPM_PER_RAD_S, color="#999999", lw=0.8, ls=":")
    stiffness.set_title(
        "Stiffness" + (" (dotted: whirl threshold)" if result.threshold_speed is not None else ""), fontsize=10
    )
    damping.set_title("Damping", fontsize=10)
    axes = np.array([inside, beside, stiffness, damping])
    for axis in axes[1:]:
        axis.grid(True, alpha=0.25)
        for side in ("top", "right"):
            axis.spines[side].set_visible(False)
    return axes


def _sectors(figure: Any, inside: Any, beside: Any, film: ThrustState) -> None:
    """Pressure and least gap of the pads of the side that carries more, over angle and radius."""
    carried = {side: float(film.pressure[film.side == side].sum()) for side in np.unique(film.side)}
    own = film.side == max(carried, key=lambda side: carried[side])
    angle = np.degrees(film.angle[own])
    # From pad to pad the angle leaps over the groove.
    steps = np.diff(angle)
    pads = np.split(np.arange(angle.size), np.flatnonzero(steps > _APART * np.median(steps)) + 1)
    largest = 1e-6 * film.largest_pressure
    picture = None
    for pad in pads:
        picture = inside.pcolormesh(
            angle[pad],
            1e3 * film.radius,
            1e-6 * film.pressure[own][pad].T,
            shading="gouraud",
            cmap="viridis",
            vmin=0.0,
            vmax=largest or 1.0,
        )
        beside.plot(angle[pad], 1e6 * film.gap[own][pad].min(axis=1), lw=1.4, color=COLOURS[0])
    figure.colorbar(picture, ax=inside, label="pressure, MPa")
    inside.set_xlabel("angle from +x, deg")
    inside.set_ylabel("radius, mm")
    inside.set_title(f"Pressure, at most {largest:.3g} MPa", fontsize=10)
    beside.set_ylim(bottom=0.0)
    beside.set_xlabel("angle from +x, deg")
    beside.set_ylabel("gap, um")
    beside.set_title("Least gap over the radius", fontsize=10)


def _pressure(figure: Any, axis: Any, film: FilmState) -> None:
    """The pressure over angle and length, both halves."""
    angle = np.degrees(film.angle) % 360.0
    order = np.argsort(angle)
    field = 1e-6 * film.pressure[order]
    z = 1e3 * np.concatenate([-film.z[::-1], film.z])
    picture = axis.pcolormesh(angle[order], z, np.hstack([field[:, ::-1], field]).T, shading="nearest", cmap="viridis")
    figure.colorbar(picture, ax=axis, label="pressure, MPa")
    axis.set_xlabel("angle from +x, deg")
    axis.set_ylabel("z, mm")
    axis.set_title(f"Pressure, at most {1e-6 * film.largest_pressure:.3g} MPa", fontsize=10)
