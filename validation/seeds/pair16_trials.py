"""Claims of the 16-dof account that it gives no numbers for, tried: impacts of loaded teeth, modes, backlash, both helices."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

import rotorgear as rg
from rotorgear.analysis.sweep.classify import period_in
from validation.seeds import misprints
from validation.seeds.corner import LoadedImpact, loaded_teeth_impact
from validation.seeds.models import changed, loaded
from validation.seeds.pair16 import CASES, FILES, PAIRS, geometry, pair, ripple

OMEGA = 2000.0 * math.pi / 30.0
# Errors of the teeth (m), which the account does not give: they let a corner meet earlier still.
ERRORS = (0.0, 5e-6, 10e-6)
# Speeds in rpm, shares of the load and backlash of the trial on contact losses; the account gives no backlash.
SPEEDS = tuple(range(500, 6001, 250))
LOADS = {"full": 1.0, "light": 0.1}
BACKLASH = 100e-6


def quick() -> dict[str, float | str]:
    """What follows without a run."""
    waves = {
        name: [abs(a) for a in ripple(geometry(teeth, helix, 0.054)[2])] for name, (teeth, helix, _) in PAIRS.items()
    }
    stiffness = {name: float(loaded(file).meshes["left"].stiffness) for name, file in FILES.items()}  # type: ignore[arg-type]
    lower = sum(stiffness["b"] * b < stiffness["a"] * a for a, b in zip(waves["a"], waves["b"], strict=True))
    return {
        "dofs": float(rg.check(loaded(FILES["a"])).to_dict()["dofs"]),
        "waves_lower": float(lower),
        "stiffness_ratio": stiffness["b"] / stiffness["a"],
        "asymmetry": misprints.pair16_axial(),
        "advice_25": geometry((34, 80), 25.0, 0.054)[2].total_contact_ratio,
        "advice_35": geometry((34, 80), 35.0, 0.054)[2].total_contact_ratio,
        "axial_35": math.tan(math.radians(35.0)) / math.tan(math.radians(25.0)),
    }


def derived(values: Mapping[str, Any]) -> dict[str, float]:
    """Speeds at which flanks part; by how much the impact of loaded teeth falls (%) from A to B; its velocity, B over A."""
    return {
        "parted_full": values["parted_full_a"] + values["parted_full_b"],
        "fe_force_drop": 100.0 * (1.0 - values["fe_force_b"] / values["fe_force_a"]),
        "velocity_ratio": values["fe_velocity_b"] / values["fe_velocity_a"],
    }


def _impact(name: str, teeth: tuple[int, int], helix: float, width: float) -> dict[str, float]:
    """Impact forces (N) of a half pair at 1000 N m over errors of its teeth, velocity and compliance without them."""
    model = pair(teeth, helix, width, 1000.0)
    found: list[LoadedImpact] = [
        loaded_teeth_impact(model, 1000.0, geometry(teeth, helix, width), OMEGA, error) for error in ERRORS
    ]
    return {
        f"fe_force_{name}": found[0].force,
        f"fe_force_low_{name}": min(one.force for one in found),
        f"fe_force_high_{name}": max(one.force for one in found),
        f"fe_velocity_{name}": found[0].velocity,
    }


def _modes() -> dict[str, float]:
    """Frequency (Hz) of the mode that strains the meshes most, and the smallest relative distance of two elastic frequencies."""
    found = {}
    for name, file in FILES.items():
        result = rg.modal(loaded(file), modes=16)
        strain = sum(result.strain_energy[f"meshes.{side}"] for side in ("left", "right"))
        hz = np.sort(result.frequency_hz[result.frequency_hz > 10.0])
        found[f"mesh_mode_{name}"] = float(result.frequency_hz[int(np.argmax(strain))])
        found[f"closest_{name}"] = 100.0 * float(np.min(np.diff(hz) / hz[1:]))
    return found | {
        "mesh_mode_ratio": found["mesh_mode_b"] / found["mesh_mode_a"],
        "closest_ratio": found["closest_b"] / found["closest_a"],
    }


def _helices() -> dict[str, float]:
    """Largest difference of the forces of both helices over their mean, pair A."""
    model = loaded(FILES["a"])
    period = 60.0 / (2000.0 * 34.0)
    result = rg.transient(model, steps=200, records=200, discard=100 * period, time=20 * period, error_estimate=False)
    force = result.mesh_force[result.counted]
    return {"helices": float(np.abs(force[:, 0] - force[:, 1]).max() / force.mean())}


def _with_backlash(name: str, load: float) -> rg.Model:
    """A pair with backlash at a share of the printed load."""
    base = loaded(FILES[name])
    loads = {one: {"torque": load * (part.torque or 0.0)} for one, part in base.loads.items() if part.torque}
    return changed(base, meshes={side: {"backlash": BACKLASH} for side in ("left", "right")}, loads=loads)


def _backlash(word: str, name: str) -> dict[str, float]:
    """Speeds at which the flanks part, and at which the motion is not of one period, and the largest dynamic factor over them."""
    result = rg.sweep(
        _with_backlash(name, LOADS[word]),
        {"operation.speed": [f"{rpm} rpm" for rpm in SPEEDS]},
        steps=100,
        discard=400,
        sample=100,
    )
    other = [p for p in range(len(SPEEDS)) if period_in(result.motion_at(p)) != 1]
    return {
        f"parted_{word}_{name}": float(np.count_nonzero(result.losses[:, 0].max(axis=1) > 0.0)),
        f"other_{word}_{name}": float(len(other)),
        f"kv_{word}_{name}": float(np.nanmax(result.dynamic_factor[:, 0])),
    }


# What takes runs; see kept.py.
PIECES: dict[str, Callable[[], Mapping[str, Any]]] = {
    **{f"impact_{name}": partial(_impact, name, teeth, helix, 0.054) for name, (teeth, helix, _) in PAIRS.items()},
    **{
        f"impact_case{n}": partial(_impact, f"case{n}", (34, 80), helix, 1e-3 * width)
        for n, (helix, width, _) in enumerate(CASES, 1)
    },
    "modes": _modes,
    "helices": _helices,
    **{f"backlash_{word}_{name}": partial(_backlash, word, name) for word in LOADS for name in FILES},
}
