"""Speed of the sweep's SIMD batch against a scalar compiled kernel, and against scipy's solve_ivp.

    python -m validation.benchmarks.sweep_speed

A chain of 7 bodies with 1 or 4 mesh contacts that part, and one of 24 with 8: k(t) +-25 %, e(t), 200 steps in a mesh period.
Prints, in CPU seconds of one thread, point-steps in a second of each, their ratios, and how far batch and scalar kernel are
apart after 20 periods. solve_ivp (DOP853, rtol 1e-8) is timed over mesh periods of one point, with a slope in numpy and with a
compiled one.
"""

from __future__ import annotations

import time
from fractions import Fraction
from typing import Any

import numpy as np

from rotorgear.analysis.sweep.point import Point, at_rest, ready, table_of
from rotorgear.forces.mesh_contact import MeshContact
from rotorgear.solvers.batch.columns import PER_DEPTH
from rotorgear.solvers.batch.run_block import BatchPlan, Start, run_block
from rotorgear.solvers.time.compiled import compiled
from rotorgear.solvers.time.local_system import LocalSystem
from validation.oscillators import local_system

STEPS = 200
BATCH = 32
CASES = ((7, 1), (7, 4), (24, 8))
_SPEED = 1.35


def chain(n: int, m: int, speed: float = _SPEED) -> LocalSystem:
    """n unit masses on springs to ground and to each other, m contacts between neighbours, a load that closes them."""
    K = 0.05 * np.eye(n)
    for i in range(n - 1):
        K[i : i + 2, i : i + 2] += 0.3 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    laws = []
    for j in range(m):
        column = np.zeros((n, 1))
        at = j * (n - 1) // m
        column[at] = 1.0
        column[at + 1] = -1.0
        law = MeshContact(
            1.0,
            0.04,
            0.6,
            contact_damping="adhesive",
            ramp=1e-3,
            order=1.0,
            phase=0.3 * j,
            stiffness_cos=(0.25,),
            error_cos=(0.15,),
        )
        laws.append((law, column))
    load = np.linspace(0.1, -0.1, n)
    return local_system(np.eye(n), 0.01 * np.eye(n), K, load.tolist(), laws, speed=speed)


@compiled(fast=True)
def scalar_loop(
    periods,
    steps,
    n,
    first,
    column,
    K,
    D,
    load,
    bfirst,
    bcolumn,
    bvalue,
    cfirst,
    ccolumn,
    cvalue,
    k,
    c,
    backlash,
    ramp,
    table,
    q,
    v,
    section,
):
    """One system by the same method and formulas, as one would write it for a single point."""
    h = 2.0 * np.pi / steps
    m = k.size
    F = np.empty(m)
    qs = np.empty(n)
    vs = np.empty(n)
    a = np.zeros(n)
    dq = np.empty(n)
    dv = np.empty(n)
    before = np.empty(m)
    used = np.empty(m)
    for period in range(periods):
        for step in range(steps):
            dq[:] = 0.0
            dv[:] = 0.0
            for stage in range(4):
                share = 0.0 if stage == 0 else (h if stage == 3 else 0.5 * h)
                weight = (1.0 if stage in (0, 3) else 2.0) * h / 6.0
                row = 2 * step + (0 if stage == 0 else (2 if stage == 3 else 1))
                for i in range(n):
                    if stage == 0:
                        qs[i] = q[i]
                        vs[i] = v[i]
                    else:
                        qs[i] = q[i] + share * vs[i]
                        vs[i] = v[i] + share * a[i]
                for j in range(m):
                    d = 0.0
                    w = 0.0
                    for p in range(bfirst[j], bfirst[j + 1]):
                        d += bvalue[p] * qs[bcolumn[p]]
                        w += bvalue[p] * vs[bcolumn[p]]
                    x = d - table[row, j, 1]
                    rate = w - table[row, j, 2]
                    side = 0.0
                    depth = 0.0
                    if x > 0.0:
                        side = 1.0
                        depth = x
                    elif x < -backlash[j]:
                        side = -1.0
                        depth = -x - backlash[j]
                    on = min(depth * ramp[j], 1.0)
                    F[j] = side * (k[j] * table[row, j, 0] * depth + c[j] * on * side * rate)
                    if stage == 0:
                        before[j] = side * on * (depth - 0.5 * on / ramp[j])
                        used[j] = 0.0
                    used[j] += weight * c[j] * on * rate
                for i in range(n):
                    total = load[i]
                    for p in range(first[i], first[i + 1]):
                        total -= K[p] * qs[column[p]] + D[p] * vs[column[p]]
                    for p in range(cfirst[i], cfirst[i + 1]):
                        total -= cvalue[p] * F[ccolumn[p]]
                    a[i] = total
                    dq[i] += weight * vs[i]
                    dv[i] += weight * a[i]
            for i in range(n):
                q[i] += dq[i]
                v[i] += dv[i]
            for j in range(m):
                x = -table[2 * step + 2, j, 1]
                for p in range(bfirst[j], bfirst[j + 1]):
                    x += bvalue[p] * q[bcolumn[p]]
                side = 0.0
                depth = 0.0
                if x > 0.0:
                    side = 1.0
                    depth = x
                elif x < -backlash[j]:
                    side = -1.0
                    depth = -x - backlash[j]
                share = min(depth * ramp[j], 1.0)
                rest = c[j] * (side * share * (depth - 0.5 * share / ramp[j]) - before[j]) - used[j]
                for p in range(bfirst[j], bfirst[j + 1]):
                    v[bcolumn[p]] -= bvalue[p] * rest
        for j in range(m):
            section[period, j] = 0.0
            for p in range(bfirst[j], bfirst[j + 1]):
                section[period, j] += bvalue[p] * q[bcolumn[p]]


def scalar(point: Point, start: Start, table: np.ndarray, periods: int) -> np.ndarray:
    """Displacements of the contacts at the end of each period, (periods, m)."""
    section = np.zeros((periods, point.system.columns.kind.size))
    scalar_loop(periods, STEPS, point.system.n, *_structure(point), table, start.z.copy(), start.dz.copy(), section)
    return section


def _structure(point: Point) -> tuple[np.ndarray, ...]:
    """Sparse matrices by rows, and the contacts."""
    s = point.system
    c = point.system.columns
    mask = (s.K != 0.0) | (s.D != 0.0)
    rows, columns = np.nonzero(mask)
    first = np.concatenate([[0], np.cumsum(mask.sum(axis=1))])
    brows, bcolumns = np.nonzero(s.B.T)
    crows, ccolumns = np.nonzero(s.B)
    bfirst, cfirst = (np.concatenate([[0], np.cumsum((A != 0.0).sum(axis=1))]) for A in (s.B.T, s.B))
    return (
        first,
        columns,
        s.K[rows, columns],
        s.D[rows, columns],
        s.load,
        bfirst,
        bcolumns,
        s.B.T[brows, bcolumns],
        cfirst,
        ccolumns,
        s.B[crows, ccolumns],
        *np.ascontiguousarray(c.values[:, :4].T),
    )


def points(n: int, m: int, count: int = BATCH) -> list[Point]:
    """Points over the speed."""
    speeds = _SPEED * np.linspace(0.8, 1.2, count)
    return [ready(at_rest(chain(n, m, w), [Fraction(1)], tuple(map(str, range(m)))), w) for w in speeds]


def apart(n: int, m: int, periods: int = 20) -> float:
    """Largest difference of batch and scalar kernel after some periods, over the largest displacement."""
    own = points(n, m)
    starts = [Start(p.system.rest, np.zeros(n)) for p in own]
    tables = [table_of(own[0], STEPS)]
    orbits = run_block([p.system for p in own], starts, tables, BatchPlan(STEPS, 0, periods, 0))
    single = [scalar(p, s, tables[0], periods) for p, s in zip(own, starts, strict=True)]
    size = max(np.abs(x).max() for x in single)
    return float(max(np.abs(o.section[:, :, 0] - x).max() for o, x in zip(orbits, single, strict=True)) / size)


def rates(n: int, m: int, tangents: int = 0) -> dict[str, float]:
    """Point-steps in a CPU second of the batch, the scalar kernel and solve_ivp."""
    own = points(n, m)
    starts = [Start(p.system.rest, np.zeros(n)) for p in own]
    tables = [table_of(own[0], STEPS)]
    periods = 60 if n > 10 else 200

    def batch() -> float:
        before = time.process_time()
        run_block([p.system for p in own], starts, tables, BatchPlan(STEPS, periods, 1, tangents))
        return BATCH * STEPS * (periods + 1) / (time.process_time() - before)

    def single() -> float:
        before = time.process_time()
        scalar(own[0], starts[0], tables[0], 10 * periods)
        return 10 * periods * STEPS / (time.process_time() - before)

    found = {"batch": max(batch() for _ in range(4)), "scalar": max(single() for _ in range(4))}
    if tangents:
        return found
    found["solve_ivp"] = _solve_ivp(own[0], starts[0], _numpy_slope, 5)
    found["solve_ivp compiled"] = _solve_ivp(own[0], starts[0], slope, 10)
    return found


@compiled(fast=True)
def slope(
    t,
    y,
    first,
    column,
    K,
    D,
    load,
    bfirst,
    bcolumn,
    bvalue,
    cfirst,
    ccolumn,
    cvalue,
    k,
    c,
    backlash,
    ramp,
    phase,
    ripple,
    error,
):
    """z' and z'' at a time, with k(t) and e(t) from their first harmonic."""
    n = load.size
    m = k.size
    out = np.empty(2 * n)
    F = np.empty(m)
    for j in range(m):
        d = 0.0
        w = 0.0
        for p in range(bfirst[j], bfirst[j + 1]):
            d += bvalue[p] * y[bcolumn[p]]
            w += bvalue[p] * y[n + bcolumn[p]]
        co = np.cos(t + phase[j])
        si = np.sin(t + phase[j])
        x = d - error * co
        rate = w + error * si
        side = 1.0 if x > 0.0 else (-1.0 if x < -backlash[j] else 0.0)
        depth = max(x, -x - backlash[j], 0.0)
        F[j] = side * (k[j] * (1.0 + ripple * co) * depth + c[j] * min(depth * ramp[j], 1.0) * side * rate)
    for i in range(n):
        total = load[i]
        for p in range(first[i], first[i + 1]):
            total -= K[p] * y[column[p]] + D[p] * y[n + column[p]]
        for p in range(cfirst[i], cfirst[i + 1]):
            total -= cvalue[p] * F[ccolumn[p]]
        out[i] = y[n + i]
        out[n + i] = total
    return out


def _numpy_slope(t, y, point, phase, ripple, error):  # type: ignore[no-untyped-def]
    """The same with numpy, as one would write it for solve_ivp."""
    s = point.system
    c = point.system.columns
    z = y[: s.n]
    dz = y[s.n :]
    x = s.B.T @ z - error * np.cos(t + phase)
    rate = s.B.T @ dz + error * np.sin(t + phase)
    side = np.where(x > 0.0, 1.0, np.where(x < -c.clearance, -1.0, 0.0))
    depth = np.maximum(np.maximum(x, -x - c.clearance), 0.0)
    k = c.stiffness * (1.0 + ripple * np.cos(t + phase))
    F = side * (k * depth + c.damping * np.minimum(depth * c.values[:, PER_DEPTH], 1.0) * side * rate)
    return np.concatenate([dz, s.load - s.K @ z - s.D @ dz - s.B @ F])


def _solve_ivp(point: Point, start: Start, right: Any, periods: int) -> float:
    """Point-steps of 200 a period that scipy's solve_ivp is worth with a slope."""
    from scipy.integrate import solve_ivp

    head = _structure(point) if right is slope else (point,)
    phase = 0.3 * np.arange(point.system.columns.kind.size)

    def run(periods: int) -> float:
        before = time.process_time()
        y0 = np.concatenate([start.z, start.dz])
        solve_ivp(right, (0.0, periods * 2.0 * np.pi), y0, "DOP853", rtol=1e-8, args=(*head, phase, 0.25, 0.15))
        return periods * STEPS / (time.process_time() - before)

    run(1)
    return run(periods)


def main() -> None:
    """Print the table."""
    from rotorgear.solvers.sparse.factor import single_thread

    with single_thread(0):
        print("M point-steps in a CPU second; ratios to the batch")
        for n, m in CASES:
            apart(n, m, 1)
            own = rates(n, m)
            words = [f"{name} {rate / 1e6:.3g}" for name, rate in own.items()]
            ratios = [f"{own['batch'] / own[name]:.1f} x {name}" for name in own if name != "batch"]
            print(f"{n:2d} dofs, {m} contacts: {', '.join(words)}; batch {', '.join(ratios)}; apart {apart(n, m):.1e}")


__all__ = ["apart", "chain", "main", "points", "rates", "scalar"]

if __name__ == "__main__":
    main()
