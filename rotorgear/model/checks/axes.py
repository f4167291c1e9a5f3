"""Checks of axes in space: shafts that have a place there, couplings on one axis."""

from __future__ import annotations

from collections.abc import Iterator

from rotorgear.errors import Problem
from rotorgear.model.checks.gears import degrees
from rotorgear.model.parts.frame import PARALLEL, Frame, angle_to
from rotorgear.model.parts.problems import missing
from rotorgear.model.parts.tables import Tables
from rotorgear.quantity import millimetres


def positions(model: Tables) -> Iterator[Problem]:
    """Where an axis is inclined all shafts have positions."""
    inclined = next((name for name, shaft in model.shafts.items() if shaft.frame.is_turned), None)
    for name, shaft in model.shafts.items() if inclined else ():
        if shaft.position is None and shaft.carrier is None:
            why = f"of its z = 0 in space: the axes of shaft '{inclined}' are not those of the model"
            yield missing(f"shafts.{name}.position", why)


def not_parallel(address: str, beside: Frame, wanted: str) -> Iterator[Problem]:
    """A problem unless another shaft, as a first one sees it, has a parallel axis that points the same way."""
    angle = angle_to(beside)
    if angle > PARALLEL:
        hint = (
            "shafts that point to opposite sides: turn the axis of one" if angle > 3.0 else "check axis of both shafts"
        )
        yield Problem(address, f"shafts whose axes are {degrees(angle)} apart", wanted, hint)


def coupled_points(model: Tables) -> Iterator[Problem]:
    """A coupling joins two points, and their shafts are coaxial and point the same way."""
    for name, coupling in model.couplings.items():
        address = f"couplings.{name}"
        first = model.shafts[coupling.from_shaft]
        second = model.shafts[coupling.to_shaft]
        if first is second and first.station(coupling.from_at) == second.station(coupling.to_at):
            yield Problem(address, "one and the same point twice", "two points")
        beside = first.frame.sees(second.frame)
        if inclined := list(not_parallel(address, beside, "coaxial shafts")):
            yield from inclined
            continue
        # Positions may be left out, and torsion alone knows no distances: nothing to compare then.
        if not model.has("bending") or first.origin is None or second.origin is None:
            continue
        distance = max(abs(x) for x in beside.at(second.station(coupling.to_at))[:2].tolist())
        if distance > 1e-9 + 1e-6 * max(first.length, second.length):
            apart = f"shafts whose axes are {millimetres(distance)} apart"
            hint = "a coupling joins shafts on one axis, a mesh joins parallel ones"
            yield Problem(address, apart, "coaxial shafts", hint)
