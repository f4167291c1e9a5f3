"""Spectra: amplitudes over frequency, and their lines."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rotorgear.results.result import Result
from rotorgear.results.schema import Record, derived, of
from rotorgear.results.table import Block, Column, heading, table_of


class Spectrum(Record):
    """One-sided amplitude spectrum: a sine of amplitude A shows a peak of height A."""

    name: str = of("name", note=" of the history")
    unit: str = of("unit", note=" of the amplitudes")
    frequency: np.ndarray = of("frequency", "", "bin", note=" in Hz, or orders of the reference shaft")
    amplitude: np.ndarray = of("amplitude", "", "bin", note=" in the history's unit")
    window: str = of("window")
    resolution: float = of("distance at which two lines are told apart", note=", in the unit of the frequency")
    over: str = of("what the frequency is in", note=', `"Hz"` or orders', default="Hz")


class SpectralLine(Record):
    """A line of a spectrum."""

    frequency_hz: float = of("frequency", "Hz", note=" of the line")
    amplitude: float = of("amplitude")
    source: str = of("shaft or mesh order that the line belongs to", note=', or `""`')


class SpectralLines(Result, kind="spectral_lines", analysis="spectrum"):
    """The strongest lines of a spectrum, by frequency."""

    name: str = of("name of the history", json="history")
    unit: str = of("unit", note=" of the amplitudes")
    frequency_hz: np.ndarray = of("frequency", "Hz", "line", json=None, form=".2f")
    amplitude: np.ndarray = of("amplitude", "", "line", json=None, form=".4g")
    source: tuple[str, ...] = of("shaft or mesh order that the line belongs to", "", "line", json=None)
    window: str = of("window")
    resolution_hz: float = of("distance at which two lines are told apart", "Hz")

    @derived("lines", "", "line", record=SpectralLine)
    def lines(self) -> tuple[SpectralLine, ...]:
        """A record for each line."""
        return tuple(map(SpectralLine, self.frequency_hz.tolist(), self.amplitude.tolist(), self.source))

    def tables(self) -> Iterator[Block]:
        """The lines of the spectrum."""
        yield heading(f"Spectrum of {self.name}, {self.window} window, {self.resolution_hz:.3g} Hz apart")
        amplitude = Column(f"amplitude {self.unit}", "amplitude", ".4g")
        yield from (
            table_of(self, "lines", Column("Hz", "frequency_hz", ".2f"), amplitude, Column("order", "source")),
            "",
        )


class LineBesideRig(Record):
    """A line of the rig, and the spectral line beside it."""

    rig_hz: float = of("frequency of the rig line", "Hz")
    label: str = of("label", note=" of the rig line")
    frequency_hz: float = of("frequency", "Hz", note=" of the spectral line beside it, or `null`")
    amplitude: float = of("amplitude", note=", or `null`")
    source: str = of("shaft or mesh order that the line belongs to")
    reason: str = of("why there is no line", note=', or `""`')


class RigSpectrum(Result, kind="rig_spectrum", analysis="compare spectrum"):
    """Spectral lines beside the k lines of a rig; NaN where none lies within the tolerance."""

    name: str = of("name of the history", json="history")
    unit: str = of("unit", note=" of the amplitudes")
    rig_hz: np.ndarray = of("frequency of the rig line", "Hz", "rig_line", json=None)
    label: tuple[str, ...] = of("label", "", "rig_line", json=None)
    frequency_hz: np.ndarray = of("frequency", "Hz", "rig_line", json=None)
    amplitude: np.ndarray = of("amplitude", "", "rig_line", json=None)
    source: tuple[str, ...] = of("shaft or mesh order that the line belongs to", "", "rig_line", json=None)
    reason: tuple[str, ...] = of("why there is no line", "", "rig_line", json=None)
    tolerance: float = of("tolerance", note=": relative distance at which a spectral line counts as the rig's")

    @derived("lines of the rig", "", "rig_line", record=LineBesideRig)
    def lines(self) -> tuple[LineBesideRig, ...]:
        """A record for each line of the rig."""
        columns = (self.rig_hz.tolist(), self.label, self.frequency_hz.tolist(), self.amplitude.tolist())
        return tuple(map(LineBesideRig, *columns, self.source, self.reason))

    def tables(self) -> Iterator[Block]:
        """Rig lines beside spectral lines."""
        yield heading(f"Rig lines within {100.0 * self.tolerance:g} %")
        columns = (
            Column("rig Hz", "rig_hz", ".6g"),
            Column("Hz", "frequency_hz", ".2f", where=lambda line: not line.reason),
            Column(f"amplitude {self.unit}", "amplitude", ".4g", where=lambda line: not line.reason),
            Column("order, or why there is no line", lambda line: line.reason or line.source),
        )
        yield from (table_of(self, "lines", *columns), "")
