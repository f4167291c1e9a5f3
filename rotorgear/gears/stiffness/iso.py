"""Tooth and mesh stiffness of ISO 6336-1: c', c_gamma_alpha and c_gamma_beta.

q' = C1 + C2/z_n1 + C3/z_n2 + C4 x1 + C5 x1/z_n1 + C6 x2 + C7 x2/z_n2 + C8 x1^2 + C9 x2^2,   c'_th = 1/q'
c' = c'_th C_M C_R C_B cos b,   c_gamma_alpha = c' (0.75 eps_alpha + 0.25),   c_gamma_beta = 0.85 c_gamma_alpha
C_R = 1 + ln(b_s / b) / (5 e^(s_R / 5 m_n)) for a web b_s and a rim s_R, 0.2 <= b_s/b <= 1.2, s_R/m_n >= 1; the mean of both
gears. Below 100 N/mm of line load c' is reduced by (F_t K_A / b / 100)^0.25. The standard is for steel, E = 206 GPa; other
moduli in proportion to the reduced modulus. Of a ring 1/z_n2 = 0: the standard takes its teeth as those of a rack.
Reference: ISO 6336-1:2006, clause 9, method B. The standard's unit is
N/(mm um); here it is N/m^2 = 1e-9 N/(mm um).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.stiffness.mesh_stiffness import MeshStiffness, ToothBody, ToothPair

UNIT = 1e9  # N/(mm um) in N/m^2
# C1 ... C9 of the standard's polynomial for q'.
_C = (0.04723, 0.15551, 0.25791, -0.00635, -0.11654, -0.00193, -0.24188, 0.00529, 0.00182)
CORRECTION = 0.8  # C_M, solid disk gears
LOW_LINE_LOAD = 1e5  # N/m
_STEEL = 206e9  # Pa, the standard's modulus


@dataclass(frozen=True)
class IsoStiffness:
    """Stiffness per face width in N/m^2, in the transverse plane: theoretical single, single, mesh for K_v and for K_H_beta."""

    theoretical: float
    single: float
    mesh_alpha: float
    mesh_beta: float
    warnings: tuple[str, ...]


def iso_tooth_stiffness(
    g1: GearGeometry,
    g2: GearGeometry,
    transverse_contact_ratio: float,
    *,
    line_load: float | None = None,
    gear_blank_factor: float = 1.0,
    modulus_ratio: float = 1.0,
) -> IsoStiffness:
    """c'_th, c', c_gamma_alpha and c_gamma_beta of a pair.

    Args:
        g1: one gear; that with fewer teeth is taken as the standard's pinion.
        g2: the other one.
        transverse_contact_ratio: eps_alpha.
        line_load: F_t K_A / b (N/m); None counts as 100 N/mm or more.
        gear_blank_factor: C_R, 1 for solid disks.
        modulus_ratio: E / 206 GPa, with E = 2 E1 E2 / (E1 + E2).
    """
    pinion, wheel = (g1, g2) if abs(g1.teeth) <= abs(g2.teeth) else (g2, g1)
    zn1 = pinion.virtual_teeth
    zn2 = math.inf if wheel.is_internal else wheel.virtual_teeth
    x1 = pinion.profile_shift
    x2 = wheel.profile_shift
    terms = (1.0, 1.0 / zn1, 1.0 / zn2, x1, x1 / zn1, x2, x2 / zn2, x1**2, x2**2)
    theoretical = UNIT * modulus_ratio / sum(c * term for c, term in zip(_C, terms, strict=True))
    # C_B of a pair whose racks differ: the mean of both.
    rack = 0.5 * sum(
        (1.0 + 0.5 * (1.2 - g.dedendum_factor)) * (1.0 - 0.02 * (20.0 - math.degrees(g.normal_pressure_angle)))
        for g in (pinion, wheel)
    )
    single = theoretical * CORRECTION * gear_blank_factor * rack * math.cos(pinion.helix_angle)

    warnings: tuple[str, ...] = ()
    if pinion.profile_shift < wheel.profile_shift or not -0.5 <= pinion.profile_shift + wheel.profile_shift <= 2.0:
        warnings += ("the profile shifts lie outside the range of ISO 6336-1 (x1 >= x2, -0.5 <= x1 + x2 <= 2)",)
    if transverse_contact_ratio >= 2.5 or transverse_contact_ratio < 1.2:
        warnings += (
            f"eps_alpha = {transverse_contact_ratio:.3g} lies outside 1.2 ... 2.5, the range of ISO 6336-1 for c_gamma",
        )
    if line_load is not None and line_load < LOW_LINE_LOAD:
        single *= (line_load / LOW_LINE_LOAD) ** 0.25
        warnings += (f"line load {1e-3 * line_load:.3g} N/mm is below 100 N/mm: c' is reduced as ISO 6336-1 has it",)
    alpha = single * (0.75 * transverse_contact_ratio + 0.25)
    return IsoStiffness(theoretical, single, alpha, 0.85 * alpha, warnings)


def pair_iso_stiffness(teeth: ToothPair, line_load: float | None = None) -> IsoStiffness:
    """The standard's stiffness of a pair with its blanks and moduli, at a line load F_t K_A / b (N/m)."""
    e1 = teeth.first_body.youngs_modulus
    e2 = teeth.second_body.youngs_modulus
    return iso_tooth_stiffness(
        teeth.first,
        teeth.second,
        teeth.pair.transverse_contact_ratio,
        line_load=line_load,
        gear_blank_factor=blank_factor(teeth),
        modulus_ratio=2.0 * e1 * e2 / (e1 + e2) / _STEEL,
    )


def blank_factor(teeth: ToothPair) -> float:
    """C_R of a pair: the mean of both gears."""

    def of(body: ToothBody) -> float:
        if body.rim_thickness is None:
            return 1.0
        # Beyond the standard's range its ends are taken: s_R / m_n >= 1 and 0.2 <= b_s / b <= 1.2.
        rim = max(body.rim_thickness / teeth.first.normal_module, 1.0)
        return 1.0 + math.log(min(max(body.web_share, 0.2), 1.2)) / (5.0 * math.exp(rim / 5.0))

    return 0.5 * (of(teeth.first_body) + of(teeth.second_body))


def iso_stiffness(teeth: ToothPair, load: float | None, positions: int) -> MeshStiffness:
    """Mean mesh stiffness c_gamma_alpha b over the period, without ripple."""
    # The standard's load is F_t at the reference circle, ours F_bt at the base circle: F_t = F_bt cos a_t.
    line_load = None if load is None else load * math.cos(teeth.first.transverse_pressure_angle) / teeth.width
    values = pair_iso_stiffness(teeth, line_load)
    k = np.full(positions, values.mesh_alpha * teeth.width)
    nominal = "a tip reaches past the base tangent point of its mate (interference): the contact ratio is nominal"
    warnings = (*values.warnings, nominal) if teeth.pair.interference else values.warnings
    body = f"blanks as in ISO 6336-1 (C_R = {blank_factor(teeth):.3f}); the approach is that of the teeth"
    return MeshStiffness(
        model="iso",
        position=np.arange(positions) / positions,
        transverse=k,
        definition="secant",
        load=load,
        body=body,
        base_helix_angle=teeth.pair.base_helix_angle,
        warnings=warnings,
    )
