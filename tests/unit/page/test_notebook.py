"""What `result.show()` puts into a notebook: a page that is whole in itself, and points that say what the result holds."""

from __future__ import annotations

import json
import re
from html import unescape

import numpy as np
import pytest

import rotorgear as rg
from tests.paths import ROOT

ROTOR = rg.load(ROOT / "models" / "jeffcott.toml")


def page_of(shown: object) -> str:
    """The page that a notebook puts into the frame."""
    frame = shown._repr_html_()  # type: ignore[attr-defined]
    found = re.fullmatch(r'<iframe sandbox="allow-scripts" [^>]*srcdoc="([^"]*)"></iframe>', frame)
    assert found
    return unescape(found[1])


def test_modes_are_the_turntable_of_the_report_and_their_names() -> None:
    modes = rg.modal(ROTOR, modes=3)
    shown = modes.show()
    page = page_of(shown)
    assert repr(shown) == repr(modes)
    scene = re.search(r'id="turntable-scene">(.*?)</script>', page)
    assert scene
    assert [mode["name"].split(" Hz")[0] for mode in json.loads(scene[1])["modes"]] == [
        f"{k + 1}: {frequency:.2f}" for k, frequency in enumerate(modes.frequency_hz) if not modes.rigid[k]
    ]
    assert not re.search(r"(src|href)=|https?://(?!www.w3.org)", page), "it asks for something from elsewhere"


def test_points_of_a_picture_stand_where_it_draws_them_and_say_what_the_result_holds() -> None:
    result = rg.campbell(ROTOR, speeds=[0.0, 100.0, 200.0], modes=2)
    page = page_of(result.show())
    assert page.count("<svg") == 1
    points = json.loads(re.findall(r"hover\(document.querySelector\('.box'\), (\[.*?\])\);", page)[-1])
    said = [[float(line.rpartition(": ")[2]) for line in words.splitlines()[-2:]] for *_, words in points]
    assert all(0.0 <= x <= 1.0 and 0.0 <= y <= 1.0 for x, y, _ in points)
    first = float(result.frequency_hz[0, 0])
    assert any(speed == 0.0 and frequency == pytest.approx(first, rel=1e-5) for speed, frequency in said)
    # On straight axes places follow from values by one scale.
    places, values = np.array([point[:2] for point in points], dtype=float), np.array(said)
    for axis in (0, 1):
        scale = np.polyfit(values[:, axis], places[:, axis], 1)
        assert np.polyval(scale, values[:, axis]) == pytest.approx(places[:, axis], abs=2e-4)
        assert (scale[0] > 0.0) == (axis == 0)


def test_a_result_without_a_picture_says_so() -> None:
    with pytest.raises(rg.AnalysisError, match="has no picture"):
        rg.check(ROTOR).show()
