"""What is given to an analysis in place of a model is refused in words, with the remedy."""

from __future__ import annotations

from pathlib import Path

import pytest

import rotorgear as rg
from rotorgear.errors import AnalysisError
from rotorgear.system.system import System

FILE = Path(__file__).resolve().parents[3] / "models" / "jeffcott.toml"


@pytest.mark.parametrize("analysis", [rg.modal, rg.static, rg.campbell])
def test_a_file_name_is_no_model(analysis):
    with pytest.raises(AnalysisError, match=rf"{analysis.__name__}: got the text .*jeffcott.toml.*rotorgear.load"):
        analysis(FILE)


def test_what_holds_a_model_is_told_from_it():
    system = System(rg.load(FILE))
    assert len(rg.modal(system, modes=2).eigenvalues) == 2
    with pytest.raises(AnalysisError, match=r"static: got the System, expected the model in it \(.model\)"):
        rg.static(system)


def test_anything_else_is_named():
    with pytest.raises(AnalysisError, match="modal: got NoneType, expected a model"):
        rg.modal(None)
