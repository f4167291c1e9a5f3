"""Modes of a model at an operating speed, from one solution of the whole system, and how far they scatter.

Where numbers of [scatter] vary, the frequencies near excitations have standard deviations, to first order:

    H_j = phi_a^H (K' - w_a w_b M' + i (w_a + w_b) / 2 (W G)') phi_b / (2 sqrt(w_a w_b)),    sigma^2 = sum_j (s_j |H_j|)^2

of number j with standard deviation s_j, over modes closer than 0.2 % as one space. |H_j| is the largest eigenvalue, which does
not care how modes turn into each other at a veering. A mode alone has |H_j| = |dw/dp_j|, the band of `rotorgear scatter`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from rotorgear.analysis.sensitivity.derivatives import systems_beside
from rotorgear.analysis.sensitivity.forms import (
    Floats,
    FormModes,
    FormNames,
    complex_forms,
    coupling,
    forms_of,
    modes_of,
    with_shapes,
)
from rotorgear.model.model import Model
from rotorgear.model.spreads import spreads_of
from rotorgear.results.campbell import ExcitationOrder
from rotorgear.results.optimise import COUNTS_FROM, NEARLY
from rotorgear.solvers.eigen.eigen import lowest_modes
from rotorgear.system.system import System

# A motion softer than this share of the first elastic frequency is rigid.
_LEAST = 1e-3
# Modes within this many margins of a line may come to count.
_WIDER = 1.2
# Modes closer than this are looked at as one space.
CLOSE = 2e-3
# Half width of the differences, in standard deviations.
_STEP = 1e-3
# Scatter is found of modes within this many margins of a line.
MARGINS = 3.0


@dataclass(frozen=True)
class ModesAtSpeed:
    """Modes at one speed.

    Attributes:
        system: the whole system.
        speed: of the reference shaft in rad/s.
        V: shapes that carry the modes (n, r).
        forms: over them (a, r, r).
        modes: m elastic modes in coordinates of V.
        taken: participation of each line in each mode (l, m).
        line_hz: frequencies of the lines (l,).
        sigma: relative standard deviations of the frequencies (m,), where numbers scatter.
    """

    system: System
    speed: float
    V: Floats
    forms: Floats
    modes: FormModes
    taken: Floats
    line_hz: Floats
    sigma: Floats | None = None

    @property
    def hz(self) -> Floats:
        """Natural frequencies in Hz (m,)."""
        return np.asarray(self.modes.omega / (2.0 * np.pi))

    @property
    def common(self) -> Floats:
        """Participation of each line in the space of each mode (l, m): the sum over modes closer than 0.2 %."""
        shares = self.taken.copy()
        for space in map(list, spaces_of(self.hz)):
            shares[:, space] = self.taken[:, space].sum(axis=1, keepdims=True)
        return shares


def state_of(
    system: System, speed: float, lines: tuple[ExcitationOrder, ...], below_hz: float, margin: float, least: float
) -> ModesAtSpeed:
    """Return all modes of a linear system up to a frequency, and what excites them.

    Modes of K and M carry the rotating ones to some 1e-5 in frequency. Those that may count, near a line with some participation,
    are sharpened: one step of inverse iteration of each joins the shapes, which leaves the square of that.
    """
    strain = system.strain_factor(speed)
    found = lowest_modes(system.mass, system.stiffness(speed), below=2.0 * np.pi * below_hz, strain=strain)
    count = len(found.eigenvalues)
    first = found.eigenvalues[min(found.rigid_count, count - 1)]
    softest = _LEAST * float(np.sqrt(max(first, 1e-12)))
    hz = np.array([line.frequency_hz(speed) for line in lines])
    names = FormNames.of(system.model, speed)

    def over(V: Floats) -> ModesAtSpeed:
        forms = forms_of(system, speed, V)
        modes = modes_of(forms, count, softest, V.shape[1])
        return ModesAtSpeed(system, speed, V, forms, modes, names.participations(lines, forms, modes), hz)

    rough = over(found.vectors)
    if not speed:
        return rough
    near = np.abs(rough.hz[None, :] / hz[:, None] - 1.0) < _WIDER * margin
    counts = np.flatnonzero(np.any(near & (rough.taken >= NEARLY * least), axis=0))
    if not len(counts):
        return rough
    steps = np.column_stack([_step(system, speed, rough, int(k)) for k in counts])
    return over(with_shapes(system.mass, found.vectors, np.hstack([steps.real, steps.imag])))


def _step(system: System, speed: float, state: ModesAtSpeed, k: int) -> NDArray[np.complex128]:
    """Inverse iteration of a mode, Q(w)^-1 (2 w M - i W G) phi, (n,)."""
    from scipy.sparse.linalg import splu

    w = float(state.modes.omega[k])
    phi = state.V @ state.modes.q[:, k]
    W = speed * system.gyroscopic
    Q = sp.csc_array(system.stiffness(speed) + 1j * w * W - w**2 * system.mass)
    answer = np.asarray(splu(Q).solve(2.0 * w * (system.mass @ phi) - 1j * (W @ phi)))
    return answer / np.linalg.norm(answer)


def total_mass(system: System) -> float:
    """Mass of everything that moves with the shafts, in kg: of a unit motion along x."""
    total = 0.0
    nodes = 6 * len(system.nodes)
    for group in system.groups:
        M = group.matrices.mass
        if M is not None:
            along = ((group.dofs < nodes) & (group.dofs % 6 == 0)).astype(float)
            total += float(np.einsum("ed,edf,ef->", along, M, along))
    return total


def spaces_of(hz: Floats) -> list[tuple[int, ...]]:
    """Modes by number, those that are close together."""
    spaces: list[list[int]] = []
    for k, f in enumerate(hz):
        if spaces and f / hz[spaces[-1][-1]] - 1.0 < CLOSE:
            spaces[-1].append(k)
        else:
            spaces.append([k])
    return [tuple(space) for space in spaces]


def with_deviations(state: ModesAtSpeed, model: Model, margin: float, least: float) -> ModesAtSpeed:
    """The state with relative standard deviations of its modes; 0 of those that no line is near to or excites.

    Args:
        state: modes of
        model: whose [scatter] says what scatters.
        margin: that modes keep from lines.
        least: least participation that counts.

    Raises:
        AnalysisError: a number whose scatter moves a place past another one.
    """
    near = np.abs(state.hz[None, :] / state.line_hz[:, None] - 1.0) < MARGINS * margin
    chosen = np.flatnonzero(np.any(near & (state.common >= NEARLY * least), axis=0))
    # A space is looked at as a whole.
    own = [space for space in spaces_of(state.hz) if set(space) & set(chosen.tolist())]
    modes = [k for space in own for k in space]
    sigma = np.zeros(len(state.hz))
    if modes:
        spreads = spreads_of(model, model.scatter)
        variance = np.zeros(len(state.hz))
        shapes = np.asarray(state.V @ state.modes.q[:, modes], dtype=complex)
        X = np.hstack([shapes.real, shapes.imag])
        for step, address in zip(_STEP * np.eye(len(spreads)), spreads.numbers.addresses, strict=True):
            models = (spreads.at(step), spreads.at(-step))
            what = f"[scatter] of {address}"
            above, below = systems_beside(models, state.system, state.speed, what, beside=state.system.state)
            change = (forms_of(above, state.speed, X) - forms_of(below, state.speed, X))[:3] / (2.0 * _STEP)
            H = coupling(complex_forms(change), state.modes.omega[modes])
            H = 0.5 * (H + H.conj().T)
            for space in own:
                at = [modes.index(k) for k in space]
                size = np.abs(np.linalg.eigvalsh(H[np.ix_(at, at)])).max()
                variance[list(space)] += (size / state.modes.omega[list(space)]) ** 2
        sigma = np.sqrt(variance)
    return replace(state, sigma=sigma)


def kept_deviations(states: list[ModesAtSpeed], margin: float, least: float) -> float:
    """By how many standard deviations modes keep a margin, the least of all; infinite where none is near.

    As for the margin itself, modes count from a share of the least participation on.
    """
    found = [np.inf]
    for state in states:
        assert state.sigma is not None
        for F, taken in zip(state.line_hz, state.common, strict=True):
            counts = (taken >= COUNTS_FROM * least) & (state.sigma > 0.0)
            found += list((np.abs(state.hz / F - 1.0)[counts] - margin) / (state.sigma * state.hz / F)[counts])
    return float(min(found))
