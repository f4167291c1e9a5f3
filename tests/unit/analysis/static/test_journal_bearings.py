"""Rotors in oil films given by geometry: equilibrium, tangents, the threshold of whirl, refusals."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.errors import AnalysisError, ModelError
from tests.models import disk_in_bearing

FRISWELL = {"diameter": 0.1, "length": 0.03, "clearance": 1e-4, "viscosity": 0.1}


def rotor(journal: dict[str, object], load: float, rpm: float, mass: float = 20.0) -> rg.Model:
    """A rigid disk in one film, which moves across only; the load is along +x."""
    given = ", ".join(f"{key} = {value}" for key, value in journal.items())
    return disk_in_bearing(
        f"journal = {{ {given} }}", f"[{load}, 0.0, 0.0]", name="left", speed=f"{rpm} rpm", mass=mass
    )


def test_the_bearing_of_friswell_has_its_finite_length_values():
    """D 100, L 30, c 0.1 mm, 0.1 Pa s, 525 N, 1500 rpm at finite length; x along the load, y 90 deg on in rotation."""
    result = rg.static(rotor(FRISWELL, 525.0, 1500.0))
    state = result.laws[0]
    assert np.hypot(*state.displacement) / 1e-4 == pytest.approx(0.2749, rel=0.01)
    assert np.degrees(np.arctan2(state.displacement[1], state.displacement[0])) == pytest.approx(70.09, abs=0.2)
    np.testing.assert_allclose(1e-6 * state.stiffness, [[8.912, 24.16], [-14.85, 12.22]], rtol=0.01)
    assert state.force[0] == pytest.approx(525.0, rel=1e-6)
    assert abs(state.force[1]) < 1e-6 * 525.0


def test_the_mass_at_the_threshold_of_whirl_is_that_of_the_closed_form():
    """K = (kxx cyy + kyy cxx - kxy cyx - kyx cxy)/(cxx + cyy), w^2 = ((K - kxx)(K - kyy) - kxy kyx)/det C, m = K/w^2."""
    state = rg.static(rotor(FRISWELL, 525.0, 1500.0)).laws[0]
    (kxx, kxy), (kyx, kyy) = state.stiffness
    (cxx, cxy), (cyx, cyy) = state.damping
    equal = (kxx * cyy + kyy * cxx - kxy * cyx - kyx * cxy) / (cxx + cyy)
    whirl = np.sqrt(((equal - kxx) * (equal - kyy) - kxy * kyx) / (cxx * cyy - cxy * cyx))
    mass = equal / whirl**2
    for share, sign in ((1.0, 0.0), (0.98, 1.0), (1.02, -1.0)):
        modes = rg.modal(rotor(FRISWELL, 525.0, 1500.0, share * mass), speed="1500 rpm")
        k = int(np.argmax(modes.frequency_hz))
        zeta = modes.damping_ratio[k]
        assert modes.frequency_hz[k] == pytest.approx(whirl / 2.0 / np.pi, rel=0.02)
        assert abs(zeta) < 1e-6 if sign == 0.0 else np.sign(zeta) == sign
    assert 0.4 < whirl / (1500.0 * np.pi / 30.0) < 0.6


def test_modes_print_the_film_that_they_are_about():
    law = rg.modal(rotor(FRISWELL, 525.0, 1500.0), speed="1500 rpm").laws[0]
    assert law.part == "bearings.left"
    assert law.deflection == pytest.approx(27.48e-6, abs=5e-9)
    assert law.load == pytest.approx(525.0, rel=1e-6)


@pytest.mark.parametrize(
    ("change", "load", "rpm", "said"),
    [
        ({"viscosity": 0.001}, 5e4, 1500.0, "of the clearance"),
        ({"viscosity": 0.001}, 525.0, 30000.0, "turbulent"),
        ({}, 525.0, 0.0, "no equilibrium was found|of the clearance"),
    ],
)
def test_a_film_that_can_not_be_is_refused(change, load, rpm, said):
    with pytest.raises(AnalysisError, match=said):
        rg.static(rotor({**FRISWELL, **change}, load, rpm))


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"length": 0.21}, "at most two diameters"),
        ({"clearance": '"20 mm"'}, "at most a tenth"),
        ({"preload": 0.5}, "2 lobes or more"),
        ({"lobes": 3, "inlet": 0.0}, "none beside lobes"),
        ({"cavitation": '"elrod"'}, "cavitation"),
    ],
)
def test_a_mistake_in_a_journal_is_told_with_its_address(change, said):
    with pytest.raises(ModelError, match=said):
        rotor({**FRISWELL, **change}, 525.0, 1500.0)
