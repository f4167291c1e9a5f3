"""Warnings of a sweep: what failed or had not settled, what the steps don't follow, and parameters that change nothing."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence

import numpy as np

from rotorgear.analysis.sweep_axes import Axis
from rotorgear.analysis.sweep_classify import period_in
from rotorgear.analysis.sweep_point import Point
from rotorgear.solvers.lanes import Orbit

# Depths over which damping sets in that flanks may pass in a step: measured on models/backlash_pair.toml at 3560 rpm, where at 12
# periodic motions turn into chaos that more steps don't show, and at 6 they don't.
_PASSED = 5.0
# Logarithm by which the start of a run must have decayed: 5 % of it.
_FORGOTTEN = 3.0


def notes(
    axes: Sequence[Axis],
    points: Sequence[Point | None],
    failed: Sequence[str],
    motion: Sequence[str],
    steps: np.ndarray,
    settle: int,
    orbits: dict[tuple[int, int], Orbit],
) -> tuple[str, ...]:
    """Return the warnings as sentences."""
    found = []
    count = sum(map(bool, failed))
    if count:
        found.append(f"{count} of {len(points)} points failed; the first: {next(filter(None, failed))}")
    if any(q.drift for q in points if q):
        found.append("the torques do not balance at some points: the shafts drift off the prescribed rotation there")
    if any(q.rolling for q in points if q):
        found.append(
            "rolling elements pass beside the meshes and never repeat with them: a motion that they drive shows as quasi-periodic"
        )
    unsettled = sum(kind == "not settled" for kind in motion)
    if unsettled:
        found.append(f"{unsettled} of {len(motion)} runs had not settled: ask for more periods of --settle or --count")
    found += [
        f"{axis.address} changes nothing in this model: its points are all the same" for axis in idle(axes, points)
    ]
    return (
        *found,
        *_slow(motion, settle, orbits, len(motion) // max(1, len(points))),
        *_thin_ramps(points, steps, orbits),
    )


def idle(axes: Sequence[Axis], points: Sequence[Point | None]) -> list[Axis]:
    """Axes along which all systems are the same to the last bit."""
    seen: dict[bytes, int] = {}
    own = [-1 if q is None else seen.setdefault(_digest(q), len(seen)) for q in points]
    table = np.array(own).reshape([len(axis.values) for axis in axes])
    return [
        axis
        for at, axis in enumerate(axes)
        if len(set(axis.values)) > 1 and np.all(table == np.take(table, [0], axis=at))
    ]


def _digest(point: Point) -> bytes:
    """All that a point's motion depends on."""
    system, columns = point.system, point.system.columns
    parts = (
        system.K, system.D, system.load, system.B, system.rest, columns.gap, columns.mode, columns.stiffness, columns.damping,
        columns.backlash, columns.ramp, columns.push, system.own.forces.parameters, np.array([system.w, system.turns]),
    )  # fmt: skip
    return hashlib.blake2b(b"".join([*(np.ascontiguousarray(part).tobytes() for part in parts), point.shape])).digest()


def _slow(motion: Sequence[str], settle: int, orbits: dict[tuple[int, int], Orbit], runs: int) -> tuple[str, ...]:
    """A warning where what a run started with is still there when it counts, and may be why it repeats after several periods."""
    several = {
        key: o for key, o in orbits.items() if period_in(motion[key[0] * runs + key[1]]) > 1 and o.growth.shape[1]
    }
    slow = sum(float(o.growth[:, 0].mean()) * settle > -_FORGOTTEN for o in several.values())
    if not slow:
        return ()
    return (
        f"{slow} of {len(several)} runs with 2T or longer forget their start more slowly than the {settle} periods that settled: "
        "their period may change with more --settle",
    )


def _thin_ramps(
    points: Sequence[Point | None], steps: np.ndarray, orbits: dict[tuple[int, int], Orbit]
) -> tuple[str, ...]:
    """A warning where flanks that meet again pass the depth over which their damping sets in within a fraction of a step."""
    from rotorgear.solvers.kernel_lane_parts import APART, X_MAX, X_MIN

    passed = []
    for (i, _), orbit in orbits.items():
        point = points[i]
        if point is None or not orbit.finite:
            continue
        columns, sums = point.system.columns, orbit.sums
        met = columns.mesh & (columns.damping > 0.0) & (sums[:, APART] > 0.0) & (sums[:, X_MAX] > 0.0)
        # Of a swing from one end to the other in a mesh period, the largest way in a step.
        way = np.pi / steps[i] * (sums[:, X_MAX] - sums[:, X_MIN])
        passed.append(float((way * columns.ramp)[met].max(initial=0.0)))
    thin = [x for x in passed if x > _PASSED]
    if not thin:
        return ()
    return (
        f"in {len(thin)} of {len(passed)} runs flanks that meet pass up to {max(thin):.0f} times the depth over which damping "
        "sets in within one step: the kind of motion may come from the step; compare with more --steps, or give the meshes a "
        "larger damping_depth",
    )
