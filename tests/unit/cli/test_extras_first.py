"""An optional package that is missing is named before a model is even read, by every command that will want it."""

from __future__ import annotations

import sys

import pytest
from typer.testing import CliRunner

from rotorgear.cli.main import app
from rotorgear.errors import MissingExtraError

SWEEP = ["sweep", "none.toml", "--over", "damping.modal=0.01,0.02"]
ORBITS = ["orbits", "none.toml", "--over", "operation.speed=1000 rpm:2000 rpm"]
FRF = ["frf", "none.toml", "--inputs", "a", "--outputs", "b", "--fmax", "100"]


@pytest.mark.parametrize(
    ("package", "extra", "command"),
    [
        ("matplotlib", "plots", ["campbell", "none.toml", "--plot", "a.png"]),
        ("matplotlib", "plots", ["critical", "none.toml", "--map", "--plot", "a.png"]),
        ("matplotlib", "plots", ["static", "none.toml", "--plot", "a.png"]),
        ("matplotlib", "plots", ["response", "none.toml", "--plot", "a.png"]),
        ("matplotlib", "plots", ["response", "none.toml", "--waterfall", "a.png"]),
        ("matplotlib", "plots", [*FRF, "--plot", "a.png"]),
        ("matplotlib", "plots", ["gear", "none.toml", "--plot", "a.png"]),
        ("matplotlib", "plots", ["mesh", "none.toml", "--plot", "a.png"]),
        ("matplotlib", "plots", ["accuracy", "none.toml", "--plot", "a.png"]),
        ("matplotlib", "plots", ["transient", "none.toml", "--plot", "a"]),
        ("matplotlib", "plots", [*SWEEP, "--plot", "a"]),
        ("matplotlib", "plots", [*ORBITS, "--plot", "a.png"]),
        ("pyvista", "vtk", ["modal", "none.toml", "--plot", "a"]),
        ("pyvista", "vtk", ["modal", "none.toml", "--vtk", "a"]),
        ("pyvista", "vtk", ["campbell", "none.toml", "--vtk", "a"]),
        ("pyvista", "vtk", ["static", "none.toml", "--vtk", "a"]),
        ("pyvista", "vtk", ["response", "none.toml", "--vtk", "a"]),
        ("pyvista", "vtk", ["casing", "none.toml", "--vtk", "a"]),
        ("pyvista", "vtk", ["transient", "none.toml", "--vtk", "a"]),
        ("pyvista", "vtk", ["mesh", "none.toml", "--vtk", "a"]),
        ("pyvista", "vtk", ["view", "none.toml"]),
        ("numba", "transient", ["transient", "none.toml"]),
        ("numba", "transient", SWEEP),
        ("numba", "transient", ORBITS),
        ("tomlkit", "rig", ["update", "none.toml", "--rig", "none.csv", "-o", "b.toml"]),
    ],
    ids=lambda value: " ".join(value[:1] + value[-2:]) if isinstance(value, list) else str(value),
)
def test_a_missing_package_is_named_before_anything_is_read(
    package: str, extra: str, command: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    refusal = CliRunner().invoke(app, command).exception
    assert isinstance(refusal, MissingExtraError)
    assert f"needs the package {package}: install it with  pip install 'rotorgear[{extra}]'" in str(refusal)


def test_a_sweep_speaks_of_itself_where_the_compiler_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "numba", None)
    assert "transient needs" not in str(CliRunner().invoke(app, SWEEP).exception)
