"""Phases of meshes and loops of gears, from where the teeth stand when the mark of the reference shaft is at +x."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import rotorgear as rg
from rotorgear.model.layout.assembly import tooth_numbers

GEAR: dict[str, Any] = {"kind": "spur", "normal_module": 0.004, "width": 0.03, "at": "start", "body": {"bore": 0.02}}


def pair(psi: float, driver: str, speed: float, distance: float = 0.12, shift: float = 0.0) -> rg.Model:
    """Spur gears with 20 and 40 teeth of 4 mm on rigid points that are held by springs."""
    spring = {"stiffness": {"radial": 1e9, "axial": 1e9, "tilt": 1e7}}
    return rg.Model(
        operation={
            "input_shaft": driver,
            "output_shaft": "two" if driver == "one" else "one",
            "torque": 100.0,
            "speed": speed,
        },
        shafts={
            "one": {"position": [0.0, 0.0]},
            "two": {"position": [distance * math.cos(psi), distance * math.sin(psi)]},
        },
        gears={
            "pinion": {"shaft": "one", "teeth": 20, "profile_shift": shift, **GEAR},
            "wheel": {"shaft": "two", "teeth": 40, **GEAR},
        },
        meshes={"pair": {"pinion": "pinion", "gear": "wheel", "stiffness": 2e8}},
        bearings={name: {"shaft": name, "at": "start", **spring} for name in ("one", "two")},
    )


def apart(one: float, other: float) -> float:
    """Distance of two phases in pitches, at most a half."""
    return abs((one - other + 0.5) % 1.0 - 0.5)


@pytest.mark.parametrize("psi", [0.0, 0.7, -2.4])
@pytest.mark.parametrize("driver", ["one", "two"])
@pytest.mark.parametrize("speed", [100.0, -100.0])
def test_a_mesh_is_at_phase_zero_when_its_carrying_flanks_meet_at_the_pitch_point(
    psi: float, driver: str, speed: float
) -> None:
    """A tooth on the reference shaft points to +x; that shaft turns until its carrying flank is on the centre line."""
    found = rg.static(pair(psi, driver, speed)).mesh_phase["pair"]
    teeth = 20 if driver == "one" else 40
    sense = math.copysign(1.0, speed)
    half = 0.5 * math.pi / teeth  # of a tooth on the pitch circle
    # The driver pushes with the flanks that look ahead.
    direction = psi if driver == "one" else psi + math.pi
    turn = sense * (direction - sense * half)  # in the sense of rotation
    assert apart(found + teeth * turn / (2.0 * math.pi), 0.0) < 1e-9


@pytest.mark.parametrize("speed", [100.0, -100.0])
def test_the_carrying_flank_of_a_shifted_tooth_stands_where_its_thickness_puts_it(speed: float) -> None:
    distance = 0.1219
    psi = 0.4
    found = rg.static(pair(psi, "one", speed, distance, 0.5)).mesh_phase["pair"]
    alpha = math.radians(20.0)
    working = math.acos(0.12 * math.cos(alpha) / distance)
    thickness = 0.5 * math.pi * 4e-3 + 2.0 * 0.5 * 4e-3 * math.tan(alpha)  # at the reference circle
    half = thickness / 0.08 + (math.tan(alpha) - alpha) - (math.tan(working) - working)
    sense = math.copysign(1.0, speed)
    assert apart(found + 20 * (sense * psi - half) / (2.0 * math.pi), 0.0) < 1e-9


@pytest.mark.parametrize("teeth", [24, 26, 25])
@pytest.mark.parametrize("angle", [45.0, 50.0, 41.0])
def test_four_equal_gears_in_a_rhombus_close_where_a_mirror_image_does(teeth: int, angle: float) -> None:
    """A tooth of the first gear points along the axis of symmetry. Gear after gear, both ways, a tooth in a space: the last gear
    is met with 8 z alpha / 2 pi pitches in between, none in a square."""
    alpha = math.radians(angle)
    side = 4e-3 * teeth
    places = {
        "p": (0.0, 0.0),
        "a": (side * math.cos(alpha), side * math.sin(alpha)),
        "b": (side * math.cos(alpha), -side * math.sin(alpha)),
        "c": (2.0 * side * math.cos(alpha), 0.0),
    }
    spring = {"stiffness": {"radial": 1e9, "axial": 1e9, "tilt": 1e7}}
    mesh = {"stiffness": 2e8}
    model = rg.Model(
        operation={"input_shaft": "p", "output_shaft": "c", "torque": 100.0, "speed": 10.0},
        shafts={name: {"position": list(place)} for name, place in places.items()},
        gears={name: {"shaft": name, "teeth": teeth, **GEAR} for name in places},
        meshes={
            f"{first}{second}": {"pinion": first, "gear": second, **mesh}
            for first, second in (("p", "a"), ("p", "b"), ("a", "c"), ("b", "c"))
        },
        bearings={name: {"shaft": name, "at": "start", **spring} for name in places},
    )
    (loop,) = rg.static(model).assembly
    assert loop.gear == ""
    assert apart(abs(loop.rest_pitches), abs((8.0 * teeth * angle / 360.0 + 0.5) % 1.0 - 0.5)) < 1e-9


@pytest.mark.parametrize("clocking", [0.0, 0.05])
def test_a_gear_that_is_turned_on_its_shaft_turns_the_phase_of_its_mesh(clocking: float) -> None:
    model = pair(0.7, "one", 100.0)
    gears = {name: gear.model_dump() for name, gear in model.gears.items()}
    gears["pinion"]["clocking"] = clocking
    turned = rg.Model(
        **{**{name: getattr(model, name) for name in ("operation", "shafts", "meshes", "bearings")}, "gears": gears}
    )
    before, after = (rg.static(own).mesh_phase["pair"] for own in (model, turned))
    # A tooth that stands ahead comes to the pitch point earlier.
    assert apart(after - before, 20 * clocking / (2.0 * math.pi)) < 1e-9


def test_phases_of_the_same_teeth_do_not_depend_on_which_gear_is_called_pinion() -> None:
    model = pair(0.7, "one", 100.0)
    meshes = {"pair": {"pinion": "wheel", "gear": "pinion", "stiffness": 2e8}}
    other = rg.Model(
        **{**{name: getattr(model, name) for name in ("operation", "shafts", "gears", "bearings")}, "meshes": meshes}
    )
    assert np.abs(apart(rg.static(model).mesh_phase["pair"], rg.static(other).mesh_phase["pair"])) < 1e-9


def central(teeth: int, others: list[tuple[int, float, float]], is_pinion: bool) -> rg.Model:
    """A gear with one wrong tooth among others (teeth, angle, profile shift) about it, all with loaded teeth of 4 mm."""
    spring = {"stiffness": {"radial": 1e9, "axial": 1e9, "tilt": 1e7}}
    shafts: dict[str, Any] = {"middle": {"position": [0.0, 0.0]}}
    own = {**GEAR, "flank": {"pitch_errors": {"0": "5 um"}}}
    gears: dict[str, Any] = {"middle": {"shaft": "middle", "teeth": teeth, **own}}
    meshes = {}
    alpha = math.radians(20.0)
    for k, (z, angle, shift) in enumerate(others):
        # Without backlash: inv(alpha_w) = inv(alpha) + 2 x tan(alpha)/(z_1 + z_2).
        wanted = math.tan(alpha) - alpha + 2.0 * shift * math.tan(alpha) / (teeth + z)
        working = brentq(lambda a, wanted=wanted: math.tan(a) - a - wanted, 0.2, 0.6)
        distance = 0.002 * (teeth + z) * math.cos(alpha) / math.cos(working)
        shafts[f"s{k}"] = {"position": [distance * math.cos(angle), distance * math.sin(angle)]}
        gears[f"g{k}"] = {"shaft": f"s{k}", "teeth": z, **GEAR, "profile_shift": shift}
        pinion, gear = ("middle", f"g{k}") if is_pinion else (f"g{k}", "middle")
        meshes[f"m{k}"] = {"pinion": pinion, "gear": gear, "stiffness": "tooth_fe"}
    return rg.Model(
        operation={"input_shaft": "middle" if is_pinion else "s0", "speed": 10.0},
        shafts=shafts,
        gears=gears,
        meshes=meshes,
        bearings={name: {"shaft": name, "at": "start", **spring} for name in shafts},
    )


@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("drives", [True, False])
@pytest.mark.parametrize("is_pinion", [True, False])
def test_maps_of_a_gear_with_a_wrong_tooth_begin_with_the_teeth_that_stand_there(
    is_pinion: bool, drives: bool, direction: int
) -> None:
    """Tooth by tooth: the last one whose carrying flank has passed the pitch point, in the order in which they come there."""
    teeth, others = 23, [(31, 0.4, 0.3), (37, 2.9, -0.2), (29, -1.7, 0.1)]
    layout = central(teeth, others, is_pinion).layout
    # Sense of rotation of the middle gear: the reference shaft is its own, or that of the first other gear.
    sense = direction if is_pinion else -direction
    pinion_drives = drives == is_pinion
    # A pinion that drives is pressed in the sense in which it turns, one that is driven against it.
    on_pinion = (sense if is_pinion else -sense) * (1 if pinion_drives else -1)
    pressed = {f"m{k}": (on_pinion, pinion_drives) for k in range(3)}
    ahead, unknown = tooth_numbers(layout.assembly, layout.meshes, direction, pressed)
    assert unknown == []
    geometry = layout.gear("middle").geometry
    assert geometry is not None
    pitch = 2.0 * math.pi / teeth
    numbers = []
    for k, (_, angle, _) in enumerate(others):
        mesh = layout.mesh(f"m{k}")
        # Half the tooth at the working circle; without backlash both halves of a pair are half a pitch.
        working = 2.0 * geometry.base_radius / math.cos(mesh.pressure_angle)
        half = geometry.transverse_thickness(working) / working
        flank = on_pinion * half
        passed = [
            (sense * (layout.assembly.angle(layout.gear("middle")) - sense * j * pitch + flank - angle))
            % (2.0 * math.pi)
            for j in range(teeth)
        ]
        (number,) = [j for j, way in enumerate(passed) if way < pitch]
        numbers.append(number)
    assert [ahead[f"m{k}"] for k in range(3)] == [(number - numbers[0]) % teeth for number in numbers]
    # Where it drives in one mesh and is driven in another, one map runs against the order of the teeth.
    pressed["m1"] = (-on_pinion, not pinion_drives)
    assert tooth_numbers(layout.assembly, layout.meshes, direction, pressed)[1] == ["middle"]
