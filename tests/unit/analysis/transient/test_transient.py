"""The transient of a whole model: against frequency response, statics and closed forms, and between its methods."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.transient.transient import transient
from rotorgear.errors import AnalysisError
from rotorgear.forces.ball_bearing import BallBearing
from rotorgear.solvers.time.contact_equilibrium import equilibrium
from rotorgear.solvers.time.local_system import Rotation
from rotorgear.system.local import local_model
from rotorgear.system.system import System
from tests.models import spur_pair
from tests.paths import MODELS

MESH = 24 * 1500.0 / 60.0


def harmonic_force(model: rg.Model, number: int) -> complex:
    """Mesh force at a harmonic of the transmission error of teeth that never part, by a solution in frequency."""
    system = System(model)
    local = local_model(system, Rotation.constant(model.operation.speed), model.operation.speed).local
    law = local.forces.laws[0]
    w = 2.0 * np.pi * MESH * number
    k = float(law.stiffness)
    c = float(law.damping)
    e = (law.error_cos[number - 1] - 1j * law.error_sin[number - 1]) * np.exp(1j * number * law.phase)
    b = local.B.toarray()
    D = local.velocity_terms(model.operation.speed).toarray() + c * b @ b.T
    Z = local.K.toarray() + k * b @ b.T + 1j * w * D - w**2 * local.M.toarray()
    x = np.linalg.solve(Z, b[:, 0] * (k + 1j * w * c) * e)
    return complex((k + 1j * w * c) * (b[:, 0] @ x - e))


@pytest.mark.parametrize("method", ["newmark", "exponential", "generalised-alpha"])
def test_teeth_that_never_part_give_the_frequency_response(method: str) -> None:
    model = spur_pair()
    result = transient(
        System(model), method=method, discard=0.2, time=0.05, steps=1200, records=40, error_estimate=False
    )
    lines = np.fft.rfft(result.mesh_force[-1200:, 0]) / 600.0  # 30 whole periods
    for number in (1, 2):
        assert abs(lines[30 * number]) == pytest.approx(abs(harmonic_force(model, number)), rel=1e-3)


def test_without_excitation_the_static_forces_stay() -> None:
    result = transient(spur_pair(meshes__pair__transmission_error=[]), time=0.01)
    assert result.status == "success"
    assert result.mesh_force == pytest.approx(200.0 / (0.048 * np.cos(np.radians(20.0))), rel=1e-9)
    assert result.dynamic_factor == pytest.approx([1.0])
    assert result.error_estimate < 1e-12
    assert any("neither transmission error" in note for note in result.left_out)


def test_a_given_mesh_phase_turns_the_harmonics_by_so_much() -> None:
    waves = [[{"harmonic": n, "amplitude": "1 um", "phase": angle} for n, angle in pair] for pair in (
        ((1, 0.3), (2, 0.1)), ((1, 0.3 + 0.7), (2, 0.1 + 1.4)))]  # fmt: skip
    found = [
        transient(spur_pair(meshes__pair__transmission_error=w, meshes__pair__phase=p), time=0.01, steps=200)
        for w, p in zip(waves, (0.7, 0.0), strict=True)
    ]
    assert found[0].mesh_force == pytest.approx(found[1].mesh_force, rel=1e-9)
    assert np.ptp(found[0].mesh_force) > 100.0


@pytest.mark.parametrize("kind", ["non-adhesive", "adhesive", "penetration"])
def test_damping_sets_in_over_the_depth_that_is_given(kind: str) -> None:
    model = spur_pair(
        meshes__pair__backlash="40 um",
        meshes__pair__contact_damping=kind,
        meshes__pair__regularisation_depth="3 um",
        meshes__pair__transmission_error=[],
    )
    law = local_model(System(model), Rotation.constant(1.0), 1.0).local.forces.laws[0]
    shares = [law.evaluate(x, 1e-4).dissipated / law.evaluate(3e-6, 1e-4).dissipated for x in (1e-6, 1.5e-6)]
    assert shares == pytest.approx([1.0 / 3.0, 0.5])


def test_bearing_forces_carry_the_mesh_force_in_the_mean() -> None:
    result = transient(spur_pair(), time=0.1, discard=0.2, steps=200, error_estimate=False)
    force = {
        axis: sum(result.history(f"bearings.{b} force {axis}")[result.counted].mean() for b in "ab") for axis in "xy"
    }
    # x: the pinion is pushed away from the wheel; y: along the line of action.
    tangential = 200.0 / 0.048
    assert abs(force["y"]) == pytest.approx(tangential, rel=1e-3)
    assert force["x"] == pytest.approx(-tangential * np.tan(np.radians(20.0)), rel=1e-3)


def test_the_methods_agree_within_their_error_estimates_while_teeth_part() -> None:
    model = spur_pair(meshes__pair__backlash="40 um", operation__torque="3 N m")
    found = [transient(model, method=m, time=0.02, discard=0.04, accuracy=2e-3) for m in ("newmark", "exponential")]
    assert found[0].contact_losses[0] > 5
    for i, name in enumerate(found[0].quantity):
        (a, b), (ea, eb) = ([getattr(r, key)[i] for r in found] for key in ("quantity_value", "quantity_error"))
        if not name.endswith(" z"):  # nothing moves along z but rounding
            assert abs(a - b) <= 5.0 * (ea + eb) + 5e-3 * abs(a), name
    assert all(result.energy.share < 0.01 for result in found)
    assert all(result.error_estimate < 4e-3 for result in found)


def test_contact_is_lost_only_if_there_is_backlash_and_the_response_does_not_depend_on_it_before() -> None:
    quiet = [
        transient(spur_pair(meshes__pair__backlash=j), time=0.02, discard=0.05, steps=200, error_estimate=False)
        for j in ("20 um", "1 mm")
    ]
    assert quiet[0].contact_losses.sum() == 0
    assert quiet[1].mesh_force == pytest.approx(quiet[0].mesh_force, rel=1e-9)


def test_own_normals_and_one_line_agree_while_only_the_driving_flank_carries() -> None:
    both = [
        transient(
            spur_pair(meshes__pair__backlash="50 um", meshes__pair__coast_flank=f),
            time=0.02,
            steps=200,
            error_estimate=False,
        )
        for f in ("line", "own normals")
    ]
    assert both[1].mesh_force[:, 0] == pytest.approx(both[0].mesh_force[:, 0], rel=1e-8)
    assert np.all(both[1].mesh_force[:, 1] == 0.0)


def test_the_backlash_of_the_back_flank_is_the_same_on_its_own_normal() -> None:
    # Turned backwards by hand, the pair meets the back flank after the backlash.
    system = System(
        spur_pair(
            meshes__pair__backlash="50 um", meshes__pair__coast_flank="own normals", meshes__pair__transmission_error=[]
        )
    )
    local = local_model(system, Rotation.constant(0.0), 0.0).local
    turn = np.zeros(system.dofs.transform.shape[0])
    turn[6 * system.nodes.at("one", 0.06) + 5] = 1.0
    first, back = (system.dofs.transform.T @ turn) @ local.B.toarray()
    assert back == pytest.approx(-first, rel=1e-12)
    laws = local.forces.laws
    assert laws[1].evaluate([51e-6]).force[0] == pytest.approx(1e-6 * 3e8, rel=1e-9)
    assert laws[1].evaluate([49e-6]).force[0] == 0.0


def test_a_run_up_uses_newmark_and_names_the_reason() -> None:
    result = transient(
        spur_pair(), speed=[(0.0, "1000 rpm"), (0.2, "2000 rpm")], time=0.2, discard=0.0, steps=60, error_estimate=False
    )
    assert "Newmark" in result.method
    assert "speed changes" in result.reason
    assert result.speed[[0, -1]] == pytest.approx(np.array([1000.0, 2000.0]) * np.pi / 30.0, rel=2e-3)
    orders = rg.spectrum(result, "force pair", orders=True)
    assert orders.over == "order"
    assert orders.frequency[np.argmax(orders.amplitude[5:]) + 5] == pytest.approx(24.0, abs=0.3)


def test_an_unbalance_gives_the_closed_form_whirl() -> None:
    model = spur_pair(
        meshes__pair__transmission_error=[],
        operation__torque=None,
        operation__output_shaft=None,
        unbalances={"u": {"shaft": "one", "at": "60 mm", "magnitude": "500 g mm"}},
    )
    result = transient(model, time=0.16, discard=0.4, steps=100, records=20)
    system = System(model)
    local = local_model(system, Rotation.constant(model.operation.speed), model.operation.speed).local
    w = model.operation.speed
    b = local.B.toarray()
    force = 0.5 * w**2 * 1e-3 * (b[:, 1] - 1j * b[:, 2])
    law = local.forces.laws[0]
    K = local.K.toarray() + law.stiffness * b[:, :1] @ b[:, :1].T
    D = local.velocity_terms(w).toarray() + law.damping * b[:, :1] @ b[:, :1].T
    q = np.linalg.solve(K + 1j * w * D - w**2 * local.M.toarray(), force)
    row = system.dofs.transform[[6 * system.nodes.at("one", 0.0)], :].toarray()[0]
    own = result.history("bearings.a displacement x")[result.counted]
    assert np.abs(own).max() == pytest.approx(abs(row @ q), rel=3e-3)


def test_rolling_bearings_settle_at_the_deflection_of_their_law_under_the_mean_force() -> None:
    rolling = {
        "kind": "ball",
        "elements": 9,
        "element_diameter": "12 mm",
        "pitch_diameter": "60 mm",
        "clearance": "8 um",
    }
    model = spur_pair(
        bearings__a__rolling=rolling,
        bearings__b__rolling=rolling,
        meshes__pair__transmission_error=[],
        meshes__pair__backlash="50 um",
    )
    result = transient(model, time=0.05, discard=0.2, steps=100, error_estimate=False)
    x, y, fx, fy = (
        result.history(f"bearings.a {what} {axis}")[-1] for what in ("displacement", "force") for axis in "xy"
    )
    assert np.hypot(fx, fy) == pytest.approx(0.5 * 200.0 / 0.048 / np.cos(np.radians(20.0)), rel=0.02)
    order = 0.5 * (1.0 - 12.0 / 60.0)
    d = [
        x,
        y,
        result.history("bearings.a displacement z")[-1] if "bearings.a displacement z" in result.channel else 0.0,
        0.0,
        0.0,
    ]
    law = BallBearing(9, 12e-3, 60e-3, clearance=8e-6, order=order)
    force = law.evaluate(d, angle=result.angle[-1]).force[:2]
    assert force == pytest.approx([fx, fy], abs=0.05 * np.hypot(fx, fy))
    assert np.hypot(x, y) > 4e-6


def test_varying_compliance_shakes_at_the_rate_of_passing_balls() -> None:
    rolling = {
        "kind": "roller",
        "elements": 12,
        "element_diameter": "8 mm",
        "length": "8 mm",
        "pitch_diameter": "60 mm",
        "clearance": "20 um",
    }
    model = spur_pair(bearings__a__rolling=rolling, meshes__pair__transmission_error=[])
    result = transient(model, time=0.2, discard=0.2, steps=100, error_estimate=False)
    passing = 12 * 0.5 * (1.0 - 8.0 / 60.0) * 25.0
    lines = rg.spectral_lines(result, "bearings.a displacement y")
    strongest = lines.frequency_hz[np.argmax(lines.amplitude)]
    assert strongest == pytest.approx(passing, rel=0.02)


def test_friction_shakes_at_the_mesh_frequency_and_takes_the_power_of_an_involute_pair() -> None:
    smooth = transient(
        spur_pair(meshes__pair__transmission_error=[]), time=0.05, discard=0.1, steps=400, error_estimate=False
    )
    rough = transient(
        spur_pair(meshes__pair__transmission_error=[], meshes__pair__friction_coefficient=0.06),
        time=0.05,
        discard=0.1,
        steps=400,
        error_estimate=False,
    )
    assert smooth.mesh_force.std() < 1e-6 * smooth.mesh_force.mean()
    assert rough.mesh_force[rough.counted].std() > 1e-3 * rough.mesh_force.mean()
    lines = rg.spectral_lines(rough, "bearings.a force x")
    strongest = lines.frequency_hz[np.argmax(lines.amplitude)]
    assert strongest == pytest.approx(MESH * round(strongest / MESH), abs=2.0)
    assert rough.energy.dissipated[-1] > 10.0 * abs(smooth.energy.dissipated[-1])
    # Loss of an involute pair, Niemann: mu pi (1/z1 + 1/z2) times a factor of the contact ratio near 1/2.
    power = 200.0 * 1500.0 * np.pi / 30.0
    late = rough.energy.time > rough.settle
    spent = np.diff(rough.energy.dissipated[late][[0, -1]])[0] / np.diff(rough.energy.time[late][[0, -1]])[0]
    expected = 0.06 * np.pi * (1.0 / 24.0 + 1.0 / 36.0)
    assert 0.3 * expected < spent / power < 1.0 * expected


def test_two_helices_half_a_pitch_apart_cancel_the_first_harmonic_of_an_even_error() -> None:
    gear = {"kind": "herringbone", "helix_angle": "25 deg", "gap": "20 mm"}
    changes = {f"gears__{name}__{key}": value for name in ("pinion", "wheel") for key, value in gear.items()}
    changes |= {
        "gears__pinion__hand": "right",
        "gears__wheel__hand": "left",
        "shafts__two__position": ["132.4053 mm", "0 mm"],
    }
    for shaft, d in (("one", "40 mm"), ("two", "50 mm")):
        changes[f"shafts__{shaft}__sections"] = [{"length": "120 mm", "outer_diameter": d}]
    only_first = [{"harmonic": 1, "amplitude": "4 um"}]
    found = []
    for stagger in (0.0, 0.5):
        model = spur_pair(**changes, meshes__pair__stagger=stagger, meshes__pair__transmission_error=only_first)
        result = transient(model, time=0.05, discard=0.2, steps=200, error_estimate=False)
        found.append(result.mesh_force[result.counted].sum(axis=1).std())
        assert result.mesh_force[result.counted].std(axis=0).min() > 10.0
    assert found[1] < 1e-3 * found[0]


def test_requests_that_make_no_sense_are_refused_in_a_sentence() -> None:
    model = spur_pair()
    for options, words in (
        ({"method": "magic"}, "method: got 'magic'"),
        ({"steps": 100, "accuracy": 0.01}, "give one of the two"),
        ({"accuracy": 2.0}, "between 1e-8 and 1"),
        ({"time": "5 mm"}, "a time"),
        ({"time": 0.0}, "expected more than 0"),
        ({"method": "newmark", "gamma": 0.3}, "gamma must lie between 0.5"),
        ({"method": "generalised-alpha", "rho_inf": 1.5}, "between 0 and 1"),
        ({"method": "newmark", "modal_damping": 0.02}, "only the exponential method"),
        ({"speed": [(0.0, 100.0), (1.0, 200.0)], "method": "exponential", "time": 1.0}, "constant speed"),
        ({"modal_damping": 1.5}, "between 0 and 1"),
        ({"time": 1e6, "steps": 1000}, "ask for less time"),
    ):
        with pytest.raises(AnalysisError, match=words):
            transient(model, **options)


def test_an_unknown_history_is_answered_with_the_nearest_one() -> None:
    result = transient(spur_pair(), time=0.01, steps=100, error_estimate=False)
    with pytest.raises(AnalysisError, match="did you mean 'force pair'"):
        rg.spectrum(result, "force pear")


@pytest.mark.parametrize("window", ["flattop", "hann"])
def test_a_spectrum_is_true_in_amplitude(window: str) -> None:
    result = transient(spur_pair(), time=0.2, discard=0.2, steps=200, error_estimate=False)
    lines = rg.spectral_lines(result, "force pair", window=window)
    strongest = np.argmax(lines.amplitude)
    assert lines.frequency_hz[strongest] == pytest.approx(2.0 * MESH, rel=1e-3)
    assert lines.source[strongest] == "mesh pair 2x"
    assert lines.amplitude[strongest] == pytest.approx(abs(harmonic_force(spur_pair(), 2)), rel=1e-2)


def test_gravity_bends_the_shafts_and_its_force_arrives_at_the_bearings() -> None:
    model = spur_pair(
        operation__gravity=["0 m/s^2", "-9.81 m/s^2", "0 m/s^2"],
        operation__torque=None,
        operation__output_shaft=None,
        meshes__pair__transmission_error=[],
    )
    result = transient(model, time=0.005, steps=100)
    total = sum(result.history(f"bearings.{name} force y")[0] for name in "abcd")
    mass = rg.check(model).total_mass_kg
    assert total == pytest.approx(-9.81 * mass, rel=1e-9)


def test_a_list_of_stiffnesses_over_the_mesh_period_does_what_its_fourier_series_does() -> None:
    pair = {"meshes__pair__transmission_error": [], "meshes__pair__backlash": "50 um"}
    n = 60
    values = [3e8 * (1.0 + 0.2 * np.cos(2.0 * np.pi * i / n)) for i in range(n)]
    series = {"mean": "3e8 N/m", "amplitudes": [0.2]}
    harmonic = spur_pair(**pair, meshes__pair__stiffness_variation=[{"harmonic": 1, "amplitude": 0.2}])
    models = [harmonic, *(spur_pair(**pair, meshes__pair__stiffness=given) for given in (values, series))]
    found = [transient(m, time=0.02, steps=200) for m in models]
    for other in found[1:]:
        assert other.mesh_force == pytest.approx(found[0].mesh_force, abs=1e-2 * np.ptp(found[0].mesh_force))


def test_a_stiffness_model_shakes_the_pair_with_its_curve() -> None:
    model = spur_pair(meshes__pair__transmission_error=[], meshes__pair__stiffness="potential_energy")
    system = System(model)
    local = local_model(system, Rotation.constant(model.operation.speed), model.operation.speed).local
    law = local.forces.laws[0]
    curve = system.state.whole_curve("pair")
    normal = curve.transverse / np.cos(0.0) ** 2
    k = [
        law.evaluate([1e-5], angle=(2.0 * np.pi * u - law.phase) / law.order, speed=100.0).in_displacement[0, 0]
        for u in curve.position
    ]
    assert k == pytest.approx(normal, rel=1e-6)
    result = transient(model, time=0.02, discard=0.02, steps=100)
    assert result.mesh_force.std() > 0.01 * result.mesh_force.mean()


def test_a_pair_under_torque_stands_in_equilibrium_at_any_stiffness() -> None:
    # Where the teeth are stiff, the transmission error at the start lies beyond the deflection: the flanks stand apart in the
    # linear start, and nothing but the torque says where to go.
    for factor in 10.0 ** np.arange(-6.0, 10.0, 1.0):
        for direction in (1.0, -1.0):
            model = spur_pair(
                meshes__pair__stiffness=2e8 * factor,
                meshes__pair__backlash="40 um",
                meshes__pair__transmission_error=[{"harmonic": 1, "amplitude": "3 um"}],
            )
            system = System(model, state=model.torque_flow(int(direction)))
            local = local_model(system, Rotation.constant(direction), direction).local
            rest = equilibrium(local)
            assert rest.converged, factor
            # Of deflections of teeth a billion times as stiff, displacements of the shafts leave few digits.
            digits = max(1e-8, 1e-12 * factor)
            assert rest.force == pytest.approx(200.0 / (0.048 * np.cos(np.radians(20.0))), rel=digits)
            assert np.all(
                np.abs(rest.free.T @ (local.load - local.B @ rest.force))
                < digits * np.abs(rest.free.T) @ np.abs(local.load)
            )


def test_energies_of_whole_steps_add_up_to_second_order_and_loose_dofs_are_rigid() -> None:
    # Steps that do not resolve the contacts take them out of the modes: four dofs of this model are then held by nothing.
    model = rg.load(MODELS / "herringbone_pair_12dof.toml")
    transient(model, time=1e-3, discard=0.0, steps=5, method="exponential", error_estimate=False)
    shares = [
        transient(model, time=1e-3, discard=0.0, steps=steps, method="exponential", error_estimate=False).energy.share
        for steps in (100, 200)
    ]
    assert shares[1] < 0.35 * shares[0]
