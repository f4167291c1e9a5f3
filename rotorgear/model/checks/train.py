"""Checks of speeds and torques: the operating point, loops of the train, the balance of power."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from rotorgear.errors import Problem
from rotorgear.model.checks.references import PartName
from rotorgear.model.layout.applied_torques import applied_torques
from rotorgear.model.layout.layout import Layout
from rotorgear.model.parts.load import Load
from rotorgear.model.parts.operation import Operation
from rotorgear.model.parts.tables import Tables
from rotorgear.quantity import LARGEST

# Without one of these the train is not known as a whole, and a balance of torques would only repeat an earlier mistake.
_OF_THE_TRAIN = {"shafts", "gears", "meshes", "couplings", "operation", "loads"}


def operating_point(model: Tables, broken: Collection[PartName]) -> Iterator[Problem]:
    """Power or torque, not both; a power has a speed; what goes in comes out."""
    loads_known = not any(table == "loads" for table, _ in broken)
    operation = model.operation
    if operation:
        loaded = operation.power is not None or operation.torque is not None
        if loaded and operation.output_shaft is None and not model.loads and loads_known:
            yield Problem(
                "operation.output_shaft", "", "missing", "required beside power or torque: the shaft that takes it"
            )
    speed_known = (
        bool(operation and operation.speed and abs(operation.speed) > 1.0 / LARGEST) or ("operation", "") in broken
    )
    given: dict[str, Operation | Load] = {f"loads.{name}": load for name, load in model.loads.items()}
    if operation:
        given["operation"] = operation
    for address, part in given.items():
        if part.torque is not None and part.power is not None:
            yield Problem(address, "torque and power", "one of the two", "the speed joins them")
        elif part.power is not None and not speed_known:
            value = "a power at standstill" if operation and operation.speed is not None else "a power without a speed"
            yield Problem(f"{address}.power", value, "a speed under [operation]", "or give a torque")


def train_problems(layout: Layout, broken: Collection[PartName]) -> Iterator[Problem]:
    """Loops with two ratios, speed ratios against the train, torques out of balance."""
    model = layout.model
    if not model.shafts or model.reference_shaft not in model.shafts:
        return
    problems = layout.train_problems
    if _OF_THE_TRAIN.isdisjoint(table for table, _ in broken):
        yield from problems or applied_torques(layout)[1]
    else:  # a loop that is there has its two ratios; a shaft's own ratio may be wrong only because of the mistake before
        yield from (problem for problem in problems if not problem.address.startswith("shafts."))
