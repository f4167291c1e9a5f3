"""The exponential integrator: exact for the linear part in complex modes, second order in the local forces, speed constant.

The local forces are split into their linear reference k d + c v, which goes into the modes, and the rest u, which is constant
within a step and found by Newton's method on m unknowns. A contact whose vibration on the inertia that it meets the step does not
resolve stays out of the modes: free of it, structures fly exactly, and its forces are impulses that keep energy.
Hochbruck and Ostermann, Acta Numerica 19 (2010) 209; Li and Wu, SIAM J. Sci. Comput. 38 (2016) A1876.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.solvers.eigen.complex_modes import ComplexModes, complex_modes
from rotorgear.solvers.time.arguments import ExponentialStep, Kept
from rotorgear.solvers.time.local_system import (
    Integrator,
    LocalSystem,
    MotionState,
    Records,
    Stepper,
    contact_rates,
)
from rotorgear.solvers.time.sisters import turned

# Modal coordinates y by their parts, motions without stiffness and their rates, and the rest of the local forces, as states
# name them.
_MOTION = ("yr", "yi", "r0", "r1", "u")
# Radians of a contact's vibration in a step above which it stays out of the modes.
_RESOLVED = 0.8


@dataclass(frozen=True)
class Exponential(Integrator):
    """Method with all modes, or `modes` real modes and the residual attachment vectors."""

    modes: int | None = None
    modal_ratio: float = 0.0
    _known: list[tuple[LocalSystem, float, ComplexModes]] = field(default_factory=list, compare=False, repr=False)
    _without: list[tuple[LocalSystem, np.ndarray, LocalSystem]] = field(default_factory=list, compare=False, repr=False)

    @property
    def name(self) -> str:
        """What it is, in words."""
        return "exponential, " + ("all complex modes" if self.modes is None else f"{self.modes} modes with residuals")

    def damping_rows(self, system: LocalSystem, speed: float) -> np.ndarray:
        """Rows Y (b, n) of the damping by modes: it dissipates |Y v|^2; none where no mode has its own ratio."""
        if not self.modal_ratio:
            return np.zeros((0, system.n))
        V = self._modes(system, speed).basis
        roots = np.sqrt(np.maximum(np.einsum("ij,ij->j", V, system.stiffness_about @ V), 0.0))
        return np.asarray(np.sqrt(2.0 * self.modal_ratio * roots)[:, None] * (system.M @ V).T)

    def prepare(self, system: LocalSystem, h: float, speed: float, tolerance: float = 1e-10) -> ExponentialStepper:
        """Find the modes and the step's coefficients.

        Raises:
            AnalysisError: the speed of the reference changes, or a dof has no inertia.
        """
        if not system.rotation.is_constant and system.G is not None and system.G.nnz:
            raise AnalysisError("the exponential integrator needs a constant speed; use newmark for a run-up")
        # Sisters that go round free of these laws have no modes: their inertia is a negative stiffness in axes at rest.
        if not (self.modal_ratio or self.modes or system.sisters.planets.size):
            system = self._resolved(system, h)
        return ExponentialStepper(self._modes(system, speed), system, h, tolerance)

    def _resolved(self, system: LocalSystem, h: float) -> LocalSystem:
        """The system with those contacts out of the reference that the step does not resolve."""
        laws = system.forces
        fast = contact_rates(system.M, system.B.toarray(), laws.reference_stiffness) * h > _RESOLVED
        if not np.any(fast):
            return system
        known = next(
            (small for whole, out, small in self._without if whole is system and np.array_equal(out, fast)), None
        )
        if known is None:
            held = np.where(fast[:, None] | fast[None, :], 0.0, 1.0)
            k = laws.reference_stiffness * held
            c = laws.reference_damping * held
            known = replace(system, forces=replace(laws, reference_stiffness=k, reference_damping=c))
            self._without.append((system, fast, known))
        return known

    def _modes(self, system: LocalSystem, speed: float) -> ComplexModes:
        """The modes, found once for a system and speed."""
        found = next((modes for known, at, modes in self._known if known is system and at == speed), None)
        if found is None:
            D = system.damping_about if system.G is None else system.damping_about + speed * system.G
            found = complex_modes(system.M, D, system.stiffness_about, system.B.toarray(), self.modes, self.modal_ratio)
            self._known.append((system, speed, found))
        return found


class ExponentialStepper(Stepper):
    """The method made ready for one system, step and speed."""

    def __init__(self, modes: ComplexModes, system: LocalSystem, h: float, tolerance: float) -> None:
        super().__init__(system, h)
        self.modes = modes
        B = system.B.toarray()
        s = modes.s
        first, _ = phi_functions(s * h)
        gain = modes.gains @ (modes.basis.T @ B)
        self._Q = (h * first)[:, None] * gain
        push = modes.gains @ (modes.basis.T @ system.load)
        C = B.T @ modes.shapes
        V = C * s
        Br = modes.rigid.T @ B
        A = np.real(C @ self._Q) + 0.5 * h * h * Br.T @ Br
        k = system.forces.reference_stiffness
        c = system.forces.reference_damping
        linear = np.eye(system.m) - A @ (0.5 * k + c / h)
        rigid_load = modes.rigid.T @ system.load
        self._mobile = modes.basis @ (modes.basis.T @ B) + modes.rigid @ Br
        self._pushed = modes.basis @ (modes.basis.T @ system.load) + modes.rigid @ rigid_load
        seen = system.observed_rows
        W = system.watched_vectors.T
        none = np.zeros((len(W), system.m))
        watched = np.vstack(
            [W @ modes.shapes, sum(Y @ (modes.shapes * s**power) for power, Y in enumerate((seen.q, seen.v, seen.a)))]
        )
        e = np.exp(s * h)
        self._step = ExponentialStep(
            h=float(h),
            rotation=system.rotation.table,
            tolerance=float(tolerance),
            e=_parts(e),
            g=_parts(h * first * push),
            Q=_parts(self._Q.T),
            G=_parts((e[:, None] * self._Q).T),
            C=_parts(np.vstack([C, watched])),
            V=_parts(V),
            B=np.ascontiguousarray(Br),
            load=rigid_load,
            W=np.ascontiguousarray(modes.rigid.T @ np.vstack([W, seen.q]).T),
            Wv=np.ascontiguousarray(modes.rigid.T @ np.vstack([0.0 * W, seen.v]).T),
            k=k,
            c=c,
            Z=np.ascontiguousarray(np.linalg.inv(linear)),
            Ad=np.ascontiguousarray(np.linalg.solve(linear, A)),
            Av=np.zeros((system.m, system.m)),
            Ud=np.ascontiguousarray(A),
            Uv=np.ascontiguousarray(np.real(V @ self._Q)),
            watched=np.ascontiguousarray(np.real(watched @ self._Q)),
            late=np.vstack([none, seen.a @ self._mobile]),
            forced=np.vstack([none, seen.F]),
            constant=np.concatenate([np.zeros(len(W)), seen.a @ self._pushed]),
        )
        self._laws = system.forces.arguments()
        self._rows: dict[tuple[str, int], tuple[np.ndarray, ...]] = {}

    def start(self, state: MotionState) -> None:
        """Take displacements and velocities over into modal coordinates."""
        if state.step == 0:
            state.sums[:] = 0.0  # energies of whole steps have no half step before the first
        modes = self.modes
        system = self.system
        if "yr" in state.inner and state.inner["yr"].size == modes.s.size:
            return
        weighted = system.M @ np.column_stack([state.q, state.v])
        laws = system.forces
        u = (
            laws.reference_stiffness @ (system.B.T @ state.q)
            + laws.reference_damping @ (system.B.T @ state.v)
            - self._acting(state)
        )
        y = self._on_modes(modes.basis.T @ weighted) - self._Q @ u
        rigid = modes.rigid.T @ weighted
        motion = (y.real.copy(), y.imag.copy(), rigid[:, 0].copy(), rigid[:, 1].copy(), u)
        state.inner = dict(zip(_MOTION, motion, strict=True))

    def _acting(self, state: MotionState) -> np.ndarray:
        """Local forces (m,) as they act on the structure."""
        system = self.system
        angle = system.rotation.angle(np.array([state.step * self.h]))
        return turned(system.sisters, -angle, state.F[None])[0] if system.sisters.planets.size else state.F

    def _on_modes(self, coordinates: np.ndarray) -> np.ndarray:
        """z (nz,) with the given basis coordinates and velocities (b, 2), by least squares on the modes themselves."""
        X = self.modes.basis.T @ (self.system.M @ self.modes.shapes)
        real = np.vstack([np.hstack([X.real, -X.imag]), np.hstack([(X * self.modes.s).real, -(X * self.modes.s).imag])])
        scale = np.abs(self.modes.s).max(initial=1.0)
        real[coordinates.shape[0] :] /= scale
        right = np.concatenate([coordinates[:, 0], coordinates[:, 1] / scale])
        if not real.size:
            return np.zeros(0, complex)
        found = np.linalg.lstsq(real, right, rcond=None)[0]
        return np.asarray(found[: self.modes.s.size] + 1j * found[self.modes.s.size :])

    @property
    def sizes(self) -> tuple[int, ...]:
        """Of both parts of z, of r and r' of the motions without stiffness, and of u."""
        return 2 * self.modes.s.size, 2 * self.modes.rigid.shape[1], self.system.m

    def loop(self, state: MotionState, steps: int, every: int, kept: Kept) -> tuple[int, int, int]:
        """Advance a state in place and record; returns steps done, status and linear solutions."""
        from rotorgear.solvers.time.kernel_exponential import exponential_loop

        motion = tuple(state.inner[name] for name in _MOTION)
        done, status, solutions = exponential_loop(
            self._step, self._laws, *self.system.going_round, steps, every, state.step, motion, state.carried, kept
        )
        return done, status, solutions

    def advance(self, state: MotionState, steps: int, every: int) -> Records:
        """Advance a state in place; q, v and a follow where the last step was recorded."""
        records = super().advance(state, steps, every)
        if records.t.size and records.t.size * every == records.done:
            state.q, state.v, state.a = (self._last(kind, *records.motion) for kind in "qva")
        return records

    def rows(self, kind: str, Y: np.ndarray, *motion: np.ndarray) -> np.ndarray:
        """Y q, Y v or Y a, (r, p), of a recorded motion."""
        z, rigid, u = motion
        key = (kind, id(Y))
        if key not in self._rows:
            power = "qva".index(kind)
            shapes = Y @ (self.modes.shapes * self.modes.s**power)
            R = Y @ self.modes.rigid
            nothing = np.zeros_like(R)
            moved = (np.hstack([R, nothing]), np.hstack([nothing, R]), np.hstack([nothing, nothing]))[power]
            mobile = Y @ self._mobile if kind == "a" else np.zeros((Y.shape[0], self.system.m))
            constant = Y @ self._pushed if kind == "a" else np.zeros(Y.shape[0])
            # Y is kept, so that its id stays its own.
            self._rows[key] = (Y, np.hstack([shapes.real, -shapes.imag]).T.copy(), moved.T, mobile.T, constant)
        _, by_z, by_rigid, by_u, constant = self._rows[key]
        return np.asarray(z @ by_z + rigid @ by_rigid + u @ by_u + constant)

    def _last(self, kind: str, z: np.ndarray, rigid: np.ndarray, u: np.ndarray) -> np.ndarray:
        """q, v or a of the last record, (n,)."""
        modes = self.modes
        power = "qva".index(kind)
        nz = modes.s.size
        nr = modes.rigid.shape[1]
        x = np.real(modes.shapes @ (modes.s**power * (z[-1, :nz] + 1j * z[-1, nz:])))
        if power < 2:
            return np.asarray(x + modes.rigid @ rigid[-1, power * nr : (power + 1) * nr])
        return np.asarray(x + self._mobile @ u[-1] + self._pushed)


def _parts(A: np.ndarray) -> np.ndarray:
    """Real and imaginary part, (2, ...)."""
    return np.ascontiguousarray(np.stack([A.real, A.imag]))


def phi_functions(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """phi_1 = (e^x - 1)/x and phi_2 = (e^x - 1 - x)/x^2, by their series where x is small."""
    small = np.abs(x) < 0.3
    safe = np.where(small, 1.0, x)
    first = np.zeros_like(x)
    second = np.zeros_like(x)
    term = np.ones_like(x)
    for k in range(1, 16):
        first = first + term
        second = second + term / (k + 1.0)
        term = term * x / (k + 1.0)
    return (
        np.where(small, first, np.expm1(safe) / safe),
        np.where(small, second, (np.expm1(safe) - safe) / safe**2),
    )
