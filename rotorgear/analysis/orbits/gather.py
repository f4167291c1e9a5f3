"""The result of a continuation from its branches."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rotorgear.analysis.orbits.curves import Curve
from rotorgear.analysis.orbits.family import Range, SystemFamily
from rotorgear.analysis.orbits.follow import Branch
from rotorgear.results.motion.orbits import OrbitBranch, SpecialCurve, SpecialPoint
from rotorgear.solvers.periodic.cycle import Cycle
from rotorgear.solvers.periodic.special import Certified

# Multipliers of a point that are kept.
_MULTIPLIERS = 12


@dataclass(frozen=True)
class Contacts:
    """Places of the mesh contacts among the local displacements and laws, cos(beta_b), labels."""

    column: np.ndarray
    law: np.ndarray
    transverse: np.ndarray
    label: tuple[str, ...]


def contacts_of(family: SystemFamily) -> Contacts:
    """The mesh contacts of a family."""
    parts = family.parts
    law = np.array([i for i, part in enumerate(parts) if part.is_mesh], int)
    return Contacts(
        family.plant(0.0).forces.first[law],
        law,
        np.array([parts[i].transverse for i in law]),
        tuple(parts[i].label for i in law),
    )


def gathered(
    branches: list[Branch], contacts: Contacts, family: SystemFamily, along: Range, harmonics: int
) -> dict[str, object]:
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
            for name, value in read(cycle, contacts, harmonics, branch.periods).items():
                rows[name].append(value)
        for point in branch.special:
            cycle = branch.orbits.cycle(point.at.node.y, point.at.node.p)
            mu = point.at.multipliers[:_MULTIPLIERS]
            special.append(
                SpecialPoint(
                    point.kind,
                    along.at(point.at.node.p),
                    number,
                    cycle.period,
                    mu.real.copy(),
                    mu.imag.copy(),
                    cycle.extremes()[contacts.column] / contacts.transverse[:, None],
                )
            )
    fields: dict[str, object] = {name: np.array(values) for name, values in rows.items()}
    return fields | {"branches": tuple(listed), "special_points": tuple(special)}


def gathered_curves(curves: list[Curve], contacts: Contacts, ranges: Sequence[Range]) -> tuple[SpecialCurve, ...]:
    """The curves of special points as a result has them."""
    return tuple(
        SpecialCurve(
            curve.kind,
            curve.branch,
            np.array([ranges[0].at(point.p) for point in curve.points]),
            np.array([ranges[1].at(point.q) for point in curve.points]),
            np.array([point.cycle.period for point in curve.points]),
            np.array(
                [point.cycle.extremes()[contacts.column] / contacts.transverse[:, None] for point in curve.points]
            ),
            curve.ended,
        )
        for curve in curves
    )


def read(cycle: Cycle, contacts: Contacts, harmonics: int, periods: int) -> dict[str, object]:
    """What a result tells of one motion."""
    at = cycle.at
    side = at.side[:, contacts.law]
    F = at.F[:, contacts.column]
    return {
        "period": cycle.period,
        "approach_extremes": cycle.extremes()[contacts.column] / contacts.transverse[:, None],
        "peak_to_peak_transmission_error": np.ptp(cycle.watched[:, : len(contacts.column)], axis=0),
        "mean_force": F.mean(axis=0),
        "rms_force": F.std(axis=0),
        "largest_force": F.max(axis=0),
        "apart": (side == 0.0).mean(axis=0),
        "back": (side < 0.0).mean(axis=0),
        # Harmonics of the base period: of a motion of k periods every k-th.
        "force_harmonics": cycle.force[::periods][: harmonics + 1, contacts.column],
        "displacement_harmonics": cycle.displacement[::periods][: harmonics + 1, contacts.column],
    }


def padded(multipliers: np.ndarray) -> np.ndarray:
    """The largest multipliers, NaN where there are fewer."""
    out = np.full(_MULTIPLIERS, np.nan + 0j)
    kept = multipliers[:_MULTIPLIERS]
    out[: kept.size] = kept
    return out


def peak_to_peak(one: Certified, branch: Branch, contacts: Contacts) -> float:
    """Largest peak to peak of a contact's displacement."""
    ends = branch.orbits.cycle(one.node.y, one.node.p).extremes()[contacts.column]
    return float((ends[:, 1] - ends[:, 0]).max(initial=0.0))
