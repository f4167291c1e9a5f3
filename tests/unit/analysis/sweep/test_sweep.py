"""Sweeps: the kernel against other integrators, exponents against closed forms, the verb against the transient."""

from __future__ import annotations

from dataclasses import fields
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.sweep.axes import along, axis_of, number_places, points_of
from rotorgear.analysis.sweep.blocks import waves
from rotorgear.analysis.sweep.classify import classify, exponents, period_of
from rotorgear.analysis.sweep.gather import notes
from rotorgear.analysis.sweep.point import at_rest, common_period, ready, table_of
from rotorgear.errors import AnalysisError
from rotorgear.forces.mesh_contact import MeshContact
from rotorgear.solvers.batch.run_block import BatchPlan, Start, run_block
from rotorgear.solvers.batch.small_system import SmallSystem
from tests.paths import ROOT
from validation.benchmarks.sweep_speed import apart
from validation.oscillators import integrate, local_system

PAIR = ROOT / "models" / "backlash_pair.toml"
SHORT: dict[str, Any] = {"discard": 40, "sample": 40}
# Fields that tell the cost of a run, not its outcome.
# What it cost, and the arguments it was asked with: the number of workers is one.
COST = ("seconds", "settings")


def same(a: rg.SweepResult, b: rg.SweepResult) -> bool:
    """Whether two results are the same to the last bit but for their cost."""

    def equal(x: Any, y: Any) -> bool:
        return bool(np.array_equal(x, y, equal_nan=True)) if isinstance(x, np.ndarray) else x == y

    return all(equal(getattr(a, f.name), getattr(b, f.name)) for f in fields(a) if f.name not in COST)


@pytest.mark.parametrize("sizes", [(7, 4), (3, 2)])
def test_lanes_agree_with_a_scalar_kernel_to_rounding(sizes: tuple[int, int]) -> None:
    assert apart(*sizes, periods=20) < 1e-11


@pytest.mark.parametrize(
    "law",
    [
        MeshContact(1.0, 0.05, 0.0, gap="bilateral", order=1.0, stiffness_cos=(0.2, 0.05), error_sin=(0.1,)),
        MeshContact(1.0, 0.0, 0.5, order=1.0, phase=0.4, stiffness_cos=(0.2,), error_cos=(0.3,)),
        MeshContact(1.0, 0.05, 0.5, contact_damping="penetration", ramp=0.1, order=1.0, error_cos=(0.3,)),
        MeshContact(1.0, 0.05, 0.5, ramp=0.05, order=1.0, error_cos=(0.3,), impact=0.2, impact_share=0.5),
        MeshContact(1.0, 0.05, gap="unilateral", ramp=0.05, order=1.0, error_cos=(0.3,)),
    ],
    ids=["never parts", "undamped", "penetration", "non-adhesive with impact", "unilateral"],
)
def test_the_kernel_follows_newmark_in_small_steps(law: MeshContact) -> None:
    speed = 0.9
    n = 3
    K = np.diag([0.4, 0.3, 0.5])
    M = np.array([[1.0, 0.1, 0.0], [0.1, 2.0, 0.0], [0.0, 0.0, 1.5]])
    local = local_system(M, 0.05 * M, K, [0.1, -0.05, 0.0], [(law, [[1.0], [-1.0], [0.2]])], speed=speed)
    point = ready(at_rest(local, [Fraction(1)], ("m",)), speed)
    steps = 800
    periods = 6
    start = Start(point.system.rest, np.zeros(n))
    orbit = run_block([point.system], [start], [table_of(point, steps)], BatchPlan(steps, 0, periods, 0))[0]
    fine = 4000
    q0 = np.linalg.solve(point.system.root.T, start.z)
    motion = integrate(local, "average acceleration", 2.0 * np.pi / speed / fine, fine * periods, q0, np.zeros(n), fine)
    d = motion.q @ local.B.toarray()[:, 0]
    v = motion.v @ local.B.toarray()[:, 0]
    tolerance = 5e-6 if law.gap == "bilateral" else 2e-4
    assert orbit.section[:, 0, 0] == pytest.approx(d[1:], abs=tolerance * np.abs(d).max())
    assert orbit.section[:, 0, 1] == pytest.approx(v[1:], abs=5.0 * tolerance * np.abs(v).max())


def test_the_method_is_of_order_four_where_teeth_do_not_part() -> None:
    law = MeshContact(1.0, 0.05, gap="bilateral", order=1.0, stiffness_cos=(0.2,), error_sin=(0.1,))
    local = local_system(np.eye(1), [[0.05]], [[0.4]], [0.1], [(law, [[1.0]])], speed=0.9)
    point = ready(at_rest(local, [Fraction(1)], ("m",)), 0.9)

    def end(steps: int) -> float:
        start = Start(np.zeros(1), np.zeros(1))
        return float(
            run_block([point.system], [start], [table_of(point, steps)], BatchPlan(steps, 0, 3, 0))[0].end.z[0]
        )

    errors = [abs(end(steps) - end(1280)) for steps in (20, 40, 80)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4.0, abs=0.3)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(4.0, abs=0.3)


def damped_chain(rigid: bool) -> SmallSystem:
    law = MeshContact(1.0, gap="bilateral", order=1.0)
    K = [[0.3, -0.3], [-0.3, 0.3]] if rigid else [[0.5, -0.3], [-0.3, 0.9]]
    local = local_system(
        np.diag([1.0, 3.0]), 0.04 * np.diag([1.0, 3.0]), K, [0.1, -0.1], [(law, [[1.0], [-1.0]])], speed=0.8
    )
    return ready(at_rest(local, [Fraction(1)], ("m",)), 0.8).system


@pytest.mark.parametrize("rigid", [False, True])
def test_all_exponents_sum_up_to_the_trace_and_a_rigid_motion_is_left_out(rigid: bool) -> None:
    system = damped_chain(rigid)
    assert len(system.rigid) == int(rigid)
    own = 2 * (2 - len(system.rigid))
    table = np.zeros((2 * 100 + 1, 1, 4))
    table[:, :, 0] = 1.0
    plan = BatchPlan(100, 40, 400, own)
    orbit = run_block([system], [Start(np.zeros(2), np.array([0.1, 0.0]))], [table], plan)[0]
    mean, _ = exponents(orbit.growth, 2.0 * np.pi / 0.8)
    # Damping in proportion to the mass: each mode decays at half its ratio, 0.02.
    assert mean == pytest.approx(np.full(own, -0.02), abs=2e-4)
    assert mean.sum() == pytest.approx(-0.04 * own / 2.0, rel=1e-5)


def test_statistics_of_a_sweep_are_those_of_the_transient() -> None:
    model = rg.load(PAIR)
    swept = rg.sweep(model, {"operation.speed": ["8000 rpm"]}, discard=300, sample=40, steps=400)
    mesh = 40 * 8000 / 60.0
    run = rg.transient(
        model, speed="8000 rpm", discard=300 / mesh, time=40 / mesh, steps=800, method="newmark", error_estimate=False
    )
    row = run.to_dict()["contacts"][0]
    assert swept.motion == ("1T",)
    assert swept.largest_force[0, 0, 0] == pytest.approx(row["largest_force_n"], rel=2e-3)
    assert swept.peak_to_peak_approach[0, 0, 0] == pytest.approx(row["peak_to_peak_approach_m"], rel=2e-3)
    assert swept.mean_force[0, 0, 0] == pytest.approx(row["mean_force_n"], rel=5e-3)
    assert swept.rms_force[0, 0, 0] == pytest.approx(row["rms_force_n"], rel=5e-3)
    assert swept.apart[0, 0, 0] == pytest.approx(row["apart_share"], abs=5e-3)
    assert swept.static_force[0, 0] == pytest.approx(row["static_force_n"])
    # Periodic: what goes in comes out, so the mean force is the static one.
    assert swept.mean_force[0, 0, 0] == pytest.approx(swept.static_force[0, 0], rel=2e-4)


def test_the_pair_goes_from_one_period_to_two_and_chaos() -> None:
    result = rg.sweep(
        rg.load(PAIR), {"operation.speed": "2600 rpm,3300 rpm,3500 rpm,3900 rpm,4000 rpm"}, discard=1000, sample=200
    )
    assert result.motion == ("1T", "2T", "4T", "chaotic", "chaotic")
    assert np.all(result.lyapunov[:3, 0, 0] < -0.03)
    assert np.all(result.lyapunov[3:, 0, 0] > 0.2)
    assert np.all(result.driving + result.apart + result.back == pytest.approx(1.0))
    assert [kind for kind, _, _ in result.route()] == ["1T", "2T", "4T", "chaotic"]


def test_workers_do_not_change_the_result_and_an_interrupted_sweep_ends_the_same(tmp_path: Path) -> None:
    model = rg.load(PAIR)
    over = {"operation.speed": "3000 rpm:9000 rpm:70"}
    whole = rg.sweep(model, over, workers=1, **SHORT)
    assert same(whole, rg.sweep(model, over, workers=3, **SHORT))

    def stop_late(fraction: float, text: str) -> None:
        if "runs" in text:
            raise KeyboardInterrupt

    path = tmp_path / "sweep.h5"
    with pytest.raises(KeyboardInterrupt):
        rg.sweep(model, over, stream=rg.stream(path), progress=stop_late, **SHORT)
    assert len(list(Path(f"{path}.parts").glob("chunk_*.h5"))) == 1
    resumed = rg.sweep(model, over, stream=rg.stream(path, resume=True), **SHORT)
    assert same(whole, resumed)
    rg.save(resumed, path)
    assert same(whole, rg.read(path))
    with pytest.raises(rg.RotorgearError, match="other settings"):
        rg.sweep(model, over, stream=rg.stream(path, resume=True), discard=40, sample=41)


def test_up_and_down_keep_their_own_attractor_and_resume_too(tmp_path: Path) -> None:
    over = {"operation.speed": "5000 rpm:9000 rpm:9"}
    both = rg.sweep(rg.load(PAIR), over, direction="both", discard=100, sample=40)
    assert both.run == ("up", "down")
    kinds = np.array(both.motion).reshape(9, 2)
    assert any(up != down for up, down in kinds)  # two attractors side by side
    path = tmp_path / "both.h5"
    calls = []

    def stop_late(fraction: float, text: str) -> None:
        calls.append(text)
        if sum("runs" in call for call in calls) == 4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        rg.sweep(
            rg.load(PAIR), over, direction="both", discard=100, sample=40, stream=rg.stream(path), progress=stop_late
        )
    again = rg.sweep(rg.load(PAIR), over, direction="both", discard=100, sample=40, stream=rg.stream(path, resume=True))
    assert same(both, again)


def test_many_starts_show_coexisting_motions() -> None:
    result = rg.sweep(rg.load(PAIR), {"operation.speed": ["8000 rpm"]}, initial_conditions=24, discard=400, sample=60)
    assert result.run[:2] == ("static", "start 2")
    sizes = result.peak_to_peak[0, :, 0]
    assert sizes.max() > 2.0 * sizes.min()


@pytest.mark.parametrize(
    ("motion", "told"),
    [
        (["chaotic", "1T"], True),
        (["2T", "chaotic"], True),
        (["chaotic", "quasi-periodic"], False),
        (["1T", "2T"], False),
        (["chaotic", "not settled"], False),
        (["chaotic", "chaotic"], False),
    ],
)
def test_chaos_beside_a_response_that_repeats_may_be_a_transient(motion: list[str], *, told: bool) -> None:
    warnings = list(notes((), [None], [""], motion, 100, {}))
    assert any("long transient" in text for text in warnings) == told
    assert any("coexist" in text for text in warnings) == (len(set(motion) - {"not settled"}) > 1)


def test_two_parameters_and_points_that_fail_stay_in_their_places() -> None:
    over = {"meshes.pair.backlash": ["20 um", "40 um"], "operation.speed": ["8000 rpm", "0 rpm", "9000 rpm"]}
    result = rg.sweep(rg.load(PAIR), over, **SHORT)
    assert result.values.shape == (6, 2)
    assert result.shape.tolist() == [2, 3]
    assert [bool(reason) for reason in result.failure] == [False, True, False] * 2
    assert result.motion[1] == "failed"
    assert np.isnan(result.lyapunov[1]).all()
    assert np.isfinite(result.lyapunov[0]).all()
    assert result.to_dict()["points"][1]["runs"][0]["lyapunov"] == [None]
    assert any("2 of 6 points failed" in note for note in result.warnings)


def test_harmonics_of_each_point_have_their_own_tables() -> None:
    over = {"meshes.pair.transmission_error.0.amplitude": ["1 um", "3 um"]}
    two = rg.sweep(rg.load(PAIR), over, **SHORT)
    alone = rg.sweep(rg.load(PAIR), {"meshes.pair.transmission_error.0.amplitude": ["1 um"]}, **SHORT)
    assert two.peak_to_peak[0] == pytest.approx(alone.peak_to_peak[0], rel=1e-9)
    assert two.peak_to_peak[1] > 1.2 * two.peak_to_peak[0]


def test_a_change_of_ones_own_takes_the_place_of_addresses() -> None:
    def change(model: rg.Model, values: tuple[float, ...]) -> rg.Model:
        return model.model_copy(update={"operation": model.operation.model_copy(update={"torque": 10.0 * values[0]})})

    model = rg.load(PAIR)
    found = rg.sweep(model, {"load ratio": [1.0, 2.0]}, change=change, **SHORT)
    given = rg.sweep(model, {"operation.torque": [10.0, 20.0]}, **SHORT)
    assert np.array_equal(found.section, given.section)


def test_exponents_of_a_known_growth_and_their_error() -> None:
    draw = np.random.default_rng(5)
    growth = 0.3 + draw.standard_normal((4000, 1))
    mean, error = exponents(growth, 2.0)
    assert mean[0] == pytest.approx(0.15, abs=4.0 * error[0])
    assert error[0] == pytest.approx(0.5 / np.sqrt(4000), rel=0.6)


def test_kinds_of_motion_by_the_stated_criterion() -> None:
    k = np.arange(240)
    extent = np.array([2e-6])
    one = np.full((240, 1), 3e-6)
    two = (3e-6 + 1e-6 * (k % 2))[:, None]
    torus = 1e-6 * np.cos(2.0 * np.pi * 0.381966 * k)[:, None]
    assert classify(one, extent, -0.1, 0.01) == "1T"
    assert classify(two, extent, -0.1, 0.01) == "2T"
    assert classify(torus, extent, 0.001, 0.01) == "quasi-periodic"
    assert classify(torus, extent, 0.5, 0.01) == "chaotic"
    assert classify(torus, extent, 0.5, 0.4) == "chaotic"
    assert classify(one, extent, 0.5, 0.4) == "1T"
    assert classify(torus, extent, 0.5, 0.6) == "not settled"
    assert classify(torus * np.exp(-k / 50.0)[:, None], extent, -0.01, 0.01) == "not settled"
    assert classify(torus, extent, None, 0.0) == "not periodic"
    assert {classify(torus[:1], extent, exponent, 0.01) for exponent in (-0.1, 0.0)} == {"not settled"}
    assert period_of(np.tile(torus[:7], (20, 1)), extent) == 7


def test_a_rotor_without_anything_nonlinear_is_refused_with_the_commands_for_it() -> None:
    unbalance = {"unbalances.u": {"shaft": "rotor", "at": "start", "magnitude": 1e-5}}
    rotor = rg.load(PAIR.parent / "jeffcott.toml").with_(unbalance)
    with pytest.raises(
        rg.AnalysisError, match=r"nothing in the model is nonlinear .*rotorgear response .*rotorgear transient"
    ):
        rg.sweep(rotor, {"operation.speed": ["3000 rpm"]}, **SHORT)


def test_the_common_period_of_several_meshes() -> None:
    assert common_period([Fraction(8), Fraction(3)]) == (Fraction(8), 8)
    assert common_period([Fraction(29), Fraction(29 * 26, 113)]) == (Fraction(29), 113)
    with pytest.raises(AnalysisError, match="nothing repeats"):
        common_period([])
    with pytest.raises(AnalysisError, match="common factors"):
        common_period([Fraction(1009), Fraction(1009 * 997, 1013)])


def test_waves_go_along_the_first_parameter() -> None:
    up = waves([3, 2], ("up", "down"), 1)
    assert [len(jobs) for jobs in up] == [4, 4, 4]
    assert [(job.point, job.run, job.after) for job in up[1]] == [(2, 0, 0), (3, 0, 1), (2, 1, 4), (3, 1, 5)]


@pytest.mark.parametrize(
    ("text", "values", "unit"),
    [
        ("1 rpm:3 rpm:3", (1.0, 2.0, 3.0), "rpm"),
        ("1:3 rpm:2", (1.0, 3.0), "rpm"),
        ("1e-3, 2e-3", (1e-3, 2e-3), ""),
    ],
)
def test_axes_are_read(text: str, values: tuple[float, ...], unit: str) -> None:
    axis = axis_of("operation.speed", text)
    assert (axis.values, axis.unit) == (values, unit)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("1:2", "FROM:TO:COUNT"),
        ("1 rpm:2 rad/s:3", "expected one"),
        ("fast", "a number with its unit"),
    ],
)
def test_mistakes_in_axes_are_named(text: str, words: str) -> None:
    with pytest.raises(AnalysisError, match=words):
        axis_of("operation.speed", text)


def test_addresses_lead_to_numbers_with_stars_and_places() -> None:
    data = {"meshes": {"a": {"k": 1.0, "e": [{"amplitude": 2.0}]}, "b": {"k": 1.0, "e": []}}}
    assert number_places(data, "meshes.*.k") == [("meshes", "a", "k"), ("meshes", "b", "k")]
    assert number_places(data, "meshes.a.e.0.amplitude") == [("meshes", "a", "e", 0, "amplitude")]
    for address, words in (
        ("mesh.a.k", "did you mean 'meshes'"),
        ("meshes.a.e.1.amplitude", "no place in a list"),
        ("meshes.a", "table"),
        ("meshes.a.k.x", "below a number"),
    ):
        with pytest.raises(AnalysisError, match=words):
            number_places(data, address)


def test_what_sweeps_do_not_take_is_refused_in_a_sentence() -> None:
    with pytest.raises(rg.RotorgearError, match="the meshes repeat after 113: leave these out"):
        rg.sweep(rg.load(ROOT / "models" / "split_torque.toml"), {"operation.speed": ["16350 rpm"]})
    model = rg.load(PAIR)
    with pytest.raises(rg.RotorgearError, match="unknown key"):
        rg.sweep(model, {"operation.sped": [1.0]})
    with pytest.raises(rg.RotorgearError, match="8 steps are unstable"):
        rg.sweep(model, {"operation.speed": ["600 rpm"]}, steps=8)
    with pytest.raises(AnalysisError, match="one or two"):
        points_of([axis_of("a", [1.0])] * 3)
    with pytest.raises(AnalysisError, match="direction"):
        rg.sweep(model, {"operation.speed": ["6000 rpm"]}, direction="sideways")


def test_the_family_of_a_model_keeps_everything_else() -> None:
    model = rg.load(PAIR)
    other = along(model, [axis_of("meshes.pair.backlash", ["20 um"])])(model, (20.0,))
    assert other.meshes["pair"].backlash == pytest.approx(20e-6)
    assert other.gears == model.gears


def test_the_pair_turns_backwards_as_it_does_forwards() -> None:
    result = rg.sweep(rg.load(PAIR), {"operation.speed": ["8000 rpm", "-8000 rpm"]}, **SHORT)
    assert result.section[1] == pytest.approx(result.section[0], rel=1e-6, abs=1e-12)


TWO_STAGES = """
schema_version = 1
motions = ["torsion"]
operation = { input_shaft = "a", output_shaft = "c", speed = "4000 rpm", torque = "12 N m" }
[shafts.a]
position = ["0 m", "0 m"]
[shafts.b]
position = ["87 mm", "0 m"]
[shafts.c]
position = ["87 mm", "96 mm"]
start = "100 mm"
[gears.g1]
shaft = "a"
at = "start"
kind = "spur"
teeth = 24
normal_module = "3 mm"
width = "20 mm"
mass = "1 kg"
polar_inertia = "8e-4 kg m^2"
diametral_inertia = "1e-3 kg m^2"
[gears.g2]
shaft = "b"
at = "start"
kind = "spur"
teeth = 34
normal_module = "3 mm"
width = "20 mm"
mass = "1 kg"
polar_inertia = "2e-3 kg m^2"
diametral_inertia = "1e-3 kg m^2"
[gears.g3]
shaft = "b2"
at = "start"
kind = "spur"
teeth = 20
normal_module = "3 mm"
width = "20 mm"
mass = "1 kg"
polar_inertia = "5e-4 kg m^2"
diametral_inertia = "1e-3 kg m^2"
[gears.g4]
shaft = "c"
at = "start"
kind = "spur"
teeth = 44
normal_module = "3 mm"
width = "20 mm"
mass = "1 kg"
polar_inertia = "9e-3 kg m^2"
diametral_inertia = "1e-3 kg m^2"
[shafts.b2]
position = ["87 mm", "0 m"]
start = "100 mm"
[couplings.quill]
from_shaft = "b"
to_shaft = "b2"
stiffness = { torsion = "5e4 N m/rad" }
damping = { torsion = "3 N m s/rad" }
[meshes.first]
pinion = "g1"
gear = "g2"
stiffness = "3e8 N/m"
damping_ratio = 0.06
backlash = "60 um"
transmission_error = [{ harmonic = 1, amplitude = "3 um" }, { harmonic = 2, amplitude = "1 um", phase = "40 deg" }]
stiffness_variation = [{ harmonic = 1, amplitude = 0.15 }]
[meshes.second]
pinion = "g3"
gear = "g4"
stiffness = "3e8 N/m"
damping_ratio = 0.06
backlash = "60 um"
transmission_error = [{ harmonic = 1, amplitude = "2 um" }]
stiffness_variation = [{ harmonic = 1, amplitude = 0.15, phase = "60 deg" }]
"""


@pytest.mark.long  # the common period of two stages is many of each
def test_two_stages_over_their_common_period_are_those_of_the_transient() -> None:
    model = rg.loads(TWO_STAGES)
    swept = rg.sweep(model, {"operation.speed": ["4000 rpm"]}, discard=30, sample=2, steps=200)
    # 24/34 of the first shaft's turns, 20 teeth: orders 24 and 240/17, together after 17 periods of the first mesh.
    assert swept.turns.tolist() == [17]
    period = 17 / swept.frequency[0]
    run = rg.transient(model, discard=30 * period, time=2 * period, steps=400, method="newmark", error_estimate=False)
    assert swept.apart[0, 0].max() > 0.01
    for i, row in enumerate(run.to_dict()["contacts"]):
        assert swept.contact[i] == row["name"]
        assert swept.largest_force[0, 0, i] == pytest.approx(row["largest_force_n"], rel=5e-3)
        assert swept.peak_to_peak_approach[0, 0, i] == pytest.approx(row["peak_to_peak_approach_m"], rel=5e-3)
        error = row["peak_to_peak_transmission_error_m"]
        assert swept.peak_to_peak_transmission_error[0, 0, i] == pytest.approx(error, rel=5e-3)
        assert swept.rms_force[0, 0, i] == pytest.approx(row["rms_force_n"], rel=1e-2)
        end = run.approach[-1, i]
        assert swept.section[0, 0, -1, i, 0] == pytest.approx(end, abs=5e-3 * swept.peak_to_peak_approach[0, 0, i])


def test_unstable_motions_are_no_chaos() -> None:
    # Teeth that never part, the mesh at twice the natural frequency: Mathieu's instability.
    model = rg.load(PAIR)
    mesh = model.meshes["pair"].model_copy(update={"backlash": None})
    linear = model.model_copy(update={"meshes": {"pair": mesh}})
    with_bounds = rg.sweep(model, {"operation.speed": ["8500 rpm"]}, initial_conditions=2, **SHORT)
    slow = rg.sweep(linear, {"operation.speed": ["8500 rpm"]}, discard=0, sample=60)
    long = rg.sweep(linear, {"operation.speed": ["8500 rpm", "12000 rpm"]}, discard=2000, sample=60)
    assert not any(with_bounds.failure)
    assert slow.lyapunov[0, 0, 0] > 0.02
    assert slow.motion == ("not settled",)
    assert long.motion == ("failed", "1T")
    assert "left all bounds" in long.failure[0]


@pytest.mark.long
def test_blocks_go_to_other_processes_as_well() -> None:
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import get_context

    over = {"operation.speed": "3000 rpm:9000 rpm:70"}
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        assert same(rg.sweep(rg.load(PAIR), over, executor=pool, **SHORT), rg.sweep(rg.load(PAIR), over, **SHORT))


def test_a_slow_motion_does_not_look_like_growth() -> None:
    # A soft spring to ground: one mode at a thousandth of the mesh frequency, almost undamped.
    law = MeshContact(1.0, 0.1, gap="bilateral", order=1.0, stiffness_cos=(0.2,), error_cos=(0.1,))
    K = [[1e-6, 0.0], [0.0, 1e-6]]
    local = local_system(np.diag([1.0, 1.0]), np.zeros((2, 2)), K, [0.1, -0.1], [(law, [[1.0], [-1.0]])], speed=1.0)
    point = ready(at_rest(local, [Fraction(1)], ("m",)), 1.0)
    start = Start(point.system.rest, np.zeros(2))
    orbit = run_block([point.system], [start], [table_of(point, 100)], BatchPlan(100, 60, 60, 1))[0]
    assert abs(exponents(orbit.growth, 1.0)[0][0]) < 1e-4
