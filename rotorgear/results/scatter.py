"""Scatter of a model: bands of frequencies, of margins to excitations and of load shares, and the numbers that make them."""

from __future__ import annotations

import numpy as np

from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.result import ModelResult
from rotorgear.results.schema import Record, derived, of

# Ends of the bands that are written, as shares of the samples below.
LOW = 0.05
HIGH = 0.95


class ScatteredNumber(Record):
    """A number of the model that scatters."""

    address: str = of("address in the model file")
    value: float = of("value in the file", note=", in SI; 1 where several numbers have one factor")
    unit: str = of("SI unit", note=" of value and sigma; empty for a factor or ratio")
    sigma: float = of("standard deviation", note=" in the unit; of ln p where it is log-normal")
    distribution: str = of("distribution", note=': `"normal"`, `"lognormal"` or `"uniform"`')


class FrequencyBand(Record):
    """One mode over the samples; it is the mode of its nominal shape, whatever its number there."""

    mode_number: int = of("number of the nominal mode", note=", from 1, elastic modes counted")
    nominal_hz: float = of("frequency", "Hz", note=" of the nominal model", form=".2f")
    group: int = of("number of the group", note=", from 1: modes of one group turn into each other within the scatter")
    sigma_first_order: float = of("relative standard deviation", note=", to first order, from energies", form=".2e")
    sigma: float = of("relative standard deviation", note=" of the samples", form=".2e")
    mean_hz: float = of("mean frequency", "Hz", note=" of the samples", form=".2f")
    low_hz: float = of("5 % quantile of the frequency", "Hz", form=".2f")
    high_hz: float = of("95 % quantile of the frequency", "Hz", form=".2f")
    found: float = of("share of the samples that have a mode of this shape")
    leading: str = of("address of the number that makes most of the variance", note=", to first order")
    leading_share: float = of("share of that number in the variance", note=", to first order", form=".0%")


class GroupBand(Record):
    """Modes that turn into each other: where the lowest and the highest of them lie."""

    group: int = of("number of the group", note=", from 1")
    modes: tuple[int, ...] = of("numbers of its nominal modes", "", "mode", note=", from 1")
    lowest_hz: float = of("5 % quantile of the lowest frequency of the group", "Hz", form=".2f")
    highest_hz: float = of("95 % quantile of the highest frequency of the group", "Hz", form=".2f")


class MarginBand(Record):
    """One excitation at the operating speed, and the mode next to it among those that it can excite."""

    line: str = of("excitation line")
    frequency_hz: float = of("frequency", "Hz", note=" of the line", form=".2f")
    nominal: float = of("margin of the nominal model", note=": f_mode / f_line - 1; `null`: no mode", form="+.4f")
    low: float = of("5 % quantile of the size of the margin", form=".4f")
    median: float = of("median of the size of the margin", form=".4f")
    below: float = of("share of the samples whose margin is too small", form=".3f")


class ShareBand(Record):
    """The share of a mesh in the load of a gear that it shares with other meshes."""

    gear: str = of("gear")
    mesh: str = of("mesh")
    nominal: float = of("share in the nominal model", form=".4f")
    sigma_first_order: float = of("standard deviation", note=" to first order", form=".2e")
    sigma: float = of("standard deviation", note=" of the samples", form=".2e")
    low: float = of("5 % quantile", form=".4f")
    high: float = of("95 % quantile", form=".4f")
    leading: str = of("address of the number that makes most of the variance", note=", to first order")
    leading_share: float = of("share of that number in the variance", note=", to first order", form=".0%")


class ScatterResult(ModelResult, kind="scatter"):
    """n samples of p numbers: bands of m modes, l margins and s load shares.

    Rows of `first_order_share` and of Sobol indices are the m modes, then the s load shares.
    """

    speed: float | None = of("speed of the input shaft", "rad/s", note="; `null` at standstill")
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
        "largest relative error of a frequency by the basis",
        note=", at samples followed to the whole system",
        form=".1e",
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
