"""What is said to be left out of loaded teeth is true: in linear analyses, in time, and of what the laws of meshes hold."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.common.left_out import left_out
from rotorgear.analysis.common.mesh_notes import unlike_teeth_left_out
from rotorgear.analysis.response.orders import orders_of
from rotorgear.analysis.static import about_equilibrium
from rotorgear.analysis.static.about_equilibrium import along_faces
from rotorgear.analysis.static.mean_state import mean_state
from rotorgear.analysis.transient.notes import transient_left_out
from rotorgear.analysis.transient.request import rotation_of
from rotorgear.errors import AnalysisError
from rotorgear.forces.loaded_teeth import LoadedTeeth
from rotorgear.gears.maps import solved_map
from rotorgear.gears.maps.contact_map import ContactMap
from rotorgear.model.layout.mesh_layout import MeshLayout
from rotorgear.system.local import LocalModel, local_model
from rotorgear.system.system import System
from tests.models import spur_pair
from tests.unit.analysis.left_out.sentences import modes, numbers, pair, says, sentence
from tests.unit.analysis.written_maps import Approach, ripple, written
from tests.unit.gears.tooth_pairs import spur

K = 3e8
TEETH = {"stiffness": "tooth_fe"}


@pytest.fixture(autouse=True)
def rippling(monkeypatch: pytest.MonkeyPatch) -> None:
    """All loaded teeth are F = k (1 + .1 cos 2 pi u) delta, unless a test writes another."""
    write(monkeypatch, ripple(K, 0.1))


def write(monkeypatch: pytest.MonkeyPatch, approach: Approach, periods: int = 1) -> None:
    of_teeth = written(approach, periods)

    def contact_map(mesh: MeshLayout, *given: Any, **more: Any) -> ContactMap | None:
        return of_teeth(mesh, *given, **more) if mesh.part.stiffness == "tooth_fe" else None

    monkeypatch.setattr(MeshLayout, "contact_map", contact_map)


def loaded(**changes: Any) -> rg.Model:
    return pair(TEETH.items(), **changes)


def system_of(model: rg.Model) -> System:
    return System(model, 1)


def local_of(model: rg.Model) -> LocalModel:
    system = system_of(model)
    system = system.with_state(along_faces(model, [150.0], system.state))
    return local_model(system, rotation_of(system, None), 150.0)


def law_of(local: LocalModel, mesh: str = "pair") -> Any:
    return next(part.law for part in local.parts if part.part == f"meshes.{mesh}")


def test_weight_and_a_push_that_bearings_carry_are_named_and_change_no_mode_of_loaded_teeth() -> None:
    push = {"loads.push": {"shaft": "one", "at": "end", "force": [400.0, -900.0, 0.0]}}
    weight = {"operation.gravity": [0.0, -9.81, 0.0]}
    model = loaded()
    heavy = model.with_(push | weight)
    for found in (rg.modal(heavy, modes=4, elements=1), rg.critical(heavy, stop="9000 rpm", elements=1)):
        assert says(found, "loads.push", "bearings carry it, and the contacts do not feel where the shafts are")
        assert says(found, "operation.gravity", "bearings carry it")
    assert not says(rg.modal(model, modes=4, elements=1), "bearings carry it")
    assert modes(heavy) == pytest.approx(modes(model), rel=1e-12)
    # A torque changes what the teeth carry.
    turned = model.with_("loads.push", {"shaft": "one", "at": "end", "moment": [0.0, 0.0, 5.0]})
    assert not says(rg.modal(turned, modes=4, elements=1), "loads.push", "bearings carry it")


def test_the_mean_tangent_that_is_named_is_the_stiffness_of_modes() -> None:
    said = sentence(rg.modal(loaded(), modes=2, elements=1), "ripple of loaded teeth; the mean tangent is taken")
    share, taken = numbers(said)[:2]
    curve = system_of(loaded()).state.curves["pair"][0].about_load  # of the teeth themselves, whose map is written here
    assert share == pytest.approx(100.0 * np.ptp(curve.transverse) / curve.mean, rel=0.02)
    assert modes(loaded()) == pytest.approx(modes(pair({"stiffness": taken}.items())), rel=2e-4)


def test_without_a_state_over_the_cycle_the_tangent_at_the_torque_flow_is_taken(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def fails(*_: Any) -> Any:
        raise AnalysisError("no luck.")

    monkeypatch.setattr(about_equilibrium, "over_cycle", fails)
    found = rg.modal(loaded(), modes=8, elements=1, error_estimate=False)
    assert says(found, "there is no solution (no luck); the tangent at the force of the torque flow is taken")
    (force,) = loaded().torque_flow(1).forces
    assert found.eigenvalues == pytest.approx(modes(pair({"stiffness": force.contact.stiffness}.items())), rel=1e-9)


def test_teeth_without_tilt_do_not_feel_the_tilt_of_their_gears() -> None:
    """A gear that tilts in the plane of action, about the middle of its face, moves no flank: K of the mesh times it is 0."""
    system = system_of(loaded())
    assert all(
        says(left_out(system, kind, 150.0), "tilt along the face; set tilt = true") for kind in ("modes", "time")
    )

    def resists(model: rg.Model) -> float:
        of = system_of(model)
        node = 6 * of.nodes.at("one", 0.06)
        (group,) = (g for g in of.groups_at(0.0) if g.part == "meshes.pair")
        place = np.flatnonzero(np.isin(group.dofs[0], (node + 3, node + 4)))
        assert group.matrices.stiffness is not None
        return float(np.abs(group.matrices.stiffness[0][:, place]).max())

    assert resists(loaded()) == 0.0
    assert resists(pair({"stiffness": K, "tilt": True}.items())) > 0.0


def train(**changes: Any) -> rg.Model:
    """Three gears in a row, whose middle one has an odd tooth."""
    gear = {"at": "50 mm", "kind": "spur", "normal_module": "5 mm", "width": "30 mm", "teeth": 30}
    shafts = {"one": 0.0, "two": 0.15, "three": 0.3}
    return rg.Model(
        operation={"input_shaft": "one", "output_shaft": "three", "speed": 100.0, "torque": 200.0},
        shafts={
            name: {"position": [x, 0.0], "sections": [{"length": 0.1, "outer_diameter": 0.05}]}
            for name, x in shafts.items()
        },
        gears={
            "a": {"shaft": "one", **gear},
            "b": {"shaft": "two", **gear, "flank": {"pitch_errors": {"3": "8 um"}}},
            "c": {"shaft": "three", **gear},
        },
        meshes={"ab": {"pinion": "a", "gear": "b", **TEETH}, "bc": {"pinion": "b", "gear": "c", **TEETH}},
        bearings={
            f"{shaft}_{end}": {"shaft": shaft, "at": end, "stiffness": {"radial": 1e9, "axial": 1e9}}
            for shaft in shafts
            for end in ("start", "end")
        },
    ).with_(changes)


def test_teeth_whose_place_is_not_known_begin_with_tooth_0_whatever_the_angle() -> None:
    def begins(angle: float) -> list[float | None]:
        # The third shaft at another angle around the second one, the phase of its mesh given.
        place = [0.15 + 0.15 * np.cos(angle), 0.15 * np.sin(angle)]
        model = train(**{"meshes.bc.phase": "10 deg", "shafts.three.position": place})
        assert says(unlike_teeth_left_out(system_of(model)), "begin with tooth 0 in each, whatever the angle")
        load = model.torque_flow(1)
        return [load.path_phase(force.contact) for force in load.forces]

    assert begins(0.0) == pytest.approx(begins(1.0), abs=1e-12)
    known = [train(**{"shafts.three.position": place}).torque_flow(1) for place in ([0.3, 0.0], [0.15, 0.15])]
    assert not list(unlike_teeth_left_out(system_of(train())))
    assert known[0].path_phase(known[0].forces[1].contact) != known[1].path_phase(known[1].forces[1].contact)


def test_cycles_that_are_taken_one_at_a_time_do_not_know_each_others_ripple(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two stages: the first one's excitation is the same whether the second ripples or has the mean of its curve."""
    model = two_stages()

    def excitation(a: float) -> dict[str, np.ndarray]:
        def contact_map(mesh: MeshLayout, *given: Any) -> Any:
            return written(ripple(K, 0.1 if mesh.name == "first" else a))(mesh, *given)

        monkeypatch.setattr(MeshLayout, "contact_map", contact_map)
        setup = mean_state(System(model, 1, state=model.torque_flow(1).of_kind("static")), 100.0)
        said = sentence(setup.notes, "what the cycles of meshes")
        assert "first; second" in said or "second; first" in said
        return {order.name: order.force for order in orders_of(setup)[0]}

    # 1/(1 + a cos) and its mean over the cycle have one mean compliance: the mean curve of the second map is that of a / 2 too.
    one, other = (excitation(a) for a in (0.1, 0.1 + 1e-9))
    changed = excitation(0.3)
    assert one["mesh first 1x"] == pytest.approx(other["mesh first 1x"], rel=1e-6)
    size = np.abs(one["mesh first 1x"]).max()
    assert np.abs(changed["mesh first 1x"] - one["mesh first 1x"]).max() < 1e-6 * size
    assert np.abs(changed["mesh second 1x"]).max() > 2.0 * np.abs(one["mesh second 1x"]).max()


def two_stages() -> rg.Model:
    gear = {"at": "50 mm", "kind": "spur", "normal_module": "5 mm", "width": "30 mm"}
    shafts = {"one": 0.0, "two": 0.15, "three": 0.3}
    return rg.Model(
        operation={"input_shaft": "one", "output_shaft": "three", "speed": 100.0, "torque": 200.0},
        shafts={
            name: {"position": [x, 0.0], "sections": [{"length": 0.2, "outer_diameter": 0.05}]}
            for name, x in shafts.items()
        },
        gears={
            "a": {"shaft": "one", **gear, "teeth": 30},
            "b": {"shaft": "two", **gear, "teeth": 30},
            "c": {"shaft": "two", **gear, "at": "150 mm", "teeth": 23},
            "d": {"shaft": "three", **gear, "at": "150 mm", "teeth": 37},
        },
        meshes={"first": {"pinion": "a", "gear": "b", **TEETH}, "second": {"pinion": "c", "gear": "d", **TEETH}},
        bearings={
            f"{shaft}_{end}": {"shaft": shaft, "at": end, "stiffness": {"radial": 1e9, "axial": 1e9}}
            for shaft in shafts
            for end in ("start", "end")
        },
    )


def kinked(F: np.ndarray, u: np.ndarray) -> np.ndarray:
    return np.asarray(F / K + 1e-5 * np.maximum(np.abs(u % 1.0 - 0.5), 0.2))


def test_orders_of_loaded_teeth_that_are_left_out_are_as_weak_as_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    write(monkeypatch, kinked)
    found = rg.response(loaded(), speeds=[0.01], elements=1, method="direct")
    weak, change = numbers(sentence(found, "orders of their loaded teeth of up to"))[:2]
    u = np.arange(1024) / 1024
    exact = kinked(np.zeros(1), u)
    lines = np.abs(np.fft.rfft(exact[::8]))  # at the positions of the map
    number = np.round(found.ratio / 24).astype(int)
    left = np.delete(np.arange(1, 64), number - 1)
    assert 100.0 * lines[left].max() / lines[1:].max() == pytest.approx(weak, rel=0.1)
    whole = (found.approach[:, 0, 0] * np.exp(2j * np.pi * np.outer(u, number))).real.sum(axis=1)
    assert 100.0 * abs(np.ptp(whole) / np.ptp(exact) - 1.0) == pytest.approx(change, abs=0.15)


def odd_tooth(F: np.ndarray, u: np.ndarray) -> np.ndarray:
    late = np.abs(np.mod(u, 6) - 2.0)
    return np.asarray(F / K + 1e-6 * np.cos(2.0 * np.pi * u) + 4e-6 * np.maximum(1.0 - late / 0.7, 0.0))


def test_the_mesh_of_shafts_is_made_for_the_larger_orders_as_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    write(monkeypatch, odd_tooth, 6)
    found = rg.response(loaded(), speeds=[150.0], method="direct", modal_damping=0.03)
    said = sentence(found, "a finer mesh for")
    count, top, highest = numbers(said)[:3]
    above = found.frequency_hz[:, 0] > top * (1.0 + 1e-4)
    assert np.sum(above) == count
    assert found.frequency_hz.max() == pytest.approx(highest, rel=1e-4)
    # These are the small ones, and without them the mesh is the same.
    size = np.abs(found.approach[:, 0, 0])
    assert size[above].max() < 0.2 * size.max()
    assert (
        rg.response(loaded(), speeds=[150.0], method="direct", modal_damping=0.03, fmax=1.0001 * top).dofs == found.dofs
    )


def test_statics_without_tilt_do_not_feed_the_misalignment_back() -> None:
    soft = loaded(bearings__b__stiffness={"radial": "2e7 N/m", "axial": "5e7 N/m"})
    found = rg.static(soft, elements=1)
    said = sentence(found, "the teeth do not feel it; set tilt = true")
    assert found.mesh_deflection == pytest.approx(rg.static(loaded(), elements=1).mesh_deflection, rel=1e-6)
    # The misalignment that is said is the tilt of the two shafts against each other in the plane of action, over the face.
    pinion, wheel = (found.place_displacement[f"gears.{name}"] for name in ("pinion", "wheel"))
    slope = np.array([pinion[4] - wheel[4], wheel[3] - pinion[3]])  # of dx/dz, dy/dz
    normal = found.mesh_force_on_gear[0, :2] / np.linalg.norm(found.mesh_force_on_gear[0, :2])
    assert abs(numbers(said)[0]) == pytest.approx(1e6 * 0.03 * abs(float(slope @ normal)), rel=0.01)


def test_teeth_that_nothing_stops_behind_carry_nothing_there() -> None:
    local = local_of(loaded())
    assert says(
        transient_left_out(local), "meshes.pair: coast flanks; no backlash is given, so nothing stops teeth that part"
    )
    assert law_of(local).can_part
    assert law_of(local).evaluate(-1.0).force[0] == 0.0
    stopped = law_of(local_of(pair({**TEETH, "backlash": 1e-4}.items())))
    assert stopped.evaluate(-1e-3).force[0] < 0.0


def test_teeth_that_never_part_pull() -> None:
    local = local_of(pair())
    assert says(transient_left_out(local), "meshes.pair: contact loss; no backlash is given, so no teeth part")
    assert law_of(local).evaluate(-1e-6).force[0] == pytest.approx(-K * 1e-6, rel=1e-9)


def test_a_mesh_that_excites_nothing_is_the_same_at_all_angles() -> None:
    local = local_of(pair())
    assert says(
        transient_left_out(local), "meshes.pair: excitation; neither transmission error nor stiffness variation"
    )
    values = [law_of(local).evaluate(5e-6, angle=angle).force[0] for angle in np.linspace(0.0, 0.3, 7)]
    assert np.ptp(values) == 0.0
    assert not says(transient_left_out(local_of(spur_pair())), "excitation; neither")
    assert not says(transient_left_out(local_of(loaded())), "excitation; neither")


@pytest.mark.parametrize("name", ["iso", "potential_energy"])
def test_what_a_stiffness_model_does_not_know_does_not_act_in_time(name: str) -> None:
    local = local_of(pair({"stiffness": name}.items()))
    said = transient_left_out(local)
    law = law_of(local)
    at = np.linspace(0.0, 2.0 * np.pi / 24, 9)
    force = np.array([[law.evaluate(d, angle=angle).force[0] for angle in at] for d in (5e-6, 1e-5, 5e-5)])
    (curve,) = local.system.state.curves["pair"]
    if np.ptp(curve.transverse):
        assert np.ptp(force[0]) > 0.05 * force[0].mean()
    else:
        assert says(said, "ripple of the stiffness, which 'iso' does not know")
        assert np.ptp(force[0]) == 0.0
    if says(said, "what changes with the load"):
        assert f"F_bt = {curve.load:.4g} N" in sentence(said, "what changes with the load")
    # The load changes nothing: twice the deflection is twice the force, at each angle.
    assert force[1] == pytest.approx(2.0 * force[0], rel=1e-12)


def test_what_is_said_of_the_damping_of_loaded_teeth_is_what_it_does() -> None:
    law = replace(LoadedTeeth.examples()[0], error_cos=(), error_sin=())
    (said,) = law.left_out()
    c, k = numbers(said.split("; ")[1])[:2]
    deep = law.approach[0, -2]
    angle = float(-law.path_phase / law.order)
    value = law.evaluate(deep, 0.0, angle=angle)
    assert value.in_velocity[0, 0] == pytest.approx(c / k * value.in_displacement[0, 0], rel=0.03)
    assert not law.evaluate(-1e-4, 0.1, angle=angle).force.any()
    sinking = replace(law, contact_damping="penetration", reference=1e-5)
    (said,) = sinking.left_out()
    c, per = numbers(said.rpartition("damping is")[2])[:2]
    touch = law.approach[0, 0]
    found = sinking.evaluate(touch + 5e-6, 0.0, angle=angle).in_velocity[0, 0]
    assert found == pytest.approx(c * 5e-6 / (1e-6 * per), rel=1e-3)
    (said,) = replace(law, damping=0.0).left_out()
    assert said.endswith("no damping of the teeth is given")
    assert replace(law, damping=0.0).evaluate(deep, 0.1, angle=angle).in_velocity[0, 0] == 0.0


def test_teeth_have_no_inertia_of_their_own() -> None:
    """At any speed of the reference and any velocity without damping, the force is that of the position alone."""
    law = replace(LoadedTeeth.examples()[0], damping=0.0)
    assert says(law.left_out(), "inertia of the teeth on their bodies: they follow their static contact")
    d = law.approach[0, -2]
    forces = [
        law.evaluate(d, v, angle=0.1, speed=speed).force[0] for v, speed in ((0.0, 0.0), (0.3, 0.0), (0.0, 500.0))
    ]
    assert np.ptp(forces) == 0.0


def tilting(**mesh: Any) -> rg.Model:
    return pair({"stiffness": K, "tilt": True, **mesh}.items())


def test_meshes_that_stand_askew_resist_a_tilt_by_their_tangent_also_where_they_part() -> None:
    """What resists a tilt is in K of the structure, whatever the law of the contact does, and the coast flanks know no tilt."""
    local, plain = (local_of(model) for model in (tilting(backlash=1e-4), pair({"backlash": 1e-4}.items())))
    said = transient_left_out(local)
    assert says(
        said,
        "meshes.pair: how the load moves along the face in time",
        "resist a tilt by the tangent about it, even where",
    )
    assert says(said, "meshes.pair: how the tilt of the coast flanks changes in time")
    assert not says(transient_left_out(plain), "tilt")
    assert law_of(local).components == 1
    tilt = local.system.dofs.transform.T.tocsr()[:, [6 * local.system.nodes.at("one", 0.06) + 3]]
    extra = (tilt.T @ (local.local.K - plain.local.K) @ tilt).toarray()[0, 0]
    assert 0.0 < extra <= 1.001 * K * 0.03**2 / 12.0


def test_a_face_damps_by_its_mean_state() -> None:
    """Damping against a tilt acts at the place of the mean stiffness, and goes with what carries, whatever the tilt is."""
    law = next(law for law in LoadedTeeth.examples() if law.tilt.size)
    assert law.damping
    d = float(law.approach.max()) * 1.5
    for tilt in (float(law.tilt[0]), 0.0, float(law.tilt[-1])):
        value = law.evaluate([d, tilt])
        assert value.in_velocity[1] == pytest.approx(law.place * value.in_velocity[0], rel=1e-9)


def test_a_map_says_how_far_it_is_from_contacts_between_its_nodes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Few positions miss the kinks of a spur pair; at their worst as far as is said, or nearly."""
    teeth, load = spur(), 11_798.1
    few = solved_map.contact_map(teeth, load, 16)
    many = solved_map.contact_map(teeth, load, 128)
    u, share = np.random.default_rng(1).random((2, 400))
    force = load * 0.32 * 5.0**share
    apart = np.abs(few.approach_at(force, u) - many.approach_at(force, u)).max()
    assert many.error < 0.2 * few.error
    assert 0.5 * few.error < apart < 4.0 * few.error
    monkeypatch.setattr(MeshLayout, "contact_map", lambda mesh, *given, **more: few)
    for said in (transient_left_out(local_of(loaded())), rg.response(loaded(), speeds=[150.0], elements=1).left_out):
        assert numbers(sentence(said, "between positions and loads of the map"))[0] == pytest.approx(
            1e6 * few.error, rel=0.1
        )
