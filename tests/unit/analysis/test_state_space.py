"""State spaces: the whole one is the frequency response, the reduced one within the error that it states, at speed too."""

from __future__ import annotations

import shutil
import subprocess
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.io import loadmat
from scipy.linalg import eigh

import rotorgear as rg
from rotorgear.errors import AnalysisError
from tests.paths import ROOT

PLACES: dict[str, Any] = {
    "inputs": ["gears.pinion:torsion", "bearings.input_left:x"],
    "outputs": ["gears.wheel:y", "bearings.input_left:x"],
}
FMAX = 3000.0


@cache
def pair() -> rg.Model:
    return rg.load(ROOT / "models" / "helical_pair.toml")


def relative_difference(found: np.ndarray, exact: np.ndarray) -> float:
    return float(np.max(np.abs(found - exact) / np.abs(exact).max(axis=0)))


def first_order(hz: np.ndarray, A: np.ndarray, B: np.ndarray, C: np.ndarray, D: np.ndarray) -> np.ndarray:
    return np.array([C @ np.linalg.solve(2j * np.pi * f * np.eye(len(A)) - A, B) + D for f in hz])


@pytest.mark.parametrize("speed", [None, "30000 rpm"])
def test_the_whole_state_space_is_the_frequency_response(speed: str | None) -> None:
    hz = np.linspace(7.0, FMAX, 23)
    exact = rg.frf(pair(), hz, speed=speed, modal_damping=0.01, elements=1, **PLACES).receptance
    system = rg.state_space(pair(), fmax=FMAX, speed=speed, modal_damping=0.01, elements=1, full=True, **PLACES)
    assert relative_difference(system.receptance(hz), exact) < 1e-8
    assert relative_difference(first_order(hz, *system.first_order()), exact) < 1e-8
    skew = system.velocity_terms - system.velocity_terms.T
    assert bool(np.any(np.abs(skew) > 1e-9)) == (speed is not None)  # gyroscopic moments are there where it turns


@pytest.mark.parametrize(("speed", "accuracy"), [(None, 1e-4), ("30000 rpm", 1e-3), ("30000 rpm", 1e-6)])
def test_a_reduced_state_space_is_within_its_stated_error(speed: str | None, accuracy: float) -> None:
    hz = np.linspace(3.0, FMAX, 311)
    exact = rg.frf(pair(), hz, speed=speed, modal_damping=0.02, elements=1, **PLACES).receptance
    system = rg.state_space(pair(), fmax=FMAX, speed=speed, modal_damping=0.02, elements=1, accuracy=accuracy, **PLACES)
    assert relative_difference(first_order(hz, *system.first_order()), exact) < system.reduction_error <= accuracy
    assert system.size < system.dofs / 2 or accuracy < 1e-5


def frequencies(system: rg.StateSpace) -> np.ndarray:
    w2 = eigh(system.stiffness_matrix, system.mass_matrix, eigvals_only=True)
    return np.sqrt(np.maximum(w2, 0.0)) / (2.0 * np.pi)


def test_an_undamped_reduction_keeps_the_natural_frequencies() -> None:
    system = rg.state_space(pair(), fmax=FMAX, elements=1, **PLACES)
    exact = frequencies(rg.state_space(pair(), fmax=FMAX, elements=1, full=True, **PLACES))
    inside = exact[(exact > 1.0) & (exact < FMAX)]
    found = frequencies(system)
    assert found[found > 1.0][: len(inside)] == pytest.approx(inside, rel=1e-8)


def test_what_no_place_reaches_has_no_coordinates() -> None:  # seed 202267: 200 loose shafts beside a pair
    loose = {f"loose_{k}": {"sections": [{"length": 0.2, "outer_diameter": 0.03}]} for k in range(3)}
    text = tomllib.loads((ROOT / "models" / "helical_pair.toml").read_text(encoding="utf-8"))
    beside = rg.Model(**{**text, "shafts": {**text["shafts"], **loose}})
    alone = rg.state_space(pair(), fmax=FMAX, modal_damping=0.02, elements=1, **PLACES)
    system = rg.state_space(beside, fmax=FMAX, modal_damping=0.02, elements=1, **PLACES)
    assert system.size == alone.size
    assert system.kept_modes == alone.kept_modes
    assert system.dofs == alone.dofs + 36
    hz = np.linspace(7.0, FMAX, 23)
    assert relative_difference(system.receptance(hz), alone.receptance(hz)) < 1e-9
    [apart] = [note for note in system.left_out if note.startswith("motions that no input moves")]
    assert apart.endswith(f"36 of {system.dofs} degrees of freedom (bending, axial, torsion)")
    whole = rg.state_space(beside, fmax=FMAX, modal_damping=0.02, elements=1, full=True, **PLACES)
    assert whole.size == whole.dofs


def test_an_output_that_no_input_moves_is_told() -> None:
    rotor = rg.load(ROOT / "models" / "jeffcott.toml")
    places = {"inputs": ["disks.disk:x"], "outputs": ["disks.disk:x", "disks.disk:y"], "fmax": 100.0, "elements": 1}
    assert rg.state_space(rotor, **places).warnings == ("no input moves disks.disk:y: its responses are 0",)
    assert not rg.state_space(rotor, speed="3000 rpm", **places).warnings  # gyroscopic moments join both


def test_places_that_move_no_inertia_are_refused() -> None:
    massless = rg.Model(
        shafts={"one": {}, "two": {}},
        disks={"disk": {"shaft": "one", "at": "start", "mass": 1.0, "polar_inertia": 1e-3, "diametral_inertia": 1e-3}},
        bearings={
            name: {"shaft": name, "at": "start", "stiffness": {"radial": 1e6, "axial": 1e6}} for name in ("one", "two")
        },
    )
    with pytest.raises(AnalysisError, match="nothing that has inertia moves with these inputs and outputs"):
        rg.state_space(massless, inputs=["bearings.two:x"], outputs=["bearings.two:x"], fmax=100.0)


@pytest.mark.parametrize("ending", ["mat", "npz"])
def test_a_file_has_the_system_with_its_names_and_units(ending: str, tmp_path: Path) -> None:
    system = rg.state_space(pair(), fmax=FMAX, modal_damping=0.02, elements=1, **PLACES)
    path = rg.write_state_space(system, tmp_path / f"pair.{ending}")
    stored: Any = loadmat(path, simplify_cells=True) if ending == "mat" else np.load(path, allow_pickle=False)
    hz = np.array([100.0, 1000.0])
    assert relative_difference(first_order(hz, *(stored[key] for key in "ABCD")), system.receptance(hz)) < 1e-8
    assert list(stored["inputs"]) == PLACES["inputs"]
    assert list(stored["input_units"]) == ["N m", "N"]
    assert float(stored["reduction_error"]) == system.reduction_error


@pytest.mark.skipif(shutil.which("octave-cli") is None, reason="GNU Octave is not installed")
def test_octave_computes_the_same_response(tmp_path: Path) -> None:
    system = rg.state_space(pair(), fmax=FMAX, speed="3000 rpm", modal_damping=0.02, elements=1, **PLACES)
    path = rg.write_state_space(system, tmp_path / "pair.mat")
    script = (
        f"s = load('{path}'); w = 2*pi*777; H = s.C*((1i*w*eye(size(s.A))-s.A)\\s.B)+s.D; "
        "printf('%.15e %.15e\\n', [real(H(:)) imag(H(:))]'); printf('%s;', s.inputs{:})"
    )
    # Some builds of Octave stumble over their own exit; what was printed before counts.
    said = subprocess.run(
        ["octave-cli", "--no-gui", "--quiet", "--eval", script], capture_output=True, text=True, timeout=120
    ).stdout
    *numbers, names = said.strip().splitlines()
    H = np.array([complex(*map(float, line.split())) for line in numbers]).reshape(2, 2).T
    assert relative_difference(H[None], system.receptance(np.array([777.0]))) < 1e-10
    assert names == ";".join(PLACES["inputs"]) + ";"


def test_matrices_of_a_file_give_the_frequencies_and_name_every_dof(tmp_path: Path) -> None:
    path = rg.write_matrices(pair(), tmp_path / "pair.npz", elements=1)
    found = rg.read_matrices(path)
    w2 = eigh(found["stiffness"].toarray(), found["mass"].toarray(), eigvals_only=True)
    exact = frequencies(rg.state_space(pair(), fmax=FMAX, elements=1, full=True, **PLACES))
    assert np.sqrt(np.maximum(w2, 0.0))[1:] / (2.0 * np.pi) == pytest.approx(exact[1:], rel=1e-8)
    n = found["mass"].shape[0]
    assert len(found["dofs"]) == len(found["units"]) == len(set(found["dofs"])) == n
    assert set(found["units"]) == {"m", "rad"}
    assert found["transform"].shape == (len(found["node_dofs"]), n)
    gyroscopic = found["gyroscopic"]
    assert abs(gyroscopic + gyroscopic.T).max() == 0.0


def test_what_is_no_file_of_matrices_is_refused(tmp_path: Path) -> None:
    (tmp_path / "other.npz").write_bytes(b"text")
    for path in (tmp_path / "other.npz", tmp_path / "none.npz"):
        with pytest.raises(rg.RotorgearError):
            rg.read_matrices(path)
    with pytest.raises(rg.AnalysisError, match=r"ends with \.npz"):
        rg.write_matrices(pair(), tmp_path / "pair.txt", elements=1)
    with pytest.raises(rg.AnalysisError, match="fmax"):
        rg.write_matrices(pair(), tmp_path / "pair.npz")


def test_the_command_writes_all_three_files(tmp_path: Path) -> None:
    from typer.testing import CliRunner

    from rotorgear.cli.main import app

    files = {name: str(tmp_path / name) for name in ("s.npz", "m.npz", "modes.unv")}
    places = ["--inputs", "gears.pinion:y", "--outputs", "gears.wheel:y", "--fmax", "1000", "--elements", "1"]
    model = str(ROOT / "models" / "helical_pair.toml")
    writes = ["--state-space", files["s.npz"], "--matrices", files["m.npz"], "--uff", files["modes.unv"]]
    done = CliRunner().invoke(app, ["export", model, *writes, *places])
    assert done.exit_code == 0
    assert all(Path(file).stat().st_size for file in files.values())
    assert isinstance(CliRunner().invoke(app, ["export", model]).exception, rg.AnalysisError)
    assert isinstance(CliRunner().invoke(app, ["export", model, "--state-space", "s.csv"]).exception, rg.AnalysisError)
