"""Trajectories of some points of a sweep: phase portraits, and the spectra in which subharmonics are seen."""

from __future__ import annotations

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.results.schema import Record, of

# What a record holds of each contact.
DISPLACEMENT = 0
VELOCITY = 1
FORCE = 2
_NAMES = ("displacement", "velocity", "force")
# A line is a maximum that stands so much above the median of so many bins on both sides, and above that share of the largest.
_ABOVE = 10.0
_SIDE = 16
_SHARE = 1e-3
_MOST_LINES = 8


class SpectrumLine(Record):
    """A line in the spectrum of a trajectory."""

    order: float = of("order", note=": frequency over that of the fastest mesh; the largest line comes first")
    displacement_m: float = of("amplitude of the displacement", "m")


class ContactLines(Record):
    """The lines of one contact."""

    name: str = of("name", note=": mesh and helix")
    lines: tuple[SpectrumLine, ...] = of("lines of the spectrum", "", "line", record=SpectrumLine)


class Portrait(Record):
    """Length and lines of one trajectory."""

    values: tuple[float, ...] = of(
        "value of each parameter", "", "parameter", note=" at a point that keeps its trajectory"
    )
    start: str = of("where the run started")
    periods: int = of("least common periods that were recorded")
    records_per_period: int = of("records in one of them")
    contacts: tuple[ContactLines, ...] = of("lines by contact", "", "contact", record=ContactLines)


class Portraits(Record):
    """k points with j runs each, c contacts, s records at most.

    Records stand at even times; the first of a least common period T is a Poincare point. Values are displacement and velocity of
    the contacts along their normal (without the error of the teeth), and force; NaN behind the last record of a point, and
    where a run failed.
    """

    point: np.ndarray = of("numbers of the points", "", "portrait")
    run: np.ndarray = of("numbers of the runs", "", "portrait_run")
    turns: np.ndarray = of("periods of the fastest mesh in a least common period", "", "portrait")
    periods: np.ndarray = of("least common periods that were recorded", "", "portrait")
    records: np.ndarray = of("records in one of them", "", "portrait")
    values: np.ndarray = of(
        "displacement, velocity, force", "m, m/s, N", "portrait", "portrait_run", "record", "contact", "dvf"
    )

    def trajectory(self, k: int, run: int = 0) -> np.ndarray:
        """Records of a run, (s, c, 3)."""
        recorded: np.ndarray = self.values[k, run, : self.periods[k] * self.records[k]]
        return recorded

    def section(self, k: int, run: int = 0) -> np.ndarray:
        """Its Poincare points, (periods, c, 3)."""
        return self.trajectory(k, run)[:: self.records[k]]

    def spectrum(
        self, k: int, run: int = 0, contact: int = 0, what: str = "displacement"
    ) -> tuple[np.ndarray, np.ndarray]:
        """Frequency over that of the fastest mesh, and amplitude without the mean, by Hann's window, each (b,).

        Args:
            what: "displacement", "velocity" or "force".

        Raises:
            AnalysisError: `what` is none of them.
        """
        if what not in _NAMES:
            raise AnalysisError(f"what: got '{what}', expected one of {', '.join(_NAMES)}")
        values = self.trajectory(k, run)[:, contact, _NAMES.index(what)]
        window = 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(values.size) / values.size)
        amplitude = 2.0 * np.abs(np.fft.rfft((values - values.mean()) * window)) / window.sum()
        return np.arange(amplitude.size) / (self.periods[k] * self.turns[k]), amplitude

    def lines(self, k: int, run: int = 0, contact: int = 0, what: str = "displacement") -> list[tuple[float, float]]:
        """The strongest lines of a spectrum, largest first: frequency over that of the fastest mesh, and amplitude."""
        order, a = self.spectrum(k, run, contact, what)
        if not np.all(np.isfinite(a)):
            return []
        maxima = np.flatnonzero((a[1:-1] >= a[:-2]) & (a[1:-1] > a[2:])) + 1
        strong = []
        for i in maxima.tolist():
            # Hann's window spreads a line over the bins next to it, so they are no part of its surroundings.
            around = np.concatenate([a[max(0, i - _SIDE) : i - 1], a[i + 2 : i + 2 + _SIDE]])
            if a[i] > max(_SHARE * a.max(), _ABOVE * float(np.median(around))):
                strong.append(_between(order, a, i))
        return sorted(strong, key=lambda line: -line[1])[:_MOST_LINES]


def _between(order: np.ndarray, a: np.ndarray, i: int) -> tuple[float, float]:
    """Place and height of a lone line near bin i by Hann's two largest bins; Harris, Proc. IEEE 66 (1978) 51.

    With the ratio r of the smaller to the larger it lies x = (2 r - 1)/(r + 1) of a bin off, and is higher by the factor
    pi x (1 - x^2)/sin(pi x).
    """
    side = 1 if a[i + 1] >= a[i - 1] else -1
    r = a[i + side] / a[i]
    x = max(0.0, (2.0 * r - 1.0) / (r + 1.0))
    return float(order[i] + side * x * order[1]), float(a[i] * (1.0 - x**2) / np.sinc(x))
