"""A face as a line of springs that only push: forces, moments and tangents against sums over thin slices, and ISO 6336-1."""

from __future__ import annotations

import numpy as np
import pytest

from rotorgear.errors import AnalysisError
from rotorgear.gears.stiffness.face_load import FaceLoad, uniform_line

K = 1e9
B = 0.04
F = 1e4
CASES = [0.0, 5e-6, -5e-6, 2e-5, 6e-5, -6e-5, 1e-3]


def sliced(approach: float, misalignment: float) -> np.ndarray:
    """F and M of 200 000 slices."""
    n = 200_000
    z = ((np.arange(n) + 0.5) / n - 0.5) * B
    load = np.maximum(K / n * (approach - misalignment * z / B), 0.0)
    return np.array([load.sum(), load @ z])


@pytest.mark.parametrize("misalignment", CASES)
def test_force_and_moment_are_those_of_thin_slices(misalignment: float) -> None:
    face = uniform_line(K, B, F, misalignment)
    force, moment = sliced(face.approach, misalignment)
    assert force == pytest.approx(F, rel=1e-8)
    assert moment == pytest.approx(face.moment, rel=1e-6, abs=1e-9)
    assert np.interp(face.peak_place, face.z, face.line_load) == pytest.approx(face.load_factor * F / B, rel=1e-12)


@pytest.mark.parametrize("misalignment", [5e-6, 6e-5, -6e-5])
def test_tangents_are_difference_quotients(misalignment: float) -> None:
    face = uniform_line(K, B, F, misalignment)
    h = 1e-9
    by_approach = (sliced(face.approach + h, misalignment) - sliced(face.approach - h, misalignment)) / (2.0 * h)
    # A tilt closes the flanks at larger z: it takes from the misalignment.
    by_tilt = (sliced(face.approach, misalignment - h * B) - sliced(face.approach, misalignment + h * B)) / (2.0 * h)
    k, e, k_t = face.static.stiffness, face.static.place, face.static.tilt_stiffness
    assert by_approach == pytest.approx([k, k * e], rel=1e-4, abs=1e-3 * K * B**2)
    assert by_tilt == pytest.approx([k * e, k * e**2 + k_t], rel=1e-4, abs=1e-3 * K * B**2)


def test_the_face_load_factor_is_that_of_iso_6336_on_both_sides_of_2() -> None:
    # ISO 6336-1: 1 + F_by c/(2 F_m/b) where the whole face carries, else sqrt(2 F_by c/(F_m/b)).
    assert uniform_line(K, B, F, 5e-6).load_factor == pytest.approx(1.0 + 5e-6 * K / (2.0 * F))
    assert uniform_line(K, B, F, 6e-5).load_factor == pytest.approx(np.sqrt(2.0 * 6e-5 * K / F))
    assert uniform_line(K, B, F, 2e-5).load_factor == pytest.approx(2.0)
    assert uniform_line(K, B, F, 2e-5 * (1.0 + 1e-9)).load_factor == pytest.approx(2.0)


def test_a_face_from_its_other_end_is_that_of_the_opposite_misalignment() -> None:
    there: FaceLoad = uniform_line(K, B, F, 6e-5).mirrored
    here = uniform_line(K, B, F, -6e-5)
    assert (there.moment, there.static, there.peak_place) == (here.moment, here.static, here.peak_place)
    assert there.line_load == pytest.approx(here.line_load)
    assert there.z == pytest.approx(here.z)


def test_a_face_without_width_or_force_is_refused() -> None:
    for width, force in ((0.0, F), (B, 0.0)):
        with pytest.raises(AnalysisError, match="needs a width and a force"):
            uniform_line(K, width, force, 0.0)
