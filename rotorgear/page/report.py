"""One page about a model in one file: the verb behind `rotorgear report`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cached_property
from pathlib import Path
from typing import Any

from rotorgear.analysis.common.recorded import setting
from rotorgear.analysis.common.request import check_grade, check_modal_damping, check_request
from rotorgear.analysis.common.stream import Stream, pieces
from rotorgear.analysis.rig.rig_file import read_rig_lines
from rotorgear.cpu import compiling_seconds, cpu_seconds
from rotorgear.errors import AnalysisError
from rotorgear.export.hdf5 import read
from rotorgear.extras import require
from rotorgear.files.own import text_of
from rotorgear.files.write import check_output, written
from rotorgear.model.load import load
from rotorgear.model.model import Model, model_hash
from rotorgear.progress import Progress, silent
from rotorgear.results.modal import ModalResult
from rotorgear.results.result import Result
from rotorgear.version import VERSION

_ENDINGS = (".html", ".htm")
# mm/s, of ISO 21940-11: that of gearboxes and turbines.
BALANCE_GRADE = 2.5


@dataclass(frozen=True)
class Report:
    """A report that was written.

    Attributes:
        path: of the page.
        results: by the name that they have in the page's numbers, such as "modal" or "mesh stage_1".
        missing: sections that are not there, and why.
        about: what `numbers` says before the results: model, settings, CPU seconds, errors.
        numbers: all numbers of the page and many more, as `--json` writes them.
    """

    path: Path
    results: dict[str, Result]
    missing: dict[str, str]
    about: dict[str, Any]

    @cached_property
    def numbers(self) -> dict[str, Any]:
        """Made when they are asked for: the page itself takes what it shows from the results."""
        from rotorgear.page.sections import RESULTS

        return {**self.about, RESULTS: {name: result.to_dict() for name, result in self.results.items()}}

    def __repr__(self) -> str:
        """Where the page is, and the names of what stands on it."""
        lacks = f", missing: {', '.join(self.missing)}" if self.missing else ""
        return f"Report('{self.path}': {', '.join(self.results)}{lacks})"

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON: results by name under `results`, each with its keys of docs/commands.md."""
        return self.numbers


def report(
    model: Model | str | Path,
    output: str | Path,
    *,
    rig: str | Path | Sequence[Any] = (),
    study: Sequence[str | Path] = (),
    grade: float = BALANCE_GRADE,
    modal_damping: float = 0.0,
    fmax: float | None = None,
    turntable: bool = False,
    only: Sequence[str] = (),
    stream: Stream | None = None,
    progress: Progress = silent,
) -> Report:
    """Compute what a model has the parts for, and write it as one page: no network, readable without script, prints on A4.

    Args:
        model: a model, or the path of its file, which the page then names.
        output: the page to write, .html.
        rig: measured frequencies (CSV); in Python also lines.
        study: stored convergence studies (`rotorgear accuracy --save`), whose curves are shown; none is run for a page.
        grade: balance quality grade G of ISO 21940-11 in mm/s.
        modal_damping: of the run-up, as in `response`.
        fmax: leave out orders of the run-up above this many Hz at its highest speed (default: above the third order of the
            fastest mesh).
        turntable: also put the modes into the page as solids that turn and move where a browser runs its script.
        only: sections, among model, statics, modes, campbell, critical, standards, run-up, teeth, casings and rig (default: all).
        stream: keeps sections while the page is made (`rotorgear.stream`), and starts an interrupted one again.
        progress: callable that is told fraction and step.

    Returns:
        The report, with its results and numbers.

    Raises:
        MissingExtraError: jinja2 or matplotlib is not installed. AnalysisError: another ending, or a file that is no study.
        ModelError: what is wrong with the model. WriteError: the page can't be written.
    """
    require("jinja2", "A report")
    require("matplotlib", "A report")
    target = Path(output)
    if target.suffix.lower() not in _ENDINGS:
        raise AnalysisError(f"a report is a page: its name ends in .html; got '{target.name}'")
    check_output(target)
    # A section that is refused is left out of a page; what no page can be made with is refused here.
    check_grade(grade)
    check_modal_damping(modal_damping)
    check_request(fmax=fmax)
    source = "" if isinstance(model, Model) else Path(model).name
    built = model if isinstance(model, Model) else load(model)
    lines = read_rig_lines(rig) if isinstance(rig, str | Path) else tuple(rig)
    studies: list[Any] = []
    for path in study:
        stored = read(path)
        if "convergence" not in stored.kind:
            expected = "a convergence study was expected (rotorgear accuracy --save)"
            raise AnalysisError(f"{path}: {expected}, this is a {stored.kind} result")
        studies.append(stored)
    # All analyses, which take a second to load.
    from rotorgear.page.contents import computed, error_of
    from rotorgear.page.sections import sections

    start = cpu_seconds() - compiling_seconds()
    asked = {"modal_damping": modal_damping, "fmax": fmax}
    piece = pieces(stream, {"model": model_hash(built), "run": f"{lines} {grade} {asked} {tuple(only)}"})
    found = computed(built, lines, grade, asked, progress, piece, tuple(only))
    found.seconds_of_all = cpu_seconds() - compiling_seconds() - start
    about = {
        "analysis": "report",
        "title": built.title,
        "file": source,
        "rotorgear_version": VERSION,
        "model_hash": model_hash(built),
        "settings": {
            "grade": grade,
            "modal_damping": modal_damping,
            "fmax": fmax,
            "only": list(only),
            "rig": setting(rig if isinstance(rig, str | Path) else [str(line) for line in lines]),
        },
        "cpu_seconds": dict(found.seconds),
        "cpu_seconds_of_all": found.seconds_of_all,
        "largest_error_estimate": {name: error_of(result) for name, result in found.results.items()},
        "missing": dict(found.missing),
    }
    progress(0.9, "page")
    modes = found.results.get("modal")
    surfaces = ""
    if turntable and isinstance(modes, ModalResult):
        from rotorgear.page.turntable import scene

        surfaces = scene(modes)
    text = _page(built, about, list(sections(found, studies)), surfaces)
    with written(target) as scratch:
        scratch.write_text(text, encoding="utf-8")
    progress(1.0, "done")
    return Report(target, dict(found.results), dict(found.missing), about)


def _page(model: Model, about: dict[str, Any], parts: list[Any], turntable: str) -> str:
    """The template filled; what comes from the model is escaped."""
    from jinja2 import Environment, StrictUndefined

    folder = Path(__file__).parent
    environment = Environment(autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    template = environment.from_string(text_of(folder / "page.html"))
    return template.render(
        title=model.title or about["file"] or "A model",
        about=about,
        sections=parts,
        turntable=turntable,
        solids=text_of(folder / "turntable.html"),
        script=text_of(folder / "turntable.js") + text_of(folder / "turntable_in_report.js") if turntable else "",
        made=datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
    )
