"""The tutorial of forces/law.py as a user would type it into a file of their own: its law runs in transients and in sweeps."""

from __future__ import annotations

import importlib.util
import textwrap
from pathlib import Path
from types import ModuleType

import pytest

import rotorgear as rg
from rotorgear.forces import law as law_module
from rotorgear.forces import registry
from tests.models import spur_pair


@pytest.fixture
def file_of_a_user(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The code of the tutorial as a module; what it registers is forgotten afterwards."""
    monkeypatch.setattr(registry, "_REGISTERED", dict(registry._REGISTERED))
    text = law_module.__doc__ or ""
    code = text[text.index("    from dataclasses") : text.index("The rest of `ForceLaw`")]
    file = tmp_path / "stop_of_a_user.py"
    file.write_text(textwrap.dedent(code), encoding="utf-8")
    spec = importlib.util.spec_from_file_location("stop_of_a_user", file)
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(__import__("sys").modules, "stop_of_a_user", module)
    spec.loader.exec_module(module)
    return module


@pytest.mark.long
def test_the_law_of_the_tutorial_runs_in_a_transient_and_a_sweep_alike(file_of_a_user: ModuleType) -> None:
    assert registry.law_of("stop") is file_of_a_user.Stop
    stop = {
        "law": "stop",
        "shaft": "two",
        "at": "end",
        "directions": ["y"],
        "parameters": {"stiffness": "1e8 N/m", "damping": "200 N s/m", "gap": "1 um"},
    }
    model, free = (
        spur_pair(meshes__pair__backlash="50 um", **extra) for extra in ({"nonlinear_elements__stop": stop}, {})
    )
    swept, without = (
        rg.sweep(each, {"operation.speed": ["1500 rpm"]}, discard=60, sample=20) for each in (model, free)
    )
    cycle = 60.0 / 1500.0 / 24
    run = rg.transient(model, discard=60 * cycle, time=20 * cycle, steps=600, method="newmark", error_estimate=False)
    row = run.to_dict()["contacts"][0]
    assert swept.largest_force[0, 0, 0] == pytest.approx(row["largest_force_n"], rel=5e-3)
    assert swept.peak_to_peak_approach[0, 0, 0] == pytest.approx(row["peak_to_peak_approach_m"], rel=1e-2)
    assert abs(swept.peak_to_peak_approach[0, 0, 0] / without.peak_to_peak_approach[0, 0, 0] - 1.0) > 1e-3, (
        "the stop does nothing here"
    )


def test_a_name_of_the_package_is_not_taken_by_another_law(file_of_a_user: ModuleType) -> None:
    with pytest.raises(rg.AnalysisError, match="'mesh_contact' is a force law of the package"):
        registry.register_law("mesh_contact")(file_of_a_user.Stop)
    with pytest.raises(rg.AnalysisError, match="'a b' is no name"):
        registry.register_law("a b")(file_of_a_user.Stop)
    with pytest.raises(rg.AnalysisError, match="derived from"):
        registry.register_law("text")(str)  # type: ignore[type-var]
