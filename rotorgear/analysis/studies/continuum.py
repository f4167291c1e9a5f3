"""Shafts as continua: the exact dynamic stiffness of Timoshenko's equations, a reference that has no shape functions.

The dependence on time is e^{st}. In one plane, with deflection w, slope θ, moment M, shear force V, and for the circular
coordinates x ± iy of a shaft that turns at W, in which the planes part,

    w' = θ + V/(κGA a),  θ' = M/(EI a),  V' = ρA (s² + αs) w,  M' = -V + ρI (s² + αs ∓ 2iWs) θ,  a = 1 + βs + η(s ∓ iW)

with Rayleigh's α and β and internal damping η. Axial motion and torsion are rods. The equations along a piece are integrated
from end to end, by a matrix exponential or, where it tapers, by collocation, and the transfer matrix turned into a stiffness of
both ends. All other parts of the model keep their matrices, and the assembly is that of the elements.

Wittrick and Williams, Q. J. Mech. Appl. Math. 24 (1971) 263: in an undamped model as many frequencies lie below w as the
dynamic stiffness at w has negative eigenvalues, where no piece that is held at both ends has one of its own.
"""

from __future__ import annotations

import warnings
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
import scipy.linalg as la

from rotorgear.analysis.response.plant import Plant
from rotorgear.elements.matrices import ElementMatrices
from rotorgear.elements.shaft_section import ShaftElements, gauss, is_uniform, section
from rotorgear.errors import ConvergenceError
from rotorgear.model.parts.operation import ModelDamping
from rotorgear.system.assembly import assemble
from rotorgear.system.groups import ElementGroup, alike, element_data
from rotorgear.system.plan import Plan
from rotorgear.system.system import System

# Gauss points along a piece that tapers.
_POINTS = 24
_ROUNDS = 12
_PIECES = (1, 2, 4, 8, 16)
# Newton's method has found a root when it moves by less than this share.
_FOUND = 1e-12
# Below this, a step that is no smaller than the last one is rounding.
_NEAR = 1e-8
# Relative step of the difference that stands for the derivative: it sets how fast the root is found, not where.
_STEP = 1e-6
# Shares by which the search starts beside a known eigenvalue, which it must not take for the answer; one after the other until
# the root that is found is that eigenvalue's.
_ASIDES = (1e-6, -1e-6, 1e-8)
# Below this share two roots are one.
_SAME = 1e-12


class Continuum:
    """A system whose shafts are continua between its nodes.

    Args:
        system: with one basic element in a piece, whose state serves.
        speed: of the reference shaft in rad/s; None: at standstill, without damping.
        highest: frequency in rad/s; where that can be, segments are cut so short that no piece which is held at both ends has one
            of its own below: the stiffness has no pole there.
    """

    def __init__(self, system: System, at: float | None, highest: float = 0.0) -> None:
        self.speed = speed = at or 0.0
        self.damped = at is not None
        self.rounding = 0.0  # largest relative last step of roots
        for elements in _PIECES:
            self.system = system.with_plan(Plan(elements))
            if self._lowest > highest:
                break
        self._given = system.model.damping if self.damped else ModelDamping()
        own = [group for group in self.system.groups_at(speed) if not _strains(group)]
        dofs = self.system.dofs

        def summed(term: object) -> np.ndarray:
            return np.asarray(assemble(own, dofs, term).toarray())  # type: ignore[arg-type]

        self._M = summed(lambda g: g.matrices.mass)
        K = summed(lambda g: g.matrices.stiffness)
        C = summed(lambda g: g.matrices.damping) + self._given.rayleigh_alpha * self._M + self._given.rayleigh_beta * K
        turning = summed(lambda g: None if g.matrices.gyroscopic is None else g.spin * g.matrices.gyroscopic)
        self._C = C + speed * turning if self.damped else 0.0 * C
        # Cross-coupling of bearings is there at standstill, too, where nothing else takes energy out or brings it in.
        self._K = K + summed(lambda g: g.circulatory_at(speed))

    @property
    def _lowest(self) -> float:
        """A frequency in rad/s below those of all held pieces."""
        return min((float(held_frequency(data).min()) for _, data, _ in self._pieces), default=np.inf)

    @property
    def _pieces(self) -> list[tuple[ElementGroup, ShaftElements, float]]:
        """Groups of elastic pieces, their sizes, and the internal damping of their shaft."""
        model = self.system.model
        nodes = self.system.nodes
        train = self.system.train
        return [
            (
                ElementGroup(f"shafts.{name}", name, ElementMatrices(), dofs, train.ratio(name)),
                element_data(model, name, elements),
                model.shafts[name].internal_damping if self.damped else 0.0,
            )
            for name in model.shafts
            for rigid, _, elements, dofs in alike(model, nodes, name)
            if not rigid
        ]

    def stiffness(self, s: complex) -> np.ndarray:
        """Dynamic stiffness D(s), (n, n) complex."""
        groups = []
        matrices = []
        for group, data, eta in self._pieces:
            groups.append(group)
            matrices.append(piece_stiffness(data, s, group.spin * self.speed, self._given, eta))
        parts = []
        for take in (np.real, np.imag):  # the assembly is of real matrices
            by_group = {id(g): take(m) for g, m in zip(groups, matrices, strict=True)}
            parts.append(assemble(groups, self.system.dofs, lambda g: by_group[id(g)]).toarray())  # noqa: B023
        return np.asarray(parts[0] + 1j * parts[1] + s * s * self._M + s * self._C + self._K)

    def solve(self, w: float, f: np.ndarray) -> np.ndarray:
        """Displacements (n, p) for forces (n, p) at a frequency in rad/s."""
        return np.asarray(la.solve(self.stiffness(1j * w), f))

    def relative_residual(self, w: object, f: object, q: object) -> float:
        """What a dense solution leaves is rounding."""
        return 0.0

    def root(self, s: complex) -> complex:
        """The eigenvalue next to s, by inverse iteration on both sides: s moves by u^T D v / u^T D' v until rounding stops it.

        Raises:
            ConvergenceError: there is none near.
        """
        right = left = np.cos(np.arange(1.0, self.system.n + 1.0)).astype(complex)
        before = np.inf
        for _ in range(_ROUNDS):
            D = self.stiffness(s)
            slope = (self.stiffness(s * (1.0 + _STEP)) - D) / (_STEP * s)
            with warnings.catch_warnings(), np.errstate(invalid="ignore"):
                warnings.simplefilter("ignore", la.LinAlgWarning)
                factor = la.lu_factor(D)
                ends = [la.lu_solve(factor, right), la.lu_solve(factor, left, trans=1)]
            if not np.all(np.isfinite(ends)):  # singular to the last digit
                return s
            right, left = (v / np.linalg.norm(v) for v in ends)
            step = complex((left @ D @ right) / (left @ slope @ right))
            size = abs(step) / abs(s)
            if size <= _FOUND or _NEAR > before <= size:
                self.rounding = max(self.rounding, min(size, before))
                return s if size > before else s - step
            s = s - step
            before = size
        raise ConvergenceError(f"no eigenvalue of the dynamic stiffness was found next to {s:.6g}")

    def roots(self, near: np.ndarray) -> np.ndarray:
        """The eigenvalues next to those of a fine mesh (m,), each to one of them.

        Raises:
            ConvergenceError: there is none that is nearer to it than to another.
        """
        return np.array([self._root_of(k, near) for k in range(len(near))])

    def _root_of(self, k: int, near: np.ndarray) -> complex:
        why = ""
        for aside in _ASIDES:
            try:
                root = self.root(complex(near[k]) * (1.0 + aside))
            except ConvergenceError as error:
                why = str(error)
                continue
            away = np.abs(root - near)
            # Of a pair that differs by rounding either will do.
            if away[k] <= 2.0 * away.min() + _SAME * abs(near[k]):
                return root
            why = (
                f"the eigenvalue of the dynamic stiffness that was found next to {near[k]:.6g} is that of another mode"
            )
        raise ConvergenceError(why)

    def count_below(self, w: float) -> int | None:
        """How many frequencies of an undamped model lie below w in rad/s; None where that can't be told."""
        D = self.stiffness(1j * w)
        hermitian = np.abs(D - D.conj().T).max(initial=0.0) <= 1e-9 * np.abs(D).max(initial=0.0)
        if self._lowest <= w or not hermitian:
            return None
        scale = 1.0 / np.sqrt(np.maximum(np.abs(np.diag(D)), np.finfo(float).tiny))
        return int(np.count_nonzero(la.eigvalsh(scale[:, None] * D * scale) < 0.0))


def _strains(group: ElementGroup) -> bool:
    """Whether a group is of elastic pieces of a shaft."""
    return group.part.startswith("shafts.") and group.matrices.modulus is not None


def piece_stiffness(data: ShaftElements, s: complex, spin: float, given: ModelDamping, eta: float) -> np.ndarray:
    """Dynamic stiffness of e pieces in the order of the basic element's dofs, (e, 12, 12), at a spin in rad/s."""
    square = s * s + given.rayleigh_alpha * s
    loss = 1.0 + (given.rayleigh_beta + eta) * s
    data, which = data.unique()  # each kind once
    found = np.zeros((len(data.length), 12, 12), complex)
    # Circular coordinates u± = x ± iy, θ± = θy ∓ iθx of both ends.
    for sign in (1.0, -1.0):
        to = np.zeros((4, 12), complex)
        for end in (0, 1):
            to[2 * end, 6 * end : 6 * end + 2] = 1.0, 1j * sign
            to[2 * end + 1, 6 * end + 3 : 6 * end + 5] = -1j * sign, 1.0
        D = _two_ends(data, square, square - 2j * sign * spin * s, loss - 1j * sign * eta * spin)
        found += 0.5 * to.conj().T @ D @ to
    for rod, dof in (("axial", 2), ("torsion", 5)):
        found[:, dof::6, dof::6] += _two_ends(data, square, square, loss, rod)
    return found[which]


def _two_ends(data: ShaftElements, square: complex, tilting: complex, loss: complex, rod: str = "") -> np.ndarray:
    """Stiffness of both ends in one plane of bending (e, 4, 4), or of a rod (e, 2, 2), by the transfer matrix."""
    L = data.length
    E = data.youngs_modulus
    G = data.shear_modulus
    rho = data.density

    def slope_of(place: float) -> np.ndarray:
        """Matrix A (e, k, k) of z' = A z at a share of the length."""
        at = np.array([place])
        area, inertia, ratio = (x[:, 0] for x in section(data.stiffness_diameters, at))
        mass, rotary, _ = (x[:, 0] for x in section(data.mass_diameters, at))
        A = np.zeros((len(L), 2, 2) if rod else (len(L), 4, 4), complex)
        if rod:
            A[:, 0, 1] = 1.0 / (loss * (E * area if rod == "axial" else 2.0 * G * inertia))
            A[:, 1, 0] = rho * square * (mass if rod == "axial" else 2.0 * rotary)
            return A
        kappa = data.kappa(ratio[:, None])[:, 0]
        A[:, 0, 1] = 1.0
        A[:, 0, 2] = 1.0 / kappa / (loss * G * area)  # 0 without shear deformation, whose kappa is infinite
        A[:, 1, 3] = 1.0 / (loss * E * inertia)
        A[:, 2, 0] = rho * mass * square
        A[:, 3, 1] = rho * rotary * tilting
        A[:, 3, 2] = -1.0
        return A

    half = 1 if rod else 2
    # Forces in units of the piece's own stiffness, so that the numbers are near 1.
    unit = np.ones((len(L), 2 * half))
    area, inertia, _ = (x[:, 0] for x in section(data.stiffness_diameters, np.array([0.5])))
    if rod:
        unit[:, 1] = (E * area if rod == "axial" else 2.0 * G * inertia) / L
    else:
        unit[:, 1] = 1.0 / L
        unit[:, 2] = E * inertia / L**3
        unit[:, 3] = E * inertia / L**2

    def scaled(place: float) -> np.ndarray:
        return np.asarray(L[:, None, None] * slope_of(place) * unit[:, None, :] / unit[:, :, None])

    if is_uniform(data):
        T = la.expm(scaled(0.5))
    else:
        # z_i = z_0 + L sum_j S_ij A_j z_j at Gauss points, which is of order twice their number.
        points, weights, cumulative = gauss(_POINTS)
        A = np.stack([scaled(place) for place in points], axis=1)
        k = 2 * half
        coupled = np.einsum("ij,ejab->eiajb", cumulative, A).reshape(len(L), k * _POINTS, k * _POINTS)
        z = np.linalg.solve(np.eye(k * _POINTS) - coupled, np.tile(np.eye(k), (_POINTS, 1))).reshape(
            len(L), _POINTS, k, k
        )
        T = np.eye(k) + np.einsum("j,ejab,ejbc->eac", weights, A, z)
    # Motions and forces of the right end by those of the left one, T = [a b; c d].
    a = T[:, :half, :half]
    b = T[:, :half, half:]
    c = T[:, half:, :half]
    d = T[:, half:, half:]
    inverse = np.linalg.inv(b)
    D = np.block([[inverse @ a, -inverse], [c - d @ inverse @ a, d @ inverse]])
    # Forces (V, M) on the ends do work on (w, θ): those on the left end are minus those inside.
    force = np.concatenate([unit[:, half:]] * 2, axis=1)
    motion = np.concatenate([unit[:, :half]] * 2, axis=1)
    return np.asarray(D * force[:, :, None] / motion[:, None, :])


def held_frequency(data: ShaftElements) -> np.ndarray:
    """A frequency in rad/s below the lowest of each piece that is held at both ends, (e,), by Dunkerley's formula."""
    places = np.linspace(0.0, 1.0, 9)
    area, inertia, ratio = section(data.stiffness_diameters, places)
    mass, rotary, _ = section(data.mass_diameters, places)
    kappa = np.minimum(data.kappa(ratio), 1.0)
    rho = data.density
    L = data.length
    shear = np.pi / L * np.sqrt(data.shear_modulus * (kappa * area).min(axis=1) / (rho * mass.max(axis=1)))
    bend = 22.37 / L**2 * np.sqrt(data.youngs_modulus * inertia.min(axis=1) / (rho * mass.max(axis=1)))
    tilt = 2.0 * np.pi / L * np.sqrt(data.youngs_modulus * inertia.min(axis=1) / (rho * rotary.max(axis=1)))
    twist = np.pi / L * np.sqrt(data.shear_modulus * inertia.min(axis=1) / (rho * rotary.max(axis=1)))
    both = 1.0 / np.sqrt(1.0 / shear**2 + 1.0 / bend**2 + 1.0 / tilt**2)
    return np.asarray(0.5 * np.minimum(both, twist))


class ContinuumSystem(System):
    """A system whose elastic pieces have the stiffness and the inertia forces of continua at rest, for statics."""

    @cached_property
    def groups(self) -> list[ElementGroup]:
        """Element groups, with matrices from the equations along the pieces in place of shape functions."""
        model = self.model
        replaced = []
        shafts = {name: [item for item in alike(model, self.nodes, name) if not item[0]] for name in model.shafts}
        for group in System.groups.func(self):  # type: ignore[attr-defined]
            if _strains(group):
                _, _, elements, _ = next(x for x in shafts[group.shaft] if np.array_equal(x[3], group.dofs))
                data = element_data(model, group.shaft, elements)
                K = np.real(piece_stiffness(data, 0.0, 0.0, ModelDamping(), 0.0))
                # D is real and analytic in s²: its derivative there is the imaginary part of a small imaginary step.
                step = 1e-30 * held_frequency(data).min() ** 2
                M = np.imag(piece_stiffness(data, np.sqrt(1j * step), 0.0, ModelDamping(), 0.0)) / step
                B = group.matrices.strain
                assert B is not None
                back = np.linalg.pinv(B)
                modulus = np.swapaxes(back, 1, 2) @ K @ back
                group = replace(group, matrices=replace(group.matrices, modulus=modulus, mass=M))
            replaced.append(group)
        return replaced


class ContinuumPlant(Plant):
    """A plant whose dynamic stiffness is that of continuous shafts."""

    def dynamics(self, speed: float) -> Any:
        """What solves at a reference speed in rad/s."""
        return Continuum(self.system, speed)
