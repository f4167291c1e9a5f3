"""Compiled: the shell around an oil film. Up to a limit the journal moves in the film; beyond it, an elastic wall takes the rest.

At displacements d with |d| > r the film stays as it is at x = r d/|d|, and the wall adds k_w (d - x). With P = dx/dd,

    F = F_film(x) + k_w (d - x),   dF/dd = dF_film/dx P + k_w (1 - P)
"""

from __future__ import annotations

import numpy as np

from rotorgear.solvers.time.compiled import compiled


@compiled(entry=False)
def place_in_shell(d, limit, place):  # type: ignore[no-untyped-def]
    """Fill place with x, y of the journal in the film and P = [[p0, p1], [p1, p2]]; return whether the wall carries."""
    radius = np.hypot(d[0], d[1])
    place[0] = d[0]
    place[1] = d[1]
    place[2] = 1.0
    place[3] = 0.0
    place[4] = 1.0
    if radius <= limit:
        return False
    share = limit / radius
    place[0] = share * d[0]
    place[1] = share * d[1]
    place[2] = share * (1.0 - d[0] * d[0] / radius**2)
    place[3] = -share * d[0] * d[1] / radius**2
    place[4] = share * (1.0 - d[1] * d[1] / radius**2)
    return True


@compiled(entry=False)
def add_wall(d, place, wall, film, k, F, Kd):  # type: ignore[no-untyped-def]
    """Fill F (2,) and Kd (4,) from the film's force (2,) and tangent (4,) at its place, and the wall; return its energy."""
    x, y, pxx, pxy, pyy = place[0], place[1], place[2], place[3], place[4]
    F[0] = film[0] + wall * (d[0] - x)
    F[1] = film[1] + wall * (d[1] - y)
    Kd[0] = k[0] * pxx + k[1] * pxy + wall * (1.0 - pxx)
    Kd[1] = k[0] * pxy + k[1] * pyy - wall * pxy
    Kd[2] = k[2] * pxx + k[3] * pxy - wall * pxy
    Kd[3] = k[2] * pxy + k[3] * pyy + wall * (1.0 - pyy)
    return 0.5 * wall * ((d[0] - x) ** 2 + (d[1] - y) ** 2)
