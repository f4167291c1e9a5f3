"""Mean mesh stiffness of bevel gears as ISO 10300-1 estimates it, whatever their teeth: c_gamma = 20 C_F C_b N/(mm um).

C_F = (F_vmt K_A / b_e)/100 below 100 N/mm of line load, else 1, and C_b = 1 for a contact pattern over 85 % of the face, b_e =
0.85 b, which is taken. The standard knows no ripple and no size of the teeth. Reference: ISO 10300-1:2014, dynamic factor,
method B. Here the stiffness is c_gamma b_e in the transverse plane of the mean point.
"""

from __future__ import annotations

import math

import numpy as np

from rotorgear.gears.geometry.bevel import BevelPair
from rotorgear.gears.stiffness.iso import LOW_LINE_LOAD, UNIT
from rotorgear.gears.stiffness.mesh_stiffness import MeshStiffness

MESH_STIFFNESS = 20.0  # c_gamma0 in N/(mm um), of average conditions
PATTERN = 0.85  # b_e / b


def bevel_stiffness(pair: BevelPair, width: float, load: float | None, positions: int) -> MeshStiffness:
    """The estimate over one mesh period.

    Args:
        pair: the pitch cones.
        width: of the common face in m.
        load: F_bt in N; None counts as 100 N/mm of line load or more.
        positions: how many positions of the period.
    """
    face = PATTERN * width
    tangential = None if load is None else load * math.cos(pair.pressure_angle)
    share = 1.0 if tangential is None else min(tangential / face / LOW_LINE_LOAD, 1.0)
    return MeshStiffness(
        model="estimate of ISO 10300-1",
        position=np.arange(positions) / positions,
        transverse=np.full(positions, MESH_STIFFNESS * UNIT * share * face),
        definition="secant",
        load=load,
        body="a gear of average size, as ISO 10300-1 estimates it",
        base_helix_angle=pair.base_helix_angle,
    )
