"""Options of commands: what typer reads for each, by the type of the verb's argument, and the value that the verb gets."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any

import typer

from rotorgear.cli.verb import REQUIRED, Argument
from rotorgear.errors import AnalysisError
from rotorgear.files.numbers import is_count, number_of, whole_of

# The default of an option that has that of its verb.
AS_VERB = object()
# A pair after a comma in a list of pairs, such as "torque=1 N m,misalignment=0 um"; values may hold commas, too.
_NEXT_PAIR = re.compile(r",(?=[^,=]+=)")
# Arguments that are speeds; `start` and `stop` are the ends of a range of them.
SPEEDS = ("speed", "speeds", "start", "stop", "speed_to", "shape_speed")
_FLAGS = {"start": "--from", "stop": "--to"}
# What typer reads for each kind of option, and what stands for the value in help.
_READS: dict[str, tuple[Any, str]] = {
    "flag": (bool, ""),
    "int": (int, "N"),
    "float": (float, "NUMBER"),
    "text": (str, "TEXT"),
    "quantity": (str, "VALUE"),
    "words": (str, "A,B,..."),
    "numbers": (str, "X,Y,..."),
    "wholes": (str, "N,M,..."),
    "path": (Path, "FILE"),
    "paths": (list[Path], "FILE"),
    "pairs": (list[str], "NAME=VALUE"),
    "texts": (list[str], "TEXT"),
}


@dataclass(frozen=True)
class Option:
    """An option (or argument) of a command.

    Attributes:
        help: what it says of itself.
        kind: int, float, flag, text, path; words, numbers, wholes (in one text, with commas); quantity (a number or a text with
            a unit); texts, paths (given once or more); pairs (NAME=VALUE, once or more).
        default: what stands where it is not given, `REQUIRED` where it must be; `AS_VERB` that of the verb.
        flags: its spellings, where they are not its name.
        least: least value of a number.
        shown: what stands for the value in help.
        read: makes the verb's value of the text, in place of what the kind does.
    """

    help: str = ""
    kind: str = ""
    default: Any = AS_VERB
    flags: tuple[str, ...] = ()
    least: int | None = None
    shown: str | None = None
    read: Callable[[Any], Any] | None = None


def kind_of(annotation: str) -> str:
    """The kind of option that an argument of a type becomes; "" for what only Python can give."""
    types = [part for part in re.split(r" \| (?![^\[]*\])", annotation) if part != "None"]
    if "Path" in types:
        return "path"
    if {"float", "str"} <= set(types):
        return "quantity"
    for name, kind in {"bool": "flag", "str": "text", "int": "int", "float": "float"}.items():
        if name in types:
            return kind
    if types[0].startswith("Mapping["):
        return "pairs"
    if types[0].startswith("Sequence["):
        inner = types[0].removeprefix("Sequence[").removesuffix("]")
        if "Path" in inner:
            return "paths"
        return {"float": "numbers", "int": "wholes"}.get(inner, "words")
    return ""


def option_of(name: str, argument: Argument | None, own: Option | None) -> Option:
    """The option of a verb's argument, with what a command has of its own in place of it."""
    own = own or Option()
    if argument is None:
        return replace(own, default=None) if own.default is AS_VERB else own
    default = argument.default if own.default is AS_VERB else own.default
    kind = own.kind or kind_of(argument.annotation)
    if isinstance(default, tuple):
        default = ",".join(f"{value:g}" if isinstance(value, float) else str(value) for value in default) or None
    elif kind == "quantity" and isinstance(default, int | float):
        default = f"{default:g}"
    # What only Python takes ends the words of an argument.
    text = re.sub(r"[;.] in Python\b.*", ".", own.help or argument.help, flags=re.IGNORECASE).replace("`", "")
    return replace(own, kind=kind, default=default, help=text[:1].upper() + text[1:])


def spelling(name: str) -> str:
    """The option of an argument on the command line."""
    return _FLAGS.get(name, f"--{name.replace('_', '-')}")


def _reader(option: Option) -> Callable[[Any], Any]:
    """What reads a number as pages write it (1_0 is none), and not below its least value.

    What is infinite or no number, the verb refuses with its reason.
    """

    def read(given: Any) -> Any:
        whole = option.kind == "int"
        try:
            value = given if not isinstance(given, str) else whole_of(given) if whole else number_of(given, words=True)
        except ValueError:
            raise typer.BadParameter(f"{given!r} is not a valid {'integer' if whole else 'float'}.") from None
        if option.least is not None and not value >= option.least:
            raise typer.BadParameter(f"{value} is not in the range x>={option.least}.")
        return value

    return read


def parameter(name: str, option: Option, panel: str, positional: bool = False) -> inspect.Parameter:
    """What typer makes the option of."""
    default = ... if option.default is REQUIRED else option.default
    kind, shown = _READS[option.kind]
    settings: dict[str, Any] = {
        "help": option.help,
        "show_default": default not in (None, False, ...),
    }
    if option.kind in ("int", "float"):
        settings["parser"] = _reader(option)
        if option.least is not None:
            settings["help"] = f"{option.help}  [x>={option.least}]"
    if positional:
        info: Any = typer.Argument(
            **settings, metavar=option.shown or ("MODEL" if option.help.startswith("Model") else None)
        )
    else:
        flags = option.flags or (spelling(name),)
        if option.kind == "flag":
            default = bool(default)
            if default and not option.flags:
                flags = (f"{flags[0]}/--no-{flags[0][2:]}",)
        info = typer.Option(*flags, rich_help_panel=panel, metavar=option.shown or shown or None, **settings)
    if default is None:
        kind |= None
    return inspect.Parameter(
        name,
        inspect.Parameter.KEYWORD_ONLY,
        default=inspect.Parameter.empty if default is ... else default,
        annotation=Annotated[kind, info],
    )


def value_of(name: str, option: Option, given: Any) -> Any:
    """The verb's value of what was given.

    Raises:
        AnalysisError: with the option, what was given and what was expected.
    """
    flag = next((flag for flag in option.flags if flag.startswith("--")), spelling(name))
    if option.read is not None:
        return option.read(given)
    if option.kind == "pairs":
        return pairs_of(flag, given, option.shown or "NAME=VALUE")
    if option.kind in ("numbers", "wholes"):
        return numbers_of(flag, given, whole=option.kind == "wholes", zero=option.least == 0)
    if option.kind == "words":
        words = [word.strip() for word in given.split(",") if word.strip()]
        return [speed_of(flag, word) for word in words] if name in SPEEDS else words
    if option.kind == "quantity" and name in SPEEDS:
        return speed_of(flag, given)
    return given


def speed_of(flag: str, text: str) -> float:
    """A speed in rad/s.

    Raises:
        AnalysisError: something else.
    """
    from rotorgear.quantity import QuantityError, parse_quantity

    if text.strip() == "0":
        return 0.0
    try:
        return parse_quantity(text, "speed")
    except QuantityError as error:
        raise AnalysisError(f"{flag}: got '{text}', expected {error}") from None


def numbers_of(flag: str, text: str, *, whole: bool = False, zero: bool = False) -> tuple[float, ...]:
    """Positive numbers with commas between, such as "1,2,0.5"; "none" for none; `zero` lets 0 stand among them.

    Raises:
        AnalysisError: something else.
    """
    if text.strip() in ("", "none"):
        return ()
    try:
        numbers = tuple(number_of(part, words=True) for part in text.split(","))
    except ValueError:
        numbers = (-1.0,)
    if any(
        not 0.0 <= number < float("inf") or (number == 0.0 and not zero) or (whole and number != int(number))
        for number in numbers
    ):
        what = "whole numbers such as 1,2,3" if whole else "positive numbers such as 0.5,1,2"
        raise AnalysisError(f"{flag}: got '{text}', expected {what} (or none)")
    return tuple(int(number) for number in numbers) if whole else numbers


def pairs_of(flag: str, texts: list[str], shown: str) -> dict[str, str]:
    """Texts by name from NAME=VALUE, given several times or with commas between.

    Raises:
        AnalysisError: something else, or a name twice.
    """
    pairs: dict[str, str] = {}
    for text in (part for given in texts for part in _NEXT_PAIR.split(given)):
        name, _, value = (part.strip() for part in text.partition("="))
        if not name or not value:
            raise AnalysisError(f"{flag}: got '{text}', expected {shown}")
        if name in pairs:
            raise AnalysisError(f"{flag}: '{name}' is given twice")
        pairs[name] = value
    return pairs


def axes_of(texts: list[str]) -> dict[str, list[float]]:
    """Values in SI over which a mesh is mapped, from texts such as 'torque=500 N m:2000 N m:4'.

    Raises:
        AnalysisError: no such axis, or values that are none.
    """
    from rotorgear.quantity import QuantityError, parse_quantity

    axes: dict[str, list[float]] = {}
    for name, values in pairs_of("--over", texts, "torque=... or misalignment=...").items():
        dimension = {"torque": "torque", "misalignment": "length"}.get(name)
        if dimension is None:
            raise AnalysisError(f"--over: got '{name}={values}', expected torque=... or misalignment=...")
        parts = [part.strip() for part in values.split(":")]
        count = int(parts.pop()) if len(parts) == 3 and is_count(parts[2]) else None
        try:
            numbers = [parse_quantity(part, dimension) for part in parts]
        except QuantityError as error:
            raise AnalysisError(
                f"--over {name}: got '{values}', expected {error}, such as '500 N m:2000 N m:4'"
            ) from None
        if count is None:
            axes[name] = numbers
        elif 2 <= count <= 1000:
            first, last = numbers
            axes[name] = [first + (last - first) * i / (count - 1) for i in range(count)]
        else:
            raise AnalysisError(f"--over {name}: got {count} values, expected 2 to 1000")
    return axes
