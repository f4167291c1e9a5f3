"""Modes without a speed are undamped, also where a stiffness is not symmetric: a rotor that is rigid beside its bearings."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg

STIFFNESS = np.array([[2.0, 0.8], [-0.4, 3.0]])  # N/m
MASS = 7850.0 * np.pi / 4.0 * (0.05**2 * 0.8 + 0.03 * (0.3**2 - 0.05**2))


def rotor() -> rg.Model:
    bearing = {
        "shaft": "rotor",
        "stiffness": {
            "x": STIFFNESS[0, 0],
            "y": STIFFNESS[1, 1],
            "xy": STIFFNESS[0, 1],
            "yx": STIFFNESS[1, 0],
        },
        "damping": {"radial": 2e4},
    }
    return rg.Model(
        materials={"steel": {"youngs_modulus": 210e9, "density": 7850.0, "poisson_ratio": 0.3}},
        shafts={"rotor": {"material": "steel", "sections": [{"length": 0.4, "outer_diameter": 0.05}] * 2}},
        disks={"disk": {"shaft": "rotor", "at": 0.4, "outer_diameter": 0.3, "bore": 0.05, "width": 0.03}},
        motions=["bending"],
        damping={"rayleigh_alpha": 5.0},
        bearings={"left": {"at": "start", **bearing}, "right": {"at": "end", **bearing}},
    )


@pytest.mark.parametrize("elements", [2, 30])
def test_dampers_have_no_part_in_modes_without_a_speed(elements):
    """m s^2 q + 2 K q = 0 for the rotor moving as a whole: one whirl grows and one decays, at one frequency."""
    found = rg.modal(rotor(), elements=elements, modes=4, error_estimate=False).eigenvalues
    exact = np.sqrt(-np.linalg.eigvals(2.0 * STIFFNESS / MASS) + 0j)
    exact = np.where(exact.imag < 0.0, -exact, exact)
    lowest = found[np.argsort(np.abs(found))][:2]
    np.testing.assert_allclose(np.sort(lowest.real), np.sort(exact.real), rtol=1e-6)
    np.testing.assert_allclose(lowest.imag, exact.imag, rtol=1e-6)
