"""Loads inside shafts and couplings in a sweep: how they follow from motions, and the errors of their statistics."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from rotorgear.solvers.frequency.contact_basis import Probes
from rotorgear.solvers.sparse.factor import factor_general
from rotorgear.solvers.time.local_system import LocalSystem
from rotorgear.solvers.time.statistics import OF_ERROR, compared, scatter_of_two
from rotorgear.system.internal_loads import LoadRows

# Columns of the statistics of a load, (l, 4).
MEAN, RMS, LARGEST, SMALLEST = range(4)
_ENDS = [LARGEST, SMALLEST]
# Frequencies at most at which loads of a reduced system are compared with those of the whole one.
_PROBES = 16


@dataclass(frozen=True)
class Inside:
    """Loads by motions: rows at a speed of the reference in rad/s, from which they grow."""

    rows: LoadRows
    about: float

    def at(self, speed: float) -> tuple[np.ndarray, ...]:
        """Rows (l, n) on q, q' and q'' at a speed, and the weight (l,) that is taken off."""
        rows = self.rows.at(speed - self.about)
        return rows.q, rows.v, rows.a, rows.weight

    def within(self, basis: np.ndarray) -> Inside:
        """The same on the coordinates of a basis (n, r)."""
        return replace(self, rows=self.rows.within(basis))

    def difference(self, whole: LocalSystem, own: LocalSystem, basis: np.ndarray, probes: Probes) -> float:
        """Largest difference of loads by a reduced system from those by the whole one, contacts closed, under forces of its laws.

        Relative to the largest of each load over the probes.
        """
        chosen = np.unique(np.linspace(0, probes.count - 1, min(_PROBES, probes.count)).round().astype(int))
        both = np.array(
            [
                [_loads(system, rows, float(probes.speed[i]), complex(probes.s[i])) for i in chosen]
                for system, rows in ((whole, self), (own, self.within(basis)))
            ]
        )
        # Forces of one law, over all frequencies, are measured by what they do most.
        size = np.abs(both[0]).max(axis=(0, 2), initial=0.0)
        off = np.abs(both[1] - both[0]).max(axis=(0, 2), initial=0.0)
        return float(np.max(off[size > 0.0] / size[size > 0.0], initial=0.0))


def _loads(system: LocalSystem, inside: Inside, speed: float, s: complex) -> np.ndarray:
    """Loads (l, m) by unit forces of each law at a complex frequency s in rad/s."""
    D = system.damping_about if system.G is None else system.damping_about + speed * system.G
    Z = sp.csc_array(system.stiffness_about + s * D + s * s * system.M, dtype=complex)
    of_q, of_v, of_a, _ = inside.at(speed)
    return np.asarray((of_q + s * of_v + s * s * of_a) @ factor_general(Z).solve(system.B.toarray().astype(complex)))


def swings(loads: np.ndarray) -> np.ndarray:
    """Sizes (l, 4) by which statistics (l, 4) of loads are judged: the larger end, of the rms its own."""
    largest = np.abs(loads[:, _ENDS]).max(axis=1, initial=0.0)
    return np.column_stack([largest, loads[:, RMS], largest, largest])


def load_errors(own: np.ndarray, finer: np.ndarray, left: float, luck: tuple[float, float]) -> np.ndarray:
    """Errors (l, 4) of the statistics of loads by those in finer steps.

    Args:
        own, finer: (l, 4) each. left: what is left of the start, over the size of the motion.
        luck: no statistic is better than this share of what others are; the second one is of ends.
    """
    if not own.size:
        return own
    sizes = swings(own)
    error = compared(own, finer, sizes, OF_ERROR, luck[0])
    error[:, _ENDS] = compared(own[:, _ENDS], finer[:, _ENDS], sizes[:, _ENDS], OF_ERROR, luck[1])
    return np.asarray(np.hypot(error, left * sizes))


def load_scatter(own: np.ndarray, windows: np.ndarray, draws: np.ndarray) -> np.ndarray:
    """By how much statistics (l, 4) of a run that never repeats differ from those of another one, in nineteen cases of twenty.

    From windows (w, l, 4) of the same motion: records made of draws (r, w) of them, ends of a quarter.
    """
    if not own.size:
        return own

    def of(which: np.ndarray, ends: np.ndarray) -> np.ndarray:
        mean = windows[which, :, MEAN].mean(axis=1)
        square = (windows[which, :, RMS] ** 2 + windows[which, :, MEAN] ** 2).mean(axis=1)
        rms = np.sqrt(np.maximum(square - mean**2, 0.0))
        largest = windows[ends, :, LARGEST].max(axis=1)
        smallest = windows[ends, :, SMALLEST].min(axis=1)
        return np.stack([mean, rms, largest, smallest], axis=-1)

    every = np.arange(len(windows))[None]
    scatter = scatter_of_two(of(draws, draws[:, : len(windows) // 4]))
    return np.asarray(np.maximum(np.abs(own - of(every, every)[0]), scatter))


def with_reduction(error: np.ndarray, loads: np.ndarray, share: float) -> np.ndarray:
    """Errors (..., 4) with those of a reduction, whose vibrations are off by a share; means are those of static shapes."""
    mean = loads[..., [MEAN]]
    moved = np.concatenate([0.0 * mean, loads[..., [RMS]], np.abs(loads[..., _ENDS] - mean)], axis=-1)
    return np.asarray(np.hypot(error, share * moved))
