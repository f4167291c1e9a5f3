"""A balanced rotor in its bearing: the static position is the mean of the motion in time, for balls, rollers and a film."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from tests.models import disk_in_bearing

BALLS = 'rolling = { kind = "ball", elements = 7, element_diameter = "11.5 mm", pitch_diameter = "43.5 mm" }'
ROLLERS = (
    'rolling = { kind = "roller", elements = 15, element_diameter = "11 mm", pitch_diameter = "65.5 mm", length = "12 mm", '
    'clearance = "5 um" }'
)
FILM = (
    'journal = { diameter = "60 mm", length = "30 mm", clearance = "60 um", viscosity = "20 mPa s", inlet = "200 deg", '
    "around = 60, along = 4 }"
)
PADS = (
    'journal = { diameter = "60 mm", length = "30 mm", clearance = "60 um", viscosity = "20 mPa s", pads = 5, '
    'pad_at = "200 deg", preload = 0.3, around = 60, along = 4 }'
)
WARM = FILM.replace('viscosity = "20 mPa s"', 'oil = "VG 46", inlet_temperature = "45 degC"')
TAPERED = (
    'rolling = { kind = "tapered", elements = 14, element_diameter = "10 mm", pitch_diameter = "60 mm", length = "14 mm", '
    'contact_angle = "15 deg", arrangement = "O", row_distance = "30 mm", preload_displacement = "4 um", slices = 5 }'
)
FOUR_POINT = (
    'rolling = { kind = "four-point", elements = 13, element_diameter = "12 mm", pitch_diameter = "65 mm", '
    'contact_angle = "35 deg" }'
)
COLLAR = (
    'thrust = { inner_diameter = "80 mm", outer_diameter = "140 mm", clearance = "60 um", viscosity = "0.03 Pa s", pads = 6, '
    "around = 12, across = 6, %s }"
)
DAMPER = 'damping = { radial = "30 kN s/m" }'
ALL_WAYS = 'damping = { radial = "30 kN s/m", axial = "30 kN s/m" }'
SPEED = 3000.0


def rotor(bearing: str, motions: str = '"bending"', fixed: str = '"tilt_x", "tilt_y"', along: float = 0.0) -> rg.Model:
    return disk_in_bearing(bearing, f"[600.0, 800.0, {along}]", speed=f"{SPEED} rpm", motions=motions, fixed=fixed)


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


@pytest.mark.long
@pytest.mark.parametrize(
    ("bearing", "elements", "share"),
    [
        (f"{TAPERED}\n{ALL_WAYS}", 14, 0.5 * (1.0 - 10.0 / 60.0 * np.cos(np.radians(15.0)))),
        (f"{FOUR_POINT}\n{ALL_WAYS}", 13, 0.5 * (1.0 - 12.0 / 65.0 * np.cos(np.radians(35.0)))),
        (PADS, 1, 1.0),
        (WARM, 1, 1.0),
        (COLLAR % "pivot = 0.6", 1, 1.0),
        (COLLAR % 'taper = "40 um"', 1, 1.0),
    ],
    ids=["tapered", "four-point", "tilting pads", "film in heat balance", "tilting thrust pads", "fixed thrust pads"],
)
def test_the_newer_kinds_stand_at_their_mean_in_time_too(bearing: str, elements: int, share: float) -> None:
    """Rolling elements over four pitches, films over four turns."""
    thrust = bearing.startswith("thrust")
    rolling = bearing.startswith("rolling")
    fixed = '"tilt_x", "tilt_y"' + (', "x", "y"' if thrust else "")
    model = rotor(
        bearing, '"bending", "axial"' if thrust or rolling else '"bending"', fixed, 2000.0 if thrust else 500.0
    )
    if thrust or rolling:
        model = model.with_("points.along", {"shaft": "rotor", "at": "start", "direction": "z"})
    placed = rg.static(model).place_displacement["bearings.front"][:3]
    pitch = 60.0 / SPEED / (elements * share)
    run = rg.transient(model, time=4.0 * pitch, discard=0.02, method="newmark", error_estimate=False)
    axes = "z" if thrust else "xyz" if rolling else "xy"
    names = {axis: f"bearings.front displacement {axis}" for axis in "xy"} | {"z": "points.along displacement"}
    mean = np.array([run.history(names[axis])[run.counted].mean() for axis in axes])
    placed = placed[["xyz".index(axis) for axis in axes]]
    assert np.abs(mean - placed).max() <= 0.01 * np.abs(placed).max()
