"""Workbooks: the cells are the numbers of the result with all their digits, and no text is a formula."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import rotorgear as rg
from rotorgear.results.table import Table, grid
from tests.paths import ROOT

openpyxl = pytest.importorskip("openpyxl")


def test_a_sheet_has_the_numbers_of_the_result(tmp_path: Path) -> None:
    model = rg.load(ROOT / "models" / "jeffcott.toml")
    modes = rg.modal(model, modes=5)
    book = openpyxl.load_workbook(rg.write_xlsx(modes, tmp_path / "modes.xlsx"))
    sheet = book["Modes"]
    rows = list(sheet.iter_rows(values_only=True))
    assert [row[1] for row in rows[1:]] == pytest.approx(modes.frequency_hz.tolist(), rel=1e-15)
    assert [row[0] for row in rows[1:]] == [1, 2, 3, 4, 5]
    assert [row[-1] for row in rows[1:]] == list(modes.description)
    assert "Hz" in rows[0][1]


def test_texts_are_no_formulas_and_sheets_have_short_names_of_their_own(tmp_path: Path) -> None:
    class Told:
        """What a workbook asks of a result."""

        kind = "told"

        def to_dict(self) -> dict[str, Any]:
            return {}

        def tables(self) -> Iterator[Table]:
            for _ in range(3):
                yield grid(
                    [('=HYPERLINK("http://x")', "2.50", "-")],
                    "=1+1",
                    "n",
                    "m",
                    caption="A [long] caption: of / a table",
                )

    book = openpyxl.load_workbook(rg.write_xlsx(Told(), tmp_path / "a.xlsx"))  # type: ignore[arg-type]
    assert len(book.sheetnames) == len({name.lower() for name in book.sheetnames}) == 3
    assert all(len(name) <= 31 for name in book.sheetnames)
    for sheet in book:
        assert sheet["A2"].value == '=HYPERLINK("http://x")'
        assert not [cell for row in sheet.iter_rows() for cell in row if cell.data_type == "f"]


def test_every_kind_of_cell_keeps_its_unit(tmp_path: Path) -> None:
    diagram = rg.campbell(rg.load(ROOT / "models" / "jeffcott.toml"), points=3, modes=4)
    book = openpyxl.load_workbook(rg.write_xlsx(diagram, tmp_path / "campbell.xlsx"))
    margins = next(sheet for sheet in book if "argin" in sheet.title)
    head, *rows = margins.iter_rows(values_only=True)
    column = next(k for k, text in enumerate(head) if str(text).startswith("margin"))
    known = [row.margin for row in diagram.margins if row.branch]
    assert [
        row[column] for row in rows if row[column] is not None and not isinstance(row[column], str)
    ] == pytest.approx([100.0 * value for value in known])
