"""Checks of loads, of the operating point, and of the train that they drive: each given in one way, in balance."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from rotorgear.errors import Problem
from rotorgear.model.layout.layout import Layout
from rotorgear.model.layout.torque_flow import applied_torques
from rotorgear.model.parts.load import Load
from rotorgear.model.parts.operation import Operation, Point
from rotorgear.model.parts.problems import not_default, told
from rotorgear.model.parts.references import PartName
from rotorgear.model.parts.tables import Tables
from rotorgear.quantity import LARGEST

_TORQUES = ("kind", "torque", "power", "speed_power", "ripple", "ripple_order", "step_to", "step_at", "step_duration")
_FORCES = ("gear", "point", "order", "order_of", "frequency", "phase")
# Without one of these the train is not known as a whole, and a balance of torques would only repeat an earlier mistake.
_OF_THE_TRAIN = {"shafts", "gears", "meshes", "couplings", "operation", "loads"}


def loads(model: Tables) -> Iterator[Problem]:
    """Each load is of one kind, at one place, and varies in one way."""
    for name, load in model.loads.items():
        if load.is_torque:
            lone = load.kind is not None and load.shaft is None
            ways = "input or output; or give force = [x, y, z] or a moment"
            beside = ("only beside a force or a moment", "a torque has shaft, at and ripple")
            yield from told(
                f"loads.{name}",
                ("kind", load.kind is None, "", "missing", ways),
                ("shaft", lone, "", "missing", "the shaft that the torque acts on"),
                *((key, True, "", *beside) for key in not_default(load, _FORCES)),
            )
        else:
            point = model.points.get(load.point or "")
            yield from _force(f"loads.{name}", load, point)


def _force(address: str, load: Load, point: Point | None) -> Iterator[Problem]:
    on_casing = point is not None and point.on_casing is not None
    inside = point is not None and point.quantity is not None
    of_torques = not_default(load, _TORQUES)[:1]
    either = f"a torque of the train ({', '.join(_TORQUES)}), or a force and moment at a place, not both"
    places = [key for key in ("shaft", "gear", "point") if getattr(load, key) is not None]
    place = places[0] if len(places) == 1 else ""
    ways = [key for key in ("order", "frequency", "history") if getattr(load, key) is not None]
    beside = place not in ("", "shaft") and load.at is not None
    both = load.history is not None and (load.force is not None or load.moment is not None)
    columns = "one of them; the columns of the history are the forces"
    phase = load.phase and load.order is None and load.frequency is None
    lone = load.order_of is not None and load.order is None and not load.over_angle
    yield from told(
        address,
        *((key, True, "", either, "give two loads") for key in of_torques),
        ("", not place, " and ".join(places) or "no place", "one of shaft (with at), gear, point"),
        ("at", place == "shaft" and load.at is None, "", "missing", "required beside shaft: z on that shaft"),
        ("at", beside, f"at beside {place}", f"a {place} alone, which says where it is"),
        ("point", on_casing, f"'{load.point}', on a casing", "a point on a shaft", "frf takes it as an input"),
        ("point", inside, f"'{load.point}', which reads a load", "a point without quantity, where the force acts"),
        ("", both, "a history beside force or moment", columns),
        ("", len(ways) > 1, " and ".join(ways), "one of them, or none for a constant load"),
        ("phase", phase, "a phase", "beside an order or a frequency only", "a constant load has none"),
        ("order_of", lone, "a shaft", "beside an order, or a history over angle"),
    )


def loads_that_stand_still(layout: Layout) -> Iterator[Problem]:
    """An order, or a history over angle, of a shaft that nothing turns never varies."""
    for name, load in layout.model.loads.items():
        if load.is_torque or (load.order is None and not load.over_angle):
            continue
        shaft = load.order_of or layout.place(f"loads.{name}").shaft
        if layout.train.ratios.get(shaft, 0) == 0:
            still = f"an order or angle of shaft '{shaft}', which stands still"
            hint = "name one with order_of, or give a frequency"
            yield Problem(f"loads.{name}", still, "a shaft that turns", hint)


def operating_point(model: Tables, broken: Collection[PartName]) -> Iterator[Problem]:
    """Power or torque, not both; a power has a speed; what goes in comes out."""
    operation = model.operation
    speed = model.operating_speed
    given: dict[str, Operation | Load] = dict(model.parts_of("loads"))
    if operation:
        given["operation"] = operation
        loads_known = not any(table == "loads" for table, _ in broken)
        loaded = operation.power is not None or operation.torque is not None
        if loaded and operation.output_shaft is None and not model.loads and loads_known:
            why = "required beside power or torque: the shaft that takes it"
            yield Problem("operation.output_shaft", "", "missing", why)
    speed_known = ("operation", "") in broken or bool(speed and abs(speed) > 1.0 / LARGEST)
    value = "a power at standstill" if speed is not None else "a power without a speed"
    for address, part in given.items():
        both = part.torque is not None and part.power is not None
        alone = part.power is not None and not both and not speed_known
        yield from told(
            address,
            ("", both, "torque and power", "one of the two", "the speed joins them"),
            ("power", alone, value, "a speed under [operation]", "or give a torque"),
        )


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
