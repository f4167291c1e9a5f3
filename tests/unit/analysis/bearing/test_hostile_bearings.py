"""Bearings that can't be, or can't carry: each is refused in one sentence with its address, in the file or by each analysis."""

from __future__ import annotations

import pytest

import rotorgear as rg
from rotorgear.errors import AnalysisError, ModelError

ROTOR = """
[operation]
input_shaft = "rotor"
speed = "6000 rpm"
gravity = ["0 m/s^2", "-9.81 m/s^2", "0 m/s^2"]
[shafts.rotor]
sections = [{{ length = "300 mm", outer_diameter = "60 mm" }}]
[bearings.left]
shaft = "rotor"
at = "start"
{}
[bearings.right]
shaft = "rotor"
at = "end"
stiffness = {{ radial = "200 N/um", axial = "100 N/um" }}
"""
PARTS = {
    "journal": {
        "diameter": "60 mm",
        "length": "30 mm",
        "clearance": "60 um",
        "viscosity": "20 mPa s",
        "around": 60,
        "along": 4,
    },
    "thrust": {
        "inner_diameter": "80 mm",
        "outer_diameter": "140 mm",
        "clearance": "60 um",
        "viscosity": "0.03 Pa s",
        "pads": 6,
        "pivot": 0.6,
    },
    "rolling": {"kind": "ball", "elements": 9, "element_diameter": "12 mm", "pitch_diameter": "65 mm"},
}
WARM = {"viscosity": None, "oil": "VG 46"}


def text(kind: str, keys: dict[str, object], more: str = "") -> str:
    own = {key: value for key, value in {**PARTS[kind], **keys}.items() if value is not None}
    inside = ", ".join(
        f'{key} = "{value}"' if isinstance(value, str) else f"{key} = {value}" for key, value in own.items()
    )
    return ROTOR.format(f"{kind} = {{ {inside} }}") + more


@pytest.mark.parametrize(
    ("kind", "keys", "said"),
    [
        ("journal", {"clearance": "0 um"}, "journal.clearance: got '0 um', expected a positive length"),
        ("journal", {"clearance": "40 mm"}, "journal.clearance: got 40 mm on a diameter of 60 mm"),
        ("journal", {"lobes": 3, "preload": -0.3}, "journal.preload: got -0.3"),
        ("journal", {"lobes": 3, "preload": 1.0}, "journal.preload: got 1, expected a share from 0 to below 1"),
        ("journal", {"preload": 0.3}, "got keys of lobes in a plain bearing"),
        ("journal", {"pads": 5, "pad_arc": "80 deg"}, "got 5 of 80 deg, expected pads that fit on 360 deg"),
        ("journal", {"lobes": 3, "lobe_arc": "130 deg"}, "got 3 of 130 deg, expected lobes that fit"),
        ("journal", {"pads": 1}, "expected 2 to 12 pads"),
        ("journal", {"lobes": 2, "preload": 0.5, "offset": 2.0}, "offset: got 2, expected a share of the arc"),
        ("journal", {"pads": 4, "pivot": 1.0}, "pivot: got 1, expected a share of the arc"),
        ("journal", {"length": "180 mm"}, "at most two diameters"),
        ("journal", {"around": 100_000}, "around: got 100000, expected at most 2000"),
        ("thrust", {"inner_diameter": "150 mm"}, "less than the outer diameter of 140 mm"),
        ("thrust", {"pad_arc": "80 deg"}, "got 6 of 80 deg, expected pads that fit on 360 deg"),
        ("thrust", {"pivot": None}, "got neither taper nor pivot"),
        ("rolling", {"elements": 2}, "elements: got 2, expected at least 3"),
        ("rolling", {"elements": 40}, "elements that fit on a circle of 65 mm"),
        ("rolling", {"clearance": "5 mm"}, "the balls would fall out"),
        ("rolling", {"kind": "roller"}, "a length for rollers"),
    ],
)
def test_what_cannot_be_built_is_refused_in_the_file(kind: str, keys: dict[str, object], said: str) -> None:
    with pytest.raises(ModelError, match=said) as found:
        rg.loads(text(kind, keys))
    assert "bearings.left" in str(found.value)


@pytest.mark.parametrize(
    ("kind", "keys", "load", "said"),
    [
        ("journal", {}, '["0 N", "-5 MN", "0 N"]', "the film is too thin for this model"),
        ("journal", {"length": "0.1 mm"}, "", "the film is too thin for this model"),
        ("journal", {"viscosity": "1e-9 Pa s"}, "", "the film is turbulent"),
        ("journal", {**WARM, "inlet_temperature": "250 degC"}, "", "oil would flow in at 250 degC"),
        ("journal", {**WARM, "inlet_temperature": "-95 degC"}, "", "oil would flow in at -95 degC"),
        ("thrust", {}, '["0 N", "0 N", "50 MN"]', "the film is too thin for this model"),
    ],
)
def test_a_film_that_cannot_carry_is_refused_by_statics_and_modes(kind: str, keys, load: str, said: str) -> None:
    hold = (
        '[supports.hold]\nshaft = "rotor"\nat = "start"\nstiffness = { radial = "200 N/um" }\n'
        if kind == "thrust"
        else ""
    )
    push = f'[loads.push]\nshaft = "rotor"\nat = "150 mm"\nforce = {load}\n' if load else ""
    model = rg.loads(text(kind, keys, hold + push))
    for solve in (rg.static, lambda one: rg.modal(one, speed="6000 rpm", modes=2)):
        with pytest.raises(AnalysisError, match=f"bearings.left: .*{said}"):
            solve(model)
