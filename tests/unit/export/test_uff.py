"""Mode shapes as a universal file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.errors import AnalysisError
from rotorgear.files.write import WriteError
from tests.paths import ROOT

PAIR = ROOT / "models" / "geared_pair.toml"


def blocks(path: Path) -> list[tuple[int, list[str]]]:
    """Number and lines of each dataset."""
    parts = path.read_text(encoding="ascii").split("    -1\n")
    return [(int(part.splitlines()[0]), part.splitlines()[1:]) for part in parts if part.strip()]


def numbers(lines: list[str]) -> np.ndarray:
    """Columns of 13 characters, as FORTRAN reads 6E13.5."""
    return np.array([float(line[k : k + 13]) for line in lines for k in range(0, len(line), 13)])


@pytest.mark.parametrize("speed", [None, "1500 rpm"])
def test_nodes_and_shapes_come_back_from_the_columns_of_the_format(tmp_path: Path, speed: str | None) -> None:
    result = rg.modal(rg.load(PAIR), speed=speed, modes=5, elements=1)
    written = blocks(rg.write_uff(result, tmp_path / "modes.unv", modes=[0, 3], rotations=True))
    assert [number for number, _ in written] == [164, 15, 82, 82, 55, 55]
    nodes = written[1][1]
    assert numbers([line[40:] for line in nodes]).reshape(-1, 3) == pytest.approx(
        result.nodes.position, rel=1e-5, abs=1e-9
    )
    assert [int(line[:10]) for line in nodes] == list(range(1, len(nodes) + 1))
    for (_, lines), mode in zip(written[4:], (0, 3), strict=True):
        codes = [int(lines[5][k : k + 10]) for k in range(0, 60, 10)]
        s = result.eigenvalues[mode]
        shape = result.shapes[:, :, mode]
        facts = numbers([lines[7]])
        rows = 2 if speed else 1
        values = np.array([numbers(lines[k + 1 : k + 1 + rows]) for k in range(8, len(lines), rows + 1)])
        if speed:
            assert codes == [1, 3, 3, 8, 5, 6]
            assert complex(*facts[:2]) == pytest.approx(s, rel=1e-5)
            found = values[:, 0::2] + 1j * values[:, 1::2]
        else:
            assert codes == [1, 2, 3, 8, 2, 6]
            assert facts[0] == pytest.approx(result.frequency_hz[mode], rel=1e-5, abs=1e-9)
            found = values
        assert found == pytest.approx(shape if speed else shape.real, rel=1e-5, abs=1e-12)


@pytest.mark.parametrize("speed", [None, "1500 rpm"])
def test_another_reader_of_universal_files_reads_the_same(tmp_path: Path, speed: str | None) -> None:
    pyuff = pytest.importorskip("pyuff")
    result = rg.modal(rg.load(PAIR), modes=3, elements=1, speed=speed)
    sets = pyuff.UFF(str(rg.write_uff(result, tmp_path / "modes.unv"))).read_sets()
    assert [each["type"] for each in sets] == [164, 15, 82, 82, 55, 55, 55]
    assert sets[1]["x"] == pytest.approx(result.nodes.position[:, 0], rel=1e-5, abs=1e-9)
    np.testing.assert_array_equal(sets[2]["nodes"], result.nodes.on_shaft("rotor_1") + 1)
    shape = result.shapes[:, :, 1] if speed else result.shapes[:, :, 1].real
    assert sets[5]["r1"] == pytest.approx(shape[:, 0], rel=1e-5, abs=1e-12)
    if speed:  # six complex components of a node are more than it reads
        assert sets[5]["eig"] == pytest.approx(result.eigenvalues[1], rel=1e-5)
    else:
        assert sets[5]["freq"] == pytest.approx(result.frequency_hz[1], rel=1e-5)
        assert sets[5]["r6"] == pytest.approx(shape[:, 5], rel=1e-5, abs=1e-12)


def test_a_mode_that_is_not_there_and_a_folder_in_the_way_are_refused(tmp_path: Path) -> None:
    result = rg.modal(rg.load(PAIR), modes=3, elements=1)
    with pytest.raises(AnalysisError, match="modes: got 7, expected numbers from 0 to 2"):
        rg.write_uff(result, tmp_path / "modes.unv", modes=[7])
    with pytest.raises(WriteError, match="it is a folder"):
        rg.write_uff(result, tmp_path)
