"""Curves of mesh stiffness: what the mean load sees, two helices apart by a stagger, and the standard's c' written out."""

from __future__ import annotations

import math

import numpy as np
import pytest

from rotorgear.gears.geometry.flank_tolerance import base_pitch_deviation, profile_form_deviation
from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.stiffness.iso import iso_tooth_stiffness
from rotorgear.gears.stiffness.mesh_stiffness import MeshStiffness

U = np.arange(16) / 16
SECANT = 4e8 * (1.0 + 0.3 * np.sin(2 * np.pi * U) + 0.1 * np.cos(4 * np.pi * U))
TANGENT = 5e8 * (1.0 + 0.2 * np.cos(2 * np.pi * U))


def curve(tangent: np.ndarray | None = None) -> MeshStiffness:
    return MeshStiffness("tooth_fe", U, SECANT, "secant", 1e4, "", 0.3, tangent=tangent)


def test_under_a_constant_load_the_static_stiffness_gives_the_mean_of_the_deflections() -> None:
    load = 2e4  # along the flank normal: cos b_b of it presses in the transverse plane, and gives back cos b_b
    deflection = load * np.cos(0.3) / SECANT * np.cos(0.3)
    found = curve(TANGENT)
    assert load / found.static_normal == pytest.approx(deflection.mean(), rel=1e-12, abs=0.0)
    assert found.about_load.mean_normal == pytest.approx(TANGENT.mean() / np.cos(0.3) ** 2, rel=1e-12)
    assert abs(found.static_normal / found.mean_normal - 1.0) > 0.01


def test_the_second_helix_is_ahead_by_the_stagger() -> None:
    steps = 4  # of 16: a quarter of the period
    both = curve().of_both_helices(0.25)
    assert both.transverse == pytest.approx([SECANT[i] + SECANT[(i + steps) % 16] for i in range(16)], rel=1e-12)
    loaded = curve(TANGENT).of_both_helices(0.25)
    for i in range(16):
        # Half the load on each helix: the approach of both together is the mean of their approaches.
        give = 0.5 * (0.5 / SECANT[i] + 0.5 / SECANT[(i + steps) % 16])
        assert loaded.transverse[i] * give == pytest.approx(1.0, rel=1e-12)


def test_the_single_stiffness_of_the_standard_is_its_polynomial_written_out() -> None:
    pinion = GearGeometry(23, 4e-3, math.radians(20.0), math.radians(18.0), profile_shift=0.3, dedendum_factor=1.4)
    wheel = GearGeometry(71, 4e-3, math.radians(20.0), math.radians(18.0), profile_shift=0.1)
    base = math.asin(math.sin(math.radians(18.0)) * math.cos(math.radians(20.0)))
    virtual = [z / (math.cos(base) ** 2 * math.cos(math.radians(18.0))) for z in (23, 71)]
    q = 0.04723 + 0.15551 / virtual[0] + 0.25791 / virtual[1] - 0.00635 * 0.3 - 0.11654 * 0.3 / virtual[0]
    q += -0.00193 * 0.1 - 0.24188 * 0.1 / virtual[1] + 0.00529 * 0.3**2 + 0.00182 * 0.1**2
    rack = 0.5 * ((1.0 + 0.5 * (1.2 - 1.4)) + (1.0 + 0.5 * (1.2 - 1.25)))
    single = 0.8 * rack * math.cos(math.radians(18.0)) / q  # N/(mm um)
    for first, second in ((pinion, wheel), (wheel, pinion)):
        found = iso_tooth_stiffness(first, second, 1.55)
        assert found.single == pytest.approx(1e9 * single, rel=1e-12)
        assert found.mesh_alpha == pytest.approx(1e9 * single * (0.75 * 1.55 + 0.25), rel=1e-12)
        assert found.mesh_beta == pytest.approx(0.85 * found.mesh_alpha, rel=1e-12)


def test_deviations_of_a_class_are_those_of_the_standard() -> None:
    gear = GearGeometry(40, 4e-3, math.radians(20.0), math.radians(18.0))
    d = 40 * 4.0 / math.cos(math.radians(18.0))
    transverse = math.atan(math.tan(math.radians(20.0)) / math.cos(math.radians(18.0)))
    pitch = (0.001 * d + 0.4 * 4.0 + 5.0) * 2.0  # class 7 is two steps of sqrt 2 above class 5
    assert 1e6 * base_pitch_deviation(gear, 7) == pytest.approx(pitch * math.cos(transverse), rel=1e-12)
    assert 1e6 * profile_form_deviation(gear, 7) == pytest.approx((0.55 * 4.0 + 5.0) * 2.0, rel=1e-12)
