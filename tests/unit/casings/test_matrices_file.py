"""Bodies reduced elsewhere: what a file of matrices must hold, and what is said where it does not."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rotorgear.casings.matrices_file import read_matrices
from rotorgear.errors import AnalysisError
from tests.bar_casing import STEEL, bar_matrices, write_bar

PLACES = np.linspace(-0.1, 0.5, 7)


@pytest.fixture(scope="module")
def arrays() -> dict[str, np.ndarray]:
    return bar_matrices(PLACES, 0.04, [0, 6])


def written(folder: Path, arrays: dict[str, Any]) -> Path:
    np.savez(folder / "bar.npz", **arrays)
    return folder / "bar.npz"


def test_mass_centre_and_inertia_follow_from_a_body_that_floats(tmp_path: Path, arrays: dict[str, np.ndarray]) -> None:
    body = read_matrices(written(tmp_path, arrays), {}, 0.0, "box")
    mass = STEEL[3] * np.pi * 0.04**2 / 4.0 * 0.6
    assert body.body_mass == pytest.approx(mass, rel=1e-9)
    assert body.centre == pytest.approx([0.0, 0.0, 0.2], abs=1e-9)
    assert np.diagonal(body.inertia) == pytest.approx(
        [mass * (0.6**2 / 12.0 + 0.04**2 / 16.0)] * 2 + [mass * 0.04**2 / 8.0], rel=1e-9
    )
    assert not body.held
    assert body.inertia_force[:, :3] == pytest.approx(arrays["weight"], abs=1e-9 * mass)


def test_of_a_body_that_is_held_they_are_not_known(tmp_path: Path) -> None:
    given = bar_matrices(PLACES, 0.04, [0, 6], held=[3])
    del given["weight"]
    body = read_matrices(written(tmp_path, given), {}, 0.0, "box")
    assert body.held
    assert np.isnan(body.body_mass)
    assert np.all(np.isnan(body.inertia_force))


def test_the_model_file_may_say_where_the_seats_are(tmp_path: Path, arrays: dict[str, np.ndarray]) -> None:
    bare = {key: arrays[key] for key in ("mass", "stiffness")}
    with pytest.raises(AnalysisError, match=r"casings.box.matrices: 'bar.npz' does not say where its seats are"):
        read_matrices(written(tmp_path, bare), {}, 0.0, "box")
    body = read_matrices(written(tmp_path, bare), {"a": (0.0, 0.0, -0.1), "b": (0.0, 0.0, 0.5)}, 0.0, "box")
    assert body.seats == ("a", "b")
    assert body.seat_points[1] == pytest.approx([0.0, 0.0, 0.5])


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"stiffness": None}, "has no array 'stiffness'; it has mass, seats"),
        ({"mass": np.eye(6)}, r"mass is \(6, 6\) in 'bar.npz', expected \(42, 42\)"),
        ({"stiffness": np.triu(np.ones((42, 42)))}, "stiffness is not symmetric"),
        ({"mass": np.zeros((42, 42))}, "the mass matrix in 'bar.npz' is not positive definite"),
        ({"stiffness": -np.eye(42)}, "the stiffness in 'bar.npz' has a negative eigenvalue"),
        ({"mass": np.full((42, 42), np.nan)}, "mass has entries that are no finite numbers"),
        ({"seats": np.array(["a"])}, "1 names of seats with 2 reference points"),
        ({"weight": np.zeros((3, 3))}, r"weight is \(3, 3\) in 'bar.npz', expected \(42, 3\)"),
        ({"loads": np.zeros(3)}, "has an array 'loads' that means nothing here"),
        ({"surface_points": np.zeros((2, 3))}, "has surface_points only; a surface needs"),
    ],
    ids=lambda value: next(iter(value)) if isinstance(value, dict) else None,
)
def test_arrays_that_do_not_fit_are_named(
    tmp_path: Path, arrays: dict[str, np.ndarray], change: dict[str, Any], said: str
) -> None:
    changed = {key: value for key, value in {**arrays, **change}.items() if value is not None}
    with pytest.raises(AnalysisError, match=said):
        read_matrices(written(tmp_path, changed), {}, 0.0, "box")


def test_files_that_are_no_archives_are_refused(tmp_path: Path) -> None:
    with pytest.raises(AnalysisError, match=r"casings\.box.matrices: there is no file '.*gone\.npz'"):
        read_matrices(tmp_path / "gone.npz", {}, 0.0, "box")
    (tmp_path / "text.npz").write_text("no matrices")
    with pytest.raises(AnalysisError, match=r"'text\.npz' can't be read as a NumPy archive"):
        read_matrices(tmp_path / "text.npz", {}, 0.0, "box")
    for share in (0.1, 0.5, 0.9):
        whole = write_bar(tmp_path / "bar.npz", z=np.linspace(0.0, 0.5, 3), diameter=0.03, seats=[0]).read_bytes()
        (tmp_path / "cut.npz").write_bytes(whole[: int(share * len(whole))])
        with pytest.raises(AnalysisError, match=r"'cut\.npz' can't be read as a NumPy archive \(\.npz\): \w"):
            read_matrices(tmp_path / "cut.npz", {}, 0.0, "box")
    (tmp_path / "box.op4").write_text("")
    with pytest.raises(
        AnalysisError, match=r"'box\.op4' is a file of Nastran, which is not read; write its matrices into"
    ):
        read_matrices(tmp_path / "box.op4", {}, 0.0, "box")
