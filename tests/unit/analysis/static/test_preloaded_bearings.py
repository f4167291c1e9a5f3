"""Angular contact bearings pressed together: their preload, O and X arrangement by hand, and clearance classes."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.forces.ball_bearing import BallBearing

CONTACT = 'kind = "ball", elements = 14, element_diameter = "12 mm", pitch_diameter = "70 mm"'
SPAN = 0.3
ANGLE = 25.0


def pair(left: float, right: float, preload: str, load: str = "force = [0.0, 0.0, 20.0]") -> rg.Model:
    """A rigid shaft in two angular contact bearings."""
    bearings = "".join(
        f'[bearings.{name}]\nshaft = "rotor"\nat = "{at}"\n'
        f'rolling = {{ {CONTACT}, contact_angle = "{angle} deg", {preload} }}\n'
        for name, at, angle in (("left", "start", left), ("right", "end", right))
    )
    section = f'{{ length = {SPAN}, outer_diameter = "60 mm", rigid = true }}'
    return rg.loads(f"""
motions = ["bending", "axial"]
[operation]
input_shaft = "rotor"
speed = "3000 rpm"
[shafts.rotor]
start = {-0.5 * SPAN}
sections = [{{ length = {0.5 * SPAN}, outer_diameter = "60 mm", rigid = true }}, {section.replace(str(SPAN), str(0.5 * SPAN), 1)}]
{bearings}
[disks.middle]
shaft = "rotor"
at = 0.0
mass = 5
polar_inertia = 0.1
diametral_inertia = 0.1
[loads.pull]
shaft = "rotor"
at = 0.0
{load}
""")


def test_a_preload_displacement_is_shared_by_both_bearings() -> None:
    result = rg.static(pair(ANGLE, -ANGLE, 'preload_displacement = "8 um"'), elements=1)
    law = BallBearing(14, 12e-3, 70e-3, contact_angle=np.radians(ANGLE))
    alone = law.evaluate([0.0, 0.0, 8e-6, 0.0, 0.0]).force[2]
    assert [abs(row.force[2]) for row in result.laws] == pytest.approx([alone, alone], rel=0.05)


@pytest.mark.parametrize(("left", "right"), [(-ANGLE, ANGLE), (ANGLE, -ANGLE)])
def test_a_preload_force_stands_in_both_bearings_and_doubles_the_axial_stiffness(left: float, right: float) -> None:
    result = rg.static(pair(left, right, "preload_force = 500"), elements=1)
    forces = {row.part: row.force[2] for row in result.laws}
    assert sum(forces.values()) == pytest.approx(20.0, rel=1e-9)
    assert np.mean(np.abs(list(forces.values()))) == pytest.approx(500.0, rel=2e-3)
    moved = result.place_displacement["disks.middle"][2]
    assert 20.0 / moved == pytest.approx(sum(row.stiffness[2, 2] for row in result.laws), rel=5e-3)


def test_o_is_stiffer_against_tilting_than_x_by_the_distance_of_the_pressure_centres() -> None:
    """By hand: loads of all balls pass through the pressure centres, R_i tan(alpha) beyond the bearings in O, within in X.

    So the tilting stiffness is that of two radial springs there, k_rr a^2/2 with their distance a. What is left is the force of
    the preload itself as it turns with the balls' contact, Q/A against 1.5 c_p sqrt(delta).
    """
    stiffness = {}
    for name, left, right in (("O", ANGLE, -ANGLE), ("X", -ANGLE, ANGLE)):
        result = rg.static(pair(left, right, "preload_force = 500", "moment = [1.0, 0.0, 0.0]"), elements=1)
        found = 1.0 / result.place_displacement["disks.middle"][3]
        row = result.laws[0]
        inner = 0.035 + 0.02 * 0.012 * np.cos(np.radians(ANGLE))
        distance = SPAN + (2.0 if name == "O" else -2.0) * inner * np.tan(np.radians(ANGLE))
        by_hand = 0.5 * row.stiffness[0, 0] * distance**2
        stiffness[name] = found
        assert found == pytest.approx(by_hand, rel=0.05)
    assert stiffness["O"] > 1.3 * stiffness["X"]


def test_a_clearance_class_is_the_middle_of_its_range() -> None:
    rolling = CONTACT + ', bore = "40 mm", clearance_class = "C3"'
    model = rg.loads(f'[shafts.a]\n[bearings.b]\nshaft = "a"\nat = "start"\nrolling = {{ {rolling} }}\n')
    from rotorgear.system.local_parts import bearing_parts
    from rotorgear.system.system import System

    law = next(bearing_parts(System(model))).law
    assert law.clearance == pytest.approx(24e-6)  # 15 to 33 um at a bore of 40 mm
    with pytest.raises(rg.ModelError, match="a bore above 10 to 120 mm"):
        rg.loads(
            f'[shafts.a]\n[bearings.b]\nshaft = "a"\nat = "start"\nrolling = {{ {rolling.replace("40 mm", "4 mm")} }}\n'
        )
    with pytest.raises(rg.ModelError, match="a preload without a contact angle"):
        rg.loads(f'[shafts.a]\n[bearings.b]\nshaft = "a"\nat = "start"\nrolling = {{ {CONTACT}, preload_force = 5 }}\n')
