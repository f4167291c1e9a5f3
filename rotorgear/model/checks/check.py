"""Checks of a model as a whole, in stages.

A part with a problem is left out of the later stages, so that everything wrong in a file is reported at once, and nothing
that only follows from an earlier mistake.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from rotorgear.errors import Problem
from rotorgear.model.checks import axes, names, planets, sizes
from rotorgear.model.checks.casings import casings, gear_bodies
from rotorgear.model.checks.gears import gear_problems, inertia_problems
from rotorgear.model.checks.internal_loads import cut_places, load_points
from rotorgear.model.checks.loads import loads, loads_that_stand_still, operating_point, train_problems
from rotorgear.model.checks.meshes import massless_gears, mesh_problems, mesh_settings
from rotorgear.model.layout.carriers import repeated, says_less
from rotorgear.model.layout.layout import Layout
from rotorgear.model.parts.references import PartName
from rotorgear.model.parts.tables import Tables


def find_problems(
    model: Tables,
    overrides: Mapping[str, Mapping[str, Any]] | None = None,
    broken: Iterable[PartName] = (),
    layout: Layout | None = None,
) -> list[Problem]:
    """List every problem of a model whose single fields are in order.

    Args:
        model: the parts as the file has them, without those whose own fields are wrong.
        overrides: what single planets have otherwise.
        broken: (table, name) of the parts that were taken out; what refers to them is in order.
        layout: of the whole gearbox, where all parts are sound.
    """
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
        *planets.on_carriers(rest),
        *gear_problems(rest),
        *gear_bodies(rest),
        *sizes.matrices(rest),
        *casings(rest, dropped),
        *sizes.nonlinear_elements(rest),
        *mesh_settings(rest),
        *names.points(rest),
        *load_points(rest),
        *loads(rest),
        *operating_point(rest, dropped),
    ]
    stages: tuple[Callable[[Layout], Iterable[Problem]], ...] = (
        lambda rest: [*sizes.stations(rest.model), *axes.coupled_points(rest.model)],
        lambda rest: [*mesh_problems(rest), *cut_places(rest)],
        lambda rest: [*inertia_problems(rest), *train_problems(rest, dropped), *loads_that_stand_still(rest)],
        lambda rest: [*massless_gears(rest), *planets.assembled(rest)],
    )
    if says_less(model):
        dropped |= _parts_of(found)
        found += repeated(names.without(model, dropped), overrides)[1]
    for stage in stages:
        # A material that is not there does not keep its part from being checked: `without` puts in the default.
        dropped |= _parts_of(found)
        # The layout of a sound model is the one that its analyses go on with.
        sound = layout if layout is not None and not (found or dropped) else None
        told = stage(sound or Layout(repeated(names.without(model, dropped), overrides)[0]))
        found += planets.once(told) if model.carriers else told
    return found


def _parts_of(problems: Iterable[Problem]) -> set[PartName]:
    """The parts that problems are about, but for those of materials."""
    return {names.part_of(problem.address) for problem in problems if not problem.address.endswith(".material")}
