"""Reduced bodies against closed forms and against their own whole meshes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg as la
from scipy.optimize import brentq

import rotorgear as rg
from rotorgear.casings import mesh_error
from rotorgear.casings.assembly import Elastic
from rotorgear.casings.fe_body import finite_element_body
from rotorgear.casings.mesh_error import eigenvalue_errors
from rotorgear.casings.reduced_body import mass_properties, rigid_motions
from rotorgear.casings.reduction import free_modes, held_modes, reduce, rigid_residual
from rotorgear.casings.settings import CasingSettings, JoinSettings, MountSettings
from tests.unit.casings.blocks import block, write_inp

pytest.importorskip("meshio")
STEEL = Elastic(206e9, 0.3, 7850.0)
SIZE = (0.1, 0.06, 0.2)


def settings(folder: Path, counts: tuple[int, int, int] = (2, 1, 3), kind: str = "tetra10") -> CasingSettings:
    path = write_inp(folder / f"{kind}{'_'.join(map(str, counts))}.inp", block(SIZE, counts, kind))
    return CasingSettings("b", (("mesh", path),), 1.0, STEEL, seats=(("one", "high"), ("two", "low")))


def held_at_its_foot(folder: Path, **more: object) -> CasingSettings:
    return replace(settings(folder, **more), held=("low",), seats=(("one", "high"),))  # type: ignore[arg-type]


def errors(measured: np.ndarray, true: np.ndarray) -> np.ndarray:
    return np.asarray(measured / true - 1.0)


@pytest.mark.parametrize("connection", ["mean", "rigid"])
def test_a_body_that_floats_keeps_its_mass_and_its_rigid_motions(tmp_path: Path, connection: str) -> None:
    fe = finite_element_body(replace(settings(tmp_path), connection=connection))  # type: ignore[arg-type]
    body, *_ = reduce(fe, None)
    assert body.rigid is not None
    K = body.stiffness
    assert np.linalg.norm(K @ body.rigid) < 1e-10 * np.linalg.norm(K) * np.linalg.norm(body.rigid)
    for reduced, mesh in zip(mass_properties(body.rigid.T @ body.mass @ body.rigid), fe.mass_properties, strict=True):
        np.testing.assert_allclose(reduced, mesh, rtol=0.0, atol=1e-9 * np.abs(mesh).max())
    assert body.body_mass == pytest.approx(7850.0 * np.prod(SIZE), rel=1e-12)
    np.testing.assert_allclose(body.centre, np.array(SIZE) / 2.0, atol=1e-12)
    inertia = body.body_mass / 12.0 * (SIZE[1] ** 2 + SIZE[2] ** 2)
    assert body.inertia[0, 0] == pytest.approx(inertia, rel=1e-12)
    np.testing.assert_allclose(body.mass @ body.rigid, body.inertia_force, atol=1e-9 * np.abs(body.inertia_force).max())
    frequency = body.modes()[0]
    assert frequency[5] < 1e-3 * frequency[6]


@pytest.mark.parametrize("held", [False, True])
def test_a_reduced_body_has_the_modes_of_its_mesh_within_the_error_that_it_states(tmp_path: Path, held: bool) -> None:
    fe = finite_element_body(held_at_its_foot(tmp_path) if held else settings(tmp_path))
    body, factor, _ = reduce(fe, 30e3)
    whole = (held_modes if held else free_modes)(fe, 6, factor)
    frequency, shapes = body.modes()
    first = 0 if held else 6
    chosen = range(first, first + 6)
    true = errors(frequency[first : first + 6] ** 2, whole.frequency**2)
    stated = np.array([body.eigenvalue_error((2 * np.pi * frequency[i]) ** 2, shapes[:, i]) for i in chosen])
    assert np.all(true > -1e-9), "a reduced body is too stiff"
    assert true.max() < 1e-3
    big = true > 1e-8  # below, rounding counts
    assert big.any()
    assert np.all(stated[big] > 0.9 * true[big])
    assert np.all(stated[big] < 2.0 * true[big])


def test_residual_shapes_make_up_for_modes_that_are_left_out(tmp_path: Path) -> None:
    fe = finite_element_body(held_at_its_foot(tmp_path))
    whole = held_modes(fe, 3).frequency
    few, *_ = reduce(fe, 5e3)
    assert len(few.fixed_frequency) < 3
    # Without them a basis of so few modes errs by per cents; with them by less than 1e-3.
    statics = slice(0, few.interface + len(few.fixed_frequency))
    plain = np.sqrt(la.eigvalsh(few.stiffness[statics, statics], few.mass[statics, statics])) / (2.0 * np.pi)
    assert errors(few.modes()[0][:3], whole).max() < 1e-3
    assert errors(plain[:3], whole).max() > 3.0 * errors(few.modes()[0][:3], whole).max()


def test_a_rigid_seat_stiffens_its_face_and_a_mean_one_does_not(tmp_path: Path) -> None:
    one = held_at_its_foot(tmp_path)
    mean, rigid = (reduce(finite_element_body(replace(one, connection=kind)), None)[0] for kind in ("mean", "rigid"))
    # The face of a mean seat is as free as without a seat.
    np.testing.assert_allclose(mean.modes()[0][:6], held_modes(finite_element_body(one), 6).frequency, rtol=1e-4)
    stiffened = rigid.modes()[0][:6] / mean.modes()[0][:6] - 1.0
    assert stiffened.min() > -1e-6
    assert stiffened.max() > 2e-3


def test_modes_beyond_what_a_mesh_can_have_are_not_taken(tmp_path: Path) -> None:
    fe = finite_element_body(replace(held_at_its_foot(tmp_path, counts=(1, 1, 2)), damping_ratio=0.01))
    body, *_ = reduce(fe, 10e6)
    free = fe.dofs - 3 * len(fe.held)
    assert len(body.fixed_frequency) == free // 4
    assert body.fixed_frequency[-1] < body.left_frequency < 10e6
    np.testing.assert_allclose(body.modes()[0][:8], held_modes(fe, 8).frequency, rtol=1e-5)


def test_a_mean_seat_on_a_bar_without_contraction_has_the_stiffness_of_the_bar(tmp_path: Path) -> None:
    one = held_at_its_foot(tmp_path, counts=(1, 1, 2), kind="hexahedron20")
    body, *_ = reduce(finite_element_body(replace(one, material=Elastic(206e9, 0.0, 7850.0))), 20e3)
    width, depth, length = SIZE
    axial = 206e9 * width * depth / length
    bending = 206e9 * depth * width**3 / 12.0 / length
    flexibility = np.linalg.inv(body.stiffness[:6, :6])
    assert 1.0 / flexibility[2, 2] == pytest.approx(axial, rel=1e-9)
    # A moment alone bends the bar to a circle, which quadratic elements hold exactly.
    assert 1.0 / flexibility[4, 4] == pytest.approx(bending, rel=1e-9)
    np.testing.assert_allclose(body.seat_points[0], [width / 2, depth / 2, length], atol=1e-12)


def test_a_body_on_soft_mounts_swings_as_a_rigid_one_and_is_damped_by_them(tmp_path: Path) -> None:
    stiffness, damping = 1e5, 40.0
    rows = np.diag([stiffness] * 3 + [1e3] * 3)
    mount = MountSettings("low", tuple(map(tuple, rows)), tuple(map(tuple, rows * damping / stiffness)))
    fe = finite_element_body(replace(settings(tmp_path), mounts=(mount,), seats=(("one", "high"),)))
    body, *_ = reduce(fe, None)
    along_z = np.sqrt(stiffness / body.body_mass) / (2.0 * np.pi)
    frequency, shapes = body.modes()
    nearest = int(np.argmin(np.abs(frequency - along_z)))
    assert frequency[nearest] == pytest.approx(along_z, rel=1e-4)
    modal = float(shapes[:, nearest] @ body.damping @ shapes[:, nearest])
    assert modal == pytest.approx(damping / body.body_mass, rel=1e-3)
    np.testing.assert_allclose(held_modes(fe, 7).frequency, frequency[:7], rtol=1e-4)
    assert body.held
    assert body.rigid is None


def test_every_elastic_mode_has_the_damping_ratio_of_the_file_and_no_rigid_one(tmp_path: Path) -> None:
    body, *_ = reduce(finite_element_body(replace(settings(tmp_path), damping_ratio=0.02)), None)
    frequency, shapes = body.modes()
    modal = shapes.T @ body.damping @ shapes
    np.testing.assert_allclose(np.diag(modal)[6:], 2.0 * 0.02 * 2.0 * np.pi * frequency[6:], rtol=1e-6)
    assert np.abs(np.diag(modal)[:6]).max() < 1e-6 * modal[6, 6]


def test_the_surface_moves_with_the_body(tmp_path: Path) -> None:
    body, *_ = reduce(finite_element_body(settings(tmp_path)), None)
    surface = body.surface
    assert surface is not None
    assert body.rigid is not None
    normals, areas = surface.normals_and_areas()
    assert areas.sum() == pytest.approx(2 * (SIZE[0] * SIZE[1] + SIZE[1] * SIZE[2] + SIZE[2] * SIZE[0]), rel=1e-12)
    # The divergence theorem: outward normals give the volume.
    middle = surface.points[surface.triangles].mean(axis=1)
    assert (middle * normals).sum(axis=1) @ areas / 3.0 == pytest.approx(np.prod(SIZE), rel=1e-12)
    turned = surface.basis @ body.rigid[:, 5]
    np.testing.assert_allclose(turned, np.cross([0.0, 0.0, 1.0], surface.points), atol=1e-9)


@pytest.mark.parametrize("stiffness", [None, 1e16])
def test_two_halves_that_are_tied_or_held_stiffly_are_one_body(tmp_path: Path, stiffness: float | None) -> None:
    half = (SIZE[0], SIZE[1], SIZE[2] / 2.0)
    lower = write_inp(tmp_path / "lower.inp", block(half, (2, 1, 2), "tetra10"))
    upper = block(half, (3, 2, 2), "tetra10")
    upper.points[:, 2] += half[2]
    files = (("lower", lower), ("upper", write_inp(tmp_path / "upper.inp", upper)))
    one = CasingSettings("b", files, 1.0, STEEL, seats=(("one", "upper.high"), ("two", "lower.low")))
    halves = finite_element_body(replace(one, joins=(JoinSettings("lower.high", "upper.low", stiffness),)))
    finer = free_modes(finite_element_body(settings(tmp_path, counts=(3, 2, 4))), 3).frequency
    coarser = free_modes(finite_element_body(settings(tmp_path, counts=(2, 1, 4))), 3).frequency
    assert rigid_residual(halves)[0] < 1e-10
    body, factor, _ = reduce(halves, 30e3)
    joined = free_modes(halves, 3, factor).frequency
    # One half is meshed as the finer whole, one as the coarser; the tie itself is a little stiff.
    assert np.all(joined > 0.999 * finer)
    assert np.all(joined < 1.005 * coarser)
    np.testing.assert_allclose(body.modes()[0][6:9], joined, rtol=2e-3)
    assert body.modes()[0][5] < 1e-3 * joined[0]


def test_a_joint_of_given_stiffness_per_area_adds_its_flexibility(tmp_path: Path) -> None:
    per_area = 1e12
    half = (SIZE[0], SIZE[1], SIZE[2] / 2.0)
    lower = write_inp(tmp_path / "lower.inp", block(half, (1, 1, 1), "hexahedron20"))
    upper = block(half, (2, 1, 1), "hexahedron20")
    upper.points[:, 2] += half[2]
    one = CasingSettings(
        "b",
        (("lower", lower), ("upper", write_inp(tmp_path / "upper.inp", upper))),
        1.0,
        Elastic(206e9, 0.0, 7850.0),
        held=("lower.low",),
        seats=(("one", "upper.high"),),
        joins=(JoinSettings("lower.high", "upper.low", per_area),),
    )
    body, *_ = reduce(finite_element_body(one), 20e3)
    area = SIZE[0] * SIZE[1]
    expected = SIZE[2] / (206e9 * area) + 1.0 / (per_area * area)
    assert np.linalg.inv(body.stiffness[:6, :6])[2, 2] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("kind", ["tetra10", "hexahedron20"])
@pytest.mark.parametrize("clamped", [pytest.param(False, marks=pytest.mark.long), True])
def test_the_error_of_the_mesh_is_estimated_to_a_factor(
    tmp_path: Path, kind: str, clamped: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = (held_at_its_foot if clamped else settings)(tmp_path, counts=(2, 1, 3), kind=kind)
    modes_of = held_modes if clamped else free_modes
    bodies = [finite_element_body(replace(file, splits=n)) for n in (0, 2)]
    coarse, fine = (modes_of(body, 3) for body in bodies)
    left = eigenvalue_errors(bodies[1], fine.eigenvalues, fine.shapes)
    # Beside a clamped face every estimate by the next order alone has half of the error or less.
    true = coarse.eigenvalues - (fine.eigenvalues - left)
    ratio = eigenvalue_errors(bodies[0], coarse.eigenvalues, coarse.shapes) / true
    assert np.all(ratio > 0.6)
    assert np.all(ratio < 2.0)
    # A hundredth of the estimate is left at most when its steps end.
    monkeypatch.setattr(mesh_error, "_ENOUGH", 1e-9)
    exact = eigenvalue_errors(bodies[0], coarse.eigenvalues, coarse.shapes)
    np.testing.assert_allclose(ratio * true, exact, rtol=0.03)


def test_a_long_round_bar_has_the_modes_of_the_timoshenko_shaft(tmp_path: Path) -> None:
    diameter, length = 0.04, 0.4
    found = block((2.0, 2.0, length), (4, 4, 12), "hexahedron20")
    x, y = found.points[:, 0] - 1.0, found.points[:, 1] - 1.0
    # A square onto a disk: lines of the square become arcs of ellipses.
    found.points[:, 0] = 0.5 * diameter * x * np.sqrt(1.0 - 0.5 * y**2)
    found.points[:, 1] = 0.5 * diameter * y * np.sqrt(1.0 - 0.5 * x**2)
    path = write_inp(tmp_path / "bar.inp", found)
    bar = CasingSettings("b", (("mesh", path),), 1.0, STEEL, seats=(("one", "high"), ("two", "low")))
    body, *_ = reduce(finite_element_body(bar), 40e3)
    shaft = rg.Model(
        materials={"m": {"youngs_modulus": 206e9, "poisson_ratio": 0.3, "density": 7850.0}},
        shafts={"s": {"material": "m", "sections": [{"length": length, "outer_diameter": diameter}]}},
    )
    beam = rg.modal(shaft, modes=11, accuracy=1e-4).frequency_hz
    # Pairs of bending, and torsion and axial modes among them.
    np.testing.assert_allclose(body.modes()[0][6:11], beam[6:11], rtol=5e-3)


@pytest.mark.long
@pytest.mark.parametrize(("kind", "counts"), [("hexahedron20", (2, 3, 6)), ("tetra10", (3, 4, 6))])
def test_frequencies_of_a_smooth_block_converge_with_order_four(
    tmp_path: Path, kind: str, counts: tuple[int, ...]
) -> None:
    found = [
        free_modes(finite_element_body(settings(tmp_path, counts=(2 * n, n, 3 * n), kind=kind)), 1).frequency[0]
        for n in counts
    ]
    coarse, middle, fine = (float(n) for n in counts)
    ratio = (found[0] - found[1]) / (found[1] - found[2])

    def of_order(p: float) -> float:
        return (coarse**-p - middle**-p) / (middle**-p - fine**-p) - ratio

    assert brentq(of_order, 1.0, 9.0) > 3.5


def test_a_body_whose_rigid_motions_are_sprung_has_their_frequency_and_residual(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Forces of 200^2 times the mass: all six motions at 200 rad/s, where a free body has rounding."""
    fe = finite_element_body(settings(tmp_path, counts=(1, 1, 1)))
    assert rigid_residual(fe)[0] < 1e-12
    monkeypatch.setattr(type(fe), "stiffness_times", lambda self, U: 200.0**2 * self.matrices.times_mass(U))
    residual, frequency = rigid_residual(fe)
    assert frequency == pytest.approx(200.0 / (2.0 * np.pi), rel=1e-9)
    R = rigid_motions(fe.mesh.points, fe.mass_properties[1])
    forces = 200.0**2 * fe.matrices.times_mass(R)
    share = np.linalg.norm(forces, axis=0) / np.linalg.norm(R, axis=0)
    assert residual == pytest.approx(share.max() / abs(fe.matrices.stiffness.data).max(), rel=1e-12)
