"""Equilibrium with force laws, and linear analyses about it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.static.solve import equilibrate
from rotorgear.errors import AnalysisError
from rotorgear.forces.law import ForceLaw, parameter
from rotorgear.forces.registry import register_law
from rotorgear.solvers.time.compiled import force_function
from rotorgear.solvers.time.kernel_contact import no_schedule
from rotorgear.system.system import System
from tests.models import spur_pair

K = 3e7
C = 400.0


@force_function
def force(p, s, d, v, F, Kd, Kv, energy):  # type: ignore[no-untyped-def]
    """A spring and a damper."""
    F[0] = p[0] * d[0] + p[1] * v[0]
    Kd[0] = p[0]
    Kv[0] = p[1]
    energy[0] = 0.5 * p[0] * d[0] ** 2
    energy[1] = 0.0
    energy[2] = p[1] * v[0] ** 2
    energy[3] = 0.0


@register_law("test_spring")
@dataclass(frozen=True)
class TestSpring(ForceLaw):
    """A linear law of one's own, which says nothing beyond its force."""

    __test__: ClassVar[bool] = False
    title: ClassVar[str] = "test spring"

    stiffness: float = parameter("N/m", "k", least=0.0)
    damping: float = parameter("N s/m", "c", 0.0, least=0.0)

    def functions(self) -> tuple[Any, Any]:
        return no_schedule, force

    @classmethod
    def examples(cls) -> tuple[TestSpring, ...]:
        return (cls(K, C),)


def pair(**parts: Any) -> rg.Model:
    """The spur pair with something on its pinion's shaft."""
    return rg.Model(**{**spur_pair().model_dump(exclude_none=True, exclude_defaults=True), "damping": {}, **parts})


def beside_a_support() -> tuple[rg.Model, rg.Model]:
    law = {
        "law": "test_spring",
        "shaft": "one",
        "at": "end",
        "directions": ["y"],
        "parameters": {"stiffness": "30 N/um", "damping": "400 N s/m"},
    }
    support = {"shaft": "one", "at": "end", "stiffness": {"y": K}, "damping": {"y": C}}
    return pair(nonlinear_elements={"extra": law}), pair(supports={"extra": support})


def test_a_linear_law_from_python_is_a_support_in_statics_modes_and_responses() -> None:
    law, support = beside_a_support()
    speeds = ["500 rpm", "1000 rpm", "1500 rpm"]
    stand = [rg.static(model) for model in (law, support)]
    assert stand[0].displacement == pytest.approx(stand[1].displacement, rel=1e-8, abs=1e-15)
    assert stand[0].bearing_force["nonlinear_elements.extra"] == pytest.approx(
        stand[1].support_force["extra"], rel=1e-8
    )
    assert stand[0].imbalance < 1e-10
    for speed in (None, "1500 rpm"):
        modes = [rg.modal(model, speed=speed, modes=8) for model in (law, support)]
        assert modes[0].eigenvalues == pytest.approx(modes[1].eigenvalues, rel=1e-8)
        share = [modes[0].strain_energy["nonlinear_elements.extra"], modes[1].strain_energy["supports.extra"]]
        assert share[0] == pytest.approx(share[1], abs=1e-7)
    diagrams = [rg.campbell(model, speeds=speeds, modes=6) for model in (law, support)]
    assert diagrams[0].eigenvalues == pytest.approx(diagrams[1].eigenvalues, rel=1e-8)
    critical = [rg.critical(model, stop="9000 rpm") for model in (law, support)]
    found = [[each.speed for each in result.speeds] for result in critical]
    assert found[0] == pytest.approx(found[1], rel=1e-8)
    answers = [rg.response(model, speeds=speeds, elements=1) for model in (law, support)]
    assert answers[0].mesh_force == pytest.approx(answers[1].mesh_force, rel=1e-7)
    places = {"inputs": ["gears.pinion:y"], "outputs": ["gears.wheel:y"]}
    receptances = [rg.frf(model, [100.0, 700.0], elements=1, **places) for model in (law, support)]
    assert receptances[0].receptance == pytest.approx(receptances[1].receptance, rel=1e-7)
    assert "linear about the static equilibrium" in receptances[0].method
    assert "linear about" not in receptances[1].method


def test_a_linear_law_from_python_is_a_support_in_transients_and_sweeps() -> None:
    law, support = beside_a_support()
    runs = [
        rg.transient(model, time=0.01, steps=200, method="newmark", error_estimate=False) for model in (law, support)
    ]
    assert runs[0].mesh_force == pytest.approx(runs[1].mesh_force, rel=1e-5)
    assert "nonlinear_elements.extra force y" in runs[0].channel
    over = {"operation.speed": ["1500 rpm"]}
    swept = [rg.sweep(model, over, elements=1, discard=50, sample=5, exponents=0) for model in (law, support)]
    assert swept[0].peak_to_peak_approach == pytest.approx(swept[1].peak_to_peak_approach, rel=1e-3)


def rigid_rotor(load: float, **bearing: Any) -> rg.Model:
    """A stiff, short rotor in the middle of one bearing, pressed down by its weight."""
    return rg.Model(
        motions=["bending"],
        operation={"input_shaft": "rotor", "speed": "1000 rpm", "gravity": [0.0, -9.81, 0.0]},
        shafts={"rotor": {"position": [0.0, 0.0]}},
        point_masses={"disk": {"shaft": "rotor", "at": "start", "mass": load / 9.81}},
        supports={"tilt": {"shaft": "rotor", "at": "start", "fixed": ["tilt_x", "tilt_y"]}},
        **bearing,
    )


def test_a_hardening_spring_stands_at_the_root_of_its_cubic_and_swings_with_its_tangent_there() -> None:
    k, k3, load = 1e6, 4e15, 500.0
    spring = {"law": "plain_spring", "shaft": "rotor", "at": "start"}
    parameters = {"stiffness": k, "cubic": k3}
    model = rigid_rotor(
        load,
        nonlinear_elements={axis: {**spring, "directions": [axis], "parameters": parameters} for axis in ("x", "y")},
    )
    y = max(root.real for root in np.roots([k3, 0.0, k, -load]) if abs(root.imag) < 1e-9 * abs(root))
    assert rg.static(model).displacement[0, :2] == pytest.approx([0.0, -y], rel=1e-8, abs=1e-15)
    found = np.sort(rg.modal(model, modes=2).frequency_hz) * 2.0 * np.pi
    assert found == pytest.approx(np.sqrt(np.array([k, k + 3.0 * k3 * y**2]) * 9.81 / load), rel=1e-8)


def test_a_stiffness_that_is_given_beside_a_law_counts_in_linear_analyses_only() -> None:
    spring = {"law": "plain_spring", "shaft": "rotor", "at": "start", "parameters": {"stiffness": 1e6}}
    model = rigid_rotor(
        500.0,
        nonlinear_elements={axis: {**spring, "directions": [axis], "stiffness": {axis: 4e6}} for axis in ("x", "y")},
    )
    assert rg.static(model).displacement[0, 1] == pytest.approx(-500.0 / 1e6, rel=1e-8)
    result = rg.modal(model, modes=2)
    assert result.frequency_hz == pytest.approx(np.full(2, np.sqrt(4e6 * 9.81 / 500.0) / (2.0 * np.pi)), rel=1e-8)
    assert any(
        "nonlinear_elements.x.parameters: the stiffness given beside the law is taken" in note
        for note in result.left_out
    )


ROLLING = {
    "kind": "ball",
    "elements": 9,
    "element_diameter": "11.5 mm",
    "pitch_diameter": "43.5 mm",
    "clearance": "60 um",
}


def test_a_bearing_given_by_its_balls_alone_stands_where_its_transient_swings_about() -> None:
    model = rigid_rotor(
        800.0, bearings={"ball": {"shaft": "rotor", "at": "start", "damping": {"radial": 3e4}, "rolling": ROLLING}}
    )
    stand = rg.static(model)
    y = stand.displacement[0, 1]
    assert -60e-6 < y < -30e-6  # beyond half the clearance, on the balls below
    assert stand.bearing_force["ball"][1] == pytest.approx(800.0, rel=1e-8)
    run = rg.transient(model, time=0.1, discard=0.05, steps=2000, error_estimate=False, method="newmark")
    assert run.history("bearings.ball displacement y")[run.counted].mean() == pytest.approx(y, rel=0.01)
    law = equilibrate(System(model), model.operation.speed).laws[0]
    modes = rg.modal(model, modes=2)
    frequency = modes.frequency_hz
    # It has one description, so no note chooses between two; the state that it is linearised about is told.
    assert not any("the stiffness carries" in note for note in (*stand.left_out, *run.left_out, *modes.left_out))
    assert [law.part for law in modes.laws] == ["bearings.ball"]
    stiffness = np.linalg.eigvalsh(0.5 * (law.stiffness + law.stiffness.T)[:2, :2])
    assert frequency == pytest.approx(np.sqrt(stiffness * 9.81 / 800.0) / (2.0 * np.pi), rel=1e-6)


def test_a_law_that_cannot_carry_the_load_is_said_to_have_no_equilibrium() -> None:
    film = {"viscosity": 0.02, "radius": "25 mm", "length": "25 mm", "clearance": "50 um", "wall": 0.0}
    element = {"law": "journal_bearing", "shaft": "rotor", "at": "start", "parameters": film}
    model = rigid_rotor(500.0, nonlinear_elements={"film": element})
    # Without rotation there is no film, and this bearing has no shell that could carry.
    with pytest.raises(AnalysisError, match="nothing holds shaft 'rotor' in y"):
        rg.static(model, speed=0.0)
    # With rotation, the film carries.
    assert abs(rg.static(model, speed="3000 rpm").displacement[0, 1]) < 50e-6
