"""Tables as data: what the terminal, a notebook and the page of a report show is one object, rendered three times.

    modes = table_over(result, "mode", Column("mode", number), "frequency_hz", "error_estimate", "description")

A column is a declared field of the rows, whose heading, form and unit the declaration says (`column`, `form` and `shown` of
`of`), or what a function says of a row. A number keeps its place in the result's JSON output, which the page writes beside it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from html import escape
from typing import TYPE_CHECKING, Any

from rotorgear.files.shown import shown
from rotorgear.quantity import RPM_PER_RAD_S, counted
from rotorgear.results.schema import Declared, Record, Row, Rows, place_of

if TYPE_CHECKING:
    from rich.console import RenderableType

# A format specification, or what writes a number.
Form = str | Callable[[Any], str]
# What the two displacements of a contact are, beside every table that has them.
TRANSMISSION_WORDS = (
    "transmission error: rotation at the base circles, r_b1 theta_1 + r_b2 theta_2; approach: of the flanks, transverse, with "
    "bending and axial motion"
)
# Below this, rounding decides.
_NOTHING = 1e-9
# What a number in the first unit is multiplied with to stand in the second.
_SCALES = {
    ("m", "mm"): 1e3,
    ("m", "um"): 1e6,
    ("Pa", "MPa"): 1e-6,
    ("W", "kW"): 1e-3,
    ("N", "kN"): 1e-3,
    ("N/m", "N/um"): 1e-6,
    ("N/m", "N/mm"): 1e-3,
    ("s", "ms"): 1e3,
    ("", "%"): 100.0,
    ("N/m^2", "N/(mm um)"): 1e-9,
    ("rad/s", "rpm"): RPM_PER_RAD_S,
    ("rad", "deg"): 180.0 / math.pi,
}


@dataclass(frozen=True)
class Line:
    """A line of text: its beginning in bold, such as a title, then the rest; `dim`: a legend."""

    bold: str = ""
    rest: str = ""
    dim: bool = False


@dataclass(frozen=True)
class Cell:
    """What stands in a table: its text; of a number also its place in the JSON output, and what it was multiplied with.

    `number`: no word; it stands to the right.
    """

    text: str
    path: tuple[str | int, ...] = ()
    factor: float = 1.0
    number: bool = False


@dataclass(frozen=True)
class Column:
    """A column: its heading, its declared field or what says its cells, and what the declaration does not say, or otherwise.

    `left`: words, which stand to the left; None: as its cells are. `label`: its heading where there is room for it. `where`: what
    says of a row whether it has such a number, `without` what stands there if not, or where it is not known. `entry`: which one
    of an array.
    """

    heading: str
    value: str | Callable[[Any], Any] = ""
    form: Form = ""
    shown: str = ""
    left: bool | None = None
    label: str = ""
    where: Callable[[Any], bool] | None = None
    without: str = "-"
    entry: tuple[int, ...] = ()


@dataclass(frozen=True)
class Table:
    """Columns and rows of cells. `caption` is what they are; `titled`: also the terminal shows it.

    `no_wrap`, `tight`, `ruled`, `headed`: as the terminal is to show it.
    """

    columns: tuple[Column, ...]
    rows: list[tuple[Cell, ...]]
    caption: str = ""
    titled: bool = False
    no_wrap: bool = False
    tight: bool = False
    ruled: bool = False
    headed: bool = True


Block = str | Line | Table


def error_words(value: float, decimals: int = 0) -> str:
    """A small relative error in one digit, or some more; what rounding alone decides is not told apart."""
    return "<1e-9" if value < _NOTHING else f"{value:.{decimals}e}"


def exact(form: str) -> Callable[[float], str]:
    """A form of numbers that may be small: where its digits would all be zeros, a number has a power of ten."""

    def words(value: float) -> str:
        text = written(value, form)
        return f"{value:.0e}" if abs(value) > _NOTHING and not text.strip("+-0.") else text

    return words


def written(value: Any, form: Form = "") -> str:
    """A value in a form: a stroke for what is not known, "yes" and "no", and a zero without a sign."""
    if value is None or value != value:
        return "-"
    if not isinstance(form, str):
        return form(value)
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        return "yes" if value else "no"
    if not math.isfinite(value):
        return "-"
    text = format(value, form)
    if text.startswith("-") and not text.strip("-0."):
        return f"+{text[1:]}" if form.startswith("+") else text[1:]
    return text


def short(value: float) -> str:
    """Four digits, without an exponent where that is as short."""
    if not math.isfinite(value):
        return "-"
    return written(value, ".0f" if 1e3 <= abs(value) < 1e6 else ".4g")


def scale(unit: str, shown: str) -> float:
    """What a number in a unit is multiplied with to be shown in another; KeyError where no one has said it."""
    return 1.0 if unit == shown else _SCALES[unit, shown]


def table_of(
    owner: Record,
    field: str,
    *columns: Column | str,
    keep: Iterable[int] | None = None,
    top: tuple[str | int, ...] = (),
    at: Callable[[int, str], tuple[str | int, ...]] | None = None,
    caption: str = "",
    **look: Any,
) -> Table:
    """A table of the records of a field, a row each; without columns, those that the records declare.

    Args:
        owner: the result, or a record in it. field: a tuple or dictionary of records. columns: as `Column`, or fields by name.
        keep: numbers of the records that are shown; all for None. top: where the owner stands in the JSON output.
        at: where a key of a record stands, from its number and key; below the field for None.
        caption: the label of the field for "". look: of the `Table`.
    """
    declared = owner.declarations[field]
    assert declared.record is not None
    kept = getattr(owner, field)
    places: list[str | int] = list(kept) if isinstance(kept, dict) else list(range(len(kept)))
    below = (*top, _key(declared) or field)
    rows = [(kept[places[k]], (*below, places[k])) for k in (range(len(places)) if keep is None else keep)]
    return records(rows, declared.record, *columns, at=at, caption=caption or _capital(declared.label), **look)


def records(
    rows: Iterable[tuple[Record | Row, tuple[str | int, ...]]],
    cls: type[Record] | Rows,
    *columns: Column | str,
    at: Callable[[int, str], tuple[str | int, ...]] | None = None,
    caption: str = "",
    **look: Any,
) -> Table:
    """A table of records of a class, each with its place in the JSON output; the rest as of `table_of`."""
    known = cls.declarations
    shown = [one if isinstance(one, Column) else Column("", one) for one in columns or _told(known)]
    cells = []
    for k, (record, place) in enumerate(rows):

        def path(key: str, k: int = k, place: tuple[str | int, ...] = place) -> tuple[str | int, ...]:
            return at(k, key) if at else (*place, *key.split("."))

        cells.append(tuple(_cell(record, known, column, path) for column in shown))
    return Table(tuple(_labelled(known, column) for column in shown), cells, caption, **look)


def table_over(owner: Record, axis: str, *columns: Column | str, caption: str = "", **look: Any) -> Table:
    """A table along an axis: a column is a field that is counted by this axis alone, or what a function says of a number.

    Args:
        owner: the result. axis: its name. columns: as `Column`, or fields by name; those that declare a column for none.
        caption, look: of the `Table`.
    """
    known = {d.name: d for d in owner.declarations.values() if axis in d.axes and d.record is None}
    single = {name: d for name, d in known.items() if d.axes == (axis,)}
    shown = [one if isinstance(one, Column) else Column("", one) for one in columns or _told(single)]

    def cell(k: int, column: Column) -> Cell:
        if column.where and not column.where(k):
            return Cell(column.without, number=True)
        if not isinstance(column.value, str):
            return _plain(column.value(k), column.form)
        declared = known[column.value]
        others = iter(column.entry)
        at = {own: k if own == axis else next(others) for own in declared.axes}
        value = getattr(owner, column.value)
        value = value[k] if isinstance(value, tuple) else value[tuple(at.values())]
        key = _key(declared)
        return _number(value, declared, column, place_of(owner, declared, key, at) if key else ())

    rows = [tuple(cell(k, column) for column in shown) for k in range(len(getattr(owner, next(iter(single)))))]
    return Table(tuple(_labelled(known, column) for column in shown), rows, caption or _capital(axis), **look)


def grid(
    rows: Iterable[Sequence[str]], *headings: str, left: int = 1, last: bool = False, caption: str = "", **look: Any
) -> Table:
    """A table of texts; the first `left` columns are words, and the last one where it says so."""
    columns = tuple(
        Column(text, left=number < left or (last and number == len(headings) - 1))
        for number, text in enumerate(headings)
    )
    return Table(columns, [tuple(map(Cell, row)) for row in rows], caption, **look)


def upright(
    owner: Record,
    field: str,
    head: str,
    *names: Column | str,
    first: int = 0,
    count: int | None = None,
    caption: str = "",
) -> Table:
    """A table of records side by side: a row is a field of theirs; one that none of them has is left out."""
    lying = table_of(owner, field, *names, keep=range(first, min(first + (count or 99), len(getattr(owner, field)))))
    title = [row[0].text for row in lying.rows]
    rows = [
        (Cell(column.heading), *cells)
        for column, cells in zip(lying.columns[1:], zip(*(row[1:] for row in lying.rows), strict=True), strict=True)
        if any(cell.text != "-" for cell in cells)
    ]
    columns = (Column(head, left=True), *(Column(text, left=False) for text in title))
    return Table(columns, rows, caption or lying.caption)


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def _told(known: dict[str, Declared]) -> list[str]:
    """The fields that declare a column."""
    return [declared.name for declared in known.values() if declared.column]


def _declared(known: dict[str, Declared], name: str) -> Declared:
    """The declaration of a field, or of one of a record in a field: "rig.frequency_hz", "helix.0.contact_ratio"."""
    first, _, rest = name.partition(".")
    inner = known[first]
    if not (rest and inner.record):
        return inner
    return _declared(inner.record.declarations, rest.lstrip("0123456789.") or rest)


def _labelled(known: dict[str, Declared], column: Column) -> Column:
    """The column with what the declaration of its field says of it."""
    if not isinstance(column.value, str):
        return replace(column, label=column.label or column.heading.replace("\n", " "))
    declared = _declared(known, column.value)
    label = column.label or label_of(declared, column.shown)
    if column.entry and not column.label:  # one of several of a name
        label = column.heading
    left = (declared.words or None) if column.left is None else column.left
    return replace(column, heading=column.heading or declared.column or label, label=label, left=left)


def label_of(declared: Declared, shown: str = "") -> str:
    """What a field is, with the unit that it is shown in: the heading of a wide table, and what stands along an axis."""
    unit = shown or unit_of(declared)
    return f"{declared.label}, {unit}" if unit else declared.label


def _key(declared: Declared) -> str:
    """The key under which a field is written as it is, or in another unit; "" where there is none."""
    written_keys = list(declared.written())
    return written_keys[0].key if len(written_keys) == 1 and isinstance(declared.json[0], str) else ""


def unit_of(declared: Declared) -> str:
    """The unit that a field is shown in: as declared, or as it is written."""
    heading = f" {declared.column}".replace("\n", " ")
    in_heading = [shown for unit, shown in _SCALES if unit == declared.unit and heading.endswith(f" {shown}")]
    if declared.shown or in_heading:
        return declared.shown or in_heading[0]
    keys = list(declared.written())
    return keys[0].unit or "" if keys and isinstance(declared.json[0], str) else declared.unit


def _cell(
    record: Record | Row, known: dict[str, Declared], column: Column, path: Callable[[str], tuple[Any, ...]]
) -> Cell:
    if column.where and not column.where(record):
        return Cell(column.without, number=True)
    if not isinstance(column.value, str):
        return _plain(column.value(record), column.form)
    value: Any = record
    for name in column.value.split("."):
        value = value[int(name)] if name.isdigit() else getattr(value, name)
    value = value[column.entry] if column.entry else value
    declared = _declared(known, column.value)
    key = _key(declared)
    above = column.value.rpartition(".")[0]
    return _number(value, declared, column, (*path(f"{above}.{key}" if above else key), *column.entry) if key else ())


def _plain(value: Any, form: Form) -> Cell:
    return Cell(written(value, form), number=not isinstance(value, str))


def _number(value: Any, declared: Declared, column: Column, path: tuple[str | int, ...]) -> Cell:
    """The cell of a field: its value in the unit that it is shown in."""
    if hasattr(value, "item"):
        value = value.item()
    form = column.form or declared.form
    if value is None or value != value:
        return Cell(column.without, number=True)
    if isinstance(value, str | bool):
        return _plain(value, form)
    shown = column.shown or unit_of(declared)
    factor = scale(declared.unit, shown)
    if isinstance(value, tuple):
        if not isinstance(form, str):
            return Cell(form(tuple(factor * one for one in value)), number=True)
        return Cell(" ".join(written(factor * one, form) for one in value), number=True)
    keys = list(declared.written())
    stands_in = keys[0].unit if path and keys[0].unit else declared.unit
    times = factor / scale(declared.unit, stands_in)
    return Cell(written(value if factor == 1.0 else value * factor, form), path, times, number=True)


def as_rich(blocks: Iterable[Block]) -> RenderableType:
    """The blocks for the terminal, as one rich renderable; brackets in a text are no markup, and nothing in it is obeyed."""
    from rich.text import Text

    def rendered(block: Block) -> RenderableType:
        if isinstance(block, Table):
            return _rich_table(block)
        if isinstance(block, Line):
            return Text.assemble((shown(block.bold), "bold"), (shown(block.rest), "dim" if block.dim else ""))
        return Text(shown(block))

    return _Unpadded(list(map(rendered, blocks)))


@dataclass(frozen=True)
class _Unpadded:
    """Renderables whose lines end with their last word: rich fills each line of a table with blanks."""

    parts: list[Any]

    def __rich_console__(self, console: Any, options: Any) -> Iterator[Any]:
        from rich.segment import Segment
        from rich.table import Table as RichTable

        for part in self.parts:
            # One blank between columns, rather than names that are cut; words of a last column may stand below each other.
            if isinstance(part, RichTable):
                size = part.__rich_measure__(console, options)
                least = size.maximum if part.columns[-1].justify == "right" else size.minimum
                part.collapse_padding |= least > options.max_width
            for line in console.render_lines(part, options, pad=False):
                while line and not line[-1].text.strip():
                    line.pop()
                yield from line[:-1]
                if line:
                    yield Segment(line[-1].text.rstrip(), line[-1].style)
                yield Segment.line()


def _rich_table(table: Table) -> Any:
    from rich import box
    from rich.table import Table as RichTable
    from rich.text import Text

    out = RichTable(
        box=box.SIMPLE_HEAD if table.ruled else None,
        pad_edge=False,
        title=Text(shown(table.caption if table.ruled else f"\n{table.caption}")) if table.titled else None,
        title_justify="left",
        title_style="italic" if table.ruled else "bold",
        header_style="bold",
        collapse_padding=table.tight,
        show_header=table.headed,
    )
    for number, (column, left) in enumerate(zip(table.columns, _sides(table), strict=True)):
        last = table.ruled and number == len(table.columns) - 1
        out.add_column(
            Text(shown(column.heading)),
            justify="left" if left else "right",
            no_wrap=table.no_wrap or (table.ruled and not last),
            overflow="fold",
            ratio=1 if last else None,
        )
    for row in table.rows:
        out.add_row(*(Text(shown(cell.text)) for cell in row))
    return out


def _sides(table: Table) -> Iterator[bool]:
    """Whether each column stands to the left: words do, unless the column says where it stands."""
    for k, column in enumerate(table.columns):
        yield any(not row[k].number for row in table.rows) if column.left is None else column.left


def as_html(blocks: Iterable[Block], most: int) -> str:
    """The blocks for a notebook: each line a paragraph, of each table so many rows at most."""
    parts = []
    for block in (one for one in blocks if one):
        if isinstance(block, Table):
            parts.append(html_table(block, most=most))
        elif isinstance(block, Line):
            bold = f"<b>{escape(block.bold)}</b>" if block.bold else ""
            parts.append(f"<p>{bold}{escape(block.rest)}</p>")
        else:
            parts.append(f"<p>{escape(block)}</p>")
    return "".join(parts)


def html_table(table: Table, *, top: tuple[str | int, ...] | None = None, most: int | None = None) -> str:
    """A table as HTML; with `top`, the place of its result in the page's JSON output, each number says its own place."""

    def shown(cell: Cell, left: bool) -> str:
        text = escape(cell.text).replace("\n", "<br>")
        if not left:
            text = "–" if text == "-" else text.replace("-", "−")
            key = escape(pointer((*top, *cell.path))) if cell.path and top is not None and text != "–" else ""
            place = f' data-key="{key}" data-factor="{cell.factor}"' if key else ""
            return f'<td class="number"{place}>{text}</td>'
        kind = cell.text.replace(" ", "-") if cell.text in _VERDICTS else "short" if len(cell.text) < 8 else ""
        return f'<td class="{kind}">{text}</td>' if kind else f"<td>{text}</td>"

    rows = table.rows[:most]
    sides = list(_sides(table))
    heads = "".join(
        f'<th scope="col"{"" if left else " class=number"}>{escape(column.label or column.heading)}</th>'
        for column, left in zip(table.columns, sides, strict=True)
    )
    body = "\n".join("<tr>" + "".join(map(shown, row, sides)) + "</tr>" for row in rows)
    rest = len(table.rows) - len(rows)
    more = f"\n<tr><td colspan={len(table.columns)}>... and {counted(rest, 'more rows')}</td></tr>" if rest else ""
    caption = f"<caption>{escape(table.caption)}</caption>" if table.caption else ""
    head = f"<thead><tr>{heads}</tr></thead>" if table.headed else ""
    return f"<table>\n{caption}{head}\n<tbody>\n{body}{more}\n</tbody>\n</table>\n"


# What a rule says of a part, which the page shows in its colour.
_VERDICTS = ("within", "not within", "not applicable")


def pointer(path: Iterable[str | int]) -> str:
    """A path as a JSON pointer (RFC 6901)."""
    return "".join("/" + str(step).replace("~", "~0").replace("/", "~1") for step in path)
