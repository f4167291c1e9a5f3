"""One mesh of a model over its cycle, and the same mesh in the rotor model."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import scipy.sparse.linalg as spl

import rotorgear as rg
from rotorgear.analysis.static.mean_state import mean_state
from rotorgear.analysis.teeth.errors import error_parts
from rotorgear.analysis.teeth.request import SolvedHelices, mesh_request, solve_helices
from rotorgear.gears.loaded.mesh_cycle import MeshCycle, loaded_cycle
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.gears.tooth_fe.points import MeshSize
from rotorgear.gears.tooth_fe.settings import ToothFe
from rotorgear.system.system import System
from tests.models import pair_file
from tests.paths import MODELS

PREVIEW = 'tooth_fe = { preset = "preview" }'
NAMED = f'stiffness = "tooth_fe"\n{PREVIEW}'


def mesh_of(text: str, **options: Any) -> rg.MeshResult:
    return rg.mesh(rg.loads(text), positions=16, **options)


def deflection_of_rotor_model(text: str) -> float:
    """Approach of the flanks along the normal in the rotor model under the torque of the file, mean of the helices."""
    model = rg.loads(text)
    system = System(model, elements=2, state=model.torque_flow().of_kind("static"))
    K = system.stiffness()
    groups = [group for group in system.groups if group.part == "meshes.pair"]
    # Both shafts are driven against each other by torques in balance; the free rotation is held by a soft spring.
    f = np.zeros(system.n)
    for shaft, torque in (("one", 1000.0), ("two", 1000.0 * 80 / 34)):
        node = next(i for i, name in enumerate(system.nodes.shaft) if name == shaft)
        f[node * 6 + 5] = torque
    soft = 1e-3 * abs(K).max()
    held = K.tolil()
    node = next(i for i, name in enumerate(system.nodes.shaft) if name == "two")
    held[node * 6 + 5, node * 6 + 5] += soft
    q = spl.spsolve(held.tocsc(), f)
    found = [float((group.matrices.strain[0] @ q[group.dofs[0]])[0]) for group in groups]
    return abs(float(np.mean(found)))


def contact_alone(text: str) -> list[MeshCycle]:
    """Each helix of a mesh at many even positions, under the mean force of the helices."""
    model = rg.loads(text)
    pair = model.layout.mesh("pair")
    forces = [force.normal_force for force in model.torque_flow().of_mesh("pair")]
    load = float(np.mean(forces) * np.cos(pair.pinion.base_helix_angle))
    u = np.arange(256 if pair.pinion.hand else 2048) / (256 if pair.pinion.hand else 2048)
    return [loaded_cycle(pair.helix_teeth(helix), load, u)[1] for helix in range(pair.helices)]


def mean_approach(text: str) -> float:
    """Of the contact alone, along the flank normal."""
    cosine = float(np.cos(rg.loads(text).layout.mesh("pair").pinion.base_helix_angle))
    return cosine * float(np.mean([cycle.deflection.mean() for cycle in contact_alone(text)]))


@pytest.mark.parametrize(
    ("helix", "kind", "extra", "near"),
    [(0.0, "spur", "", 5e-5), (20.86, "helical", "", 1e-5), (20.86, "herringbone", "stagger = 0.5", 1e-5)],
    ids=["spur", "helical", "herringbone"],
)
def test_the_rotor_model_deflects_as_the_loaded_teeth_do(helix: float, kind: str, extra: str, near: float) -> None:
    text = pair_file(helix, kind, mesh=f"{NAMED}\n{extra}")
    deflection = deflection_of_rotor_model(text)
    assert deflection == pytest.approx(mean_approach(text), rel=near)
    if kind == "spur":  # it is looked at where a mesh is, and helices at even positions
        assert deflection == pytest.approx(rg.mesh(rg.loads(text), estimate=False).mean_transmission_error, rel=1e-6)


@pytest.mark.parametrize(
    ("helix", "kind", "near"), [pytest.param(0.0, "spur", 1e-6, marks=pytest.mark.long), (20.86, "helical", 1e-5)]
)
def test_statics_press_the_teeth_together_as_loaded_contact_does(helix: float, kind: str, near: float) -> None:
    text = pair_file(helix, kind, mesh=NAMED)
    assert rg.static(rg.loads(text)).mesh_deflection[0] == pytest.approx(mean_approach(text), rel=near)


def test_small_motions_meet_the_tangent_stiffness() -> None:
    model = rg.loads(pair_file(mesh=NAMED))
    found = rg.mesh(model, estimate=False)
    force = System(model).state.of_mesh("pair")[0]
    assert force.contact.stiffness == pytest.approx(found.mean_tangent_stiffness, rel=1e-9)


def test_the_load_is_that_of_the_torque_flow_unless_one_is_given() -> None:
    text = pair_file(mesh=NAMED)
    own = mesh_of(text)
    given = mesh_of(text, torque=1000.0)
    half = mesh_of(text, torque=500.0)
    assert own.load is not None
    assert own.load.pinion_torque_n_m == pytest.approx(1000.0, rel=1e-12)
    assert given.stiffness == pytest.approx(own.stiffness, rel=1e-12)
    assert half.mean_stiffness < own.mean_stiffness


def test_a_number_in_the_file_is_answered_by_teeth_and_on_request_by_itself() -> None:
    text = pair_file(mesh=f'stiffness = "8e8 N/m"\n{PREVIEW}')
    assert mesh_of(text).stiffness_model == "tooth_fe"
    given = mesh_of(text, stiffness="given")
    assert given.mean_normal_stiffness == pytest.approx(8e8)
    assert given.peak_to_peak_stiffness == pytest.approx(0.0, abs=1.0)


def test_orders_of_a_stiffness_that_does_not_vary_are_none_and_not_rounding() -> None:
    text = mesh_of(pair_file(mesh=NAMED), stiffness="iso").text(harmonics=4)
    rows = text[text.index("mesh order") :].splitlines()[1:5]
    assert all("0 N/m" in row and "e-" not in row for row in rows), text


def test_iso_and_teeth_answer_in_the_same_plane() -> None:
    text = pair_file(20.86, "helical", mesh=NAMED)
    teeth = mesh_of(text)
    iso = mesh_of(text, stiffness="iso")
    assert iso.mean_stiffness / teeth.mean_stiffness == pytest.approx(1.0, abs=0.35)


def test_a_reversed_torque_loads_the_other_flanks_of_a_symmetric_pair_alike() -> None:
    text = pair_file(20.86, "helical", mesh=NAMED)
    ahead = mesh_of(text, torque=1000.0)
    back = mesh_of(text, torque=-1000.0)
    assert back.stiffness == pytest.approx(ahead.stiffness, rel=1e-12)


def test_a_helix_slope_acts_the_other_way_on_the_other_flanks() -> None:
    right = pair_file(20.86, "helical", mesh=f'{NAMED}\nmisalignment = "20 um"')
    left = pair_file(20.86, "helical", mesh=f'{NAMED}\nmisalignment = "20 um"', hand=("left", "right"))
    other = pair_file(20.86, "helical", mesh=f'{NAMED}\nmisalignment = "-20 um"')
    found = mesh_of(right, torque=1000.0)
    assert mesh_of(left, torque=1000.0).stiffness == pytest.approx(mesh_of(other, torque=1000.0).stiffness, rel=1e-12)
    assert mesh_of(right, torque=-1000.0).stiffness == pytest.approx(mesh_of(other, torque=1000.0).stiffness, rel=1e-12)
    assert abs(mesh_of(other, torque=1000.0).stiffness / found.stiffness - 1.0).max() > 1e-4


def test_a_staggered_herringbone_has_no_odd_orders() -> None:
    plain = rg.mesh(rg.loads(pair_file(20.86, "herringbone", mesh=NAMED)))
    half = rg.mesh(rg.loads(pair_file(20.86, "herringbone", mesh=f"{NAMED}\nstagger = 0.5")))
    one = rg.mesh(rg.loads(pair_file(20.86, "helical", mesh=NAMED)), torque=500.0)
    assert plain.stiffness == pytest.approx(2.0 * one.stiffness, rel=1e-9)
    c = half.ste_harmonics(4)
    whole = plain.ste_harmonics(4)
    assert c is not None
    assert whole is not None
    assert abs(c[::2]).max() <= 1e-9 * abs(whole).max()
    # Even orders stay, as far as the positions of either know them: the 48 stations of the preview make as many small kinks.
    assert abs(c[1::2]) == pytest.approx(abs(whole[1::2]), abs=1e-2 * abs(whole).max())


def test_pitch_errors_are_followed_until_all_have_passed() -> None:
    flank = '[gears.pinion.flank]\npitch_errors = { "2" = "20 um" }\n'
    text = pair_file(mesh=NAMED) + flank
    found = mesh_of(text)
    assert len(found.position) == 4 * 16
    assert found.no_load_error is not None
    assert np.ptp(found.no_load_error) > 1e-6
    # Orders of the mesh are those of whole periods.
    assert len(found.harmonics(5)) == 5


@pytest.mark.long
def test_an_accuracy_takes_the_cheapest_preset_that_is_estimated_to_reach_it() -> None:
    text = pair_file(mesh='stiffness = "tooth_fe"')
    rough = mesh_of(text, accuracy=0.05)
    sharp = mesh_of(text, accuracy=0.008)
    assert (rough.preset, sharp.preset) == ("preview", "default")
    assert sharp.errors is not None
    assert sharp.errors.worst <= 0.008
    with pytest.raises(rg.AnalysisError, match="No preset reaches"):
        mesh_of(text, accuracy=1e-7)


def test_estimates_are_larger_than_the_errors_against_a_finer_mesh() -> None:
    study = rg.mesh_convergence_study(rg.loads(pair_file()))
    for rung in study.rungs:
        if rung.estimate is not None:
            for name in ("mean_stiffness", "peak_to_peak_stiffness", "ste_peak_to_peak"):
                assert getattr(rung.error, name) <= 1.5 * getattr(rung.estimate, name)


@pytest.mark.long
def test_estimates_of_helical_teeth_are_larger_than_errors_against_thinner_layers_and_a_finer_profile() -> None:
    """A face of 20 mm: 4 and 5 layers of the presets beside 14, whose profile has twice as many rows."""
    text = pair_file(20.86, "helical", torque="400 N m").replace('width = "54 mm"', 'width = "20 mm"')
    request = mesh_request(rg.loads(text), None, None, None, {})
    assert request.teeth is not None
    names = ("mean_stiffness", "peak_to_peak_stiffness", "ste_peak_to_peak")

    def solved(fe: ToothFe) -> tuple[ToothPair, SolvedHelices]:
        assert request.teeth is not None
        teeth = replace(request.teeth, fe=fe)
        return teeth, solve_helices(request, teeth, 32, judged=True)

    def figures(found: SolvedHelices) -> np.ndarray:
        return np.array([found.curve.mean()[1], np.ptp(found.stiffness), np.ptp(found.error)])

    exact = figures(solved(ToothFe(preset="fine", size=MeshSize(16, 4, 8, 3, 7, 14)))[1])
    estimates = []
    for fe in (ToothFe(preset="default"), ToothFe(preset="fine")):
        teeth, found = solved(fe)
        parts = error_parts(request, teeth, found)
        assert parts is not None
        error = np.abs(figures(found) / exact - 1.0)
        estimates.append(np.array([getattr(parts.total, name) for name in names]))
        assert np.all(error <= 1.5 * estimates[-1])
        assert estimates[-1].max() <= 4.0 * error.max()
    assert np.all(estimates[1] <= estimates[0])


def test_loads_are_tabled_on_request() -> None:
    found = mesh_of(pair_file(mesh=NAMED), load_factors=(0.1, 1.0))
    assert [point.factor for point in found.loads] == [0.1, 1.0]
    assert found.loads[1].mean_stiffness_n_per_m == pytest.approx(found.mean_stiffness, rel=1e-12)


def test_a_mesh_without_load_says_what_to_give() -> None:
    text = pair_file(torque="", mesh='stiffness = "1e9 N/m"')
    with pytest.raises(rg.AnalysisError, match=r"carries no torque.*--torque"):
        mesh_of(text)
    assert mesh_of(text, stiffness="iso").load is None
    assert mesh_of(pair_file(torque="", mesh=NAMED), stiffness="iso").load is None
    assert mesh_of(pair_file(torque="", mesh=NAMED), torque=100.0).load is not None


def test_gears_without_teeth_are_refused() -> None:
    model = rg.load(MODELS / "geared_pair.toml")
    with pytest.raises(rg.AnalysisError, match="given by their base radius have no teeth"):
        rg.mesh(model, torque=100.0)
    assert rg.mesh(model, stiffness="given").mean_normal_stiffness == pytest.approx(1e8)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"mesh": "pear"}, "did you mean 'pair'"),
        ({"stiffness": "tooth_fem"}, "did you mean 'tooth_fe'"),
        ({"stiffness": "given"}, "names the model 'tooth_fe'"),
        ({"torque": 0.0}, "not zero"),
        ({"preset": "finest"}, "preset: got 'finest'"),
        ({"body": "disc"}, "body: got 'disc'"),
        ({"accuracy": 2.0}, "accuracy between 0 and 1"),
        ({"periods": 0}, "--periods"),
        ({"load_factors": (-1.0,)}, "positive"),
    ],
)
def test_a_wish_that_cannot_be_is_refused_in_one_sentence(options: dict[str, Any], said: str) -> None:
    with pytest.raises(rg.AnalysisError, match=said):
        mesh_of(pair_file(mesh=NAMED), **options)


def test_the_result_is_plain_json() -> None:
    found = mesh_of(pair_file(mesh=NAMED))
    data = found.to_dict()
    again = json.loads(json.dumps(data, allow_nan=False))
    assert again["definition"] == "secant"
    assert len(again["stiffness_n_per_m"]) == len(again["position"]) == 16
    assert again["mean_stiffness_n_per_m"] == pytest.approx(found.mean_stiffness)
    assert sum(again["event"]) >= 2


def test_a_response_about_the_mean_state_meets_the_tangent_stiffness() -> None:
    model = rg.loads(pair_file(mesh=NAMED))
    state = mean_state(System(model, state=model.torque_flow().of_kind("static")), 100.0)
    found = rg.mesh(model, estimate=False)
    tangent = state.system.state.of_mesh("pair")[0].contact.stiffness
    (alone,) = contact_alone(pair_file(mesh=NAMED))
    assert tangent == pytest.approx(float(alone.tangent.mean()), rel=5e-4)
    assert tangent == pytest.approx(found.mean_tangent_stiffness, rel=1e-3)  # of 64 positions
    assert tangent > 1.02 * found.mean_stiffness
    assert state.lines.stiffness == pytest.approx([tangent])


def test_in_a_loop_of_meshes_split_and_stiffness_agree() -> None:
    text = (MODELS / "split_torque.toml").read_text(encoding="utf-8")
    for number in ("5.63e8 N/m", "1.2e9 N/m"):
        text = text.replace(f'stiffness = "{number}"', f'stiffness = "tooth_fe"\n{PREVIEW}')
    model = rg.loads(text)
    flow = model.torque_flow()
    assert set(flow.curves) == {"stage_1a", "stage_1b", "stage_2a", "stage_2b"}
    assert flow.whole_curve("stage_1a").mean == pytest.approx(flow.whole_curve("stage_1b").mean, rel=1e-6)
    torque = 2.5e6 / (16350 * np.pi / 30.0)
    radius = flow.of_mesh("stage_1a")[0].contact.pinion_base_radius
    base = flow.of_mesh("stage_1a")[0].contact.base_helix_angle
    carried = (
        sum(f.normal_force for name in ("stage_1a", "stage_1b") for f in flow.of_mesh(name)) * radius * np.cos(base)
    )
    assert carried == pytest.approx(torque, rel=1e-9)
    assert flow.whole_curve("stage_1a").load == pytest.approx(0.5 * torque / radius, rel=1e-6)
