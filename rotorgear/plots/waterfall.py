"""Draws a waterfall: the spectrum of one quantity at every speed of a run-up, one above the other."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.plots.colours import COLOURS
from rotorgear.plots.figure import axes_for
from rotorgear.plots.static import plain_axis
from rotorgear.results.response import ResponseResult

_SPECTRA = 45
# The largest line is so many steps between two spectra high; a line is a peak of this share of the width.
_STEPS_HIGH = 7.0
_PEAK_WIDTH = 0.0035
# Heights are logarithmic over so many decades below the highest peak: orders that stay below are left out.
_DECADES = 3.0
_SHOWN = 10.0**-_DECADES
# Labels stand so far apart.
_LABELS_APART = 0.03


def waterfall(result: ResponseResult, ax: Any = None, *, at: str | None = None) -> Any:
    """Draw the spectra of one quantity over speed, one above the other.

    Heights are logarithmic over three decades: weak orders are seen beside the strongest.

    Args:
        result: a run-up.
        ax: axes to draw on; those of a new figure for None.
        at: name of a mesh (its most loaded helix), a bearing (all three forces) or a point; None: mesh of the largest force,
            else the first bearing.

    Returns:
        The axes.

    Raises:
        AnalysisError: no such mesh, bearing or point, or a single speed. MissingExtraError: matplotlib is not installed.
    """
    if len(result.speeds) < 2:
        raise AnalysisError("a waterfall needs more than one speed")
    title, unit, size = waterfall_of(result, at)
    chosen = np.arange(len(result.speeds) - 1, -1, -(len(result.speeds) // _SPECTRA + 1))[::-1]
    rpm = np.abs(result.speed_rpm)
    top = float(size[:, chosen].max()) or 1.0
    step = float(rpm[chosen[-1]] - rpm[chosen[0]]) / len(chosen)
    shown = [o for o in range(len(result.orders)) if size[o].max() >= _SHOWN * top]
    widest = 1.03 * float(result.frequency_hz[shown].max())
    weak = len(result.orders) - len(shown)
    left_out = f", {weak} weaker order{'s'[: weak != 1]} left out" if weak else ""
    peak = f"{title}: highest peak {top:.4g} {unit}, logarithmic over {_DECADES:g} decades{left_out}"
    axis = axes_for(ax, (10.0, 7.0), f"{result.model.title}\n{peak}")
    labelled = -widest
    for order in shown:  # the way of each order, lowest first
        axis.plot(result.frequency_hz[order], rpm, color="#999999", lw=0.7, ls=":", zorder=0)
        here = float(result.frequency_hz[order, -1])
        if here - labelled < _LABELS_APART * widest:
            continue
        labelled = here
        axis.annotate(
            result.orders[order],
            (here, rpm[-1]),
            xytext=(2, 4),
            textcoords="offset points",
            fontsize=7.5,
            rotation=35,
            color="#333333",
            annotation_clip=False,
            zorder=200,
        )
    for number, s in enumerate(chosen[::-1]):
        hz, height = _spectrum(result.frequency_hz[shown, s], _height(size[shown, s] / top), widest)
        line = rpm[s] + _STEPS_HIGH * step * height
        axis.fill_between(hz, rpm[s], line, where=line > rpm[s], color="white", zorder=2 * number + 1, lw=0)
        axis.plot(hz, line, color=COLOURS[0], lw=0.8, zorder=2 * number + 2)
    axis.set_xlim(0.0, widest)
    axis.set_ylim(rpm[0] - step, rpm[-1] + (_STEPS_HIGH + 3.0) * step)
    axis.set_xlabel("frequency, Hz")
    axis.set_ylabel(f"speed of {result.model.reference_shaft}, rpm")
    plain_axis(axis)
    return axis


def waterfall_of(result: ResponseResult, at: str | None) -> tuple[str, str, np.ndarray]:
    """Title, unit and amplitudes (o, s) of a mesh, a bearing or a point."""
    if at is None:
        at = max(result.peaks(), key=lambda row: row[4])[0] if result.contact_mesh else next(iter(result.bearings), "")
    name = at.rpartition(".")[2]
    if name in result.contact_mesh:
        return (
            f"dynamic force of mesh {name}",
            "N",
            np.abs(result.mesh_force[:, :, result.contacts_of(name)]).max(axis=2),
        )
    if name in result.bearings:
        force = result.bearing_force[:, :, result.bearings.index(name)]
        return f"force of bearing {name}", "N", np.linalg.norm(np.abs(force), axis=2)
    if name in result.points:
        turns = result.model.points[name].direction in ("tilt_x", "tilt_y", "torsion")
        size = np.abs(result.acceleration[:, :, result.points.index(name)])
        return f"acceleration at {name}", "rad/s$^2$" if turns else "m/s$^2$", size
    known = [*dict.fromkeys(result.contact_mesh), *result.bearings, *result.points]
    raise AnalysisError(
        f"'{at}' is no mesh, bearing or point of the model: expected one of {', '.join(known) or 'none'}"
    )


def _height(share: np.ndarray) -> np.ndarray:
    """Heights from 0 to 1 of shares of the highest peak, logarithmic."""
    return np.asarray(1.0 + np.log10(np.maximum(share, _SHOWN)) / _DECADES)


def _spectrum(at: np.ndarray, height: np.ndarray, widest: float) -> tuple[np.ndarray, np.ndarray]:
    """A line along the axis with a narrow triangle of each height at its frequency."""
    width = _PEAK_WIDTH * widest
    hz = np.unique(np.concatenate([[0.0, widest], at - width, at, at + width]))
    hz = hz[(hz >= 0.0) & (hz <= widest)]
    peaks = np.clip(1.0 - np.abs(hz[:, None] - at) / width, 0.0, None) * height
    return hz, peaks.max(axis=1)
