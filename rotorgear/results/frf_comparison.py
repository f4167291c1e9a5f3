"""Measured frequency responses and order cuts beside those of a model."""

from __future__ import annotations

import numpy as np

from rotorgear.results.result import ModelResult
from rotorgear.results.schema import Record, derived, of


class FrfMatch(Record):
    """One measured frequency response and that of the model."""

    response: str = of("place of the response")
    reference: str = of("place of the force")
    frac: float = of("frequency response assurance criterion", note=": 1 where both are in proportion", form=".3f")
    size_frac: float = of("the same of the sizes alone", note=", which phase and sign leave as it is", form=".3f")
    ratio: float = of("root mean square of the model's over that of the rig", form=".3g")


class FrfComparison(ModelResult, kind="compare_frf"):
    """Measured frequency responses beside those of a model, at the frequencies of the rig."""

    frequency_hz: np.ndarray = of("frequency", "Hz", "frequency")
    pairs: tuple[FrfMatch, ...] = of("pairs of places", "", "pair", record=FrfMatch)
    measured: np.ndarray = of("measured receptance", "m/N, rad/N, m/(N m) or rad/(N m)", "pair", "frequency", json=None)
    computed: np.ndarray = of(
        "receptance of the model", "m/N, rad/N, m/(N m) or rad/(N m)", "pair", "frequency", json=None
    )
    damping_ratio: float = of("damping ratio", note=" added to every elastic mode")

    @derived("mean of the criterion over the pairs", form=".3f")
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


class OrderMatch(Record):
    """The cut of one order at one place, measured and computed, over the same speeds."""

    point: str = of("named point")
    order: str = of("name of the order")
    ratio: float = of("frequency over that of the input shaft")
    level_db: float = of("root mean square of the model over that of the rig", "dB", form=".1f")
    correlation: float = of("correlation of the levels over speed", note=", in dB", form=".2f")
    rig_peak_rpm: float = of("speed of the largest measured amplitude", "rpm")
    model_peak_rpm: float = of("speed of the largest amplitude of the model", "rpm")


class OrderComparison(ModelResult, kind="compare_orders"):
    """Order cuts of a run-up beside the response of the model."""

    speed_rpm: np.ndarray = of("speed of the input shaft", "rpm", "speed")
    cuts: tuple[OrderMatch, ...] = of("cuts", "", "cut", record=OrderMatch)
    measured_acceleration: np.ndarray = of("measured acceleration", "m/s^2, rad/s^2", "cut", "speed")
    computed_acceleration: np.ndarray = of("acceleration of the model", "m/s^2, rad/s^2", "cut", "speed")
    without: tuple[str, ...] = of("measured cuts without an order of the model", "", "left_cut")
