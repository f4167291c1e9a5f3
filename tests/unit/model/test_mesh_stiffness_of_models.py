"""A mesh that names a stiffness model has, in modes and forces, the stiffness of that model at its mean load."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from typing import Any

import pytest

import rotorgear as rg
from rotorgear.errors import ModelError
from rotorgear.model.model import Model
from tests.unit.gears.tooth_pairs import harmonics


def with_stiffness(data: dict[str, Any], value: Any) -> Model:
    for mesh in data["meshes"].values():
        mesh["stiffness"] = value
    return Model(**data)


@pytest.mark.parametrize("name", ["iso", "contact_line", "potential_energy"])
def test_modes_with_a_model_are_those_with_its_mean_typed_in(pair: dict[str, Any], name: str) -> None:
    named = with_stiffness(pair, name)
    curve = named.torque_flow().whole_curve("stage")
    typed = with_stiffness(pair, curve.mean_normal)
    got, want = (rg.modal(model, modes=12, elements=2).frequency_hz for model in (named, typed))
    assert got == pytest.approx(want, rel=1e-9, abs=1e-6)
    assert curve.load == pytest.approx(
        20e3 / (1500 * math.pi / 30) / named.layout.mesh("stage").teeth.first.base_radius, rel=1e-9
    )


def test_a_table_over_the_mesh_period_counts_with_its_mean(pair: dict[str, Any]) -> None:
    table = with_stiffness(pair, ["3e8 N/m", "4e8 N/m", 5e8])
    assert table.torque_flow().forces[0].contact.stiffness == pytest.approx(4e8, rel=1e-14)
    curve = table.layout.mesh("stage").stiffness()
    assert curve.transverse / math.cos(curve.base_helix_angle) ** 2 == pytest.approx([3e8, 4e8, 5e8], rel=1e-14)


def test_a_fourier_series_keeps_its_mean_amplitudes_and_phases(pair: dict[str, Any]) -> None:
    series = {"mean": "4e8 N/m", "amplitudes": [0.2, 0.0, 0.05], "phases": ["30 deg", 0.0, "-90 deg"]}
    curve = with_stiffness(pair, series).layout.mesh("stage").stiffness()
    assert curve.mean_normal == pytest.approx(4e8, rel=1e-13)
    got = harmonics(curve, 4) / curve.mean
    want = [0.2 * cmath.exp(1j * math.pi / 6), 0.0, -0.05j, 0.0]
    assert max(abs(one - other) for one, other in zip(got, want, strict=True)) < 1e-13


@pytest.mark.parametrize(
    ("series", "words"),
    [
        ({"mean": "4e8 N/m"}, "amplitudes as shares of it"),
        ({"mean": "4e8 N/m", "amplitudes": [0.1], "phases": [0.0, 0.0]}, "as many phases or none"),
        ({"mean": "4e8 N/m", "amplitudes": [0.1], "phase": [0.0]}, "as many phases or none"),
        ({"mean": "4e8 N/m", "amplitudes": [0.9, -0.4]}, "leave the stiffness positive"),
        ({"mean": "-4e8 N/m", "amplitudes": [0.1]}, "a positive stiffness"),
        ({"mean": "4e8 N/m", "amplitudes": ["0.1 mm"]}, "meshes.stage.stiffness"),
    ],
)
def test_a_series_that_makes_no_sense_is_refused(pair: dict[str, Any], series: dict[str, Any], words: str) -> None:
    with pytest.raises(ModelError, match=words) as caught:
        with_stiffness(pair, series)
    assert [problem.address for problem in caught.value.problems] == ["meshes.stage.stiffness"]


def test_both_helices_of_a_herringbone_share_the_load_and_add_up(split: dict[str, Any]) -> None:
    model = with_stiffness(split, "contact_line")
    flow = model.torque_flow()
    for name in model.meshes:
        forces = flow.of_mesh(name)
        curve = flow.whole_curve(name)
        assert curve.helices == len(forces)
        base = math.cos(curve.base_helix_angle)
        assert curve.load == pytest.approx(sum(force.normal_force for force in forces) * base, rel=1e-6)
        assert sum(force.contact.stiffness for force in forces) == pytest.approx(curve.mean_normal, rel=1e-12)


def test_a_light_load_in_a_loop_is_iterated_with_its_stiffness(split: dict[str, Any]) -> None:
    split["operation"]["power"] = "200 W"  # far below 100 N/mm: c' depends on the load
    model = with_stiffness(split, "iso")
    flow = model.torque_flow()
    for name in model.meshes:
        forces = [force.normal_force for force in flow.of_mesh(name)]
        assert model.layout.mesh(name).stiffness(sum(forces) / len(forces)).mean == pytest.approx(
            flow.whole_curve(name).mean, rel=1e-7
        )
        assert flow.whole_curve(name).warnings


def test_without_a_load_a_model_that_needs_none_still_answers(pair: dict[str, Any]) -> None:
    del pair["operation"]["power"], pair["operation"]["output_shaft"]
    model = with_stiffness(pair, "iso")
    assert model.torque_flow().whole_curve("stage").load is None


def test_the_result_says_which_mean_stiffness_was_taken_at_which_load(pair: dict[str, Any]) -> None:
    result = rg.modal(with_stiffness(pair, "contact_line"), modes=3)
    sentence = next(note for note in result.left_out if note.part == "meshes.stage")
    for part in ("ripple of", "18.4 % of", "'contact_line'", "along the flank normal", "secant, at F_bt ="):
        assert part in sentence


def test_a_wrong_name_is_refused_at_its_address_with_the_nearest(pair: dict[str, Any]) -> None:
    with pytest.raises(ModelError, match="did you mean 'contact_line'") as caught:
        with_stiffness(pair, "contactline")
    assert [problem.address for problem in caught.value.problems] == ["meshes.stage.stiffness"]


def test_what_teeth_cannot_be_is_refused_at_its_address(
    pair: dict[str, Any], addresses: Callable[[dict[str, Any]], list[str]]
) -> None:
    gear = pair["gears"]["pinion"]
    gear |= {"upper_thickness_allowance": "0.05 mm", "tip_relief": "20 um", "accuracy_grade": 12}
    found = addresses(pair)
    for key in ("upper_thickness_allowance", "tip_relief_diameter", "accuracy_grade"):
        assert f"gears.pinion.{key}" in found


def test_a_ball_must_touch_the_flanks(pair: dict[str, Any], addresses: Callable[[dict[str, Any]], list[str]]) -> None:
    for diameter in ("0.3 mm", "20 mm"):
        pair["gears"]["pinion"]["ball_diameter"] = diameter
        assert addresses(pair) == ["gears.pinion.ball_diameter"]


def test_pointed_teeth_are_refused_with_the_remedy(pair: dict[str, Any]) -> None:
    pair["gears"]["pinion"] |= {"teeth": 12, "profile_shift": 1.1, "helix_angle": "20 deg"}
    with pytest.raises(ModelError, match=r"reduce the tip diameter, the addendum or the profile shift"):
        Model(**pair)
