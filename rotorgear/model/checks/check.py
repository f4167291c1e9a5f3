"""Checks of a model as a whole, in stages.

A part with a problem is left out of the later stages, so that everything wrong in a file is reported at once, and nothing
that only follows from an earlier mistake.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from rotorgear.errors import Problem
from rotorgear.model.checks.casings import casings, gear_bodies
from rotorgear.model.checks.gears import gear_problems, inertia_problems
from rotorgear.model.checks.loads import loads, loads_that_stand_still, operating_point, train_problems
from rotorgear.model.checks.meshes import massless_gears, mesh_problems, mesh_settings
from rotorgear.model.checks.names import (
    PartName,
    duplicate_names,
    part_of,
    points,
    sound,
    unknown_materials,
    unknown_names,
    without,
)
from rotorgear.model.checks.sizes import (
    coupled_points,
    materials,
    matrices,
    motions,
    nonlinear_elements,
    sections,
    stations,
)
from rotorgear.model.layout.layout import Layout
from rotorgear.model.parts.tables import Tables


def find_problems(layout: Layout, broken: Iterable[PartName] = ()) -> list[Problem]:
    """List every problem of a model whose single fields are in order.

    Args:
        layout: of the model, without the parts whose own fields are wrong.
        broken: (table, name) of those parts; what refers to them is in order.
    """
    model = layout.model
    dropped = set(broken)
    found: list[Problem] = []
    if not model.shafts and not any(table == "shafts" for table, _ in dropped):
        found.append(Problem("shafts", "", "missing", "a model has at least one shaft, such as [shafts.input]"))
        dropped.add(("shafts", ""))
    found += _by_themselves(model, dropped)
    stages: tuple[Callable[[Layout], Iterable[Problem]], ...] = (
        lambda rest: [*stations(rest.model), *coupled_points(rest.model)],
        mesh_problems,
        lambda rest: [*inertia_problems(rest), *train_problems(rest, dropped), *loads_that_stand_still(rest)],
        massless_gears,
    )
    for stage in stages:
        # A material that is not there does not keep its part from being checked: `without` puts in the default.
        dropped |= {part_of(problem.address) for problem in found if not problem.address.endswith(".material")}
        # The layout of a sound model is the one that its analyses go on with.
        found += stage(Layout(without(model, dropped)) if found or dropped else layout)
    return found


def _by_themselves(model: Tables, broken: set[PartName]) -> Iterator[Problem]:
    """Checks that look at one part and at names only, so that they need no other part to be in order."""
    yield from motions(model)
    yield from duplicate_names(model, broken)
    yield from unknown_names(model, broken)
    yield from unknown_materials(model, broken)
    rest = sound(model, broken)
    yield from materials(rest)
    yield from sections(rest)
    yield from gear_problems(rest)
    yield from gear_bodies(rest)
    yield from matrices(rest)
    yield from casings(rest, broken)
    yield from nonlinear_elements(rest)
    yield from mesh_settings(rest)
    yield from points(rest)
    yield from loads(rest)
    yield from operating_point(rest, broken)
