"""Rows and labelled data sets of a result, both from the declarations of its fields alone."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError, MissingExtraError
from rotorgear.model.parts.fields import DOF_NAMES
from rotorgear.results.schema import Declared, Record, Rows

# Behind the name of an axis that stands twice.
_SECOND = "_2"
# What stands along axes that all results have in common.
_NAMES = {"component": DOF_NAMES, "displacement": DOF_NAMES, "velocity": DOF_NAMES, "xyz": tuple("xyz")}


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
    axes = axes or main_axes(result)
    declared = result.declarations.get(axes[0]) if len(axes) == 1 else None
    if declared is not None and declared.record is not None and declared.axes:
        # A record is one row; what is itself a list of records stays one.
        stored = [name for name, one in declared.record.declarations.items() if not one.computed]
        if isinstance(declared.record, Rows) and declared.record.inner is not None:
            stored.append(declared.record.inner_name)
        return [{name: _python(getattr(record, name)) for name in stored} for record in getattr(result, axes[0])]
    columns = list(_columns(result))
    sizes = {axis: size for _, along, values, _ in columns for axis, size in zip(along, values.shape, strict=True)}
    lists = [one.name for one in result.declarations.values() if one.record is not None and one.axes]
    for axis in axes:
        if axis not in sizes:
            raise AnalysisError(f"rows: got '{axis}', expected one of {', '.join([*sorted(sizes), *lists])}")
    entries = []
    for place in product(*(range(sizes[axis]) for axis in axes)):
        at = dict(zip(axes, place, strict=True))
        row: dict[str, Any] = {axis: number + 1 for axis, number in at.items()}
        for name, along, values, _ in columns:
            if along and set(along) <= set(axes):
                row[name] = _python(values[tuple(at[axis] for axis in along)])
        entries.append(row)
    return entries


def main_axes(result: Record) -> tuple[str, ...]:
    """The axes of the first field that is no label of an axis, or the name of the first list of records."""
    for declared in result.declarations.values():
        value = getattr(result, declared.name)
        if declared.record is not None and declared.axes and value:
            return (declared.name,)
        if isinstance(value, np.ndarray) and declared.axes and declared.name not in map("{}s".format, declared.axes):
            return declared.axes
    return ()


def _python(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value


def _columns(record: Record, prefix: str = "") -> Iterator[tuple[str, tuple[str, ...], np.ndarray, Declared]]:
    """Yield everything that is counted by axes, dictionaries taken apart: its name, axes, values and declaration."""
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
                    yield f"{name}.{key}", declared.axes[1:], np.asarray(entry), declared
        elif isinstance(value, np.ndarray):
            yield name, declared.axes, value, declared
        elif isinstance(value, tuple) and declared.axes:
            # Empty by its default, a field says that the model has nothing of its kind: it isn't counted by its axis.
            if value == () and (declared.computed or type(record).__dataclass_fields__[declared.name].default == ()):
                continue
            texts = np.empty(len(value), dtype=object)
            texts[:] = value
            yield name, declared.axes, texts, declared


def _distinct(axes: tuple[str, ...]) -> list[str]:
    """Axes with other names where one stands twice, as of a matrix."""
    return [f"{axis}{_SECOND}" if axis in axes[:k] else axis for k, axis in enumerate(axes)]


def data_set(result: Record) -> Any:
    """Return everything that is counted by axes as an `xarray.Dataset`.

    Dimensions are the axes, in small letters. A field that has the name of its only axis, or the plural, labels it, and
    frequencies do; the six motions of a node and x, y, z have their names, and what is only counted has numbers from 1, as in
    `rows`. Of a matrix over one axis the second is called "parameter_2". Each variable and each coordinate that is a quantity
    has `long_name` and `units`.

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
            if named == declared.name:  # a variable can't have the name of its dimension
                named = f"{named}_of"
            arrays.append(
                xr.DataArray(
                    np.array(list(value.values())),
                    dims=(named, *declared.axes[1:]),
                    coords={named: list(value)},
                    name=declared.name,
                    attrs=about,
                )
            )
    for name, axes, values, declared in _columns(result):
        about = {"long_name": declared.label, "units": declared.unit}
        if isinstance(getattr(result, declared.name, None), dict) or not axes:
            continue
        labels = len(axes) == 1 and name in (axes[0], f"{axes[0]}s")
        if labels or (name, axes) == ("frequency_hz", ("frequency",)):
            coordinates[axes[0]] = (axes[0], values, about)
        if not labels:
            arrays.append(xr.DataArray(values, dims=_distinct(axes), name=name, attrs=about))
    merged = xr.merge(arrays, join="outer", compat="no_conflicts", combine_attrs="drop")
    # Newer versions of xarray drop the attributes of the variables as well as those of the whole.
    for array in arrays:
        merged[array.name].attrs = dict(array.attrs)
    for axis, size in merged.sizes.items():
        if axis not in coordinates and axis not in merged.coords:
            first = str(axis).removesuffix(_SECOND)
            known = _NAMES.get(first, coordinates[first][1] if first in coordinates else ())
            coordinates[axis] = (axis, list(known) if len(known) == size else np.arange(1, size + 1))
    return merged.assign_coords(coordinates)
