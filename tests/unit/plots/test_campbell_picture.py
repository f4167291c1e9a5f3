"""Campbell diagrams: lines by the names of their parts, sidebands without a heap of names, branches of every kind of motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.plots import campbell as picture
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


def with_line(result: rg.CampbellResult, end: float) -> rg.CampbellResult:
    """The result with one line of a shaft alone, which ends at so many Hz."""
    fastest = float(np.abs(result.speed_rpm).max()) / 60.0
    first = next(line for line in result.lines if line.kind == "shaft")
    return replace(result, lines=(replace(first, order=end / fastest),), crossings=(), onsets=())


def test_lines_are_straight_from_the_origin_unless_asked_otherwise(result: rg.CampbellResult) -> None:
    highest = float(np.nanmax(result.frequency_hz))
    usual = rg.plot.campbell(with_line(result, 0.3 * highest))
    assert usual.get_yscale() == "linear"
    assert usual.get_ylim()[0] == 0.0
    far = rg.plot.campbell(with_line(result, 0.1 * highest), log=True)
    assert far.get_yscale() == "log"
    assert far.get_ylim()[1] > highest
    # The name stands where its line ends, on this axis too.
    low, high = np.log(far.get_ylim())
    (name,) = (text for text in far.texts if text.get_text().endswith("1x"))
    assert name.get_position()[1] == pytest.approx((np.log(0.1 * highest) - low) / (high - low), abs=0.01)


def test_the_picture_ends_above_the_branch_beyond_all_lines_and_counts_the_others(result: rg.CampbellResult) -> None:
    lowest = np.sort(np.nanmin(result.frequency_hz, axis=0))
    elastic = lowest[lowest > 1.0]
    axes = rg.plot.campbell(with_line(result, 0.5 * (elastic[0] + elastic[1])))
    top = axes.get_ylim()[1]
    beyond = next(b for b in range(len(result)) if np.nanmin(result.frequency_hz[:, b]) == elastic[1])
    assert top > np.nanmax(result.frequency_hz[:, beyond])
    above = int(np.count_nonzero(lowest > top))
    told = [text.get_text() for text in axes.texts if "above" in text.get_text()]
    assert told == (
        [f"{above} branch{'es'[: 2 * (above != 1)]} up to {np.nanmax(result.frequency_hz):.4g} Hz above"]
        if above
        else []
    )
    assert not [
        text for text in rg.plot.campbell(with_line(result, 2.0 * lowest[-1])).texts if "above" in text.get_text()
    ]


@pytest.fixture(scope="module")
def whirling() -> rg.CampbellResult:
    """A rotor whose internal damping makes its first forward branch grow above its critical speed."""
    rotor = """
        [operation]
        input_shaft = "rotor"
        speed = "100 rad/s"
        [shafts.rotor]
        material = "steel"
        internal_damping = "2e-4 s"
        sections = [{ length = "1 m", outer_diameter = "40 mm" }]
        [bearings.left]
        shaft = "rotor"
        at = "start"
        stiffness = { radial = "1e8 N/m", axial = "1e8 N/m" }
        [bearings.right]
        shaft = "rotor"
        at = "end"
        stiffness = { radial = "1e8 N/m" }
    """
    return rg.campbell(rg.loads(rotor), speeds=[100.0, 300.0, 900.0], modes=6)


def test_what_grows_is_marked_from_its_onset_on(whirling: rg.CampbellResult) -> None:
    onset = next(one for one in whirling.onsets if one.branch)
    rpm = onset.speed * 30.0 / np.pi
    axes = rg.plot.campbell(whirling)
    assert f"unstable from {rpm:.0f} rpm" in [text.get_text() for text in axes.texts]
    crosses = [line.get_xydata()[0] for line in axes.lines if line.get_marker() == "X"]
    assert np.allclose(crosses[0], (rpm, onset.frequency_hz))
    # Of each branch that grows the whole part from there is on the band, and nothing before it.
    (band, *_) = (line for line in axes.lines if line.get_linewidth() == 6.0)
    x = band.get_xdata()
    assert np.nanmin(x) == pytest.approx(rpm)
    assert np.nanmax(x) == pytest.approx(whirling.speed_rpm[-1])
    assert "unstable" in [
        text.get_text() for text in axes.figure.findobj(lambda one: hasattr(one, "get_texts"))[0].get_texts()
    ]


def test_a_stable_machine_has_no_such_mark(result: rg.CampbellResult) -> None:
    axes = rg.plot.campbell(result)
    assert not [line for line in axes.lines if line.get_marker() == "X" or line.get_linewidth() == 6.0]


def test_all_points_that_were_solved_are_on_the_branches(whirling: rg.CampbellResult) -> None:
    axes = rg.plot.campbell(whirling)
    drawn = np.concatenate(
        [np.concatenate(lines.get_segments()) for lines in axes.collections if hasattr(lines, "get_segments")]
    )
    assert len(whirling.crossings) > 2
    for met in whirling.crossings:
        here = np.array([met.speed * 30.0 / np.pi, met.frequency_hz])
        assert np.min(np.abs(drawn / here - 1.0).max(axis=1)) < 1e-9


# G. M. Machado et al., IEEE Transactions on Visualization and Computer Graphics 15 (2009): no red cones, no green ones.
PROTAN = np.array([[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]])
DEUTAN = np.array([[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]])
GREY = np.tile([0.2126, 0.7152, 0.0722], (3, 1))


@pytest.mark.parametrize(("seen", "least"), [(PROTAN, 0.2), (DEUTAN, 0.2), (GREY, 0.05)])
def test_motions_are_told_apart_without_red_or_green_and_in_grey(seen: np.ndarray, least: float) -> None:
    motions = picture._MOTION
    linear = np.array([motions[name] for name in ("bending", "axial", "torsion")]) ** 2.2
    looks = np.clip(linear @ seen.T, 0.0, 1.0)
    for a, b in ((0, 1), (0, 2), (1, 2)):
        assert np.abs(looks[a] - looks[b]).max() > least
