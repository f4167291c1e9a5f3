"""What responses, gear sheets, maps, orbits and films say that they left out is true."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.forces.journal_film import JournalFilm
from tests.models import spur_pair
from tests.paths import MODELS
from tests.unit.analysis.left_out.sentences import numbers, pair, says, sentence

SPEED = "1500 rpm"


def answer(model: rg.Model, **more: Any) -> rg.ResponseResult:
    return rg.response(model, **{"speeds": [SPEED], "elements": 1, "method": "direct", **more})


def varied(share: float, **changes: Any) -> rg.Model:
    return pair({"stiffness_variation": [{"harmonic": 1, "amplitude": share}]}.items(), **changes)


def test_varying_stiffness_acts_to_first_order() -> None:
    one, two = (answer(varied(share)) for share in (0.01, 0.02))
    assert says(one, "the product of its varying stiffness and the vibration; it acts to first order, as a force")
    assert two.mesh_force == pytest.approx(2.0 * one.mesh_force, rel=1e-9)


def test_torques_balance_as_without_friction() -> None:
    smooth, rough = (
        spur_pair(motions=["torsion"], bearings=None, points=None, meshes__pair__friction_coefficient=mu)
        for mu in (0.0, 0.1)
    )
    run = rg.transient(rough, time=1e-3, elements=1, error_estimate=False)
    assert says(run, "meshes.pair: what friction takes of the torques; they balance as without it")
    assert rg.check(rough).to_dict()["torques"] == rg.check(smooth).to_dict()["torques"]


UNBALANCED = {"unbalances": {"u": {"shaft": "two", "at": 0.06, "magnitude": 1e-4}}}


def test_without_torque_varying_stiffness_excites_nothing() -> None:
    still, varies = (
        answer(pair(mesh, operation__torque=None, **UNBALANCED))
        for mesh in ((), {"stiffness_variation": [{"harmonic": 1, "amplitude": 0.1}]}.items())
    )
    assert says(varies, "meshes.pair: stiffness variation; no torque, so no mean force that it acts on")
    assert (still.orders, varies.orders) == (("shaft two 1x",), ("shaft two 1x", "mesh pair 1x"))
    assert varies.bearing_force[0] == pytest.approx(still.bearing_force[0], rel=1e-12)
    assert not varies.bearing_force[1].any()


def test_orders_above_the_limit_are_left_out_and_no_others() -> None:
    whole = answer(spur_pair())
    limit = 0.5 * (whole.frequency_hz[0, 0] + whole.frequency_hz[1, 0])
    some = answer(spur_pair(), fmax=limit)
    assert sentence(some, "above") == f"mesh pair 2x: above {limit:g} Hz at the highest speed"
    assert some.orders == whole.orders[:1]
    assert some.mesh_force[0] == pytest.approx(whole.mesh_force[0], rel=1e-9)


LIST = [float(k) for k in 3e8 * (1.0 + 0.2 * np.array([0.0, 1.0, 0.4, -0.5, -1.0, 0.6]))]


@pytest.mark.parametrize(
    ("what", "mesh"),
    [
        ("stiffness", {"stiffness": LIST}),
        ("corner impact", {"corner_impact": {"force": 40.0, "duration": 0.3, "at": 0.2}}),
    ],
)
def test_harmonics_that_are_left_out_are_as_weak_as_is_said(what: str, mesh: dict[str, Any]) -> None:
    found = answer(pair(mesh.items()))
    (share,) = numbers(sentence(found, f"harmonics of its {what} of up to").split(" % ")[0])
    kept = {int(name.rpartition(" ")[2].removesuffix("x")) for name in found.orders}
    u = np.arange(60000) / 60000
    if what == "stiffness":
        x = np.interp(u, np.arange(7) / 6, [*LIST, LIST[0]])
    else:
        late = (u - 0.2) % 1.0
        x = np.where(late < 0.3, np.sin(np.pi * late / 0.3), 0.0)
    size = np.abs(np.fft.rfft(x))[1:2000]
    left = [size[n - 1] for n in range(1, 2000) if n not in kept]
    assert 100.0 * max(left) / size.max() == pytest.approx(share, rel=0.05)


def test_torques_that_change_with_speed_or_step_do_so_in_time_only() -> None:
    def run(**brake: Any) -> rg.ResponseResult:
        shafts = {"one": {"kind": "input", "torque": 200.0}, "two": {"kind": "output", **brake}}
        loads = {f"on_{name}": {"shaft": name, **load} for name, load in shafts.items()}
        return answer(spur_pair(operation__torque=None, operation__output_shaft=None, loads=loads))

    plain, bent, step = run(), run(speed_power=2.0), run(step_at="0.1 s", step_to=0.5)
    assert says(bent, "loads.on_two.speed_power (2): only motions over time take it")
    assert bent.mesh_force == pytest.approx(plain.mesh_force, rel=1e-12)
    assert says(step, "loads.on_two.step_to (0.5): only motions over time take it")
    assert step.mesh_force == pytest.approx(plain.mesh_force, rel=1e-12)


def test_springs_to_ground_carry_no_mean_torque_in_a_response() -> None:
    def held(k: float) -> rg.ResponseResult:
        return answer(spur_pair(supports={"brake": {"shaft": "two", "at": "0 mm", "stiffness": {"torsion": k}}}))

    soft, stiff = held(1e3), held(1e6)
    assert says(soft, "supports.brake: mean torque in the torsional stiffness to ground")
    assert stiff.mean_force == pytest.approx(soft.mean_force, rel=1e-9)
    assert not np.allclose(stiff.mesh_force, soft.mesh_force, rtol=1e-3)


def test_a_gear_sheet_leaves_out_gears_without_teeth_and_stiffness_without_torque() -> None:
    without = rg.gear(pair({"stiffness": "tooth_fe"}.items(), operation__torque=None))
    assert says(without, "is that of loaded teeth, and no torque flows")
    assert [row.stiffness_n_per_m for row in without.meshes] == [None]
    lumped = rg.Model(
        shafts={"one": {}, "two": {}, "three": {}},
        gears={
            **{
                name: {"shaft": shaft, "at": "start", "kind": "spur", "teeth": 20, "normal_module": 0.004, "width": 0.03}
                for name, shaft in (("a", "one"), ("b", "two"))
            },
            "c": {"shaft": "three", "at": "start", "kind": "spur", "base_radius": 0.05, "mass": 1.0, "polar_inertia": 0.01,
                  "diametral_inertia": 0.01},
        },
    )  # fmt: skip
    sheet = rg.gear(lumped)
    assert sentence(sheet, "gears.c") == "gears.c: given by its base radius, without teeth"
    assert [row.name for row in sheet.gears] == ["a", "b"]


TEETH = {"meshes__pair__stiffness": "tooth_fe", "meshes__pair__transmission_error": []}


def test_a_map_over_torques_has_no_estimate_and_the_first_period_only() -> None:
    plain, odd = (
        rg.mesh_map(spur_pair(**TEETH, gears__pinion__flank=flank), over={"torque": [200.0]}, positions=32)
        for flank in ({}, {"pitch_errors": {"12": "8 um"}})
    )
    assert says(odd, "error estimates: `rotorgear mesh` gives them for one point")
    assert not [name for name in vars(odd) if "estimate" in name]
    assert says(odd, "errors of single teeth beyond the first mesh period")
    # The odd tooth comes twelve periods later: the first one is that of a pair without it.
    assert odd.ste_peak_to_peak == pytest.approx(plain.ste_peak_to_peak, rel=1e-9)


def test_roots_are_those_of_teeth_that_are_all_alike() -> None:
    plain, odd = (
        rg.root_stress(spur_pair(**TEETH, gears__pinion__flank=flank), torque=200.0, preset="preview", positions=4)
        for flank in ({}, {"pitch_errors": {"0": "8 um"}})
    )
    assert says(odd, "errors of single teeth: all teeth are taken alike")
    assert not says(plain, "errors of single teeth")
    assert says(plain, "a strength rating: factors of load, size, surface and material")
    for first, second in zip(plain.gears, odd.gears, strict=True):
        assert second.at_tangent == pytest.approx(first.at_tangent, rel=1e-9)


def test_a_film_knows_no_tilt_of_its_journal() -> None:
    law = JournalFilm.examples()[0]
    assert law.left_out() == ("heat, turbulence and tilt of the journal in its film",)
    assert law.components == 2  # forces across its axis, no moments
    assert not {"turbulence", "reynolds"} & set(law.declared())


def test_layouts_and_updates_leave_damping_out() -> None:
    plain = rg.load(MODELS / "jeffcott.toml")
    damped = plain.with_("bearings.*.damping", {"radial": 2e4})
    layouts = [
        rg.optimise(model, "shafts.*.sections.*.outer_diameter", margin="25 %", searches=1, elements=1)
        for model in (plain, damped)
    ]
    assert all(says(layout, "damping: frequencies are those of the undamped rotating system") for layout in layouts)
    assert layouts[0].numbers == layouts[1].numbers
    rigs = [rg.update(model, [20.0, 125.5], free="bearings.*.stiffness", elements=2) for model in (plain, damped)]
    assert all(says(rig, "damping and rotation: lines are undamped natural frequencies") for rig in rigs)
    assert [row.factor for row in rigs[0].parameters] == [row.factor for row in rigs[1].parameters]
    # Damping that is left out does move what a rig would see.
    seen = [rg.modal(model, speed=1.0, modes=8, elements=2).frequency_hz for model in (plain, damped)]
    assert np.abs(seen[1] - seen[0]).max() > 1e-3
