"""Warnings of a sweep: points that failed or had not settled, parameters without effect, slow transients."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence

import numpy as np

from rotorgear.analysis.common.casings import time_warnings
from rotorgear.analysis.sweep.axes import Axis
from rotorgear.analysis.sweep.classify import CHAOTIC, FAILED, NOT_SETTLED, period_in, repeats
from rotorgear.analysis.sweep.point import Point
from rotorgear.model.model import Model
from rotorgear.solvers.batch.run_block import Orbit

# Decay exponent over the periods discarded: exp(-3) = 5 % of the initial deviation is left.
_FORGOTTEN = 3.0
# What a motion may be in the direction of a law, beside that direction, and still count as none.
_ROUNDING = 1e-9
# Sentences that are shown of those that do not hold for all points.
_SOME = 4


def notes(
    axes: Sequence[Axis],
    points: Sequence[Point | None],
    failed: Sequence[str],
    motion: Sequence[str],
    settle: int,
    orbits: dict[tuple[int, int], Orbit],
) -> tuple[str, ...]:
    """Return the warnings as sentences."""
    sentences = []
    count = sum(map(bool, failed))
    if count:
        sentences.append(f"{count} of {len(points)} points failed; the first: {next(filter(None, failed))}")
    if any(q.drift for q in points if q):
        sentences.append(
            "the torques do not balance at some points: the shafts drift off the prescribed rotation there"
        )
    # Laws that push a motion whose speed the drive keeps.
    takers: set[str] = set()
    for q in filter(None, points):
        B = q.system.B
        pushed = np.any(np.abs(q.system.carried @ B) > _ROUNDING * np.linalg.norm(B, axis=0), axis=0)
        own = q.system.own
        places = zip(own.forces.laws, *own.place, strict=True)
        takers |= {law.title for law, first, count in places if pushed[first : first + count].any()}
    if takers:
        sentences.append(
            f"the loads do not give the power that {' and '.join(sorted(takers))} takes: the drive makes up for it on all "
            "shafts, in proportion to their inertia, so that they keep their speed; with a drive at one end mean forces may be "
            "another by about that loss"
        )
    if any(q.rolling for q in points if q):
        sentences.append(
            "bearing cages never repeat with the teeth: a response that rolling elements drive shows as quasi-periodic"
        )
    unsettled = sum(kind == NOT_SETTLED for kind in motion)
    if unsettled:
        sentences.append(
            f"{unsettled} of {len(motion)} runs had not settled: ask for more periods (--discard, --sample)"
        )
    longer = [orbit.settled for orbit in orbits.values() if orbit.settled > settle]
    if longer:
        sentences.append(
            f"{len(longer)} of {len(motion)} runs settled for up to {max(longer)} periods, until their response type and their "
            "exponents agreed"
        )
    runs = len(motion) // max(1, len(points))
    sentences += _coexisting([set(motion[i * runs : (i + 1) * runs]) for i in range(len(points))])
    sentences += [
        f"{axis.address} has no effect on this model: all its points are the same" for axis in idle(axes, points)
    ]
    # Where the transient has not decayed when sampling begins, a response may repeat after several T because of it.
    several = {
        key: o for key, o in orbits.items() if period_in(motion[key[0] * runs + key[1]]) > 1 and o.growth.shape[1]
    }
    slow = sum(float(o.growth[:, 0].mean()) * o.settled > -_FORGOTTEN for o in several.values())
    if slow:
        sentences.append(
            f"{slow} of {len(several)} runs with 2T or longer have a transient that outlasts the periods that they settled: "
            "their period may change with more --discard"
        )
    return tuple(sentences)


def _coexisting(kinds: Sequence[set[str]]) -> list[str]:
    """Warnings where the runs of a point end in different responses, from the response types of each point."""
    told = [found - {NOT_SETTLED, FAILED} for found in kinds]
    several = [found for found in told if len(found) > 1]
    if not several:
        return []
    sentences = [
        f"different responses coexist at {len(several)} of {len(kinds)} points: --initial-conditions shows what share of the "
        "starts goes to each"
    ]
    # Chaos that a crisis has opened stays for thousands of periods, with the exponents of lasting chaos, and then leaves at once.
    transient = sum(CHAOTIC in found and any(map(repeats, found)) for found in several)
    if transient:
        sentences.append(
            f"at {transient} of them a chaotic response stands beside one that repeats: it may be a long transient that ends in "
            "that one; run it with ten times the --discard"
        )
    return sentences


def coarse_shafts(model: Model, elements: int | None) -> tuple[str, ...]:
    """A warning where shafts have the default discretisation, whose error a sweep does not estimate."""
    if elements is not None or not any(shaft.sections for shaft in model.shafts.values()):
        return ()
    return ("each shaft segment has one element of second order: compare with --elements 8, say",)


def short_of_modes(model: Model, points: Sequence[Point | None]) -> tuple[str, ...]:
    """A warning on each casing whose modes end too low for the point with the fastest excitation."""
    sound = [point for point in points if point is not None]
    fastest = max(sound, key=lambda point: point.system.w)
    return tuple(time_warnings(model, fastest.forces.laws, fastest.system.w / fastest.order))


def left_out_of(models: Sequence[tuple[str, ...]]) -> tuple[str, ...]:
    """What is left out of all models of a sweep; of some of them only, the first such sentences."""
    found = list(dict.fromkeys(text for texts in models for text in texts))
    common = [text for text in found if all(text in texts for texts in models)]
    some = [text for text in found if text not in common]
    shown = [f"of some points: {text}" for text in some[:_SOME]]
    more = [f"of some points: {len(some) - _SOME} more such sentences"] if len(some) > _SOME else []
    return (*common, *shown, *more)


def idle(axes: Sequence[Axis], points: Sequence[Point | None]) -> list[Axis]:
    """Axes along which all systems are the same to the last bit."""
    seen: dict[bytes, int] = {}
    own = []
    for q in points:
        if q is None:
            own.append(-1)
            continue
        # All that a point's motion depends on.
        system = q.system
        columns = system.columns
        parts = (
            system.K,
            system.D,
            system.load,
            system.B,
            system.rest,
            columns.kind,
            columns.mode,
            columns.stiffness,
            columns.damping,
            columns.clearance,
            columns.per_depth,
            columns.push,
            system.own.forces.parameters,
            np.array([system.w, system.turns]),
        )
        data = b"".join([*(np.ascontiguousarray(part).tobytes() for part in parts), q.shape])
        own.append(seen.setdefault(hashlib.blake2b(data).digest(), len(seen)))
    table = np.array(own).reshape([len(axis.values) for axis in axes])
    return [
        axis
        for at, axis in enumerate(axes)
        if len(set(axis.values)) > 1 and np.all(table == np.take(table, [0], axis=at))
    ]
