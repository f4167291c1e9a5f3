"""Compiled: the pressure of a cavitating film on a grid of n = rows x columns nodes, whatever the shape of its cells.

    (A p)_k = a_k p_k - b_k p_(k-1) - b_(k+1) p_(k+1) - c_k p_(k-columns) - c_(k+columns) p_(k+columns)

is the discrete -div(h^3 grad p): a on the diagonal, b towards the node before in the same row, c towards that in the row before,
0 where there is none. Cavitation of Swift and Stieber, p >= 0, A p >= push, p (A p - push) = 0, is a linear complementarity
problem, solved exactly by changes of the set of nodes that carry. Murty, Linear Complementarity (1988).
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.time.compiled import compiled

_MOST_CHANGES = 200


@compiled(entry=False)
def factor(A, n, width):  # type: ignore[no-untyped-def]
    """L D L^T of a symmetric band matrix A (n, width + 1), A[k, j] the entry (k, k - j), in place."""
    for k in range(n):
        first = max(0, k - width)
        for j in range(first, k):
            total = A[k, k - j]
            for i in range(max(first, j - width), j):
                total -= A[k, k - i] * A[i, 0] * A[j, j - i]
            A[k, k - j] = total / A[j, 0]
        total = A[k, 0]
        for i in range(first, k):
            total -= A[k, k - i] ** 2 * A[i, 0]
        A[k, 0] = total


@compiled(entry=False)
def solve(A, n, width, b):  # type: ignore[no-untyped-def]
    """Solve with the factors, b (n,) in place."""
    for k in range(n):
        for i in range(max(0, k - width), k):
            b[k] -= A[k, k - i] * b[i]
    for k in range(n):
        b[k] /= A[k, 0]
    for k in range(n - 1, -1, -1):
        for i in range(max(0, k - width), k):
            b[i] -= A[k, k - i] * b[k]


@compiled(entry=False)
def applied(a, b, c, columns, x, out):  # type: ignore[no-untyped-def]
    """Fill out (n,) with A x."""
    n = a.size
    for k in range(n):
        total = a[k] * x[k] - b[k] * x[k - 1] - c[k] * x[k - columns]
        if k + 1 < n:
            total -= b[k + 1] * x[k + 1]
        if k + columns < n:
            total -= c[k + columns] * x[k + columns]
        out[k] = total


@compiled(entry=False)
def carried(a, b, c, columns, push, cut, A, free, p):  # type: ignore[no-untyped-def]
    """Fill the factors A (n, columns + 1), which nodes are free to carry, and p (n,); `cut`: all are, and p has any sign."""
    n = a.size
    left = np.zeros(n)
    free[:] = True
    for _ in range(_MOST_CHANGES):
        A[:] = 0.0
        for k in range(n):
            if not free[k]:
                A[k, 0] = 1.0
                continue
            A[k, 0] = a[k]
            if k > 0 and free[k - 1]:
                A[k, 1] = -b[k]
            if k >= columns and free[k - columns]:
                A[k, columns] += -c[k]
        factor(A, n, columns)
        for k in range(n):
            p[k] = push[k] if free[k] else 0.0
        solve(A, n, columns, p)
        if cut:
            break
        applied(a, b, c, columns, p, left)
        changed = False
        for k in range(n):
            if free[k]:
                if p[k] < 0.0:
                    free[k] = False
                    changed = True
            elif left[k] < push[k]:
                free[k] = True
                changed = True
        if not changed:
            break
