"""Excitations of planets that go round: which class they move, and at which side of the order the ground feels it."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from tests.planetary import GROUND, Springs, helical_stage

CENTRAL = ("gears.sun", "gears.ring", "disks.carrier")
TEETH = {3: (28, 35, 98), 4: (26, 36, 98), 5: (24, 26, 76)}


def stage(planets: int, more: str = "", ground: dict[str, Springs] | None = None) -> rg.Model:
    """A stage whose sun meshes have errors of six harmonics."""
    error = ", ".join(f'{{harmonic = {h}, amplitude = "{h} um"}}' for h in range(1, 7))
    text = helical_stage(planets, teeth=TEETH[planets], loss=2e-6, ground=ground or GROUND, more=more)
    return rg.loads(text.replace("stiffness = 600000000.0", f"stiffness = 600000000.0\ntransmission_error = [{error}]"))


@pytest.mark.parametrize("planets", [3, 4, 5])
def test_each_harmonic_moves_one_class_and_the_first_has_one_sideband(planets: int) -> None:
    sun, _, ring = TEETH[planets]
    found = rg.response(stage(planets), speeds=["700 rpm", "1000 rpm"])
    carrier = sun / (sun + ring)
    mesh = ring * carrier
    wanted = {}
    for h in range(1, 7):
        rest = h * sun % planets
        side = {1: 1.0, planets - 1: -1.0}.get(rest, 0.0)
        wanted[h] = (h * mesh + side * carrier, rest)
    assert found.ratio == pytest.approx(sorted(ratio for ratio, _ in wanted.values()), rel=1e-12)
    order = np.argsort([ratio for ratio, _ in wanted.values()])
    k = found.bearings.index("pin#1")
    for number, h in enumerate(np.array(list(wanted))[order].tolist()):
        rest = wanted[h][1]
        side = {1: " + stage", planets - 1: " - stage"}.get(rest, "")
        assert found.orders[number] == f"mesh sun_planet {h}x{side}"
        # Radial forces of central bodies belong to the first class, their torques and thrusts to class 0.
        moved = {part: np.abs(found.displacement[number, :, found.places.index(part)]) for part in CENTRAL}
        radial = max(float(amplitude[:, :2].max()) for amplitude in moved.values())
        axial = max(float(amplitude[:, 2].max()) for amplitude in moved.values())
        force = float(np.abs(found.bearing_force[number, :, k]).max())
        assert force > 1.0
        size = force / 4e8
        assert (radial > 1e-3 * size) == (rest in (1, planets - 1))
        assert (axial > 1e-3 * size) == (rest == 0)
        assert min(radial, axial) < 1e-10 * size


def test_a_sideband_is_the_pattern_that_turns_in_time() -> None:
    """Amplitudes at the sideband balance the forces of an excitation whose place goes round: told without any class."""
    model = stage(3, ground={name: {**values, "y": 1.7 * values["y"]} for name, values in GROUND.items()})
    found = rg.response(model, speeds=["1000 rpm"], elements=1)
    first = int(np.argmin(np.abs(found.ratio - (98 + 1) * 28 / 126)))
    sun = found.displacement[first, 0, found.places.index("gears.sun")]
    # Springs unequal in x and y give both senses of whirl at one frequency: no circle, and no line.
    assert abs(abs(sun[0] / sun[1]) - 1.0) > 0.05
    # The ground feels the order of the carrier that is a multiple of the number of planets: 99 of the carrier.
    assert found.ratio[first] / (28 / 126) == pytest.approx(99.0)


def test_one_tooth_error_of_a_single_planet_has_both_sidebands_and_the_order() -> None:
    more = '[meshes."sun_planet#2"]\ntransmission_error = [{harmonic = 1, amplitude = "3 um"}]'
    text = helical_stage(3, teeth=TEETH[3], loss=2e-6, more=more)
    found = rg.response(rg.loads(text), speeds=["1000 rpm"])
    assert [name.split("1x")[1] for name in found.orders] == [" - stage", "", " + stage"]


def test_an_unbalance_of_planets_turns_with_them_in_axes_that_go_round() -> None:
    more = '[unbalances.planet]\nshaft = "planet"\nat = 0\nmagnitude = 1e-4\n[unbalances."planet#3"]\nmagnitude = 3e-4'
    model = rg.loads(helical_stage(3, loss=2e-6, more=more))
    found = rg.response(model, speeds=["1000 rpm"])
    ratios = model.layout.train.ratios
    own = abs(float(ratios["planet#1"] - ratios["carrier"]))
    carrier = float(ratios["carrier"])
    assert found.ratio == pytest.approx([own - carrier, own, own + carrier], rel=1e-12)
