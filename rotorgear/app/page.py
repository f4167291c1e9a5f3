"""The page of `rotorgear app`: one desk for each browser tab, and the server that only this machine reaches."""

from __future__ import annotations

import asyncio
import contextlib
import socket
import threading
import time
import webbrowser
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import uvicorn
from fastapi import FastAPI
from nicegui import ui

from rotorgear.analysis.modal.modal import modal
from rotorgear.app.gate import HOST, Gate
from rotorgear.app.jobs import CancelledError, Jobs, report_of
from rotorgear.app.panels import LEAVES, File, Leaf, Middle, Modes, Parts
from rotorgear.app.scene import View
from rotorgear.app.study import Field, Study
from rotorgear.errors import RotorgearError
from rotorgear.files.own import text_of
from rotorgear.files.read import noting_nothing
from rotorgear.files.write import WriteError
from rotorgear.model.model import Model
from rotorgear.progress import listening
from rotorgear.results.modal import ModalResult

# CPU seconds of the last solution from which on modes answer when a number is let go, and not while it is dragged.
_SLOW = 0.3
# Seconds from one word to the next of what is being solved.
_TOLD = 0.4
# Seconds for which a page whose browser sleeps keeps its changes.
_PATIENCE = 3600.0


class SupersededError(RotorgearError):
    """Newer numbers have been asked for meanwhile."""


class Desk:
    """One page: a study, its modes, and the panels that show them."""

    def __init__(self, path: Path) -> None:
        self.study = Study(path)
        self.jobs = Jobs()
        self.view: View | None = None
        self.mode = 0
        self.part = ""
        self.is_at_speed = False
        self._number = 0
        self._turn = asyncio.Lock()
        self._seconds = 0.0
        self._step = ""  # of modes that are being found

    def build(self) -> None:
        """Put the panels on the page."""
        with ui.header().classes("rg-header items-center no-wrap"):
            ui.label(self.study.model.title or self.study.path.stem).classes("rg-title ellipsis")
            ui.label(self.study.path.name).classes("rg-name")
            ui.space()
            self.solving = ui.label("").classes("rg-status ellipsis")
            self.status = ui.label("").classes("rg-status ellipsis")
            self.bar = ui.linear_progress(0.0, show_value=False).props("instant-feedback").classes("rg-progress")
            self.cancel = ui.button("Cancel", on_click=self.jobs.cancel).props("dense flat no-caps color=white")
            self.undo = ui.button("Undo", icon="undo", on_click=self.take_back).props("dense flat no-caps color=white")
            self.save = ui.button("Save", icon="save", on_click=self.write).props("dense flat no-caps color=white")
            ui.button("Report", icon="description", on_click=self.report).props("dense flat no-caps color=white")
            ui.button("File", icon="download", on_click=self.download).props("dense flat no-caps color=white")
        with ui.element("div").classes("rg-desk"):
            with ui.element("div").classes("rg-left"):
                self.parts = Parts(self)
            with ui.element("div").classes("rg-middle"):
                self.middle = Middle(self)
            with ui.element("div").classes("rg-right"):
                self._leaves()
        ui.timer(_TOLD, lambda: self.solving.set_text(f"modes: {self._step}" if self._step else ""))
        self.working(False)
        self.marked()

    def _leaves(self) -> None:
        with ui.tabs(on_change=lambda event: self.opened(str(event.value))).props(
            "dense no-caps align=left inline-label outside-arrows mobile-arrows"
        ) as tabs:
            for name in ("Modes", *LEAVES, "Text"):
                ui.tab(name)
        self.leaves: dict[str, Leaf] = {}
        with ui.tab_panels(tabs, value="Modes", animated=False, keep_alive=True).classes("rg-leaves"):
            with ui.tab_panel("Modes"):
                self.modes = Modes(self)
            for name in LEAVES:
                with ui.tab_panel(name):
                    self.leaves[name] = Leaf(self, name)
            with ui.tab_panel("Text"):
                self.file = File(self)

    async def opened(self, name: str) -> None:
        """A leaf was opened: what is not there is computed."""
        if name in self.leaves:
            await self.leaves[name].fill()

    def choose(self, part: str) -> None:
        """Choose a part, in the tree and on the turntable."""
        known = self.study.parts
        # Planets stand on every pin, and once in the file; a solid of a part of a part is that part's.
        part = next((one for one in (part, part.partition("#")[0]) if one in known), "")
        if part != self.part:
            self.part = part
            self.parts.show()
        self.middle.turntable.run_method("choose", part)

    def choose_mode(self, mode: int) -> None:
        """Animate a mode, counted from 0."""
        if self.view is not None and 0 <= mode < len(self.view.result):
            self.mode = mode
            self.modes.mark()
            self.middle.mode()

    async def at_speed(self, on: bool) -> None:
        """Modes at the operating speed, or at standstill."""
        self.is_at_speed = on
        await self.solve()

    async def change(self, address: str, text: str | None) -> None:
        """Write a value, and answer with its modes, or with what is wrong."""
        if self.study.change(address, text):
            await self.changed()
        else:
            self.parts.show()
            self.marked()
            if self.view is not None:  # in place of what was seen of a drag
                self.modes.show(self.view.result, live=False)

    async def drag(self, field: Field, text: str) -> None:
        """Frequencies with a value that is still being dragged."""
        if self._seconds > _SLOW:
            return
        with contextlib.suppress(RotorgearError):
            result = await self._modes(self.study.trial(field.address, text), shapes=False)
            self.modes.show(result, live=True)

    async def changed(self) -> None:
        """The text is another one: everything that shows it follows."""
        self.part = self.part if self.part in self.study.parts else ""
        self.parts.show()
        self.marked()
        await self.solve()

    def marked(self) -> None:
        """Show what can be undone and saved, and which leaves are about an earlier text."""
        self.undo.set_enabled(self.study.can_undo)
        unsaved = self.study.text != self.study.saved
        self.save.set_enabled(unsaved)
        ui.run_javascript(f"window.unsaved = {'true' if unsaved else 'false'}")
        self.file.show()
        for leaf in self.leaves.values():
            leaf.outdated()

    async def solve(self) -> None:
        """Modes with their shapes, into table and turntable."""
        try:
            result = await self._modes(self.study.model, shapes=True)
        except SupersededError:
            return
        except RotorgearError as error:
            self.said(str(error))
            return
        self.view = await asyncio.to_thread(View, result)
        first = next((k for k in range(len(result)) if not result.rigid[k]), 0)
        self.mode = self.mode if 0 < self.mode < len(result) else first
        self.modes.show(result, live=False)
        self.middle.shown()

    async def _modes(self, model: Model, *, shapes: bool) -> ModalResult:
        """Modes of a model, unless newer ones are asked for before they are found.

        Raises:
            SupersededError: they were. RotorgearError: by the analysis.
        """
        self._number += 1
        number = self._number
        speed = model.operating_speed if self.is_at_speed else None

        def progress(fraction: float, step: str) -> None:
            if number != self._number:
                raise SupersededError("newer numbers were asked for")
            self._step = step

        def found() -> ModalResult:
            start = time.thread_time()
            with listening(progress):
                result = modal(model, speed=speed, shapes=shapes, progress=progress)
            self._seconds = time.thread_time() - start
            return result

        async with self._turn:
            progress(0.0, "")
            try:
                result = await asyncio.to_thread(found)
            finally:
                self._step = ""
            progress(1.0, "")
            return result

    async def job(self, title: str, work: Callable[..., Any], *given: Any) -> Any:
        """Do long work in the process beside this one, with its progress above."""

        def progress(fraction: float, step: str) -> None:
            self.bar.value = fraction
            self.status.text = f"{title}: {step}"

        self.working(True)
        progress(0.0, "begins")
        try:
            return await self.jobs.run(work, *given, progress=progress)
        finally:
            self.working(False)

    def working(self, on: bool) -> None:
        """Show whether there is something to wait for, or to cancel."""
        self.bar.set_visibility(on)
        self.cancel.set_visibility(on)
        self.status.text = ""

    def said(self, text: str) -> None:
        """Tell something that went wrong, or well."""
        ui.notify(text, multi_line=True, close_button="Close", timeout=8000)
        self.status.text = ""

    async def take_back(self) -> None:
        """Undo the last change."""
        self.study.undo()
        await self.changed()

    def write(self) -> None:
        """Save into the file."""
        try:
            path = self.study.save()
        except WriteError as error:
            self.said(str(error))
            return
        self.marked()
        self.said(f"saved {path.name}")

    async def report(self) -> None:
        """The page of `rotorgear report`, to the browser's downloads."""
        study = self.study
        rig = self.leaves["Rig"].rig
        try:
            given = (study.text, (study.path.name, str(study.folder)), None if rig is None else str(study.rig(rig)))
            page = await self.job("report", report_of, *given)
        except CancelledError:
            return
        except RotorgearError as error:
            self.said(str(error))
            return
        ui.download.content(page, f"{study.path.stem}.html", "text/html")

    def download(self) -> None:
        """The text as it stands, to the browser's downloads."""
        ui.download.content(self.study.text.encode(), self.study.path.name, "application/toml")


def _page(path: Path) -> Callable[[], Awaitable[None]]:
    """What builds the page for each tab that opens it."""
    folder = Path(__file__).parent
    script = text_of(folder.parent / "page" / "turntable.js")
    look = text_of(folder / "page.css")
    leaving = "window.addEventListener('beforeunload', e => { if (window.unsaved) { e.preventDefault(); } });"

    async def page() -> None:
        ui.add_head_html(f"<style>{look}</style><script>{script}\n{leaving}</script>")
        try:
            desk = Desk(path)
        except RotorgearError as error:  # the file was changed since the server began
            ui.label(str(error)).style("white-space: pre-wrap")
            return
        ui.page_title(f"{path.name}: rotorgear")
        desk.build()
        client = ui.context.client
        client.on_delete(desk.jobs.close)
        await client.connected()
        await desk.solve()

    return page


def server(path: Path, port: int = 0) -> tuple[uvicorn.Server, socket.socket, Gate]:
    """The server of a model, its socket on this machine, and the gate in front of it.

    Args:
        path: of the model file. port: 0 for any that is free.

    Raises:
        OSError: the port is taken.
    """
    listener = socket.create_server((HOST, port))
    application = FastAPI(openapi_url=None)
    ui.page("/", title="rotorgear", favicon="⚙")(_page(path))
    ui.run_with(application, show_welcome_message=False, reconnect_timeout=_PATIENCE, dark=False, tailwind=False)
    gate = Gate(application, listener.getsockname()[1])
    settings = uvicorn.Config(gate, log_level="warning", access_log=False, timeout_graceful_shutdown=1)
    return uvicorn.Server(settings), listener, gate


def serve(path: Path, port: int, *, browser: bool, say: Callable[[str], None]) -> None:
    """Serve the page of a model until it is interrupted.

    Args:
        path: of the model file. port: 0 for any that is free. browser: open the page in the browser.
        say: is told the address.

    Raises:
        ModelError: what is wrong in the file. RotorgearError: the port is taken.
    """
    with noting_nothing():
        Study(path)  # mistakes are told here, and not in a browser
        try:
            serving, listener, gate = server(path.resolve(), port)
        except OSError as error:
            raise RotorgearError(f"--port {port}: it can't be had on this machine ({error.strerror})") from None
        say(f"{path} is open at\n  {gate.address}\nOnly this machine reaches it. Ctrl-C ends it.")
        if browser:
            threading.Timer(0.5, webbrowser.open, (gate.address,)).start()
        with contextlib.suppress(KeyboardInterrupt):
            serving.run(sockets=[listener])
