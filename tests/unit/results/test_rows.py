"""Rows without axes, and data frames: those of what a result is about."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from tests.paths import ROOT

pytest.importorskip("pandas")


def test_a_frame_is_indexed_by_what_the_result_is_about() -> None:
    model = rg.load(ROOT / "models" / "jeffcott.toml")
    modes = rg.modal(model, modes=4)
    assert modes.rows() == modes.rows("mode")
    frame = modes.to_pandas()
    assert frame.index.name == "mode"
    assert np.array_equal(frame["frequency_hz"], modes.frequency_hz)
    diagram = rg.campbell(model, points=3, modes=4)
    long = diagram.to_pandas()
    assert long.index.names == ["speed", "branch"]
    assert long.loc[(2, 1), "frequency_hz"] == diagram.frequency_hz[1, 0]
    assert list(diagram.to_pandas("margins").columns[:2]) == ["line", "frequency_hz"]
