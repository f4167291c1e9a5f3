"""Measured shapes, frequency responses and order cuts beside a model, on rigs whose truth is known."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

import rotorgear as rg
from rotorgear.analysis.rig.compare_shapes import phase_collinearity
from rotorgear.cli.main import app
from rotorgear.errors import AnalysisError, ModelError
from rotorgear.uff.datasets import Function, Shape
from rotorgear.uff.read import read_universal
from rotorgear.uff.write import function_set, nodes_set, shape_set, units_set
from tests.paths import MODELS
from validation.studies.rigs import draw, nominal


@pytest.fixture(scope="module")
def model():
    return nominal()


@pytest.fixture(scope="module")
def modes(model):
    return rg.modal(model, fmax=1100.0)


@pytest.fixture(scope="module")
def measured(model):
    return draw(model, 1).measured


def test_shapes_find_their_modes_where_chance_does_not(model, modes, measured):
    result = rg.compare_shapes(modes, measured, samples=50)
    right = [match.rig.label == f"true mode {match.mode_number}" for match in result.matches]
    assert np.mean(right) >= 0.9
    assert result.good > 10
    assert result.chance.expected < 2
    assert result.learnt_parameters > 5
    assert result.comac.min() > 0.8
    assert not result.doubts
    assert "evidence for the model" in result.text()


def test_shapes_of_the_model_itself_agree_entirely(modes, model):
    names = tuple(model.points)
    elastic = np.flatnonzero(~modes.rigid)[:12]
    shapes = np.array([[modes.point_amplitudes[name][k] for name in names] for k in elastic]) * 3.0j
    lines = tuple(rg.RigLine(float(modes.natural_frequency_hz[k])) for k in elastic)
    result = rg.compare_shapes(modes, rg.Measured(lines, names, shapes), samples=20)
    assert [match.mode_number for match in result.matches] == [k + 1 for k in elastic]
    for match in result.matches:
        assert match.mac == pytest.approx(1.0)
        assert match.phase_collinearity == pytest.approx(1.0)
        assert match.close_to or match.scale == pytest.approx(3.0)
    np.testing.assert_allclose(result.comac, 1.0)


def test_close_modes_are_compared_as_the_plane_that_they_span(modes, model):
    """Any mixture of two modes at the same frequency is a mode: its MAC is 1 and the principal angles are 0."""
    hz = modes.natural_frequency_hz
    near = int(np.argmin(np.diff(np.log(hz[~modes.rigid])))) + int(np.count_nonzero(modes.rigid))
    pair = [near, near + 1]
    names = tuple(model.points)
    own = np.array([[modes.point_amplitudes[name][k] for name in names] for k in pair])
    turned = np.array([[0.6, 0.8], [-0.8, 0.6]]) @ own
    lines = tuple(rg.RigLine(float(hz[k])) for k in pair)
    result = rg.compare_shapes(modes, rg.Measured(lines, names, turned), samples=5)
    (group,) = result.subspaces
    assert set(group.mode_numbers) >= {near + 1, near + 2}
    np.testing.assert_allclose(group.angles, 0.0, atol=1e-6)
    assert all(match.mac == pytest.approx(1.0) and match.close_to for match in result.matches)


@pytest.mark.parametrize(
    ("change", "words"),
    [("sign", "look the other way"), ("exchange", "exchanged with"), ("turn", "look along -z")],
)
def test_sensors_that_are_wired_or_turned_otherwise_are_named(model, modes, measured, change, words):
    shapes = measured.shapes.copy()
    names = list(measured.points)
    guilty = "output_left_x"
    k = names.index(guilty)
    if change == "sign":
        shapes[:, k] *= -1.0
    elif change == "exchange":
        other = names.index("input_right_y")
        shapes[:, [k, other]] = shapes[:, [other, k]]
    else:
        # The table says x, and the sensor looks along -z: the true shape there.
        true = draw(model.with_("points.output_left_x.direction", "z"), 1).measured.shapes
        shapes[:, k] = -true[:, k]
    result = rg.compare_shapes(modes, replace(measured, shapes=shapes), samples=5)
    assert result.doubts
    assert words in result.doubts[0].what
    assert guilty in (result.doubts[0].point, *result.doubts[0].what.split())
    assert result.doubts[0].mac_after > result.doubts[0].mac_before
    assert guilty in result.text().replace("\n", " ")


def test_too_few_sensors_are_said_with_the_modes_that_they_confuse(modes, measured):
    few = rg.Measured(measured.lines, measured.points[:2], measured.shapes[:, :2])
    result = rg.compare_shapes(modes, few, samples=5)
    assert any("Too few sensors to tell modes" in sentence for sentence in result.verdicts)


def test_phase_collinearity_is_one_in_phase_and_nothing_on_a_circle():
    assert phase_collinearity(np.exp(0.7j) * np.array([1.0, -2.0, 3.0, np.nan])) == pytest.approx(1.0)
    assert phase_collinearity(np.exp(2j * np.pi * np.arange(5) / 5)) == pytest.approx(0.0, abs=1e-15)


def test_nodes_without_a_table_stand_at_the_nearest_place(tmp_path):
    model = rg.load(MODELS / "geared_pair.toml")
    result = rg.modal(model, modes=6, elements=2)
    file = rg.write_uff(result, tmp_path / "rig.uff", modes=range(1, 6))
    found = rg.compare_shapes(result, file, samples=5)
    assert "gears.pinion:x" in found.points
    assert np.nanmin(found.distance) == pytest.approx(0.0, abs=1e-6)
    assert all(match.mac > 1 - 1e-9 for match in found.matches)
    text = file.read_text().replace("         1  SI: Meter (newton)", "         9  SI: Meter (newton)")
    file.write_text(text.replace("1.0000000000000000D+00", "1.0000000000000000D-03"))
    with pytest.raises(AnalysisError, match="correct its units"):
        rg.compare_shapes(result, file, samples=5)


def test_responses_of_the_model_itself_have_a_frac_of_one_and_swapped_signs_are_named(tmp_path):
    model = rg.load(MODELS / "geared_pair.toml")
    places = {"inputs": ["gears.pinion:x"], "outputs": ["gears.wheel:y", "gears.pinion:x"]}
    own = rg.frf(model, **places, fmax=60.0, points=40, elements=1, modal_damping=0.02)
    file = rg.write_uff(own, tmp_path / "rig.uff", binary=True)
    found = rg.compare_frf(model, file, elements=1, modal_damping=0.02)
    for pair in found.pairs:
        assert pair.frac == pytest.approx(1.0, abs=1e-9)
        assert pair.ratio == pytest.approx(1.0, abs=1e-6)
    table = tmp_path / "sensors.csv"
    table.write_text("point,node,direction\ngears.pinion,1,x\ngears.wheel,2,-y\n")
    signs = rg.compare_frf(model, file, points=table, elements=1, modal_damping=0.02)
    assert any("opposite sign" in sentence and "gears.wheel:y" in sentence for sentence in signs.verdicts)


@pytest.mark.parametrize(
    ("wound", "text"),
    [
        ({"denominator": 12}, "transmissibility"),
        ({"x_type": 19}, "axis of type 19"),
        ({"numerator": 13}, "type 13"),
        ({"reference": (0, 0)}, "between two sensors"),
    ],
)
def test_functions_that_are_no_motion_over_force_are_refused(tmp_path, wound, text):
    good = Function(4, (1, 1), (2, 2), np.array([1.0, 2.0]), np.array([2.0 + 1j, 1.0]), 18, 12, 13)
    (tmp_path / "rig.uff").write_bytes(function_set(replace(good, **wound)))
    (tmp_path / "sensors.csv").write_text("point,node,direction\ngears.pinion,1,x\ngears.wheel,2,y\n")
    with pytest.raises(AnalysisError, match=text):
        rg.read_rig_frf(tmp_path / "rig.uff", tmp_path / "sensors.csv")


def test_a_response_without_type_and_unit_is_refused_with_the_option_that_names_it(tmp_path):
    told = Function(4, (1, 1), (2, 2), np.array([1.0, 2.0]), np.array([2.0 + 1j, 1.0]), 18, 12, 13)
    table = tmp_path / "sensors.csv"
    table.write_text("point,node,direction\ngears.pinion,1,x\ngears.wheel,2,y\n")
    (tmp_path / "told.uff").write_bytes(function_set(told))
    (tmp_path / "untold.uff").write_bytes(function_set(replace(told, numerator=0, denominator=0)))
    with pytest.raises(AnalysisError, match=r"--frf-motion displacement \| velocity \| acceleration"):
        rg.read_rig_frf(tmp_path / "untold.uff", table)
    with pytest.raises(AnalysisError, match="one of displacement, velocity, acceleration; got 'jerk'"):
        rg.read_rig_frf(tmp_path / "untold.uff", table, motion="jerk")
    expected = rg.read_rig_frf(tmp_path / "told.uff", table).receptance
    found = rg.read_rig_frf(tmp_path / "untold.uff", table, motion="acceleration")
    np.testing.assert_allclose(found.receptance, expected, rtol=1e-12)
    assert any("taken as acceleration" in note for note in found.notes)
    model = rg.load(MODELS / "geared_pair.toml")
    with pytest.raises(AnalysisError, match="give it with --frf"):
        rg.update(model, [20.0], frf_motion="velocity")
    with pytest.raises(AnalysisError, match="give it with --frf"):
        rg.compare_frf(model, found, frf_motion="velocity")


def test_a_shape_that_moves_nowhere_is_a_line_without_shape(tmp_path):
    model = rg.load(MODELS / "geared_pair.toml")
    result = rg.modal(model, modes=6, elements=2)
    file = rg.write_uff(result, tmp_path / "rig.uff", modes=range(1, 6))
    sets = read_universal(file)
    shapes = [replace(shape, values=shape.values * (k > 0)) for k, shape in enumerate(sets.shapes)]
    file.write_bytes(b"".join([units_set(sets.units), nodes_set(sets.nodes), *map(shape_set, shapes)]))
    found = rg.compare_shapes(result, file, samples=5)
    assert any("taken as a line without shape" in note for note in found.warnings)
    assert np.isnan(found.matches[0].mac)
    assert "nan" not in found.text()
    assert min(match.mac for match in found.matches[1:]) > 1 - 1e-9


def test_order_cuts_come_back_from_csv_and_from_a_universal_file(tmp_path):
    point = {"left": {"on": "bearings.input_left", "direction": "y"}}
    model = rg.load(MODELS / "split_torque.toml").with_("points", point)
    run = rg.response(model, points=7, start="1000 rpm", stop="3000 rpm", elements=1, modal_damping=0.02)
    settings = {"modal_damping": 0.02, "elements": 1}
    uff = rg.write_uff(run, tmp_path / "run.uff")
    node = run.nodes.nearest(*model.layout.place("points.left")) + 1
    (tmp_path / "sensors.csv").write_text(f"point,node,direction\nleft,{node},y\n")
    found = rg.compare_orders(model, uff, points=tmp_path / "sensors.csv", **settings)
    assert len(found.cuts) == len(run.orders)
    rows = [f"{rpm},{run.ratio[0]},{abs(run.acceleration[0, k, 0])}" for k, rpm in enumerate(run.speed_rpm)]
    (tmp_path / "cuts.csv").write_text("\n".join(["speed_rpm,order,left", *rows, "1500,999,1"]))
    again = rg.compare_orders(model, tmp_path / "cuts.csv", **settings)
    for cut in (*found.cuts, *again.cuts):
        assert cut.level_db == pytest.approx(0.0, abs=0.1)
        assert cut.rig_peak_rpm == pytest.approx(cut.model_peak_rpm, rel=1e-4)
    assert again.without == ("999 at left",)
    (tmp_path / "cuts.csv").write_text("speed_rpm,order,left\n1000,one,2\n")
    with pytest.raises(ModelError, match=r"cuts\.csv:2"):
        rg.compare_orders(model, tmp_path / "cuts.csv")


def test_the_command_compares_shapes_and_asks_for_one_measurement(tmp_path, measured):
    sets = []
    for line, shape in zip(measured.lines, measured.shapes, strict=True):
        values = np.zeros((12, 3))
        values[:, 0] = shape.real
        sets.append(shape_set(Shape(line.frequency_hz, 0.01, None, np.arange(1, 13), values)))
    (tmp_path / "rig.uff").write_bytes(b"".join(sets))
    rows = [f"{name},{k},x" for k, name in enumerate(measured.points, start=1)]
    (tmp_path / "sensors.csv").write_text("\n".join(["point,node,direction", *rows]))
    points = "\n".join(
        f'[points.{name}]\non = "{part.on}"\ndirection = "{part.direction}"' for name, part in nominal().points.items()
    )
    (tmp_path / "model.toml").write_text((MODELS / "split_torque.toml").read_text() + "\n" + points)
    arguments = ["compare", str(tmp_path / "model.toml"), "--shapes", str(tmp_path / "rig.uff")]
    arguments += ["--points", str(tmp_path / "sensors.csv"), "--json", str(tmp_path / "out.json")]
    done = CliRunner().invoke(app, [*arguments, "--plot", str(tmp_path / "mac.png")])
    assert done.exit_code == 0, done.output
    data = json.loads((tmp_path / "out.json").read_text())
    assert data["learnt_parameters"] > 5
    assert np.shape(data["mac"])[0] == 20
    refused = CliRunner().invoke(app, ["compare", str(MODELS / "geared_pair.toml")])
    assert isinstance(refused.exception, AnalysisError)
