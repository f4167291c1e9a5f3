"""Where to put the sensors of a test, so that they tell the modes apart."""

from __future__ import annotations

import numpy as np

from rotorgear.results.correlation import pairs_alike
from rotorgear.results.result import ModelResult
from rotorgear.results.schema import Record, derived, of


class PlannedSensor(Record):
    """A place for a sensor."""

    place: str = of("place", note=": a part, a point or a place on a casing, as tables of sensors name it")
    node: int = of("number of the place", note=", from 1; directions of one place share it")
    direction: str = of("direction", note=" that it looks along")
    position: np.ndarray = of("position", "m", "xyz")
    independence: float = of(
        "effective independence",
        note=": share of the sensor in the rank of the shapes, 1 where nothing replaces it",
        form=".2f",
    )


class SensorPlan(ModelResult, kind="sensors"):
    """Places that tell the lowest elastic modes of a model apart."""

    sensors: tuple[PlannedSensor, ...] = of("sensors", "", "sensor", record=PlannedSensor)
    mode_number: np.ndarray = of("number of the mode", "", "mode")
    mode_hz: np.ndarray = of("frequency of the mode", "Hz", "mode")
    model_auto_mac: np.ndarray = of("MAC of the computed shapes at the sensors among themselves", "", "mode", "mode")
    candidates: int = of("number of places and directions that were looked at")
    all_auto_mac: float = of("largest MAC of two modes with all of them")

    @derived("largest MAC of two modes at the sensors", form=".2f")
    def worst(self) -> float:
        """Largest off-diagonal entry."""
        return float(np.max(np.triu(self.model_auto_mac, 1), initial=0.0))

    @derived("what the sensors can't tell", "", "sentence", note=", in sentences")
    def confused(self) -> tuple[str, ...]:
        """Modes that are the same at the sensors."""
        return tuple(pairs_alike(self.model_auto_mac, [str(number) for number in self.mode_number], "modes", set()))
