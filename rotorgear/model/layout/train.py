"""Speed and sense of every shaft of a train, and how its shafts hang together."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction

# Base radii come rounded to a few digits, so a loop of lumped gears closes only to this; loops with teeth close exactly.
LOOP_TOLERANCE = 1e-6
# No train comes near this ratio; within it, speeds and torques stay in the range of numbers.
EXTREME_RATIO = 1e12


# Speed over another speed: exact from numbers of teeth, else a float.
Ratio = Fraction | float
# What joins two shafts kinematically: its address, both shafts, the speed of the second over that of the first.
Link = tuple[str, str, str, Ratio]
# Shaft -> address, other shaft and its ratio to this one, of each link.
Neighbours = dict[str, list[tuple[str, str, Ratio]]]


@dataclass(frozen=True)
class Train:
    """Speeds of all shafts relative to the reference shaft, and the order of the walk.

    Attributes:
        reference: name of the shaft whose speed is the reference.
        ratios: shaft -> speed over that of the reference; negative turns the other way, 0 stands still.
        depth: shaft -> number of links from the reference (or from the start of its own part of the train).
        group: shaft -> number of the kinematically connected part it belongs to; 0 holds the reference.
        reached_by: shaft -> address of the mesh or coupling through which the walk came, "" at a start.
        rotations: of each connected part with carriers the rotations that no mesh resists: speeds of its shafts, of one that is
            driven by the reference alone those of `ratios`. Shafts that are held stand still in all of them.
    """

    reference: str
    ratios: dict[str, Ratio] = field(default_factory=dict)
    depth: dict[str, int] = field(default_factory=dict)
    group: dict[str, int] = field(default_factory=dict)
    reached_by: dict[str, str] = field(default_factory=dict)
    rotations: dict[int, tuple[dict[str, Ratio], ...]] = field(default_factory=dict)

    def free_rotations(self, group: int) -> tuple[dict[str, Ratio], ...]:
        """Speeds of the shafts of a connected part in each rotation that no mesh resists."""
        return self.rotations.get(group, (self.ratios,))

    def ratio(self, shaft: str) -> float:
        """Speed of a shaft over that of the reference shaft."""
        return float(self.ratios[shaft])

    def sense(self, shaft: str) -> int:
        """+1 or -1: sense of rotation about +z where the reference turns positively; +1 for a shaft at rest."""
        return -1 if self.ratios[shaft] < 0 else 1


def ratio_text(ratio: Ratio) -> str:
    """A ratio in digits, and as a fraction where it is one."""
    exact = f" ({ratio.numerator}/{ratio.denominator})" if isinstance(ratio, Fraction) and ratio.denominator > 1 else ""
    return f"{float(ratio):.9g}{exact}"
