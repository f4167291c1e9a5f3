"""A balanced rotor in its bearing: the static position is the mean of the motion in time, for balls, rollers and a film."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg

BALLS = 'rolling = { kind = "ball", elements = 7, element_diameter = "11.5 mm", pitch_diameter = "43.5 mm" }'
ROLLERS = (
    'rolling = { kind = "roller", elements = 15, element_diameter = "11 mm", pitch_diameter = "65.5 mm", length = "12 mm", '
    'clearance = "5 um" }'
)
FILM = (
    'journal = { diameter = "60 mm", length = "30 mm", clearance = "60 um", viscosity = "20 mPa s", inlet = "200 deg", '
    "around = 60, along = 4 }"
)
DAMPER = 'damping = { radial = "30 kN s/m" }'
SPEED = 3000.0


def rotor(bearing: str) -> rg.Model:
    return rg.loads(f"""
motions = ["bending"]
[operation]
input_shaft = "rotor"
speed = "{SPEED} rpm"
[shafts.rotor]
[bearings.front]
shaft = "rotor"
at = "start"
{bearing}
[supports.guide]
shaft = "rotor"
at = "start"
fixed = ["tilt_x", "tilt_y"]
[disks.d]
shaft = "rotor"
at = "start"
mass = 10
polar_inertia = 0.1
diametral_inertia = 0.1
[loads.pull]
shaft = "rotor"
at = "start"
force = ["600 N", "800 N", "0 N"]
""")


@pytest.mark.parametrize(
    ("bearing", "elements", "share"),
    [
        # Compiling the loop for one more law takes 15 s of CPU: two of the three are long tests.
        pytest.param(f"{BALLS}\n{DAMPER}", 7, 0.5 * (1.0 - 11.5 / 43.5), marks=pytest.mark.long),
        (f"{ROLLERS}\n{DAMPER}", 15, 0.5 * (1.0 - 11.0 / 65.5)),
        pytest.param(FILM, 1, 1.0, marks=pytest.mark.long),
    ],
)
def test_the_static_position_is_the_mean_in_time(bearing: str, elements: int, share: float) -> None:
    model = rotor(bearing)
    placed = rg.static(model).place_displacement["bearings.front"][:2]
    pitch = 60.0 / SPEED / (elements * share)
    run = rg.transient(model, time=4.0 * pitch, discard=0.02, method="newmark", error_estimate=False)
    mean = np.array([run.history(f"bearings.front displacement {axis}")[run.counted].mean() for axis in "xy"])
    assert np.abs(mean - placed).max() <= 0.01 * np.abs(placed).max()
