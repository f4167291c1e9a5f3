"""Solves a plant for all orders at all speeds: direct, or in a basis of modes and solutions that proves its own error."""

from __future__ import annotations

import numpy as np

from rotorgear.analysis.response.order import Order
from rotorgear.analysis.response.plant import Plant, Readings, gathered
from rotorgear.errors import ConvergenceError
from rotorgear.progress import Progress, part_of
from rotorgear.solvers.eigen.reduced_pencil import Pencil
from rotorgear.solvers.frequency.frequency_range import largest_peaks
from rotorgear.solvers.frequency.harmonic import Dynamics, orthonormal, projected, response_in_basis
from rotorgear.solvers.sparse.factor import factor_symmetric, single_thread
from rotorgear.system.system import InPowers

# The basis grows until its error against direct solutions is below this, at the points where its residual is largest.
TOLERANCE = 1e-6
# Above this number of unknowns in all, the basis is cheaper than direct solutions.
_DIRECT_UP_TO = 100_000
# A basis takes about this many direct solutions of every order until it is proved.
_FEW_SPEEDS = 20
_ROUNDS = 40
_PER_ROUND = 6
_SPEEDS_WHILE_GROWING = 24
# Modes up to this much above the highest frequency of an order are in its basis.
_MODES_UP_TO = 1.5
# Minor orders that share a basis, at most.
_IN_A_BUNCH = 32


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
    return "modal", f"by modes, since {size} one by one would take longer"


def direct_sweep(plant: Plant, orders: list[Order], speeds: np.ndarray, progress: Progress) -> Sweep:
    """Factor the dynamic stiffness for every order at every speed."""
    readings = []
    worst = 0.0
    for k, speed in enumerate(speeds):
        progress(k / len(speeds), f"speed {k + 1} of {len(speeds)}")
        dynamics = plant.dynamics(speed)
        w, f = plant.loads(orders, speed)
        q = solve_orders(dynamics, w, f)
        worst = max(worst, dynamics.relative_residual(w, f, q))
        readings.append(plant.read(orders, speed, w, q))
    method = "direct sparse LU; largest residual relative to the forces inside"
    return gathered(readings), worst, len(speeds) * len(orders), method


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
        patterns = np.hstack([loads.real, loads.imag, plant.lines.vectors])
        self.basis = orthonormal(np.zeros((plant.system.n, 0)), np.hstack([modes, shifted.solve(patterns)]), self.scale)
        self._projection: list[Pencil] | None = None
        self.modes = modes.shape[1]
        self.checked = 0
        self.error = np.inf

    def reduced(self, dynamics: Dynamics, speed: float) -> Pencil:
        """The projection at a speed: put together from two speeds where nothing but W G and W K changes."""
        powers = self.plant.system.in_powers
        if self.plant.has_tables and powers is None:
            return projected(dynamics, self.basis)
        if powers is not None:
            return self._in_powers(powers, speed)
        if self._projection is None:
            self._projection = [projected(self.plant.dynamics(x), self.basis) for x in (0.0, 1.0)]
        still, turning = self._projection
        return still.between(turning, speed)

    def _in_powers(self, powers: InPowers, speed: float) -> Pencil:
        """The projection where planets go round: by powers of the speed, and the loads of their pins on a few dofs."""
        X = self.basis
        if self._projection is None:
            still = projected(self.plant.dynamics(0.0), X)
            per_speed = X.T @ (self.plant.system.gyroscopic @ X)
            turning = Pencil(still.M, per_speed, X.T @ (powers.per_speed @ X))
            self._projection = [still, turning, Pencil(still.M, per_speed, X.T @ (powers.per_square @ X))]
        still, turning, square = self._projection
        pins = self.plant.system.stiffness_of(speed)
        rows = np.unique(pins.indices)
        own = X[rows]
        K = still.K + speed * turning.K + speed**2 * square.K + own.T @ (pins[rows][:, rows] @ own)
        return Pencil(still.M, still.D + speed * turning.D, K)

    def solve(self, speed: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Frequencies (o,), displacements (n, o) and relative residuals (o,) at a speed."""
        w, f = self.plant.loads(self.orders, speed)
        dynamics = self.plant.dynamics(speed)
        # Real and complex would be multiplied as two complex ones, four times the work of a wide basis.
        projected_load = self.basis.T @ f.real + 1j * (self.basis.T @ f.imag)
        y = response_in_basis(self.reduced(dynamics, speed), w, projected_load)
        q = self.basis @ y.real + 1j * (self.basis @ y.imag)
        rest = (f - dynamics.apply(w, q)) / self.scale[:, None]
        size = np.linalg.norm(f / self.scale[:, None], axis=0)
        return w, q, np.linalg.norm(rest, axis=0) / np.where(size > 0.0, size, 1.0)

    def proved(self, progress: Progress) -> Readings:
        """Readings at every speed, with a basis that was proved where its residual is largest, first at few of the speeds.

        Raises:
            ConvergenceError: the error against direct solutions stays above the tolerance.
        """
        count = len(self.speeds)
        name = self.orders[-1].name
        few = np.unique(np.linspace(0, count - 1, _SPEEDS_WHILE_GROWING).round().astype(int))
        for number in range(_ROUNDS):
            progress(0.05 + 0.3 * number / _ROUNDS, name)
            if self.check(self.speeds[few], [self.solve(float(speed))[2] for speed in self.speeds[few]]) <= TOLERANCE:
                break
        else:
            raise self._unproved()
        for _ in range(_ROUNDS):
            readings = []
            residuals = []
            for k, speed in enumerate(self.speeds):
                if k % 10 == 0:
                    progress(0.35 + 0.6 * k / count, name)
                w, q, rest = self.solve(float(speed))
                readings.append(self.plant.read(self.orders, float(speed), w, q))
                residuals.append(rest)
            if self.check(self.speeds, residuals) <= TOLERANCE:
                return gathered(readings)
        raise self._unproved()

    def _unproved(self) -> ConvergenceError:
        return ConvergenceError(
            f"the modal solution of {self.orders[-1].name} still differs by {self.error:.1e} from direct ones with "
            f"{self.basis.shape[1]} vectors; use --method direct"
        )

    def check(self, speeds: np.ndarray, residuals: list[np.ndarray]) -> float:
        """Largest relative error against direct solutions where the residuals (s, o) at some speeds are largest.

        These solutions join the basis where it is too large.
        """
        new = []
        error = 0.0
        for s, order in largest_peaks(np.array(residuals), _PER_ROUND):
            speed = float(speeds[s])
            w, q, _ = self.solve(speed)
            f = self.plant.loads(self.orders, speed)[1][:, [order]]
            exact = self.plant.dynamics(speed).solve(float(w[order]), f)[:, 0]
            size = float(np.linalg.norm(self.scale * exact))
            difference = float(np.linalg.norm(self.scale * (exact - q[:, order]))) / size if size else 0.0
            error = max(error, difference)
            self.checked += 1
            if difference > 0.1 * TOLERANCE:
                new += [exact.real, exact.imag]
        if error > TOLERANCE:
            self.basis = orthonormal(self.basis, np.array(new).T, self.scale)
            self._projection = None
        self.error = error
        return error


def modal_sweep(
    plant: Plant, orders: list[Order], speeds: np.ndarray, modes: tuple[np.ndarray, np.ndarray], progress: Progress
) -> Sweep:
    """Solve each order in a basis of its own, grown until it is proved good, then at every speed.

    `modes` are shapes (n, m) and w (m,) in rad/s. Slow orders get along with few of them.
    """
    shapes, w = modes
    readings = []
    sweeps = []
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
            sweep = ModalSweep(plant, own, speeds, shapes[:, w <= top])
            share = part_of(progress, number / len(bunches), (number + 1) / len(bunches))
            readings.append(sweep.proved(share))
            sweeps.append(sweep)
    most, added = max((sweep.modes, sweep.basis.shape[1] - sweep.modes) for sweep in sweeps)
    method = f"modal, up to {most} modes and {added} static and direct solutions as basis of an order"
    back = np.argsort(np.concatenate(bunches))
    whole = gathered(readings, lambda parts: np.concatenate(parts, axis=1)[:, back])
    return whole, max(sweep.error for sweep in sweeps), sum(sweep.checked for sweep in sweeps), method
