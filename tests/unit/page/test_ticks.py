"""Ticks of a page's pictures: what stands along a logarithmic axis stays, in fewer artists."""

from __future__ import annotations

import re

import numpy as np
import pytest

from rotorgear.page.figures import painted, svg_of
from rotorgear.page.ticks import power_of_ten, settle
from rotorgear.plots.figure import new_figure


@pytest.mark.parametrize(("value", "word"), [(1000.0, "10³"), (1e-12, "10⁻¹²"), (1.0, "10⁰"), (25.0, "25")])
def test_powers_of_ten_are_letters(value: float, word: str) -> None:
    assert power_of_ten(value) == word


def test_small_ticks_of_a_logarithmic_axis_stay_where_they_were() -> None:
    axis = new_figure((4.0, 3.0)).subplots()
    axis.semilogy([1.0, 2.0], [0.3, 4e4])
    low, high = axis.get_ylim()
    before = [place for place in axis.yaxis.get_minorticklocs() if low <= place <= high]
    settle(axis.figure)
    assert len(axis.yaxis.get_minorticklocs()) == 0
    markers = [line for line in axis.artists + axis.lines if line.get_linestyle() == "None"]
    np.testing.assert_array_equal(np.sort(markers[-1].get_ydata()), np.sort(before))
    assert (low, high) == axis.get_ylim()


def test_small_ticks_with_names_keep_them() -> None:
    axis = new_figure((4.0, 3.0)).subplots()
    axis.semilogy([1.0, 2.0], [2.1, 6.7])
    names = [name for name in axis.yaxis.get_minor_formatter().format_ticks(axis.yaxis.get_minorticklocs()) if name]
    assert names
    settle(axis.figure)
    assert len(axis.yaxis.get_minorticklocs())


def test_powers_of_ten_can_be_read_in_the_picture() -> None:
    axis = new_figure((4.0, 3.0)).subplots()
    axis.semilogy([1.0, 2.0], [1e-3, 4e4])
    text = svg_of(axis, "curve")
    assert {"10⁻³", "10⁰", "10³"} <= set(re.findall(r">(10[^<]*)</text>", text))


def test_polygons_are_painted_one_over_the_other_where_they_lie() -> None:
    from io import BytesIO

    from PIL import Image

    whole = [[0.0, 0.0], [8.0, 0.0], [8.0, 6.0], [0.0, 6.0]]
    right = [[4.0, 0.0], [8.0, 0.0], [8.0, 6.0], [4.0, 6.0]]
    glass = [[0.0, 3.0], [8.0, 3.0], [8.0, 6.0], [0.0, 6.0]]
    colours = np.array([[1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0], [0.0, 1.0, 0.0, 0.2]])
    pixels = np.asarray(Image.open(BytesIO(painted(np.array([whole, right, glass]), colours, (8, 6)))))
    assert pixels.shape == (6, 8, 3)
    np.testing.assert_array_equal(pixels[1, 1], [255, 0, 0])
    np.testing.assert_array_equal(pixels[1, 6], [0, 0, 255])
    np.testing.assert_allclose(pixels[4, 1], [204, 51, 0], atol=2)
