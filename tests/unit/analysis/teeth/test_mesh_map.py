"""A mesh over torque and misalignment: each point is that of a mesh by itself, and what can't be is refused."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import rotorgear as rg
from rotorgear.cli.main import app
from rotorgear.cli.options import axes_of
from tests.models import pair_file

PREVIEW = 'stiffness = "tooth_fe"\ntooth_fe = { preset = "preview" }'


def test_a_point_of_the_map_is_the_mesh_at_its_torque_and_misalignment() -> None:
    found = rg.mesh_map(
        rg.loads(pair_file(20.86, "herringbone", mesh=PREVIEW)),
        over={"torque": ["800 N m", 400.0], "misalignment": ["15 um", 0.0]},
        positions=12,
    )
    assert found.pinion_torque == pytest.approx([400.0, 800.0])
    askew = rg.loads(pair_file(20.86, "herringbone", mesh=f'{PREVIEW}\nmisalignment = "15 um"'))
    alone = rg.mesh(askew, torque=800.0, positions=12, estimate=False)
    orders = alone.ste_harmonics(3)
    assert orders is not None
    assert found.ste_peak_to_peak[1, 1] == pytest.approx(alone.ste_peak_to_peak, rel=1e-12)
    assert found.ste_harmonics[1, 1] == pytest.approx(abs(orders), rel=1e-9)
    assert found.largest_pressure[1, 1] == pytest.approx(max(item.pressure.max() for item in alone.helix), rel=1e-12)
    assert found.mean_stiffness[1, 1] == pytest.approx(alone.mean_stiffness, rel=1e-12)


def test_the_face_load_factor_is_that_of_a_line_of_springs_where_teeth_stand_askew() -> None:
    """Uncoupled slices of spur teeth: with the whole face in contact K_Hbeta - 1 is the share of the end in the load, which
    grows in proportion to the misalignment, and less than a line of springs of the stiffness without load along it says."""
    model = rg.loads(pair_file(mesh=PREVIEW))
    misalignment = np.array([-8e-6, -4e-6, 0.0, 4e-6, 8e-6])
    found = rg.mesh_map(model, over={"torque": 2000.0, "misalignment": misalignment}, positions=16)
    factor = found.face_load_factor[0]
    assert factor[2] == pytest.approx(1.0, rel=1e-6)
    assert factor == pytest.approx(factor[::-1], rel=1e-9)
    assert (factor[4] - 1.0) / (factor[3] - 1.0) == pytest.approx(2.0, rel=0.03)
    # ISO 6336-1: 1 + k f/(2 F) with the tangent stiffness of the whole face, places being those of the middles of 32 stretches.
    teeth = rg.mesh(model, torque=2000.0, positions=16, estimate=False)
    assert teeth.load is not None
    assert teeth.mean_tangent_stiffness is not None
    line = 0.5 * teeth.mean_tangent_stiffness * 4e-6 / teeth.load.base_force_n * 31.0 / 32.0
    assert factor[3] - 1.0 == pytest.approx(line, rel=0.03)


def test_the_command_writes_table_and_picture(tmp_path: Path) -> None:
    file = tmp_path / "pair.toml"
    file.write_text(pair_file(mesh=PREVIEW))
    table = tmp_path / "map.csv"
    picture = tmp_path / "map.png"
    asked = ["mesh-map", str(file), "--over", "torque=500 N m:1000 N m:2", "--positions", "8"]
    done = CliRunner().invoke(app, [*asked, "--csv", str(table), "--plot", str(picture)], env={"COLUMNS": "80"})
    assert done.exit_code == 0, done.output
    assert max(map(len, done.output.splitlines())) <= 80 + len(str(tmp_path))
    rows = list(csv.DictReader(table.open()))
    assert [float(row["pinion_torque_n_m"]) for row in rows] == [500.0, 1000.0]
    assert picture.stat().st_size > 0


def test_ranges_and_lists_of_values_are_read_with_their_units() -> None:
    assert axes_of(["torque=1 kN m:2000 N m:3"])["torque"] == pytest.approx([1000.0, 1500.0, 2000.0])
    both = axes_of(["torque=500 N m:600 N m,misalignment=-5 um:0 um:9 um"])
    assert both["torque"] == pytest.approx([500.0, 600.0])
    assert both["misalignment"] == pytest.approx([-5e-6, 0.0, 9e-6])


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--over", "speed=1 rpm"], "expected torque=... or misalignment=..."),
        (["--over", "torque=fast"], "--over torque: got 'fast'"),
        (["--over", "torque=1 N m:2 N m:1"], "expected 2 to 1000"),
        (["--over", "torque=-100 N m:100 N m:2"], "one sense"),
        (["--over", "torque=0 N m"], "one sense|not zero"),
        (["--over", "torque=100 N m", "--over", "torque=200 N m"], "given twice"),
    ],
)
def test_what_cannot_be_is_refused(tmp_path: Path, arguments: list[str], said: str) -> None:
    file = tmp_path / "pair.toml"
    file.write_text(pair_file(mesh=PREVIEW))
    done = CliRunner().invoke(app, ["mesh-map", str(file), *arguments], env={"COLUMNS": "200"})
    assert isinstance(done.exception, rg.AnalysisError)
    assert any(text in str(done.exception) for text in said.split("|"))
