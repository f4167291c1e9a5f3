"""What stands on the page: parts and their numbers, the turntable, and what was found. All names go to it as text."""

from __future__ import annotations

import base64
import re
from collections.abc import Callable
from typing import Any, Protocol

from nicegui import ui

from rotorgear.app.jobs import sections_of
from rotorgear.app.scene import COLOURINGS, View
from rotorgear.app.study import Field, Study
from rotorgear.errors import RotorgearError
from rotorgear.page.turntable import mode_name
from rotorgear.results.modal import ModalResult
from rotorgear.results.table import Table

# Sections of the report on one leaf each; what a leaf says where its sections are empty.
LEAVES = {
    "Campbell": ("campbell", "critical"),
    "Run-up": ("run-up",),
    "Loads": ("statics",),
    "Teeth": ("teeth",),
    "Rules": ("standards",),
    "Rig": ("rig",),
}
_EMPTY = {"Teeth": 'No mesh of the model has stiffness = "tooth_fe", whose teeth are finite elements in contact.'}
# A drag goes from a fifth to five times the number.
_REACH = 5.0
# Seconds from one trial of a dragged number to the next.
_PACE = 0.1
_BARS = 12


class Desk(Protocol):
    """What panels ask of the page that they stand on."""

    study: Study
    view: View | None
    mode: int
    part: str

    def choose(self, part: str) -> None:
        """A part was chosen, by its address."""

    def choose_mode(self, mode: int) -> None:
        """A mode was chosen, counted from 0."""

    async def at_speed(self, on: bool) -> None:
        """Modes at the operating speed are asked for, or at standstill."""

    async def change(self, address: str, text: str | None) -> None:
        """A value was typed."""

    async def drag(self, field: Field, text: str) -> None:
        """A value is being dragged."""

    async def job(self, title: str, work: Callable[..., Any], *given: Any) -> Any:
        """Long work is asked for."""


class Turntable(ui.element, component="turntable_view.js"):  # type: ignore[call-arg]
    """The solids of the model, which the browser turns and moves by itself."""

    def __init__(self, pick: Callable[[str], None]) -> None:
        super().__init__()
        self.props["label"] = "The gearbox as solids that turn and move"
        self.on("pick", lambda event: pick(str(event.args or "")))


def text_line(text: str, classes: str = "") -> ui.label:
    """A line of plain text."""
    return ui.label(text).classes(classes)


class Parts:
    """The parts of the file, and the numbers of the one that is chosen."""

    def __init__(self, desk: Desk) -> None:
        self.desk = desk
        self.shown = 0
        with ui.element("div").classes("rg-tree"):
            self.tree = ui.tree(self._nodes(), on_select=lambda event: self._selected(event.value))
            self.tree.props("dense no-selection-unset no-transition selected-color=primary")
        self.form = ui.element("div").classes("rg-form")
        self.show()

    def _nodes(self) -> list[dict[str, Any]]:
        tables: dict[str, list[dict[str, Any]]] = {}
        for part in self.desk.study.parts:
            table, _, name = part.partition(".")
            tables.setdefault(table, [])
            if name:
                tables[table].append({"id": part, "label": name})
        return [
            {"id": table or "model", "label": f"{table.replace('_', ' ')} ({len(parts)})", "children": parts}
            if parts
            else {"id": table or "model", "label": table or "the model"}
            for table, parts in tables.items()
        ]

    def _selected(self, node: str | None) -> None:
        part = "" if node in (None, "model") else str(node)
        if part in self.desk.study.parts:
            self.desk.choose(part)
        elif node:  # a table of parts: opened and closed by a click on its name, too
            known = self.tree.props.get("expanded") or []
            self.tree.collapse([node]) if node in known else self.tree.expand([node])

    def show(self) -> None:
        """Show the numbers of the part that is chosen, found by its name in the tree as well."""
        part = self.desk.part
        self.shown += 1
        self.tree.props["nodes"] = self._nodes()
        self.tree.select(part or "model")
        if "." in part:
            self.tree.expand([part.partition(".")[0]])
        self.form.clear()
        study = self.desk.study
        fields = study.fields(part)
        at_fields = {field.address for field in fields}
        with self.form:
            text_line(part or "The model", "text-subtitle1 text-weight-medium q-mb-xs")
            elsewhere = [str(one) for one in study.problems if one.address not in at_fields]
            if elsewhere:
                text_line("\n".join(elsewhere), "rg-problem q-mb-sm")
            for field in (one for one in fields if one.given or one.address in study.waiting):
                self._field(field)
            with ui.expansion("More keys").props("dense").classes("q-mt-sm full-width"):
                for field in (one for one in fields if not (one.given or one.address in study.waiting)):
                    self._field(field)

    def _field(self, field: Field) -> None:
        study = self.desk.study
        text = study.waiting.get(field.address, field.text)
        label = field.address.removeprefix(f"{self.desk.part}.")
        told = [f"in {field.unit}" if field.unit else "", field.bounds, field.meaning]
        hint = "; ".join(one for one in told if one)
        problem = next((str(one) for one in study.problems if one.address == field.address), "")

        async def put(value: Any) -> None:
            wanted = None if value in ("", None) else str(value)
            if (wanted or "") != ("" if text is None else str(text)):
                await self.desk.change(field.address, wanted)

        if field.choices:
            options = list(dict.fromkeys([*field.choices, *([text] if text else [])]))
            ui.select(options, value=text or None, label=label, clearable=not field.given).props(
                "dense outlined options-dense"
            ).classes("full-width q-mt-xs").on_value_change(lambda event: put(event.value))
            text_line(hint, "rg-hint")
            if problem:
                text_line(problem, "rg-problem")
            return
        entry = ui.input(label, value="" if text is None else str(text)).props("dense outlined")
        entry.classes("full-width q-mt-xs")
        entry.mark(field.address)
        if problem:
            entry.props["error"] = True
            entry.props["no-error-icon"] = True
            entry.props["error-message"] = problem
            entry.props["hide-bottom-space"] = True
        entry.on("blur", lambda: put(entry.value))
        entry.on("keydown.enter", lambda: put(entry.value))
        text_line(hint, "rg-hint")
        if field.is_number and field.address not in study.waiting:
            self._slider(field, entry)

    def _slider(self, field: Field, entry: ui.input) -> None:
        """A handle below a number, which is dragged to a fifth or five times of it."""

        shown = self.shown

        def factor(event: Any) -> float:
            return float(_REACH ** max(-1.0, min(1.0, float(event.args))))

        async def drag(event: Any) -> None:
            if shown != self.shown:  # the browser tells the last of a drag after its end
                return
            entry.value = self.desk.study.dragged(field, factor(event))
            await self.desk.drag(field, entry.value)

        async def release(event: Any) -> None:
            await self.desk.change(field.address, self.desk.study.dragged(field, factor(event)))

        slider = ui.slider(min=-1.0, max=1.0, step=0.005, value=0.0).props("dense color=blue-grey-4")
        slider.classes("rg-slider")
        slider.tooltip("Drag: a fifth to five times the number")
        slider.on("update:model-value", drag, throttle=_PACE)
        slider.on("change", release)


class Middle:
    """The turntable, and what is chosen of it."""

    def __init__(self, desk: Desk) -> None:
        self.desk = desk
        self.colouring = "displacement"
        self.moving = True
        with ui.row().classes("items-center no-wrap q-gutter-x-sm rg-bar"):
            self.colour = ui.select(
                COLOURINGS, value=self.colouring, on_change=lambda event: self._coloured(event.value)
            )
            self.colour.props("dense outlined options-dense").classes("rg-colour")
            self.button = ui.button(icon="pause", on_click=self._moved).props("dense flat round")
            self.button.tooltip("Stop and go")
            text_line("Drag to turn, wheel to come nearer, click to pick a part.", "rg-hint")
        with ui.element("div").classes("rg-view"):
            self.turntable = Turntable(desk.choose)
            self.headline = text_line("", "rg-headline")
            with ui.element("div").classes("rg-scale") as self.scale:
                self.ramp = ui.element("div").classes("rg-ramp")
                self.low = text_line("0")
                self.high = text_line("")

    def shown(self) -> None:
        """New solids, of a new result."""
        if self.desk.view is not None:
            self.turntable.run_method("show", self.desk.view.geometry)
            self.turntable.run_method("choose", self.desk.part)
            self.mode()

    def mode(self) -> None:
        """Move in the mode that is chosen."""
        view = self.desk.view
        mode = self.desk.mode
        if view is None or not len(view.result):
            return
        self.headline.text = f"Mode {mode_name(view.result, mode)}"
        self.turntable.run_method("move", view.motion(mode))
        self.turntable.run_method("run", self.moving)
        self._paint()

    def _paint(self) -> None:
        view = self.desk.view
        kind = self.colouring
        if view is None:
            return
        colours: Any = kind if kind == "displacement" else None
        if kind in ("kinetic", "strain"):
            colours = view.colours(self.desk.mode, kind)
            part, share = next(iter(view.shares(self.desk.mode, kind).items()), ("", 0.0))
            self.high.text = f"{100.0 * share:.0f} %, {part}"
        else:
            self.high.text = "largest displacement"
        self.ramp.classes(replace=f"rg-ramp rg-ramp-{kind}")
        self.scale.set_visibility(kind != "parts")
        self.turntable.run_method("paint", colours)

    def _coloured(self, kind: str) -> None:
        self.colouring = kind if kind in COLOURINGS else "displacement"
        self._paint()

    def _moved(self) -> None:
        self.moving = not self.moving
        self.button.props["icon"] = "pause" if self.moving else "play_arrow"
        self.turntable.run_method("run", self.moving)


class Modes:
    """The table of modes, and where the energy of the chosen one is."""

    def __init__(self, desk: Desk) -> None:
        self.desk = desk
        self.head = text_line("", "rg-hint q-mb-xs")
        self.speed = ui.switch("at the operating speed", on_change=lambda event: desk.at_speed(bool(event.value)))
        self.speed.props("dense").set_visibility(bool(desk.study.model.operating_speed))
        self.table = ui.table(rows=[], columns=[], row_key="number").props("dense flat hide-pagination wrap-cells")
        self.table.props["pagination"] = {"rowsPerPage": 0}
        self.table.classes("rg-modes full-width")
        self.table.on("rowClick", lambda event: desk.choose_mode(int(event.args[1]["number"])), [[], ["number"], None])
        self.energies = ui.element("div").classes("q-mt-md")
        self.notes = ui.element("div").classes("q-mt-md")

    def show(self, result: ModalResult, *, live: bool) -> None:
        """Show modes; `live`: while a number is dragged, without what is said of shapes."""
        table = next(one for one in result.tables() if isinstance(one, Table))
        if not live:  # the words of shapes stay empty meanwhile, in a column that stays
            self.table.columns = [_column(table, k) for k in range(len(table.columns))]
        self.table.rows = [
            {"number": k, **{str(c): cell.text for c, cell in enumerate(row)}} for k, row in enumerate(table.rows)
        ]
        self.head.text = (
            "dragging: frequencies only" if live else f"{result.dofs} dofs, {result.cost}; click a mode to see it"
        )
        self.speed.set_visibility(bool(self.desk.study.model.operating_speed))
        self.mark()
        if not live:
            self.notes.clear()
            with self.notes:
                for title, notes in (("Warnings", result.warnings), ("Left out", result.left_out)):
                    if notes:
                        text_line(title, "text-weight-medium q-mt-sm")
                        for note in dict.fromkeys(map(str, notes)):
                            text_line(note, "rg-note")

    def mark(self) -> None:
        """Mark the mode that is chosen, and show its energies."""
        self.table.props[":table-row-class-fn"] = f"row => row.number === {self.desk.mode} ? 'rg-chosen' : ''"
        self.table.update()
        self.energies.clear()
        view = self.desk.view
        if view is None or self.desk.mode >= len(view.result):
            return
        kinetic, strain = (view.shares(self.desk.mode, kind) for kind in ("kinetic", "strain"))
        parts = sorted({*kinetic, *strain}, key=lambda one: -max(kinetic.get(one, 0.0), strain.get(one, 0.0)))
        with self.energies:
            text_line(f"Where the energy of mode {self.desk.mode + 1} is", "text-weight-medium")
            with ui.element("div").classes("rg-energies"):
                for head in ("part", "kinetic", "", "strain", ""):
                    text_line(head, "rg-hint")
                for part in parts[:_BARS]:
                    if max(kinetic.get(part, 0.0), strain.get(part, 0.0)) < 0.005:
                        break
                    text_line(part, "rg-part").on("click", lambda part=part: self.desk.choose(part))
                    for shares in (kinetic, strain):
                        share = shares.get(part, 0.0)
                        bar = ui.element("div").classes("rg-share")
                        bar.style(f"width: {100.0 * max(0.0, min(1.0, share)):.1f}%")
                        text_line(f"{100.0 * share:.0f} %", "rg-percent")


def _column(table: Table, k: int) -> dict[str, Any]:
    """A column as NiceGUI has it: words stand to the left, and numbers are not broken."""
    words = not all(row[k].number for row in table.rows)
    column = table.columns[k]
    look = {"align": "left"} if words else {"align": "right", "style": "white-space: nowrap"}
    return {"name": str(k), "label": column.heading.replace("\n", " ") or column.label, "field": str(k), **look}


class Leaf:
    """Sections of the report about the text as it stands, computed when the leaf is opened."""

    def __init__(self, desk: Desk, title: str) -> None:
        self.desk = desk
        self.title = title
        self.about: tuple[Any, ...] | None = None
        self.rig: str | None = None
        self.damping = 0.0
        if title == "Rig":
            names = desk.study.rigs
            if not names:
                text_line("There is no table of measured lines (CSV) in the folder of the model.", "rg-note")
            else:
                choice = ui.select(names, label="Measured lines", on_change=lambda event: self._measured(event.value))
                choice.props("dense outlined options-dense").classes("full-width")
        if title == "Run-up":
            ui.number("Modal damping ratio added", value=0.0, min=0.0, max=0.5, step=0.01).props(
                "dense outlined"
            ).classes("full-width").on_value_change(lambda event: self._damped(event.value))
        with ui.row().classes("items-center q-my-sm q-gutter-x-sm"):
            self.button = ui.button("Compute", on_click=self.fill).props("dense unelevated no-caps")
            self.stale = text_line("", "rg-hint")
        self.body = ui.element("div")

    async def _measured(self, name: Any) -> None:
        self.rig = str(name)
        await self.fill()

    async def _damped(self, value: Any) -> None:
        self.damping = min(0.5, max(0.0, float(value or 0.0)))
        self.outdated()

    def _asked(self) -> tuple[Any, ...]:
        return (self.desk.study.text, self.rig, self.damping)

    def outdated(self) -> None:
        """Say whether what stands here is about another text, or was asked otherwise."""
        old = self.about is not None and self.about != self._asked()
        self.stale.text = "Below: before the last change." if old else ""
        self.body.classes(add="rg-old") if old else self.body.classes(remove="rg-old")

    async def fill(self) -> None:
        """Compute what is not there."""
        if self.title == "Rig" and self.rig is None:
            return
        asked = self._asked()
        if asked == self.about:
            return
        study = self.desk.study
        try:
            rig = str(study.rig(self.rig)) if self.rig is not None else None
            source = (study.path.name, str(study.folder))
            sections = await self.desk.job(
                self.title, sections_of, study.text, source, LEAVES[self.title], rig, self.damping
            )
        except RotorgearError as error:
            self.body.clear()
            with self.body:
                text_line(str(error), "rg-problem")
            return
        self.about = asked
        self.body.clear()
        with self.body:
            for section in sections:
                show_section(section)
            if len(sections) == 1 and self.title in _EMPTY:
                text_line(_EMPTY[self.title], "rg-note")
        self.outdated()


def show_section(section: Any) -> None:
    """A section of the report: its words as text, its tables cleaned by the browser, its figures as images, which run nothing."""
    if not (section.words or section.tables or section.figures):
        return
    text_line(section.title, "text-subtitle1 text-weight-medium q-mt-md")
    for words in section.words:
        text_line(words, "rg-note")
    for figure in section.figures:
        with ui.element("figure").classes("rg-figure"):
            image = ui.element("img")
            image.props["src"] = _image_of(figure["markup"])
            image.props["alt"] = figure["caption"]
            text_line(figure["caption"], "rg-hint")
    for table in section.tables:
        ui.html(table, sanitize=True).classes("rg-table")


def _image_of(markup: str) -> str:
    """The address of an image, data and all, from the markup of a figure: an SVG, or an image element."""
    if markup.lstrip().startswith("<svg"):
        return f"data:image/svg+xml;base64,{base64.b64encode(markup.encode()).decode()}"
    found = re.search(r'src="(data:image/png;base64,[^"]+)"', markup)
    return found[1] if found else ""


class File:
    """The text of the file, and what differs from the disk."""

    def __init__(self, desk: Desk) -> None:
        self.desk = desk
        text_line("Changes since the file was last saved", "text-weight-medium")
        self.changes = ui.element("div").classes("q-mb-md")
        text_line("The file", "text-weight-medium")
        self.text = text_line("", "rg-file")
        self.show()

    def show(self) -> None:
        """Show the text as it stands."""
        difference = self.desk.study.difference
        self.changes.clear()
        with self.changes:
            for line in difference or ["none"]:
                text_line(line, {"-": "rg-file rg-gone", "+": "rg-file rg-new"}.get(line[:1], "rg-hint"))
        self.text.text = self.desk.study.text
