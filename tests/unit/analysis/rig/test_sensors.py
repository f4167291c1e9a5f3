"""Places of sensors before the test is made."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.rig.sensors import best_rows, independence
from rotorgear.errors import AnalysisError
from tests.paths import MODELS


def test_shares_add_up_to_the_rank_and_repeated_rows_share_theirs():
    shapes = np.random.default_rng(1).standard_normal((9, 4))
    assert independence(shapes).sum() == pytest.approx(4.0)
    twice = np.array([[1.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    np.testing.assert_allclose(independence(twice), [0.5, 0.5, 1.0])


def test_the_rows_kept_are_near_the_best_of_all_sets():
    """Against every set of rows: the determinant of the normed Phi^T Phi that is kept is of the largest ones."""
    shapes = np.random.default_rng(2).standard_normal((10, 3))
    unit = shapes / np.linalg.norm(shapes, axis=0)

    def size(rows):
        return np.linalg.det(unit[list(rows)].T @ unit[list(rows)])

    every = np.array([size(rows) for rows in combinations(range(10), 4)])
    assert np.mean(every > size(best_rows(shapes, 4))) < 0.05


def test_planned_sensors_tell_modes_apart_that_random_ones_do_not(tmp_path):
    model = rg.load(MODELS / "split_torque.toml")
    plan = rg.sensors(model, count=12)
    assert len(plan.sensors) == 12
    assert plan.worst < 0.3
    assert not plan.confused
    few = rg.sensors(model, count=3, modes=8, candidates="bearings.*", directions="xy")
    assert {sensor.direction for sensor in few.sensors} <= {"x", "y"}
    assert all(sensor.place.startswith("bearings.") for sensor in few.sensors)
    assert any("Too few sensors" in sentence for sentence in few.confused) == (few.worst > 0.9)
    # The table is read by the comparison: shapes of the model at these places are found as they are.
    table = rg.write_sensors(plan, tmp_path / "sensors.csv")
    modes = rg.modal(model, fmax=300.0)
    result = rg.write_uff(modes, tmp_path / "rig.uff", modes=[3, 4, 5])
    text = table.read_text().splitlines()
    rows = []
    for sensor in plan.sensors:
        node = modes.nodes.nearest(*model.layout.place(sensor.place)) + 1
        rows.append(f"{sensor.place},{node},{sensor.direction}")
    table.write_text("\n".join(["point,node,direction", *rows]))
    assert text[0].startswith("point,node,direction")
    found = rg.compare_shapes(modes, result, points=table, samples=5)
    assert [match.mode_number for match in found.matches] == [4, 5, 6]
    assert all(match.mac > 1 - 1e-9 for match in found.matches)


def test_more_sensors_than_places_and_places_that_are_none_are_refused():
    model = rg.load(MODELS / "geared_pair.toml")
    with pytest.raises(AnalysisError, match="ask for fewer"):
        rg.sensors(model, count=500, modes=4, elements=1)
    with pytest.raises(AnalysisError, match="names no place"):
        rg.sensors(model, candidates="casings.*")
    with pytest.raises(AnalysisError, match="directions"):
        rg.sensors(model, directions="xw")


def test_modes_that_no_candidate_sees_are_named_and_place_nothing():
    plan = rg.sensors(rg.load(MODELS / "jeffcott.toml"), count=2, fmax=200.0, directions="z", elements=2)
    assert any("no sensor there sees them" in warning for warning in plan.warnings)
    everyone = rg.sensors(rg.load(MODELS / "jeffcott.toml"), count=2, fmax=200.0, elements=2)
    assert not everyone.warnings
    assert set(plan.mode_number) < set(everyone.mode_number)


def test_a_machine_that_only_twists_has_no_place_for_a_sensor_that_looks_along_an_axis():
    with pytest.raises(AnalysisError, match="moves a candidate along x, y, z"):
        rg.sensors(rg.load(MODELS / "marine_dual_turbine.toml"), count=4, elements=1)
