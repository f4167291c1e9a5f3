"""What an element gives to the assembly: its matrices in its own degrees of freedom, for a batch of equal elements.

Stiffness and damping come as B^T D B, with the strain-displacement matrix B (strains, or relative displacements, from the
degrees of freedom) and the constitutive matrix D. So an upper floor can take energies and powers element by element, as
squares of strains: u^T K u of a stiff model is a small difference of large terms and loses its digits.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class ElementMatrices:
    """Matrices of e elements with d degrees of freedom and s strains each; None is a term that the element doesn't have.

    Attributes:
        strain: strain-displacement matrix B, shape (e, s, d).
        modulus: constitutive matrix D of the symmetric stiffness B^T D B, shape (e, s, s).
        mass: M, shape (e, d, d), symmetric.
        viscosity: constitutive matrix of the damping matrix, shape (e, s, s).
        gyroscopic: gyroscopic matrix G for unit spin of the element's own shaft, shape (e, d, d), skew.
        circulation: constitutive matrix of the non-symmetric part of the stiffness, shape (e, s, s).
        circulation_per_speed: the same for unit spin of the element's own shaft, shape (e, s, s).
        modulus_per_square: what D grows by for unit spin of the element's own shaft, with the square of it, shape (e, s, s).
    """

    strain: np.ndarray | None = None
    modulus: np.ndarray | None = None
    mass: np.ndarray | None = None
    viscosity: np.ndarray | None = None
    gyroscopic: np.ndarray | None = None
    circulation: np.ndarray | None = None
    circulation_per_speed: np.ndarray | None = None
    modulus_per_square: np.ndarray | None = None

    @property
    def stiffness(self) -> np.ndarray | None:
        """Symmetric stiffness, shape (e, d, d); None where the element has none."""
        # Rounding leaves the product slightly unsymmetric; the solvers take K as symmetric.
        K = self._carried(self.modulus)
        return None if K is None else 0.5 * (K + np.swapaxes(K, 1, 2))

    @property
    def damping(self) -> np.ndarray | None:
        """Damping C, shape (e, d, d); None where the element has none."""
        return self._carried(self.viscosity)

    @property
    def circulatory(self) -> np.ndarray | None:
        """Non-symmetric part of the stiffness, shape (e, d, d); None where the element has none."""
        return self._carried(self.circulation)

    @property
    def circulatory_per_speed(self) -> np.ndarray | None:
        """Non-symmetric stiffness for unit spin of the element's own shaft, shape (e, d, d); None where there is none."""
        return self._carried(self.circulation_per_speed)

    def _carried(self, D: np.ndarray | None) -> np.ndarray | None:
        """B^T D B, shape (e, d, d)."""
        if self.strain is None or D is None:
            return None
        return np.asarray(np.swapaxes(self.strain, 1, 2) @ D @ self.strain)
