"""Loads inside shafts and couplings in statics: in balance with all that acts outside of a cut, wherever that is."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.errors import ModelError
from tests.unit.analysis.static.test_static import changed, data_of

G = np.array([1.7, -9.0, 3.1])
Wrench = tuple[float, np.ndarray, np.ndarray]  # z, force, moment about the axis there
SIX = (("shear", "x"), ("shear", "y"), ("axial", "z"), ("bending", "x"), ("bending", "y"), ("torque", "x"))


def read_everywhere(data: dict[str, Any], places: Sequence[tuple[str, float]], **more: Any) -> rg.Model:
    """The model with six points at each place of a shaft."""
    points = {
        f"{number}_{quantity}_{axis}": {
            "shaft": shaft,
            "at": float(z),
            "quantity": quantity,
            "direction": axis,
            **more,
        }
        for number, (shaft, z) in enumerate(places)
        for quantity, axis in SIX
    }
    return rg.Model(**{**data, "points": {**data.get("points", {}), **points}})


def read(result: rg.StaticResult, number: int) -> np.ndarray:
    """The six loads at a place."""
    return np.array([result.load_at(f"{number}_{quantity}_{axis}") for quantity, axis in SIX])


def weight_left_of(model: rg.Model, shaft: str, z: float) -> list[Wrench]:
    """Weight of slices of the shaft at smaller z, by Gauss points that integrate cones exactly."""
    part = model.shafts[shaft]
    found = []
    left = part.start
    x, w = np.polynomial.legendre.leggauss(4)
    for section in part.sections:
        end = min(left + section.length, z)
        outer, bore, outer_end, bore_end = section.mass_diameters()
        rho = model.material_of(shaft, section).density
        for at, weight in zip(0.5 * (left + end) + 0.5 * (end - left) * x, 0.5 * (end - left) * w, strict=True):
            if end <= left:
                break
            share = (at - left) / section.length
            d = outer + share * (outer_end - outer)
            b = bore + share * (bore_end - bore)
            found.append((at, math.pi / 4 * (d**2 - b**2) * rho * weight * G, np.zeros(3)))
        left += section.length
    return found


def load_of(outside: list[Wrench], z: float) -> np.ndarray:
    """Load inside at z that balances all that acts at smaller z."""
    force = -np.sum([f for _, f, _ in outside], axis=0)
    moment = -np.sum([m + np.cross([0.0, 0.0, at - z], f) for at, f, m in outside], axis=0)
    return np.concatenate([force, moment])


def test_a_stepped_and_tapered_cantilever_is_in_balance_with_its_end_load_and_weight() -> None:
    sections = [
        {"length": 0.31, "outer_diameter": 0.04},
        {"length": 0.52, "outer_diameter": 0.03, "outer_diameter_end": 0.07, "bore": 0.01},
        {"length": 0.11, "outer_diameter": 0.05},
    ]
    force = np.array([110.0, 30.0, -700.0])
    moment = np.array([1.3, 21.0, -3.7])
    data = {
        "operation": {"input_shaft": "a", "gravity": tuple(G)},
        "shafts": {"a": {"sections": sections}},
        "supports": {"wall": {"shaft": "a", "at": "end", "fixed": ["all"]}},
        "loads": {"tip": {"shaft": "a", "at": "start", "force": tuple(force), "moment": tuple(moment)}},
    }
    rng = np.random.default_rng(7)
    places = [("a", z) for z in rng.uniform(0.0, 0.94, 50)]
    for side in ("left", "right"):
        model = read_everywhere(data, places, side=side)
        result = rg.static(model, elements=1)
        for number, (_, z) in enumerate(places):
            outside = [(0.0, force, moment), *weight_left_of(model, "a", z)]
            np.testing.assert_allclose(read(result, number), load_of(outside, z), rtol=1e-9, atol=1e-9 * 700.0)
        assert all(row.error < 1e-9 * 700.0 for row in result.internal_loads)


def geared() -> dict[str, Any]:
    """The helical pair with a cone, a skew field of gravity, a load on its output and a coupled machine."""
    data = data_of("helical_pair")
    data = changed(data, "operation.gravity", tuple(G))
    cone = {"length": "120 mm", "outer_diameter": "60 mm", "outer_diameter_end": "40 mm"}
    sections = [*data["shafts"]["output"]["sections"][:2], cone]
    data = changed(data, "shafts.output.sections", sections)
    return changed(data, "loads", {"pull": {"shaft": "output", "at": "100 mm", "force": (310.0, -50.0, 20.0)}})


def test_loads_in_geared_shafts_are_in_balance_with_meshes_bearings_loads_and_weights() -> None:
    rng = np.random.default_rng(11)
    places = [("input", z) for z in rng.uniform(-0.15, 0.08, 25)] + [
        ("output", z) for z in rng.uniform(-0.08, 0.15, 25)
    ]
    model = read_everywhere(geared(), places)
    result = rg.static(model)
    layout = model.layout
    on_gear = result.mesh_force_on_gear[0]
    a = 0.135
    teeth = {"pinion": 23, "wheel": 61}
    towards = {"pinion": 1.0, "wheel": -1.0}
    for number, (shaft, z) in enumerate(places):
        every = weight_left_of(model, shaft, z)
        for name, bearing in model.bearings.items():
            if bearing.shaft == shaft:
                load = result.bearing_force[name]
                every.append((layout.place(f"bearings.{name}").z, load[:3], load[3:]))
        for name in model.gears:
            place = layout.place(f"gears.{name}")
            if place.shaft != shaft:
                continue
            every.append((place.z, layout.gear(name).body.mass * G, np.zeros(3)))
            force = on_gear if name == "wheel" else -on_gear
            arm = np.array([towards[name] * a * teeth[name] / 84.0, 0.0, 0.0])  # to the pitch point
            every.append((place.z, force, np.cross(arm, force)))
        for name, disk in model.disks.items():
            if disk.shaft == shaft:
                every.append((layout.place(f"disks.{name}").z, layout.disk_body(name).mass * G, np.zeros(3)))
        if shaft == "output":
            every.append((0.1, np.array([310.0, -50.0, 20.0]), np.zeros(3)))
        for item in model.torque_flow().applied:
            if item.shaft == shaft:
                every.append((item.z, np.zeros(3), np.array([0.0, 0.0, item.torque])))
        exact = load_of([one for one in every if one[0] < z], z)
        size = np.abs(on_gear).max()
        np.testing.assert_allclose(read(result, number), exact, rtol=1e-9, atol=1e-9 * size)


def chain(*stiffness: float) -> dict[str, Any]:
    """Rotors on a line of torsional springs, 17 N m in at the first and out at the last one."""
    count = len(stiffness) + 1
    names = [f"s{number}" for number in range(count)]
    return {
        "motions": ("torsion",),
        "operation": {"input_shaft": names[0], "output_shaft": names[-1], "torque": 17.0},
        "shafts": {name: {} for name in names},
        "disks": {name: {"shaft": name, "at": "start", "polar_inertia": 0.1} for name in names},
        "couplings": {
            f"c{number}": {"from_shaft": names[number], "to_shaft": names[number + 1], "stiffness": {"torsion": k}}
            for number, k in enumerate(stiffness)
        },
        "points": {
            f"c{number}": {"on": f"couplings.c{number}", "quantity": "torque"} for number in range(len(stiffness))
        },
    }


def test_the_torque_of_a_spring_is_its_stiffness_times_its_twist() -> None:
    stiffness = (1.9e5, 6.95e3, 90.0, 4.19e4)
    model = rg.Model(**chain(*stiffness))
    result = rg.static(model)
    twist = np.diff([result.place_displacement[f"disks.s{number}"][5] for number in range(5)])
    for number, k in enumerate(stiffness):
        load = result.load_at(f"c{number}")
        assert load == pytest.approx(-17.0, rel=1e-12)
        if k < 1e4:  # the others twist by less than 1e-3 of what their neighbours turn
            assert load == pytest.approx(k * twist[number], rel=1e-9)


def test_the_torque_of_a_stiff_spring_is_right_where_the_difference_of_rotations_loses_its_digits() -> None:
    stiffness = (30.0, 2e10, 45.0, 7e9)
    model = rg.Model(**chain(*stiffness))
    result = rg.static(model)
    twist = np.diff([result.place_displacement[f"disks.s{number}"][5] for number in range(5)])
    assert abs(2e10 * twist[1] / -17.0 - 1.0) > 1e-8
    for row in result.internal_loads:
        assert abs(row.load + 17.0) <= row.error
        assert row.error < 1e-11


def test_the_load_of_a_coupling_is_that_in_the_middle_of_its_gap() -> None:
    data = {
        "operation": {"input_shaft": "a"},
        "shafts": {
            "a": {"position": (0.0, 0.0), "sections": [{"length": 0.3, "outer_diameter": 0.03}]},
            "b": {"position": (0.0, 0.0), "start": 0.38, "sections": [{"length": 0.2, "outer_diameter": 0.04}]},
        },
        "supports": {"wall": {"shaft": "a", "at": "start", "fixed": ["all"]}},
        "couplings": {
            "disc": {
                "from_shaft": "a",
                "to_shaft": "b",
                "stiffness": {"radial": 3e6, "axial": 2e6, "tilt": 4e3, "torsion": 5e4},
            }
        },
        "loads": {"tip": {"shaft": "b", "at": "end", "force": (10.0, -20.0, 35.0), "moment": (1.0, 2.0, 3.0)}},
        "points": {
            f"0_{quantity}_{axis}": {"on": "couplings.disc", "quantity": quantity, "direction": axis}
            for quantity, axis in SIX
        },
    }
    result = rg.static(rg.Model(**data))
    arm = np.array([0.0, 0.0, 0.58 - 0.34])
    force = np.array([10.0, -20.0, 35.0])
    exact = np.concatenate([force, np.array([1.0, 2.0, 3.0]) + np.cross(arm, force)])
    np.testing.assert_allclose(read(result, 0), exact, rtol=1e-11)


def test_a_side_tells_on_which_side_of_a_gear_its_load_is_read() -> None:
    data = geared()
    both = {side: {"on": "gears.wheel", "quantity": "torque", "side": side} for side in ("left", "right")}
    result = rg.static(rg.Model(**{**data, "points": both}))
    torque = rg.Model(**data).torque_flow().applied[0].torque * 61 / 23
    assert result.load_at("left") == pytest.approx(0.0, abs=1e-9 * torque)
    assert abs(result.load_at("right")) == pytest.approx(torque, rel=1e-9)


@pytest.mark.parametrize(
    ("point", "address", "words"),
    [
        ({"shaft": "input", "at": "0 mm", "quantity": "shear", "direction": "z"}, "direction", "x or y"),
        ({"shaft": "input", "at": "0 mm", "quantity": "torque", "direction": "y"}, "direction", "nothing here"),
        ({"shaft": "input", "at": "0 mm", "side": "left"}, "side", "a motion has no side"),
        ({"shaft": "input", "at": "80 mm", "quantity": "torque", "side": "right"}, "", "an elastic section"),
        ({"on": "couplings.stub"}, "quantity", "required on a coupling"),
        ({"on": "couplings.stub", "quantity": "torque", "side": "left"}, "side", "one load"),
    ],
)
def test_a_load_that_is_not_there_is_refused(point: dict[str, Any], address: str, words: str) -> None:
    data = data_of("helical_pair")
    data = changed(data, "shafts.stub", {"position": ["135 mm", "0 mm"], "start": "150 mm"})
    data = changed(data, "disks.stub", {"shaft": "stub", "at": "start", "mass": 1.0, "polar_inertia": 0.1})
    coupling = {"from_shaft": "output", "to_shaft": "stub", "stiffness": {"torsion": 1e5}}
    data = changed(data, "couplings", {"stub": coupling})
    with pytest.raises(ModelError) as error:
        rg.Model(**{**data, "points": {"p": point}})
    (problem,) = [one for one in error.value.problems if one.address.startswith("points.")]
    assert problem.address == f"points.p.{address}".rstrip(".")
    assert words in str(problem)


def test_a_force_does_not_act_at_a_point_that_reads_a_load() -> None:
    data = data_of("helical_pair")
    points = {"p": {"shaft": "input", "at": "0 mm", "quantity": "torque"}}
    loads = {"f": {"point": "p", "force": (1.0, 0.0, 0.0)}}
    with pytest.raises(ModelError, match="reads a load"):
        rg.Model(**{**data, "points": points, "loads": loads})
