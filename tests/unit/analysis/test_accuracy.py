"""Convergence studies of every analysis: what they compare, what they refuse, and accuracies that can't be reached."""

from __future__ import annotations

import json
from itertools import cycle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import rotorgear as rg
from rotorgear.analysis.accuracy import study_by_name
from rotorgear.analysis.common.study import Judged, Setting, Study, measured
from rotorgear.cli.main import app
from rotorgear.errors import AnalysisError, ConvergenceError
from tests.overhung import overhung_disk
from tests.unit.system.test_rigid_bearings import rotor

ROOT = Path(__file__).parents[3]
SHORT: dict[str, Any] = {"elements": (2, 4), "accuracies": (1e-3,), "repeat": 0}


def within(study: rg.ConvergenceStudy, low: float, high: float) -> None:
    """All rows that the reference resolves have an estimate between `low` and `high` of their error, and there is one."""
    told = [rung.effectivity for rung in study.rungs if rung.effectivity is not None]
    assert told, study.text()
    assert min(told) > low, study.text()
    assert max(told) < high, study.text()


def falls_with_order(study: rg.ConvergenceStudy, order: float) -> None:
    measured_order = [rung.order for rung in study.rungs if rung.order is not None]
    assert measured_order, study.text()
    assert min(measured_order) > order, study.text()


def test_an_analysis_is_measured_by_its_own_estimate_and_by_the_reference() -> None:
    exact = np.array([1.0, 2.0])

    def judge(h: float) -> Judged:
        found = exact * (1.0 + np.array([0.5, 1.0]) * h**2)
        return Judged(3, np.abs(found / exact - 1.0), np.array([0.6, 1.1]) * h**2)

    settings = [Setting(f"h 1/{n}", "elements", float(n), {"h": 1.0 / n}) for n in (2, 4)]
    study = Study(settings, run=lambda options: options["h"], judge=judge, resolution=1e-9)
    coarse, fine = study.rungs(1, lambda fraction, step: None)
    assert fine.order == pytest.approx(2.0)
    assert (coarse.error, coarse.estimate) == pytest.approx((0.25, 0.275))
    assert coarse.effectivity == pytest.approx(1.1)
    assert (coarse.effectivity_smallest, coarse.effectivity_largest) == pytest.approx((1.1, 1.2))


def test_a_rung_that_does_not_converge_stands_as_such() -> None:
    def run(options: dict[str, Any]) -> float:
        raise ConvergenceError("no root")

    settings = [Setting("accuracy 1e-9", "accuracy", 1e-9)]
    study = Study(settings, run=run, judge=lambda result: Judged(1, np.zeros(1), np.zeros(1)), resolution=1e-9)
    (rung,) = study.rungs(1, lambda fraction, step: None)
    assert rung.error == float("inf")
    assert rung.notes == ("not reached: no root",)


def test_memory_of_a_run_is_that_of_its_arrays() -> None:
    _, _, memory = measured(lambda: np.ones(2_000_000).sum(), repeat=1)
    assert 16e6 <= memory < 17e6


def test_critical_speeds_carry_the_error_of_the_speed_and_not_of_the_frequency() -> None:
    # Gyroscopic moments: the error of the crossing is that of the frequency at a held speed over 1 - d(frequency)/d(speed).
    study = study_by_name("critical")(overhung_disk(), elements=(2, 4), accuracies=(), repeat=0)
    within(study, 0.8, 1.25)
    falls_with_order(study, 1.5)
    last = rg.critical(overhung_disk(), elements=2).speeds[-1]

    def mode(speed: float) -> tuple[float, float]:
        found = rg.modal(overhung_disk(), speed=speed, elements=2, modes=12)
        k = int(np.argmin(np.abs(found.eigenvalues.imag / (2.0 * np.pi) - last.frequency_hz)))
        return float(found.eigenvalues[k].imag), float(found.error_estimate[k])

    w, held = mode(last.speed)
    slope = (mode(1.001 * last.speed)[0] - mode(0.999 * last.speed)[0]) / (0.002 * last.speed)
    assert w == pytest.approx(last.speed)
    assert abs(slope) > 0.2
    assert last.error_estimate == pytest.approx(held / (1.0 - slope), rel=1e-3)


def test_a_free_rotation_of_a_fine_mesh_is_no_critical_speed() -> None:
    model = rg.load(ROOT / "models" / "geared_pair.toml")
    coarse = rg.critical(model, elements=4, stop=5.0)
    fine = rg.critical(model, elements=32, stop=5.0)
    assert len(coarse) == len(fine) > 0
    assert fine.speeds[0].speed > 1.0


@pytest.mark.long
def test_branches_of_a_campbell_diagram_are_held_to_modes_at_each_speed() -> None:
    study = study_by_name("campbell")(overhung_disk(), modes=6, **SHORT)
    within(study, 0.5, 3.0)
    falls_with_order(study, 1.5)


@pytest.mark.long
@pytest.mark.parametrize("analysis", ["response", "frf"])
def test_amplitudes_are_held_to_those_of_a_mesh_of_high_order(analysis: str) -> None:
    study = study_by_name(analysis)(overhung_disk(), modal_damping=0.01, **SHORT)
    within(study, 0.5, 3.0)
    falls_with_order(study, 1.5)
    assert study.rungs[-1].error <= 1e-3


def test_a_model_in_torsion_alone_has_its_response_between_rotations() -> None:
    study = study_by_name("frf")(rg.load("models/backlash_pair.toml"), **SHORT)
    assert study.rungs[0].dofs == 2
    assert study.rungs[0].error < 1e-11


def test_statics_of_the_basic_element_are_exact() -> None:
    study = study_by_name("static")(overhung_disk(), **SHORT)
    assert max(rung.error for rung in study.rungs) < 1e-11
    assert all("rounding only" in rung.notes for rung in study.rungs)


def test_lumped_mass_is_measured_against_consistent_mass() -> None:
    study = rg.convergence_study(
        overhung_disk(mass_matrix="lumped"), modes=6, elements=(8, 16), accuracies=(), repeat=0, speed=800.0
    )
    within(study, 0.5, 3.0)
    falls_with_order(study, 1.8)


def test_periodic_motions_of_harmonics_are_held_to_shooting_and_their_estimates_are_those_of_the_errors() -> None:
    model = rg.load(ROOT / "models" / "backlash_pair.toml")
    study = rg.orbits_convergence_study(model, speed="4000 rpm", harmonics=(10, 40), densities=(8,), repeat=0)
    assert "shooting" in study.reference
    assert study.resolution < 1e-5
    within(study, 0.5, 3.0)
    falls_with_order(study, 1.5)


def test_a_motion_too_large_for_shooting_is_checked_by_a_transient() -> None:
    study = rg.orbits_convergence_study(
        rg.load(ROOT / "models" / "flexible_pair.toml"), harmonics=(5, 10), densities=(), repeat=0
    )
    assert "a transient that starts there comes back to" in study.reference
    returned = float(study.reference.split("comes back to ")[1].split()[0])
    assert returned < 1e-5
    assert study.rungs[-1].error < 1e-9


def test_orbits_of_a_rotor_without_meshes_are_compared_by_its_own_displacements() -> None:
    rotor = rg.load(ROOT / "models" / "jeffcott.toml").with_(
        "unbalances", {"u": {"shaft": "rotor", "at": "400 mm", "magnitude": "500 g mm"}}
    )
    study = rg.orbits_convergence_study(rotor, speed="1000 rpm", harmonics=(5, 10), densities=(), repeat=0)
    assert study.compared == "displacements of the bearings, elements and unbalances"
    assert study.modes == 2
    # A linear rotor has one harmonic: nothing is cut off.
    assert max(rung.error for rung in study.rungs) < 1e-9


@pytest.mark.parametrize("analysis", ["scatter", "update", "optimise", "compare", "sensors", "standards", "gear"])
def test_a_verb_without_a_discretisation_says_where_its_errors_stand(analysis: str) -> None:
    with pytest.raises(AnalysisError, match=f"{analysis} has no study of its own: it"):
        rg.accuracy(overhung_disk(), analysis)


def test_an_accuracy_of_amplitudes_is_reached_or_said_to_be_missed() -> None:
    points = {"inputs": ["disks.d:y"], "outputs": ["disks.d:y"], "fmax": 300.0, "points": 60}
    reached = rg.frf(overhung_disk(), **points, modal_damping=0.001, accuracy=1e-5)
    assert reached.error_estimate <= 1e-5
    assert reached.status == "success"
    missed = rg.static(overhung_disk(), accuracy=1e-11)
    assert missed.status == "success"


def test_a_missed_accuracy_is_a_warning_and_a_status(monkeypatch: pytest.MonkeyPatch) -> None:
    # On every mesh the forces are half of those with elements cut in two.
    forces = cycle([np.array([2.0]), np.array([1.0])])
    monkeypatch.setattr("rotorgear.analysis.static.static.forces_of", lambda equilibrium: next(forces))
    result = rg.static(overhung_disk(), accuracy=1e-3)
    assert result.status.startswith("accuracy 0.001 not reached: the error is estimated at 0.5")
    assert result.status in result.warnings


def test_the_command_writes_every_column_and_refuses_what_belongs_elsewhere(tmp_path: Path) -> None:
    file = str(ROOT / "models" / "backlash_pair.toml")
    target = tmp_path / "study.json"
    picture = tmp_path / "study.png"
    done = CliRunner().invoke(
        app, ["accuracy", file, "--analysis", "static", "--json", str(target), "--plot", str(picture)]
    )
    assert done.exit_code == 0, done.output
    rung = json.loads(target.read_text(encoding="utf-8"))["rungs"][0]
    assert {"seconds", "spread", "timed", "memory_bytes", "error", "estimate", "effectivity", "order", "notes"} <= set(
        rung
    )
    assert picture.stat().st_size > 10_000
    with pytest.raises(AnalysisError, match="--to belongs to --analysis campbell or critical, not to static"):
        rg.accuracy(overhung_disk(), "static", stop=100.0)
    with pytest.raises(AnalysisError, match="expected modal, campbell"):
        rg.accuracy(overhung_disk(), "dance")


def test_loads_inside_shafts_and_forces_of_rigid_bearings_have_their_error_against_run_time() -> None:
    bearing = {"stiffness": {"radial": 1e8, "axial": 1e8}, "damping": {"radial": 300.0}}
    rigid = {"stiffness": {"radial": "rigid", "axial": "rigid"}}
    points = {"b": {"shaft": "a", "at": 0.25, "quantity": "bending", "direction": "x"}}
    model = rotor(bearing, rigid, points=points)
    options: dict[str, Any] = {"elements": (1, 2, 4), "accuracies": (), "repeat": 0}
    static, response = (study_by_name(name)(model, **options) for name in ("static", "response"))
    assert isinstance(static, rg.ConvergenceStudy)
    assert isinstance(response, rg.ConvergenceStudy)
    for study in (static, response):
        assert "loads inside shafts" in study.compared
    assert max(rung.error for rung in static.rungs) < 1e-9
    assert "elements tell loads inside shafts" in response.text().replace("\n", " ")
    within(response, 0.3, 30.0)
    falls_with_order(response, 1.0)
