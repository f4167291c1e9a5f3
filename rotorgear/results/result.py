"""What every result has: where it comes from, what it cost, its text, its rows and its labelled data set."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from typing import TYPE_CHECKING, Any, ClassVar

from rotorgear.drawing import page_of, picture_of
from rotorgear.extras import require
from rotorgear.note import NAMED, as_notes, sentences
from rotorgear.quantity import counted
from rotorgear.results.schema import Record, Written, derived, of
from rotorgear.results.table import Block, Line, as_html, as_rich, table_of, table_over
from rotorgear.version import VERSION

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.model.model import Model

# The screen shows so many lines of a result, a notebook so many rows of a table; `text()` has them all.
_LINES = 40
_WIDTH = 80
# Compilation below these CPU seconds goes untold.
_WORTH_TELLING = 1.0


def _said(key: str) -> Written:
    """One sentence for each cause."""
    return Written(key, lambda record, notes: sentences(notes))


def _by_step(record: Record, seconds: dict[str, float]) -> dict[str, float]:
    return {step: float(value) for step, value in seconds.items() if step != "total"}


class Fact(Record):
    """One thing that a sentence of `left_out` or `warnings` says of one part."""

    about: str = of("what it tells", note=': `"left out"` or `"warning"`')
    part: str = of(
        "address of the part or of its key", note=' in the model file; `""` of what belongs to no single part'
    )
    what: str = of("what was left out, or what the warning is", note='; `""` where the address says it')
    why: str = of("reason")
    value: str = of("size")


class Result(Record):
    """Base of all results.

    `kind` names a class of results in files; `analysis` is the word that JSON output begins with. `left_out` and `warnings`
    hold a fact for each part, which is its own sentence; JSON has one sentence for each cause, and beside them the facts.
    """

    kind: ClassVar[str] = ""
    analysis_word: ClassVar[str] = ""
    kinds: ClassVar[dict[str, type[Result]]] = {}

    seconds: dict[str, float] = of(
        "CPU time",
        "s",
        "STEP",
        json=(
            Written("seconds", lambda record, seconds: float(seconds.get("total", 0.0)), axes=()),
            Written("seconds_by_step", _by_step, note=" of each step of the analysis"),
        ),
        default_factory=dict,
        kw_only=True,
    )
    left_out: tuple[str, ...] = of(
        "sentences",
        "",
        "left_out_note",
        note=": what the model holds and the analysis did not take, and why",
        json=_said("left_out"),
        default=(),
        kw_only=True,
    )
    warnings: tuple[str, ...] = of("sentences", "", "warning", json=_said("warnings"), default=(), kw_only=True)
    method: str = of("method", note=": solver, and what its guards said", default="", kw_only=True)
    status: str = of(
        "status", note=': `"success"`, `"accuracy ... not reached"`, or why it ended', default="success", kw_only=True
    )
    rotorgear_version: str = of("version of rotorgear", default=VERSION, kw_only=True)
    model_hash: str = of(
        "SHA-256 of the model", note=": of the canonical JSON of its fields in SI units", default="", kw_only=True
    )
    settings: dict[str, Any] = of(
        "arguments of the analysis", "", "ARGUMENT", note=", by name", default_factory=dict, kw_only=True
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in ("left_out", "warnings"):
            object.__setattr__(self, name, as_notes(getattr(self, name)))

    @derived("facts behind the sentences of `left_out` and `warnings`", "", "fact", record=Fact)
    def facts(self) -> tuple[Fact, ...]:
        """Each of them by itself, of one part."""
        both = (("left out", self.left_out), ("warning", self.warnings))
        return tuple(Fact(about, n.part, n.what, n.why, n.value) for about, notes in both for n in as_notes(notes))

    def __init_subclass__(cls, *, kind: str = "", analysis: str = "") -> None:
        super().__init_subclass__()
        cls.kind = kind
        cls.analysis_word = analysis or kind
        if kind:
            Result.kinds[kind] = cls

    @property
    def cost(self) -> str:
        """CPU seconds in words, without those of compilation, which are told beside them: they are spent once."""
        compilation = self.seconds.get("compilation", 0.0)
        words = f" (and {compilation:.2f} of compilation, once)" if compilation >= _WORTH_TELLING else ""
        return f"{self.seconds['total'] - compilation:.2f} CPU s{words}"

    @property
    def ended_early(self) -> bool:
        """Whether the analysis stopped before its end; one that only missed an accuracy did not."""
        return self.status != "success" and not self.status.startswith("accuracy ")

    # Results hold arrays; two runs of one analysis are told apart by `is`, and compared by `==`.
    __hash__ = None  # type: ignore[assignment]

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON; the keys are on docs/commands.md."""
        values = super().to_dict()
        head = {"title": values.pop("title")} if "title" in values else {}
        return {"analysis": self.analysis_word, **head, **values}

    def tables(self, *_: Any, **options: Any) -> Iterator[Block]:
        """What there is to show, as data: a title, tables of what declares a column, and what was left out.

        A kind of result that has more to say does so itself; the options are those of the command that choose tables.
        """
        yield Line(getattr(self, "title", "") or self.kind)
        declared = self.declarations.values()
        counted = dict.fromkeys(
            one.axes[0] for one in declared if one.column and one.record is None and len(one.axes) == 1
        )
        for axis in counted:
            yield from ("", table_over(self, axis))
        for one in declared:
            if one.record is not None and one.axes and any(d.column for d in one.record.declarations.values()):
                yield from ("", table_of(self, one.name))
        yield from ("", *self.remarks())

    def titled(self) -> Iterator[Block]:
        """The title, if there is one."""
        title = getattr(self, "title", "")
        if title:
            yield Line(title)

    def remarks(self) -> list[str]:
        """What all tables end with: what the analysis left out, and its warnings, one sentence for each cause."""
        return [
            *(f"left out: {text}" for text in sentences(self.left_out, named=NAMED)),
            *(f"Warning: {text}" for text in sentences(self.warnings, named=NAMED)),
        ]

    def table(self, *, laws: bool = False, **options: Any) -> RenderableType:
        """What the command prints, as one rich renderable; the options are those of the command that choose tables.

        `laws` puts the operating points of bearings below it, of a result that is linear about an equilibrium.
        """
        points = [self.operating_points()] if laws and hasattr(self, "operating_points") else []
        return as_rich([*self.tables(**options), *points])

    def plot(self, on: Any = None, **options: Any) -> Any:
        """Draw this result; `rotorgear.plot` has the picture of its kind, with the options, and others.

        Args:
            on: axes, figure or plotter to draw on, as the picture takes; a new one for None.
            options: of the picture.

        Returns:
            The axes, an array of them, or the plotter.

        Raises:
            AnalysisError: a kind of result without a picture. MissingExtraError: matplotlib or pyvista is not installed.
        """
        return picture_of(self.kind)(self, on, **options)

    def show(self) -> Any:
        """What a notebook shows below its cell: modes as solids that turn, else the picture, whose points say what they are.

        Returns:
            An object that notebooks show, and whose text is that of the result.

        Raises:
            AnalysisError: a kind of result without a picture. MissingExtraError: matplotlib is not installed.
        """
        return page_of(self)

    def text(self, width: int = _WIDTH, **options: Any) -> str:
        """The table as text, so many characters wide."""
        from io import StringIO

        from rich.console import Console

        out = StringIO()
        # In a notebook rich would show the table there and leave the text empty.
        console = Console(file=out, width=width, highlight=False, color_system=None, force_jupyter=False)
        console.print(self.table(**options))
        return "\n".join(line.rstrip() for line in out.getvalue().splitlines()).rstrip("\n")

    def __repr__(self) -> str:
        return "\n".join(self._lines())

    def _lines(self) -> list[str]:
        """What fits on a screen of the text."""
        try:
            lines = self.text().splitlines()
        except Exception as error:  # a debugger asks for the text of half-made results too
            return [f"{type(self).__name__}: no table ({type(error).__name__}: {error})"]
        if len(lines) <= _LINES:
            return lines
        return [
            *lines[: _LINES - 1],
            f"... and {counted(len(lines) - _LINES + 1, 'more lines')}: result.text() has them all",
        ]

    def _repr_html_(self) -> str:
        try:
            return as_html(self.tables(), _LINES)
        except Exception:  # as above
            return f"<p>{escape(repr(self))}</p>"

    def rows(self, *axes: str) -> list[dict[str, Any]]:
        """One dictionary for each entry along an axis, or along several; see `rotorgear.results.labelled.rows`.

        Without axes those of what the result is about, such as "mode", or "speed" and "branch".
        """
        from rotorgear.results.labelled import rows

        return rows(self, *axes)

    def to_pandas(self, *axes: str) -> Any:
        """The rows as a `pandas.DataFrame`, which is indexed by the axes where they number its rows.

        Raises:
            MissingExtraError: pandas is not installed. AnalysisError: as `rows`.
        """
        require("pandas", "A data frame")
        from pandas import DataFrame

        from rotorgear.results.labelled import main_axes

        axes = axes or main_axes(self)
        frame = DataFrame(self.rows(*axes))
        return frame.set_index(list(axes)) if axes and set(axes) <= set(frame.columns) else frame

    def to_xarray(self) -> Any:
        """A labelled data set; see `rotorgear.results.labelled.data_set`. Its attributes say where the result is from.

        Raises:
            MissingExtraError: xarray is not installed.
        """
        from rotorgear.results.labelled import data_set

        source = ("title", "analysis_word", "status", "rotorgear_version", "model_hash")
        return data_set(self).assign_attrs({name: getattr(self, name, "") for name in source})


class ModelResult(Result):
    """A result of a model with n degrees of freedom."""

    model: Model = of("model that was analysed", json=None)
    dofs: int = of("degrees of freedom", default=0, kw_only=True)

    @derived("title of the model")
    def title(self) -> str:
        """The title in the model file."""
        return self.model.title


def statistic_names() -> Any:
    """The field of a result whose statistics of contacts have estimated errors, which are counted by these names."""
    return of(
        "name of the statistic",
        "",
        "statistic",
        note=" of a contact whose error is estimated; transmission error and approach peak to peak",
        default=(),
    )
