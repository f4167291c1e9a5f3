"""Damped and gyroscopic modes of one group of dofs, in modal coordinates where the assembled stiffness is too coarse for them.

A mode so soft that K q is mostly rounding (a bearing of 1 N/m on a shaft of 1e10 N/m) is lost to any solver that is given K.
The undamped modes X are not, thanks to their strains. In q = X u the problem is (s^2 I + s X^T (C + W G) X + L) u = 0, with
L = omega^2 to full precision, and C and the circulatory terms taken through strains. A large group takes the lowest undamped
modes and a first round of damped ones as its basis; a small one takes all modes, which is no approximation.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from rotorgear.analysis.modal.problem import Problem
from rotorgear.errors import ConvergenceError
from rotorgear.solvers.eigen.damped import DampedModes, damped_modes, with_largest_one
from rotorgear.solvers.eigen.eigen import UndampedModes
from rotorgear.solvers.eigen.gyroscopic import gyroscopic_modes
from rotorgear.solvers.eigen.local_damping import locally_damped_modes
from rotorgear.solvers.eigen.quadratic import corrected, newton, scaled
from rotorgear.solvers.eigen.ritz import strain_ritz
from rotorgear.solvers.eigen.undamped_basis import NearUndamped
from rotorgear.solvers.sparse.entries import column_forms, magnitudes, unit_vectors
from rotorgear.solvers.sparse.pencil import count_below, rounding_noise
from rotorgear.system.assembly import StrainForms

# Rounding of K relative to omega^2 (a bound, rarely met) up to which the assembled matrices do.
_CLEAN = 1e-10
# The same for a large group, whose modal coordinates cost more: strains then correct the eigenvalues.
_CLEAN_LARGE = 1e-8
# Rounding above which a first round takes a mode as a rigid-body motion.
_AS_RIGID = 1e-6
# Dofs up to which all undamped modes are cheap: the basis is then complete, and no approximation.
_ALL_UP_TO = 120
# Undamped modes for the basis of gyroscopic ones: a multiple of those asked for, and some more; up to a share of the dofs.
_REACH = 1.35
_MORE = 8
_MOST_OF = 0.4
# Shift over the first frequency within which the factor of the undamped modes serves for corrections as well.
_LEAST_SHIFT = 0.03
_MOST_SHIFT = 0.5
# Residual in the dofs above which a mode that the matrices do resolve is refined on them.
_POLISH = 1e-14
# A refinement that moves s by more than this share of it has gone to another mode.
_NEAR = 1e-6
# A strain, or a gyroscopic term, of a rigid-body motion this much smaller than its parts is none.
_ZERO = 1e-9


def damped_group(problem: Problem, count: int | None, below: float | None) -> tuple[DampedModes, str]:
    """Return the damped modes of lowest |s|, and a word on the coordinates they were found in."""
    if problem.rigid is not None and (problem.rigid.shape[1] or problem.strain is None):
        # On a fast carrier the symmetric stiffness of planets alone is no spring, and gyroscopic terms hold them.
        R = problem.rigid
        more = None if count is None else count + R.shape[1]
        # Spin and damping hardly change how many modes there are.
        expected = None if below is None or count is not None else _count_below(problem, below)
        M, D, K = problem.M, problem.D, problem.K
        found = damped_modes(M, D, K, count=more, below=below, rigid_vectors=R, expected=expected)
        found = by_strains(problem, found)
        return (_without_drift(found, count) if R.shape[1] else found), ""
    near = _near_undamped(problem, count, below)
    if near is not None:
        return near, ""
    undamped = _undamped(problem, None, None)  # the softest modes suffer most
    rigid = undamped.rigid
    noise = relative_noise(problem, undamped.frequencies, undamped.elastic)
    small = problem.K.shape[0] <= _ALL_UP_TO
    worst = max(noise.max(initial=0.0), _drift_noise(problem, rigid))
    if problem.strain is None or worst <= (_CLEAN if small else _CLEAN_LARGE):
        return by_strains(problem, _by_matrices(problem, count, below, undamped)), ""
    if small:
        basis = problem.lowest(None, None).elastic
    else:
        # Elastic undamped modes and the damped ones of a first round, which takes the softest modes as rigid.
        undamped = _undamped(problem, count, below)
        noise = relative_noise(problem, undamped.frequencies, undamped.elastic)
        lost = int(np.count_nonzero(noise > _AS_RIGID))
        found = _by_matrices(problem, None if count is None else count + lost, below, undamped, lost)
        V = found.vectors[:, ~found.rigid]
        basis = np.hstack([undamped.elastic, V.real, V.imag])
    return _in_coordinates(problem, rigid, basis, count, below), " in modal coordinates"


def _count_below(problem: Problem, below: float) -> int | None:
    """How many modes the symmetric part of the stiffness has up to a frequency in rad/s; None where that is not clear."""
    try:
        return count_below(problem.M, problem.K_symmetric, below**2)
    except ConvergenceError:
        return None


# Share of the frequencies below which a motion is the drift of a train with planets.
_DRIFT = 1e-5


def _without_drift(modes: DampedModes, count: int | None) -> DampedModes:
    """The modes without the second zero of each free rotation of a train with planets.

    Pins give d under the centrifugal load, and dampers beside them see d where the rotation drifts, by (d/r)^2 of their work:
    what is exactly zero becomes a number far below all frequencies.
    """
    size = np.abs(modes.eigenvalues)
    oscillating = size[modes.eigenvalues.imag > 0.0]
    kept = modes.rigid | (size > _DRIFT * np.median(oscillating if oscillating.size else size))
    kept &= np.cumsum(kept) <= (len(kept) if count is None else count)
    return replace(
        modes,
        eigenvalues=modes.eigenvalues[kept],
        vectors=modes.vectors[:, kept],
        rigid=modes.rigid[kept],
        backward_error=modes.backward_error[kept],
    )


def _by_matrices(
    problem: Problem, count: int | None, below: float | None, undamped: UndampedModes, soft: int = 0
) -> DampedModes:
    """The damped modes of the assembled matrices, with some undamped ones known; the softest elastic ones count as rigid."""
    frequencies = undamped.frequencies[soft:]
    scale = float(frequencies[0]) if len(frequencies) else None
    R = undamped.vectors[:, : undamped.rigid_count + soft]
    return damped_modes(
        problem.M, problem.D, problem.K, count=count, below=below, rigid_vectors=R, frequency_scale=scale
    )


def _near_undamped(problem: Problem, count: int | None, below: float | None) -> DampedModes | None:
    """The modes from the undamped ones where the stiffness is symmetric and the assembled matrices are clean; else None."""
    S = problem.strain
    if S is None or problem.K.shape[0] <= _ALL_UP_TO or (count is None and below is None):
        return None
    # Gyroscopic moments bring modes down from above those that are asked for.
    spare = None if count is None else int(_REACH * count) + _MORE
    too_many = spare is not None and spare > _MOST_OF * problem.K.shape[0]
    if too_many or (problem.K is not problem.K_symmetric and (problem.K - problem.K_symmetric).nnz):
        return None
    undamped = problem.lowest(spare, None if below is None else _REACH * below, counted=False)
    frequencies = undamped.frequencies
    if undamped.complete or not len(frequencies):
        return None
    noise = undamped.noise[undamped.rigid_count :] / frequencies**2
    noise = noise + damping_noise(problem, frequencies, undamped.elastic)
    if noise.max() > _CLEAN_LARGE:
        return None
    shift = np.sqrt(-undamped.shift)
    is_low = _LEAST_SHIFT * frequencies[0] <= shift <= _MOST_SHIFT * frequencies[0]
    near = NearUndamped(
        M=problem.M,
        D=problem.D,
        K=problem.K,
        strain=lambda V: np.asarray(S @ V),
        frequencies=frequencies,
        modes=undamped.elastic,
        rigid=undamped.rigid,
        factored=(shift, undamped.factor) if undamped.factor is not None and is_low else None,
    )
    if near.halves[0].nnz:
        return locally_damped_modes(near, count, below)
    found = gyroscopic_modes(near, count, below)
    return None if found is None else by_strains(problem, found)


def _drift_noise(problem: Problem, rigid: np.ndarray) -> float:
    """The same for the motions that a damper or a spin gives to bodies which no spring holds: s of R^T D R, of lowest |s|."""
    if not rigid.shape[1]:
        return 0.0
    strained = _without_rounding(problem.forms, rigid, rigid.shape[1])
    drag = _inertial(problem.inertial, rigid, rigid.shape[1]) + strained.T @ (problem.forms.viscosity @ strained)
    size = np.abs(np.linalg.eigvals(drag))
    moving = size > 1e-14 * size.max(initial=0.0)
    if not moving.any():
        return 0.0
    return float(relative_noise(problem, np.full(rigid.shape[1], size[moving].min()), rigid).max())


def _undamped(problem: Problem, count: int | None, below: float | None) -> UndampedModes:
    """The rigid modes and enough elastic ones to see which of those asked for suffer from rounding: at least one."""
    if count is None and below is not None:
        found = problem.lowest(None, below)
        if len(found.frequencies):
            return found
    number = max(6, count or 0)  # a shaft free along and about its axis, twice over
    while True:
        found = problem.lowest(number, None)
        if len(found.frequencies) or found.complete:
            return found
        number = 4 * number + 3


def _in_coordinates(
    problem: Problem, rigid: np.ndarray, basis: np.ndarray, count: int | None, below: float | None
) -> DampedModes:
    """The damped modes in the coordinates u of q = [R X N] u: rigid-body motions R, elastic modes X, massless dofs N."""
    assert problem.strain is not None
    S = problem.strain
    M = problem.M
    r = rigid.shape[1]
    independent = _independent(M, rigid, basis)
    squares, turn = strain_ritz(S, independent)
    X = independent @ turn
    # A dof without inertia follows the others at once; no undamped mode holds that, so it is a coordinate of its own.
    massless = np.flatnonzero(M.diagonal() <= 0.0)
    N = unit_vectors(M.shape[0], massless)
    whole = np.hstack([_by_damping(problem.forms, rigid), X, N])
    massive = r + len(squares)
    none = np.zeros(massless.size)
    inertia = np.concatenate([np.ones(massive), none])
    stiffness = np.diag(np.concatenate([np.zeros(r), squares, none]))
    if massless.size:
        block = (S @ whole[:, r:]).T @ (S @ N)
        stiffness[r:, massive:] = block
        stiffness[massive:, r:] = block.T
    strained = _without_rounding(problem.forms, whole, r)
    D = strained.T @ (problem.forms.viscosity @ strained) + _inertial(problem.inertial, whole, r)
    K = stiffness + strained.T @ (problem.forms.circulation @ strained)
    lowest = float(np.sqrt(squares[0])) if len(squares) else None
    matrices = (sp.csc_array(A) for A in (np.diag(inertia), D, K))
    R = np.eye(len(inertia))[:, :r]
    reduced = damped_modes(*matrices, count=count, below=below, rigid_vectors=R, frequency_scale=lowest, dense=True)
    return _restored(problem, whole, reduced, lowest or 1.0)


def _independent(M: sp.csc_array, rigid: np.ndarray, basis: np.ndarray) -> np.ndarray:
    """Columns (n, k) that span the basis beside the rigid-body motions, M-orthonormal, without directions that are there already.

    One column after the other: a soft mode that was turned among stiff ones would lose the accuracy of its small strains.
    """
    mass = sp.csr_array(M)
    first = rigid.shape[1]
    kept = np.zeros((M.shape[0], first + basis.shape[1]), order="F")
    kept[:, :first] = rigid
    k = first
    for x in basis.T:
        size = np.sqrt(max(x @ (mass @ x), 0.0))
        for _ in range(3):
            if size == 0.0:
                break
            x = x / size
            x = x - kept[:, :k] @ (kept[:, :k].T @ (mass @ x))
            size = np.sqrt(max(x @ (mass @ x), 0.0))
            size = size if size > _ZERO else 0.0
        if size > 0.0:
            kept[:, k] = x / size
            k += 1
    return kept[:, first:k]


def _by_damping(forms: StrainForms, rigid: np.ndarray) -> np.ndarray:
    """The rigid-body motions turned so that those which hardly move a strong damper stand apart from those which do."""
    V = sp.coo_array(forms.viscosity)
    if not rigid.shape[1] or not V.nnz or np.any(V.row != V.col):
        return rigid
    drag = np.sqrt(np.maximum(forms.viscosity.diagonal(), 0.0))[:, None]
    strained = drag * _without_rounding(forms, rigid, rigid.shape[1])
    return rigid @ strain_ritz(lambda _: strained, rigid)[1] if strained.any() else rigid


def _without_rounding(forms: StrainForms, whole: np.ndarray, rigid: int) -> np.ndarray:
    """Strains of the basis; what rounding leaves in the first `rigid` columns is zero.

    A rigid-body motion alone has no strain that meets a stiffness. Of other strains, those of dampers or of full 6 x 6 matrices,
    the ones far below their parts are taken for rounding.
    """
    strained = forms.strain @ whole
    size = abs(forms.strain) @ np.abs(whole[:, :rigid])
    alone = (np.diff(forms.modulus.indptr) == 1) & (forms.modulus.diagonal() > 0.0)
    far_below = np.where(forms.modulus.diagonal() > 0.0, 1e3 * _ZERO, _ZERO)
    real = (np.abs(strained[:, :rigid]) > far_below[:, None] * size) & ~alone[:, None]
    strained[:, :rigid] = np.where(real, strained[:, :rigid], 0.0)
    return np.asarray(strained)


def _inertial(A: sp.csc_array, whole: np.ndarray, rigid: int) -> np.ndarray:
    """The part alpha M + spin G in the basis; what rounding leaves among the first `rigid` columns is zero."""
    product = whole.T @ (A @ whole)
    R = whole[:, :rigid]
    size = np.abs(R).T @ (abs(A) @ np.abs(R))
    product[:rigid, :rigid] = np.where(np.abs(product[:rigid, :rigid]) > _ZERO * size, product[:rigid, :rigid], 0.0)
    return np.asarray(product)


def _restored(problem: Problem, whole: np.ndarray, found: DampedModes, scale: float) -> DampedModes:
    """The modes in the coordinates of the dofs, with the residuals that they leave there."""
    V = with_largest_one(whole @ found.vectors)
    values = found.eigenvalues.copy()
    quadratic = scaled(problem.M, problem.D, problem.K, scale)
    size = np.sqrt(np.maximum(np.real(column_forms(problem.M, V)), 1e-300))
    clean = ~found.rigid & (relative_noise(problem, np.abs(values), V / size) <= _CLEAN)
    errors = quadratic.residuals(values / quadratic.w0, V / quadratic.scale[:, None])
    for k in np.flatnonzero(clean & (errors > _POLISH)):
        z, v = newton(quadratic, values[k] / quadratic.w0, V[:, k] / quadratic.scale)
        if abs(z * quadratic.w0 - values[k]) <= _NEAR * abs(values[k]):
            up = z.imag >= 0.0  # of a pair next to the real axis the other one may be found
            values[k] = (z if up else np.conj(z)) * quadratic.w0
            V[:, k] = (v if up else np.conj(v)) * quadratic.scale
    V = with_largest_one(V)
    errors = quadratic.residuals(values / quadratic.w0, V / quadratic.scale[:, None])
    complete = found.complete and whole.shape[1] == problem.K.shape[0]
    return replace(found, eigenvalues=values, vectors=V, backward_error=errors, complete=complete)


def by_strains(problem: Problem, found: DampedModes) -> DampedModes:
    """The modes with eigenvalues from strain energies, which do not carry the rounding of the assembled stiffness."""
    V = found.vectors
    forms = problem.forms
    S = forms.strain @ V
    mass = column_forms(problem.M, V)
    damping = column_forms(problem.inertial, V) + column_forms(forms.viscosity, S)
    stiffness = column_forms(forms.modulus, S) + column_forms(forms.circulation, S)
    noise = relative_noise(problem, np.abs(found.eigenvalues), V / np.sqrt(np.real(mass)))
    trust = np.where(found.rigid, 0.0, noise)
    return replace(found, eigenvalues=corrected(found.eigenvalues, trust, (mass, damping, stiffness)))


def relative_noise(problem: Problem, size: np.ndarray, V: np.ndarray) -> np.ndarray:
    """Rounding that K q and s C q carry, relative to |s|^2 q^H M q, for |s| = size (m,) and M-normal V (n, m)."""
    K = magnitudes(problem.K_symmetric)
    size = np.maximum(size, 1e-150)  # its square is still a number
    return np.asarray(rounding_noise(K, V) / size**2 + damping_noise(problem, size, V))


def damping_noise(problem: Problem, size: np.ndarray, V: np.ndarray) -> np.ndarray:
    """Rounding that s C q alone carries, (m,)."""
    C = sp.csc_array(problem.D - problem.inertial)
    return rounding_noise(magnitudes(C), V) / size if C.nnz else np.zeros(V.shape[1])
