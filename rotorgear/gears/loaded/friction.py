"""Coefficients of friction between tooth flanks as plain functions, for estimates of one's own.

All return a coefficient mu >= 0 (or signed, where the sliding velocity's sign is an input). SI units; those of a published
regression are converted inside. The law that acts in analyses, with Benedict and Kelley's formula, is `forces.mesh_friction`.
"""

from __future__ import annotations

import math

from rotorgear.errors import AnalysisError


def _require_positive(**values: float) -> None:
    """AnalysisError unless every named value is positive and finite: powers and logarithms of it are taken."""
    for name, value in values.items():
        if not 0.0 < value < math.inf:
            raise AnalysisError(
                f"The {name.replace('_', ' ')} of a friction law must be positive and finite, not {value:g}."
            )


def saturating_friction(sliding_velocity: float, limit: float, decay: float) -> float:
    """mu = mu_0 sgn(v_s) (1 - exp(-a |v_s|)), signed like the sliding velocity v_s (m/s).

    `limit` is mu_0, `decay` is a (s/m). It goes through zero at the pitch point without a jump.
    """
    _require_positive(decay=decay)
    return limit * math.copysign(-math.expm1(-decay * abs(sliding_velocity)), sliding_velocity)


# b1 ... b9 of the regression.
_XU = (-8.916465, 1.03303, 1.036077, -0.354068, 2.812084, -0.100601, 0.752755, -0.390958, 0.620305)


def xu_kahraman_friction(
    slide_to_roll: float,
    hertz_pressure: float,
    viscosity: float,
    entraining_velocity: float,
    curvature_radius: float,
    roughness: float,
) -> float:
    """Xu, Kahraman, Anderson and Maddock, Journal of Mechanical Design 129 (2007) 982: regression of EHL calculations.

    mu = exp(f) P^b2 |SR|^b3 V^b6 nu^b7 R^b8,
    f = b1 + b4 |SR| P log10(nu) + b5 exp(-|SR| P log10(nu)) + b9 exp(S).

    Args:
        slide_to_roll: SR, sliding velocity over entraining velocity (mean of both surfaces').
        hertz_pressure: largest (Pa); the regression's P is in GPa.
        viscosity: dynamic, at inlet temperature (Pa s); the regression's nu is in cP.
        entraining_velocity: V (m/s).
        curvature_radius: R (m), reduced.
        roughness: S (m), root mean square of both flanks; the regression's is in um.

    Returns:
        mu, 0 in pure rolling.
    """
    _require_positive(
        hertz_pressure=hertz_pressure,
        viscosity=viscosity,
        entraining_velocity=entraining_velocity,
        curvature_radius=curvature_radius,
    )
    slide = abs(slide_to_roll)
    if slide == 0.0:
        return 0.0
    b1, b2, b3, b4, b5, b6, b7, b8, b9 = _XU
    P = 1e-9 * hertz_pressure
    nu = 1e3 * viscosity
    common = slide * P * math.log10(nu)
    f = b1 + b4 * common + b5 * math.exp(-common) + b9 * math.exp(1e6 * roughness)
    return math.exp(f) * P**b2 * slide**b3 * entraining_velocity**b6 * nu**b7 * curvature_radius**b8


def mean_mesh_friction(
    line_load: float, sum_velocity: float, curvature_radius: float, viscosity: float, roughness_factor: float = 1.0
) -> float:
    """DIN 3990-4: mean along the path of contact, mu = 0.045 (w / (v_sum rho))^0.2 eta^-0.05 X_R.

    The regression's units are N/mm, m/s, mm and mPa s.

    Args:
        line_load: w = K F_bt / b (N/m).
        sum_velocity: v_sum of both surfaces at the pitch point (m/s).
        curvature_radius: rho (m), reduced, at the pitch point.
        viscosity: eta (Pa s), dynamic, at oil temperature.
        roughness_factor: X_R.
    """
    _require_positive(
        line_load=line_load, sum_velocity=sum_velocity, curvature_radius=curvature_radius, viscosity=viscosity
    )
    term = 1e-3 * line_load / (sum_velocity * 1e3 * curvature_radius)
    return 0.045 * term**0.2 * (1e3 * viscosity) ** -0.05 * roughness_factor
