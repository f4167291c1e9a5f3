"""Writes docs/coming_from.md: words of other programs and their keys, from the list that the program answers with."""

from __future__ import annotations

from rotorgear.model.parts.synonyms import GROUPS

HEAD = """# Coming from another program

A model file has one word for each thing. What other programs and drawings call it is no key, but `rotorgear check` answers it
with the key that is meant: `inner_diameter: unknown key (here that is 'bore')`. Capitals, blanks and hyphens do not matter.
Where a word leads to several keys, the first that the table has is meant.

| you have | begin with |
|---|---|
| a model of ROSS, openTorsion or a book | [sections of shafts](model_file.md#shaftsname) for elements; `at` is a place, no node |
| a gearbox in MASTA, Romax, KISSsoft or another program that writes REXS | [`rotorgear import`](rexs.md) |
| a casing in Nastran, Abaqus or Gmsh | [its mesh, or reduced matrices](casings.md#put-a-bearing-on-a-casing) |
| measured modes in a universal file, records over time | [the rig](rig.md) |
"""


def pages() -> dict[str, str]:
    """Return the page by its path in the repository."""
    parts = [HEAD]
    for title, words in GROUPS.items():
        by_keys: dict[tuple[str, ...], list[str]] = {}
        for word, keys in words.items():
            by_keys.setdefault(keys, []).append(f"`{word}`")
        rows = [f"| {', '.join(names)} | {', '.join(f'`{key}`' for key in keys)} |" for keys, names in by_keys.items()]
        parts.append("\n".join([f"## {title}\n", "| word | here |", "|---|---|", *rows]) + "\n")
    return {"docs/coming_from.md": "\n".join(parts)}
