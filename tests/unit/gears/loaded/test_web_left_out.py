"""Bodies of teeth: which gear stands on its blank, what the others say they leave out, and what a web does to a pair."""

from __future__ import annotations

import numpy as np
import pytest

from rotorgear.gears.geometry.blank import BlankShape, solid_blank
from rotorgear.gears.loaded.helix_cycles import tooth_fe_stiffness
from rotorgear.gears.loaded.tooth_contact import contact_problem, in_space
from rotorgear.gears.stiffness.blank_note import wind_up_per_width
from rotorgear.gears.stiffness.energy import potential_energy_stiffness
from rotorgear.gears.stiffness.mesh_stiffness import ToothBody, ToothPair
from rotorgear.gears.tooth_fe.points import MeshSize
from rotorgear.gears.tooth_fe.settings import ToothFe
from tests.unit.gears.tooth_pairs import LOAD, WIDTH, pair

SIZE = MeshSize(5, 2, 4, 2, 3, 4)
ROOT = 193.75e-3
WEB = BlankShape(60e-3, ROOT - 15e-3, 16.2e-3, 0.0, 80e-3, WIDTH)


def webbed(body: str | None = None, blank: BlankShape = WEB, *, exclude: bool | None = None) -> ToothPair:
    """Spur pair 34/80 whose gear has a blank."""
    fe = ToothFe(body=body, size=SIZE, exclude_torsion=exclude)  # type: ignore[arg-type]
    gear = ToothBody(inner_radius=blank.rim_radius, web_share=0.3, rim_thickness=15e-3, blank=blank)
    return pair(fe=fe, second_body=gear)


def test_a_gear_with_rim_and_web_is_a_wheel_and_any_other_one_a_rim() -> None:
    fe = ToothFe()
    assert (fe.body_of(None), fe.body_of(solid_blank(0.06)), fe.body_of(WEB)) == ("rim", "rim", "wheel")
    assert ToothFe(body="rim").body_of(WEB) == "rim"
    text = contact_problem(webbed()).body
    assert text.startswith("pinion rim: arc of 7 pitches")
    assert text.endswith(
        "gear wheel: rim, web and hub held at radius 60 mm, without the wind-up between bore and teeth"
    )


@pytest.mark.parametrize("body", ["rim", "ring"])
def test_a_body_without_the_web_says_how_much_it_leaves_out(body: str) -> None:
    (warning,) = (text for text in contact_problem(webbed(body)).warnings if "web" in text)
    assert warning.startswith(
        f"gear: body = '{body}' leaves out the compliance of web and hub, so the mesh comes out too stiff"
    )
    # 2.17e-5 mm per N/mm in the 3D reference
    assert "0.022 um per N/mm" in warning
    assert wind_up_per_width(webbed().second, webbed().second_body, WIDTH) == pytest.approx(2.168e-11, rel=5e-3)


def test_potential_energy_says_so_too_and_a_solid_blank_is_complete() -> None:
    assert any("the elastic ring leaves out" in text for text in potential_energy_stiffness(webbed(), None, 8).warnings)
    solid = webbed(blank=solid_blank(60e-3))
    assert not any("web" in text for text in potential_energy_stiffness(solid, None, 8).warnings)
    assert not any("web" in text for text in contact_problem(webbed()).warnings)


def test_the_wind_up_left_to_the_shaft_is_in_series_with_the_mesh() -> None:
    """A rotation of all teeth alike: forces stay, and the approach grows by the wind-up at that load."""
    without, within = (tooth_fe_stiffness(webbed(exclude=out), LOAD, 4) for out in (True, False))
    given = LOAD / within.transverse - LOAD / without.transverse
    expected = wind_up_per_width(webbed().second, webbed().second_body, WIDTH) * LOAD / WIDTH
    assert given == pytest.approx(np.full(4, expected), rel=1e-6)


def test_a_web_off_the_middle_is_solved_in_space() -> None:
    off = BlankShape(60e-3, ROOT - 15e-3, 16.2e-3, 18.9e-3, 80e-3, WIDTH)
    assert in_space(webbed(blank=off)) == (True, False)
    assert in_space(webbed("rim", blank=off)) == (False, False)
    assert in_space(webbed()) == (False, False)
