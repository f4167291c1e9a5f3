"""Sweeps with laws that run one system at a time: rolling bearings, friction, torques over speed."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.sweep.point import at_rest, ready, table_of
from rotorgear.forces.ball_bearing import BallBearing
from rotorgear.forces.law import ForceLaw
from rotorgear.forces.mesh_contact import MeshContact
from rotorgear.forces.mesh_friction import MeshFriction
from rotorgear.forces.torque_curve import TorqueCurve
from rotorgear.solvers.batch.own_laws import not_held, own_laws
from rotorgear.solvers.batch.run_block import BatchPlan, Start, run_block
from rotorgear.solvers.time.local_system import LocalSystem
from tests.models import spur_pair
from validation.oscillators import integrate, local_system

MESH = MeshContact(
    1.0, 0.05, 0.5, contact_damping="adhesive", ramp=0.05, order=1.0, error_cos=(0.3,), stiffness_cos=(0.2,)
)
ROLLING = {
    "kind": "ball",
    "elements": 9,
    "element_diameter": "12 mm",
    "pitch_diameter": "60 mm",
    "clearance": "8 um",
}


def with_law(law: ForceLaw, columns: Any, speed: float = 0.9, contact: MeshContact = MESH) -> LocalSystem:
    """Five masses on springs with a mesh between the first two, and a law."""
    K = 0.3 * np.eye(5) + 0.1 * (np.eye(5, k=1) + np.eye(5, k=-1))
    mesh = np.array([[1.0], [-1.0], [0.0], [0.0], [0.2]])
    return local_system(
        np.eye(5), 0.05 * np.eye(5), K, [0.2, -0.1, 0.0, 0.05, 0.0], [(contact, mesh), (law, columns)], speed=speed
    )


@pytest.mark.parametrize(
    ("law", "columns"),
    [
        (BallBearing(7, 0.3, 1.2, clearance=0.02, order=0.37, youngs_modulus=8.0), np.eye(5)),
        (MeshFriction(MESH, 0.9, -0.7, 0.6, 1.5, 0.1, smooth=0.2), np.eye(5)[:, [0, 2, 4]]),
        (MeshFriction(MESH, 0.9, -0.7, 0.6, 1.5, 0.1, overlap=1.3, smooth=0.2), np.eye(5)[:, [0, 2, 4]]),
        (TorqueCurve(0.2, 1.0, 2.0, 0.9, damping=0.02, ripple=0.3, order=1.0), np.eye(5)[:, [1]]),
    ],
    ids=["ball bearing", "friction", "friction of helical teeth", "torque over speed"],
)
def test_laws_follow_newmark_in_small_steps(law: ForceLaw, columns: np.ndarray) -> None:
    local = with_law(law, columns)
    point = ready(at_rest(local, [Fraction(1)], ("m",)), 0.9)
    steps = 800
    periods = 5
    start = Start(point.system.rest, np.zeros(5))
    orbit = run_block([point.system], [start], [table_of(point, steps)], BatchPlan(steps, 0, periods, 0))[0]
    fine = 6000
    q0 = np.linalg.solve(point.system.root.T, start.z)
    h = 2.0 * np.pi / 0.9 / fine
    motion = integrate(local, "average acceleration", h, fine * periods, q0, np.zeros(5), fine)
    d = motion.q @ local.B.toarray()
    v = motion.v @ local.B.toarray()
    assert orbit.section[:, :, 0] == pytest.approx(d[1:], abs=3e-4 * np.abs(d).max())
    assert orbit.section[:, :, 1] == pytest.approx(v[1:], abs=2e-3 * np.abs(v).max())


def test_one_at_a_time_and_in_vectors_are_the_same_to_rounding(monkeypatch: pytest.MonkeyPatch) -> None:
    # Damping that grows with the depth: what jumps is put right in vectors only.
    smooth = replace(MESH, contact_damping="penetration")
    local = with_law(smooth, np.array([[0.0], [1.0], [0.0], [-1.0], [0.0]]), contact=smooth)

    def orbit(own: bool) -> Any:
        known = at_rest(local, [Fraction(1)], ("m", "n"))
        if own:
            monkeypatch.setattr(MeshContact, "columns", ForceLaw.columns)
        points = [ready(known, speed) for speed in (0.8, 0.9, 1.1)]
        # The same measure of tangents for both: that of a law of its own is taken at its steepest.
        points = [replace(p, system=replace(p.system, energy=np.eye(5))) for p in points]
        starts = [Start(p.system.rest, np.zeros(5)) for p in points]
        return run_block(
            [p.system for p in points], starts, [table_of(points[0], 200)], BatchPlan(200, 3, 12, 4, warm=3)
        )

    for a, b in zip(orbit(False), orbit(True), strict=True):
        assert a.section == pytest.approx(b.section, rel=1e-9, abs=1e-11)
        assert a.growth == pytest.approx(b.growth, abs=1e-9)


@pytest.mark.parametrize(
    "changes",
    [
        pytest.param({"bearings__a__rolling": ROLLING, "bearings__b__rolling": ROLLING}, marks=pytest.mark.long),
        # With a load that brakes, so that the speed is the same in both: a sweep keeps what nothing brakes at its speed.
        {
            "meshes__pair__friction_coefficient": 0.06,
            "operation": {"input_shaft": "one", "speed": "1500 rpm"},
            "loads": {
                "drive": {"shaft": "one", "kind": "input", "torque": "200 N m"},
                "propeller": {"shaft": "two", "kind": "output", "speed_power": 2.0},
            },
        },
        {
            "motions": ["torsion"],
            "operation": {"input_shaft": "one", "speed": "1500 rpm"},
            "loads": {
                "drive": {"shaft": "one", "kind": "input", "torque": "200 N m", "ripple": 0.2, "ripple_order": 12.0},
                "propeller": {"shaft": "two", "kind": "output", "speed_power": 2.0},
            },
        },
    ],
    ids=["rolling", "friction", "propeller"],
)
def test_models_with_such_laws_give_the_transient(changes: dict[str, Any]) -> None:
    model = spur_pair(meshes__pair__backlash="50 um", **changes)
    # The basic element in both: a law acts alike whatever the mesh, and small systems keep this quick.
    swept = rg.sweep(model, {"operation.speed": ["1500 rpm"]}, discard=30, sample=10, elements=1)
    mesh = 24 * 1500.0 / 60.0
    run = rg.transient(
        model, discard=30 / mesh, time=10 / mesh, steps=600, method="newmark", error_estimate=False, elements=1
    )
    row = run.to_dict()["contacts"][0]
    assert swept.largest_force[0, 0, 0] == pytest.approx(row["largest_force_n"], rel=5e-3)
    assert swept.peak_to_peak_approach[0, 0, 0] == pytest.approx(row["peak_to_peak_approach_m"], rel=1e-2)
    assert swept.rms_force[0, 0, 0] == pytest.approx(row["rms_force_n"], rel=1e-2)
    assert any("bearing cages never repeat" in warning for warning in swept.warnings) == (
        "bearings__a__rolling" in changes
    )


def test_each_ripple_of_a_torque_has_its_own_table() -> None:
    loads = {
        "drive": {"shaft": "one", "kind": "input", "torque": "200 N m", "ripple": 0.1, "ripple_order": 6.0},
        "brake": {"shaft": "two", "kind": "output"},
    }
    model = spur_pair(
        motions=["torsion"],
        operation={"input_shaft": "one", "speed": "1500 rpm"},
        loads=loads,
        meshes__pair__transmission_error=[],
    )
    both = rg.sweep(model, {"loads.drive.ripple": [0.1, 0.4]}, discard=10, sample=5, elements=1)
    # Teeth never part, so the motion is linear in the ripple.
    assert both.peak_to_peak_approach[1, 0, 0] == pytest.approx(4.0 * both.peak_to_peak_approach[0, 0, 0], rel=1e-3)


def test_a_torque_that_steps_is_refused() -> None:
    loads = {
        "drive": {"shaft": "one", "kind": "input", "torque": "200 N m", "step_to": 0.5},
        "brake": {"shaft": "two", "kind": "output"},
    }
    model = spur_pair(operation={"input_shaft": "one", "speed": "1500 rpm"}, loads=loads)
    with pytest.raises(rg.RotorgearError, match="a torque that steps at a time"):
        rg.sweep(model, {"operation.speed": ["1500 rpm"]})


def test_a_bearing_without_stiffness_at_rest_still_holds_its_shaft() -> None:
    law = BallBearing(9, 12e-3, 60e-3, clearance=8e-6, order=0.4)
    local = local_system(np.eye(5), 0.05 * np.eye(5), np.zeros((5, 5)), np.zeros(5), [(law, np.eye(5))], speed=0.9)
    rest = at_rest(local, [Fraction(1)], ()).rest
    own = own_laws(local.forces, np.ones(5, dtype=bool), 1.0)
    assert rest.free.shape == (5, 5)
    # The balls answer when the shaft moves far enough, whichever way.
    assert not_held(local, rest.q, own, rest.free).shape[1] == 0


def free_pair_that_rubs(**changes: Any) -> rg.Model:
    """In torsion on shafts that nothing holds, with friction between the teeth."""
    return spur_pair(
        motions=["torsion"],
        bearings=None,
        points=None,
        meshes__pair__backlash="50 um",
        meshes__pair__friction_coefficient=0.1,
        **changes,
    )


def test_friction_does_not_run_the_shafts_down() -> None:
    # Its loss is in no balance of torques: a pair left alone with it would slide otherwise after some thousand periods, and the
    # largest force of this one falls by 6 % in a thousand.
    model = free_pair_that_rubs()
    soon, late = (
        rg.sweep(model, {"operation.speed": ["1500 rpm"]}, discard=discard, sample=10, exponents=0, elements=1)
        for discard in (60, 200)
    )
    for name in ("mean_force", "largest_force", "peak_to_peak_approach"):
        assert getattr(late, name) == pytest.approx(getattr(soon, name), rel=1e-9)
    assert any("the power that tooth friction takes: the drive makes up for it" in text for text in late.warnings)
    assert not any("drift" in warning for warning in late.warnings)


def test_a_light_drag_does_not_let_friction_run_the_shafts_down() -> None:
    # 0.016 N m beside 200 N m: in balance with the loss of friction it would be far below the speed of the shafts.
    supports = {"drag": {"shaft": "one", "at": "60 mm", "damping": {"torsion": 1e-4}}}
    model = free_pair_that_rubs(supports=supports)
    soon, late = (
        rg.sweep(model, {"operation.speed": ["1500 rpm"]}, discard=discard, sample=10, exponents=0, elements=1)
        for discard in (60, 150)
    )
    assert late.largest_force == pytest.approx(soon.largest_force, rel=1e-9)
    assert any("the drive makes up for it" in text for text in late.warnings)


def test_a_propeller_keeps_its_speed_itself_while_the_drive_pulses_once_in_a_turn() -> None:
    loads = {
        "drive": {"shaft": "one", "kind": "input", "torque": "200 N m", "ripple": 0.2, "ripple_order": 1.0},
        "propeller": {"shaft": "two", "kind": "output", "speed_power": 2.0},
    }
    operation = {"input_shaft": "one", "speed": "1500 rpm"}
    model = spur_pair(motions=["torsion"], bearings=None, points=None, operation=operation, loads=loads)
    swept = rg.sweep(model, {"operation.speed": ["1500 rpm"]}, discard=10, sample=2, elements=1, modes=3, exponents=0)
    run = rg.transient(model, discard=0.4, time=0.08, steps=600, method="newmark", error_estimate=False, elements=1)
    assert swept.mean_force.ravel() == pytest.approx(run.force_mean, rel=1e-6)
    assert swept.rms_force.ravel() == pytest.approx(run.force_rms, rel=1e-6)
    assert not any("makes up" in text or "drift" in text for text in swept.warnings)
    assert not any("drift" in text for text in run.warnings)


@pytest.mark.parametrize(
    ("columns", "brake", "carried"),
    [([0, 1], 0.0, 1), ([0, 1], 1e-3, 1), ([0, 1], 5.0, 0), ([2, 3], 0.0, 0)],
    ids=["free", "hardly braked", "braked", "strained"],
)
def test_the_drive_carries_only_what_nothing_else_brakes_and_friction_pushes(
    columns: list[int], brake: float, carried: int
) -> None:
    # Two masses on a mesh, free together, and two that springs hold.
    K = np.diag([0.0, 0.0, 0.3, 0.3])
    C = np.diag([brake, brake, 0.05, 0.05])
    mesh = np.array([[1.0], [-1.0], [0.0], [0.0]])
    law = MeshFriction(MESH, 0.9, -0.7, 0.6, 1.5, 0.1, smooth=0.2)
    across = np.zeros((4, 3))
    across[columns[0], 2] = across[columns[1], 2] = 1.0
    across[:, :1] = mesh
    local = local_system(np.eye(4), C, K, [0.1, -0.1, 0.0, 0.0], [(MESH, mesh), (law, across)], speed=0.9)
    system = ready(at_rest(local, [Fraction(1)], ("m",)), 0.9).system
    assert len(system.rigid) == 1
    assert len(system.carried) == carried
    if carried:
        assert abs(system.carried[0]) == pytest.approx(np.array([1.0, 1.0, 0.0, 0.0]) / np.sqrt(2.0), abs=1e-12)
