"""Compiled: what all journal bearings share, the first of their parameters and the shell around the film.

Up to the share `contact` of the clearance the journal moves in the film; beyond it, an elastic wall takes the rest. At
displacements d with |d| > r the film stays as it is at x = r d/|d|, and the wall adds k_w (d - x). With P = dx/dd,

    F = F_film(x) + k_w (d - x),   dF/dd = dF_film/dx P + k_w (1 - P)
"""

from __future__ import annotations

from collections import namedtuple

import numpy as np

from rotorgear.solvers.time.compiled import compiled, schedule_function

VISCOSITY, RADIUS, LENGTH, CLEARANCE, ORDER, CONTACT, WALL, MORE = range(8)  # of the parameters
SPEED = 0  # of the state
# Place x, y of the journal in the film, P = [[xx, xy], [xy, yy]], and 1 where the wall carries, else 0.
InShell = namedtuple("InShell", "x y xx xy yy touches")


@schedule_function
def schedule(angle, speed, time, p, s):  # type: ignore[no-untyped-def]
    """Speed of the journal."""
    s[SPEED] = p[ORDER] * speed


@compiled(entry=False)
def place_in_shell(d, p):  # type: ignore[no-untyped-def]
    """Place of a journal at d (2,) in its film."""
    limit = p[CONTACT] * p[CLEARANCE]
    radius = np.hypot(d[0], d[1])
    if radius <= limit:
        return InShell(d[0], d[1], 1.0, 0.0, 1.0, 0.0)
    share = limit / radius
    xx = share * (1.0 - d[0] * d[0] / radius**2)
    xy = -share * d[0] * d[1] / radius**2
    yy = share * (1.0 - d[1] * d[1] / radius**2)
    return InShell(share * d[0], share * d[1], xx, xy, yy, 1.0)


@compiled(entry=False)
def add_wall(d, place, wall, film, k, F, Kd):  # type: ignore[no-untyped-def]
    """Fill F (2,) and Kd (4,) from the film's force (2,) and tangent (4,) at its place, and the wall; return its energy."""
    F[0] = film[0] + wall * (d[0] - place.x)
    F[1] = film[1] + wall * (d[1] - place.y)
    Kd[0] = k[0] * place.xx + k[1] * place.xy + wall * (1.0 - place.xx)
    Kd[1] = k[0] * place.xy + k[1] * place.yy - wall * place.xy
    Kd[2] = k[2] * place.xx + k[3] * place.xy - wall * place.xy
    Kd[3] = k[2] * place.xy + k[3] * place.yy + wall * (1.0 - place.yy)
    return 0.5 * wall * ((d[0] - place.x) ** 2 + (d[1] - place.y) ** 2)
