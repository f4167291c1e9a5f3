"""A model written to a file reads as the same model; what did not change stays as it was written."""

from __future__ import annotations

import json
import random
import tomllib
from pathlib import Path
from typing import Any

import pytest

import rotorgear as rg
from rotorgear.errors import AnalysisError, ModelError
from rotorgear.model.address import tables_of
from rotorgear.model.model import model_hash
from rotorgear.model.text import text_of
from tests.models import spur_pair
from tests.paths import MODELS

SHIPPED = sorted(MODELS.glob("*.toml"))


def _names_files(model: rg.Model) -> bool:
    return bool(model.casings) or any(gear.body.mesh is not None for gear in model.gears.values())


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_model_that_has_not_changed_is_written_as_it_was(path: Path, tmp_path: Path) -> None:
    model = rg.load(path)
    there = model.to_toml(tmp_path / "same.toml")
    again = rg.load(there)
    if _names_files(model):  # told from the new place, so that they mean the same files
        assert model_hash(again) == model_hash(model)
    else:
        assert there.read_text() == path.read_text()
        assert again == model


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_model_without_a_text_reads_as_itself(path: Path, tmp_path: Path) -> None:
    """In SI, without defaults, planets once and single sisters with what they have otherwise."""
    model = rg.load(path)
    bare = rg.Model(**tables_of(model))
    assert bare.source is None
    again = rg.load(bare.to_toml(tmp_path / "bare.toml"))
    assert model_hash(again) == model_hash(bare)
    assert again == bare or _names_files(bare)


def _numbers(value: Any, address: str = "") -> list[str]:
    """Addresses of the numbers in the tables of a model that may be 3 % larger."""
    if isinstance(value, dict):
        return [
            found for key, entry in value.items() for found in _numbers(entry, f"{address}.{key}" if address else key)
        ]
    if isinstance(value, list):
        return [found for k, entry in enumerate(value) for found in _numbers(entry, f"{address}[{k}]")]
    return [address] if isinstance(value, float) and value else []


@pytest.mark.parametrize("seed", range(50))
def test_random_changes_are_written_and_nothing_else(seed: int, tmp_path: Path) -> None:
    chosen = random.Random(seed)
    path = chosen.choice([path for path in SHIPPED if "helicopter" not in path.stem])
    model = rg.load(path)
    # What the file spells out: no defaults.
    given = json.loads(json.dumps(model.model_dump(exclude_none=True, exclude_defaults=True)))
    addresses = [at for at in _numbers(given) if not at.startswith("gears.")]
    values: dict[str, Any] = {}
    for address in chosen.sample(addresses, min(3, len(addresses))):
        value = given
        for key in address.replace("[", ".").replace("]", "").split("."):
            value = value[int(key)] if isinstance(value, list) else value[key]
        values[address] = value * chosen.choice((1.03, 0.97))
    try:
        changed = model.with_(values)
    except ModelError:
        return  # what no longer fits is refused before anything is written
    there = changed.to_toml(tmp_path / "changed.toml")
    old, new = path.read_text().splitlines(), there.read_text().splitlines()
    assert model_hash(rg.load(there)) == model_hash(changed)
    if not _names_files(changed):
        assert rg.load(there) == changed
        assert [line.partition("#")[2] for line in new] == [line.partition("#")[2] for line in old]
        assert 0 < sum(a != b for a, b in zip(old, new, strict=True)) <= len(values)


TEXT = """# A rotor.
[operation]
input_shaft = "rotor"   # the only one
speed = "3000 rpm"      # under load

[shafts.rotor]
sections = [{ length = "300 mm", outer_diameter = "30 mm" }]   # solid

[bearings]
left = { shaft = "rotor", at = "start", stiffness = { radial = "2e7 N/m" } }   # ball
right = { shaft = "rotor", at = "end", stiffness = { radial = "2e7 N/m" } }
"""


def test_units_comments_and_order_stay() -> None:
    model = rg.loads(TEXT).with_(
        {
            "operation.speed": 100.0 * 3.141592653589793,
            "shafts.rotor.sections[0].length": 0.31,
            "bearings.left.stiffness.radial": 2.5e7,
            "bearings.right.damping": {"radial": 40.0},
            "title": "Rotor",
        }
    )
    text = text_of(model, ".", model.source)
    assert rg.loads(text) == model
    for line in (
        "# A rotor.",
        'speed = "3000 rpm"      # under load',
        'sections = [{ length = "310 mm", outer_diameter = "30 mm" }]   # solid',
        'left = { shaft = "rotor", at = "start", stiffness = { radial = "2.5e7 N/m" } }   # ball',
    ):
        assert line in text
    assert tomllib.loads(text)["title"] == "Rotor"


def test_parts_that_come_and_go() -> None:
    model = rg.loads(TEXT).with_({"bearings.middle": rg.Bearing(shaft="rotor", at=0.1, stiffness={"radial": 1e6})})
    model = model.with_("bearings.right", None).with_(
        "disks.wheel", {"shaft": "rotor", "at": 0.2, "mass": 1.0, "polar_inertia": 0.1, "diametral_inertia": 0.06}
    )
    text = text_of(model, ".", model.source)
    assert rg.loads(text) == model
    assert "# ball" in text
    assert "right" not in text


def test_a_model_of_parts_is_written(tmp_path: Path) -> None:
    model = spur_pair()
    assert rg.load(model.to_toml(tmp_path / "parts.toml")) == model
    assert rg.load(rg.write_model_file(model, tmp_path / "again.toml")) == model


def test_one_sister_that_differs_is_written(tmp_path: Path) -> None:
    text = (MODELS / "planetary.toml").read_text() + '\n[meshes."sun_planet#2"]\nindex_error = "7 um"\n'
    model = rg.loads(text, folder=MODELS)
    bare = rg.Model(**model.model_dump(exclude_none=True))
    for written in (model, bare, model.with_("gears.sun.width", "33 mm")):
        assert rg.load(written.to_toml(tmp_path / "one.toml")) == written


def test_a_text_with_other_values() -> None:
    text = rg.changed_text(TEXT, {"operation.speed": "3600 rpm", "bearings.left.stiffness.radial": 3e7, "title": "R"})
    assert 'speed = "3600 rpm"      # under load' in text
    assert "radial = 30000000.0 } }   # ball" in text
    assert rg.loads(text).title == "R"
    assert "under load" not in rg.changed_text(TEXT, {"operation.speed": None})
    with pytest.raises(AnalysisError, match=r"bearings\.lft\.stiffness: the file does not spell this value out"):
        rg.changed_text(TEXT, {"bearings.lft.stiffness": 1.0})


def test_a_model_is_no_result() -> None:
    with pytest.raises(AnalysisError, match=r"got a Model; model\.to_toml writes a model"):
        rg.save(spur_pair(), "model.h5")  # type: ignore[arg-type]
