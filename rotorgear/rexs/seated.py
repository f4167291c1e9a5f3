"""Gears that a REXS file holds in the casing, with no shaft between: the ring of most planetary stages.

The casing has such a gear as its part, or a coupling sits between both. Casings are ground here: the gear gets a shaft without
sections at its place, which stands still on a support. It is fixed there, but for the stiffnesses that a coupling states.
"""

from __future__ import annotations

from dataclasses import replace

from rotorgear.rexs.account import Account
from rotorgear.rexs.bearings import COUPLING_STIFFNESS, given_stiffness, is_coupling
from rotorgear.rexs.document import Component, Document, Relation
from rotorgear.rexs.shafts import ShaftPart
from rotorgear.rexs.structure import ASSEMBLIES, GEARS, ON_SHAFT
from rotorgear.rexs.toml_text import Names, Table, quantity, row

# Motions that a stiffness of a coupling holds.
_HELD = {"radial": ("x", "y"), "axial": ("z",), "tilt": ("tilt_x", "tilt_y"), "torsion": ("torsion",)}
_PLACE = ("support_vector", "u_axis_vector", "w_axis_vector", "reference_component_for_position")


def with_seats(document: Document) -> tuple[Document, dict[str, Component | None]]:
    """The document with a shaft for each gear in the casing, and by its number the coupling that holds it, None without one."""
    components = dict(document.components)
    casings = {part.id for part in document.of_type("gear_casing")}
    shafts = {part.id for part in document.of_type("shaft")}
    toothed = {part.id for part in document.of_type(*GEARS)}
    borne = {
        number
        for one in document.relations
        if one.type in ASSEMBLIES and shafts & set(one.at("assembly"))
        for number in one.at("part")
    }
    seats: dict[str, Component | None] = {}
    relations = []
    for relation in document.relations:
        numbers = {number for _, number in relation.refs}
        gears = numbers & toothed - borne
        joint = next(
            (components[number] for number in numbers & components.keys() if is_coupling(components[number])), None
        )
        part_of = relation.type in ASSEMBLIES and bool(casings & set(relation.at("assembly")))
        if len(gears) == 1 and casings & numbers and (part_of or (joint is not None and relation.type in ON_SHAFT)):
            gear = components[gears.pop()]
            shaft = f"{gear.id} in the casing"
            place = {key: value for key, value in gear.attributes.items() if key in _PLACE}
            components[shaft] = Component(shaft, "shaft", gear.name, place)
            seats[shaft] = seats.get(shaft) or joint
            swapped = tuple((role, shaft if number == gear.id else number) for role, number in relation.refs)
            relations += [
                replace(relation, refs=swapped),
                Relation("assembly", (("assembly", shaft), ("part", gear.id))),
            ]
        else:
            relations.append(relation)
    return replace(document, components=components, relations=tuple(relations)), seats


def seat_table(part: ShaftPart, coupling: Component | None, names: Names, account: Account) -> Table:
    """The support of a gear in the casing: the stiffnesses that its coupling states, and fixed in all else."""
    holder = coupling or part.component
    header = f"supports.{names.of(holder.name, 'support', holder.id)}"
    remark = f"{coupling}, which holds the gear to the casing" if coupling else "the gear is part of the casing"
    table = part.table(header, remark, part.start)
    stiffness = {}
    fixed: list[str] = []
    for key, (kind, attributes) in COUPLING_STIFFNESS.items():
        found = None if coupling is None else given_stiffness(coupling, attributes, kind, account)
        if found is None:
            fixed += _HELD[key]
        else:
            stiffness[key] = quantity(found, kind)
    if stiffness:
        table.add("stiffness", row(**stiffness))
    if fixed:
        words = ", ".join(fixed)
        reason = "the file has the gear in the casing and no stiffness there"
        table.add(
            "fixed",
            "[" + ", ".join(f'"{word}"' for word in fixed) + "]",
            account.assume(f"{header}.fixed", words, reason),
        )
    return table
