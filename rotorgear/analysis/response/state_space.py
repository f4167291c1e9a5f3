"""A gearbox as a linear system between inputs and outputs, for control and system simulation: whole, or reduced to modes.

Reduced coordinates are those of the undamped modes of the conservative part up to a multiple of the highest frequency, and of
static shapes (K + s^2 M)^-1 [B C^T] under unit forces at inputs and outputs, which represent the modes above (residual
flexibility, R. R. Craig and A. J. Kurdila, Fundamentals of Structural Dynamics, 2nd ed., Wiley 2006, ch. 17); the shift s lets
trains turn freely. Where gyroscopic moments and damping need more, whole displacements at single frequencies join them. Motions
that no matrix joins with an input or an output take part in no response, and have no coordinates.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from rotorgear.analysis.common.discretise import pieces
from rotorgear.analysis.common.left_out import GIVE_DAMPING, left_out
from rotorgear.analysis.common.points import moving_rows
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import check_modal_damping, check_request, missed, speed_in_si
from rotorgear.analysis.response.frequency_response import checked_places, receptance_error
from rotorgear.analysis.response.mesh import aims, damped_modes, damped_plant, meshed
from rotorgear.analysis.response.outputs import Outputs, output_rows
from rotorgear.analysis.response.plant import Plant
from rotorgear.analysis.static.mean_state import about_mean
from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.model.model import Model
from rotorgear.note import Note
from rotorgear.progress import Progress, silent
from rotorgear.results.laws import about_state, law_rows
from rotorgear.results.state_space import StateSpace
from rotorgear.solvers.frequency.harmonic import Dynamics
from rotorgear.solvers.sparse.factor import factor_general, single_thread
from rotorgear.system.bubble_errors import ForcedChanges
from rotorgear.system.components import dof_motions, independent_groups
from rotorgear.system.damped_range import damped_up_to, undamped_above
from rotorgear.system.system import System

# Modes are kept up to this multiple of the highest frequency; the static shapes represent the rest.
_KEPT = 1.5
ACCURACY = 1e-4
_UNDAMPED = Note(
    "",
    "nothing damps the model",
    f"responses are infinite at its natural frequencies; {GIVE_DAMPING}, or --modal-damping",
)
# The shift of the static shapes over the highest frequency: above zero, where a free train has none.
_SHIFT = 0.5
# Dense matrices of the whole system: beyond this they would not fit into what opens them.
_LARGEST = 3000
# Where a reduction is judged: between modes, and about each peak at its half-power points.
_BETWEEN = 61
# Poles below this share of the highest frequency are rigid motions, where no response is finite.
_LOWEST = 1e-5
# Damping ratio below which a mode counts as undamped.
_NO_WIDTH = 1e-9
# A response below this share of what the displacements there could add up to is none.
_FORBIDDEN = 1e-9
# Static shapes that are no more than this share of what the basis already holds add nothing.
_NEW = 1e-9


@recorded
def state_space(
    model: Model,
    *,
    inputs: Sequence[str],
    outputs: Sequence[str],
    fmax: float,
    speed: float | str | None = None,
    modal_damping: float = 0.0,
    elements: int | None = None,
    accuracy: float | None = None,
    full: bool = False,
    progress: Progress = silent,
) -> StateSpace:
    """Return the linear system between places, M x'' + D x' + K x = B u, with the model's damping at a speed.

    Outputs are y = C x, and y = C x + C_v x' + C_a x'' of those that read a load.

    Args:
        model: any model; contacts are closed, on the flanks that its loads choose.
        inputs: as in `frf`.
        outputs: places where displacements are read, named as the inputs are, and points that read a load.
        fmax: highest frequency in Hz that the system is meant for; the mesh is refined for it as that of `frf`.
        speed: as in `frf`.
        modal_damping: as in `frf`.
        elements: number of basic elements in each shaft segment (default: refined for modes up to the highest frequency).
        accuracy: reduce no further than to this share of the largest size of each response (default: 1e-4), and refine the mesh
            until each response is estimated to be within it (default: modes up to the highest frequency are refined to 1e-3).
        full: all degrees of freedom in place of modes and static shapes.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: a place that the model has not, or a full system of more than 3000 degrees of freedom.
        ConvergenceError: the reduced system is singular, as at a mode without damping.
    """
    turns = speed_in_si(speed) or 0.0
    check_request(fmax=fmax, elements=elements)
    check_request(accuracy=accuracy)
    check_modal_damping(modal_damping)
    places = checked_places(model, inputs, outputs)
    zeta = modal_damping + model.damping.modal_ratio
    progress(0.02, "discretisation")
    about = about_mean(model, [turns or None], turns)
    limit = 2.0 * np.pi * fmax
    for aim in aims(accuracy):
        progress(0.05, "discretisation")
        system = meshed(model, about, turns, fmax, elements, aim)
        if full and system.n > _LARGEST:
            raise AnalysisError(
                f"a full state space of {system.n} degrees of freedom is dense in {2 * system.n} states; leave 'full' out for a "
                "reduced one, or write sparse matrices"
            )
        B = moving_rows(system, inputs).T
        groups = _groups(system, turns)
        damping = damped_up_to(system, limit), zeta
        # Damping of modes reads in loads, too, but adds no displacement to those that a place reads.
        touched = output_rows(Plant(system), outputs, turns).touched.T
        reached = np.arange(system.n) if full else _reached(system, groups, np.hstack([B, touched]))
        plant = damped_plant(system, turns, *damping, reached)
        C = output_rows(plant, outputs, turns)
        ends = np.hstack([B, C.q.T])
        dynamics = plant.dynamics(turns).cut(reached)
        damped = bool(zeta) or bool(system.damping(turns).nnz)
        progress(0.4, "matrices")
        with single_thread(system.n):
            kept_modes, kept = damped_modes(system, _KEPT * limit, turns, reached)
            basis = kept_modes[reached]
            if not full:
                # Static shapes under forces at inputs and outputs, beside the modes. Peaks alone show without them.
                symmetric = sp.csc_array(0.5 * (dynamics.K + dynamics.K.T))
                factor = factor_general(sp.csc_array(symmetric + (_SHIFT * limit) ** 2 * dynamics.M, dtype=complex))
                basis = _joined(basis, np.real(factor.solve(ends[reached].astype(complex))), dynamics.M)
            progress(0.6, "error of the reduction")
            cut = B[reached], C.cut(reached)
            made = _Matrices.of(dynamics, *cut, basis)
            learnt, held_out = (_Seen.at(dynamics, B[reached], w) for w in _judging(made, limit, damped))
            if full:
                made, error = _Matrices.of(dynamics, *cut), 0.0
            else:
                made, error = _reduced(dynamics, *cut, basis, (learnt, held_out), accuracy or ACCURACY)
            progress(0.9, "error of the mesh")
            seen, first = np.unique([*learnt.w, *held_out.w], return_index=True)
            q = np.zeros((len(seen), system.n, len(inputs)), dtype=complex)
            q[:, reached] = np.concatenate([learnt.q, held_out.q])[first]
            bubbles = ForcedChanges.of(system)
            at = zip(np.repeat(seen[:, None], len(inputs), axis=1), q, strict=True)
            lacking = np.array([bubbles.change(turns, w, q_w, turning=False) for w, q_w in at])
        hz = seen / (2.0 * np.pi)
        estimate = receptance_error(system, turns, hz, C.of(seen, q), lacking, (inputs, outputs), damping)
        if accuracy is None or elements is not None or estimate <= accuracy:
            break
    progress(1.0, "done")
    unmoved = tuple(
        Note("", f"no input moves {text}", "its responses are 0")
        for text, row in zip(outputs, touched.T, strict=True)
        if not np.intersect1d(groups[row], groups[np.any(B, axis=1)]).size
    )
    missing = (
        missed(accuracy or ACCURACY, error, "write the full system, or ask for less"),
        missed(accuracy, estimate, "ask for less, or give more damping to resonances in the range"),
    )
    short = next(filter(None, missing), None)
    return StateSpace(
        model=model,
        speed=turns,
        fmax=fmax,
        **places,
        mass_matrix=made.M,
        velocity_terms=made.D,
        stiffness_matrix=made.K,
        input_matrix=made.B,
        output_matrix=made.C.q,
        velocity_output=made.C.v,
        acceleration_output=made.C.a,
        reduced=not full,
        kept_modes=0 if full else len(kept),
        reduction_error=error,
        error_estimate=estimate,
        dofs=system.n,
        discretisation=pieces(system),
        laws=law_rows(system.state.operating),
        left_out=(
            *about[1].notes,
            *left_out(system, "frf", turns, modal_damping=modal_damping),
            *undamped_above(*damping),
            *_apart(system, reached),
        ),
        warnings=(*(() if damped else (_UNDAMPED,)), *unmoved, *((short,) if short else ())),
        status=short or "success",
        method=("all degrees of freedom" if full else "modes and static shapes") + about_state(system.state),
    )


def _groups(system: System, turns: float) -> np.ndarray:
    """The number of the group of each dof (n,); groups do not act on each other at a speed in rad/s."""
    matrices = [system.mass, system.stiffness(turns), system.circulatory(turns), system.damping(turns)]
    if turns:
        matrices.append(system.gyroscopic)
    number = np.zeros(system.n, dtype=int)
    for k, group in enumerate(independent_groups(matrices)):
        number[group] = k
    return number


def _reached(system: System, groups: np.ndarray, places: np.ndarray) -> np.ndarray:
    """The dofs (r,) of the groups in which one of the places (n, p) is, ascending.

    Raises:
        AnalysisError: nothing has inertia there, so that there are no modes to reduce to.
    """
    reached = np.flatnonzero(np.isin(groups, groups[np.any(places, axis=1)]))
    if not np.any(system.mass.diagonal()[reached] > 0.0):
        raise AnalysisError(
            "nothing that has inertia moves with these inputs and outputs; give the body there its inertia, or write the full "
            "system"
        )
    return reached


def _apart(system: System, reached: np.ndarray) -> tuple[Note, ...]:
    """What is left out because no input moves it and no output sees it."""
    rest = np.setdiff1d(np.arange(system.n), reached)
    if not rest.size:
        return ()
    motions = ", ".join(dict.fromkeys(dof_motions(system)[rest]))
    how_many = f"{len(rest)} of {system.n} degrees of freedom ({motions})"
    return (Note("", "motions that no input moves and no output sees", how_many),)


@dataclass(frozen=True)
class _Matrices:
    """Dense M, D, K (s, s), B (s, i) and rows C (o, s)."""

    M: np.ndarray
    D: np.ndarray
    K: np.ndarray
    B: np.ndarray
    C: Outputs

    @classmethod
    def of(cls, dynamics: Dynamics, B: np.ndarray, C: Outputs, V: np.ndarray | None = None) -> _Matrices:
        """All degrees of freedom, or the coordinates of a basis V (n, s): V^T M V and so on."""
        parts = (dynamics.M, dynamics.D, dynamics.K)
        M, D, K = (A.toarray() if V is None else V.T @ (A @ V) for A in parts)
        if dynamics.low_rank is not None:
            P, d, _ = dynamics.low_rank
            P = P if V is None else V.T @ P
            D = D + (P * d) @ P.T
        return cls(M, D, K, B, C) if V is None else cls(0.5 * (M + M.T), D, K, V.T @ B, C.within(V))

    def receptance(self, w: float) -> np.ndarray:
        """C Z^-1 B at a frequency in rad/s, (o, i)."""
        Z = self.K + 1j * w * self.D - w**2 * self.M
        try:
            return np.asarray(self.C.of(np.array([w]), np.linalg.solve(Z, self.B.astype(complex))[None])[0])
        except np.linalg.LinAlgError:
            raise ConvergenceError(
                f"the reduced system is singular at {w / 2.0 / np.pi:.6g} Hz, as at a mode without damping: look at the modes "
                "there, or take the full system"
            ) from None


def _joined(basis: np.ndarray, shapes: np.ndarray, M: sp.csc_array) -> np.ndarray:
    """A basis that is orthonormal in M, and shapes made so beside it; what it holds already is left out."""
    columns = list(basis.T)
    for shape in shapes.T:
        before = np.sqrt(max(float(shape @ (M @ shape)), 0.0))
        if not before:
            continue
        new = shape / before
        for _ in range(2):  # once more, for what rounding left
            for column in columns:
                new = new - column * float(column @ (M @ new))
        left = np.sqrt(max(float(new @ (M @ new)), 0.0))
        if left > _NEW:
            columns.append(new / left)
    return np.array(columns).T


def _differences(made: _Matrices, C: Outputs, w: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Largest difference of reduced and whole responses (f,) at w (f,) in rad/s, over the largest size of each response.

    The whole displacements there are q (f, n, i).
    """
    whole = C.of(w, q)
    reduced = np.array([made.receptance(float(value)) for value in w])
    # A response that symmetry forbids is rounding of what moves there.
    forbidden = _FORBIDDEN * np.max(abs(C.q) @ np.abs(q), axis=0)
    size = np.maximum(np.abs(whole).max(axis=0), forbidden)
    relative = np.abs(whole - reduced) / np.where(size > 0.0, size, 1.0)
    return np.asarray(relative.reshape(len(w), -1).max(axis=1))


@dataclass(frozen=True)
class _Seen:
    """Displacements q (f, n, i) of the whole system at frequencies w (f,) in rad/s."""

    w: np.ndarray
    q: np.ndarray

    @classmethod
    def at(cls, dynamics: Dynamics, B: np.ndarray, w: np.ndarray) -> _Seen:
        """Those under forces B (n, i)."""
        return cls(w, np.array([dynamics.solve(float(value), B) for value in w]))


def _judging(made: _Matrices, limit: float, damped: bool) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies in rad/s that a basis may learn from, and those where it is judged: between them, and about each peak."""
    even = limit * np.arange(1, _BETWEEN + 1) / _BETWEEN
    # Golden parts of the steps: no even grid, and half-way between the others.
    judged = limit * (np.arange(_BETWEEN) + 0.381966) / _BETWEEN
    peaks = _peaks(made, limit) if damped and len(made.M) else np.zeros((0, 2))
    flanks = np.array([w + k * half for w, half in peaks for k in (-1.5, -0.7, 0.3, 0.7, 1.5)])
    flanks = flanks[(flanks > _LOWEST * limit) & (flanks <= limit)]
    return np.unique([*even, *peaks[:, 0]]), np.unique([*judged, *flanks])


def _reduced(
    dynamics: Dynamics, B: np.ndarray, C: Outputs, basis: np.ndarray, seen: tuple[_Seen, _Seen], accuracy: float
) -> tuple[_Matrices, float]:
    """The reduced matrices, and twice the largest difference that was found where the basis was not made.

    As long as the worst of some frequencies is above the accuracy, the whole displacement there joins the basis (greedy reduced
    basis: J. S. Hesthaven, G. Rozza, B. Stamm, Certified Reduced Basis Methods, Springer 2016, ch. 3). Judged is between these
    frequencies, and on the tops and flanks of the peaks of the reduced system.
    """
    made = _Matrices.of(dynamics, B, C, basis)
    learnt, held_out = seen
    while True:
        error = 2.0 * float(_differences(made, C, held_out.w, held_out.q).max())
        worst = _differences(made, C, learnt.w, learnt.q)
        if error <= accuracy or not worst.max() > 0.1 * accuracy:
            return made, error
        shapes = learnt.q[int(np.argmax(worst))]
        larger = _joined(basis, np.hstack([shapes.real, shapes.imag]), dynamics.M)
        if larger.shape[1] == basis.shape[1]:
            return made, error
        basis = larger
        made = _Matrices.of(dynamics, B, C, basis)


def _peaks(made: _Matrices, limit: float) -> np.ndarray:
    """Damped natural frequencies up to a limit and their half-power half-widths in rad/s, (p, 2).

    A mode without damping has no width, and at its pole nothing can be solved: it is left out.
    """
    n = made.M.shape[0]
    state = np.block(
        [[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(made.M, made.K), -np.linalg.solve(made.M, made.D)]]
    )
    poles = la.eigvals(state)
    near = poles[(poles.imag > _LOWEST * limit) & (poles.imag <= limit) & (np.abs(poles.real) > _NO_WIDTH * poles.imag)]
    return np.stack([near.imag, np.abs(near.real)], axis=1)
