"""What analyses ask of casings and say of them: how far they were reduced, and how wrong a mode is for it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from rotorgear.casings.settings import BEYOND
from rotorgear.model.model import Model
from rotorgear.quantity import millimetres
from rotorgear.system.system import System

if TYPE_CHECKING:
    from rotorgear.solvers.time.local_forces import LocalLaw

# Harmonics of a law that are looked at, at most.
_HARMONICS = 10
# Modes of a casing that are taken where the file does not ask for more.
MOST_MODES = 120
# A bearing nearer to the point of its seat than this stands there.
_APART = 1e-4
# A relative error of a frequency above this is worth a warning.
NOTICED = 1e-3


def with_casing_modes(model: Model, fmax: float | None) -> tuple[Model, tuple[str, ...]]:
    """The model with modes of its casings up to twice the highest frequency that an analysis asks for.

    Where the file gives `modes_to`, where the usual number of modes reaches as far, and without casings from meshes, it is the
    model itself. More than some hundred modes are not taken unasked: their number, which grows with f^1.5 at most, sets the cost.

    Args:
        model: any.
        fmax: in Hz; None: no range is asked for.

    Returns:
        The model, and a sentence on each casing whose modes end below twice that frequency.
    """
    wanted = BEYOND * (fmax or 0.0)
    further: dict[str, float] = {}
    short = []
    for name, part in model.casings.items():
        if not part.mesh or part.modes_to is not None:
            continue
        body = model.layout.casing(name)
        if body.left_frequency >= wanted:
            continue
        most = body.left_frequency * (MOST_MODES / max(len(body.fixed_frequency), 1)) ** (2.0 / 3.0)
        if wanted > most:
            short.append(
                f"casings.{name}: its modes go to {most:.3g} Hz, and this analysis to {fmax:.4g} Hz; modes_to takes in more"
            )
        # To two digits, so that analyses that ask for nearly the same find one body.
        reach = min(wanted, most)
        digit = 10.0 ** (math.floor(math.log10(reach)) - 1)
        further[f"casings.{name}.modes_to"] = math.ceil(reach / digit) * digit
    return (model.with_(further) if further else model), tuple(short)


def reduction_errors(system: System, s: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Estimated relative error (m,) of |s| by the reduction of casings, from free shapes x (n, m) of any scale."""
    errors = np.zeros(len(s))
    if not system.model.casings:
        return errors
    q = system.dofs.expand(x / np.sqrt(np.real(np.einsum("nm,nm->m", x.conj(), system.mass @ x))))
    for name in system.model.casings:
        body = system.layout.casing(name)
        own = q[system.nodes.of_casing(name)]
        for k in np.flatnonzero(np.abs(s) > 0.0):
            of_square = body.eigenvalue_error(float(np.abs(s[k]) ** 2), own[:, k])
            errors[k] += 0.5 * (of_square or 0.0)
    return errors


def casing_notes(system: System) -> Iterator[str]:
    """Say what of each casing was left out."""
    model = system.model
    for name in model.casings:
        body = system.layout.casing(name)
        modes = len(body.fixed_frequency)
        top = f"{modes} mode{'s'[: modes != 1]} to {body.fixed_frequency[-1]:.4g} Hz" if modes else "no modes"
        yield f"casings.{name}: all but the motions of its {len(body.seats)} seats and {top} between fixed seats"
        if model.casings[name].matrices is None:
            yield f"casings.{name}: the error of its mesh, which 'rotorgear casing' estimates"
        elif body.error is None:
            yield f"casings.{name}: the error of its reduction; its file says nothing of what was left out"
        yield from (f"casings.{name}: {note}" for note in body.notes)
        for part in model.casings[name].seats:
            tables = ("bearings", "nonlinear_elements", "gears")
            table = next(table for table in tables if part in getattr(model, table))
            if getattr(model, table)[part].casing != name:
                yield (
                    f"casings.{name}.seats.{part}: {table}.{part}, which stands elsewhere; casing = '{name}' among its keys "
                    "puts it into this seat"
                )
    for address, (_, _, arm) in system.layout.seats:
        if abs(arm[2]) > _APART:
            yield (
                f"{address}: the flexibility of its seat over the {millimetres(abs(float(arm[2])))} to the point of the seat, "
                "which carries it rigidly"
            )


def time_warnings(model: Model, laws: Sequence[LocalLaw], speed: float) -> Iterator[str]:
    """A sentence on each casing whose modes end below twice the highest harmonic that acts in a motion over time.

    Such motions have the modes of the model file, or the usual number of them: they don't state what a reduction makes wrong.

    Args:
        model: with casings or without.
        laws: what acts.
        speed: the largest one of the reference, in rad/s.
    """
    top = float(rates(laws, speed).max(initial=0.0)) / (2.0 * np.pi) if model.casings else 0.0
    for name in model.casings:
        body = model.layout.casing(name)
        if body.left_frequency < BEYOND * top:
            yield (
                f"casings.{name}: its {len(body.fixed_frequency)} modes serve up to {body.left_frequency / BEYOND:.4g} Hz, half "
                f"of the lowest one that is left out, and what excites goes to {top:.4g} Hz; modes_to takes in more"
            )


def casing_warnings(errors: np.ndarray, s: np.ndarray) -> Iterator[str]:
    """A sentence where the reduction of casings makes a frequency wrong by more than a thousandth."""
    over = np.flatnonzero(errors > NOTICED)
    if over.size:
        first = int(over[0])
        yield (
            f"casings: their reduction makes {over.size} of {len(errors)} frequencies wrong by more than {NOTICED:g}, the "
            f"first of them at {abs(s[first]) / (2.0 * np.pi):.4g} Hz by {errors[first]:.1e}; raise modes_to"
        )


def rates(laws: Sequence[LocalLaw], speed: float) -> np.ndarray:
    """Rad/s of all harmonics of all laws that matter, up to the 10th, at a speed of the reference in rad/s, each once."""
    frequencies = [
        each.order * abs(speed) * harmonic
        for law in laws
        for each in law.repeats()
        for harmonic in range(1, min(each.harmonics, _HARMONICS) + 1)
    ]
    return np.unique(np.round([w for w in frequencies if w > 0.0], 6))
