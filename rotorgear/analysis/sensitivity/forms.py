"""Energies of a system as quadratic forms over a few shapes, the modes that follow from them, and what excites these.

With shapes V (all dofs) every form is V^T A V, summed element by element; stiffness from strains, so that nothing cancels. K and
M are symmetric, W G is skew. With the modes T of K and M (T^T M T = 1, T^T K T = L) and g = T^T W G T, the states y = (L^(1/2)
a, i w a) obey

    w y = [0  -i L^(1/2); i L^(1/2)  i g] y,

which is Hermitian: frequencies are real, vectors orthonormal in the energy, and the problem is regular where frequencies meet
(Meirovitch 1974, A new method of solution of the eigenvalue problem for gyroscopic systems, AIAA Journal 12). Without
rotation y has two equal halves and a is real.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from numpy.typing import NDArray

from rotorgear.model.model import Model
from rotorgear.results.campbell import ExcitationOrder
from rotorgear.solvers.eigen.reduced_pencil import largest_pairs
from rotorgear.solvers.sparse.entries import times
from rotorgear.system.system import System

Floats: TypeAlias = NDArray[np.float64]
# Shapes of modes in columns, complex where the system rotates.
Shapes: TypeAlias = NDArray[np.complex128] | Floats

# What is left of a shape beside others below this share is rounding.
SAME = 1e-7


@dataclass(frozen=True)
class FormNames:
    """Number of each form: the first three are K, M and the skew W G; then one for each mesh, and three for each shaft.

    `senses` has the sense of each shaft's spin about +z, 0 at rest.
    """

    meshes: tuple[str, ...]
    senses: dict[str, float]

    @classmethod
    def of(cls, model: Model, speed: float | None) -> FormNames:
        """Those of a model at a speed of the reference shaft."""
        ratio = model.layout.train.ratio
        return cls(tuple(model.meshes), {name: float(np.sign(ratio(name) * (speed or 0.0))) for name in model.shafts})

    @property
    def shafts(self) -> tuple[str, ...]:
        """Names of the shafts."""
        return tuple(self.senses)

    def __len__(self) -> int:
        return 3 + len(self.meshes) + 3 * len(self.shafts)

    def mesh(self, name: str) -> int:
        """Twice the strain energy of a mesh."""
        return 3 + self.meshes.index(name)

    def kinetic(self, shaft: str) -> int:
        """Kinetic energy of a shaft and what is on it, over that of unit velocities: its mass matrix."""
        return 3 + len(self.meshes) + 3 * self.shafts.index(shaft)

    def bending(self, shaft: str) -> int:
        """The same of its bending alone."""
        return self.kinetic(shaft) + 1

    def swept(self, shaft: str) -> int:
        """M J of its bending, skew, J (x, y) = (y, -x): i q^H M J q is the area swept about +z."""
        return self.kinetic(shaft) + 2

    def participations(self, lines: tuple[ExcitationOrder, ...], forms: Floats, modes: FormModes) -> Floats:
        """Share of what a line shakes in each mode, (l, m).

        Meshes in the strain energy; shafts in the kinetic energy, of their first order (unbalance) the forward whirl of bending:
        q^H (M + i sign(W) M J) q / 2, half of it where nothing turns.
        """
        found = np.zeros((len(lines), len(modes.omega)))
        sizes: dict[bool, Floats] = {}
        for row, line in enumerate(lines):
            part, whole = self.exciting(line, forms)
            # Kinetic energies of all shaft orders, strain energies of all mesh orders are the same.
            of_shafts = line.kind == "shaft"
            if of_shafts not in sizes:
                sizes[of_shafts] = diagonal(whole, modes.q)
            found[row] = diagonal(part, modes.q) / sizes[of_shafts]
        return found

    def exciting(self, line: ExcitationOrder, forms: Shapes) -> tuple[Shapes, Shapes]:
        """Hermitian forms (r, r) of what a line shakes and of the whole: their ratio in a mode is its participation."""
        K, M = forms[:2]
        if line.kind != "shaft":
            return np.sum([forms[self.mesh(part)] for part in line.parts], axis=0), K
        if not line.name.endswith(" 1x"):
            return np.sum([forms[self.kinetic(part)] for part in line.parts], axis=0), M
        bending = np.sum([forms[self.bending(part)] for part in line.parts], axis=0)
        swept = np.sum([self.senses[part] * forms[self.swept(part)] for part in line.parts], axis=0)
        return 0.5 * (bending + 1j * swept), M


def forms_of(system: System, speed: float, V: Floats) -> Floats:
    """Return all forms (a, r, r) over shapes V (n, r) of the free dofs at a reference speed in rad/s."""
    names = FormNames.of(system.model, speed)
    q = np.asarray(system.dofs.expand(V))
    # J q: (y, -x) in place of (x, y) of every node, tilts the same; what bends inside an element sweeps nothing by itself.
    turned = np.zeros_like(q)
    for first in (0, 3):
        x = np.arange(len(system.nodes)) * 6 + first
        turned[x] = q[x + 1]
        turned[x + 1] = -q[x]
    found = np.zeros((len(names), V.shape[1], V.shape[1]))
    stiffness, mass, gyroscopic = found[:3]
    for group in system.groups_at(speed):
        m = group.matrices
        local = q[group.dofs]  # (e, d, r)
        if m.strain is not None and m.modulus is not None:
            strains = m.strain @ local
            K = _summed(strains, m.modulus @ strains)
            stiffness += K
            table, _, name = group.part.partition(".")
            if table == "meshes":
                found[names.mesh(name)] += K
        if m.gyroscopic is not None and group.spin and speed:
            gyroscopic += speed * group.spin * _summed(local, m.gyroscopic @ local)
        if m.mass is not None:
            M = _summed(local, m.mass @ local)
            mass += M
            if group.shaft in names.shafts:
                found[names.kinetic(group.shaft)] += M
                bends = np.array([motion == "bending" for motion in group.dof_motions])
                own = m.mass[:, bends][:, :, bends]
                found[names.bending(group.shaft)] += _summed(local[:, bends], own @ local[:, bends])
                swept = _summed(local[:, bends], own @ turned[group.dofs][:, bends])
                found[names.swept(group.shaft)] += 0.5 * (swept - swept.T)
    return found


def _summed(left: Floats, right: Floats) -> Floats:
    """Sum over elements e of left_e^T right_e, (e, d, r) each."""
    r = left.shape[-1]
    return np.asarray(left.reshape(-1, r).T @ right.reshape(-1, r))


@dataclass(frozen=True)
class FormModes:
    """m elastic modes in coordinates of a basis of r shapes.

    Attributes:
        omega: natural frequencies in rad/s (m,), ascending.
        q: shapes (r, m), complex where the system rotates; q^H (K + w^2 M) q / 2 = w^2, so that modal mass is 1 at standstill.
    """

    omega: Floats
    q: Shapes


def modes_of(forms: Floats, count: int, least: float, wide: int) -> FormModes:
    """Return `count` elastic modes.

    Args:
        forms: (a, r, r), the first three K, M and W G.
        count: how many.
        least: frequency in rad/s below which a motion is rigid.
        wide: number of modes of K and M, which carry those of a rotating system.
    """
    K, M, G = forms[:3]
    r = len(K)
    # All modes of so small a problem by divide and conquer cost half of what the lowest cost one by one.
    values, T = la.eigh(0.5 * (K + K.T), 0.5 * (M + M.T), driver="gvd", check_finite=False)
    last = min(r, wide)
    values = values[:last]
    T = T[:, :last]
    elastic = values > least**2
    values = values[elastic]
    T = T[:, elastic]
    if not G.any():
        return FormModes(np.sqrt(values[:count]), T[:, :count])
    root = np.sqrt(values)
    g = T.T @ G @ T
    g = 0.5 * (g - g.T)
    # The matrix is i A with a real skew A = [0  -L^(1/2); L^(1/2)  g], whose inverse B = [b g b  b; -b  0], b = L^(-1/2), needs
    # no solution.
    m = len(root)
    b = np.diag(1.0 / root)
    inverse, y = largest_pairs(np.block([[b @ g @ b, b], [-b, np.zeros((m, m))]]), min(count, m))
    omega = 1.0 / inverse
    # y = (L^(1/2) a, i w a) has length 1 where a^H (L + w^2) a = 1: to modal mass 1.
    a = y[:m] / root[:, None] * (np.sqrt(2.0) * omega)
    return FormModes(omega, times(T, a))


def overlaps(K: Floats, M: Floats, first: FormModes, second: FormModes) -> Shapes:
    """Products of modes in the energy of K and M, (m, m'): 1 in size where they are the same mode, each of length 1."""

    def energy(modes: FormModes, Kq: Shapes, wMq: Shapes) -> Floats:
        return np.asarray(0.5 * np.sum(np.real(modes.q.conj() * (Kq + wMq * modes.omega)), axis=0))

    K_second = times(K, second.q)
    M_second = times(M, second.q) * second.omega
    one = energy(first, times(K, first.q), times(M, first.q) * first.omega)
    conjugate = first.q.conj().T
    common: Shapes = np.matmul(conjugate, K_second) + first.omega[:, None] * np.matmul(conjugate, M_second)
    common /= 2.0 * np.sqrt(np.outer(one, energy(second, K_second, M_second)))
    return common


def diagonal(form: Shapes, Q: Shapes) -> Floats:
    """q^H A q of the columns of Q (r, m), A Hermitian."""
    product = form @ Q if np.iscomplexobj(form) else times(np.real(form), Q)
    return np.real(np.sum(Q.conj() * product, axis=0))


def with_shapes(M: sp.csc_array, V: Floats, more: Floats, same: float = SAME) -> Floats:
    """V (n, r) with further shapes, all orthonormal in M; of which V has all but a share `same` fall away."""

    def sizes(X: Floats) -> Floats:
        return np.sqrt(np.maximum(np.einsum("ij,ij->j", X, M @ X), 0.0))

    before = sizes(more)
    for _ in range(2):
        more = more - V @ (V.T @ (M @ more))
    after = sizes(more)
    fresh = after > same * before
    more = more[:, fresh] / after[fresh]
    if not more.shape[1]:
        return V
    values, turned = la.eigh(more.T @ (M @ more))
    kept = values > 1e-10 * values[-1]
    more = more @ (turned[:, kept] / np.sqrt(values[kept]))
    return np.hstack([V, more - V @ (V.T @ (M @ more))])


def complex_forms(forms: Floats) -> NDArray[np.complex128]:
    """Forms (a, k, k) among complex shapes from those over their real parts, then their imaginary ones (a, 2 k, 2 k)."""
    k = forms.shape[1] // 2
    C = np.vstack([np.eye(k), 1j * np.eye(k)])
    return np.asarray(C.conj().T @ forms @ C)


def coupling(change: Shapes, omega: Floats) -> NDArray[np.complex128]:
    """Change of some frequencies (k,) as a matrix among their modes (k, k), in rad/s, from changes of K, M and W G over these.

    H_ab = phi_a^H (K' - w_a w_b M' + i (w_a + w_b) / 2 (W G)') phi_b / (2 sqrt(w_a w_b)): slopes of frequencies on its diagonal,
    and the slopes of modes that meet are its eigenvalues among them.
    """
    K, M, G = change
    product = np.outer(omega, omega)
    return np.asarray((K - product * M + 0.5j * np.add.outer(omega, omega) * G) / (2.0 * np.sqrt(product)))
