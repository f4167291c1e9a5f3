"""A face of springs that only push, by its maps at several tilts: closed form, and the map of one tilt by itself."""

from __future__ import annotations

import numpy as np
import pytest

from rotorgear.forces.loaded_teeth import LoadedTeeth

STIFFNESS = 4e8
WIDTH = 0.03


def line(approach: float, tilt: float) -> tuple[float, float]:
    """F and M of a line of springs k/b over a face of width b: integrals of (k/b) max(delta + tilt z, 0) and of that times z."""
    z = (np.arange(20000) + 0.5) / 20000 * WIDTH - 0.5 * WIDTH
    pressed = STIFFNESS * np.maximum(approach + tilt * z, 0.0)
    return float(pressed.mean()), float((pressed * z).mean())


def face(tilts: np.ndarray, **more: float) -> LoadedTeeth:
    load = 5000.0 * np.concatenate([[0.0], np.geomspace(1e-3, 4.0, 80)])
    gape = np.maximum(np.abs(tilts), 1e-12)[:, None] * WIDTH
    part = WIDTH * np.minimum(np.sqrt(2.0 * load / (STIFFNESS * gape)), 1.0)
    whole = part >= WIDTH
    side = np.sign(tilts)[:, None]
    approach = np.where(whole, load / STIFFNESS, gape * (part / WIDTH - 0.5))
    moment = np.where(whole, STIFFNESS * WIDTH * side * gape / 12.0, load * side * (0.5 * WIDTH - part / 3.0))
    return LoadedTeeth(load, approach[:, None], STIFFNESS, tilt=tilts, moment=moment[:, None], **more)


@pytest.mark.parametrize("approach", [-2e-6, 4e-6, 12e-6, 25e-6])
@pytest.mark.parametrize("tilt", [-7e-4, -2.1e-4, 3e-5, 5.2e-4])
def test_force_and_moment_between_the_tilts_are_those_of_a_line_of_springs(approach: float, tilt: float) -> None:
    F, M = line(approach, tilt)
    law = face(1e-4 * np.arange(-10.0, 11.0))
    found = law.evaluate([approach, tilt])
    # Within 1 %, or 0.1 % of the working load of 5000 N and of its moment at the end of the face.
    assert found.force[0] == pytest.approx(F, rel=0.01, abs=5.0)
    assert found.force[1] == pytest.approx(M, rel=0.01, abs=5.0 * 0.5 * WIDTH)


def test_at_a_tilt_that_was_solved_it_is_the_map_of_that_tilt() -> None:
    law = face(1e-4 * np.arange(-5.0, 6.0))
    k = 8
    alone = LoadedTeeth(law.load, law.approach[k], STIFFNESS)
    for approach in (1e-6, 6e-6, 20e-6):
        here = law.evaluate([approach, float(law.tilt[k])])
        assert here.force[0] == pytest.approx(alone.evaluate(approach).force[0], rel=2e-3, abs=5.0)
        assert here.force[1] == pytest.approx(line(approach, float(law.tilt[k]))[1], rel=0.01)


def test_teeth_that_part_carry_neither_force_nor_moment() -> None:
    law = face(1e-4 * np.arange(-10.0, 11.0), damping=900.0)
    found = law.evaluate([-16e-6, 2e-4], [1e-3, 1e-2])
    assert np.array_equal(found.force, np.zeros(2))
    assert not found.in_displacement.any()


def test_damping_acts_at_the_place_of_the_stiffness() -> None:
    law = face(1e-4 * np.arange(-10.0, 11.0), damping=900.0, place=0.01)
    still, moving = (law.evaluate([20e-6, 0.0], v).force for v in ([0.0, 0.0], [1e-3, 2e-2]))
    assert moving - still == pytest.approx(900.0 * (1e-3 + 0.01 * 2e-2) * np.array([1.0, 0.01]), rel=1e-3)
