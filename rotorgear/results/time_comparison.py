"""Records over time beside what a model answers to the same loads, and beside what it would answer without vibration."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rotorgear.results.comparison import RigLine
from rotorgear.results.result import ModelResult
from rotorgear.results.schema import Record, derived, of
from rotorgear.results.table import Block, Line, table_of

# A share below this is no number to compare.
_WORST = -9.99


def _share(value: float) -> str:
    if value < _WORST:
        return f"< {100.0 * _WORST:.0f} %"
    return f"{100.0 * value:.1f} %" if np.isfinite(value) else "-"


class TimeInput(Record):
    """A measured load that acts on the model."""

    name: str = of("name of the channel", column="load")
    place: str = of("place on the model", column="acts at")
    quantity: str = of("what it tells", column="is")
    unit: str = of("unit of the channel", note=", SI", column="unit")
    mean: float = of("mean", note=", in that unit", form=".4g", column="mean")
    largest: float = of("largest absolute value", note=", in that unit", form=".4g", column="largest")


class TimeMatch(Record):
    """A measured channel beside the model: over the time that is judged."""

    name: str = of("name of the channel", column="channel")
    place: str = of("place on the model")
    quantity: str = of("what it tells", column="is")
    unit: str = of("unit of the channel", note=", SI", column="unit")
    rig_mean: float = of("measured mean", note=", in that unit", form=".4g", column="mean: rig")
    model_mean: float = of("mean of the model", note=", in that unit", form=".4g", column="model")
    rig_largest: float = of("largest measured absolute value", note=", in that unit", form=".4g", column="max: rig")
    model_largest: float = of("largest absolute value of the model", note=", in that unit", form=".4g", column="model")
    error: float = of(
        "error of the model's root mean square",
        note=", relative to it, of steps in time; `null` where none is known",
        form=".0e",
    )


class TimeShare(Record):
    """How much of a measured channel the model explains: of its size, of its variance, and of that in bands of frequencies."""

    name: str = of("name of the channel", column="channel")
    part: str = of("part of the record", note=': `"size"` (mean and all), `"variance"`, or a band', column="part")
    low_hz: float = of("lowest frequency of the part", "Hz")
    high_hz: float = of("highest frequency of the part", "Hz")
    of_record: float = of("share of the measured variance in it", form=_share, column="of the record")
    ratio: float = of("root mean square of the model over that of the rig", form=".3g", column="model/rig")
    explained: float = of(
        "share that the model explains",
        note=": 1 less the mean square of the difference over that of the record, means taken out but of the size",
        form=_share,
        column="explained",
    )
    quasi_static: float = of("share that a model without vibration explains", form=_share, column="static")


class RingDown(Record):
    """A vibration that dies away, fitted to a channel, or to all of them together, of the rig and of the model alike."""

    name: str = of("name of the channel", note=', `"all"` for all of them together', column="channel")
    rig_hz: float = of("measured natural frequency", "Hz", form=".4g", column="rig Hz")
    rig_hz_sigma: float = of("standard error of the measured frequency", "Hz", form=".1g", column="+-")
    rig_damping_ratio: float = of("measured damping ratio", form=_share, column="damping")
    rig_damping_ratio_sigma: float = of("standard error of the measured damping ratio", form=_share, column="+-")
    answer_hz: float = of("the same fitted to the model's answer", "Hz", form=".4g", column="answer")
    answer_damping_ratio: float = of("the same fitted to the model's answer", form=_share, column="damping")
    mode_hz: float = of("natural frequency of the model's nearest mode", "Hz", form=".4g", column="mode Hz")
    mode_damping_ratio: float = of("damping ratio of that mode", form=_share, column="damping")
    explained: float = of("share of the measured variance that the fit explains", form=_share)


class TimeComparison(ModelResult, kind="compare_time"):
    """A record over time beside the transient of a model under the measured loads."""

    time: np.ndarray = of("time", "s", "instant", note=" as the record counts it")
    rig_values: np.ndarray = of(
        "measured values", "N, N m, m, rad, m/s, rad/s, m/s^2 or rad/s^2", "channel", "instant",
        note=", shifted to the clock of the loads, orders taken out where that was asked for",
    )  # fmt: skip
    model_values: np.ndarray = of(
        "values of the model", "N, N m, m, rad, m/s, rad/s, m/s^2 or rad/s^2", "channel", "instant"
    )
    baseline_values: np.ndarray = of(
        "values of a model without vibration", "N, N m, m, rad, m/s, rad/s, m/s^2 or rad/s^2", "channel", "instant"
    )
    load: np.ndarray = of("measured loads", "N, N m", "input", "instant")
    inputs: tuple[TimeInput, ...] = of("measured loads that act on the model", "", "input", record=TimeInput)
    channels: tuple[TimeMatch, ...] = of("measured channels", "", "channel", record=TimeMatch)
    shares: tuple[TimeShare, ...] = of("shares of each channel", "", "share", record=TimeShare)
    ring_downs: tuple[RingDown, ...] = of(
        "vibrations that die away", "", "ring_down", record=RingDown, note="; empty where no time of them was named"
    )
    window_s: tuple[float, float] = of("begin and end of the time that is judged", "s", "end")
    offset: float = of("what was added to the clock of the channels", "s", note=" to have that of the loads")
    offset_found: float = of("what fits best in place of it", "s")
    offset_explained: float = of("mean share that would be explained with that", form=_share)
    removed: tuple[str, ...] = of("orders that were taken out of the channels", "", "removed_order")
    error_estimate: float = of("largest relative error of the model's statistics", note="; `null` without an estimate")

    def ring_down_lines(self) -> tuple[RigLine, ...]:
        """Lines of a rig, as `update` and `compare` take them: natural frequencies and damping of all channels together."""
        return tuple(
            RigLine(row.rig_hz, f"ring-down of {len(self.channels)} channels", row.rig_hz_sigma, row.rig_damping_ratio)
            for row in self.ring_downs
            if row.name == "all"
        )

    @derived("what the agreement is worth", note=", in one sentence")
    def verdict(self) -> str:
        """Where the model explains more than one without vibration."""
        known = [row for row in self.shares if np.isfinite(row.quasi_static)]
        if not known:
            return "There is no baseline: a share by itself does not tell vibration from load."
        worse = [f"{row.name}, {row.part}" for row in known if row.explained <= row.quasi_static]
        if not worse:
            return "In every part of every channel the model explains more than it would without vibration."
        if len(worse) == len(known):
            return "Nowhere does the model explain more than it would without vibration: nothing here speaks for its modes."
        return f"The model explains no more than it would without vibration: {'; '.join(worse)}."

    def tables(self) -> Iterator[Block]:
        """Loads, channels, bands, ring-downs, and what the agreement is worth."""
        low, high = self.window_s
        yield Line(f"{self.model.title or 'Record over time'}:", f" judged from {low:.4g} to {high:.4g} s")
        if self.inputs:
            yield from (table_of(self, "inputs"), "")
        yield from (table_of(self, "channels"), "")
        yield from (table_of(self, "shares"), "")
        if self.ring_downs:
            yield from (table_of(self, "ring_downs"), "")
        yield (
            "explained: share of the record's size, of its variance, or of that in a band; static: by the same model whose "
            "springs have no time to swing. A share counts as far as it is above that."
        )
        yield ""
        yield (
            f"Clock: {1e3 * self.offset:+.4g} ms added to that of the channels. Best fit {1e3 * self.offset_found:+.4g} ms, "
            f"which would explain {_share(self.offset_explained)} in the mean of the channels."
        )
        if self.removed:
            yield f"Taken out of the channels: {', '.join(self.removed)}."
        if np.isfinite(self.error_estimate):
            yield f"Statistics of the model within {self.error_estimate:.0e}, {self.method}."
        yield from ("", *self.remarks())
        yield Line(self.verdict)
