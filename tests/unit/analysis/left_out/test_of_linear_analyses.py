"""What linear analyses and statics say that they left out is true: with or without it, their numbers are the same."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.common.left_out import left_out
from rotorgear.analysis.transient.request import rotation_of
from rotorgear.elements.spring import rigid_transfer
from rotorgear.note import as_notes
from rotorgear.system.local import LocalModel, local_model
from rotorgear.system.system import System
from tests.models import bearing, cantilever, disk, spur_pair
from tests.unit.analysis.left_out.sentences import modes, numbers, pair, says, sentence

SPRING = {"law": "plain_spring", "shaft": "two", "at": "end", "directions": ["y"], "parameters": {"stiffness": 1e6}}
SECTION = {"length": 0.4, "outer_diameter": 0.03}


def overhung(**changes: Any) -> rg.Model:
    """A shaft with a thin disk that tilts as it swings."""
    return cantilever(SECTION).with_("disks", {"d": disk(mass=4.0, polar=0.08, tilt=0.04)}).with_(changes)


def in_time(model: rg.Model) -> LocalModel:
    """The model that is integrated in time."""
    system = System(model, 1)
    return local_model(system, rotation_of(system, None), 150.0)


def test_motions_that_are_absent_take_their_dofs_and_no_part() -> None:
    model = pair(motions=["torsion"])
    found = rg.modal(model, elements=1, error_estimate=False)
    count = System(pair(), 1).n - System(model, 1).n
    assert sentence(found, "not among the motions").startswith(f"bending and axial ({count} dofs):")
    stiffer = modes(model.with_("bearings.a.stiffness", {"radial": 4e9, "axial": 4e9}))
    assert np.array_equal(stiffer, modes(model))
    assert not np.array_equal(modes(pair(bearings__a__stiffness={"radial": 4e9, "axial": 4e9})), modes(pair()))
    still = rg.static(model, elements=1)
    assert sentence(still, "not among") == sentence(found, "not among the motions")
    assert not still.displacement[:, :5].any()


def test_dofs_that_supports_hold_do_not_move() -> None:
    model = overhung()
    found = rg.modal(model, modes=6, elements=1)
    (count,) = numbers(sentence(found, "held fixed by supports"))
    free = model.with_({"supports": {}, "bearings": {"b": bearing(x=1.0, y=1.0)}})
    assert System(free, 1).n - System(model, 1).n == count == 6
    assert not found.shapes[0].any()


def test_dofs_of_rigid_sections_are_tied() -> None:
    stiff = {**SECTION, "rigid": True}
    model = cantilever(SECTION, stiff).with_("disks", {"d": disk(mass=4.0)})
    found = rg.modal(model, modes=4, elements=1)
    (count,) = numbers(sentence(found, "tied by rigid sections"))
    assert System(cantilever(SECTION, SECTION), 1).n - System(model, 1).n == count
    first, last = (int(np.argmin(np.abs(found.nodes.position[:, 2] - z))) for z in (0.4, 0.8))
    carried = rigid_transfer(np.array([0.0, 0.0, 0.4])) @ found.shapes[first]
    assert found.shapes[last] == pytest.approx(carried, abs=1e-9)


def test_at_standstill_there_are_no_gyroscopic_terms() -> None:
    still, turning = (rg.modal(overhung(), modes=4, speed=speed, elements=2) for speed in (0.0, 300.0))
    assert says(still, "gyroscopic matrix: standstill")
    assert not says(turning, "gyroscopic")
    bending = [f.frequency_hz[f.kinetic_by_motion["bending"] > 0.5] for f in (still, turning)]
    assert bending[0][0] == pytest.approx(bending[0][1], rel=1e-9)
    assert bending[1][1] > 1.02 * bending[1][0]


def test_a_run_up_from_standstill_has_gyroscopic_terms() -> None:
    run = {"time": 0.001, "steps": 20, "elements": 1, "method": "newmark", "error_estimate": False}
    rising = rg.transient(spur_pair(), speed="0 rpm", speed_to="1500 rpm", **run)
    still = rg.transient(spur_pair(), speed=0.0, **run)
    assert says(still, "gyroscopic matrix: standstill")
    assert not says(rising, "gyroscopic")


def test_without_tilt_nothing_is_gyroscopic() -> None:
    model = pair(motions=["torsion"])
    turning = rg.modal(model, speed=150.0, modes=4, elements=1, error_estimate=False)
    assert says(turning, "gyroscopic matrix: nothing that turns can tilt")
    system = System(model, 1)
    assert (system.velocity_terms(150.0) != system.damping(150.0)).nnz == 0
    assert (System(pair(), 1).velocity_terms(150.0) != System(pair(), 1).damping(150.0)).nnz


def test_an_undamped_analysis_has_no_damping() -> None:
    thin, thick = (pair({"damping_ratio": ratio}.items()) for ratio in (0.01, 0.2))
    assert says(rg.modal(thin, modes=4, elements=1), "meshes.pair.damping_ratio", "undamped")
    assert np.array_equal(modes(thin), modes(thick))
    assert not modes(thick).real.any()
    assert not np.allclose(modes(thin, speed=0.0), modes(thick, speed=0.0), rtol=1e-3)
    critical = [rg.critical(model, stop="9000 rpm", elements=1, damped=False) for model in (thin, thick)]
    assert says(critical[0], "meshes.pair.damping_ratio", "undamped")
    assert [c.speed for c in critical[0].speeds] == [c.speed for c in critical[1].speeds]


def test_where_nothing_damps_no_motion_decays() -> None:
    found = rg.modal(overhung(), modes=6, speed=100.0)
    assert says(
        found, "damping matrix: nothing damps; give bearings or meshes a damping, or modal_ratio under [damping]"
    )
    assert np.all(np.abs(found.eigenvalues.real) < 1e-9 * np.abs(found.eigenvalues))
    damped = overhung(**{"damping.rayleigh_beta": 1e-5})
    assert not says(rg.modal(damped, modes=2, speed=100.0), "damping matrix")


CROSSED = {"x": 2e7, "y": 2e7, "xy": 3e6, "yx": -3e6}


def test_damping_by_the_stiffness_takes_its_symmetric_part() -> None:
    model = overhung(
        **{"bearings": {"b": {"shaft": "rotor", "at": "end", "stiffness": CROSSED}}, "damping.rayleigh_beta": 1e-4}
    )
    assert says(rg.modal(model, modes=2, speed=50.0), "rayleigh_beta acts on the symmetric part of K")
    system = System(model, 1)
    K = system.stiffness(50.0).toarray()
    assert pytest.approx(K.T, rel=1e-12) == K
    assert system.circulatory(50.0).nnz
    assert system.damping(50.0).toarray() == pytest.approx(1e-4 * K, rel=1e-9, abs=1e-9)


def test_in_time_laws_damp_as_they_say_and_not_by_the_stiffness() -> None:
    given = {"nonlinear_elements": {"n": SPRING}}
    plain, damped = (in_time(pair(**given, damping__rayleigh_beta=beta)) for beta in (0.0, 1e-4))
    said = left_out(damped.system, "time", 150.0)
    assert says(said, "nonlinear_elements.n: beta K; rayleigh_beta acts on the tangent in linear analyses")
    of_law = [next(p.law for p in local.parts if p.part == "nonlinear_elements.n") for local in (plain, damped)]
    assert of_law[0] == of_law[1]
    support = {"shaft": "two", "at": "end", "stiffness": {"y": 1e6}}
    linear = modes(pair(**given, damping__rayleigh_beta=1e-4), speed=0.0)
    assert linear == pytest.approx(
        modes(pair(supports={"n": support}, damping__rayleigh_beta=1e-4), speed=0.0), rel=1e-8
    )


BALLS = {"kind": "ball", "elements": 9, "element_diameter": 0.0115, "pitch_diameter": 0.0435, "clearance": 1e-5}


def test_of_two_descriptions_of_a_bearing_the_one_that_is_said_counts() -> None:
    given, other = (spur_pair(bearings__a__rolling={**BALLS, "elements": n}) for n in (9, 8))
    assert says(rg.modal(given, modes=2, elements=1), "bearings.a.rolling: the stiffness carries")
    assert np.array_equal(modes(given), modes(other))
    assert np.array_equal(rg.static(given, elements=1).displacement, rg.static(other, elements=1).displacement)
    stiff = given.with_("bearings.a.stiffness", {"radial": 9e9, "axial": 9e9})
    local = [in_time(model) for model in (given, stiff)]
    assert says(left_out(local[0].system, "time", 150.0), "bearings.a.stiffness", "the rolling elements carry")
    assert (local[0].local.K != local[1].local.K).nnz == 0


LIST = (2.6e8, 3.4e8, 3.2e8, 2.8e8)


def test_of_a_given_list_of_stiffnesses_the_mean_is_taken() -> None:
    varied = pair({"stiffness": LIST}.items())
    said = sentence(rg.modal(varied, modes=2, elements=1), "ripple of the given stiffness")
    assert numbers(said)[0] == pytest.approx(100.0 * 8e7 / 3e8, rel=1e-2)
    assert f"{np.mean(LIST):.4g} N/m" in said
    assert modes(varied) == pytest.approx(modes(pair({"stiffness": float(np.mean(LIST))}.items())), rel=1e-12)


@pytest.mark.parametrize("name", ["iso", "potential_energy"])
def test_of_a_model_of_the_stiffness_the_mean_is_taken(name: str) -> None:
    model = pair({"stiffness": name}.items())
    said = sentence(rg.modal(model, modes=2, elements=1), "the mean stiffness of")
    (curve,) = System(model).state.curves["pair"]
    if np.ptp(curve.transverse):
        assert numbers(said)[0] == pytest.approx(100.0 * np.ptp(curve.transverse) / curve.mean, rel=1e-2)
    else:
        assert "which 'iso' does not know" in said
    taken = next(x for x in numbers(said) if x > 1e7)
    assert modes(model) == pytest.approx(modes(pair({"stiffness": taken}.items())), rel=1e-3)


CONSTANT = {"shaft": "two", "at": 0.06, "force": [0.0, -300.0, 0.0]}


def test_loads_are_left_out_as_each_analysis_says(tmp_path: Any) -> None:
    (tmp_path / "pull.csv").write_text("time_s,force_x_N\n0,40\n1,90\n")
    shaking = {**CONSTANT, "order": 1.0}
    bare, pushed = pair(), pair(loads={"push": CONSTANT})
    assert says(rg.modal(pushed, modes=2, elements=1), "loads.push (300 N): free vibrations have no excitation")
    assert np.array_equal(modes(pushed), modes(bare))
    places = {"inputs": ["gears.pinion:y"], "outputs": ["gears.wheel:y"], "elements": 1}
    frf = [rg.frf(model, [200.0, 900.0], **places) for model in (bare, pushed)]
    assert says(frf[1], "loads.push (300 N): a frequency response is that to unit forces")
    assert np.array_equal(frf[0].receptance, frf[1].receptance)
    still = [rg.static(model, elements=1) for model in (bare, pair(loads={"push": shaking}))]
    assert says(still[1], "loads.push (300 N): a harmonic load has no constant part")
    assert np.array_equal(still[0].displacement, still[1].displacement)
    history = {"shaft": "two", "at": 0.06, "history": str(tmp_path / "pull.csv")}
    at_zero = {**CONSTANT, "force": [40.0, 0.0, 0.0]}
    still = [rg.static(pair(loads={"push": load}), elements=1) for load in (history, at_zero)]
    assert says(still[0], "loads.push (40 to 90): what varies of the history; the values at time 0 act")
    assert still[0].displacement == pytest.approx(still[1].displacement, rel=1e-12)
    unbalanced = {"unbalances": {"u": {"shaft": "two", "at": 0.06, "magnitude": 1e-4}}}
    shaken = [
        rg.response(pair(loads={"push": load}, **unbalanced), speeds=[90.0], elements=1) for load in (history, at_zero)
    ]
    assert says(shaken[0], "loads.push (40 to 90): history over time; only the values at time 0 act")
    assert np.array_equal(shaken[0].bearing_force, shaken[1].bearing_force)
    torsion = pair(motions=["torsion"], loads={"push": CONSTANT})
    assert says(rg.static(torsion, elements=1), "loads.push (300 N): force y; whose motion is not among")
    assert np.array_equal(
        rg.static(torsion, elements=1).displacement, rg.static(pair(motions=["torsion"]), elements=1).displacement
    )


def test_without_gravity_nothing_weighs() -> None:
    light, heavy = (
        overhung(**{"disks.d.mass": mass, "loads": {"push": {"shaft": "rotor", "at": "end", "force": [1.0, 0.0, 0.0]}}})
        for mass in (4.0, 400.0)
    )
    assert says(rg.static(light), "weight: no gravity given")
    assert np.array_equal(rg.static(light).displacement, rg.static(heavy).displacement)
    weighs = heavy.with_("operation", {"input_shaft": "rotor", "gravity": [0.0, -9.81, 0.0]})
    assert not says(rg.static(weighs), "weight")


def test_stiffness_to_ground_of_turning_shafts_is_not_in_statics() -> None:
    def held(torsion: float) -> Any:
        brake = {"shaft": "two", "at": "0 mm", "stiffness": {"torsion": torsion}}
        return rg.static(spur_pair(supports={"brake": brake}), elements=1)

    assert says(held(1e5), "supports.brake: torsional stiffness to ground")
    assert held(1e5).mesh_force == pytest.approx(held(1e8).mesh_force, rel=1e-12)


def test_campbell_says_what_it_does_not_draw() -> None:
    model = spur_pair()
    found = rg.campbell(model, points=3, modes=8, elements=1, start="1000 rpm", stop="1400 rpm")
    (count,) = numbers(sentence(found, "rigid-body mode").split(" rigid")[0])
    modal = rg.modal(model, speed="1200 rpm", modes=8, elements=1)
    assert count == np.sum(modal.rigid) == 1
    assert says(found, "margins: the operating speed lies outside of the range")
    assert not found.margins
    inside = rg.campbell(model, points=3, modes=8, elements=1, start="1000 rpm", stop="2000 rpm")
    assert not says(inside, "margins")
    without = rg.campbell(overhung(), points=2, modes=4, elements=1, stop="2000 rpm")
    assert says(without, "margins: the model has no operating speed")


def test_motions_without_oscillation_are_not_drawn() -> None:
    sticky = {"shaft": "rotor", "at": "end", "stiffness": {"x": 1e3, "y": 1e3}, "damping": {"x": 1e5, "y": 1e5}}
    model = overhung(bearings={"b": sticky})
    found = rg.campbell(model, points=2, modes=6, elements=1, stop="2000 rpm")
    assert says(found, "motions that do not oscillate (overdamped)")
    assert np.all(found.eigenvalues.imag.max(axis=0) > 0.0)
    values = rg.modal(model, speed=0.0, modes=6, elements=1).eigenvalues
    assert np.any((values.imag == 0.0) & (values.real < 0.0))


def test_groups_that_are_solved_apart_do_not_act_on_each_other() -> None:
    found = rg.modal(overhung(), modes=6, elements=2)
    said = sentence(found, "solved apart")
    system = System(overhung(), 2)
    from scipy.sparse.csgraph import connected_components

    coupled = abs(system.mass) + abs(system.stiffness())
    assert numbers(said)[0] == connected_components(coupled)[0]


def test_modes_that_the_request_damps_are_damped() -> None:
    tip = {"tip": {"shaft": "rotor", "at": "end", "direction": "y"}}
    bare = cantilever({"length": 0.4, "outer_diameter": 0.03}).with_("points", tip)
    places = {"inputs": ["tip"], "outputs": ["tip"]}
    for ratio in (0.0, 0.03):
        found = rg.frf(bare, [20.0], **places, modal_damping=ratio, elements=1)
        assert ("damping matrix" in {note.what for note in as_notes(found.left_out)}) == (not ratio)
