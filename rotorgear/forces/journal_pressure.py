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
from rotorgear.forces.shell import add_wall, place_in_shell
from rotorgear.solvers.time.compiled import compiled, force_function, schedule_function

# Of the parameters; then start, extent, place of the least gap of each pad.
VISCOSITY, RADIUS, LENGTH, CLEARANCE, ORDER, CONTACT, WALL, PRELOAD, AROUND, ALONG, CUT, FOLLOWS, PADS, FIRST = range(
    14
)
SPEED = 0  # of the state


@schedule_function
def schedule(angle, speed, time, p, s):  # type: ignore[no-untyped-def]
    """Speed of the journal."""
    s[SPEED] = p[ORDER] * speed


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
    cosine = np.zeros(around + 1)
    sine = np.zeros(around + 1)
    h = np.zeros(around + 1)
    middle = np.zeros(around)
    middle_c = np.zeros(around)
    middle_s = np.zeros(around)
    for i in range(around + 1):
        t = start + i * dt
        cosine[i] = np.cos(t)
        sine[i] = np.sin(t)
        h[i] = c_pad - x * cosine[i] - y * sine[i] - p[PRELOAD] * c_pad * np.cos(t - least)
        if i < around:
            t += 0.5 * dt
            middle_c[i] = np.cos(t)
            middle_s[i] = np.sin(t)
            middle[i] = c_pad - x * middle_c[i] - y * middle_s[i] - p[PRELOAD] * c_pad * np.cos(t - least)
    push = np.zeros(n)
    wedge = 6.0 * p[VISCOSITY] * omega / dt
    squeeze = 12.0 * p[VISCOSITY]
    for i in range(around - 1):
        value = squeeze * (vx * cosine[i + 1] + vy * sine[i + 1]) - wedge * (middle[i + 1] - middle[i])
        for j in range(along):
            push[i * along + j] = value
    free = np.ones(n, dtype=np.bool_)
    A = np.zeros((n, along + 1))
    q = np.zeros(n)
    diagonal = np.zeros(n)
    beside = np.zeros(n)
    behind = np.zeros(n)
    stencil(h**3, middle**3, around, along, per_t, per_z, diagonal, beside, behind)
    carried(diagonal, beside, behind, along, push, p[CUT] > 0.0, A, free, q)
    area = 2.0 * p[RADIUS] * dt * dz
    weight_c = np.zeros(n)
    weight_s = np.zeros(n)
    for i in range(around - 1):
        for j in range(along):
            k = i * along + j
            carries = free[k] and (q[k] > 0.0 or p[CUT] == 0.0)
            weight_c[k] = area * cosine[i + 1] if carries else 0.0
            weight_s[k] = area * sine[i + 1] if carries else 0.0
            pressure[i, j] = q[k] if carries else 0.0
    F[0] += np.sum(weight_c * q)
    F[1] += np.sum(weight_s * q)
    left = np.zeros(n)
    change = np.zeros(n)
    for which in range(2):
        c = cosine if which == 0 else sine
        mc = middle_c if which == 0 else middle_s
        stencil(-3.0 * h**2 * c, -3.0 * middle**2 * mc, around, along, per_t, per_z, diagonal, beside, behind)
        applied(diagonal, beside, behind, along, q, left)
        for i in range(around - 1):
            for j in range(along):
                k = i * along + j
                change[k] = wedge * (mc[i + 1] - mc[i]) - left[k] if free[k] else 0.0
        solve(A, n, along, change)
        Kd[which] += np.sum(weight_c * change)
        Kd[2 + which] += np.sum(weight_s * change)
        for i in range(around - 1):
            for j in range(along):
                k = i * along + j
                change[k] = squeeze * c[i + 1] if free[k] else 0.0
        solve(A, n, along, change)
        Kv[which] += np.sum(weight_c * change)
        Kv[2 + which] += np.sum(weight_s * change)


@force_function
def force(p, s, d, v, F, Kd, Kv, energy):  # type: ignore[no-untyped-def]
    """Force of the journal on the film and the shell, along x and y."""
    place = np.zeros(5)
    touches = place_in_shell(d, p[CONTACT] * p[CLEARANCE], place)
    x = place[0]
    y = place[1]
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
    energy[3] = 1.0 if touches else 0.0
