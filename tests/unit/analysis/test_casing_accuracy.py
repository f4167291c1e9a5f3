"""The study of a casing: error and estimate of the same frequencies, of its own and of the gearbox with it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from tests.unit.casings.blocks import block, write_inp
from tests.unit.casings.test_casing import MODEL

pytest.importorskip("meshio")


def model(folder: Path) -> rg.Model:
    write_inp(folder / "box.inp", block((0.1, 0.06, 0.2), (2, 1, 2), "hexahedron20"))
    return rg.loads(MODEL, folder=folder)


@pytest.mark.parametrize("coupled", [False, True])
def test_estimates_of_mesh_and_reduction_are_those_of_the_errors(tmp_path: Path, coupled: bool) -> None:
    study = rg.casing_convergence_study(
        model(tmp_path), modes=3, coupled=coupled, finest=3000, fixed=(1, 3, 10), repeat=1
    )
    rows = {rung.method: rung for rung in study.rungs}
    mesh = rows["the file's mesh"]
    assert mesh.effectivity is not None
    assert 0.5 < mesh.effectivity < 3.0
    fixed = [rows[f"{n} fixed mode{'s'}"] for n in (1, 3, 10)]
    assert fixed[0].error > fixed[1].error > fixed[2].error
    for rung in fixed:
        assert rung.effectivity is None or 0.9 < rung.effectivity < 10.0
    if not coupled:
        assert rows["linear elements"].error > 2.0 * mesh.error
        assert np.isnan(rows["linear elements"].estimate)


def test_a_mesh_too_large_for_a_finer_one_is_refused(tmp_path: Path) -> None:
    with pytest.raises(rg.AnalysisError, match="one split in eight to compare with has more than 500"):
        rg.accuracy(model(tmp_path), "casing", finest=500)
