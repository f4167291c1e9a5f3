"""A Chromium without a window, driven over its debugging socket: what it shows, says and asks for."""

from __future__ import annotations

import base64
import json
import shutil
import subprocess
import time
import urllib.request
from contextlib import suppress
from pathlib import Path
from typing import Any

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
# Software rendering, so that the turntable's script runs to its end.
QUIET = ("--no-sandbox", "--disable-background-networking", "--no-first-run", "--disable-component-update")
DRAWING = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")


class Chromium:
    """One tab. `console`: errors and warnings of the page; `asked`: addresses of its requests."""

    def __init__(self, profile: Path, size: tuple[int, int] = (1600, 950)) -> None:
        from websockets.sync.client import connect

        options = [f"--user-data-dir={profile}", "--remote-debugging-port=0", f"--window-size={size[0]},{size[1]}"]
        command = [str(CHROMIUM), "--headless", *QUIET, *DRAWING, *options, "about:blank"]
        self._process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        told = profile / "DevToolsActivePort"
        until = time.monotonic() + 30.0
        while not (told.exists() and told.read_text().count("\n") >= 1):
            assert time.monotonic() < until, "Chromium did not start"
            time.sleep(0.1)
        port = told.read_text().split("\n")[0]
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/json") as answer:
            target = next(one for one in json.load(answer) if one["type"] == "page")
        self._socket = connect(target["webSocketDebuggerUrl"], max_size=None)
        self._number = 0
        self.console: list[str] = []
        self.asked: list[str] = []
        for domain in ("Page", "Runtime", "Network", "Log"):
            self.call(f"{domain}.enable")

    def __enter__(self) -> Chromium:
        return self

    def __exit__(self, *_: object) -> None:
        with suppress(Exception):
            self.call("Browser.close")
        self._socket.close()
        self._process.terminate()
        self._process.wait(20)

    def call(self, method: str, **given: Any) -> dict[str, Any]:
        """Ask the browser for something, and return its answer."""
        self._number += 1
        self._socket.send(json.dumps({"id": self._number, "method": method, "params": given}))
        while True:
            answer = json.loads(self._socket.recv(timeout=60.0))
            if answer.get("id") == self._number:
                assert "error" not in answer, answer
                return answer.get("result", {})
            self._noted(answer)

    def _noted(self, event: dict[str, Any]) -> None:
        given = event.get("params", {})
        match event.get("method"):
            case "Runtime.consoleAPICalled" if given["type"] in ("error", "warning", "assert"):
                self.console.append(str([one.get("value", one.get("description")) for one in given["args"]]))
            case "Runtime.exceptionThrown":
                self.console.append(str(given["exceptionDetails"].get("exception", given["exceptionDetails"])))
            case "Log.entryAdded" if given["entry"]["level"] in ("error", "warning"):
                self.console.append(f"{given['entry']['text']} {given['entry'].get('url', '')}")
            case "Network.requestWillBeSent":
                self.asked.append(given["request"]["url"])
            case "Network.webSocketCreated":
                self.asked.append(given["url"])

    def open(self, address: str) -> None:
        """Go to a page."""
        self.call("Page.navigate", url=address)

    def js(self, expression: str) -> Any:
        """The value of an expression in the page."""
        found = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in found, found["exceptionDetails"]
        return found["result"].get("value")

    def wait(self, expression: str, seconds: float = 30.0) -> Any:
        """Wait until an expression is true, and return it."""
        until = time.monotonic() + seconds
        while not (found := self.js(expression)):
            assert time.monotonic() < until, f"never true: {expression}"
            time.sleep(0.05)
        return found

    def press(self, x: float, y: float, *, to: tuple[float, float] | None = None, hold: bool = False) -> None:
        """Click at a place, or drag from there; `hold`: without letting go."""
        mouse = {"button": "left", "clickCount": 1}
        self.call("Input.dispatchMouseEvent", type="mousePressed", x=x, y=y, **mouse)
        if to is not None:
            for k in range(1, 9):
                at = {"x": x + (to[0] - x) * k / 8, "y": y + (to[1] - y) * k / 8}
                self.call("Input.dispatchMouseEvent", type="mouseMoved", buttons=1, **at, **mouse)
                time.sleep(0.03)
            x, y = to
        if not hold:
            self.release(x, y)

    def release(self, x: float, y: float) -> None:
        """Let go."""
        self.call("Input.dispatchMouseEvent", type="mouseReleased", x=x, y=y, button="left", clickCount=1)

    def place(self, element: str) -> tuple[float, float]:
        """The middle of an element that an expression finds, scrolled into view."""
        self.js(f"({element}).scrollIntoView({{block: 'center'}})")
        box = self.js(
            f"(() => {{ const b = ({element}).getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; }})()"
        )
        return float(box[0]), float(box[1])

    def click(self, element: str) -> None:
        """Click an element that an expression finds."""
        self.press(*self.place(element))

    def type(self, text: str) -> None:
        """Type into what has the focus, in place of what stands there."""
        self.call("Input.dispatchKeyEvent", type="keyDown", key="a", code="KeyA", modifiers=2, commands=["selectAll"])
        self.call("Input.dispatchKeyEvent", type="keyUp", key="a", code="KeyA", modifiers=2)
        self.call("Input.insertText", text=text)
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key="Enter", code="Enter", windowsVirtualKeyCode=13)

    def picture(self, path: Path) -> Path:
        """Keep what is seen as a PNG."""
        path.write_bytes(base64.b64decode(self.call("Page.captureScreenshot")["data"]))
        return path
