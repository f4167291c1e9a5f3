"""Heavy packages are imported where they are needed: help comes at once, and a modal run loads no graphics.

Each test starts a new interpreter and looks at its `sys.modules`, because this one has long loaded everything.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.paths import ROOT

# The page of `rotorgear app`, and tables of other programs: nothing else has any of them.
PAGE = {"nicegui", "fastapi", "starlette", "uvicorn", "openpyxl", "pandas", "xarray"}
HEAVY = PAGE | {"numpy", "scipy", "numba", "h5py", "pyvista", "skfem", "meshio", "matplotlib", "distributed", "dask"}
# What a modal run of shafts has no need of: graphics, a compiler, finite elements of solids, a cluster.
GRAPHICS = PAGE | {"pyvista", "vtk", "vtkmodules", "matplotlib", "numba", "skfem", "meshio", "pymetis", "distributed"}

# Runs the program text argv[1] with the arguments argv[3:], then writes which modules are loaded to the file argv[2].
WATCH = """
import json, sys
program, answer, *arguments = sys.argv[1:]
sys.argv = ["rotorgear", *arguments]
code = 0
try:
    exec(compile(program, "program", "exec"), {"__name__": "program"})
except SystemExit as stop:
    code = stop.code or 0
with open(answer, "w", encoding="utf-8") as file:
    json.dump({"code": code, "modules": sorted({name.partition(".")[0] for name in sys.modules})}, file)
"""
AS_MODULE = "import runpy; runpy.run_module('rotorgear', run_name='__main__', alter_sys=True)"
AS_FUNCTION = "from rotorgear.cli.main import main; main()"

needs_command_line = pytest.mark.skipif(
    not ((ROOT / "rotorgear" / "cli" / "main.py").exists() and (ROOT / "rotorgear" / "__main__.py").exists()),
    reason="there is no command line yet",
)
needs_models = pytest.mark.skipif(not any((ROOT / "models").glob("*.toml")), reason="there are no models yet")


def loaded(tmp_path: Path, program: str, *arguments: str) -> set[str]:
    """Return the top-level modules loaded by a program that ends well."""
    answer = tmp_path / "answer.json"
    command = [sys.executable, "-c", WATCH, program, str(answer), *arguments]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PYTHONUTF8": "1"}
    run = subprocess.run(
        command,
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        encoding="utf-8",
        timeout=120,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    report = json.loads(answer.read_text(encoding="utf-8"))
    assert report["code"] == 0, run.stdout + run.stderr
    return set(report["modules"])


def test_the_watch_sees_a_heavy_import_inside_a_function(tmp_path: Path) -> None:
    assert HEAVY & loaded(tmp_path, "def late():\n    import numpy.linalg\nlate()") == {"numpy"}


def test_importing_rotorgear_loads_nothing_heavy(tmp_path: Path) -> None:
    modules = loaded(tmp_path, "import rotorgear")
    assert "rotorgear" in modules
    assert not HEAVY & modules


@needs_command_line
@pytest.mark.parametrize("program", [AS_MODULE, AS_FUNCTION], ids=["python -m rotorgear", "main()"])
@pytest.mark.parametrize("arguments", [("--help",), ("modal", "--help")], ids=" ".join)
def test_help_loads_nothing_heavy(tmp_path: Path, program: str, arguments: tuple[str, ...]) -> None:
    modules = loaded(tmp_path, program, *arguments)
    assert "rotorgear" in modules
    assert not HEAVY & modules


@needs_command_line
def test_the_list_of_commands_loads_no_model_and_no_colours(tmp_path: Path) -> None:
    assert not {"pydantic", "pydantic_core", "rich"} & loaded(tmp_path, AS_MODULE, "--help")


def test_the_server_of_the_page_is_imported_by_the_page_alone() -> None:
    sources = {file: file.read_text(encoding="utf-8") for file in (ROOT / "rotorgear").rglob("*.py")}
    found = {file.parent.name for file, text in sources.items() if re.search(r"^\s*(from|import) nicegui", text, re.M)}
    assert found == {"app"}


@needs_command_line
@needs_models
def test_a_modal_run_loads_no_graphics_and_no_compiler(tmp_path: Path) -> None:
    model = min((ROOT / "models").glob("*.toml"), key=lambda file: file.stat().st_size)
    modules = loaded(tmp_path, AS_FUNCTION, "modal", str(model))
    assert {"rotorgear", "scipy"} <= modules
    assert not GRAPHICS & modules
