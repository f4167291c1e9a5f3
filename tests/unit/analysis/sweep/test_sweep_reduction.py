"""Sweeps of finite-element models: reduced systems against whole ones, other analyses and closed forms."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.common import pool
from rotorgear.analysis.sweep.classify import exponents
from rotorgear.analysis.sweep.point import Point, PointMaker, ready_reduced, table_of
from rotorgear.analysis.sweep.reduce import Large, Reducer, probes_for, rates
from rotorgear.errors import AnalysisError, RotorgearError
from rotorgear.forces.mesh_contact import MeshContact
from rotorgear.forces.rotating_force import RotatingForce
from rotorgear.model.model import Model
from rotorgear.solvers.batch.run_block import BatchPlan, Start, run_block
from rotorgear.solvers.batch.small_system import Still
from tests.models import pair_file, spur_pair
from tests.paths import ROOT
from tests.unit.analysis.sweep.test_sweep_laws import ROLLING

FLEXIBLE = ROOT / "models" / "flexible_pair.toml"
MESH = """stiffness = "8e8 N/m"
damping_ratio = 0.04
transmission_error = [{ harmonic = 1, amplitude = "4 um" }, { harmonic = 2, amplitude = "1 um" }]
stiffness_variation = [{ harmonic = 1, amplitude = 0.15 }]
backlash = "40 um"
[damping]
rayleigh_alpha = "100 1/s"
rayleigh_beta = "1 us"
"""


def pair(folder: Path, mesh: str = MESH, **options: Any) -> Model:
    path = folder / "pair.toml"
    path.write_text(pair_file(torque="300 N m", mesh=mesh, helix=15.0, kind="helical", **options), encoding="utf-8")
    return rg.load(path)


def large(model: Model, elements: int, modes: int | None = None) -> Large:
    point = PointMaker(modes, elements)(model)
    assert isinstance(point, Large)
    return point


def reduced_point(model: Model, elements: int, modes: int) -> Point:
    own = large(model, elements, 1)
    return next(ready_reduced([own], Reducer(modes=modes)([own], lambda size, error: None)))


def test_a_reduced_sweep_shows_the_motions_of_the_whole_one_with_and_without_contact(tmp_path: Path) -> None:
    # Between 2600 and 4400 rpm motions are quasi-periodic, or take so long to settle that their kind is chance.
    speeds = [800, 1400, 2000, 2600, 4400, 5000, 5600, 6200, 6800]
    model = pair(tmp_path)
    over = {"operation.speed": [f"{rpm} rpm" for rpm in speeds]}
    how: dict[str, Any] = {"discard": 120, "sample": 40, "elements": 1}
    whole = rg.sweep(model, over, **how)
    part = rg.sweep(model, over, modes=18, **how)
    assert whole.reduction is None
    assert part.reduction is not None
    assert (part.reduction.dofs, whole.dofs) == (36, 36)
    assert part.dofs == 21
    assert part.reduction.error < 0.05
    assert part.motion == whole.motion
    periodic = np.array([kind == "1T" for kind in whole.motion])
    assert np.sum(whole.apart[periodic, 0, 0] > 0.1) >= 2
    assert np.sum(whole.apart[periodic, 0, 0] == 0.0) >= 2
    for name in ("peak_to_peak", "largest_force", "rms_force"):
        assert getattr(part, name)[periodic] == pytest.approx(getattr(whole, name)[periodic], rel=0.03)
    assert part.static_force == pytest.approx(whole.static_force, rel=1e-10)


@pytest.mark.long  # five sweeps over two speeds
def test_more_modes_come_nearer_in_receptance_and_in_motion(tmp_path: Path) -> None:
    model = pair(tmp_path)
    over = {"operation.speed": ["2000 rpm", "7000 rpm"]}
    how: dict[str, Any] = {"discard": 200, "sample": 10, "exponents": 0, "steps": 1200, "elements": 1}
    whole = rg.sweep(model, over, **how).peak_to_peak
    found = [rg.sweep(model, over, modes=n, **how) for n in (4, 10, 20, 35)]
    stated = [result.reduction.error for result in found if result.reduction]
    true = [float(np.max(np.abs(result.peak_to_peak / whole - 1.0))) for result in found]
    assert stated == sorted(stated, reverse=True)
    assert stated[0] > 0.5
    assert stated[2] < 5e-3
    assert true[0] > 0.02
    assert true[2] < 5e-3
    # 35 elastic modes and the rotation are all there is.
    assert stated[3] < 1e-9
    assert true[3] < 1e-7


def test_a_large_model_agrees_with_its_own_transient_where_teeth_part() -> None:
    model = rg.load(FLEXIBLE)
    mesh = 23 * 8250 / 60.0
    swept = rg.sweep(model, {"operation.speed": ["8250 rpm"]}, discard=400, sample=40, exponents=0, elements=1)
    run = rg.transient(
        model,
        speed="8250 rpm",
        discard=400 / mesh,
        time=40 / mesh,
        steps=400,
        method="newmark",
        elements=1,
        error_estimate=False,
    )
    row = run.to_dict()["contacts"][0]
    assert swept.reduction is not None
    assert swept.reduction.dofs == 84 > swept.dofs
    assert swept.reduction.error <= 0.01
    assert row["apart_share"] > 0.2
    assert swept.apart[0, 0, 0] == pytest.approx(row["apart_share"], abs=0.01)
    assert swept.peak_to_peak_approach[0, 0, 0] == pytest.approx(row["peak_to_peak_approach_m"], rel=0.01)
    assert swept.largest_force[0, 0, 0] == pytest.approx(row["largest_force_n"], rel=0.01)
    assert swept.static_force[0, 0] == pytest.approx(row["static_force_n"], rel=1e-9)


@pytest.mark.parametrize("rpm", [2400.0, pytest.param(6000.0, marks=pytest.mark.long)])
def test_without_clearance_the_amplitude_is_that_of_the_harmonic_response(rpm: float) -> None:
    model = rg.load(FLEXIBLE)
    table = model.meshes["stage"].model_dump(mode="json", exclude_none=True)
    table.update(backlash=None, stiffness_variation=[], transmission_error=[{"harmonic": 1, "amplitude": "3 um"}])
    model = model.model_copy(update={"meshes": {"stage": type(model.meshes["stage"])(**table)}})
    swept = rg.sweep(model, {"operation.speed": [f"{rpm} rpm"]}, elements=6, discard=600, sample=5, exponents=0)
    forced = rg.response(model, speeds=[rpm * np.pi / 30.0], elements=6, method="direct")
    assert swept.reduction is not None
    assert swept.reduction.dofs > 400 > 100 > swept.dofs
    amplitude = float(np.abs(forced.mesh_force[0, 0, 0]))
    assert amplitude > 100.0
    assert swept.largest_force[0, 0, 0] - swept.mean_force[0, 0, 0] == pytest.approx(amplitude, rel=0.01)


def test_all_exponents_of_a_reduced_system_sum_up_to_its_trace(tmp_path: Path) -> None:
    mesh = 'stiffness = "8e8 N/m"\ndamping_ratio = 0.04\n[damping]\nrayleigh_alpha = "400 1/s"\n'
    point = reduced_point(pair(tmp_path, mesh), 3, 6)
    system = point.system
    assert len(system.rigid) == 1
    assert np.abs(system.rigid @ system.B).max() < 1e-12 * np.abs(system.B).max()
    own = 2 * (system.n - 1)
    assert own > 12
    plan = BatchPlan(600, 5, 40, own)
    orbit = run_block([system], [Start(system.rest, np.zeros(system.n))], [table_of(point, 600)], plan)[0]
    mean, _ = exponents(orbit.growth, 1.0)
    damping = system.D + (system.B * system.columns.damping) @ system.B.T
    left = np.eye(system.n) - system.rigid.T @ system.rigid
    assert mean.sum() == pytest.approx(-2.0 * np.pi * np.trace(left @ damping @ left), rel=1e-5)


def test_rigid_motions_stay_free_and_the_drive_turns_without_strain(tmp_path: Path) -> None:
    own = large(pair(tmp_path), 6)
    found = Reducer(0.01)([own], lambda size, error: None)[0]
    rest = next(ready_reduced([own], [found]))
    whole = own.local
    free = found[1].vectors @ np.linalg.solve(rest.system.root.T, rest.system.rigid.T)
    assert free.shape[1] == 1
    K = whole.stiffness_about
    assert np.abs(K @ free).max() < 1e-11 * (abs(K) @ np.abs(free)).max()


def test_continuation_goes_on_in_another_basis(tmp_path: Path) -> None:
    soft = large(pair(tmp_path), 4)
    stiff = large(pair(tmp_path, MESH.replace("8e8", "9e8")), 4)
    reducer = Reducer(0.001)
    first, second = (next(ready_reduced([own], reducer([own], lambda n, e: None))).system for own in (soft, stiff))
    start = Start(first.rest, 1e-3 * first.rest)
    moved = start.moved(first, second)
    assert second.B.T @ moved.z == pytest.approx(first.B.T @ start.z, rel=5e-3)
    back = moved.moved(second, first)
    assert first.B.T @ back.z == pytest.approx(first.B.T @ start.z, rel=5e-3)
    up = rg.sweep(
        pair(tmp_path),
        {"meshes.pair.stiffness": ["8e8 N/m", "9e8 N/m"]},
        direction="up",
        modes=9,
        discard=20,
        sample=20,
        exponents=0,
    )
    assert up.reduction is not None
    assert up.reduction.bases == 2
    assert "failed" not in up.motion


def test_points_that_differ_in_speed_and_torque_share_a_basis_and_results_do_not_depend_on_workers() -> None:
    over = {"operation.speed": ["5000 rpm", "6000 rpm"], "operation.torque": ["40 N m", "80 N m"]}
    how: dict[str, Any] = {"discard": 20, "sample": 20}
    one, two = (rg.sweep(rg.load(FLEXIBLE), over, workers=n, **how) for n in (1, 2))
    assert one.reduction is not None
    assert one.reduction.bases == 1
    assert np.array_equal(one.section, two.section)
    assert np.array_equal(one.lyapunov, two.lyapunov)


def test_small_models_are_left_as_they_are() -> None:
    result = rg.sweep(
        rg.load(ROOT / "models" / "backlash_pair.toml"), {"operation.speed": ["8000 rpm"]}, discard=5, sample=5
    )
    assert result.reduction is None
    assert result.dofs == 2


def test_no_basis_is_refused_and_a_number_by_hand_is_warned_of() -> None:
    model = rg.load(FLEXIBLE)
    over = {"operation.speed": ["8000 rpm"]}
    with pytest.raises(RotorgearError, match=r"444 dofs can't be reduced: with 160 coordinates .* lower the speed"):
        rg.sweep(model, over, elements=6, reduction_error=1e-12, discard=1, sample=1)
    few = rg.sweep(model, over, modes=3, discard=5, sample=5)
    assert any("ask for more modes" in text for text in few.warnings)
    bads: list[dict[str, Any]] = [{"modes": 0}, {"modes": 1000}, {"reduction_error": 0.0}, {"elements": 0}]
    for bad in bads:
        with pytest.raises(AnalysisError, match=next(iter(bad))):
            rg.sweep(model, over, **bad)


def test_a_dof_without_inertia_is_reduced_away(tmp_path: Path) -> None:
    own = large(pair(tmp_path), 1, 1)
    M = own.local.M.tolil()
    last = own.local.n - 1
    M[last, :] = 0.0
    M[:, last] = 0.0
    light = replace(own, local=replace(own.local, M=M.tocsc()))
    with pytest.raises(AnalysisError, match="no inertia"):
        Still(light.local, None)  # type: ignore[arg-type]
    found = Reducer(0.01)([light], lambda size, error: None)[0]
    assert found[0].n < own.local.n
    assert next(ready_reduced([light], [found])).static_force == pytest.approx(
        next(ready_reduced([own], [found])).static_force, rel=1e-6
    )


def test_probes_hold_the_harmonics_of_all_meshes_up_to_the_highest_tabulated() -> None:
    parting = MeshContact(1.0, backlash=1.0, order=2.0, error_cos=(0.1,))
    tied = MeshContact(1.0, gap="bilateral", order=3.0, error_cos=(0.1, 0.0, 0.0, 0.2))
    pieces = tuple((i / 8, float(np.cos(np.pi * i / 4)), float(np.cos(np.pi * (i + 1) / 4))) for i in range(8))
    shaken = MeshContact(1.0, gap="bilateral", order=1.0, impact=1.0, impact_share=0.15)
    assert [law.repeats()[0].harmonics for law in (parting, tied, shaken)] == [3, 4, 7]
    assert replace(tied, error_cos=(), pieces=pieces).repeats()[0].harmonics == 1
    unbalance = RotatingForce(1.0, 1.0, plane=True)
    assert rates([parting, unbalance], -10.0) == pytest.approx([10.0, 20.0, 40.0, 60.0])
    probes = probes_for([parting], [5.0, 10.0], np.array([0.0, 33.0, 70.0]), damping=0.01)
    at = {(speed, round(float(w), 6)) for speed, w in zip(probes.speed, probes.s.imag, strict=True)}
    assert {(5.0, 10.0), (5.0, 30.0), (10.0, 60.0), (10.0, 33.0)} <= at
    assert (10.0, 70.0) not in at
    assert probes.s.real == pytest.approx(0.015 * probes.s.imag)


@pytest.mark.parametrize(
    "changes",
    [
        pytest.param({"bearings__a__rolling": ROLLING, "bearings__b__rolling": ROLLING}, marks=pytest.mark.long),
        pytest.param({"meshes__pair__friction_coefficient": 0.06}, marks=pytest.mark.long),
    ],
    ids=["rolling", "friction"],
)
def test_bearings_with_rolling_elements_and_friction_act_in_a_reduced_system(changes: dict[str, Any]) -> None:
    model = spur_pair(meshes__pair__backlash="50 um", **changes)
    over = {"operation.speed": ["3000 rpm"]}
    how: dict[str, Any] = {"discard": 15, "sample": 5, "exponents": 0}
    whole = rg.sweep(model, over, **how)
    part = rg.sweep(model, over, modes=10, **how)
    assert part.dofs < whole.dofs
    for name in ("peak_to_peak", "largest_force", "rms_force"):
        assert getattr(part, name)[0, 0] == pytest.approx(getattr(whole, name)[0, 0], rel=2e-3)


def test_a_long_block_tells_how_far_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pool, "_EVERY", 1e-3)
    told: list[tuple[float, str]] = []
    rg.sweep(
        rg.load(ROOT / "models" / "backlash_pair.toml"),
        {"operation.speed": ["6000 rpm"]},
        discard=1200,
        sample=10,
        progress=lambda share, text: told.append((share, text)),
    )
    inside = [share for share, text in told if text.startswith("about")]
    assert any(0.15 < share < 1.0 for share in inside)
    assert inside == sorted(inside)


def test_a_basis_tells_how_far_it_is() -> None:
    told: list[str] = []
    rg.sweep(
        rg.load(FLEXIBLE),
        {"operation.speed": ["6000 rpm"]},
        discard=1,
        sample=1,
        progress=lambda _, text: told.append(text),
    )
    assert sum("coordinates" in text for text in told) > 5
