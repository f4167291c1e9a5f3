"""How far excitations are from keeping a margin, as a smooth function of the numbers, with its derivatives.

With e = f / F - 1 of a mode beside a line F and the margin m,

    J = sum over lines and modes of w(s) h(e / m),    h(u) = (1 - u^2)^2 inside |u| < 1, else 0,

w rises from 0 to 1 as the participation s goes from 0.6 of the least one that counts to that one, so that a mode just below it
is no way out of a margin. Modes closer than 0.2 % are taken together: w of
their common participation times the mean of h, a trace over their space, which does not care how they turn into each other.

Derivatives are exact (`sensitivity/derivatives.py`), with all modes taken together in the border of Nelson's system. Matrices are
differentiated by central differences about x; no eigenproblem is solved again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.layout.modes_at_speed import ModesAtSpeed, spaces_of
from rotorgear.analysis.sensitivity.derivatives import bordered, changed_forces
from rotorgear.analysis.sensitivity.forms import Floats, FormNames, Shapes, complex_forms, forms_of
from rotorgear.results.campbell import ExcitationOrder
from rotorgear.results.optimise import WEIGHS_FROM
from rotorgear.system.system import System

# A line by number, the modes of one space near it, w, dw/ds, the mean of h, and dJ/df of each mode at fixed participation.
Near = tuple[int, tuple[int, ...], float, float, float, Floats]


def near_modes(state: ModesAtSpeed, margin: Floats, least: float) -> Iterator[Near]:
    """The modes that count in J; `margin` is that of each beside each line (l, m)."""
    spaces = spaces_of(state.hz)
    for line, F in enumerate(state.line_hz):
        for space in spaces:
            own = list(space)
            u = (state.hz[own] / F - 1.0) / margin[line, own]
            inside = np.maximum(1.0 - u**2, 0.0)
            share = float(state.taken[line, own].sum())
            t = float(np.clip((share / least - WEIGHS_FROM) / (1.0 - WEIGHS_FROM), 0.0, 1.0))
            weight = t * t * (3.0 - 2.0 * t)
            if weight and inside.any():
                slope = 6.0 * t * (1.0 - t) / (least * (1.0 - WEIGHS_FROM))
                df = weight * (-4.0 * u * inside) / (F * margin[line, own] * len(own))
                yield line, space, weight, slope, float(np.mean(inside**2)), df


def penalty(state: ModesAtSpeed, margin: Floats, least: float) -> float:
    """J of one state; arguments as of `near_modes`."""
    return float(sum(weight * height for _, _, weight, _, height, _ in near_modes(state, margin, least)))


def penalty_slopes(
    state: ModesAtSpeed,
    near: list[Near],
    lines: tuple[ExcitationOrder, ...],
    beside: Callable[[int], tuple[System, System, float]],
    count: int,
) -> Floats:
    """dJ/dx (p,) of p numbers; `beside(j)` gives the systems above and below in number j, and the distance between them."""
    slopes = np.zeros(count)
    if not near:
        return slopes
    chosen = sorted({k for _, modes, *_ in near for k in modes})
    shapes = np.asarray(state.V @ state.modes.q[:, chosen], dtype=complex)
    X = np.hstack([shapes.real, shapes.imag])
    omega = state.modes.omega[chosen]
    names = FormNames.of(state.system.model, state.speed)

    def share_slope(line: ExcitationOrder, own: list[int], changed: NDArray[np.complex128], forces: Shapes) -> float:
        """d/dx of the participation of modes of one space; how they turn among themselves is no matter."""
        moved_part, moved_whole = names.exciting(line, changed)
        still = np.zeros((len(own), 1))
        total = 0.0
        for at, force in zip(own, forces.T, strict=True):
            w2 = float(omega[at] ** 2)
            turned = bordered(state.system, state.speed, w2, shapes[:, own], force[:, None], still)[:, 0]
            phi = shapes[:, at]
            X = np.column_stack([phi.real, turned.real, phi.imag, turned.imag])
            part, whole = names.exciting(line, complex_forms(forms_of(state.system, state.speed, X)))
            size = float(np.real(whole[0, 0]))
            share = float(np.real(part[0, 0])) / size
            total += float(np.real(moved_part[at, at] - share * moved_whole[at, at])) / size
            total += 2.0 * float(np.real(part[0, 1] - share * whole[0, 1])) / size
        return total

    for j in range(count):
        above, below, width = beside(j)
        changed = complex_forms((forms_of(above, state.speed, X) - forms_of(below, state.speed, X)) / width)
        df = frequency_slopes(state, chosen, changed[:3]) / (2.0 * np.pi)
        for _, modes, *_, of_frequency in near:
            slopes[j] += float(of_frequency @ df[[chosen.index(k) for k in modes]])
        for line, modes, _, of_share, height, _ in near:
            if of_share > 0.0:
                own = [chosen.index(k) for k in modes]
                forces = changed_forces(above, below, width, state.speed, omega[own] ** 2, shapes[:, own])
                slopes[j] += of_share * height * share_slope(lines[line], own, changed, forces)
    return slopes


def frequency_slopes(state: ModesAtSpeed, chosen: list[int], change: NDArray[np.complex128]) -> Floats:
    """dw/dx of chosen modes from the changes of K, M and W G over their shapes (3, k, k)."""
    q = state.modes.q[:, chosen]
    w = state.modes.omega[chosen]
    K, M, G = (np.diagonal(form) for form in change)
    _, mass, gyroscopic = state.forms[:3]
    size = np.real(np.sum(q.conj() * (2.0 * (mass @ q) * w - 1j * (gyroscopic @ q)), axis=0))
    return np.asarray(np.real(K + 1j * w * G - w**2 * M) / size)
