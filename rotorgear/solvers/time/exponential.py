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
from rotorgear.solvers.time.arguments import (
    Compliance,
    ModalKept,
    ModalMotion,
    ModalStep,
    Reference,
    RigidStep,
    Span,
    Turning,
)
from rotorgear.solvers.time.local_system import LocalSystem, Records, State, blank_records, contact_rates

# Radians of a contact's vibration in a step above which it stays out of the modes.
_RESOLVED = 0.8


@dataclass(frozen=True)
class Exponential:
    """Method with all modes, or `modes` real modes and the residual attachment vectors."""

    modes: int | None = None
    modal_ratio: float = 0.0
    _known: list[tuple[LocalSystem, float, ComplexModes]] = field(default_factory=list, compare=False, repr=False)
    _without: list[tuple[LocalSystem, np.ndarray, LocalSystem]] = field(default_factory=list, compare=False, repr=False)

    @property
    def name(self) -> str:
        """What it is, in words."""
        return "exponential, " + ("all complex modes" if self.modes is None else f"{self.modes} modes with residuals")

    @property
    def keeps_energy(self) -> bool:
        """Local forces do the work by which their potential changes over a step."""
        return True

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
        if not (self.modal_ratio or self.modes):
            system = self._resolved(system, h)
        return ExponentialStepper(self._modes(system, speed), system, h, tolerance)

    def _resolved(self, system: LocalSystem, h: float) -> LocalSystem:
        """The system with those contacts out of the reference that the step does not resolve."""
        fast = contact_rates(system) * h > _RESOLVED
        if not np.any(fast):
            return system
        known = next(
            (small for whole, out, small in self._without if whole is system and np.array_equal(out, fast)), None
        )
        if known is None:
            held = np.where(fast[:, None] | fast[None, :], 0.0, 1.0)
            laws = system.forces
            forces = replace(
                laws,
                reference_stiffness=laws.reference_stiffness * held,
                reference_damping=laws.reference_damping * held,
            )
            known = replace(system, forces=forces)
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


class ExponentialStepper:
    """The method made ready for one system, step and speed."""

    def __init__(self, modes: ComplexModes, system: LocalSystem, h: float, tolerance: float) -> None:
        self.h = h
        self._system = system
        self.modes = modes
        self._tolerance = tolerance
        B = system.B.toarray()
        m = system.m
        s = modes.s
        e = np.exp(modes.s * h)
        first, _ = phi_functions(modes.s * h)
        gain = modes.gains @ (modes.basis.T @ B)
        self._Q = (h * first)[:, None] * gain
        push = modes.gains @ (modes.basis.T @ system.load)
        C = B.T @ modes.shapes
        V = C * s
        Br = modes.rigid.T @ B
        A = np.real(C @ self._Q) + 0.5 * h * h * Br.T @ Br
        k_ref = system.forces.reference_stiffness
        c_ref = system.forces.reference_damping
        linear = np.eye(m) - A @ (0.5 * k_ref + c_ref / h)
        self._rigid_load = modes.rigid.T @ system.load
        self._mobile = modes.basis @ (modes.basis.T @ B) + modes.rigid @ Br
        self._pushed = modes.basis @ (modes.basis.T @ system.load) + modes.rigid @ self._rigid_load
        seen = system.observed_rows
        W = system.watched_vectors.T
        p = len(W)
        none = np.zeros((p, m))
        watched = np.vstack(
            [W @ modes.shapes, sum(Y @ (modes.shapes * s**power) for power, Y in enumerate((seen.q, seen.v, seen.a)))]
        )
        rotation = system.rotation
        self._turning = Turning(rotation.times, rotation.speeds, rotation.angles)
        self._modal = ModalStep(
            *_parts(e),
            *_parts((e[:, None] * self._Q).T),
            *_parts(h * first * push),
            *_parts(self._Q.T),
            *_parts(np.vstack([C, watched])),
            *_parts(V),
        )
        self._rigid = RigidStep(
            np.ascontiguousarray(Br),
            np.ascontiguousarray(modes.rigid.T @ np.vstack([W, seen.q]).T),
            np.ascontiguousarray(modes.rigid.T @ np.vstack([0.0 * W, seen.v]).T),
            self._rigid_load,
        )
        self._reference = Reference(
            Z=np.ascontiguousarray(np.linalg.inv(linear)),
            compliance=Compliance(np.ascontiguousarray(np.linalg.solve(linear, A)), np.zeros((m, m))),
            A=np.ascontiguousarray(A),
            Av=np.ascontiguousarray(np.real(V @ self._Q)),
            k=k_ref,
            c=c_ref,
            watched=np.ascontiguousarray(np.real(watched @ self._Q)),
            late=np.vstack([none, seen.a @ self._mobile]),
            forced=np.vstack([none, seen.F]),
            constant=np.concatenate([np.zeros(p), seen.a @ self._pushed]),
        )
        self._laws = system.forces.arguments()
        self._rows: dict[tuple[str, int], tuple[np.ndarray, ...]] = {}

    def start(self, state: State) -> None:
        """Take displacements and velocities over into modal coordinates."""
        if state.step == 0:
            state.sums[:] = 0.0  # energies of whole steps have no half step before the first
        modes = self.modes
        system = self._system
        if "yr" in state.inner and state.inner["yr"].size == modes.s.size:
            return
        weighted = modes.basis.T @ (system.M @ np.column_stack([state.q, state.v]))
        z = self._on_modes(weighted)
        laws = system.forces
        u = (
            laws.reference_stiffness @ (system.B.T @ state.q)
            + laws.reference_damping @ (system.B.T @ state.v)
            - state.F
        )
        y = z - self._Q @ u
        rigid = modes.rigid.T @ (system.M @ np.column_stack([state.q, state.v]))
        state.inner = {
            "yr": y.real.copy(),
            "yi": y.imag.copy(),
            "r0": rigid[:, 0].copy(),
            "r1": rigid[:, 1].copy(),
            "u": u,
        }

    def _on_modes(self, coordinates: np.ndarray) -> np.ndarray:
        """z (nz,) with the given basis coordinates and velocities (b, 2), by least squares on the modes themselves."""
        X = self.modes.basis.T @ (self._system.M @ self.modes.shapes)
        real = np.vstack([np.hstack([X.real, -X.imag]), np.hstack([(X * self.modes.s).real, -(X * self.modes.s).imag])])
        scale = np.abs(self.modes.s).max(initial=1.0)
        real[coordinates.shape[0] :] /= scale
        right = np.concatenate([coordinates[:, 0], coordinates[:, 1] / scale])
        if not real.size:
            return np.zeros(0, complex)
        found = np.linalg.lstsq(real, right, rcond=None)[0]
        return np.asarray(found[: self.modes.s.size] + 1j * found[self.modes.s.size :])

    def advance(self, state: State, steps: int, every: int) -> Records:
        """Advance a state in place by some steps and record every `every`-th."""
        from rotorgear.solvers.time.kernel_exponential import exponential_loop

        system = self._system
        inner = state.inner
        nz = self.modes.s.size
        nr = self.modes.rigid.shape[1]
        kept = blank_records(steps, every, 0, system)
        r = steps // every
        modal = ModalKept(z=np.zeros((r, 2 * nz)), rigid=np.zeros((r, 2 * nr)), u=np.zeros((r, system.m)))
        done, status, solutions = exponential_loop(
            Span(steps, every, state.step, self.h),
            self._turning,
            self._modal,
            self._rigid,
            self._reference,
            self._laws,
            ModalMotion(inner["yr"], inner["yi"], inner["r0"], inner["r1"], inner["u"]),
            state.carried,
            self._tolerance,
            modal,
            kept,
        )
        count = done // every
        t = (state.step + every * np.arange(1, count + 1)) * self.h
        state.step += done
        fields = ModalFields(self, modal.z[:count], modal.rigid[:count], modal.u[:count])
        if count and count * every == done:
            state.q, state.v, state.a = (fields.last(kind) for kind in "qva")
        return Records(t, kept.d[:count], kept.F[:count], kept.energy[:count], fields, done, status, solutions)

    def projected(self, kind: str, Y: np.ndarray) -> tuple[np.ndarray, ...]:
        """What gives Y q, Y v or Y a from modal coordinates, rigid ones, u and the load."""
        key = (kind, id(Y))
        if key not in self._rows:
            power = "qva".index(kind)
            shapes = Y @ (self.modes.shapes * self.modes.s**power)
            R = Y @ self.modes.rigid
            nothing = np.zeros_like(R)
            rigid = (np.hstack([R, nothing]), np.hstack([nothing, R]), np.hstack([nothing, nothing]))[power]
            mobile = Y @ self._mobile if kind == "a" else np.zeros((Y.shape[0], self._system.m))
            constant = Y @ self._pushed if kind == "a" else np.zeros(Y.shape[0])
            self._rows[key] = (Y, np.hstack([shapes.real, -shapes.imag]).T.copy(), rigid.T, mobile.T, constant)
        return self._rows[key][1:]


@dataclass(frozen=True)
class ModalFields:
    """Recorded modal coordinates, from which any rows of q, v and a follow."""

    stepper: ExponentialStepper
    z: np.ndarray
    rigid: np.ndarray
    u: np.ndarray

    def rows(self, kind: str, Y: np.ndarray) -> np.ndarray:
        """Y q, Y v or Y a at the recorded steps, (r, p); `kind` is "q", "v" or "a"."""
        shapes, rigid, mobile, constant = self.stepper.projected(kind, Y)
        return np.asarray(self.z @ shapes + self.rigid @ rigid + self.u @ mobile + constant)

    def chosen(self, which: np.ndarray) -> ModalFields:
        """Those of some records."""
        return ModalFields(self.stepper, self.z[which], self.rigid[which], self.u[which])

    def last(self, kind: str) -> np.ndarray:
        """q, v or a of the last record, (n,)."""
        modes = self.stepper.modes
        power = "qva".index(kind)
        nz = modes.s.size
        nr = modes.rigid.shape[1]
        z = self.z[-1, :nz] + 1j * self.z[-1, nz:]
        x = np.real(modes.shapes @ (modes.s**power * z))
        if power < 2:
            return np.asarray(x + modes.rigid @ self.rigid[-1, power * nr : (power + 1) * nr])
        return np.asarray(x + self.stepper._mobile @ self.u[-1] + self.stepper._pushed)


def _parts(A: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return np.ascontiguousarray(A.real), np.ascontiguousarray(A.imag)


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
