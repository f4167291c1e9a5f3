"""The bifurcation diagram leaves its lines free."""

from __future__ import annotations

import pytest

import rotorgear as rg
from tests.paths import ROOT


def test_the_legend_of_shares_stands_outside_the_panels() -> None:
    pytest.importorskip("matplotlib")
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from rotorgear.plots.sweep import bifurcation

    pair = rg.load(ROOT / "models" / "backlash_pair.toml")
    found = rg.sweep(pair, {"operation.speed": "3000 rpm:9000 rpm:3"}, discard=5, sample=4, exponents=0)
    figure = Figure(figsize=(8.0, 6.0), layout="constrained")
    panels = bifurcation(found, figure)
    FigureCanvasAgg(figure).draw()
    [legend] = figure.legends
    told = [text.get_text() for text in legend.get_texts()]
    assert len(told) == 2
    for panel in panels:
        assert panel.get_legend() is None
        assert not panel.get_window_extent().overlaps(legend.get_window_extent())
