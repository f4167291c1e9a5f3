"""The finite-element bodies under the teeth against elasticity: wind-up of a ring, and a helix seen in the plane."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

from rotorgear.gears.loaded.tooth_contact import contact_problem
from rotorgear.gears.stiffness.mesh_stiffness import ToothBody
from rotorgear.gears.tooth_fe.points import MeshSize
from rotorgear.gears.tooth_fe.settings import ToothFe
from tests.unit.gears.tooth_pairs import WIDTH, pair

SMALL = MeshSize(5, 2, 4, 2, 3, 2)
E = 206e9
NU = 0.3


@pytest.mark.parametrize("helix", [0.0, 20.0])
def test_without_torsion_a_ring_gives_less_by_the_wind_up_of_its_disc(helix: float) -> None:
    """A ring between the bore and the root circle under shear: r phi' = T/(2 pi r^2 b G), seen at the base circle."""
    bore = ToothBody(inner_radius=40e-3)
    space = helix > 0.0
    whole, rest = (
        contact_problem(
            pair(
                helix,
                ToothFe(body="ring", size=SMALL, exclude_torsion=out, space=space),
                first_body=bore,
                second_body=bore,
            )
        )
        for out in (False, True)
    )
    teeth = pair(helix)
    G = E / (2.0 * (1.0 + NU))
    for i, g in enumerate((teeth.first, teeth.second)):
        root = 0.5 * g.root_diameter
        wound = quad(lambda r: 1.0 / (2.0 * math.pi * r**3 * G), 40e-3, root)[0]
        # A unit force along the flank normal turns with r_b cos b_b, and its own displacement is seen by the same arm.
        give = (g.base_radius * math.cos(g.base_helix_angle)) ** 2 * wound / (WIDTH if space else 1.0)
        lost = (whole.compliance[i].flexibility - rest.compliance[i].flexibility) * whole.scale[i]
        assert lost / give == pytest.approx(np.ones(lost.shape), rel=1e-9)


def test_a_helix_seen_in_the_plane_gives_by_the_square_of_the_cosine_along_its_normal() -> None:
    """F cos b_b acts in the transverse plane, and cos b_b of what it gives there lies along the normal."""
    for helix in (0.0, 15.0, 30.0):
        teeth = pair(helix, ToothFe("preview"))
        problem = contact_problem(teeth)
        assert problem.plane
        cosine = math.sqrt(1.0 - (math.sin(math.radians(helix)) * math.cos(math.radians(20.0))) ** 2)
        assert E * np.array(problem.scale) == pytest.approx([cosine**2] * 2, rel=1e-12)
        assert E * problem.local == pytest.approx([2.0 * (1.0 - NU**2) / math.pi] * 2)
        assert problem.modulus == pytest.approx(0.5 * E / (1.0 - NU**2))
