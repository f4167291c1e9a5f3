"""A number that is dragged shows what the file with that number in it gives, digit by digit."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.app.study import Study
from rotorgear.results.table import Table
from tests.paths import ROOT

# A rotor, gears, rigid bodies that some dofs of have no inertia, planets, a chain in torsion; films are compiled for it.
DRAGGED = (
    ("jeffcott", "bearings.left.stiffness.axial"),
    ("geared_pair", "bearings.rotor_1_left.stiffness.y"),
    ("herringbone_pair_12dof", "meshes.left.stiffness"),
    ("planetary", "bearings.pin.stiffness.tilt"),
    ("marine_dual_turbine", "meshes.first_lp.stiffness"),
    pytest.param("split_torque_journals", "bearings.branch_a_right.journal.diameter", marks=pytest.mark.long),
)


def _shown(result: rg.ModalResult) -> list[list[str]]:
    table = next(one for one in result.tables() if isinstance(one, Table))
    return [[cell.text for cell in row[:3]] for row in table.rows]


@pytest.mark.parametrize(("name", "address"), DRAGGED)
def test_a_dragged_number_gives_what_the_saved_file_gives(name: str, address: str, tmp_path: Path) -> None:
    file = tmp_path / f"{name}.toml"
    shutil.copy(ROOT / "models" / file.name, file)
    study = Study(file)
    field = next(one for one in study.fields(".".join(address.split(".")[:2])) if one.address == address)
    text = study.dragged(field, 1.17)
    dragged = rg.modal(study.trial(address, text), shapes=False)
    assert study.change(address, text)
    study.save()
    saved = rg.modal(rg.load(file))
    assert np.array_equal(dragged.frequency_hz, saved.frequency_hz)
    assert _shown(dragged) == _shown(saved)
    assert _shown(saved) != _shown(rg.modal(rg.load(ROOT / "models" / file.name)))
