"""Errors of sweeps and transients against closed forms of linear systems."""

from __future__ import annotations

import mpmath as mp
import numpy as np

import rotorgear as rg
from tests.extreme.forced_errors import mass_on_spring
from tests.paths import ROOT


def linear_pair(stiffness: float, damping_ratio: float, **changes: object) -> rg.Model:
    """Two gears that turn, on a mesh that never parts, shaken by its first transmission error."""
    pair = rg.load(ROOT / "models" / "backlash_pair.toml")
    return pair.with_(
        {
            "meshes.pair.stiffness": stiffness,
            "meshes.pair.damping_ratio": damping_ratio,
            "meshes.pair.backlash": None,
            "meshes.pair.contact_damping": "adhesive",
            "meshes.pair.stiffness_variation": (),
            **changes,
        }
    )


def resonance(model: rg.Model, stiffness: float) -> mp.mpf:
    """w = sqrt(k (r_1^2 / I_1 + r_2^2 / I_2)) in rad/s."""
    squared = sum(mp.mpf(gear.base_radius) ** 2 / mp.mpf(gear.polar_inertia) for gear in model.gears.values())
    return mp.sqrt(mp.mpf(stiffness) * squared)


def sweep_of_pair(stiffness: float, damping_ratio: float, ratio: float, **options: int) -> float:
    """Peak to peak of the penetration x'' + 2 zeta w x' + w^2 x = -e'' at a mesh frequency of so many times the resonance."""
    model = linear_pair(stiffness, damping_ratio)
    w = resonance(model, stiffness)
    forced = mp.mpf(ratio) * w
    speed = float(forced / model.gears["pinion"].teeth)
    found = rg.sweep(model, {"operation.speed": [speed]}, initial_conditions=1, **options)
    exact = 2 * mp.mpf("3e-6") * forced**2 / abs(w**2 - forced**2 + 2j * mp.mpf(damping_ratio) * w * forced)
    return float(abs(mp.mpf(float(found.peak_to_peak.ravel()[0])) / exact - 1))


def stepped_torque(stiffness: float) -> float:
    """An undamped pair under a torque that doubles at once: its force swings between both static ones and as far beyond.

    F(t) = F (1 + (1 - cos w t) / 2) for equal inertias, so 2 F at most, where the step is short beside a period.
    """
    loads = {
        "drive": {"shaft": "a", "kind": "input", "torque": 10.0, "step_to": 2.0, "step_at": 0.0},
        "take": {"shaft": "b", "kind": "output"},
    }
    quiet = {"meshes.pair.transmission_error": (), "operation.torque": None, "operation.output_shaft": None}
    model = linear_pair(stiffness, 0.0, **quiet, loads=loads)
    period = float(2 * mp.pi / resonance(model, stiffness))
    found = rg.transient(model, time=period, discard=0.0, method="exponential")
    radius = mp.mpf(model.gears["pinion"].base_radius)
    force = 10 / radius
    return float(abs(mp.mpf(float(found.mesh_force.max())) / (2 * force) - 1))


def whirl_in_time(stiffness: float, damping: float, speed: float, mass: float = 2.0) -> float:
    """Root mean square of the force of a bearing under an unbalance, after its free motion has died away."""
    u = 1e-5
    model = mass_on_spring(stiffness, damping, mass, u)
    found = rg.transient(model, speed=speed, time=40.0 * np.pi / speed, discard=400.0 * np.pi / speed)
    W = mp.mpf(speed)
    radius = u * W**2 / abs(mp.mpc(stiffness - mass * W**2, W * damping))
    exact = radius * abs(mp.mpc(stiffness, W * damping)) / mp.sqrt(2)
    force = found.history("bearings.b force x")[found.counted]
    return float(abs(mp.mpf(float(np.sqrt(np.mean(force**2)))) / exact - 1))
