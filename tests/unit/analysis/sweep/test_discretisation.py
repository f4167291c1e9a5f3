"""A file is discretised alike in a transient and in a sweep."""

from __future__ import annotations

import rotorgear as rg
from rotorgear.analysis.sweep.point import PointMaker
from rotorgear.analysis.transient.task import prepare
from rotorgear.errors import AnalysisError
from tests.paths import ROOT


def test_a_transient_and_a_sweep_of_a_shipped_model_have_the_same_dofs() -> None:
    compared = 0
    for path in sorted((ROOT / "models").glob("*.toml")):
        model = rg.load(path)
        try:
            point = PointMaker()(model)
        except AnalysisError:  # no speed, no mesh, or teeth that never meet again
            continue
        dofs = point.local.n if hasattr(point, "local") else point.system.n
        assert dofs == prepare(model, None, None).local.local.n, path.name
        compared += 1
    assert compared > 5
