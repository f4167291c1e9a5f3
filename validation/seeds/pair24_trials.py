"""Claims of the 24-dof account tried: load over the speeds, cascade and windows, unequal helices, resonance, multipliers."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

import rotorgear as rg
from rotorgear.analysis.sweep.classify import CHAOTIC
from validation.seeds.models import changed, loaded
from validation.seeds.motions import order
from validation.seeds.pair24 import MODEL, SETTLE_BEARINGS, SPEEDS, STEPS, on_bearings

SETTLE = 800
COUNT = 200
# Speeds in rpm at which the cascade behind the first doubling, and windows in chaos, are looked for.
CASCADE = tuple(np.arange(5780.0, 5901.0, 10.0).tolist())
WINDOWS = tuple(np.arange(5900.0, 6401.0, 10.0).tolist())
# Transmission error of the right helix over that of the left.
UNEQUAL = 1.25


def quick() -> dict[str, float | str]:
    """Mode that strains the meshes most, over the stiffness of the teeth."""
    found = {f"mesh_mode_{word}": _mesh_mode(factor) for word, factor in (("soft", 0.5), ("own", 1.0), ("stiff", 2.0))}
    return {
        **found,
        "mode_rise": found["mesh_mode_stiff"] / found["mesh_mode_soft"],
        "frequency_ratio": 2200.0 / found["mesh_mode_own"],
        "frequency_ratio_soft": 2200.0 / found["mesh_mode_soft"],
    }


def _mesh_mode(factor: float) -> float:
    """Frequency (Hz) of the mode of set 1 that strains its meshes most."""
    base = loaded(MODEL)
    meshes = {side: {"stiffness": factor * float(base.meshes[side].stiffness)} for side in ("left", "right")}  # type: ignore[arg-type]
    result = rg.modal(changed(base, meshes=meshes), modes=24)
    strain = sum(result.strain_energy[f"meshes.{side}"] for side in ("left", "right"))
    return float(result.frequency_hz[int(np.argmax(strain))])


def _swept(
    speeds: Sequence[float], *, torque: float = 150.0, unequal: float = 1.0, direction: str = "none"
) -> rg.SweepResult:
    """Set 1 over speeds in rpm."""
    base = loaded(MODEL)
    loads: dict[str, Any] = {f"input_{side}": {"torque": 0.5 * torque} for side in ("left", "right")}
    loads["output_left"] = {"torque": 0.5 * torque * 41.0 / 22.0}
    error = [{"harmonic": 1, "amplitude": unequal * 2e-6, "phase": 0.0}]
    model = changed(base, loads=loads, meshes={"right": {"transmission_error": error}})
    options: dict[str, Any] = {} if direction == "none" else {"direction": direction}
    return rg.sweep(
        model,
        {"operation.speed": [f"{rpm} rpm" for rpm in speeds]},
        steps=STEPS,
        discard=SETTLE,
        sample=COUNT,
        **options,
    )


def _over_speeds(torque: float) -> dict[str, float]:
    """4600 to 6000 rpm at a torque (N m): speeds that are chaotic, or not of one period, and the mean peak to peak (um)."""
    result = _swept(SPEEDS, torque=torque)
    motions = [result.motion_at(p) for p in range(len(SPEEDS))]
    return {
        f"chaotic_{torque:.0f}": float(sum(kind == CHAOTIC for kind in motions)),
        f"other_{torque:.0f}": float(sum(kind != "1T" for kind in motions)),
        f"mean_peak_{torque:.0f}": 1e6 * float(result.peak_to_peak[:, 0, 0].mean()),
    }


def _unequal() -> dict[str, float | str]:
    """With a larger error on the right helix: how far the deflections of both differ (%), and the way over the speed."""
    result = _swept(SPEEDS, unequal=UNEQUAL)
    left, right = result.peak_to_peak[:, 0].T
    motions = [result.motion_at(p) for p in range(len(SPEEDS))]
    return {
        "helix_difference": 100.0 * float(np.mean(np.abs(left - right) / np.maximum(left, right))),
        "unequal_order": order([kind if kind in ("1T", "2T") else "others" for kind in motions]),
    }


def _cascade() -> dict[str, str]:
    """Motions up from that of two periods, each speed from the end of the one before."""
    up = _swept(CASCADE, direction="up")
    motions = [up.motion_at(p) for p in range(len(CASCADE))]
    return {"cascade": order(motions), "cascade_kinds": ", ".join(sorted(set(motions)))}


def _windows() -> dict[str, str]:
    """Motions in and beyond the chaos, from the static start."""
    over = _swept(WINDOWS)
    motions = [over.motion_at(p) for p in range(len(WINDOWS))]
    return {"windows": order(motions), "window_kinds": ", ".join(sorted(set(motions)))}


def _doubling() -> dict[str, float | str]:
    """Where the motion of one period of set 1 loses its stability, how, and where with a little less ripple."""
    own, weaker = (_first_loss(ripple) for ripple in (0.15, 0.1))
    return {
        "doubling_kind": own[0],
        "doubling_rpm": own[1],
        "doubling_rpm_weaker": weaker[1],
        "doubling_shift": 100.0 * abs(weaker[1] / own[1] - 1.0),
    }


def _first_loss(ripple: float) -> tuple[str, float]:
    """Kind and speed (rpm) of the first loss of stability over 5500 to 5900 rpm with a ripple of the stiffness."""
    variation = [{"harmonic": 1, "amplitude": ripple, "phase": 0.0}]
    model = changed(loaded(MODEL), meshes={side: {"stiffness_variation": variation} for side in ("left", "right")})
    found = rg.orbits(model, {"operation.speed": ("5500 rpm", "5900 rpm")}, step=0.08)
    first = min(found.special_points, key=lambda point: point.value)
    return first.kind, first.value * 30.0 / math.pi


def _clearance() -> dict[str, str]:
    """Set 1 on bearings with clearance at 6000 rpm over ten times as many periods: label, exponent with three standard errors."""
    result = rg.sweep(
        on_bearings(),
        {"operation.speed": ["6000 rpm"]},
        steps=STEPS,
        discard=10 * SETTLE_BEARINGS,
        sample=10 * SETTLE_BEARINGS,
    )
    error = max(3.0 * float(result.lyapunov_error[0, 0, 0]), 1e-3)
    return {
        "clearance_longer": result.motion_at(0),
        "clearance_exponent_longer": f"{result.lyapunov[0, 0, 0]:.3f} +- {error:.3f}",
    }


# What takes runs; see kept.py.
PIECES: dict[str, Callable[[], Mapping[str, Any]]] = {
    **{f"torque_{torque:.0f}": partial(_over_speeds, torque) for torque in (150.0, 300.0)},
    "unequal": _unequal,
    "cascade": _cascade,
    "windows": _windows,
    "doubling": _doubling,
    "clearance": _clearance,
}
