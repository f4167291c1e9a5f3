"""Rolling bearings: balls and rollers by their contacts."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from pydantic import ConfigDict, Field, field_validator, model_validator

from rotorgear.errors import Problem
from rotorgear.forces.designations import SERIES, bore_of, class_clearance, designated, inner_geometry, words_of
from rotorgear.model.parts.bearings.geometry import UNIT, BearingGeometry, Judged
from rotorgear.model.parts.fields import Angle, Force, NonNegativeLength, PositiveLength, PositiveRatio, Whole, refuse
from rotorgear.model.parts.problems import told
from rotorgear.quantity import millimetres

if TYPE_CHECKING:
    from rotorgear.forces.ball_bearing import BallBearing
    from rotorgear.forces.law import ForceLaw
    from rotorgear.forces.tapered_bearing import SlicedRollers, TaperedBearing


class RollingElements(BearingGeometry):
    """What rolls in a bearing: its Hertz contacts, clearance and turning cage; by its geometry, or by a designation."""

    noun: ClassVar[str] = "rolling elements"
    ring: ClassVar[str] = "pitch_diameter"
    fits: ClassVar[tuple[float, float]] = (0.3, 12.0)
    fastest: ClassVar[float] = 200.0
    runs: ClassVar[str] = "whose bearing '{}' rolls"

    # With a designation the four keys that are needed otherwise may be left out.
    model_config = ConfigDict(json_schema_extra=lambda schema: schema.update(required=[]))

    designation: str | None = Field(
        None,
        description="series and two digits of the bore, with or without a blank, then any suffix: '6206', 'NU 208', '7209 B' "
        "(B 40, A 30, AC, A5 or E 25, C 15 deg); fills what is not given of kind, elements, diameters, length and contact angle, "
        "estimated from the outside where nothing is published",
    )
    kind: Literal["ball", "roller", "tapered", "four-point"] = Field(
        description="ball, cylindrical roller, tapered roller, or ball between two arcs (four-point)"
    )
    elements: Whole = Field(description="number of balls or rollers of a row")
    element_diameter: PositiveLength = Field(description="diameter of a ball or roller")
    pitch_diameter: PositiveLength = Field(description="diameter of the circle of their centres")
    length: PositiveLength | None = Field(None, description="effective length of a roller")
    clearance: NonNegativeLength = Field(0.0, description="radial internal clearance: the whole play along a diameter")
    clearance_class: Literal["C2", "CN", "C3", "C4", "C5"] | None = Field(
        None,
        description="class of ISO 5753-1 of a deep groove ball bearing, in place of the clearance: the middle of its range "
        "before fits and warmth",
    )
    bore: PositiveLength | None = Field(
        None,
        description="bore of the inner ring, above 10 to 120 mm, for the class; default: that of the designation",
    )
    preload_displacement: NonNegativeLength = Field(
        0.0,
        description="axial displacement by which the rings of an angular contact bearing are pressed together at assembly; two "
        "bearings that are set against each other by 20 um have 10 um each",
    )
    preload_force: Force = Field(0.0, description="axial force that presses it together, in place of that displacement")
    contact_angle: Angle = Field(
        0.0,
        description="free contact angle of an angular contact ball bearing, or of the outer raceway of a tapered one; positive "
        "where it takes a push towards +z",
    )
    arrangement: Literal["single", "O", "X", "tandem"] = Field(
        "single",
        description="two rows of angular contact or tapered bearings: O (back to back), X (face to face) or tandem; single: one",
    )
    row_distance: PositiveLength | None = Field(
        None, description="distance of the middles of the two rows; the bearing stands half way between them"
    )
    slices: Whole | None = Field(
        None,
        description="slices of a roller over which its load varies as the rings tilt; default: 21 of a tapered one, 1 of a "
        "cylindrical one, which then feels no tilt",
    )
    inner_groove: PositiveRatio = Field(0.52, description="groove radius of the inner ring over the ball's diameter")
    outer_groove: PositiveRatio = Field(0.53, description="groove radius of the outer ring over the ball's diameter")

    @model_validator(mode="before")
    @classmethod
    def _by_designation(cls, data: Any) -> Any:
        """Fill what a designation tells, where it is not given."""
        if not isinstance(data, dict) or not isinstance(data.get("designation"), str):
            return data
        # What an unknown one lacks is not missing: the designation is wrong, which its own check says.
        known = inner_geometry(data["designation"])[0] or inner_geometry("6206")[0]
        given = {key: value for key, value in data.items() if value is not None}
        if "clearance_class" in given:
            known["bore"] = bore_of(data["designation"])
        return {**known, **given}

    @property
    def seat(self) -> float | None:
        """Bore of the inner ring in m, as given or by its designation; None where neither is."""
        return self.bore or bore_of(self.designation)

    @field_validator("designation")
    @classmethod
    def _known(cls, value: str | None) -> str | None:
        """Refuse what is not in the tables."""
        if value is None or inner_geometry(value)[0]:
            return value
        found = designated(value)
        why = f" (this is a {words_of(found.type)} bearing: give its stiffness)" if found else ""
        raise refuse(
            f"a designation of the series {SERIES}{why}; or leave it out and give kind, elements and diameters"
        )

    @property
    def play(self) -> float | None:
        """The clearance, where it has one."""
        return self.clearance or None

    @property
    def takes(self) -> tuple[str, ...]:
        """That of its side where its rows press to one; both of a ball bearing without an angle, whose balls find theirs."""
        if self.kind == "roller":
            return ()
        one_sided = self.contact_angle and self.kind != "four-point" and self.arrangement in ("single", "tandem")
        return ("+z" if self.contact_angle > 0.0 else "-z",) if one_sided else ("+z", "-z")

    @property
    def estimate(self) -> tuple[str, str, str]:
        """Where its elements or its contact angle follow from its designation."""
        known, published = inner_geometry(self.designation or "")
        said = designated(self.designation or "")
        if said is None or not known:
            return "", "", ""
        angle = ""
        if math.isclose(abs(self.contact_angle), known.get("contact_angle", math.inf)):
            angle = f"{math.degrees(self.contact_angle):.4g} deg ({said.reason})"
        if published or self.element_diameter != known["element_diameter"]:
            what, why = "contact angle by the designation", "give contact_angle where you know it"
            return (what, why, f"{self.designation}: {angle}") if angle else ("", "", "")
        inside = f"{self.elements} of {1e3 * self.element_diameter:.4g} mm on {1e3 * self.pitch_diameter:.4g} mm"
        return (
            "elements estimated, since no maker prints them: stiffness and loads are an order of size",
            "give elements and diameters where you know them",
            f"{self.designation}: {inside}{f', {angle}' if angle else ''}",
        )

    def law(self, ratio: float, sense: float, linear: Sequence[float]) -> ForceLaw:
        """Hertz contacts of its balls or rollers; loads of slices vary along their roller."""
        import numpy as np

        # Elements that roll without slip between a turning inner ring and a still outer one: the cage turns at
        # (1 - D_w cos(alpha) / D_pw) / 2 of the shaft.
        slip_free = 0.5 * (1.0 - self.element_diameter * np.cos(self.contact_angle) / self.pitch_diameter)
        own: dict[str, Any] = {
            "clearance": self.clearance,
            "order": float(ratio * slip_free),
            "pitch_diameter": self.pitch_diameter,
            "reference": tuple(linear[:2]),
        }
        if self.kind in ("roller", "tapered"):
            own |= {"rollers": self.elements, "length": self.length or 0.0, "roller_diameter": self.element_diameter}
        if self.kind == "roller" and (self.slices or 1) == 1:
            from rotorgear.forces.roller_bearing import RollerBearing

            return RollerBearing(**own)
        own |= {"contact_angle": self.contact_angle, "row_distance": self.row_distance or 0.0}
        arrangement = "four-point" if self.kind == "four-point" else self.arrangement
        own |= {"reference": tuple(linear[:5]), "arrangement": arrangement}
        law: BallBearing | SlicedRollers | TaperedBearing
        if self.kind in ("roller", "tapered"):
            from rotorgear.forces.tapered_bearing import SlicedRollers, TaperedBearing

            own |= {"preload": self.preload_displacement, "slices": self.slices or 21}
            law = (TaperedBearing if self.kind == "tapered" else SlicedRollers)(**own)
        else:
            from rotorgear.forces.ball_bearing import BallBearing

            if self.clearance_class is not None and self.bore is not None:
                own["clearance"] = 0.5 * sum(class_clearance(self.bore, self.clearance_class) or (0.0, 0.0))
            side = -1.0 if self.contact_angle < 0.0 else 1.0
            law = BallBearing(
                **own,
                balls=self.elements,
                ball_diameter=self.element_diameter,
                inner_groove=self.inner_groove,
                outer_groove=self.outer_groove,
                preload=side * self.preload_displacement,
            )
        return law.pressed_by(self.preload_force) if self.preload_force else law

    def problems(self, here: str, beside: Mapping[str, Any]) -> Iterator[Problem]:
        """Rolling elements that fit into their bearing, beside a stiffness that the linear analyses take."""
        stiffness = beside.get("stiffness")
        crossed = "table" in beside or (stiffness and stiffness.given & {"matrix", "xy", "yx"})
        diagonal = "stiffness along x, y, axial and tilt beside them"
        size = millimetres(self.element_diameter)
        fitting = f"elements that fit on a circle of {millimetres(self.pitch_diameter)}"
        full = self.elements * self.element_diameter > math.pi * self.pitch_diameter
        rollers = self.kind in ("roller", "tapered")
        known, published = inner_geometry(self.designation or "")
        said = designated(self.designation or "")
        others = []
        for key, value in known.items():
            given = getattr(self, key)
            same = given == value or (isinstance(given, float) and math.isclose(given, value))
            # What is published stands against what is given; an estimate gives way.
            if (key == "kind" or (published and key != "contact_angle")) and not same:
                got = f"{given} beside designation = '{self.designation}'"
                wanted = f"{value if key == 'kind' else f'{value:.6g}'} as {self.designation} has it, or no designation"
                others.append((key, True, got, wanted))
        if (
            said
            and not said.bore
            < self.pitch_diameter - self.element_diameter
            < self.pitch_diameter + self.element_diameter
            < said.outer
        ):
            got = f"elements of {size} on {millimetres(self.pitch_diameter)} beside designation = '{self.designation}'"
            others.append(
                ("", True, got, f"between its bore {millimetres(said.bore)} and outside {millimetres(said.outer)}")
            )
        angle = f"{math.degrees(self.contact_angle):.6g} deg"
        no_length = "a roller without length" if rollers else "a length of balls"
        reach = 2.0 * (self.inner_groove + self.outer_groove - 1.0) * self.element_diameter
        loose = not rollers and reach > 0.0 and self.clearance >= reach * math.cos(self.contact_angle)
        inside = f"less than {millimetres(reach)}: the balls would fall out"
        grooves = {key: getattr(self, key) for key in ("inner_groove", "outer_groove")}
        wider = "more than 0.5: a groove is wider than its ball"
        yield from told(
            here,
            ("", crossed, "rolling elements beside a table or cross terms", diagonal),
            ("elements", self.elements < 3, str(self.elements), "at least 3"),
            ("element_diameter", full, f"{self.elements} of {size}", fitting),
            *others,
            ("length", rollers != (self.length is not None), no_length, "a length for rollers, none for balls"),
            ("contact_angle", self.kind == "roller" and self.contact_angle, "an angle", "0 for cylindrical rollers"),
            *self._rows(angle, rollers),
            *self._fit(),
            *((key, value <= 0.5, f"{value:g}", wider) for key, value in grooves.items()),
            ("contact_angle", not abs(self.contact_angle) < 1.4, angle, "an angle below 80 deg"),
            ("clearance", loose, millimetres(self.clearance), inside),
        )

    def _rows(self, angle: str, rollers: bool) -> Iterator[tuple[Any, ...]]:
        """Rows with the contact angle that makes them press, and slices of rollers."""
        pressing = f"an angle of a {self.kind} bearing, such as '15 deg' or '35 deg'"
        yield "contact_angle", self.kind in ("tapered", "four-point") and not self.contact_angle, "0", pressing
        pair = self.arrangement != "single"
        straight = pair and (self.kind not in ("ball", "tapered") or not self.contact_angle)
        got = f"{self.arrangement} of a {self.kind} bearing without an angle"
        wanted = "a pair of angular contact ball or tapered roller bearings, with their contact_angle"
        yield "arrangement", straight, got, wanted
        two_sided = (pair or self.kind == "four-point") and self.contact_angle < 0.0
        yield "contact_angle", two_sided, angle, "a positive angle: the arrangement has the sides"
        got = "a pair without a distance" if pair else "a distance of one row"
        wanted = "the distance of the two rows beside an arrangement O, X or tandem"
        yield "row_distance", pair != (self.row_distance is not None), got, wanted
        sliced = self.slices is not None and not (rollers and 1 <= self.slices <= 200)
        yield "slices", sliced, f"{self.slices} of a {self.kind} bearing", "1 to 200 slices of a roller"

    def _fit(self) -> Iterator[tuple[Any, ...]]:
        """A clearance class with its bore, and a preload of a bearing that can take one."""
        bore = "no bore" if self.bore is None else millimetres(self.bore)
        if self.clearance_class is not None:
            alone = "the class of a deep groove ball bearing alone, or a clearance"
            beside = self.kind != "ball" or self.contact_angle or self.clearance
            yield "clearance_class", beside, self.clearance_class, alone
            unknown = self.bore is None or class_clearance(self.bore, self.clearance_class) is None
            yield "bore", unknown, bore, "a bore above 10 to 120 mm, which the table of classes has"
        else:
            lone = self.bore is not None and self.designation is None
            yield "bore", lone, bore, "a clearance_class beside it, which it is for"
        pressed = (self.preload_displacement or self.preload_force) and not self.contact_angle
        printed = bore_of(self.designation)
        differs = None not in (self.bore, printed) and not math.isclose(self.bore or 0.0, printed or 0.0)
        as_printed = f"{millimetres(printed or 0.0)} as {self.designation} has it, or no designation"
        yield "bore", differs, f"{bore} beside designation = '{self.designation}'", as_printed
        yield "", pressed, "a preload without a contact angle", "a contact_angle, at which it presses"
        both = self.preload_displacement and self.preload_force
        yield "", both, "preload_displacement and preload_force", "one of the two"

    def judged(self) -> Iterator[Judged]:
        """Clearance, preload, number and length of rolling elements against their diameter."""
        size = self.element_diameter
        for key, most in (("clearance", 0.05), ("preload_displacement", 0.02)):
            value = getattr(self, key)
            got = f"{value:.4g} m"
            yield key, value / size, (0.0, most), got, "up to {1:g} of the diameter of an element", "um meant?"
        # Share of its circle that the elements of a row fill.
        filled = self.elements * size / (math.pi * self.pitch_diameter)
        got = f"{size:.4g} m, of which {self.elements} fill {filled:.2g} of their circle"
        yield "element_diameter", filled, (0.15, 1.0), got, "0.15 to 1 of it", UNIT
        # Some five times the static capacity.
        pressure = self.preload_force / (self.elements * size**2)
        got = f"{self.preload_force:.4g} N, {1e-6 * pressure:.3g} MPa on the squares of the diameters"
        yield "preload_force", pressure, (0.0, 3e8), got, "up to 300 MPa", UNIT
        if self.length is not None:
            got = f"{self.length:.4g} m, {self.length / size:.3g} diameters"
            yield "length", self.length / size, (0.2, 30.0), got, "{:g} to {:g}", (UNIT, "mm meant?")
