"""Rows and labelled data sets of a result, both from the declarations of its fields alone."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError, MissingExtraError
from rotorgear.results.schema import Declared, Record


@dataclass(frozen=True)
class Series:
    """Values over counted axes: an array whose dimensions are `axes`, with the words of its declaration."""

    name: str
    axes: tuple[str, ...]
    values: np.ndarray
    declared: Declared


def rows(result: Record, *axes: str) -> list[dict[str, Any]]:
    """One flat dictionary for each entry along an axis, or for each pair of entries along two.

    Args:
        axes: names of axes, such as "mode", or "speed" and "branch"; or one name of a list of records, such as "crossings".

    Returns:
        The number of the entry (from 1) under the axis' name, unless a field has that name; then all fields that are counted
        by these axes only. A field by part or by shaft gives a column each, "strain_energy.meshes.stage".

    Raises:
        AnalysisError: no field is counted by such an axis.
    """
    declared = result.declarations.get(axes[0]) if len(axes) == 1 else None
    if declared is not None and declared.record is not None and declared.axes:
        # A record is one row; what is itself a list of records stays one.
        return [
            {
                name: _python(getattr(record, name))
                for name, one in declared.record.declarations.items()
                if not one.computed
            }
            for record in getattr(result, axes[0])
        ]
    columns = list(_columns(result))
    known = sorted({axis for column in columns for axis in column.axes})
    lists = [one.name for one in result.declarations.values() if one.record is not None and one.axes]
    for axis in axes:
        if axis not in known:
            raise AnalysisError(f"rows: got '{axis}', expected one of {', '.join([*known, *lists])}")
    sizes = {
        axis: size
        for column in columns
        for axis, size in zip(column.axes, column.values.shape, strict=True)
        if axis in axes
    }
    shown = [column for column in columns if column.axes and set(column.axes) <= set(axes)]
    entries = []
    for place in product(*(range(sizes[axis]) for axis in axes)):
        at = dict(zip(axes, place, strict=True))
        row: dict[str, Any] = {axis: number + 1 for axis, number in at.items()}
        for column in shown:
            row[column.name] = _python(column.values[tuple(at[axis] for axis in column.axes)])
        entries.append(row)
    return entries


def _python(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value


def _columns(record: Record, prefix: str = "") -> Iterator[Series]:
    """Yield everything that is counted by axes, dictionaries taken apart."""
    for declared in record.declarations.values():
        value = getattr(record, declared.name)
        name = f"{prefix}{declared.name}"
        if value is None or declared.name == "settings":
            continue
        if declared.record is not None:
            if isinstance(value, Record):
                yield from _columns(value, f"{name}.")
        elif isinstance(value, dict):
            for key, entry in value.items():
                if len(declared.axes) == np.ndim(entry) + 1:
                    yield Series(f"{name}.{key}", declared.axes[1:], np.asarray(entry), declared)
        elif isinstance(value, np.ndarray):
            yield Series(name, declared.axes, value, declared)
        elif isinstance(value, tuple) and declared.axes:
            # Empty by its default, a field says that the model has nothing of its kind: it isn't counted by its axis.
            if value == () and type(record).__dataclass_fields__[declared.name].default == ():
                continue
            texts = np.empty(len(value), dtype=object)
            texts[:] = value
            yield Series(name, declared.axes, texts, declared)


def data_set(result: Record) -> Any:
    """Return everything that is counted by axes as an `xarray.Dataset`.

    Dimensions are the axes, in small letters; a field that has the name of its only axis, or the plural, labels it. Each
    variable has `long_name` and `units`.

    Raises:
        MissingExtraError: xarray is not installed.
    """
    try:
        import xarray as xr
    except ImportError:
        raise MissingExtraError("A labelled data set", "xarray", "xarray") from None
    coordinates: dict[str, Any] = {}
    arrays: list[Any] = []
    for declared in result.declarations.values():
        value = getattr(result, declared.name)
        about = {"long_name": declared.label, "units": declared.unit}
        if isinstance(value, dict) and declared.record is None and declared.name != "settings" and value:
            named = declared.axes[0].lower()
            arrays.append(
                xr.DataArray(
                    np.array(list(value.values())),
                    dims=(named, *declared.axes[1:]),
                    coords={named: list(value)},
                    name=declared.name,
                    attrs=about,
                )
            )
    for column in _columns(result):
        about = {"long_name": column.declared.label, "units": column.declared.unit}
        if isinstance(getattr(result, column.declared.name, None), dict) or not column.axes:
            continue
        axis = column.axes[0]
        if len(column.axes) == 1 and column.name in (axis, f"{axis}s"):
            coordinates[axis] = (axis, column.values, about)
        else:
            arrays.append(xr.DataArray(column.values, dims=column.axes, name=column.name, attrs=about))
    merged = xr.merge(arrays, join="outer", compat="no_conflicts", combine_attrs="drop")
    # Newer versions of xarray drop the attributes of the variables as well as those of the whole.
    for array in arrays:
        merged[array.name].attrs = dict(array.attrs)
    return merged.assign_coords(coordinates)
