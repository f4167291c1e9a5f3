"""What a notebook shows, in a browser without a window: solids come up, points answer the mouse, the console says nothing."""

from __future__ import annotations

from pathlib import Path

import pytest

import rotorgear as rg
from tests.browser.chromium import CHROMIUM, Chromium
from tests.paths import ROOT

pytestmark = [pytest.mark.long, pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")]


def test_modes_come_up_and_points_answer_the_mouse(tmp_path: Path) -> None:
    rotor = rg.load(ROOT / "models" / "jeffcott.toml")
    with Chromium(tmp_path / "profile", (1000, 800)) as browser:
        for name, result in (("modes", rg.modal(rotor, modes=4)), ("campbell", rg.campbell(rotor, modes=2))):
            page = tmp_path / f"{name}.html"
            page.write_text(result.show().page, encoding="utf-8")
            browser.open(page.as_uri())
            if name == "modes":
                browser.wait("document.getElementById('turntable')?.hidden === false")
                assert browser.js("document.getElementById('turntable-mode').options.length") == 3
                continue
            browser.wait("!!document.querySelector('.said')")
            box = "document.querySelector('.box').firstElementChild.getBoundingClientRect()"
            x, y, wide, high = (browser.js(f"{box}.{key}") for key in ("x", "y", "width", "height"))
            for share in range(5, 95):
                browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=x + 0.5 * wide, y=y + high * share / 100)
                if browser.js("!document.querySelector('.said').hidden"):
                    break
            assert "frequency, Hz:" in browser.js("document.querySelector('.said').textContent")
        assert browser.console == []
        assert [asked for asked in browser.asked if not asked.startswith(("file:", "data:"))] == []
