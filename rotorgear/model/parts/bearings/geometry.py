"""What every kind of bearing answers that is given by its geometry.

A kind is a class of this base and a field of `Bearing` (model/parts/supports.py), whose name is its key in the file. All else
asks the bearing for its geometry, and that for what it needs, so that nothing else has to know which kinds there are.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar

from rotorgear.errors import Problem
from rotorgear.model.parts.fields import Part

if TYPE_CHECKING:
    from rotorgear.forces.law import ForceLaw

# Key, value by which it is judged, what is usual; value and usual range as they are printed; likely slips below and above.
Judged = tuple[str, float, tuple[float, float], tuple[str, str], tuple[str, str]]


class BearingGeometry(Part):
    """Base of the kinds.

    Attributes:
        noun: what a sentence calls it.
        ring: key of the diameter that surrounds the shaft. fits: usual ones, over the least and the largest of the shaft.
        fastest: speed of the shaft in it that nothing exceeds, m/s on half that diameter. runs: a clause on that, of its name.
    """

    noun: ClassVar[str]
    ring: ClassVar[str]
    fits: ClassVar[tuple[float, float]]
    fastest: ClassVar[float]
    runs: ClassVar[str]

    @abstractmethod
    def law(self, ratio: float, sense: float, linear: Sequence[float]) -> ForceLaw:
        """Its force law.

        Args:
            ratio: turns of its shaft for each turn of the reference.
            sense: of rotation of the reference for which it is built, 1 or -1: that of pivots and least gaps.
            linear: stiffness given beside it, (6,) in N/m and N m/rad; 0 where none is.
        """

    @abstractmethod
    def problems(self, here: str, beside: Mapping[str, Any]) -> Iterator[Problem]:
        """What of its numbers does not go together.

        Args:
            here: its address. beside: what else the bearing is given by, by its keys.
        """

    @abstractmethod
    def judged(self) -> Iterator[Judged]:
        """Its numbers that physics makes unlikely beyond some range."""

    @property
    def surrounds(self) -> float:
        """Diameter that surrounds the shaft, in m."""
        return float(getattr(self, self.ring))

    @property
    def play(self) -> float | None:
        """Whole play of the shaft along a diameter in m; None where nothing is known of it."""
        return None

    @property
    def estimate(self) -> str:
        """What of it is an estimate, as a sentence; or ""."""
        return ""
