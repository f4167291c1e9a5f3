"""The herringbone pair of 24 dofs: geometry, the route over the speed, and the sense of the trends.

A response counts as kT when points k mesh periods apart agree to 2 % of the largest of peak to peak and 0.05 um, and as chaotic
where the largest Lyapunov exponent is above 0.02 per mesh period, which is what `rotorgear sweep` does.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from functools import cache
from itertools import product
from typing import Any

import numpy as np

import rotorgear as rg
from validation.seeds.rows import changed, loaded

MODEL = "herringbone_pair_24dof"
SECOND = "herringbone_pair_24dof_set2"
STEPS = 160
KEPT = 64
SETTLE = 250
# The trends take longer runs from several starts: motions that are about to lose their order settle slowly, and some coexist.
LONG_SETTLE = 1500
LONG_KEPT = 300
STARTS = 16


def route(name: str, speeds: Sequence[float], settle: int = SETTLE) -> rg.SweepResult:
    """Motions over speeds in rpm, each from its own static start."""
    return rg.sweep(
        loaded(name), {"operation.speed": [f"{rpm} rpm" for rpm in speeds]}, steps=STEPS, discard=settle, sample=KEPT
    )


def apart(
    torques: Sequence[float] = (150.0,),
    backlash: Sequence[float] = (40e-6,),
    damping: Sequence[float] = (1.0,),
    stiffness: Sequence[float] = (1.0,),
) -> list[str]:
    """Motion of set 1 at 6000 rpm from most starts, mean share of the time apart to 10 %; damping and stiffness are factors."""
    base = loaded(MODEL)
    # type: ignore[arg-type]
    mean = float(base.meshes["left"].stiffness)
    c = base.meshes["left"].damping or 0.0

    def changed_to(_: rg.Model, at: tuple[float, ...]) -> rg.Model:
        torque, play, share, factor = points[round(at[0])]
        loads: dict[str, Any] = {f"input_{side}": {"torque": 0.5 * torque} for side in ("left", "right")}
        loads["output_left"] = {"torque": 0.5 * torque * 41.0 / 22.0}
        mesh = {"backlash": play, "stiffness": factor * mean, "damping": share * c * math.sqrt(factor)}
        return changed(base, loads=loads, meshes={"left": mesh, "right": mesh})

    points = list(product(torques, backlash, damping, stiffness))
    result = rg.sweep(
        base,
        {"point": list(range(len(points)))},
        steps=STEPS,
        discard=LONG_SETTLE,
        sample=LONG_KEPT,
        initial_conditions=STARTS,
        change=changed_to,
    )
    kinds = [Counter(result.motion_at(p, r) for r in range(STARTS)).most_common(1)[0][0] for p in range(len(points))]
    return [f"{kind} {10 * round(10.0 * result.apart[p, :, 0].mean())} %" for p, kind in enumerate(kinds)]


def _input(name: str) -> float:
    """Torque (N m) into both halves of the pinion."""
    return sum(load.torque or 0.0 for load in loaded(name).loads.values() if load.kind == "input")


def summary(result: rg.SweepResult) -> str:
    """Runs of equal motions: "1T to 4900, 2T to 5100 rpm"; beyond 4T all count as one, as short runs don't tell them apart."""
    names = [
        kind if kind in ("1T", "2T", "3T", "4T") else "longer, chaotic or unsettled"
        for kind in (result.motion_at(p) for p in range(len(result.values)))
    ]
    last = [i for i, name in enumerate(names) if i + 1 == len(names) or names[i + 1] != name]
    return ", ".join(f"{names[i]} to {result.values[i, 0]:.0f}" for i in last) + " rpm"


def quick() -> dict[str, float | str]:
    """What follows without a run."""
    sheet = rg.check(loaded(MODEL)).to_dict()
    mesh = sheet["meshes"][0]
    sheets = {gear["name"]: gear for gear in rg.gear(loaded(MODEL)).to_dict()["gears"]}
    gears = [sheets[f"{name}_left"] for name in ("pinion", "gear")]
    return {
        "dofs": float(sheet["dofs"]),
        "torque": _input(MODEL),
        "torque_2": _input(SECOND),
        "d1": 1e3 * gears[0]["reference_diameter_m"],
        "d2": 1e3 * gears[1]["reference_diameter_m"],
        "rb1": 500.0 * gears[0]["base_diameter_m"],
        "rb2": 500.0 * gears[1]["base_diameter_m"],
        "a": 1e3 * mesh["centre_distance_m"],
        "eps_alpha": mesh["transverse_contact_ratio"],
        "eps_beta": mesh["overlap_ratio"],
        "mesh_hz": mesh["mesh_frequency_hz"],
        # ISO 15: from code 04 on, the bore in mm is five times the last two figures of the designation.
        "bore_NJ209": 5.0 * int("NJ209"[-2:]),
        "bore_6211": 5.0 * int("6211"[-2:]),
    }


@cache
def values() -> dict[str, float | str]:
    """What takes runs."""
    first = route(MODEL, np.arange(4600.0, 6001.0, 50.0).tolist())
    kinds = [first.motion_at(p) for p in range(len(first.values))]
    speeds = first.values[:, 0]
    found: dict[str, float | str] = {
        "route": summary(first),
        "high": summary(route(SECOND, np.arange(3e3, 40.1e3, 500.0).tolist(), 200)),
        "first_multi": f"{next((rpm for rpm, kind in zip(speeds, kinds, strict=True) if kind != '1T'), math.nan):.0f}",
        "first_chaotic": f"{next((rpm for rpm, kind in zip(speeds, kinds, strict=True) if kind == 'chaotic'), math.nan):.0f}",
        "exponent_1t": round(float(first.lyapunov[0, 0, 0]), 3),
        "exponent_chaos": round(float(first.lyapunov[kinds.index("chaotic") + 1, 0, 0]), 1),
    }
    trends = {
        "torque": apart(torques=(75.0, 150.0, 300.0, 600.0, 1200.0)),
        "damping": apart(damping=(0.5, 1.0, 2.0, 4.0, 8.0)),
        "backlash": apart(backlash=(1e-6, 5e-6, 10e-6, 20e-6, 40e-6)),
        "stiffness": apart(stiffness=(0.5, 0.7, 1.0, 1.4, 2.0)),
    }
    return found | {f"apart_{name}": ", ".join(entries) for name, entries in trends.items()}
