"""What teeth in space will take is known before."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import rotorgear as rg
from rotorgear.gears.loaded.forecast import forecast
from rotorgear.gears.tooth_fe.settings import ToothFe
from tests.unit.analysis.geared import pair_file
from tests.unit.gears.tooth_pairs import helical, spur


@pytest.fixture(autouse=True)
def nothing_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROTORGEAR_CACHE", str(tmp_path))


@pytest.mark.parametrize(("preset", "measured"), [("default", 0.952e9), ("fine", 1.257e9)])
def test_memory_of_the_presets_is_that_which_was_measured(preset: str, measured: float) -> None:
    """Largest memory of a process that computed this pair: 0.952 and 1.257 GB."""
    fe: ToothFe = replace(ToothFe(), preset=preset)  # type: ignore[arg-type]
    assert forecast((replace(helical(), fe=fe),)).memory == pytest.approx(measured, rel=0.1)


def test_teeth_in_the_plane_take_nothing_worth_a_word() -> None:
    assert forecast((spur(),)).memory == 0.0


def test_what_does_not_fit_is_refused_before_it_begins(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rotorgear.analysis.teeth.mesh.free_memory", lambda: 0.5e9)
    with pytest.raises(rg.AnalysisError, match=r"would take \d\.\d+ GB of memory, and 0\.5 GB are free: take --preset"):
        rg.mesh(rg.loads(pair_file(20.86, "helical", mesh='stiffness = "tooth_fe"')))
