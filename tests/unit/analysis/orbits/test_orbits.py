"""Periodic motions over a parameter: special points of a known oscillator, linear models, refusals."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.orbits.family import SystemFamily, range_of
from rotorgear.errors import AnalysisError
from rotorgear.solvers.periodic.floquet import basis_of
from tests.models import spur_pair
from tests.paths import MODELS
from validation.cases.journal_whirl.whirl import FINITE, SHORT, closed_form, model
from validation.studies.dead_zone import HALF_BACKLASH, DeadZone, jumps


def test_shooting_finds_the_fold_of_an_oscillator_with_a_dead_zone() -> None:
    case = DeadZone(amplitude=0.05)
    found = case.orbits((0.738, 0.758))
    assert "shooting" in found.method
    fold = found.special_points[0]
    assert fold.kind == "fold"
    assert case.ratio_of(fold.value) == pytest.approx(0.7481043, abs=1e-6)
    assert 1.0 + fold.approach_extremes[0] / HALF_BACKLASH == pytest.approx([0.967804, 1.235125], abs=2e-6)
    assert np.sort(fold.multiplier_real) == pytest.approx([0.431762, 1.0], abs=1e-4)
    mu = np.where(np.isnan(found.multipliers), 1.0, found.multipliers)
    exact = np.exp(-2.0 * case.ratio * case.frequency * found.period)
    assert mu.prod(axis=1) == pytest.approx(exact, rel=1e-8)


def test_both_methods_find_the_period_doubling_and_shooting_the_branch_behind_it() -> None:
    case = DeadZone(amplitude=0.2)
    exact = case.orbits((1.63, 1.59), step=0.2, switch=True)
    kinds = [(point.kind, point.branch) for point in exact.special_points]
    assert ("period doubling", 0) in kinds
    at = next(point for point in exact.special_points if point.branch == 0)
    assert case.ratio_of(at.value) == pytest.approx(1.6076657, abs=1e-6)
    assert exact.branches[1].name == "2T"
    twice = exact.branch == 1
    assert exact.period[twice] == pytest.approx(2.0 * 2.0 * np.pi / (20.0 * exact.value[twice]))
    balance = case.orbits((1.63, 1.59), step=0.2, method="harmonic balance")
    assert [point.kind for point in balance.special_points] == ["period doubling"]
    assert case.ratio_of(balance.special_points[0].value) == pytest.approx(1.6076657, abs=1e-3)
    # Each step's map is exact for a constant tangent: the product of multipliers is nearly that of the damping.
    mu = np.where(np.isnan(balance.multipliers), 1.0, balance.multipliers)
    damped = np.exp(-2.0 * case.ratio * case.frequency * balance.period)
    assert mu.prod(axis=1).real == pytest.approx(damped, rel=1e-5)
    # Flanks part: the mean of a tangent over a step has to know where in it they do. Both runs begin at one value.
    assert np.sort(mu[0, :2].real) == pytest.approx(np.sort(exact.multipliers[0, :2].real), abs=5e-5)


@pytest.mark.long  # a sweep of twenty speeds one after another
def test_sweeps_jump_where_the_folds_are() -> None:
    found = jumps()
    for run, fold in (("up", 0.7481043), ("down", 0.450539)):
        low, high = found[run]
        assert low < fold < high


def test_the_modes_of_a_free_pair_hold_nothing_of_its_rotation() -> None:
    model = rg.load(MODELS / "backlash_pair.toml")
    plant = SystemFamily(model, [range_of(model, "operation.speed", "4000 rpm:4100 rpm")], None, None).plant(0.0)
    V = basis_of(plant, np.inf).V
    assert V.shape == (2, 1)
    assert np.abs(V.T @ (plant.M @ plant.free)).max() < 1e-12
    # Both gears are the same: they move towards each other by the same angle.
    assert V[0] == pytest.approx(V[1], rel=1e-12)


@pytest.mark.parametrize("friction", [0.0, 0.05])
def test_drag_on_a_shaft_that_turns_freely_leaves_its_place_open(friction: float) -> None:
    # Where the shafts stand has a multiplier of 1, which no equation of a periodic motion may hang on.
    spans = {f"shafts__{shaft}__sections": None for shaft in ("one", "two")}
    places = {f"gears__{gear}__at": "start" for gear in ("pinion", "wheel")}
    bodies = {
        f"gears__{gear}__{key}": value
        for gear, inertia in (("pinion", 2.5e-3), ("wheel", 1e-2))
        for key, value in (("mass", 2.0), ("polar_inertia", inertia), ("diametral_inertia", 0.6 * inertia))
    }
    model = spur_pair(
        motions=["torsion"],
        supports={"a": {"shaft": "one", "at": "start", "damping": {"torsion": "0.05 N m s/rad"}}},
        bearings=None,
        points=None,
        meshes__pair__backlash="50 um",
        meshes__pair__friction_coefficient=friction or None,
        **spans,
        **places,
        **bodies,
    )
    over = {"operation.speed": "1500 rpm:1510 rpm"}
    shot, balanced = (rg.orbits(model, over, method=method, step=0.5) for method in ("shooting", "harmonic balance"))
    swept = rg.sweep(model, {"operation.speed": ["1500 rpm"]}, discard=60, sample=10, exponents=0)
    for found in (shot, balanced):
        first = int(np.argmin(found.value))
        assert not found.special_points
        assert found.mean_force[first] == pytest.approx(swept.mean_force.ravel(), rel=1e-4)
        assert found.rms_force[first] == pytest.approx(swept.rms_force.ravel(), rel=1e-3)
        assert np.nanmax(np.abs(found.multipliers)) < 1.0 - 1e-4
    largest = [float(np.nanmax(np.abs(found.multipliers[0]))) for found in (shot, balanced)]
    assert largest[0] == pytest.approx(largest[1], rel=1e-3)


def test_orbits_of_a_linear_model_are_its_forced_response() -> None:
    text = (MODELS / "flexible_pair.toml").read_text(encoding="utf-8")
    cut = [line for line in text.splitlines() if not line.startswith(("backlash", "stiffness_variation"))]
    model = rg.loads("\n".join(cut))
    found = rg.orbits(model, {"operation.speed": "2000 rpm:2200 rpm"}, harmonics=4, step=0.5, elements=1)
    response = rg.response(model, speeds=found.value, elements=1)
    for harmonic in (1, 2):
        own = np.abs(found.force_harmonics[:, harmonic])
        assert own == pytest.approx(np.abs(response.mesh_force[harmonic - 1]), rel=1e-10)


def test_stages_without_a_short_common_period_are_refused_with_the_remedy() -> None:
    model = rg.load(MODELS / "split_torque.toml")
    with pytest.raises(
        AnalysisError,
        match=r"only after 409625 periods .* s at the first speed .* excite one stage at a time",
    ):
        rg.orbits(model, {"operation.speed": "9000 rpm:9100 rpm"})


@pytest.mark.parametrize(
    ("over", "options", "said"),
    [
        ({"operation.speed": "3000 rpm"}, {}, "expected FROM:TO"),
        ({"operation.speed": "0 rpm:3000 rpm"}, {}, "standstill"),
        ({"operation.speed": "3000 rpm:3000 rpm"}, {}, "two different values"),
        ({"operation.speed": "3000 rpm:4000 rpm"}, {"excite": "nobody"}, "nothing that excites is named"),
        ({"operation.speed": "3000 rpm:4000 rpm"}, {"method": "magic"}, "expected one of auto"),
    ],
)
def test_requests_that_make_no_sense_are_refused(over: dict[str, str], options: dict[str, object], said: str) -> None:
    with pytest.raises(AnalysisError, match=said):
        rg.orbits(rg.load(MODELS / "backlash_pair.toml"), over, **options)  # type: ignore[arg-type]


def shaken(magnitude: str) -> rg.Model:
    """The Jeffcott rotor with an unbalance on its disk."""
    return rg.load(MODELS / "jeffcott.toml").with_(
        "unbalances", {"u": {"shaft": "rotor", "at": "400 mm", "magnitude": magnitude}}
    )


def test_orbits_of_a_linear_rotor_are_its_response_to_unbalance() -> None:
    found = rg.orbits(shaken("500 g mm"), {"operation.speed": "1000 rpm:1040 rpm"}, harmonics=3, step=0.5, elements=1)
    assert found.contact == ()
    assert found.place == ("unbalances.u x", "unbalances.u y")
    assert found.place_unit == ("m", "m")
    response = rg.response(shaken("500 g mm"), speeds=found.value, elements=1)
    frequency = found.value[:, None]  # the probes are on the same disk
    amplitude = np.abs(response.acceleration[0]) / frequency**2
    np.testing.assert_allclose(np.abs(found.place_harmonics[:, 1]), amplitude, rtol=1e-9)
    np.testing.assert_allclose(found.place_peak_to_peak, 2.0 * amplitude, rtol=1e-6)
    assert found.stable.all()


def test_an_unbalanced_rotor_on_a_short_film_begins_to_whirl_at_the_closed_forms_threshold() -> None:
    threshold, ratio = closed_form()
    rotor = model(SHORT, "1 g mm")
    found = rg.orbits(rotor, {"operation.speed": [0.95 * threshold, 1.05 * threshold]}, harmonics=4, step=0.5)
    (onset,) = found.special_points
    assert onset.kind == "Neimark-Sacker"
    assert onset.value == pytest.approx(threshold, rel=1e-5)
    # The whirl's own frequency shows as the angle of the multiplier in a turn, modulo a turn.
    turned = np.angle(onset.multiplier_real[0] + 1j * abs(onset.multiplier_imaginary[0])) / (2.0 * np.pi)
    assert 1.0 - turned == pytest.approx(ratio, rel=1e-4)
    assert found.place == tuple(
        f"{part} {axis}" for part in ("nonlinear_elements.film", "unbalances.u") for axis in "xy"
    )
    assert list(found.stable) == list(found.value < onset.value)


def test_a_model_whose_motions_nothing_tells_apart_is_refused_with_the_remedy() -> None:
    rotor = rg.load(MODELS / "jeffcott.toml").with_(
        "loads", {"shake": {"shaft": "rotor", "at": "400 mm", "force": [1.0, 0.0, 0.0], "order": 1}}
    )
    with pytest.raises(AnalysisError, match=r"nothing tells one motion from another.*response"):
        rg.orbits(rotor, {"operation.speed": "1000 rpm:1100 rpm"})


@pytest.mark.long
def test_multipliers_on_a_film_of_finite_length_are_those_of_the_damped_modes() -> None:
    speed = closed_form()[0]
    found = rg.orbits(
        model(FINITE, "1 g mm"), {"operation.speed": [speed, 1.03 * speed]}, harmonics=4, instants=256, step=0.5
    )
    assert "harmonic balance" in found.method
    mu = np.abs(found.multipliers[[0, -1], 0])
    s = [rg.modal(model(FINITE), speed=float(one), modes=4).eigenvalues for one in found.value[[0, -1]]]
    exact = [np.exp(2.0 * np.pi / one * modes.real.max()) for one, modes in zip(found.value[[0, -1]], s, strict=True)]
    np.testing.assert_allclose(mu, exact, rtol=2e-4)
    assert found.special_points[0].kind == "Neimark-Sacker"
