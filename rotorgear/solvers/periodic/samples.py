"""A motion at many instants, the answers of the laws there, and one period of it as results read it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.solvers.time.arguments import Answer, Laws
from rotorgear.solvers.time.local_forces import LocalForces
from rotorgear.solvers.time.statistics import PeriodicCurve


@dataclass(frozen=True)
class Samples:
    """r instants: time (r,), d, v, F (r, m), tangents Kd, Kv (r, blocks), energies of each law (r, l, 4)."""

    t: np.ndarray
    d: np.ndarray
    v: np.ndarray
    F: np.ndarray
    Kd: np.ndarray
    Kv: np.ndarray
    energy: np.ndarray

    @property
    def side(self) -> np.ndarray:
        """Which side of each law touches, (r, l): 1, 0 apart, -1."""
        return self.energy[:, :, 3]


# To hand compiled functions over costs more than a thousand evaluations, and goes with their number.
_FEW = 2


def arguments_of(forces: LocalForces) -> Laws:
    """What compiled loops take of laws, with few functions where few are different."""
    laws = forces.arguments()
    if laws.kind.max(initial=0) < _FEW:
        return laws._replace(schedules=laws.schedules[:_FEW], forces=laws.forces[:_FEW])
    return laws


def answered(t: np.ndarray, d: np.ndarray, v: np.ndarray, forces: LocalForces, speed: float) -> Samples:
    """The answers of all laws at times t (r,) to d and v (r, m), at a constant speed of the reference."""
    from rotorgear.solvers.periodic.kernel_instants import laws_at

    r = len(t)
    blocks = int(forces.block_first[-1])
    laws = len(forces.laws)
    answer = Answer(np.zeros((r, forces.m)), np.zeros((r, blocks)), np.zeros((r, blocks)), np.zeros((r, 4 * laws)))
    d = np.ascontiguousarray(d, dtype=float)
    v = np.ascontiguousarray(v, dtype=float)
    t = np.ascontiguousarray(t, dtype=float)
    laws_at(arguments_of(forces), speed, t, d, v, answer)
    return Samples(t, d, v, answer.F, answer.Kd, answer.Kv, answer.energy.reshape(r, laws, 4))


@dataclass(frozen=True)
class MotionCycle:
    """A period T in s; the motion at N instants; watched displacements and rates (N, p); coefficients of d and F (H + 1, m)."""

    period: float
    at: Samples
    watched: np.ndarray
    watched_rate: np.ndarray
    displacement: np.ndarray
    force: np.ndarray

    def extremes(self) -> np.ndarray:
        """Least and largest local displacements (m, 2), by the cubics through values and rates."""
        return PeriodicCurve(self.period, self.at.d, self.at.v).extremes()


def spectrum(values: np.ndarray, harmonics: int) -> np.ndarray:
    """Coefficients c (H + 1, m) of values (N, m), d(t) = Re sum c_h e^{i h w t}."""
    c = np.fft.rfft(values, axis=0)[: harmonics + 1] / len(values)
    c[1:] *= 2.0
    return np.asarray(c)
