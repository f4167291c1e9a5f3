"""Measured frequency responses and order cuts beside those of a model."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rotorgear.results.result import ModelResult
from rotorgear.results.schema import Record, derived, of
from rotorgear.results.table import Block, table_of


class FrfMatch(Record):
    """One measured frequency response and that of the model."""

    response: str = of("place of the response", column="response")
    reference: str = of("place of the force", column="force")
    frac: float = of(
        "frequency response assurance criterion", note=": 1 where both are in proportion", form=".3f", column="FRAC"
    )
    size_frac: float = of(
        "the same of the sizes alone", note=", which phase and sign leave as it is", form=".3f", column="of sizes"
    )
    ratio: float = of("root mean square of the model's over that of the rig", form=".3g", column="model/rig")


class FrfComparison(ModelResult, kind="compare_frf"):
    """Measured frequency responses beside those of a model, at the frequencies of the rig."""

    frequency_hz: np.ndarray = of("frequency", "Hz", "frequency")
    pairs: tuple[FrfMatch, ...] = of("pairs of places", "", "pair", record=FrfMatch)
    measured: np.ndarray = of("measured receptance", "m/N, rad/N, m/(N m) or rad/(N m)", "pair", "frequency", json=None)
    computed: np.ndarray = of(
        "receptance of the model", "m/N, rad/N, m/(N m) or rad/(N m)", "pair", "frequency", json=None
    )
    damping_ratio: float = of("damping ratio", note=" added to every elastic mode")

    @derived("mean of the criterion over the pairs")
    def mean_frac(self) -> float:
        """Mean FRAC."""
        return float(np.mean([pair.frac for pair in self.pairs]))

    @derived("what the agreement is worth", "", "sentence", note=", in sentences")
    def verdicts(self) -> tuple[str, ...]:
        """Signs that are swapped, and sizes that a unit would explain."""
        said = []
        for pair, rig, model in zip(self.pairs, self.measured, self.computed, strict=True):
            cosine = float(np.real(np.vdot(rig, model))) / float(np.linalg.norm(rig) * np.linalg.norm(model) or 1.0)
            name = f"{pair.response} over {pair.reference}"
            if cosine < -0.5:
                said.append(
                    f"{name}: of the opposite sign (cosine {cosine:+.2f}): does the sensor or the hammer look the other way?"
                )
            power = round(np.log10(pair.ratio)) if pair.ratio > 0.0 else 0
            if power and power % 3 == 0:
                said.append(f"{name}: the model's is {pair.ratio:.2g} times as large: another unit?")
        return tuple(said)

    def tables(self) -> Iterator[Block]:
        """Each pair of places, and what the agreement is worth."""
        yield from self.titled()
        hz = self.frequency_hz
        yield from (table_of(self, "pairs"), "")
        yield f"Mean FRAC {self.mean_frac:.3f} over {len(hz)} frequencies, {hz[0]:.5g} to {hz[-1]:.5g} Hz."
        yield from (*self.verdicts, *self.remarks())


class OrderMatch(Record):
    """The cut of one order at one place, measured and computed, over the same speeds."""

    point: str = of("named point", column="point")
    order: str = of("name of the order", column="order")
    ratio: float = of("frequency over that of the input shaft")
    level_db: float = of(
        "root mean square of the model over that of the rig", "dB", form="{:+.1f} dB".format, column="model/rig"
    )
    correlation: float = of("correlation of the levels over speed", note=", in dB", form=".2f", column="correlation")
    rig_peak_rpm: float = of(
        "speed of the largest measured amplitude", "rpm", form="{:.0f} rpm".format, column="peak: rig"
    )
    model_peak_rpm: float = of(
        "speed of the largest amplitude of the model", "rpm", form="{:.0f} rpm".format, column="model"
    )


class OrderComparison(ModelResult, kind="compare_orders"):
    """Order cuts of a run-up beside the response of the model."""

    speed_rpm: np.ndarray = of("speed of the input shaft", "rpm", "speed")
    cuts: tuple[OrderMatch, ...] = of("cuts", "", "cut", record=OrderMatch)
    measured_acceleration: np.ndarray = of("measured acceleration", "m/s^2, rad/s^2", "cut", "speed")
    computed_acceleration: np.ndarray = of("acceleration of the model", "m/s^2, rad/s^2", "cut", "speed")
    without: tuple[str, ...] = of("measured cuts without an order of the model", "", "left_cut")

    def tables(self) -> Iterator[Block]:
        """Each cut, and those that the model has no order for."""
        yield from self.titled()
        columns = ("point", "order", "level_db", "correlation", "rig_peak_rpm", "model_peak_rpm")
        yield from (table_of(self, "cuts", *columns), "")
        if self.without:
            yield f"No order of the model: {', '.join(self.without)}."
        yield from self.remarks()
