"""From what the model file says of a casing or a gear body to its reduced body: from memory, from disk, or computed and kept."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import TypeVar

from rotorgear.casings.fe_body import finite_element_body
from rotorgear.casings.reduced_body import ReducedBody, Surface
from rotorgear.casings.reduction import reduce
from rotorgear.casings.settings import BEYOND, CasingSettings
from rotorgear.casings.wheel import ReducedWheel
from rotorgear.casings.wheel_reduction import reduce_wheel
from rotorgear.errors import AnalysisError
from rotorgear.files.bounds import MESH
from rotorgear.files.cache import read_entry, write_entry
from rotorgear.files.read import UnreadableError, digest_of_named, named_file
from rotorgear.fingerprint import fingerprint
from rotorgear.progress import Progress, part_of, silent

# A process keeps this many bodies in memory; one takes some ten MB, mostly its surface.
_MOST_KEPT = 8
_KEPT: dict[str, ReducedBody | ReducedWheel] = {}
# Where bodies are computed: what other sources kept is passed over.
_MAKERS = ("casings",)
_SURFACE = "surface."

Body = TypeVar("Body", ReducedBody, ReducedWheel)


def reduced_casing(settings: CasingSettings, fmax: float | None = None, progress: Progress = silent) -> ReducedBody:
    """The reduced body of a casing.

    Args:
        settings: of the model file.
        fmax: highest frequency in Hz that an analysis asks for; used where the file gives no `modes_to`.
        progress: of reading, assembly and reduction.

    Raises:
        AnalysisError: what is wrong with mesh or settings, in one sentence with the remedy.
        MissingExtraError: meshio or scikit-fem is not installed.
    """
    if not settings.seats:
        raise AnalysisError(f"{settings.address}.seats: a casing without seats carries no bearing.")
    return _kept(ReducedBody, settings, settings.modes_to or (BEYOND * fmax if fmax else None), progress)


def reduced_gear_body(settings: CasingSettings, progress: Progress = silent) -> ReducedWheel:
    """The reduced body of a gear, whose seats are its bore and its rim; errors as of `reduced_casing`."""
    return _kept(ReducedWheel, settings, settings.modes_to, progress)


def keep(settings: CasingSettings, body: ReducedBody) -> None:
    """Keep in memory, for `reduced_casing`, the body of settings that was computed already."""
    _KEPT[key_of(settings, settings.modes_to)] = body


def key_of(settings: CasingSettings, modes_to: float | None) -> str:
    """A text that tells all inputs of a body; files enter with their contents."""
    files = tuple((part, digest_of_named(path, MESH.most_bytes)) for part, path in settings.files)
    return f"{fingerprint(*_MAKERS)} {files} {modes_to!r} {replace(settings, files=())!r}"


def _kept(kind: type[Body], settings: CasingSettings, modes_to: float | None, progress: Progress) -> Body:
    for _, path in settings.files:
        try:
            named_file(path, MESH.most_bytes)
        except UnreadableError:  # the reader says it with the nearest name
            finite_element_body(settings)
    key = key_of(settings, modes_to)
    body = _KEPT.get(key)
    if body is None:
        stored = read_entry("bodies", kind.__name__, key)
        if stored is None:
            fe = finite_element_body(settings, part_of(progress, 0.0, 0.3))
            tell = part_of(progress, 0.3, 1.0)
            body = reduce(fe, modes_to, tell)[0] if kind is ReducedBody else reduce_wheel(fe, modes_to, tell)
            values = {one.name: getattr(body, one.name) for one in fields(body) if one.name != "surface"}
            assert body.surface is not None, "a body of a mesh has a surface"
            values |= {_SURFACE + one.name: getattr(body.surface, one.name) for one in fields(Surface)}
            write_entry("bodies", kind.__name__, key, values)
        else:
            surface = Surface(*(stored.pop(_SURFACE + one.name) for one in fields(Surface)))
            # A casing that is held has no rigid motions.
            body = kind(**({"rigid": None} if kind is ReducedBody else {}) | stored, surface=surface)
        while len(_KEPT) >= _MOST_KEPT:
            _KEPT.pop(next(iter(_KEPT)))  # the oldest: dicts keep their order
        _KEPT[key] = body
    return body  # type: ignore[return-value]  # a key is of one kind: casings and gears differ in their address


def forget() -> None:
    """Drop what is kept in memory; the disk stays."""
    _KEPT.clear()
