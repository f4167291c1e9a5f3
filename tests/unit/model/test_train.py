"""Speeds and senses of a train: products of tooth ratios, loops that close, and what contradicts them."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rotorgear.errors import ModelError
from rotorgear.model.layout.train import Link, Train
from rotorgear.model.layout.walk import links, mesh_factors, walk
from rotorgear.model.model import Model
from rotorgear.model.parts.gear import Gear
from rotorgear.model.parts.mesh import Mesh
from rotorgear.model.parts.operation import Operation
from rotorgear.model.parts.shaft import Disk, Shaft
from rotorgear.model.parts.supports import Coupling, StiffnessMatrix

Data = dict[str, Any]


def spur(shaft: str, teeth: int) -> Gear:
    return Gear(shaft=shaft, at=0, kind="spur", teeth=teeth, normal_module=0.002, width=0.02, body={"bore": 0})


def chain(*stages: tuple[int, int]) -> Model:
    """Shafts 0, 1, 2 ... of torsion only; stage i joins shaft i to i + 1."""
    return Model(
        motions=("torsion",),
        operation=Operation(input_shaft="0"),
        shafts={str(number): Shaft() for number in range(len(stages) + 1)},
        gears={
            f"{kind}{i}": spur(str(i + j), z)
            for i, pair in enumerate(stages)
            for j, (kind, z) in enumerate(zip("pw", pair, strict=True))
        },
        meshes={str(i): Mesh(pinion=f"p{i}", gear=f"w{i}", stiffness=1e8) for i in range(len(stages))},
    )


def train_of(model: Model) -> Train:
    train, problems = walk(model)
    assert problems == []
    return train


@given(st.lists(st.tuples(st.integers(10, 200), st.integers(10, 200)), min_size=1, max_size=5))
@settings(max_examples=30, deadline=None)
def test_the_speed_of_a_chain_is_the_signed_product_of_its_tooth_ratios(stages: list[tuple[int, int]]) -> None:
    train = train_of(chain(*stages))
    exact = Fraction(1)
    for number, (pinion, wheel) in enumerate(stages, start=1):
        exact *= -Fraction(pinion, wheel)
        assert train.ratios[str(number)] == exact
        assert train.sense(str(number)) == (-1) ** number
        assert (train.depth[str(number)], train.reached_by[str(number)]) == (number, f"meshes.{number - 1}")
    assert set(train.group.values()) == {0}


def test_an_idler_keeps_the_ratio_of_its_neighbours_and_turns_the_sense() -> None:
    model = Model(
        motions=("torsion",),
        shafts={name: Shaft() for name in "abc"},
        gears={"a": spur("a", 20), "idler": spur("b", 37), "c": spur("c", 40)},
        meshes={
            "first": Mesh(pinion="a", gear="idler", stiffness=1e8),
            "second": Mesh(pinion="idler", gear="c", stiffness=1e8),
        },
    )
    train = train_of(model)
    assert train.ratios == {"a": 1, "b": Fraction(-20, 37), "c": Fraction(1, 2)}


def test_the_walk_does_not_ask_which_gear_is_called_the_pinion(pair: Data) -> None:
    forwards = train_of(Model(**pair))
    mesh = pair["meshes"]["stage"]
    mesh["pinion"], mesh["gear"] = mesh["gear"], mesh["pinion"]
    assert train_of(Model(**pair)).ratios == forwards.ratios == {"input": 1, "output": Fraction(-1, 3)}


def test_the_split_torque_loop_closes_in_whole_numbers(split: Data) -> None:
    train = train_of(Model(**split))
    assert train.ratios["output"] == Fraction(29, 113) * Fraction(26, 125)
    assert train.ratios["branch_a"] == train.ratios["branch_b"] == Fraction(-29, 113)


def test_a_loop_that_misses_by_one_tooth_is_refused_with_both_ratios(split: Data) -> None:
    split["motions"] = ["torsion"]
    for shaft in split["shafts"].values():
        del shaft["position"]
    split["gears"]["wheel_b"]["teeth"] = 114
    with pytest.raises(ModelError) as caught:
        Model(**split)
    (problem,) = caught.value.problems
    assert problem.address == "meshes.second_b"
    assert f"{29 / 114 * 26 / 125:.9g} (377/7125)" in problem.value
    assert f"{29 / 113 * 26 / 125:.9g} (754/14125)" in problem.expected
    assert "meshes.second_a" in problem.expected


@pytest.mark.parametrize(("error", "closes"), [(1e-7, True), (1e-5, False)])
def test_a_loop_of_lumped_gears_closes_to_their_rounding(error: float, closes: bool) -> None:
    def gear(shaft: str, radius: float) -> Gear:
        return Gear(shaft=shaft, at=0, kind="spur", base_radius=radius, mass=1, polar_inertia=1, diametral_inertia=1)

    def build() -> Model:
        return Model(
            motions=("torsion",),
            shafts={"a": Shaft(), "b": Shaft()},
            gears={"p": gear("a", 0.1), "q": gear("a", 0.2), "v": gear("b", 0.3), "w": gear("b", 0.6 * (1 + error))},
            meshes={"1": Mesh(pinion="p", gear="v", stiffness=1e8), "2": Mesh(pinion="q", gear="w", stiffness=1e8)},
        )

    if closes:
        assert train_of(build()).ratio("b") == pytest.approx(-1 / 3)
    else:
        with pytest.raises(ModelError, match=r"meshes\.2: got ratio"):
            build()


def test_a_coupling_drives_with_torsional_stiffness_and_not_without() -> None:
    def build(torsion: float) -> Train:
        stiffness = StiffnessMatrix(radial=1e6, torsion=torsion)
        return train_of(
            Model(
                shafts={"a": Shaft(), "b": Shaft()},
                couplings={"c": Coupling(from_shaft="b", to_shaft="a", stiffness=stiffness)},
            )
        )

    stiff = build(1e3)
    loose = build(0.0)
    assert (stiff.ratios, stiff.reached_by["b"]) == ({"a": 1, "b": 1}, "couplings.c")
    assert (loose.ratios, loose.group) == ({"a": 1, "b": 0}, {"a": 0, "b": 1})


def test_a_shaft_that_nothing_drives_takes_its_given_ratio_and_stands_still_without(everything: Data) -> None:
    train = train_of(Model(**everything))
    assert (train.ratio("fan"), train.ratio("point"), train.sense("fan")) == (-0.5, 1.0, -1)
    assert train.reached_by["fan"] == ""
    del everything["shafts"]["fan"]["speed_ratio"]
    assert train_of(Model(**everything)).ratio("fan") == 0.0


def test_a_given_ratio_against_the_train_is_refused(pair: Data) -> None:
    pair["shafts"]["output"]["speed_ratio"] = -1 / 3
    Model(**pair)
    pair["shafts"]["output"]["speed_ratio"] = 1 / 3
    with pytest.raises(
        ModelError, match=r"output\.speed_ratio: got 0\.333333333, expected -0\.333333333, which follows"
    ):
        Model(**pair)


def test_the_reference_is_the_input_shaft_else_the_first_one(pair: Data) -> None:
    pair["operation"] = {"input_shaft": "output"}
    assert train_of(Model(**pair)).ratios == {"output": 1, "input": -3}
    del pair["operation"]
    assert train_of(Model(**pair)).reference == "input"


def test_a_chain_beyond_all_trains_is_refused_instead_of_overflowing() -> None:
    with pytest.raises(ModelError, match="speeds differ by less than a factor of 1e"):
        chain(*[(1000, 5)] * 150)


def test_mesh_frequencies_are_one_for_both_gears_and_none_without_teeth(pair: Data, everything: Data) -> None:
    model = Model(**pair)
    speed = 2.0 * math.pi * 25.0
    assert model.layout.mesh_frequency("stage", speed) == pytest.approx(25.0 * 24)
    assert model.layout.mesh_frequency("stage", -speed) == pytest.approx(25.0 * 24)
    lumped = Model(**everything)
    assert lumped.layout.mesh_frequency("lumped", speed) is None


def _links(model: Model) -> list[Link]:
    return links(model, mesh_factors(model))


def test_links_are_the_meshes_and_the_stiff_couplings(everything: Data) -> None:
    found = {part: ratio for part, _, _, ratio in _links(Model(**everything))}
    assert found == {"meshes.toothed": Fraction(-1, 2), "meshes.lumped": pytest.approx(-0.5), "couplings.membrane": 1}


def test_bodies_take_no_part_in_the_train(pair: Data) -> None:
    pair["disks"] = {"d": Disk(shaft="input", at=0.1, mass=1, polar_inertia=1, diametral_inertia=1)}
    assert len(_links(Model(**pair))) == 1
