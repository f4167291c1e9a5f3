"""The sections of the page in their order, each there only where its results are; what they cost and what was left out."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from rotorgear.export.solids import LIGHT, build_solids
from rotorgear.note import sentences
from rotorgear.page.at_rest import model_section, modes_section, static_section
from rotorgear.page.cells import RESULTS, Cell, Figure, Numbers, Section, Table, words
from rotorgear.page.contents import Contents, error_of
from rotorgear.page.curves import draw_errors
from rotorgear.page.figures import Painter, svg_of
from rotorgear.page.of_parts import casings_section, rig_section, teeth_section
from rotorgear.page.over_speed import campbell_section, critical_section, response_section, standards_section


def sections(found: Contents, numbers: Numbers, studies: list[Any]) -> Iterator[Section]:
    """Yield the sections of a report in the order of the page."""
    made = found.results
    painter = None
    if "modal" in made:
        painter = Painter(build_solids(found.model, made["modal"].nodes, LIGHT), (9.6, 5.2))
    if "check" in made:
        yield model_section(made, numbers, painter)
    if "static" in made:
        yield static_section(made, numbers)
    if "modal" in made:
        yield modes_section(made, numbers, painter)
    shown: dict[str, Callable[[dict[str, Any], Numbers], Section]] = {
        "campbell": campbell_section,
        "critical": critical_section,
        "standards": standards_section,
        "response": response_section,
    }
    for name, section in shown.items():
        if name in made:
            yield section(made, numbers)
    teeth = [name for name in made if name.startswith("mesh ")]
    if teeth:
        yield teeth_section(made, numbers, teeth)
    casings = [name for name in made if name.startswith("casing ")]
    if casings:
        yield casings_section(numbers, casings)
    if "rig" in made:
        yield rig_section(made, numbers)
    yield _costs(found, numbers, studies)
    yield _left_out(found)


def _costs(found: Contents, numbers: Numbers, studies: list[Any]) -> Section:
    section = Section("errors", "Error against run time")
    section.words.append(
        "The largest estimated relative error of each section's numbers beside the CPU seconds that they took on one thread. "
        "Where nothing is discretised, or no estimate is known, there is a dash."
    )
    rows = []
    for name, result in found.results.items():
        known = error_of(result)
        rows.append(
            [
                Cell(name),
                numbers.cell(".2f", "cpu_seconds", name),
                numbers.cell(".1e", "largest_error_estimate", name) if known is not None else Cell("–"),
                numbers.cell("d", RESULTS, name, "dofs") if getattr(result, "dofs", None) else Cell("–"),
                Cell(result.method),
            ]
        )
    rows.append([Cell("all"), numbers.cell(".2f", "cpu_seconds_of_all"), Cell(""), Cell(""), Cell("")])
    section.tables.append(Table("Cost and error", ("analysis", "CPU s", "largest error", "dofs", "method"), rows))
    section.figures.append(
        Figure(
            "Estimated error against CPU seconds, an analysis a point.",
            svg_of(draw_errors(found), "Error against run time"),
        )
    )
    for k, study in enumerate(studies):
        picture = svg_of(study.plot(), f"study {k + 1}")
        section.figures.append(Figure(f"Stored convergence study: {getattr(study, 'title', study.kind)}.", picture))
    if not studies:
        section.words.append(
            "Convergence studies over meshes are not run for a page: give stored ones (rotorgear accuracy --save, --study)."
        )
    return section


def _left_out(found: Contents) -> Section:
    section = Section("left-out", "What was left out, and why")
    rows = [words(name, reason) for name, reason in found.missing.items()]
    if rows:
        section.tables.append(Table("Sections that are not there", ("section", "reason"), rows, left=2))
    both = (
        ("left_out", "Left out of the analyses", "what and why"),
        ("warnings", "Warnings", "warning"),
    )
    for name, title, heading in both:
        said: dict[str, list[str]] = {}
        for analysis, result in found.results.items():
            for sentence in sentences(getattr(result, name)):
                said.setdefault(sentence, []).append(analysis)
        if said:
            rows = [words(", ".join(analyses), sentence) for sentence, analyses in said.items()]
            section.tables.append(Table(title, ("analysis", heading), rows, left=2))
    return section
