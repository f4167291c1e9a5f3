"""Result of a continuation of periodic motions: branches with their stability, special points, and curves of these."""

from __future__ import annotations

import numpy as np

from rotorgear.results.result import ModelResult
from rotorgear.results.schema import Record, derived, of


class SpecialPoint(Record):
    """A point where a branch changes its stability."""

    kind: str = of("kind", note=': `"fold"`, `"period doubling"` or `"Neimark-Sacker"`')
    value: float = of("value of the parameter", note=", in SI")
    branch: int = of("branch", note=", counted from 0")
    period: float = of("period", "s", json="period_s")
    multiplier_real: np.ndarray = of("real part of the Floquet multipliers", "", "multiplier", note=", largest first")
    multiplier_imaginary: np.ndarray = of("imaginary part of the Floquet multipliers", "", "multiplier")
    approach_extremes: np.ndarray = of(
        "least and largest approach of the flanks", "m", "contact", "extreme", json="approach_extremes_m"
    )


class OrbitBranch(Record):
    """A branch."""

    name: str = of("name", note=': `"1T"`, or `"2T"` of the branch behind a period doubling')
    periods: int = of("base periods in a period of the motion")
    ended: str = of("why it ended")


class SpecialCurve(Record):
    """Where a special point goes as a second parameter changes."""

    kind: str = of("kind", note=': `"fold"` or `"period doubling"`')
    branch: int = of("branch", note=", counted from 0, that it begins on")
    value: np.ndarray = of("value of the parameter", "", "curve_point", note=", the first one, in SI")
    second: np.ndarray = of("value of the second parameter", "", "curve_point", note=", in SI")
    period: np.ndarray = of("period", "s", "curve_point", json="period_s")
    approach_extremes: np.ndarray = of(
        "least and largest approach of the flanks",
        "m",
        "curve_point",
        "contact",
        "extreme",
        json="approach_extremes_m",
    )
    ended: str = of("why it ended")


class OrbitVerification(Record):
    """What a transient that was started on an orbit did."""

    value: float = of("value of the parameter", note=", in SI")
    stable: bool = of("whether the orbit is stable by its multipliers")
    deviation: float = of(
        "largest deviation from the orbit after the first period", note=", over the peak to peak of the displacement"
    )
    growth: float = of("measured growth of the deviation in a period", note="; `null` where it can't be told")
    expected: float = of("largest Floquet multiplier, its size")
    periods: int = of("periods that were run")


class OrbitsResult(ModelResult, kind="orbits"):
    """p points on b branches, c mesh contacts, H harmonics of the base period, k multipliers a point (NaN where fewer)."""

    address: tuple[str, ...] = of("address of a parameter", "", "parameter", note=": what was changed")
    unit: tuple[str, ...] = of("unit", "", "parameter", note=' the range was given in, or `""` for SI')
    per_unit: np.ndarray = of("SI of one unit of the range", "", "parameter", json=None)
    excited: str = of("what excites", note="; all other parts are at their mean")
    order: float = of("base periods in a turn of the input shaft")
    contact: tuple[str, ...] = of("names of the contacts", "", "contact")
    branches: tuple[OrbitBranch, ...] = of("branches", "", "branch", record=OrbitBranch)
    branch: np.ndarray = of("branch", "", "point", note=", counted from 0")
    value: np.ndarray = of("value of the parameter", "", "point", note=", in SI")
    period: np.ndarray = of("period", "s", "point", json="period_s")
    stable: np.ndarray = of("whether the motion is stable", "", "point")
    multipliers: np.ndarray = of("Floquet multipliers", "", "point", "multiplier", json=None)
    approach_extremes: np.ndarray = of(
        "least and largest approach of the flanks",
        "m",
        "point",
        "contact",
        "extreme",
        json="approach_extremes_m",
        note=", transverse",
    )
    peak_to_peak_transmission_error: np.ndarray = of(
        "transmission error, peak to peak", "m", "point", "contact", json="peak_to_peak_transmission_error_m"
    )
    mean_force: np.ndarray = of("mean force", "N", "point", "contact", json="mean_force_n")
    rms_force: np.ndarray = of(
        "root mean square of the force about its mean", "N", "point", "contact", json="rms_force_n"
    )
    largest_force: np.ndarray = of("largest force", "N", "point", "contact", json="largest_force_n")
    apart: np.ndarray = of("contact-loss ratio", "", "point", "contact", json="apart_share")
    back: np.ndarray = of("share of the time on the coast flank", "", "point", "contact", json="back_share")
    force_harmonics: np.ndarray = of(
        "coefficients of the mesh force, F = Re sum c_h exp(i h w t)", "N", "point", "harmonic", "contact", json=None
    )
    displacement_harmonics: np.ndarray = of(
        "coefficients of the displacement along the flank normal",
        "m",
        "point",
        "harmonic",
        "contact",
        json=None,
    )
    special_points: tuple[SpecialPoint, ...] = of("special points", "", "special_point", record=SpecialPoint)
    curves: tuple[SpecialCurve, ...] = of(
        "curves of special points over two parameters", "", "curve", record=SpecialCurve, default=()
    )
    verifications: tuple[OrbitVerification, ...] = of(
        "transients started on orbits", "", "verification", record=OrbitVerification, default=()
    )
    harmonics: int = of("harmonics of the base period", default=0)
    instants: int = of("instants in a base period", default=0)
    error_estimate: float = of(
        "error estimate",
        note=": largest relative difference of the coefficients at some points from those with twice the harmonics and instants",
        default=float("nan"),
    )
    cpu_per_point: float = of("CPU time of a point", "s", json="cpu_seconds_per_point", default=float("nan"))

    @derived("real part of the Floquet multipliers", "", "point", "multiplier", note=", largest first")
    def multiplier_real(self) -> np.ndarray:
        """Of each point."""
        return np.asarray(self.multipliers.real)

    @derived("imaginary part of the Floquet multipliers", "", "point", "multiplier")
    def multiplier_imaginary(self) -> np.ndarray:
        """Of each point."""
        return np.asarray(self.multipliers.imag)

    @derived("approach, peak to peak", "m", "point", "contact", json="peak_to_peak_approach_m")
    def peak_to_peak_approach(self) -> np.ndarray:
        """Of each point."""
        return np.asarray(self.approach_extremes[:, :, 1] - self.approach_extremes[:, :, 0])

    @derived("amplitude of the mesh force's first harmonic", "N", "point", "contact", json="first_harmonic_n")
    def first_harmonic(self) -> np.ndarray:
        """Of each point: of the harmonic that the base period brings."""
        return np.abs(self.force_harmonics[:, 1])
