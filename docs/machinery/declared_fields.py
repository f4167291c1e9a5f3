"""Lets the page of public names show what fields declare: units, axes, bounds and defaults of results and of parts of a model.

`types_of` finds the types that public names lead to. `DeclaredFields` is an extension of griffe, which reads the sources for
mkdocstrings: it puts a table of fields into the docstring of each result and part, and says what a function returns.
"""

from __future__ import annotations

import html
import inspect
import types
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any, Literal, Union, get_args, get_origin

import griffe
from pydantic import BaseModel
from update import load_generator

from rotorgear.results.schema import Declared, Record, Rows

ROOT = Path(__file__).resolve().parents[2]


@cache
def _sources() -> griffe.Module:
    package = griffe.load("rotorgear", search_paths=[ROOT], resolve_aliases=True)
    assert isinstance(package, griffe.Module)
    return package


def types_of(paths: list[str]) -> list[str]:
    """Canonical paths of the classes of the package that functions take or return and that fields hold, beside those named.

    Args:
        paths: public names, such as rotorgear.modal.
    """
    named = [_final(_sources()[path.removeprefix("rotorgear.")]) for path in paths]
    found = {one.path: one for one in named}
    waiting = list(found.values())
    while waiting:
        for path in _leads_to(waiting.pop()):
            if path not in found and path.startswith("rotorgear."):
                one = _class_at(path)
                if one is not None and one.path not in found:
                    found[one.path] = one
                    waiting.append(one)
    return sorted(found.keys() - {one.path for one in named}, key=lambda path: path.rpartition(".")[2].lower())


def _final(one: griffe.Object | griffe.Alias) -> griffe.Object:
    return one.final_target if isinstance(one, griffe.Alias) else one


def _class_at(path: str) -> griffe.Class | None:
    try:
        one = _final(_sources()[path.removeprefix("rotorgear.")])
    except (KeyError, griffe.AliasResolutionError):
        return None
    return one if isinstance(one, griffe.Class) and not one.name.startswith("_") else None


def _leads_to(one: griffe.Object) -> Iterator[str]:
    """Paths of the names in the types of a function's arguments and return, or of the fields of a class and in its bases."""
    said: list[Any] = []
    if isinstance(one, griffe.Function):
        said = [one.returns, *(parameter.annotation for parameter in one.parameters)]
    elif isinstance(one, griffe.Class) and issubclass(real := _runtime(one), Record | BaseModel):
        own = [one.members[name] for name in _fields_of(real) if name in one.members]
        said = [*one.bases, *(_type_of(member) for member in own)]
    for expression in said:
        if isinstance(expression, griffe.Expr):
            yield from (
                name.canonical_path for name in expression.iterate(flat=True) if isinstance(name, griffe.ExprName)
            )


def _type_of(member: griffe.Object | griffe.Alias) -> Any:
    return member.returns if isinstance(member, griffe.Function) else getattr(member, "annotation", None)


def _runtime(cls: griffe.Class) -> type:
    found = getattr(import_module(cls.module.path), cls.name, object)
    return found if isinstance(found, type) else object


def _fields_of(cls: type) -> dict[str, Any]:
    declared = getattr(cls, "declarations", None) or getattr(cls, "model_fields", None) or {}
    return dict(declared)


class DeclaredFields(griffe.Extension):
    """Puts what fields declare into the docstrings of results and parts, in place of the fields themselves."""

    def on_class(self, *, cls: griffe.Class, **_: Any) -> None:
        """Give a result or a part its table of fields."""
        if not cls.path.startswith(("rotorgear.results.", "rotorgear.model.", "rotorgear.analysis.")):
            return
        real = _runtime(cls)
        if not issubclass(real, Record | BaseModel):
            return
        own = {name: field for name, field in _fields_of(real).items() if name in cls.members}
        if own:
            table = _records_table(cls, own) if issubclass(real, Record) else _parts_table(real, own)
            words = cls.docstring.value if cls.docstring else ""
            cls.docstring = griffe.Docstring(f"{words}\n\n{table}", parent=cls)
        for name in own:
            del cls.members[name]

    def on_function(self, *, func: griffe.Function, **_: Any) -> None:
        """Say what a function returns by the first sentence of the class, where its docstring has no section for it."""
        if (
            func.docstring is None
            or "Returns:" in func.docstring.value
            or not isinstance(func.returns, griffe.ExprName)
        ):
            return
        returned = _class_at(func.returns.canonical_path)
        if returned is not None and returned.docstring is not None:
            first = returned.docstring.value.strip().split("\n\n")[0].replace("\n", " ")
            func.docstring.value = f"{inspect.cleandoc(func.docstring.value)}\n\nReturns:\n    {first}"


def _records_table(cls: griffe.Class, own: dict[str, Declared]) -> str:
    rows = []
    for name, declared in own.items():
        said = _type_of(cls.members[name])
        kind = (
            _linked(said)
            if isinstance(said, griffe.Expr)
            else "<code>tuple</code>"
            if declared.record
            else "<code>ndarray</code>"
        )
        note = declared.note.replace("`null`", "`None`")
        meaning = f"{declared.label}{note}"
        if isinstance(declared.record, Rows):
            meaning += f": rows with {', '.join(f'`{written.key}`' for _, written in declared.record.keys)}"
        rows.append([f"`{name}`", kind, declared.unit, ", ".join(declared.axes), meaning])
    return _table(["field", "type", "unit", "over", "meaning"], rows)


def _linked(expression: griffe.Expr) -> str:
    """A type as code, whose names lead to where they are shown."""
    parts = []
    for one in expression.iterate(flat=True):
        text = html.escape(one if isinstance(one, str) else one.name)
        if isinstance(one, griffe.ExprName) and one.canonical_path.startswith("rotorgear."):
            text = _reference(one.canonical_path, text)
        parts.append(text)
    return f"<code>{''.join(parts).replace('|', '&#124;')}</code>"


def _reference(path: str, text: str) -> str:
    return f'<autoref identifier="{path}" optional>{text}</autoref>'


def _parts_table(real: type[BaseModel], own: dict[str, Any]) -> str:
    reference = load_generator(ROOT / "docs" / "generate_model_reference.py")
    rows = []
    for name, unit, bound, default, meaning in reference.facts(real):
        if name in own:
            kind = f"<code>{_shown(own[name].annotation).replace('|', '&#124;')}</code>"
            rows.append([f"`{name}`", kind, unit, bound, default, meaning])
    return _table(["field", "type", "SI unit", "bound", "default", "meaning"], rows)


def _shown(annotation: Any) -> str:
    """A type as it is held: without what it is read by, and with a link to a part."""
    origin, inner = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return _shown(inner[0])
    if origin in (Union, types.UnionType):
        return " | ".join(_shown(one) for one in inner)
    if origin is Literal:
        return " | ".join(html.escape(repr(one)) for one in inner)
    if origin is not None:
        return f"{origin.__name__}[{', '.join('...' if one is Ellipsis else _shown(one) for one in inner)}]"
    if annotation is type(None):
        return "None"
    if isinstance(annotation, type) and annotation.__module__.startswith("rotorgear."):
        return _reference(f"{annotation.__module__}.{annotation.__qualname__}", annotation.__name__)
    return str(getattr(annotation, "__name__", annotation))


def _table(head: list[str], rows: list[list[str]]) -> str:
    lines = [head, ["---"] * len(head), *([*row[:-1], row[-1].replace("|", "\\|")] for row in rows)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)
