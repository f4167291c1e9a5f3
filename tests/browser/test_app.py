"""The page of `rotorgear app` in a browser without a window: a person's way through it, and whom the server turns away."""

from __future__ import annotations

import json
import os
import re
import shutil
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

import rotorgear as rg
from rotorgear.results.table import Table
from tests.browser.chromium import CHROMIUM, Chromium
from tests.paths import ROOT

pytestmark = [pytest.mark.long, pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")]
ROWS = "[...document.querySelectorAll('.rg-modes tbody tr')].map(r => [...r.cells].map(c => c.textContent.trim()))"
READY = (
    "document.querySelectorAll('.rg-modes tbody tr').length > 0 && document.querySelector('.rg-headline').textContent"
)
# One of each sort: a casing, planets, films, a rotor without gears, rigid teeth, dofs without mass.
MODELS = (
    "split_torque_casing",
    "planetary",
    "split_torque_journals",
    "jeffcott",
    "ev_reducer",
    "herringbone_pair_12dof",
)
# Waiting for a process that takes what there is of two cores.
LONG = 900.0


@contextmanager
def served(model: str, folder: Path, text: str | None = None) -> Iterator[tuple[str, Path]]:
    """The address of a page about a copy of a shipped model, and that copy."""
    for file in (ROOT / "models").iterdir():
        shutil.copy(file, folder)
    path = folder / f"{model}.toml"
    if text is not None:
        path.write_text(text, encoding="utf-8")
    command = [sys.executable, "-m", "rotorgear", "app", path.name, "--no-browser"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    run = subprocess.Popen(
        command, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    assert run.stdout is not None
    try:
        said = ""
        while "token=" not in said:
            line = run.stdout.readline()
            assert line, said
            said += line
        found = re.search(r"http://\S+", said)
        assert found
        yield found[0], path
    finally:
        run.terminate()
        run.wait(20)


def tab(name: str) -> str:
    return f"[...document.querySelectorAll('.rg-right .q-tab')].find(t => t.textContent.trim() === '{name}')"


def button(name: str) -> str:
    return f"[...document.querySelectorAll('button')].find(b => b.textContent.includes('{name}') && b.offsetParent)"


def entry(label: str) -> str:
    return f"document.querySelector('.rg-form input[aria-label=\"{label}\"]')"


def shown_by(model: rg.Model) -> list[list[str]]:
    """The table of modes as the terminal has it."""
    table = next(one for one in rg.modal(model).tables() if isinstance(one, Table))
    return [[cell.text for cell in row] for row in table.rows]


def as_text(rows: list[list[str]]) -> str:
    """Rows as JSON.stringify writes them, as a text of a script."""
    return json.dumps(json.dumps(rows, separators=(",", ":"), ensure_ascii=False))


def choose(page: Chromium, part: str) -> None:
    """Choose a part in the tree."""
    table, name = part.split(".")
    label = "[...document.querySelectorAll('.rg-tree .q-tree__node-header-content')].find(n => n.textContent.trim().{})"
    there = label.format(f"match(/^{name}$/)")
    if not page.js(f"!!({there}) && ({there}).offsetParent !== null"):
        page.click(label.format(f"startsWith('{table} (')"))
        page.wait(f"!!({there}) && ({there}).offsetParent !== null")
    page.click(there)
    page.wait(f"document.querySelector('.rg-form').textContent.startsWith('{part}')")


def test_a_persons_way_through_the_page(tmp_path: Path) -> None:
    with served("split_torque", tmp_path) as (address, path), Chromium(tmp_path / "profile") as page:
        page.open(address)
        page.wait(READY, 60.0)
        before = rg.load(path)
        assert page.js(ROWS) == shown_by(before)
        assert "token" not in page.js("location.href")

        # The middle of the picture is a part: a click finds it, and its numbers stand at the left.
        page.press(*page.place("document.querySelector('.rg-view canvas')"))
        page.wait("document.querySelector('.rg-form').textContent.startsWith('gears.')")

        # A bad value has the sentence of the file below it, and changes nothing.
        choose(page, "bearings.input_left")
        page.click(entry("stiffness.radial"))
        page.type("-3 N/m")
        told = page.wait("document.querySelector('.rg-form .q-field__messages')?.textContent")
        with pytest.raises(rg.ModelError) as refused:
            before.with_("bearings.input_left.stiffness.radial", "-3 N/m")
        assert told == str(refused.value.problems[0])
        page.click(button("Undo"))
        page.wait(f"{entry('stiffness.radial')}.value === '2.46e8 N/m'")

        # A good one changes the table to what rg.modal says, and one line of the file.
        page.click(entry("stiffness.radial"))
        page.type("1.2e8 N/m")
        after = before.with_("bearings.input_left.stiffness.radial", "1.2e8 N/m")
        page.wait(f"JSON.stringify({ROWS}) === {as_text(shown_by(after))}")
        text = path.read_text(encoding="utf-8")
        page.click(button("Save"))
        page.wait("document.body.textContent.includes('saved split_torque.toml')")
        saved = path.read_text(encoding="utf-8")
        differs = [(a, b) for a, b in zip(text.splitlines(), saved.splitlines(), strict=True) if a != b]
        assert len(differs) == 1
        assert differs[0][1] == differs[0][0].replace("2.46e8", "1.2e8")

        # While a number is dragged the frequencies follow, and after it they are those of the number.
        slider = "document.querySelectorAll('.rg-form .rg-slider')[1]"
        x, y = page.place(slider)
        wide = page.js(f"{slider}.getBoundingClientRect().width")
        page.press(x, y, to=(x + 0.2 * wide, y), hold=True)
        page.wait("document.querySelector('.q-tab-panel').textContent.includes('dragging')")
        time.sleep(1.0)  # the browser tells of a drag ten times a second
        value = page.js(f"{entry('stiffness.radial')}.value")
        dragged = shown_by(after.with_("bearings.input_left.stiffness.radial", value))
        live = f"{ROWS}.map(r => r.slice(0, 3))"
        page.wait(f"JSON.stringify({live}) === {as_text([row[:3] for row in dragged])}")
        page.release(x + 0.2 * wide, y)
        page.wait("!document.querySelector('.q-tab-panel').textContent.includes('dragging')")
        page.wait(f"{entry('stiffness.radial')}?.value === '{value}'")
        page.wait(f"JSON.stringify({ROWS}) === {as_text(dragged)}")

        # A long job runs, is cancelled, and runs again.
        page.click(tab("Run-up"))
        page.wait(f"!!({button('Cancel')})")
        page.click(button("Cancel"))
        page.wait("document.body.textContent.includes('cancelled')")
        page.click(tab("Campbell"))
        page.wait("document.querySelectorAll('.rg-right .rg-figure img').length > 0", LONG)
        page.wait("[...document.querySelectorAll('.rg-figure img')].every(i => i.complete && i.naturalWidth > 0)")
        assert page.console == []
        foreign = [one for one in page.asked if not re.match(r"(http|ws)://127\.0\.0\.1:|data:|blob:|about:", one)]
        assert foreign == []


@pytest.mark.parametrize("model", MODELS)
def test_shipped_models_open_on_every_leaf(model: str, tmp_path: Path) -> None:
    with served(model, tmp_path) as (address, path), Chromium(tmp_path / "profile") as page:
        page.open(address)
        page.wait(READY, LONG)
        assert page.js(ROWS) == shown_by(rg.load(path))
        for name in ("Campbell", "Run-up", "Loads", "Teeth", "Rules", "Text"):
            page.click(tab(name))
            page.wait(f"({tab(name)}).classList.contains('q-tab--active')")
            page.wait(f"!({button('Cancel')})", LONG)
            page.wait(
                "[...document.querySelectorAll('.q-tab-panel')].some(p => p.offsetParent && p.textContent.length > 20)",
                LONG,
            )
            page.wait(f"!({button('Cancel')})", LONG)
            assert "a fault of rotorgear" not in page.js("document.body.textContent")
            page.picture(tmp_path / f"{model}_{name}.png")
        assert page.console == []


def test_names_and_titles_are_text(tmp_path: Path) -> None:
    evil = "<img src=x onerror='window.caught=1'>**bold**<script>window.caught=1</script>"
    text = (ROOT / "models" / "jeffcott.toml").read_text(encoding="utf-8")
    text = re.sub(r'title = ".*"', lambda _: f'title = "{evil}"', text, count=1)
    with served("jeffcott", tmp_path, text) as (address, _), Chromium(tmp_path / "profile") as page:
        page.open(address)
        page.wait(READY, 60.0)
        assert page.js("document.querySelector('.rg-title').textContent") == evil
        for name in ("Campbell", "Text"):
            page.click(tab(name))
            page.wait(f"({tab(name)}).classList.contains('q-tab--active')")
            page.wait(f"!({button('Cancel')})", LONG)
        assert page.js("window.caught === undefined && !document.querySelector('img[src=x]')")


def test_two_pages_have_two_states(tmp_path: Path) -> None:
    with (
        served("jeffcott", tmp_path) as (address, path),
        Chromium(tmp_path / "one") as one,
        Chromium(tmp_path / "other") as other,
    ):
        for page in (one, other):
            page.open(address)
            page.wait(READY, 60.0)
        before = shown_by(rg.load(path))
        choose(one, f"disks.{next(iter(rg.load(path).disks))}")
        one.click(entry("width"))
        one.type("30 mm")
        one.wait(f"JSON.stringify({ROWS}) !== {as_text(before)}")
        assert other.js(ROWS) == before


def answer(address: str, **headers: str) -> tuple[int, str]:
    """Status and text of an answer to a plain request, redirections not followed."""

    class Stay(urllib.request.HTTPRedirectHandler):
        def redirect_request(self, *_: Any) -> None:
            return None

    request = urllib.request.Request(address, headers={key.replace("_", "-"): value for key, value in headers.items()})
    try:
        with urllib.request.build_opener(Stay).open(request, timeout=20) as found:
            return found.status, found.read().decode()
    except urllib.error.HTTPError as error:
        return error.code, error.headers.get("set-cookie", "") or error.read().decode()


def test_the_server_turns_away_all_but_its_own_browser(tmp_path: Path) -> None:
    from websockets.exceptions import InvalidStatus
    from websockets.sync.client import connect

    with served("jeffcott", tmp_path) as (address, _):
        base, _, token = address.partition("?token=")
        port = base.rstrip("/").rpartition(":")[2]
        status, cookie = answer(address)
        cookie = cookie.partition(";")[0]
        assert (status, answer(base, Cookie=cookie)[0]) == (303, 200)
        assert answer(base)[0] == 403
        assert answer(f"{base}?token={token[:-1]}")[0] == 403
        assert answer(base, Cookie=cookie, Host=f"evil.example:{port}")[0] == 403
        assert answer(base, Cookie=cookie, Origin="http://evil.example")[0] == 403
        assert answer(f"{base}_nicegui/static/nicegui.js")[0] == 403
        for path in ("../jeffcott.toml", "jeffcott.toml", "%2e%2e/%2e%2e/etc/passwd", "_nicegui/../../etc/passwd"):
            assert answer(base + path, Cookie=cookie)[0] == 404
        at = f"ws://127.0.0.1:{port}/_nicegui_ws/socket.io/?EIO=4&transport=websocket"
        own = f"http://127.0.0.1:{port}"
        for given in ({}, {"Cookie": cookie, "Origin": "http://evil.example"}, {"Cookie": cookie}, {"Origin": own}):
            with pytest.raises(InvalidStatus):
                connect(at, additional_headers=given)
        with connect(at, additional_headers={"Cookie": cookie, "Origin": own}) as own_socket:
            assert str(own_socket.recv(timeout=10)).startswith("0{")  # the greeting of engine.io
        # No other machine reaches it: only the loopback listens.
        own_address = next(
            (one[4][0] for one in socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)), "127.0.0.1"
        )
        if not own_address.startswith("127."):
            with pytest.raises(ConnectionRefusedError):
                socket.create_connection((own_address, int(port)), timeout=5)
