"""Gearboxes whose carriers turn, as solids at a moment: places, pins that stay in their bearings, and loops of frames."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.export.solids import build_solids
from rotorgear.export.turning import Motion, Turning, turning_of
from tests.planetary import PIN, helical_stage

STAGES = [(4, (26, 36, 98)), (5, (24, 26, 76))]
STIFF = {name: 3e4 * value for name, value in PIN.items()}


def modes_of_a_stage(planets: int, teeth: tuple[int, int, int], speed: float) -> rg.ModalResult:
    return rg.modal(rg.loads(helical_stage(planets, teeth=teeth, pin=STIFF)), speed=speed, modes=12)


def turning_of_modes(found: rg.ModalResult) -> Turning:
    turning = turning_of(found.model, found.nodes, build_solids(found.model, found.nodes), found.speed)
    assert turning is not None
    return turning


@pytest.mark.parametrize(("planets", "teeth"), STAGES)
@pytest.mark.parametrize("speed", [400.0, -250.0])
def test_planets_on_stiff_pins_move_as_the_carrier_does_where_they_stand_then(
    planets: int, teeth: tuple[int, int, int], speed: float
) -> None:
    """u + theta x r of the carrier, at the place of the pin and in the phase of the moment, in all modes."""
    found = modes_of_a_stage(planets, teeth, speed)
    turning = turning_of_modes(found)
    node = {name: k for k, name in enumerate(found.nodes.shaft)}
    names = list(found.model.shafts)
    radius = found.model.layout.planets[0].radius
    checked = 0
    for mode in range(len(found)):
        shape = found.shapes[:, :, mode]
        for periods in (0.0, 0.3, 0.85):
            solids, moved = turning.at(shape, periods)
            on = 2.0 * np.pi * periods / planets * np.sign(speed)
            u, theta = shape[node["carrier"], :3], shape[node["carrier"], 3:]
            for k in range(planets):
                angle = on + 2.0 * np.pi * k / planets
                arm = radius * np.array([np.cos(angle), np.sin(angle), 0.0])
                name = f"planet#{k + 1}"
                assert solids.axes is not None
                frame = solids.axes[names.index(name)]
                told = frame @ moved[node[name], :3]
                assert told == pytest.approx(u + np.cross(theta, arm), abs=2e-3 * np.abs(shape[:, :3]).max())
                checked += bool(np.abs(told).max() > 0.1 * np.abs(shape[:, :3]).max())
    assert checked > 50


@pytest.mark.parametrize(("planets", "teeth"), STAGES)
def test_after_a_period_each_planet_is_where_the_next_one_was_and_the_picture_comes_again(
    planets: int, teeth: tuple[int, int, int]
) -> None:
    model = rg.loads(helical_stage(planets, teeth=teeth))
    found = rg.modal(model, speed=500.0, modes=26)
    turning = turning_of_modes(found)
    solids = turning.solids
    names = list(model.shafts)
    of_planet = []
    for k in range(planets):
        cells = np.split(solids.shaft == names.index(f"planet#{k + 1}"), [len(solids.quads)])
        of_planet.append(
            np.unique(np.concatenate([solids.quads[cells[0]].ravel(), solids.triangles[cells[1]].ravel()]))
        )
    repeats = set()
    for mode in range(1, len(found)):
        shape = found.shapes[:, :, mode]
        scaled, scale = solids.scaled(shape, 0.03)
        motion = Motion(solids, shape, scaled, scale, turning)
        repeats.add((found.mode_class[mode], motion.periods))
        before, after = (np.add(*motion.at(periods)) for periods in (0.0, float(motion.periods)))
        step = 1 if motion.periods == 1 else planets
        for k in range(planets):
            there = before[of_planet[(k + step) % planets]].mean(axis=0)
            assert after[of_planet[k]].mean(axis=0) == pytest.approx(there, abs=1e-7 * solids.size)
    assert repeats == {("rotational-axial", 1), ("translational-tilting", 1), ("planet", planets)}


def test_gears_turn_by_their_ratios_and_what_holds_them_stands_still() -> None:
    planets, teeth = STAGES[0]
    found = modes_of_a_stage(planets, teeth, 300.0)
    turning = turning_of_modes(found)
    rest = turning.solids
    solids, _ = turning.at(found.shapes[:, :, 1], 0.4)
    on = 2.0 * np.pi * 0.4 / planets
    ratio = {name: float(value) for name, value in found.model.layout.train.ratios.items()}
    cell = np.array(rest.part_names)[rest.part]
    for part, shaft in (("gears.sun", "sun"), ("gears.ring", "ring"), ("disks.carrier", "carrier")):
        points = np.unique(rest.quads[(cell == part)[: len(rest.quads)]])
        angle = on * ratio[shaft] / ratio["carrier"]
        c, s = np.cos(angle), np.sin(angle)
        R = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        assert solids.points[points] == pytest.approx(rest.points[points] @ R.T, abs=1e-12)
    held = np.unique(rest.quads[(cell == "supports.ring")[: len(rest.quads)]])
    assert np.array_equal(solids.points[held], rest.points[held])
    # Teeth that are in mesh at the start are so at any moment: the planet turns on its pin by - z_s/z_p of the sun's turn to it.
    own = np.unique(rest.quads[(cell == "gears.planet#1")[: len(rest.quads)]])
    centre = solids.points[own].mean(axis=0)
    first = rest.points[own] - rest.points[own].mean(axis=0)
    turned = solids.points[own] - centre
    angle = np.angle(np.sum((turned[:, 0] + 1j * turned[:, 1]) * np.conj(first[:, 0] + 1j * first[:, 1])))
    wanted = on - teeth[0] / teeth[1] * (ratio["sun"] / ratio["carrier"] - 1.0) * on
    assert np.exp(1j * angle) == pytest.approx(np.exp(1j * wanted), abs=1e-9)


def test_frames_of_a_mode_have_planets_at_their_places(tmp_path: Path) -> None:
    pv = pytest.importorskip("pyvista")
    planets, teeth = STAGES[0]
    found = modes_of_a_stage(planets, teeth, 400.0)
    translational = found.mode_class.index("translational-tilting")
    rg.write_vtk(found, tmp_path, modes=[translational], frames=6, amplitude=0.01)
    files = sorted((tmp_path / f"mode_{translational + 1:02d}").glob("phase_*.vtp"))
    assert len(files) == 6
    number = list(found.model.shafts).index("planet#2")
    for k, file in enumerate(files):
        mesh = pv.read(file)
        own = mesh.extract_cells(np.flatnonzero(mesh.cell_data["shaft_id"] == number))
        x, y, _ = (own.points - own.point_data["displacement"]).mean(axis=0)
        angle = 2.0 * np.pi * (1.0 + k / 6.0) / planets
        assert np.arctan2(y, x) == pytest.approx(angle, abs=1e-3)
    assert "CARRIERS" in (tmp_path / "README.txt").read_text()
    at_rest = rg.modal(found.model, modes=3)
    rg.write_vtk(at_rest, tmp_path / "rest", modes=[1], frames=4)
    assert "CARRIERS" not in (tmp_path / "rest" / "README.txt").read_text()


def test_planets_keep_their_own_axes_where_another_shaft_has_no_place() -> None:
    """Outwards is outwards of each planet, though the input shaft is put beside the others."""
    model = rg.load("models/planetary.toml")
    found = rg.modal(model, modes=2)
    solids = build_solids(model, found.nodes)
    assert solids.axes is not None
    names = list(model.shafts)
    for k in range(4):
        outwards = solids.axes[names.index(f"planet#{k + 1}")][:, 0]
        assert outwards == pytest.approx([np.cos(0.5 * np.pi * k), np.sin(0.5 * np.pi * k), 0.0], abs=1e-12)


def test_instants_of_a_motion_in_time_have_planets_where_they_are_then(tmp_path: Path) -> None:
    """Places by the true angle of the carrier, and displacements outwards and onwards of the channels about their mean."""
    pv = pytest.importorskip("pyvista")
    planets, teeth = STAGES[0]
    loads = '[loads.in]\nshaft = "sun"\nkind = "input"\ntorque = 400\n[loads.out]\nshaft = "carrier"\nkind = "output"\n'
    text = helical_stage(planets, teeth=teeth, loss=2e-6, more=loads).replace(
        "[meshes.sun_planet]\n", "[meshes.sun_planet]\ntransmission_error = [{harmonic = 1, amplitude = 3e-6}]\n"
    )
    found = rg.transient(
        rg.loads(text), speed=400.0, time=0.02, steps=100, frames=24, method="exponential", error_estimate=False
    )
    rg.write_motion(found, tmp_path)
    turn = float(found.model.layout.train.ratio("carrier")) * 400.0
    at_start = 2.0 * np.pi * np.arange(planets) / planets
    # What the channels tell in axes that go round, as a pattern over the pins at the start, about its mean.
    own = np.stack(
        [[found.history(f"bearings.pin#{k + 1} displacement {axis}") for axis in "xy"] for k in range(planets)]
    )[:, :, -24:]
    wave = at_start[:, None] - at_start[None, :]
    time = found.time[-24:]

    def on(angle: float, x: np.ndarray) -> np.ndarray:
        first = 2.0 / planets * (np.cos(wave + angle) - np.cos(wave))
        return x + np.tensordot(first, x, axes=1)

    pattern = np.stack([on(-turn * t, own[:, :, i]) for i, t in enumerate(time)], axis=2)
    told = pattern - pattern.mean(axis=2, keepdims=True)
    number = build_solids(found.model, found.nodes).part_names.index("gears.planet#2")
    for i in (0, 11, 23):
        mesh = pv.read(tmp_path / "motion" / f"instant_{i + 1:04d}.vtp")
        cells = mesh.extract_cells(np.flatnonzero(mesh.cell_data["part_id"] == number))
        x, y, _ = (cells.points - cells.point_data["displacement"]).mean(axis=0)
        angle = at_start[1] + turn * time[i]
        assert np.exp(1j * np.arctan2(y, x)) == pytest.approx(np.exp(1j * angle), abs=1e-4)
        outwards, onwards = on(turn * time[i], told[:, :, i])[1]
        moved = outwards * np.array([np.cos(angle), np.sin(angle)]) + onwards * np.array(
            [-np.sin(angle), np.cos(angle)]
        )
        shown = cells.point_data["displacement_m"].mean(axis=0)[:2]
        assert shown == pytest.approx(moved, abs=1e-2 * np.abs(told).max())
