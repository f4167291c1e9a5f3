"""Flank tolerances of ISO 1328-1:2013 by class A, which the dynamic factor and the scatter of index errors need.

f_pT = (0.001 d + 0.4 m_n + 5) sqrt(2)^(A - 5),  f_f_alphaT = (0.55 m_n + 5) sqrt(2)^(A - 5),
F_pT = (0.002 d + 0.55 sqrt(d) + 0.7 m_n + 12) sqrt(2)^(A - 5), in um with d and m_n in mm; the base pitch
deviation is f_pb = f_pT cos a_t. The standard rounds them; here they are not rounded. Lengths in m.
"""

from __future__ import annotations

import math

from rotorgear.gears.geometry.geometry import GearGeometry

# Classes of the standard: 1 to 11.
FLANK_CLASSES = 11


def base_pitch_deviation(g: GearGeometry, grade: int) -> float:
    """f_pb (m) of a gear in a tolerance class."""
    # The standard's formulas give um for d and m_n in mm: 1e3 and 1e-6 are those units.
    pitch = 0.001 * 1e3 * abs(g.reference_diameter) + 0.4 * 1e3 * g.normal_module + 5.0
    return 1e-6 * pitch * _step(grade) * math.cos(g.transverse_pressure_angle)


def profile_form_deviation(g: GearGeometry, grade: int) -> float:
    """f_f_alpha (m) of a gear in a tolerance class."""
    return 1e-6 * (0.55 * 1e3 * g.normal_module + 5.0) * _step(grade)


def cumulative_pitch_tolerance(g: GearGeometry, grade: int) -> float:
    """F_pT (m) of a gear in a tolerance class: total cumulative pitch deviation, along the reference circle."""
    d = 1e3 * abs(g.reference_diameter)
    return 1e-6 * (0.002 * d + 0.55 * math.sqrt(d) + 0.7 * 1e3 * g.normal_module + 12.0) * _step(grade)


def _step(grade: int) -> float:
    """Ratio of a class's tolerance to that of class 5, in which the formulas are written."""
    return math.sqrt(2.0) ** (grade - 5)
