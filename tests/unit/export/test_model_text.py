"""Changed numbers in a model file: value and unit as the user wrote them, all else untouched."""

from __future__ import annotations

import pytest

import rotorgear as rg
from rotorgear.errors import AnalysisError
from rotorgear.export.model_files import scaled_text
from tests.paths import MODELS

pytest.importorskip("tomlkit")


def test_only_the_named_values_change_and_the_file_loads():
    text = (MODELS / "split_torque.toml").read_text()
    changed = scaled_text(
        text,
        {
            "meshes.stage_1a.stiffness": 2.0,
            "bearings.input_left.stiffness": 0.5,
            "shafts.input.sections[0].length": 1.0,
        },
        {"meshes.stage_1a.stiffness": "doubled"},
    )
    before = rg.loads(text)
    after = rg.loads(changed)
    assert after.meshes["stage_1a"].stiffness == pytest.approx(2.0 * before.meshes["stage_1a"].stiffness, rel=1e-5)
    assert after == before.with_(
        {
            "meshes.stage_1a.stiffness": after.meshes["stage_1a"].stiffness,
            "bearings.input_left.stiffness": after.bearings["input_left"].stiffness,
        }
    )
    lines = dict(zip(text.splitlines(), changed.splitlines(), strict=True))
    assert sum(old != new for old, new in lines.items()) <= 3
    assert "# doubled; fitted" in changed


def test_a_series_keeps_its_shares():
    text = '[meshes.a]\nstiffness = { mean = "2e8 N/m", amplitudes = [0.1], phases = ["90 deg"] }\n'
    assert 'mean = "3e+08 N/m", amplitudes = [0.1], phases = ["90 deg"]' in scaled_text(
        text, {"meshes.a.stiffness": 1.5}
    )


@pytest.mark.parametrize("address", ["meshes.b.stiffness", "meshes.a.width", "meshes.a.stiffness.x.y"])
def test_what_the_file_does_not_spell_out_is_refused(address):
    with pytest.raises(AnalysisError, match="spell"):
        scaled_text('[meshes.a]\nstiffness = "2e8 N/m"\n', {address: 2.0})
    with pytest.raises(AnalysisError, match="no number"):
        scaled_text('[meshes.a]\nstiffness = "iso"\n', {"meshes.a.stiffness": 2.0})
