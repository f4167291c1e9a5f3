"""The field `stiffness` of a mesh: a stiffness with its unit, a list of them over one mesh period, or a model's name."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, WithJsonSchema

from rotorgear.model.fields import Unit, refuse
from rotorgear.quantity import DIMENSIONS, nearest

# Names of the stiffness models, as gears/mesh_stiffness.py has them; a test compares both, so that no numerics load here.
STIFFNESS_MODELS = ("iso", "contact_line", "potential_energy", "tooth_fe")
_LEAST_VALUES = 3
_UNIT = Unit("stiffness", "positive")


def _parse(value: Any) -> Any:
    if isinstance(value, list | tuple):
        if len(value) < _LEAST_VALUES:
            raise refuse(f"at least {_LEAST_VALUES} stiffnesses, evenly spaced over one mesh period")
        return tuple(_UNIT.parse(item) for item in value)
    if isinstance(value, str) and value.strip() and not any(character.isdigit() for character in value):
        if value in STIFFNESS_MODELS:
            return value
        guess = nearest(value, list(STIFFNESS_MODELS))
        hint = f"; did you mean '{guess}'?" if guess else ""
        raise refuse(f"a stiffness such as '{_example()}' or one of {', '.join(STIFFNESS_MODELS)}{hint}")
    return _UNIT.parse(value)


def _example() -> str:
    return DIMENSIONS["stiffness"].example


def _schema() -> dict[str, Any]:
    one = _UNIT.schema()
    names = {"type": "string", "enum": list(STIFFNESS_MODELS)}
    several = {"type": "array", "minItems": _LEAST_VALUES, "items": {"anyOf": one["anyOf"]}}
    return {**one, "anyOf": [*one["anyOf"], names, several], "description": f"{one['description']}, a list, or a model"}


StiffnessValue = Annotated[float | str | tuple[float, ...], BeforeValidator(_parse), WithJsonSchema(_schema())]
