"""Measured shapes beside those of a model: which mode a line is, how alike they are, and what the sensors can tell."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rotorgear.results.comparison import ExcitationLine, LearntParameter, RigLine, learnt_words
from rotorgear.results.result import ModelResult
from rotorgear.results.schema import Record, derived, of
from rotorgear.results.table import Block, Column, table_of

# Two shapes more alike than this at the sensors are one shape to the test.
SAME = 0.9
# A match is good where frequency and shape both agree: within the tolerance, and at least so alike.
ALIKE = 0.8
# Chance does as well in fewer cases than this: evidence.
_RARE = 0.025
_SHOWN = 4


class ShapeMatch(Record):
    """A measured mode and its mode of the model."""

    rig: RigLine = of("rig line", record=RigLine)
    mode_number: int = of("number of the mode", note=", from 1, rigid-body modes counted", column="mode")
    mode_frequency_hz: float = of("frequency of the mode", "Hz", form=".2f", column="model Hz")
    error_percent: float = of(
        "frequency of the mode over that of the rig, less 1", "%", form="{:+.2f} %".format, column="error"
    )
    mac: float = of(
        "modal assurance criterion", note="; of close modes the shape's share in their plane", form=".3f", column="MAC"
    )
    scale: float = of("measured shape over that of the mode", note=": modal scale factor, size", form=".3e")
    phase_collinearity: float = of(
        "modal phase collinearity", note=": 1 where all sensors move in phase or against it", form=".2f", column="phase"
    )
    close_to: tuple[int, ...] = of("modes that are too close to be told apart", "", "close_mode", note=", by number")
    excitations: tuple[ExcitationLine, ...] = of(
        "shaft and mesh orders that coincide with it", "", "excitation", record=ExcitationLine
    )


class Subspace(Record):
    """Modes too close to each other to be compared one by one, and the measured shapes among them."""

    mode_numbers: tuple[int, ...] = of("numbers of the modes", "", "close_mode")
    mode_hz: tuple[float, ...] = of("frequencies of the modes", "Hz", "close_mode")
    rig_hz: tuple[float, ...] = of("measured frequencies", "Hz", "rig_shape")
    angles: tuple[float, ...] = of(
        "principal angles", "rad", "rig_shape", note=" between the measured shapes and the modes' plane", json="angles"
    )


class SensorDoubt(Record):
    """A sensor that fits the model when it is taken otherwise than the table says; nothing was changed."""

    point: str = of("place of the sensor")
    what: str = of("how it would fit")
    mac_before: float = of("mean MAC as the table has it", form=".3f")
    mac_after: float = of("mean MAC when it is taken so", form=".3f")


class ShapeChance(Record):
    """What random lists of as many lines and shapes do: frequencies uniform in the log, shapes mixed from those of the model."""

    expected: float = of("mean number of good matches of a random list")
    probability_as_many: float = of("share of random lists with as many good matches")
    probability_as_close: float = of("share of random lists that come as close in frequency and shape together")
    samples: int = of("number of random lists")
    seed: int = of("seed of the random lists")


class ShapeComparison(ModelResult, kind="compare_shapes"):
    """Measured shapes beside the modes of a model."""

    points: tuple[str, ...] = of("names of the points", "", "point", note=", or places, of the sensors")
    distance: np.ndarray = of(
        "distance of the rig's node from the place", "m", "point", note="; `null`: a table names it", json="distance"
    )
    rig_hz: np.ndarray = of("frequency of the rig line", "Hz", "rig_shape")
    mode_number: np.ndarray = of("number of the mode", "", "mode")
    mode_hz: np.ndarray = of("frequency of the mode", "Hz", "mode")
    mac: np.ndarray = of(
        "MAC of measured and computed shapes", "", "rig_shape", "mode", note="; of close modes the share in their plane"
    )
    auto_mac: np.ndarray = of("MAC of the measured shapes among themselves", "", "rig_shape", "rig_shape")
    model_auto_mac: np.ndarray = of("MAC of the computed shapes at the sensors among themselves", "", "mode", "mode")
    comac: np.ndarray = of(
        "coordinate MAC", "", "point", note=": how far a sensor agrees with the model over all matched shapes"
    )
    matches: tuple[ShapeMatch, ...] = of("measured modes and their modes", "", "match", record=ShapeMatch)
    unmatched: tuple[RigLine, ...] = of("measured lines without a mode", "", "unmatched_line", record=RigLine)
    subspaces: tuple[Subspace, ...] = of("groups of close modes", "", "group", record=Subspace)
    doubts: tuple[SensorDoubt, ...] = of(
        "sensors that seem to be wired or turned otherwise", "", "doubt", record=SensorDoubt
    )
    tolerance: float = of("tolerance", note=": largest relative difference in frequency of a good match")
    chance: ShapeChance = of("what chance gives", record=ShapeChance)
    stiffnesses: tuple[LearntParameter, ...] = of(
        "what the matched lines teach of each stiffness", "", "stiffness", record=LearntParameter, note=", by frequency"
    )

    @derived("effective number of parameters that the lines teach", note=": by frequency alone; the shapes teach more")
    def learnt_parameters(self) -> float | None:
        """Sum of the learnt shares."""
        return sum(row.learnt for row in self.stiffnesses) if self.stiffnesses else None

    @derived("number of good matches", note=f": frequency within the tolerance and MAC at least {ALIKE}")
    def good(self) -> int:
        """Matches within the tolerance whose shapes are alike."""
        return sum(1 for m in self.matches if abs(m.error_percent) <= 100.0 * self.tolerance and m.mac >= ALIKE)

    @derived("what the agreement is worth", "", "sentence", note=", in sentences")
    def verdicts(self) -> tuple[str, ...]:
        """Agreement against chance, modes that the sensors can't tell apart, sensors in doubt."""
        chance = self.chance
        count = len(self.rig_hz)
        rare = chance.probability_as_many <= _RARE or chance.probability_as_close <= _RARE
        worth = "evidence for the model if it was not fitted to them" if rare else "no evidence for the model"
        many = f"{100 * chance.probability_as_many:.2g} %"
        said = [
            f"{self.good} of {count} measured modes agree in frequency within {100 * self.tolerance:.3g} % and in shape (MAC at "
            f"least {ALIKE}). Of {chance.samples} random lists the mean has {chance.expected:.2f}; {many} have as many, "
            f"{100 * chance.probability_as_close:.2g} % come as close in both: {worth}."
        ]
        close = {group.mode_numbers for group in self.subspaces}
        said += pairs_alike(self.model_auto_mac, [f"{number}" for number in self.mode_number], "modes", close)
        said += pairs_alike(self.auto_mac, [f"{hz:.1f} Hz" for hz in self.rig_hz], "measured shapes", set())
        for doubt in self.doubts:
            said.append(
                f"Sensor {doubt.point}: {doubt.what}? The mean MAC would be {doubt.mac_after:.3f} in place of "
                f"{doubt.mac_before:.3f}. Look at the rig; nothing was changed."
            )
        poor = [name for name, value in zip(self.points, self.comac, strict=True) if value < 0.5]
        if poor and not self.doubts:
            said.append(f"Sensors that agree least over all shapes (COMAC below 0.5): {', '.join(poor)}.")
        driven = [m for m in self.matches if m.excitations]
        if driven:
            lines = ", ".join(f"{m.rig.frequency_hz:.1f} Hz ({m.excitations[0].name})" for m in driven)
            said.append(f"Lines at a frequency of excitation, which may be no natural frequency at all: {lines}.")
        return tuple(said)

    def tables(self) -> Iterator[Block]:
        """Measured modes beside those of the model, and what the agreement is worth."""
        yield from self.titled()
        close = Column("", lambda m: f"with {', '.join(map(str, m.close_to))}" if m.close_to else "", left=False)
        own = ("mode_number", "mode_frequency_hz", "error_percent", "mac", "phase_collinearity")
        yield table_of(self, "matches", Column("rig Hz", "rig.frequency_hz", ".2f"), *own, close)
        yield from ("", *self.verdicts)
        for group in self.subspaces:
            numbers = " and ".join(str(k) for k in group.mode_numbers)
            angles = ", ".join(f"{angle:.1f}" for angle in np.degrees(group.angles))
            yield f"Modes {numbers} are too close to be told apart: principal angles to the measured plane {angles} degrees."
        if self.unmatched:
            yield f"Without a mode: {', '.join(f'{line.frequency_hz:.1f}' for line in self.unmatched)} Hz."
        if self.stiffnesses:
            yield learnt_words(self.stiffnesses, len(self.matches), "matched lines")
        yield from self.remarks()


def pairs_alike(table: np.ndarray, names: list[str], what: str, close: set[tuple[int, ...]]) -> list[str]:
    """A sentence on pairs that are one shape at the sensors, if there are any; close modes are left to their subspace."""
    rows, columns = np.nonzero(np.triu(table > SAME, 1))
    pairs = [
        (float(table[i, j]), int(i), int(j))
        for i, j in zip(rows, columns, strict=True)
        if not any({names[i], names[j]} <= {str(number) for number in group} for group in close)
    ]
    if not pairs:
        return []
    nearest = sorted(pairs, key=lambda pair: (pair[2] - pair[1], -pair[0]))[:_SHOWN]
    told = ", ".join(f"{names[i]} and {names[j]}" for _, i, j in nearest)
    more = f" and {len(pairs) - len(nearest)} more pairs" if len(pairs) > len(nearest) else ""
    return [f"Too few sensors to tell {what} {told} apart{more}: they are the same at these places (MAC above {SAME})."]
