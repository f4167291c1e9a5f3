"""How the systems of a sweep were reduced, and the FRF error of the reduction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Reduction:
    """A basis of modes and static shapes in place of all degrees of freedom; of several bases, the largest values.

    Attributes:
        dofs: before. coordinates: after. modes: elastic modes among them; highest: frequency of the highest of these in Hz.
        rigid: rigid-body modes. static: static shapes of contacts and loads.
        closed, apart: FRF error: largest relative difference of the receptances at the contacts from those of the whole system,
            with all contacts closed and with all of them open; see solvers/frequency/receptance.py.
        up_to: Hz up to which they were compared. frequencies: how many. bases: how many bases there are.
        seconds: to find and check them.
    """

    dofs: int
    coordinates: int
    modes: int
    highest: float
    rigid: int
    static: int
    closed: float
    apart: float
    up_to: float
    frequencies: int
    bases: int
    seconds: float

    @property
    def error(self) -> float:
        """The larger of the two differences."""
        return max(self.closed, self.apart)

    @property
    def sentence(self) -> str:
        """One sentence that describes the reduction."""
        parts = [f"{self.modes} modes up to {_hertz(self.highest)}"] if self.modes else []
        parts += [f"{self.rigid} rigid"] if self.rigid else []
        parts += [f"{self.static} static shapes"] if self.static else []
        return (
            f"{self.dofs} dofs reduced to {self.coordinates} ({', '.join(parts)}): FRF error at the contacts "
            f"{100.0 * self.error:.2g} % up to {_hertz(self.up_to)}"
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON; the keys are documented in docs/json.md."""
        return {
            "dofs": self.dofs,
            "coordinates": self.coordinates,
            "modes": self.modes,
            "highest_mode_hz": self.highest,
            "rigid_motions": self.rigid,
            "static_shapes": self.static,
            "error_closed": self.closed,
            "error_apart": self.apart,
            "up_to_hz": self.up_to,
            "frequencies": self.frequencies,
            "bases": self.bases,
            "seconds": self.seconds,
        }


def _hertz(value: float) -> str:
    return f"{value / 1000.0:.3g} kHz" if value >= 1000.0 else f"{value:.3g} Hz"
