"""Field types of the parts: each carries its unit, its bounds and its place in the JSON Schema.

A part is its own schema: the loader, the error text, the reference page and the schema file all come from these fields. Parts
write `si.Length` for a length that is held in SI.
"""

from __future__ import annotations

import numbers
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any, Literal, Self, get_args

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    ValidationError,
    WithJsonSchema,
    model_validator,
)
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from rotorgear.errors import ModelError
from rotorgear.model.parts.old_names import with_current_names
from rotorgear.model.parts.problems import from_validation
from rotorgear.quantity import DIMENSIONS, LARGEST, QuantityError, parse_quantity
from rotorgear.quantity import in_words as quantity_in_words

MOTIONS = ("bending", "axial", "torsion")
DOF_NAMES = ("x", "y", "z", "tilt_x", "tilt_y", "torsion")
# The word of what does not give at all: flanks that stay in touch, directions in which two parts move as one.
RIGID = "rigid"

# Longest list or table that the repr of a part writes out.
_SHORT = 3


class Part(BaseModel):
    """Base of every part of a model: frozen, without unknown keys, without coercion of strings."""

    # A validator is built when a part is first made: most models have few of the kinds.
    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    def __init__(self, /, **data: Any) -> None:
        try:
            super().__init__(**data)
        except ValidationError as error:
            raise ModelError(from_validation(error, type(self)), type(self).__name__) from None

    # Tells pydantic that parts inside of parts need no call of __init__, so that all their errors come in one list.
    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    @model_validator(mode="before")
    @classmethod
    def _by_current_names(cls, data: Any) -> Any:
        """Read former values as the present ones."""
        return with_current_names(cls.__name__, data) if isinstance(data, dict) else data

    # What a part derives from its fields (cached properties) stands in __dict__ beside them, where pydantic would copy and
    # pickle it: a copy with other fields would go on to answer with the old values, and lazy containers don't pickle.
    def __copy__(self) -> Self:
        twin = super().__copy__()
        for name in twin.__dict__.keys() - type(self).model_fields.keys():
            del twin.__dict__[name]
        return twin

    def __deepcopy__(self, memo: dict[int, Any] | None = None) -> Self:
        return BaseModel.__deepcopy__(self.__copy__(), memo)

    def __getstate__(self) -> dict[Any, Any]:
        state = super().__getstate__()
        fields = type(self).model_fields
        return {**state, "__dict__": {name: value for name, value in self.__dict__.items() if name in fields}}

    def __eq__(self, other: object) -> bool:
        # Field by field: pydantic compares what is derived as well where both have derived it.
        fields = type(self).model_fields
        return type(self) is type(other) and all(getattr(self, name) == getattr(other, name) for name in fields)

    def __repr__(self) -> str:
        """What differs from the defaults; long lists and tables by their length."""
        texts = []
        for name, field in type(self).model_fields.items():
            value = getattr(self, name)
            if isinstance(value, tuple | dict) and len(value) > _SHORT:
                texts.append(f"{len(value)} {name}")
            elif value != field.get_default(call_default_factory=True):
                texts.append(f"{name}={f'{value:.6g}' if isinstance(value, float) else repr(value)}")
        return f"{type(self).__name__}({', '.join(texts)})"

    def __str__(self) -> str:
        return repr(self)

    def __hash__(self) -> int:
        return hash((type(self), *(getattr(self, name) for name in type(self).model_fields)))


def in_words(part: Part, key: str) -> str:
    """The value of a field with its unit; of a table in it the first quantity, of a list the first few entries."""
    return _words(getattr(part, key), unit_of(type(part).model_fields[key]))


def _words(value: Any, unit: Unit | None) -> str:
    if isinstance(value, Part):
        fields = type(value).model_fields
        given = (key for key in fields if isinstance(getattr(value, key), float) and unit_of(fields[key]))
        return next((in_words(value, key) for key in given), "")
    if isinstance(value, tuple | dict):
        entries = list(value.values()) if isinstance(value, dict) else list(value)
        shown = ", ".join(filter(None, (_words(entry, unit) for entry in entries[:_SHORT])))
        return shown + (f" and {len(entries) - _SHORT} more" if len(entries) > _SHORT else "")
    if isinstance(value, float) and unit:
        return quantity_in_words(value, unit.dimension)
    return str(value)


def _marks(about: Any) -> Iterator[Any]:
    """What the type of a field is annotated with, however deep it stands."""
    for item in (*getattr(about, "metadata", ()), *get_args(getattr(about, "annotation", about))):
        yield item
        yield from _marks(item) if get_args(item) else ()


def unit_of(about: Any) -> Unit | None:
    """The first unit in the type of a field."""
    return next((mark for mark in _marks(about) if isinstance(mark, Unit)), None)


def si_unit(about: Any) -> str:
    """SI unit of a field, by the unit or the JSON Schema in its type; "" of one that is no quantity."""
    schemas = (mark.schema() if isinstance(mark, Unit) else getattr(mark, "json_schema", {}) for mark in _marks(about))
    return next((str(schema["x-unit"]) for schema in schemas if "x-unit" in schema), "")


def refuse(text: str) -> PydanticCustomError:
    """The error that says what was expected in place of a value."""
    return PydanticCustomError("quantity", "{text}", {"text": text})


@dataclass(frozen=True)
class Unit:
    """Marks a field of type float as a quantity: read with its unit, held in SI. `bound` is "", "positive" or "non-negative"."""

    dimension: str
    bound: str = ""

    def parse(self, value: Any) -> float:
        """Return a value of the file in SI; the error that pydantic gets otherwise says what was expected."""
        try:
            number = parse_quantity(value, self.dimension)
        except QuantityError as error:
            raise refuse(str(error)) from error
        # The least positive number keeps its reciprocal and its powers finite.
        if (self.bound == "positive" and number < 1.0 / LARGEST) or (self.bound == "non-negative" and number < 0.0):
            wanted = DIMENSIONS[self.dimension]
            noun = wanted.phrase.removeprefix("an ").removeprefix("a ")
            raise refuse(f"a {self.bound} {noun} such as '{wanted.example}'")
        return number

    def schema(self) -> dict[str, Any]:
        """Return the JSON Schema: a number in SI or a text with a unit."""
        wanted = DIMENSIONS[self.dimension]
        number: dict[str, Any] = {"type": "number"}
        if self.bound == "positive":
            number["exclusiveMinimum"] = 0
        elif self.bound == "non-negative":
            number["minimum"] = 0
        text = {"type": "string", "examples": [wanted.example], "pattern": r"^\s*[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?"}
        description = f"{wanted.phrase} (SI: {wanted.unit or '-'})"
        return {"anyOf": [number, text], "description": description, "x-unit": wanted.unit}

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_before_validator_function(self.parse, handler(source))

    def __get_pydantic_json_schema__(self, _: CoreSchema, __: GetJsonSchemaHandler) -> dict[str, Any]:
        return self.schema()


@dataclass(frozen=True)
class UnitOrRigid(Unit):
    """A quantity, or the word of what does not give at all."""

    def parse(self, value: Any) -> Any:
        """The word, or the quantity in SI."""
        return value if value == RIGID else super().parse(value)

    def schema(self) -> dict[str, Any]:
        """A number in SI, a text with a unit, or the word."""
        plain = super().schema()
        return {**plain, "anyOf": [*plain["anyOf"], {"type": "string", "enum": [RIGID]}]}


Length = Annotated[float, Unit("length")]
PositiveLength = Annotated[float, Unit("length", "positive")]
NonNegativeLength = Annotated[float, Unit("length", "non-negative")]
Angle = Annotated[float, Unit("angle")]
Speed = Annotated[float, Unit("speed")]
Time = Annotated[float, Unit("time", "non-negative")]
PositiveTime = Annotated[float, Unit("time", "positive")]
Rate = Annotated[float, Unit("rate", "non-negative")]
Mass = Annotated[float, Unit("mass", "non-negative")]
PositiveMass = Annotated[float, Unit("mass", "positive")]
Inertia = Annotated[float, Unit("inertia", "non-negative")]
Density = Annotated[float, Unit("density", "positive")]
Modulus = Annotated[float, Unit("modulus", "positive")]
Torque = Annotated[float, Unit("torque", "non-negative")]
Power = Annotated[float, Unit("power", "non-negative")]
Stiffness = Annotated[float, Unit("stiffness", "non-negative")]
StiffnessOrRigid = Annotated[float | str, UnitOrRigid("stiffness", "non-negative")]
SignedStiffness = Annotated[float, Unit("stiffness")]
StiffnessPerArea = Annotated[float, Unit("stiffness_per_area", "positive")]
Frequency = Annotated[float, Unit("frequency", "positive")]
RotationalStiffness = Annotated[float, Unit("rotational_stiffness", "non-negative")]
RotationalStiffnessOrRigid = Annotated[float | str, UnitOrRigid("rotational_stiffness", "non-negative")]
Damping = Annotated[float, Unit("damping", "non-negative")]
SignedDamping = Annotated[float, Unit("damping")]
RotationalDamping = Annotated[float, Unit("rotational_damping", "non-negative")]
Ratio = Annotated[float, Unit("ratio", "non-negative")]
PositiveRatio = Annotated[float, Unit("ratio", "positive")]
SignedRatio = Annotated[float, Unit("ratio")]
Force = Annotated[float, Unit("force", "non-negative")]
Viscosity = Annotated[float, Unit("viscosity", "non-negative")]
Temperature = Annotated[float, Unit("temperature", "positive")]
SpecificHeat = Annotated[float, Unit("specific_heat", "positive")]
UnbalanceSize = Annotated[float, Unit("unbalance", "non-negative")]
Acceleration = Annotated[float, Unit("acceleration")]


def _parse_station(value: Any) -> float | str:
    if isinstance(value, str) and value in ("start", "end"):
        return value
    try:
        return parse_quantity(value, "length")
    except QuantityError as error:
        raise refuse("a position along z such as '120 mm', or 'start' or 'end' of the shaft") from error


_LENGTH = Unit("length").schema()
Station = Annotated[
    float | Literal["start", "end"],
    BeforeValidator(_parse_station),
    WithJsonSchema(
        {
            **_LENGTH,
            "anyOf": [*_LENGTH["anyOf"], {"type": "string", "enum": ["start", "end"]}],
            "description": "z of the place, or 'start' or 'end' of the shaft",
        }
    ),
]


def listed(count: int, expected: str) -> BeforeValidator:
    """Refuses all but a list of `count` entries; `expected` says what it should have been."""

    def parse(value: Any) -> Any:
        if not isinstance(value, list | tuple) or len(value) != count:
            raise refuse(expected)
        return value

    return BeforeValidator(parse)


def _parse_position(value: Any) -> Any:
    if not isinstance(value, list | tuple) or len(value) not in (2, 3):
        raise refuse(
            "x and y of the axis such as ['0 mm', '120 mm'], or x, y and z of its z = 0, "
            "or { mesh = 'stage_2', angle = '52 deg' }"
        )
    return value


def parse_direction(value: Any) -> tuple[float, ...]:
    """Three numbers that are not all 0, of a direction.

    Raises:
        PydanticCustomError: others.
    """
    wanted = "x, y and z of a direction such as [0, 0.6, 0.8]; its length does not matter"
    try:
        x, y, z = (parse_quantity(part, "ratio") for part in value)
    except (TypeError, ValueError, QuantityError):
        raise refuse(wanted) from None
    if not 1e-9 <= max(abs(x), abs(y), abs(z)) <= 1e9:
        raise refuse(wanted)
    return x, y, z


Position = Annotated[
    tuple[Length, ...],
    BeforeValidator(_parse_position),
    WithJsonSchema(
        {
            "type": "array",
            "minItems": 2,
            "maxItems": 3,
            "items": Unit("length").schema(),
            "description": "x and y of the axis, or x, y and z of its z = 0",
        }
    ),
]
Direction = Annotated[
    tuple[float, float, float],
    BeforeValidator(parse_direction),
    WithJsonSchema(
        {
            "type": "array",
            "minItems": 3,
            "maxItems": 3,
            "items": {"type": "number"},
            "description": "x, y and z of a direction, of any length",
        }
    ),
]
Gravity = Annotated[
    tuple[Acceleration, Acceleration, Acceleration],
    listed(3, "its x, y and z such as ['0 m/s^2', '-9.81 m/s^2', '0 m/s^2']"),
]


def _parse_matrix(value: Any) -> tuple[tuple[float, ...], ...]:
    rows = value if isinstance(value, list | tuple) else ()
    if len(rows) != 6 or any(not isinstance(row, list | tuple) or len(row) != 6 for row in rows):
        raise refuse("6 rows of 6 numbers in SI, rows and columns x y z tilt_x tilt_y torsion")
    return tuple(tuple(_cell(x, f"row {i}, column {j}") for j, x in enumerate(row, 1)) for i, row in enumerate(rows, 1))


def _cell(value: Any, place: str) -> float:
    """A plain number: the entries of a 6 x 6 have several units, so that they are given in SI."""
    if isinstance(value, str):
        raise refuse(f"plain numbers in SI, without units; {place} is a text")
    try:
        return parse_quantity(value, "ratio")
    except QuantityError as error:
        raise refuse(f"finite numbers in SI; that of {place} is none") from error


Matrix6 = Annotated[
    tuple[tuple[float, ...], ...],
    BeforeValidator(_parse_matrix),
    WithJsonSchema(
        {
            "type": "array",
            "minItems": 6,
            "maxItems": 6,
            "items": {"type": "array", "minItems": 6, "maxItems": 6, "items": {"type": "number"}},
            "description": "6 x 6 in SI, rows and columns x y z tilt_x tilt_y torsion",
        }
    ),
]

_MOST = 100_000


def _whole(value: Any) -> int:
    """No 29.0, no "29" and no true for 1."""
    if isinstance(value, bool) or not isinstance(value, numbers.Integral) or not 1 <= int(value) <= _MOST:
        raise refuse(f"a whole number from 1 to {_MOST}")
    return int(value)


Whole = Annotated[int, BeforeValidator(_whole), WithJsonSchema({"type": "integer", "minimum": 1, "maximum": _MOST})]
Flag = Annotated[bool, Field(strict=True)]


def _parse_name(name: str) -> str:
    if len(name) > 60 or not re.fullmatch(r"[\w-](?:[\w -]*[\w-])?", name) or not re.search(r"[^\W_]", name):
        raise refuse("a short name of letters, digits, _ and - such as 'input_left'")
    return name


# Names stand in addresses, tables, files and groups of files: dots, brackets and slashes would be read as something else.
Name = Annotated[str, AfterValidator(_parse_name), WithJsonSchema({"type": "string"})]
