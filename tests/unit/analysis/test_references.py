"""References of studies are another method: continuous shafts against closed forms, counts, and what was missed or stopped."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from typer.testing import CliRunner

import rotorgear as rg
from rotorgear.analysis.accuracy import study_by_name
from rotorgear.analysis.common.study import Judged, Setting, Study
from rotorgear.analysis.studies import meshes
from rotorgear.analysis.studies.continuum import Continuum, piece_stiffness
from rotorgear.cli.main import app
from rotorgear.elements.shaft import shaft_elements
from rotorgear.elements.shaft_section import ShaftElements
from rotorgear.errors import ConvergenceError, Interrupted
from rotorgear.model.parts.operation import ModelDamping
from rotorgear.system.system import flow_system
from tests.overhung import overhung_disk
from tests.unit.analysis.impact_oscillator import ImpactOscillator

SHORT: dict[str, Any] = {"elements": (2, 4), "accuracies": (1e-3,), "repeat": 0}
E, NU, RHO, KAPPA = 2.1e11, 0.3, 7850.0, 0.85
G = E / (2.0 * (1.0 + NU))


def piece(length: float, left: tuple[float, float], right: tuple[float, float]) -> ShaftElements:
    diameters = np.array([[*left, *right]])
    one = np.ones(1)
    return ShaftElements(length * one, diameters, diameters, E * one, G * one, NU * one, RHO * one, KAPPA * one)


def test_a_pinned_piece_has_the_frequencies_of_timoshenkos_equation() -> None:
    L, d = 0.7, 0.11
    A, second = np.pi / 4.0 * d**2, np.pi / 64.0 * d**4
    for n in (1, 2, 3):
        k = n * np.pi / L
        # EI k^4 - w^2 (rho A + rho I k^2 + rho EI k^2 / kappa G) + w^4 rho^2 I / (kappa G) = 0
        terms = [
            RHO**2 * second / (KAPPA * G),
            -(RHO * A + RHO * second * k**2 * (1.0 + E / (KAPPA * G))),
            E * second * k**4,
        ]
        w = np.sqrt(np.roots(terms).min())
        D = piece_stiffness(piece(L, (d, 0.0), (d, 0.0)), 1j * w, 0.0, ModelDamping(), 0.0)[0].real
        free = [3, 9]  # slopes in the plane yz, deflections held
        scaled = D[np.ix_(free, free)] / D[3, 3]
        assert abs(np.linalg.det(scaled)) < 1e-9


def test_a_cone_at_rest_has_the_stiffness_of_the_element_that_is_exact_in_statics() -> None:
    data = piece(0.3, (0.12, 0.02), (0.05, 0.03))
    found = piece_stiffness(data, 0.0, 0.0, ModelDamping(), 0.0)[0]
    exact = shaft_elements(data).stiffness[0]
    size = np.sqrt(np.outer(np.diag(exact), np.diag(exact)))
    assert np.abs(found - exact).max() / size.max() < 1e-9
    assert np.max(np.abs(found - exact) / size) < 1e-8


def test_a_turning_damped_cone_is_that_of_integrated_equations() -> None:
    data = piece(0.3, (0.12, 0.02), (0.05, 0.03))
    s, spin, eta = -40.0 + 9000.0j, 1500.0, 3e-6
    D = piece_stiffness(data, s, spin, ModelDamping(rayleigh_alpha=20.0, rayleigh_beta=1e-6), eta)[0]
    loss = 1.0 + 1e-6 * s + eta * (s - 1j * spin)

    def slopes(z: float, y: np.ndarray) -> np.ndarray:
        outer, inner = 0.12 - 0.07 * z / 0.3, 0.02 + 0.01 * z / 0.3
        A, second = np.pi / 4.0 * (outer**2 - inner**2), np.pi / 64.0 * (outer**4 - inner**4)
        w, slope, V, M = y
        square = s**2 + 20.0 * s
        tilting = square - 2j * spin * s
        return np.array(
            [
                slope + V / (KAPPA * G * A * loss),
                M / (E * second * loss),
                RHO * A * square * w,
                -V + RHO * second * tilting * slope,
            ]
        )

    start = np.array([1.0e-3, -2.0e-3, 4.0e5, 3.0e4], complex)
    end = solve_ivp(slopes, (0.0, 0.3), start, method="DOP853", rtol=1e-12, atol=1e-14).y[:, -1]
    # Circular motion x + iy: x = u, y = -i u / 1 ... of amplitude (1, -i)/2 in the plane; theta_y = slope_x, theta_x = -slope_y.
    q = np.zeros(12, complex)
    for at, (w, slope) in ((0, start[:2]), (6, end[:2])):
        q[at : at + 2] = 0.5 * w, -0.5j * w
        q[at + 3 : at + 5] = 0.5j * slope, 0.5 * slope
    f = D @ q
    assert 2.0 * f[0] == pytest.approx(-start[2], rel=1e-7)
    assert 2.0 * f[4] == pytest.approx(-start[3], rel=1e-7)
    assert 2.0 * f[6] == pytest.approx(end[2], rel=1e-7)
    assert 2.0 * f[10] == pytest.approx(end[3], rel=1e-7)


def test_modes_are_counted_by_the_signs_of_the_dynamic_stiffness() -> None:
    model = overhung_disk()
    found = rg.modal(model, modes=10, accuracy=1e-8)
    w = np.sort(np.abs(found.eigenvalues))
    for k in np.flatnonzero(np.diff(w) > 1e-3 * w[1:]):
        assert Continuum(flow_system(model), None, w[-1]).count_below(0.5 * (w[k] + w[k + 1])) == k + 1


def test_a_cross_coupled_bearing_at_standstill_is_that_of_the_model() -> None:
    cross = np.diag([4e7, 4e7, 1e7, 0.0, 0.0, 0.0])
    cross[0, 1], cross[1, 0] = 2e7, -1e7
    model = overhung_disk().with_("bearings.b.stiffness", {"matrix": cross.tolist()})
    study = study_by_name("modal")(model, modes=8, **SHORT | {"elements": (4, 8)})
    assert "exact dynamic stiffness" in study.reference
    assert "finest mesh's word" in study.reference  # counts need a symmetric stiffness
    assert np.any(np.abs(rg.modal(model, modes=8).eigenvalues.real) > 1.0)
    assert all(rung.effectivity is not None and 0.9 < rung.effectivity < 1.1 for rung in study.rungs), study.text()


def test_a_root_of_another_mode_is_not_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    model = overhung_disk()
    s = rg.modal(model, modes=10, accuracy=1e-8).eigenvalues[-3:]
    exact = Continuum(flow_system(model), None, abs(s[-1]))
    assert exact.roots(s) == pytest.approx(s, rel=1e-6)
    with pytest.raises(ConvergenceError, match="is that of another mode"):
        exact.roots(np.array([s[0], 1.001 * s[0]]))
    monkeypatch.setattr(Continuum, "root", lambda self, s: 1.5j)
    study = study_by_name("modal")(model, modes=6, **SHORT)
    assert study.reference.startswith("the same elements, refined to 1e-10")


@pytest.mark.parametrize("analysis", ["state-space", pytest.param("campbell", marks=pytest.mark.long)])
def test_state_spaces_and_branches_are_compared_with_continuous_shafts(analysis: str) -> None:
    more = {"modes": 5} if analysis == "campbell" else {"speed": 700.0}
    study = study_by_name(analysis)(overhung_disk(), **SHORT, **more)
    assert "exact dynamic stiffness" in study.reference
    ratios = [rung.effectivity for rung in study.rungs]
    assert all(ratio is not None and 0.5 < ratio < 3.0 for ratio in ratios), study.text()


@pytest.mark.parametrize("analysis", ["modal", "critical", "frf", "response"])
def test_no_mesh_of_elements_is_the_reference(analysis: str) -> None:
    study = study_by_name(analysis)(overhung_disk(), **SHORT)
    assert "exact dynamic stiffness" in study.reference
    ratios = [rung.effectivity for rung in study.rungs if np.isfinite(rung.estimate)]
    assert len(ratios) >= 2
    assert all(ratio is not None and 0.9 < ratio < 1.1 for ratio in ratios), study.text()


def test_a_critical_speed_that_a_coarse_mesh_misses_has_an_infinite_error() -> None:
    model = overhung_disk()
    highest = rg.critical(model, accuracy=1e-9).speeds[-1].speed
    coarse = rg.critical(model, elements=1).speeds[-1].speed
    assert coarse > highest
    study = study_by_name("critical")(model, stop=0.5 * (coarse + highest), elements=(1, 8), accuracies=(), repeat=0)
    missed, fine = study.rungs
    assert missed.error == float("inf")
    assert any(note.startswith("1 missed") for note in missed.notes)
    assert fine.error < 1e-4


def test_a_point_of_a_sweep_is_compared_with_shooting_by_all_its_statistics() -> None:
    case = ImpactOscillator(W=0.7, ripple=1.4, z=0.05)
    study = rg.sweep_convergence_study(case.model(), speed=case.speed(case.W), steps=(50, 100), counts=(20,), starts=3)
    assert study.reference.startswith("shooting")
    ratios = [rung.effectivity for rung in study.rungs]
    assert all(ratio is not None and 0.3 < ratio < 5.0 for ratio in ratios), study.text()
    assert study.rungs[1].error < 0.5 * study.rungs[0].error


def test_rows_that_were_done_outlive_an_interrupt(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def run(options: dict[str, Any]) -> int:
        if options["n"] == 3:
            raise KeyboardInterrupt
        return int(options["n"])

    settings = [Setting(f"n {n}", "elements", float(n), {"n": n}) for n in (1, 2, 3, 4)]
    study = Study(settings, run=run, judge=lambda n: Judged(n, np.ones(1), np.ones(1)), resolution=1e-9)
    with pytest.raises(Interrupted) as caught:
        study.result("modal", overhung_disk(), 1, lambda fraction, step: None)
    assert [rung.method for rung in caught.value.result.rungs] == ["n 1", "n 2"]

    given = meshes.modal

    def modal(model: rg.Model, **options: Any) -> rg.ModalResult:
        if options.get("elements") == 4:
            raise KeyboardInterrupt
        return given(model, **options)

    monkeypatch.setattr(meshes, "modal", modal)
    file = tmp_path / "study.json"
    done = CliRunner().invoke(app, ["accuracy", "models/jeffcott.toml", "--modes", "4", "--json", str(file)])
    assert done.exit_code == 130
    assert "interrupted after 2 of" in done.stdout
    kept = json.loads(file.read_text())
    assert len(kept["rungs"]) == 2
    assert kept["status"].startswith("interrupted")
    assert "2 basic elements" in done.stderr


def test_short_runs_are_repeated_and_the_row_shows_their_range() -> None:
    study = rg.convergence_study(overhung_disk(), modes=4, elements=(2,), accuracies=())
    (rung,) = study.rungs
    assert rung.timed >= 3
    assert 0.0 < rung.seconds_least <= rung.seconds <= rung.seconds_most
    assert f"{rung.seconds_least:.2g}-{rung.seconds_most:.2g}" in study.text()
