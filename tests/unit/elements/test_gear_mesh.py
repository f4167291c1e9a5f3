"""The contact of a mesh as rigid kinematics: where its force acts, how its flanks slide, whichever gear drives."""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import scipy.linalg as la

import rotorgear as rg
from rotorgear.elements.gear_mesh import (
    ContactGeometry,
    Face,
    contact_vector,
    equivalent_mass_general,
    equivalent_mass_torsion,
    face_strains,
    flank_normal,
    gear_mesh,
    sliding_vectors,
    tilt_vector,
)
from rotorgear.elements.spring import rigid_transfer
from rotorgear.system.system import System
from tests.models import lumped_gear, lumped_pair, pair_points, random_contact, rigid_motions

Z = np.array([0.0, 0.0, 1.0])


def line_of_action(g: ContactGeometry) -> np.ndarray:
    """Unit vector in the transverse plane along the normal of the flanks, towards the gear."""
    n = flank_normal(g) * [1.0, 1.0, 0.0]
    return np.asarray(n / np.linalg.norm(n))


def contact_point(g: ContactGeometry) -> np.ndarray:
    """Where the flanks touch, from the pinion's axis in the plane of the contact: the pitch point and xi along the line."""
    share = g.pinion_base_radius / (g.pinion_base_radius + g.gear_base_radius)
    pitch_point = share * (pair_points(g)[1] - pair_points(g)[0]) * [1.0, 1.0, 0.0]
    return np.asarray(pitch_point + g.contact_position * line_of_action(g))


@pytest.mark.parametrize("seed", range(6))
def test_a_turn_of_one_gear_about_the_point_of_contact_does_not_press_the_flanks(seed: int) -> None:
    rng = np.random.default_rng(seed)
    g = random_contact(rng)
    v = contact_vector(g)
    P = contact_point(g)
    for part, node in zip((v[:6], v[6:]), pair_points(g), strict=True):
        turn = rng.normal(size=3)
        motion = np.concatenate([np.cross(turn, node - P), turn])
        assert abs(part @ motion) < 1e-15
    assert v[:3] == pytest.approx(flank_normal(g))
    assert v[6:9] == pytest.approx(-flank_normal(g))


@pytest.mark.parametrize("seed", range(6))
def test_flanks_slide_by_the_difference_of_both_gears_motions_where_they_touch(seed: int) -> None:
    rng = np.random.default_rng(seed)
    g = random_contact(rng)
    motion = rng.normal(size=12)
    P = contact_point(g)
    moved = [rigid_transfer(P - node)[:3] @ q for node, q in zip(pair_points(g), motion.reshape(2, 6), strict=True)]
    across = np.cross(Z, line_of_action(g))
    # Out of the plane the arm of xi tilts the flanks; that share is no sliding across the line of action.
    first, second = sliding_vectors(g)
    own = (first + g.contact_position * second) @ motion
    assert own == pytest.approx(across @ (moved[0] - moved[1]), abs=1e-12)


@pytest.mark.parametrize("seed", range(6))
def test_a_pair_that_moves_as_one_body_does_not_slide(seed: int) -> None:
    rng = np.random.default_rng(seed)
    g = random_contact(rng)
    together = np.vstack([rigid_transfer(node) for node in pair_points(g)])
    assert np.abs(sliding_vectors(g) @ together).max() < 1e-14


@pytest.mark.parametrize(
    ("driver", "speed", "side", "hand"),
    list(itertools.product(("one", "two"), (50.0, -50.0), (3e-3, -2e-3), ("right", "left"))),
)
def test_recess_lies_where_the_contact_goes_whichever_gear_drives(
    driver: str, speed: float, side: float, hand: str
) -> None:
    """The contact runs along the line of action as the force pushes the driven gear; positions count from the pitch point."""
    other = {"right": "left", "left": "right"}[hand]
    mesh: dict[str, Any] = {"contact_position": side, "centre_line_angle": 0.3, "pressure_angle": 0.4}
    operation = {
        "input_shaft": driver,
        "output_shaft": {"one": "two", "two": "one"}[driver],
        "torque": 100.0,
        "speed": speed,
    }
    model = lumped_pair(lumped_gear("one", 0.06, hand), lumped_gear("two", 0.15, other), mesh, operation=operation)
    system = System(model)
    strain = next(group.matrices.strain for group in system.groups if group.part == "meshes.pair")
    assert strain is not None
    v = strain[0, 0]
    e = np.array([np.cos(0.3), np.sin(0.3), 0.0])
    t = np.cross(Z, e)
    # The force on the driven gear: away from the driver, and with a moment in the sense in which the driven gear turns.
    away = e if driver == "one" else -e
    spin = -speed  # of the driven shaft
    arm = -away  # from its axis towards the other gear
    along = max((s * t for s in (1.0, -1.0)), key=lambda w: float(np.cross(arm, w)[2] * spin))
    runs = np.sin(0.4) * away + np.cos(0.4) * along
    P = 0.06 / np.cos(0.4) * e + side * runs
    for part, node in ((v[:6], np.zeros(3)), (v[6:], 0.21 / np.cos(0.4) * e)):
        assert part[3:] == pytest.approx(np.cross(P - node, part[:3]), abs=1e-14)
    push = v[:3] if driver == "one" else v[6:9]  # normal force over F of the driver on the driven gear
    assert push @ runs > 0.0


def test_the_given_damping_of_a_herringbone_mesh_is_that_of_both_helices() -> None:
    from tests.contract.test_conventions_of_the_mesh import herringbone_pair

    for nodes in (1, 2):
        model = herringbone_pair(nodes)
        data = {name: getattr(model, name) for name in ("materials", "shafts", "gears", "operation")}
        mesh = {"pinion": "pinion", "gear": "wheel", "stiffness": 6e8, "damping": 350.0}
        system = System(rg.Model(**data, meshes={"pair": mesh}))
        turn = np.zeros(6 * len(system.nodes))
        turn[[6 * node + 5 for node in system.nodes.on_shaft("one")]] = 1.0
        rate = np.linalg.lstsq(system.dofs.transform.toarray(), turn, rcond=None)[0]
        # 25 teeth of 3 mm at 20 deg and a helix of 0.5 rad: r_b = z m_t cos a_t / 2, sin b_b = sin b cos a_n.
        alpha = np.arctan(np.tan(np.radians(20.0)) / np.cos(0.5))
        base = 0.5 * 25 * 3e-3 / np.cos(0.5) * np.cos(alpha)
        slope = np.arcsin(np.sin(0.5) * np.cos(np.radians(20.0)))
        expected = 350.0 * (base * np.cos(slope)) ** 2
        assert rate @ (system.damping() @ rate) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_a_mesh_with_a_face_is_two_meshes_of_half_its_width(seed: int) -> None:
    rng = np.random.default_rng(seed)
    g = random_contact(rng)
    width = rng.uniform(0.02, 0.2)
    k = 3e8
    at = width / (2.0 * np.sqrt(3.0))
    halves = 0.0
    for z in (at, -at):
        v = contact_vector(replace(g, pinion_offset=g.pinion_offset + z, gear_offset=g.gear_offset + z))
        halves = halves + 0.5 * k * np.outer(v, v)
    K = gear_mesh(g, k, face=Face(0.0, k * width**2 / 12.0)).stiffness
    assert K is not None
    assert K[0] == pytest.approx(halves, rel=1e-12, abs=1e-12 * k)


@pytest.mark.parametrize("seed", range(6))
def test_rigid_motions_of_a_pair_neither_press_nor_tilt_its_flanks(seed: int) -> None:
    g = random_contact(np.random.default_rng(seed))
    strain = gear_mesh(g, 1e8, face=Face(0.01, 1e4)).strain
    assert strain is not None
    strains = strain[0] @ rigid_motions(pair_points(g))
    assert np.abs(strains).max() < 1e-12


def test_the_tilt_of_the_flanks_is_what_more_face_adds_to_their_approach() -> None:
    g = random_contact(np.random.default_rng(1))
    farther = replace(g, pinion_offset=g.pinion_offset + 0.02, gear_offset=g.gear_offset + 0.02)
    assert (contact_vector(farther) - contact_vector(g)) / 0.02 == pytest.approx(tilt_vector(g), abs=1e-14)


def test_a_mesh_without_tilt_stiffness_has_one_strain_and_damping_keeps_the_proportion() -> None:
    g = random_contact(np.random.default_rng(2))
    one = gear_mesh(g, 1e8, 500.0)
    both = gear_mesh(g, 1e8, 500.0, Face(0.0, 2e4))
    assert one.strain is not None
    assert one.strain.shape == (1, 1, 12)
    assert both.stiffness is not None
    assert both.damping == pytest.approx(500.0 / 1e8 * both.stiffness)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("integral", [(True, False), (False, True), (True, True)])
def test_gears_cut_on_their_shafts_are_free_of_strain_in_rigid_motions(seed: int, integral: tuple[bool, bool]) -> None:
    g = random_contact(np.random.default_rng(seed))
    points = pair_points(g)
    ends = [points[k] * [1.0, 1.0, 0.0] + [0.0, 0.0, z] for k in (0, 1) if integral[k] for z in (-0.02, 0.02)]
    strains = face_strains(g, Face(0.004, 1e4, 0.04, integral)) @ rigid_motions(np.array([*points, *ends]))
    assert np.abs(strains).max() < 1e-12


def test_a_rigid_shaft_under_its_teeth_tilts_them_as_its_node_does() -> None:
    rng = np.random.default_rng(5)
    g = random_contact(rng)
    motion = rng.normal(size=(2, 6))
    ends = [
        rigid_transfer(np.array([0.0, 0.0, offset + z])) @ q
        for offset, q in zip((g.pinion_offset, g.gear_offset), motion, strict=True)
        for z in (-0.02, 0.02)
    ]
    whole = np.concatenate([*motion, *ends])
    cut = face_strains(g, Face(0.004, 1e4, 0.04, (True, True))) @ whole
    assert cut == pytest.approx(face_strains(g, Face(0.004, 1e4)) @ whole[:12], rel=1e-12)


@pytest.mark.parametrize("seed", range(4))
def test_the_equivalent_mass_is_that_of_two_free_bodies_on_the_spring_of_the_mesh(seed: int) -> None:
    """k v v^T x = w^2 M x has one frequency, w^2 = k/m_e; of bodies that only turn it is that of torsion."""
    rng = np.random.default_rng(seed)
    g = random_contact(rng)
    first, second = rng.uniform(0.1, 3.0, (2, 6))
    v = contact_vector(g)
    M = np.diag(np.concatenate([first, second]))
    k = 3e8
    values = la.eigh(k * np.outer(v, v), M, eigvals_only=True)
    assert values[-1] == pytest.approx(k / equivalent_mass_general(g, first, second), rel=1e-9)
    assert np.abs(values[:-1]).max() < 1e-9 * values[-1]
    heavy = np.full(6, 1e30)
    turning = [np.append(heavy[:5], J) for J in (first[5], second[5])]
    along = np.cos(g.base_helix_angle) ** 2
    torsion = equivalent_mass_torsion(first[5], second[5], g.pinion_base_radius, g.gear_base_radius)
    assert torsion == pytest.approx(along * equivalent_mass_general(g, *turning), rel=1e-9)
    # r1 theta1 + r2 theta2 on one spring.
    r = np.array([g.pinion_base_radius, g.gear_base_radius])
    two = la.eigh(k * np.outer(r, r), np.diag([first[5], second[5]]), eigvals_only=True)
    assert two[-1] == pytest.approx(k / torsion, rel=1e-9)
    # A body without inertia where the mesh pushes gives way.
    assert equivalent_mass_general(g, np.where(v[:6] == v[5], 0.0, first), second) == 0.0
    assert equivalent_mass_torsion(0.0, 2.0, 0.1, 0.2) == 0.0
