"""Internal dynamic factor K_v: ISO 6336-1 method B, and the simple form of DIN 3990-1 method C.

Method B: N = n1 / n_E1 with the resonance speed w_E1 = sqrt(c_gamma_alpha / m_red) / z1, m_red per face width from
1 / m_red = r_b1^2 b / J1 + r_b2^2 b / J2, and
    B_p = c' (f_pb - y_p) / w,  B_f = c' (f_fa - y_f) / w,  B_k = |1 - c' C_a / w|,  w = F_t K_A / b
    N <= N_S            K_v = 1 + N (C_v1 B_p + C_v2 B_f + C_v3 B_k)          subcritical
    N_S < N <= 1.15     K_v = 1 + C_v1 B_p + C_v2 B_f + C_v4 B_k              main resonance
    1.15 < N < 1.5      linear in N between both neighbours
    N >= 1.5            K_v = C_v5 B_p + C_v6 B_f + C_v7                      supercritical
Method C: K_v = 1 + (K1 / w + K2) v z1/100 sqrt(u^2 / (1 + u^2)), w in N/mm, at least 100.
Reference: ISO 6336-1:2006, clause 6.5; DIN 3990-1:1987, method C. SI units.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from rotorgear.errors import AnalysisError

_LOW_LINE_LOAD = 1e5  # N/m
# K1 of accuracy grades 3 ... 12, and K2, of spur gears and of helical ones with eps_beta >= 1.
_K1_SPUR = (2.1, 3.9, 7.5, 14.9, 26.8, 39.1, 52.8, 76.6, 102.6, 146.3)
_K1_HELICAL = (1.9, 3.5, 6.7, 13.3, 23.9, 34.8, 47.0, 68.2, 91.4, 130.3)
_K2_SPUR = 0.0193
_K2_HELICAL = 0.0087
# Limits of v z1/100 sqrt(u^2/(1+u^2)) in m/s: method B is meant for faster gears than the first, method C holds up to the second.
_LEAST_B = 3.0
_MOST_C = 10.0
# Running in takes this share off a deviation of hardened gears, and no more than 3 um (m).
_RUN_IN = 0.075
_MOST_RUN_IN = 3e-6


@dataclass(frozen=True)
class DynamicFactor:
    """K_v with the method it comes from; resonance ratio N only of method B."""

    value: float
    method: str
    resonance_ratio: float | None = None
    warnings: tuple[str, ...] = ()


def reduced_mass(inertias: Sequence[float], base_radii: Sequence[float], width: float) -> float:
    """m_red (kg/m) per face width (m) from the polar inertias (kg m^2) and base radii (m) of both gears."""
    return 1.0 / (width * sum(r**2 / J for r, J in zip(base_radii, inertias, strict=True)))


def iso_dynamic_factor(
    *,
    pinion_teeth: int,
    ratio: float,
    pinion_speed: float,
    pitch_line_velocity: float,
    total_contact_ratio: float,
    line_load: float,
    single_stiffness: float,
    mesh_stiffness: float,
    reduced_mass: float,
    base_pitch_deviation: float,
    profile_deviation: float,
    tip_relief: float = 0.0,
) -> DynamicFactor:
    """K_v by method B, of one helix: the pinion is the gear with fewer teeth.

    Args:
        pinion_teeth: z1.
        ratio: u = z2 / z1.
        pinion_speed: rad/s.
        pitch_line_velocity: v (m/s).
        total_contact_ratio: eps_gamma.
        line_load: w = F_t K_A / b (N/m).
        single_stiffness: c' (N/m^2).
        mesh_stiffness: c_gamma_alpha (N/m^2).
        reduced_mass: m_red per face width (kg/m).
        base_pitch_deviation: f_pb (m), the larger of both gears.
        profile_deviation: f_fa (m), the larger of both gears.
        tip_relief: C_a (m), or the running-in amount C_ay.

    Raises:
        AnalysisError: a total contact ratio of 1 or less, or no load.
    """
    if total_contact_ratio <= 1.0:
        raise AnalysisError(f"K_v of ISO 6336-1 needs a total contact ratio above 1, not {total_contact_ratio:.4g}.")
    if not line_load > 0.0:
        raise AnalysisError("K_v of ISO 6336-1 needs a load: give the torque or power that the mesh carries.")

    # B_p, B_f, B_k: deviations that are left after running in, and relief, in terms of the deflection w / c'.
    left_pitch, left_profile = (
        deviation - min(_RUN_IN * deviation, _MOST_RUN_IN) for deviation in (base_pitch_deviation, profile_deviation)
    )
    per_deflection = single_stiffness / line_load
    B_p = per_deflection * left_pitch
    B_f = per_deflection * left_profile
    B_k = abs(1.0 - per_deflection * tip_relief)

    # C_v1 ... C_v7 of the standard's table: one column up to eps_gamma = 2, another above.
    eps = total_contact_ratio
    C1 = 0.32
    C2 = 0.34 if eps <= 2.0 else 0.57 / (eps - 0.3)
    C3 = 0.23 if eps <= 2.0 else 0.096 / (eps - 1.56)
    C4 = 0.90 if eps <= 2.0 else (0.57 - 0.05 * eps) / (eps - 1.44)
    C5 = 0.47
    C6 = 0.47 if eps <= 2.0 else 0.12 / (eps - 1.74)
    C7 = 0.75 if eps <= 1.5 else 1.0 if eps > 2.5 else 0.125 * math.sin(math.pi * (eps - 2.0)) + 0.875

    # N_S: under light load the range of the main resonance begins at a lower speed.
    subcritical_end = 0.5 + 0.35 * math.sqrt(line_load / _LOW_LINE_LOAD) if line_load < _LOW_LINE_LOAD else 0.85
    # Over w_E1, where the mesh frequency meets the pair's own.
    N = pinion_speed / (math.sqrt(mesh_stiffness / reduced_mass) / pinion_teeth)
    resonance = 1.0 + C1 * B_p + C2 * B_f + C4 * B_k
    beyond = C5 * B_p + C6 * B_f + C7
    if subcritical_end >= N:
        value = 1.0 + N * (C1 * B_p + C2 * B_f + C3 * B_k)
    elif N <= 1.15:
        value = resonance
    elif N < 1.5:
        value = beyond + (resonance - beyond) * (1.5 - N) / 0.35
    else:
        value = beyond
    slow = _speed_term(pitch_line_velocity, pinion_teeth, ratio) < _LEAST_B
    note = ("K_v: v z1/100 sqrt(u^2/(1+u^2)) is below 3 m/s, where method B is not meant for use",) if slow else ()
    return DynamicFactor(value, "ISO 6336-1 method B", N, note)


def _speed_term(velocity: float, pinion_teeth: int, ratio: float) -> float:
    """v z1/100 sqrt(u^2 / (1 + u^2)) in m/s."""
    return velocity * pinion_teeth / 100.0 * math.sqrt(ratio**2 / (1.0 + ratio**2))


def simple_dynamic_factor(
    pitch_line_velocity: float, pinion_teeth: int, ratio: float, line_load: float, overlap_ratio: float, grade: int
) -> DynamicFactor:
    """K_v by the simple form of DIN 3990-1, method C.

    Args:
        pitch_line_velocity: v (m/s) at the reference circle.
        pinion_teeth, ratio: z1 and u = z2 / z1 >= 1.
        line_load: F_t K_A / b (N/m); below 100 N/mm it counts as that.
        overlap_ratio: eps_beta; between 0 and 1 the values of spur and helical gears are interpolated.
        grade: accuracy grade 3 ... 12.

    Raises:
        AnalysisError: a grade outside.
    """
    if not 3 <= grade <= 12:
        raise AnalysisError(f"The simple form of K_v knows accuracy grades 3 to 12, not {grade}.")
    speed = _speed_term(pitch_line_velocity, pinion_teeth, ratio)
    load = 1e-3 * max(line_load, _LOW_LINE_LOAD)
    spur = 1.0 + (_K1_SPUR[grade - 3] / load + _K2_SPUR) * speed
    helical = 1.0 + (_K1_HELICAL[grade - 3] / load + _K2_HELICAL) * speed
    note = (f"K_v: v z1/100 sqrt(u^2/(1+u^2)) = {speed:.3g} m/s is beyond 10 m/s, the range of method C",)
    value = spur - min(overlap_ratio, 1.0) * (spur - helical)
    return DynamicFactor(value, "DIN 3990-1 method C (simple form)", warnings=note if speed > _MOST_C else ())
