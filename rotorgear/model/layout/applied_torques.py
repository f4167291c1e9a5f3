"""The torques that drive and load the train, from the operating point and the loads, balanced in power."""

from __future__ import annotations

from dataclasses import dataclass

from rotorgear.errors import Problem
from rotorgear.model.layout.layout import Layout
from rotorgear.model.parts.load import Load


@dataclass(frozen=True)
class AppliedTorque:
    """A torque on a shaft: `torque` in N m about +z, at `z` in m."""

    name: str
    shaft: str
    z: float
    torque: float


def applied_torques(layout: Layout, direction: int | None = None) -> tuple[list[AppliedTorque], list[Problem]]:
    """Return the torques that drive and load the train, balanced in power, and the problems where they can't be.

    Args:
        layout: of the model.
        direction: +1 or -1, sense in which the reference shaft turns; None: that of the operating speed. Torques are those of
            the positive sense, and turn with it; moments from outside stay where they are, and have the sign that this asks for.
    """
    loads, problems = _loads(layout)
    operation = layout.model.operation
    found = _moments(layout, direction)
    open_ends: list[tuple[str, Load]] = []
    for name, load in loads.items():
        torque = load.torque
        if load.power is not None and operation is not None and operation.speed:
            torque = load.power / abs(operation.speed * layout.train.ratio(load.on_shaft))
        if torque is None:  # an open end, which takes the rest
            open_ends.append((name, load))
        else:
            sign = layout.train.sense(load.on_shaft) * (1 if load.kind == "input" else -1)
            found.append(AppliedTorque(name, *layout.load_place(load), sign * torque))
    if problems or not (loads or found):
        return found, problems
    return _balanced(layout, found, open_ends)


def _moments(layout: Layout, direction: int | None) -> list[AppliedTorque]:
    """Constant moments about z of loads from outside on shafts that turn: they take part in the balance."""
    sense = direction or layout.direction
    return [
        AppliedTorque(load.address, *place, sense * float(load.constant[5]) / len(load.places))
        for load in layout.external_loads
        for place in load.places
        if load.constant[5] and load.in_train
    ]


def _loads(layout: Layout) -> tuple[dict[str, Load], list[Problem]]:
    """Merge [operation] and [loads]; loads on shafts that are not driven are problems."""
    model = layout.model
    loads = {f"loads.{name}": load for name, load in model.loads.items() if load.is_torque}
    operation = model.operation
    if operation and (operation.power is not None or operation.torque is not None):
        loads["operation"] = Load(
            shaft=operation.input_shaft, kind="input", torque=operation.torque, power=operation.power
        )
        if operation.output_shaft:
            loads["operation.output_shaft"] = Load(shaft=operation.output_shaft, kind="output")
    problems = [
        Problem(
            name,
            f"a load on shaft '{load.shaft}', which stands still",
            "a shaft that the train drives",
            "no mesh or coupling leads to it from the input shaft",
        )
        for name, load in loads.items()
        if layout.train.ratios[load.on_shaft] == 0
    ]
    return ({} if problems else loads), problems


def _balanced(
    layout: Layout, found: list[AppliedTorque], open_ends: list[tuple[str, Load]]
) -> tuple[list[AppliedTorque], list[Problem]]:
    """Close the balance of power of each connected part of the train with its one open end, or refuse."""
    train = layout.train
    problems: list[Problem] = []
    for group in sorted(
        {train.group[item.shaft] for item in found} | {train.group[load.on_shaft] for _, load in open_ends}
    ):
        given = [item for item in found if train.group[item.shaft] == group]
        ends = [(name, load) for name, load in open_ends if train.group[load.on_shaft] == group]
        excess = sum(item.torque * train.ratio(item.shaft) for item in given)
        scale = max((abs(item.torque * train.ratio(item.shaft)) for item in given), default=0.0)
        if len(ends) > 1:
            names = ", ".join(name for name, _ in ends)
            problems.append(
                Problem("loads", f"{names} without torque or power", "at most one of them: it takes the rest")
            )
        elif ends:
            name, load = ends[0]
            torque = -excess / train.ratio(load.on_shaft)
            wanted = train.sense(load.on_shaft) * (1 if load.kind == "input" else -1)
            if torque * wanted < 0.0:
                text = f"to balance the other loads this {load.kind} would need {abs(torque):.6g} N m against its sense"
                other = "output" if load.kind == "input" else "input"
                problems.append(Problem(name, "", text, f"change the other torques, or make it an {other}"))
            found.append(AppliedTorque(name, *layout.load_place(load), torque))
        elif abs(excess) > 1e-6 * scale:
            problems.append(
                Problem(
                    "loads",
                    f"torques that leave {excess:.6g} N m, taken to the speed of shaft '{train.reference}'",
                    "torques that balance",
                    "leave the torque of one output out and it takes the rest",
                )
            )
    return found, problems
