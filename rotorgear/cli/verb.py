"""What a verb says of its arguments: names, types, defaults and the docstring's words, from which its command is made.

They are read from the verb's source and not from the function: to import a verb takes half a second and the packages that it
computes with, and neither help nor the completion of a shell is to wait for those.
"""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import rotorgear
from rotorgear.files.own import text_of
from rotorgear.lazy import homes_of

# The default of an argument that has none.
REQUIRED = object()
_ENTRY = re.compile(r"    (?P<names>\w+(?:, \w+)*): (?P<text>.*)")
_ELSEWHERE = re.compile(r"\bas (?:in|for) `(\w+)`")


@dataclass(frozen=True)
class Argument:
    """An argument of a verb: its annotation as it is written, its default (None where that is no plain value), its help."""

    annotation: str
    default: Any
    help: str


def source_of(module: str) -> str:
    """The text of a module of rotorgear."""
    path = Path(rotorgear.__file__).parent.joinpath(*module.split(".")[1:])
    return text_of(path / "__init__.py" if path.is_dir() else path.with_suffix(".py"))


@cache
def arguments_of(verb: str) -> dict[str, Argument]:
    """The arguments of a verb by name, in their order."""
    module, function = _declaration(verb)
    texts = _texts(ast.get_docstring(function) or "")
    listed = function.args.posonlyargs + function.args.args
    defaults = [None] * (len(listed) - len(function.args.defaults)) + function.args.defaults
    return {
        argument.arg: Argument(
            ast.unparse(argument.annotation) if argument.annotation else "",
            REQUIRED if default is None else _plain(module, default),
            _resolved(argument.arg, texts.get(argument.arg, "")),
        )
        for argument, default in [
            *zip(listed, defaults, strict=True),
            *zip(function.args.kwonlyargs, function.args.kw_defaults, strict=True),
        ]
    }


def summary_of(verb: str) -> str:
    """What a verb's docstring says before it comes to the arguments."""
    text = ast.get_docstring(_declaration(verb)[1]) or ""
    return re.split(r"\n(?:Args|Returns|Raises):\n", text)[0].strip()


def told_by(verb: str) -> str:
    """What the result of a verb tells, with units: the labels of its fields, from their declarations; "" of other values."""
    module, function = _declaration(verb)
    returned = ast.unparse(function.returns) if function.returns else ""
    imports = [item for item in parsed(module).body if isinstance(item, ast.ImportFrom)]
    homes = [item.module for item in imports if item.module and returned in [one.name for one in item.names]]
    told = []
    for item in parsed(homes[0]).body if homes else ():
        for field in item.body if isinstance(item, ast.ClassDef) and item.name == returned else ():
            for call in [field.value] if isinstance(field, ast.AnnAssign) else getattr(field, "decorator_list", []):
                if isinstance(call, ast.Call) and ast.unparse(call.func) in ("of", "derived"):
                    label, *unit = [ast.literal_eval(text) for text in call.args[:2]]
                    told.append(f"{label} ({unit[0]})" if any(unit) else label)
    return "; ".join(dict.fromkeys(told))


@cache
def parsed(module: str) -> ast.Module:
    """The syntax tree of a module of rotorgear."""
    return ast.parse(source_of(module))


def _declaration(verb: str) -> tuple[str, ast.FunctionDef]:
    """The module that a verb stands in, and its function there."""
    module, name = homes_of(rotorgear.__file__)[verb]
    # The last one of a name is the function, those before it are its overloads.
    functions = [item for item in parsed(module).body if isinstance(item, ast.FunctionDef) and item.name == name]
    return module, functions[-1]


def _plain(module: str, default: ast.expr) -> Any:
    """The value of a default that is a literal, or a name with one in the module or where that imports it from; else None."""
    if isinstance(default, ast.Name):
        for item in parsed(module).body:
            if isinstance(item, ast.Assign) and ast.unparse(item.targets[0]) == default.id:
                return _plain(module, item.value)
            if isinstance(item, ast.ImportFrom) and item.module and default.id in [one.name for one in item.names]:
                return _plain(item.module, default)
    try:
        return ast.literal_eval(default)
    except ValueError:
        return None


def _texts(docstring: str) -> dict[str, str]:
    """The words of the section `Args:` by argument; one entry may speak of several."""
    section = docstring.partition("\nArgs:\n")[2].partition("\n\n")[0]
    texts: dict[str, str] = {}
    names: list[str] = []
    for line in section.splitlines():
        if entry := _ENTRY.fullmatch(line):
            names = entry["names"].split(", ")
            texts |= dict.fromkeys(names, entry["text"])
        else:
            texts |= {name: f"{texts[name]} {line.strip()}" for name in names}
    return texts


def _resolved(name: str, text: str) -> str:
    """The words with those of another verb in place of "as in `verb`"."""

    def words(found: re.Match[str]) -> str:
        return arguments_of(found[1])[name].help.removesuffix(".")

    return _ELSEWHERE.sub(words, text)
