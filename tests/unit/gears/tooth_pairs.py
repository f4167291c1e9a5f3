"""Pairs for the tests of loaded teeth: spur and helical 34/80, and small meshes of them."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.pair import pair_geometry
from rotorgear.gears.loaded.mesh_cycle import MeshCycle, loaded_cycle
from rotorgear.gears.stiffness.mesh_stiffness import MeshStiffness, ToothPair
from rotorgear.gears.tooth_fe.points import MeshSize
from rotorgear.gears.tooth_fe.settings import ToothFe

WIDTH = 54e-3
COARSE = MeshSize(5, 2, 4, 2, 3, 4)
LOAD = 11_798.1


def pair(helix: float = 0.0, fe: ToothFe | None = None, addendum: float = 1.0, **given: Any) -> ToothPair:
    """Teeth 34/80, module 5 mm, 20 deg, face 54 mm, no shift, at the distance without backlash; helix in degrees."""
    gears = [
        GearGeometry(
            teeth=z,
            normal_module=5e-3,
            normal_pressure_angle=math.radians(20.0),
            helix_angle=math.radians(helix),
            addendum_factor=addendum,
        )
        for z in (34, 80)
    ]
    return ToothPair(gears[0], gears[1], pair_geometry(*gears, WIDTH), WIDTH, fe=fe or ToothFe(), **given)


def spur(**given: Any) -> ToothPair:
    """The spur pair with the default preset."""
    return pair(**given)


def helical(**given: Any) -> ToothPair:
    """The helical pair, 20.86 deg, on a coarse mesh in space."""
    return pair(20.86, ToothFe(size=COARSE), **given)


def cycle(teeth: ToothPair, load: float = LOAD, positions: int = 16) -> MeshCycle:
    """Loaded contact over one period."""
    return loaded_cycle(teeth, load, np.arange(positions) / positions)[1]


def swapped(teeth: ToothPair) -> ToothPair:
    """The same teeth with gear 2 as gear 1."""
    p = teeth.pair
    return replace(
        teeth,
        first=teeth.second,
        second=teeth.first,
        pair=replace(p, start_of_contact=-p.end_of_contact, end_of_contact=-p.start_of_contact),
        first_body=teeth.second_body,
        second_body=teeth.first_body,
        first_flank=teeth.second_flank,
        second_flank=teeth.first_flank,
    )


def harmonics(curve: MeshStiffness, count: int) -> np.ndarray:
    """Complex c_h (count,) in N/m of a curve at even positions: k(u) = mean + sum_h Re(c_h e^{2 pi i h u}), h = 1, 2 ..."""
    return np.asarray(2.0 * np.fft.fft(curve.transverse)[1 : count + 1] / len(curve.transverse))
