"""Compiled: one number for each of BATCH systems as a value of its own, so that loops over systems need no loops.

An array of lanes has the systems as its last axis, is contiguous, and is read and written row by row: row i are the BATCH
numbers from i BATCH on, whatever the axes before. The values add, subtract and multiply with each other and with numbers;
products may be fused with sums. They turn into vector instructions as wide as the machine has, without the checks for
overlapping arrays that keep a compiler from doing so with loops.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

import numba
import numpy as np
from llvmlite import ir
from numba.core import types
from numba.core.datamodel import models
from numba.core.typing.templates import infer_global, make_concrete_template, signature
from numba.extending import intrinsic, lower_builtin, register_model

from rotorgear.solvers.time.compiled import compiled

BATCH = 32
_VECTOR = ir.VectorType(ir.DoubleType(), BATCH)
_FLAGS = ("contract", "nsz")


class LaneType(types.Type):
    """Type of the values."""

    def __init__(self) -> None:
        super().__init__(name=f"Lanes{BATCH}")


@register_model(LaneType)
def _model(manager: Any, lane_type: Any) -> models.PrimitiveModel:
    """How compiled code holds them: a vector register, or several."""
    return models.PrimitiveModel(manager, lane_type, _VECTOR)


lanes = LaneType()


def _place(context: Any, builder: Any, array_type: Any, array: Any, row: Any) -> Any:
    """Pointer to a row of an array."""
    data = context.make_array(array_type)(context, builder, array).data
    at = builder.gep(data, [builder.mul(row, ir.Constant(row.type, BATCH))])
    return builder.bitcast(at, _VECTOR.as_pointer())


def _splat(builder: Any, number: Any) -> Any:
    """A number for all lanes."""
    blank = ir.Constant(_VECTOR, ir.Undefined)
    first = builder.insert_element(blank, number, ir.Constant(ir.IntType(32), 0))
    return builder.shuffle_vector(first, blank, ir.Constant(ir.VectorType(ir.IntType(32), BATCH), [0] * BATCH))


@intrinsic
def fill(typing: Any, number: Any) -> Any:
    """A number for all lanes."""

    def build(context: Any, builder: Any, made: Any, args: Any) -> Any:
        return _splat(builder, args[0])

    return lanes(types.float64), build


@intrinsic
def get(typing: Any, array: Any, row: Any) -> Any:
    """Row of an array."""

    def build(context: Any, builder: Any, made: Any, args: Any) -> Any:
        value = builder.load(_place(context, builder, made.args[0], args[0], args[1]))
        value.align = 8
        return value

    return lanes(array, types.intp), build


@intrinsic
def put(typing: Any, array: Any, row: Any, value: Any) -> Any:
    """Write a row of an array."""

    def build(context: Any, builder: Any, made: Any, args: Any) -> Any:
        done = builder.store(args[2], _place(context, builder, made.args[0], args[0], args[1]))
        done.align = 8
        return context.get_dummy_value()

    return types.void(array, types.intp, lanes), build


# The next three take numbers as well: what comes out is a number if all that goes in are numbers, else lanes, where a number
# stands for the same in all of them. So a formula written with them is one source for both.


def _common(given: tuple[Any, ...]) -> tuple[Any, Any]:
    """The type that given types have in common, numbers or lanes, and what brings values to it."""
    if lanes not in given:
        return types.float64(*[types.float64] * len(given)), lambda builder, made, args: list(args)
    return lanes(*[lanes if kind == lanes else types.float64 for kind in given]), _wide


def _wide(builder: Any, made: Any, args: Any) -> list[Any]:
    """All values as lanes."""
    return [a if kind == lanes else _splat(builder, a) for a, kind in zip(args, made.args, strict=True)]


@intrinsic
def where_positive(typing: Any, sign: Any, then: Any, otherwise: Any) -> Any:
    """`then` where `sign` > 0, `otherwise` elsewhere (also where sign is not a number)."""
    kind, alike = _common((sign, then, otherwise))

    def build(context: Any, builder: Any, made: Any, args: Any) -> Any:
        sign, then, otherwise = alike(builder, made, args)
        return builder.select(builder.fcmp_ordered(">", sign, ir.Constant(sign.type, None)), then, otherwise)

    return kind, build


def _extreme(comparison: str) -> Any:
    def choose(typing: Any, a: Any, b: Any) -> Any:
        kind, alike = _common((a, b))

        def build(context: Any, builder: Any, made: Any, args: Any) -> Any:
            a, b = alike(builder, made, args)
            return builder.select(builder.fcmp_ordered(comparison, a, b), a, b)

        return kind, build

    return choose


larger = intrinsic(_extreme(">"))
smaller = intrinsic(_extreme("<"))


def _register(function: Callable[..., Any], name: str, taken: tuple[tuple[Any, ...], ...], **options: Any) -> None:
    """Make an operator known for some types that it takes, by the instruction of this name."""
    infer_global(function)(make_concrete_template(name, function, [signature(lanes, *kinds) for kinds in taken]))

    def build(context: Any, builder: Any, made: Any, args: Any) -> Any:
        return getattr(builder, name)(*_wide(builder, made, args), **options)

    for kinds in taken:
        lower_builtin(function, *kinds)(build)


_WITH_NUMBERS = ((lanes, lanes), (lanes, types.float64), (types.float64, lanes))
for _name, _functions in {
    "fadd": (operator.add, operator.iadd),
    "fsub": (operator.sub, operator.isub),
    "fmul": (operator.mul, operator.imul),
}.items():
    for _function in _functions:
        _register(_function, _name, _WITH_NUMBERS, flags=_FLAGS)
_register(operator.neg, "fneg", ((lanes,),))


def formula(function: Callable[..., Any]) -> Any:
    """Compile a function of numbers or lanes into whatever compiled code calls it."""
    return numba.njit(forceinline=True)(function)


@compiled(inner=True)
def work(rows):
    """New rows (rows, BATCH) of zeros that begin where vector registers read best."""
    raw = np.zeros(rows * BATCH + 8)
    at = ((-raw.ctypes.data) % 64) // 8
    return raw[at : at + rows * BATCH].reshape(rows, BATCH)


@compiled(inner=True)
def copy_rows(source, begin, into, at, number):
    """Copy a number of rows of an array from `begin` on to rows of another from `at` on."""
    for i in range(number):
        put(into, at + i, get(source, begin + i))
