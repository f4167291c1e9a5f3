"""Result of a continuation of periodic motions: branches with their stability, special points, and curves of these."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import numpy as np

from rotorgear.quantity import counted
from rotorgear.results.result import ModelResult, statistic_names
from rotorgear.results.schema import Record, derived, of
from rotorgear.results.table import Block, Line, Table, error_words, grid, written

# Points of a branch that are listed; all are in the files.
_SHOWN = 12
_NO_PLACES = partial(np.zeros, (0, 0, 2))


class SpecialPoint(Record):
    """A point where a branch changes its stability."""

    kind: str = of("kind", note=': `"fold"`, `"period doubling"` or `"Neimark-Sacker"`')
    value: float = of("value of the parameter", note=", in SI")
    branch: int = of("branch", note=", counted from 0")
    period: float = of("period", "s")
    multiplier_real: np.ndarray = of("real part of the Floquet multipliers", "", "multiplier", note=", largest first")
    multiplier_imaginary: np.ndarray = of("imaginary part of the Floquet multipliers", "", "multiplier")
    approach_extremes: np.ndarray = of("least and largest approach of the flanks", "m", "contact", "extreme")
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
    period: np.ndarray = of("period", "s", "curve_point")
    approach_extremes: np.ndarray = of(
        "least and largest approach of the flanks", "m", "curve_point", "contact", "extreme"
    )
    ended: str = of("why it ended")
    place_extremes: np.ndarray = of(
        "least and largest displacement at a place", "", "curve_point", "place", "extreme", default_factory=_NO_PLACES
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
    contact: tuple[str, ...] = of("name of the contact", "", "contact", note=": mesh and helix")
    branches: tuple[OrbitBranch, ...] = of("branches", "", "branch", record=OrbitBranch)
    branch: np.ndarray = of("branch", "", "point", note=", counted from 0")
    value: np.ndarray = of("value of the parameter", "", "point", note=", in SI")
    period: np.ndarray = of("period", "s", "point")
    stable: np.ndarray = of("whether the motion is stable", "", "point")
    multipliers: np.ndarray = of("Floquet multipliers", "", "point", "multiplier", json=None)
    approach_extremes: np.ndarray = of(
        "least and largest approach of the flanks", "m", "point", "contact", "extreme", note=", transverse"
    )
    peak_to_peak_transmission_error: np.ndarray = of("transmission error, peak to peak", "m", "point", "contact")
    mean_force: np.ndarray = of("mean force", "N", "point", "contact")
    rms_force: np.ndarray = of("root mean square of the force about its mean", "N", "point", "contact")
    largest_force: np.ndarray = of("largest force", "N", "point", "contact")
    apart: np.ndarray = of("contact-loss ratio", "", "point", "contact", json="apart_share")
    back: np.ndarray = of("share of the time on the coast flank", "", "point", "contact", json="back_share")
    force_harmonics: np.ndarray = of(
        "coefficients of the mesh force, F = Re sum c_h exp(i h w t)", "N", "point", "harmonic", "contact", json=None
    )
    displacement_harmonics: np.ndarray = of(
        "coefficients of the displacement along the flank normal", "m", "point", "harmonic", "contact", json=None
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
        "error estimate", note=": largest relative change of the coefficients in a finer solution", default=float("nan")
    )
    cpu_per_point: float = of("CPU time of a point", "s", json="cpu_seconds_per_point", default=float("nan"))
    place: tuple[str, ...] = of(
        "place of the displacement", "", "place", note=', such as `"bearings.front x"`', default=()
    )
    place_unit: tuple[str, ...] = of(
        "unit of the displacement at a place", "", "place", note=', `"m"` or `"rad"`', default=()
    )
    place_extremes: np.ndarray = of(
        "least and largest displacement at a place", "", "point", "place", "extreme", default_factory=_NO_PLACES
    )
    place_harmonics: np.ndarray = of(
        "coefficients of a displacement",
        "",
        "point",
        "harmonic",
        "place",
        json=None,
        default_factory=partial(np.zeros, (0, 0, 0), complex),
    )

    statistic: tuple[str, ...] = statistic_names()
    statistics_error: np.ndarray = of(
        "estimated errors of the statistics",
        "",
        "point",
        "contact",
        "statistic",
        note=", each in its unit, at the value of the parameter; `null` beside a fold, where that tells no motion",
        default_factory=lambda: np.zeros((0, 0, 0)),
    )

    place_error: np.ndarray = of(
        "estimated error of the displacement at a place, peak to peak",
        "",
        "point",
        "place",
        note="; `null` beside a fold",
        default_factory=partial(np.zeros, (0, 0)),
    )

    load_points: tuple[str, ...] = of("names of the points that read a load", "", "gauge", default=(), kw_only=True)
    load_unit: tuple[str, ...] = of("unit of the load that a point reads", "", "gauge", default=(), kw_only=True)
    load_statistics: np.ndarray = of(
        "mean, rms about it, largest and smallest load inside a shaft or coupling",
        "N, N m",
        "point",
        "gauge",
        "load_statistic",
        default_factory=partial(np.zeros, (0, 0, 4)),
        kw_only=True,
    )
    load_error: np.ndarray = of(
        "estimated errors of these loads",
        "N, N m",
        "point",
        "gauge",
        "load_statistic",
        note="; `null` beside a fold",
        default_factory=partial(np.zeros, (0, 0, 4)),
        kw_only=True,
    )

    @derived("real part of the Floquet multipliers", "", "point", "multiplier", note=", largest first")
    def multiplier_real(self) -> np.ndarray:
        """Of each point."""
        return np.asarray(self.multipliers.real)

    @derived("imaginary part of the Floquet multipliers", "", "point", "multiplier")
    def multiplier_imaginary(self) -> np.ndarray:
        """Of each point."""
        return np.asarray(self.multipliers.imag)

    @derived("approach, peak to peak", "m", "point", "contact")
    def peak_to_peak_approach(self) -> np.ndarray:
        """Of each point."""
        return np.asarray(self.approach_extremes[:, :, 1] - self.approach_extremes[:, :, 0])

    @derived("amplitude of the mesh force's first harmonic", "N", "point", "contact")
    def first_harmonic(self) -> np.ndarray:
        """Of each point: of the harmonic that the base period brings."""
        return np.abs(self.force_harmonics[:, 1])

    @derived("displacement at a place, peak to peak", "", "point", "place")
    def place_peak_to_peak(self) -> np.ndarray:
        """Of each point."""
        return np.asarray(np.ptp(self.place_extremes, axis=-1))

    @property
    def shown_unit(self) -> str:
        """The unit of what tables and pictures show of the motions: metres where anything moves along a line."""
        return "m" if self.contact or "m" in self.place_unit else "rad"

    @property
    def shown(self) -> tuple[str, ...]:
        """What tables and pictures show of the motions: the approach of contacts; without any, displacements of places."""
        return self.contact or tuple(self.place[k] for k in self._shown_places)

    @property
    def _shown_places(self) -> list[int]:
        return [k for k, unit in enumerate(self.place_unit) if unit == self.shown_unit]

    def peak_to_peak_of(self, motions: OrbitsResult | SpecialPoint | SpecialCurve) -> np.ndarray:
        """Peak to peak of what is shown, over it in the last place, in its unit."""
        extremes = motions.approach_extremes if self.contact else motions.place_extremes[..., self._shown_places, :]
        return np.asarray(np.ptp(extremes, axis=-1))

    def tables(self) -> Iterator[Block]:
        """Special points, branches, curves, transients started on orbits, and notes."""
        yield Line(f"{self.model.title or 'Orbits'}: periodic motions over {self.address[0]}")
        yield from ("", f"excited by {self.excited}", "", "Special points")
        yield self._special() if self.special_points else "none"
        for number in range(len(self.branches)):
            yield from ("", *self._branch(number))
        for curve in self.curves:
            yield from ("", *self._curve(curve))
        if self.verifications:
            yield from ("", "Transients started on orbits", self._started())
        shown = f"p-p: largest peak to peak of {', '.join(self.shown)}"
        if self.contact:
            shown = "p-p: approach of the flanks, peak to peak, F max, loss: of the worst contact; error: relative"
        yield from ("", f"|mu|: largest Floquet multiplier; {shown}", f"{self.dofs} dofs; {self.method}")
        yield f"{self.cpu_per_point:.3g} CPU s a point, {self.cost} in all"
        if self.error_estimate == self.error_estimate:
            yield f"error estimate {error_words(self.error_estimate, 1)} of the motions' coefficients"
        yield from (*self.remarks(), "")

    def _value(self, si: float, parameter: int = 0) -> str:
        return f"{si / self.per_unit[parameter]:.8g}"

    def _head(self, parameter: int = 0) -> str:
        return f"{self.address[parameter].rpartition('.')[2]} {self.unit[parameter]}".strip()

    def _special(self) -> Table:
        rows = []
        for point in self.special_points:
            mu = point.multiplier_real + 1j * point.multiplier_imaginary
            words = (f"{z.real:.4g}" if abs(z.imag) < 1e-9 else f"{z.real:.3g}{z.imag:+.3g}i" for z in mu[:3])
            branch = self.branches[point.branch].name
            rows.append((point.kind, self._value(point.value), branch, f"{1e3 * point.period:.4g}", ", ".join(words)))
        return grid(rows, "kind", self._head(), "branch", "period\nms", "multipliers", caption="Special points")

    def _branch(self, number: int) -> Iterator[Block]:
        own = np.flatnonzero(self.branch == number)
        branch = self.branches[number]
        yield f"Branch {branch.name}: {counted(len(own), 'points')}, {int(self.stable[own].sum())} stable, to {branch.ended}"
        sizes = self.peak_to_peak_of(self)
        rows = []
        for i in own[_spread(len(own))]:
            worst = int(np.argmax(sizes[i]))
            size = float(np.nanmax(np.abs(self.multipliers[i])))
            cells = [self._value(float(self.value[i])), written(bool(self.stable[i])), f"{size:.4f}"]
            cells += [f"{1e6 * sizes[i, worst]:.4g}", self._error(i, worst, "approach", sizes[i, worst])]
            if self.contact:
                mean, largest, loss = (float(x[i, worst]) for x in (self.mean_force, self.largest_force, self.apart))
                cells += [f"{mean:.4g}", self._error(i, worst, "mean force", mean)]
                cells += [f"{largest:.4g}", self._error(i, worst, "largest force", largest)]
                cells += [f"{100.0 * loss:.1f}", self._error(i, worst, "contact loss", 1.0)]
            rows.append(cells)
        forces = ("F mean\nN", "error", "F max\nN", "error", "loss\n%", "error") if self.contact else ()
        heads = (self._head(), "stable", "|mu|", f"p-p\nu{self.shown_unit}", "error", *forces)
        yield grid(rows, *heads, left=0, caption=f"Branch {branch.name}", tight=True)
        yield from self._loads(number)

    def _loads(self, number: int) -> Iterator[Block]:
        """Loads inside shafts and couplings along a branch: the mean, rms about it, and the larger end, with its error."""
        own = np.flatnonzero(self.branch == number)
        for k, (name, unit) in enumerate(zip(self.load_points, self.load_unit, strict=True)):
            rows = []
            for i in own[_spread(len(own))]:
                mean, rms, largest, smallest = (float(x) for x in self.load_statistics[i, k])
                end = 2 if abs(largest) >= abs(smallest) else 3
                error = float(self.load_error[i, k, end]) / (max(abs(largest), abs(smallest)) or np.nan)
                cells = (f"{x:.5g}" for x in (mean, rms, largest, smallest))
                rows.append((self._value(float(self.value[i])), *cells, written(error, error_words)))
            yield from ("", f"Load at {name}")
            heads = (self._head(), f"mean\n{unit}", f"rms\n{unit}", f"largest\n{unit}", f"smallest\n{unit}", "error")
            yield grid(rows, *heads, left=0, caption=f"Load at {name}, branch {self.branches[number].name}")

    def _error(self, point: int, number: int, what: str, size: float) -> str:
        """Estimated error of a statistic of the contact of that number, or of the place shown, relative to a size, in words."""
        errors = self.statistics_error if self.contact else self.place_error[:, self._shown_places]
        if not errors.size or not size:
            return "-"
        at = errors[point, number]
        return written(float(at[self.statistic.index(what)] if self.contact else at) / abs(size), error_words)

    def _curve(self, curve: SpecialCurve) -> Iterator[Block]:
        name = self.branches[curve.branch].name
        yield f"Curve of the {curve.kind} of branch {name}: {counted(len(curve.value), 'points')}, to {curve.ended}"
        sizes = self.peak_to_peak_of(curve)
        rows = [
            (
                self._value(float(curve.value[i])),
                self._value(float(curve.second[i]), 1),
                f"{1e3 * curve.period[i]:.4g}",
                f"{1e6 * sizes[i].max():.4g}",
            )
            for i in _spread(len(curve.value))
        ]
        heads = (self._head(), self._head(1), "period\nms", f"p-p\nu{self.shown_unit}")
        yield grid(rows, *heads, left=0, caption=f"Curve of the {curve.kind}")

    def _started(self) -> Table:
        rows = [
            (
                self._value(one.value),
                written(one.stable),
                error_words(one.deviation, 1),
                written(one.growth, ".5f"),
                f"{one.expected:.5f}",
            )
            for one in self.verifications
        ]
        heads = (self._head(), "stable", "deviation", "growth", "|mu|")
        return grid(rows, *heads, left=0, caption="Transients started on orbits")


def _spread(count: int) -> np.ndarray:
    """Numbers of the points of a branch that are listed: its ends, and evenly between them."""
    return np.unique(np.linspace(0, count - 1, min(_SHOWN, count)).round().astype(int))
