"""How the systems of a sweep were reduced, and the FRF error of the reduction."""

from __future__ import annotations

from rotorgear.results.schema import Record, of


class Reduction(Record):
    """A basis of modes and static shapes in place of all degrees of freedom; of several bases, the largest values."""

    dofs: int = of("degrees of freedom", note=" before the reduction; of several bases, the largest values")
    coordinates: int = of("coordinates after the reduction")
    modes: int = of("elastic modes among them")
    highest: float = of("frequency of the highest of these modes", "Hz", json="highest_mode_hz")
    rigid: int = of("rigid-body motions among them", json="rigid_motions")
    static: int = of("static shapes of loads and contacts among them", json="static_shapes")
    closed: float = of(
        "FRF error: largest relative error of the receptances at the contacts, all of them closed",
        json="error_closed",
        note=", against those of the whole system (solvers/frequency/receptance.py)",
    )
    apart: float = of(
        "FRF error: largest relative error of the receptances at the contacts, all of them open", json="error_apart"
    )
    up_to: float = of("frequency up to which they were compared", "Hz", json="up_to_hz")
    frequencies: int = of("at how many frequencies")
    bases: int = of("how many bases there are")
    seconds: float = of("wall time", "s", note=" to find and check them")

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


def _hertz(value: float) -> str:
    return f"{value / 1000.0:.3g} kHz" if value >= 1000.0 else f"{value:.3g} Hz"
