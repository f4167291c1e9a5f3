"""Lowest modes of an elastic body under constraints, by Lanczos on its static answers (ARPACK, Lehoucq et al. 1998)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

from rotorgear.errors import AnalysisError, ConvergenceError

Columns = Callable[[np.ndarray], np.ndarray]
_TOLERANCE = 1e-10
# More modes no analysis can carry.
_MOST_MODES = 2000
# Beyond this share of its unknowns a mesh has no modes of the body any more.
_MOST_SHARE = 0.25


def lowest_modes(solve: Columns, times_mass: Columns, size: int, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The lowest modes of K x = λ M x.

    Args:
        solve: static answers (n, k) to forces (n, k), that fulfil the constraints; symmetric.
        times_mass: M x.
        size: n.
        count: of modes.

    Returns:
        λ (count,) rising, in (rad/s)^2, and shapes (n, count) of modal mass 1.

    Raises:
        ConvergenceError: the iteration did not end.
    """

    def column(function: Columns) -> LinearOperator:
        return LinearOperator((size, size), matvec=lambda x: function(x.reshape(-1, 1))[:, 0], dtype=float)

    # A start in the space of the constraints, the same each time.
    start = solve(times_mass(np.random.default_rng(3).standard_normal((size, 1))))[:, 0]
    try:
        values, shapes = eigsh(
            column(times_mass),  # not used with sigma = 0 but for its size
            k=count,
            M=column(times_mass),
            sigma=0.0,
            OPinv=column(solve),
            v0=start,
            tol=_TOLERANCE,
        )
    except ArpackNoConvergence as error:
        raise ConvergenceError(f"{len(error.eigenvalues)} of {count} modes of the casing converged.") from None
    order = np.argsort(values)
    return values[order], shapes[:, order]


def modes_up_to(
    solve: Columns, times_mass: Columns, size: int, limit: float | None, usual: int, name: str
) -> tuple[np.ndarray, np.ndarray, float]:
    """Modes below a frequency limit in Hz, or the usual number of them; and the frequency in Hz of the first that is left.

    No more than a quarter of the unknowns: those above are modes of the elements.

    Raises:
        AnalysisError: thousands of modes lie below the limit; `name` is that of the body.
    """
    count = min(usual, max(size - 3, 1))
    most = max(count, min(_MOST_MODES, int(_MOST_SHARE * size)))
    while True:
        values, shapes = lowest_modes(solve, times_mass, size, min(count + 1, size - 2))
        frequency = np.sqrt(np.maximum(values, 0.0)) / (2.0 * np.pi)
        if limit is None:
            return values[:count], shapes[:, :count], float(frequency[-1])
        if frequency[-1] <= limit and count == _MOST_MODES:
            raise AnalysisError(
                f"{name}.modes_to: more than {_MOST_MODES} modes lie below {limit:.6g} Hz, the last of these at "
                f"{frequency[-1]:.4g} Hz; lower modes_to, or the frequencies that are asked for"
            )
        if frequency[-1] > limit or count == most:
            kept = min(int(np.count_nonzero(frequency <= limit)), len(frequency) - 1)
            return values[:kept], shapes[:, :kept], float(frequency[kept])
        # By Weyl's law the number of modes of a solid grows with the cube of the frequency, of a plate linearly.
        count = min(int(count * np.clip((limit / frequency[-1]) ** 1.5 * 1.2, 1.3, 4.0)), most)
