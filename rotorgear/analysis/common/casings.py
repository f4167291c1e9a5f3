"""What analyses say of casings: how far they were reduced, and how wrong a mode is for it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rotorgear.quantity import millimetres
from rotorgear.system.system import System

# A bearing nearer to the point of its seat than this stands there.
_APART = 1e-4
# A relative error of a frequency above this is worth a warning.
_NOTICED = 1e-3


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
    for table in ("bearings", "nonlinear_elements"):
        for part in getattr(model, table):
            seat = system.layout.seat(f"{table}.{part}")
            if seat is not None and abs(seat.arm[2]) > _APART:
                yield (
                    f"{table}.{part}: the flexibility of its seat over the {millimetres(abs(float(seat.arm[2])))} to the "
                    "point of the seat, which carries it rigidly"
                )


def casing_warnings(errors: np.ndarray, s: np.ndarray) -> Iterator[str]:
    """A sentence where the reduction of casings makes a frequency wrong by more than a thousandth."""
    over = np.flatnonzero(errors > _NOTICED)
    if over.size:
        first = int(over[0])
        yield (
            f"casings: their reduction makes {over.size} of {len(errors)} frequencies wrong by more than {_NOTICED:g}, the "
            f"first of them at {abs(s[first]) / (2.0 * np.pi):.4g} Hz by {errors[first]:.1e}; raise modes_to"
        )
