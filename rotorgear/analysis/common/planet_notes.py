"""What linear analyses leave out of planets that go round, and of which planets modes have no classes."""

from __future__ import annotations

from collections.abc import Iterator

from rotorgear.note import Note
from rotorgear.system.planets import turning_carriers
from rotorgear.system.system import System


def planet_notes(system: System, speed: float | None) -> Iterator[Note]:
    """Of each carrier that turns at a speed of the reference shaft in rad/s, what is neglected (`system/planets.py`)."""
    model = system.model
    if speed and system.is_seen_from_carrier:
        # All of these turn with one carrier.
        carrier = turning_carriers(system.layout)[0].carrier
        why = (
            "their coefficients are constant only seen from their carrier, as frequencies and senses of whirl are told"
        )
        yield Note(
            f"carriers.{carrier}", "modes in axes at rest: planets are two, differ or stand at unequal angles", why
        )
    for planets in turning_carriers(system.layout) if speed else ():
        address = f"carriers.{planets.carrier}"
        if model.operation is not None and (model.operation.torque or model.operation.power):
            what = "what the torque brings where pins and flanks turn with the carrier"
            yield Note(address, what, "terms of meshes and of pins, which cancel only together")
        if model.has("bending") and any(model.shafts[planet].sections for planet in planets.planets):
            what = "stiffness by the centrifugal load in the planets' own shafts"
            yield Note(address, what, "the load acts on pins and carrier")


def class_notes(system: System) -> Iterator[Note]:
    """Of each carrier whose planets are no pattern round the circle of pins, that its modes have no classes."""
    carriers = {planets.carrier: planets.part for planets in system.layout.planets}
    for carrier, part in carriers.items():
        if not part.is_regular and part.planets != 2:
            why = "its planets are not two or more at equal angles"
            yield Note(f"carriers.{carrier}", "classes of modes", why)
