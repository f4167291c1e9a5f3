"""Spectra of a transient's histories: windowed and true in amplitude, over frequency or over orders of the reference shaft.

A window w scales a line by sum(w)/2, which is divided out. A flat top window keeps a line's height within 0.1 % wherever it lies
between two bins; Hann's tells near lines better apart. Harris, Proc. IEEE 66 (1978) 51.
"""

from __future__ import annotations

import numpy as np

from rotorgear.analysis.common.excitation import excitation_lines
from rotorgear.analysis.common.recorded import recorded
from rotorgear.errors import AnalysisError
from rotorgear.results.spectrum import SpectralLines, Spectrum
from rotorgear.results.transient import TransientResult

# Width of a line in bins between its half heights.
_WIDTH = {"hann": 2.0, "flattop": 3.8, "boxcar": 1.2}
# A line is listed from this share of the largest one on.
_FLOOR = 1e-4
_MOST_LINES = 30


def history_of(result: TransientResult, name: str) -> tuple[np.ndarray, str]:
    """A history and its unit.

    Raises:
        AnalysisError: no such history; the text lists the nearest names.
    """
    from rotorgear.quantity import did_you_mean

    units = {f"{what} {c}": "m" for c in result.contact for what in ("force", "transmission_error", "approach")}
    units |= {name: "N" for name in units if name.startswith("force")}
    units = dict(zip(result.channel, result.unit, strict=True)) | units
    if name not in units and name.removeprefix("deflection ") not in result.contact:
        hint = did_you_mean(name, units, f"known: {', '.join(list(units)[:6])} ...")
        raise AnalysisError(f"there is no history '{name}'; {hint}")
    return result.history(name), units.get(name, "m")


def spectrum(result: TransientResult, name: str, *, window: str = "hann", orders: bool = False) -> Spectrum:
    """Return the amplitude spectrum of what counts of a history.

    Args:
        result: a transient result.
        name: a channel, "force CONTACT", "transmission_error CONTACT" or "approach CONTACT".
        window: hann, flattop or boxcar.
        orders: over orders of the reference shaft, from the history at even angles: for run-ups.

    Raises:
        AnalysisError: unknown history or window, too few records, or orders of a shaft at rest.
    """
    from scipy.interpolate import CubicSpline
    from scipy.signal import get_window

    if window not in _WIDTH:
        raise AnalysisError(f"window: got '{window}', expected one of {', '.join(_WIDTH)}")
    values, unit = history_of(result, name)
    values = values[result.counted]
    if values.size < 16:
        raise AnalysisError(f"{values.size} records are too few for a spectrum: run longer, or record more often")
    spacing = result.spacing
    over = "Hz"
    if orders:
        # The transform wants even spacing: equal angles, at which one order stays in one bin while the speed changes.
        angle = np.abs(result.angle[result.counted])
        if np.any(np.diff(angle) <= 0.0):
            raise AnalysisError("orders need a shaft that turns on in one sense: its speed goes through zero here")
        even = np.linspace(angle[0], angle[-1], values.size)
        values = CubicSpline(angle, values)(even)
        spacing = float(even[1] - even[0]) / (2.0 * np.pi)
        over = "order"
    w = get_window(window, values.size)
    amplitude = 2.0 * np.abs(np.fft.rfft((values - values.mean()) * w)) / w.sum()
    frequency = np.fft.rfftfreq(values.size, spacing)
    return Spectrum(name, unit, frequency, amplitude, window, _WIDTH[window] / (values.size * spacing), over)


@recorded
def spectral_lines(
    result: TransientResult, name: str, *, window: str = "flattop", count: int = _MOST_LINES
) -> SpectralLines:
    """Return the strongest lines of a history at constant speed, each with the shaft or mesh order it belongs to.

    Args:
        result: a transient at constant speed.
        name: of the history.
        window: of the amplitudes; the flat top keeps heights between two bins.
        count: how many lines at most.

    Returns:
        The lines, lowest frequency first.
    """
    found = spectrum(result, name, window=window)
    hann = spectrum(result, name, window="hann")
    a = found.amplitude
    inner = np.flatnonzero((a[1:-1] >= a[:-2]) & (a[1:-1] > a[2:])) + 1
    inner = inner[a[inner] > _FLOOR * a.max(initial=0.0)]
    strongest = np.sort(inner[np.argsort(a[inner])[::-1][:count]])
    frequencies = np.array([_between_bins(hann, i) for i in strongest])
    # Two peaks of one line, on a shoulder of the wide window, are one.
    close = np.abs(frequencies - frequencies[:, None]) < 0.5 * found.resolution
    highest = ~np.any(close & (a[strongest] > a[strongest][:, None]), axis=1)
    strongest = strongest[highest]
    frequencies = frequencies[highest]
    sources = tuple(_source(result, f, found.resolution) for f in frequencies)
    return SpectralLines(name, found.unit, frequencies, a[strongest], sources, window, found.resolution)


def _between_bins(hann: Spectrum, i: int) -> float:
    """Frequency of a lone line near bin i from the two largest of Hann's bins: exact for one sine.

    With the ratio r of the smaller to the larger it lies (2 r - 1)/(r + 1) of a bin off; Harris, Proc. IEEE 66 (1978) 51.
    """
    a = hann.amplitude
    first = max(i - 2, 1)
    k = first + int(np.argmax(a[first : min(i + 3, a.size - 1)]))
    side = 1 if a[k + 1] >= a[k - 1] else -1
    ratio = a[k + side] / max(a[k], 1e-300)
    return float(hann.frequency[k] + side * (2.0 * ratio - 1.0) / (ratio + 1.0) * hann.frequency[1])


def _source(result: TransientResult, frequency: float, resolution: float) -> str:
    """Name of the mesh order within a quarter of the resolution, else of the shaft order where shafts have an unbalance."""
    best = 0.25 * resolution
    name = ""
    for mesh, f in result.mesh_frequency.items():
        order = max(1, round(frequency / f))
        if abs(frequency - order * f) < best * (1.0 - 1e-9):
            best = abs(frequency - order * f)
            name = f"mesh {mesh} {order}x"
    if name or not result.model.unbalances:
        return name
    for line in excitation_lines(result.model, float(result.speed[-1])):
        if line.name.startswith("shaft") and abs(frequency - line.frequency_hz) < best:
            best = abs(frequency - line.frequency_hz)
            name = line.name
    return name
