"""From what the model file says of a casing or a gear body to its reduced body: from memory, from disk, or computed and kept."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from rotorgear.casings.fe_body import FiniteElementBody, finite_element_body
from rotorgear.casings.kept_bodies import key_of, path_of, read_body, read_wheel, write_body, write_wheel
from rotorgear.casings.reduced_body import ReducedBody
from rotorgear.casings.reduction import reduce
from rotorgear.casings.settings import BEYOND, CasingSettings
from rotorgear.casings.wheel import ReducedWheel
from rotorgear.casings.wheel_reduction import reduce_wheel
from rotorgear.errors import AnalysisError
from rotorgear.progress import Progress, part_of, silent

# A process keeps this many bodies in memory; one takes some ten MB, mostly its surface.
_MOST_KEPT = 8
_KEPT: dict[str, ReducedBody | ReducedWheel] = {}

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
    modes_to = settings.modes_to or (BEYOND * fmax if fmax else None)

    def computed(fe: FiniteElementBody, tell: Progress) -> ReducedBody:
        return reduce(fe, modes_to, tell)[0]

    return _kept(settings, modes_to, (read_body, write_body), computed, progress)


def reduced_gear_body(settings: CasingSettings, progress: Progress = silent) -> ReducedWheel:
    """The reduced body of a gear, whose seats are its bore and its rim; errors as of `reduced_casing`."""

    def computed(fe: FiniteElementBody, tell: Progress) -> ReducedWheel:
        return reduce_wheel(fe, settings.modes_to, tell)

    return _kept(settings, settings.modes_to, (read_wheel, write_wheel), computed, progress)


def keep(settings: CasingSettings, body: ReducedBody) -> None:
    """Keep in memory, for `reduced_casing`, the body of settings that was computed already."""
    _KEPT[key_of(settings, settings.modes_to)] = body


def _kept(
    settings: CasingSettings,
    modes_to: float | None,
    disk: tuple[Callable[[Path, str], Body | None], Callable[[Path, str, Body], None]],
    compute: Callable[[FiniteElementBody, Progress], Body],
    progress: Progress,
) -> Body:
    for _, path in settings.files:
        if not path.is_file():  # the reader says it with the nearest name
            finite_element_body(settings)
    read, write = disk
    key = key_of(settings, modes_to)
    body = _KEPT.get(key)
    if body is None:
        body = read(path_of(key), key)
        if body is None:
            fe = finite_element_body(settings, part_of(progress, 0.0, 0.3))
            body = compute(fe, part_of(progress, 0.3, 1.0))
            write(path_of(key), key, body)
        while len(_KEPT) >= _MOST_KEPT:
            _KEPT.pop(next(iter(_KEPT)))  # the oldest: dicts keep their order
        _KEPT[key] = body
    return body  # type: ignore[return-value]  # a key is of one kind: casings and gears differ in their address


def forget() -> None:
    """Drop what is kept in memory; the disk stays."""
    _KEPT.clear()
