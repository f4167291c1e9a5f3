"""Checks of single parts: materials, sections, 6 x 6 matrices, force laws, and that each part stands on its shaft."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice, pairwise

from rotorgear.errors import AnalysisError, Problem
from rotorgear.model.parts.fields import DOF_NAMES, RIGID
from rotorgear.model.parts.gear import Gear
from rotorgear.model.parts.problems import not_default, shown, told
from rotorgear.model.parts.references import ON_SHAFTS
from rotorgear.model.parts.shaft import Section
from rotorgear.model.parts.supports import (
    Bearing,
    DampingMatrix,
    StiffnessMatrix,
    TableRow,
    element_law,
    law_parameters,
)
from rotorgear.model.parts.tables import Tables
from rotorgear.quantity import RPM_PER_RAD_S, did_you_mean, millimetres, nearest

_OF_LAW = "a law gives way, and the stiffness stands for it; leave one of the two out"


def motions(model: Tables) -> Iterator[Problem]:
    """The model has at least one motion."""
    if not model.motions or len(set(model.motions)) < len(model.motions):
        yield Problem("motions", shown(list(model.motions)), "some of bending, axial, torsion, each once")


def materials(model: Tables) -> Iterator[Problem]:
    """A material has one of nu and G beside E, and nu is one of a stable material."""
    for name, material in model.materials.items():
        given = (material.poisson_ratio is not None, material.shear_modulus is not None)
        both = "poisson_ratio and shear_modulus"
        nu = f"a Poisson's ratio of {material.nu:.4g}"
        follows = "it follows from nu = E/2G - 1" if material.shear_modulus else ""
        yield from told(
            f"materials.{name}",
            ("", not any(given), "neither poisson_ratio nor shear_modulus", "one of them"),
            ("", all(given), both, "one of them", "the other follows from E = 2 G (1 + nu)"),
            ("", sum(given) == 1 and not -1.0 < material.nu < 0.5, nu, "one between -1 and 0.5", follows),
        )


def sections(model: Tables) -> Iterator[Problem]:
    """Every section has a wall, for the stiffness and for the mass; the first mistake of each is told."""
    for name, shaft in model.shafts.items():
        for number, section in enumerate(shaft.sections):
            yield from islice(_section(f"shafts.{name}.sections[{number}]", section), 1)


def _section(address: str, section: Section) -> Iterator[Problem]:
    outer, bore, outer_end, bore_end = section.stiffness_diameters()
    below = "less than the outer diameter there, "
    keeps = "" if section.bore_end is not None else "it keeps the bore of the left end: give bore_end"
    yield from told(
        address,
        ("bore", bore >= outer, millimetres(bore), below + millimetres(outer)),
        ("bore_end", bore_end >= outer_end, millimetres(bore_end), below + millimetres(outer_end), keeps),
    )
    for key, base in (("mass_outer_diameter_end", "mass_outer_diameter"), ("mass_bore_end", "mass_bore")):
        if getattr(section, key) is not None and getattr(section, base) is None:
            yield Problem(f"{address}.{base}", "", "missing", f"required beside {key}")
    outer, bore, outer_end, bore_end = section.mass_diameters()
    for inner, room in ((bore, outer), (bore_end, outer_end)):
        if inner > room:
            text = f"at most the outer diameter that counts for the mass there, {millimetres(room)}"
            yield Problem(f"{address}.mass_bore", millimetres(inner), text)


def matrices(model: Tables) -> Iterator[Problem]:
    """Bearings, supports and couplings have what they need, each entry given once."""
    for name, bearing in model.bearings.items():
        yield from _bearing(f"bearings.{name}", bearing)
    for name, support in model.supports.items():
        yield from six_by_six(f"supports.{name}", support.stiffness, support.damping, "hold it by fixed = ['x', 'y']")
        if not (support.stiffness or support.damping or support.fixed):
            yield Problem(f"supports.{name}", "neither stiffness, damping nor fixed", "at least one of them")
    for name, element in model.nonlinear_elements.items():
        address = f"nonlinear_elements.{name}"
        wanted = "a stiffness beside it, or neither: then the law's own tangents serve"
        lone = element.damping is not None and element.stiffness is None
        yield from told(
            address,
            ("", element.stiffness is not None and element.table, "stiffness and table", "one of the two"),
            ("damping", lone, "damping without stiffness", wanted),
        )
        yield from six_by_six(address, element.stiffness, element.damping, _OF_LAW)
        yield from _table(address, element.table)
    for name, coupling in model.couplings.items():
        given = not_default(coupling, ("stiffness", "damping"))
        wanted = "a stiffness, or rigid = true"
        yield from told(
            f"couplings.{name}",
            ("stiffness", not (coupling.rigid or coupling.stiffness), "", "missing", f"required: {wanted}"),
            *((key, coupling.rigid, f"a {key} beside rigid", "one of the two") for key in given),
        )
        yield from six_by_six(f"couplings.{name}", coupling.stiffness, coupling.damping)


def _bearing(address: str, bearing: Bearing) -> Iterator[Problem]:
    *nouns, last = (kind.noun for kind in Bearing.kinds().values())
    ways = f"stiffness (with damping), a table over speed, {', '.join(nouns)}, or {last}"
    nothing = bearing.stiffness is None and not bearing.table and not bearing.has_law
    double = bearing.table and bearing.damping is not None
    yield from told(
        address,
        ("", nothing, "neither stiffness nor table", ways),
        ("", bearing.stiffness is not None and bearing.table, "stiffness and table", "one of the two"),
        ("damping", double, "damping beside a table", "damping in the rows of the table"),
    )
    yield from six_by_six(address, bearing.stiffness, bearing.damping, _OF_LAW if bearing.has_law else None)
    if bearing.stiffness is not None and bearing.stiffness.torsion == RIGID:
        wanted = "a stiffness, or a support with fixed = ['torsion']"
        yield Problem(f"{address}.stiffness.torsion", f"'{RIGID}'", wanted, "shafts turn in their bearings")
    yield from _table(address, bearing.table)
    for kind, geometry in bearing.geometries.items():
        yield from geometry.problems(f"{address}.{kind}", bearing.beside(kind))
    if bearing.pedestal is None:
        return
    stiffness = bearing.pedestal.stiffness
    yield from six_by_six(f"{address}.pedestal", stiffness, bearing.pedestal.damping, "leave a rigid direction out")
    for key, matrix in (("stiffness", stiffness), ("damping", bearing.pedestal.damping)):
        rows = matrix.as_rows() if matrix and stiffness.given else ()
        tilts = any(value for i, row in enumerate(rows) for j, value in enumerate(row) if max(i, j) > 2)
        loose = key == "stiffness" and rows and not any(rows[i][i] for i in range(3))
        hint = "leave the pedestal out if it is rigid"
        yield from told(
            f"{address}.pedestal.{key}",
            ("", tilts, "tilt or torsion", "x, y and axial only", "a pedestal is rigid in tilt"),
            ("", loose, "none along x, y or z", "a stiffness in one of them", hint),
        )


def _table(address: str, table: tuple[TableRow, ...]) -> Iterator[Problem]:
    speeds = [row.speed for row in table]
    if len(speeds) == 1 or any(b <= a for a, b in pairwise(speeds)) or any(s < 0 for s in speeds):
        rpm = ", ".join(f"{speed * RPM_PER_RAD_S:.6g}" for speed in speeds)
        wanted = "at least two rows with speeds that rise from 0 or more"
        yield Problem(f"{address}.table", f"speeds of {rpm} rpm", wanted)
    for number, row in enumerate(table):
        yield from six_by_six(f"{address}.table[{number}]", row.stiffness, row.damping, "give a stiffness, not a table")


def six_by_six(
    address: str, stiffness: StiffnessMatrix | None, damping: DampingMatrix | None, in_place: str | None = None
) -> Iterator[Problem]:
    """A stiffness and a damping have entries, each given once, that are no springs of negative stiffness.

    `in_place` says what a rigid direction is given by where it is none of this stiffness.
    """
    rigid = stiffness.rigid if stiffness else ()
    if rigid and in_place is not None:
        yield Problem(f"{address}.stiffness", f"'{RIGID}'", "numbers", in_place)
    elif stiffness is not None:
        damped = damping.as_rows() if damping else ()
        for k in rigid:
            crossed = any(stiffness.as_rows()[k]) or any(row[k] for row in stiffness.as_rows())
            name = DOF_NAMES[k]
            if crossed:
                yield Problem(f"{address}.stiffness", f"a cross term of {name}", f"none: {name} is {RIGID}")
            if damped and (any(damped[k]) or any(row[k] for row in damped)):
                yield Problem(f"{address}.damping", f"one of {name}", f"none: {name} is {RIGID}, and does not move")
    for key, matrix in (("stiffness", stiffness), ("damping", damping)):
        if matrix is None:
            continue
        given = matrix.given
        clashes = [("radial", {"x", "y"}), ("tilt", {"tilt_x", "tilt_y"}), ("matrix", given - {"matrix"})]
        for whole, parts in clashes:
            if whole in given and parts & given:
                names = ", ".join(sorted(parts & given))
                yield Problem(f"{address}.{key}", f"{whole} together with {names}", "one of the two ways to give it")
        if not given:
            yield Problem(f"{address}.{key}", "an empty table", "entries such as radial, axial or tilt, or a matrix")
        for i, row in enumerate(matrix.matrix or ()):
            if row[i] < 0.0:
                place = f"{row[i]:g} in row {i + 1}, column {i + 1}"
                yield Problem(f"{address}.{key}.matrix", place, "0 or more on the diagonal")


def nonlinear_elements(model: Tables) -> Iterator[Problem]:
    """Every element names a law, gives its parameters, and acts on as many displacements as the law has."""
    if not model.nonlinear_elements:
        return
    # Laws are compiled: they are loaded for models that name one only.
    from rotorgear.forces.registry import law_of, names

    for name, element in model.nonlinear_elements.items():
        address = f"nonlinear_elements.{name}"
        if element.law not in names():
            wanted = f"one of {', '.join(names())}"
            yield Problem(f"{address}.law", shown(element.law), wanted, did_you_mean(element.law, names()))
            continue
        law = law_of(element.law)
        declared = law.declared()
        _, refused = law_parameters(law, element.parameters)
        wrong = [key for key in element.parameters if key not in declared]
        given = {*element.parameters, law.shaft_ratio}
        absent = [key for key in law.required() if key not in given and not nearest(key, wrong)]
        unknown_key = f"unknown parameter of {element.law}"
        valid = f"valid here: {', '.join(declared)}"
        found = [("", unknown_key, key, did_you_mean(key, declared, valid)) for key in wrong]
        found += [(shown(element.parameters[key]), text, key, declared[key].meaning) for key, text in refused.items()]
        found += [("", "missing", key, f"required: {declared[key].meaning}") for key in absent]
        yield from (Problem(f"{address}.parameters.{key}", got, wanted, hint) for got, wanted, key, hint in found)
        if found:
            continue
        try:
            made = element_law(element, 1.0)
        except AnalysisError as error:
            yield Problem(f"{address}.parameters", str(error), "parameters that go together")
            continue
        count = f"{made.components} direction{'s'[: made.components != 1]}"
        other = made.components != len(element.directions)
        lone = element.to_at is not None and element.to_shaft is None
        yield from told(
            address,
            ("directions", other, shown(list(element.directions)), f"{count}, as {element.law} has"),
            ("to_at", lone, "without to_shaft", "the name of the second shaft beside it"),
        )


def stations(model: Tables) -> Iterator[Problem]:
    """Every part stands on its shaft."""
    for address, part in model.parts_of(*ON_SHAFTS):
        offset = part.helix_offset if isinstance(part, Gear) and part.node_count == 2 else 0.0
        yield from _station(model, f"{address}.at", part.shaft, part.at, offset)
    for name, coupling in model.couplings.items():
        yield from _station(model, f"couplings.{name}.from_at", coupling.from_shaft, coupling.from_at)
        yield from _station(model, f"couplings.{name}.to_at", coupling.to_shaft, coupling.to_at)
    for name, element in model.nonlinear_elements.items():
        if element.to_shaft is not None:
            at = element.at if element.to_at is None else element.to_at
            yield from _station(model, f"nonlinear_elements.{name}.to_at", element.to_shaft, at)
    for address, part in model.parts_of("loads", "unbalances", "points"):
        if part.shaft is not None and part.at is not None:
            yield from _station(model, f"{address}.at", part.shaft, part.at)


def _station(model: Tables, address: str, shaft: str, at: float | str, offset: float = 0.0) -> Iterator[Problem]:
    part = model.shafts[shaft]
    z = part.station(at)
    slack = 1e-9 * max(part.length, abs(part.start), 1e-6)
    if part.start - slack <= z - offset and z + offset <= part.end + slack:
        return
    run = f"shaft '{shaft}', which runs from {millimetres(part.start)} to {millimetres(part.end)}"
    if not part.sections:
        run = f"shaft '{shaft}', which has no sections and is one point at {millimetres(part.start)}"
    if not offset:
        yield Problem(address, millimetres(z), f"a place on {run}")
    else:
        got = f"{millimetres(z)} with helices at {millimetres(z - offset)} and {millimetres(z + offset)}"
        yield Problem(address, got, f"both helices on {run}", "nodes = 1 puts the whole gear at one place")
