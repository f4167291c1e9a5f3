"""The herringbone pair of 24 dofs: geometry, the route over the speed, and the sense of the trends.

A response counts as kT when points k mesh periods apart agree to 2 % of the largest of peak to peak and 0.05 um, and as chaotic
where the largest Lyapunov exponent is above 0.02 per mesh period, which is what `rotorgear sweep` does.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from itertools import product
from typing import Any

import numpy as np

import rotorgear as rg
from rotorgear.analysis.sweep.classify import CHAOTIC, NOT_SETTLED
from rotorgear.forces.designations import designated, inner_geometry
from validation.seeds import misprints
from validation.seeds.models import changed, loaded
from validation.seeds.motions import (
    ends,
    kinds,
    kinds_so_far,
    least_share,
    most,
    number,
    order,
    spread,
    stated,
    static_share,
)
from validation.seeds.motions import route as stretches

MODEL = "herringbone_pair_24dof"
SECOND = "herringbone_pair_24dof_set2"
# Usual sizes of NJ209 and 6211, and the middle of their normal clearance; the account gives neither what rolls nor a clearance.
# NJ209 is a roller bearing: exponent 10/9, not the printed 3/2.
ROLLING: dict[str, dict[str, Any]] = {
    "pinion": {
        "kind": "roller",
        "elements": 15,
        "element_diameter": 11e-3,
        "pitch_diameter": 65e-3,
        "length": 10e-3,
        "clearance": 45e-6,
    },
    "gear": {
        "kind": "ball",
        "elements": 10,
        "element_diameter": 14.29e-3,
        "pitch_diameter": 77.5e-3,
        "clearance": 18e-6,
    },
}
STEPS = 160
# Set 1 has chaos that lasts for up to two thousand periods before it falls onto a small motion of one period, and exponents that
# take hundreds of periods to average.
SETTLE = 2500
KEPT = 640
SETTLE_2 = 200
KEPT_2 = 64
SPEEDS = tuple(np.arange(4600.0, 6001.0, 50.0).tolist())
SPEEDS_2 = tuple(np.arange(3e3, 40.1e3, 500.0).tolist())
# Laws of rolling elements run one by one, so few speeds and periods.
SPEEDS_BEARINGS = (4600.0, 5800.0, 6000.0)
SETTLE_BEARINGS = 60
# The trends take runs from several starts, for motions coexist, and long ones: with a backlash of 1 or 5 um chaos may be a
# transient of thousands of periods, and only thousands of periods tell the exponent of a torus beside it from that of chaos.
LONG_SETTLE = 3000
LONG_KEPT = 8000
STARTS = 4
TRENDS: dict[str, dict[str, tuple[float, ...]]] = {
    "torque": {"torques": (75.0, 150.0, 300.0, 600.0, 1200.0)},
    "damping": {"damping": (0.5, 1.0, 2.0, 4.0, 8.0)},
    "backlash": {"backlash": (1e-6, 5e-6, 10e-6, 20e-6, 40e-6)},
    "stiffness": {"stiffness": (0.5, 0.7, 1.0, 1.4, 2.0)},
}


def route(
    name: str, speeds: Sequence[float], settle: int = SETTLE, count: int = KEPT, *, starts: int = 1
) -> rg.SweepResult:
    """Motions over speeds in rpm, the first run of each from its own static start."""
    return rg.sweep(
        loaded(name),
        {"operation.speed": [f"{rpm} rpm" for rpm in speeds]},
        steps=STEPS,
        discard=settle,
        sample=count,
        initial_conditions=starts,
    )


def on_bearings() -> rg.Model:
    """Set 1 on rolling bearings with clearance, under its weight.

    The account has the contacts between bearing node and ground and a spring between gear half and node. Here the contacts are
    between half and node, whose pedestal is that spring: the same two in series about the same 2 kg.
    """
    bearings = {f"{who}_{side}": {"rolling": one} for who, one in ROLLING.items() for side in ("left", "right")}
    return changed(loaded(MODEL), bearings=bearings, operation={"": {"gravity": [0.0, -9.81, 0.0]}})


def apart(
    torques: Sequence[float] = (150.0,),
    backlash: Sequence[float] = (40e-6,),
    damping: Sequence[float] = (1.0,),
    stiffness: Sequence[float] = (1.0,),
    settle: int = LONG_SETTLE,
) -> rg.SweepResult:
    """Motions of set 1 at 6000 rpm from several starts; damping and stiffness are factors."""
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
    return rg.sweep(
        base,
        {"point": list(range(len(points)))},
        steps=STEPS,
        discard=settle,
        sample=LONG_KEPT,
        initial_conditions=STARTS,
        change=changed_to,
    )


def trend(result: rg.SweepResult) -> list[tuple[str, int]]:
    """Motion of most starts at each point and the mean share (%) of the time apart, to 10 %."""
    return [
        (most(kinds_so_far(result, p)), 10 * round(10.0 * result.apart[p, :, 0].mean()))
        for p in range(len(result.values))
    ]


def _input(name: str) -> float:
    """Torque (N m) into both halves of the pinion."""
    return sum(load.torque or 0.0 for load in loaded(name).loads.values() if load.kind == "input")


def names(result: rg.SweepResult) -> list[str]:
    """Motions from the static start; those beyond 4T and chaotic ones count as "others"."""
    found = [result.motion_at(p) for p in range(len(result.values))]
    return [kind if kind in ("1T", "2T", "3T", "4T", NOT_SETTLED) else "others" for kind in found]


def summary(result: rg.SweepResult) -> str:
    """Stretches of equal motions: "1T to 4900, 2T to 5100 rpm"."""
    return stretches(result, names(result)) + " rpm"


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
        **_bearings(),
        "solid_pinion": _solid(gears[0]["reference_diameter_m"]),
        "solid_gear": _solid(gears[1]["reference_diameter_m"]),
        **_tooth_force(gears[0]),
        **_misprinted(gears[0]),
    }


def _bearings() -> dict[str, float]:
    """Boundary dimensions in mm by the designations (ISO 15)."""
    found = {name: designated(name) for name in ("NJ209", "6211")}
    # Of a line contact 10/9, of a point contact 3/2.
    exponents = {"roller": 10.0 / 9.0, "ball": 1.5}
    return {f"exponent_{name}": exponents[inner_geometry(name)[0]["kind"]] for name in found} | {
        f"{key}_{name}": 1e3 * float(getattr(one, key))
        for name, one in found.items()
        for key in ("bore", "outer", "width")
    }


def _solid(diameter: float) -> float:
    """Mass (kg) of a half as a solid disc of steel over the printed face width."""
    return 7850.0 * math.pi / 4.0 * diameter**2 * 0.12


def _tooth_force(pinion: dict[str, Any]) -> dict[str, float]:
    """Mean force (N) of a helix at 150 N m and 300 N m, and the tangential load over the face (N/mm) at 150 N m."""
    arm = 0.5 * pinion["base_diameter_m"] * math.cos(math.radians(pinion["base_helix_angle_deg"]))
    return {
        "force_150": 75.0 / arm,
        "force_300": 150.0 / arm,
        "line_load": 75.0 / (0.5 * pinion["reference_diameter_m"]) / 120.0,
    }


def _misprinted(pinion: dict[str, Any]) -> dict[str, float]:
    """Misprints: force left on both gears, arm of a tooth force, motions of rotation with a spring to the ground."""
    angle, helix = math.radians(20.0), math.radians(22.0)
    right = math.cos(math.radians(pinion["base_helix_angle_deg"]))
    printed, opposite = misprints.pair24_force()
    return {
        "left_over": printed,
        "left_over_opposite": opposite,
        "arm_ratio": math.cos(angle) * math.cos(helix) / right,
        "rigid": float(rg.modal(loaded(MODEL), modes=4).rigid.sum()),
    }


def set_1() -> dict[str, float | str]:
    """The route of set 1 and two of its exponents."""
    return of_set_1(route(MODEL, SPEEDS, starts=STARTS))


def of_set_1(first: rg.SweepResult, settle: int = SETTLE) -> dict[str, float | str]:
    """The rows of the page that tell of it."""
    found = [first.motion_at(p) for p in range(len(SPEEDS))]
    in_chaos = SPEEDS.index(5950.0)
    begin = f"static; {settle} + {KEPT} T"
    return {
        "route": summary(first),
        "route_order": order(["chaotic" if kind == CHAOTIC else kind for kind in found]),
        "route_runs": f"{begin}; {static_share(first)}",
        "first_multi": f"{next((rpm for rpm, kind in zip(SPEEDS, found, strict=True) if kind != '1T'), math.nan):.0f}",
        "first_chaotic": f"{next((rpm for rpm, kind in zip(SPEEDS, found, strict=True) if kind == CHAOTIC), math.nan):.0f}",
        "exponent_1t": number(first.lyapunov[0, :, 0], kinds(first, 0), 3),
        "exponent_1t_runs": f"{begin}; {ends(kinds(first, 0))}",
        "exponent_chaos": number(first.lyapunov[in_chaos, :, 0], kinds(first, in_chaos), 3),
        "exponent_chaos_runs": f"{begin}; {ends(kinds(first, in_chaos))}",
        "coexist": _coexisting(first),
    }


def _coexisting(result: rg.SweepResult) -> str:
    """Speeds at which the starts end in different motions."""
    found = [p for p in range(len(result.values)) if len(set(kinds(result, p))) > 1]
    return ", ".join(f"{result.values[p, 0]:.0f} ({ends(kinds_so_far(result, p))})" for p in found) or "none"


def set_2() -> dict[str, float | str]:
    """The route of set 2."""
    second = route(SECOND, SPEEDS_2, SETTLE_2, KEPT_2)
    return {
        "high": summary(second),
        "high_order": order(names(second)),
        # Three standard errors.
        "high_exponent": stated(float(second.lyapunov[-1, 0, 0]), 3.0 * float(second.lyapunov_error[-1, 0, 0])),
        "high_first": names(second)[0],
        "high_last": names(second)[-1],
        "high_runs": f"static; {SETTLE_2} + {KEPT_2} T; {static_share(second)}",
    }


def with_clearance(settle: int = SETTLE_BEARINGS) -> rg.SweepResult:
    """Motions of set 1 on bearings with rolling elements and clearance, under its weight; counts as long as it settles."""
    return rg.sweep(
        on_bearings(),
        {"operation.speed": [f"{rpm} rpm" for rpm in SPEEDS_BEARINGS]},
        steps=STEPS,
        discard=settle,
        sample=settle,
    )


def clearance() -> dict[str, float | str]:
    """What they are called, and their exponents."""
    result = with_clearance()
    found = ", ".join(f"{result.motion_at(p)} at {rpm:.0f}" for p, rpm in enumerate(SPEEDS_BEARINGS))
    exponents = clearance_exponents(result)
    return {
        "clearance": f"{found} rpm",
        "clearance_kinds": ", ".join(result.motion_at(p) for p in range(len(SPEEDS_BEARINGS))),
        "clearance_exponent": ", ".join(exponents),
        **{f"clearance_exponent_{rpm:.0f}": text for rpm, text in zip(SPEEDS_BEARINGS, exponents, strict=True)},
    }


def clearance_exponents(result: rg.SweepResult) -> list[str]:
    """Largest exponent per mesh period at each speed, with three standard errors."""
    return [
        f"{result.lyapunov[p, 0, 0]:.3f} +- {max(3.0 * result.lyapunov_error[p, 0, 0], 1e-3):.3f}"
        for p in range(len(SPEEDS_BEARINGS))
    ]


def trend_values(name: str) -> dict[str, float | str]:
    """Motion and time apart over torque, damping, backlash or stiffness, and how many starts end in it."""
    result = apart(**TRENDS[name])  # type: ignore[arg-type]
    found = trend(result)
    values: dict[str, float | str] = {}
    for p, (motion, share) in enumerate(found):
        own = kinds_so_far(result, p)
        values |= {
            f"{name}_motion_{1 + p}": motion,
            # To 10 %, as the page has it.
            f"{name}_apart_{1 + p}": f"{share} +- 5",
            f"{name}_exponent_{1 + p}": number(result.lyapunov[p, :, 0], own, 3),
            f"{name}_peak_{1 + p}": spread(1e6 * result.peak_to_peak[p, :, 0], own, 1),
            f"{name}_rms_{1 + p}": number(1e6 * result.rms_approach[p, :, 0], own, 2),
            f"{name}_mean_force_{1 + p}": number(result.mean_force[p, :, 0], own, 0),
        }
    return values | {
        f"apart_{name}": ", ".join(f"{motion} {share} %" for motion, share in found),
        f"apart_{name}_runs": f"static and random; {LONG_SETTLE} + {LONG_KEPT} T; {least_share(result)}",
    }


# What takes runs; see kept.py.
PIECES: dict[str, Callable[[], dict[str, float | str]]] = {
    "set_1": set_1,
    "set_2": set_2,
    "clearance": clearance,
    **{name: partial(trend_values, name) for name in TRENDS},
}
