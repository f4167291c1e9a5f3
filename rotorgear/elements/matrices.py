"""What an element gives to the assembly: its matrices in its own degrees of freedom, for a batch of equal elements.

Stiffness and damping come as B^T D B, with the strain-displacement matrix B (strains, or relative displacements, from the
degrees of freedom) and the constitutive matrix D. So an upper floor can take energies and powers element by element, as
squares of strains: u^T K u of a stiff model is a small difference of large terms and loses its digits.

Analyses of one model compute the same elements again and again: results of equal data are kept (`kept_by_content`).
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass, fields
from functools import wraps
from typing import Any, Concatenate, ParamSpec, TypeVar

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
        K = self.carried(self.modulus)
        return None if K is None else 0.5 * (K + np.swapaxes(K, 1, 2))

    @property
    def damping(self) -> np.ndarray | None:
        """Damping C, shape (e, d, d); None where the element has none."""
        return self.carried(self.viscosity)

    @property
    def circulatory(self) -> np.ndarray | None:
        """Non-symmetric part of the stiffness, shape (e, d, d); None where the element has none."""
        return self.carried(self.circulation)

    @property
    def circulatory_per_speed(self) -> np.ndarray | None:
        """Non-symmetric stiffness for unit spin of the element's own shaft, shape (e, d, d); None where there is none."""
        return self.carried(self.circulation_per_speed)

    def carried(self, D: np.ndarray | None) -> np.ndarray | None:
        """B^T D B, shape (e, d, d), for D (e, s, s); None where there is no B or D."""
        if self.strain is None or D is None:
            return None
        return np.asarray(np.swapaxes(self.strain, 1, 2) @ D @ self.strain)


Record = TypeVar("Record")
Result = TypeVar("Result")
Others = ParamSpec("Others")


def kept_by_content(
    rows: int, results: int
) -> Callable[
    [Callable[Concatenate[Record, Others], Result]],
    Callable[Concatenate[Record, Others], Result],
]:
    """A decorator of compute(record, ...), whose argument and result are dataclasses of arrays: equal records are computed once.

    The arrays of a kept result are read-only, because several callers share them.

    Args:
        rows: records with more rows than this are computed each time, and not kept.
        results: number of results that are kept, the latest ones.
    """

    def decorated(
        compute: Callable[Concatenate[Record, Others], Result],
    ) -> Callable[Concatenate[Record, Others], Result]:
        known: dict[Hashable, Result] = {}

        @wraps(compute)
        def kept(record: Record, *args: Others.args, **options: Others.kwargs) -> Result:
            arrays = _arrays(record)
            if max(len(array) for array in arrays) > rows:
                return compute(record, *args, **options)
            content = tuple((array.dtype.str, array.shape, array.tobytes()) for array in arrays)
            request = (type(record), content, args, tuple(sorted(options.items())))
            if request in known:
                result = known.pop(request)
            else:
                result = compute(record, *args, **options)
                for array in _arrays(result):
                    array.setflags(write=False)
            known[request] = result  # the latest one last
            if len(known) > results:
                known.pop(next(iter(known)))
            return result

        return kept

    return decorated


def _arrays(record: Any) -> list[np.ndarray]:
    """The fields of a record that are arrays."""
    values = [getattr(record, item.name) for item in fields(record)]
    return [value for value in values if isinstance(value, np.ndarray)]
