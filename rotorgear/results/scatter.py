"""Scatter of a model: bands of frequencies, of margins to excitations and of load shares, and the numbers that make them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from rotorgear.quantity import RPM_PER_RAD_S, counted
from rotorgear.results.result import ModelResult
from rotorgear.results.schema import Record, derived, of
from rotorgear.results.table import Block, Column, Form, Line, Table, grid, table_of

# Ends of the bands that are written, as shares of the samples below.
LOW = 0.05
HIGH = 0.95
# Of the Sobol indices a table shows this many numbers a mode.
_RANKED = 3
_SAMPLED = ", by the number of samples: from blocks of them"


class ScatteredNumber(Record):
    """A number of the model that scatters."""

    address: str = of("address in the model file")
    value: float = of("value in the file", note=", in SI; 1 where several numbers have one factor")
    unit: str = of("SI unit", note=" of value and sigma; empty for a factor or ratio")
    sigma: float = of("standard deviation", note=" in the unit; of ln p where it is log-normal")
    distribution: str = of("distribution", note=': `"normal"`, `"lognormal"` or `"uniform"`')


class FrequencyBand(Record):
    """One mode over the samples; it is the mode of its nominal shape, whatever its number there."""

    mode_number: int = of("number of the nominal mode", note=", from 1, elastic modes counted", column="mode")
    nominal_hz: float = of("frequency", "Hz", note=" of the nominal model", form=".2f", column="Hz")
    group: int = of("number of the group", note=", from 1: modes of one group turn into each other within the scatter")
    sigma_first_order: float = of(
        "relative standard deviation", note=", to first order", form="±{:.2f} %".format, shown="%", column="1st order"
    )
    sigma: float = of(
        "relative standard deviation", note=" of the samples", form="±{:.2f} %".format, shown="%", column="sampled"
    )
    mean_hz: float = of("mean frequency", "Hz", note=" of the samples")
    low_hz: float = of("5 % quantile of the frequency", "Hz", form=".2f", column="5 %")
    high_hz: float = of("95 % quantile of the frequency", "Hz", form=".2f", column="95 %")
    found: float = of("share of the samples that have a mode of this shape")
    leading: str = of("address of the number that makes most of the variance", note=", to first order")
    leading_share: float = of("share of that number in the variance", note=", to first order")
    low_error_hz: float = of(
        "standard error of the 5 % quantile", "Hz", note=_SAMPLED, default=float("nan"), kw_only=True
    )
    high_error_hz: float = of(
        "standard error of the 95 % quantile", "Hz", note=_SAMPLED, default=float("nan"), kw_only=True
    )


class GroupBand(Record):
    """Modes that turn into each other: where the lowest and the highest of them lie."""

    group: int = of("number of the group", note=", from 1")
    modes: tuple[int, ...] = of("numbers of its nominal modes", "", "mode", note=", from 1")
    lowest_hz: float = of("5 % quantile of the lowest frequency of the group", "Hz")
    highest_hz: float = of("95 % quantile of the highest frequency of the group", "Hz")
    lowest_error_hz: float = of("standard error of that 5 % quantile", "Hz", note=_SAMPLED, default=float("nan"))
    highest_error_hz: float = of("standard error of that 95 % quantile", "Hz", note=_SAMPLED, default=float("nan"))


class MarginBand(Record):
    """One excitation at the operating speed, and the mode next to it among those that it can excite."""

    line: str = of("excitation line", column="excitation")
    frequency_hz: float = of("frequency", "Hz", note=" of the line", form=".2f", column="Hz")
    nominal: float = of(
        "margin of the nominal model", note=": f_mode / f_line - 1; `null`: no mode", form="+.4f", column="margin"
    )
    low: float = of("5 % quantile of the size of the margin", form=".4f", column="5 % have under")
    median: float = of("median of the size of the margin", form=".4f", column="median")
    below: float = of("share of the samples whose margin is too small", form=".3f", column="below")
    low_error: float = of("standard error of the 5 % quantile", note=_SAMPLED, default=float("nan"), kw_only=True)


class ShareBand(Record):
    """The share of a mesh in the load of a gear that it shares with other meshes."""

    gear: str = of("gear", column="shared by")
    mesh: str = of("mesh", column="mesh")
    nominal: float = of("share in the nominal model", form=".4f", column="share")
    sigma_first_order: float = of(
        "standard deviation", note=" to first order", form="±{:.4f}".format, column="1st order"
    )
    sigma: float = of("standard deviation", note=" of the samples", form="±{:.4f}".format, column="sampled")
    low: float = of("5 % quantile", form=".4f", column="5 % under")
    high: float = of("95 % quantile", form=".4f", column="95 % under")
    leading: str = of("address of the number that makes most of the variance", note=", to first order")
    leading_share: float = of("share of that number in the variance", note=", to first order")
    low_error: float = of("standard error of the 5 % quantile", note=_SAMPLED, default=float("nan"))
    high_error: float = of("standard error of the 95 % quantile", note=_SAMPLED, default=float("nan"))


class ScatterResult(ModelResult, kind="scatter"):
    """n samples of p numbers: bands of m modes, l margins and s load shares.

    Rows of `first_order_share` and of Sobol indices are the m modes, then the s load shares.
    """

    speed: float | None = of("speed of the input shaft", "rad/s", note="; `null` at standstill", json="speed")
    numbers: tuple[ScatteredNumber, ...] = of("scattering numbers", "", "number", record=ScatteredNumber)
    bands: tuple[FrequencyBand, ...] = of("modes", "", "mode", record=FrequencyBand)
    groups: tuple[GroupBand, ...] = of("modes that turn into each other", "", "group", record=GroupBand)
    margins: tuple[MarginBand, ...] = of("excitations", "", "line", record=MarginBand)
    shares: tuple[ShareBand, ...] = of("load shares", "", "share", record=ShareBand)
    least_margin: float = of("margin that is asked for")
    sampling: str = of("sampling", note=': `"sobol"`, `"latin"` or `"random"`')
    z: np.ndarray = of("samples of the numbers", "", "sample", "number", note=", in standard deviations", json=None)
    sample_hz: np.ndarray = of(
        "frequency of each nominal shape", "Hz", "sample", "mode", note="; NaN: not found", json=None
    )
    sample_margin: np.ndarray = of("margin", "", "sample", "line", note="; NaN: no mode", json=None)
    sample_share: np.ndarray = of("load share", "", "sample", "share", json=None)
    first_order_share: np.ndarray = of(
        "share of each number in the variance", "", "quantity", "number", note=", to first order"
    )
    sobol_first: np.ndarray = of(
        "first-order Sobol index", "", "quantity", "number", note="; empty where not asked for"
    )
    sobol_total: np.ndarray = of("total Sobol index", "", "quantity", "number")
    sobol_first_error: np.ndarray = of("standard error of the first-order index", "", "quantity", "number")
    sobol_total_error: np.ndarray = of("standard error of the total index", "", "quantity", "number")
    basis_size: int = of("number of shapes that carry the samples")
    frequency_basis_error: float = of(
        "largest relative error of a frequency by the basis", note=", at samples followed to the whole system"
    )
    checked_samples: int = of("number of samples that were followed to the whole system")
    failed: int = of("number of samples that have no modes", note=": numbers that the model can't have")

    @property
    def speed_rpm(self) -> float | None:
        """Speed of the input shaft in rpm."""
        return None if self.speed is None else self.speed * RPM_PER_RAD_S

    @derived("number of samples")
    def sample_count(self) -> int:
        """n."""
        return len(self.z)

    def tables(self) -> Iterator[Block]:
        """Bands of modes, margins and load shares, the numbers that make them, and how far to trust them."""
        at = "at standstill" if self.speed_rpm is None else f"at {self.speed_rpm:.6g} rpm"
        yield Line(self.title or "Scatter", f": scatter {at}, {counted(self.sample_count, 'samples')}")
        # Addresses without their last key where that tells them apart all the same.
        whole = [row.address for row in self.numbers]
        short = [address.rpartition(".")[0] for address in whole]
        names = {a: b if short.count(b) == 1 else a for a, b in zip(whole, short, strict=True)}
        by = Column(
            "mostly by",
            lambda row: f"{100 * row.leading_share:.0f} % {names[row.leading]}" if row.leading else "",
            left=True,
        )
        several = {one.group for one in self.groups}
        group = Column("group", "group", where=lambda row: row.group in several, without="")
        frequencies = ("mode_number", "nominal_hz", "sigma_first_order", "sigma", "low_hz", "high_hz")
        yield table_of(self, "bands", *frequencies, group, by)
        if self.groups:
            yield from ("", "Modes of a group turn into each other; a row of theirs follows one shape.")
        for one in self.groups:
            modes = ", ".join(map(str, one.modes))
            yield f"group {one.group}: modes {modes} lie from {one.lowest_hz:.2f} to {one.highest_hz:.2f} Hz"
        if self.margins:
            yield from ("", self._margins())
        if self.shares:
            shares = ("gear", "mesh", "nominal", "sigma_first_order", "sigma", "low", "high")
            yield from ("", table_of(self, "shares", *shares, by))
        if self.sobol_first.size:
            yield from ("", self._ranks())
        yield ""
        yield (
            f"basis of {self.basis_size} shapes: frequencies within {self.frequency_basis_error:.0e} of the whole system's at "
            f"{counted(self.checked_samples, 'samples')} that it was not made from"
        )
        lost = [row for row in self.bands if row.found < 0.95]
        if lost:
            modes = ", ".join(f"{row.mode_number} ({100 * row.found:.0f} %)" for row in lost)
            yield f"found again in fewer than 95 % of the samples: modes {modes}"
        if errors := self._quantile_errors():
            yield f"standard errors of the quantiles by the number of samples: {', '.join(errors)}"
        if self.failed:
            yield f"{counted(self.failed, 'samples')} with numbers that the model can't have"
        yield from self.remarks()

    def _quantile_errors(self) -> list[str]:
        """The largest standard errors of quantiles in words: of frequencies relative to them, of the others as they are."""

        def largest(values: Iterable[float]) -> float:
            known = [value for value in values if np.isfinite(value)]
            return max(known, default=0.0)

        of_modes = [(row.low_error_hz / row.nominal_hz, row.high_error_hz / row.nominal_hz) for row in self.bands]
        sizes = {
            "frequencies": largest(value for row in of_modes for value in row),
            "margins": largest(row.low_error for row in self.margins),
            "shares": largest(value for row in self.shares for value in (row.low_error, row.high_error)),
        }
        return [f"{name} up to {100.0 * size:.2g} %" for name, size in sizes.items() if size > 0.0]

    def _margins(self) -> Table:
        def percent(name: str, words: Form, without: str = "-", head: str = "") -> Column:
            return Column(head, name, words, "%", where=lambda row: bool(np.isfinite(row.median)), without=without)

        margin = percent("nominal", "{:+.2f} %".format, "no mode")
        below = percent("below", "{:.1f} %".format, head=f"below {100 * self.least_margin:.3g} %")
        ends = [percent(name, "{:.2f} %".format) for name in ("low", "median")]
        return table_of(self, "margins", "line", "frequency_hz", margin, *ends, below)

    def _ranks(self) -> Table:
        rows = []
        names = [f"mode {row.mode_number}" for row in self.bands] + [f"{row.gear}, {row.mesh}" for row in self.shares]
        for k, name in enumerate(names):
            for place, j in enumerate(np.argsort(-self.sobol_total[k], kind="stable")[:_RANKED]):
                first = f"{self.sobol_first[k, j]:.3f} ±{self.sobol_first_error[k, j]:.3f}"
                total = f"{self.sobol_total[k, j]:.3f} ±{self.sobol_total_error[k, j]:.3f}"
                rows.append(("" if place else name, self.numbers[j].address, first, total))
        return grid(rows, "of", "number", "first", "total", left=2, caption="Sobol indices")
