"""What rigid rings leave out: their rim bends, by itself with n = 2 nodal diameters at the lowest frequency,

    w_n^2 = E I n^2 (n^2 - 1)^2 / (m' R^4 (n^2 + 1)),    I = b h^3/12,

for a thin rim of height h between roots and outer surface, mean radius R and mass m' per length, that of its teeth included
(R. Hoppe, J. reine angew. Math. 73 (1871) 158; A. E. H. Love, Mathematical Theory of Elasticity, art. 293).
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rotorgear.model.layout.gear_layout import GearLayout
from rotorgear.note import Note
from rotorgear.system.system import System


def ring_notes(system: System) -> Iterator[Note]:
    """Of each ring that no casing holds, that its bending is left out, and where it would begin."""
    for gear, frequency in _rings(system):
        why = "a ring is rigid; by itself its rim bends with two nodal diameters from this frequency on"
        yield Note(f"gears.{gear.name}", "bending of the rim", why, f"{frequency:.3g} Hz")


def ring_warnings(system: System, values: np.ndarray) -> Iterator[Note]:
    """Of rings whose rim would bend below the highest of some eigenvalues (m,) in rad/s."""
    highest = float(np.abs(values).max(initial=0.0)) / (2.0 * math.pi)
    for gear, frequency in _rings(system):
        if frequency < highest:
            what = f"taken as rigid, but its rim by itself bends from about {frequency:.3g} Hz on"
            yield Note(f"gears.{gear.name}", what, "give it a thicker rim, or trust the modes below alone")


def _rings(system: System) -> Iterator[tuple[GearLayout, float]]:
    """Rings of given sizes that stand on shafts, and their lowest frequency of bending in Hz."""
    for gear in system.layout.gears:
        part = gear.part
        if part.internal and part.casing is None and gear.geometry is not None and gear.ring_diameter and part.width:
            yield gear, _lowest(gear) / (2.0 * math.pi)


def _lowest(gear: GearLayout) -> float:
    """w_2 in rad/s."""
    assert gear.geometry is not None
    inner, outer = -0.5 * gear.geometry.root_diameter, 0.5 * gear.ring_diameter
    reference = -0.5 * gear.geometry.reference_diameter
    height = outer - inner
    R = 0.5 * (inner + outer)
    # Teeth count as a solid ring from the reference circle on, as they do for the mass; all for one unit of width.
    mass = gear.material.density * math.pi * (outer**2 - reference**2) / (2.0 * math.pi * R)
    return math.sqrt(36.0 / 5.0 * gear.material.youngs_modulus * height**3 / 12.0 / (mass * R**4))
