"""Loaded teeth in a ring: corners by plane kinematics, Hertz by the difference of curvatures, approach, sharing, rigid limit."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from rotorgear.gears.geometry.flank import FlankModification
from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.line_of_action import generated_line
from rotorgear.gears.geometry.outline import tooth_outline
from rotorgear.gears.geometry.pair import pair_geometry
from rotorgear.gears.loaded.mesh_cycle import loaded_cycle
from rotorgear.gears.stiffness.mesh_stiffness import ToothBody, ToothPair
from rotorgear.gears.tooth_fe.settings import ToothFe
from rotorgear.model.layout.mesh_layout import mirrored
from tests.unit.gears.tooth_pairs import COARSE

M = 3e-3
WIDTH = 0.03
LOAD = 6000.0


def in_ring(helix: float = 0.0, moduli: tuple[float, float] = (206e9, 206e9), fe: ToothFe | None = None) -> ToothPair:
    """Teeth 23/71 with unequal shifts and blanks."""
    alpha = math.radians(20.0)
    first = GearGeometry(23, M, alpha, helix, 0.3)
    second = GearGeometry(-71, M, alpha, helix, -0.1, addendum_factor=0.85)
    outer = -0.5 * second.root_diameter + 0.014
    bodies = (ToothBody(moduli[0], inner_radius=0.02), ToothBody(moduli[1], 0.28, outer, rim_thickness=0.014))
    return ToothPair(first, second, pair_geometry(first, second, WIDTH), WIDTH, *bodies, fe=fe or ToothFe())


def test_a_tip_corner_comes_to_its_mate_as_both_gears_turn() -> None:
    teeth = in_ring()
    line = generated_line(teeth.first, teeth.second, teeth.pair)
    pinion, ring = (tooth_outline(g) for g in (teeth.first, teeth.second))
    bases = [teeth.first.base_radius, -teeth.second.base_radius]
    distance = -teeth.pair.centre_distance
    tangent = math.tan(teeth.pair.working_transverse_pressure_angle)

    def half(gear: int, radius: float) -> float:
        """Half the angle of a tooth at a radius."""
        roll = math.sqrt(radius**2 - bases[gear] ** 2)
        return float((pinion, ring)[gear].involute(roll if gear == 0 else -roll)[1])

    at_pitch = [half(i, base / math.cos(math.atan(tangent))) for i, base in enumerate(bases)]
    # The pinion turns towards +y, from the pitch point on +x; its upper flank touches the lower one of a tooth of the ring.
    for excess in (0.1e-3, 0.6e-3, 1.5e-3):
        after = line.end + excess - line.pitch_point
        corner = half(0, pinion.tip_radius) - at_pitch[0] + after / bases[0]
        x = distance + pinion.tip_radius * math.cos(corner)
        y = pinion.tip_radius * math.sin(corner)
        flank = at_pitch[1] - half(1, math.hypot(x, y)) + after / bases[1]
        gap, roll = line.corner(0, np.array([excess]))
        assert gap[0] == pytest.approx(bases[1] * (flank - math.atan2(y, x)), rel=1e-6, abs=1e-12)
        assert gap[0] > 0.0
        assert -roll[0] == pytest.approx(math.sqrt(x**2 + y**2 - bases[1] ** 2), rel=1e-9)
        before = line.start - excess - line.pitch_point
        corner = at_pitch[1] - half(1, ring.tip_radius) + before / bases[1]
        x = ring.tip_radius * math.cos(corner) - distance
        y = ring.tip_radius * math.sin(corner)
        if math.hypot(x, y) < bases[0]:
            continue
        flank = half(0, math.hypot(x, y)) - at_pitch[0] + before / bases[0]
        gap, roll = line.corner(1, np.array([excess]))
        assert gap[0] == pytest.approx(bases[0] * (math.atan2(y, x) - flank), rel=1e-6, abs=1e-12)
        assert gap[0] > 0.0
        assert roll[0] == pytest.approx(math.sqrt(x**2 + y**2 - bases[0] ** 2), rel=1e-9)


@pytest.fixture(scope="module")
def one_pair() -> float:
    """A position where one pair of the spur teeth carries all, in the middle of that stretch."""
    teeth = in_ring()
    line = generated_line(teeth.first, teeth.second, teeth.pair)
    return (0.5 * (line.start + line.end) - line.pitch_point) / line.base_pitch


def test_pressure_follows_the_difference_of_curvatures(one_pair: float) -> None:
    teeth = in_ring()
    problem, cycle = loaded_cycle(teeth, LOAD, np.array([one_pair]))
    carrying = np.argmax(cycle.force)
    assert cycle.force[carrying] == pytest.approx(LOAD, rel=1e-9)
    rho = problem.line.pitch_point + one_pair * problem.line.base_pitch
    outer = rho - problem.line.length  # the ring's radius of curvature, T1T2 < 0
    radius = 1.0 / (1.0 / rho - 1.0 / outer)
    modulus = 1.0 / ((1.0 - 0.3**2) / 206e9 + (1.0 - 0.28**2) / 206e9)
    assert cycle.pressure[carrying] == pytest.approx(math.sqrt(LOAD * modulus / (math.pi * WIDTH * radius)), rel=1e-6)


def test_the_approach_is_the_sum_of_both_flanks_displacements(one_pair: float) -> None:
    """With one gear rigid the other's flank alone gives; both together differ by the width of the strip in the logarithm only."""
    at = np.array([one_pair])
    both, ring_rigid, pinion_rigid = (
        loaded_cycle(in_ring(moduli=moduli), LOAD, at)[1].deflection[0]
        for moduli in ((206e9, 206e9), (206e9, 206e15), (206e15, 206e9))
    )
    # Strips of one elastic gear are 1/sqrt(2) as wide: 2 (1 - nu^2)/(pi E) F/b ln 2 / 2 more for each gear.
    local = LOAD / WIDTH * math.log(2.0) / (math.pi * 206e9) * ((1.0 - 0.3**2) + (1.0 - 0.28**2))
    assert ring_rigid + pinion_rigid == pytest.approx(both + local, rel=2e-4)
    assert ring_rigid > pinion_rigid > 0.2 * ring_rigid


def test_pairs_share_the_load_and_rigid_teeth_follow_their_flanks() -> None:
    u = np.arange(12) / 12
    _, cycle = loaded_cycle(in_ring(), LOAD, u)
    assert [cycle.force[cycle.slices.at(i)].sum() for i in range(12)] == pytest.approx([LOAD] * 12, rel=1e-9)
    numbers = [np.count_nonzero(cycle.force[cycle.slices.at(i)]) for i in range(12)]
    assert {1, 2} <= set(numbers)
    # Two pairs are stiffer than one by less than twice.
    stiffness = LOAD / cycle.deflection
    assert 1.2 < stiffness.max() / stiffness.min() < 2.0
    # The pair whose flanks stand back least carries; the slope is so small that no corner comes before it.
    rigid = in_ring(moduli=(206e15, 206e15))
    back = replace(rigid, second_flank=FlankModification(profile_slope=0.2e-6))
    problem, moved = loaded_cycle(back, LOAD, u)
    exact = loaded_cycle(rigid, LOAD, u)[1]
    line = problem.line
    roll = line.pitch_point + (u[:, None] + np.arange(-3, 4)) * line.base_pitch
    touching = (roll >= line.start) & (roll <= line.end)
    share = ((line.length - roll) - 0.5 * (line.form[1] + line.tip[1])) / (line.tip[1] - line.form[1])
    depth = np.where(touching, 0.2e-6 * share, np.inf).min(axis=1)
    assert moved.deflection - exact.deflection == pytest.approx(depth, abs=1e-10)


def test_a_misaligned_helical_ring_seen_from_its_other_end_is_the_mirror_image() -> None:
    teeth = replace(
        in_ring(0.2, fe=ToothFe(size=COARSE, arc=3, body="rim")),
        misalignment=8e-6,
        second_flank=FlankModification(helix_slope=3e-6, crowning=2e-6),
    )
    at = np.array([0.1])
    one = loaded_cycle(teeth, LOAD, at)[1]
    opened = loaded_cycle(replace(teeth, misalignment=-8e-6), LOAD, at)[1]
    # Flanks that stand apart at larger z carry at smaller z.
    assert one.moment[0] < opened.moment[0]
    assert loaded_cycle(mirrored(mirrored(teeth)), LOAD, at)[1].deflection[0] == one.deflection[0]
    # A slope of a flank is a misalignment of as much.
    sloped = replace(teeth, misalignment=11e-6, second_flank=FlankModification(crowning=2e-6))
    assert loaded_cycle(sloped, LOAD, at)[1].deflection[0] == pytest.approx(one.deflection[0], rel=1e-9)
