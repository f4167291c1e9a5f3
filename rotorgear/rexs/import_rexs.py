"""A REXS file as a model file: what it says, with a comment for everything that had to be assumed."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

from rotorgear.cpu import Clock
from rotorgear.errors import AnalysisError, ModelError
from rotorgear.model.load import loads
from rotorgear.model.model import model_hash
from rotorgear.results.rexs_import import RexsImport
from rotorgear.rexs.account import Account
from rotorgear.rexs.bearings import bearing_table, coupling_table, is_bearing, is_coupling
from rotorgear.rexs.document import Document
from rotorgear.rexs.gears import GearPart, gear_table, matched, mesh_table, read_gear
from rotorgear.rexs.loads import MASS, load_tables, mass_tables
from rotorgear.rexs.read import read_document
from rotorgear.rexs.shafts import Materials, ShaftPart, read_sections, shaft_axes, shaft_table
from rotorgear.rexs.structure import GEAR, Structure, refuse_other_kinds
from rotorgear.rexs.toml_text import Names, Table, comment_line, text

_NEWEST = (1, 6)


def import_rexs(path: str | Path, *, load_case: str | int | None = None) -> RexsImport:
    """Read a gearbox from a REXS file, versions 1.0 to 1.6, in XML, JSON, or a zip archive of one.

    External cylindrical gears on parallel shafts with their sections, materials, bearings, couplings, speeds, torques and forces.
    What the file leaves open is assumed and said; what can't be assumed is reported, all of it at once.

    Args:
        path: REXS file, versions 1.0 to 1.6: XML, JSON or zip.
        load_case: number of a load case of the file (default: the first, where it has some).

    Returns:
        The text of the model file with its comments, and the assumptions by address.

    Raises:
        AnalysisError: no REXS file, a planetary, worm or bevel stage, or no such load case.
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
    structure = Structure(document, account)
    materials = Materials(structure)
    pairs = structure.pairs()
    axes = shaft_axes(structure, pairs)
    shafts: dict[str, ShaftPart] = {}
    names = Names()
    for component in document.of_type("shaft"):
        sections = read_sections(component, structure)
        if component.id in axes and sections:
            name = names.of(component.name, "shaft", component.id)
            shafts[component.id] = ShaftPart(component, name, axes[component.id], sections)
    if not document.of_type("shaft"):
        account.missing("the file", "a gearbox needs at least one component of the type shaft")
    shaft_tables = [shaft_table(part, *materials.of(part.component, f"shafts.{part.name}")) for part in shafts.values()]
    # Gears with shifts that fit their axes, and those that mesh.
    gears: dict[str, GearPart] = {}
    names = Names()
    for component in document.of_type(GEAR):
        part = read_gear(component, names.of(component.name, "gear", component.id), shafts, structure, version)
        if part is not None:
            gears[component.id] = part
    meshing: list[tuple[GearPart, GearPart]] = []
    mesh_tables = []
    names = Names()
    for pair in pairs:
        first, second = (gears.get(gear.id) for gear in pair.members)
        fitted = matched(first, second, pair, account) if first is not None and second is not None else None
        if fitted is not None:
            gears |= {part.component.id: part for part in fitted}
            meshing.append(fitted)
            name = names.of(pair.stage.name, "stage", pair.stage.id)
            mesh_tables.append(mesh_table(pair, name, *fitted, account))
    gear_tables = []
    for part in gears.values():
        # A gear has a material of its own, or that of its shaft.
        own = structure.referenced(part.component, "material") is not None
        material = materials.of(part.component, f"gears.{part.name}") if own else ("", "")
        gear_tables.append(gear_table(part, structure, material))
    names = Names()
    masses = document.of_type(MASS)
    mass_list = [table for part in masses for table in mass_tables(part, names, shafts, structure)]
    # Bearings (also those between two shafts) and couplings, by number.
    bearings: dict[str, Table] = {}
    couplings: dict[str, Table] = {}
    names = Names()
    for component in document.components.values():
        for found, is_one, table_of in (
            (bearings, is_bearing, bearing_table),
            (couplings, is_coupling, coupling_table),
        ):
            table = table_of(component, names, shafts, structure) if is_one(component) else None
            if table is not None:
                found[component.id] = table
    by_name = {part.name: number for number, part in shafts.items()}
    stiff = [(by_name[_value(table, "from_shaft")], by_name[_value(table, "to_shaft")]) for table in couplings.values()]
    operation, load_list = load_tables(shafts, meshing, stiff, structure)
    taken = [part for part in document.components.values() if is_bearing(part) or is_coupling(part)]
    structure.note_left_out({part.id for part in [*taken, *masses]})
    counts = {"shafts": len(shafts), "gears": len(gears), "meshes": len(mesh_tables), "bearings": len(bearings)}
    head = [*filter(None, [operation]), *materials.tables]
    bodies = [*shaft_tables, *gear_tables, *mass_list]
    joints = [*mesh_tables, *bearings.values(), *couplings.values()]
    return [*head, *bodies, *joints, *load_list], counts


def _value(table: Table, key: str) -> str:
    return next(value for name, value, _ in table.rows if name == key).strip('"')
