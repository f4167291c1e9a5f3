"""Writes docs/api.md: the public names of `rotorgear` and of `rotorgear.plot` in groups, as the stubs list them.

The site shows each with its signature, types, fields, returns and errors, from the sources (mkdocstrings).
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
HEAD = """# Public names

All names of `import rotorgear as rg`, and the pictures of `rg.plot`. `help(rg.modal)` tells arguments, units and errors of
a function, `help(rg.ModalResult)` the fields of a result. [Python](python.md) has examples.
"""
_SITE = """
[The site](../CONTRIBUTING.md#docs), which `python docs/build_site.py` builds, shows every name with types, units and links.
"""
# What a group holds, by the comment above it in the stub.
_WORDS = {
    "A model from a file or from parts": "`rg.load` reads a [model file](model_file.md); the classes are its parts.",
    "The verbs: a model in, a result out": "Most are the [command](commands.md) of their name and take its options.",
    "A force law of your own": "[Force laws](python.md#a-force-law-of-your-own) that you write act in every analysis.",
    "A rig beside them": "What reads measurements and puts them [beside a model](rig.md).",
    "Files of results": "What saves results and writes them for other programs.",
    "The results": "What the verbs return; the keys of their JSON stand under [commands](commands.md#json-output).",
    "The errors": "What is raised: see [Troubleshooting](errors.md).",
    "Pictures": "Functions of `rg.plot`; `result.plot()` calls the one of its kind ([gallery](gallery.md)).",
}
_TYPES = """## Types beside them

What public functions return, and what results and parts hold. They are no names of `rg`.
"""
# The search shows the pages that explain before this one.
_LATER = "---\nsearch:\n  boost: 0.3\n---\n"
_WIDTH = 130


def pages() -> dict[str, str]:
    """Return the summary by its path: the names of each group."""
    parts = [HEAD.rstrip(), _SITE]
    for heading, names in groups():
        listed = textwrap.fill(
            " ".join(f"`{name.rpartition('.')[2]}`" for name in names), _WIDTH, break_on_hyphens=False
        )
        parts.append(f"## {heading}\n\n{_WORDS[heading]}\n\n{listed}\n")
    return {"docs/api.md": "\n".join(parts)}


def site_pages() -> dict[str, str]:
    """Return the whole page by its path, for mkdocstrings."""
    from machinery.declared_fields import types_of

    parts = [_LATER, HEAD]
    found = []
    for heading, names in groups():
        parts.append(f"## {heading}\n\n{_WORDS[heading]}\n")
        parts += [_entry(name, name.replace("rotorgear", "rg")) for name in names]
        found += names
    parts.append(_TYPES)
    parts += [_entry(path, path.rpartition(".")[2]) for path in types_of(found)]
    return {"docs/api.md": "\n".join(parts)}


def _entry(path: str, heading: str) -> str:
    return f"::: {path}\n    options:\n      heading: {heading}\n      toc_label: {heading}\n"


def groups() -> Iterator[tuple[str, list[str]]]:
    """Yield the comment above each group of the stub, and the paths of its names; the pictures as the last group."""
    heading, names = "", []
    for line in (ROOT / "rotorgear" / "__init__.pyi").read_text(encoding="utf-8").splitlines():
        if line.startswith("# "):
            if names:
                yield heading, names
            heading, names = line[2:].rstrip("."), []
        names += [f"rotorgear.{name}" for name in _name(line)]
    yield heading, names
    pictures = (ROOT / "rotorgear" / "plot" / "__init__.pyi").read_text(encoding="utf-8").splitlines()
    yield "Pictures", [f"rotorgear.plot.{name}" for line in pictures for name in _name(line)]


def _name(line: str) -> list[str]:
    words = line.split()
    return [words[5]] if len(words) == 6 and words[4] == "as" and words[5] != "plot" else []
