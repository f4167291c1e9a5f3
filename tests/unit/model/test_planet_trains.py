"""Trains with carriers: speeds of all members as exact fractions by Willis, and torques that do no work in any free rotation."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest

import rotorgear as rg
from tests.planetary import helical_stage, torsional_train

SIMPLE = {
    "shafts": "s r c",
    "gears": "gs s 27, gp p 36, gr r -99",
    "meshes": "gs gp, gp gr",
    "carriers": "k c 3",
    "planets": "p k",
}
RAVIGNEAUX = {
    "shafts": "ss sl r c",
    "gears": "gss ss 28, gsl sl 36, gps ps 20, gpl pl 31, gr r -98",
    "meshes": "gss gps, gps gpl, gsl gpl, gpl gr",
    "carriers": "k c 2",
    "planets": "ps k, pl k",
}
SIMPSON = {
    "shafts": "s r1 r2 c1 c2",
    "gears": "g1 s 33, p1 q1 21, h1 r1 -75, g2 s 33, p2 q2 21, h2 r2 -75",
    "meshes": "g1 p1, p1 h1, g2 p2, p2 h2",
    "carriers": "k1 c1 3, k2 c2 3",
    "planets": "q1 k1, q2 k2",
    "couplings": "c1 r2",
}
TRAINS = {
    "ring held": ("s", SIMPLE, "r 0", "c", {"c": "3/14", "p#1": "-3/8"}, {"c": "-14/3", "r": "11/3"}),
    "sun held": ("r", SIMPLE, "s 0", "c", {"c": "11/14", "p#2": "11/8"}, {"c": "-14/11", "s": "3/11"}),
    "star": ("s", SIMPLE, "c 0", "r", {"r": "-3/11", "p#3": "-3/4"}, {"r": "11/3", "c": "-14/3"}),
    "stepped planets": (
        "s",
        {**SIMPLE, "gears": "gs s 24, gb p 53, gm p 19, gr r -96", "meshes": "gs gb, gm gr"},
        "r 0",
        "c",
        {"c": "19/231", "p#1": "-1/3"},
        {"c": "-231/19", "r": "212/19"},
    ),
    "Ravigneaux, carrier held": ("ss", RAVIGNEAUX, "c 0", "r", {"r": "2/7", "sl": "-7/9"}, {"r": "-7/2", "c": "5/2"}),
    "Ravigneaux, large sun held": (
        "ss",
        RAVIGNEAUX,
        "sl 0",
        "r",
        {"r": "67/112", "c": "7/16", "pl#1": "469/496", "ps#2": "-7/20"},
        {"r": "-112/67", "sl": "45/67"},
    ),
    "Wolfrom": (
        "s",
        {
            "shafts": "s r1 r2 c",
            "gears": "gs s 21, gb p 43, gm p 40, h1 r1 -107, h2 r2 -104",
            "meshes": "gs gb, gb h1, gm h2",
            "carriers": "k c 1",
            "planets": "p k",
        },
        "r1 0",
        "r2",
        {"r2": "63/8944", "c": "21/128", "p#1": "-21/86"},
        {"r2": "-8944/63", "r1": "8881/63"},
    ),
    "two in series": (
        "s1",
        {
            "shafts": "s1 r1 c1 s2 r2 c2",
            "gears": "a s1 27, b p1 36, d r1 -99, e s2 24, f p2 30, g r2 -84",
            "meshes": "a b, b d, e f, f g",
            "carriers": "k1 c1 3, k2 c2 3",
            "planets": "p1 k1, p2 k2",
            "couplings": "c1 s2",
        },
        "r1 0, r2 0",
        "c2",
        {"c2": "1/21", "s2": "3/14", "p2#1": "-3/35"},
        {"c2": "-21", "r1": "11/3", "r2": "49/3"},
    ),
    "differential": ("s", SIMPLE, "r -0.2", "c r", {"c": "2/35", "p#1": "-13/20"}, {"c": "-14/3", "r": "11/3"}),
    "Simpson, common sun held": ("r1", SIMPSON, "s 0", "c1", {"c1": "25/36", "c2": "625/1296"}, {"s": "11/25"}),
    "Simpson, rear carrier held": ("r1", SIMPSON, "c2 0", "c1", {"s": "-625/671", "c1": "25/61"}, {"c2": "36/25"}),
    "meshed planets": (
        "s",
        {
            "shafts": "s r c",
            "gears": "gs s 30, g1 p1 17, g2 p2 17, gr r -78",
            "meshes": "gs g1, g1 g2, g2 gr",
            "carriers": "k c 3",
            "planets": "p1 k, p2 k",
        },
        "r 0",
        "c",
        {"c": "-5/8", "p1#1": "-475/136", "p2#1": "305/136"},
        {"c": "8/5", "r": "-13/5"},
    ),
}


def mesh_torques(model: rg.Model) -> dict[str, float]:
    """What comes into each shaft from outside (N m about +z) for the forces of all meshes."""
    found = dict.fromkeys(model.shafts, 0.0)
    for force in model.torque_flow(1).forces:
        contact = force.contact
        pressed = force.normal_force * force.torque_sense * math.cos(contact.base_helix_angle)
        carrier = model.layout.carrier_place(contact.mesh)
        for place, lever in zip((contact.pinion_place, contact.gear_place), contact.levers, strict=True):
            found[place.shaft] += pressed * lever
            if carrier is not None:
                found[carrier.shaft] -= pressed * lever
    return found


@pytest.mark.parametrize("name", TRAINS)
def test_speeds_are_exact_and_torques_balance(name: str) -> None:
    driven, train, given, output, speeds, torques = TRAINS[name]
    model = torsional_train(driven, **train, given=given, loads=output)  # type: ignore[arg-type]
    ratios = model.layout.train.ratios
    assert {shaft: ratios[shaft] for shaft in speeds} == {shaft: Fraction(text) for shaft, text in speeds.items()}
    found = mesh_torques(model)
    # A coupling hands on what the meshes of both its ends take.
    joined = {coupling.to_shaft: coupling.from_shaft for coupling in model.couplings.values()}
    outside: dict[str, float] = {}
    for shaft, torque in found.items():
        outside[joined.get(shaft, shaft)] = outside.get(joined.get(shaft, shaft), 0.0) + torque
    for shaft, text in torques.items():
        assert outside[shaft] == pytest.approx(float(Fraction(text)), rel=1e-12)
    assert outside[driven] == pytest.approx(1.0, rel=1e-12)
    # Coaxial members hold each other, planets turn freely on their pins, and no power is lost.
    assert sum(outside.values()) == pytest.approx(0.0, abs=1e-11)
    assert max(abs(torque) for shaft, torque in outside.items() if "#" in shaft) < 1e-12
    assert sum(torque * float(ratios[shaft]) for shaft, torque in found.items()) == pytest.approx(0.0, abs=1e-11)


def test_nothing_that_says_how_a_ring_turns_is_an_error_with_its_address() -> None:
    with pytest.raises(rg.ModelError, match=r"shafts\.r\.speed_ratio: missing: nothing says how 'r', 'c' turn"):
        torsional_train("s", **SIMPLE)


def test_a_speed_that_two_paths_contradict_is_an_error_with_both_values() -> None:
    with pytest.raises(rg.ModelError, match=r"shafts\.c\.speed_ratio: got 0\.3, expected 0\.214285714 \(3/14\)"):
        torsional_train("s", **SIMPLE, given="r 0, c 0.3")


def test_a_train_that_is_locked_is_an_error() -> None:
    with pytest.raises(rg.ModelError, match=r"expected a train that turns \(the input shaft 's' stands still then"):
        torsional_train("s", **SIMPLE, given="r 0, c 0")


def test_planets_that_can_not_be_put_in_are_refused() -> None:
    with pytest.raises(rg.ModelError, match=r"meshes\.gp_gr: got teeth that miss by 0\.\d+ of a pitch") as caught:
        torsional_train("s", **{**SIMPLE, "carriers": "k c 4"}, given="r 0", loads="c")
    assert len(caught.value.problems) == 1


def test_planets_that_touch_are_refused_once() -> None:
    with pytest.raises(rg.ModelError, match="planets that do not touch") as caught:
        torsional_train("s", **{**SIMPLE, "carriers": "k c 6"}, given="r 0", loads="c")
    assert len(caught.value.problems) == 1


def test_pins_at_unequal_angles_are_multiples_of_the_angle_of_one_tooth() -> None:
    tooth = 360.0 / 126
    text = helical_stage().replace("planets = 3", f'angles = ["0 deg", "{41 * tooth} deg", "{85 * tooth} deg"]')
    assert rg.loads(text).layout.assembly.loops
    with pytest.raises(rg.ModelError, match="teeth that miss"):
        rg.loads(helical_stage().replace("planets = 3", 'angles = ["0 deg", "118 deg", "243 deg"]'))


def test_one_planet_may_differ_and_the_model_is_written_as_it_was_read() -> None:
    model = rg.loads(helical_stage(more='[meshes."sun_planet#2"]\nindex_error = "10 um"'))
    assert [model.meshes[f"sun_planet#{k}"].index_error for k in (1, 2, 3)] == pytest.approx([0.0, 1e-5, 0.0])
    again = model.with_("meshes.sun_planet.stiffness", 5e8)
    assert [again.meshes[f"sun_planet#{k}"].stiffness for k in (1, 2, 3)] == [5e8] * 3
    assert again.meshes["sun_planet#2"].index_error == pytest.approx(1e-5)
    assert "planet#1" not in model.written.shafts
    assert list(model.model_dump()["meshes"]) == ["sun_planet", "planet_ring", "sun_planet#2"]
    with pytest.raises(rg.ModelError, match=r'meshes\."sun_planet#4"'):
        rg.loads(helical_stage(more='[meshes."sun_planet#4"]\nindex_error = "10 um"'))
