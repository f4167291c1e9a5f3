"""The result of a continuation from its branches."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rotorgear.analysis.orbits.curves import Curve
from rotorgear.analysis.orbits.family import Range
from rotorgear.analysis.orbits.follow import Branch
from rotorgear.analysis.orbits.places import Told
from rotorgear.results.motion.orbits import OrbitBranch, SpecialCurve, SpecialPoint
from rotorgear.solvers.periodic.cycle import Cycle

# Multipliers of a point that are kept.
_MULTIPLIERS = 12


def gathered(branches: list[Branch], told: Told, along: Range, harmonics: int) -> dict[str, object]:
    """The fields of a result that belong to points and special points."""
    rows: dict[str, list[object]] = {
        name: []
        for name in (
            "branch",
            "value",
            "period",
            "stable",
            "multipliers",
            "approach_extremes",
            "peak_to_peak_transmission_error",
            "mean_force",
            "rms_force",
            "largest_force",
            "apart",
            "back",
            "force_harmonics",
            "displacement_harmonics",
            "place_extremes",
            "place_harmonics",
        )
    }
    special = []
    listed = []
    for number, branch in enumerate(branches):
        listed.append(OrbitBranch(branch.name, branch.periods, branch.ended))
        for one in branch.nodes:
            cycle = branch.orbits.cycle(one.node.y, one.node.p)
            rows["branch"].append(number)
            rows["value"].append(along.at(one.node.p))
            rows["stable"].append(one.stable)
            rows["multipliers"].append(padded(one.multipliers))
            for name, value in read(cycle, told, harmonics, branch.periods).items():
                rows[name].append(value)
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
    fields: dict[str, object] = {name: np.array(values) for name, values in rows.items()}
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


def read(cycle: Cycle, told: Told, harmonics: int, periods: int) -> dict[str, object]:
    """What a result tells of one motion."""
    contacts = told.contacts
    at = cycle.at
    side = at.side[:, contacts.law]
    F = at.F[:, contacts.column]
    approach, moved = _extremes(cycle, told)
    # Harmonics of the base period: of a motion of k periods every k-th.
    force = cycle.force[::periods][: harmonics + 1]
    displacement = cycle.displacement[::periods][: harmonics + 1]
    return {
        "period": cycle.period,
        "approach_extremes": approach,
        "peak_to_peak_transmission_error": np.ptp(cycle.watched[:, : len(contacts.column)], axis=0),
        "mean_force": F.mean(axis=0),
        "rms_force": F.std(axis=0),
        "largest_force": F.max(axis=0),
        "apart": (side == 0.0).mean(axis=0),
        "back": (side < 0.0).mean(axis=0),
        "force_harmonics": force[:, contacts.column],
        "displacement_harmonics": displacement[:, contacts.column],
        "place_extremes": moved,
        "place_harmonics": displacement[:, told.places.column],
    }


def padded(multipliers: np.ndarray) -> np.ndarray:
    """The largest multipliers, NaN where there are fewer."""
    out = np.full(_MULTIPLIERS, np.nan + 0j)
    kept = multipliers[:_MULTIPLIERS]
    out[: kept.size] = kept
    return out
