"""A model with other numbers, and its modes at every operating speed: one solution of the whole system each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from rotorgear.analysis.scatter.basis import with_shapes
from rotorgear.analysis.scatter.forms import FormNames, forms_of
from rotorgear.analysis.scatter.modes import FormModes, modes_of
from rotorgear.analysis.scatter.samples import participations, spin_signs
from rotorgear.results.campbell import ExcitationOrder
from rotorgear.solvers.eigen.eigen import lowest_modes
from rotorgear.system.system import System

# A motion softer than this share of the first elastic frequency is rigid.
_LEAST = 1e-3
# Modes so many margins from a line, and with this share of the least participation, may come to count.
_WIDER = 1.2
_SOME = 0.5


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
    V: NDArray[np.float64]
    forms: NDArray[np.float64]
    modes: FormModes
    taken: NDArray[np.float64]
    line_hz: NDArray[np.float64]
    sigma: NDArray[np.float64] | None = None

    @property
    def hz(self) -> NDArray[np.float64]:
        """Natural frequencies in Hz (m,)."""
        return np.asarray(self.modes.omega / (2.0 * np.pi))


def state_of(
    system: System,
    speed: float,
    lines: tuple[ExcitationOrder, ...],
    below_hz: float,
    *,
    margin: float,
    least: float,
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
    names = FormNames.of(system.model)
    senses = spin_signs(system.model, speed)

    def over(V: NDArray[np.float64]) -> ModesAtSpeed:
        forms = forms_of(system, speed, V)
        modes = modes_of(forms, count, softest, V.shape[1])
        return ModesAtSpeed(system, speed, V, forms, modes, participations(names, lines, forms, modes, senses), hz)

    rough = over(found.vectors)
    if not speed:
        return rough
    near = np.abs(rough.hz[None, :] / hz[:, None] - 1.0) < _WIDER * margin
    counts = np.flatnonzero(np.any(near & (rough.taken >= _SOME * least), axis=0))
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
