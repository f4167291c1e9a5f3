"""Every analysis marks its result in one place: with its arguments, the hash of its model, the time it took, and warnings of
values of the model that make no sense."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import wraps
from numbers import Real
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import numpy as np

from rotorgear.cpu import Clock
from rotorgear.errors import AnalysisError, ConvergenceError, Interrupted, RotorgearError
from rotorgear.model.checks.bearings import estimated, one_sided
from rotorgear.model.checks.plausibility import implausible, implausible_speed
from rotorgear.model.model import Model, model_hash
from rotorgear.results.result import Result
from rotorgear.results.schema import Record

P = ParamSpec("P")
R = TypeVar("R", bound=Result)
# They say how the work is done or watched, and change no number.
_NOT_SETTINGS = ("progress", "stream", "executor", "critical_speeds")
_LISTS = ("Sequence", "Iterable", "Collection", "list", "tuple")
# Arguments that are speeds of the input shaft; a transient's may be pairs of time and speed.
_SPEEDS = ("speed", "speed_to", "start", "stop", "speeds")


def recorded(analysis: Callable[P, R]) -> Callable[P, R]:
    """Wrap an analysis so that its result carries settings, model hash and seconds.

    The first argument is what is analysed (a model, a system, or another result) and no setting.

    Raises:
        AnalysisError: by the analysis; a model is to be analysed and the first argument is none; memory is not enough.
        ConvergenceError: by the analysis; its numbers are beyond double precision.
    """
    signature = inspect.signature(analysis)
    first = next(iter(signature.parameters.values()))
    analysed = {name.strip() for name in str(first.annotation).split("|")}

    @wraps(analysis)
    def run(*args: P.args, **kwargs: P.kwargs) -> R:
        clock = Clock()
        bound = signature.bind(*args, **kwargs)
        bound.apply_defaults()
        (_, subject), *given = bound.arguments.items()
        if "Model" in analysed and not any(kind.__name__ in analysed for kind in type(subject).__mro__):
            raise AnalysisError(f"{analysis.__name__}: {_no_model(subject)}")
        for name, value in given:
            _check_list(name, value, str(signature.parameters[name].annotation))
        stopped = False
        try:
            result = analysis(*args, **kwargs)
        except Interrupted as stop:
            result = stop.result
            stopped = True
        except MemoryError as error:
            words = " ".join(str(error).split()) or "it is full"
            raise AnalysisError(f"{analysis.__name__}: not enough memory ({words}); ask for less at a time") from None
        except (np.linalg.LinAlgError, OverflowError) as error:
            cause = f"; look at {_farthest(subject)}" if isinstance(subject, Model) else ""
            raise ConvergenceError(
                f"{analysis.__name__}: the equations can't be solved in double precision ({error}){cause}"
            ) from error
        settings = {name: setting(value) for name, value in given if name not in _NOT_SETTINGS}
        clock.lap("analysis")
        seconds = result.seconds or clock.total()
        doubts = tuple(_doubts(subject, dict(given))) if isinstance(subject, Model) else ()
        warnings = tuple(dict.fromkeys((*result.warnings, *doubts)))
        result = replace(result, settings=settings, model_hash=hash_of(subject), seconds=seconds, warnings=warnings)
        if stopped:
            raise Interrupted(result)
        return result

    return run


def _farthest(model: Model) -> str:
    """Address and value of the number that is most decades away from 1: solvers fail at those, not at what is usual."""
    most = ("the model's numbers", 0.0, 1.0)

    def walk(value: Any, address: str) -> None:
        nonlocal most
        if isinstance(value, dict):
            for key, entry in value.items():
                walk(entry, f"{address}.{key}" if address else str(key))
        elif isinstance(value, list):
            for number, entry in enumerate(value):
                walk(entry, f"{address}[{number}]")
        elif isinstance(value, float) and value and abs(np.log10(abs(value))) > most[1]:
            most = (address, abs(np.log10(abs(value))), value)

    walk(model.model_dump(mode="json", exclude_none=True), "")
    return f"{most[0]}, {most[2]:.4g} in SI"


def _check_list(name: str, value: Any, annotation: str) -> None:
    """Refuse a text or a number where a list of such is meant: a text would be read letter by letter."""
    if isinstance(value, bool) or not isinstance(value, str | Real):
        return
    alone = [kind.strip() for kind in re.sub(r"\[[^\[\]]*\]", "[]", re.sub(r"\[[^\[\]]*\]", "", annotation)).split("|")]
    listed = any(kind.partition("[")[0] in _LISTS for kind in alone)
    taken = ("str", "Path", "Any") if isinstance(value, str) else ("float", "int", "np.ndarray", "Any")
    if listed and not any(kind in taken for kind in alone):
        raise AnalysisError(f"{name}: got {value!r}, expected a list, such as [{value!r}]")


def _doubts(model: Model, given: Mapping[str, Any]) -> Iterator[str]:
    """Sentences on values of a model, and on what an analysis was asked for, that are far from all that is built.

    A text carries its unit; a bare number is in SI, where 12000 is no rpm.
    """
    yield from implausible(model.layout)
    yield from one_sided(model.layout)
    yield from estimated(model.layout)
    for name in _SPEEDS:
        if bare := [abs(value) for value in _numbers(given.get(name))]:
            yield from implausible_speed(model.layout, name, max(bare))
    over = given.get("over")
    for address, values in over.items() if isinstance(over, Mapping) else ():
        # Names without a dot, as speed or the torque of a mesh map, are no addresses.
        if bare := [value for value in _numbers(values) if "." in address]:
            for extreme in {min(bare), max(bare)}:
                # One value alone may not fit the model where a point of two parameters does: no doubt ends an answer.
                with suppress(RotorgearError):
                    yield from implausible(model.with_(address, extreme).layout)


def _numbers(value: Any) -> Iterator[float]:
    """The bare numbers of an argument: itself, those of a list, or the second ones of pairs."""
    if isinstance(value, Real) and not isinstance(value, bool):
        yield float(value)
    elif isinstance(value, list | tuple | np.ndarray | range):
        for entry in value:
            yield from _numbers(entry[-1] if isinstance(entry, list | tuple) and entry else entry)


def _no_model(subject: Any) -> str:
    """What was given in place of a model, and how to get one from it."""
    if isinstance(subject, str | Path):
        return f"got the text '{subject}', expected a model; read its file first: rotorgear.load('{subject}')"
    kind = type(subject).__name__
    if isinstance(getattr(subject, "model", None), Model):
        return f"got the {kind}, expected the model in it (.model)"
    return f"got {kind}, expected a model, as rotorgear.load gives it"


def hash_of(subject: Any) -> str:
    """Hash of the model that something is, or belongs to; "" without one."""
    if isinstance(subject, Result):
        return subject.model_hash
    model = subject if isinstance(subject, Model) else getattr(subject, "model", None)
    return model_hash(model) if isinstance(model, Model) else ""


def setting(value: Any) -> Any:
    """An argument as plain values: what JSON and HDF5 can hold."""
    if isinstance(value, bool | int | float | str) or value is None:
        return value
    if isinstance(value, np.generic | np.ndarray):
        return setting(value.tolist())
    if isinstance(value, Mapping):
        return {str(key): setting(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple | set | frozenset | range):
        return tuple(setting(entry) for entry in value)
    if isinstance(value, Result):
        return value.kind
    if isinstance(value, Record):
        return setting(value.to_dict())
    if isinstance(value, Path):
        return str(value)
    return getattr(value, "__name__", None) or repr(value)
