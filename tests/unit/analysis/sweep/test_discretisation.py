"""A file is discretised alike in a transient and in a sweep."""

from __future__ import annotations

from typing import Any

import pytest

import rotorgear as rg
from rotorgear.analysis.sweep import point as sweep_point
from rotorgear.analysis.sweep.point import PointMaker
from rotorgear.analysis.transient.request import prepare
from rotorgear.errors import AnalysisError
from tests.paths import ROOT

# Models whose teeth or casing are computed by finite elements first.
COSTLY = {"elastic_wheel", "helicopter", "overhung_pinion", "relieved_pair", "split_torque_casing", "web_wheel"}


@pytest.mark.parametrize("costly", [False, pytest.param(True, marks=pytest.mark.long)])
def test_a_transient_and_a_sweep_of_a_shipped_model_have_the_same_dofs(costly: bool) -> None:
    compared = 0
    for path in sorted((ROOT / "models").glob("*.toml")):
        if (path.stem in COSTLY) != costly:
            continue
        model = rg.load(path)
        try:
            point = PointMaker()(model)
        except AnalysisError:  # no speed, no mesh, or teeth that never meet again
            continue
        dofs = point.local.n if hasattr(point, "local") else point.system.n
        assert dofs == prepare(model, None, None).local.local.n, path.name
        compared += 1
    assert compared >= (3 if costly else 6)


def test_only_shafts_with_internal_damping_find_their_state_at_rest_anew_at_each_speed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    flexible = rg.load(ROOT / "models" / "flexible_pair.toml")
    assert flexible.operation
    made: list[float] = []
    built = sweep_point.local_model

    def counted(*args: Any) -> Any:
        made.append(args[-1])
        return built(*args)

    monkeypatch.setattr(sweep_point, "local_model", counted)
    damped = {name: shaft.model_copy(update={"internal_damping": 1e-6}) for name, shaft in flexible.shafts.items()}
    for shafts, times in ((flexible.shafts, 1), (damped, 3)):
        made.clear()
        maker = PointMaker()
        for speed in (300.0, 400.0, 500.0):
            operation = flexible.operation.model_copy(update={"speed": speed})
            maker(flexible.model_copy(update={"shafts": shafts, "operation": operation}))
        assert len(made) == times
