"""Limits of a run-up: what the table says of them by hand, units and levels, pictures, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.errors import ModelError
from rotorgear.results.response import LimitLine
from tests.paths import ROOT

MODEL = rg.load(ROOT / "models/split_torque.toml")
SPEEDS = ["8000 rpm", "9500 rpm", "11000 rpm", "15000 rpm"]
MESH_ORDER = "mesh stage_2a, stage_2b 1x"


def run_up(limits: Path | None = None) -> rg.ResponseResult:
    return rg.response(MODEL, speeds=SPEEDS, fmax=3000.0, modal_damping=0.02, elements=1, limits=limits)


@pytest.fixture(scope="module")
def plain() -> rg.ResponseResult:
    return run_up()


@pytest.fixture(scope="module")
def limited(tmp_path_factory: pytest.TempPathFactory) -> rg.ResponseResult:
    file = tmp_path_factory.mktemp("limits") / "targets.csv"
    file.write_text(
        "# of the test bench\nat;order;speed_rpm;rms [kN]\n"
        f"stage_2a;;9000;0.1\nmeshes.stage_2a;;13000;0.3\nstage_2a;{MESH_ORDER};0;50\nstage_2a;{MESH_ORDER};20000;50\n"
    )
    return run_up(file)


def test_a_line_is_straight_between_its_corners_and_holds_for_all_orders_together(
    plain: rg.ResponseResult, limited: rg.ResponseResult
) -> None:
    assert plain.limits == ()
    whole, single = limited.limits
    assert (whole.at, whole.order, whole.unit) == ("stage_2a", "", "N")
    size = np.abs(plain.mesh_force[:, :, plain.contacts_of("stage_2a")]).max(axis=2)
    total = np.sqrt((size**2).sum(axis=0))
    # 9500 rpm is an eighth of the way, 11000 rpm half of it, and the others lie outside of the line.
    allowed = np.sqrt(2.0) * np.array([125.0, 200.0])
    ratio = total[1:3] / allowed
    worst = int(np.argmax(ratio))
    assert whole.ratio == pytest.approx(ratio[worst])
    assert (whole.reached, whole.allowed) == pytest.approx((total[1 + worst], allowed[worst]))
    assert whole.worst_rpm == pytest.approx((9500.0, 11000.0)[worst])
    assert whole.level_db == pytest.approx(20.0 * np.log10(ratio[worst]))
    of_order = size[plain.orders.index(MESH_ORDER)] / (np.sqrt(2.0) * 5e4)
    assert single.ratio == pytest.approx(of_order.max())
    assert single.exceeded_rpm == 0.0


def test_the_range_above_a_limit_is_that_of_the_steps_beside_the_speeds(limited: rg.ResponseResult) -> None:
    line = limited.limits[0]
    total = np.sqrt((limited.amplitudes_of("stage_2a")[2] ** 2).sum(axis=0))
    above = total > line.over(limited.speed_rpm)
    # From the middle of the step before to the middle of that behind: of unequal steps numpy's derivative of the numbers.
    assert line.exceeded_rpm == pytest.approx(np.gradient(limited.speed_rpm)[above].sum())
    assert list(np.isnan(line.over(limited.speed_rpm))) == [True, False, False, True]


def test_a_level_counts_from_the_reference_of_its_quantity(tmp_path: Path, plain: rg.ResponseResult) -> None:
    (tmp_path / "l.csv").write_text("at,speed_rpm,level_dB\noutput_bearing_y,1000,120\noutput_bearing_y,20000,120\n")
    (line,) = run_up(tmp_path / "l.csv").limits
    assert line.unit == "m/s^2"
    assert line.amplitude == pytest.approx(np.sqrt(2.0))  # 120 dB re 1 um/s^2 are 1 m/s^2 of effective value
    total = np.sqrt((plain.amplitudes_of("output_bearing_y")[2] ** 2).sum(axis=0))
    assert line.ratio == pytest.approx(total.max() / np.sqrt(2.0))


def test_limits_are_saved_told_and_drawn(limited: rg.ResponseResult, tmp_path: Path) -> None:
    again = rg.read(rg.save(limited, tmp_path / "run_up.h5"))
    assert again.limits == limited.limits
    assert "limit of" in limited.text()
    assert limited.to_dict()["limits"][1]["order"] == MESH_ORDER
    left = rg.plot.response(limited)[0, 0]
    assert "limit of stage_2a" in [text.get_text() for text in left.get_legend().get_texts()]
    above = rg.plot.order_map(limited, at="stage_2a")[0]
    assert [line.get_label() for line in above.lines].count("limit") == 1
    over = limited.limits[0].ratio > 1.0
    marks = rg.plot.waterfall(limited, at="stage_2a").get_legend()
    assert (marks is not None) == over


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("at,speed_rpm,amplitude_N\nstage_2,1000,5\nstage_2,2000,5\n", "csv:2:at: got 'stage_2', expected a mesh.*stage_2a"),
        ("at,speed_rpm,amplitude_mm\nstage_2a,1000,5\nstage_2a,2000,5\n", "t.csv:2: got stage_2a,1000,5, expected a force"),
        ("at,speed_rpm,amplitude_N\nstage_2a,2000,5\nstage_2a,1000,5\n", "csv:3:speed_rpm: got 1000, expected speeds that"),
        ("at,speed_rpm,amplitude_N\nstage_2a,2000,-5\nstage_2a,3000,5\n", "t.csv:2: .*a limit above 0"),
        ("at,speed_rpm,amplitude_N\nstage_2a,2000,5\n", "one row of stage_2a, expected two rows or more"),
        ("at,speed_rpm,amplitude_N\nstage_2a,2000,x\nstage_2a,3000,5\n", "t.csv:2: got stage_2a,2000,x, expected"),
        ("at,speed_rpm,amplitude\nstage_2a,2000,1\nstage_2a,3000,5\n", "t.csv:1: expected columns at, speed_rpm and one"),
        ("at,speed_rpm\nstage_2a,2000\n", "t.csv:1: expected columns at, speed_rpm and one of"),
        ("at,speed_rpm,amplitude_N,colour\nstage_2a,2000,5,red\n", "t.csv:1:colour: unknown column"),
        ("at,speed_rpm,amplitude_N\nstage_2a,20000,5\nstage_2a,30000,5\n", "from 20000 to 30000 rpm; the run-up has no"),
        ("at,order,speed_rpm,amplitude_N\nstage_2a,mesh 1x,0,5\nstage_2a,mesh 1x,30000,5\n", "run-up has no order 'mesh 1x'"),
        ("", "t.csv: expected a table of limits"),
    ],
)  # fmt: skip
def test_mistakes_are_told_before_anything_is_computed(text: str, said: str, tmp_path: Path) -> None:
    (tmp_path / "t.csv").write_text(text)
    with pytest.raises((ModelError, rg.AnalysisError), match=said):
        run_up(tmp_path / "t.csv")


def test_a_limit_says_nothing_outside_of_its_corners() -> None:
    line = LimitLine("a", "", "N", np.array([100.0, 300.0]), np.array([1.0, 5.0]), 0.0, 0.0, 0.0, 0.0, 0.0)
    assert line.over(np.array([-200.0, 200.0])) == pytest.approx([3.0, 3.0])
    assert np.isnan(line.over(np.array([99.0, 301.0]))).all()
