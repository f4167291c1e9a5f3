"""Critical speeds: what the map draws, and the sense of whirl that a line of a shaft reads."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from tests.models import STEEL
from tests.paths import MODELS


def dual_spool(ratio: float = -1.5, polar: float = 0.02) -> rg.Model:
    """Two coaxial spools on isotropic bearings, one of them between the spools; `ratio` is the speed of the outer one."""

    def disk(shaft: str, at: float, mass: float) -> dict[str, Any]:
        return {
            "shaft": shaft,
            "at": at,
            "mass": mass,
            "polar_inertia": mass * polar,
            "diametral_inertia": mass * 0.011,
        }

    def bearing(shaft: str, at: float) -> dict[str, Any]:
        return {"shaft": shaft, "at": at, "stiffness": {"radial": 2e7, "axial": 1e7}}

    hollow = {"length": 0.4, "outer_diameter": 0.08, "bore": 0.06}
    return rg.Model(
        shafts={
            "low": {"sections": [{"length": 1.0, "outer_diameter": 0.04}]},
            "high": {"start": 0.3, "speed_ratio": ratio, "sections": [hollow]},
        },
        disks={"fan": disk("low", 0.1, 10.0), "turbine": disk("low", 0.9, 8.0), "high": disk("high", 0.5, 12.0)},
        bearings={"front": bearing("low", 0.0), "rear": bearing("low", 1.0), "high": bearing("high", 0.3)},
        couplings={
            "between": {
                "from_shaft": "low",
                "from_at": 0.7,
                "to_shaft": "high",
                "to_at": 0.7,
                "stiffness": {"radial": 1e7},
            }
        },
        operation={"input_shaft": "low", "speed": 1000.0},
        motions=["bending"],
    )


def falls(chart: rg.CriticalMap) -> float:
    """The steepest fall of a curve of the map from one stiffness to the next, relative; 0 or above: none."""
    speeds = np.abs(chart.critical_speeds)
    return float(np.nanmin(speeds[1:] / speeds[:-1] - 1.0))


@pytest.mark.parametrize("name", ["split_torque", "dual spool"])
def test_no_curve_of_the_map_falls_and_none_begins_in_the_middle(name: str) -> None:
    model = dual_spool() if name == "dual spool" else rg.load(MODELS / f"{name}.toml")
    stop = 2500.0 if name == "dual spool" else None
    chart = rg.critical_map(model, stiffness=np.logspace(6.0, 10.0, 9).tolist(), stop=stop, elements=1)
    assert falls(chart) >= -1e-9
    # A curve leaves the map through its upper edge once, and does not come back.
    there = np.isfinite(chart.critical_speeds)
    assert not np.any(there[1:] & ~there[:-1])
    assert there[0].sum() >= 4


def test_the_picture_draws_what_does_not_fall() -> None:
    pytest.importorskip("matplotlib")
    chart = rg.critical_map(dual_spool(), stiffness=np.logspace(6.0, 9.0, 7).tolist(), stop=2500.0, elements=1)
    axis = rg.plot.critical_map(chart)
    curves = [line.get_ydata() for line in axis.lines if len(line.get_xdata()) == 7 and line.get_linestyle() == "-"]
    assert len(curves) == chart.critical_speeds.shape[1]
    for curve in curves:
        assert np.all(np.diff(curve[np.isfinite(curve)]) >= -1e-9 * curve[0])
    names = {text.get_text() for text in axis.get_legend().get_texts()}
    assert {"forward whirl", "backward whirl"} <= names


@pytest.mark.parametrize(("ratio", "polar"), [(-1.5, 0.02), (1.5, 0.02), (-1.5, 0.0), (-1.0, 0.02)])
def test_unbalance_on_isotropic_supports_drives_forward_whirl_of_its_own_shaft_only(ratio: float, polar: float) -> None:
    """On isotropic supports every orbit is a circle of one sense: forward for a spool or backward."""
    result = rg.critical(dual_spool(ratio, polar), stop=2500.0, elements=2)
    excited = [item for item in result.speeds if item.excited]
    # At equal sizes of speed both spools have one line, and every mode is forward for one of them.
    both = {"shaft low 1x", "shaft high 1x"} if abs(ratio) != 1.0 else {"shaft low, high 1x"}
    assert {item.line for item in excited} == both
    assert {item.whirl for item in excited} == {"forward"}
    assert {item.whirl for item in result.speeds if not item.excited} <= {"backward"}


def test_whirl_of_a_line_is_that_of_its_own_shaft() -> None:
    """The same mode, met by the lines of two spools that turn against each other, reads forward for the one and backward else."""
    diagram = rg.campbell(
        dual_spool(-1.5), speeds=np.linspace(0.0, 2500.0, 11).tolist(), modes=6, elements=1, shaft_orders=[1.0]
    )
    assert {item.whirl for item in diagram.crossings if item.excited} == {"forward"}
    assert {item.whirl for item in diagram.margins if item.branch} == {"forward"}


def test_free_rotations_of_shafts_that_nothing_joins_are_no_critical_speeds() -> None:
    # One element each: their strains are rounding too.
    section = [{"length": 0.2, "outer_diameter": 0.03}]
    rotor = rg.Model(
        materials=STEEL,
        operation={"speed": 157.0, "input_shaft": "held"},
        shafts={"held": {"sections": section}, "loose": {"start": 1.0, "sections": section}},
        bearings={"left": {"shaft": "held", "at": "start", "stiffness": {"radial": 1e7}}},
    )
    assert rg.critical(rotor).speeds == ()


def test_the_method_says_a_count_by_pivot_signs_where_there_was_one() -> None:
    model = dual_spool()
    assert rg.critical(model, stop="9000 rpm", damped=False).method.endswith("undamped, counted by pivot signs")
    assert "pivot signs" not in rg.critical(model, stop="9000 rpm").method
    # Stiffnesses that change with the speed are no pair of Hermitian matrices: there is nothing to count with.
    name, bearing = next(iter(model.bearings.items()))
    assert bearing.stiffness is not None
    rows = [{"speed": f"{rpm} rpm", "stiffness": {"radial": k}} for rpm, k in ((0, 1e7), (20000, 3e7))]
    changed = model.with_({f"bearings.{name}.stiffness": None, f"bearings.{name}.table": rows})
    found = rg.critical(changed, stop="9000 rpm", damped=False)
    assert len(found)
    assert found.method.endswith(("undamped, not counted by pivot signs", "undamped, in part counted by pivot signs"))
