"""What the laws of loaded teeth share: their maps give the approach under loads, and repeat with the mesh cycle."""

from __future__ import annotations

import numpy as np

from rotorgear.forces.law import ForceLaw, Repeats

# Harmonics of a base pitch that count: teeth part, and corners strike.
_HARMONICS = 10


class LoadedMap(ForceLaw):
    """A contact by a map: the approach (..., p, l) at p even positions of its cycle under l loads."""

    load: np.ndarray
    approach: np.ndarray
    stiffness: float
    damping: float
    contact_damping: str
    reference: float
    order: float
    periods: int
    error_cos: tuple[float, ...]
    error_sin: tuple[float, ...]

    def __eq__(self, other: object) -> bool:
        """Whether all parameters are the same, arrays element by element."""
        return type(other) is type(self) and all(
            np.array_equal(getattr(self, name), getattr(other, name)) for name in self.declared()
        )

    def __hash__(self) -> int:
        """Of the loads: equal laws have equal ones."""
        return hash(self.load.tobytes())

    @property
    def can_part(self) -> bool:
        """The flanks push only."""
        return True

    @property
    def known_up_to(self) -> float:
        """The largest load of the map."""
        return float(self.load[-1])

    def left_out(self) -> tuple[str, ...]:
        """Nothing of the loaded teeth but what moves too fast for them to be at rest; the damping is no part of their map."""
        damped = "no damping of the teeth is given"
        if self.damping and self.contact_damping == "penetration":
            damped = f"damping is {self.damping:.4g} N s/m times the deflection over {1e6 * self.reference:.3g} um"
        elif self.damping:
            damped = (
                f"damping goes with the stiffness that carries, {self.damping:.4g} N s/m at {self.stiffness:.4g} N/m, and is "
                "nothing where the teeth part"
            )
        return (
            f"inertia of the teeth on their bodies: they follow their static contact over the mesh cycle; {damped}",
        )

    def repeats(self) -> tuple[Repeats, ...]:
        """The mesh cycle, or the several base pitches after which the map repeats."""
        if not self.order or (self.approach.shape[-2] == 1 and not (self.error_cos or self.error_sin)):
            return ()
        highest = max(_HARMONICS, len(self.error_cos), len(self.error_sin))
        return (Repeats(abs(self.order) / self.periods, highest * self.periods),)
