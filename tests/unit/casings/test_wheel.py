"""Gear bodies that turn: against plate theory, rotating disks, closed forms of compliance, and rigid gears."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import scipy.linalg as la
from scipy.optimize import brentq
from scipy.special import iv, ivp, jv, jvp, kv, kvp, yv, yvp

import rotorgear as rg
from rotorgear.casings.assembly import Elastic
from rotorgear.casings.casing import forget
from rotorgear.casings.fe_body import FiniteElementBody, finite_element_body
from rotorgear.casings.settings import CasingSettings
from rotorgear.casings.wheel import ReducedWheel
from rotorgear.casings.wheel_reduction import _Rim, reduce_wheel
from rotorgear.errors import AnalysisError
from tests.paths import ROOT
from tests.unit.casings.blocks import write_inp
from tests.unit.casings.rings import ring

pytest.importorskip("meshio")
NU = 0.3
STEEL = Elastic(210e9, NU, 7800.0)
THIN = (0.03, 0.1, 0.004)  # radii of bore and rim, thickness


def body(folder: Path, mesh: object, **more: object) -> FiniteElementBody:
    path = write_inp(folder / "wheel.inp", mesh)  # type: ignore[arg-type]
    settings = CasingSettings(
        "wheel.body",
        (("mesh", path),),
        1.0,
        STEEL,
        seats=(("seat", "bore"), ("rim", "rim")),
        connection="rigid",
        table="gears",
    )
    return finite_element_body(replace(settings, **more))  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def thin(tmp_path_factory: pytest.TempPathFactory) -> tuple[FiniteElementBody, ReducedWheel]:
    inner, outer, h = THIN
    fe = body(tmp_path_factory.mktemp("thin"), ring(tuple(np.geomspace(inner, outer, 9)), (-h / 2, h / 2), 36))
    return fe, reduce_wheel(fe, 5000.0)


def plate_frequency(n: int, inner: float, outer: float, h: float) -> float:
    """Lowest frequency in Hz of n nodal diameters of a plate, clamped inside and free outside (Leissa, NASA SP-160, eq. 1.17)."""

    def row(f: object, fp: object, sign: float, k: float, r: float) -> list[float]:
        # w, w', bending moment and Kelvin's edge force of f(k r) cos(n θ); the Laplacian of f is sign k² f.
        F, F1 = f(n, k * r), k * fp(n, k * r)  # type: ignore[operator]
        laplacian = sign * k**2 * F
        F2 = laplacian - F1 / r + n**2 * F / r**2
        moment = F2 + NU * (F1 / r - n**2 * F / r**2)
        force = sign * k**2 * F1 - (1.0 - NU) * n**2 / r**2 * (F1 - F / r)
        return [F, F1, moment, force]

    kinds = ((jv, jvp, -1.0), (yv, yvp, -1.0), (iv, ivp, 1.0), (kv, kvp, 1.0))

    def determinant(k: float) -> float:
        A = np.array(
            [[row(f, fp, s, k, inner)[i] for f, fp, s in kinds] for i in (0, 1)]
            + [[row(f, fp, s, k, outer)[i] for f, fp, s in kinds] for i in (2, 3)]
        )
        return float(np.linalg.det(A / np.abs(A).max(axis=1)[:, None] / np.abs(A).max(axis=0)))

    grid = np.linspace(8.0, 90.0, 400)
    values = [determinant(k) for k in grid]
    first = next(i for i in range(len(grid) - 1) if values[i] * values[i + 1] < 0.0)
    k = brentq(determinant, grid[first], grid[first + 1])
    bending = STEEL.youngs_modulus * h**3 / (12.0 * (1.0 - NU**2))
    return float(k**2 * np.sqrt(bending / (STEEL.density * h)) / (2.0 * np.pi))


@pytest.mark.parametrize("n", [0, 1, 2, 3, 4])
def test_a_thin_disk_has_the_nodal_diameters_of_plate_theory(
    thin: tuple[FiniteElementBody, ReducedWheel], n: int
) -> None:
    wheel = thin[1]
    found = wheel.frequency[wheel.diameters == n]
    assert found[0] == pytest.approx(plate_frequency(n, *THIN), rel=8e-3)
    if n:
        assert found[1] == found[0]


def turning_frequencies(wheel: ReducedWheel, speed: float) -> np.ndarray:
    """Of the body with its bore at rest, seen from the ground, in Hz rising."""
    k = wheel.size
    K = np.diag(wheel.stiffness) + speed**2 * wheel.spin_stiffness
    G = speed * wheel.gyroscopic[6:, 6:]
    found = la.eigvals(np.block([[np.zeros((k, k)), np.eye(k)], [-K, -G]])).imag / (2.0 * np.pi)
    return np.sort(found[found > 0.0])


def test_waves_on_a_disk_that_turns_split_by_twice_their_diameters_times_the_speed(
    thin: tuple[FiniteElementBody, ReducedWheel],
) -> None:
    wheel = thin[1]
    speed = 200.0
    found = turning_frequencies(wheel, speed)
    for n in (2, 3, 4):
        k = int(np.flatnonzero(wheel.diameters == n)[0])
        # On the disk it has ω² + B W² by centrifugal stresses (Southwell); waves forward and backward are ± n W apart from it.
        B = wheel.spin_stiffness[k, k] + n**2
        on_disk = np.sqrt(wheel.stiffness[k] + B * speed**2)
        for expected in (on_disk + n * speed, on_disk - n * speed):
            assert np.abs(2.0 * np.pi * found / expected - 1.0).min() < 2e-4


def test_centrifugal_stresses_stiffen_a_membrane_as_lamb_and_southwell_found(tmp_path: Path) -> None:
    """A full disk without bending stiffness: ω²/W² = (n (n + 2) (3 + ν) - n² (1 + 3 ν)) / 8, with w = r^n cos nθ."""
    from rotorgear.casings.constrained import Constrained, ElasticBody
    from rotorgear.casings.reduced_body import rigid_motions
    from rotorgear.casings.wheel_reduction import spin_integrals

    fe = body(tmp_path, ring((1e-4, 0.02, 0.04, 0.07, 0.1), (-5e-4, 5e-4), 24))
    R = rigid_motions(fe.mesh.points)
    free = fe.free_space(held=False, rigid_seats=False)
    outward = fe.matrices.times_mass((fe.mesh.points * [1.0, 1.0, 0.0]).reshape(-1, 1))
    # The mean motions of the rim at rest: the forces are in balance.
    system = Constrained(ElasticBody(fe.stiffness_in(free.shapes), R, "disk"), fe.mean_weights(fe.seats[1:]))
    _, stress = spin_integrals(fe.mesh, STEEL, system.solve(outward)[:, 0])
    x, y, _ = fe.mesh.points.T
    for n in (1, 2, 3):
        w = ((x + 1j * y) ** n).real
        expected = (n * (n + 2) * (3.0 + NU) - n**2 * (1.0 + 3.0 * NU)) / 8.0
        assert w @ (stress @ w) / (w @ (fe.matrices.mass @ w)) == pytest.approx(expected, rel=2e-3)
    # What rigid rotations take by the mass, they get back by the stresses: H is I_p / 2 for a tilt, I_p about the axis.
    polar = fe.mass_properties[2][2, 2]
    for motion, expected in zip(R.T, (0.0, 0.0, 0.0, 0.5 * polar, 0.5 * polar, polar), strict=True):
        u = motion.reshape(-1, 3)
        assert np.sum(u * (stress @ u)) == pytest.approx(expected, rel=1e-6, abs=1e-9 * polar)


def test_a_rim_that_moves_rigidly_on_a_soft_web_is_hardly_stiffened(tmp_path: Path) -> None:
    """Of a rigid motion S - H = 0: what the stresses of the rim bring, its mass takes. The web's pull alone is left."""
    keep = np.ones((5, 16, 3), dtype=bool)
    keep[1:3, :, 0] = False
    keep[1:3, :, 2] = False
    mesh = ring((0.02, 0.03, 0.05, 0.07, 0.09, 0.1), (-0.02, -0.001, 0.001, 0.02), 16, keep)
    wheel = reduce_wheel(body(tmp_path, mesh), 2500.0)
    tilt = int(np.flatnonzero(wheel.diameters == 1)[0])
    twist = int(np.argmax(np.abs(wheel.rim_motion[5, : wheel.modes])))
    assert 0.0 < wheel.spin_stiffness[twist, twist] < 0.1
    assert 0.0 < wheel.spin_stiffness[tilt, tilt] < 0.2


def test_a_ring_winds_up_like_a_cylinder(tmp_path: Path) -> None:
    """φ = T / (4 π G L) (1/a² - 1/b²) for a ring of width L that is held at its bore and turned at its rim."""
    a, b, L = 0.03, 0.1, 0.02
    wheel = reduce_wheel(body(tmp_path, ring((a, 0.04, 0.06, b), (-L / 2, L / 2), 20)), None)
    G = STEEL.youngs_modulus / (2.0 * (1.0 + NU))
    expected = (1.0 / a**2 - 1.0 / b**2) / (4.0 * np.pi * G * L)
    assert wheel.rim_flexibility[5, 5] == pytest.approx(expected, rel=2e-3)


def test_the_flexibility_of_the_rim_does_not_depend_on_how_many_modes_are_kept(tmp_path: Path) -> None:
    fe = body(tmp_path, ring((0.03, 0.06, 0.1), (-0.004, 0.004), 16))
    few, many = (reduce_wheel(fe, modes_to) for modes_to in (1500.0, 20e3))
    assert few.modes < 10 < many.modes
    scale = np.sqrt(np.outer(*2 * [np.diag(many.rim_flexibility)]))
    np.testing.assert_allclose(few.rim_flexibility / scale, many.rim_flexibility / scale, atol=1e-8)


def test_a_body_turns_with_the_inertia_of_its_mesh(thin: tuple[FiniteElementBody, ReducedWheel]) -> None:
    fe, wheel = thin
    mass, _, inertia = fe.mass_properties
    rigid = [mass, mass, mass, inertia[0, 0], inertia[1, 1], inertia[2, 2]]
    np.testing.assert_allclose(wheel.mass[:6, :6], np.diag(rigid), atol=1e-9 * mass)
    assert wheel.gyroscopic[3, 4] == pytest.approx(inertia[2, 2], rel=1e-9)
    np.testing.assert_allclose(wheel.gyroscopic, -wheel.gyroscopic.T, atol=1e-12)
    assert la.eigvalsh(wheel.mass).min() > 0.0


def test_teeth_on_a_rim_move_as_the_rim_moves_where_they_stand(thin: tuple[FiniteElementBody, ReducedWheel]) -> None:
    """The foot at an angle is that at another one, of the field that is turned: exp(-α L)."""
    wheel = thin[1]
    angle, more = 0.4, 0.9
    turned = la.expm(-more * wheel.turning)
    c, s = np.cos(more), np.sin(more)
    axes = la.block_diag(*2 * [np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])])
    here, there = (wheel.foot(x, 0.1, 0.003) for x in (angle, angle + more))
    np.testing.assert_allclose(there @ turned, axes @ here, atol=1e-9 * np.abs(here).max())


def holes(parts: int) -> np.ndarray:
    """A rim and a hub with spokes between them: bricks of the web are left out, in equal parts about the axis."""
    keep = np.ones((4, 24, 1), dtype=bool)
    around = np.arange(24) % (24 // parts) < (12 // parts)
    keep[1:3, around] = False
    return keep


def test_a_body_of_six_parts_is_averaged_and_one_of_two_is_refused(tmp_path: Path) -> None:
    radii, heights = (0.02, 0.04, 0.06, 0.08, 0.1), (-0.005, 0.005)
    small = np.ones((4, 24, 1), dtype=bool)
    small[2, ::4] = False  # six holes
    wheel = reduce_wheel(body(tmp_path, ring(radii, heights, 24, small)), 4000.0)
    assert 1e-6 < wheel.averaged < 0.02
    with pytest.raises(AnalysisError, match="not near to one of revolution"):
        reduce_wheel(body(tmp_path, ring(radii, heights, 24, holes(2))), 4000.0)


def test_a_mesh_off_its_axis_is_refused(tmp_path: Path) -> None:
    mesh = ring((0.03, 0.06, 0.1), (-0.004, 0.004), 12)
    mesh.points = mesh.points + np.array([0.002, 0.0, 0.0])
    with pytest.raises(AnalysisError, match="2 mm off the z axis"):
        reduce_wheel(body(tmp_path, mesh), None)


MODEL = """
schema_version = 1
title = "A pair with an elastic wheel"
operation = { input_shaft = "a", output_shaft = "b", speed = "6000 rpm", torque = "100 N m" }
materials.own = { youngs_modulus = "%s", poisson_ratio = 0.3, density = "7800 kg/m^3" }

[shafts]
a = { position = ["0 mm", "0 mm"], sections = [{ length = "200 mm", outer_diameter = "30 mm" }] }
b = { position = ["150 mm", "0 mm"], sections = [{ length = "200 mm", outer_diameter = "30 mm" }] }

[gears.pinion]
shaft = "a"
at = "80 mm"
kind = "helical"
teeth = 25
hand = "right"
base_radius = "46 mm"
base_helix_angle = "15 deg"
mass = "2 kg"
polar_inertia = "0.002 kg m^2"
diametral_inertia = "0.001 kg m^2"

[gears.wheel]
shaft = "b"
at = "80 mm"
kind = "helical"
teeth = 50
hand = "left"
base_radius = "92 mm"
base_helix_angle = "15 deg"
%s

[meshes.pair]
pinion = "pinion"
gear = "wheel"
stiffness = "3e8 N/m"
transmission_error = [{ harmonic = 1, amplitude = "1 um" }]

[bearings]
a1 = { shaft = "a", at = "start", stiffness = { radial = "2e8 N/m", axial = "8e7 N/m" } }
a2 = { shaft = "a", at = "end", stiffness = { radial = "2e8 N/m" } }
b1 = { shaft = "b", at = "start", stiffness = { radial = "2e8 N/m", axial = "8e7 N/m" } }
b2 = { shaft = "b", at = "end", stiffness = { radial = "2e8 N/m" } }
"""
WHEEL = 'body = { mesh = "wheel.inp", unit = "m", material = "own", seat = "bore", rim = "rim", modes_to = "6 kHz"%s }'


def pair(folder: Path, wheel: str = WHEEL % "", modulus: str = "210 GPa") -> rg.Model:
    radii, heights = (0.015, 0.03, 0.06, 0.09, 0.1), (-0.01, -0.004, 0.004, 0.01)
    keep = np.ones((4, 16, 3), dtype=bool)
    keep[1:3, :, 0] = False
    keep[1:3, :, 2] = False
    if not (folder / "wheel.inp").exists():
        write_inp(folder / "wheel.inp", ring(radii, heights, 16, keep))
    (folder / "pair.toml").write_text(MODEL % (modulus, wheel), encoding="utf-8")
    return rg.load(folder / "pair.toml")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("pair")


def stated(model: rg.Model) -> str:
    gear = model.layout.gear("wheel").body
    inertia = {"polar_inertia": gear.polar_inertia, "diametral_inertia": gear.diametral_inertia}
    return "\n".join([f'mass = "{gear.mass!r} kg"', *(f'{key} = "{value!r} kg m^2"' for key, value in inertia.items())])


@pytest.mark.parametrize("speed", [None, "6000 rpm"])
def test_a_stiff_body_is_a_rigid_gear(folder: Path, speed: str | None) -> None:
    stiff = pair(folder, modulus="210e6 GPa")
    rigid = pair(folder, stated(stiff))
    found, expected = (rg.modal(model, modes=12, speed=speed).frequency_hz[1:] for model in (stiff, rigid))
    np.testing.assert_allclose(found, expected, rtol=1e-5)
    assert not np.allclose(rg.modal(pair(folder), modes=12, speed=speed).frequency_hz[1:], expected, rtol=1e-2)


def test_statics_has_the_give_of_the_body_and_its_weight(folder: Path) -> None:
    soft = pair(folder)
    rigid = pair(folder, stated(soft))
    found, expected = (rg.static(model) for model in (soft, rigid))
    np.testing.assert_allclose(found.mesh_force, expected.mesh_force, rtol=1e-9)  # the torque decides it
    heavy = [model.with_({"operation.gravity": (0.0, -9.81, 0.0)}) for model in (soft, rigid)]
    weight = [sum(rg.static(model).bearing_force[name][1] for name in model.bearings) for model in heavy]
    assert weight[0] == pytest.approx(weight[1], rel=1e-6)


def test_critical_speeds_are_the_crossings_of_the_campbell_diagram(folder: Path) -> None:
    model = pair(folder)
    found = rg.critical(model, stop="60000 rpm", fmax=900.0, elements=2)
    assert any("nodal diameters" in one.description for one in found.speeds)
    for one in found.speeds:
        near = rg.modal(model, modes=14, speed=one.speed, elements=2, error_estimate=False)
        assert np.abs(near.frequency_hz / one.frequency_hz - 1.0).min() < 1e-8


def test_a_mode_of_the_rim_is_named_by_its_nodal_diameters(folder: Path) -> None:
    lines = rg.modal(pair(folder), modes=14).description
    assert any(line.startswith("gear wheel: 2 nodal diameters") for line in lines)


@pytest.mark.parametrize(
    ("wheel", "text"),
    [
        (WHEEL.replace('unit = "m", ', "") % "", "gears.wheel.body.unit"),
        (WHEEL.replace('rim = "rim", ', "") % "", "gears.wheel.body.rim"),
        (WHEEL % ', web_thickness = "8 mm"', "a mesh or sizes of a blank"),
        (
            'body = { unit = "m" }\nmass = "1 kg"\npolar_inertia = "1 kg m^2"\ndiametral_inertia = "1 kg m^2"',
            "mesh beside",
        ),
        (WHEEL % "" + "\nintegral = true", "no bore"),
    ],
)
def test_a_body_that_lacks_or_repeats_something_is_refused(folder: Path, wheel: str, text: str) -> None:
    with pytest.raises(rg.RotorgearError, match=text):
        pair(folder, wheel)


@pytest.mark.parametrize(
    ("more", "text"),
    [
        ('\nmass = "5 kg"', "gears.wheel.body.mass"),
        ('\npolar_inertia = "5 kg m^2"', "counted once"),
    ],
)
def test_mass_that_is_stated_otherwise_than_the_mesh_has_it_is_refused(folder: Path, more: str, text: str) -> None:
    with pytest.raises(AnalysisError, match=text):
        rg.static(pair(folder, WHEEL % "" + more))


def test_a_sweep_takes_a_small_gearbox_with_an_elastic_body_in_a_basis(folder: Path) -> None:
    from rotorgear.analysis.sweep.point import PointMaker
    from rotorgear.analysis.sweep.reduce import Large, Reducer

    text = MODEL.replace('outer_diameter = "30 mm" }', 'outer_diameter = "30 mm", rigid = true }')
    pair(folder)
    (folder / "rigid.toml").write_text(text % ("210 GPa", WHEEL % ", damping_ratio = 0.01"), encoding="utf-8")
    point = PointMaker()(rg.load(folder / "rigid.toml"))
    assert isinstance(point, Large)
    assert 24 < point.local.n <= 80
    reducer = Reducer()
    reduced, _ = reducer([point], lambda size, error: None)[0]
    assert reduced.n < 0.6 * point.local.n
    summary = reducer.summary
    assert summary is not None
    assert max(summary.closed, summary.apart) <= 0.01


def test_loaded_teeth_are_held_where_the_rim_of_the_mesh_is() -> None:
    # The nodes of the set are within the mesh, three modules below the roots: what lies outside rides on them.
    model = rg.load(ROOT / "models" / "elastic_wheel.toml")
    assert model.layout.elastic_bodies["wheel"].rim_radius == pytest.approx(0.0875, rel=1e-6)
    for thickness, what in ((2.0, "would be in neither"), (4.0, "would count twice")):
        other = model.with_("meshes.pair.tooth_fe.rim_thickness", thickness)
        with pytest.raises(rg.AnalysisError, match=rf"{what}.*tooth_fe\.rim_thickness = 3\."):
            _ = other.layout.elastic_bodies


def test_the_surface_of_a_body_moves_with_its_shaft_and_its_waves(folder: Path) -> None:
    model = pair(folder)
    found = rg.modal(model, modes=14)
    own = found.nodes.of_casing("gears.wheel.body")
    points = found.nodes.position[own] - [0.15, 0.0, 0.08]
    radius = np.hypot(points[:, 0], points[:, 1])
    assert radius.max() == pytest.approx(0.1)
    node = found.nodes.nearest("b", 0.08)
    bore = np.flatnonzero(radius < 0.0151)
    for k in range(14):
        centre = found.shapes[node, :, k]
        rigid = centre[:3] + np.cross(centre[3:], points)
        # The bore is held by the shaft; the rim is not.
        moved = found.shapes[own, :3, k]
        assert np.abs(moved[bore] - rigid[bore]).max() < 1e-6 * np.abs(found.shapes[:, :3, k]).max() + 1e-12
    waves = [k for k, words in enumerate(found.description) if "2 nodal diameters" in words]
    rim = np.flatnonzero(radius > 0.099)
    angle = np.arctan2(points[rim, 1], points[rim, 0])
    axial = found.shapes[own[rim], 2, waves[0]]
    share = [abs(np.sum(axial * np.exp(-1j * n * angle))) for n in range(5)]
    assert np.argmax(share) == 2


def test_kept_bodies_keep_their_surface_and_their_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROTORGEAR_CACHE", str(tmp_path / "cache"))
    forget()
    first = pair(tmp_path).layout.elastic_bodies["wheel"]
    forget()
    again = pair(tmp_path).layout.elastic_bodies["wheel"]
    assert first.surface is not None
    assert again.surface is not None
    np.testing.assert_array_equal(again.surface.basis, first.surface.basis)
    assert again.mesh_error == first.mesh_error > 0.0


def test_a_shaft_carries_the_mass_of_its_wheel_and_none_of_the_wheels_modes() -> None:
    model = rg.load(ROOT / "models" / "elastic_wheel.toml")
    wheel = model.layout.gear("wheel").wheel
    assert wheel is not None
    alone, row = rg.check(model).shafts
    assert alone.length_m == row.length_m  # two shafts alike, of which one carries the wheel
    assert row.body_mass_kg == pytest.approx(wheel.body_mass, rel=1e-9)
    bare = alone.polar_inertia_kg_m2 - model.layout.gear("pinion").body.polar_inertia
    assert row.polar_inertia_kg_m2 == pytest.approx(bare + wheel.polar_inertia, rel=1e-9)


@pytest.mark.parametrize(("uniform", "largest"), [(0.6, 3), (0.8, 0)])
def test_the_strongest_wave_of_a_real_field_is_that_of_the_largest_mean_square(uniform: float, largest: int) -> None:
    # Over the circle the square of a constant a is a^2 in the mean, that of cos 3 theta is 1/2: they are equal at a = .707.
    angle = np.linspace(0.0, 2.0 * np.pi, 40, endpoint=False)
    points = np.column_stack([0.2 * np.cos(angle), 0.2 * np.sin(angle), np.zeros(40)])
    seat = SimpleNamespace(nodes=np.arange(40), surface_mass=np.eye(40))
    rim = _Rim(SimpleNamespace(seats=[None, seat], mesh=SimpleNamespace(points=points)))  # type: ignore[arg-type]
    radial = uniform + np.cos(3.0 * angle)
    field = radial[:, None] * np.column_stack([np.cos(angle), np.sin(angle), np.zeros(40)])
    assert rim.largest(field.ravel()) == largest
