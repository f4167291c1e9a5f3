"""Where bearings stand in casings: each casing's reduced body, and the seat of a bearing with its place on the shaft."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.model.layout.places import Place
from rotorgear.model.parts.casing import Casing
from rotorgear.model.parts.tables import Tables
from rotorgear.progress import listener
from rotorgear.quantity import millimetres, nearest

if TYPE_CHECKING:
    from rotorgear.casings.reduced_body import ReducedBody

# A shaft whose axis misses the reference point of a seat by more than this stands in another one.
_OFF_AXIS = 5e-3


@dataclass(frozen=True)
class Seat:
    """The seat of a bearing or nonlinear element.

    Attributes:
        casing: name of its casing; number: of the seat, counted from 0.
        arm: (3,) from the reference point of the seat to the bearing, in m; the seat carries it rigidly.
    """

    casing: str
    number: int
    arm: np.ndarray


def reduced(model: Tables, name: str) -> ReducedBody:
    """The reduced body of a casing of the file.

    Raises:
        AnalysisError: its file can't be read, or does not fit.
        MissingExtraError: meshio or scikit-fem is not installed.
    """
    casing = model.casings[name]
    if casing.matrices is not None:
        from rotorgear.casings.matrices_file import read_matrices

        return read_matrices(Path(casing.matrices), casing.interface, casing.damping_ratio, name)
    from rotorgear.casings.casing import reduced_casing
    from rotorgear.model.layout.casings import casing_settings

    return reduced_casing(casing_settings(model, name), progress=listener())


def find_seat(model: Tables, address: str, place: Place, body_of: Callable[[str], ReducedBody]) -> Seat | None:
    """The seat of a part such as "bearings.left" at its place; None where it stands on the ground.

    Raises:
        AnalysisError: the casing has no such seat, or the shaft's axis does not run through it.
    """
    table, _, part = address.partition(".")
    casing = getattr(model, table)[part].casing
    if casing is None:
        return None
    body = body_of(casing)
    wanted = _seat_name(model.casings[casing], part)
    if wanted not in body.seats:
        guess = nearest(wanted, list(body.seats))
        hint = f"did you mean '{guess}'?" if guess else f"there is: {', '.join(body.seats) or 'none'}"
        raise AnalysisError(
            f"{address}.casing: casing '{casing}' has no seat '{wanted}': {hint} "
            f"(casings.{casing}.seats says which seat a bearing stands in)"
        )
    number = body.seats.index(wanted)
    x, y = model.shafts[place.shaft].position or (0.0, 0.0)
    arm = np.array([x, y, place.z]) - body.seat_points[number]
    off = math.hypot(arm[0], arm[1])
    if off > _OFF_AXIS:
        raise AnalysisError(
            f"{address}.casing: the axis of shaft '{place.shaft}' misses seat '{wanted}' of casing '{casing}' by "
            f"{millimetres(off)}: give the shaft the position {millimetres(float(body.seat_points[number][0]))}, "
            f"{millimetres(float(body.seat_points[number][1]))}, or name another seat"
        )
    return Seat(casing, number, arm)


def _seat_name(casing: Casing, part: str) -> str:
    """What the reduced body calls the seat of a bearing: of a file of matrices as `seats` says, else as the bearing."""
    said = casing.seats.get(part)
    return said.set if casing.matrices is not None and said is not None and said.set is not None else part
