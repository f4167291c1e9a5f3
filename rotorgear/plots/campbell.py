"""Draws a Campbell diagram: branches coloured by motion, mesh strain energy or damping, whirl by marker, lines and crossings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.plots.figure import axes_for, name_axes
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.campbell import CampbellResult, Crossing, ExcitationOrder
from rotorgear.results.modal import WHIRL_WORDS

COLOURS = ("motion", "mesh", "damping")
_MOTION = {
    "bending": (0.12, 0.37, 0.66),
    "axial": (0.18, 0.60, 0.25),
    "torsion": (0.80, 0.23, 0.13),
    "casing": (0.45, 0.45, 0.45),
    "gear body": (0.62, 0.42, 0.10),
}
_MARKERS = {"forward": "^", "backward": "v", "mixed": "D", "planar": "_"}
_LINES = {"shaft": "#555555", "mesh": "#7a3f9d", "sideband": "#b58ccb"}
_MOST_LABELS = 14
# A top of so many times the highest shaft order gives a logarithmic axis; below this share of the top a mode is a rigid one.
_FLAT = 5.0
_RIGID = 1e-4
# More sidebands than that are drawn without names.
_MOST_SIDEBANDS = 8


def campbell(result: CampbellResult, ax: Any = None, *, colour: str = "motion") -> Any:
    """Draw a Campbell diagram: branches over speed with whirl, lines of excitation, and the crossings that are excited.

    Args:
        result: branches over speed.
        ax: axes to draw on; those of a new figure for None.
        colour: "motion" (bending, axial, torsion, mixed by their shares of the kinetic energy), "mesh" (share of all meshes in
            the strain energy) or "damping" (logarithmic decrement).

    Returns:
        The axes. Frequencies are logarithmic where the diagram reaches more than five times as far as the shaft orders.

    Raises:
        AnalysisError: an unknown colour. MissingExtraError: matplotlib is not installed.
    """
    if colour not in COLOURS:
        raise AnalysisError(f"colour: got '{colour}', expected {', '.join(COLOURS[:-1])} or {COLOURS[-1]}")
    axis = axes_for(ax, (11.0, 7.0), result.model.title or "Campbell diagram")
    from matplotlib.lines import Line2D

    height = _height(result)
    top = height.top
    left, right = sorted((float(result.speed_rpm[0]), float(result.speed_rpm[-1])))
    axis.set_xlim(left, right)
    if height.logarithmic:
        axis.set_yscale("log")
    axis.set_ylim(height.bottom, top)
    _branches(axis, result, colour)
    # About eight markers of whirl a branch, each branch beginning elsewhere, so that close branches don't hide each other's.
    step = max(1, len(result.speeds) // 8)
    for word, marker in _MARKERS.items():
        x = []
        y = []
        for b in range(len(result)):
            for k in range((b * step) // 3 % step + 1, len(result.speeds), step):
                if WHIRL_WORDS[result.whirl[k, b]] == word and np.isfinite(result.frequency_hz[k, b]):
                    x.append(result.speed_rpm[k])
                    y.append(result.frequency_hz[k, b])
        axis.plot(x, y, marker, color="#222222", ms=3.6, mfc="white", mew=0.7, ls="none", zorder=4)
    _lines(axis, result, (left, right), height)
    _crossings(axis, result, height)
    if result.operating_speed is not None and left <= result.operating_speed * RPM_PER_RAD_S <= right:
        axis.axvline(result.operating_speed * RPM_PER_RAD_S, color="black", lw=0.8)
        axis.annotate(
            "operating speed",
            (result.operating_speed * RPM_PER_RAD_S, top),
            xytext=(-3, -9),  # inside: the names of lines that end at the top stand above
            textcoords="offset points",
            fontsize=7,
            ha="right",
            bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.5},
            zorder=6,
        )
    name_axes(axis, f"speed of {result.model.reference_shaft}, rpm", "damped frequency, Hz", grid=True)
    handles = []
    if colour == "motion":
        handles += [Line2D([], [], color=_MOTION[name], lw=1.8, label=name) for name in result.kinetic_by_motion]
    used = {WHIRL_WORDS[number] for number in np.unique(result.whirl)}
    handles += [
        Line2D([], [], color="#222222", marker=marker, mfc="white", ms=4.5, mew=0.8, ls="none", label=f"{word} whirl")
        for word, marker in _MARKERS.items()
        if word in used
    ]
    kinds = {line.kind for line in result.lines}
    handles += [Line2D([], [], color=_LINES[k], ls="--", lw=0.9, label=f"{k} orders") for k in _LINES if k in kinds]
    if any(item.excited for item in result.crossings):
        handles.append(
            Line2D([], [], color="black", marker="o", mfc="none", ms=6, mew=0.7, ls="none", label="crossing, rpm")
        )
    axis.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, -0.08), ncols=6, frameon=False, fontsize=8)
    return axis


@dataclass(frozen=True)
class _Height:
    """The axis of frequencies: its ends in Hz, and whether it is logarithmic."""

    bottom: float
    top: float
    logarithmic: bool

    def share(self, frequency: Any) -> Any:
        """Height of a frequency as a share of the axis."""
        if self.logarithmic:
            return np.log(np.maximum(frequency, 1e-300) / self.bottom) / np.log(self.top / self.bottom)
        return np.asarray(frequency) / self.top

    def at(self, share: float) -> float:
        """Frequency at a share of the axis."""
        return float(self.bottom * (self.top / self.bottom) ** share) if self.logarithmic else share * self.top


def _height(result: CampbellResult) -> _Height:
    """Linear, but logarithmic where the diagram reaches so far, for the orders of meshes, that shaft orders would lie flat."""
    top = 1.04 * float(np.nanmax(result.frequency_hz))
    fastest = float(np.max(np.abs(result.speed_rpm))) / 60.0
    shafts = max((line.order * fastest for line in result.lines if line.kind == "shaft"), default=top)
    elastic = result.frequency_hz[result.frequency_hz > _RIGID * top]
    if not elastic.size or top < _FLAT * shafts:
        return _Height(0.0, top, False)
    return _Height(0.7 * min(float(elastic.min()), shafts), top, True)


def _branches(axis: Any, result: CampbellResult, colour: str) -> None:
    from matplotlib.collections import LineCollection

    points = np.stack(
        [np.broadcast_to(result.speed_rpm[:, None], result.frequency_hz.shape), result.frequency_hz], axis=-1
    )
    segments = np.stack([points[:-1], points[1:]], axis=2).reshape(-1, 2, 2)
    there = np.isfinite(segments).all(axis=(1, 2))
    if colour == "motion":
        shares = np.stack([_mean(result.kinetic_by_motion[name]) for name in result.kinetic_by_motion], axis=-1)
        colours = np.clip(shares @ np.array([_MOTION[name] for name in result.kinetic_by_motion]), 0.0, 1.0)
        # A motion without energy, as of a branch that stands still, has no shares: grey.
        colours = np.where(np.isfinite(colours), colours, 0.5)
        axis.add_collection(LineCollection(segments[there], colors=colours.reshape(-1, 3)[there], lw=1.5, zorder=3))
        return
    if colour == "mesh":
        total = sum(result.mesh_strain.values(), np.zeros(result.frequency_hz.shape))
        values = 100.0 * _mean(total)
        label = "share of the meshes in the strain energy, %"
    else:
        values = _mean(result.log_decrement)
        label = "logarithmic decrement"
    lines = LineCollection(segments[there], array=values.ravel()[there], cmap="viridis", lw=1.7, zorder=3)
    axis.add_collection(lines)
    axis.figure.colorbar(lines, ax=axis, label=label, pad=0.06, fraction=0.03)


def _mean(values: np.ndarray) -> np.ndarray:
    return np.asarray(0.5 * (values[:-1] + values[1:]))


def _lines(axis: Any, result: CampbellResult, ends: tuple[float, float], height: _Height) -> None:
    """Excitation lines, named where they leave the picture: at the right, or at its upper edge."""
    side: list[tuple[float, ExcitationOrder]] = []
    above: list[tuple[float, ExcitationOrder]] = []
    far = max(ends, key=abs)
    sidebands = sum(line.kind == "sideband" for line in result.lines)
    speeds = np.linspace(*ends, 201)
    for line in result.lines:
        axis.plot(speeds, line.order * np.abs(speeds) / 60.0, "--", color=_LINES[line.kind], lw=0.7, zorder=2)
        end = line.order * abs(far) / 60.0
        if line.kind == "sideband" and sidebands > _MOST_SIDEBANDS:
            continue  # the legend says what they are; names would cover each other
        if height.bottom <= end <= height.top:
            side.append((float(height.share(end)), line))
        elif end > height.top:
            above.append((60.0 * height.top / line.order / far, line))
    edge = 1.005 if far == ends[1] else -0.06
    for (share, line), place in zip(side, spread([h for h, _ in side], 0.021), strict=True):
        axis.annotate(
            _short(line),
            (far, height.at(share)),
            xytext=(edge, place),
            textcoords="axes fraction",
            fontsize=7,
            va="center",
            color=_LINES[line.kind],
            annotation_clip=False,
        )
    span = ends[1] - ends[0]
    shares = [(far * share - ends[0]) / span for share, _ in above]
    for (_, line), share, place in zip(above, shares, spread(shares, 0.014), strict=True):
        if 0.0 <= share <= 1.0:
            axis.annotate(
                _short(line),
                (ends[0] + share * span, height.top),
                xytext=(place, 1.01),
                textcoords="axes fraction",
                fontsize=7,
                rotation=50,
                va="bottom",
                ha="left",
                color=_LINES[line.kind],
                annotation_clip=False,
            )


def _short(line: ExcitationOrder) -> str:
    """A line's name for the edge of the picture: up to two parts by name, of more the first and how many others."""
    parts = ", ".join(line.parts) if len(line.parts) <= 2 else f"{line.parts[0]} and {len(line.parts) - 1} others"
    last = line.name.rpartition(", ")[2]
    return f"{parts} {last.partition(' ')[2] if len(line.parts) > 1 else line.name.split(' ', 2)[2]}"


def _crossings(axis: Any, result: CampbellResult, height: _Height) -> None:
    """A ring at every crossing that is excited, as large as its participation; the speeds of the most telling ones beside it."""
    met = [item for item in result.crossings if item.excited]
    if not met:
        return
    x = np.array([item.speed * RPM_PER_RAD_S for item in met])
    y = np.array([item.frequency_hz for item in met])
    size = 6.0 + 60.0 * np.sqrt([item.participation for item in met])
    axis.scatter(x, y, s=size, facecolors="none", edgecolors="black", lw=0.7, zorder=5)
    labels = Labels(axis.get_xlim(), (0.0, 1.0))
    labels.block(np.column_stack([x, height.share(y)]))

    def telling(item: Crossing) -> float:
        """Participation, more the nearer to the operating speed."""
        if not result.operating_speed:
            return item.participation
        return item.participation / (0.05 + abs(item.speed / result.operating_speed - 1.0))

    for item in sorted(met, key=telling, reverse=True):
        if labels.count >= _MOST_LABELS:
            break
        place = labels.place(item.speed * RPM_PER_RAD_S, float(height.share(item.frequency_hz)))
        if place is not None:
            axis.annotate(
                f"{item.speed * RPM_PER_RAD_S:.0f}",
                (item.speed * RPM_PER_RAD_S, item.frequency_hz),
                xytext=(place[0], height.at(place[1])),
                fontsize=7,
                zorder=6,
                va="center",
                ha="center",
                bbox={"fc": "white", "ec": "none", "alpha": 0.8, "pad": 0.6},
            )


# Size of a short label, and distances at which it is tried, as shares of the axes.
_WIDTH = 0.046
_HEIGHT = 0.026
_TRIALS = tuple((r * np.cos(a), r * np.sin(a)) for r in (0.03, 0.045) for a in np.radians((60, 120, -60, -120, 0, 180)))


def spread(places: list[float], least: float) -> list[float]:
    """Places moved apart by the least amounts that keep their order and a distance of `least` between neighbours."""
    order = np.argsort(places, kind="stable")
    moved = np.array([places[k] for k in order], float)
    for _ in range(200):
        gaps = np.diff(moved)
        tight = np.flatnonzero(gaps < least * 0.999)
        if not tight.size:
            break
        for k in tight:
            push = 0.5 * (least - (moved[k + 1] - moved[k]))
            if push > 0.0:
                moved[k] -= push
                moved[k + 1] += push
    back = np.empty(len(moved))
    back[order] = moved
    return [float(value) for value in back]


class Labels:
    """Boxes taken so far in axes of given limits."""

    def __init__(self, x: tuple[float, float], y: tuple[float, float]) -> None:
        self._low = np.array([x[0], y[0]])
        self._span = np.array([x[1] - x[0], y[1] - y[0]])
        self._boxes: list[np.ndarray] = []
        self._points = np.zeros((0, 2))

    @property
    def count(self) -> int:
        """How many labels have a place."""
        return len(self._boxes)

    def block(self, points: np.ndarray) -> None:
        """Keep points (k, 2) in data units free."""
        self._points = (points - self._low) / self._span

    def place(self, x: float, y: float) -> tuple[float, float] | None:
        """Centre of a free box beside a point in data units, or None."""
        at = (np.array([x, y]) - self._low) / self._span
        for offset in _TRIALS:
            centre = at + offset
            if self._is_free(centre):
                self._boxes.append(centre)
                where = self._low + centre * self._span
                return float(where[0]), float(where[1])
        return None

    def _is_free(self, centre: np.ndarray) -> bool:
        size = np.array([_WIDTH, _HEIGHT])
        if np.any(centre - 0.5 * size < 0.0) or np.any(centre + 0.5 * size > 1.0):
            return False
        if np.any(np.all(np.abs(self._points - centre) < 0.5 * size, axis=1)):
            return False
        return not any(np.all(np.abs(box - centre) < size) for box in self._boxes)
