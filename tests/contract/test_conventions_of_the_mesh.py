"""C13 to C19 of docs/conventions.md: the mesh of a parallel-axis pair, single helical and herringbone."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pytest
import scipy.linalg as la
import scipy.optimize as optimize
from scipy.spatial.transform import Rotation

import rotorgear as rg
from rotorgear.elements.gear_mesh import ContactGeometry, contact_vector, flank_normal, gear_mesh
from rotorgear.system.system import System
from tests.models import (
    STEEL,
    bearing,
    clamp,
    lumped_gear,
    lumped_pair,
    pair_points,
    random_contact,
    rigid_motions,
)

TURN = np.array([[0.0, -1.0], [1.0, 0.0]])
SIGNS = list(product((1, -1), (1, 0, -1)))


def contact(hand: int = 1, sense: int = 1, psi: float = 0.0) -> ContactGeometry:
    """A contact with base radii of 60 and 150 mm."""
    return ContactGeometry(psi, 0.38, 0.42 * abs(hand), hand, sense, 0.06, 0.15)


def vectors(system: System) -> list[np.ndarray]:
    """The contact vectors (12,) of all meshes of a system."""
    strains = [group.matrices.strain for group in system.groups if group.part.startswith("meshes.")]
    return [strain[0, 0] for strain in strains if strain is not None]


# --- C13: the normal ----------------------------------------------------------------------------------------------------------


def involute_flank(g: ContactGeometry, roll: float, z: float) -> np.ndarray:
    """A point of the pinion's driving flank, an involute helicoid; a right-hand one turns positively with +z."""
    # thinner towards the tip
    x = np.cos(roll) + roll * np.sin(roll)
    y = -(np.sin(roll) - roll * np.cos(roll))
    across = g.pinion_base_radius * np.array([x, g.torque_sense * y])
    turn = g.hand * np.tan(g.base_helix_angle) * z / g.pinion_base_radius
    return np.array([*(np.cos(turn) * across + np.sin(turn) * TURN @ across), z])


@pytest.mark.parametrize(("sense", "hand"), SIGNS)
def test_c13_the_normal_is_that_of_the_involute_helicoid_at_the_pitch_point(sense: int, hand: int) -> None:
    g = contact(hand, sense)
    pitch = g.pinion_base_radius / np.cos(g.pressure_angle)
    roll = optimize.brentq(lambda u: np.hypot(*involute_flank(g, u, 0.0)[:2]) - pitch, 1e-3, 3.0, xtol=1e-15)
    h = 1e-5
    along_u = involute_flank(g, roll + h, 0.0) - involute_flank(g, roll - h, 0.0)
    along_z = involute_flank(g, roll, h) - involute_flank(g, roll, -h)
    normal = np.cross(along_u, along_z)
    point = involute_flank(g, roll, 0.0)
    back = -np.arctan2(point[1], point[0])  # turn the tooth to the pitch point on the line of centres
    normal[:2] = np.cos(back) * normal[:2] + np.sin(back) * TURN @ normal[:2]
    normal *= sense * np.sign(normal[1]) / la.norm(normal)  # out of the material, where the pinion pushes
    np.testing.assert_allclose(flank_normal(g), normal, atol=1e-8)


@pytest.mark.parametrize(("sense", "hand"), SIGNS)
def test_c13_the_normal_is_the_force_on_the_gear_and_pressing_the_teeth_is_positive(sense: int, hand: int) -> None:
    g = contact(hand, sense)
    n = flank_normal(g)
    v = contact_vector(g)
    assert la.norm(n) == pytest.approx(1.0, rel=1e-15)
    assert n[0] > 0.0  # the flanks push the axes apart
    assert n[1] * sense > 0.0  # a pinion that drives positively pushes a gear on its right upwards
    np.testing.assert_allclose(v[:3], n, rtol=1e-15)
    pressed = np.zeros(12)
    pressed[5] = 1e-6 * sense  # the pinion turns into the gear
    assert v @ pressed > 0.0
    K = gear_mesh(g, 1e8).stiffness
    assert K is not None
    force = -K[0] @ pressed  # on the bodies
    np.testing.assert_allclose(force[6:9], 1e8 * (v @ pressed) * n, rtol=1e-12)
    assert force[5] * sense < 0.0  # it resists the pinion
    assert force[11] * sense < 0.0  # and drives the gear the other way


def test_c13_torques_of_the_contact_are_force_times_base_radius() -> None:
    for sense, hand in SIGNS:
        g = contact(hand, sense, psi=0.7)
        v = contact_vector(g)
        lever = np.cos(g.base_helix_angle) * sense
        assert v[5] == pytest.approx(0.06 * lever, rel=1e-14)
        assert v[11] == pytest.approx(0.15 * lever, rel=1e-14)


# --- C14: rigid motions ---------------------------------------------------------------------------------------------------------


def test_c14_all_rigid_motions_of_any_pair_and_its_gear_ratio_rotation_are_free_of_strain() -> None:
    rng = np.random.default_rng(14)
    for _ in range(300):
        g = random_contact(rng)
        v = contact_vector(g)
        rolling = np.zeros(12)
        rolling[[5, 11]] = g.gear_base_radius, -g.pinion_base_radius
        motions = np.column_stack([rigid_motions(pair_points(g)), rolling])
        assert np.abs(v @ motions).max() < 1e-12 * (np.abs(v) @ np.abs(motions)).max()


def test_c14_the_stiffness_is_symmetric_of_rank_one_and_positive_semidefinite() -> None:
    rng = np.random.default_rng(15)
    for _ in range(30):
        K = gear_mesh(random_contact(rng), 3e8).stiffness
        assert K is not None
        np.testing.assert_array_equal(K[0], K[0].T)
        values = la.eigvalsh(K[0])
        assert values[-1] > 1e8
        assert np.abs(values[:-1]).max() < 1e-14 * values[-1]


def test_c14_a_whole_train_without_supports_moves_rigidly_without_strain() -> None:
    model = rg.Model(
        materials=STEEL,
        shafts={
            "one": {"position": [0.02, -0.01], "start": -0.1, "sections": [{"length": 0.2, "outer_diameter": 0.03}]},
            "two": {"position": [0.1, 0.07], "start": -0.15, "sections": [{"length": 0.3, "outer_diameter": 0.05}]},
        },
        gears={
            "pinion": lumped_gear("one", 0.028, "left", at=0.01, width=0.03),
            "wheel": lumped_gear("two", 0.075, "right", at=0.0, width=0.04),
        },
        meshes={"pair": {"pinion": "pinion", "gear": "wheel", "stiffness": 5e8}},
    )
    system = System(model, 2)
    K = system.stiffness().toarray()
    R = rigid_motions(system.positions())
    assert np.abs(K @ R).max() < 1e-12 * np.abs(K).max() * np.abs(R).max()
    assert (
        rg.modal(model, modes=12, elements=2).rigid.sum() == 11
    )  # 6 of each shaft, less the one that the mesh strains


# --- C15, C16: axial forces -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("hand", "speed", "sign"), [("right", 1, 1), ("right", -1, -1), ("left", 1, -1), ("left", -1, 1)]
)
def test_c15_a_right_hand_pinion_that_drives_counter_clockwise_is_pushed_to_plus_z(
    hand: str, speed: int, sign: int
) -> None:
    other = {"right": "left", "left": "right"}[hand]
    operation = {"input_shaft": "one", "output_shaft": "two", "torque": 100.0, "speed": 100.0 * speed}
    model = lumped_pair(lumped_gear("one", 0.06, hand), lumped_gear("two", 0.15, other), {}, operation=operation)
    system = System(model)
    (v,), (force,) = vectors(system), system.state.forces
    on_bodies = -force.normal_force * v
    assert on_bodies[2] == pytest.approx(sign * force.normal_force * np.sin(0.4), rel=1e-12)
    assert on_bodies[8] == pytest.approx(-on_bodies[2], rel=1e-12)
    assert on_bodies[5] == pytest.approx(-100.0 * speed, rel=1e-12)  # balances the input torque
    assert np.tan(0.4) * 100.0 / 0.06 == pytest.approx(abs(on_bodies[2]), rel=1e-12)


def herringbone(shaft: str, teeth: int, hand: str, nodes: int, at: float) -> dict[str, Any]:
    return {
        "shaft": shaft,
        "at": at,
        "kind": "herringbone",
        "teeth": teeth,
        "normal_module": 0.003,
        "helix_angle": 0.5,
        "hand": hand,
        "width": 0.04,
        "gap": 0.02,
        "nodes": nodes,
    }


def herringbone_pair(nodes: int, hand: str = "right", rigid: bool = True, **shaft: Any) -> rg.Model:
    """Two herringbone gears; their shafts are rigid between the helices, or all along."""
    distance = 0.003 / np.cos(0.5) * (25 + 60) / 2
    between = {"length": 0.06, "outer_diameter": 0.05, "rigid": rigid}
    ends = {"length": 0.08, "outer_diameter": 0.04}
    sections = [ends, between, ends]
    return rg.Model(
        materials=STEEL,
        shafts={
            "one": {"position": [0.0, 0.0], "start": -0.11, "sections": sections, **shaft},
            "two": {"position": [distance * 0.6, distance * 0.8], "start": -0.11, "sections": sections, **shaft},
        },
        gears={
            "pinion": herringbone("one", 25, hand, nodes, 0.0) | {"body": {"bore": 0.04}},
            "wheel": herringbone("two", 60, {"right": "left", "left": "right"}[hand], nodes, 0.0)
            | {"body": {"bore": 0.04}},
        },
        meshes={"pair": {"pinion": "pinion", "gear": "wheel", "stiffness": 6e8}},
        bearings={
            f"{shaft}_{end}": bearing(shaft, end, radial=2e8, axial=1e7)
            for shaft in ("one", "two")
            for end in ("start", "end")
        },
        operation={"input_shaft": "one", "output_shaft": "two", "torque": 300.0, "speed": 200.0},
    )


@pytest.mark.parametrize("nodes", [1, 2])
def test_c16_a_symmetric_herringbone_has_no_net_axial_force(nodes: int) -> None:
    system = System(herringbone_pair(nodes))
    forces = [-force.normal_force * v for force, v in zip(system.state.forces, vectors(system), strict=True)]
    total = np.sum(forces, axis=0)
    assert abs(forces[0][2]) > 100.0
    assert abs(total[2]) < 1e-12 * abs(forces[0][2])
    assert abs(total[8]) < 1e-12 * abs(forces[0][2])
    assert total[5] == pytest.approx(-300.0, rel=1e-12)


def test_c16_the_hand_of_a_herringbone_is_that_of_the_helix_at_the_smaller_z() -> None:
    for hand, first in (("right", 1), ("left", -1)):
        low, high = herringbone_pair(2, hand).layout.mesh("pair").contacts
        assert low.contact_z < high.contact_z
        assert (low.hand, high.hand) == (first, -first)
        system = System(herringbone_pair(2, hand))
        pushed = -vectors(system)[0][2]
        assert np.sign(pushed) == first  # it drives counter-clockwise: the right-hand helix pushes to +z


@pytest.mark.parametrize("speed", [None, 3000.0])
def test_c16_two_nodes_of_a_herringbone_tied_rigidly_are_one_lumped_node(speed: float | None) -> None:
    frequencies = [
        rg.modal(herringbone_pair(nodes), speed=speed, modes=24, elements=2, error_estimate=False).frequency_hz
        for nodes in (1, 2)
    ]
    np.testing.assert_allclose(frequencies[1][1:], frequencies[0][1:], rtol=1e-9)
    flexible = rg.modal(herringbone_pair(2, rigid=False), modes=24, elements=2, error_estimate=False).frequency_hz
    assert np.abs(flexible[1:] / frequencies[0][1:] - 1.0).max() > 1e-3  # the tie is what makes them equal


# --- C17: the datum of the stiffness ------------------------------------------------------------------------------------------


def twist_of_the_pinion(model: rg.Model, torque: float) -> float:
    """Static twist in rad of the pinion's shaft under a torque, the wheel held."""
    system = System(model)
    node = system.nodes.on_shaft("one")[0]
    load = np.zeros(6 * len(system.nodes))
    load[6 * node + 5] = torque
    q = system.dofs.expand(la.solve(system.stiffness().toarray(), system.dofs.transform.T @ load))
    return float(q[6 * node + 5])


@pytest.mark.parametrize("hand", [None, "right"])
def test_c17_a_stiffness_acts_along_the_flank_normal_and_the_transverse_one_is_smaller_by_cos_squared(
    hand: str | None,
) -> None:
    other = None if hand is None else "left"
    held = {"one": clamp("x", "y", "z", "tilt_x", "tilt_y", shaft="one"), "two": clamp(shaft="two")}
    model = lumped_pair(lumped_gear("one", 0.06, hand), lumped_gear("two", 0.15, other), {}, supports=held)
    transverse_force = 50.0 / 0.06
    transverse_give = 0.06 * twist_of_the_pinion(model, 50.0)
    base_helix = 0.0 if hand is None else 0.4
    normal = transverse_force / transverse_give / np.cos(base_helix) ** 2
    assert normal == pytest.approx(1e8, rel=1e-12)


def test_c17_the_stiffness_of_a_herringbone_is_that_of_both_helices_together() -> None:
    model = herringbone_pair(1)
    held = {
        "one": clamp("x", "y", "z", "tilt_x", "tilt_y", shaft="one", at=0.0),
        "two": clamp(shaft="two", at=0.0),
    }
    data = {name: getattr(model, name) for name in ("materials", "shafts", "gears", "meshes")}
    rigid = {
        name: shaft.model_copy(update={"sections": tuple(s.model_copy(update={"rigid": True}) for s in shaft.sections)})
        for name, shaft in model.shafts.items()
    }
    line = model.layout.mesh("pair").contacts[0]
    twist = twist_of_the_pinion(rg.Model(**{**data, "shafts": rigid}, supports=held), 80.0)
    expected = 80.0 / (6e8 * (line.pinion_base_radius * np.cos(line.base_helix_angle)) ** 2)
    assert twist == pytest.approx(expected, rel=1e-9)


# --- C18, C19 -------------------------------------------------------------------------------------------------------------------


def toothed_pair(distance: float, shift: float, **mesh: Any) -> rg.Model:
    """Spur gears of module 4 mm with 20 and 40 teeth."""
    gear = {"kind": "spur", "normal_module": 0.004, "width": 0.03, "at": "start", "body": {"bore": 0.02}}
    return rg.Model(
        shafts={"one": {}, "two": {"position": [0.0, -distance]}} | {"one": {"position": [0.0, 0.0]}},
        gears={
            "pinion": {"shaft": "one", "teeth": 20, "profile_shift": shift, **gear},
            "wheel": {"shaft": "two", "teeth": 40, **gear},
        },
        meshes={"pair": {"pinion": "pinion", "gear": "wheel", "stiffness": 2e8, **mesh}},
    )


def test_c18_the_working_pressure_angle_follows_from_the_distance_of_the_axes() -> None:
    bases = 0.5 * 0.004 * 60 * np.cos(np.radians(20.0))
    (at_reference,) = toothed_pair(0.12, 0.0).layout.mesh("pair").contacts
    assert at_reference.pressure_angle == pytest.approx(np.radians(20.0), rel=1e-12)
    assert at_reference.psi == pytest.approx(-np.pi / 2, rel=1e-15)
    (shifted,) = toothed_pair(0.1219, 0.5).layout.mesh("pair").contacts
    assert shifted.pressure_angle == pytest.approx(np.arccos(bases / 0.1219), rel=1e-12)
    assert shifted.pressure_angle > np.radians(21.0)


def test_c19_mesh_damping_is_2_zeta_sqrt_k_m_with_the_torsional_equivalent_mass() -> None:
    first = lumped_gear("one", 0.06, "right", mass=8.0, polar_inertia=0.02, diametral_inertia=0.03)
    second = lumped_gear("two", 0.15, "left", mass=40.0, polar_inertia=0.5, diametral_inertia=0.4)
    system = System(lumped_pair(first, second, {"damping_ratio": 0.07}))
    m_e = 0.02 * 0.5 / (0.02 * 0.15**2 + 0.5 * 0.06**2)
    (v,) = vectors(system)
    c = 2 * 0.07 * np.sqrt(1e8 * m_e)
    np.testing.assert_allclose(system.damping().toarray(), c * np.outer(v, v), rtol=1e-12, atol=1e-12 * c)
    inverse = 1.0 / np.array([8.0, 8.0, 8.0, 0.03, 0.03, 0.02, 40.0, 40.0, 40.0, 0.4, 0.4, 0.5])
    general = System(lumped_pair(first, second, {"damping_ratio": 0.07, "equivalent_mass": "general"}))
    c = 2 * 0.07 * np.sqrt(1e8 / (v**2 @ inverse))
    np.testing.assert_allclose(general.damping().toarray(), c * np.outer(v, v), rtol=1e-12, atol=1e-12 * c)
    given = System(lumped_pair(first, second, {"damping": 350.0}))
    np.testing.assert_allclose(given.damping().toarray(), 350.0 * np.outer(v, v), rtol=1e-12, atol=1e-9)


def test_c19_a_spur_pair_in_torsion_has_the_damping_ratio_that_was_asked_for() -> None:
    model = lumped_pair(lumped_gear("one", 0.06), lumped_gear("two", 0.15), {"damping_ratio": 0.07})
    result = rg.modal(replace_motions(model), speed=0.0, modes=2)
    assert result.rigid.tolist() == [True, False]
    assert result.damping_ratio[1] == pytest.approx(0.07, rel=1e-10)


def replace_motions(model: rg.Model) -> rg.Model:
    """The model with torsion only."""
    return rg.Model(motions=["torsion"], shafts=model.shafts, gears=model.gears, meshes=model.meshes)


@pytest.mark.parametrize(("sense", "hand"), SIGNS)
def test_c33_a_contact_of_shafts_in_space_is_one_point_and_one_normal(sense: int, hand: int) -> None:
    """P and n by hand in space, each shaft with a frame of its own; a spin of x of the gear's shaft about its axis beside it."""
    plain = contact(hand, sense)
    R1 = Rotation.from_rotvec([0.4, 1.3, -0.8]).as_matrix()
    R2 = R1 @ Rotation.from_rotvec([0.0, 0.0, 0.9]).as_matrix()
    O1 = np.array([0.3, -0.2, 0.5])
    r1, r2 = (r / np.cos(plain.pressure_angle) for r in (plain.pinion_base_radius, plain.gear_base_radius))
    e, t = (np.array([np.cos(psi), np.sin(psi), 0.0]) for psi in (plain.psi, plain.psi + 0.5 * np.pi))
    n_t = sense * np.cos(plain.pressure_angle) * t + np.sin(plain.pressure_angle) * e
    P = O1 + R1 @ (r1 * e + plain.contact_position * n_t + np.array([0.0, 0.0, plain.pinion_offset]))
    O2 = O1 + R1 @ ((r1 + r2) * e + np.array([0.0, 0.0, plain.pinion_offset - plain.gear_offset]))
    n = R1 @ flank_normal(plain)
    by_hand = np.concatenate([R1.T @ n, R1.T @ np.cross(P - O1, n), -R2.T @ n, -R2.T @ np.cross(P - O2, n)])
    turn = tuple(map(tuple, (R2.T @ R1).tolist()))
    node = tuple((R1.T @ (O2 - O1)).tolist())
    for g in (replace(plain, turn=turn), replace(plain, turn=turn, gear_node=node)):
        np.testing.assert_allclose(contact_vector(g), by_hand, rtol=0.0, atol=1e-15)


def test_the_other_flank_has_the_mirrored_normal() -> None:
    g = contact(1, 1)
    n = flank_normal(g)
    other = flank_normal(replace(g, torque_sense=-1))
    np.testing.assert_allclose(other, n * [1.0, -1.0, -1.0], atol=1e-15)
