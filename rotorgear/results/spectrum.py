"""Spectra: amplitudes over frequency, and their lines."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rotorgear.results.result import Result
from rotorgear.results.schema import Record, of, rows
from rotorgear.results.table import Block, Column, Line, table_of


class Spectrum(Record):
    """One-sided amplitude spectrum: a sine of amplitude A shows a peak of height A."""

    name: str = of("name", note=" of the history")
    unit: str = of("unit", note=" of the amplitudes")
    frequency: np.ndarray = of("frequency", "", "bin", note=" in Hz, or orders of the reference shaft")
    amplitude: np.ndarray = of("amplitude", "", "bin", note=" in the history's unit")
    window: str = of("window")
    resolution: float = of("distance at which two lines are told apart", note=", in the unit of the frequency")
    over: str = of("what the frequency is in", note=', `"Hz"` or orders', default="Hz")


class SpectralLines(Result, kind="spectral_lines", analysis="spectrum"):
    """The strongest lines of a spectrum, by frequency."""

    name: str = of("name of the history", json="history")
    unit: str = of("unit", note=" of the amplitudes")
    lines = rows("lines", "line")
    frequency_hz: np.ndarray = of("frequency", "Hz", "line", form=".2f")
    amplitude: np.ndarray = of("amplitude", "", "line", form=".4g")
    source: tuple[str, ...] = of("shaft or mesh order that the line belongs to", "", "line", note=', or `""`')
    window: str = of("window")
    resolution_hz: float = of("distance at which two lines are told apart", "Hz")

    def tables(self) -> Iterator[Block]:
        """The lines of the spectrum."""
        yield Line(f"Spectrum of {self.name}, {self.window} window, {self.resolution_hz:.3g} Hz apart")
        columns = (
            Column("Hz", "frequency_hz"),
            Column(f"amplitude {self.unit}", "amplitude"),
            Column("order", "source"),
        )
        yield from (table_of(self, "lines", *columns), "")


class RigSpectrum(Result, kind="rig_spectrum", analysis="compare spectrum"):
    """Spectral lines beside the k lines of a rig; NaN where none lies within the tolerance."""

    name: str = of("name of the history", json="history")
    unit: str = of("unit", note=" of the amplitudes")
    lines = rows("lines of the rig", "rig_line")
    rig_hz: np.ndarray = of("frequency of the rig line", "Hz", "rig_line")
    label: tuple[str, ...] = of("label", "", "rig_line", note=" of the rig line")
    frequency_hz: np.ndarray = of(
        "frequency", "Hz", "rig_line", note=" of the spectral line beside it, or `null`", form=".2f"
    )
    amplitude: np.ndarray = of("amplitude", "", "rig_line", note=", or `null`", form=".4g")
    source: tuple[str, ...] = of("shaft or mesh order that the line belongs to", "", "rig_line")
    reason: tuple[str, ...] = of("why there is no line", "", "rig_line", note=', or `""`')
    tolerance: float = of("tolerance", note=": relative distance at which a spectral line counts as the rig's")

    def tables(self) -> Iterator[Block]:
        """Rig lines beside spectral lines."""
        yield Line(f"Rig lines within {100.0 * self.tolerance:g} %")
        columns = (
            Column("rig Hz", "rig_hz", ".6g"),
            Column("Hz", "frequency_hz", where=lambda line: not line.reason),
            Column(f"amplitude {self.unit}", "amplitude", where=lambda line: not line.reason),
            Column("order, or why there is no line", lambda line: line.reason or line.source),
        )
        yield from (table_of(self, "lines", *columns), "")
