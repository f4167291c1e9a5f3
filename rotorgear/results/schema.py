"""Results as schemas: a field says once what it is, in which unit and over what; everything that shows it reads that.

    class Modes(Result, kind="modes"):
        eigenvalues: np.ndarray = of("eigenvalue", "rad/s", "mode", json=None)

        @derived("frequency", "Hz", "mode", note=" of each mode")
        def frequency_hz(self) -> np.ndarray:
            return np.abs(self.eigenvalues) / (2.0 * np.pi)

JSON, HDF5, rows, data sets, the text of a result and docs/commands.md follow from these declarations. An axis in small letters is
counted ("mode"), one in capitals is a dictionary's ("PART"). Subclasses of `Record` are frozen dataclasses without a decorator;
two of them are equal if all their values are, arrays by their entries and NaN to NaN, and their arrays are read-only. `rows`
writes the fields that an axis counts as a list of rows.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import MISSING, Field, dataclass, field, fields, replace
from itertools import count
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar, dataclass_transform, overload

from rotorgear.quantity import RPM_PER_RAD_S

if TYPE_CHECKING:
    import numpy as np

T = TypeVar("T")
_SAME_KEY = "\0"  # the field's name, with its unit
_places = count()  # fields and computed fields of a class share one order, that of the page
# A key is the field's name with its unit behind it, where the name does not say that already: these units, in small letters.
_IN_KEYS = ("N", "m", "N m", "N/m", "Pa", "s", "W", "K", "Pa s", "kg", "J", "Hz", "m/s", "m^3/s", "mm/s")
_ENDINGS = {"rad/s": "_rpm", "rad": "_deg", "byte": "_bytes"}
_ENDINGS |= {unit: f"_{unit.lower().replace('/', '_per_').replace('^', '').replace(' ', '_')}" for unit in _IN_KEYS}
# A key that ends so is written in its unit: the unit stands with the written key, SI with the stored field.
_WRITTEN_UNITS = {("rad/s", "_rpm"): ("rpm", RPM_PER_RAD_S), ("rad", "_deg"): ("deg", 180.0 / math.pi)}


@dataclass(frozen=True)
class Written:
    """A key of the JSON output that is not simply the field.

    `value(record, stored)` makes what is written; `axes` are those of it, where it does not go along those of the field.
    """

    key: str
    value: Callable[[Any, Any], Any] | None = None
    unit: str | None = None
    axes: tuple[str, ...] | None = None
    label: str | None = None
    note: str | None = None

    def of(self, record: Record, declared: Declared) -> Any:
        """What is written of a field of the record."""
        stored = getattr(record, declared.name)
        if self.value is not None:
            stored = self.value(record, stored)
        if self.axes is not None or declared.along == declared.axes or stored is None:
            return stored
        return _arranged(record, stored, declared.axes, declared.along)


@dataclass(frozen=True)
class Declared:
    """What a field says of itself; see `of`.

    `place` orders the fields of a class; `computed`: not stored; `along`: the axes along which it is written; `words`: it holds
    texts.
    """

    name: str
    label: str
    unit: str
    axes: tuple[str, ...]
    note: str
    form: str | Callable[[Any], str]
    record: type[Record] | Rows | None
    json: tuple[str | Written, ...]
    stored: bool
    computed: bool
    column: str
    shown: str
    place: int
    along: tuple[str, ...] = ()
    words: bool = False

    def written(self) -> Iterator[Written]:
        """Yield the keys that are written, with their units and words."""
        for entry in self.json:
            if isinstance(entry, Written):
                yield entry
                continue
            key = key_of(self.name, self.unit) if entry == _SAME_KEY else entry
            converted = (into for (si, end), into in _WRITTEN_UNITS.items() if self.unit == si and key.endswith(end))
            unit, factor = next(converted, (self.unit, None))
            yield Written(key, None if factor is None else _scaled(factor), unit)


def real_part(record: Record, values: Any) -> Any:
    """What is written of complex numbers under a key for their real part."""
    return values.real


def imaginary_part(record: Record, values: Any) -> Any:
    """What is written of complex numbers under a key for their imaginary part."""
    return values.imag


def force_and_moment(kind: str, on: str = "the shaft") -> tuple[Written, Written]:
    """Keys of their own for the force and the moment in vectors of six components."""

    def part(cut: slice) -> Callable[[Any, Any], Any]:
        def of(record: Record, all_six: Any) -> Any:
            if isinstance(all_six, dict):
                return {name: one[cut] for name, one in all_six.items()}
            return all_six[..., cut]

        return of

    return (
        Written(f"{kind}_force_n", part(slice(0, 3)), "N", label=f"force on {on}"),
        Written(f"{kind}_moment_n_m", part(slice(3, 6)), "N m", label=f"moment on {on}"),
    )


def key_of(name: str, unit: str) -> str:
    """The key of a field in JSON: its name, and its unit where it has one that the name does not say."""
    ending = _ENDINGS.get(unit, "")
    return name if name.endswith((ending, "seconds")) else f"{name}{ending}"


# What an axis in capitals is counted by, where that is not its own name in small letters.
_COUNTED = {"MESH": "contact", "SET": "ground", "AXIS": "xyz"}


def _counted(axis: str, own: tuple[str, ...]) -> str:
    """Which of a field's own axes an axis of the JSON output goes along, if it is one of them."""
    last = axis.rpartition(".")[2]
    counted = _COUNTED.get(last, last.lower())
    return "component" if counted == "xyz" and "xyz" not in own else counted


def _along(own: tuple[str, ...], order: tuple[str, ...]) -> tuple[str, ...]:
    """A field's axes as they are written: in the order of its record, then those that this does not name."""
    rest = list(own)
    along = []
    for axis in order:
        counted = axis if axis in rest else _counted(axis, own)
        if counted in rest:
            rest.remove(counted)
            along += [axis, "helix"] if counted == "contact" else [axis]
    return (*along, *rest)


def _arranged(record: Record, values: Any, own: tuple[str, ...], along: tuple[str, ...]) -> Any:
    """A field counted by the axes `own` as it is written along other axes.

    One in small letters is a list, one in capitals a dictionary by the names that the record has along it; contacts stand by
    mesh, then by helix.
    """
    import numpy as np

    if isinstance(values, dict):
        return {name: _arranged(record, entry, own[1:], along[1:]) for name, entry in values.items()}
    if not along:
        return values
    axis = _counted(along[0], own)
    k = own.index(axis)
    rest = own[:k] + own[k + 1 :]
    slices = np.moveaxis(values, k, 0)
    if not along[0].isupper():
        return [_arranged(record, one, rest, along[1:]) for one in slices]
    names = _names_along(record, axis)
    if along[1:2] == ("helix",):
        helices: dict[str, list[Any]] = {}
        for name, one in zip(names, slices, strict=True):
            helices.setdefault(name, []).append(_arranged(record, one, rest, along[2:]))
        return {name: np.array(entries) for name, entries in helices.items()}
    # Of the six components of a motion, x, y and z are written.
    return {name: _arranged(record, one, rest, along[1:]) for name, one in zip(names, slices, strict=False)}


def _names_along(record: Record, axis: str) -> Sequence[str]:
    """The record's first field of texts over an axis alone."""
    if axis in ("xyz", "component"):
        return "xyz"
    naming = (one for one in record.declarations.values() if one.axes == (axis,) and one.words)
    names: Sequence[str] = getattr(record, next(naming).name)
    return names


def place_of(record: Record, declared: Declared, key: str, at: dict[str, int]) -> tuple[str | int, ...]:
    """Where an entry of a field stands in the JSON output below its key, from its numbers along the field's axes."""
    path: list[str | int] = [key]
    for axis in declared.along:
        counted = _counted(axis, declared.axes)
        if axis == "helix" and axis not in at:
            names = _names_along(record, "contact")
            path.append(list(names[: at["contact"]]).count(names[at["contact"]]))
        elif axis.isupper():
            path.append(_names_along(record, counted)[at[counted]])
        elif counted in at:
            path.append(at[counted])
    return tuple(path)


def _scaled(factor: float) -> Callable[[Any, Any], Any]:
    return lambda record, stored: None if stored is None else stored * factor


def of(
    label: str,
    unit: str = "",
    *axes: str,
    note: str = "",
    form: str | Callable[[Any], str] = "",
    record: type[Record] | Rows | None = None,
    json: str | Written | tuple[str | Written, ...] | None = _SAME_KEY,
    stored: bool = True,
    column: str = "",
    shown: str = "",
    default: Any = MISSING,
    default_factory: Any = MISSING,
    kw_only: bool = False,
) -> Any:
    """Declare a stored field.

    Args:
        label: what it is, in the same words wherever a field has this name.
        unit: SI, as it is stored; "" for words, counts and ratios.
        axes: what its entries are counted by, one name a dimension.
        note: goes on after the label on the page of keys, punctuation included: what the label means in this result.
        form: how tables show a number, such as ".4f", or what writes it.
        record: class of its entries (or of its value, without axes), where they are records.
        json: key of the JSON output where it is not the name with its unit (`key_of`); a `Written` (or several) where the value
            is converted or cut in parts; None where it is not written.
        stored: whether it is saved and compared; what only drawings need is not.
        column: heading of its column in tables, in few letters; "" where it stands in none that is not told to hold it.
        shown: unit that tables show it in, where neither the heading ends with it nor the key is in it.
        default, default_factory, kw_only: as of a dataclass field.
    """
    keys = () if json is None else json if isinstance(json, tuple) else (json,)
    declared = Declared("", label, unit, axes, note, form, record, keys, stored, False, column, shown, next(_places))
    more: dict[str, Any] = {"default": default} if default is not MISSING else {}
    more |= {"default_factory": default_factory} if default_factory is not MISSING else {}
    return field(metadata={"declared": declared}, kw_only=kw_only, **more)


class Derived(Generic[T]):
    """A declared field that is computed when it is asked for."""

    def __init__(self, function: Callable[[Any], T], declared: Declared) -> None:
        self.function = function
        self.declared = declared
        self.__doc__ = function.__doc__

    def __set_name__(self, owner: type, name: str) -> None:
        self.declared = replace(self.declared, name=name)

    @overload
    def __get__(self, obj: None, owner: type) -> Derived[T]: ...
    @overload
    def __get__(self, obj: object, owner: type) -> T: ...
    def __get__(self, obj: object | None, owner: type) -> T | Derived[T]:
        return self if obj is None else read_only(self.function(obj))


def derived(label: str, unit: str = "", *axes: str, **said: Any) -> Callable[[Callable[[Any], T]], Derived[T]]:
    """Declare a computed field; the arguments are those of `of`."""
    declared: Declared = of(label, unit, *axes, **said).metadata["declared"]

    def declare(function: Callable[[Any], T]) -> Derived[T]:
        words = "str" in str(function.__annotations__.get("return"))
        return Derived(function, replace(declared, stored=False, computed=True, words=words))

    return declare


def part_of(field: str, k: int, label: str, unit: str, *axes: str, **said: Any) -> Derived[np.ndarray]:
    """Declare entry k along the last axis of an array as a field of its own."""

    def part(record: Record) -> np.ndarray:
        entries: np.ndarray = getattr(record, field)[..., k]
        return entries

    return derived(label, unit, *axes, **said)(part)


class Row(SimpleNamespace):
    """An entry along axes of a result: what the fields say of it, by their keys in the JSON output."""


class Rows:
    """The fields of a result that are written as a list of rows, one for each entry along the last of its axes.

    Of lists in one another, such as runs of points, a field stands in the first whose axes count it, and is a list along its
    other axes.
    """

    def __init__(self, axes: tuple[str, ...], inner_name: str, inner: Rows | None) -> None:
        self.axes = axes
        self.inner_name = inner_name
        self.inner = inner
        self.fields: list[Declared] = []
        self.declarations: dict[str, Declared] = {}
        self.keys: list[tuple[Declared, Written]] = []

    def emptied(self) -> Rows:
        """The same lists without fields."""
        return Rows(self.axes, self.inner_name, self.inner and self.inner.emptied())

    @property
    def all_axes(self) -> tuple[str, ...]:
        """The axes of this list and of those in it."""
        return self.axes if self.inner is None else self.inner.all_axes

    @property
    def all_fields(self) -> list[Declared]:
        """The fields of this list and of those in it."""
        return self.fields if self.inner is None else self.fields + self.inner.all_fields

    def take(self, declared: Declared, json_axes: tuple[str, ...]) -> None:
        """Take a field that these axes count."""
        last = [axis for axis in self.all_axes if axis in declared.axes][-1]
        if self.inner is not None and last != self.axes[-1]:
            self.inner.take(declared, json_axes)
            return
        self.fields.append(declared)
        axes = tuple(axis for axis in declared.axes if axis not in self.axes)
        own = replace(declared, axes=axes, along=_along(axes, json_axes), computed=False)
        for written in declared.written():
            self.keys.append((declared, written))
            self.declarations[written.key] = replace(own, name=written.key, json=(written.key,))

    def of(self, record: Record, values: dict[str, Any], at: dict[str, int]) -> tuple[Row, ...]:
        """The rows: of a record, from the values of its fields, at numbers along the axes of the outer lists."""
        axis = self.axes[-1]
        counting = next(declared for declared in self.fields if axis in declared.axes)
        value = values[counting.name]
        length = len(value) if isinstance(value, tuple) else value.shape[counting.axes.index(axis)]
        made = []
        for k in range(length):
            here = at | {axis: k}
            row: dict[str, Any] = {}
            for declared, written in self.keys:
                entry = _entry(values[declared.name], tuple(here.get(one, slice(None)) for one in declared.axes))
                one = entry if written.value is None else written.value(record, entry)
                own = self.declarations[written.key]
                row[written.key] = one if own.along == own.axes else _arranged(record, one, own.axes, own.along)
            if self.inner is not None:
                row[self.inner_name] = self.inner.of(record, values, here)
            made.append(Row(**row))
        return tuple(made)


def _entry(values: Any, at: tuple[Any, ...]) -> Any:
    """An entry of a tuple or an array, nothing of what an older file does not hold; numbers as Python has them."""
    if isinstance(values, tuple):
        return values[at[0]]
    entry = values[at] if values.size else values.ravel()
    return entry.item() if getattr(entry, "ndim", 1) == 0 else entry


def rows(label: str, axis: str, **within: str) -> Derived[tuple[Row, ...]]:
    """Declare a list of rows: of the fields that an axis counts.

    `within`: lists in each row, by the axes that they go along.
    """
    axes = (axis, *within.values())
    names = (*within, "")
    lists: Rows | None = None
    for depth in range(len(axes), 0, -1):
        lists = Rows(axes[:depth], names[depth - 1], lists)

    def made(record: Record) -> tuple[Row, ...]:
        own = record.declarations[here.declared.name].record
        assert isinstance(own, Rows)
        return own.of(record, {one.name: getattr(record, one.name) for one in own.all_fields}, {})

    declared: Declared = of(label, "", axis, record=lists).metadata["declared"]
    here = Derived(made, replace(declared, stored=False, computed=True))
    return here


@dataclass_transform(frozen_default=True, eq_default=False, field_specifiers=(of,))
class Record:
    """Base of results and of the records in them.

    `json_axes` orders the axes of its fields in the JSON output, where that is another order than they have; "MESH" is for
    contacts, which stand by mesh and helix.
    """

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]
    declarations: ClassVar[dict[str, Declared]] = {}
    json_axes: ClassVar[tuple[str, ...]] = ()
    known: ClassVar[dict[str, type[Record]]] = {}  # all records by the name of their class, for files

    def __init_subclass__(cls) -> None:
        dataclass(frozen=True, eq=False, repr=False)(cls)
        # A field is found by its name in the class that declares it last; its own fields stand before those of the bases.
        by_name: dict[str, Declared] = {}
        for item in fields(cls):
            if "declared" in item.metadata:
                by_name[item.name] = replace(item.metadata["declared"], name=item.name, words="str" in str(item.type))
        for base in reversed(cls.__mro__):
            for name, value in vars(base).items():
                if isinstance(value, Derived):
                    by_name[name] = value.declared
        inherited = {name for base in cls.__mro__[1:] for name in getattr(base, "declarations", {})}
        order = sorted(by_name.values(), key=lambda one: (one.name in inherited, one.place))
        cls.declarations = {one.name: replace(one, along=_along(one.axes, cls.json_axes)) for one in order}
        for listed in order:
            if isinstance(listed.record, Rows):
                lists = listed.record.emptied()  # a subclass may have fields of its own in them
                cls.declarations[listed.name] = replace(listed, record=lists, along=listed.axes)
                for one in order:
                    if one.json and one.record is None and one.axes and one.axes[0] in lists.all_axes:
                        lists.take(one, cls.json_axes)
                        cls.declarations[one.name] = replace(cls.declarations[one.name], json=())
        own = [
            f"    {one.name}: {one.label}{f' in {one.unit}' * bool(one.unit)}."
            for one in order
            if one.name not in inherited
        ]
        cls.__doc__ = "\n".join([cls.__doc__ or "", "\nAttributes:" * bool(own), *own])
        Record.known[record_name(cls)] = cls
        Record.known.setdefault(cls.__name__, cls)  # files of 0.1 name a record by its class alone

    def __post_init__(self) -> None:
        for item in fields(self):
            object.__setattr__(self, item.name, read_only(getattr(self, item.name)))

    def __setstate__(self, state: dict[str, Any]) -> None:
        # Arrays come writeable out of a pickle.
        for name, value in state.items():
            object.__setattr__(self, name, read_only(value))

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        return all(_agree(getattr(self, name), getattr(other, name)) for name in self._compared())

    def __hash__(self) -> int:
        return hash((type(self), *(getattr(self, name) for name in self._compared())))

    @classmethod
    def _compared(cls) -> list[str]:
        declared = cls.declarations
        return [item.name for item in fields(cls) if item.name not in declared or declared[item.name].stored]

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{item.name}={_short(getattr(self, item.name))}' for item in fields(self))})"

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON; the keys are on docs/commands.md."""
        out: dict[str, Any] = {}
        for declared in self.declarations.values():
            for entry in declared.written():
                out[entry.key] = plain(entry.of(self, declared))
        return out


def record_of(name: str) -> type[Record]:
    """The class that a file names; a record may have moved to another file since."""
    return Record.known.get(name) or Record.known[name.rpartition(".")[2]]


def record_name(cls: type[Record]) -> str:
    """Name of a record in files: its class, and the file that it stands in, since two results may have rows of one name."""
    return f"{cls.__module__.rpartition('.')[2]}.{cls.__name__}"


def read_only(value: Any) -> Any:
    """The same, arrays as read-only views: whoever made them may go on with them."""
    import numpy as np

    if isinstance(value, np.ndarray):
        if not value.flags.writeable:
            return value
        view = value.view()
        view.flags.writeable = False
        return view
    if isinstance(value, dict):
        return {key: read_only(entry) for key, entry in value.items()}
    # Names of a hundred thousand nodes are of one type: look at the types, not at the names.
    if isinstance(value, tuple) and any(issubclass(kind, np.ndarray | dict) for kind in set(map(type, value))):
        return tuple(read_only(entry) for entry in value)
    return value


def plain(value: Any) -> Any:
    """Lists, dictionaries, texts, numbers and None: complex numbers by their size, None for one that is not finite."""
    import numpy as np

    if isinstance(value, Record):
        return value.to_dict()
    if isinstance(value, Row):
        return plain(vars(value))
    if isinstance(value, np.ndarray):
        return _plain_array(value)
    if isinstance(value, np.generic):
        value = (np.abs(value) if np.iscomplexobj(value) else value).item()
    if isinstance(value, dict):
        return {str(key): plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [plain(entry) for entry in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def _plain_array(values: np.ndarray) -> Any:
    import numpy as np

    if values.dtype.kind not in "fc":
        return values.tolist()
    real = np.abs(values) if values.dtype.kind == "c" else values
    finite = np.isfinite(real)
    if finite.all():
        return real.tolist()
    written = real.astype(object)
    written[~finite] = None
    return written.tolist()


def _agree(one: Any, other: Any) -> bool:
    """Whether two values are the same; NaN is NaN."""
    import numpy as np

    if one is other:
        return True
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        if not (isinstance(one, np.ndarray) and isinstance(other, np.ndarray)):
            return False
        return one.dtype.kind == other.dtype.kind and np.array_equal(one, other, equal_nan=one.dtype.kind in "fc")
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_agree(value, other[key]) for key, value in one.items())
    if isinstance(one, list | tuple) and isinstance(other, list | tuple):
        return type(one) is type(other) and len(one) == len(other) and all(map(_agree, one, other))
    if isinstance(one, float) and isinstance(other, float):
        return one == other or (one != one and other != other)
    return bool(one == other)


def _short(value: Any) -> str:
    """A value in a few words: large ones by their shape."""
    shape = getattr(value, "shape", ())
    if shape:
        return f"array {shape}"
    if isinstance(value, tuple | dict) and len(value) > 6:
        return f"{len(value)} entries"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key!r}: {_short(entry)}" for key, entry in value.items()) + "}"
    return repr(value)
