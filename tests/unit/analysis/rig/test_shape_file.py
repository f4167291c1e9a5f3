"""Universal files with measured shapes: as pyuff writes them, and broken in the ways they come."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.errors import AnalysisError, ModelError

pyuff = pytest.importorskip("pyuff")

SENSORS = "point,node,direction\n# looks down\ntop,7,-y\nside,9,x\n"


def shape(frequency, values, **changes):
    """A dataset 55 of nodes 7 and 9; `values` (2, 3) along x y z."""
    values = np.asarray(values)
    given = {
        "model_type": 1,
        "analysis_type": 2,
        "data_ch": 2,
        "spec_data_type": 8,
        "data_type": 2,
        "n_data_per_node": 3,
        "r1": values[:, 0],
        "r2": values[:, 1],
        "r3": values[:, 2],
        "node_nums": [7, 9],
        "mode_n": 1,
        "freq": frequency,
        "modal_m": 1,
        "modal_damp_vis": 0.02,
        "modal_damp_his": 0.0,
        "load_case": 1,
        **{f"id{k}": "none" for k in range(1, 6)},
    }
    return pyuff.prepare_55(**given | changes)


def written(folder, *sets):
    file = folder / "rig.uff"
    pyuff.UFF(str(file)).write_sets(list(sets), "overwrite")
    (folder / "sensors.csv").write_text(SENSORS)
    return file, folder / "sensors.csv"


def test_shapes_come_with_frequency_damping_and_the_signs_of_the_sensors(tmp_path):
    measured = rg.read_rig_shapes(
        *written(tmp_path, shape(120.0, [[1, 2, 3], [4, 5, 6]]), shape(250.0, [[0, 1, 0], [-1, 0, 0]]))
    )
    assert [line.frequency_hz for line in measured.lines] == [120.0, 250.0]
    assert measured.lines[0].damping_ratio == pytest.approx(0.02)
    assert measured.points == ("top", "side")
    np.testing.assert_allclose(measured.shapes, [[-2, 4], [-1, -1]])


def test_complex_shapes_take_frequency_and_damping_from_their_eigenvalue(tmp_path):
    eigenvalue = complex(-10.0, 800.0)
    values = np.array([[1, 2j, 0], [3, 0, 0]], dtype=complex)
    data = shape(
        0.0, values, analysis_type=3, data_type=5, eig=eigenvalue, modal_a=complex(1), modal_b=complex(1), freq=None
    )
    (line,) = (measured := rg.read_rig_shapes(*written(tmp_path, data))).lines
    assert line.frequency_hz == pytest.approx(abs(eigenvalue) / (2 * np.pi), rel=1e-5)
    assert line.damping_ratio == pytest.approx(10.0 / abs(eigenvalue), rel=1e-4)
    np.testing.assert_allclose(measured.shapes, [[-2j, 3]])


@pytest.mark.parametrize(
    ("sensors", "text"),
    [
        ("point,node\na,1\n", "columns point, node, direction"),
        ("point,node,direction\ntop,seven,x\n", "number of a node"),
        ("point,node,direction\ntop,7,w\n", "x, y, z, rx, ry, rz"),
        ("point,node,direction\ntop,7,x\ntop,9,x\n", "every point once"),
        ("point,node,direction\ntop,8,x\n", "node that some shape"),
        ("point,node,direction\n", "a row for each sensor"),
        ("", "header row"),
    ],
)
def test_a_table_of_sensors_that_makes_no_sense_is_refused_with_its_line(tmp_path, sensors, text):
    file, table = written(tmp_path, shape(120.0, [[1, 2, 3], [4, 5, 6]]))
    table.write_text(sensors)
    with pytest.raises(ModelError, match=text):
        rg.read_rig_shapes(file, table)


def test_files_that_are_cut_or_empty_or_have_no_shapes_get_a_sentence(tmp_path):
    file, table = written(tmp_path, shape(120.0, [[1, 2, 3], [4, 5, 6]]))
    whole = file.read_text()
    for text in ("", "nothing like it\n", whole[: len(whole) // 2]):
        file.write_text(text)
        with pytest.raises((ModelError, AnalysisError)):
            rg.read_rig_shapes(file, table)
    units = pyuff.prepare_164(
        units_code=1, units_description="SI", temp_mode=1, length=1.0, force=1.0, temp=1.0, temp_offset=0.0
    )
    with pytest.raises(AnalysisError, match="no mode shapes"):
        rg.read_rig_shapes(*written(tmp_path, units))
    with pytest.raises(AnalysisError, match="positive one"):
        rg.read_rig_shapes(*written(tmp_path, shape(0.0, [[1, 2, 3], [4, 5, 6]])))
    with pytest.raises(ModelError, match="no such file"):
        rg.read_rig_shapes(tmp_path / "none.uff", table)
