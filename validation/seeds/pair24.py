"""The herringbone pair of 24 dofs: geometry, the route over the speed by Poincare points, and the sense of the trends.

A response counts as kT when points k mesh periods apart agree to 2 % of the largest of peak to peak and 0.05 um, and as
irregular where no k up to 8 does. Exponents belong to the sweep of a parameter, not to this page.
"""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np

import rotorgear as rg
from validation.seeds.rows import changed, loaded

MODEL = "herringbone_pair_24dof"
SECOND = "herringbone_pair_24dof_set2"
STEPS, KEPT, LONGEST = 160, 64, 8
IRREGULAR = "irregular"


def poincare(model: rg.Model, rpm: float, settle: int) -> tuple[str, rg.TransientResult]:
    """Period of the deflection of the left helix at a speed ("1T", ..., "irregular"), and the run."""
    period = 60.0 / (rpm * 22.0)
    result = rg.transient(
        model, speed=rpm * math.pi / 30.0, method="newmark", steps=STEPS, records=40, settle=settle * period,
        time=KEPT * period, error_estimate=False,
    )  # fmt: skip
    x = result.history("deflection left")[result.counted]
    points, scale = x[::40], max(float(np.ptp(x)), 0.05e-6)
    for k in range(1, LONGEST + 1):
        if np.abs(points[k:] - points[:-k]).max() < 0.02 * scale:
            return f"{k}T", result
    return IRREGULAR, result


def route() -> dict[float, str]:
    """Periods at 4600 to 6000 rpm in steps of 50, set 1, each from its own static start."""
    return {rpm: poincare(loaded(MODEL), rpm, 250)[0] for rpm in np.arange(4600.0, 6001.0, 50.0)}


def high_speeds() -> dict[float, str]:
    """Periods of set 2 over 3000 to 40000 rpm in steps of 1000, and of 250 where it is not simple."""
    speeds = np.union1d(np.arange(3e3, 40.5e3, 1e3), np.arange(8e3, 10.1e3, 250.0))
    return {rpm: poincare(loaded(SECOND), rpm, 200)[0] for rpm in speeds}


def apart(torque: float = 150.0, backlash: float = 40e-6, damping: float = 1.0, stiffness: float = 1.0) -> str:
    """Period of set 1 at 6000 rpm and its share of the time apart to 5 %; damping and stiffness are factors."""
    base = loaded(MODEL)
    mean, c = float(base.meshes["left"].stiffness), base.meshes["left"].damping or 0.0  # type: ignore[arg-type]
    out = 0.5 * torque * 41.0 / 22.0
    loads: dict[str, Any] = {f"input_{side}": {"torque": 0.5 * torque} for side in ("left", "right")}
    mesh = {"backlash": backlash, "stiffness": stiffness * mean, "damping": damping * c * math.sqrt(stiffness)}
    model = changed(base, loads=loads | {"output_left": {"torque": out}}, meshes={"left": mesh, "right": mesh})
    period, result = poincare(model, 6000.0, 250)
    return f"{period} {5 * round(20.0 * float(result.contact_time[0, 1]))} %"


def _input(name: str) -> float:
    """Torque (N m) into both halves of the pinion."""
    return sum(load.torque or 0.0 for load in loaded(name).loads.values() if load.kind == "input")


def summary(periods: dict[float, str]) -> str:
    """Runs of equal periods: "1T to 4900, 2T to 5100, irregular to 6000 rpm"."""
    speeds = list(periods)
    ends = [i for i, rpm in enumerate(speeds) if i + 1 == len(speeds) or periods[speeds[i + 1]] != periods[rpm]]
    return ", ".join(f"{periods[speeds[i]]} to {speeds[i]:.0f}" for i in ends) + " rpm"


def quick() -> dict[str, float | str]:
    """What follows without a run."""
    sheet = rg.describe_model(loaded(MODEL)).to_dict()
    mesh = sheet["meshes"][0]
    sheets = {gear["name"]: gear for gear in rg.gear_sheet(loaded(MODEL)).to_dict()["gears"]}
    gears = [sheets[f"{name}_left"] for name in ("pinion", "gear")]
    return {
        "dofs": float(sheet["dofs"]), "torque": _input(MODEL), "torque_2": _input(SECOND),
        "d1": 1e3 * gears[0]["reference_diameter_m"], "d2": 1e3 * gears[1]["reference_diameter_m"],
        "rb1": 500.0 * gears[0]["base_diameter_m"], "rb2": 500.0 * gears[1]["base_diameter_m"],
        "a": 1e3 * mesh["centre_distance_m"], "eps_alpha": mesh["transverse_contact_ratio"],
        "eps_beta": mesh["overlap_ratio"], "mesh_hz": mesh["mesh_frequency_hz"],
    }  # fmt: skip


@cache
def values() -> dict[str, float | str]:
    """What takes runs."""
    first = route()
    irregular = [rpm for rpm, period in first.items() if period == IRREGULAR]
    multi = [rpm for rpm, period in first.items() if period not in ("1T", IRREGULAR)]
    found: dict[str, float | str] = {
        "route": summary(first), "high": summary(high_speeds()),
        "first_multi": f"{min(multi):.0f}" if multi else "none",
        "first_irregular": f"{min(irregular):.0f}" if irregular else "none",
    }  # fmt: skip
    trends = {
        "torque": [apart(torque=t) for t in (75.0, 150.0, 300.0, 600.0, 1200.0)],
        "damping": [apart(damping=c) for c in (0.5, 1.0, 2.0, 4.0, 8.0)],
        "backlash": [apart(backlash=j) for j in (1e-6, 5e-6, 10e-6, 20e-6, 40e-6)],
        "stiffness": [apart(stiffness=k) for k in (0.5, 0.7, 1.0, 1.4, 2.0)],
    }
    return found | {f"apart_{name}": ", ".join(found) for name, found in trends.items()}
