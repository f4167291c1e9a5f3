"""Whirl threshold of a rigid rotor in a plain journal bearing, three ways, relative to the closed form of the short bearing."""

from __future__ import annotations

from functools import cache

import numpy as np
from scipy.optimize import brentq

import rotorgear as rg

VISCOSITY, RADIUS, LENGTH, CLEARANCE, MASS, GRAVITY = 0.06, 0.05, 0.01, 1e-4, 20.0, 9.81
REVOLUTIONS = 150
SHORT = f"""
[nonlinear_elements.film]
law = "journal_bearing"
shaft = "rotor"
at = "start"
parameters = {{ viscosity = {VISCOSITY}, radius = {RADIUS}, length = {LENGTH}, clearance = {CLEARANCE} }}
"""
FINITE = f"""
[bearings.film]
shaft = "rotor"
at = "start"
journal = {{ viscosity = {VISCOSITY}, diameter = {2 * RADIUS}, length = {LENGTH}, clearance={CLEARANCE}, around=120, along = 6}}
"""


def coefficients(e: float) -> tuple[np.ndarray, np.ndarray]:
    """K c/W and C c w/W of the short bearing at an eccentricity e (Friswell et al., section 5.5.1)."""
    h = 1.0 / (np.pi**2 * (1.0 - e**2) + 16.0 * e**2) ** 1.5
    root = np.sqrt(1.0 - e**2)
    uu = 4.0 * (np.pi**2 * (2.0 - e**2) + 16.0 * e**2)
    vv = 4.0 * (np.pi**2 * (1.0 + 2.0 * e**2) + 32.0 * e**2 * (1.0 + e**2) / (1.0 - e**2))
    uv = np.pi * (np.pi**2 * (1.0 - e**2) ** 2 - 16.0 * e**4) / (e * root)
    vu = -np.pi * (np.pi**2 * (1.0 - e**2) * (1.0 + 2.0 * e**2) + 32.0 * e**2 * (1.0 + e**2)) / (e * root)
    c_uu = 2.0 * np.pi * root * (np.pi**2 * (1.0 + 2.0 * e**2) - 16.0 * e**2) / e
    c_uv = -8.0 * (np.pi**2 * (1.0 + 2.0 * e**2) - 16.0 * e**2)
    c_vv = 2.0 * np.pi * (np.pi**2 * (1.0 - e**2) ** 2 + 48.0 * e**2) / (e * root)
    return h * np.array([[uu, uv], [vu, vv]]), h * np.array([[c_uu, c_uv], [c_uv, c_vv]])


def eccentricity(speed: float) -> float:
    """Where the weight is carried at a speed in rad/s (Ocvirk)."""

    def rest(e: float) -> float:
        size = VISCOSITY * speed * RADIUS * LENGTH**3 * e / (4.0 * CLEARANCE**2 * (1.0 - e**2) ** 2)
        return float(size * np.sqrt(16.0 * e**2 + np.pi**2 * (1.0 - e**2)) - MASS * GRAVITY)

    return float(brentq(rest, 1e-9, 0.999))


@cache
def closed_form() -> tuple[float, float]:
    """Threshold in rad/s, and the whirl's frequency over the speed there."""

    def state(speed: float) -> tuple[float, float]:
        K, C = coefficients(eccentricity(speed))
        k = (K[0, 0] * C[1, 1] + K[1, 1] * C[0, 0] - K[0, 1] * C[1, 0] - K[1, 0] * C[0, 1]) / (C[0, 0] + C[1, 1])
        square = ((K[0, 0] - k) * (K[1, 1] - k) - K[0, 1] * K[1, 0]) / np.linalg.det(C)
        return float(GRAVITY * k / CLEARANCE - square * speed**2), float(np.sqrt(abs(square)))

    speed = float(brentq(lambda w: state(w)[0], 600.0, 2500.0))
    return speed, state(speed)[1]


def model(law: str, unbalance: str = "") -> rg.Model:
    """A mass that can move across only, in its bearing."""
    shake = f'[unbalances.u]\nshaft = "rotor"\nat = "start"\nmagnitude = "{unbalance}"' if unbalance else ""
    return rg.loads(f"""
motions = ["bending"]
[operation]
input_shaft = "rotor"
speed = {closed_form()[0]}
gravity = [0.0, -{GRAVITY}, 0.0]
[shafts.rotor]
[disks.d]
shaft = "rotor"
at = "start"
mass = {MASS}
polar_inertia = 1e-6
diametral_inertia = 1e-6
[supports.guide]
shaft = "rotor"
at = "start"
fixed = ["tilt_x", "tilt_y"]
{law}
{shake}
""")


def growth(share: float) -> float:
    """Rate in 1/s at which the whirl grows in a transient at a share of the threshold, started by a small unbalance.

    Over two revolutions the unbalance's own motion has no part in the component at half the speed.
    """
    speed = share * closed_form()[0]
    turn = 2.0 * np.pi / speed
    run = rg.transient(
        model(SHORT, "1 g mm"),
        speed=speed,
        time=REVOLUTIONS * turn,
        discard=0.0,
        method="newmark",
        error_estimate=False,
    )
    force = run.history("nonlinear_elements.film force x")
    n = round(2.0 * turn / float(run.time[1] - run.time[0]))
    windows = len(force) // n
    wave = (force * np.exp(-0.5j * speed * run.time))[: windows * n].reshape(windows, n)
    size = np.abs(wave.mean(axis=1))[3:]
    return float(np.polyfit(2.0 * turn * np.arange(size.size), np.log(size), 1)[0])


def measure(quantity: str, mode: str) -> float:
    """Threshold or frequency of the whirl over the closed form; `mode`: "campbell", "sheet" or "transient", and the law."""
    way, law = mode.split(", ")
    text = SHORT if law == "short" else FINITE
    speed, ratio = closed_form()
    if way == "transient":
        low, high = growth(0.98), growth(1.02)
        return 0.98 - 0.04 * low / (high - low)
    if way == "campbell":
        onset = rg.campbell(model(text), speeds=[share * speed for share in np.linspace(0.8, 1.2, 9)], modes=4).onsets[
            0
        ]
        return onset.speed / speed if quantity == "threshold" else 2.0 * np.pi * onset.frequency_hz / (ratio * speed)
    sheet = rg.bearing(model(text), "film", speeds=[0.8 * speed, 1.2 * speed])
    assert sheet.threshold_speed is not None
    assert sheet.threshold_frequency_hz is not None
    if quantity == "threshold":
        return sheet.threshold_speed / speed
    return 2.0 * np.pi * sheet.threshold_frequency_hz / (ratio * speed)
