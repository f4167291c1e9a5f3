"""Writes docs/api.md from the docstrings of the public names, those of `rotorgear` and of `rotorgear.plot`.

The repository keeps a line for each name; the site shows the whole docstrings.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import rotorgear as rg

ROOT = Path(__file__).resolve().parents[1]
HEAD = """# Public names

All names of `import rotorgear as rg`, from their docstrings; `rg.plot` at the end. A part's keys stand in
[the model file](model_file.md), a result's keys in [JSON output](json.md), and examples in [Python](python.md).
"""
_SUMMARY = f"""{HEAD}
Arguments, units, returns and errors are on the site, which `python docs/build_site.py` builds, and in `help(rg.modal)`.
"""


def pages() -> dict[str, str]:
    """Return the summary by its path: a line for each name."""
    return {"docs/api.md": _page(_SUMMARY, _line, "| name | what it is |\n|---|---|")}


def site_pages() -> dict[str, str]:
    """Return the whole page by its path."""
    return {"docs/api.md": _page(HEAD, _entry, "")}


def _page(head: str, entry: Callable[[object, str], str], above: str) -> str:
    parts = [
        head,
        *_sections(rg, ROOT / "rotorgear" / "__init__.pyi", "rg", entry, above),
        "\n## Pictures\n",
        *filter(None, [above]),
    ]
    parts += _sections(rg.plot, ROOT / "rotorgear" / "plot" / "__init__.pyi", "rg.plot", entry, above)
    return "\n".join(parts).rstrip() + "\n"


def _sections(
    package: ModuleType, stub: Path, prefix: str, entry: Callable[[object, str], str], above: str
) -> list[str]:
    """The names in the order of the stub, under its comments."""
    parts: list[str] = []
    for line in stub.read_text(encoding="utf-8").splitlines():
        if line.startswith("# ") and package is rg:
            parts += [
                f"\n## {line[2:].rstrip('.')}\n" if above else f"## {line[2:].rstrip('.')}\n",
                *filter(None, [above]),
            ]
        words = line.split()
        if len(words) == 6 and words[4] == "as" and words[5] != "plot":
            parts.append(entry(getattr(package, words[5]), f"{prefix}.{words[5]}"))
    return parts


def _line(value: object, name: str) -> str:
    """A name, with the arguments that it needs, and the first sentence of its docstring."""
    called = ""
    if inspect.isfunction(value):
        needed = [p.name for p in inspect.signature(value).parameters.values() if p.default is p.empty]
        called = f"({', '.join(needed)})"
    first = (inspect.getdoc(value) or "").split("\n\n")[0].replace("\n", " ").replace("|", "\\|")
    return f"| `{name}{called}` | {first} |"


def _entry(value: object, name: str) -> str:
    text = inspect.getdoc(value) or ""
    if inspect.isfunction(value):
        arguments = [
            f"{parameter.name}=..." if parameter.default is not parameter.empty else parameter.name
            for parameter in inspect.signature(value).parameters.values()
        ]
        return f"### `{name}`\n\n```text\n{name}({', '.join(arguments)})\n\n{text}\n```\n"
    return f"### `{name}`\n\n```text\n{text}\n```\n"
