"""A fact that an analysis states beside its numbers: of which part, what it left out or warns about, why, and how much.

It is made where the decision is made, and is its own sentence: `Note("meshes.pair", "the backlash", "teeth in contact do not
reach it", "0.1 mm")` reads "meshes.pair (0.1 mm): the backlash; teeth in contact do not reach it". Facts of one cause that hold
for several parts become one sentence where they are shown (`sentences`).
"""

from __future__ import annotations

from collections.abc import Iterable

# On a screen, a sentence names up to this many parts; of more, one of each kind and how many there are.
NAMED = 3


class Note(str):
    """A sentence that knows what it is made of.

    Attributes:
        part: address of the part, or of one of its keys, as in the model file; "" of what belongs to no single part.
        what: what is left out, or what the warning is. why: the reason. value: its size. Each of them may be "".
    """

    part: str
    what: str
    why: str
    value: str

    def __new__(cls, part: str, what: str, why: str = "", value: str = "") -> Note:
        note = str.__new__(cls, _sentence([(part, value)], what, why, NAMED))
        note.part = part
        note.what = what
        note.why = why
        note.value = value
        return note

    def __reduce__(self) -> tuple[type[Note], tuple[str, str, str, str]]:
        return Note, (self.part, self.what, self.why, self.value)


def as_notes(texts: Iterable[str]) -> tuple[Note, ...]:
    """Facts, each once; a plain sentence is one about no single part."""
    return tuple(dict.fromkeys(text if isinstance(text, Note) else Note("", text) for text in texts))


def sentences(notes: Iterable[str], named: int | None = None) -> list[str]:
    """One sentence for each cause, in the order in which the causes come first; it names all parts, or at most some of them."""
    causes: dict[tuple[bool, str, str], list[tuple[str, str]]] = {}
    for note in as_notes(notes):
        causes.setdefault((bool(note.part), note.what, note.why), []).append((note.part, note.value))
    return [_sentence(where, what, why, named) for (_, what, why), where in causes.items()]


def _sentence(where: list[tuple[str, str]], what: str, why: str, named: int | None) -> str:
    """Parts with their values, what and why; a value that neighbours share stands behind the last of them."""
    if not where[0][0]:  # of no single part
        size = f"({where[0][1]})" if where[0][1] else ""
        return ": ".join(filter(None, (" ".join(filter(None, (what, size))), why)))
    # Keys of one kind stand together: of many backlashes and many unbalances, one each is named.
    kinds: dict[tuple[str, str], list[tuple[str, str]]] = {}
    for part, value in where:
        table, _, rest = part.partition(".")
        kinds.setdefault((table, rest.partition(".")[2]), []).append((part, value))
    many = named is not None and len(where) > named
    parts = []
    for entries in kinds.values():
        shown = entries[:1] if many and len(entries) > 2 else entries
        for k, (part, value) in enumerate(shown):
            shared = k + 1 < len(shown) and shown[k + 1][1] == value
            parts.append(f"{part} ({value})" if value and not shared else part)
        if len(shown) < len(entries):
            parts[-1] += f" and {len(entries) - len(shown)} more"
    last = parts.pop()
    names = f"{', '.join(parts)}{', ' if ' and ' in last else ' and '}{last}" if parts else last
    return f"{names}: {'; '.join(filter(None, (what, why)))}"
