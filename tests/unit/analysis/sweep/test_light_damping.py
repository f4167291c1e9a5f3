"""With little damping a start outlasts the periods that settle: a sweep finds where it ends, or says that it does not know."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from tests.models import lumped_gear, lumped_pair

RADII = (0.05, 0.08)
INERTIAS = (2e-3, 1.7e-2)
STIFFNESS = 1.5e8
ERROR = 1.5e-6
TEETH = 25
NATURAL = float(np.sqrt(STIFFNESS * sum(r**2 / inertia for r, inertia in zip(RADII, INERTIAS, strict=True))))
# Of the natural frequency; the last ones look like motions of one, two, three and five periods.
RATIOS = np.array([0.27, 0.61, 0.83, 1.37, 1.9, 1 / 2, 1 / 3, 2 / 3, 3 / 5, 5 / 7])


def unequal(damping: float, **mesh: object) -> rg.Model:
    """A pair in torsion of unequal gears, which a torque keeps in contact."""
    first, second = (
        lumped_gear(shaft, radius, polar_inertia=inertia, teeth=teeth)
        for shaft, radius, inertia, teeth in zip(("one", "two"), RADII, INERTIAS, (TEETH, 40), strict=True)
    )
    own = {
        "stiffness": STIFFNESS,
        "damping_ratio": damping,
        "transmission_error": [{"harmonic": 1, "amplitude": ERROR, "phase": 0.9}],
        **mesh,
    }
    operation = {"input_shaft": "one", "output_shaft": "two", "speed": 100.0, "torque": 400.0}
    return lumped_pair(first, second, own, operation=operation, motions=["torsion"])


def exact(damping: float) -> np.ndarray:
    """Peak to peak of the penetration at each ratio."""
    return 2.0 * ERROR * RATIOS**2 / np.abs(1.0 - RATIOS**2 + 2j * damping * RATIOS)


OVER = {"operation.speed": (RATIOS * NATURAL / TEETH).tolist()}


@pytest.mark.parametrize(
    ("damping", "mesh"), [(1e-6, {}), (1e-5, {}), (1e-4, {"backlash": 1e-4}), (1e-3, {}), (1e-2, {})]
)
def test_a_contact_that_never_parts_has_the_closed_form_at_any_damping(damping: float, mesh: dict[str, float]) -> None:
    found = rg.sweep(unequal(damping, **mesh), OVER)
    assert set(found.motion) <= {"1T", "not settled"}
    assert found.motion.count("1T") >= (10 if not mesh else 5)
    sound = np.array(found.motion) == "1T"
    np.testing.assert_allclose(found.peak_to_peak[sound, 0, 0], exact(damping)[sound], rtol=3e-3)


def test_without_exponents_it_has_the_closed_form_too() -> None:
    found = rg.sweep(unequal(1e-5), OVER, exponents=0)
    assert set(found.motion) == {"1T"}
    np.testing.assert_allclose(found.peak_to_peak[:, 0, 0], exact(1e-5), rtol=3e-3)


def test_errors_cover_what_is_left_of_a_start_and_notes_say_what_was_done() -> None:
    found = rg.sweep(unequal(1e-4), OVER)
    force = found.statistics_error[:, 0, 0, found.statistic.index("rms force")]
    k = STIFFNESS * exact(1e-4) / np.sqrt(8.0) * np.abs(1.0 + 2e-4j * RATIOS)
    assert np.all(np.abs(found.rms_force[:, 0, 0] - k) <= 3.0 * force + 1e-4 * k)
    assert any("went on from their periodic motion" in note for note in found.warnings)
