"""Stiffness ratios up to 1e19 against 40 digits: strain factors keep each frequency that the assembled K loses."""

import mpmath as mp
import numpy as np
import pytest

from rotorgear.solvers.eigen.eigen import lowest_modes
from tests.unit.solvers.spring_chains import Beam, exact_eigenvalues

EVEN = [0.1] * 8
BEAMS = {
    "base": Beam(EVEN, springs={1: 1e8, 7: 1e8}),
    "soft bearings": Beam(EVEN, springs={1: 1e3, 7: 1e3}),
    "stiff bearings": Beam(EVEN, springs={1: 1e13, 7: 1e13}),
    "soft and stiff bearing": Beam(EVEN, springs={1: 1e3, 7: 1e13}),
    "hardly supported": Beam(EVEN, springs={1: 1e-3, 7: 1e-3}),
    "three short elements": Beam([0.1, 0.1, 1e-4, 1e-4, 1e-4, 0.1, 0.1, 0.1], springs={1: 1e6, 7: 1e6}),
    "one micrometre": Beam([0.1, 0.1, 1e-6, 0.1, 0.1, 0.1], springs={1: 1e6, 5: 1e6}),
    "thin shaft on stiff bearings": Beam(EVEN, bending=0.16, line_mass=0.025, springs={1: 1e13, 7: 1e13}),
    "inertia ratio": Beam(EVEN, springs={1: 1e8, 7: 1e8}, lumps={3: (1e3, 1e3), 6: (1e-3, 1e-3)}),
    "all at once": Beam(
        [0.1, 0.1, 1e-4, 0.1, 0.1, 0.1], springs={1: 1e13, 5: 1e3}, lumps={3: (1e3, 1e3), 6: (1e-3, 1e-3)}
    ),
}


def _omega_error(eigenvalues, exact):
    pairs = zip(eigenvalues, exact, strict=False)
    return max(abs(float(mp.sqrt(mp.mpf(float(computed)) / true) - 1)) for computed, true in pairs)


@pytest.mark.parametrize("name", BEAMS)
@pytest.mark.parametrize("count", [6, None])
def test_frequencies_are_exact_to_rounding_whatever_the_stiffness_ratio(name, count):
    beam = BEAMS[name]
    with mp.workdps(40):
        exact = exact_eigenvalues(*beam.exact())
        modes = lowest_modes(*beam.matrices(), count=count, strain=beam.strain)
        assert modes.rigid_count == 0
        assert modes.sturm_count_ok
        assert _omega_error(modes.eigenvalues, exact) < 1e-14


def test_the_assembled_stiffness_alone_loses_what_the_strain_factors_keep():
    beam = BEAMS["three short elements"]
    with mp.workdps(40):
        exact = exact_eigenvalues(*beam.exact())
        assert _omega_error(lowest_modes(*beam.matrices(), count=6).eigenvalues, exact) > 1e-9


def test_the_rigid_motions_of_a_free_beam_carry_no_strain():
    beam = Beam(EVEN)
    modes = lowest_modes(*beam.matrices(), count=5, strain=beam.strain)
    assert modes.rigid_count == 2
    assert np.all(modes.eigenvalues[:2] < 1e-20 * modes.eigenvalues[2])
