"""Shift and invert of a symmetric pair: T = (K - sigma M)^-1 M, sigma < 0, with eigenvalues 1 / (lambda - sigma).

sigma is set from the matrices themselves: below the rounding of K nothing is seen, far above the first elastic
eigenvalue all modes look alike. So a guess is probed, and replaced by -0.1 times the first elastic eigenvalue when off.
Ericsson and Ruhe, Math. Comp. 35 (1980) 1251.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from scipy.linalg.lapack import dsygvd

from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.solvers.eigen.krylov import BlockKrylov
from rotorgear.solvers.sparse.entries import magnitudes, unit_vectors
from rotorgear.solvers.sparse.factor import SymmetricFactor, factor_symmetric
from rotorgear.solvers.sparse.pencil import EPS, rounding_noise

_BLOCK = 4  # as many copies of an eigenvalue are found at once; more columns cost more than they bring
_CONVERGED = 1e-9  # residual of T v = theta v relative to theta; its square is the error of the Rayleigh quotient
# The same for a basis of other modes: the lower ones, this share of all, carry the others; the upper ones only correct them.
_CONVERGED_BASIS = 1e-4
_LOWER = 0.7
_BEGIN = 1.4  # Krylov vectors for each mode of a basis, before its residuals are first looked at; 2 for modes that are counted
_USEFUL = (1e-3, 10.0)  # |sigma| / first elastic eigenvalue: inside, the shift costs neither accuracy nor iterations
_START = 1e-4  # |sigma| at first over the least k_ii / m_ii
_SPREAD = 1e7  # highest eigenvalue / |sigma| up to which rounding in soft modes leaves the stiff ones alone
# Highest eigenvalue / |sigma| from which modes in the middle are rounding to both dense solvers, of 16 digits each: the whole
# space is then handed on, and the Jacobi iteration on strains (ritz.py) tells its modes apart.
_TOO_FAR_FOR_TWO = 1e26
_NEAR = 100.0  # multiple of their rounding below which neighbouring eigenvalues count as equal
Modes = tuple[np.ndarray, np.ndarray]


@dataclass
class ShiftInvert:
    """A factored shift; `krylov` keeps the probe to go on from."""

    M: sp.csc_array
    K: sp.csc_array
    sigma: float
    factor: SymmetricFactor
    elastic: float = 0.0  # the first eigenvalue above rounding as the probe saw it; 0 when there is none

    def __post_init__(self) -> None:
        # Stored by rows, which are the columns of a symmetric matrix: no copy.
        self.mass = sp.csr_array(self.M.T)
        self.stiffness = sp.csr_array(self.K.T)
        self.size_K = magnitudes(self.stiffness)
        self.krylov = BlockKrylov(self.factor.solve, self.K.shape[0], _BLOCK, self.mass.__matmul__)

    def move(self, sigma: float) -> None:
        """Factor at another shift and start the Krylov basis anew."""
        self.sigma = sigma
        self.factor = factor_symmetric(sp.csc_array(self.K - sigma * self.M))
        self.krylov = BlockKrylov(self.factor.solve, self.K.shape[0], _BLOCK, self.mass.__matmul__)

    def apply(self, X: np.ndarray) -> np.ndarray:
        """T X = (K - sigma M)^-1 M X."""
        return self.factor.solve(self.mass @ X)

    def ritz(self, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Lowest eigenvalues (k,), their coordinates in the Krylov basis (m, k), and relative residuals (k,)."""
        theta, Y, residuals = self.krylov.ritz(count)
        return self.sigma + 1.0 / theta, Y, residuals


def shifted_operator(M: sp.csc_array, K: sp.csc_array, guess: float | None = None) -> ShiftInvert:
    """Find a useful sigma < 0 and factor K - sigma M; `guess`, a first elastic eigenvalue, saves work where it is right.

    Raises:
        AnalysisError: K is not positive semidefinite.
        ConvergenceError: K - sigma M is singular for every shift.
    """
    # The least k_ii / m_ii is a Rayleigh quotient: the lowest eigenvalue does not lie above it, mostly some decades below. The
    # probe moves on from a start that is off.
    if guess:
        sigma = -0.1 * guess
    else:
        mass = M.diagonal()
        stiffness = K.diagonal()
        both = (mass > 0.0) & (stiffness > 0.0)
        sigma = -(_START * float(np.min(stiffness[both] / mass[both])) if np.any(both) else 1.0)
    for _ in range(12):
        try:
            factor = factor_symmetric(sp.csc_array(K - sigma * M))
        except ConvergenceError:
            factor = None
        if factor is None or factor.negative_count() > 0:
            sigma *= 1e3  # a free structure: sigma M must rise above the rounding of K
            continue
        operator = ShiftInvert(M, K, sigma, factor)
        operator.elastic = _first_elastic(operator)
        if not operator.elastic or _USEFUL[0] <= -sigma / operator.elastic <= _USEFUL[1]:
            return operator
        sigma = -0.1 * operator.elastic
    raise ConvergenceError("No shift makes K - sigma M positive definite: a motion lacks stiffness and inertia.")


def _first_elastic(operator: ShiftInvert) -> float:
    """The lowest Ritz value above the rounding of K, or 0 when the Krylov space holds rigid modes only."""
    krylov = operator.krylov
    while not krylov.exhausted and krylov.size < 30 * _BLOCK:
        krylov.expand()
        if krylov.size < 2 * _BLOCK and not krylov.exhausted:
            continue
        values, Y, residuals = operator.ritz(krylov.size)
        noise = 1e2 * rounding_noise(operator.size_K, krylov.basis @ Y, operator.sigma)
        noise += residuals * (values - operator.sigma)  # an eigenvalue lies within the residual of each Ritz value
        # Ritz values below the noise are mixtures of rigid modes, with negative values of its size.
        if np.any(values < -10.0 * noise[values <= noise].max(initial=0.0)):
            raise unstable(float(values.min()))
        if np.any(values > noise):
            return float(values[values > noise].min())
    return 0.0


def unstable(eigenvalue: float) -> AnalysisError:
    """What to raise for a negative eigenvalue in (rad/s)^2."""
    return AnalysisError(
        f"The stiffness is not positive semidefinite (lambda = {eigenvalue:.4g} (rad/s)^2): the structure is statically"
        " unstable; check the terms off the diagonal of its 6 x 6 stiffness matrices."
    )


def lanczos_modes(operator: ShiftInvert, converged: int, spare: int) -> np.ndarray:
    """M-orthogonal vectors (n, k) of at least the `converged` lowest eigenpairs and up to `spare` Ritz pairs more."""
    return _ritz_vectors(operator, converged, converged + spare, 2 * (converged + spare), _CONVERGED)


def basis_vectors(operator: ShiftInvert, count: int) -> np.ndarray:
    """M-orthogonal Ritz vectors (n, count) of the lowest eigenpairs, the upper ones less accurate."""
    return _ritz_vectors(operator, int(_LOWER * count) + 1, count, int(_BEGIN * count) + 1, _CONVERGED_BASIS)


def _ritz_vectors(operator: ShiftInvert, converged: int, enough: int, begin: int, tolerance: float) -> np.ndarray:
    """Ritz vectors (n, enough), `converged` of them with residuals below a tolerance, from at least `begin` Krylov vectors."""
    goal = begin
    while True:
        krylov = operator.krylov
        krylov.grow(goal)
        values, Y, residuals = operator.ritz(enough)
        stagnant = krylov.size > 10 * enough + 200  # the Sturm count will tell whether it matters
        if not (krylov.exhausted or stagnant or np.all(residuals[:converged] < tolerance)):
            goal = krylov.size + 1 + krylov.size // 16
            continue
        highest = values[min(converged, values.size) - 1]
        if highest <= _SPREAD * -operator.sigma:
            # One more solve for the modes below |sigma| takes the rounding in stiff modes out of soft ones.
            V = krylov.polished(Y)
            low = values < -operator.sigma
            if np.any(low):
                V[:, low] = operator.apply(V[:, low])
            return V
        # Soft and stiff modes too far apart for one shift: move it up, where the stiff ones are seen.
        operator.move(-1e-4 * highest)
        goal = begin


def symmetric_pair(A: np.ndarray, B: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Ascending eigenvalues (n,) and B-orthonormal vectors (n, n) of A v = lambda B v, by LAPACK's divide and conquer.

    What scipy's `eigh` calls; on its way there it loads numpy.ma, a fiftieth of what a small command costs.

    Raises:
        LinAlgError: B is not positive definite, or an entry is not finite.
    """
    if not (np.all(np.isfinite(A)) and np.all(np.isfinite(B))):
        raise la.LinAlgError("entries are not finite")
    values, V, failed = dsygvd(A, B)
    if failed:
        raise la.LinAlgError("the right matrix is not positive definite")
    return values, V


def dense_modes(operator: ShiftInvert, massless: np.ndarray, wanted: int) -> np.ndarray:
    """A basis (n, k) of all finite modes: `eigh(M, K - sigma M)` for low ones, `eigh(K, M)` for those that it can't resolve."""
    M = operator.M.toarray()
    K = operator.K.toarray()

    # Low modes: M v = mu (K - sigma M) v, sigma moved out until the Cholesky factor of the right side exists.
    sigma = min(operator.sigma, -0.01 * operator.elastic)
    for _ in range(6):
        try:
            mu, V = symmetric_pair(M, K - sigma * M)
            break
        except la.LinAlgError:
            sigma *= 30.0
    else:
        raise ConvergenceError("K - sigma M is positive definite for no shift; merge very short elements.")
    mu = mu[::-1]
    V = V[:, ::-1]
    finite = np.arange(mu.size) < np.count_nonzero(mu > mu.size * EPS * mu[0])
    values = sigma + 1.0 / mu[finite]
    V = V[:, finite] / np.sqrt(mu[finite])
    # Every mu errs by eps of the largest: those above 1e-6 of it keep ten digits.
    if wanted <= int(np.count_nonzero(mu[finite] > 1e-6 * mu[0])):
        return V

    # High modes: K v = lambda M v after exact condensation of the massless dofs. Where M stays singular there is nothing better.
    massive = np.delete(np.arange(K.shape[0]), massless)
    follow = unit_vectors(K.shape[0], massive)
    if massless.size:
        follow[massless] = -la.solve(K[np.ix_(massless, massless)], K[np.ix_(massless, massive)], assume_a="pos")
    try:
        high, condensed = symmetric_pair(K[massive] @ follow, M[np.ix_(massive, massive)])
    except la.LinAlgError:
        return V

    if high[-1] > _TOO_FAR_FOR_TWO * -sigma:
        return follow
    # Each solver errs by eps times its largest eigenvalue: they are equally good at the geometric mean. Modes that lie as near to
    # each other there as these errors are mixed in another way by each, and come all from one.
    far = np.sqrt(max(high[-1] / -sigma, 0.0))
    split = int(np.count_nonzero(values < far * -sigma))
    near = _NEAR * (rounding_noise(operator.size_K, V, sigma) + EPS * far * (values - sigma))
    while 0 < split < values.size and values[split] - values[split - 1] <= near[split - 1 : split + 1].max():
        split -= 1
    return np.hstack([V[:, :split], (follow @ condensed)[:, split:]])
