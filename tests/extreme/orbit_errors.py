"""Errors of periodic motions against closed forms: linear pairs, and pairs whose flanks part and strike."""

from __future__ import annotations

from dataclasses import replace

import mpmath as mp
import numpy as np

import rotorgear as rg
from tests.extreme.time_errors import linear_pair, resonance
from tests.unit.analysis.impact_oscillator import ImpactOscillator


def exact_force(model: rg.Model, stiffness: float, damping_ratio: float, forced: mp.mpf) -> mp.mpf:
    """Root mean square of the force k x + c x' about its mean, of x'' + 2 zeta w x' + w^2 x = -e'' with e of 3 um."""
    w = resonance(model, stiffness)
    x = mp.mpf("3e-6") * forced**2 / (w**2 - forced**2 + 2j * mp.mpf(damping_ratio) * w * forced)
    return abs(mp.mpf(stiffness) * (1 + 2j * mp.mpf(damping_ratio) * forced / w) * x) / mp.sqrt(2)


def orbit_of_pair(stiffness: float, damping_ratio: float, ratio: float, method: str = "auto") -> float:
    """Root mean square of the mesh force at a mesh frequency of so many times the resonance."""
    model = linear_pair(stiffness, damping_ratio)
    forced = mp.mpf(ratio) * resonance(model, stiffness)
    speed = float(forced / model.gears["pinion"].teeth)
    found = rg.orbits(model, {"operation.speed": [speed, 1.001 * speed]}, method=method, step=0.5, points=2)
    exact = exact_force(model, stiffness, damping_ratio, mp.mpf(speed) * model.gears["pinion"].teeth)
    return float(abs(mp.mpf(float(found.rms_force[0, 0])) / exact - 1))


def orbit_of_rattle(case: ImpactOscillator, what: int = 2) -> float:
    """Largest force (or another of `STATISTICS`) of a motion with impacts that is solved piece by piece."""
    speed = case.speed(case.W)
    found = rg.orbits(case.model(), {"operation.speed": [speed, 1.001 * speed]}, step=0.5, points=2)
    exact = _exact(case, found)
    return float(abs(found.largest_force[0, 0] / exact[what] - 1.0))


def _exact(case: ImpactOscillator, found: rg.OrbitsResult) -> np.ndarray:
    """The exact statistics of the first point, from its state at the begin of the period."""
    c = found.displacement_harmonics[0, :, 0]
    rate = 1j * 2.0 * np.pi / found.period[0] * np.arange(len(c)) * c
    return replace(case).exact(float(c.real.sum()), float(rate.real.sum()))


def sweep_of_rattle(case: ImpactOscillator) -> float:
    """The same of a sweep, from its own section."""
    found = rg.sweep(case.model(), {"operation.speed": [case.speed(case.W)]}, initial_conditions=1, discard=400)
    exact = case.exact(*found.section[0, 0, -1, 0])
    return float(abs(found.largest_force[0, 0, 0] / exact[2] - 1.0))


def transient_of_rattle(case: ImpactOscillator) -> float:
    """The same of a transient, from rest."""
    periods = int(np.ceil(25.0 * case.W / (2.0 * np.pi * case.z)))
    found = rg.transient(case.model(), time=20 * case.period, discard=periods * case.period)
    d = found.approach[:, 0]
    v = (3.0 * d[-1] - 4.0 * d[-2] + d[-3]) / (2.0 * found.spacing)
    exact = case.exact(float(d[-1]), float(v))
    return float(abs(found.largest_force[0] / exact[2] - 1.0))
