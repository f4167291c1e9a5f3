"""Solves a plant for all orders at all speeds: direct, or in a basis of modes and solutions that proves its own error."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rotorgear.analysis.response.order import Order
from rotorgear.analysis.response.plant import Plant, Readings, gathered
from rotorgear.errors import ConvergenceError
from rotorgear.progress import Progress, part_of, silent
from rotorgear.quantity import counted
from rotorgear.solvers.eigen.reduced_pencil import Pencil
from rotorgear.solvers.frequency.frequency_range import largest_peaks
from rotorgear.solvers.frequency.harmonic import Dynamics, DynamicsOverSpeed, orthonormal, projected, stiffness_in_basis
from rotorgear.solvers.sparse.entries import times
from rotorgear.solvers.sparse.factor import factor_symmetric, single_thread
from rotorgear.system.system import InPowers

# The basis grows until its error against direct solutions is below this, at the points where its residual is largest.
TOLERANCE = 1e-6
# Up to this number of unknowns in all, nothing is cheaper than direct solutions.
_DIRECT_UP_TO = 100_000
# A basis takes about this many direct solutions of every order until it is proved.
_FEW_SPEEDS = 20
_ROUNDS = 40
_PER_ROUND = 6
_SPEEDS_WHILE_GROWING = 24
# Modes up to this much above the highest frequency of an order are in its basis.
_MODES_UP_TO = 1.5
DIRECT = "direct sparse LU; largest residual relative to the forces inside"
# Numbers in one block of solutions.
_NUMBERS = 1_000_000
# Minor orders that share a basis, at most.
_IN_A_BUNCH = 32


# Nanoseconds of one core that were measured on models of 300 to 2000 dofs. A direct solution: for each dof, each entry of the
# stiffness, and each dof and mode with a damping ratio of its own.
_A_DOF = 500.0
_AN_ENTRY = 80.0
_A_DAMPED_MODE = 25.0
# A solution in a basis of r vectors: for r^3, r^2 and each dof and vector.
_CUBIC = 0.09
_SQUARE = 10.0
_PRODUCT = 1.5
# Solutions in the basis for each point until it is proved, direct ones in all, and vectors of the basis for each mode and beside.
_PASSES = 3.0
_PROOFS = 45
_A_MODE = 1.3
_BESIDE = 30


# Readings (s, o, ...) at every speed, the error of the solver, how many points were checked, and words on the method.
Sweep = tuple[Readings, float, int, str]


def choose_method(asked: str, speeds: int, orders: int, n: int) -> tuple[str, str]:
    """Return "direct" or "modal" and the reason."""
    if asked != "auto":
        return asked, "as asked for"
    if speeds <= _FEW_SPEEDS:
        return "direct", f"only {speeds} speed{'s'[: speeds != 1]}"
    points = speeds * orders
    size = f"{points} solutions of {n} dofs"
    if points * n <= _DIRECT_UP_TO:
        return "direct", f"only {size}"
    return "modal", f"{size}, each order in a basis of modes where that is less work"


def basis_pays(plant: Plant, modes: int, points: int) -> bool:
    """Whether a basis with so many modes in it takes less work than direct solutions at so many points, orders times speeds."""
    n = plant.system.n
    damped = 0 if plant.low_rank is None else len(plant.low_rank.d)
    direct = _A_DOF * n + _AN_ENTRY * plant.system.stiffness(0.0).nnz + _A_DAMPED_MODE * n * damped
    r = _A_MODE * modes + _BESIDE
    reduced = _CUBIC * r**3 + _SQUARE * r**2 + _PRODUCT * n * r
    return points * _PASSES * reduced + _PROOFS * direct < points * direct


def direct_sweep(plant: Plant, orders: list[Order], speeds: np.ndarray, progress: Progress) -> Sweep:
    """Factor the dynamic stiffness for every order at every speed."""
    readings = []
    worst = 0.0
    done = 0
    for block in _blocks(plant, speeds, plant.system.n * len(orders)):
        solved = []
        for speed in block.tolist():
            progress(done / len(speeds), f"speed {done + 1} of {len(speeds)}")
            done += 1
            dynamics = plant.dynamics(speed)
            w, f = plant.loads(orders, speed)
            q = solve_orders(dynamics, w, f)
            worst = max(worst, dynamics.relative_residual(w, f, q))
            solved.append((w, q))
        w, q = (np.concatenate(every, axis=-1) for every in zip(*solved, strict=True))
        readings.append(_read(plant, orders, block, w, q))
    return gathered(readings, np.concatenate), worst, len(speeds) * len(orders), DIRECT


def _blocks(plant: Plant, speeds: np.ndarray, numbers: int) -> Iterator[np.ndarray]:
    """Speeds (b,) that are taken together, where each needs so many numbers; of a model with tables one by one."""
    size = 1 if plant.has_tables else max(1, _NUMBERS // max(numbers, 1))
    for begin in range(0, len(speeds), size):
        yield speeds[begin : begin + size]


def _read(plant: Plant, orders: list[Order], speeds: np.ndarray, w: np.ndarray, q: np.ndarray) -> Readings:
    """Readings (s, o, ...) of displacements q (n, s o) at some speeds, all orders at one speed after the other."""
    flat = plant.read(orders * len(speeds), np.repeat(speeds, len(orders)), w, q)
    return gathered([flat], lambda parts: parts[0].reshape(len(speeds), len(orders), *parts[0].shape[1:]))


def answer(plant: Plant, orders: list[Order], speed: float) -> Readings:
    """Readings of some orders at a speed, by direct solutions."""
    w, f = plant.loads(orders, speed)
    return plant.read(orders, speed, w, solve_orders(plant.dynamics(speed), w, f))


def solve_orders(dynamics: Dynamics, w: np.ndarray, f: np.ndarray) -> np.ndarray:
    """Direct solution of every order, (n, o), each distinct frequency factored once."""
    q = np.zeros(f.shape, complex)
    for value in np.unique(w):
        alike = np.flatnonzero(w == value)
        q[:, alike] = dynamics.solve(float(value), f[:, alike])
    return q


@dataclass(frozen=True)
class Solved:
    """Solutions in a basis at p points, all orders at one speed after the other.

    Attributes:
        w: (p,) frequencies in rad/s.
        y: (r, p) coordinates.
        residual: (p,) relative to the loads.
    """

    w: np.ndarray
    y: np.ndarray
    residual: np.ndarray


class ModalSweep:
    """The reduced plant: modes and static responses first, then direct solutions where the residual is largest."""

    def __init__(self, plant: Plant, orders: list[Order], speeds: np.ndarray, modes: np.ndarray) -> None:
        self.plant, self.orders, self.speeds = plant, orders, np.asarray(speeds, float)
        top = max(order.frequency_at(float(np.max(np.abs(self.speeds)))) for order in orders)
        M = plant.system.mass
        K = plant.system.stiffness(float(self.speeds[-1]))
        self.scale = np.sqrt(np.abs(K.diagonal()) + (0.1 * top) ** 2 * np.abs(M.diagonal()))
        shifted = factor_symmetric((K + (0.3 * top) ** 2 * M).tocsc())
        loads = np.hstack([plant.loads(orders, float(self.speeds[-1]))[1]])
        read = (rows(float(self.speeds[-1])).q.T for rows in (plant.load_rows, plant.rigid_rows))
        patterns = np.hstack([loads.real, loads.imag, plant.lines.vectors, *read])
        self.basis = orthonormal(np.zeros((plant.system.n, 0)), np.hstack([modes, shifted.solve(patterns)]), self.scale)
        self._projection: tuple[Pencil, ...] | None = None
        self.modes = modes.shape[1]
        self.checked = 0
        self.error = np.inf

    def reduced(self, dynamics: DynamicsOverSpeed, speed: float) -> tuple[Pencil, Pencil]:
        """The projection at standstill, and what it grows by with the speed; of a model with tables that at this speed."""
        powers = self.plant.system.in_powers
        if powers is not None:
            there = self._in_powers(powers, speed)
            nothing = np.zeros_like(there.K)
            return there, Pencil(nothing, nothing, nothing)
        if self._projection is None or self.plant.has_tables:
            self._projection = dynamics.projected(self.basis)
        still, grown = self._projection
        return still, grown

    def _in_powers(self, powers: InPowers, speed: float) -> Pencil:
        """The projection where planets go round: by powers of the speed, and the loads of their pins on a few dofs."""
        X = self.basis
        if self._projection is None:
            still = projected(self.plant.dynamics(0.0), X)
            per_speed = X.T @ (self.plant.system.gyroscopic @ X)
            turning = Pencil(still.M, per_speed, X.T @ (powers.per_speed @ X))
            self._projection = still, turning, Pencil(still.M, per_speed, X.T @ (powers.per_square @ X))
        still, turning, square = self._projection
        pins = self.plant.system.stiffness_of(speed)
        rows = np.unique(pins.indices)
        own = X[rows]
        K = still.K + speed * turning.K + speed**2 * square.K + own.T @ (pins[rows][:, rows] @ own)
        return Pencil(still.M, still.D + speed * turning.D, K)

    def solve(self, speeds: np.ndarray, progress: Progress = silent) -> Solved:
        """Solutions of all orders at some speeds."""
        solved = []
        done = 0
        for block in _blocks(self.plant, speeds, len(self.orders) * max(len(self.basis), self.basis.shape[1] ** 2)):
            progress(done / len(speeds), self.orders[-1].name)
            done += len(block)
            solved.append(self._solve(block))
        return Solved(*(np.concatenate(every, axis=-1) for every in zip(*solved, strict=True)))

    def _solve(self, speeds: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Frequencies (p,), coordinates (r, p) and relative residuals (p,) at speeds that are taken together, p = s o."""
        w, f = self._loads(speeds)
        x = np.repeat(speeds, len(self.orders))
        dynamics = self.plant.over_speed(float(speeds[0]))
        still, grown = self.reduced(dynamics, float(speeds[0]))
        by = x[:, None, None]
        Z = stiffness_in_basis(Pencil(still.M, still.D + by * grown.D, still.K + by * grown.K), w)
        y = np.linalg.solve(Z, times(self.basis.T, f).T[:, :, None])[:, :, 0].T
        rest = (f - dynamics.apply(x, w, times(self.basis, y))) / self.scale[:, None]
        size = np.linalg.norm(f / self.scale[:, None], axis=0)
        return w, y, np.linalg.norm(rest, axis=0) / np.where(size > 0.0, size, 1.0)

    def _loads(self, speeds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Frequencies (p,) and loads (n, p) of all orders at one speed after the other."""
        w, f = zip(*(self.plant.loads(self.orders, speed) for speed in speeds.tolist()), strict=True)
        return np.concatenate(w), np.hstack(f)

    def proved(self, progress: Progress) -> Readings:
        """Readings at every speed, with a basis that was proved where its residual is largest, first at few of the speeds.

        Raises:
            ConvergenceError: the error against direct solutions stays above the tolerance.
        """
        few = np.unique(np.linspace(0, len(self.speeds) - 1, _SPEEDS_WHILE_GROWING).round().astype(int))
        for number in range(_ROUNDS):
            progress(0.05 + 0.3 * number / _ROUNDS, self.orders[-1].name)
            if self.check(self.speeds[few], self.solve(self.speeds[few])) <= TOLERANCE:
                break
        else:
            raise self._unproved()
        for _ in range(_ROUNDS):
            solved = self.solve(self.speeds, part_of(progress, 0.35, 0.95))
            if self.check(self.speeds, solved) <= TOLERANCE:
                return self._readings(solved)
        raise self._unproved()

    def _readings(self, solved: Solved) -> Readings:
        """What solutions at all speeds mean."""
        count = len(self.orders)
        readings = []
        first = 0
        for block in _blocks(self.plant, self.speeds, len(self.basis) * count):
            own = slice(first, first + len(block) * count)
            first = own.stop
            readings.append(_read(self.plant, self.orders, block, solved.w[own], times(self.basis, solved.y[:, own])))
        return gathered(readings, np.concatenate)

    def _unproved(self) -> ConvergenceError:
        return ConvergenceError(
            f"the modal solution of {self.orders[-1].name} still differs by {self.error:.1e} from direct ones with "
            f"{self.basis.shape[1]} vectors; use --method direct"
        )

    def check(self, speeds: np.ndarray, solved: Solved) -> float:
        """Largest relative error against direct solutions where the residuals at some speeds are largest.

        These solutions join the basis where it is too large.
        """
        new = []
        error = 0.0
        count = len(self.orders)
        for s, order in largest_peaks(solved.residual.reshape(len(speeds), count), _PER_ROUND):
            at = count * s + order
            w, f = self.plant.loads([self.orders[order]], float(speeds[s]))
            exact = self.plant.dynamics(float(speeds[s])).solve(float(w[0]), f)[:, 0]
            size = float(np.linalg.norm(self.scale * exact))
            difference = exact - times(self.basis, solved.y[:, [at]])[:, 0]
            share = float(np.linalg.norm(self.scale * difference)) / size if size else 0.0
            error = max(error, share)
            self.checked += 1
            if share > 0.1 * TOLERANCE:
                new += [exact.real, exact.imag]
        if error > TOLERANCE:
            self.basis = orthonormal(self.basis, np.array(new).T, self.scale)
            self._projection = None
        self.error = error
        return error


def modal_sweep(
    plant: Plant,
    orders: list[Order],
    speeds: np.ndarray,
    modes: tuple[np.ndarray, np.ndarray],
    progress: Progress,
    *,
    throughout: bool = True,
) -> Sweep:
    """Solve each order in a basis of its own, grown until it is proved good, then at every speed.

    `modes` are shapes (n, m) and w (m,) in rad/s. Slow orders get along with few of them. Unless it is to be so `throughout`,
    orders whose basis would take more work than direct solutions are solved by these.
    """
    shapes, w = modes
    readings = []
    sweeps = []
    # Of the orders that are solved directly, the largest residual, and how many they are.
    residual = 0.0
    direct = 0
    # Minor orders share a basis with those of like frequency, every other order has its own.
    minor = [o for o, order in enumerate(orders) if order.minor]
    bunches = [
        *([o] for o, order in enumerate(orders) if not order.minor),
        *(minor[at : at + _IN_A_BUNCH] for at in range(0, len(minor), _IN_A_BUNCH)),
    ]
    with single_thread(plant.system.n):
        for number, bunch in enumerate(bunches):
            own = [orders[o] for o in bunch]
            top = _MODES_UP_TO * max(order.frequency_at(float(np.max(np.abs(speeds)))) for order in own)
            share = part_of(progress, number / len(bunches), (number + 1) / len(bunches))
            if throughout or basis_pays(plant, int(np.count_nonzero(w <= top)), len(own) * len(speeds)):
                sweeps.append(ModalSweep(plant, own, speeds, shapes[:, w <= top]))
                readings.append(sweeps[-1].proved(share))
            else:
                found, rest, _, _ = direct_sweep(plant, own, speeds, share)
                readings.append(found)
                residual = max(residual, rest)
                direct += len(own)
    back = np.argsort(np.concatenate(bunches))
    whole = gathered(readings, lambda parts: np.concatenate(parts, axis=1)[:, back])
    error = max([residual, *(sweep.error for sweep in sweeps)])
    return whole, error, sum(sweep.checked for sweep in sweeps) + direct * len(speeds), _method(sweeps, direct)


def _method(sweeps: list[ModalSweep], direct: int) -> str:
    """What was done for the orders of some bases, and how many were solved directly, in words."""
    if not sweeps:
        return DIRECT
    most, added = max((sweep.modes, sweep.basis.shape[1] - sweep.modes) for sweep in sweeps)
    words = f"modal, up to {most} modes and {added} static and direct solutions as basis of an order"
    return f"{words}; {counted(direct, 'orders')} by direct sparse LU, which is less work" if direct else words
