"""From what the model file says of a casing to its reduced body: from memory, from disk, or computed and kept."""

from __future__ import annotations

from rotorgear.casings.fe_body import finite_element_body
from rotorgear.casings.kept_bodies import key_of, path_of, read_body, write_body
from rotorgear.casings.reduced_body import ReducedBody
from rotorgear.casings.reduction import reduce
from rotorgear.casings.settings import CasingSettings
from rotorgear.errors import AnalysisError
from rotorgear.progress import Progress, part_of, silent

# Fixed-interface modes up to this multiple of an analysis's highest frequency bring its error to some 2e-3 without residual
# shapes, and well below 1e-3 with them.
BEYOND = 2.0
# A process keeps this many bodies in memory; one takes some ten MB, mostly its surface.
_MOST_KEPT = 8
_KEPT: dict[str, ReducedBody] = {}


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
    for _, path in settings.files:
        if not path.is_file():  # the reader says it with the nearest name
            finite_element_body(settings)
    if not settings.seats:
        raise AnalysisError(f"{settings.address}.seats: a casing without seats carries no bearing.")
    modes_to = settings.modes_to or (BEYOND * fmax if fmax else None)
    key = key_of(settings, modes_to)
    if key not in _KEPT:
        body = read_body(path_of(key), key)
        if body is None:
            fe = finite_element_body(settings, part_of(progress, 0.0, 0.3))
            body = reduce(fe, modes_to, part_of(progress, 0.3, 1.0))[0]
            write_body(path_of(key), key, body)
        while len(_KEPT) >= _MOST_KEPT:
            _KEPT.pop(next(iter(_KEPT)))  # the oldest: dicts keep their order
        _KEPT[key] = body
    return _KEPT[key]


def forget() -> None:
    """Drop what is kept in memory; the disk stays."""
    _KEPT.clear()
