"""Turns of what equal, equally spaced planets have alike, the sisters, as their carrier goes round.

Numbers x of N sisters at directions psi_i are x(psi) = x_0 + x_c cos psi + x_s sin psi + (further classes). Known at the
directions that the pins had at the start, they become R(a) x where the carrier has gone on by the angle a, with

    T_ij = 2/N sin(psi_i - psi_j),    R(a) = exp(-a T) = 1 + (1 - cos a) T^2 - sin a T,    R' = -T R.

T turns the first class on by a quarter and takes nothing of the others; R(-a) is the transpose of R(a). `system/planets.py` has
the equations of motion, `kernel_sisters.py` the same turns in compiled loops.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from rotorgear.solvers.time.arguments import Sisters


def sister_turn(angles: np.ndarray) -> np.ndarray:
    """T (N, N) of sisters at directions (N,) in rad."""
    return np.asarray(2.0 / len(angles) * np.sin(angles[:, None] - angles[None, :]))


def taken_round(T: np.ndarray, angle: float | np.ndarray, x: np.ndarray) -> np.ndarray:
    """R(a) x of x (N, ...), at one angle in rad or at one for each entry of the last axes."""
    quarter = np.tensordot(T, x, axes=1)
    return np.asarray(x + (1.0 - np.cos(angle)) * np.tensordot(T, quarter, axes=1) - np.sin(angle) * quarter)


def sisters_of(sets: Iterable[tuple[float, np.ndarray, np.ndarray]] = ()) -> Sisters:
    """Sets of sisters as compiled loops read them.

    Args:
        sets: speed of a carrier over that of the reference, directions (N,) of its pins at the start in rad, and places (k, N) in
            an array, each row the same of all planets.
    """
    rows = [(ratio, angles, row) for ratio, angles, places in sets for row in np.reshape(places, (-1, len(angles)))]
    most = max((len(angles) for _, angles, _ in rows), default=1)
    place = np.zeros((len(rows), most), dtype=np.int64)
    cosine = np.zeros((len(rows), most))
    sine = np.zeros((len(rows), most))
    for k, (_, angles, row) in enumerate(rows):
        N = len(angles)
        place[k, :N] = row
        cosine[k, :N] = np.cos(angles)
        sine[k, :N] = np.sin(angles)
    planets = np.array([len(angles) for _, angles, _ in rows], dtype=np.int64)
    return Sisters(place, planets, np.array([ratio for ratio, _, _ in rows], dtype=float), cosine, sine)


def turned(sisters: Sisters, angle: np.ndarray, x: np.ndarray) -> np.ndarray:
    """R(a) x of rows x (r, p) at angles (r,) of the reference in rad; what has no sisters stays."""
    found = np.array(x, dtype=float)
    for ratio, place, T in _each(sisters):
        found[:, place] = taken_round(T, ratio * np.asarray(angle), found[:, place].T).T
    return found


def over_a_turn(sisters: Sisters, x: np.ndarray) -> np.ndarray:
    """Mean of R(a) x over the angle for x (p,): as much of it as half a turn takes to its opposite is gone."""
    half = turned(sisters._replace(ratio=np.ones(len(sisters.ratio))), np.full(1, np.pi), x[None])[0]
    return np.asarray(0.5 * (x + half))


def turning_matrix(sisters: Sisters, size: int) -> np.ndarray:
    """W T (size, size) for unit speed of the reference: what planets see as a rate beside x' is -W T x."""
    found = np.zeros((size, size))
    for ratio, place, T in _each(sisters):
        found[np.ix_(place, place)] = ratio * T
    return found


def _each(sisters: Sisters) -> Iterable[tuple[float, np.ndarray, np.ndarray]]:
    """Ratio, places and T of each set."""
    for k, N in enumerate(sisters.planets):
        angles = np.arctan2(sisters.sine[k, :N], sisters.cosine[k, :N])
        yield float(sisters.ratio[k]), sisters.place[k, :N], sister_turn(angles)
