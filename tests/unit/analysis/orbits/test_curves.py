"""Folds and period doublings over two parameters: the same points that branches at the second parameter's value have."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.errors import AnalysisError
from tests.paths import MODELS
from validation.studies.dead_zone import DeadZone


def _curve(case: DeadZone, W: tuple[float, float], ripple: tuple[float, float], method: str) -> rg.OrbitsResult:
    ends = [case.speed(one) for one in W]
    over = {"operation.speed": ends, "loads.drive.ripple": list(ripple)}
    return rg.orbits(rg.loads(case.text(W[0])), over, method=method, step=0.2)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("method", "error"), [pytest.param("shooting", 1e-5, marks=pytest.mark.long), ("harmonic balance", 1e-3)]
)
def test_a_fold_curve_ends_at_the_fold_of_its_last_value(method: str, error: float) -> None:
    case = DeadZone(amplitude=0.05)
    found = _curve(case, (0.735, 0.755), (1.0, 1.03), method)
    curve = found.curves[0]
    assert curve.kind == "fold"
    assert curve.ended == "the end of the second range"
    assert curve.second[[0, -1]] == pytest.approx([1.0, 1.03])
    other = DeadZone(amplitude=0.0515).orbits((0.735, 0.755), method="shooting", step=0.2)
    assert other.special_points[0].kind == "fold"
    assert curve.value[-1] == pytest.approx(other.special_points[0].value, rel=error)
    assert np.all(np.diff(curve.value) < 0.0)


def test_a_curve_of_period_doublings_ends_at_the_doubling_of_its_last_value() -> None:
    case = DeadZone(amplitude=0.2)
    curve = _curve(case, (1.59, 1.63), (4.0, 4.03), "shooting").curves[0]
    assert curve.kind == "period doubling"
    other = DeadZone(amplitude=0.2015).orbits((1.59, 1.63), method="shooting", step=0.2)
    assert other.special_points[0].kind == "period doubling"
    assert curve.value[-1] == pytest.approx(other.special_points[0].value, rel=1e-5)


def test_three_parameters_are_refused() -> None:
    over = {"operation.speed": "1 rpm:2 rpm", "operation.torque": "1 N m:2 N m", "meshes.pair.backlash": "1 um:2 um"}
    with pytest.raises(AnalysisError, match="got 3 parameters, expected one or two"):
        rg.orbits(rg.load(MODELS / "backlash_pair.toml"), over)
