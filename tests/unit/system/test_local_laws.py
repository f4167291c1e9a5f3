"""Laws that a model gives to the time integrators: errors of both helices, both flanks, curves read backwards, friction."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.forces.law import ForceLaw
from rotorgear.forces.mesh_contact import MeshContact
from rotorgear.forces.mesh_friction import MeshFriction
from rotorgear.solvers.time.local_system import Rotation
from rotorgear.system.local import local_model
from rotorgear.system.system import System
from tests.models import spur_pair
from tests.unit.analysis.transient.test_against_response import herringbone

BACKWARDS = {"operation__input_shaft": "two", "operation__output_shaft": "one"}


def laws_of(model: rg.Model) -> list[tuple[str, ForceLaw]]:
    assert model.operation is not None
    speed = model.operation.speed or 0.0
    return [(part.label, part.law) for part in local_model(System(model), Rotation.constant(speed), speed).parts]


def test_a_transient_at_rest_shares_the_load_of_the_helices_as_statics_does() -> None:
    errors = {"meshes__pair__index_error": "3 um", "meshes__pair__helix_index_error": "12 um"}
    model = herringbone(**errors, meshes__pair__transmission_error=[], unbalances={}, operation__torque="600 N m")
    static = rg.static(model, elements=1).mesh_force
    assert abs(static[1] / static[0] - 1.0) > 0.05  # so the error of the second helix can be seen
    result = rg.transient(model, time=0.002, discard=0.0, steps=50, elements=1, error_estimate=False)
    assert result.mesh_force[0] == pytest.approx(static, rel=1e-6)
    assert result.mesh_force[-1] == pytest.approx(static, rel=1e-6)


def test_both_flanks_on_their_own_normals_leave_the_play_of_one_line_whatever_the_index_error() -> None:
    found = []
    for flank in ("line", "own normals"):
        model = spur_pair(
            meshes__pair__backlash="50 um",
            meshes__pair__coast_flank=flank,
            meshes__pair__index_error="7 um",
            meshes__pair__transmission_error=[{"harmonic": 1, "amplitude": "3 um", "phase": "30 deg"}],
        )
        found.append([law for name, law in laws_of(model) if name.startswith("pair")])
    (line,), (drive, coast) = found
    for d in np.array([-60.0, -52.0, -48.0, -43.0, -40.0, -20.0, 0.0, 5.0, 9.0, 20.0]) * 1e-6:
        for angle in (0.0, 0.1):
            one = line.evaluate([d], angle=angle).force[0]
            # In torsion alone, what closes the one flank opens the other by as much.
            both = drive.evaluate([d], angle=angle).force[0] - coast.evaluate([-d], angle=angle).force[0]
            assert both == pytest.approx(one, rel=1e-9, abs=1e-6)


@pytest.mark.parametrize("changes", [{}, BACKWARDS, {"operation__speed": "-1500 rpm"}])
def test_a_stiffness_curve_is_read_backwards_where_the_gear_drives(changes: dict[str, Any]) -> None:
    """Positions count from approach to recess of the pinion; with the gear driving, the contacts run the other way."""
    values = [
        3e8 * (1.0 + 0.1 * math.sin(2.0 * math.pi * i / 12) + 0.05 * math.cos(4.0 * math.pi * i / 12))
        for i in range(12)
    ]
    model = spur_pair(
        meshes__pair__transmission_error=[], meshes__pair__stiffness=values, meshes__pair__phase=0.0, **changes
    )
    law = next(law for name, law in laws_of(model) if name == "pair")
    order = law.parameters()[6]
    for i, value in enumerate(values):
        later = -i / 12 if "operation__input_shaft" in changes else i / 12
        angle = 2.0 * math.pi * later / order
        assert law.evaluate([1e-5], angle=angle).in_displacement[0, 0] == pytest.approx(value, rel=1e-6)


@pytest.mark.parametrize("changes", [{}, BACKWARDS])
def test_friction_by_a_lubricant_is_that_of_speeds_and_loads_computed_by_hand(changes: dict[str, Any]) -> None:
    """Spur teeth 24/36 of 4 mm at 20 deg; the pinion turns at 1.5 times the speed of the wheel, whichever is the reference."""
    viscosity = 0.04  # Pa s
    reference = 1500.0 * math.pi / 30.0
    model = spur_pair(
        meshes__pair__transmission_error=[],
        meshes__pair__lubricant_viscosity=viscosity,
        operation__torque="200 N m",
        gears__wheel__width="20 mm",
        **changes,
    )
    law = replace(next(law for name, law in laws_of(model) if "friction" in name), smooth=1e-9)
    pinion, wheel = (reference * share for share in ((1.5, 1.0) if changes else (1.0, 1.0 / 1.5)))
    base = 0.048 * math.cos(math.radians(20.0))
    pitch = 2.0 * math.pi * base / 24
    normal = 200.0 / (0.072 if changes else 0.048) / math.cos(math.radians(20.0))
    # Along the path of the pinion's tip and the wheel's tip, seen by the driver from approach to recess.
    alpha = math.radians(20.0)
    leave, reach = (
        math.sqrt((r + 0.004) ** 2 - (r * math.cos(alpha)) ** 2) - r * math.sin(alpha) for r in (0.048, 0.072)
    )
    start, end = (-leave, reach) if changes else (-reach, leave)
    for angle in np.linspace(0.0, 0.26, 27):
        phase = law.contact.order * angle + law.contact.phase
        there = [xi for n in range(-4, 5) if start <= (xi := (phase / (2.0 * math.pi) + n) * pitch) <= end]
        assert 1 <= len(there) <= 2
        mus = []
        for xi in there:
            slide = max(abs(xi) * (pinion + wheel), 1e-9)
            roll = 2.0 * pinion * base * math.tan(alpha)
            load = normal / 0.020
            x = 29.66 * load / (1e3 * viscosity * slide * roll**2)
            mus.append(min(max(0.0127 * math.log10(max(x, 1.0)), 0.0), 0.2))
        d = normal / 3e8 + law.contact.error_mean
        found = law.evaluate([d, 0.0, 0.0], angle=angle, speed=reference)
        moment = sum(mu * normal / len(there) * abs(xi) for mu, xi in zip(mus, there, strict=True))
        assert abs(found.force[2]) == pytest.approx(moment, rel=1e-6)
        power = sum(mu * normal / len(there) * abs(xi) * (pinion + wheel) for mu, xi in zip(mus, there, strict=True))
        assert found.dissipated == pytest.approx(power, rel=1e-6)


@pytest.mark.parametrize("changes", [{}, BACKWARDS, {"operation__speed": "-1500 rpm"}])
def test_the_mean_rotation_slides_the_flanks_as_the_friction_law_takes_it(changes: dict[str, Any]) -> None:
    """Both gears roll on each other: nothing closes, nothing slides at the pitch point, and xi W slides away from it."""
    model = spur_pair(meshes__pair__transmission_error=[], meshes__pair__friction_coefficient=0.05, **changes)
    assert model.operation is not None
    speed = model.operation.speed or 0.0
    system = System(model)
    found = local_model(system, Rotation.constant(speed), speed)
    (part,) = [part for part in found.parts if "friction" in part.label]
    rolling = np.zeros(system.dofs.transform.shape[0])
    for shaft in ("one", "two"):
        rolling[[6 * node + 5 for node in system.nodes.on_shaft(shaft)]] = float(system.train.ratio(shaft)) * speed
    assert isinstance(part.law, MeshFriction)
    rates = part.columns.T @ rolling
    assert rates == pytest.approx([0.0, 0.0, part.law.closing * speed], abs=1e-9)


def test_the_cage_of_a_rolling_bearing_turns_with_its_own_shaft() -> None:
    rolling = {
        "kind": "roller",
        "elements": 12,
        "element_diameter": "8 mm",
        "length": "8 mm",
        "pitch_diameter": "60 mm",
    }
    model = spur_pair(bearings__a__rolling=rolling, bearings__c__rolling=rolling, meshes__pair__transmission_error=[])
    own = dict(laws_of(model))
    cage = 0.5 * (1.0 - 8.0 / 60.0)
    assert own["a"].order == pytest.approx(cage)
    assert own["c"].order == pytest.approx(-cage * 24.0 / 36.0)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_propeller_on_the_second_shaft_follows_the_speed_of_that_shaft(sense: float) -> None:
    model = spur_pair(
        operation__torque=None,
        operation__output_shaft=None,
        operation__speed=f"{sense * 1500} rpm",
        meshes__pair__transmission_error=[],
        loads={
            "in": {"shaft": "one", "kind": "input", "torque": "100 N m"},
            "out": {"shaft": "two", "kind": "output", "speed_power": 2.0},
        },
    )
    law = dict(laws_of(model))["loads.out"]
    own = -sense * 1500.0 * math.pi / 30.0 / 1.5
    full = law.evaluate([0.0], [0.0], speed=sense * 1500.0 * math.pi / 30.0).force[0]
    assert abs(full) == pytest.approx(150.0, rel=1e-9)
    assert np.sign(-full) == -np.sign(own)  # it takes power
    faster = law.evaluate([0.0], [0.1 * own], speed=sense * 1500.0 * math.pi / 30.0).force[0]
    assert faster == pytest.approx(1.21 * full, rel=1e-9)


@pytest.mark.parametrize("driver", ["one", "two"])
@pytest.mark.parametrize("speed", [300.0, -300.0])
def test_teeth_of_the_second_helix_are_ahead_by_the_stagger_where_the_input_turns_about_z(
    driver: str, speed: float
) -> None:
    """Turned the other way, the same teeth come later. Both helices together have the stiffness that the mesh has as a whole."""
    values = [
        3e8 * (1.0 + 0.1 * math.sin(2.0 * math.pi * i / 12) + 0.05 * math.cos(4.0 * math.pi * i / 12))
        for i in range(12)
    ]
    model = herringbone(
        meshes__pair__stiffness=values,
        operation__input_shaft=driver,
        operation__output_shaft={"one": "two", "two": "one"}[driver],
        operation__torque="300 N m",
        operation__speed=speed,
    )
    first, second = (law for name, law in laws_of(model) if name.startswith("pair") and isinstance(law, MeshContact))
    ahead = (second.phase - first.phase) / (2.0 * math.pi)
    assert (ahead - math.copysign(0.25, speed)) % 1.0 == pytest.approx(0.0, abs=1e-9)
    assert first.order == second.order
    system = System(model)
    (force, _) = system.state.forces
    whole = system.layout.mesh("pair").stiffness(sense=force.torque_sense)
    for u, k in zip(whole.position, whole.transverse / math.cos(whole.base_helix_angle) ** 2, strict=True):
        later = u if driver == "one" else -u
        angle = (2.0 * math.pi * later - first.phase) / first.order
        both = sum(law.evaluate([1e-3], angle=angle).in_displacement[0, 0] for law in (first, second))
        assert both == pytest.approx(k, rel=1e-6)
