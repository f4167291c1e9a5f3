"""Stress in tooth roots: nominal stress by hand, symmetry, proportion to the load, and the beam with its notch of ISO 6336-3."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import rotorgear as rg
from rotorgear.cli.main import app
from rotorgear.gears.geometry.outline import root_section, tangent_angle, tooth_outline
from tests.models import pair_file
from tests.unit.gears.tooth_pairs import spur

PREVIEW = 'stiffness = "tooth_fe"\ntooth_fe = { preset = "preview" }'


def test_the_tangent_of_the_section_makes_thirty_degrees_by_points_of_the_fillet() -> None:
    outline = tooth_outline(spur().first)
    section = root_section(outline)
    assert tangent_angle(outline, section.share) == pytest.approx(math.radians(30.0), abs=1e-9)
    radius, angle = outline.fillet(section.share + np.array([-1e-3, 0.0, 1e-3]))
    x = radius * np.sin(angle)
    y = radius * np.cos(angle)
    assert math.degrees(math.atan2(x[2] - x[0], y[0] - y[2])) == pytest.approx(30.0, abs=0.05)
    assert section.thickness == pytest.approx(2.0 * x[1], rel=1e-9)
    # The trochoid of a rack is flatter than the rack's own tip.
    assert section.curvature_radius > outline.geometry.tool_tip_radius_factor * outline.geometry.normal_module


def test_the_nominal_stress_is_the_product_of_the_factors_of_the_standard() -> None:
    """sigma = F_t/(b m) Y_F Y_S with F_t = F_bt cos alpha, factors by hand from the section."""
    outline = tooth_outline(spur().first)
    section = root_section(outline)
    g = outline.geometry
    roll = outline.tip_roll_length
    direction = math.tan(math.acos(g.base_radius / outline.tip_radius)) - outline.base_half_angle
    arm = g.base_radius / math.cos(direction) - math.sqrt(section.radius**2 - (0.5 * section.thickness) ** 2)
    m = g.normal_module
    alpha = g.normal_pressure_angle
    form = 6.0 * (arm / m) * math.cos(direction) / ((section.thickness / m) ** 2 * math.cos(alpha))
    slender = section.thickness / arm
    stress = (1.2 + 0.13 * slender) * (section.thickness / (2.0 * section.curvature_radius)) ** (
        1.0 / (1.21 + 2.3 / slender)
    )
    line_load = 200e3
    wanted = line_load * math.cos(alpha) / m * form * stress
    assert section.nominal_stress(line_load, roll) == pytest.approx(wanted, rel=1e-12)


def test_teeth_at_light_load_come_near_to_the_beam_with_its_notch_and_grow_with_the_load() -> None:
    """One pair carries all between B and D, and positions stand there: tooth and beam agree within a tenth."""
    model = rg.loads(pair_file(mesh=PREVIEW))
    light = rg.root_stress(model, torque=20.0, positions=12)
    twice = rg.root_stress(model, torque=40.0, positions=12)
    for gear, more in zip(light.gears, twice.gears, strict=True):
        assert gear.nominal is not None
        assert 0.9 < gear.worst_at_tangent / gear.nominal < 1.05
        assert gear.worst >= gear.worst_at_tangent
        # Shares between two pairs hardly depend on a light load, and single contact not at all.
        assert more.worst_at_tangent == pytest.approx(2.0 * gear.worst_at_tangent, rel=0.02)
        # The tooth is loaded a whole path of contact long, and pulls at its neighbours before and after.
        assert gear.phase.min() < -1.0
        assert gear.phase.max() > 1.0


def test_equal_gears_have_equal_roots_as_one_comes_and_the_other_goes() -> None:
    text = pair_file(mesh=PREVIEW).replace("teeth = 80", "teeth = 34").replace("285.0 mm", "170.0 mm")
    found = rg.root_stress(rg.loads(text), torque=20.0, positions=8)
    first, second = found.gears
    # What the pinion has at u the other has at -u.
    mirrored = np.interp(-first.phase, second.phase, second.at_tangent)
    inside = np.abs(first.phase) < 1.0
    assert first.at_tangent[inside] == pytest.approx(mirrored[inside], rel=1e-3)


def test_what_cannot_be_is_refused_and_the_command_draws(tmp_path: Path) -> None:
    with pytest.raises(rg.AnalysisError, match="4 to 256"):
        rg.root_stress(rg.loads(pair_file()), positions=2)
    with pytest.raises(rg.AnalysisError, match="no roots to show"):
        rg.root_stress(rg.loads(pair_file(20.86, "helical", mesh=PREVIEW)))
    file = tmp_path / "pair.toml"
    file.write_text(pair_file(mesh=PREVIEW))
    picture = tmp_path / "roots.png"
    asked = ["root-stress", str(file), "--positions", "4", "--plot", str(picture)]
    done = CliRunner().invoke(app, asked, env={"COLUMNS": "80"})
    assert done.exit_code == 0, done.output
    assert "at the root section, MPa" in done.output
    assert picture.stat().st_size > 3000
