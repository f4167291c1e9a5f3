"""The result of a continuation from its branches."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rotorgear.analysis.orbits.curves import Curve
from rotorgear.analysis.orbits.family import Range, SystemFamily
from rotorgear.analysis.orbits.follow import Branch
from rotorgear.analysis.orbits.places import Told
from rotorgear.analysis.orbits.refined import refined
from rotorgear.results.orbits import OrbitBranch, SpecialCurve, SpecialPoint
from rotorgear.solvers.periodic.cycle import Cycle
from rotorgear.solvers.periodic.plant import Plant
from rotorgear.solvers.periodic.samples import answered
from rotorgear.solvers.time.statistics import MotionStatistics, PeriodicCurve, compared, over_period

# Multipliers of a point that are kept.
_MULTIPLIERS = 12
# The finer solution is better by far, and its difference is the error; where that passes through zero, a share of the others'.
_LUCK = 0.03


def gathered(
    branches: list[Branch], told: Told, family: SystemFamily, along: Range, harmonics: int
) -> dict[str, object]:
    """The fields of a result that belong to points and special points.

    The error of a statistic is its difference from that of the finer solution at the same value of the parameter.
    """
    contacts = told.contacts
    points: list[dict[str, object]] = []
    special = []
    listed = []
    for number, branch in enumerate(branches):
        listed.append(OrbitBranch(branch.name, branch.periods, branch.ended))
        orbits = branch.orbits
        finer = orbits.finer()
        for one in branch.nodes:
            node = one.node
            plant = family.plant(node.p)
            cycle = orbits.cycle(node.y, node.p)
            found = statistics_of(cycle, plant, told)
            better = refined(orbits, finer, node) if contacts.label else None
            error = np.full(found.values.shape, np.nan)
            if better is not None:
                exact = statistics_of(finer.cycle(better, node.p), plant, told)
                error = compared(found.values, exact.values, found.scales, 1.0, _LUCK)
            approach, moved = _extremes(cycle, told)
            # Harmonics of the base period: of a motion of k periods every k-th.
            force = cycle.force[:: branch.periods][: harmonics + 1]
            displacement = cycle.displacement[:: branch.periods][: harmonics + 1]
            points.append(
                {
                    "branch": number,
                    "value": along.at(node.p),
                    "period": cycle.period,
                    "stable": one.stable,
                    "multipliers": padded(one.multipliers),
                    "approach_extremes": approach,
                    "peak_to_peak_transmission_error": np.ptp(found.transmission_error, axis=1),
                    "mean_force": found.force.mean,
                    "rms_force": found.force.rms,
                    "largest_force": found.force.largest,
                    "apart": found.shares[:, 1],
                    "back": found.shares[:, 2],
                    "statistics_error": error,
                    "force_harmonics": force[:, contacts.column],
                    "displacement_harmonics": displacement[:, contacts.column],
                    "place_extremes": moved,
                    "place_harmonics": displacement[:, told.places.column],
                }
            )
        for point in branch.special:
            cycle = branch.orbits.cycle(point.at.node.y, point.at.node.p)
            mu = point.at.multipliers[:_MULTIPLIERS]
            approach, moved = _extremes(cycle, told)
            special.append(
                SpecialPoint(
                    point.kind,
                    along.at(point.at.node.p),
                    number,
                    cycle.period,
                    mu.real.copy(),
                    mu.imag.copy(),
                    approach,
                    moved,
                )
            )
    fields: dict[str, object] = {name: np.array([point[name] for point in points]) for name in points[0]}
    return fields | {"branches": tuple(listed), "special_points": tuple(special)}


def gathered_curves(curves: list[Curve], told: Told, ranges: Sequence[Range]) -> tuple[SpecialCurve, ...]:
    """The curves of special points as a result has them."""
    found = []
    for curve in curves:
        extremes = [_extremes(point.cycle, told) for point in curve.points]
        found.append(
            SpecialCurve(
                curve.kind,
                curve.branch,
                np.array([ranges[0].at(point.p) for point in curve.points]),
                np.array([ranges[1].at(point.q) for point in curve.points]),
                np.array([point.cycle.period for point in curve.points]),
                np.array([approach for approach, _ in extremes]),
                curve.ended,
                np.array([moved for _, moved in extremes]),
            )
        )
    return tuple(found)


def _extremes(cycle: Cycle, told: Told) -> tuple[np.ndarray, np.ndarray]:
    """Least and largest approach of the contacts, (c, 2), and displacements of the places, (k, 2)."""
    both = cycle.extremes()
    return both[told.contacts.column] / told.contacts.transverse[:, None], both[told.places.column]


def statistics_of(cycle: Cycle, plant: Plant, told: Told) -> MotionStatistics:
    """Statistics of the contacts over a period, what is between its instants included."""
    contacts = told.contacts

    def laws(t: np.ndarray, d: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        at = answered(t, d, v, plant.forces, plant.speed)
        return at.F[:, contacts.column], at.side[:, contacts.law]

    force, shares = over_period(PeriodicCurve(cycle.period, cycle.at.d, cycle.at.v), laws)
    watched = PeriodicCurve(cycle.period, cycle.watched, cycle.watched_rate).extremes()
    return MotionStatistics(force, shares, watched[: len(contacts.label)], _extremes(cycle, told)[0])


def padded(multipliers: np.ndarray) -> np.ndarray:
    """The largest multipliers, NaN where there are fewer."""
    out = np.full(_MULTIPLIERS, np.nan + 0j)
    kept = multipliers[:_MULTIPLIERS]
    out[: kept.size] = kept
    return out
