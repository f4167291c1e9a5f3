"""Speeds at which a mode has p times the speed as its frequency: an eigenproblem in the speed itself.

Between two speeds a and b the matrices are affine, D = D_0 + W D_1 and K = K_0 + W K_1. With lambda = p s and W = -i s

    [ K_0 + s (p D_0 - i K_1) + s^2 (p^2 M - i p D_1) ] x = 0 ,       W = Im s

which for D_0 = K_1 = 0 is K x = W^2 (p^2 M - i p G) x, a Hermitian but indefinite pair. A stiffness W^2 K_2, of elastic bodies
that turn, adds to p^2 M as -K_2. The pencil is inverted at s = i (a + b)/2, so that all speeds between a and b lie in the
disc around it. Without damping s is imaginary, and Newton's method in s itself ends on it. With damping Re s is not zero, and the
root of Im lambda(W) = p W is found from it by a secant, each trial an eigenpair of the pencil at a real W.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from rotorgear.errors import ConvergenceError
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.solvers.eigen.quadratic import inverse_iteration
from rotorgear.solvers.sparse.entries import scaled_on_both_sides
from rotorgear.solvers.sparse.factor import Factor, factor_general, factor_symmetric, single_thread
from rotorgear.solvers.sparse.sums import SparseSums

_DENSE_UP_TO = 100
LEAST_SHARE = 1e-6  # of the highest speed, below which a root is not told from a rigid motion at no speed
_CENTRE = 1.000731  # off the middle, where an eigenvalue may sit
_RADIUS = 1.15  # of half the range
_HEAVY = 0.7  # |Re s| / |s| from which on a mode no longer oscillates in a way that can be followed
_BEYOND = 0.15  # of a speed, how far damped roots may move when they are polished
_MOST = 400  # critical speeds that ARPACK is asked for; more are a question of another range
_CONVERGED = 1e-14  # |Im lambda - p W| / (p W) at which the secant ends
_FOUND = 1e-12  # the same of a root that was found in s itself, where what is left is rounding
_FREE = 1e-9  # stiffness along a motion over that of its terms, below which it is none
BACK_SUBSTITUTED = 1e-10  # the same, above which a root is refused


@dataclass(frozen=True)
class Affine:
    """M, D = D_0 + W D_1, K = K_0 + W K_1 + W^2 K_2 for speeds W from `low` to `high` in rad/s; sparse (n, n), real."""

    M: sp.csc_array
    D0: sp.csc_array
    D1: sp.csc_array
    K0: sp.csc_array
    K1: sp.csc_array
    K2: sp.csc_array
    low: float
    high: float

    def at(self, speed: float) -> tuple[sp.csc_array, sp.csc_array]:
        """D and K at a speed."""
        K = self.K0 + speed * self.K1 + speed**2 * self.K2
        return sp.csc_array(self.D0 + speed * self.D1), sp.csc_array(K)

    @property
    def is_damped(self) -> bool:
        """Whether roots may lie off the imaginary axis: a damping or a circulation."""
        damping = (self.D0 + self.D0.T, self.D1 + self.D1.T)
        circulation = self.K0 - self.K0.T
        if any(even.nnz and abs(even).max() > 1e-312 for even in damping):
            return True
        return bool(circulation.nnz and abs(circulation).max() > 1e-12 * abs(self.K0).max())

    def inertia(self, order: float) -> sp.csc_array:
        """p^2 M - i p D_1 - K_2: what grows with s^2."""
        return sp.csc_array(order**2 * self.M - 1j * order * self.D1 - self.K2)

    def cut(self, dofs: np.ndarray) -> Affine:
        """The same of some dofs, that no other acts on."""
        matrices = (self.M, self.D0, self.D1, self.K0, self.K1, self.K2)
        M, D0, D1, K0, K1, K2 = (sp.csc_array(A[:, dofs][dofs]) for A in matrices)
        return Affine(M, D0, D1, K0, K1, K2, self.low, self.high)


@dataclass(frozen=True)
class Synchronous:
    """A speed W in rad/s with Im lambda(W) = p W: lambda, its vector (n,), and |Im lambda - p W| / (p W)."""

    speed: float
    eigenvalue: complex
    vector: np.ndarray
    residual: float


def synchronous_speeds(family: Affine, order: float) -> tuple[list[Synchronous], bool]:
    """All speeds above `low` and up to `high` at which an oscillating mode has the frequency `order` times the speed, ascending.

    Returns:
        The speeds, and whether a count by pivot signs confirms that none is missing; False where they can't be counted.

    Raises:
        ConvergenceError: a root does not converge to 1e-10, or a count by pivot signs (undamped systems) misses one.
    """
    with single_thread(family.M.shape[0]):
        pencil = _Pencil(family, order)
        is_damped = family.is_damped
        # Another centre and another start vector where a count says that one was missed.
        for attempt in range(4):
            s, X = _starts(family, order, attempt)
            # Starts move when they are polished, with damping the further the steeper the matrices grow: some beyond both ends
            # are tried. s near 0 is a rigid motion at no speed.
            beyond = _BEYOND if is_damped else 0.0
            inside = s.imag > (1.0 - beyond) * family.low - 1e-3 * family.high
            inside &= s.imag < (1.05 + beyond) * family.high
            inside &= np.abs(s.real) < _HEAVY * np.abs(s)
            inside &= np.abs(s.imag) > LEAST_SHARE * family.high
            roots: list[Synchronous] = []
            for k in np.flatnonzero(inside):
                root = _polished(pencil, order, complex(s[k]), X[:, k], is_damped)
                if root is not None and not any(_same(root, other, family.M) for other in roots):
                    roots.append(root)
            roots = sorted((r for r in roots if family.low < r.speed <= family.high), key=lambda root: root.speed)
            agrees = _count_agrees(family, order, roots)
            if agrees is not False:
                return roots, agrees is True
    raise ConvergenceError(
        f"a count by pivot signs does not confirm the {len(roots)} critical speeds of order {order:g} that were found",
        roots,
    )


def _starts(family: Affine, order: float, attempt: int) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues s (k,) of the problem in the speed inside the disc, and vectors (n, k)."""
    centre = 0.5 * (family.low + family.high) * _CENTRE * (1.0 + 0.0137 * attempt)
    radius = _RADIUS * 0.5 * (family.high - family.low) / centre
    if family.is_damped:
        # Damping moves roots sideways, in a narrow range far beyond a disc that is as wide as it.
        radius = max(radius, _HEAVY / np.sqrt(1.0 - _HEAVY**2) * family.high / centre)
    diagonal = np.abs(family.K0.diagonal()) + (order * centre) ** 2 * family.M.diagonal()
    scale = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    S = sp.diags_array(scale)
    A0 = sp.csc_array(S @ family.K0 @ S, dtype=complex)
    A1 = sp.csc_array(S @ (order * family.D0 - 1j * family.K1) @ S * centre)
    A2 = sp.csc_array(S @ family.inertia(order) @ S * centre**2)
    # Inverted at s = i (a + b)/2, in units in which that is i: T [x; s x] as in `quadratic.InverseState`.
    sigma = 1j
    n = family.M.shape[0]
    factor = factor_general(sp.csc_array(A0 + sigma * A1 + sigma**2 * A2))
    first = sp.csr_array(A1 + sigma * A2)

    def apply(x: np.ndarray) -> np.ndarray:
        q = -factor.solve(first @ x[:n] + A2 @ x[n:])
        return np.concatenate([q, x[:n] + sigma * q])

    mu, X = _largest(apply, 2 * n, 1.0 / radius, attempt)
    keep = np.abs(mu) >= 1.0 / radius
    return centre * (sigma + 1.0 / mu[keep]), scale[:, None] * X[:n, keep]


def _largest(
    apply: Callable[[np.ndarray], np.ndarray], size: int, least: float, attempt: int
) -> tuple[np.ndarray, np.ndarray]:
    """Eigenpairs of a linear map (2n) that hold all with |mu| >= least."""
    if size <= 2 * _DENSE_UP_TO:
        return np.linalg.eig(apply(np.eye(size, dtype=complex)))
    from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigs

    operator = LinearOperator((size, size), matvec=lambda x: apply(x.reshape(-1)), dtype=complex)
    start = np.random.default_rng(5 + attempt).standard_normal(size) + 0j
    count = 24 * 2**attempt
    while count < min(size - 2, _MOST):
        try:
            mu, X = eigs(operator, k=count, ncv=min(size, 2 * count + 20), which="LM", v0=start, tol=1e-11)
        except ArpackNoConvergence as error:
            raise ConvergenceError(
                f"the {count} critical speeds nearest to the middle of the range did not converge"
            ) from error
        if np.abs(mu).min() < least:
            return mu, X
        count *= 2
    if size > 6000:
        raise ConvergenceError(f"more than {_MOST} critical speeds lie in the range; narrow it, or give fmax")
    return np.linalg.eig(apply(np.eye(size, dtype=complex)))


class _Pencil:
    """Q(lambda, W) = lambda^2 M + lambda (D_0 + W D_1) + K_0 + W K_1 + W^2 K_2 in dofs scaled to unit diagonals at the middle."""

    def __init__(self, family: Affine, order: float) -> None:
        self.family = family
        middle = order * 0.5 * (family.low + family.high)
        diagonal = np.abs(family.K0.diagonal()) + middle**2 * np.abs(family.M.diagonal())
        self.scale = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
        matrices = (family.M, family.D0, family.D1, family.K0, family.K1, family.K2)
        self._parts = [scaled_on_both_sides(sp.csc_array(A), self.scale) for A in matrices]
        self._sums = SparseSums(*self._parts)

    def newton(self, z: complex, x: np.ndarray, a: complex, b: complex, c: float) -> tuple[complex, np.ndarray]:
        """The eigenpair of Q(a z, b z + c) next to a value and vector (n,)."""

        def factored(z: complex) -> Factor:
            value = a * z
            speed = b * z + c
            return self._sums.factor((value**2, value, value * speed, 1.0, speed, speed**2))

        def slope(z: complex, v: np.ndarray) -> np.ndarray:
            value = a * z
            speed = b * z + c
            by_z = (2.0 * a * value, a, a * speed + b * value, 0.0, b, 2.0 * b * speed)
            return sum((d * (A @ v) for d, A in zip(by_z, self._parts, strict=True) if d and A.nnz), np.zeros_like(v))

        found, v = inverse_iteration(z, x / self.scale, factored, slope)
        return found, v * self.scale


def _polished(pencil: _Pencil, order: float, s: complex, x: np.ndarray, is_damped: bool) -> Synchronous | None:
    """The root of Im lambda(W) = p W next to a start; None where it leads elsewhere."""
    if not is_damped:
        s, x = pencil.newton(s, x, order, -1j, 0.0)
    speed = s.imag
    value = order * s
    v = x
    last: tuple[float, float] | None = None
    for _ in range(12):
        value, v = pencil.newton(value, v, 1.0, 0.0, speed)
        gap = value.imag - order * speed
        if abs(gap) <= (_CONVERGED if is_damped else _FOUND) * order * speed:
            break
        # Secant; the first step takes lambda as constant, and one as long as a third of the speed leads to another root.
        slope = -order if last is None or last[0] == speed else (gap - last[1]) / (speed - last[0])
        last = (speed, gap)
        step = gap / (slope or -order)
        if abs(step) > 0.3 * speed:
            return None
        if abs(step) <= 1e-16 * speed:
            break
        speed -= step
    residual = abs(value.imag - order * speed) / (order * speed)
    if residual > BACK_SUBSTITUTED:
        K = pencil.family.at(speed)[1]
        held = abs(np.vdot(v, K @ v))
        if held <= _FREE * float(np.abs(v) @ (abs(K) @ np.abs(v))):
            return None  # a free motion, whose stiffness is what rounding leaves of terms that cancel
        raise ConvergenceError(f"residual {residual:.1e} at a critical speed near {speed * RPM_PER_RAD_S:.6g} rpm")
    return Synchronous(float(speed), complex(value), v, float(residual))


def _same(one: Synchronous, other: Synchronous, M: sp.csc_array) -> bool:
    """Whether two starts led to one root: equal speeds may belong to two modes, which their vectors tell apart."""
    if abs(one.speed - other.speed) > 1e-9 * one.speed:
        return False
    if abs(one.eigenvalue - other.eigenvalue) > 1e-8 * abs(one.eigenvalue):
        return False
    x = one.vector
    y = other.vector
    return bool(abs(np.vdot(x, M @ y)) ** 2 > 0.98 * (abs(np.vdot(x, M @ x)) * abs(np.vdot(y, M @ y))))


def _count_agrees(family: Affine, order: float, roots: list[Synchronous]) -> bool | None:
    """Pivot signs of K - W^2 H at both ends of the range against the signs of x^H H x; None where these can't be counted.

    An eigenvalue of K - m H falls through zero at m = W^2 where x^H H x > 0 and rises where it is negative.
    """
    skew = abs(family.D1 + family.D1.T)
    if family.D0.nnz or family.K1.nnz or (skew.nnz and skew.max() > 1e-12 * abs(family.D1).max()):
        return None  # the pair is not Hermitian
    H = family.inertia(order)
    ends = (max(family.low, 1e-4 * 0.999 * min([family.high, *(r.speed for r in roots)])), family.high)
    if any(abs(r.speed - end) < 1e-7 * end for r in roots for end in ends):
        return None  # a root on the very end can't be counted
    signs = [np.sign(np.vdot(r.vector, H @ r.vector).real) for r in roots]
    try:
        below = [factor_symmetric(sp.csc_array(family.K0 - W**2 * H)).negative_count() for W in ends]
    except ConvergenceError:
        return None  # no factors without row exchanges: nothing to count with
    return below[1] - below[0] == int(sum(signs))
