"""Pictures and VTK files of statics and forced response: what a model has is drawn, whatever it has not."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import rotorgear as rg
from rotorgear.cli.main import app
from tests.paths import ROOT

GEARBOX = ROOT / "models" / "split_torque.toml"


@pytest.fixture(scope="module")
def run_up() -> rg.ResponseResult:
    return rg.response(rg.load(GEARBOX), speeds=[900.0, 1300.0, 1712.0], fmax=3000.0, modal_damping=0.02, elements=1)


@pytest.fixture(scope="module")
def lone_rotor() -> rg.ResponseResult:
    """Neither mesh nor bearing nor point."""
    data = tomllib.loads(
        (ROOT / "validation" / "cases" / "jeffcott_rotor" / "unbalanced.toml").read_text(encoding="utf-8")
    )
    return rg.response(rg.Model(**{**data, "points": {}}), speeds=[50.0, 90.0, 120.0], elements=1)


def test_a_run_up_is_drawn_in_every_format(run_up: rg.ResponseResult, tmp_path: Path) -> None:
    for draw, endings in ((rg.plot.response, ("png", "svg")), (rg.plot.waterfall, ("pdf",))):
        axes = draw(run_up)
        for ending in endings:
            assert rg.plot.save(axes, tmp_path / f"picture.{ending}").stat().st_size > 3000


def test_a_rotor_without_meshes_bearings_and_points_is_drawn_by_its_displacement(
    lone_rotor: rg.ResponseResult, tmp_path: Path
) -> None:
    assert rg.plot.save(rg.plot.response(lone_rotor), tmp_path / "rotor.png").exists()
    with pytest.raises(rg.AnalysisError, match="no mesh, bearing or point"):
        rg.plot.waterfall(lone_rotor)


def test_a_waterfall_names_its_quantity(run_up: rg.ResponseResult) -> None:
    title, unit, size = run_up.amplitudes_of("bearings.output_left")
    assert (title, unit) == ("force of bearing output_left (root of the sum of squares of x, y, z)", "N")
    own = run_up.bearing_force[:, :, run_up.bearings.index("output_left")]
    assert size == pytest.approx(np.sqrt((np.abs(own) ** 2).sum(axis=2)))
    assert run_up.amplitudes_of("output_bearing_y")[1] == "m/s^2"
    assert run_up.amplitudes_of()[0] == f"dynamic force of mesh {max(run_up.peaks(), key=lambda row: row[4])[0]}"
    with pytest.raises(rg.AnalysisError, match="stage_1a"):
        run_up.amplitudes_of("nowhere")


def test_a_waterfall_draws_the_highest_peak_of_all_speeds(run_up: rg.ResponseResult) -> None:
    # A peak at one of a hundred speeds, of which every third is drawn.
    force = np.repeat(run_up.mesh_force[:, :1], 100, axis=1)
    force[:, 51] *= 9.0
    wide = replace(run_up, speeds=np.linspace(900.0, 1712.0, 100), mesh_force=force)
    title = rg.plot.waterfall(wide).get_title() or rg.plot.waterfall(wide).figure.get_suptitle()
    assert f"highest peak {np.abs(force).max():.4g} N at {wide.speed_rpm[51]:.0f} rpm" in title


def test_the_table_of_a_run_up_names_the_axis_of_a_bearing_force(run_up: rg.ResponseResult) -> None:
    for peak in run_up.largest:
        if peak.quantity == "bearing force":
            own = np.abs(run_up.bearing_force[:, :, run_up.bearings.index(peak.part)])
            assert own[..., "xyz".index(peak.axis)].max() == pytest.approx(own.max()) == pytest.approx(peak.amplitude)
            assert f"{peak.part} {peak.axis} " in str(run_up)
    assert {peak.axis for peak in run_up.largest if peak.quantity == "mesh force"} == {""}


def test_a_wrong_ending_is_refused_and_leaves_nothing(run_up: rg.ResponseResult, tmp_path: Path) -> None:
    with pytest.raises(rg.AnalysisError, match="PNG"):
        rg.plot.save(rg.plot.response(run_up), tmp_path / "picture.txt")
    assert not list(tmp_path.iterdir())


def test_statics_and_frequency_responses_are_drawn(tmp_path: Path) -> None:
    model = rg.load(GEARBOX)
    assert rg.plot.save(rg.plot.static(rg.static(model)), tmp_path / "static.png").exists()
    result = rg.frf(model, [10.0, 20.0, 30.0], inputs=["gears.bull:y"], outputs=["output_bearing_y"], elements=1)
    assert rg.plot.save(rg.plot.frf(result, quantity="mobility"), tmp_path / "frf.svg").exists()


def test_operating_deflections_in_vtk_are_those_of_the_result(run_up: rg.ResponseResult, tmp_path: Path) -> None:
    pv = pytest.importorskip("pyvista")
    written = rg.write_deflections(run_up, tmp_path)
    assert {path.name for path in written} >= {"order_01.vtp", "order_01.pvd"}
    mesh = pv.read(tmp_path / "order_03.vtp")
    assert str(mesh.field_data["order"][0]) == run_up.orders[2]
    shown = mesh.point_data["displacement_real"] + 1j * mesh.point_data["displacement_imag"]
    true = mesh.point_data["displacement_real_m"] + 1j * mesh.point_data["displacement_imag_m"]
    scale = float(mesh.field_data["displacement_scale"][0])
    assert shown == pytest.approx(scale * true, rel=1e-4, abs=1e-5 * float(np.abs(shown).max()))
    nodes = np.abs(run_up.shapes[:, :3, 2]).max()
    assert 0.5 * nodes < np.abs(true).max() < 5.0 * nodes


def test_the_static_deflection_in_vtk_is_true_in_metres(tmp_path: Path) -> None:
    pv = pytest.importorskip("pyvista")
    result = rg.static(rg.load(GEARBOX))
    rg.write_deflections(result, tmp_path)
    mesh = pv.read(tmp_path / "static.vtp")
    largest = float(np.linalg.norm(mesh.point_data["displacement_m"], axis=1).max())
    turned = float(np.abs(result.displacement[:, 3:]).max())
    assert largest >= 0.9 * float(np.linalg.norm(result.displacement[:, :3], axis=1).max())
    assert (
        largest <= float(np.linalg.norm(result.displacement[:, :3], axis=1).max()) + turned * 0.4
    )  # the bull gear's radius


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["response", str(GEARBOX), "--points", "0"], "the number of points must be at least 1, got 0"),
        (["response", str(GEARBOX), "--from", "10 mm"], "--from: got"),
        (["response", str(GEARBOX), "--from", "0", "--points", "2"], "none of them 0"),
        (["response", str(ROOT / "models" / "geared_pair.toml"), "--points", "2"], "nothing excites"),
        (["frf", str(GEARBOX), "--inputs", "x", "--outputs", "y", "--fmax", "10"], "'x' is no place"),
        (
            ["frf", str(GEARBOX), "--inputs", "output_bearing_y", "--outputs", "output_bearing_y", "--fmax", "-1"],
            "fmin < fmax",
        ),
        (
            [
                "frf",
                str(GEARBOX),
                "--inputs",
                "output_bearing_y",
                "--outputs",
                "output_bearing_y",
                "--fmax",
                "9",
                "--quantity",
                "x",
            ],
            "receptance",
        ),
        (["static", str(GEARBOX), "--elements", "0"], "at least 1"),
    ],
)
def test_a_slip_on_the_command_line_gets_a_sentence(arguments: list[str], words: str) -> None:
    run = CliRunner().invoke(app, arguments)
    assert isinstance(run.exception, rg.RotorgearError)
    assert words in str(run.exception)
    assert "\n" not in str(run.exception)


def test_statics_of_points_alone_have_a_picture_that_says_so() -> None:
    twist = {name: {"shaft": name, "at": "start", "moment": [0.0, 0.0, m]} for name, m in (("one", 5.0), ("two", -5.0))}
    chain = rg.load(ROOT / "models" / "torsion_chain.toml").with_({"loads": twist})
    (axis,) = rg.plot.static(rg.static(chain))
    assert [text.get_text() for text in axis.texts] == ["no meshes, no bearings, and no shaft with a length"]


def test_an_order_map_has_the_levels_of_the_orders_and_of_all_together(run_up: rg.ResponseResult) -> None:
    _, _, size = run_up.amplitudes_of("stage_2a")
    above, axis, by_order = rg.plot.order_map(run_up, at="stage_2a")
    rms = size / np.sqrt(2.0)
    assert np.allclose(above.lines[0].get_ydata(), 20.0 * np.log10(np.sqrt((rms**2).sum(axis=0)) / 1e-6))
    (lines,) = (one for one in axis.collections if hasattr(one, "get_segments") and len(one.get_segments()))
    assert lines.get_clim()[1] == pytest.approx(20.0 * np.log10(rms.max() / 1e-6))
    # Each piece lies on the ray of its order: its level is the mean of those at its ends.
    order, at = np.unravel_index(int(np.argmax(size)), size.shape)
    level = 20.0 * np.log10(rms / 1e-6)
    found = [
        value
        for value, piece in zip(lines.get_array(), lines.get_segments(), strict=True)
        if np.any(np.all(np.isclose(piece, (abs(run_up.speed_rpm[at]), run_up.frequency_hz[order, at])), axis=1))
    ]
    near = [0.5 * (level[order, at] + level[order, k]) for k in (at - 1, at + 1) if 0 <= k < size.shape[1]]
    assert sorted(found) == pytest.approx(sorted(near))
    assert any("re 1 uN" in one.get_ylabel() for one in axis.figure.axes)
    # By order they are level lines at the ratios to the input shaft.
    (level_lines,) = (one for one in by_order.collections if hasattr(one, "get_segments") and len(one.get_segments()))
    heights = {round(float(piece[0, 1]), 6) for piece in level_lines.get_segments()}
    assert heights == {round(float(ratio), 6) for ratio in run_up.ratio}
    with pytest.raises(rg.AnalysisError, match="no mesh, bearing or point"):
        rg.plot.order_map(run_up, at="nowhere")
