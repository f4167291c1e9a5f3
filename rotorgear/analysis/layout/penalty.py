"""How far excitations are from keeping a margin, as a smooth function of the numbers, with its derivatives.

With e = f / F - 1 of a mode beside a line F and the margin m,

    J = sum over lines and modes of w(s) h(e / m),    h(u) = (1 - u^2)^2 inside |u| < 1, else 0,

w rises from 0 to 1 as the participation s comes to the least one that counts. Modes closer than 0.2 % are taken together: w of
their common participation times the mean of h, a trace over their space, which does not care how they turn into each other.

Derivatives are exact (Fox and Kapoor 1968; Nelson 1976), for the rotating system Q(w) = K + i w W G - w^2 M:

    w' = phi^H Q' phi / phi^H (2 w M - i W G) phi,    [Q  B; C^H 0] [phi'; .] = [-Q' phi; 0],

with B = (2 w M - i W G) Phi and C = M Phi of all modes taken together. Matrices are differentiated by central differences about
x; no eigenproblem is solved again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from rotorgear.analysis.layout.modes_at_speed import ModesAtSpeed
from rotorgear.analysis.scatter.forms import GYROSCOPIC, MASS, STIFFNESS, FormNames, forms_of
from rotorgear.analysis.scatter.samples import exciting_forms, spin_signs
from rotorgear.results.campbell import ExcitationOrder
from rotorgear.system.system import System

# Modes closer than this are looked at as one space.
CLOSE = 2e-3
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


def spaces_of(hz: NDArray[np.float64]) -> list[tuple[int, ...]]:
    """Modes by number, those that are close together."""
    spaces: list[list[int]] = []
    for k, f in enumerate(hz):
        if spaces and f / hz[spaces[-1][-1]] - 1.0 < CLOSE:
            spaces[-1].append(k)
        else:
            spaces.append([k])
    return [tuple(space) for space in spaces]


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
            pushed = [
                _pushed(above, below, state, shapes[:, chosen.index(k)], omega[chosen.index(k)], width)
                for k in one.modes
            ]
            own = [chosen.index(k) for k in one.modes]
            slopes[j] += one.weight_slope * one.height * _share_slope(state, one, lines, changed, own, shapes, pushed)
    return slopes


def frequency_slopes(state: ModesAtSpeed, chosen: list[int], change: NDArray[np.complex128]) -> NDArray[np.float64]:
    """dw/dx of chosen modes from the changes of K, M and W G over their shapes (3, k, k)."""
    q = state.modes.q[:, chosen]
    w = state.modes.omega[chosen]
    K, M, G = (np.diagonal(change[form]) for form in (STIFFNESS, MASS, GYROSCOPIC))
    size = np.real(np.sum(q.conj() * (2.0 * (state.forms[MASS] @ q) * w - 1j * (state.forms[GYROSCOPIC] @ q)), axis=0))
    return np.asarray(np.real(K + 1j * w * G - w**2 * M) / size)


def complex_forms(forms: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Forms (a, k, k) among complex shapes from those over their real parts, then their imaginary ones (a, 2 k, 2 k)."""
    k = forms.shape[1] // 2
    C = np.vstack([np.eye(k), 1j * np.eye(k)])
    return np.asarray(C.conj().T @ forms @ C)


def _pushed(
    above: System, below: System, state: ModesAtSpeed, phi: NDArray[np.complex128], w: float, width: float
) -> NDArray[np.complex128]:
    """Q' phi (n,)."""

    def product(system: System) -> NDArray[np.complex128]:
        turning = 1j * w * state.speed * (system.gyroscopic @ phi) if state.speed else 0.0
        return np.asarray(system.stiffness(state.speed) @ phi + turning - w**2 * (system.mass @ phi))

    return (product(above) - product(below)) / width


def _share_slope(
    state: ModesAtSpeed,
    one: Near,
    lines: tuple[ExcitationOrder, ...],
    changed: NDArray[np.complex128],
    own: list[int],
    shapes: NDArray[np.complex128],
    pushed: list[NDArray[np.complex128]],
) -> float:
    """d/dx of the participation of modes of one space; how they turn among themselves is no matter."""
    names = FormNames.of(state.system.model)
    senses = spin_signs(state.system.model, state.speed)
    line = lines[one.line]
    together = shapes[:, own]
    total = 0.0
    for k, push in zip(one.modes, pushed, strict=True):
        phi = state.V @ state.modes.q[:, k]
        turned = _bordered(state, float(state.modes.omega[k]), together, push)
        X = np.column_stack([phi.real, turned.real, phi.imag, turned.imag])
        forms = complex_forms(forms_of(state.system, state.speed, X))
        part, whole = exciting_forms(names, line, forms, senses)
        moved_part, moved_whole = exciting_forms(names, line, changed, senses)
        at = own[one.modes.index(k)]
        size = float(np.real(whole[0, 0]))
        share = float(np.real(part[0, 0])) / size
        total += float(np.real(moved_part[at, at] - share * moved_whole[at, at])) / size
        total += 2.0 * float(np.real(part[0, 1] - share * whole[0, 1])) / size
    return total


def _bordered(
    state: ModesAtSpeed, w: float, together: NDArray[np.complex128], push: NDArray[np.complex128]
) -> NDArray[np.complex128]:
    """phi' (n,) outside the space of the shapes `together` (n, c)."""
    from scipy.sparse.linalg import splu

    system = state.system
    K = system.stiffness(state.speed)
    M = system.mass
    W = state.speed * system.gyroscopic
    Q = sp.csc_array(K + 1j * w * W - w**2 * M)
    # Rows in N stand beside rows in N m, and the border beside both: to unit size first.
    d = 1.0 / np.sqrt(np.maximum(abs(K).max(axis=1).toarray().ravel(), 1e-300))
    D = sp.diags_array(d)
    B = D @ (2.0 * w * (M @ together) - 1j * (W @ together))
    C = D @ (M @ together)
    B = B / np.linalg.norm(B, axis=0)
    C = C / np.linalg.norm(C, axis=0)
    c = together.shape[1]
    A = sp.csc_array(sp.block_array([[D @ Q @ D, sp.csc_array(B)], [sp.csc_array(C.conj().T), None]]))
    answer = splu(A).solve(np.concatenate([-d * push, np.zeros(c, dtype=complex)]))
    return np.asarray(d * answer[:-c])
