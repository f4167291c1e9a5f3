"""How far excitations are from keeping a margin, as a smooth function of the numbers, with its derivatives.

With e = f / F - 1 of a mode beside a line F and the margin m,

    J = sum over lines and modes of w(s) h(e / m),    h(u) = (1 - u^2)^2 inside |u| < 1, else 0,

w rises from 0 to 1 as the participation s comes to the least one that counts. Modes closer than 0.2 % are taken together: w of
their common participation times the mean of h, a trace over their space, which does not care how they turn into each other.

Derivatives are exact (`sensitivity/derivatives.py`), with all modes taken together in the border of Nelson's system. Matrices are
differentiated by central differences about x; no eigenproblem is solved again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.layout.modes_at_speed import ModesAtSpeed, spaces_of
from rotorgear.analysis.sensitivity.derivatives import bordered, changed_forces
from rotorgear.analysis.sensitivity.forms import (
    GYROSCOPIC,
    MASS,
    STIFFNESS,
    FormNames,
    Shapes,
    complex_forms,
    exciting_forms,
    forms_of,
)
from rotorgear.results.campbell import ExcitationOrder
from rotorgear.system.system import System

# Participation begins to count at this share of the least one, so that the function has a slope there.
_RAMP = 0.7


@dataclass(frozen=True)
class Near:
    """Modes of one space near a line.

    Attributes:
        line: number of the line.
        modes: numbers of the modes.
        share: their participation together.
        weight, weight_slope: w and dw/ds.
        height: mean of h.
        slopes: dJ/df of each mode at fixed participation.
    """

    line: int
    modes: tuple[int, ...]
    share: float
    weight: float
    weight_slope: float
    height: float
    slopes: NDArray[np.float64]


def near_modes(state: ModesAtSpeed, margin: float | NDArray[np.float64], least: float) -> list[Near]:
    """The modes that count in J; `margin` is one for all, or that of each beside each line (l, m)."""
    found = []
    wide = np.broadcast_to(np.asarray(margin, dtype=float), state.taken.shape)
    spaces = spaces_of(state.hz)
    for line, F in enumerate(state.line_hz):
        for space in spaces:
            own = list(space)
            u = (state.hz[own] / F - 1.0) / wide[line, own]
            inside = np.maximum(1.0 - u**2, 0.0)
            share = float(state.taken[line, own].sum())
            t = float(np.clip((share / least - _RAMP) / (1.0 - _RAMP), 0.0, 1.0))
            weight = t * t * (3.0 - 2.0 * t)
            if weight == 0.0 or not inside.any():
                continue
            slope = 6.0 * t * (1.0 - t) / (least * (1.0 - _RAMP))
            df = weight * (-4.0 * u * inside) / (F * wide[line, own] * len(own))
            found.append(Near(line, space, share, weight, slope, float(np.mean(inside**2)), df))
    return found


def penalty(near: list[Near]) -> float:
    """J of one state."""
    return float(sum(one.weight * one.height for one in near))


def penalty_slopes(
    state: ModesAtSpeed,
    near: list[Near],
    lines: tuple[ExcitationOrder, ...],
    beside: Callable[[int], tuple[System, System, float]],
    count: int,
) -> NDArray[np.float64]:
    """dJ/dx (p,) of p numbers; `beside(j)` gives the systems above and below in number j, and the distance between them."""
    slopes = np.zeros(count)
    if not near:
        return slopes
    chosen = sorted({k for one in near for k in one.modes})
    shapes = np.asarray(state.V @ state.modes.q[:, chosen], dtype=complex)
    X = np.hstack([shapes.real, shapes.imag])
    omega = state.modes.omega[chosen]
    turning = [one for one in near if one.weight_slope > 0.0]
    for j in range(count):
        above, below, width = beside(j)
        change = (forms_of(above, state.speed, X) - forms_of(below, state.speed, X)) / width
        changed = complex_forms(change)
        df = frequency_slopes(state, chosen, changed[:3]) / (2.0 * np.pi)
        for one in near:
            slopes[j] += float(one.slopes @ df[[chosen.index(k) for k in one.modes]])
        for one in turning:
            own = [chosen.index(k) for k in one.modes]
            forces = changed_forces(above, below, width, state.speed, omega[own] ** 2, shapes[:, own])
            slopes[j] += one.weight_slope * one.height * _share_slope(state, one, lines, changed, own, shapes, forces)
    return slopes


def frequency_slopes(state: ModesAtSpeed, chosen: list[int], change: NDArray[np.complex128]) -> NDArray[np.float64]:
    """dw/dx of chosen modes from the changes of K, M and W G over their shapes (3, k, k)."""
    q = state.modes.q[:, chosen]
    w = state.modes.omega[chosen]
    K, M, G = (np.diagonal(change[form]) for form in (STIFFNESS, MASS, GYROSCOPIC))
    size = np.real(np.sum(q.conj() * (2.0 * (state.forms[MASS] @ q) * w - 1j * (state.forms[GYROSCOPIC] @ q)), axis=0))
    return np.asarray(np.real(K + 1j * w * G - w**2 * M) / size)


def _share_slope(
    state: ModesAtSpeed,
    one: Near,
    lines: tuple[ExcitationOrder, ...],
    changed: NDArray[np.complex128],
    own: list[int],
    shapes: NDArray[np.complex128],
    forces: Shapes,
) -> float:
    """d/dx of the participation of modes of one space; how they turn among themselves is no matter."""
    names = FormNames.of(state.system.model, state.speed)
    line = lines[one.line]
    total = 0.0
    for at, force in zip(own, forces.T, strict=True):
        phi = shapes[:, at]
        w2 = float(state.modes.omega[one.modes[own.index(at)]] ** 2)
        turned = bordered(state.system, state.speed, w2, shapes[:, own], force[:, None], np.zeros((len(own), 1)))[:, 0]
        X = np.column_stack([phi.real, turned.real, phi.imag, turned.imag])
        forms = complex_forms(forms_of(state.system, state.speed, X))
        part, whole = exciting_forms(names, line, forms)
        moved_part, moved_whole = exciting_forms(names, line, changed)
        size = float(np.real(whole[0, 0]))
        share = float(np.real(part[0, 0])) / size
        total += float(np.real(moved_part[at, at] - share * moved_whole[at, at])) / size
        total += 2.0 * float(np.real(part[0, 1] - share * whole[0, 1])) / size
    return total
