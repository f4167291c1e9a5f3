"""Teeth of a ring as finite elements: against an own mesh of triangles, and in the limit where ring and gear are both racks."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.sparse import linalg as sla
from scipy.spatial import Delaunay, cKDTree

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.outline import tooth_outline
from rotorgear.gears.tooth_fe.compliance_model import compliance_key, gear_compliance, pitch_of, wind_up
from rotorgear.gears.tooth_fe.settings import ToothFe
from rotorgear.gears.tooth_fe.tooth_solution import ToothInside
from tests.unit.gears.tooth_pairs import COARSE

ALPHA = math.radians(20.0)
NU = 0.3
RING = GearGeometry(-71, 1.0, ALPHA, 0.0, -0.1, addendum_factor=0.85)
OUTER = -0.5 * RING.root_diameter + 4.7
Answer = Callable[[int, int], float]


def triangles(rolls: np.ndarray, teeth: int = 17, fine: float = 0.1) -> Callable[[int], Answer]:
    """Plane strain of some pitches by quadratic triangles between scattered points, held at the outer surface, sides free.

    Returns: for the number of a loaded roll length a function of (number of a roll length, tooth), the displacement there along
    the normal; tooth 1 is on the side of the loaded flank. E = 1, a unit force on a unit width.
    """
    skfem = pytest.importorskip("skfem")
    from skfem.models.elasticity import linear_elasticity

    outline = tooth_outline(RING)
    pitch = 2.0 * math.pi / 71
    # The contour around the ring, whose flanks have points where forces act; then points inside, rarer far from the loaded tooth.
    flank = [np.concatenate(pair) for pair in zip(outline.involute(rolls[::-1]), outline.fillet(LATER), strict=True)]
    tip = np.linspace(-flank[1][0], flank[1][0], 12)[1:-1]
    root = np.linspace(flank[1][-1], pitch - flank[1][-1], 4)[1:-1]
    radii = [flank[0][::-1], np.full(10, outline.tip_radius), flank[0], np.full(2, outline.root_radius)]
    radius = np.tile(np.concatenate(radii), teeth)
    turns = pitch * np.repeat(np.arange(teeth) - teeth // 2, len(radius) // teeth)
    angle = np.tile(np.concatenate([-flank[1][::-1], tip, flank[1], root]), teeth) + turns
    around = np.linspace(angle[0], angle[-1], 30 * teeth)
    points = [place(radius, angle), place(np.full(len(around), OUTER), around)]
    contour = cKDTree(points[0])
    middle = np.array([0.0, 0.5 - outline.root_radius])
    for level in range(5):
        h = fine * 2.0**level
        x, y = np.meshgrid(np.arange(-30.0, 30.0, h), np.arange(-OUTER, -20.0, 0.866 * h))
        grid = np.stack([(x + 0.5 * h * (np.arange(len(x))[:, None] % 2)).ravel(), y.ravel()], -1)
        away = np.hypot(*(grid - middle).T)
        grid = grid[(away < 2.2 * 2.0**level) & (away >= (1.1 * 2.0**level if level else 0.0))]
        solid = (np.hypot(*grid.T) < OUTER - 0.5 * h) & inside(grid, radius, angle)
        points.append(grid[solid][contour.query(grid[solid])[0] > 0.55 * h])
    p = np.concatenate(points)
    t = Delaunay(p).simplices
    t = t[inside(p[t].mean(axis=1), radius, angle)]
    sides = np.diff(p[t], axis=1)
    t = t[np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]) > 1e-7]
    used, number = np.unique(t, return_inverse=True)
    mesh = skfem.MeshTri(np.ascontiguousarray(p[used].T), np.ascontiguousarray(number.reshape(-1, 3).T))
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementTriP2()))
    K = linear_elasticity(NU / ((1.0 + NU) * (1.0 - 2.0 * NU)), 0.5 / (1.0 + NU)).assemble(basis)
    free = np.flatnonzero(np.hypot(*basis.doflocs) < OUTER * (1.0 - 2e-4))
    factor = sla.splu(K[free][:, free].tocsc(), permc_spec="MMD_AT_PLUS_A")
    corners = cKDTree(mesh.p.T)

    def at(roll: int, tooth: int) -> tuple[np.ndarray, np.ndarray]:
        """Unknowns of a flank point, and the normal there: along the tangent of the base circle."""
        r, a = outline.involute(rolls[roll])
        node = corners.query(place(r, a + tooth * pitch))[1]
        normal = outline.base_half_angle + rolls[roll] / RING.base_radius + tooth * pitch
        return basis.nodal_dofs[:, node], np.array([math.cos(normal), math.sin(normal)])

    def loaded(roll: int) -> Answer:
        force = np.zeros(K.shape[0])
        dofs, normal = at(roll, 0)
        force[dofs] = normal
        moved = np.zeros(K.shape[0])
        moved[free] = factor.solve(force[free])
        return lambda where, tooth: float(moved[at(where, tooth)[0]] @ at(where, tooth)[1])

    return loaded


LATER = np.linspace(0.0, 1.0, 24)[1:]


def place(radius: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Points by radius and angle from -y, positive towards +x."""
    return np.stack([radius * np.sin(angle), -radius * np.cos(angle)], -1)


def inside(points: np.ndarray, radius: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Whether points lie behind the contour, between the ends of the arc."""
    own = np.arctan2(points[:, 0], -points[:, 1])
    return (np.hypot(*points.T) > np.interp(own, angle, radius)) & (own > angle[0]) & (own < angle[-1])


def test_a_ring_on_a_stiff_seat_gives_as_an_own_mesh_of_triangles_says() -> None:
    """Forces at one flank point, displacements at others and on both neighbours; the sides of the own arc are far away."""
    key = compliance_key(RING, ToothFe(preset="fine"), NU, 10.0, OUTER, space=False)
    found = gear_compliance(key)
    assert found.asymmetry < 1e-12
    last = len(found.roll) - 1
    own = triangles(found.roll)
    for force, places in ((2, ((16, 0), (last, 0), (16, 1), (16, -1))), (16, ((0, 0), (last, 0), (16, 1), (last, -1)))):
        answer = own(force)
        for where, tooth in places:
            assert found.response(tooth)[where, force] == pytest.approx(answer(where, tooth), rel=1e-2)


def test_a_ring_and_a_gear_of_very_many_teeth_are_one_rack() -> None:
    size = {"preset": "preview"}
    cut = {"addendum_factor": 1.0, "profile_shift": 0.2}
    z = 20_000
    external = GearGeometry(z, 1.0, ALPHA, 0.0, **cut)  # type: ignore[arg-type]
    internal = GearGeometry(-z, 1.0, ALPHA, 0.0, cutter_teeth=z // 2, **cut)  # type: ignore[arg-type]
    one, other = (
        gear_compliance(compliance_key(g, ToothFe(**size), NU, 10.0, 0.0, space=False))  # type: ignore[arg-type]
        for g in (external, internal)
    )
    assert one.roll[-1] - one.roll[0] == pytest.approx(other.roll[-1] - other.roll[0], rel=2e-3)
    assert np.abs(one.flexibility - other.flexibility).max() < 2e-3 * np.abs(one.flexibility).max()
    # With a helix in space the teeth lean to the other side if a sign is wrong: tooth and neighbours would answer otherwise.
    leaning = [
        gear_compliance(
            compliance_key(
                GearGeometry(s * z, 1.0, ALPHA, 0.35, cutter_teeth=z // 2 if s < 0 else None, **cut),  # type: ignore[arg-type]
                ToothFe(size=COARSE, arc=3),
                NU,
                6.0,
                0.0,
                space=True,
            )
        ).flexibility
        for s in (1, -1)
    ]
    assert np.abs(leaning[0] - leaning[1]).max() < 1e-2 * np.abs(leaning[0]).max()
    mirrored = leaning[1].reshape(3, 9, 11, 9, 11)[:, ::-1, :, ::-1].reshape(leaning[1].shape)
    assert np.abs(leaning[0] - mirrored).max() > 5e-2 * np.abs(leaning[0]).max()


def test_the_rim_of_a_ring_lies_around_its_teeth() -> None:
    for body, held in (("rim", -0.5 * RING.root_diameter + 3.0), ("ring", OUTER), (None, OUTER)):
        key = compliance_key(RING, ToothFe(body=body), NU, 10.0, OUTER, space=False)  # type: ignore[arg-type]
        mesh = pitch_of(key)[1]
        assert np.hypot(*mesh.points[mesh.inner].T) == pytest.approx(held)
        assert np.hypot(*mesh.points.T).min() == pytest.approx(-0.5 * RING.effective_tip_diameter)
        assert key.arc == (7 if body == "rim" else 0)
    # A thin cylinder in shear turns by T (1/r_f^2 - 1/r_o^2)/(4 pi b G).
    expected = RING.base_radius**2 * (4.0 / RING.root_diameter**2 - 1.0 / OUTER**2) * (1.0 + NU) / (2.0 * math.pi)
    assert wind_up(key) == pytest.approx(expected)
    with pytest.raises(AnalysisError, match=r"give body\.rim_thickness"):
        compliance_key(RING, ToothFe(body="ring"), NU, 10.0, 0.0, space=False)
    with pytest.raises(AnalysisError, match="above the root radius"):
        pitch_of(compliance_key(RING, ToothFe(), NU, 10.0, 30.0, space=False))


def test_roots_of_a_ring_and_of_a_gear_of_very_many_teeth_are_stressed_alike() -> None:
    found = []
    for g in (
        GearGeometry(20_000, 1.0, ALPHA, 0.0, 0.2),
        GearGeometry(-20_000, 1.0, ALPHA, 0.0, 0.2, cutter_teeth=10_000),
    ):
        inside_tooth = ToothInside(compliance_key(g, ToothFe(preset="preview"), NU, 10.0, 0.0, space=False))
        pitch = inside_tooth.pitch
        force = np.zeros(len(pitch.flank))
        force[-3] = -1.0
        teeth, moved = inside_tooth.solve({0: force})
        stress = np.array([pitch.stress(moved[list(teeth).index(tooth)]) for tooth in (0, 1, -1)])
        found.append(stress[..., pitch.fillet].max(axis=-1))
    assert found[0] == pytest.approx(found[1], rel=2e-3)
    assert found[0][0, 1] > 2.0 * found[0][1, 1]
