"""Quantities with units at the border: "2.75 mm" -> 0.00275. Inside, everything is SI and radians.

Units are looked up by `pint`; a text is a number and a unit, never an expression, and the radian counts as a unit of its own.
Rotational speed and frequency are kept apart by hand, because dimensional analysis can't tell them apart: 50 Hz is no
rotational speed until one says whether it means turns or radians, so a speed takes rpm, deg/s or rad/s, and a frequency
takes Hz or cycles (or turns) per minute.
"""

from __future__ import annotations

import math
import numbers
import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, SupportsFloat

from rotorgear.common_units import COMMON_UNITS
from rotorgear.errors import RotorgearError
from rotorgear.files.bounds import LONGEST_QUANTITY
from rotorgear.files.numbers import NUMBER


@dataclass(frozen=True)
class Dimension:
    """A physical dimension of the model file: its SI unit, how an error names it, and an example."""

    name: str
    unit: str
    phrase: str
    example: str


_TABLE = [
    ("length", "m", "a length", "20 mm"),
    ("angle", "rad", "an angle", "20 deg"),
    ("speed", "rad/s", "a rotational speed", "1500 rpm"),
    ("frequency", "Hz", "a frequency", "361 Hz"),
    ("time", "s", "a time", "2e-5 s"),
    ("rate", "1/s", "a rate", "12 1/s"),
    ("mass", "kg", "a mass", "3.2 kg"),
    ("inertia", "kg*m^2", "a moment of inertia", "0.02 kg m^2"),
    ("density", "kg/m^3", "a density", "7850 kg/m^3"),
    ("modulus", "Pa", "an elastic modulus", "206 GPa"),
    ("torque", "N*m", "a torque", "120 N m"),
    ("power", "W", "a power", "2.5 MW"),
    ("stiffness", "N/m", "a stiffness", "2e8 N/m"),
    ("stiffness_per_area", "N/m^3", "a stiffness per area or a cubic stiffness", "1e13 N/m^3"),
    ("rotational_stiffness", "N*m/rad", "a rotational stiffness", "1e5 N m/rad"),
    ("unbalance", "kg*m", "an unbalance", "20 g mm"),
    ("acceleration", "m/s^2", "an acceleration", "9.81 m/s^2"),
    ("force", "N", "a force", "500 N"),
    ("viscosity", "Pa*s", "a dynamic viscosity", "0.01 Pa s"),
    ("temperature", "K", "a temperature", "45 degC"),
    ("specific_heat", "J/(kg*K)", "a specific heat", "1900 J/(kg K)"),
    ("damping", "N*s/m", "a damping coefficient", "500 N s/m"),
    ("rotational_damping", "N*m*s/rad", "a rotational damping coefficient", "2 N m s/rad"),
    ("ratio", "", "a ratio", "0.05"),
]
DIMENSIONS = {row[0]: Dimension(*row) for row in _TABLE}

_NUMBER_AND_UNIT = re.compile(rf"({NUMBER})(.*)\Z", re.DOTALL)
_UNIT_TEXT = re.compile(r"[A-Za-z0-9µμ°·²³*/^()\s%-]*\Z")
_EXPONENT_OR_RECIPROCAL = re.compile(r"\^\s*-?[0-9](?![0-9])|^1(?=\s*/)")
# No length, mass, stiffness ... of a machine comes near this bound, and powers and products within it stay finite.
LARGEST = 1e30
# Revolutions per minute in a radian per second.
RPM_PER_RAD_S = 30.0 / math.pi
ZERO_CELSIUS = 273.15  # 0 deg C in K
GRAVITY = 9.80665  # standard acceleration of gravity in m/s^2
_TURN = 2.0 * math.pi
# Spellings that the table of common units does not tell apart.
_SPELLING = str.maketrans({"*": " ", "^": "", "\u00b5": "u", "\u03bc": "u"})
# Factors to SI where a frequency and a rotational speed would be mixed up by dimensional analysis alone.
_RPM = _TURN / 60
_SPEED_UNITS = {"rpm": _RPM, "1/min": _RPM, "rev/min": _RPM, "rev/s": _TURN, "rad/s": 1.0, "deg/s": _TURN / 360}
_SPEED_UNITS |= {"krpm": 1000 * _RPM, "RPM": _RPM, "min^-1": _RPM, "r/min": _RPM}
_FREQUENCY_UNITS = {"Hz": 1.0, "kHz": 1e3, "MHz": 1e6, "mHz": 1e-3, "cpm": 1 / 60, "rpm": 1 / 60, "rad/s": 1 / _TURN}
# Temperatures have a zero of their own: factor to K, and K at 0 of the unit.
_TEMPERATURE_UNITS = {"K": (1.0, 0.0), "degF": (5.0 / 9.0, 459.67 * 5.0 / 9.0)}
_TEMPERATURE_UNITS |= dict.fromkeys(("degC", "°C", "C"), (1.0, ZERO_CELSIUS))


class QuantityError(ValueError):
    """The text is no quantity of the wanted dimension; the message says what was expected."""


def parse_quantity(value: Any, dimension: str) -> float:
    """Return `value` in SI as a finite float.

    Args:
        value: a plain number (taken as SI) or a text of number and unit, such as "2.75 mm".
        dimension: a key of `DIMENSIONS`.

    Raises:
        QuantityError: not a quantity of that dimension; the text is what was expected, with an example.
    """
    wanted = DIMENSIONS[dimension]
    number, unit = _number_and_unit(value, wanted)
    if unit is None:
        return number
    if dimension == "temperature":
        if unit not in _TEMPERATURE_UNITS:
            raise QuantityError(f"{_expected(wanted)}; units: {', '.join(_TEMPERATURE_UNITS)}")
        factor, zero = _TEMPERATURE_UNITS[unit]
        return _sensible(number * factor + zero, wanted)
    return _sensible(_sensible(number, wanted) * _factor(unit, wanted), wanted)


def parse_in_unit(value: Any, unit: str) -> float:
    """Return `value` in SI as a finite float, for a quantity that is declared by its SI unit alone, such as "N s/m".

    Raises:
        QuantityError: not a quantity of that unit.
    """
    key = unit.replace(" ", "*")
    name = "ratio" if key == "rad/rad" else next((item.name for item in DIMENSIONS.values() if item.unit == key), None)
    if name is not None:
        return parse_quantity(value, name)
    wanted = Dimension("", key, f"a number in {unit}", f"1 {unit}")
    number, given = _number_and_unit(value, wanted)
    return number if given is None else _sensible(number * _factor_by_pint(given, wanted), wanted)


def split_number(text: str) -> tuple[float, str]:
    """The number that a text begins with, and what follows it: "85 mm" is 85.0 and " mm".

    Raises:
        ValueError: it begins with none.
    """
    found = _NUMBER_AND_UNIT.match(text.strip())
    if found is None:
        raise ValueError(f"no number: {text}")
    return float(found[1]), found[2]


def _number_and_unit(value: Any, wanted: Dimension) -> tuple[float, str | None]:
    """A number and its unit; a plain number is one in SI, of no unit, and has a sensible size."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real | str):
        raise QuantityError(_expected(wanted))
    if not isinstance(value, str):
        return _sensible(value, wanted), None
    match = _NUMBER_AND_UNIT.match(value.strip()) if len(value) <= LONGEST_QUANTITY else None
    if match is None or not _UNIT_TEXT.match(match[2]):
        raise QuantityError(_expected(wanted) + ("; decimals take a point" if "," in value else ""))
    return float(match[1]), " ".join(match[2].split())


def _expected(wanted: Dimension) -> str:
    return f"{wanted.phrase} such as '{wanted.example}'"


def _sensible(value: SupportsFloat, wanted: Dimension) -> float:
    """Return a finite number of a size that calculations can bear."""
    try:
        number = float(value)
    except (OverflowError, ValueError):  # a whole number of hundreds of digits
        number = math.inf
    if not math.isfinite(number):
        raise QuantityError(f"a finite number: {_expected(wanted)}")
    if abs(number) > LARGEST:
        raise QuantityError(f"a number of sensible size: {_expected(wanted)}")
    return number


@lru_cache(maxsize=512)
def _factor(unit: str, wanted: Dimension) -> float:
    """Return the factor from `unit` to the SI unit of a dimension."""
    if wanted.name in ("speed", "frequency"):
        table = _SPEED_UNITS if wanted.name == "speed" else _FREQUENCY_UNITS
        key = unit.replace(" ", "")
        if key not in table:
            raise QuantityError(f"{_expected(wanted)}; units: {', '.join(list(table)[:7])}")
        return table[key]
    if wanted.name == "ratio":
        if unit in ("", "%"):
            return 0.01 if unit == "%" else 1.0
        raise QuantityError(_expected(wanted))
    if not unit:
        raise QuantityError(f"{_expected(wanted)}; a number in SI stands without quotes")
    common = COMMON_UNITS[wanted.name].get(unit.translate(_SPELLING))
    return _factor_by_pint(unit, wanted) if common is None else common


def _factor_by_pint(unit: str, wanted: Dimension) -> float:
    """Return the factor from any unit that pint knows to the SI unit of a dimension."""
    _, needed = _base_units(wanted.unit)  # outside: if this fails, it is not what the user wrote
    try:
        factor, given = _base_units(_expression(unit))
    except Exception as error:  # pint raises many kinds: undefined unit, offset unit, bad syntax, too deep
        raise QuantityError(_expected(wanted)) from error
    # "N m" for a rotational stiffness or damping is customary: its radian may be left out.
    without = {key: power for key, power in needed.items() if key != "radian"}
    if given != needed and not (wanted.name and given and given == without):
        raise QuantityError(_expected(wanted))
    return factor


def _expression(unit: str) -> str:
    """Write a unit as pint reads it; ValueError for numbers other than exponents and a leading 1/."""
    text = unit.replace("·", "*").replace("²", "^2").replace("³", "^3").replace("**", "^")
    text = re.sub(r"(?<=[A-Za-z])([2-4])(?![0-9])", r"^\1", text)  # mm2
    if re.search("[0-9%]", _EXPONENT_OR_RECIPROCAL.sub("", text)):
        raise ValueError(unit)
    return text.replace("^", "**")


def _base_units(unit: str) -> tuple[float, dict[str, float]]:
    """Return the factor to SI and the exponents of kilogram, meter, second, radian ..."""
    registry = _registry()
    factor, base = registry.get_base_units(registry.parse_units(unit.replace("^", "**")))
    return float(factor), {key: float(power) for key, power in base._units.items()}


@lru_cache(maxsize=1)
def _registry() -> Any:
    import pint

    try:
        registry: Any = pint.UnitRegistry(on_redefinition="ignore")
    except Exception as error:  # versions of pint and of what it builds on that do not fit together
        raise RotorgearError(
            f"pint {pint.__version__} can't read its own list of units ({error}): install pint 0.24.4 or newer"
        ) from error
    registry.define("newton_meter = newton * meter = Nm")  # written without a blank by every engineer
    registry.define("newton_millimeter = newton * millimeter = Nmm")
    return registry


def millimetres(length: float) -> str:
    """Write a length in m as an engineer reads it: 0.0275 -> "27.5 mm"."""
    return f"{1e3 * length + 0.0:.6g} mm"


# Units in which an engineer reads a small or a turning quantity: up to which size in SI, times, unit.
_READ_IN = {
    "length": ((1e-3, 1e6, "um"), (1.0, 1e3, "mm")),
    "angle": ((math.inf, 180.0 / math.pi, "deg"),),
    "speed": ((math.inf, RPM_PER_RAD_S, "rpm"),),
    "unbalance": ((1.0, 1e6, "g mm"),),
}


def in_words(value: float, dimension: str) -> str:
    """Write a value in SI as an engineer reads it: 4e-5 of a length is "40 um"."""
    for limit, times, unit in _READ_IN.get(dimension, ()):
        if abs(value) < limit:
            return f"{value * times:.6g} {unit}"
    return f"{value:.4g} {DIMENSIONS[dimension].unit.replace('*', ' ')}".rstrip()


def in_two_digits(value: float) -> str:
    """A number from 10 on in two digits, without a power of ten: 1234 is 1200."""
    return f"{float(f'{value:.2g}'):.0f}"


def counted(number: int, what: str) -> str:
    """So many of what is named in the plural, or by its table: "1 mesh", "4 point masses", "1 frequency"."""
    words = what.replace("_", " ")
    if number != 1:
        return f"{number} {words}"
    if words.endswith("ies"):
        return f"1 {words.removesuffix('ies')}y"
    return f"1 {words.removesuffix('es' if words.endswith(('shes', 'sses', 'ches')) else 's')}"


def nearest(name: str, valid: list[str]) -> str:
    """Return the valid name that is closest to `name`, or "" where none is close."""
    import difflib

    lower = {candidate.lower(): candidate for candidate in reversed(valid)}
    found = difflib.get_close_matches(name.lower(), list(lower), n=1, cutoff=0.55)
    return lower[found[0]] if found else ""


def did_you_mean(name: str, valid: Iterable[str], otherwise: str = "") -> str:
    """The hint of a name that is not valid: the valid one that is closest, or what to say where none is close."""
    guess = nearest(name, list(valid))
    return f"did you mean '{guess}'?" if guess else otherwise
