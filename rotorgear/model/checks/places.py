"""Checks of places: parts stand on their shafts, couplings join coaxial points."""

from __future__ import annotations

from collections.abc import Iterator

from rotorgear.errors import Problem
from rotorgear.model.checks.references import ON_SHAFTS
from rotorgear.model.parts.tables import Tables
from rotorgear.quantity import millimetres


def stations(model: Tables) -> Iterator[Problem]:
    """Every part stands on its shaft."""
    for table in ON_SHAFTS:
        for name, part in getattr(model, table).items():
            offset = part.helix_offset if table == "gears" and part.node_count == 2 else 0.0
            yield from _station(model, f"{table}.{name}.at", part.shaft, part.at, offset)
    for name, coupling in model.couplings.items():
        yield from _station(model, f"couplings.{name}.from_at", coupling.from_shaft, coupling.from_at)
        yield from _station(model, f"couplings.{name}.to_at", coupling.to_shaft, coupling.to_at)
    for name, element in model.nonlinear_elements.items():
        if element.to_shaft is not None:
            at = element.at if element.to_at is None else element.to_at
            yield from _station(model, f"nonlinear_elements.{name}.to_at", element.to_shaft, at)
    for table in ("loads", "unbalances", "points"):
        for name, part in getattr(model, table).items():
            if part.shaft is not None and part.at is not None:
                yield from _station(model, f"{table}.{name}.at", part.shaft, part.at)


def _station(model: Tables, address: str, shaft: str, at: float | str, offset: float = 0.0) -> Iterator[Problem]:
    part = model.shafts[shaft]
    z = part.station(at)
    slack = 1e-9 * max(part.length, abs(part.start), 1e-6)
    if part.start - slack <= z - offset and z + offset <= part.end + slack:
        return
    run = f"shaft '{shaft}', which runs from {millimetres(part.start)} to {millimetres(part.end)}"
    if not part.sections:
        run = f"shaft '{shaft}', which has no sections and is one point at {millimetres(part.start)}"
    if offset:
        value = f"{millimetres(z)} with helices at {millimetres(z - offset)} and {millimetres(z + offset)}"
        yield Problem(address, value, f"both helices on {run}", "nodes = 1 puts the whole gear at one place")
    else:
        yield Problem(address, millimetres(z), f"a place on {run}")


def coupled_points(model: Tables) -> Iterator[Problem]:
    """A coupling joins two points, and their shafts are coaxial."""
    for name, coupling in model.couplings.items():
        address = f"couplings.{name}"
        first = model.shafts[coupling.from_shaft]
        second = model.shafts[coupling.to_shaft]
        one_shaft = coupling.from_shaft == coupling.to_shaft
        if one_shaft and first.station(coupling.from_at) == second.station(coupling.to_at):
            yield Problem(address, "one and the same point twice", "two points")
        # Positions may be left out, and torsion alone knows no axes: nothing to compare then.
        if not model.has("bending") or first.position is None or second.position is None:
            continue
        distance = max(abs(a - b) for a, b in zip(first.position, second.position, strict=True))
        if distance > 1e-9 + 1e-6 * max(first.length, second.length):
            apart = f"shafts whose axes are {millimetres(distance)} apart"
            hint = "a coupling joins shafts on one axis, a mesh joins parallel ones"
            yield Problem(address, apart, "coaxial shafts", hint)
