"""Claims of the split-torque account that it gives no numbers for, tried: gyroscopy, layouts, loaded teeth, helices, beating."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from itertools import product
from typing import Any

import numpy as np

import rotorgear as rg
from validation.cases.split_torque_lines.spectrum import excited
from validation.seeds.models import changed, loaded
from validation.seeds.split import MODEL, RANGE

SPEED = "16350 rpm"
# Factors on the stiffness of all bearings and on the diameters of all shafts, which the account does not give.
BEARINGS = (0.25, 1.0, 4.0)
DIAMETERS = (0.8, 1.0, 1.2)
# Half of the input torque on each branch (N m), and shares of it.
TORQUE = 2.5e6 / (16350.0 * math.pi / 30.0) * 113.0 / 29.0 / 2.0
LOADS = (0.25, 0.5, 1.0, 2.0)
_POINT = "points.output_bearing_y acceleration"


def quick() -> dict[str, float | str]:
    """Nothing follows without a run."""
    return {}


def _gyroscopy() -> dict[str, float]:
    """The pair of modes near 138.5 and 142.3 Hz at rest and at speed, and the largest change of any below 5 kHz in %."""
    rest, turning = (
        np.sort(result.frequency_hz[~result.rigid])
        for result in (rg.modal(loaded(MODEL), fmax=RANGE), rg.modal(loaded(MODEL), speed=SPEED, fmax=RANGE))
    )
    near = int(np.argmin(np.abs(rest - 138.5)))
    count = min(len(rest), len(turning))
    return {
        "rest_low": float(rest[near]),
        "rest_high": float(rest[near + 1]),
        "turning_low": float(turning[near]),
        "turning_high": float(turning[near + 1]),
        "split_rest": float(rest[near + 1] - rest[near]),
        "split_turning": float(turning[near + 1] - turning[near]),
        "largest_change": 100.0 * float(np.abs(turning[:count] / rest[:count] - 1.0).max()),
    }


def _layouts() -> dict[str, float]:
    """Fewest and most elastic modes below 5 kHz over layouts with softer and stiffer bearings and shafts."""
    base = loaded(MODEL)
    found = []
    for bearing, diameter in product(BEARINGS, DIAMETERS):
        data = base.model_dump(exclude_none=True)
        for part in data["bearings"].values():
            part["stiffness"] = {key: bearing * value for key, value in part["stiffness"].items()}
        for shaft in data["shafts"].values():
            for section in shaft["sections"]:
                section["outer_diameter"] *= diameter
        for gear in data["gears"].values():
            if "bore" in gear.get("body", {}):
                gear["body"]["bore"] *= diameter
        result = rg.modal(rg.Model(**data), fmax=RANGE, error_estimate=True)
        found.append(float(np.count_nonzero(result.frequency_hz[~result.rigid] < RANGE)))
    return {"modes_low": min(found), "modes_high": max(found)}


def _teeth() -> dict[str, float]:
    """Mean stiffness of the second stage along the flank normal (N/m) by loaded teeth over shares of the load; its swing in %."""
    torques = [share * TORQUE for share in LOADS]
    found = [rg.mesh(loaded(MODEL), "stage_2a", stiffness="tooth_fe", torque=one, estimate=False) for one in torques]
    means = [one.mean_normal_stiffness for one in found]
    middle = found[LOADS.index(1.0)]
    return {
        "fe_mean": middle.mean_normal_stiffness,
        "fe_mean_low": min(means),
        "fe_mean_high": max(means),
        "fe_swing": 100.0 * middle.peak_to_peak_stiffness / middle.mean_stiffness,
    }


def _helices() -> dict[str, float]:
    """Largest distance (%) of a helix's share in its mesh from one half, with branches that float and that are held."""
    found = {}
    for word, axial in (("floating", 1e6), ("held", 1e9)):
        bearings = {}
        for side in "ab":
            stiffness = loaded(MODEL).bearings[f"branch_{side}_left"].stiffness
            bearings[f"branch_{side}_left"] = {"stiffness": {"radial": stiffness.radial, "axial": axial}}  # type: ignore[union-attr]
        shares = np.asarray(rg.static(changed(loaded(MODEL), bearings=bearings)).helix_share, dtype=float)
        found[f"helix_{word}"] = 100.0 * float(np.nanmax(np.abs(shares - 0.5)))
    return found


def _beating() -> dict[str, float]:
    """Acceleration at the output bearing with the printed errors: second line over the first one, and how often contacts part."""
    result = rg.transient(excited(), modal_damping=0.02, steps=80, discard="20 ms", time="60 ms", error_estimate=False)
    size = np.sort(rg.spectral_lines(result, _POINT).amplitude)
    named = [bool(source) for source in rg.spectral_lines(result, _POINT).source]
    history = result.history(_POINT)[result.counted]
    parts = np.array_split(history, 12)
    rms = [float(part.std()) for part in parts]
    return {
        "second_line": float(size[-2] / size[-1]),
        "losses": float(np.sum(result.contact_losses)),
        "named_lines": 100.0 * float(np.mean(named)),
        "modulation": 100.0 * (max(rms) - min(rms)) / (max(rms) + min(rms)),
    }


# What takes runs; see kept.py.
PIECES: dict[str, Callable[[], Mapping[str, Any]]] = {
    "gyroscopy": _gyroscopy,
    "layouts": _layouts,
    "teeth": _teeth,
    "helices": _helices,
    "beating": _beating,
}
