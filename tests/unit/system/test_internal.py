"""Internal pairs: a sun, planets on axes that stand, and a ring, against vectors put together by hand and closed forms."""

from __future__ import annotations

import math
import re
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
import scipy.linalg as la

import rotorgear as rg
from rotorgear.export.solids import build_solids
from tests.turned import turned

MODULE, HELIX, ALPHA = 0.003, math.radians(20.0), math.radians(20.0)
ALPHA_T = math.atan(math.tan(ALPHA) / math.cos(HELIX))
BASE_HELIX = math.asin(math.sin(HELIX) * math.cos(ALPHA))
K_SUN, K_RING = 6e8, 7.5e8
# Mass, polar and diametral inertia, and springs to the ground along x y z tilt_x tilt_y torsion, of sun, planets and ring.
INERTIA = {"sun": (2.6, 0.0029, 0.0024), "planet": (2.2, 0.0046, 0.0031), "ring": (9.0, 0.26, 0.14)}
SPRINGS = {
    "sun": [4e7, 6.4e7, 3e7, 2e4, 3.2e4, 0.0],
    "planet": [4e8, 4e8, 1.5e8, 3e5, 3e5, 0.0],
    "ring": [9e8, 7e8, 7e8, 4e6, 3e6, 0.0],
}


def radius(teeth: int) -> float:
    """Reference radius in m."""
    return 0.5 * teeth * MODULE / math.cos(HELIX)


def star(teeth: tuple[int, int, int] = (27, 36, 99), angles: tuple[float, ...] = (0.0, 120.0, 240.0)) -> dict[str, Any]:
    """Tables of a sun that drives a ring through planets on axes that stand, all of them rigid points in one plane."""
    circle = radius(teeth[0]) + radius(teeth[1])
    planets = {f"planet_{i + 1}": math.radians(angle) for i, angle in enumerate(angles)}
    places = {"sun": (0.0, 0.0), "ring": (0.0, 0.0)}
    places |= {name: (circle * math.cos(psi), circle * math.sin(psi)) for name, psi in planets.items()}
    tables: dict[str, Any] = {
        "operation": {"input_shaft": "sun", "speed": 120.0, "torque": 300.0, "output_shaft": "ring"},
        "shafts": {name: {"position": place} for name, place in places.items()},
        "gears": {},
        "meshes": {},
        "bearings": {},
    }
    for name in places:
        kind = name.partition("_")[0]
        z = teeth[("sun", "planet", "ring").index(kind)]
        mass, polar, diametral = INERTIA[kind]
        tables["gears"][name] = {
            "shaft": name,
            "at": 0.0,
            "kind": "helical",
            "hand": "right" if kind == "sun" else "left",
            "internal": kind == "ring",
            "teeth": z,
            "base_radius": radius(z) * math.cos(ALPHA_T),
            "base_helix_angle": BASE_HELIX,
            "transverse_pressure_angle": ALPHA_T,
            "width": 0.03,
            "mass": mass,
            "polar_inertia": polar,
            "diametral_inertia": diametral,
        }
        names = ("x", "y", "axial", "tilt_x", "tilt_y", "torsion")
        stiffness = dict(zip(names, SPRINGS[kind], strict=True))
        tables["bearings"][name] = {"shaft": name, "at": 0.0, "stiffness": stiffness}
    for name in planets:
        tables["meshes"][f"sun_{name}"] = {"pinion": "sun", "gear": name, "stiffness": K_SUN}
        tables["meshes"][f"{name}_ring"] = {"pinion": name, "gear": "ring", "stiffness": K_RING}
    return tables


def by_hand() -> np.ndarray:
    """Frequencies in Hz of the star from vectors in space: each contact one point and one normal."""
    planets = np.radians([0.0, 120.0, 240.0])
    circle = radius(27) + radius(36)
    k = np.array([0.0, 0.0, 1.0])
    places = [np.zeros(3), np.zeros(3), *(circle * np.array([math.cos(psi), math.sin(psi), 0.0]) for psi in planets)]
    kinds = ["sun", "ring", *["planet"] * 3]
    M = np.diag(np.concatenate([[m, m, m, d, d, p] for m, p, d in (INERTIA[kind] for kind in kinds)]))
    K = np.diag(np.concatenate([SPRINGS[kind] for kind in kinds])).astype(float)
    for i, psi in enumerate(planets, 2):
        e = np.array([math.cos(psi), math.sin(psi), 0.0])
        # The sun (right) pushes the planet with s = +1; the planet (left) pushes the ring with s = -1.
        for one, other, s, h, r, stiffness in ((0, i, 1, 1, radius(27), K_SUN), (i, 1, -1, -1, radius(36), K_RING)):
            P = places[one] + r * e
            n_t = s * math.cos(ALPHA_T) * np.cross(k, e) + math.sin(ALPHA_T) * e
            n = math.cos(BASE_HELIX) * n_t - s * h * math.sin(BASE_HELIX) * k
            v = np.zeros(30)
            for body, sign in ((one, 1.0), (other, -1.0)):
                v[6 * body : 6 * body + 6] = sign * np.concatenate([n, np.cross(P - places[body], n)])
            K += stiffness * np.outer(v, v)
    return np.sqrt(np.abs(la.eigh(K, M, eigvals_only=True))) / (2.0 * math.pi)


def test_a_star_of_planets_has_the_frequencies_of_vectors_by_hand() -> None:
    wanted = by_hand()
    assert wanted[0] < 1e-2 < wanted[1]  # the train turns
    for model in (rg.Model(**star()), turned(rg.Model(**star()))):
        modes = rg.modal(model, modes=30)
        assert modes.rigid[0]
        assert modes.frequency_hz[1:] == pytest.approx(wanted[1:], rel=1e-9)


def test_speeds_torques_and_forces_of_a_star() -> None:
    model = rg.Model(**star())
    train = model.layout.train
    assert train.ratios["planet_2"] == -Fraction(3, 4)
    assert train.ratios["ring"] == -Fraction(3, 11)
    found = rg.static(model)
    torque = found.torque
    assert torque["operation.output_shaft"] == pytest.approx(300.0 * 11 / 3, rel=1e-12)
    force = 300.0 / (3.0 * radius(27) * math.cos(ALPHA_T) * math.cos(BASE_HELIX))
    # A planet passes on what it gets; its bearing takes both tangential forces, and the axial ones cancel.
    assert found.mesh_force == pytest.approx(np.full(6, force), rel=0.2)
    assert found.mesh_force.reshape(3, 2) @ [1.0, -1.0] == pytest.approx(np.zeros(3), abs=1e-9 * force)
    assert found.bearing_force["planet_1"][2] == pytest.approx(0.0, abs=1e-9 * force)
    # The mountings of planets and ring take the moment that is left over.
    places = {name: model.shafts[name].frame.origin for name in model.shafts}
    moment = sum(
        load[5] + np.cross(places[name], load[:3])[2] for name, load in found.bearing_force.items()
    )  # fmt: skip
    assert moment + 300.0 * (1.0 + 11 / 3) == pytest.approx(0.0, abs=1e-9 * 1400.0)


def test_planets_at_equal_angles_go_together_where_the_teeth_of_sun_and_ring_allow_it_and_have_parkers_phases() -> None:
    """Parker and Lin 2004: sun meshes -z_s psi_i/2 pi, ring meshes z_r psi_i/2 pi pitches after those of planet 1."""
    model = rg.Model(**star((28, 35, 98)))
    assert [rest for _, _, rest in model.layout.assembly.loops] == pytest.approx([0.0, 0.0], abs=1e-9)
    phases = {name: phase / (2.0 * math.pi) for name, phase in model.torque_flow().phases.items() if phase is not None}
    for i, psi in ((2, 1 / 3), (3, 2 / 3)):
        sun = phases[f"sun_planet_{i}"] - phases["sun_planet_1"]
        ring = phases[f"planet_{i}_ring"] - phases["planet_1_ring"]
        assert math.remainder(sun + 28 * psi, 1.0) == pytest.approx(0.0, abs=1e-9)
        assert math.remainder(ring - 98 * psi, 1.0) == pytest.approx(0.0, abs=1e-9)
    # An angle that is no multiple of 360/(z_s + z_r) leaves a part of a pitch open, that is how far the planet is off it.
    off = rg.Model(**star((28, 35, 98), (0.0, 120.2, 240.0)))
    rest = max(abs(rest) for _, _, rest in off.layout.assembly.loops)
    assert rest == pytest.approx(126 * 0.2 / 360.0, rel=1e-6)


def test_planets_that_turn_on_standing_axes_have_the_planet_modes_of_lin_and_parker() -> None:
    """N - 1 modes of planets against each other, sqrt((k_sp + k_rp)/(I/r^2)), all else at rest (torsion alone)."""
    radii = {"sun": 0.0387, "ring": 0.1375} | {f"planet_{i}": 0.05015 for i in (1, 2, 3)}
    lumped = {"sun": 0.39, "ring": 3.0, "planet": 0.61}
    gears = {
        name: {
            "shaft": name,
            "at": 0.0,
            "kind": "spur",
            "internal": name == "ring",
            "base_radius": r,
            "mass": 1.0,
            "polar_inertia": lumped[name.partition("_")[0]] * r**2,
            "diametral_inertia": 1.0,
        }
        for name, r in radii.items()
    }
    meshes = {f"s{i}": {"pinion": "sun", "gear": f"planet_{i}", "stiffness": 5e8} for i in (1, 2, 3)}
    meshes |= {f"r{i}": {"pinion": f"planet_{i}", "gear": "ring", "stiffness": 5e8} for i in (1, 2, 3)}
    held = {"ring": {"shaft": "ring", "at": 0.0, "stiffness": {"torsion": 1e9 * 0.1375**2}}}
    model = rg.Model(
        motions=["torsion"], shafts={name: {} for name in radii}, gears=gears, meshes=meshes, supports=held
    )
    found = rg.modal(model, modes=5).frequency_hz
    wanted = math.sqrt(1e9 / 0.61) / (2.0 * math.pi)
    assert wanted == pytest.approx(6443.995, abs=1e-3)
    assert np.sum(np.isclose(found, wanted, rtol=1e-9)) == 2


def test_a_ring_is_drawn_about_what_turns_in_it() -> None:
    model = rg.Model(**star())
    modes = rg.modal(model, modes=2)
    solids = build_solids(modes.model, modes.nodes)
    ring = np.unique(solids.quads[solids.part[: len(solids.quads)] == solids.part_names.index("gears.ring")])
    assert np.hypot(*solids.points[ring, :2].T).min() == pytest.approx(radius(99), rel=1e-9)


def refused(tables: dict[str, Any]) -> str:
    """What a model of some tables is refused with."""
    with pytest.raises(rg.ModelError) as error:
        rg.Model(**tables)
    return re.sub(r"\s+", " ", str(error.value))


def test_what_no_internal_pair_can_have_is_refused_by_name() -> None:
    one = star()
    one["meshes"]["planet_1_ring"] = {"pinion": "ring", "gear": "planet_1", "stiffness": 1e8}
    assert "the external gear is the pinion" in refused(one)
    one = star()
    one["gears"]["ring"]["hand"] = "right"
    assert "an internal pair winds the same way" in refused(one)
    one = star()
    one["shafts"]["planet_2"]["position"] = (0.0, 0.09)
    assert "meshes.planet_2_ring: got axes 90 mm apart, expected a centre distance of 100.5" in refused(one)
    one = star()
    one["gears"]["ring"]["integral"] = True
    assert "gears.ring.integral: got true of a ring" in refused(one)
    one = star()
    one["meshes"]["planet_1_ring"]["stiffness"] = "iso"
    assert "meshes.planet_1_ring.stiffness" in refused(one)
