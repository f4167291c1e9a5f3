"""Claims of the marine account that it gives no numbers for, tried: backlash, ripple, helix angle, printed stiffness."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import product
from typing import Any

import numpy as np

import rotorgear as rg
from rotorgear.analysis.sweep.classify import CHAOTIC
from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.pair import pair_geometry
from validation.seeds.marine import (
    COUNT,
    MODEL,
    NOMINAL,
    PITCH_RADIUS,
    RATIOS,
    SETTLE,
    STEPS,
    operating,
)
from validation.seeds.models import changed, loaded
from validation.seeds.motions import ends, kinds, spread

# What the fitted set has, in m.
BACKLASH = {"first": 40e-6, "second": 50e-6}
# Factors on it and ripples that are tried: none, and twice that of the fitted set; helix angles in deg, whose ripple is tried.
BACKLASHES = {"half": 0.5, "own": 1.0, "twice": 2.0}
RIPPLES = {"even": 0.0, "rippled": 0.24}
HELICES = (15.0, 25.0, 35.0)
# Face width of a helix (m), which the account does not give.
WIDTH = 0.2
# With the printed stiffness: drags (N m) and mesh frequencies (over that of the file) that are tried.
DRAGS = (1.0, 5.6e3, 11.2e3, 16.8e3)
FREQUENCIES = (0.1, 0.3, 1.0)


def quick() -> dict[str, float | str]:
    """Overlap ratio and ripple of the first stage at three helix angles."""
    return {
        **{f"overlap_{helix:.0f}": _teeth(helix)[0] for helix in HELICES},
        **{f"ripple_{helix:.0f}": _teeth(helix)[1] for helix in HELICES},
    }


def _teeth(helix_deg: float) -> tuple[float, float]:
    """Overlap ratio and ripple by the contact lines, for teeth of the printed base radii."""
    helix = math.radians(helix_deg)
    transverse = math.atan(math.tan(math.radians(20.0)) / math.cos(helix))
    module = 2.0 * PITCH_RADIUS / math.cos(transverse) / 25.0 * math.cos(helix)
    mesh = pair_geometry(*(GearGeometry(z, module, math.radians(20.0), helix) for z in (25, 80)), WIDTH)
    wave = 2.0 * np.sinc(mesh.transverse_contact_ratio) * np.sinc(mesh.overlap_ratio)
    return mesh.overlap_ratio, float(abs(wave))


def _region(word: str, change: Callable[[float], rg.Model], ratios: Sequence[float] = RATIOS) -> dict[str, float | str]:
    """Load ratios of region II, of chaos without its bound on the amplitude, and exponent and largest force at 0.6."""
    result = rg.sweep(
        loaded(MODEL),
        {"load ratio": list(ratios)},
        steps=STEPS,
        discard=SETTLE,
        sample=COUNT,
        change=lambda _, at: change(at[0]),
    )
    i = result.contact.index("first_lp")
    large = result.peak_to_peak[:, 0, i] > 3.0 * NOMINAL
    strong = result.lyapunov[:, 0, 0] > 0.1
    chaotic = np.array([result.motion_at(p) == CHAOTIC for p in range(len(ratios))])
    middle = ratios.index(0.6)
    # Three standard errors.
    error = 3.0 * float(result.lyapunov_error[middle, 0, 0])
    return {
        f"region_count_{word}": float(np.count_nonzero(large & strong)),
        f"chaos_count_{word}": float(np.count_nonzero(chaotic)),
        f"exponent_{word}": f"{result.lyapunov[middle, 0, 0]:.3f} +- {error:.3f}",
        f"amplitude_{word}": float(result.peak_to_peak[middle, 0, i] / NOMINAL),
        f"largest_force_{word}": 1e-3 * float(result.largest_force[middle, 0, i]),
        f"back_{word}": float(result.back[middle, 0, i]),
    }


def _with_backlash(factor: float) -> Callable[[float], rg.Model]:
    meshes = {f"{stage}_{side}": {"backlash": factor * BACKLASH[stage]} for stage in BACKLASH for side in ("hp", "lp")}
    return lambda gamma: changed(operating(gamma), meshes=meshes)


def _with_ripple(amplitude: float) -> Callable[[float], rg.Model]:
    variation = [{"harmonic": 1, "amplitude": amplitude, "phase": 0.0}] if amplitude else None
    meshes = {f"first_{side}": {"stiffness_variation": variation} for side in ("hp", "lp")}
    return lambda gamma: changed(operating(gamma), meshes=meshes)


def _soft() -> dict[str, float]:
    """The printed stiffness over load ratios, drags and mesh frequencies: chaotic points, and the largest amplitude indicator.

    The amplitude is over the static deflection at 15 kN m with that stiffness.
    """
    points = list(product(DRAGS, FREQUENCIES, RATIOS[::2]))

    def point(at: float) -> rg.Model:
        drag, factor, gamma = points[round(at)]
        speed = factor * (loaded(MODEL).operating_speed or 0.0)
        return changed(operating(gamma, drag=drag, table_stiffness=True), operation={"": {"speed": speed}})

    result = rg.sweep(
        loaded(MODEL),
        {"point": list(range(len(points)))},
        steps=STEPS,
        discard=400,
        sample=100,
        change=lambda _, at: point(at[0]),
    )
    i = result.contact.index("first_lp")
    chaotic = [result.motion_at(p) == CHAOTIC for p in range(len(points))]
    return {
        "soft_points": float(len(points)),
        "soft_chaotic": float(sum(chaotic)),
        "soft_exponent": float(np.nanmax(result.lyapunov[:, 0, 0])),
        "soft_amplitude": float(np.nanmax(result.peak_to_peak[:, 0, i])) / (100.0 * NOMINAL),
    }


def _longer() -> dict[str, str]:
    """Amplitude at 35 kN m and a load ratio of 0.3, whose bursts are rare, over ten times as many periods."""
    result = rg.sweep(
        loaded(MODEL),
        {"load ratio": [0.3]},
        steps=STEPS,
        discard=SETTLE,
        sample=10 * COUNT,
        initial_conditions=8,
        change=lambda _, at: operating(at[0], 35e3),
    )
    i = result.contact.index("first_lp")
    own = kinds(result, 0)
    return {
        "am_longer": spread(result.peak_to_peak[0, :, i] / NOMINAL, own, 2),
        "runs_longer": f"static; {SETTLE} + {10 * COUNT} of 8 T_m1; {ends(own)}",
    }


def _doubling() -> dict[str, float | str]:
    """Where the motion of one period of the file, at 30 kN m, loses its stability on the way into region II, and how."""
    found = rg.orbits(loaded(MODEL), {"loads.lp.torque": ("5600 N m", "6400 N m")}, from_transient=True, points=40)
    first = min(found.special_points, key=lambda point: point.value)
    return {"doubling_kind": first.kind, "doubling_ratio": first.value / (30e3 - first.value)}


# What takes runs; see kept.py.
PIECES: dict[str, Callable[[], Mapping[str, Any]]] = {
    **{f"backlash_{word}": partial(_region, word, _with_backlash(f)) for word, f in BACKLASHES.items()},
    **{f"ripple_{word}": partial(_region, word, _with_ripple(amplitude)) for word, amplitude in RIPPLES.items()},
    **{
        f"helix_{h:.0f}": partial(_region, f"helix_{h:.0f}", _with_ripple(_teeth(h)[1]))
        for h in (HELICES[0], HELICES[-1])
    },
    "soft": _soft,
    "longer": _longer,
    "doubling": _doubling,
}
