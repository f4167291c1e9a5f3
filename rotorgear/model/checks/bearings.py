"""What bearings lack that a file may leave out: measured elements, and somebody who takes the push that the others do not."""

from __future__ import annotations

import math
from collections.abc import Iterator

from rotorgear.model.layout.layout import Layout
from rotorgear.note import Note


def estimated(layout: Layout) -> Iterator[Note]:
    """Yield a fact on every bearing whose rolling elements follow from its boundary dimensions."""
    for name, bearing in layout.model.bearings.items():
        for kind, geometry in bearing.geometries.items():
            what, why, value = geometry.estimate
            if what:
                yield Note(f"bearings.{name}.{kind}", what, why, value)


def one_sided(layout: Layout) -> Iterator[Note]:
    """Yield a fact on every shaft whose bearings take its push to one side only, while nothing else holds it along its axis."""
    model = layout.model
    if not model.has("axial"):
        return
    gravity = (model.operation and model.operation.gravity) or (0.0, 0.0, 0.0)
    for shaft, part in model.shafts.items():
        own = {name: bearing for name, bearing in model.bearings.items() if bearing.shaft == shaft}
        taken = {name: bearing.geometry.takes for name, bearing in own.items() if bearing.geometry}
        sides = {side for takes in taken.values() for side in takes}
        if len(sides) != 1 or shaft in _held_otherwise(layout):
            continue
        sign = 1.0 if "+z" in sides else -1.0
        # The weight of an upright shaft keeps it where its bearing carries.
        if sign * float(part.frame.axes[:, 2] @ gravity) > 0.0:
            continue
        side, other = ("+z", "-z") if sign > 0.0 else ("-z", "+z")
        pressing = [name for name, takes in taken.items() if takes]
        rolling = own[pressing[-1]].rolling
        remedy = f"give one that acts against {other}"
        if rolling:
            turned = f"'{-math.degrees(rolling.contact_angle):.6g} deg'"
            remedy = f"turn one round, such as bearings.{pressing[-1]}.rolling.contact_angle = {turned}"
        names = " and ".join(f"bearings.{name}" for name in pressing)
        yield Note(
            f"shafts.{shaft}",
            f"nothing takes its push towards {other}",
            f"{names} {'take' if len(pressing) > 1 else 'takes'} one towards {side} only; {remedy}",
        )


def _held_otherwise(layout: Layout) -> set[str]:
    """Shafts that something holds along the axis to both sides: a stiffness, a fixed motion, a coupling or a law of its own."""
    model = layout.model
    held = {bearing.shaft for bearing in model.bearings.values() if not bearing.geometry or bearing.stiffness}
    held |= {support.shaft for support in model.supports.values()}
    held |= {name for coupling in model.couplings.values() for name in (coupling.from_shaft, coupling.to_shaft)}
    return held | {
        name
        for element in model.nonlinear_elements.values()
        if "z" in element.directions
        for name in (element.shaft, element.to_shaft)
        if name
    }
