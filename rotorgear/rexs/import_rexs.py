"""A REXS file as a model file: what it says, with a comment for everything that had to be assumed."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import replace
from pathlib import Path

from rotorgear.cpu import Clock
from rotorgear.errors import AnalysisError, ModelError
from rotorgear.model.load import loads
from rotorgear.model.model import model_hash
from rotorgear.results.rexs_import import RexsImport
from rotorgear.rexs.account import Account
from rotorgear.rexs.bearings import bearing_table, coupling_table, holds, is_bearing, is_coupling, is_open
from rotorgear.rexs.bevels import BevelPart, bevel_table, matched_bevels, read_bevel_gear
from rotorgear.rexs.carriers import Carriers
from rotorgear.rexs.document import Component, Document
from rotorgear.rexs.gears import GearPart, gear_table, matched, mesh_table, read_gear
from rotorgear.rexs.loads import MASS, given_speeds, load_tables, mass_tables
from rotorgear.rexs.planets import Planets, on_shafts, placed_planets, read_stages
from rotorgear.rexs.read import read_document
from rotorgear.rexs.seated import seat_table, with_seats
from rotorgear.rexs.shafts import Materials, ShaftPart, read_sections, shaft_axes, shaft_table
from rotorgear.rexs.structure import BEVEL, GEARS, Axis, Pair, Structure, refuse_other_kinds
from rotorgear.rexs.toml_text import Names, Table, comment_line, quantity, text

_NEWEST = (1, 6)


def import_rexs(path: str | Path, *, load_case: str | int | None = None) -> RexsImport:
    """Read a gearbox from a REXS file, versions 1.0 to 1.6, in XML, JSON, or a zip archive of one.

    Cylindrical gears, external and internal, bevel gears and planetary stages, on shafts with their sections, materials,
    bearings, couplings, speeds, torques and forces. What the file leaves open is assumed and said; what can't be assumed is
    reported, all of it at once.

    Args:
        path: REXS file, versions 1.0 to 1.6: XML, JSON or zip.
        load_case: number of a load case of the file (default: the first, where it has some).

    Returns:
        The text of the model file with its comments, and the assumptions by address.

    Raises:
        AnalysisError: no REXS file, a worm or hypoid stage, or no such load case.
        ModelError: values are missing that nothing can replace, or the model would not be sound; all of them.
    """
    clock = Clock()
    document = read_document(path)
    source = Path(path).name
    refuse_other_kinds(document, source)
    account = Account()
    version = _version(document, account)
    document, case = _with_load_case(document, load_case, source, account)
    tables, counts = _tables(document, version, account)
    if account.problems:
        raise ModelError(account.problems, source)
    # Where the text comes from stands at its head, with the warnings and what was left out.
    by = f" by {document.application}" if document.application else ""
    of_case = f", load case {case}" if case else ""
    unit = next(iter(document.of_type("gear_unit")), None)
    lines = [
        f"# Made from {comment_line(source)}, REXS {comment_line(document.version)}{comment_line(by)}{of_case}.",
        f"# {len(account.assumptions)} values are assumed: look for 'assumed'. z is u, x is v and y is w of the file.",
        *(f"# Warning: {comment_line(note)}" for note in account.warnings),
        *(f"# Left out: {comment_line(note)}" for note in account.left_out),
        "schema_version = 1",
        f"title = {text(f'{unit.name} of {source}' if unit and unit.name else source)}",
    ]
    for table in tables:
        lines += ["", *table.lines()]
    whole = "\n".join(lines) + "\n"
    try:
        model = loads(whole, source)
    except ModelError as error:
        raise ModelError(error.problems, f"{source}, read as a model") from None
    clock.lap("import")
    return RexsImport(
        file=source,
        version=document.version,
        application=document.application,
        load_case=case,
        shafts=counts["shafts"],
        gears=counts["gears"],
        meshes=counts["meshes"],
        bearings=counts["bearings"],
        toml=whole,
        assumptions=tuple(account.assumptions),
        left_out=tuple(account.left_out),
        warnings=tuple(account.warnings),
        method=f"REXS {document.version}",
        model_hash=model_hash(model),
        seconds=clock.total(),
        settings={"load_case": load_case},
    )


def _version(document: Document, account: Account) -> tuple[int, int]:
    found = re.match(r"\s*(\d+)\.(\d+)", document.version)
    version = (int(found[1]), int(found[2])) if found else None
    if version is not None and (1, 0) <= version <= _NEWEST:
        return version
    told = f"REXS {document.version} is read as 1.6, the newest version that is known here"
    account.warnings.append(told if found else f"the file states no version ('{document.version}'): it is read as 1.6")
    return _NEWEST


def _with_load_case(
    document: Document, wanted: str | int | None, source: str, account: Account
) -> tuple[Document, str]:
    """The document with the attributes of a load case over those of its components, and the case's number."""
    if not document.load_cases:
        if wanted is not None:
            raise AnalysisError(f"{source}: load case {wanted} was asked for, and the file has none")
        return document, ""
    cases = dict(document.load_cases)
    chosen = str(wanted) if wanted is not None else document.load_cases[0][0]
    if chosen not in cases:
        raise AnalysisError(f"{source}: there is no load case '{chosen}'; it has: {', '.join(cases)}")
    components = dict(document.components)
    for number, attributes in cases[chosen].items():
        if number in components:
            old = components[number]
            components[number] = replace(old, attributes={**old.attributes, **attributes})
    if wanted is None and len(cases) > 1:
        account.warnings.append(f"load case {chosen} is taken, the first of {len(cases)}: {', '.join(cases)}")
    return replace(document, components=components), chosen


def _tables(document: Document, version: tuple[int, int], account: Account) -> tuple[list[Table], dict[str, int]]:
    """All tables of the model file in its order, and how many parts of each kind there are."""
    document, seats = with_seats(document)
    whole = Structure(document, account)
    held = {number: joint for number, joint in seats.items() if joint is None or not is_open(joint, whole)}
    pairs = whole.pairs()
    on = on_shafts(whole)
    stages = read_stages(whole, on)
    axes = shaft_axes(whole, pairs, {number for stage in stages for number in stage.pins})
    planets = placed_planets(stages, on, axes, pairs, whole, version)
    structure = whole.without(planets.dropped)
    shafts = _shafts(structure, axes, planets, seats.keys())
    carriers = Carriers(planets, shafts, whole)
    materials = Materials(structure)
    given = _given_speeds(shafts, structure, bool(stages), held)
    shaft_tables = [
        shaft_table(
            part,
            *materials.of(part.component, f"shafts.{part.name}"),
            structure.model,
            given.get(part.component.id, ()),
        )
        for part in shafts.values()
    ]
    gear_tables, mesh_tables = _gears(
        structure, shafts, [p for p in pairs if p.stage.id not in planets.dropped], version, materials
    )
    masses = document.of_type(MASS)
    names = Names()
    bodies = [
        table
        for part in masses
        if part.id not in planets.dropped
        for table in mass_tables(part, names, shafts, structure)
    ]
    bodies = [*bodies, *carriers.bodies(materials, names)]
    bearings, couplings = _joints(structure, shafts, planets, carriers, held)
    parts = [*shaft_tables, *carriers.tables(), *gear_tables]
    operation, loads = load_tables(shafts, [*parts, *mesh_tables, *couplings], structure)
    taken = [part.id for part in document.components.values() if is_bearing(part) or is_coupling(part)]
    whole.note_left_out({*taken, *planets.dropped, *(part.id for part in masses)})
    counts = {"shafts": len(shafts), "gears": len(gear_tables), "meshes": len(mesh_tables), "bearings": len(bearings)}
    head = [*filter(None, [operation]), *materials.tables]
    return [*head, *parts, *bodies, *mesh_tables, *bearings, *couplings, *loads], counts


def _shafts(
    structure: Structure, axes: dict[str, Axis], planets: Planets, seats: Collection[str]
) -> dict[str, ShaftPart]:
    """The shafts that have a place and sections, or a seat in the casing, by number."""
    found = {}
    names = Names()
    for component in structure.document.of_type("shaft"):
        sections = () if component.id in seats else read_sections(component, structure)
        if component.id in axes and (sections or component.id in seats):
            name = names.of(component.name, "shaft", component.id)
            place = planets.places.get(component.id)
            found[component.id] = ShaftPart(component, name, axes[component.id], sections, place)
    if not structure.document.of_type("shaft"):
        structure.account.missing("the file", "a gearbox needs at least one component of the type shaft")
    return found


def _given_speeds(
    shafts: dict[str, ShaftPart], structure: Structure, planetary: bool, held: Collection[str]
) -> dict[str, tuple[str, str, str]]:
    """Number of a shaft -> key, value and comment of its speed, where it is held, or the second one of a train with carriers."""
    found: dict[str, tuple[str, str, str]] = {}
    first = True
    for speed, shaft, defines in given_speeds(shafts, structure.account):
        if not speed:
            found[shaft.component.id] = ("speed_ratio", "0", "held: its speed is 0")
        elif defines and planetary and not first:
            found[shaft.component.id] = ("speed", quantity(speed, "speed"), "")
        first = first and not speed
    for part in structure.document.components.values():
        if is_coupling(part) and holds(part, structure):
            found |= {
                side.id: ("speed_ratio", "0", f"held by {part}") for side in structure.beside(part) if side.id in shafts
            }
    return found | dict.fromkeys(held, ("speed_ratio", "0", "held: its gear stands in the casing"))


def _gears(
    structure: Structure,
    shafts: dict[str, ShaftPart],
    pairs: list[Pair],
    version: tuple[int, int],
    materials: Materials,
) -> tuple[list[Table], list[Table]]:
    """Gears with hands and shifts that fit their axes, and their meshes."""
    account = structure.account
    gears: dict[str, GearPart] = {}
    bevels: dict[str, BevelPart] = {}
    names = Names()
    for component in structure.document.of_type(*GEARS):
        name = names.of(component.name, "gear", component.id)
        if component.type == BEVEL:
            bevel = read_bevel_gear(component, name, shafts, structure)
            bevels |= {component.id: bevel} if bevel is not None else {}
        else:
            gear = read_gear(component, name, shafts, structure, version)
            gears |= {component.id: gear} if gear is not None else {}
    meshes = []
    names = Names()
    for pair in pairs:
        first, second = (member.id for member in pair.members)
        fitted: tuple[GearPart, GearPart] | tuple[BevelPart, BevelPart] | None = None
        if first in gears and second in gears:
            if (cylindrical := matched(gears[first], gears[second], pair, account)) is not None:
                gears |= {part.component.id: part for part in cylindrical}
                fitted = cylindrical
        elif (
            first in bevels
            and second in bevels
            and (conical := matched_bevels(bevels[first], bevels[second], pair, account))
        ):
            bevels |= {part.component.id: part for part in conical}
            fitted = conical
        if fitted is not None:
            name = names.of(pair.stage.name, "stage", pair.stage.id)
            meshes.append(mesh_table(pair.stage, name, {part.name: part.teeth for part in fitted}, account))
    tables = []
    parts: list[GearPart | BevelPart] = [*gears.values(), *bevels.values()]
    for part in parts:
        # A gear has a material of its own, or that of its shaft.
        own = structure.referenced(part.component, "material") is not None
        material = materials.of(part.component, f"gears.{part.name}") if own else ("", "")
        if isinstance(part, BevelPart):
            tables.append(bevel_table(part, structure, material))
        else:
            tables.append(gear_table(part, structure, material))
    return tables, meshes


def _joints(
    structure: Structure,
    shafts: dict[str, ShaftPart],
    planets: Planets,
    carriers: Carriers,
    held: Mapping[str, Component | None],
) -> tuple[list[Table], list[Table]]:
    """Bearings (also those between two shafts), and couplings with the supports of shafts that some hold to the casing."""
    bearings: list[Table] = []
    couplings: list[Table] = []
    names = Names()
    pins = {part.id: pin for number, pin in planets.pins.items() for part in planets.on.get(number, ())}
    for component in structure.document.components.values():
        if is_bearing(component):
            table = bearing_table(component, names, shafts, structure, pins.get(component.id))
            bearings += [table] if table is not None else []
        elif is_coupling(component) and component not in held.values():
            table = coupling_table(component, names, shafts, structure)
            couplings += [table] if table is not None else []
    couplings += [
        seat_table(shafts[number], coupling, names, structure.account)
        for number, coupling in held.items()
        if number in shafts
    ]
    by_name = {part.name: number for number, part in shafts.items()}
    joined = [table for table in couplings if table.header.startswith("couplings.")]
    pairs = [(by_name[_value(table, "from_shaft")], by_name[_value(table, "to_shaft")]) for table in joined]
    return bearings, [*couplings, *carriers.joins(pairs, names)]


def _value(table: Table, key: str) -> str:
    return next(value for name, value, _ in table.rows if name == key).strip('"')
