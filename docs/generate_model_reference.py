"""Writes docs/model_file.md from the fields of the parts.

Every field carries its unit, bounds and meaning; the loader, the error texts and the JSON Schema come from the same
fields. Only the rules that tie several keys together are put in words here.
"""

from __future__ import annotations

import inspect
import math
import re
from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel, TypeAdapter

from rotorgear.model.model import SCHEMA_VERSION, Model
from rotorgear.model.parts.bearings.journal import JournalGeometry
from rotorgear.model.parts.bearings.rolling import RollingElements
from rotorgear.model.parts.bearings.thrust import ThrustGeometry
from rotorgear.model.parts.carrier import Carrier
from rotorgear.model.parts.casing import Bore, Box, Casing, Feet, Join, Mount, Ribs, Seat
from rotorgear.model.parts.fields import Whole
from rotorgear.model.parts.gear import Flank, Gear, GearBody
from rotorgear.model.parts.load import Load, LoadHistory, Unbalance
from rotorgear.model.parts.mesh import CornerImpact, ErrorHarmonic, Mesh, StiffnessHarmonic, ToothFeTable
from rotorgear.model.parts.operation import ModelDamping, Operation, Point, Scatter
from rotorgear.model.parts.shaft import LIBRARY, Disk, Material, PointMass, PositionByMesh, Section, Shaft
from rotorgear.model.parts.supports import (
    Bearing,
    Coupling,
    DampingMatrix,
    NonlinearElement,
    Pedestal,
    StiffnessMatrix,
    Support,
    TableRow,
)
from rotorgear.model.parts.topography import MeasuredGrid, Topography
from rotorgear.quantity import DIMENSIONS

SECTIONS: list[tuple[str, type[BaseModel]]] = [
    ("Top of the file", Model),
    ("[operation]", Operation),
    ("[materials.NAME]", Material),
    ("[shafts.NAME]", Shaft),
    ("position = { ... } of a shaft", PositionByMesh),
    ("sections = [{ ... }] of a shaft", Section),
    ("[carriers.NAME]", Carrier),
    ("[gears.NAME]", Gear),
    ("body = { ... } of a gear", GearBody),
    ("flank = { ... } of a gear", Flank),
    ("topography = { ... } of a flank", Topography),
    ("grids = [{ ... }] of a topography", MeasuredGrid),
    ("[meshes.NAME]", Mesh),
    ("tooth_fe = { ... } of a mesh", ToothFeTable),
    ("transmission_error = [{ ... }] of a mesh", ErrorHarmonic),
    ("stiffness_variation = [{ ... }] of a mesh", StiffnessHarmonic),
    ("corner_impact = { ... } of a mesh", CornerImpact),
    ("[bearings.NAME]", Bearing),
    *((f"{key} = {{ ... }} of a bearing", kind) for key, kind in Bearing.kinds().items()),
    ("table = [{ ... }] of a bearing", TableRow),
    ("pedestal = { ... } of a bearing", Pedestal),
    ("stiffness = { ... } of a part", StiffnessMatrix),
    ("damping = { ... } of a part", DampingMatrix),
    ("[casings.NAME]", Casing),
    ("box = { ... } of a casing", Box),
    ("bores = { NAME = { ... } } of a box", Bore),
    ("ribs = { ... } of a box", Ribs),
    ("feet = { ... } of a box", Feet),
    ("seats = { NAME = { ... } } of a casing", Seat),
    ("mounts = { SET = { ... } } of a casing", Mount),
    ("joins = [{ ... }] of a casing", Join),
    ("[supports.NAME]", Support),
    ("[couplings.NAME]", Coupling),
    ("[nonlinear_elements.NAME]", NonlinearElement),
    ("[disks.NAME]", Disk),
    ("[point_masses.NAME]", PointMass),
    ("[damping]", ModelDamping),
    ("[loads.NAME]", Load),
    ("history = { ... } of a load, in place of a file", LoadHistory),
    ("[unbalances.NAME]", Unbalance),
    ("[points.NAME]", Point),
    ("[scatter] by address", Scatter),
]

# A whole number from 1 to the largest count.
COUNT = TypeAdapter(Whole).json_schema()
# What single fields can't say: rules that tie keys together.
RULES: dict[type[BaseModel], str] = {
    Model: """
        Keys above the first table, and the tables of a file.""",
    Operation: """
        Give `power` or `torque`, not both; then name the `output_shaft`, or list the torques under `[loads]`. Without
        `[operation]` the first shaft is the input.""",
    Material: """
        Give `poisson_ratio` or `shear_modulus`, not both.""",
    Casing: """
        A bearing with `casing = "NAME"` stands on the seat of its name. Give `material`, or E, nu and density; and a `mesh`, a
        `box` or `matrices`.
        See [Casings](casings.md).""",
    Seat: """
        A text is the name of a set. Else all of `axis`, `center`, `from`, `to` and `radius` say where the bore is.""",
    Join: """
        Both faces may stand in one mesh or in two; a set of one mesh of several is written `lower.flange`.""",
    Shaft: """
        That is enough for a torsional model.""",
    PositionByMesh: """
        Such as `{ mesh = "stage_2", angle = "52 deg" }`. The axes are parallel and lie at the distance at which teeth and profile
        shifts mesh without backlash; z = 0 of both lies side by side. It moves with teeth, module and shifts.""",
    Section: """
        A section begins where the one before it ends. `outer_diameter_end` and `bore_end` make it a cone. The mass
        diameters serve sleeves and rings that weigh but do not stiffen.""",
    Gear: """
        A gear is described by `teeth`, `normal_module` and `width`, or, for lumped models, by `base_radius`. Helical and
        herringbone gears need `helix_angle` and `hand` as well (beside a `base_radius`: `base_helix_angle` and `hand`).
        Mass and inertias are computed from the blank, or given all together. Those of a herringbone are of both helices,
        about the middle of the gear.""",
    GearBody: """
        Without a rim the blank is a solid ring from the bore to the reference circle. A rim needs a web.""",
    Flank: """
        For [loaded teeth](mesh.md) only, where their shapes and the columns of `topography` stand. Amounts are depths of removed
        material; `z` is that of the gear's shaft, and of each helix by itself in a herringbone.""",
    ToothFeTable: """
        See [Loaded teeth](mesh.md).""",
    Mesh: """
        Both gears need the same kind, normal module, pressure angle and helix angle, and opposite hands. Their axes must
        stand at the centre distance that teeth and profile shifts give, to a twentieth of the module. Signs:
        [conventions](conventions.md#mesh-of-a-parallel-axis-pair).""",
    Bearing: """
        Give `stiffness` (and `damping`), a `table` over speed, `rolling` elements, a `journal` or a `thrust` bearing.
        A stiffness of one number (`"1e8 N/m"`, `{ radial = "1e8 N/m" }`) is along x and y alone, not z:
        give one bearing of the shaft an `axial` one, too. A bearing holds no torsion unless told to. See
        [Bearings](bearings.md).""",
    TableRow: """
        At least two rows, speeds rising. A speed outside the table is refused, never extrapolated.""",
    Pedestal: """
        Only `x`, `y` and `axial` count, or `radial` for x and y: a pedestal is rigid in tilt.""",
    StiffnessMatrix: """
        Give `radial`, or `x` and `y`; `tilt`, or `tilt_x` and `tilt_y`; or the full `matrix` and nothing else, rows and
        columns x y z tilt_x tilt_y torsion. What is left out is zero, and `"rigid"` is for bearings and couplings.""",
    DampingMatrix: f"""
        The same keys as those of the [stiffness](#stiffness-----of-a-part), with velocities in place of displacements:
        `"{DIMENSIONS["damping"].example}"` along axes, `"{DIMENSIONS["rotational_damping"].example}"` about them.""",
    CornerImpact: """
        The force of each helix, beside the contact force.""",
    RollingElements: """
        With a `designation` no other key is required. It is one of the series 60, 62, 63, 64, 160, 618, 619 (deep groove), 70,
        72, 73, 718, 719 (angular contact), QJ 0, 2, 3 (four-point), N, NU, NJ, NUP 2, 3, 4, 10, 22, 23 (cylindrical), 302, 303,
        313, 320, 322, 323, 329 to 332 (tapered). O arrangement: `contact_angle` positive at the smaller z, negative at the
        larger, X the other way round. With a `stiffness` beside them (along x, y, axial and tilt), statics and linear analyses
        keep that and say so; without one, statics solves for the contacts, and linear analyses take the tangent there, the mean
        over a pitch of the elements. Transients and sweeps follow the contacts.""",
    JournalGeometry: """
        The film carries across; what holds the shaft along z is a support or a bearing of its own. Statics, transients and
        sweeps solve its pressure, linear analyses take its stiffness and damping at the static equilibrium, over speed.
        Refused: turbulent films, eccentricities above 0.95, lengths above two diameters.""",
    ThrustGeometry: """
        The films carry along z and resist tilting of the collar; what holds the shaft across is a bearing of its own. Analyses
        take pressure and tangents like those of a journal. Fixed pads have a `taper`, tilting ones a `pivot` instead. The
        keys of the oil, `viscosity`, `oil`, `inlet_temperature`, `heat_share`, `specific_heat` and `density`, are those of the
        [journal](#journal-----of-a-bearing).""",
    NonlinearElement: """
        The law is one of the package, such as `journal_bearing` or `plain_spring`, or registered from Python before the file is
        loaded. Statics, transients and sweeps take it as it is, linear analyses by its tangents at the static equilibrium.
        Displacements are those of the shaft less those of `to_shaft`, and the force acts against them.""",
    Unbalance: """
        Responses, transients and sweeps take it.""",
    Disk: """
        Give `mass` and both inertias, or `outer_diameter` and `width`.""",
    ModelDamping: """
        Damping counts in analyses at a `--speed` only. Materials have no loss factor: the damping of parts stands in `damping` of
        bearings, supports and couplings, `damping_ratio` or `damping` of meshes, `internal_damping` of shafts, and
        `damping_ratio` of casings and gear bodies.""",
    Load: """
        A torque has `shaft`, `kind` and `torque` or `power`, in place of those under `[operation]`. The torques must balance in
        power; leave that of one output out and it takes the rest.

        A force has `force`, `moment` or both, along and about x, y and z, or a `history`; and one of `shaft` with `at`, `gear`,
        `point`. It is constant, or goes with `order` or `frequency`: one that turns is two loads a quarter turn apart. A constant
        moment about z on a shaft that turns takes part in the balance of torques.

        A `history` is a CSV file with a column `time` or `angle` and others `force_x` to `moment_z`, each with its unit in the
        header (`angle_deg,force_y_kN`), linear between its rows; angles are those of the shaft and begin again after 360 deg.
        [Forces and moments](static.md#forces-and-moments) says which analysis takes what.""",
    Scatter: """
The key is an address in quotes, such as `"bearings.*.stiffness" = { sigma = "10 %" }`; of two that name one number the later
counts. [Scatter](report.md#scatter) says what is made of it.
""",
    Point: """
        Give `on`, or `shaft` and `at`.""",
}

# Parts whose keys are, as far as they have the same name and meaning, those of another one; words say so.
AS_ANOTHER: dict[type[BaseModel], type[BaseModel]] = {DampingMatrix: StiffnessMatrix, ThrustGeometry: JournalGeometry}

HEAD = f"""# The model file

<!-- Generated by docs/generate_model_reference.py from the fields of the parts. -->

A model is one [TOML](https://toml.io) file in UTF-8. This page lists every key of schema version {SCHEMA_VERSION}.
[Your first gearbox](first_gearbox.md) builds a file step by step; [models/](../models) holds more.

**Quantities** are texts of number and unit, `"2.75 mm"`. A plain number is SI: angles in rad, speeds in rad/s.
Decimals take a point. A unit of the wrong kind is an error.

**Names** are yours: `[gears.pinion_1]` makes a gear called `pinion_1`. They take letters, digits, `_`, `-` and blanks.

**Places**: z runs along every shaft, from one origin that you choose for the whole gearbox. `at` is a z in that
frame, or `"start"` or `"end"` of the shaft. Signs and axes stand in [conventions](conventions.md).

**Mistakes** are reported all at once: see [Troubleshooting](errors.md).

**Editors** complete and check keys from a JSON Schema (Taplo; "Even Better TOML" in VS Code). `rotorgear new` writes it beside
the model, whose first line names it: `#:schema ./model.schema.json`. For any other model,
`rotorgear schema --json model.schema.json`.

In the tables, a *value* is an example, the choices, or a kind, with its bounds. The SI unit of a plain number follows from the
example, as [below](#quantities-and-units); a *count* is a whole number from 1 to {COUNT["maximum"]}. A key that is not
*required* may be left out; where no default stands, the meaning says what holds then, or nothing does.
"""


def pages() -> dict[str, str]:
    """Return the reference page by its path."""
    parts = [HEAD, _quantities(), *(_section(*row) for row in SECTIONS), _library()]
    return {"docs/model_file.md": "\n".join(parts)}


def _anchor(title: str) -> str:
    kept = "".join(character for character in title.lower() if character.isalnum() or character in "_- ")
    return kept.strip().replace(" ", "-")


def _quantities() -> str:
    rows = [["quantity", "SI unit of a plain number", "example"]]
    rows += [
        [d.name.replace("_", " "), f"`{d.unit}`" if d.unit else "none", f'`"{d.example}"`'] for d in DIMENSIONS.values()
    ]
    speeds = "Rotational speeds take rpm, rev/s, deg/s or rad/s, never Hz. Ratios may be given in `%`."
    return f"## Quantities and units\n\n{_table(rows)}\n{speeds}\n"


def _section(title: str, part: type[BaseModel]) -> str:
    lead = "" if part is Model else inspect.cleandoc(part.__doc__ or "").split("\n\n")[0]
    text = " ".join(f"{lead} {RULES.get(part, '')}".split())
    shared = {row[0] for row in _shared(part)}
    own = [row for row in _rows(part) if row[0] not in shared]
    table = _table([["key", "value", "default", "meaning"], *own]) if own else ""
    return f"## {title}\n\n{text}\n\n{table}".rstrip() + "\n"


def _shared(part: type[BaseModel]) -> list[list[str]]:
    """The rows that a part shares with another one: all keys of a damping, or those with the same words."""
    if part not in AS_ANOTHER:
        return []
    other = list(_rows(AS_ANOTHER[part]))
    names = [row[0] for row in other]
    rows = list(_rows(part))
    return rows if [row[0] for row in rows] == names else [row for row in rows if row in other]


def _rows(part: type[BaseModel]) -> Iterator[list[str]]:
    for (name, _, bound, default, meaning), kind in zip(facts(part), _kinds(part), strict=True):
        yield [f"`{name}`", f"{_linked(name, part, _value(kind))} {bound} {_words(kind)}".rstrip(), default, meaning]


def _linked(key: str, part: type[BaseModel], value: str) -> str:
    """What a key takes; of a table that has a section, with a link there."""
    names = (f"{key} =", f"[{key}.NAME]") if part is not Model else (f"[{key}.NAME]", f"[{key}]")
    title = next((title for title, _ in SECTIONS if title.startswith(names)), None) if "table" in value else None
    return f"[{value}](#{_anchor(title)})" if title else value


def facts(part: type[BaseModel]) -> Iterator[tuple[str, str, str, str, str]]:
    """Yield key, SI unit, bound, default and meaning of each field of a part, as cells of a table."""
    for (name, field), kind in zip(part.model_fields.items(), _kinds(part), strict=True):
        default = "required" if field.is_required() else _default(field.get_default(call_default_factory=True), kind)
        yield name, _unit(kind), _bound(kind), default, _escaped(field.description or "")


def _kinds(part: type[BaseModel]) -> Iterator[dict[str, Any]]:
    schema = part.model_json_schema()
    for name in part.model_fields:
        yield _kind(schema["properties"][name], schema)


def _kind(schema: dict[str, Any], root: dict[str, Any]) -> dict[str, Any]:
    """Return the schema of a value without null and references."""
    if "$ref" in schema:
        return {**root["$defs"][schema["$ref"].rpartition("/")[2]], "table": schema["$ref"].rpartition("/")[2]}
    options = [option for option in schema.get("anyOf", []) if option.get("type") != "null"]
    if len(options) == 1:
        return _kind(options[0], root)
    if schema.get("type") == "array" and "$ref" in schema.get("items", {}):
        return {**schema, "table": schema["items"]["$ref"].rpartition("/")[2]}
    return schema


def _value(kind: dict[str, Any]) -> str:
    if "x-unit" in kind:
        example = next(o["examples"][0] for o in kind["anyOf"] if "examples" in o)
        if not kind["x-unit"]:
            return "number"
        return f'`"{example}"`'
    if "oneOf" in kind:
        return f"{_value(kind['oneOf'][0])}, or table"
    options = {option.get("type") for option in kind.get("anyOf", [])} - {"null"}
    if options == {"string"}:
        return "text, or"
    if options == {"string", "object"}:
        return "text or table"
    if options == {"number", "string", None}:
        return "number or table"
    if options == {"string", None}:
        words = [word for option in kind["anyOf"] for word in option.get("enum", ())]
        return " ".join(f'`"{word}"`' for word in words) + " or table"
    if options == {"string", "array"}:
        return "text or list of numbers"
    if options == {"string", "number"}:
        return "share or size"
    if "enum" in kind or "const" in kind:
        choices = kind.get("enum", [kind.get("const")])
        return " ".join(f'`"{choice}"`' if isinstance(choice, str) else f"`{choice}`" for choice in choices)
    if kind.get("type") == "array":
        return _list(kind)
    if "table" in kind or kind.get("type") == "object":
        return "named tables" if "additionalProperties" in kind and "table" not in kind else "table"
    if kind["type"] == "integer":
        return "count" if kind.get("maximum") == COUNT["maximum"] else "whole number"
    return {"string": "text", "boolean": "`true` `false`"}[kind["type"]]


def _words(kind: dict[str, Any]) -> str:
    """The words that a quantity may be in place of a number, or that a text usually is."""
    return " ".join(f'`"{word}"`' for option in kind.get("anyOf", []) for word in option.get("enum", []))


def _list(kind: dict[str, Any]) -> str:
    if "table" in kind:
        return "list of tables"
    items = kind.get("items", {})
    if "enum" in items:
        return "list of " + " ".join(f'`"{choice}"`' for choice in items["enum"])
    if items.get("type") == "string" or any(item.get("type") == "string" for item in kind.get("prefixItems", [])):
        return "list of texts"
    if "prefixItems" in kind:
        return f"`{_example(kind)}`"
    if items.get("type") == "array" and "prefixItems" in items:
        return f'rows of {len(items["prefixItems"])}, such as `["12 um", "0 um"]`'
    if items.get("type") == "array":
        return "6 rows of 6 numbers" if items.get("minItems") == 6 else f"rows of {_plural(items['items'])}"
    return f"list of {_plural(items)}"


def _example(kind: dict[str, Any]) -> str:
    """A list, or a list of lists, of example quantities."""
    if "prefixItems" in kind:
        return f"[{', '.join(map(_example, kind['prefixItems']))}]"
    return next(f'"{option["examples"][0]}"' for option in kind["anyOf"] if "examples" in option)


def _plural(kind: dict[str, Any]) -> str:
    return _value(kind) if kind.get("x-unit") else "numbers"


def _unit(kind: dict[str, Any]) -> str:
    items = kind.get("prefixItems")
    unit = items[0].get("x-unit", "") if items else kind.get("x-unit", "")
    return f"`{unit}`" if unit else ""


def _bound(kind: dict[str, Any]) -> str:
    numbers = [kind, *(option for option in kind.get("anyOf", []) if option.get("type") == "number")]
    signs = {"exclusiveMinimum": ">", "minimum": "≥", "exclusiveMaximum": "<", "maximum": "≤"}
    if kind.get("type") == "integer" and _value(kind) == "count":
        return ""
    found = [f"{sign} {option[key]:g}" for option in numbers for key, sign in signs.items() if key in option]
    return ", ".join(dict.fromkeys(found))


def _default(value: Any, kind: dict[str, Any]) -> str:
    if value is None or value in ("", ()) or isinstance(value, dict | BaseModel):
        return ""
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    if kind.get("x-unit") == "rad" and value:
        return f'`"{math.degrees(value):.6g} deg"`'
    if isinstance(value, tuple):
        return "`[" + ", ".join(f'"{item}"' if isinstance(item, str) else f"{item:g}" for item in value) + "]`"
    return f'`"{value}"`' if isinstance(value, str) else f"`{value:g}`"


def _library() -> str:
    rows = [["name", "E GPa", "Poisson's ratio", "density kg/m³"]]
    rows += [[f"`{n}`", f"{m.youngs_modulus / 1e9:g}", f"{m.nu:g}", f"{m.density:g}"] for n, m in LIBRARY.items()]
    note = "Handbook values at room temperature. A material of the same name under `[materials]` replaces one of these."
    return f"## Materials of the library\n\n{note}\n\n{_table(rows)}"


def _escaped(text: str) -> str:
    return text.replace("|", "\\|").replace("*", "\\*")


def _table(rows: list[list[str]]) -> str:
    head, *body = [re.sub(r" {2,}", " ", f"| {' | '.join(row)} |") for row in rows]
    return "\n".join([head, "|" + "---|" * len(rows[0]), *body]) + "\n"
