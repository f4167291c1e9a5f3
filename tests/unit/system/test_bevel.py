"""Bevel pairs: their forces by hand, and two shafts that meet against frames of beams that were assembled in two other ways."""

from __future__ import annotations

import math
import re
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.linalg as la

import rotorgear as rg
from rotorgear.elements.shaft import shaft_elements
from rotorgear.elements.shaft_section import ShaftElements
from rotorgear.elements.spring import rigid_transfer
from tests.turned import far_off, turned

STEEL = {"plain": {"youngs_modulus": 206e9, "poisson_ratio": 0.3, "density": 7850.0}}
# Shaft angle in deg, teeth, mean pitch diameter of the pinion, spiral angle, hand, mesh stiffness, torque, speed; sections
# (length, outer, bore), place of the gear, bearings (z, x y z tilt_x tilt_y torsion), mass and inertias, of both shafts; place of
# the output.
CASES: dict[str, dict[str, Any]] = {
    "square": {
        "S": 90.0, "z": (19, 41), "d": 0.0665, "beta": 35.0, "h": -1, "k": 3.1e8, "T": 180.0, "W": 600.0,
        "segs": ([(0.06, 0.03, 0.0), (0.08, 0.04, 0.0), (0.03, 0.045, 0.0)],
                 [(0.04, 0.05, 0.02), (0.09, 0.055, 0.02), (0.1, 0.05, 0.02)]),
        "at": (0.155, 0.04), "out": 0.23, "origins": ([0.0, 0.0, -0.08325], [-0.00675, 0.0, 0.0]),
        "b": ([(0.0, [8e7, 8e7, 0, 0, 0, 0]), (0.12, [1.5e8, 1.2e8, 1.1e8, 4e4, 4e4, 0])],
              [(0.0, [1.1e8, 9e7, 0, 0, 0, 0]), (0.2, [2e8, 2e8, 1.4e8, 6e4, 6e4, 0])]),
        "m": ((1.1, 0.00075, 0.0006), (4.2, 0.016, 0.0085)),
        "still": [597.2064, 687.2248, 758.9581, 815.2963, 984.1861, 1027.0147, 1501.9816, 1537.2833, 1996.5775, 2019.2894],
        "turning": [597.1989, 687.2205, 758.9481, 815.2588, 984.1787, 1027.0284, 1491.5363, 1547.808, 1992.8563, 2023.0532],
        "force": 7032.836477,
        "plain": ([-40.76699, -92.6696, -22.37041, 1036.15376, -331.06558, 10172.3425],
                  [-21.89743, 45.14022, 28.55121, 136.31899, 259.35174, -1319.83341]),
        "heavy": ([-40.69037, -92.91639, -22.26335, 1038.26988, -330.36615, 10171.04304],
                  [-22.09805, 44.72378, 28.71882, 135.56384, 259.56318, -1319.83341]),
        "bearings": [[-315.5723, -1273.0864, 0.0], [4084.0, 6707.3934, 2416.1991],
                     [3283.341, -4209.2569, 0.0], [-821.8456, -1144.5234, -3798.6252]],
    },
    "sharp": {
        "S": 70.0, "z": (23, 52), "d": 0.092, "beta": 30.0, "h": 1, "k": 4.2e8, "T": 260.0, "W": 450.0,
        "segs": ([(0.07, 0.035, 0.0), (0.09, 0.045, 0.01), (0.04, 0.05, 0.0)],
                 [(0.05, 0.06, 0.0), (0.1, 0.065, 0.03), (0.12, 0.06, 0.03)]),
        "at": (0.18, 0.05), "out": 0.27,
        "origins": ([0.0, 0.0, -0.052582881], [0.034585464, 0.0, 0.012588079]),
        "b": ([(0.0, [9e7, 9e7, 0, 0, 0, 0]), (0.14, [1.8e8, 1.4e8, 1.2e8, 5e4, 5e4, 0])],
              [(0.0, [1.4e8, 1.1e8, 0, 0, 0, 0]), (0.24, [2.2e8, 2.6e8, 1.6e8, 7e4, 7e4, 0])]),
        "m": ((1.9, 0.0019, 0.0014), (6.8, 0.041, 0.022)),
        "still": [550.8908, 570.1241, 651.7694, 698.3463, 818.9942, 848.9093, 1282.2829, 1306.6941, 1702.2609, 1710.843],
        "turning": [550.8815, 570.124, 651.7574, 698.3097, 818.9811, 848.9416, 1272.0781, 1317.0477, 1697.6063, 1715.5263],
        "force": 6945.428873,
        "plain": ([-38.34935, -84.45329, 32.74073, 840.7175, -665.54181, 7274.76906],
                  [22.91811, 38.39278, -1.77587, 85.018, -45.86835, -1189.85555]),
        "heavy": ([-38.24275, -84.8029, 32.89626, 843.47641, -664.63338, 7268.2689],
                  [22.73128, 37.83707, -1.43332, 84.24672, -45.79969, -1189.85555]),
        "bearings": [[-1415.5617, -1350.5172, 0.0], [2529.4448, 7035.5981, -3894.5305],
                     [-3244.0895, -4352.4184, 0.0], [-745.0752, -1204.0968, 215.2613]],
    },
}  # fmt: skip
GRAVITY = [3.0, -8.0, 4.5]


def hand_of(h: int) -> dict[str, str]:
    """The key of a hand, +1 right; none for 0."""
    return {} if h == 0 else {"hand": "right" if h > 0 else "left"}


def crossed(case: dict[str, Any], **changes: Any) -> dict[str, Any]:
    """Tables of two shafts that meet, the output held in torsion where its load is."""
    S = math.radians(case["S"])
    beta = math.radians(case["beta"])
    axis = (math.sin(S), 0.0, math.cos(S))
    axes = ({}, {"axis": axis, "x_axis": np.cross([0.0, 1.0, 0.0], axis).tolist()})
    tables: dict[str, Any] = {
        "materials": STEEL,
        "operation": {"input_shaft": "one", "speed": case["W"]},
        "shafts": {},
        "gears": {},
        "bearings": {},
        "meshes": {"pair": {"pinion": "pinion", "gear": "wheel", "stiffness": case["k"]}},
        "supports": {"brake": {"shaft": "two", "at": case["out"], "fixed": ["torsion"]}},
        "loads": {
            "in": {"shaft": "one", "kind": "input", "at": 0.0, "torque": case["T"]},
            "out": {"shaft": "two", "kind": "output", "at": case["out"]},
        },
    }
    for i, shaft in enumerate(("one", "two")):
        sections = [{"length": length, "outer_diameter": d, "bore": bore} for length, d, bore in case["segs"][i]]
        tables["shafts"][shaft] = {"position": case["origins"][i], "material": "plain", "sections": sections, **axes[i]}
        mass, polar, diametral = case["m"][i]
        tables["gears"][("pinion", "wheel")[i]] = {
            "shaft": shaft,
            "at": case["at"][i],
            "kind": "bevel",
            "teeth": case["z"][i],
            "mean_normal_module": case["d"] * math.cos(beta) / case["z"][0],
            "spiral_angle": beta,
            "width": 0.02,
            "mass": mass,
            "polar_inertia": polar,
            "diametral_inertia": diametral,
            **hand_of((1, -1)[i] * case["h"]),
        }
        for j, (z, k) in enumerate(case["b"][i]):
            names = ("x", "y", "axial", "tilt_x", "tilt_y", "torsion")
            tables["bearings"][f"{shaft}_{j}"] = {
                "shaft": shaft,
                "at": z,
                "stiffness": dict(zip(names, k, strict=True)),
            }
    return tables | changes


@pytest.mark.parametrize("name", CASES)
def test_statics_of_two_shafts_that_meet_agree_with_a_frame_of_beams(name: str) -> None:
    case = CASES[name]
    tables = crossed(case)
    found = rg.static(rg.Model(**tables), elements=2)
    assert found.mesh_force[0] == pytest.approx(case["force"], rel=1e-8)
    for gear, wanted in zip(("pinion", "wheel"), case["plain"], strict=True):
        assert 1e6 * found.place_displacement[f"gears.{gear}"] == pytest.approx(np.array(wanted), rel=1e-7, abs=2e-5)
    assert found.torque["loads.out"] * found.torque["loads.in"] > 0.0  # both axes lead away from the apex
    assert abs(found.torque["loads.out"]) == pytest.approx(case["T"] * case["z"][1] / case["z"][0], rel=1e-12)
    tables["operation"]["gravity"] = GRAVITY
    heavy = rg.static(rg.Model(**tables), elements=2)
    for gear, wanted in zip(("pinion", "wheel"), case["heavy"], strict=True):
        assert 1e6 * heavy.place_displacement[f"gears.{gear}"] == pytest.approx(np.array(wanted), rel=1e-7, abs=2e-5)
    forces = [heavy.bearing_force[f"{shaft}_{j}"][:3] for shaft in ("one", "two") for j in range(2)]
    assert np.array(forces) == pytest.approx(np.array(case["bearings"]), rel=1e-7, abs=2e-4)


@pytest.mark.parametrize("name", CASES)
def test_frequencies_of_two_shafts_that_meet_agree_with_a_frame_of_beams(name: str) -> None:
    case = CASES[name]
    model = rg.Model(**crossed(case, supports={}))
    for speed, wanted in ((None, case["still"]), (case["W"], case["turning"])):
        modes = rg.modal(model, modes=len(wanted) + 1, speed=speed, elements=2)
        assert modes.rigid[0]
        assert modes.frequency_hz[1:] == pytest.approx(wanted, rel=1e-6)


def test_an_outer_module_is_that_of_the_heel() -> None:
    case = CASES["square"]
    tables = crossed(case)
    delta = math.atan2(*case["z"])
    R_m = 0.5 * case["d"] / math.sin(delta)
    outer = (case["d"] + 0.02 * math.sin(delta)) / case["z"][0]
    for gear in tables["gears"].values():
        del gear["mean_normal_module"]
        gear["outer_module"] = outer
    pair = rg.Model(**tables).layout.mesh("pair").bevel
    assert pair is not None
    assert pair.mean_cone_distance == pytest.approx(R_m, rel=1e-12)
    assert pair.mean_radii[0] == pytest.approx(0.5 * case["d"], rel=1e-12)


def test_a_bevel_gearbox_turned_in_space_says_the_same() -> None:
    model = rg.Model(**crossed(CASES["sharp"], supports={}))
    modes, inclined = (rg.modal(one, modes=10, speed=450.0, elements=1) for one in (model, turned(model)))
    assert inclined.eigenvalues == pytest.approx(modes.eigenvalues, rel=1e-9, abs=1e-6)
    times = [rg.transient(one, time=0.002, steps=100, error_estimate=False) for one in (model, turned(model))]
    assert far_off(times[0].mesh_force, times[1].mesh_force) < 1e-8


def test_the_estimate_of_iso_10300_is_20_newtons_a_micrometre_of_85_per_cent_of_the_face() -> None:
    tables = crossed(CASES["square"])
    tables["meshes"]["pair"]["stiffness"] = "iso"
    model = rg.Model(**tables)
    (force,) = model.torque_flow().forces
    b_b = math.asin(math.sin(math.radians(35.0)) * math.cos(math.radians(20.0)))
    assert force.contact.stiffness == pytest.approx(20e9 * 0.85 * 0.02 / math.cos(b_b) ** 2, rel=1e-12)
    # 180 N m on a radius of 33.25 mm are 318 N/mm; a tenth of that is less than 100.
    tables["loads"]["in"]["torque"] = 18.0
    line_load = 18.0 / 0.03325 / (0.85 * 0.02)
    less = rg.Model(**tables).torque_flow().forces[0].contact.stiffness
    assert less == pytest.approx(force.contact.stiffness * line_load / 1e5, rel=1e-9)
    said = [str(note) for note in rg.modal(model, modes=2, elements=1).left_out]
    assert any("estimate of ISO 10300-1" in note for note in said)


def refused(tables: dict[str, Any]) -> str:
    """What a model of some tables is refused with."""
    with pytest.raises(rg.ModelError) as error:
        rg.Model(**tables)
    return re.sub(r"\s+", " ", str(error.value))


def test_what_no_bevel_pair_can_have_is_refused_by_name() -> None:
    def tables() -> dict[str, Any]:
        return crossed(CASES["square"])

    one = tables()
    one["gears"]["wheel"]["at"] = 0.042
    assert "gears.wheel.at: got 42 mm, expected 40 mm on its cone" in refused(one)
    one = tables()
    one["shafts"]["two"]["position"] = (-0.00675, 0.004, 0.0)
    assert "hypoid gears" in refused(one)
    one = tables()
    one["shafts"]["two"] |= {"axis": (0.0, 0.0, 1.0), "x_axis": (1.0, 0.0, 0.0)}
    assert "bevel gears on parallel axes" in refused(one)
    one = tables()
    one["gears"]["wheel"]["hand"] = "left"
    assert "bevel gears have opposite hands" in refused(one)
    one = tables()
    one["gears"]["wheel"]["kind"] = "spur"
    assert "bevel" in refused(one)
    for key, value in (
        ("tilt", True),
        ("friction_coefficient", 0.05),
        ("stiffness", "tooth_fe"),
        ("misalignment", 1e-5),
    ):
        one = tables()
        one["meshes"]["pair"][key] = value
        assert f"meshes.pair.{key}" in refused(one)
    for key, value in (("profile_shift", 0.1), ("integral", True), ("normal_module", 0.003), ("tip_relief", 1e-5)):
        one = tables()
        one["gears"]["pinion"][key] = value
        assert f"gears.pinion.{key}" in refused(one)
    one = tables()
    del (
        one["gears"]["pinion"]["mass"],
        one["gears"]["pinion"]["polar_inertia"],
        one["gears"]["pinion"]["diametral_inertia"],
    )
    assert "mass and moments of inertia of a bevel gear" in refused(one)
    model = rg.Model(**tables())
    for verb in (rg.mesh, rg.gear):
        with pytest.raises(rg.AnalysisError, match="bevel gears"):
            verb(model)


def casing_of_tubes(seats: np.ndarray, hub: np.ndarray) -> dict[str, np.ndarray]:
    """A casing of straight tubes of four elements each, from its seats to a hub with a mass on springs, by its matrices."""
    E, nu, rho, outer, bore, count = 206e9, 0.3, 7850.0, 0.07, 0.05, 4
    n = len(seats) * count + 1  # nodes: the seats, the hub, and those inside the tubes
    K, M = np.zeros((6 * n, 6 * n)), np.zeros((6 * n, 6 * n))
    points = [*seats, hub]
    for number, seat in enumerate(seats):
        z = (hub - seat) / np.linalg.norm(hub - seat)
        x = np.cross([0.3, 0.5, -0.8], z)
        R = np.column_stack([x / np.linalg.norm(x), np.cross(z, x / np.linalg.norm(x)), z])
        length = np.full(1, np.linalg.norm(hub - seat) / count)
        sizes = np.array([[outer, bore, outer, bore]])
        ones = np.ones(1)
        data = ShaftElements(length, sizes, sizes, E * ones, E / 2.6 * ones, nu * ones, rho * ones, np.nan * ones)
        one = shaft_elements(data)
        assert one.stiffness is not None
        assert one.mass is not None
        B = la.block_diag(R, R, R, R)
        inner = list(range(len(points), len(points) + count - 1))
        points += [seat + (hub - seat) * k / count for k in range(1, count)]
        for a, b in pairwise([number, *inner, len(seats)]):
            dofs = np.concatenate([6 * a + np.arange(6), 6 * b + np.arange(6)])
            K[np.ix_(dofs, dofs)] += B @ one.stiffness[0] @ B.T
            M[np.ix_(dofs, dofs)] += B @ one.mass[0] @ B.T
    own = 6 * len(seats) + np.arange(6)
    K[own, own] += [6e7, 5e7, 9e7, 8e5, 7e5, 6e5]
    M[own, own] += [6.0, 6.0, 6.0, 0.05, 0.06, 0.07]
    # Coordinates beside the seats: static shapes of these and modes on them, all of them.
    seat_dofs, rest = np.split(np.arange(6 * n), [6 * len(seats)])
    T = np.eye(6 * n)
    T[np.ix_(rest, seat_dofs)] = -la.solve(K[np.ix_(rest, rest)], K[np.ix_(rest, seat_dofs)])
    T[np.ix_(rest, rest)] = la.eigh(K[np.ix_(rest, rest)], M[np.ix_(rest, rest)])[1]
    rigid = np.vstack([rigid_transfer(point) for point in points])
    return {
        "stiffness": T.T @ K @ T,
        "mass": T.T @ M @ T,
        "seats": np.array(["one_0", "one_1", "two_0", "two_1"]),
        "positions": seats,
        "weight": T.T @ M @ rigid[:, :3],
    }


def test_crossed_shafts_in_an_elastic_casing_agree_with_a_frame_of_beams(tmp_path: Path) -> None:
    seats = np.array([[0.0, 0.0, -0.08325], [0.0, 0.0, 0.03675], [-0.00675, 0.0, 0.0], [0.19325, 0.0, 0.0]])
    np.savez(tmp_path / "box.npz", **casing_of_tubes(seats, np.array([0.12, -0.02, -0.22])))
    names = ("one_0", "one_1", "two_0", "two_1")
    box = {"matrices": str(tmp_path / "box.npz"), "seats": {name: name for name in names}}
    tables = crossed(CASES["square"], supports={}, casings={"box": box})
    for name in names:
        tables["bearings"][name]["casing"] = "box"
    model = rg.Model(**tables)
    wanted = {
        None: [115.2481, 119.1635, 250.1369, 270.922, 304.056, 352.7886, 366.8385, 376.1334, 533.2864, 746.0121],
        600.0: [115.238, 119.17, 250.1353, 270.9154, 304.0051, 352.7731, 366.8676, 376.1385, 533.2925, 745.9593],
    }
    for speed, hz in wanted.items():
        modes = rg.modal(model, modes=11, speed=speed, elements=2)
        assert modes.frequency_hz[1:] == pytest.approx(hz, rel=1e-6)
    # Under weight alone the ground carries all of it, whichever way the shafts point.
    tables["operation"]["gravity"] = [2.0, -9.0, 3.0]
    tables |= {"loads": {}, "supports": {"brake": {"shaft": "two", "at": 0.23, "fixed": ["torsion"]}}}
    heavy = rg.static(rg.Model(**tables), elements=1)
    on_seats = sum(heavy.casing_seat_force[f"box.{name}"][:3] for name in names)
    mass = rg.check(rg.Model(**tables)).total_mass_kg
    assert on_seats == pytest.approx(mass * np.array([2.0, -9.0, 3.0]), rel=1e-9)
