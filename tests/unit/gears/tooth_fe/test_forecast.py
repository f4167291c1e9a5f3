"""What teeth in space take is known before."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import rotorgear as rg
from rotorgear.gears.loaded.tooth_contact import gear_key
from rotorgear.gears.tooth_fe.compliance_model import forecast, forget, gear_compliance, pitch_of, plane_unknowns
from rotorgear.gears.tooth_fe.settings import ToothFe
from tests.models import pair_file
from tests.unit.gears.tooth_pairs import COARSE, helical


@pytest.mark.parametrize(("preset", "measured"), [("default", 0.85e9), ("fine", 0.96e9)])
def test_memory_of_the_presets_is_that_which_was_measured(preset: str, measured: float) -> None:
    """Largest memory of a process that computed this gear (validation.benchmarks.mesh_cost): 0.85 and 0.96 GB."""
    fe: ToothFe = replace(ToothFe(), preset=preset)  # type: ignore[arg-type]
    key = gear_key(replace(helical(), fe=fe), 0, space=True)
    memory, seconds = forecast(key, pitch_of(key)[1])
    assert memory == pytest.approx(measured, rel=0.1)
    assert seconds > 0.0


def test_sizes_are_those_of_the_superelement() -> None:
    key = gear_key(replace(helical(), fe=ToothFe(size=COARSE)), 0, space=True)
    inside, kept, _, flank = plane_unknowns(key, pitch_of(key)[1])
    planes = 2 * COARSE.face + 1
    found = gear_compliance(key)
    assert found.unknowns == (inside + kept) * planes * (key.arc or key.geometry.teeth)
    assert found.flexibility.shape[1] == flank * planes


def test_what_does_not_fit_is_refused_before_it_begins(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("ROTORGEAR_CACHE", str(tmp_path))
    forget()
    monkeypatch.setattr("rotorgear.gears.tooth_fe.compliance_model.free_memory", lambda: 0.5e9)
    with pytest.raises(rg.AnalysisError, match=r"would take 0\.8\d GB of memory, and 0\.5 GB are free: take tooth_fe"):
        rg.mesh(rg.loads(pair_file(20.86, "helical", mesh='stiffness = "tooth_fe"')))
    assert not list(tmp_path.iterdir())
