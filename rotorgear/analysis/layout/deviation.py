"""How far the modes near excitations move when numbers of [scatter] do: standard deviations of frequencies, to first order.

    H_j = phi_a^H (K' - w_a w_b M' + i (w_a + w_b) / 2 (W G)') phi_b / (2 sqrt(w_a w_b)),    sigma^2 = sum_j (s_j |H_j|)^2

of number j with standard deviation s_j, over modes closer than 0.2 % as one space. |H_j| is the largest eigenvalue, which does
not care how modes turn into each other at a veering. A mode alone has |H_j| = |dw/dp_j|, the band of `rotorgear scatter`.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.layout.modes_at_speed import ModesAtSpeed
from rotorgear.analysis.layout.penalty import complex_forms, spaces_of
from rotorgear.analysis.scatter.forms import GYROSCOPIC, MASS, STIFFNESS, forms_of
from rotorgear.analysis.static.state_at import linear_system
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.model.spreads import Spreads, spreads_of
from rotorgear.system.plan import Plan

# Half width of the differences, in standard deviations.
_STEP = 1e-3
# Modes are looked at within so many margins of a line, and with this share of the least participation.
MARGINS = 3.0
_SOME = 0.7


def with_deviations(state: ModesAtSpeed, model: Model, plan: Plan, margin: float, least: float) -> ModesAtSpeed:
    """The state with relative standard deviations of its modes; 0 of those that no line is near to or excites.

    Args:
        state: modes of
        model: whose [scatter] says what scatters, on the mesh of
        plan: that the state has.
        margin: that modes keep from lines.
        least: least participation that counts.

    Raises:
        AnalysisError: a number whose scatter moves a place past another one.
    """
    near = np.abs(state.hz[None, :] / state.line_hz[:, None] - 1.0) < MARGINS * margin
    chosen = np.flatnonzero(np.any(near & (state.taken >= _SOME * least), axis=0))
    # A space is looked at as a whole.
    own = [space for space in spaces_of(state.hz) if set(space) & set(chosen.tolist())]
    modes = [k for space in own for k in space]
    sigma = np.zeros(len(state.hz))
    if modes:
        spreads = spreads_of(model, model.scatter)
        variance = np.zeros(len(state.hz))
        for j in range(len(spreads)):
            H = _coupling(state, spreads, j, plan, modes)
            for space in own:
                at = [modes.index(k) for k in space]
                size = np.abs(np.linalg.eigvalsh(H[np.ix_(at, at)])).max()
                variance[list(space)] += (size / state.modes.omega[list(space)]) ** 2
        sigma = np.sqrt(variance)
    return replace(state, sigma=sigma)


def _coupling(state: ModesAtSpeed, spreads: Spreads, j: int, plan: Plan, modes: list[int]) -> NDArray[np.complex128]:
    """s_j H_j over some modes (k, k), in rad/s."""
    shapes = np.asarray(state.V @ state.modes.q[:, modes], dtype=complex)
    X = np.hstack([shapes.real, shapes.imag])
    step = np.zeros(len(spreads))
    step[j] = _STEP
    above, below = (
        linear_system(spreads.at(side * step), [state.speed], plan, beside=state.system.state) for side in (1.0, -1.0)
    )
    if not above.n == below.n == state.system.n:
        raise AnalysisError(
            f"[scatter] of {spreads.numbers.addresses[j]} moves a place past another one that it coincides with: move one of "
            "them by more than the scatter, or leave it out"
        )
    change = (forms_of(above, state.speed, X) - forms_of(below, state.speed, X))[:3] / (2.0 * _STEP)
    K, M, G = (complex_forms(change)[form] for form in (STIFFNESS, MASS, GYROSCOPIC))
    w = state.modes.omega[modes]
    H = K - np.outer(w, w) * M + 0.5j * np.add.outer(w, w) * G
    return np.asarray(0.5 * (H + H.conj().T) / (2.0 * np.sqrt(np.outer(w, w))))


def kept_deviations(states: list[ModesAtSpeed], margin: float, least: float) -> float:
    """By how many standard deviations the modes that count keep a margin, the least of all; infinite where none is near."""
    found = [np.inf]
    for state in states:
        assert state.sigma is not None
        for F, taken in zip(state.line_hz, state.taken, strict=True):
            counts = (taken >= least) & (state.sigma > 0.0)
            found += list((np.abs(state.hz / F - 1.0)[counts] - margin) / (state.sigma * state.hz / F)[counts])
    return float(min(found))
