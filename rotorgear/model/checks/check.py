"""Checks of a model as a whole, in stages.

A part with a problem is left out of the later stages, so that everything wrong in a file is reported at once, and nothing
that only follows from an earlier mistake.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from rotorgear.errors import Problem
from rotorgear.model.checks import axes, names, sizes
from rotorgear.model.checks.casings import casings, gear_bodies
from rotorgear.model.checks.gears import gear_problems, inertia_problems
from rotorgear.model.checks.loads import loads, loads_that_stand_still, operating_point, train_problems
from rotorgear.model.checks.meshes import massless_gears, mesh_problems, mesh_settings
from rotorgear.model.checks.names import PartName
from rotorgear.model.layout.layout import Layout


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
    # First the checks that look at one part and at names only, so that they need no other part to be in order.
    rest = names.sound(model, dropped)
    found += [
        *sizes.motions(model),
        *names.duplicate_names(model, dropped),
        *names.unknown_names(model, dropped),
        *names.unknown_materials(model, dropped),
        *sizes.materials(rest),
        *sizes.sections(rest),
        *axes.positions(rest),
        *gear_problems(rest),
        *gear_bodies(rest),
        *sizes.matrices(rest),
        *casings(rest, dropped),
        *sizes.nonlinear_elements(rest),
        *mesh_settings(rest),
        *names.points(rest),
        *loads(rest),
        *operating_point(rest, dropped),
    ]
    stages: tuple[Callable[[Layout], Iterable[Problem]], ...] = (
        lambda rest: [*sizes.stations(rest.model), *axes.coupled_points(rest.model)],
        mesh_problems,
        lambda rest: [*inertia_problems(rest), *train_problems(rest, dropped), *loads_that_stand_still(rest)],
        massless_gears,
    )
    for stage in stages:
        # A material that is not there does not keep its part from being checked: `without` puts in the default.
        dropped |= {names.part_of(problem.address) for problem in found if not problem.address.endswith(".material")}
        # The layout of a sound model is the one that its analyses go on with.
        found += stage(Layout(names.without(model, dropped)) if found or dropped else layout)
    return found
