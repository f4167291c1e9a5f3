"""Journal bearings in oil: plain, with lobes, or of tilting pads."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from pydantic import Field

from rotorgear.errors import Problem
from rotorgear.model.parts.bearings.geometry import Oil, arc_row
from rotorgear.model.parts.fields import Angle, PositiveLength, Ratio, Whole
from rotorgear.model.parts.problems import told
from rotorgear.quantity import millimetres

if TYPE_CHECKING:
    from rotorgear.forces.journal_film import JournalFilm
    from rotorgear.forces.tilting_pads import TiltingPads


class JournalGeometry(Oil):
    """A journal bearing with its oil film: plain, with lobes, or of tilting pads."""

    noun: ClassVar[str] = "a journal"
    others: ClassVar[str] = "what holds the shaft along z is a support or a bearing of its own"
    ring: ClassVar[str] = "diameter"
    fits: ClassVar[tuple[float, float]] = (0.3, 3.0)

    diameter: PositiveLength = Field(description="diameter of the journal")
    length: PositiveLength = Field(description="length of the bearing")
    clearance: PositiveLength = Field(
        description="radial clearance; of lobes where the gap of the centred journal is least"
    )
    cavitation: Literal["reynolds", "half_sommerfeld"] = Field(
        "reynolds",
        description="reynolds: pressure and its slope vanish together; half_sommerfeld: negative pressures of the full film are "
        "cut",
    )
    inlet: Angle | None = Field(
        None,
        description="angle of the oil inlet of a plain bearing, from +x about +z; default: where the gap is widest at the static "
        "equilibrium",
    )
    lobes: Whole = Field(1, description="number of lobes; 1: a plain bearing")
    lobe_arc: Angle | None = Field(None, description="extent of a lobe; default: its share of the circle")
    lobe_at: Angle = Field(0.0, description="angle of the middle of the first lobe, from +x about +z")
    preload: Ratio = Field(
        0.0, description="preload of lobes or pads: 1 - clearance over (radius of lobe or pad - journal radius)"
    )
    offset: Ratio = Field(
        0.5,
        description="where in a lobe the gap of the centred journal is least, as a share of its arc in the sense of rotation; "
        "0.5: symmetric; 1 with two lobes: offset halves",
    )
    pads: Whole | None = Field(None, description="number of tilting pads; default: none, a bearing that is fixed")
    pad_arc: Angle | None = Field(None, description="extent of a tilting pad; default: 0.8 of its share of the circle")
    pad_at: Angle = Field(0.0, description="angle of the pivot of the first pad, from +x about +z")
    pivot: Ratio = Field(0.5, description="where in a pad its pivot is, as a share of its arc in the sense of rotation")
    whirl_ratio: Ratio = Field(
        1.0,
        description="frequency over the speed of the journal at which stiffness and damping of tilting pads are taken; 1: "
        "synchronous",
    )
    around: Whole = Field(240, description="cells of the grid around the circle")
    along: Whole = Field(12, description="cells of the grid over half the length")

    @property
    def follows(self) -> bool:
        """Whether the oil flows in where the gap is widest: a plain bearing whose inlet is not given."""
        return self.inlet is None and self.lobes == 1 and self.pads is None

    @property
    def play(self) -> float:
        """Twice the radial clearance."""
        return 2.0 * self.clearance

    def law(self, ratio: float, sense: float, linear: Sequence[float]) -> JournalFilm | TiltingPads:
        """Its film."""
        same = ("length", "clearance", "preload", "cavitation", "around", "along")
        own = self.oil_parameters() | {key: getattr(self, key) for key in same}
        own |= {"radius": 0.5 * self.diameter, "order": ratio}
        if self.pads:
            from rotorgear.forces.tilting_pads import TiltingPads

            return TiltingPads(
                **own,
                pads=self.pads,
                arc=self.pad_arc or 0.8 * 2.0 * math.pi / self.pads,
                at=self.pad_at,
                pivot=self.pivot if sense > 0.0 else 1.0 - self.pivot,
                whirl_ratio=self.whirl_ratio,
            )
        from rotorgear.forces.journal_film import JournalFilm

        return JournalFilm(
            **own,
            lobes=self.lobes,
            arc=self.lobe_arc or 0.0,
            at=self.lobe_at,
            offset=self.offset if sense > 0.0 else 1.0 - self.offset,
            inlet=self.inlet or 0.0,
            follows=self.inlet is None and self.lobes == 1,
        )

    def problems(self, here: str, beside: Mapping[str, Any]) -> Iterator[Problem]:
        """Lobes or pads that fit, each with its keys, on a grid that serves."""
        yield from super().problems(here, beside)
        on = f"on a diameter of {millimetres(self.diameter)}"
        long = "at most two diameters, beyond which shafts bend in their bearing"
        thin = "a film that is thin: at most a tenth of the diameter, 1e-3 as a rule"
        between = "none beside lobes: oil comes in between them"
        counts = {key: getattr(self, key) for key in ("lobes", "around", "along")}
        most = {"lobes": 8, "around": 2000, "along": 200}
        least = {"around": 24, "along": 2}
        pads = self.pads or 0
        of_pads = self.pad_arc is not None or self.pad_at or self.pivot != 0.5 or self.whirl_ratio != 1.0
        fixed = self.lobes > 1 or self.inlet is not None
        of_lobes = (self.preload and not pads) or self.lobe_arc is not None or self.lobe_at or self.offset != 0.5
        yield from told(
            here,
            ("length", self.length > 2.0 * self.diameter, f"{millimetres(self.length)} {on}", long),
            ("clearance", self.clearance > 0.1 * self.diameter, f"{millimetres(self.clearance)} {on}", thin),
            *((key, counts[key] > limit, f"{counts[key]}", f"at most {limit}") for key, limit in most.items()),
            *((key, counts[key] < limit, f"{counts[key]}", f"at least {limit} cells") for key, limit in least.items()),
            ("pads", not pads and of_pads, "keys of pads in a fixed bearing", "the number of pads beside them"),
            ("pads", pads and not 2 <= pads <= 12, str(pads), "2 to 12 pads"),
            ("pads", pads and fixed, "pads beside lobes or an inlet", "one of them: oil comes in between pads"),
            arc_row("pad_arc", pads, self.pad_arc if pads else None, "pads"),
            ("pivot", pads and not 0.0 < self.pivot < 1.0, f"{self.pivot:g}", "a share of the arc between 0 and 1"),
            ("whirl_ratio", pads and not self.whirl_ratio, "0", "a ratio above 0; 1 is synchronous"),
            ("lobes", self.lobes == 1 and of_lobes, "keys of lobes in a plain bearing", "2 lobes or more beside them"),
            ("inlet", self.lobes > 1 and self.inlet is not None, "an inlet", between),
            ("preload", self.preload >= 1.0, f"{self.preload:g}", "a share from 0 to below 1"),
            ("offset", self.offset > 1.0, f"{self.offset:g}", "a share of the arc from 0 to 1"),
            arc_row("lobe_arc", self.lobes, self.lobe_arc, "lobes"),
        )
