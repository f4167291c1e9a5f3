"""What linear analyses say that they leave out of planets."""

from __future__ import annotations

import rotorgear as rg
from tests.planetary import helical_stage

TORQUE = '[operation]\ntorque = 400\noutput_shaft = "carrier"'
OF_TORQUE = "what the torque brings where pins and flanks turn with the carrier"
OF_SHAFTS = "stiffness by the centrifugal load in the planets' own shafts"


def of_carrier(found: rg.Result) -> set[str]:
    return {fact.what for fact in found.facts if fact.part == "carriers.stage" and fact.about == "left out"}


def test_what_the_torque_brings_is_told_where_the_carrier_turns_under_one() -> None:
    free = rg.loads(helical_stage(3))
    loaded = rg.loads(helical_stage(3).replace("[operation]", TORQUE))
    assert of_carrier(rg.modal(loaded, speed="1000 rpm", modes=4)) == {OF_TORQUE}
    assert of_carrier(rg.modal(loaded, modes=4)) == set()  # at rest nothing turns the pins
    assert of_carrier(rg.modal(free, speed="1000 rpm", modes=4)) == set()


def test_a_held_carrier_leaves_nothing_of_its_turning_out() -> None:
    star = helical_stage(3).replace("[shafts.carrier]", "[shafts.carrier]\nspeed_ratio = 0")
    star = star.replace("[shafts.ring]\nspeed_ratio = 0", "[shafts.ring]")
    model = rg.loads(star.replace("[operation]", TORQUE.replace('"carrier"', '"ring"')))
    assert of_carrier(rg.modal(model, speed="1000 rpm", modes=4)) == set()


def test_shafts_of_planets_are_not_stiffened_and_points_have_none() -> None:
    model = rg.load("models/planetary.toml")
    assert of_carrier(rg.modal(model, speed="1800 rpm", modes=4)) == {OF_TORQUE, OF_SHAFTS}
    assert of_carrier(rg.modal(model, modes=4)) == set()


def test_planets_at_unequal_angles_have_no_classes() -> None:
    text = helical_stage(3).replace("planets = 3", 'angles = ["0 deg", "120 deg", "234.2857142857143 deg"]')
    found = rg.modal(rg.loads(text), modes=4)
    assert found.mode_class == ()
    assert of_carrier(found) == {"classes of modes"}
    assert rg.modal(rg.loads(helical_stage(2, teeth=(28, 36, 100))), modes=4).mode_class
