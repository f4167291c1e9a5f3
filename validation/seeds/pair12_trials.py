"""Claims of the 12-dof account tried: impacts by loaded teeth, losses of contact, chaos, Gamma, friction, mirrored hands."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

import rotorgear as rg
from rotorgear.analysis.sweep.classify import CHAOTIC
from validation.seeds.corner import loaded_teeth_impact
from validation.seeds.models import changed, loaded
from validation.seeds.motions import ends, kinds, most
from validation.seeds.pair12 import MODEL, TABLE, at_ratio, backlash_effect, draws, geometry, run, vibration

OMEGA = 2000.0 * math.pi / 30.0
# Errors of the teeth (m) and torques on half a pinion (N m): 800 N m on the pinion, and on the gear.
ERRORS = (0.0, 5e-6, 10e-6)
TORQUES = (400.0, 400.0 * 17.0 / 44.0)
FRICTION = 0.05
STARTS = 4
SETTLE = 1000
COUNT = 200


def quick() -> dict[str, float | str]:
    """Nothing follows without a run."""
    return {}


def _impact(i: int) -> dict[str, float]:
    """Both formulas of the account with loaded teeth at a shift of its table (kN), over errors and readings of the torque."""
    shift = TABLE[i - 1][0]
    gears = geometry(shift)
    model = changed(
        loaded(MODEL),
        gears={f"pinion_{side}": {"profile_shift": shift} for side in ("left", "right")},
        shafts={f"gear_{side}": {"position": (gears[2].centre_distance, 0.0)} for side in ("left", "right")},
    )
    tried = [loaded_teeth_impact(model, torque, gears, OMEGA, error) for torque in TORQUES for error in ERRORS]
    own = tried[0]
    return {
        f"fe_force_{i}": 1e-3 * own.force,
        f"fe_force_low_{i}": 1e-3 * min(one.force for one in tried),
        f"fe_force_high_{i}": 1e-3 * max(one.force for one in tried),
        f"fe_alone_{i}": 1e-3 * own.alone,
        f"fe_alone_low_{i}": 1e-3 * min(one.alone for one in tried),
        f"fe_alone_high_{i}": 1e-3 * max(one.alone for one in tried),
        f"fe_deviation_{i}": 100.0 * (1.0 - own.force / own.alone),
        f"fe_carrying_{i}": 1e9 * own.carrying,
        f"fe_mean_{i}": own.stiffness,
        f"fe_swing_{i}": 100.0 * own.peak_to_peak / own.stiffness,
    }


def _motions() -> dict[str, float | str]:
    """Motions, exponents and losses of contact of the chosen set at the ratios with printed vibration, from several starts."""
    points = [at_ratio(TABLE[i][1], 1e3 * TABLE[i][3]) for i in (0, 2, 4)]
    result = rg.sweep(
        loaded(MODEL),
        {"point": [0, 1, 2]},
        steps=200,
        discard=SETTLE,
        sample=COUNT,
        initial_conditions=STARTS,
        change=lambda _, at: points[int(at[0])],
    )
    found: dict[str, float | str] = {}
    for p, i in enumerate((1, 3, 5)):
        own = kinds(result, p)
        found |= {
            f"motion_{i}": most(own),
            f"exponent_{i}": float(result.lyapunov[p, :, 0].max()),
            f"losses_{i}": float(result.losses[p].max()),
            f"runs_{i}": f"static and random; {SETTLE} + {COUNT} T; {ends(own)}",
        }
    return found


def _chaos() -> dict[str, float | str]:
    """Largest exponent at 4.07 over the random sets, how many are chaotic, and in how many the flanks part."""
    sets = draws()
    result = rg.sweep(
        loaded(MODEL),
        {"set": list(range(len(sets)))},
        steps=200,
        discard=400,
        sample=100,
        change=lambda _, at: at_ratio(TABLE[4][1], 1e3 * TABLE[4][3], **sets[int(at[0])]),
    )
    return {
        "chaotic_sets": float(sum(result.motion_at(p) == CHAOTIC for p in range(len(sets)))),
        "largest_exponent": float(result.lyapunov[:, 0, 0].max()),
        "parted_sets": float(np.count_nonzero(result.losses[:, 0].max(axis=1) > 0.0)),
    }


def _gamma() -> dict[str, float]:
    """How the force changes with the backlash at the three ratios: nothing, where Gamma > 1 makes the system linear."""
    return {f"backlash_effect_{i}": backlash_effect(TABLE[i - 1][1], 1e3 * TABLE[i - 1][3]) for i in (1, 3, 5)}


def _others() -> dict[str, float]:
    """Vibration at 3.30 with friction, and with the hands of all helices changed, over that without; force along the axis."""
    base = at_ratio(3.30, 6469.0)
    rms = vibration(base)[0]
    other = {"left": "right", "right": "left"}
    mirrored = changed(base, gears={name: {"hand": other[str(gear.hand)]} for name, gear in base.gears.items()})
    rubbing = changed(base, meshes={side: {"friction_coefficient": FRICTION} for side in ("left", "right")})
    result = run(base)
    axial = math.sin(math.radians(24.43)) * (result.mesh_force[:, 0] - result.mesh_force[:, 1])
    return {
        "mirror": vibration(mirrored)[0] / rms,
        "friction_effect": 100.0 * (vibration(rubbing)[0] / rms - 1.0),
        "net_axial": float(np.abs(axial).max() / result.mesh_force.mean()),
    }


# What takes runs; see kept.py.
PIECES: dict[str, Callable[[], Mapping[str, Any]]] = {
    **{f"impact_{i}": partial(_impact, i) for i in range(1, 6)},
    "motions": _motions,
    "chaos": _chaos,
    "gamma": _gamma,
    "others": _others,
}
