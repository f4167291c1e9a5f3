"""Gears whose teeth turn against their shaft: the torsion of web and hub stands in the rotor model, once."""

from __future__ import annotations

import math

import numpy as np
import pytest
import scipy.linalg as la

import rotorgear as rg
from rotorgear.elements.bodies import elastic_gear
from rotorgear.gears.geometry.blank import BlankShape
from rotorgear.gears.tooth_fe.blank_section import BlankSection, blank_torsion
from rotorgear.system.rigid_motions import rigid_motions
from tests.paths import ROOT
from validation.benchmarks.wheel_torsion import CASES, held_model, program_hz, reference_hz, rigid_in_hub

NU = 0.3
WEBBED = BlankShape(
    bore_radius=40.0, rim_radius=110.0, web_thickness=8.0, web_position=0.0, hub_radius=60.0, hub_width=40.0
)


def wheel(**changes: object) -> rg.Model:
    """The model with a web wheel in torsion alone; given values at addresses."""
    model = rg.load(ROOT / "models" / "web_wheel.toml")
    return model.with_({"motions": ["torsion"], **changes})


def turned(model: rg.Model) -> float:
    """Rotation (rad) of the input shaft by its torque, the output shaft held where its torque acts."""
    system = rg.System(model, state=model.torque_flow(1).of_kind("static"))
    K = system.stiffness().toarray()
    inlet, outlet = (system.nodes.at(item.shaft, item.z) for item in system.state.applied)
    force = np.zeros(K.shape[0])
    force[system.dofs.column[6 * inlet + 5]] = 300.0
    free = np.delete(np.arange(K.shape[0]), system.dofs.column[6 * outlet + 5])
    q = np.zeros(K.shape[0])
    q[free] = np.linalg.solve(K[np.ix_(free, free)], force[free])
    return float(q[system.dofs.column[6 * inlet + 5]])


def test_the_wind_up_is_neither_lost_nor_counted_twice() -> None:
    """At rest the shafts turn alike whether the mesh or the rotor model has the torsion of web and hub."""
    # Gears as wide as their common face, so that both have the same blank.
    same = {"gears.pinion.width": "32 mm"}
    apart = turned(wheel(**same))
    within = turned(wheel(**same, **{"meshes.stage.tooth_fe.exclude_torsion": False}))
    rigid = turned(wheel(**same, **{"meshes.stage.tooth_fe.body": "rim"}))
    assert apart == pytest.approx(within, rel=1e-6)
    assert apart > 1.05 * rigid


def test_only_one_more_rotation_and_the_same_mass() -> None:
    elastic = rg.System(wheel())
    rigid = rg.System(wheel(**{"meshes.stage.tooth_fe.exclude_torsion": False}))
    assert elastic.n == rigid.n + 1
    assert rigid_motions(elastic, elastic.groups).shape[1] == 1
    # All parts turning with their shafts at one speed have the same kinetic energy.
    turning = [rigid_motions(system, system.groups)[:, 0] for system in (elastic, rigid)]
    energies = [
        q @ system.mass @ q / (q[system.dofs.column[5]] ** 2)
        for q, system in zip(turning, (elastic, rigid), strict=True)
    ]
    assert energies[0] == pytest.approx(energies[1], rel=1e-9)


def test_with_all_motions_one_rotation_is_free() -> None:
    system = rg.System(rg.load(ROOT / "models" / "web_wheel.toml"))
    assert rigid_motions(system, system.groups).shape[1] == 1


@pytest.mark.long
def test_the_torsional_mode_of_wheel_and_shaft_is_that_of_the_whole_blank() -> None:
    """A hub on a shaft's spring with a rotor's inertia: two rotations against finite elements of the whole section."""
    width = 40.0
    root = 125.0
    outside = 131.0
    torsion = blank_torsion(WEBBED, width, (root, outside), NU)
    section = BlankSection(WEBBED, width, root, NU)
    r = section.radius
    # Rotations in place of displacements: V = r phi. All nodes of the bore turn as one.
    K = 2.0 * math.pi * (section.free_stiffness(0)[1::3, 1::3].toarray() * r[:, None] * r)
    M = 2.0 * math.pi * section.inertia.toarray()
    # Teeth as a ring that turns with the root circle.
    on_circle = np.flatnonzero(r > root * (1.0 - 1e-9))
    M[on_circle, on_circle] += 0.5 * math.pi * width * (outside**4 - root**4) / len(on_circle)
    bore = r < WEBBED.bore_radius * (1.0 + 1e-9)
    T = np.hstack([bore[:, None].astype(float), np.eye(len(r))[:, ~bore]])
    K = T.T @ K @ T
    M = T.T @ M @ T
    polar = float(M.sum()) * torsion.polar_share
    element = elastic_gear(1.0, polar, 1.0, 1.0 / torsion.flexibility)
    assert element.mass is not None
    assert element.stiffness is not None
    pick = np.ix_([5, 11], [5, 11])
    small = [element.stiffness[0][pick].copy(), element.mass[0][pick].copy()]
    stiffness = 1.0 / torsion.flexibility
    for spring, inertia in ((0.2 * stiffness, 0.1 * polar.sum()), (stiffness, polar.sum())):
        exact = [K.copy(), M.copy()]
        ours = [matrix.copy() for matrix in small]
        for matrices in (exact, ours):
            matrices[0][0, 0] += spring
            matrices[1][0, 0] += inertia
        found = np.sqrt(la.eigh(*ours, eigvals_only=True))
        expected = np.sqrt(la.eigh(*exact, eigvals_only=True)[:2])
        assert found == pytest.approx(expected, rel=0.01)


@pytest.mark.long
@pytest.mark.parametrize("case", CASES)
def test_the_lowest_torsional_mode_of_wheel_and_shaft_is_that_of_3d_elements(case: str) -> None:
    model = held_model(CASES[case])
    assert program_hz(model)[0] == pytest.approx(reference_hz(model, rigid=False)[0], rel=0.01)


@pytest.mark.long
@pytest.mark.parametrize("case", [name for name in CASES if name.startswith("long shaft")])
def test_so_is_the_second_where_the_shaft_within_the_hub_is_rigid(case: str) -> None:
    """There the rim turns against its shaft; on a short shaft the ends of the rigid stretch count, up to 3 %."""
    model = rigid_in_hub(held_model(CASES[case]))
    assert program_hz(model) == pytest.approx(reference_hz(model, rigid=True), rel=0.01)


def test_a_gear_winds_up_in_all_its_meshes_alike() -> None:
    data = rg.load(ROOT / "models" / "web_wheel.toml").model_dump(exclude_unset=True)
    data["shafts"]["third"] = data["shafts"]["input"] | {"position": [0.327, 0.0]}
    data["gears"]["mate"] = data["gears"]["pinion"] | {"shaft": "third"}
    data["meshes"]["other"] = data["meshes"]["stage"] | {"pinion": "mate", "tooth_fe": {"exclude_torsion": False}}
    with pytest.raises(rg.ModelError, match="the wind-up of gear 'wheel' in this mesh"):
        rg.Model(**data)
