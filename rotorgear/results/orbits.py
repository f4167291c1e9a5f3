"""Result of a continuation of periodic motions: branches with their stability, special points, and curves of these."""

from __future__ import annotations

from dataclasses import dataclass

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
    place_extremes: np.ndarray = of(
        "least and largest displacement at a place", "", "place", "extreme", default_factory=lambda: np.zeros((0, 2))
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
    place_extremes: np.ndarray = of(
        "least and largest displacement at a place",
        "",
        "curve_point",
        "place",
        "extreme",
        default_factory=lambda: np.zeros((0, 0, 2)),
    )


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
    """p points on b branches, c mesh contacts, places, H harmonics of the base period, k multipliers a point (NaN where fewer).

    Places are the displacements across bearings of rolling elements or oil films, across nonlinear elements, and at unbalances.
    """

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
        note=": largest relative difference of the coefficients at some points from a finer solution of the same method",
        default=float("nan"),
    )
    cpu_per_point: float = of("CPU time of a point", "s", json="cpu_seconds_per_point", default=float("nan"))
    place: tuple[str, ...] = of(
        "displacement that is told",
        "",
        "place",
        note=' across a bearing, a nonlinear element or at an unbalance, as `"bearings.front x"`',
        default=(),
    )
    place_unit: tuple[str, ...] = of(
        "unit of the displacement at a place", "", "place", note=', `"m"` or `"rad"`', default=()
    )
    place_extremes: np.ndarray = of(
        "least and largest displacement at a place",
        "",
        "point",
        "place",
        "extreme",
        default_factory=lambda: np.zeros((0, 0, 2)),
    )
    place_harmonics: np.ndarray = of(
        "coefficients of the displacement at a place",
        "",
        "point",
        "harmonic",
        "place",
        json=None,
        default_factory=lambda: np.zeros((0, 0, 0), complex),
    )

    statistic: tuple[str, ...] = of(
        "name of the statistic",
        "",
        "statistic",
        note=" of a contact whose error is estimated; transmission error and approach peak to peak",
        default=(),
    )
    statistics_error: np.ndarray = of(
        "estimated errors of the statistics",
        "",
        "point",
        "contact",
        "statistic",
        note=", each in its unit, at the value of the parameter; `null` beside a fold, where that tells no motion",
        default_factory=lambda: np.zeros((0, 0, 0)),
    )

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

    @derived("displacement at a place, peak to peak", "", "point", "place")
    def place_peak_to_peak(self) -> np.ndarray:
        """Of each point."""
        return np.asarray(np.ptp(self.place_extremes, axis=-1))

    def shown(self) -> Shown:
        """What tables and pictures show of the motions."""
        if self.contact:
            return Shown("approach", self.contact, "m", np.arange(len(self.contact)), of_contacts=True)
        unit = "m" if "m" in self.place_unit else "rad"
        own = np.array([k for k, one in enumerate(self.place_unit) if one == unit], int)
        return Shown("displacement", tuple(self.place[k] for k in own), unit, own, of_contacts=False)


@dataclass(frozen=True)
class Shown:
    """The approach of the contacts; without any, the displacements of the places, in metres where there are such.

    Attributes:
        what: the quantity. label, unit: of each, and of all. number: among contacts or places.
    """

    what: str
    label: tuple[str, ...]
    unit: str
    number: np.ndarray
    of_contacts: bool

    def peak_to_peak(self, motions: OrbitsResult | SpecialPoint | SpecialCurve) -> np.ndarray:
        """Over what is shown in the last place, in its unit."""
        extremes = motions.approach_extremes if self.of_contacts else motions.place_extremes
        return np.asarray(np.ptp(extremes[..., self.number, :], axis=-1))
