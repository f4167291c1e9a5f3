"""Draws an undamped critical speed map."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from rotorgear.plots.figure import new_figure, write_figure
from rotorgear.results.campbell import RPM
from rotorgear.results.critical import CriticalMap

_STYLE = {"forward": ("-", "#1f5fa8"), "backward": ("--", "#c2571a"), "other": (":", "#777777")}


def draw_critical_map(chart: CriticalMap, path: str | Path) -> Path:
    """Write critical speeds over support stiffness, with the stiffness of the bearings, as a picture; return its path.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    figure = new_figure((9.0, 6.0))
    axis = figure.subplots()
    for kind, (style, colour) in _STYLE.items():
        values = np.abs(getattr(chart, kind)) * RPM
        for column in range(values.shape[1]):
            axis.loglog(
                chart.stiffness,
                values[:, column],
                style,
                color=colour,
                lw=1.4,
                label=_label(kind) if column == 0 else None,
            )
    _bearings(axis, chart)
    axis.set_xlabel("radial stiffness of every bearing, N/m")
    axis.set_ylabel(f"critical speed of {chart.model.reference_shaft}, rpm")
    axis.set_title(f"{chart.model.title or 'Critical speeds'}\nundamped critical speeds of {chart.line}", fontsize=10)
    axis.set_xlim(chart.stiffness[0], chart.stiffness[-1])
    axis.grid(True, which="both", alpha=0.2)
    axis.legend(frameon=False, loc="lower right")
    return write_figure(figure, path)


def _label(kind: str) -> str:
    return "torsion or axial" if kind == "other" else f"{kind} whirl"


def _bearings(axis: object, chart: CriticalMap) -> None:
    """A vertical line at each different stiffness that a bearing has, named after the bearings that have it."""
    names: dict[float, list[str]] = {}
    for name, (x, y) in chart.bearings.items():
        for value, suffix in ((x, "" if x == y else " x"), (y, "" if x == y else " y")):
            if value > 0.0 and f"{name}{suffix}" not in names.setdefault(float(value), []):
                names[float(value)].append(f"{name}{suffix}")
    for value, own in names.items():
        if chart.stiffness[0] <= value <= chart.stiffness[-1]:
            axis.axvline(value, color="#444444", lw=0.8)  # type: ignore[attr-defined]
            more = f" and {len(own) - 3} more" if len(own) > 3 else ""
            axis.text(  # type: ignore[attr-defined]
                value,
                0.02,
                " " + ", ".join(own[:3]) + more,
                rotation=90,
                fontsize=7,
                va="bottom",
                ha="right",
                color="#444444",
                transform=axis.get_xaxis_transform(),  # type: ignore[attr-defined]
            )
