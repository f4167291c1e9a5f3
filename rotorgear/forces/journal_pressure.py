"""Compiled: pressure, force and tangents of the film on the pads of a journal bearing.

On each pad (one of 360 deg of a plain bearing, or a lobe), with the gap h = c_p - x cos t - y sin t - m c_p cos(t - t_m),

    1/R^2 d/dt(h^3 dp/dt) + d/dz(h^3 dp/dz) = 12 mu (dh/dt + omega/2 dh/dtheta),   p = 0 at the edges of the pad and at both ends

in finite volumes of second order, on one half of the length; from the last cell to the end at half a cell the flow is that which
makes the mean of a parabola exact, the profile of a short bearing. Cavitation "reynolds" (Swift and Stieber): p >= 0, and where
p = 0 the film does not have to push (film_grid.py).
"half_sommerfeld" (Guembel) cuts the negative pressure of the full film. The force is F = int p n dA, and its tangents are those
of the discrete film: A dp = -(dA p + db) where the film carries.

Pinkus and Sternlicht, Theory of Hydrodynamic Lubrication (1961); Lund and Thomsen, in Topics in Fluid Film Bearing and Rotor
Bearing System Design (ASME 1978).
"""

from __future__ import annotations

import numpy as np

from rotorgear.forces.film_grid import applied, carried, solve
from rotorgear.forces.shell import CLEARANCE, LENGTH, MORE, RADIUS, SPEED, VISCOSITY, WALL, add_wall, place_in_shell
from rotorgear.solvers.time.compiled import compiled, force_function

# Of the parameters behind those of every journal bearing; then start, extent, place of the least gap of each pad.
PRELOAD, AROUND, ALONG, CUT, FOLLOWS, PADS, FIRST = range(MORE, MORE + 7)


@compiled(entry=False)
def stencil(h3, middle3, around, along, per_t, per_z, a, b, c):  # type: ignore[no-untyped-def]
    """Fill a, b, c (n,) of film_grid.py with -div(w grad) of any weights w: `h3` at nodes, `middle3` between them."""
    end = 2.0 / (1.0 - 1.0 / (3.0 * along))
    for i in range(around - 1):
        back = middle3[i] * per_t
        forth = middle3[i + 1] * per_t
        side = h3[i + 1] * per_z
        for j in range(along):
            k = i * along + j
            a[k] = back + forth + (side if j > 0 else 0.0) + (side if j < along - 1 else end * side)
            b[k] = side if j > 0 else 0.0
            c[k] = back if i > 0 else 0.0


@compiled
def pad_film(p, omega, x, y, vx, vy, start, extent, least, F, Kd, Kv, pressure):  # type: ignore[no-untyped-def]
    """Add force and tangents of one pad, and fill its pressure (around - 1, along) over half the length."""
    around = int(p[AROUND])
    along = int(p[ALONG])
    n = (around - 1) * along
    dt = extent / around
    dz = 0.5 * p[LENGTH] / along
    per_t = 1.0 / (p[RADIUS] * dt) ** 2
    per_z = 1.0 / dz**2
    c_pad = p[CLEARANCE] / (1.0 - p[PRELOAD])
    # n = (cos, sin) and the gap, at the nodes and between them.
    h = np.zeros(around + 1)
    normal = np.zeros((2, around + 1))
    middle = np.zeros(around)
    middle_normal = np.zeros((2, around))
    for i in range(around + 1):
        t = start + i * dt
        normal[0, i] = np.cos(t)
        normal[1, i] = np.sin(t)
        h[i] = c_pad - x * normal[0, i] - y * normal[1, i] - p[PRELOAD] * c_pad * np.cos(t - least)
    for i in range(around):
        t = start + i * dt + 0.5 * dt
        middle_normal[0, i] = np.cos(t)
        middle_normal[1, i] = np.sin(t)
        middle[i] = c_pad - x * middle_normal[0, i] - y * middle_normal[1, i] - p[PRELOAD] * c_pad * np.cos(t - least)
    source = np.zeros(n)
    wedge = 6.0 * p[VISCOSITY] * omega / dt
    squeeze = 12.0 * p[VISCOSITY]
    for k in range(n):
        i = k // along
        source[k] = squeeze * (vx * normal[0, i + 1] + vy * normal[1, i + 1]) - wedge * (middle[i + 1] - middle[i])
    free = np.ones(n, dtype=np.bool_)
    A = np.zeros((n, along + 1))
    q = np.zeros(n)
    diagonal = np.zeros(n)
    beside = np.zeros(n)
    behind = np.zeros(n)
    stencil(h**3, middle**3, around, along, per_t, per_z, diagonal, beside, behind)
    carried(diagonal, beside, behind, along, source, p[CUT] > 0.0, A, free, q)
    area = 2.0 * p[RADIUS] * dt * dz
    weight = np.zeros((2, n))
    for k in range(n):
        if free[k] and (q[k] > 0.0 or p[CUT] == 0.0):
            weight[:, k] = area * normal[:, k // along + 1]
            pressure[k // along, k % along] = q[k]
        else:
            pressure[k // along, k % along] = 0.0
    left = np.zeros(n)
    change = np.zeros(n)
    for m in range(2):
        F[m] += np.sum(weight[m] * q)
        c = normal[m]
        mc = middle_normal[m]
        stencil(-3.0 * h**2 * c, -3.0 * middle**2 * mc, around, along, per_t, per_z, diagonal, beside, behind)
        applied(diagonal, beside, behind, along, q, left)
        for k in range(n):
            i = k // along
            change[k] = wedge * (mc[i + 1] - mc[i]) - left[k] if free[k] else 0.0
        solve(A, n, along, change)
        for o in range(2):
            Kd[2 * o + m] += np.sum(weight[o] * change)
        for k in range(n):
            change[k] = squeeze * c[k // along + 1] if free[k] else 0.0
        solve(A, n, along, change)
        for o in range(2):
            Kv[2 * o + m] += np.sum(weight[o] * change)


@force_function
def force(p, s, d, v, F, Kd, Kv, energy):  # type: ignore[no-untyped-def]
    """Force of the journal on the film and the shell, along x and y."""
    place = place_in_shell(d, p)
    x = place.x
    y = place.y
    omega = s[SPEED]
    film = np.zeros(2)
    k = np.zeros(4)
    c = np.zeros(4)
    pressure = np.zeros((int(p[AROUND]) - 1, int(p[ALONG])))
    follows = p[FOLLOWS] > 0.0 and np.hypot(x, y) > 0.0
    for pad in range(int(p[PADS])):
        at = FIRST + 3 * pad
        start = np.arctan2(-y, -x) if follows else p[at]
        pad_film(p, omega, x, y, v[0], v[1], start, p[at + 1], p[at + 2], film, k, c, pressure)
    if follows:
        # The inlet turns with the journal: dF/dt0 = J F - K J d - C J v by symmetry of rotation, dt0/dd = (-y, x)/|d|^2.
        turned_x = -film[1] - (k[0] * -y + k[1] * x) - (c[0] * -v[1] + c[1] * v[0])
        turned_y = film[0] - (k[2] * -y + k[3] * x) - (c[2] * -v[1] + c[3] * v[0])
        size = x * x + y * y
        k[0] += turned_x * -y / size
        k[1] += turned_x * x / size
        k[2] += turned_y * -y / size
        k[3] += turned_y * x / size
    energy[0] = add_wall(d, place, p[WALL], film, k, F, Kd)
    Kv[:] = c
    # What the film takes up: the journal turns it in at omega/2 beside the motion of its centre.
    turning = 0.5 * omega * (film[0] * y - film[1] * x)
    energy[1] = turning
    energy[2] = film[0] * v[0] + film[1] * v[1] + turning
    energy[3] = place.touches
