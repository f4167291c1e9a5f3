"""Writes docs/api.md from the docstrings of the public names, those of `rotorgear` and of `rotorgear.plot`."""

from __future__ import annotations

import inspect
from pathlib import Path
from types import ModuleType

import rotorgear as rg

ROOT = Path(__file__).resolve().parents[1]
HEAD = """# Public names

All names of `import rotorgear as rg`, from their docstrings; `rg.plot` at the end. A part's keys stand in
[the model file](model_file.md), a result's keys in [JSON output](json.md), and examples in [Python](python.md).
"""


def pages() -> dict[str, str]:
    """Return the page by its path."""
    parts = [HEAD, *_sections(rg, ROOT / "rotorgear" / "__init__.pyi", "rg"), "## Pictures\n"]
    parts += _sections(rg.plot, ROOT / "rotorgear" / "plot" / "__init__.pyi", "rg.plot")
    return {"docs/api.md": "\n".join(parts).rstrip() + "\n"}


def _sections(package: ModuleType, stub: Path, prefix: str) -> list[str]:
    """The names in the order of the stub, under its comments."""
    parts: list[str] = []
    for line in stub.read_text(encoding="utf-8").splitlines():
        if line.startswith("# ") and package is rg:
            parts.append(f"## {line[2:].rstrip('.')}\n")
        words = line.split()
        if len(words) == 6 and words[4] == "as" and words[5] != "plot":
            parts.append(_entry(getattr(package, words[5]), f"{prefix}.{words[5]}"))
    return parts


def _entry(value: object, name: str) -> str:
    text = inspect.getdoc(value) or ""
    if inspect.isfunction(value):
        arguments = [
            f"{parameter.name}=..." if parameter.default is not parameter.empty else parameter.name
            for parameter in inspect.signature(value).parameters.values()
        ]
        return f"### `{name}`\n\n```text\n{name}({', '.join(arguments)})\n\n{text}\n```\n"
    return f"### `{name}`\n\n```text\n{text}\n```\n"
