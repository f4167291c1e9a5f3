"""The many small orders of teeth that differ: they share bases, and the mesh is made for the large ones."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.model.layout.mesh_layout import MeshLayout
from tests.models import spur_pair
from tests.unit.analysis.written_maps import written

K = 3e8
PERIODS = 6


def one_odd_tooth(F: np.ndarray, u: np.ndarray) -> np.ndarray:
    """A ripple, and a tooth of six that stands back by 4 um."""
    late = np.abs(np.mod(u, PERIODS) - 2.0)
    return np.asarray(F / K + 1e-6 * np.cos(2.0 * np.pi * u) + 4e-6 * np.maximum(1.0 - late / 0.7, 0.0))


def solved(method: str, speeds: list[float]) -> rg.ResponseResult:
    model = spur_pair(
        meshes__pair__stiffness="tooth_fe", meshes__pair__transmission_error=[], meshes__pair__stiffness_variation=[]
    )
    return rg.response(model, speeds=speeds, method=method, modal_damping=0.03, elements=1)


def test_orders_that_share_a_basis_are_those_of_direct_solutions(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(MeshLayout, "contact_map", written(one_odd_tooth, PERIODS))
    direct, modal = (solved(method, [40.0, 90.0, 150.0]) for method in ("direct", "modal"))
    assert len(direct.orders) > 2 * PERIODS
    assert modal.orders == direct.orders
    for name in ("mesh_force", "transmission_error", "approach", "displacement"):
        expected = getattr(direct, name)
        size = np.abs(expected).max(axis=tuple(range(2, expected.ndim)), keepdims=True)
        assert np.all(np.abs(getattr(modal, name) - expected) <= 1e-5 * size)
    assert any("finer mesh" in note for note in direct.left_out)


def test_at_a_crawl_all_orders_together_have_the_peak_to_peak_of_the_teeth(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(MeshLayout, "contact_map", written(one_odd_tooth, PERIODS))
    found = solved("direct", [0.01])
    u = PERIODS * np.arange(4096) / 4096
    ratio = found.ratio / found.model.gears["pinion"].teeth
    whole = (found.approach[:, 0, 0] * np.exp(2j * np.pi * np.outer(u, ratio))).real.sum(axis=1)
    assert np.ptp(whole) == pytest.approx(np.ptp(one_odd_tooth(np.zeros(1), u)), rel=0.01)
