"""Campbell diagrams: lines by the names of their parts, sidebands without a heap of names, branches of every kind of motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.results import campbell as table
from tests.paths import ROOT


@pytest.fixture(scope="module")
def result() -> rg.CampbellResult:
    return rg.campbell(rg.load(ROOT / "models" / "helical_pair.toml"), points=5, modes=6, elements=1, sidebands=2)


def test_many_sidebands_have_no_names_and_meshes_keep_theirs(result: rg.CampbellResult) -> None:
    assert sum(line.kind == "sideband" for line in result.lines) > 8
    words = [text.get_text() for text in rg.plot.campbell(result).texts]
    assert "stage 1x" in words
    assert not [text for text in words if "±" in text or " + " in text]


def test_a_line_names_two_parts_and_counts_more(result: rg.CampbellResult) -> None:
    line = next(line for line in result.lines if line.kind == "mesh")
    two = replace(line, name="mesh a, b 1x", parts=("a", "b"))
    four = replace(line, name="mesh a, b, c, d 2x", parts=("a", "b", "c", "d"))
    words = [text.get_text() for text in rg.plot.campbell(replace(result, lines=(two, four))).texts]
    assert "a, b 1x" in words
    assert "a and 3 others 2x" in words


def test_branches_of_casings_and_gear_bodies_have_their_colours(result: rg.CampbellResult) -> None:
    more = {name: np.full(result.frequency_hz.shape, 0.1) for name in ("casing", "gear body")}
    more["casing"][:] = np.nan  # shares of a motion without energy
    axes = rg.plot.campbell(replace(result, kinetic_by_motion=dict(result.kinetic_by_motion) | more))
    assert all(np.isfinite(lines.get_colors()).all() for lines in axes.collections if hasattr(lines, "get_colors"))


def test_a_long_list_of_crossings_is_cut_to_those_that_take_part_most(
    result: rg.CampbellResult, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(table, "_MOST_CROSSINGS", 3)
    text = result.text(crossings=True)
    assert f"{len(result.crossings) - 3} more crossings take part less" in text
    largest = max(result.crossings, key=lambda item: item.participation)
    assert f"{100.0 * largest.participation:.2f}" in text


def test_frequencies_are_logarithmic_where_shaft_orders_would_lie_flat(result: rg.CampbellResult) -> None:
    top = 1.04 * float(np.nanmax(result.frequency_hz))
    fastest = float(np.abs(result.speed_rpm).max()) / 60.0
    first = next(line for line in result.lines if line.kind == "shaft")
    near = rg.plot.campbell(replace(result, lines=(replace(first, order=0.3 * top / fastest),)))
    assert near.get_yscale() == "linear"
    assert near.get_ylim()[0] == 0.0
    end = 0.1 * top
    far = rg.plot.campbell(replace(result, lines=(replace(first, order=end / fastest),)))
    assert far.get_yscale() == "log"
    # The name stands where its line ends, on this axis too.
    low, high = np.log(far.get_ylim())
    (name,) = (text for text in far.texts if text.get_text().endswith("1x"))
    assert name.get_position()[1] == pytest.approx((np.log(end) - low) / (high - low), abs=0.01)
