"""The forms of a model over one basis as functions of its scattering numbers.

A number changes the forms of its own parts, so that F(z) = F(0) + sum_j [F_j(z_j) - F(0)] as long as no two numbers meet in one
element, nor in an equilibrium that all of them move. One point shows whether the sum holds, before any interpolation. Each F_j
is interpolated at Chebyshev points, which is exact for the powers 1 (stiffness) to 4 (diameter) in which numbers enter. Three
points show which numbers enter by themselves, the others get all. Sum and interpolation are checked by whole systems at points
of their own; where they do not hold, every sample is assembled.

The basis has modes of the nominal model, and what scattering numbers add to them: to first order phi' = (K - w^2 M)^-1 (-(K' -
w^2 M') phi), so that for all numbers and modes together the leading directions of K_s^-1 (K_j' - w_i^2 M_j') phi_i s_j are
taken, with K_s = K + w_s^2 M. Its error is not estimated within the basis: samples far out are followed to eigenpairs of the
whole system by inverse iteration."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from numpy.typing import NDArray

from rotorgear.analysis.sensitivity.forms import SAME, Floats, FormModes, forms_of, with_shapes
from rotorgear.analysis.static.state_at import linear_system, state_at
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.model.spreads import Spreads
from rotorgear.progress import Progress, silent
from rotorgear.solvers.eigen.eigen import lowest_modes
from rotorgear.system.plan import Plan
from rotorgear.system.system import System

# Points at which each number is looked at: as many as show that it enters linearly, else all.
_FEW = 3
_POINTS = 7
# Trials of the sum, and its largest error that is still rounding beside a basis.
_TRIALS = 3
_SUM_ERROR = 1e-8
# Terms that are rounding are left out.
_NOTHING = 1e-13
# Samples that are asked for again: the outermost ones, and those that show which modes turn into each other.
_KEPT = 96


def sampled_system(spreads: Spreads, z: Floats, speed: float | None, plan: Plan) -> System:
    """The linear system of the model at z (p,) about its equilibrium, with the face maps of the nominal one."""
    model = sample_at(spreads, tuple(map(float, z)))
    return linear_system(model, [speed], plan, beside=state_at(spreads.numbers.model, [speed]))


@lru_cache(maxsize=_KEPT)
def sample_at(spreads: Spreads, z: tuple[float, ...]) -> Model:
    """The model at z (p,), kept with its states: where that is of loaded teeth, it takes longer than all else of a sample."""
    return spreads.at(np.array(z))


# What the numbers add to one form: a sum of k Chebyshev polynomials, each of one number over its reach: number and degree (k,),
# and coefficients (k, r r) of each.
Term = tuple[NDArray[np.intp], NDArray[np.intp], Floats]


@dataclass(frozen=True)
class Family:
    """Forms over one basis at any z.

    Attributes:
        spreads: the numbers.
        speed: of the reference shaft in rad/s; None at standstill.
        plan: the mesh.
        V: the basis over the free dofs (n, r).
        nominal: forms at z = 0 (a, r, r).
        terms: form -> what the numbers add to it, where they change it; None where every sample is assembled.
    """

    spreads: Spreads
    speed: float | None
    plan: Plan
    V: Floats
    nominal: Floats
    terms: dict[int, Term] | None

    def system(self, z: Floats) -> System:
        """The whole system at z (p,).

        Raises:
            AnalysisError: a number moves a place past another one.
        """
        system = sampled_system(self.spreads, z, self.speed, self.plan)
        if system.n != self.V.shape[0]:
            moved = [name for name in self.spreads.numbers.addresses if name.endswith((".at", ".start", ".length"))]
            names = ", ".join(moved)
            raise AnalysisError(
                f"the scatter of {names or 'these numbers'} moves a place past another one that it coincides with, so that the "
                "shafts are cut otherwise: move one of them by more than the scatter, or leave it out"
            )
        return system

    def assembled(self, z: Floats) -> Floats:
        """The forms at z from the whole system."""
        return forms_of(self.system(z), self.speed or 0.0, self.V)

    def at(self, z: Floats) -> Floats:
        """The forms at z (p,), each (r, r)."""
        if self.terms is None:
            return self.assembled(z)
        angle = np.arccos(np.clip(z / self.spreads.reach, -1.0, 1.0))
        T = np.cos(np.multiply.outer(angle, np.arange(_POINTS)))
        found = self.nominal.copy()
        for form, (number, degree, coefficients) in self.terms.items():
            found[form] += (T[number, degree] @ coefficients).reshape(found[form].shape)
        return found


def family_of(spreads: Spreads, speed: float | None, plan: Plan, V: Floats, progress: Progress = silent) -> Family:
    """Return the family over a basis V (n, r)."""
    nominal = forms_of(linear_system(spreads.numbers.model, [speed], plan), speed or 0.0, V)
    bare = Family(spreads, speed, plan, V, nominal, None)
    trials = np.random.default_rng(0).uniform(-0.7, 0.7, (_TRIALS, len(spreads))) * spreads.reach
    if len(spreads) > 1:
        # Whether the change of the forms is the sum of those of each number by itself.
        summed = nominal + sum(bare.assembled(alone) - nominal for alone in np.diag(trials[0]))
        if _error(summed, bare.assembled(trials[0])) >= _SUM_ERROR:
            return bare
    changes = []
    for j in range(len(spreads)):
        progress(j / len(spreads), f"number {j + 1} of {len(spreads)}")
        few = _interpolated(bare, j, _FEW)
        linear = all(len(coefficients) < _FEW for coefficients in few.values())
        changes.append(few if linear else _interpolated(bare, j, _POINTS))
    # The sums of all numbers, form by form.
    terms = {}
    for form in sorted({form for change in changes for form in change}):
        parts = [(j, change[form]) for j, change in enumerate(changes) if form in change]
        number = np.concatenate([np.full(len(c), j) for j, c in parts])
        degree = np.concatenate([np.arange(len(c)) for _, c in parts])
        coefficients = np.concatenate([c.reshape(len(c), -1) for _, c in parts])
        terms[form] = (number, degree, coefficients)
    whole = replace(bare, terms=terms)
    return whole if all(_error(whole.at(z), bare.assembled(z)) < _SUM_ERROR for z in trials) else bare


def _interpolated(bare: Family, j: int, points: int) -> dict[int, Floats]:
    """What number j adds to the forms that it changes: form -> coefficients (k, r, r), k as many as are no rounding."""
    k = np.arange(points)
    angles = np.pi * (k + 0.5) / points
    # c = (2 / n) sum f(x_i) cos(k t_i), half of it for k = 0.
    fit = np.cos(np.outer(k, angles)) * (2.0 / points)
    fit[0] *= 0.5
    seen = []
    for place, x in enumerate(np.cos(angles)):
        z = np.zeros(len(bare.spreads))
        z[j] = bare.spreads.reach[j] * x
        # The middle one of an odd number of points is the nominal model.
        middle = 2 * place + 1 == points
        seen.append(np.zeros_like(bare.nominal) if middle else bare.assembled(z) - bare.nominal)
    found = {}
    for form, nominal in enumerate(bare.nominal):
        change = np.array([forms[form] for forms in seen])
        # Of a symmetric positive form its diagonal is the largest; a skew one has none.
        least = _NOTHING * float(np.abs(nominal).max(initial=0.0))
        if np.abs(change).max(initial=0.0) <= least:
            continue
        coefficients = np.tensordot(fit, change, axes=1)
        large = np.flatnonzero(np.abs(coefficients).max(axis=(1, 2)) > least)
        found[form] = coefficients[: large[-1] + 1]
    return found


def _error(found: Floats, exact: Floats) -> float:
    """Largest error of K, M and W G in units of the energies of the shapes."""
    k, m = (np.sqrt(np.maximum(np.diag(form), 1e-300)) for form in exact[:2])
    # A free motion has no strain energy of its own to be measured by.
    k = np.maximum(k, 1e-6 * float(k.max()))
    sizes = [np.outer(k, k), np.outer(m, m), np.outer(k, m)]
    return float((np.abs(found - exact)[:3] / sizes).max())


# A change of one standard deviation is looked at on both sides.
_SIDE = 1.0
# Directions that carry less than this share of the largest are left out, and never more than this number is taken.
_LEAST = 1e-5
_MOST = 80
_STEPS = 6
# Free motions of one body.
_OF_A_BODY = 6
_CONVERGED = 1e-11


def nominal_modes(system: System, speed: float | None, count: int) -> tuple[Floats, Floats, int]:
    """w^2 (m,), shapes (n, m) of modal mass 1 of the undamped system that does not rotate, and how many are rigid.

    They are `count`, or more where bodies beside each other have more free motions than one.
    """
    strain = system.strain_factor(speed or 0.0)
    K = system.stiffness(speed or 0.0)
    asked = count
    while True:
        found = lowest_modes(system.mass, K, count=asked, strain=strain)
        if found.complete or len(found.eigenvalues) - found.rigid_count >= count - _OF_A_BODY:
            return found.eigenvalues, found.vectors, found.rigid_count
        asked = 2 * asked


def basis_of(spreads: Spreads, speed: float | None, plan: Plan, system: System, values: Floats, X: Floats) -> Floats:
    """The basis (n, r) with nominal modes w^2 (m,), X (n, m) first, orthonormal in M."""
    stiffness = system.stiffness(speed or 0.0)
    forces = []
    for z in _SIDE * np.eye(len(spreads)):
        for sign in (1.0, -1.0):
            other = sampled_system(spreads, sign * z, speed, plan)
            if other.n == system.n:
                K = other.stiffness(speed or 0.0) - stiffness
                M = other.mass - system.mass
                forces.append(sign * (K @ X - (M @ X) * values))
    if speed:
        forces.append(speed * (system.gyroscopic @ X) * np.sqrt(np.maximum(values, 0.0)))
    if not forces:
        return X
    shift = float(np.median(values[values > 0.0])) if np.any(values > 0.0) else 1.0
    shifted = sp.csc_array(stiffness + shift * system.mass)
    from scipy.sparse.linalg import splu

    answers = splu(shifted).solve(np.hstack(forces) / np.tile(values + shift, len(forces)))
    whole = np.linalg.norm(answers, axis=0)
    answers -= X @ (X.T @ (system.mass @ answers))
    # In a model of few dofs its modes hold everything: what is left is rounding.
    answers[:, np.linalg.norm(answers, axis=0) <= SAME * whole] = 0.0
    if not answers.any():
        return X
    # Leading directions in the energy of the shifted system; what is left is the part that a mode hardly takes.
    gram = answers.T @ (shifted @ answers)
    energy, turned = la.eigh(0.5 * (gram + gram.T))
    kept = np.flatnonzero(energy > _LEAST**2 * max(float(energy[-1]), 1e-300))[-_MOST:]
    return with_shapes(system.mass, X, answers @ (turned[:, kept] / np.sqrt(energy[kept])))


def whole_modes(family: Family, z: Floats, modes: FormModes) -> tuple[Floats, NDArray[np.complex128]]:
    """Frequencies (m,) and shapes (n, m) of the whole system at z that the modes of the basis lead to."""
    system = family.system(z)
    speed = family.speed or 0.0
    K = system.stiffness(speed)
    M = system.mass
    W = speed * system.gyroscopic
    X = family.V @ modes.q
    found = [_inverse_iteration(K, M, W, float(w), q) for w, q in zip(modes.omega, X.T.astype(complex), strict=True)]
    return np.array([w for w, _ in found]), np.column_stack([q for _, q in found])


def _inverse_iteration(
    K: sp.csc_array, M: sp.csc_array, W: sp.csc_array, omega: float, q: NDArray[np.complex128]
) -> tuple[float, NDArray[np.complex128]]:
    """The eigenpair of K + s W + s^2 M next to s = i w and q, by Newton's method on both."""
    from scipy.sparse.linalg import splu

    s = 1j * omega
    for _ in range(_STEPS):
        right = W @ q + 2.0 * s * (M @ q)
        try:
            u = splu(sp.csc_array(K + s * W + s**2 * M)).solve(right)
        except RuntimeError:  # exactly singular: s is an eigenvalue
            break
        Mq = M @ q
        change = complex(np.vdot(q, Mq) / np.vdot(Mq, u))
        s = s - change
        q = u / np.sqrt(abs(np.vdot(u, M @ u)))
        if abs(change) <= _CONVERGED * abs(s):
            break
    return float(s.imag), q
