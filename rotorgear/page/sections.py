"""The sections of a report in the order of the page: the tables of its results, pictures beside them, costs and errors."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rotorgear.export.solids import LIGHT, build_solids
from rotorgear.note import sentences
from rotorgear.page.contents import MODES, SECTIONS, Contents, error_of
from rotorgear.page.figures import Painter, draw_errors, draw_unbalance, svg_of
from rotorgear.plots.response import order_map
from rotorgear.results.casing import CasingRow
from rotorgear.results.mesh import MeshResult
from rotorgear.results.table import (
    Cell,
    Column,
    Line,
    Table,
    error_words,
    grid,
    html_table,
    records,
    table_of,
    written,
)

# Where the results of all analyses stand in the JSON output of a report.
RESULTS = "results"
# Pictures of so many elastic modes, the first of the table.
_PICTURES = 8


@dataclass
class Section:
    """A section of the page: its tables are HTML; a figure has a caption and a markup, inline SVG or an image."""

    name: str
    title: str
    words: list[str] = field(default_factory=list)
    tables: list[str] = field(default_factory=list)
    figures: list[dict[str, Any]] = field(default_factory=list)

    def show(self, tables: Iterable[Any], *top: str) -> Section:
        """Add tables whose numbers stand below a place of the JSON output; what else a result says is left."""
        self.tables += [html_table(one, top=top) for one in tables if isinstance(one, Table) and one.rows]
        return self

    def draw(self, caption: str, picture: Any, label: str) -> Section:
        """Add axes of matplotlib; `label` says what they show to those who don't see them."""
        self.figures.append({"caption": caption, "markup": svg_of(picture, label), "small": False})
        return self


def sections(found: Contents, studies: list[Any]) -> Iterator[Section]:
    """Yield the sections of a report in the order of the page."""
    yield from analysed(found)
    yield _costs(found, studies)
    yield left_out(found)


def analysed(found: Contents) -> Iterator[Section]:
    """Yield the sections that show results, of those that were asked for."""
    made = found.results
    wanted = found.only or tuple(SECTIONS)
    painter = None
    if "modal" in made and ("model" in wanted or "modes" in wanted):
        painter = Painter(build_solids(found.model, made["modal"].nodes, LIGHT), (9.6, 5.2))
    teeth = [name for name in made if name.startswith("mesh ")]
    casings = [name for name in made if name.startswith("casing ")]
    makers: dict[str, tuple[bool, Callable[[], Section]]] = {
        "model": ("check" in made, lambda: _model(found, painter)),
        "statics": ("static" in made, lambda: _statics(made["static"])),
        "modes": ("modal" in made, lambda: _modes(made["modal"], painter)),
        "campbell": ("campbell" in made, lambda: _campbell(made)),
        "critical": ("critical" in made, lambda: _critical(made)),
        "standards": ("standards" in made, lambda: _standards(made)),
        "run-up": ("response" in made, lambda: _response(made)),
        "teeth": (bool(teeth), lambda: _teeth(made, teeth)),
        "casings": (bool(casings), lambda: _casings(made, casings)),
        "rig": ("rig" in made, lambda: _rig(made["rig"])),
    }
    for name, (there, make) in makers.items():
        if there and name in wanted:
            yield make()


def _model(found: Contents, painter: Painter | None) -> Section:
    """What the model is made of, and a picture of it."""
    section = Section("model", "The gearbox").show(found.results["check"].tables(), RESULTS, "check")
    if painter is not None:
        seen = "The model, seen obliquely" + ("; casings are transparent." if found.model.casings else ".")
        section.figures.append({"caption": seen, "markup": painter.image("The gearbox"), "small": False})
    return section


def _statics(result: Any) -> Section:
    """Forces, load sharing and deflections."""
    section = Section("statics", "Statics").show(result.tables(), RESULTS, "static")
    return section.draw("Forces, load sharing and deflections.", result.plot(), "Statics")


def _modes(result: Any, painter: Painter | None) -> Section:
    """Natural frequencies, what holds their energy, and pictures of the first elastic modes."""
    section = Section("modes", "Natural frequencies and modes").show(result.tables(energies=True), RESULTS, "modal")
    section.words.append(
        "Undamped, at standstill. Error: estimated relative error of the frequency by the finite elements."
    )
    if painter is not None:
        small = Painter(painter.solids, (4.6, 2.9))
        for k in [k for k in range(len(result)) if not result.rigid[k]][:_PICTURES]:
            label = f"Mode {k + 1}: {result.frequency_hz[k]:.2f} Hz"
            image = small.mode(label, np.real(result.shapes[:, :, k]))
            section.figures.append({"caption": f"{label}, {result.description[k]}", "markup": image, "small": True})
    return section


def _campbell(made: dict[str, Any]) -> Section:
    """The diagram, margins at the operating speed, and onsets of instability."""
    result = made["campbell"]
    section = Section("campbell", "Campbell diagram and margins").show(result.tables(), RESULTS, "campbell")
    section.words.append(
        f"The {MODES} lowest branches at any speed; rotorgear campbell follows those up to the mesh frequencies, too."
    )
    section.draw("Natural frequencies over speed, and lines of excitation.", result.plot(), "Campbell diagram")
    if result.onsets:
        section.show([table_of(result, "onsets")], RESULTS, "campbell")
    else:
        section.words.append("Stability: no branch grows in this range of speeds.")
    return section


def _critical(made: dict[str, Any]) -> Section:
    """Speeds at which 1x of a shaft meets a mode, and the map over the stiffness of the bearings."""
    result = made["critical"]
    section = Section("critical", "Critical speeds")
    if "critical_map" in made and np.isfinite(made["critical_map"].critical_speeds).any():
        caption = "Undamped critical speeds over one stiffness of all bearings; vertical lines: those of the model."
        section.draw(caption, made["critical_map"].plot(), "Critical speed map")
    if not len(result):
        section.words.append("No line meets a mode in the range of speeds.")
    return section.show(result.tables(), RESULTS, "critical")


def _standards(made: dict[str, Any]) -> Section:
    """Peaks of the unbalance response, and verdicts of the rules, with more words than the terminal has room for."""
    result = made["standards"]
    section = Section("standards", "Unbalance response and rules of standards")
    section.words.append(
        "Each verdict speaks of the one rule beside it. None says that the machine meets a standard: that takes more than these."
    )
    if result.curves:
        caption = (
            "Response to the rules' unbalance in the shape of each shaft's first peak; dashed: the operating speed."
        )
        section.draw(caption, draw_unbalance(result), "Unbalance response")
    rules = [(rule.name, rule.source, rule.formula) for rule in result.rules]
    tables = [
        table_of(result, "criticals", *_with_columns(result, "criticals"), "description"),
        table_of(result, "checks", *_with_columns(result, "checks"), "note"),
        grid(rules, "rule", "standard", "formula", left=3, caption="What the rules say"),
    ]
    return section.show(tables, RESULTS, "standards")


def _with_columns(result: Any, field: str) -> list[str]:
    """The fields of its records that stand in a table everywhere."""
    return [one.name for one in result.declarations[field].record.declarations.values() if one.column]


def _response(made: dict[str, Any]) -> Section:
    """Amplitudes over speed, and the largest of them."""
    result = made["response"]
    section = Section("run-up", "Run-up").show(result.tables(), RESULTS, "response")
    section.words.append(
        "Linear response to the unbalances, transmission errors and stiffness variation that the model has."
    )
    # Films, tables over speed and laws damp as well as keys named damping: the analysis knows whether anything does.
    if any("nothing damps the model" in text for text in result.warnings):
        section.words.append("Nothing damps the model: heights near resonances are those of the nearest speed.")
    elif result.damping_ratio:
        section.words.append(
            f"Damping: that of the model, and a damping ratio of {result.damping_ratio:g} of every elastic mode."
        )
    else:
        section.words.append("Damping: that of the model alone.")
    if not result.damping_ratio:
        section.words.append("No modal damping was added: peaks may be far too high. --modal-damping 0.02 adds 2 %.")
    section.draw("Amplitudes over speed.", result.plot(), "Run-up")
    if len(result.speeds) > 1 and (result.contact_mesh or result.bearings):
        section.draw(
            "Levels over speed, by frequency and by order; above, the overall level.", order_map(result), "Orders"
        )
    return section


def _teeth(made: dict[str, Any], names: list[str]) -> Section:
    """Stiffness, transmission error and pressure of each mesh over its cycle."""
    section = Section("teeth", "Teeth in contact")
    for name in names:
        label = name.partition(" ")[2]
        caption = f"{label}: stiffness k(t), transmission error, load sharing and pressure over the mesh cycle."
        section.draw(caption, made[name].plot(), name)
    columns = (
        Column("", "mesh"),
        Column("", "mean_stiffness", ".5g", "N/um"),
        Column("", "peak_to_peak_stiffness", ".4g", "N/um"),
        Column("", "ste_peak_to_peak", ".4g", "um"),
        Column("", "helix.0.largest_pressure_pa", ".4g", "MPa"),
        Column("", "helix.0.contact_ratio", ".3f"),
    )
    rows = [(made[name], (RESULTS, name)) for name in names]
    caption = "Loaded teeth at the mean load, transverse stiffness"
    return section.show([records(rows, MeshResult, *columns, caption=caption)])


def _casings(made: dict[str, Any], names: list[str]) -> Section:
    """Meshes of the casings and what their reduction left."""
    rows = [(row, (RESULTS, name, "casings", casing)) for name in names for casing, row in made[name].casings.items()]
    label = {id(row): str(place[-1]) for row, place in rows}
    columns = (
        Column("casing", lambda row: label[id(row)]),
        "element",
        "dofs",
        Column("", "mass_kg", ".3f"),
        Column("", "free_frequency_hz", ".2f", entry=(0,), label="first free mode, Hz"),
        Column("", "free_mesh_error", error_words, entry=(0,), label="its mesh error"),
        "coordinates",
        Column("", "reduction_error", error_words, entry=(0,), label="reduction error"),
    )
    caption = "Meshes of the casings and their reduction"
    return Section("casings", "Casings").show([records(rows, CasingRow, *columns, caption=caption)])


def _rig(result: Any) -> Section:
    """Lines of the rig beside modes, and what chance would have matched."""
    blocks = list(result.tables())
    section = Section("rig", "Comparison with the rig").show(blocks, RESULTS, "rig")
    lines = [one.bold + one.rest if isinstance(one, Line) else one for one in blocks if not isinstance(one, Table)]
    start = next((k for k, line in enumerate(lines) if line.startswith("Chance")), len(lines))
    section.words += [line for line in lines[start:] if line]
    return section


def _costs(found: Contents, studies: list[Any]) -> Section:
    """What each analysis took, and the largest error that it states."""
    section = Section("errors", "Error against run time")
    section.words.append(
        "The largest estimated relative error of each section's numbers beside the CPU seconds that they took on one thread. "
        "Where nothing is discretised, or no estimate is known, there is a dash."
    )
    rows: list[tuple[Cell, ...]] = []
    for name, result in found.results.items():
        seconds = Cell(f"{found.seconds[name]:.2f}", ("cpu_seconds", name), number=True)
        error = Cell(written(error_of(result), error_words), ("largest_error_estimate", name), number=True)
        dofs = Cell(written(getattr(result, "dofs", None) or None, "d"), (RESULTS, name, "dofs"), number=True)
        rows.append((Cell(name), seconds, error, dofs, Cell(result.method)))
    total = Cell(f"{found.seconds_of_all:.2f}", ("cpu_seconds_of_all",), number=True)
    rows.append((Cell("all"), total, *[Cell("", number=True)] * 2, Cell("")))
    heads = ("analysis", "CPU s", "largest error", "dofs", "method")
    section.show([Table(tuple(map(Column, heads)), rows, "Cost and error")])
    caption = "Estimated error against CPU seconds, an analysis a point."
    section.draw(caption, draw_errors(found), "Error against run time")
    for k, study in enumerate(studies):
        caption = f"Stored convergence study: {getattr(study, 'title', study.kind)}."
        section.draw(caption, study.plot(), f"study {k + 1}")
    if not studies:
        section.words.append(
            "Convergence studies over meshes are not run for a page: give stored ones (rotorgear accuracy --save, --study)."
        )
    return section


def left_out(found: Contents) -> Section:
    """Sections that are not there, and what the analyses left out and warn about, each sentence once."""
    tables = [grid(found.missing.items(), "section", "reason", left=2, caption="Sections that are not there")]
    both = (("left_out", "Left out of the analyses", "what and why"), ("warnings", "Warnings", "warning"))
    for name, title, heading in both:
        said: dict[str, list[str]] = {}
        for analysis, result in found.results.items():
            for sentence in sentences(getattr(result, name)):
                said.setdefault(sentence, []).append(analysis)
        rows = [(", ".join(analyses), sentence) for sentence, analyses in said.items()]
        tables.append(grid(rows, "analysis", heading, left=2, caption=title))
    return Section("left-out", "What was left out, and why").show(tables)
