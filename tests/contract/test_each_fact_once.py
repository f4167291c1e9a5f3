"""What follows from a model has one home: nobody behind model/ looks parts up, and nothing is derived twice."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable
from typing import Any

import pytest

import rotorgear as rg
from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.model import model as model_module
from rotorgear.model.layout import layout, mesh_layout
from tests.paths import ROOT

# Layout answers with gear(name), mesh(name) and place(address).
LOOKUP = re.compile(r"\.(gears|meshes)\[|\.station\(")
ANALYSES: dict[str, Callable[[rg.Model], Any]] = {
    "modal": lambda model: rg.modal(model, modes=8, elements=1),
    "static": lambda model: rg.static(model, elements=1),
    "response": lambda model: rg.response(model, speeds=["1500 rpm"], elements=1),
    "campbell": lambda model: rg.campbell(model, speeds=["0 rpm", "1500 rpm"], modes=4, elements=1),
}


def test_behind_the_model_no_gear_mesh_or_place_is_looked_up_by_hand() -> None:
    package = ROOT / "rotorgear"
    found = [
        f"{file.relative_to(ROOT)}:{number}: {line.strip()}"
        for file in package.rglob("*.py")
        if (package / "model") not in file.parents
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), start=1)
        if LOOKUP.search(line)
    ]
    assert found == []


@pytest.mark.parametrize("analysis", ANALYSES)
def test_loading_and_an_analysis_derive_each_fact_once(analysis: str, monkeypatch: pytest.MonkeyPatch) -> None:
    made: Counter[str] = Counter()

    def counted(module: Any, name: str, what: Callable[..., str]) -> None:
        derive = getattr(module, name)

        def counting(*args: Any, **options: Any) -> Any:
            made[what(*args)] += 1
            return derive(*args, **options)

        monkeypatch.setattr(module, name, counting)

    counted(layout, "walk", lambda model: "train")
    counted(mesh_layout, "pair_geometry", lambda first, second: f"pair of {first.teeth} and {second.teeth} teeth")
    counted(model_module, "torque_flow", lambda own, direction: f"mean load {direction}")
    geometries: list[GearGeometry] = []
    check = GearGeometry.__post_init__ if hasattr(GearGeometry, "__post_init__") else None

    def first_made(self: GearGeometry) -> None:
        geometries.append(self)
        if check is not None:
            check(self)

    monkeypatch.setattr(GearGeometry, "__post_init__", first_made, raising=False)
    model = rg.load(ROOT / "models" / "split_torque.toml")
    ANALYSES[analysis](model)
    # Stages a and b are alike: two pairs each of 29 and 113, and of 26 and 125 teeth.
    assert made["train"] == 1
    assert made["mean load 1"] <= 1
    assert made["mean load -1"] == 0
    assert made["pair of 29 and 113 teeth"] == made["pair of 26 and 125 teeth"] == 2
    # Teeth that are thinned by their allowances, for the balls of a check, are other gears than those of the model.
    own = Counter(gear.geometry for gear in model.gears.values())
    assert Counter(geometry for geometry in geometries if geometry in own) == own
