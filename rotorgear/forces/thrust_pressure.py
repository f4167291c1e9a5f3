"""Compiled: pressure, forces and tangents of the film on sector pads, with the collar at the displacement z and the tilts tx, ty.

With p = 0 on all edges of a pad,

    d/dt(h^3/r dp/dt) + d/dr(r h^3 dp/dr) = 12 mu r (dh/dtime + omega/2 dh/dt),   h = c + shape - q . phi
    q = sigma (z, tx, ty),   phi = (1, r sin t, -r cos t),   sigma = +1 where the pads take a push towards +z

in finite volumes of second order. Forces are int p phi dA, tangents those of the discrete film. A tilting pad has one more
field, phi_3 = r sin(t - t_p) about the radius through its pivot at t_p, and its equilibrium is G_3 = int p phi_3 dA = 0. Where
the collar leans away from a pad its film may fail, as pad_fold.py has it with H = c - q_0 and a = (q_2 cos t_p - q_1 sin t_p)
r_o/H. Below the least gap h_c the gap goes on as h_c exp(h/h_c - 1): the film becomes a wall. p >= 0 by changes of the active
set (film_grid.py).

Pinkus and Sternlicht, Theory of Hydrodynamic Lubrication (1961), chs. 3 and 4.
"""

from __future__ import annotations

import numpy as np

from rotorgear.forces.film_grid import applied, carried, solve
from rotorgear.forces.pad_fold import TILT_THERE, film_weight, loaded_tilt
from rotorgear.solvers.time.compiled import compiled, force_function, schedule_function

# Of the parameters, then middle and side of each pad, and the fold of tilting ones; and of the state.
VISCOSITY, INNER, OUTER, CLEARANCE, ORDER, ARC, TAPER, SHARE, PIVOT, LEAST, AROUND, ACROSS, PADS, FIRST = range(14)
SPEED = 0
_ITERATIONS = 60
_LEVEL = 1e-12
_DEEPEST_EXPONENT = -12.0


@schedule_function
def schedule(angle, speed, time, p, s):  # type: ignore[no-untyped-def]
    """Speed of the collar."""
    s[SPEED] = p[ORDER] * speed


@compiled(entry=False)
def gap_at(p, omega, start, t, r, q):  # type: ignore[no-untyped-def]
    """The gap at an angle and a radius, and its change with what closes it; q (4,)."""
    h = p[CLEARANCE]
    if p[PIVOT] < 0.0:
        u = (t - start) / p[ARC]
        if omega < 0.0:
            u = 1.0 - u
        if u < p[SHARE]:
            h += p[TAPER] * (1.0 - u / p[SHARE])
    pivot = start + abs(p[PIVOT]) * p[ARC]
    h -= q[0] + r * (np.sin(t) * q[1] - np.cos(t) * q[2]) + r * np.sin(t - pivot) * q[3]
    least = p[LEAST] * p[CLEARANCE]
    if h >= least:
        return h, 1.0
    exponent = h / least - 1.0
    if exponent > _DEEPEST_EXPONENT:
        thin = least * np.exp(exponent)
        return thin, thin / least
    return least * np.exp(_DEEPEST_EXPONENT), 0.0


@compiled
def gaps_at(p, omega, start, t, r, q):  # type: ignore[no-untyped-def]
    """The same at angles (t,) and radii (j,): gaps and changes, (t, j) each."""
    h = np.zeros((t.size, r.size))
    closes = np.zeros((t.size, r.size))
    for i in range(t.size):
        for j in range(r.size):
            h[i, j], closes[i, j] = gap_at(p, omega, start, t[i], r[j], q)
    return h, closes


@compiled(entry=False)
def field_at(which, t, r, pivot):  # type: ignore[no-untyped-def]
    """phi_which at an angle and a radius."""
    if which == 0:
        return 1.0
    if which == 1:
        return r * np.sin(t)
    if which == 2:
        return -r * np.cos(t)
    return r * np.sin(t - pivot)


@compiled(entry=False)
def stencil(theta, radial, r, dr, dt, a, b, c):  # type: ignore[no-untyped-def]
    """Fill a, b, c (n,) of film_grid.py with -div(w grad): weights between the nodes, along the arc and the radius.

    theta (rows + 1, columns), radial (rows, columns + 1).
    """
    rows = radial.shape[0]
    columns = theta.shape[1]
    for i in range(rows):
        for j in range(columns):
            k = i * columns + j
            per_t = 1.0 / (r[j] * dt * dt)
            back = radial[i, j] * (r[j] - 0.5 * dr) / dr**2
            forth = radial[i, j + 1] * (r[j] + 0.5 * dr) / dr**2
            a[k] = (theta[i, j] + theta[i + 1, j]) * per_t + back + forth
            b[k] = back if j > 0 else 0.0
            c[k] = theta[i, j] * per_t if i > 0 else 0.0


@compiled
def sector_film(p, omega, start, q, v, first, fields, G, K, C, pressure):  # type: ignore[no-untyped-def]
    """Fill G (4,) of one pad for its fields below `fields`, K and C (4, 4) from `first` on, and its pressure at inner nodes."""
    around = int(p[AROUND])
    across = int(p[ACROSS])
    rows = around - 1
    columns = across - 1
    n = rows * columns
    dt = p[ARC] / around
    dr = (p[OUTER] - p[INNER]) / across
    pivot = start + abs(p[PIVOT]) * p[ARC]
    r = p[INNER] + dr * np.arange(1, across)
    # At the nodes, and half-way to the next along the arc and along the radius.
    t = start + np.arange(1.0, around) * dt
    middle_t = start + (np.arange(around) + 0.5) * dt
    middle_r = p[INNER] + (np.arange(across) + 0.5) * dr
    theta_h, theta_c = gaps_at(p, omega, start, middle_t, r, q)
    radial_h, radial_c = gaps_at(p, omega, start, t, middle_r, q)
    _, closes = gaps_at(p, omega, start, t, r, q)
    wedge = 6.0 * p[VISCOSITY] * omega / dt
    squeeze = 12.0 * p[VISCOSITY]
    source = np.zeros(n)
    for k in range(n):
        i = k // columns
        j = k % columns
        speed = 0.0
        for m in range(fields):
            speed += v[m] * field_at(m, t[i], r[j], pivot)
        source[k] = r[j] * (squeeze * closes[i, j] * speed - wedge * (theta_h[i + 1, j] - theta_h[i, j]))
    theta_3 = theta_h**3
    radial_3 = radial_h**3
    # Half a cell at each rim has no node: with this flow to the rim the sum over the nodes is that of a parabola, which oil has
    # that leaves at the rims alone.
    rim = 1.0 / (1.0 + across / (6.0 * (across - 1.0) ** 2))
    radial_3[:, 0] *= rim
    radial_3[:, columns] *= rim
    free = np.ones(n, dtype=np.bool_)
    A = np.zeros((n, columns + 1))
    x = np.zeros(n)
    left = np.zeros(n)
    diagonal = np.zeros(n)
    beside = np.zeros(n)
    behind = np.zeros(n)
    stencil(theta_3, radial_3, r, dr, dt, diagonal, beside, behind)
    carried(diagonal, beside, behind, columns, source, False, A, free, x)
    weight = np.zeros((4, n))
    for k in range(n):
        i = k // columns
        j = k % columns
        pressure[i, j] = x[k] if free[k] else 0.0
        for m in range(fields if free[k] else 0):
            weight[m, k] = field_at(m, t[i], r[j], pivot) * r[j] * dr * dt
    change = np.zeros(n)
    phi_t = np.zeros((rows + 1, columns))
    phi_r = np.zeros((rows, columns + 1))
    for m in range(fields):
        G[m] = np.sum(weight[m] * x)
    for m in range(first, fields):
        for i in range(rows + 1):
            for j in range(columns):
                phi_t[i, j] = theta_c[i, j] * field_at(m, middle_t[i], r[j], pivot)
        for i in range(rows):
            for j in range(columns + 1):
                phi_r[i, j] = radial_c[i, j] * field_at(m, t[i], middle_r[j], pivot)
        phi_r[:, 0] *= rim
        phi_r[:, columns] *= rim
        stencil(-3.0 * theta_h**2 * phi_t, -3.0 * radial_h**2 * phi_r, r, dr, dt, diagonal, beside, behind)
        applied(diagonal, beside, behind, columns, x, left)
        for k in range(n):
            i = k // columns
            j = k % columns
            change[k] = r[j] * wedge * (phi_t[i + 1, j] - phi_t[i, j]) - left[k] if free[k] else 0.0
        solve(A, n, columns, change)
        for o in range(fields):
            K[o, m] = np.sum(weight[o] * change)
        for k in range(n):
            i = k // columns
            j = k % columns
            phi = closes[i, j] * field_at(m, t[i], r[j], pivot)
            change[k] = squeeze * r[j] * phi if free[k] else 0.0
        solve(A, n, columns, change)
        for o in range(fields):
            C[o, m] = np.sum(weight[o] * change)


@compiled
def pad_in_balance(p, omega, start, q, v, G, K, C, pressure, follows):  # type: ignore[no-untyped-def]
    """Turn a tilting pad until it is in balance: q[3] is found, and G, K, C and the pressure at it.

    follows (2, 3, 3): what the changes of G with q and v gain as the pad follows. Near the fold all is weighted, as in
    tilting_pads.py.
    """
    pivot = start + abs(p[PIVOT]) * p[ARC]
    behind = p[ARC] - (pivot - start) if omega >= 0.0 else pivot - start
    at = FIRST + 2 * int(p[PADS])
    gap = p[CLEARANCE] - q[0]
    away = leaning(p, pivot, q)
    slope = np.zeros((3, 2))
    follows[:] = 0.0
    weight = 0.0
    change = 0.0
    if away >= 0.0 and behind < 0.5 * p[ARC]:
        weight, change = film_weight(p, at, away)
    # How far the collar leans away, with its displacements.
    leans = np.array([away / gap, -np.sin(pivot) * p[OUTER] / gap, np.cos(pivot) * p[OUTER] / gap])
    closing = False
    for corner in range(4):
        t = start + (p[ARC] if corner % 2 else 0.0)
        r = p[OUTER] if corner // 2 else p[INNER]
        closing |= v[0] + r * (np.sin(t) * v[1] - np.cos(t) * v[2]) > 0.0
    if weight == 0.0 or (weight < 1.0 and closing):
        balanced_pad(p, omega, start, q, v, False, closing, G, K, C, pressure, slope)
        for i in range(3):
            for j in range(3):
                follows[0, i, j] = (1.0 - weight) * K[i, 3] * slope[j, 0] - change * leans[j] * G[i]
                follows[1, i, j] = (1.0 - weight) * K[i, 3] * slope[j, 1]
    if weight > 0.0:
        rest_G = G * (1.0 - weight)
        rest_K = K * (1.0 - weight)
        rest_C = C * (1.0 - weight)
        rest = weight < 1.0 and closing
        balanced_pad(p, omega, start, q, v, True, closing, G, K, C, pressure, slope)
        for i in range(3):
            for j in range(3):
                follows[0, i, j] += weight * K[i, 3] * slope[j, 0] + change * leans[j] * G[i]
                follows[1, i, j] += weight * K[i, 3] * slope[j, 1]
        G *= weight
        K *= weight
        C *= weight
        pressure *= weight
        if rest:
            G += rest_G
            K += rest_K
            C += rest_C


@compiled
def leaning(p, pivot, q):  # type: ignore[no-untyped-def]
    """a of pad_fold.py: how far the collar leans away from a pad."""
    gap = p[CLEARANCE] - q[0]
    if gap <= p[LEAST] * p[CLEARANCE]:
        return -1.0
    return (np.cos(pivot) * q[2] - np.sin(pivot) * q[1]) * p[OUTER] / gap


@compiled
def balanced_pad(p, omega, start, q, v, loaded, closing, G, K, C, pressure, slope):  # type: ignore[no-untyped-def]
    """Turn a pad about its pivot until G_3 = 0: q[3] is found; a pad whose edge comes down first lies on it.

    `loaded`: on the loaded tilt of a pad that the collar leans away from; `closing`: whether the gap closes anywhere.
    slope (3, 2): change of q[3] with the other three and with their velocities.
    """
    tilt_unit = p[CLEARANCE] / p[OUTER]
    least = p[LEAST] * p[CLEARANCE]
    pivot = start + abs(p[PIVOT]) * p[ARC]
    sense = 1.0 if omega >= 0.0 else -1.0
    behind = p[ARC] - (pivot - start) if sense > 0.0 else pivot - start
    # Gap and tilt about the pivot with q[3] = 0, and how far the collar leans away.
    gap = p[CLEARANCE] - q[0]
    along = np.cos(pivot) * q[1] + np.sin(pivot) * q[2]
    away = leaning(p, pivot, q)
    slope[:] = 0.0
    if away > 0.0 and not loaded and not closing:
        G[:] = 0.0
        K[:] = 0.0
        C[:] = 0.0
        pressure[:] = 0.0
        # The gap opens from the leading edge to the trailing one.
        q[3] = -sense * away * gap / p[OUTER] * np.tan(behind) - along
        return
    low = -1e3 * tilt_unit
    high = 1e3 * tilt_unit
    # Tilts that leave the least gap at the edges of the pad.
    for corner in range(4):
        t = start + (p[ARC] if corner % 2 else 0.0)
        r = p[OUTER] if corner // 2 else p[INNER]
        room = p[CLEARANCE] - q[0] - r * (np.sin(t) * q[1] - np.cos(t) * q[2]) - least
        side = r * np.sin(t - pivot)
        if side > 0.0 and room / side < high:
            high = room / side
            for m in range(3):
                slope[m, 0] = -field_at(m, t, r, pivot) / side
        if side < 0.0 and room / side > low:
            low = room / side
            for m in range(3):
                slope[m, 1] = -field_at(m, t, r, pivot) / side
    if high <= low:
        high = low = 0.0
    most = high
    lowest = low
    # A flat pad has no pressure to tell it how to turn: it begins with its leading edge open.
    q[3] = 0.5 * (high if sense > 0.0 else low)
    if loaded:
        at = FIRST + 2 * int(p[PADS])
        shut = sense * gap * (1.0 + away * np.cos(behind)) / (p[OUTER] * np.sin(behind))
        q[3] = p[at + TILT_THERE] * shut - along
        below = 0.0
        if v[0] != 0.0 or v[1] != 0.0 or v[2] != 0.0:
            sector_film(p, omega, start, q, v, 3, 4, G, K, C, pressure)
            below = sense * G[3]
        # A collar that moves fast may leave no loaded tilt: then the pad turns on from the one at the fold.
        if below <= 0.0:
            if sense > 0.0:
                low = max(q[3], low)
            else:
                high = min(q[3], high)
            q[3] = shut * loaded_tilt(p, at, away) - along
    elif away > 0.0:
        q[3] = -along
    if not low < q[3] < high:
        q[3] = 0.5 * (low + high)
    for _ in range(_ITERATIONS):
        sector_film(p, omega, start, q, v, 3, 4, G, K, C, pressure)
        if (abs(G[0]) > 0.0 and abs(G[3]) <= _LEVEL * abs(G[0]) * p[OUTER]) or high - low < 1e-14 * tilt_unit:
            break
        # More tilt closes the trailing edge, where the film presses more.
        if G[3] > 0.0:
            high = q[3]
        elif G[3] < 0.0 or sense > 0.0:
            low = q[3]
        else:
            high = q[3]
        step = q[3] - G[3] / K[3, 3] if K[3, 3] != 0.0 else low
        q[3] = step if low < step < high else 0.5 * (low + high)
    sector_film(p, omega, start, q, v, 0, 4, G, K, C, pressure)
    for m in range(3):
        if most - q[3] < 1e-9 * tilt_unit:
            slope[m, 1] = 0.0
        elif q[3] - lowest < 1e-9 * tilt_unit:
            slope[m, 0] = slope[m, 1]
            slope[m, 1] = 0.0
        else:
            slope[m, 0] = -K[3, m] / K[3, 3] if K[3, 3] != 0.0 else 0.0
            slope[m, 1] = -C[3, m] / K[3, 3] if K[3, 3] != 0.0 else 0.0


@force_function
def force(p, s, d, v, F, Kd, Kv, energy):  # type: ignore[no-untyped-def]
    """Force along z and moments about x and y of the collar on its films."""
    omega = s[SPEED]
    F[:] = 0.0
    Kd[:] = 0.0
    Kv[:] = 0.0
    G = np.zeros(4)
    K = np.zeros((4, 4))
    C = np.zeros((4, 4))
    q = np.zeros(4)
    w = np.zeros(4)
    follows = np.zeros((2, 3, 3))
    taken = 0.0
    tilts = p[PIVOT] >= 0.0
    pressure = np.zeros((int(p[AROUND]) - 1, int(p[ACROSS]) - 1))
    for pad in range(int(p[PADS])):
        start = p[FIRST + 2 * pad] - 0.5 * p[ARC]
        side = p[FIRST + 2 * pad + 1]
        q[3] = 0.0
        for i in range(3):
            q[i] = side * d[2 + i]
            w[i] = side * v[2 + i]
        if tilts:
            pad_in_balance(p, omega, start, q, w, G, K, C, pressure, follows)
        else:
            sector_film(p, omega, start, q, w, 0, 3, G, K, C, pressure)
        for i in range(3):
            F[2 + i] += side * G[i]
            for j in range(3):
                stiff = K[i, j] + follows[0, i, j]
                damp = C[i, j] + follows[1, i, j]
                taken += v[2 + i] * C[i, j] * v[2 + j]
                Kd[5 * (2 + i) + 2 + j] += stiff
                Kv[5 * (2 + i) + 2 + j] += damp
    # At a velocity the films take up v^T C v; what they give back as the collar leaves them comes from its rotation.
    energy[:] = 0.0
    energy[1] = taken - (F[2] * v[2] + F[3] * v[3] + F[4] * v[4])
    energy[2] = taken
