"""The step of the thruster bench by `compare --time`, with default settings, and the lowest mode of its model."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np

import rotorgear as rg
from rotorgear.results.time_comparison import TimeComparison

HERE = Path(__file__).parent
CHANNELS = {"load": "-points.propeller", "upper": "-points.upper", "lower": "-points.lower"}


@cache
def step(window: str = "0 s:0.475 s") -> TimeComparison:
    """The record beside the model."""
    bench = rg.load(HERE / "bench.toml")
    return rg.compare_time(
        bench, HERE / "step.csv", channels=CHANNELS, bands=["15:60"], window=window, ring_down="10 ms:300 ms"
    )


def measure(quantity: str, mode: str) -> float:
    """A number of the comparison: of the channel `mode`, or of the lowest mode."""
    what, _, part = quantity.partition(", ")
    found = step()
    if what in ("explained", "explained without vibration"):
        row = next(row for row in found.shares if (row.name, row.part) == (mode, part))
        return row.explained if what == "explained" else row.quasi_static
    if what == "torque at the end":
        at_end = (found.time >= 0.25) & (found.time <= 0.475)
        return float(np.abs(found.model_values[channel(found, mode), at_end].mean()))
    if what == "largest torque":
        return found.channels[channel(found, mode)].model_largest
    ring = next(row for row in found.ring_downs if row.name == "all")
    return {
        "frequency_hz of the mode": ring.mode_hz * np.sqrt(1.0 - ring.mode_damping_ratio**2),
        "damping of the mode": ring.mode_damping_ratio,
        "frequency_hz of the record": ring.rig_hz,
        "damping of the record": ring.rig_damping_ratio,
    }[quantity]


def channel(found: TimeComparison, name: str) -> int:
    """Number of a channel."""
    return [row.name for row in found.channels].index(name)
