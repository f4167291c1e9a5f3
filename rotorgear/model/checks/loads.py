"""Checks of loads, of the operating point, and of the train that they drive: each given in one way, in balance."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from rotorgear.errors import Problem
from rotorgear.model.checks.names import PartName
from rotorgear.model.layout.layout import Layout
from rotorgear.model.layout.torque_flow import applied_torques
from rotorgear.model.parts.load import Load
from rotorgear.model.parts.operation import Operation
from rotorgear.model.parts.tables import Tables
from rotorgear.quantity import LARGEST

_OF_TORQUES = (
    "kind",
    "torque",
    "power",
    "speed_power",
    "ripple",
    "ripple_order",
    "step_to",
    "step_at",
    "step_duration",
)
_OF_FORCES = ("gear", "point", "order", "order_of", "frequency", "phase")


def loads(model: Tables) -> Iterator[Problem]:
    """Each load is of one kind, at one place, and varies in one way."""
    for name, load in model.loads.items():
        address = f"loads.{name}"
        if load.is_torque:
            yield from _torque(address, load)
            continue
        given = [key for key in _OF_TORQUES if getattr(load, key) != Load.model_fields[key].default]
        if given:
            yield Problem(
                f"{address}.{given[0]}",
                "",
                f"a torque of the train ({', '.join(_OF_TORQUES)}), or a force and moment at a place, not both",
                "give two loads",
            )
        yield from _place(address, load)
        point = model.points.get(load.point or "")
        if point is not None and point.on_casing is not None:
            yield Problem(
                f"{address}.point", f"'{load.point}', on a casing", "a point on a shaft", "frf takes it as an input"
            )
        yield from _variation(address, load)


def _torque(address: str, load: Load) -> Iterator[Problem]:
    if load.kind is None:
        yield Problem(f"{address}.kind", "", "missing", "input or output; or give force = [x, y, z] or a moment")
    elif load.shaft is None:
        yield Problem(f"{address}.shaft", "", "missing", "the shaft that the torque acts on")
    for key in _OF_FORCES:
        if getattr(load, key) != Load.model_fields[key].default:
            yield Problem(
                f"{address}.{key}", "", "only beside a force or a moment", "a torque has shaft, at and ripple"
            )


def _place(address: str, load: Load) -> Iterator[Problem]:
    ways = [key for key in ("shaft", "gear", "point") if getattr(load, key) is not None]
    if len(ways) != 1:
        yield Problem(address, " and ".join(ways) or "no place", "one of shaft (with at), gear, point")
    elif ways == ["shaft"] and load.at is None:
        yield Problem(f"{address}.at", "", "missing", "required beside shaft: z on that shaft")
    elif ways != ["shaft"] and load.at is not None:
        yield Problem(f"{address}.at", f"at beside {ways[0]}", f"a {ways[0]} alone, which says where it is", "")


def _variation(address: str, load: Load) -> Iterator[Problem]:
    if load.history is not None and (load.force is not None or load.moment is not None):
        yield Problem(
            address, "a history beside force or moment", "one of them; the columns of the history are the forces"
        )
    ways = [key for key in ("order", "frequency", "history") if getattr(load, key) is not None]
    if len(ways) > 1:
        yield Problem(address, " and ".join(ways), "one of them, or none for a constant load")
    if load.phase and load.order is None and load.frequency is None:
        yield Problem(f"{address}.phase", "a phase", "beside an order or a frequency only", "a constant load has none")
    over_angle = load.history is not None and load.history.over == "angle"
    if load.order_of is not None and load.order is None and not over_angle:
        yield Problem(f"{address}.order_of", "a shaft", "beside an order, or a history over angle", "")


def loads_that_stand_still(layout: Layout) -> Iterator[Problem]:
    """An order, or a history over angle, of a shaft that nothing turns never varies."""
    for name, load in layout.model.loads.items():
        if load.is_torque:
            continue
        shaft = load.order_of or layout.place(f"loads.{name}").shaft
        over_angle = load.history is not None and load.history.over == "angle"
        if (load.order is not None or over_angle) and layout.train.ratios.get(shaft, 0) == 0:
            yield Problem(
                f"loads.{name}",
                f"an order or angle of shaft '{shaft}', which stands still",
                "a shaft that turns",
                "name one with order_of, or give a frequency",
            )


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
