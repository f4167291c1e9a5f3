"""Files are read, written and removed in one place, `rotorgear/files/`: what it refuses, nobody else lets through."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from rotorgear.files import bounds
from tests.paths import ROOT

PACKAGE = ROOT / "rotorgear"
# Calls that open, read or remove a file, however their module is called.
METHODS = {
    "read_text",
    "read_bytes",
    "rmtree",
    "fromfile",
    "loadtxt",
    "genfromtxt",
    "memmap",
    "loadmat",
    "unpack_archive",
}
CALLS = {("np", "load"), ("numpy", "load"), ("h5py", "File"), ("h5", "File"), ("ET", "parse"), ("ElementTree", "parse")}
CALLS |= {("tomllib", "load"), ("tomllib", "loads"), ("json", "load"), ("pickle", "load"), ("pickle", "loads")}
CALLS |= {("zipfile", "ZipFile"), ("os", "open"), ("io", "open"), ("os", "remove"), ("os", "unlink"), ("os", "replace")}
# Who may, and why.
ALLOWED = {
    ("analysis/sweep/cluster.py", "read_bytes"): "the function goes to workers whole, where no package may be",
    ("model/shipped.py", "tomllib.loads"): "models of the package, which need no bounds",
    ("records/logger.py", "open"): "TdmsFile reads what rotorgear/files opened",
    ("rexs/read.py", "open"): "a file of an archive that rotorgear/files opened",
}


def openings(source: str) -> Iterator[str]:
    """Names of calls that open, read or remove files."""
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.Call):
            continue
        if isinstance(node.func, ast.Name) and node.func.id == "open":
            yield "open"
        elif isinstance(node.func, ast.Attribute):
            owner = node.func.value.id if isinstance(node.func.value, ast.Name) else ""
            if node.func.attr in METHODS or (node.func.attr == "open" and owner != "webbrowser"):
                yield node.func.attr
            elif (owner, node.func.attr) in CALLS:
                yield f"{owner}.{node.func.attr}"


def test_files_are_opened_in_one_place_only() -> None:
    found = set()
    for file in PACKAGE.rglob("*.py"):
        place = file.relative_to(PACKAGE).as_posix()
        if not place.startswith("files/"):
            found |= {(place, name) for name in openings(file.read_text(encoding="utf-8"))}
    assert found == set(ALLOWED)


@pytest.mark.parametrize(
    "line",
    [
        "open(path)",
        "with path.open() as file: pass",
        "Path(name).read_text()",
        "np.load(path)",
        "h5py.File(path, 'r')",
        "shutil.rmtree(folder)",
        "from shutil import rmtree as r\nshutil.rmtree(folder)",
        "ET.parse(path)",
    ],
)
def test_the_walk_sees_what_opens_a_file(line: str) -> None:
    assert list(openings(line))


def test_meshes_of_other_programs_are_read_after_their_name_was_checked() -> None:
    source = (PACKAGE / "casings" / "mesh_file.py").read_text(encoding="utf-8")
    assert source.index("named_file(path") < source.index("meshio.read(")
    others = [file for file in PACKAGE.rglob("*.py") if "meshio.read(" in file.read_text(encoding="utf-8")]
    assert [file.name for file in others] == ["mesh_file.py"]


def test_the_command_line_prints_foreign_text_by_one_function() -> None:
    for file in (PACKAGE / "cli").glob("*.py"):
        text = file.read_text(encoding="utf-8")
        if file.name not in ("console.py", "main.py"):  # the latter prints the version, and errors through `shown`
            assert "typer.echo(" not in text, file.name
            assert not re.search(r"(?<!\w)print\(", text.replace("console().print(", "").replace("out.print(", "")), (
                file.name
            )


def test_the_bounds_are_those_that_the_page_on_security_prints() -> None:
    assert bounds.printed() in (ROOT / "SECURITY.md").read_text(encoding="utf-8")


def test_every_bound_is_used() -> None:
    text = "".join(file.read_text(encoding="utf-8") for file in PACKAGE.rglob("*.py") if file.name != "bounds.py")
    for name, value in vars(bounds).items():
        if name.isupper() and name != "ALL" and not name.startswith("_"):
            assert re.search(rf"\b{name}\b", text), f"{name} = {value}"


def test_the_walk_covers_the_package() -> None:
    assert len(list(Path(PACKAGE).rglob("*.py"))) > 400
