"""The field `stiffness` of a mesh: a number, a list over one mesh period, a Fourier series, or a stiffness model's name.

The series is k(u) = mean [1 + sum_n a_n cos(2 pi n u + phi_n)], u in mesh periods from contact at the pitch point in the middle
of the face; it is kept as the list of its values, so many that no harmonic is lost.
"""

from __future__ import annotations

import math
from typing import Annotated, Any

from pydantic import BeforeValidator, WithJsonSchema

from rotorgear.gears.stiffness_models import MODELS
from rotorgear.model.parts.fields import Unit, refuse
from rotorgear.quantity import DIMENSIONS, nearest

_LEAST_VALUES = 3
_MOST_HARMONICS = 100
_VALUES_A_HARMONIC = 8
_VALUES = 64
_UNIT = Unit("stiffness", "positive")
_SHARE = Unit("ratio")
_ANGLE = Unit("angle")
_SERIES = ("mean", "amplitudes", "phases")


def _parse(value: Any) -> Any:
    if isinstance(value, dict):
        return _series(value)
    if isinstance(value, list | tuple):
        if len(value) < _LEAST_VALUES:
            raise refuse(f"at least {_LEAST_VALUES} stiffnesses, evenly spaced over one mesh period")
        return tuple(_UNIT.parse(item) for item in value)
    if isinstance(value, str) and value.strip() and not any(character.isdigit() for character in value):
        if value in MODELS:
            return value
        guess = nearest(value, list(MODELS))
        hint = f"; did you mean '{guess}'?" if guess else ""
        raise refuse(f"a stiffness such as '{_example()}' or one of {', '.join(MODELS)}{hint}")
    return _UNIT.parse(value)


def _series(table: dict[str, Any]) -> tuple[float, ...]:
    """Values of a Fourier series over one mesh period."""
    amplitudes = table.get("amplitudes")
    phases = table.get("phases", [])
    if (
        set(table) - set(_SERIES)
        or "mean" not in table
        or not isinstance(amplitudes, list | tuple)
        or not isinstance(phases, list | tuple)
        or not 1 <= len(amplitudes) <= _MOST_HARMONICS
        or len(phases) not in (0, len(amplitudes))
    ):
        raise refuse(
            f"mean, a list of 1 to {_MOST_HARMONICS} amplitudes as shares of it, and as many phases or none, such as "
            f"{{ mean = '{_example()}', amplitudes = [0.1, 0.02], phases = ['0 deg', '90 deg'] }}"
        )
    mean = _UNIT.parse(table["mean"])
    shares = [_SHARE.parse(item) for item in amplitudes]
    angles = [_ANGLE.parse(item) for item in phases] or [0.0] * len(shares)
    count = max(_VALUES, _VALUES_A_HARMONIC * len(shares))
    turns = [2.0 * math.pi * j / count for j in range(count)]
    terms = list(zip(range(1, len(shares) + 1), shares, angles, strict=True))
    values = tuple(mean * (1.0 + sum(a * math.cos(n * turn + phi) for n, a, phi in terms)) for turn in turns)
    if min(values) <= 0.0:
        raise refuse("amplitudes that leave the stiffness positive over the whole mesh period")
    return values


def _example() -> str:
    return DIMENSIONS["stiffness"].example


def _schema() -> dict[str, Any]:
    one = _UNIT.schema()
    names = {"type": "string", "enum": list(MODELS)}
    several = {"type": "array", "minItems": _LEAST_VALUES, "items": {"anyOf": one["anyOf"]}}
    shares = {"type": "array", "minItems": 1, "maxItems": _MOST_HARMONICS, "items": {"type": "number"}}
    angles = {"type": "array", "maxItems": _MOST_HARMONICS, "items": {"anyOf": _ANGLE.schema()["anyOf"]}}
    series = {
        "type": "object",
        "properties": {"mean": {"anyOf": one["anyOf"]}, "amplitudes": shares, "phases": angles},
        "required": ["mean", "amplitudes"],
        "additionalProperties": False,
    }
    text = f"{one['description']}, a list, a Fourier series, or a model"
    return {**one, "anyOf": [*one["anyOf"], names, several, series], "description": text}


StiffnessValue = Annotated[float | str | tuple[float, ...], BeforeValidator(_parse), WithJsonSchema(_schema())]
