"""Where to put the sensors of a test, so that they tell the modes apart."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rotorgear.results.correlation import pairs_alike
from rotorgear.results.result import ModelResult
from rotorgear.results.schema import Record, derived, of
from rotorgear.results.table import Block, Column, table_of


class PlannedSensor(Record):
    """A place for a sensor."""

    place: str = of(
        "place", note=": a part, a point or a place on a casing, as tables of sensors name it", column="place"
    )
    node: int = of("number of the place", note=", from 1; directions of one place share it", column="node")
    direction: str = of("direction", note=" that it looks along", column="along")
    position: np.ndarray = of("position", "m", "xyz", json="position")
    independence: float = of(
        "effective independence", note=": its share in the rank of the shapes", form=".2f", column="independence"
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

    def tables(self) -> Iterator[Block]:
        """The sensors, and what they can't tell."""
        yield from self.titled()
        where = [Column(f"{x} mm", "position", ".1f", "mm", entry=(j,)) for j, x in enumerate("xyz")]
        along = Column("", "direction", left=False)
        yield from (table_of(self, "sensors", "place", "node", along, *where, "independence"), "")
        hz = self.mode_hz
        yield (
            f"{len(self.sensors)} of {self.candidates} places and directions for {len(hz)} modes, {hz[0]:.5g} to "
            f"{hz[-1]:.5g} Hz. Largest MAC of two of them: {self.worst:.2f}, with all places {self.all_auto_mac:.2f}."
        )
        yield from (*self.confused, *self.remarks())
