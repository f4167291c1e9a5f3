"""Blocks of up to 32 small systems that run side by side, and what a run leaves of each."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rotorgear.files.compiled_once import CompiledOnce
from rotorgear.solvers.batch.arguments import ActingLaws, BatchMotion, BatchSystem
from rotorgear.solvers.batch.columns import ERROR, FORCE, NEVER
from rotorgear.solvers.batch.small_system import SmallSystem
from rotorgear.solvers.time.arguments import SparseRows

# Steps between two questions whether to go on: a fraction of a second.
_SLICE = 50_000
_REGISTER = 64  # bytes of the widest vector registers


@dataclass(frozen=True)
class BatchPlan:
    """How long: steps in a period of the fastest excitation, common periods that settle and count, tangents to follow.

    The tangents are followed over the last `warm` of the periods that settle, so that they find the direction of most growth.
    """

    steps: int
    settle: int
    count: int
    tangents: int
    warm: int = 40

    def stride(self, turns: int) -> int:
        """Common periods, of `turns` periods of the fastest excitation each, between two questions whether to go on."""
        return max(1, _SLICE // (turns * self.steps))

    def questions(self, turns: int) -> int:
        """How often a run asks whether to go on, at most."""
        return 3 + (self.settle + self.count) // self.stride(turns)


@dataclass(frozen=True)
class Start:
    """A state: z and z' (n,)."""

    z: np.ndarray
    dz: np.ndarray

    def moved(self, old: SmallSystem, new: SmallSystem) -> Start:
        """The same displacements and velocities in the coordinates of another system."""
        if old is new:
            return self
        q, v = (np.linalg.solve(old.root.T, x) for x in (self.z, self.dz * old.w))
        if old.shapes is not new.shapes and old.shapes and new.shapes:
            q, v = (new.shapes.weighed.T @ (old.shapes.vectors @ x) for x in (q, v))
        return Start(new.root.T @ q, new.root.T @ v / new.w)


@dataclass(frozen=True)
class Orbit:
    """What a run leaves of one system.

    Attributes:
        section: displacement and velocity (in m and m/s) of each local displacement at the end of each common period, (p, m, 2).
        growth: (p, t) logarithm of the growth of each tangent in a common period.
        sums: (m, 14) statistics, see kernel_parts.py; forces in N.
        extremes: (p, 2) least and largest of the watched displacements.
        loads: (l, 4) mean, rms about it, largest and smallest of loads inside shafts and couplings, in N or N m; load_error: the
        errors of these, by a run with other steps; nan where that was not done.
        doubt: (t,) what exponents per period change by in a run with other steps.
        settled: common periods before those that count.
        multiplier: ln|mu| in a common period of the orbit that it is on; nan where that is not asked for or not found.
        repeats: common periods after which that orbit repeats; 0 where it is not known.
        away: what is left of the start over the periods that count, over the size of the motion; nan where it is not known.
        before: range of the section of each counted displacement (c,) in the round before; nan in the first.
        jumped: whether the run was set on the orbit that it goes to.
        error: (c, s) errors of statistics of each contact, by a run with other steps; nan where that was not done.
        end: state at the end. finite: whether everything stayed finite.
    """

    section: np.ndarray
    growth: np.ndarray
    sums: np.ndarray
    extremes: np.ndarray
    end: Start
    finite: bool
    doubt: np.ndarray
    settled: int
    multiplier: float = np.nan
    repeats: int = 0
    away: float = np.nan
    jumped: bool = False
    before: np.ndarray = field(default_factory=lambda: np.zeros(0))
    error: np.ndarray = field(default_factory=lambda: np.array(np.nan))
    loads: np.ndarray = field(default_factory=lambda: np.zeros((0, 4)))
    load_error: np.ndarray = field(default_factory=lambda: np.zeros((0, 4)))


def foretell_batches() -> None:
    """Tell whoever hears forecasts if the loop of batches is to be compiled first, by processes that nobody hears."""
    from rotorgear.solvers.batch.kernel import batch_loop

    if isinstance(kept := getattr(batch_loop, "_cache", None), CompiledOnce):
        kept.foretell_unless_kept()


def run_block(
    systems: Sequence[SmallSystem],
    starts: Sequence[Start],
    tables: Sequence[np.ndarray],
    plan: BatchPlan,
    go_on: Callable[[], bool] = lambda: True,
) -> list[Orbit]:
    """Run up to BATCH systems of one kind side by side.

    Args:
        systems: of the same n, m, kinds of columns, rigid motions and common period.
        starts: one a system. tables: one a system, or one for all, (2 turns steps + 1, m, 4).
        plan: how long.
        go_on: asked now and then whether to go on; where it is false, the run ends by a KeyboardInterrupt.
    """
    from rotorgear.solvers.batch.kernel import batch_loop
    from rotorgear.solvers.batch.kernel_jumps import KEPT, keep_start
    from rotorgear.solvers.contact.vectors import BATCH

    count = len(systems)
    if not 0 < count <= BATCH:
        raise ValueError(f"{count} systems in a block, expected 1 to {BATCH}")
    filled = [*systems, *[systems[-1]] * (BATCH - count)]
    begins = [*starts, *[starts[-1]] * (BATCH - count)]
    wide = tables if len(tables) == 1 else [*tables, *[tables[-1]] * (BATCH - count)]
    first = systems[0]
    m = first.columns.kind.size
    jumps = np.max([s.columns.jumps for s in filled], axis=0)
    values = _stacked([s.columns.values for s in filled])
    columns = first.columns._replace(jumps=jumps, jumping=bool(np.any(jumps != NEVER)), values=values)
    system = _matrices(filled)
    pushed = any(np.any(s.columns.values[:, FORCE]) for s in systems)
    table = _stacked([one[:, :, : 4 if pushed else 3] for one in wide])
    acting = acting_laws(systems)
    x = [
        s.B.T @ start.z - wide[i % len(wide)][0, :, ERROR]
        for i, (s, start) in enumerate(zip(filled, begins, strict=True))
    ]
    # Random tangents, the same for all systems and runs.
    tangents = np.random.default_rng(1).standard_normal((plan.tangents, 2 * first.n))
    extremes = aligned((2, first.W.shape[1] + len(first.loads.base), BATCH))
    extremes[0] = np.inf
    extremes[1] = -np.inf
    begin = BatchMotion(
        state=_stacked([np.concatenate([s.z, s.dz]) for s in begins]),
        kept=aligned((m, KEPT, BATCH)),
        tangents=_stacked([tangents] * BATCH),
        last=aligned((m, BATCH)),
        growth=aligned((0, 0, BATCH)),
        section=aligned((0, 0, BATCH)),
        sums=blank_sums(m),
        extremes=extremes,
        moments=aligned((2, len(first.loads.base), BATCH)),
    )
    keep_start(columns.values, _stacked(x), begin.kept)

    def run(begun: int, periods: int, counting: bool, followed: np.ndarray) -> BatchMotion:
        growth = aligned((periods, len(followed), BATCH))
        section = aligned((periods, 2 * m, BATCH))
        stride = plan.stride(first.turns)
        for p in range(0, periods, stride):
            if not go_on():
                raise KeyboardInterrupt
            rows = slice(p, p + stride)
            motion = begin._replace(tangents=followed, growth=growth[rows], section=section[rows])
            batch_loop(
                first.turns, plan.steps, begun + p, counting, system, columns, table, acting, *first.going_round, motion
            )
        return begin._replace(growth=growth, section=section)

    warm = min(plan.warm, plan.settle) if plan.tangents else 0
    with np.errstate(all="ignore"):
        run(0, plan.settle - warm, False, begin.tangents[:0])
        run(plan.settle - warm, warm, False, begin.tangents)
        end = run(plan.settle, plan.count, True, begin.tangents)
    return [_orbit(filled[i], i, end, plan) for i in range(count)]


def acting_laws(systems: Sequence[SmallSystem]) -> ActingLaws:
    """The laws of systems of one kind that act by functions of their own, as the kernels take them."""
    own = systems[0].own
    parameters = np.ascontiguousarray(np.stack([s.own.forces.parameters for s in systems]))
    clock = np.array([[s.own.turn for s in systems], [s.w for s in systems]])
    return ActingLaws(own.forces.arguments()._replace(parameters=parameters), own.place, clock)


def _orbit(system: SmallSystem, number: int, motion: BatchMotion, plan: BatchPlan) -> Orbit:
    """One system of a batch, with forces in N and velocities in m/s."""
    from rotorgear.solvers.batch.kernel_parts import F_MAX, F_MIN, F_SQUARES, F_SUM

    sums = motion.sums[:, :, number].copy()
    n = system.n
    moved = motion.section[:, :, number].reshape(len(motion.section), len(sums), 2).copy()
    for row in (F_MIN, F_MAX, F_SUM):
        sums[:, row] *= system.w**2
    sums[:, F_SQUARES] *= system.w**4
    moved[:, :, 1] *= system.w
    end = Start(motion.state[:n, number].copy(), motion.state[n:, number].copy())
    finite = bool(np.all(np.isfinite(moved)) and np.all(np.isfinite(end.z)))
    growth = motion.growth[..., number].copy()
    watched = system.W.shape[1]
    extremes = motion.extremes[:, :, number].T.copy()
    mean, square = motion.moments[:, :, number] / max(plan.count * system.turns * plan.steps, 1)
    ends = system.loads.base[:, None] + extremes[watched:, ::-1]
    rms = np.sqrt(np.maximum(square - mean**2, 0.0))
    loads = np.column_stack([system.loads.base + mean, rms, ends])
    # Two displacements are watched of each contact.
    doubt = np.zeros(growth.shape[1])
    before = np.full(watched // 2, np.nan)
    return Orbit(moved, growth, sums, extremes[:watched], end, finite, doubt, plan.settle, before=before, loads=loads)


def trajectory(
    system: SmallSystem, start: Start, table: np.ndarray, steps: int, periods: int, every: int = 1, begun: int = 0
) -> np.ndarray:
    """Run one system on from a state over common periods, by the steps of `run_block`.

    Args:
        table: of what depends on time, (2 turns steps + 1, m, 4).
        steps: in a period of the fastest excitation. periods: common ones. every: steps between two records.
        begun: common periods before the start, for laws that go on from one to the next, such as rolling elements.

    Returns:
        Displacement in m, velocity in m/s and force in N of each local displacement, (periods turns steps / every, m, 3); the
        first record is the state to start from.

    Raises:
        ValueError: `every` does not divide the steps of a common period.
    """
    from rotorgear.solvers.batch.kernel_trajectory import trajectory

    length, rest = divmod(system.turns * steps, every)
    if rest:
        raise ValueError(f"{system.turns * steps} steps in a common period are no multiple of {every}")
    out = np.empty((periods * length, system.columns.kind.size, 3))
    trajectory(
        steps,
        every,
        begun * system.turns * steps,
        tuple(np.ascontiguousarray(x, dtype=float) for x in (system.K, system.D, system.B, system.load)),
        system.columns,
        np.ascontiguousarray(table),
        acting_laws([system]),
        system.going_round[0],
        np.concatenate([start.z, start.dz]),
        out,
    )
    return out * np.array([1.0, system.w, system.w**2])


def blank_sums(m: int) -> np.ndarray:
    """Statistics (m, 14, w) before anything was counted."""
    from rotorgear.solvers.batch.kernel_parts import D_MAX, D_MIN, F_MAX, F_MIN, X_MAX, X_MIN
    from rotorgear.solvers.contact.vectors import BATCH

    sums = aligned((m, 14, BATCH))
    sums[:, [D_MIN, X_MIN, F_MIN]] = np.inf
    sums[:, [D_MAX, X_MAX, F_MAX]] = -np.inf
    return sums


def aligned(shape: tuple[int, ...]) -> np.ndarray:
    """Zeros whose rows begin where vector registers read best."""
    size = int(np.prod(shape))
    raw = np.zeros(size + _REGISTER // 8)
    at = (-raw.ctypes.data) % _REGISTER // 8
    return raw[at : at + size].reshape(shape)


def _stacked(values: Sequence[Any]) -> np.ndarray:
    """Arrays of the systems as one, with the systems as its last axis."""
    found = aligned((*np.shape(values[0]), len(values)))
    np.stack(values, axis=-1, out=found)
    return found


def _matrices(systems: Sequence[SmallSystem]) -> BatchSystem:
    """The systems' matrices side by side."""
    return BatchSystem(
        matrix=_sparse([np.hstack([-s.K, -s.D, -s.B, s.load[:, None]]) for s in systems]),
        # Displacement and velocity of a column lie side by side.
        across=_sparse(
            [
                np.stack([np.kron([1.0, 0.0], s.B.T), np.kron([0.0, 1.0], s.B.T)], axis=1).reshape(-1, 2 * s.n)
                for s in systems
            ]
        ),
        per_force=_sparse([-s.B for s in systems]),
        watched=_sparse([_watched(s) for s in systems]),
        rigid=_stacked([s.rigid for s in systems]),
        carried=_stacked([s.carried for s in systems]),
        root=_stacked([s.energy for s in systems]),
    )


def _watched(system: SmallSystem) -> np.ndarray:
    """Watched displacements and loads as rows (p, 2 n + m + 1) on z, z', F and 1."""
    displacements = np.zeros((system.W.shape[1], system.loads.rows.shape[1]))
    displacements[:, : system.n] = system.W.T
    return np.vstack([displacements, system.loads.rows])


def _sparse(matrices: Sequence[np.ndarray]) -> SparseRows:
    """Row starts, columns and values by system (p, w) of what is not zero in all of them."""
    used = np.any([matrix != 0.0 for matrix in matrices], axis=0)
    first = np.concatenate([[0], np.cumsum(used.sum(axis=1))]).astype(np.int64)
    return SparseRows(first, np.nonzero(used)[1].astype(np.int64), _stacked([matrix[used] for matrix in matrices]))
