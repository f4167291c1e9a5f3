"""Reynolds' equation by bilinear elements on a pad, an independent reference for the finite volumes of the package.

    int h^3/(12 mu) (w_t p_t q_t + w_s p_s q_s) dt ds = -int area (omega/2 h_t + h_time) q dt ds,   p >= 0

On a journal s is z, w_t = 1/R, w_s = R, area = R; on a sector s is r, w_t = 1/r, w_s = r, area = r. Two Gauss points each way;
the complementarity by a primal-dual active set, from all nodes free. There are no tangents: K and C are difference quotients.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve

Field = Callable[[np.ndarray, np.ndarray], np.ndarray]
_GAUSS = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3.0)


class Pad:
    """A grid of (n, m) elements on [t0, t1] x [s0, s1] with p = 0 on all edges."""

    def __init__(
        self, t: tuple[float, float], s: tuple[float, float], n: int, m: int, radius: float | None = None
    ) -> None:
        self.radius = radius
        self.n = n
        self.m = m
        self.dt = (t[1] - t[0]) / n
        self.ds = (s[1] - s[0]) / m
        i, j = (x.ravel() for x in np.meshgrid(np.arange(n), np.arange(m), indexing="ij"))
        self.nodes = np.stack([a * (m + 1) + b for a, b in ((i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1))], axis=1)
        grid = np.arange((n + 1) * (m + 1)).reshape(n + 1, m + 1)
        self.inner = grid[1:-1, 1:-1].ravel()
        self.points = []
        for a in _GAUSS:
            for b in _GAUSS:
                value = np.array([(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b])
                in_t = np.array([-(1 - b), 1 - b, -b, b]) / self.dt
                in_s = np.array([-(1 - a), -a, 1 - a, a]) / self.ds
                self.points.append((value, in_t, in_s, t[0] + (i + a) * self.dt, s[0] + (j + b) * self.ds))

    def weights(self, s: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        r = s if self.radius is None else np.full_like(s, self.radius)
        return 1.0 / r, r, r

    def pressure(self, gap: Field, slope: Field, closing: Field, viscosity: float, omega: float) -> np.ndarray:
        """Pressure at all nodes; `slope` is dh/dt, `closing` the rate -dh/dtime."""
        size = (self.n + 1) * (self.m + 1)
        area = 0.25 * self.dt * self.ds
        A = sp.csr_array((size, size))
        b = np.zeros(size)
        rows = np.repeat(self.nodes, 4, axis=1).ravel()
        columns = np.tile(self.nodes, (1, 4)).ravel()
        for value, in_t, in_s, t, s in self.points:
            w_t, w_s, own = self.weights(s)
            carry = gap(t, s) ** 3 / (12.0 * viscosity)
            local = (carry * w_t)[:, None] * np.outer(in_t, in_t).ravel() + (carry * w_s)[:, None] * np.outer(
                in_s, in_s
            ).ravel()
            A = A + sp.csr_array((area * local.ravel(), (rows, columns)), shape=(size, size))
            push = own * (closing(t, s) - 0.5 * omega * slope(t, s))
            np.add.at(b, self.nodes.ravel(), (area * push[:, None] * value).ravel())
        A = A[self.inner][:, self.inner]
        b = b[self.inner]
        scale = A.diagonal().mean()
        p = np.zeros(len(b))
        free = np.ones(len(b), bool)
        for _ in range(100):
            p[:] = 0.0
            if free.any():
                p[free] = spsolve(sp.csc_array(A[free][:, free]), b[free])
            left = A @ p - b
            now = np.where(free, p > 0.0, scale * p - left > 0.0)
            if np.array_equal(now, free):
                break
            free = now
        else:
            raise AssertionError("the active set does not settle")
        full = np.zeros(size)
        full[self.inner] = p
        return full

    def moments(self, p: np.ndarray, *weights: Field) -> np.ndarray:
        """int p w dA for each weight."""
        found = np.zeros(len(weights))
        for value, _, _, t, s in self.points:
            here = p[self.nodes] @ value * self.weights(s)[2] * 0.25 * self.dt * self.ds
            found += [np.sum(here * weight(t, s)) for weight in weights]
        return found
