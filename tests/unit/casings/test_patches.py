"""Patches and joins by geometry: mean motions, areas, nearest points, and the energy of a joint under rigid motions."""

from __future__ import annotations

import numpy as np
import pytest

from rotorgear.casings.file_mesh import FileMesh
from rotorgear.casings.joins import join
from rotorgear.casings.patches import Cylinder, Patch, by_cylinder, by_set
from rotorgear.casings.reduced_body import rigid_motions
from rotorgear.casings.settings import JoinSettings
from rotorgear.casings.solid_mesh import SolidMesh, merged, solid_mesh
from rotorgear.errors import AnalysisError
from tests.unit.casings.blocks import block

SIZE = (0.1, 0.06, 0.2)
KINDS = ("tetra10", "hexahedron20")


def placed(mesh: FileMesh, turn: np.ndarray, move: tuple[float, float, float]) -> SolidMesh:
    mesh.points[:] = mesh.points @ turn.T + np.array(move)
    return solid_mesh(mesh, 1.0, "casings.b.mesh")


def turned() -> np.ndarray:
    """A rotation about no axis of the block."""
    Q, R = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))
    Q = Q * np.sign(np.diag(R))
    return Q * np.sign(np.linalg.det(Q))


@pytest.mark.parametrize("kind", KINDS)
def test_the_mean_motion_of_a_face_is_that_of_its_integrals(kind: str) -> None:
    """u = s (1 + x/a - 2 y^2/b^2) along the normal and tangent of a face a x b, anywhere in space: its means by hand."""
    Q = turned()
    mesh = placed(block(SIZE, (2, 1, 1), kind), Q, (0.3, -0.2, 0.5))
    patch = by_set(mesh, "high", "casings.b.seats.one")
    a, b, c = SIZE
    middle = Q @ np.array([0.5 * a, 0.5 * b, c]) + np.array([0.3, -0.2, 0.5])
    assert patch.area == pytest.approx(a * b, rel=1e-12)
    assert patch.point == pytest.approx(middle, abs=1e-12)
    W = patch.weights(mesh.points)
    assert W.T @ rigid_motions(mesh.points[patch.nodes], patch.point) == pytest.approx(np.eye(6), abs=1e-12)
    x, y, _ = ((mesh.points[patch.nodes] - middle) @ Q).T
    size = 1.0 + x / a - 2.0 * y**2 / b**2
    for direction, turning in (
        # Along the normal: 1/a about -y; along x: none about z but that of a mean that is odd in y.
        (np.array([0.0, 0.0, 1.0]), np.array([0.0, -1.0 / a, 0.0])),
        # Along y: u_y = x/a is a shear and a turn; the turn about z that is nearest to it: a^2/(a^2 + b^2)/a.
        (np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, a / (a**2 + b**2)])),
    ):
        q = W.T @ (size[:, None] * (Q @ direction)).ravel()
        assert q[:3] == pytest.approx((1.0 - 2.0 / 12.0) * (Q @ direction), abs=1e-12)
        assert q[3:] == pytest.approx(Q @ turning, abs=1e-10)


def test_nodes_that_make_no_face_count_the_same_and_three_on_a_line_do_not_turn() -> None:
    points = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
    nodes = np.array([0, 1, 2])
    patch = Patch("spider", nodes, np.eye(3), points[nodes].mean(axis=0), 0.0)
    W = patch.weights(points)
    assert W.T @ rigid_motions(points[nodes], patch.point) == pytest.approx(np.eye(6), abs=1e-12)
    assert (W.T @ np.array([[3.0, 0.0, 0.0], [0.0, 6.0, 0.0], [0.0, 0.0, 9.0]]).ravel())[:3] == pytest.approx([1, 2, 3])
    line = Patch("line", np.array([0, 3, 1]), np.eye(3), points[3], 0.0)
    with pytest.raises(AnalysisError, match="3 nodes lie on a line"):
        line.weights(points)


@pytest.mark.parametrize("kind", KINDS)
def test_a_bore_that_reaches_over_a_part_of_its_hole_has_its_own_middle_and_area(kind: str) -> None:
    """A block bent to a pipe of 30 and 50 mm: a seat from 25 to 75 mm of its 100 mm of length."""
    found = block((1.0, 1.0, 0.1), (2, 24, 4), kind)
    radius = 0.03 + 0.02 * found.points[:, 0]
    angle = 2.0 * np.pi * found.points[:, 1]
    found.points[:, 0] = radius * np.cos(angle)
    found.points[:, 1] = radius * np.sin(angle)
    Q = turned()
    mesh = placed(merged_seam(found), Q, (0.1, 0.2, -0.3))
    centre = np.array([0.1, 0.2, -0.3]) + 0.01 * Q[:, 2]
    bore = Cylinder(tuple(centre), tuple(Q[:, 2]), 0.015, 0.065, 0.03)
    patch = by_cylinder(mesh, bore, "casings.b.seats.one")
    assert patch.point == pytest.approx(np.array([0.1, 0.2, -0.3]) + 0.05 * Q[:, 2], abs=1e-12)
    assert patch.area == pytest.approx(2.0 * np.pi * 0.03 * 0.05, rel=2e-3)
    along = (mesh.points[patch.nodes] - patch.point) @ Q[:, 2]
    assert (along.min(), along.max()) == pytest.approx((-0.025, 0.025))
    with pytest.raises(AnalysisError, match=r"radius 31 mm.*30 mm or more from its axis"):
        by_cylinder(mesh, Cylinder(tuple(centre), tuple(Q[:, 2]), 0.015, 0.065, 0.031), "casings.b.seats.one")


def merged_seam(mesh: FileMesh) -> FileMesh:
    """The mesh with its double nodes made one, and without sets."""
    _, first, number = np.unique(np.round(mesh.points, 9) + 0.0, axis=0, return_index=True, return_inverse=True)
    cells = {kind: number.reshape(-1)[one] for kind, one in mesh.cells.items()}
    return FileMesh(mesh.points[first], cells, {})


def halves(kind: str, gap: float = 0.0, overhang: float = 0.0) -> SolidMesh:
    """A block of 2 x 1 elements under one of 3 x 2, which stands `gap` above it and is moved along x by `overhang`."""
    upper = block(SIZE, (3, 2, 1), kind)
    upper.points += np.array([overhang, 0.0, SIZE[2] + gap])
    both = {"lower": block(SIZE, (2, 1, 1), kind), "upper": upper}
    return merged({name: solid_mesh(one, 1.0, "casings.b.mesh") for name, one in both.items()}, "casings.b.mesh")


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("order", [("lower.high", "upper.low"), ("upper.low", "lower.high")])
def test_the_energy_of_a_joint_is_that_of_its_relative_motion(kind: str, order: tuple[str, str]) -> None:
    """k/2 times the integral of |u|^2 over the common face: A for a displacement, and second moments for a rotation."""
    k = 3e11
    mesh = halves(kind)
    joined = join(mesh, (JoinSettings(*order, k),), "casings.b")
    K = joined.stiffness
    assert K is not None
    assert joined.interpolation is None
    a, b, c = SIZE
    upper = np.zeros(len(mesh.points), dtype=bool)
    upper[np.unique(mesh.cells[2 * (6 if kind == "tetra10" else 1) :])] = True
    middle = np.array([0.5 * a, 0.5 * b, c])
    R = rigid_motions(mesh.points, middle).reshape(-1, 3, 6) * upper[:, None, None]
    energy = np.einsum("pia,pib->ab", R, np.stack([K @ R[:, i] for i in range(3)], axis=1))
    A = a * b
    expected = k * A * np.array([1.0, 1.0, 1.0, b**2 / 12.0, a**2 / 12.0, (a**2 + b**2) / 12.0])
    assert np.diag(energy) == pytest.approx(expected, rel=1e-9)
    assert energy - np.diag(np.diag(energy)) == pytest.approx(np.zeros((6, 6)), abs=1e-9 * k * A)


@pytest.mark.parametrize("kind", KINDS)
def test_tied_nodes_move_as_the_linear_field_of_the_other_face(kind: str) -> None:
    mesh = halves(kind, gap=1e-4)
    joined = join(mesh, (JoinSettings("upper.low", "lower.high", None),), "casings.b")
    T = joined.interpolation
    assert T is not None
    # The nodes of the finer face are moved onto the other one, and follow any quadratic motion of it.
    at = joined.mesh.points[joined.tied]
    assert at[:, 2] == pytest.approx(np.full(len(at), SIZE[2]), abs=1e-12)
    assert np.linalg.norm(at - mesh.points[joined.tied], axis=1) == pytest.approx(np.full(len(at), 1e-4), rel=1e-9)
    x, y = joined.mesh.points[:, 0] / SIZE[0], joined.mesh.points[:, 1] / SIZE[1]
    for field in (np.ones(len(x)), x, y, x * y, x**2 - 2.0 * y**2):
        moved = T @ np.where(np.isin(np.arange(len(x)), joined.tied), 0.0, field)
        assert moved[joined.tied] == pytest.approx(field[joined.tied], abs=1e-12)


def test_nodes_beyond_the_other_face_stay_free_and_faces_apart_are_no_joint() -> None:
    joined = join(halves("hexahedron20", overhang=0.04), (JoinSettings("upper.low", "lower.high", None),), "casings.b")
    assert joined.mesh.points[joined.tied][:, 0].max() <= SIZE[0] + 1e-9
    assert "stay free" in joined.mesh.notes[-1]
    # A tenth of the size of the elements, the root of the mean area of 33 x 30 mm.
    near = 0.1 * np.sqrt(SIZE[0] * SIZE[1] / 6.0)
    assert len(join(halves("tetra10", gap=0.5 * near), (JoinSettings("upper.low", "lower.high", None),), "b").tied)
    with pytest.raises(AnalysisError, match=r"do not touch: they are 6\.\d+ mm apart"):
        join(halves("hexahedron20", gap=2.1 * near), (JoinSettings("upper.low", "lower.high", None),), "casings.b")
