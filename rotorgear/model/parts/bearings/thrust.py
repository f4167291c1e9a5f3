"""Thrust bearings in oil: sector pads, fixed or tilting."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from pydantic import Field

from rotorgear.errors import Problem
from rotorgear.model.parts.bearings.geometry import UNIT, Judged, Oil, arc_row
from rotorgear.model.parts.fields import Angle, PositiveLength, Ratio, Whole
from rotorgear.model.parts.problems import told
from rotorgear.quantity import millimetres

if TYPE_CHECKING:
    from rotorgear.forces.thrust_film import ThrustFilm


class ThrustGeometry(Oil):
    """A thrust bearing in oil: sector pads, fixed with a taper and a land, or tilting about a radius."""

    noun: ClassVar[str] = "a thrust bearing"
    others: ClassVar[str] = "what holds the shaft across is a bearing of its own, at the same place"
    ring: ClassVar[str] = "outer_diameter"
    fits: ClassVar[tuple[float, float]] = (0.3, 12.0)

    inner_diameter: PositiveLength = Field(description="inner diameter of the pads")
    outer_diameter: PositiveLength = Field(description="outer diameter of the pads")
    clearance: PositiveLength = Field(
        description="gap between collar and pads (the land of fixed ones) of each side, with the shaft at its place"
    )
    pads: Whole = Field(8, description="number of pads of a side")
    pad_arc: Angle | None = Field(None, description="extent of a pad; default: 0.85 of its share of the circle")
    pad_at: Angle = Field(0.0, description="angle of the middle of the first pad, from +x about +z")
    taper: PositiveLength | None = Field(None, description="depth of the taper at the leading edge of fixed pads")
    taper_share: Ratio = Field(0.8, description="share of the arc that the taper takes; 1: a wedge without a land")
    pivot: Ratio | None = Field(
        None,
        description="where in a tilting pad its pivot is, as a share of its arc in the sense of rotation; 0.6 as a rule",
    )
    acts: Literal["both", "+z", "-z"] = Field("both", description="pushes of the shaft that the bearing takes")
    whirl_ratio: Ratio = Field(
        1.0,
        description="frequency over the speed of the shaft at which stiffness and damping of tilting pads are taken",
    )
    around: Whole = Field(40, description="cells of the grid along a pad")
    across: Whole = Field(10, description="cells of the grid from the inner to the outer diameter")

    @property
    def takes(self) -> tuple[str, ...]:
        """The pushes that it acts against."""
        return ("+z", "-z") if self.acts == "both" else (self.acts,)

    def law(self, ratio: float, sense: float, linear: Sequence[float]) -> ThrustFilm:
        """Its films."""
        from rotorgear.forces.thrust_film import ThrustFilm

        same = ("clearance", "pads", "taper_share", "acts", "whirl_ratio", "around", "across")
        return ThrustFilm(
            **self.oil_parameters(),
            **{key: getattr(self, key) for key in same},
            inner_radius=0.5 * self.inner_diameter,
            outer_radius=0.5 * self.outer_diameter,
            arc=self.pad_arc or 0.85 * 2.0 * math.pi / self.pads,
            at=self.pad_at,
            taper=self.taper or 0.0,
            pivot=-1.0 if self.pivot is None else self.pivot if sense > 0.0 else 1.0 - self.pivot,
            order=ratio,
        )

    def problems(self, here: str, beside: Mapping[str, Any]) -> Iterator[Problem]:
        """Pads that fit and carry, on a grid that serves."""
        yield from super().problems(here, beside)
        inside = f"less than the outer diameter of {millimetres(self.outer_diameter)}"
        thin = "a film that is thin: at most a twentieth of the outer diameter, 1e-3 as a rule"
        few = 1 <= self.pads <= 40
        both = "neither taper nor pivot" if self.taper is None else "taper and pivot"
        either = "a taper of fixed pads, or the pivot of tilting ones"
        above = "a share of the arc above 0, up to 1"
        pivot = 0.5 if self.pivot is None else self.pivot
        cells = [("around", self.around, 6, 400), ("across", self.across, 4, 200)]
        yield from told(
            here,
            ("inner_diameter", self.inner_diameter >= self.outer_diameter, millimetres(self.inner_diameter), inside),
            ("clearance", self.clearance > 0.05 * self.outer_diameter, millimetres(self.clearance), thin),
            ("pads", not few, str(self.pads), "1 to 40 pads"),
            arc_row("pad_arc", self.pads, self.pad_arc if few else None, "pads"),
            ("", (self.taper is None) == (self.pivot is None), both, either),
            ("pivot", not 0.0 < pivot < 1.0, f"{pivot:g}", "a share of the arc between 0 and 1"),
            ("taper_share", not 0.0 < self.taper_share <= 1.0, f"{self.taper_share:g}", above),
            ("whirl_ratio", not self.whirl_ratio, "0", "a ratio above 0; 1 is synchronous"),
            *((key, not least <= n <= most, f"{n}", f"{least} to {most} cells") for key, n, least, most in cells),
        )

    def judged(self) -> Iterator[Judged]:
        """The oil and its gap, and before its density the taper."""
        *film, density = super().judged()
        yield from film
        if self.taper is not None:
            share = self.taper / self.clearance
            got = f"{self.taper:.4g} m, {share:.3g} of the clearance"
            yield "taper", share, (0.02, 50.0), got, "{:g} to {:g} of it", (UNIT, "um meant?")
        yield density
