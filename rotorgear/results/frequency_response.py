"""Result of a frequency response analysis: receptances between places."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from rotorgear.quantity import RPM_PER_RAD_S, counted
from rotorgear.results.laws import AboutEquilibrium
from rotorgear.results.modal import Piece
from rotorgear.results.schema import Written, imaginary_part, of, real_part
from rotorgear.results.table import Block, Line, error_words, grid

# What the receptance is multiplied with: a power of i w.
QUANTITIES = {"receptance": 0, "mobility": 1, "accelerance": 2}


# So many peaks of each response are listed.
_PEAKS = 6
# Half-power width of a peak, in steps of the frequencies, from which on three of them describe it.
_RESOLVED = 1.0


class Peak(NamedTuple):
    """A peak of one response: its frequency in Hz and its size; `resolved` is False where the frequencies are too far apart.

    The size of such a peak is that at the highest frequency of the grid, and the true one is larger.
    """

    frequency_hz: float
    size: float
    resolved: bool


def peak_between(x: np.ndarray, size: np.ndarray, power: int) -> Peak | None:
    """The peak of x^(power/2) |H| within three points, from |H| alone; None where they don't describe one.

    Of one mode 1/|H|^2 = ((x_r - x)^2 + 4 zeta^2 x_r x)/|A|^2 in x = w^2, a parabola q(x): three points give it exactly, and
    x^p/q(x) is largest where (p - 2) a x^2 + (p - 1) b x + p c = 0, with q = a x^2 + b x + c.

    Args:
        x: squares of three frequencies in rad/s, ascending; size: |H| there, largest in the middle or beside it.
        power: 0, 1, 2 for receptance, mobility, accelerance.
    """
    middle = x[1]
    a, b, c = np.polyfit(x / middle, 1.0 / size**2, 2)
    if not a > 0.0:
        return None
    candidates = np.roots([(power - 2) * a, (power - 1) * b, power * c])
    at = [float(z.real) for z in candidates if z.imag == 0.0 and x[0] <= z.real * middle <= x[2]]
    if not at:
        return None
    z = at[0]
    least = a * z * z + b * z + c
    if least <= 0.0:
        return None
    # Half-power points of q stand sqrt(least/a) to both sides, in x; the wider step of the grid beside that.
    width = 2.0 * np.sqrt(least / a) * middle
    resolved = bool(width >= _RESOLVED * np.diff(x).max())
    w = float(np.sqrt(z * middle))
    return Peak(w / (2.0 * np.pi), float(w**power / np.sqrt(least)), resolved)


class BetweenPlaces(AboutEquilibrium):
    """A result of o places that answer to unit forces (or moments) at i places."""

    speed: float = of("speed of the input shaft", "rad/s")
    inputs: tuple[str, ...] = of("where the unit forces or moments act", "", "input", json="input")
    outputs: tuple[str, ...] = of("where the response is read", "", "output", json="output")
    input_units: tuple[str, ...] = of("units of what acts", "", "input", note=": N or N m")
    output_units: tuple[str, ...] = of("units of the displacements read", "", "output", note=": m or rad")
    discretisation: tuple[Piece, ...] = of("how each shaft segment was divided", "", "piece", record=Piece, json=None)

    @property
    def at_speed(self) -> str:
        """The speed in words."""
        turns = f"{self.model.reference_shaft} at {self.speed * RPM_PER_RAD_S:.6g} rpm"
        return turns if self.speed else "at standstill"


class FrequencyResponse(BetweenPlaces, kind="frf"):
    """Response of o places to unit forces (or moments) at i places, at f frequencies; Re(x e^{+iwt})."""

    json_axes = ("output", "input", "frequency")

    frequency_hz: np.ndarray = of("frequency", "Hz", "frequency")
    receptance: np.ndarray = of(
        "receptance: displacement over force",
        "m/N, rad/N, m/(N m) or rad/(N m)",
        "frequency",
        "output",
        "input",
        json=(
            Written("receptance_real", real_part, note=", real part"),
            Written("receptance_imag", imaginary_part, note=", imaginary part; negative where the response lags"),
        ),
    )
    damping_ratio: float = of("damping ratio", note=" added to every elastic mode")
    residual: float = of(
        "residual", note=" of the equations, the largest, relative to the forces inside", form=error_words
    )
    error_estimate: float = of(
        "estimated relative discretisation error",
        note=": change on a finer mesh at the largest responses, relative to the largest; 0 without shaft elements",
        form=error_words,
    )

    def of(self, quantity: str) -> np.ndarray:
        """Receptance, mobility or accelerance, (f, o, i)."""
        w = 2.0 * np.pi * self.frequency_hz
        return np.asarray(self.receptance * ((1j * w) ** QUANTITIES[quantity])[:, None, None])

    def unit(self, output: int, entry: int, quantity: str = "receptance") -> str:
        """Unit of one response, such as "m/N" or "rad/(N m s)"."""
        seconds = ("", "s", "s²")[QUANTITIES[quantity]]
        below = " ".join(word for word in (self.input_units[entry], seconds) if word)
        return f"{self.output_units[output]}/({below})" if " " in below else f"{self.output_units[output]}/{below}"

    def peaks(self, output: int, entry: int, quantity: str = "receptance") -> list[Peak]:
        """The local maxima of one response, largest first, between the frequencies where these resolve them."""
        power = QUANTITIES[quantity]
        x = (2.0 * np.pi * self.frequency_hz) ** 2
        receptance = np.abs(self.receptance[:, output, entry])
        size = np.abs(self.of(quantity)[:, output, entry])
        inside = np.flatnonzero((size[1:-1] > size[:-2]) & (size[1:-1] >= size[2:])) + 1
        found = []
        for k in inside:
            peak = peak_between(x[k - 1 : k + 2], receptance[k - 1 : k + 2], power)
            found.append(peak if peak and peak.resolved else Peak(float(self.frequency_hz[k]), float(size[k]), False))
        return sorted(found, key=lambda peak: -peak.size)

    def tables(self, *, quantity: str = "receptance") -> Iterator[Block]:
        """The highest peaks of each response, of receptance, mobility or accelerance."""
        hz = self.frequency_hz
        yield Line(f"{self.model.title or 'Model'}: {quantity}, {hz[0]:.6g} to {hz[-1]:.6g} Hz, {self.at_speed}")
        rows = []
        coarse = False
        for i, entry in enumerate(self.inputs):
            for o, place in enumerate(self.outputs):
                for peak in self.peaks(o, i, quantity)[:_PEAKS]:
                    coarse |= not peak.resolved
                    size = f"{'' if peak.resolved else '> '}{peak.size:.3e}"
                    rows.append((entry, place, f"{peak.frequency_hz:.2f}", size, self.unit(o, i, quantity)))
        yield from ("", grid(rows, "force at", "response at", "peak Hz", quantity, "unit", left=2, caption="Peaks"), "")
        yield f"{counted(len(hz), 'frequencies')}, {self.dofs} dofs, {self.cost}; {self.method}"
        yield (
            f"residual {error_words(self.residual)} of the forces inside; on a finer mesh the peaks change by "
            f"{error_words(self.error_estimate)}"
        )
        yield f"damping ratio added to every elastic mode: {self.damping_ratio:g}"
        if coarse:
            yield "> the peak is narrower than a step of the frequencies, and higher than at any of them"
        yield from (*self.remarks(), "")
