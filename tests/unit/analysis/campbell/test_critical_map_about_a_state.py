"""The map of critical speeds where teeth feel the tilt of their shafts: each stiffness has a state of its own."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from tests.paths import MODELS


def helical(stiffness: str, **given: object) -> rg.Model:
    return rg.load(MODELS / "helical_pair.toml").with_(
        {"meshes.stage.tilt": True, "meshes.stage.stiffness": stiffness, "operation.speed": "2100 rpm", **given}
    )


def overhung() -> rg.Model:
    return rg.load(MODELS / "overhung_pinion.toml")


def with_bearings(model: rg.Model, k: float) -> rg.Model:
    """The model with this radial stiffness in all bearings; all else of them stays, but their damping."""
    changed = {}
    for name, bearing in model.bearings.items():
        assert bearing.stiffness is not None
        rows = np.array(bearing.stiffness.as_rows())
        rows[:2, :] = 0.0
        rows[:, :2] = 0.0
        rows[0, 0] = rows[1, 1] = k
        changed |= {f"bearings.{name}.stiffness": {"matrix": rows.tolist()}, f"bearings.{name}.damping": None}
    return model.with_(changed)


@pytest.mark.parametrize(
    ("model", "stop"),
    [
        (lambda: helical("9.4e8 N/m", **{"meshes.stage.misalignment": "40 um"}), "90000 rpm"),
        (lambda: helical("iso", **{"meshes.stage.misalignment": "-35 um"}), "-90000 rpm"),
        pytest.param(overhung, "60000 rpm", marks=pytest.mark.long),
    ],
)
def test_the_map_is_what_critical_finds_with_just_these_bearings(model, stop) -> None:
    given = model()
    for k in (4e7, 6e8):
        found = rg.critical_map(given, stiffness=[k], stop=stop, elements=2)
        row = found.critical_speeds[0]
        same = rg.critical(
            with_bearings(given, k), stop=stop, elements=2, damped=False, shaft_orders=(1.0,), mesh_orders=()
        )
        expected = [item.speed for item in same.speeds if item.line == found.line]
        assert len(expected) >= 2
        assert np.sort(np.abs(row[np.isfinite(row)])) == pytest.approx(np.sort(np.abs(expected)), rel=1e-6)
