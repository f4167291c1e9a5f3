"""What holds the shafts: bearings on pedestals, supports to ground, and couplings between shaft ends."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import ConfigDict, Field, model_validator

from rotorgear.forces.designations import SERIES, inner_geometry
from rotorgear.model.parts.fields import (
    Angle,
    Damping,
    Density,
    Force,
    Mass,
    Matrix6,
    NonNegativeLength,
    Part,
    PositiveLength,
    PositiveRatio,
    Ratio,
    RotationalDamping,
    RotationalStiffness,
    SignedDamping,
    SignedStiffness,
    SpecificHeat,
    Speed,
    Station,
    Stiffness,
    Temperature,
    Viscosity,
    Whole,
    refuse,
)

Rows = tuple[tuple[float, ...], ...]
FixedDof = Literal["x", "y", "z", "tilt_x", "tilt_y", "torsion", "all"]


class _SixBySix(Part):
    """What stiffness and damping share: a diagonal shorthand, cross terms in the plane, or the full matrix."""

    @property
    def given(self) -> frozenset[str]:
        """Names of the entries that have a value."""
        return frozenset(name for name in type(self).model_fields if getattr(self, name) is not None)

    def as_rows(self) -> Rows:
        """The 6 x 6 matrix as rows, in the order x y z tilt_x tilt_y torsion."""
        values = {name: getattr(self, name) or 0.0 for name in type(self).model_fields if name != "matrix"}
        matrix = getattr(self, "matrix", None)
        if matrix is not None:
            return matrix
        diagonal = [
            values["x"] or values["radial"],
            values["y"] or values["radial"],
            values["axial"],
            values["tilt_x"] or values["tilt"],
            values["tilt_y"] or values["tilt"],
            values["torsion"],
        ]
        rows = [[diagonal[i] if i == j else 0.0 for j in range(6)] for i in range(6)]
        rows[0][1] = values["xy"]
        rows[1][0] = values["yx"]
        return tuple(tuple(row) for row in rows)


class StiffnessMatrix(_SixBySix):
    """Stiffness of a bearing, support or coupling."""

    radial: Stiffness | None = Field(None, description="along x and y")
    x: Stiffness | None = Field(None, description="along x")
    y: Stiffness | None = Field(None, description="along y")
    axial: Stiffness | None = Field(None, description="along z")
    xy: SignedStiffness | None = Field(None, description="cross term: force along x from a displacement along y")
    yx: SignedStiffness | None = Field(None, description="cross term: force along y from a displacement along x")
    tilt: RotationalStiffness | None = Field(None, description="about x and y")
    tilt_x: RotationalStiffness | None = Field(None, description="about x")
    tilt_y: RotationalStiffness | None = Field(None, description="about y")
    torsion: RotationalStiffness | None = Field(None, description="about z")
    matrix: Matrix6 | None = Field(None, description="the full 6 x 6, in place of all the others")


class DampingMatrix(_SixBySix):
    """Viscous damping of a bearing, support or coupling."""

    radial: Damping | None = Field(None, description="along x and y")
    x: Damping | None = Field(None, description="along x")
    y: Damping | None = Field(None, description="along y")
    axial: Damping | None = Field(None, description="along z")
    xy: SignedDamping | None = Field(None, description="cross term: force along x from a velocity along y")
    yx: SignedDamping | None = Field(None, description="cross term: force along y from a velocity along x")
    tilt: RotationalDamping | None = Field(None, description="about x and y")
    tilt_x: RotationalDamping | None = Field(None, description="about x")
    tilt_y: RotationalDamping | None = Field(None, description="about y")
    torsion: RotationalDamping | None = Field(None, description="about z")
    matrix: Matrix6 | None = Field(None, description="the full 6 x 6, in place of all the others")


class TableRow(Part):
    """A bearing's matrices at one speed of its shaft."""

    speed: Speed = Field(description="speed of the bearing's own shaft, without sign")
    stiffness: StiffnessMatrix = Field(description="stiffness at that speed")
    damping: DampingMatrix | None = Field(None, description="damping at that speed; default: none")


class Pedestal(Part):
    """A flexible pedestal with mass in series with a bearing. A direction without stiffness is rigid."""

    mass: Mass = Field(0.0, description="mass that moves with the bearing's housing")
    stiffness: StiffnessMatrix = Field(description="stiffness to ground along x, y and z")
    damping: DampingMatrix | None = Field(None, description="damping to ground along x, y and z")


class RollingElements(Part):
    """What rolls in a bearing: its Hertz contacts, clearance and turning cage; by its geometry, or by a designation."""

    # With a designation the four keys that are needed otherwise may be left out.
    model_config = ConfigDict(json_schema_extra=lambda schema: schema.update(required=[]))

    designation: str | None = Field(
        None,
        description="such as 6205, 7218 B, QJ 212, NJ209 or 30209: fills kind, elements, diameters, length and contact angle "
        "where they are not given; estimated from the outside where nothing is published",
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
        description="class of ISO 5753-1 of a deep groove ball bearing, in place of the clearance: the middle of its range, "
        "before fits and temperature take from it",
    )
    bore: PositiveLength | None = Field(None, description="bore of the inner ring, above 10 to 120 mm, for the class")
    preload_displacement: NonNegativeLength = Field(
        0.0,
        description="how far an angular contact bearing is pressed together along its contact angle at assembly",
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
        known = inner_geometry(data["designation"])
        if known is None:
            raise refuse(f"a designation of the series {SERIES}; or leave it out and give kind, elements and diameters")
        given = {key: value for key, value in data.items() if value is not None}
        return {**known.keys, **given}


class Oil(Part):
    """The oil of a film: its viscosity, or its grade and the temperature at which it flows in."""

    viscosity: Viscosity | None = Field(
        None, description="dynamic viscosity of the oil in the film, whatever its temperature; or give the oil"
    )
    oil: (
        Literal[
            "VG 10",
            "VG 15",
            "VG 22",
            "VG 32",
            "VG 46",
            "VG 68",
            "VG 100",
            "VG 150",
            "VG 220",
            "VG 320",
            "VG 460",
            "VG 680",
            "VG 1000",
        ]
        | None
    ) = Field(
        None,
        description="grade of ISO 3448 of a mineral oil, in place of the viscosity: the film has that of its temperature in heat "
        "balance",
    )
    inlet_temperature: Temperature | None = Field(None, description="temperature at which the oil flows in")
    heat_share: Ratio = Field(
        1.0,
        description="share of the power loss of the film that the oil carries away; 1: all of it, 0: the film stays at the "
        "inlet temperature",
    )
    specific_heat: SpecificHeat = Field(1900.0, description="specific heat of the oil")
    density: Density = Field(
        870.0, description="density of the oil, for the limit of laminar flow and the heat balance"
    )

    @property
    def heats(self) -> bool:
        """Whether the viscosity follows from the heat balance of the film."""
        return self.oil is not None and self.heat_share > 0.0

    @property
    def follows(self) -> bool:
        """Whether the oil flows in where the gap is widest."""
        return False

    @property
    def settles(self) -> bool:
        """Whether something of the film follows from the equilibrium that it is in."""
        return self.heats or self.follows

    @property
    def grade(self) -> float:
        """Kinematic viscosity at 40 deg C in m^2/s; 0 where the viscosity is given."""
        return 1e-6 * float(self.oil.removeprefix("VG ")) if self.oil else 0.0


class JournalGeometry(Oil):
    """A journal bearing with its oil film: plain, with lobes, or of tilting pads."""

    diameter: PositiveLength = Field(description="diameter of the journal")
    length: PositiveLength = Field(description="length of the bearing, up to two diameters")
    clearance: PositiveLength = Field(
        description="radial clearance; of lobes where the gap of the centred journal is least"
    )
    cavitation: Literal["reynolds", "half_sommerfeld"] = Field(
        "reynolds",
        description="how the film cavitates; reynolds: pressure and its slope vanish together; half_sommerfeld: negative "
        "pressures of the full film are cut",
    )
    inlet: Angle | None = Field(
        None,
        description="angle of the oil inlet of a plain bearing, from +x about +z; default: where the gap is widest in the "
        "static equilibrium at the speed",
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


class ThrustGeometry(Oil):
    """A thrust bearing in oil: sector pads, fixed with a taper and a land, or tilting about a radius."""

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


class Bearing(Part):
    """A bearing between a shaft and the ground, a pedestal or a casing: a stiffness, or a law by its geometry."""

    shaft: str = Field(description="name of the shaft")
    at: Station = Field(description="z of the bearing, or 'start' or 'end'")
    stiffness: StiffnessMatrix | None = Field(None, description="stiffness; or give a table")
    damping: DampingMatrix | None = Field(None, description="damping; default: none")
    table: tuple[TableRow, ...] = Field(
        (), description="rows over speed, linear in between, in place of stiffness and damping"
    )
    rolling: RollingElements | None = Field(
        None, description="rolling elements, which take the place of the stiffness in a transient"
    )
    journal: JournalGeometry | None = Field(
        None, description="journal bearing by its geometry, in place of stiffness, damping and rolling elements"
    )
    thrust: ThrustGeometry | None = Field(
        None, description="thrust bearing by its geometry, in place of stiffness, damping and rolling elements"
    )
    pedestal: Pedestal | None = Field(None, description="flexible pedestal; default: rigid ground")
    casing: str | None = Field(
        None, description="name of the casing that the bearing stands on: its seat has the bearing's name"
    )

    @property
    def has_law(self) -> bool:
        """Whether its geometry gives a force law."""
        return self.rolling is not None or self.has_film

    @property
    def has_film(self) -> bool:
        """Whether oil carries in it, which it does only while its shaft turns."""
        return self.film is not None

    @property
    def film(self) -> JournalGeometry | ThrustGeometry | None:
        """Its journal or thrust bearing in oil; None without."""
        return self.journal or self.thrust

    @property
    def is_linear(self) -> bool:
        """Whether it has a stiffness that linear analyses take."""
        return not self.has_law or self.stiffness is not None


class Support(Part):
    """A support to ground: springs, dampers, and motions that are held fixed."""

    shaft: str = Field(description="name of the shaft")
    at: Station = Field(description="z of the support, or 'start' or 'end'")
    stiffness: StiffnessMatrix | None = Field(None, description="stiffness to ground")
    damping: DampingMatrix | None = Field(None, description="damping to ground")
    fixed: tuple[FixedDof, ...] = Field((), description="motions held fixed: x y z tilt_x tilt_y torsion, or all")


class Coupling(Part):
    """A flexible coupling between two coaxial points: shaft ends, gear halves, or an inner and an outer shaft."""

    from_shaft: str = Field(description="name of the first shaft")
    from_at: Station = Field("end", description="z on the first shaft; default: its end")
    to_shaft: str = Field(description="name of the second shaft")
    to_at: Station = Field("start", description="z on the second shaft; default: its start")
    stiffness: StiffnessMatrix = Field(description="stiffness; with a torsional one, both shafts turn at one speed")
    damping: DampingMatrix | None = Field(None, description="damping; default: none")

    @property
    def turns_both(self) -> bool:
        """Whether its torsional stiffness makes both shafts turn at one speed."""
        return self.stiffness.as_rows()[5][5] > 0.0
