"""What a sweep says that it leaves out: what a transient of the same point says, and of which points it holds."""

from __future__ import annotations

from typing import Any

import pytest

import rotorgear as rg
from rotorgear.analysis.sweep.gather import left_out_of
from rotorgear.analysis.sweep.point import PointMaker
from tests.models import spur_pair

BACKLASH: dict[str, Any] = {"meshes__pair__backlash": "80 um"}


@pytest.mark.parametrize(
    "changes",
    [
        {"motions": ["torsion"]},
        {"motions": ["torsion"], **BACKLASH},
        {"meshes__pair__transmission_error": [], **BACKLASH},
        {"meshes__pair__stiffness": "iso"},
        {"supports": {"brake": {"shaft": "two", "at": "0 mm", "stiffness": {"torsion": "1e5 N m/rad"}}}},
    ],
    ids=["open", "backlash", "still", "stiffness model", "held"],
)
def test_a_point_leaves_out_what_a_transient_of_it_does(changes: dict[str, Any]) -> None:
    model = spur_pair(**changes)
    maker = PointMaker(elements=1)
    maker(model)
    run = rg.transient(model, time=0.01, discard=0.0, steps=40, elements=1, method="newmark", error_estimate=False)
    assert run.left_out
    assert maker.left_out == [tuple(note for note in run.left_out if "in this run" not in note)]


def test_sentences_that_hold_for_some_points_say_so() -> None:
    shared = "gyroscopic matrix: nothing that turns can tilt"
    found = left_out_of([(shared, "a"), (shared,), (shared, "b")])
    assert found == (shared, "of some points: a", "of some points: b")
    many = left_out_of([(shared, *(str(n) for n in range(9))), (shared,)])
    assert many[0] == shared
    assert many[-1] == "of some points: 5 more such sentences"


def test_a_sweep_prints_what_it_leaves_out() -> None:
    swept = rg.sweep(
        spur_pair(motions=["torsion"]), {"operation.speed": ["1500 rpm"]}, discard=2, sample=2, exponents=0, elements=1
    )
    assert any("no teeth part" in note for note in swept.left_out)
    assert "left out: meshes.pair: contact loss" in " ".join(swept.text().split())
