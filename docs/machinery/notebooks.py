"""Notebooks of the docs: run cell by cell, kept with what they show, and made pages of the site.

A code cell shows what it prints, and its last expression: a figure as a picture, anything else as its text. Lines that begin
with % speak to Jupyter alone. Plain Python runs the rest, so no package of Jupyter is needed here.
"""

from __future__ import annotations

import ast
import base64
import json
import re
import shutil
from pathlib import Path
from typing import Any

from machinery.comparison import texts_agree
from machinery.session import PythonSession
from machinery.snippets import ROOT, SnippetError, environment

FOLDER = ROOT / "docs" / "notebooks"
# Of stored pictures: some 20 kB each.
_DOTS_PER_INCH = 80
_COLOURS = 64
_SHOW = f"""
def _show(value, picture):
    from matplotlib.figure import Figure
    from PIL import Image
    if isinstance(value, Figure):
        value.savefig(picture, dpi={_DOTS_PER_INCH})
        with Image.open(picture) as drawn:
            drawn.convert("RGB").quantize({_COLOURS}, dither=Image.Dither.NONE).save(picture, optimize=True)
    elif value is not None:
        print(repr(value))
"""
_TO_PAGE = re.compile(r"\]\(\.\./([^)/]+\.md[^)]*)\)")
_TO_FILE = re.compile(r"\]\(\.\./\.\./([^)]+)\)")


def notebooks(folder: Path = FOLDER) -> list[Path]:
    """Return the notebooks of the docs."""
    return sorted(folder.glob("*.ipynb"))


def code_cells(notebook: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the cells of code of a notebook, in order."""
    return [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]


def code_of(cell: dict[str, Any]) -> str:
    """Return the code of a cell without the lines for Jupyter."""
    return "\n".join(line for line in "".join(cell["source"]).splitlines() if not line.startswith("%"))


def run_notebook(file: Path, directory: Path) -> str:
    """Run a notebook in an empty directory; return its text with what its cells show now.

    What a cell shows stays as it is in the file where it agrees with what is shown now, seconds and pixels apart.

    Raises:
        SnippetError: where a cell fails.
    """
    notebook = json.loads(file.read_text(encoding="utf-8"))
    directory.mkdir(parents=True, exist_ok=True)
    with PythonSession(directory, environment()) as session:
        session.run(_SHOW)
        for number, cell in enumerate(code_cells(notebook), 1):
            picture = directory / f"cell_{number}.png"
            ok, printed = session.run(_shown(code_of(cell), picture))
            if not ok:
                raise SnippetError(f"{file.name}, code cell {number}: this cell fails:\n{printed}")
            if not (texts_agree(stored_text(cell), printed) and bool(stored_picture(cell)) == picture.exists()):
                cell["outputs"] = _outputs(printed, picture, number)
            cell["execution_count"] = number
    return json.dumps(notebook, indent=1, ensure_ascii=False) + "\n"


def _shown(code: str, picture: Path) -> str:
    """The code with its last expression shown."""
    tree = ast.parse(code)
    last = tree.body[-1] if tree.body else None
    if isinstance(last, ast.Expr):
        call = ast.Call(ast.Name("_show", ast.Load()), [last.value, ast.Constant(str(picture))], [])
        tree.body[-1] = ast.Expr(call)
    return ast.unparse(ast.fix_missing_locations(tree))


def _outputs(printed: str, picture: Path, number: int) -> list[dict[str, Any]]:
    """What a cell showed, as a notebook keeps it."""
    kept: dict[str, Any] = {}
    if picture.exists():
        kept["image/png"] = base64.b64encode(picture.read_bytes()).decode("ascii")
    if printed:
        kept["text/plain"] = printed.splitlines(keepends=True)
    if not kept:
        return []
    return [{"output_type": "execute_result", "execution_count": number, "data": kept, "metadata": {}}]


def stored_text(cell: dict[str, Any]) -> str:
    """Return the text that a cell shows in the file."""
    return "".join("".join(output["data"].get("text/plain", "")) for output in cell["outputs"])


def stored_picture(cell: dict[str, Any]) -> bytes:
    """Return the picture that a cell shows in the file, as PNG; nothing where it shows none."""
    return base64.b64decode("".join(output["data"].get("image/png", "") for output in cell["outputs"]))


def write_page(file: Path, folder: Path) -> str:
    """Return a notebook as the Markdown of a page; its pictures, and itself to be taken along, go into `folder`."""
    notebook = json.loads(file.read_text(encoding="utf-8"))
    taken = folder / "files" / file.name
    taken.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(file, taken)
    parts = []
    number = 0
    for cell in notebook["cells"]:
        source = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            parts.append(_TO_FILE.sub(r"](../\1)", _TO_PAGE.sub(r"](\1)", source)))
            continue
        number += 1
        parts.append(f"```python\n{source}\n```")
        if text := stored_text(cell):
            parts.append(f"```text\n{text}\n```")
        if picture := stored_picture(cell):
            name = f"pictures/{file.stem}_{number}.png"
            (folder / name).write_bytes(picture)
            parts.append(f"![What cell {number} shows]({name})")
    parts.insert(1, f"This page is a notebook: [{file.name}](files/{file.name}) opens in Jupyter.")
    return "\n\n".join(parts) + "\n"
