"""A ring given by its teeth in all analyses: the same as one given by its base radius; and what its sheet and drawings show."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.teeth.inside_teeth import tooth_fields
from rotorgear.export.solids import build_solids
from rotorgear.export.teeth import tooth_phases
from rotorgear.gears.geometry.outline import tooth_outline
from rotorgear.plots.gear_mesh import gear_contour
from tests.unit.system.test_internal import refused

BETA = math.radians(12.0)


def toothed(**ring: Any) -> dict[str, Any]:
    """Tables of a pinion that drives a ring on a shaft at its end; nothing about them is equal or in line."""
    teeth = {"kind": "helical", "hand": "left", "helix_angle": BETA, "normal_module": 0.003}
    springs = {"x": 3e8, "y": 4.4e8, "axial": 1.3e8}
    return {
        "operation": {"input_shaft": "pinion", "speed": 310.0, "torque": 180.0, "output_shaft": "ring"},
        "shafts": {
            "pinion": {"position": (0.01, 0.02), "sections": [{"length": 0.16, "outer_diameter": 0.04}]},
            "ring": {"position": (0.01, 0.02 - 0.0729), "sections": [{"length": 0.09, "outer_diameter": 0.07}]},
        },
        "gears": {
            "sun": teeth | {"shaft": "pinion", "at": 0.08, "teeth": 23, "width": 0.03, "profile_shift": 0.3},
            "annulus": teeth
            | {"shaft": "ring", "at": 0.081, "teeth": 71, "width": 0.032, "profile_shift": -0.1, "internal": True}
            | {"body": {"rim_thickness": 0.014}, "addendum_factor": 0.85}
            | ring,
        },
        "meshes": {
            "pair": {
                "pinion": "sun",
                "gear": "annulus",
                "stiffness": "iso",
                "damping_ratio": 0.05,
                "transmission_error": [{"harmonic": 1, "amplitude": 3e-6}],
            }
        },
        "bearings": {
            "a": {"shaft": "pinion", "at": 0.01, "stiffness": springs},
            "b": {"shaft": "pinion", "at": 0.15, "stiffness": {"x": 2.5e8, "y": 2e8}},
            "c": {"shaft": "ring", "at": 0.005, "stiffness": springs},
            "d": {"shaft": "ring", "at": 0.05, "stiffness": {"x": 5e8, "y": 2e8}},
        },
    }


def lumped(model: rg.Model) -> rg.Model:
    """The same with gears given by base radius, mass and inertias, and a number for the stiffness."""
    tables = toothed()
    for name in ("sun", "annulus"):
        gear = model.layout.gear(name)
        geometry = gear.geometry
        assert geometry is not None
        kept = {key: tables["gears"][name][key] for key in ("shaft", "at", "kind", "hand", "teeth", "width")}
        tables["gears"][name] = kept | {
            "internal": name == "annulus",
            "base_radius": abs(geometry.base_radius),
            "base_helix_angle": geometry.base_helix_angle,
            "transverse_pressure_angle": model.layout.mesh("pair").pressure_angle,
            "mass": gear.body.mass,
            "polar_inertia": gear.body.polar_inertia,
            "diametral_inertia": gear.body.diametral_inertia,
        }
    # Without profile shift half a tooth is a quarter of the pitch: the mark moves instead, so that contacts keep their phase.
    tables["gears"]["sun"]["clocking"] = model.layout.mesh("pair").half_tooth - 0.5 * math.pi / 23
    force = model.torque_flow().of_mesh("pair")[0].normal_force
    tables["meshes"]["pair"]["stiffness"] = model.layout.mesh("pair").stiffness(force, sense=1).mean_normal
    return rg.Model(**tables)


def test_teeth_and_base_radius_are_one_ring_in_all_analyses() -> None:
    model = rg.Model(**toothed())
    other = lumped(model)
    still = [rg.static(one) for one in (model, other)]
    assert np.allclose(still[0].displacement, still[1].displacement, rtol=1e-9, atol=1e-14)
    assert np.abs(still[0].displacement).max() > 1e-5
    modes = [rg.modal(one, modes=9).frequency_hz for one in (model, other)]
    assert np.allclose(*modes, rtol=1e-9, atol=1e-3)
    waves = [rg.response(one, speeds=[300.0, 330.0]) for one in (model, other)]
    assert np.allclose(waves[0].mesh_force, waves[1].mesh_force, rtol=1e-7)
    runs = [rg.transient(one, time=2e-4, steps=40, error_estimate=False) for one in (model, other)]
    assert np.allclose(runs[0].mesh_force, runs[1].mesh_force, rtol=1e-7)
    assert np.ptp(runs[0].mesh_force) > 10.0


def test_the_blank_of_a_ring_lies_around_its_reference_circle() -> None:
    model = rg.Model(**toothed())
    geometry = model.layout.gear("annulus").geometry
    assert geometry is not None
    inside = 0.5 * 71 * 0.003 / math.cos(BETA)
    outside = inside + 0.003 * (1.25 + 0.1) + 0.014
    mass = 7850.0 * math.pi * (outside**2 - inside**2) * 0.032
    body = model.layout.gear("annulus").body
    assert body.mass == pytest.approx(mass, rel=1e-9)
    assert body.polar_inertia == pytest.approx(0.5 * mass * (outside**2 + inside**2), rel=1e-9)
    same = rg.Model(**toothed(body={"outer_diameter": 2.0 * outside}))
    assert same.layout.gear("annulus").body.mass == pytest.approx(mass, rel=1e-9)
    assert "body.rim_thickness or body.outer_diameter of the ring" in refused(toothed(body={}))


def test_the_sheet_of_a_ring_has_positive_numbers_and_no_span() -> None:
    sheet = rg.gear(rg.Model(**toothed()))
    sun, ring = sheet.gears
    mesh = sheet.meshes[0]
    assert (sun.internal, ring.internal) == (False, True)
    assert (ring.teeth, ring.span_teeth, ring.span_m) == (71, None, None)
    assert ring.tip_diameter_m < ring.reference_diameter_m < ring.form_diameter_m < ring.root_diameter_m
    assert mesh.ratio == pytest.approx(71 / 23)
    assert mesh.centre_distance_m == pytest.approx(0.0729)
    assert mesh.working_pitch_diameter_m[1] - mesh.working_pitch_diameter_m[0] == pytest.approx(2 * 0.0729)
    # From the axis of the ring: tip of the pinion to root of the ring, and root of the pinion to tip of the ring.
    assert mesh.tip_clearance_m[0] == pytest.approx(0.5 * (ring.root_diameter_m - sun.tip_diameter_m) - 0.0729)
    assert mesh.tip_clearance_m[1] == pytest.approx(0.5 * (ring.tip_diameter_m - sun.root_diameter_m) - 0.0729)


def test_drawn_teeth_touch_and_none_is_in_another() -> None:
    teeth = rg.Model(**toothed()).layout.mesh("pair").teeth
    pinion, ring = gear_contour(teeth, 1), gear_contour(teeth, 2)
    axis = [teeth.pair.centre_distance, 0.0]
    # Contours about the ring's axis, as angles over the radius: a pinion's point lies between two flanks of the ring.
    mine, theirs = ((points - axis) @ [1.0, 1.0j] for points in (pinion, ring))
    outline = tooth_outline(teeth.second)
    inside = np.abs(mine) > outline.tip_radius
    roll = -np.sqrt(np.abs(mine[inside]) ** 2 - teeth.second.base_radius**2)
    half = outline.involute(np.maximum(roll, outline.form_roll_length))[1]
    own = outline.involute(teeth.second.base_radius * math.tan(teeth.pair.working_transverse_pressure_angle))[1]
    # The tooth that touches at the pitch point has its middle at `own`.
    beside = np.abs((np.angle(mine[inside]) - own + math.pi / 71) % (2 * math.pi / 71) - math.pi / 71)
    assert (beside - half).min() > -1e-9
    assert (beside - half).min() < 1e-4
    assert np.abs(theirs).max() == pytest.approx(outline.root_radius)


def test_a_ring_is_solid_between_its_teeth_and_its_outer_surface() -> None:
    model = rg.Model(**toothed())
    modes = rg.modal(model, modes=1)
    solids = build_solids(modes.model, modes.nodes)
    number = solids.part_names.index("gears.annulus")
    points = solids.points[np.unique(solids.quads[solids.part[: len(solids.quads)] == number])]
    radius = np.hypot(points[:, 0] - 0.01, points[:, 1] - 0.02 + 0.0729)
    geometry = model.layout.gear("annulus").geometry
    assert geometry is not None
    assert radius.min() == pytest.approx(-0.5 * geometry.effective_tip_diameter, rel=1e-6)
    assert radius.max() == pytest.approx(-0.5 * geometry.root_diameter + 0.014, rel=1e-6)


def test_what_a_ring_has_not_is_refused_by_name() -> None:
    assert "gears.annulus.body.web_thickness" in refused(toothed(body={"rim_thickness": 0.02, "web_thickness": 0.01}))
    assert "one of the two" in refused(toothed(body={"rim_thickness": 0.02, "outer_diameter": 0.3}))
    assert "more than the root diameter" in refused(toothed(body={"outer_diameter": 0.22}))
    assert "gears.annulus.integral: got true of a ring" in refused(toothed(integral=True))
    assert "gears.sun.cutter_teeth" in refused(with_gear("sun", cutter_teeth=20))
    assert "can't hold a pinion" in refused(with_gear("sun", teeth=80))
    far = with_loaded_teeth()
    far["gears"]["annulus"]["teeth"] = 200
    assert "meshes.pair: got axes 72.9 mm apart" in refused(far)
    assert "profile shift of 1.4 is too large" in refused(toothed(profile_shift=1.4))
    assert "reach to its axis" in refused(toothed(addendum_factor=40.0))
    energy = toothed()
    energy["meshes"]["pair"]["stiffness"] = "potential_energy"
    assert "meshes.pair.stiffness: got 'potential_energy' in a ring, expected 'iso'" in refused(energy)
    with pytest.raises(rg.AnalysisError, match="'potential_energy' has no ring"):
        rg.mesh(rg.Model(**with_loaded_teeth()), stiffness="potential_energy")


def with_gear(name: str, **change: Any) -> dict[str, Any]:
    """The tables with one gear changed."""
    tables = toothed()
    tables["gears"][name] |= change
    return tables


def test_tips_that_cut_each_other_are_an_error_and_a_pinion_that_only_goes_in_along_the_axis_a_word() -> None:
    spur = {"kind": "spur", "hand": None, "helix_angle": None, "profile_shift": 0.0, "addendum_factor": 0.8}
    tables = toothed(**spur | {"teeth": 46})
    tables["gears"]["sun"] |= spur | {"teeth": 40}
    tables["shafts"]["ring"]["position"] = (0.01, 0.02 - 0.009)
    assert "that cut each other by 0.0738" in refused(tables)
    tables["gears"]["annulus"]["teeth"] = 50
    tables["shafts"]["ring"]["position"] = (0.01, 0.02 - 0.015)
    assert any("only along the axis" in text for text in rg.gear(rg.Model(**tables)).meshes[0].warnings)
    assert not any("only along the axis" in text for text in rg.gear(rg.Model(**toothed())).meshes[0].warnings)


def with_loaded_teeth(**mesh: Any) -> dict[str, Any]:
    """The tables with loaded teeth."""
    tables = toothed()
    pair = tables["meshes"]["pair"]
    del pair["transmission_error"]
    pair |= {"stiffness": "tooth_fe", "tooth_fe": {"preset": "preview"}} | mesh
    return tables


def test_loaded_teeth_of_a_ring_carry_it_in_the_rotor_model() -> None:
    model = rg.Model(**with_loaded_teeth())
    teeth = rg.mesh(model, estimate=False)
    still = rg.static(model)
    # That of the mean deflection and the mean over the period, at other positions, differ by the ripple squared.
    stiffness = teeth.mean_tangent_stiffness / math.cos(teeth.base_helix_angle) ** 2
    assert still.mesh_stiffness[0] == pytest.approx(stiffness, rel=1e-3)
    # The mean approach of the loaded teeth, along the flank normal.
    approach = teeth.mean_transmission_error * math.cos(teeth.base_helix_angle)
    assert still.mesh_deflection[0] == pytest.approx(approach, rel=1e-3)
    # Tilted shafts open the flanks at larger z by n (theta_gear x k - theta_pinion x k); e is +y.
    alpha = model.layout.mesh("pair").pressure_angle
    normal = math.cos(teeth.base_helix_angle) * np.array([-math.cos(alpha), math.sin(alpha)])
    z = {"pinion": 0.0805, "ring": 0.0805}
    tilt = {}
    for shaft, at in z.items():
        own = [i for i, name in enumerate(still.nodes.shaft) if name == shaft]
        nearest = min(own, key=lambda i: abs(still.nodes.position[i][2] - at))
        tilt[shaft] = np.array([still.displacement[nearest, 4], -still.displacement[nearest, 3]])
    opened = 0.03 * normal @ (tilt["ring"] - tilt["pinion"])
    assert still.faces[0].shaft_misalignment_m == pytest.approx(opened, rel=0.02)
    assert abs(opened) > 1e-5


@pytest.mark.parametrize("first", ["sun", "annulus"])
def test_drawn_teeth_of_a_pinion_stand_in_the_gaps_of_its_ring(first: str) -> None:
    tables = toothed()
    tables["shafts"]["ring"]["position"] = (0.01 + 0.0729 * math.cos(0.7), 0.02 + 0.0729 * math.sin(0.7))
    tables["gears"] = {name: tables["gears"][name] for name in sorted(tables["gears"], key=first.__ne__)}
    model = rg.Model(**tables)
    phases = tooth_phases(model, {name: shaft.frame for name, shaft in model.shafts.items()})
    rate = math.tan(model.layout.gear("sun").base_helix_angle)
    shares = []
    # The pitch point, away from the ring's axis, in the middle of the common face; a left-hand helix turns back towards +z.
    for name, z in (("sun", 23), ("annulus", 71)):
        gear = model.layout.gear(name)
        middle = phases[name] - rate / gear.base_radius * (0.08 - gear.z)
        shares.append((0.7 + math.pi - middle) / (2.0 * math.pi) * z)
    # Both turn the same way: where a tooth of the pinion is so far back, so is a gap of the ring.
    assert math.remainder(shares[0] - shares[1] - 0.5, 1.0) == pytest.approx(0.0, abs=1e-6)


def test_fields_of_loaded_teeth_lie_where_pinion_and_ring_mesh_and_roots_are_stressed() -> None:
    tables = with_loaded_teeth()
    for name in ("sun", "annulus"):
        tables["gears"][name] |= {"kind": "spur", "hand": None, "helix_angle": None}
    tables["shafts"]["ring"]["position"] = (0.01, 0.02 - 0.07137914743405432)
    model = rg.Model(**tables)
    fields = tooth_fields(model, at=0.1)
    pinion, ring = (field.points[:, :2] for field in fields.gears)
    geometry = model.layout.gear("annulus").geometry
    assert geometry is not None
    from_ring = np.hypot(ring[:, 0], ring[:, 1] + 0.07137914743405432)
    assert from_ring.min() == pytest.approx(-0.5 * geometry.effective_tip_diameter, rel=1e-6)
    # Each contact lies on both flanks, whose nodes are half a millimetre apart.
    for x, y, _ in fields.contact.ends.mean(axis=1):
        for points in (pinion, ring):
            assert np.hypot(*(points - [x, y]).T).min() < 0.25e-3
    # At little load one pair carries all at some time: tooth and beam with its notch agree within a fifth for the ring.
    light = rg.root_stress(model, torque=10.0, positions=8)
    for gear, share in zip(light.gears, (0.1, 0.2), strict=True):
        assert gear.nominal is not None
        assert gear.worst == pytest.approx(gear.nominal, rel=share)
