"""Figures of matplotlib."""

from __future__ import annotations

import logging
from pathlib import Path

import pytest

pytest.importorskip("matplotlib")

from rotorgear.plots.figure import beside, name_axes, new_figure, save


def test_a_font_that_is_not_there_is_no_news_to_the_user(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.WARNING)
    figure = new_figure((2.0, 1.0))
    figure.text(0.1, 0.5, "words", family="a font that nobody has")
    save(figure, tmp_path / "words.png")
    assert [record.getMessage() for record in caplog.records if record.name.startswith("matplotlib")] == []


@pytest.mark.parametrize("title", [r"a $\frac{ b_{$", "$x^$", "5 $ and 6 $"])
def test_a_title_is_no_formula(title: str, tmp_path: Path) -> None:
    figure = new_figure((3.0, 2.0), title)
    axis = figure.subplots()
    name_axes(axis, title=title)
    beside(axis, title, (0.5, 0.5), (1.0, 1.0))
    assert save(axis, tmp_path / "a.png").stat().st_size > 1000
