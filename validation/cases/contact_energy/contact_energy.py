"""Energy of an oscillator that meets a stiff spring, and statistics of stiff pairs that statics and more records must confirm."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np

import rotorgear as rg
from rotorgear.forces.mesh_contact import MeshContact
from rotorgear.results.transient import TransientResult
from validation.oscillators import integrate, local_system

_PERIODS = 10
_STEPS = 200
_MODELS = Path(__file__).resolve().parents[3] / "models"
_IMPACT = {"force": "3000 N", "duration": 0.02}


def measure(quantity: str, mode: str) -> float:
    """Drift of energy in a period, `mode`: s; method. Of pairs: a statistic, or a difference over the errors claimed."""
    if quantity == "drift of energy in a period":
        stiffness, method = mode.split("; ")
        return _drift(float(stiffness), method)
    if quantity == "mean contact force":
        model = rg.load(_MODELS / "backlash_pair.toml").with_("meshes.pair.stiffness", "1.6e12 N/m")
        found = rg.transient(model, time=0.025, discard=0.025, steps=1440, method=mode, error_estimate=False)
        return found.contacts[0].mean_force_n
    few, many = _with_impact(40), _with_impact(4000)
    claimed = few.quantity_error + many.quantity_error + 1e-9 * few.quantity_scale
    return float((np.abs(few.quantity_value - many.quantity_value) / claimed).max())


@cache
def _with_impact(records: int) -> TransientResult:
    changes = {"meshes.stage.corner_impact": _IMPACT, "operation.speed": "1000 rpm"}
    model = rg.load(_MODELS / "flexible_pair.toml").with_(changes)
    return rg.transient(model, time=0.03, discard=0.06, records=records)


def _drift(stiffness: float, method: str) -> float:
    law = MeshContact(stiffness, gap="unilateral", error_mean=1.0)
    system = local_system([[1.0]], [[0.0]], [[1.0]], [0.0], [(law, [[1.0]])])
    rate = np.sqrt(1.0 + stiffness)
    free = 2.0 * (np.pi - np.arccos(1.0 / 3.0))
    period = free + (np.pi - 2.0 * np.arctan2(1.0 / (1.0 + stiffness), np.sqrt(8.0) / rate)) / rate
    motion = integrate(system, method, period / _STEPS, _PERIODS * _STEPS, [-3.0], [0.0])
    energy = 0.5 * motion.v[:, 0] ** 2 + 0.5 * motion.q[:, 0] ** 2 + motion.stored
    return float(np.abs(energy / energy[0] - 1.0).max() / _PERIODS)
