"""Draws a Campbell diagram: branches coloured by motion, mesh strain energy or damping, whirl by marker, lines and crossings."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.model.parts.carrier import written_name
from rotorgear.plots.figure import axes_for, beside, label, legend_below, name_axes
from rotorgear.quantity import RPM_PER_RAD_S, counted
from rotorgear.results.campbell import CampbellResult, ExcitationOrder
from rotorgear.results.modal import WHIRL_WORDS

COLOURS = ("motion", "mesh", "damping")
# Told apart by those who don't see red and green as others do, and in grey by how light they are.
_MOTION = {
    "bending": (0.00, 0.45, 0.70),
    "axial": (0.90, 0.62, 0.00),
    "torsion": (0.53, 0.13, 0.33),
    "casing": (0.60, 0.60, 0.60),
    "gear body": (0.00, 0.62, 0.45),
}
_MARKERS = {"forward": "^", "backward": "v", "mixed": "D", "planar": "_"}
_LINES = {"shaft": "#555555", "mesh": "#7a3f9d", "sideband": "#b58ccb"}
_MOST_LABELS = 14
# Below this share of the top a mode is a rigid one.
_RIGID = 1e-4
# How far above the highest line, and above the first branch beyond it, the picture reaches.
_ABOVE_LINES = 1.3
_ABOVE_BRANCH = 1.1
# A logarithmic decrement below this is no rounding: the motion grows.
_GROWS = -1e-9
_UNSTABLE = "#d55e00"
_MOST_ONSETS = 4
# More sidebands than that are drawn without names.
_MOST_SIDEBANDS = 8


def campbell(result: CampbellResult, ax: Any = None, *, colour: str = "motion", log: bool = False) -> Any:
    """Draw a Campbell diagram: branches over speed with whirl, lines of excitation, and the crossings that are excited.

    Args:
        result: branches over speed.
        ax: axes to draw on; those of a new figure for None.
        colour: "motion" (bending, axial, torsion, mixed by their shares of the kinetic energy), "mesh" (share of all meshes in
            the strain energy) or "damping" (logarithmic decrement).
        log: frequencies on a logarithmic axis, with all branches; else lines of excitation are straight from the origin, and
            branches far above all of them are beyond the picture, which says how many.

    Returns:
        The axes. Branches are dashed on a broad band where they grow, and crossed where they begin to.

    Raises:
        AnalysisError: an unknown colour. MissingExtraError: matplotlib is not installed.
    """
    require_colour(colour)
    axis = axes_for(ax, (11.0, 7.0), result.model.title or "Campbell diagram")
    from matplotlib.lines import Line2D

    left, right = sorted((float(result.speed_rpm[0]), float(result.speed_rpm[-1])))
    axis.set_xlim(left, right)
    _set_height(axis, result, log)
    _branches(axis, result, colour)
    grows = _instability(axis, result)
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
    _lines(axis, result, (left, right))
    _crossings(axis, result)
    if result.operating_speed is not None and left <= result.operating_speed * RPM_PER_RAD_S <= right:
        rpm = result.operating_speed * RPM_PER_RAD_S
        axis.axvline(rpm, color="black", lw=0.8)
        box = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.5}
        # Inside: the names of lines that end at the top stand above.
        beside(axis, "operating speed", (rpm, axis.get_ylim()[1]), (-3, -9), ha="right", bbox=box, zorder=6)
    name_axes(axis, label(result, "speeds", "rpm"), label(result, "frequency_hz"), grid=True)
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
    if grows:
        handles.append(
            Line2D([], [], color=_UNSTABLE, lw=1.6, ls=(0, (3, 1.5)), marker="X", mec="white", ms=8, label="unstable")
        )
    legend_below(axis, 6, 0.08, handles=handles, fontsize=8)
    return axis


def _set_height(axis: Any, result: CampbellResult, log: bool) -> None:
    """From 0 to what matters: a bit above all lines, the first branch beyond them and all onsets; or all of it, logarithmic."""
    highest = float(np.nanmax(result.frequency_hz))
    fastest = float(np.max(np.abs(result.speed_rpm))) / 60.0
    reach = max((line.order * fastest for line in result.lines), default=highest)
    if log:
        elastic = result.frequency_hz[result.frequency_hz > _RIGID * highest]
        shafts = max((line.order * fastest for line in result.lines if line.kind == "shaft"), default=reach)
        axis.set_yscale("log")
        axis.set_ylim(0.7 * min(float(elastic.min(initial=highest)), shafts), 1.04 * highest)
        return
    lowest = np.nanmin(result.frequency_hz, axis=0)
    next_one = np.argmin(np.where(lowest > reach, lowest, np.inf))
    beyond = float(np.nanmax(result.frequency_hz[:, next_one])) if (lowest > reach).any() else highest
    told = [
        reach * _ABOVE_LINES,
        beyond * _ABOVE_BRANCH,
        *(_ABOVE_BRANCH * onset.frequency_hz for onset in result.onsets),
    ]
    top = min(1.04 * highest, max(told))
    axis.set_ylim(0.0, top)
    above = int(np.count_nonzero(lowest > top))
    if above:
        words = f"{counted(above, 'branches')} up to {highest:.4g} Hz above"
        axis.text(0.008, 0.985, words, transform=axis.transAxes, va="top", fontsize=8, color="#555555", zorder=6)


def _followed(result: CampbellResult, b: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """All points of a branch that were solved, in the order of the speeds: rpm, Hz, logarithmic decrement.

    Beside the speeds of the result these are its crossings and onsets, which were found to rounding.
    """
    points = [*zip(result.speed_rpm, result.frequency_hz[:, b], result.log_decrement[:, b], strict=True)]
    for met in result.crossings:
        if met.branch == b + 1:
            zeta = met.damping_ratio
            points.append(
                (met.speed * RPM_PER_RAD_S, met.frequency_hz, 2.0 * np.pi * zeta / np.sqrt(1.0 - zeta * zeta))
            )
    points += [(one.speed * RPM_PER_RAD_S, one.frequency_hz, 0.0) for one in result.onsets if one.branch == b + 1]
    rpm, hz, decrement = np.array(sorted(points, key=lambda point: point[0]), float).T
    return rpm, hz, decrement


def _instability(axis: Any, result: CampbellResult) -> bool:
    """Mark the parts of branches that grow: a broad band below white dashes, a cross where they begin; whether there are any."""
    grows = False
    for b in range(len(result)):
        rpm, hz, decrement = _followed(result, b)
        growing = _mean(decrement) < _GROWS
        x, y = (np.where(growing, np.stack([v[:-1], v[1:]]), np.nan).T for v in (rpm, hz))
        if not np.isfinite(y).any():
            continue
        grows = True
        ends = [np.column_stack([v, np.full(len(v), np.nan)]).ravel() for v in (x, y)]
        axis.plot(*ends, color=_UNSTABLE, lw=6.0, alpha=0.3, solid_capstyle="butt", zorder=2.5)
        for run in np.split(np.arange(len(growing)), np.flatnonzero(np.diff(growing)) + 1):
            if growing[run[0]]:
                among = slice(run[0], run[-1] + 2)
                axis.plot(rpm[among], hz[among], color="white", lw=1.7, ls=(0, (1.5, 3.0)), zorder=3.5)
    onsets = [one for one in result.onsets if one.branch]
    for number, one in enumerate(onsets):
        at = (one.speed * RPM_PER_RAD_S, one.frequency_hz)
        axis.plot(*at, "X", color=_UNSTABLE, ms=9, mec="white", mew=0.8, zorder=7, clip_on=False)
        if number < _MOST_ONSETS:
            left = at[0] > np.mean(axis.get_xlim())
            box = {"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 0.5}
            name = f"unstable from {at[0]:.0f} rpm"
            side = "right" if left else "left"
            beside(axis, name, at, (-8 if left else 8, 9), fontsize=8, color="#8a3b00", bbox=box, zorder=8, ha=side)
    return grows


def _shares(axis: Any, points: list[tuple[float, float]]) -> np.ndarray:
    """Where points stand as shares of the axes, (k, 2)."""
    return np.asarray((axis.transScale + axis.transLimits).transform(np.reshape(points, (-1, 2))))


def require_colour(colour: str) -> None:
    """Refuse what branches can't be coloured by.

    Raises:
        AnalysisError: it is none of `COLOURS`.
    """
    if colour not in COLOURS:
        raise AnalysisError(f"colour: got '{colour}', expected {', '.join(COLOURS[:-1])} or {COLOURS[-1]}")


def _branches(axis: Any, result: CampbellResult, colour: str) -> None:
    from matplotlib.collections import LineCollection

    followed = [_followed(result, b) for b in range(len(result))]
    points = [np.stack([rpm, hz], axis=-1) for rpm, hz, _ in followed]
    segments = np.concatenate([np.stack([one[:-1], one[1:]], axis=1) for one in points])
    there = np.isfinite(segments).all(axis=(1, 2))

    def along(values: np.ndarray) -> np.ndarray:
        """Means over the segments of what is known at the speeds of the result, (k, b)."""
        return np.concatenate(
            [_mean(_interpolated(rpm, result.speed_rpm, values[:, b])) for b, (rpm, _, _) in enumerate(followed)]
        )

    if colour == "motion":
        names = list(result.kinetic_by_motion)
        shares = np.stack([along(result.kinetic_by_motion[name]) for name in names], axis=-1)
        colours = np.clip(shares @ np.array([_MOTION[name] for name in names]), 0.0, 1.0)
        # A motion without energy, as of a branch that stands still, has no shares: grey.
        colours = np.where(np.isfinite(colours), colours, 0.5)
        axis.add_collection(LineCollection(segments[there], colors=colours[there], lw=1.5, zorder=3))
        return
    if colour == "mesh":
        total = sum(result.mesh_strain.values(), np.zeros(result.frequency_hz.shape))
        values = 100.0 * along(total)
        shown = "share of the meshes in the strain energy, %"
    else:
        values = np.concatenate([_mean(decrement) for _, _, decrement in followed])
        shown = label(result, "log_decrement")
    lines = LineCollection(segments[there], array=values[there], cmap="viridis", lw=1.7, zorder=3)
    axis.add_collection(lines)
    axis.figure.colorbar(lines, ax=axis, label=shown, pad=0.06, fraction=0.03)


def _interpolated(at: np.ndarray, speeds: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Values between speeds, which may descend; NaN where none is known."""
    known = np.isfinite(values)
    if not known.any():
        return np.full(len(at), np.nan)
    order = np.argsort(speeds[known])
    return np.asarray(np.interp(at, speeds[known][order], values[known][order]))


def _mean(values: np.ndarray) -> np.ndarray:
    return np.asarray(0.5 * (values[:-1] + values[1:]))


def _lines(axis: Any, result: CampbellResult, ends: tuple[float, float]) -> None:
    """Excitation lines, named where they leave the picture: at the right, or at its upper edge."""
    side: list[tuple[ExcitationOrder, tuple[float, float]]] = []
    above: list[tuple[ExcitationOrder, tuple[float, float]]] = []
    bottom, top = axis.get_ylim()
    far = max(ends, key=abs)
    sidebands = sum(line.kind == "sideband" for line in result.lines)
    speeds = np.linspace(*ends, 201)
    for line in result.lines:
        axis.plot(speeds, line.order * np.abs(speeds) / 60.0, "--", color=_LINES[line.kind], lw=0.7, zorder=2)
        end = line.order * abs(far) / 60.0
        if line.kind == "sideband" and sidebands > _MOST_SIDEBANDS:
            continue  # the legend says what they are; names would cover each other
        if bottom <= end <= top:
            side.append((line, (far, end)))
        elif end > top:
            above.append((line, (60.0 * top / line.order, top)))

    def name(line: ExcitationOrder, at: tuple[float, float], place: tuple[float, float], **look: Any) -> None:
        look |= {"fontsize": 7, "color": _LINES[line.kind], "annotation_clip": False}
        axis.annotate(_short(line), at, xytext=place, textcoords="axes fraction", **look)

    edge = 1.005 if far == ends[1] else -0.06
    heights = _shares(axis, [at for _, at in side])[:, 1].tolist()
    for (line, at), height in zip(side, spread(heights, 0.021), strict=True):
        name(line, at, (edge, height), va="center")
    shares = _shares(axis, [at for _, at in above])[:, 0].tolist()
    for (line, at), share, place in zip(above, shares, spread(shares, 0.014), strict=True):
        if 0.0 <= share <= 1.0:
            name(line, at, (place, 1.01), rotation=50, va="bottom", ha="left")


def _short(line: ExcitationOrder) -> str:
    """A line's name for the edge of the picture: up to two parts by name, of more the first and how many others."""
    names = list(dict.fromkeys(map(written_name, line.parts)))
    parts = ", ".join(names) if len(names) <= 2 else f"{names[0]} and {len(names) - 1} others"
    last = line.name.rpartition(", ")[2]
    return f"{parts} {last.partition(' ')[2] if len(names) > 1 else line.name.split(' ', 2)[2]}"


def _crossings(axis: Any, result: CampbellResult) -> None:
    """A ring at every crossing that is excited, as large as its participation; the speeds of the most telling ones beside it."""
    met = [item for item in result.crossings if item.excited]
    if not met:
        return
    points = [(item.speed * RPM_PER_RAD_S, item.frequency_hz) for item in met]
    size = 6.0 + 60.0 * np.sqrt([item.participation for item in met])
    axis.scatter(*np.transpose(points), s=size, facecolors="none", edgecolors="black", lw=0.7, zorder=5)

    def telling(k: int) -> float:
        """Participation, more the nearer to the operating speed."""
        if not result.operating_speed:
            return met[k].participation
        return met[k].participation / (0.05 + abs(met[k].speed / result.operating_speed - 1.0))

    rings = _shares(axis, points)
    taken = np.zeros((0, 2))
    box = {"fc": "white", "ec": "none", "alpha": 0.8, "pad": 0.6}
    for k in sorted(range(len(met)), key=telling, reverse=True):
        place = _free_place(rings[k], rings, taken) if len(taken) < _MOST_LABELS else None
        if place is not None:
            taken = np.vstack([taken, place])
            # A thin line from a label to its ring: another branch may lie beside it.
            thread = {"arrowstyle": "-", "lw": 0.5, "shrinkA": 0.0, "shrinkB": 0.5 * float(np.sqrt(size[k]))}
            look = {"fontsize": 7, "va": "center", "ha": "center", "bbox": box, "arrowprops": thread}
            axis.annotate(f"{points[k][0]:.0f}", points[k], place, textcoords="axes fraction", zorder=6, **look)


# Size of a short label, and distances at which it is tried, as shares of the axes.
_LABEL = np.array([0.046, 0.026])
_TRIALS = tuple((r * np.cos(a), r * np.sin(a)) for r in (0.03, 0.045) for a in np.radians((60, 120, -60, -120, 0, 180)))


def _free_place(at: np.ndarray, rings: np.ndarray, taken: np.ndarray) -> np.ndarray | None:
    """Centre of a free box beside a point, which covers no ring and no other label; all as shares of the axes."""
    for offset in _TRIALS:
        centre: np.ndarray = at + offset
        inside = np.all(np.abs(centre - 0.5) <= 0.5 * (1.0 - _LABEL))
        on_ring = np.all(np.abs(rings - centre) < 0.5 * _LABEL, axis=1).any()
        if inside and not on_ring and not np.all(np.abs(taken - centre) < _LABEL, axis=1).any():
            return centre
    return None


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
