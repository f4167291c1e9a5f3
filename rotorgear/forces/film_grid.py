"""Compiled: the pressure of a cavitating film on a grid of n = rows x columns nodes, whatever the shape of its cells.

    (A p)_k = a_k p_k - b_k p_(k-1) - b_(k+1) p_(k+1) - c_k p_(k-columns) - c_(k+columns) p_(k+columns)

is the discrete -div(h^3 grad p): a on the diagonal, b towards the node before in the same row, c towards that in the row before,
0 where there is none. Cavitation of Swift and Stieber, p >= 0, A p >= source, p (A p - source) = 0, is a linear complementarity
problem, solved exactly by changes of the set of nodes that carry, from that of the problem with one unknown a row on: it ends as
any guess does, after a few factorisations in place of up to twenty. Murty, Linear Complementarity (1988).
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.time.compiled import compiled

_MOST_CHANGES = 200


@compiled(entry=False)
def factor(A, free, begin, width):  # type: ignore[no-untyped-def]
    """L D L^T of a symmetric band matrix A (n, width + 1), A[k, j] the entry (k, k - j), in place from the row `begin` on.

    Rows that are not `free` (n,) have nothing beside their diagonal.
    """
    for k in range(begin, free.size):
        if not free[k]:
            continue
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
def assemble(a, b, c, columns, free, begin, A):  # type: ignore[no-untyped-def]
    """Fill A (n, columns + 1) from the row `begin` on; the row of a node that does not carry is that of the identity."""
    for k in range(begin, a.size):
        A[k] = 0.0
        if not free[k]:
            A[k, 0] = 1.0
            continue
        A[k, 0] = a[k]
        if k > 0 and free[k - 1]:
            A[k, 1] = -b[k]
        if k >= columns and free[k - columns]:
            A[k, columns] += -c[k]


@compiled(entry=False)
def complementary(a, b, c, columns, source, A, free, p):  # type: ignore[no-untyped-def]
    """Fill the factors A (n, columns + 1) and p (n,), and change the guess `free` (n,) until it is right."""
    n = a.size
    left = np.zeros(n)
    begin = 0
    for _ in range(_MOST_CHANGES):
        assemble(a, b, c, columns, free, begin, A)
        factor(A, free, begin, columns)
        for k in range(n):
            p[k] = source[k] if free[k] else 0.0
        solve(A, n, columns, p)
        applied(a, b, c, columns, p, left)
        begin = n
        for k in range(n):
            if (free[k] and p[k] < 0.0) or (not free[k] and left[k] < source[k]):
                free[k] = not free[k]
                begin = min(begin, k)
        if begin == n:
            break


@compiled(entry=False)
def rows_that_carry(a, b, c, columns, source, free):  # type: ignore[no-untyped-def]
    """Guess which nodes are free to carry: the rows that do where all have one profile, that of a middle row alone."""
    rows = a.size // columns
    middle = rows // 2 * columns
    A = np.zeros((columns, 2))
    profile = np.ones(columns)
    for j in range(columns):
        k = middle + j
        A[j, 0] = a[k] - c[k] - (c[k + columns] if k + columns < a.size else 0.0)
        A[j, 1] = -b[k]
    factor(A, np.ones(columns, dtype=np.bool_), 0, 1)
    solve(A, columns, 1, profile)
    row_a = np.zeros(rows)
    row_c = np.zeros(rows)
    row_source = np.zeros(rows)
    for i in range(rows):
        for j in range(columns):
            k = i * columns + j
            row_a[i] += profile[j] * (a[k] * profile[j] - 2.0 * b[k] * profile[j - 1])
            row_c[i] += profile[j] ** 2 * c[k]
            row_source[i] += profile[j] * source[k]
    row_free = np.ones(rows, dtype=np.bool_)
    complementary(row_a, np.zeros(rows), row_c, 1, row_source, np.zeros((rows, 2)), row_free, np.zeros(rows))
    for k in range(a.size):
        free[k] = row_free[k // columns]


@compiled(entry=False)
def carried(a, b, c, columns, source, cut, A, free, p):  # type: ignore[no-untyped-def]
    """Fill the factors A (n, columns + 1), which nodes are free to carry, and p (n,); `cut`: all are, and p has any sign."""
    free[:] = True
    if cut:
        assemble(a, b, c, columns, free, 0, A)
        factor(A, free, 0, columns)
        p[:] = source
        solve(A, a.size, columns, p)
    else:
        rows_that_carry(a, b, c, columns, source, free)
        complementary(a, b, c, columns, source, A, free, p)
