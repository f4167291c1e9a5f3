"""A damped problem of one group of dofs, the rounding of its assembled matrices, and eigenvalues from strains without it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
import scipy.sparse as sp

from rotorgear.solvers.eigen.damped import DampedModes
from rotorgear.solvers.eigen.eigen import UndampedModes
from rotorgear.solvers.eigen.quadratic import corrected
from rotorgear.solvers.sparse.entries import magnitudes
from rotorgear.solvers.sparse.pencil import rounding_noise
from rotorgear.system.assembly import StrainForms


class Lowest(Protocol):
    """The lowest undamped modes: so many, or up to a limit in rad/s, counted by Sturm's sequence or as a basis of others."""

    def __call__(self, count: int | None, below: float | None, counted: bool = True) -> UndampedModes: ...


@dataclass(frozen=True)
class DampedProblem:
    """(s^2 M + s D + K) q = 0 of n dofs, with D = alpha M + spin G + C and what K and C are made of.

    `strain` (p, n) is S with S^T S the symmetric part of K; None where a spring is indefinite. `lowest(count, below)` gives the
    undamped modes; `make_forms` keeps what it made.
    """

    M: sp.csc_array
    D: sp.csc_array
    K: sp.csc_array
    K_symmetric: sp.csc_array
    inertial: sp.csc_array
    strain: sp.csr_array | None
    make_forms: Callable[[], StrainForms]
    lowest: Lowest

    @property
    def forms(self) -> StrainForms:
        """Strains, and what acts on them; made when they are first asked for."""
        return self.make_forms()


def by_strains(problem: DampedProblem, found: DampedModes) -> DampedModes:
    """The modes with eigenvalues from strain energies, which do not carry the rounding of the assembled stiffness."""
    V = found.vectors
    forms = problem.forms
    S = forms.strain @ V

    def form(A: sp.sparray, X: np.ndarray) -> np.ndarray:
        return np.asarray(np.einsum("ij,ij->j", X.conj(), A @ X))

    noise = relative_noise(problem, np.abs(found.eigenvalues), V / np.sqrt(np.real(form(problem.M, V))))
    values = corrected(
        found.eigenvalues,
        np.where(found.rigid, 0.0, noise),
        (
            form(problem.M, V),
            form(problem.inertial, V) + form(forms.viscosity, S),
            form(forms.modulus, S) + form(forms.circulation, S),
        ),
    )
    return replace(found, eigenvalues=values)


def relative_noise(problem: DampedProblem, size: np.ndarray, V: np.ndarray) -> np.ndarray:
    """Rounding that K q and s C q carry, relative to |s|^2 q^H M q, for |s| = size (m,) and M-normal V (n, m)."""
    K = magnitudes(problem.K_symmetric)
    size = np.maximum(size, 1e-150)  # its square is still a number
    return np.asarray(rounding_noise(K, V) / size**2 + damping_noise(problem, size, V))


def damping_noise(problem: DampedProblem, size: np.ndarray, V: np.ndarray) -> np.ndarray:
    """The part of s C q in it, (m,)."""
    C = sp.csc_array(problem.D - problem.inertial)
    return rounding_noise(magnitudes(C), V) / size if C.nnz else np.zeros(V.shape[1])
