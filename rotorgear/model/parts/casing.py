"""Elastic casings that bearings stand on, from finite-element meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, GetJsonSchemaHandler, WithJsonSchema, create_model, model_validator
from pydantic_core import CoreSchema

from rotorgear.model.parts import fields as si
from rotorgear.model.parts.fields import Name, Part, listed, parse_direction, refuse
from rotorgear.model.parts.supports import DampingMatrix, StiffnessMatrix

# Lengths of the units that meshes are drawn in, in m.
UNIT_LENGTHS = {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001, "um": 1e-6, "in": 0.0254, "ft": 0.3048}
# The name of the only mesh of a casing that has no more.
ONLY_MESH = "mesh"


_CENTER = (
    "the two coordinates across an axis x, y or z, in the order x y z, such as ['-55 mm', '130 mm'], or all three of a point on "
    "an axis of any direction"
)
_CORNER = "a corner x y z such as ['-60 mm', '-90 mm', '-40 mm']"
_EXTENTS = "three lengths along x, y and z such as ['40 mm', '15 mm', '30 mm']"
_POINT = "the point x y z of the seat such as ['-55 mm', '130 mm', '20 mm']"


def _parse_axis(value: Any) -> Any:
    if isinstance(value, list | tuple):
        return parse_direction(value)
    if value not in ("x", "y", "z"):
        raise refuse("'x', 'y' or 'z', or a direction such as [0, 0.6, 0.8]")
    return value


def _parse_center(value: Any) -> Any:
    if not isinstance(value, list | tuple) or len(value) not in (2, 3):
        raise refuse(_CENTER)
    return value


_NUMBERS = {"type": "array", "minItems": 3, "maxItems": 3, "items": {"type": "number"}}
SeatAxis = Annotated[
    Literal["x", "y", "z"] | tuple[float, float, float],
    BeforeValidator(_parse_axis),
    WithJsonSchema({"anyOf": [{"enum": ["x", "y", "z"], "type": "string"}, _NUMBERS]}),
]
SeatCenter = Annotated[
    tuple[si.Length, ...],
    BeforeValidator(_parse_center),
    WithJsonSchema({"type": "array", "minItems": 2, "maxItems": 3, "items": si.Unit("length").schema()}),
]


class _Seat(Part):
    """A bearing seat: a face or node set of the mesh, or the cylinder that a bearing sits in."""

    set: str | None = Field(None, description="name of a face or node set; a text in place of the table says it alone")
    axis: SeatAxis | None = Field(
        None,
        description="without a set: direction of the axis of the bore, x, y or z, or a vector such as [0, 0.6, 0.8]",
    )
    center: SeatCenter | None = Field(
        None,
        description="where the axis is: the coordinates across it, in the order x y z; of a vector all three of a point on it, "
        "from which `from` and `to` count",
    )
    radius: si.PositiveLength | None = Field(None, description="radius of the bore")
    to: si.Length | None = Field(None, description="where the seat ends along the axis")

    @model_validator(mode="before")
    @classmethod
    def _a_text_is_a_set(cls, data: Any) -> Any:
        return {"set": data} if isinstance(data, str) else data

    @model_validator(mode="after")
    def _center_of_axis(self) -> Self:
        if self.axis is not None and self.center is not None:
            wanted = 2 if isinstance(self.axis, str) else 3
            if len(self.center) != wanted:
                raise refuse(f"a center of {wanted} coordinates beside this axis; it has {len(self.center)}")
        return self

    @property
    def begin(self) -> float | None:
        """Where the seat begins along the axis: its key `from` is a word of Python."""
        begin: float | None = getattr(self, "from")
        return begin


if TYPE_CHECKING:
    Seat = _Seat
else:
    Seat = create_model(
        "Seat",
        __base__=_Seat,
        __doc__=_Seat.__doc__,
        __module__=__name__,
        **{"from": (si.Length | None, Field(None, description="where the seat begins along the axis"))},
    )


class TextOrTable:
    """Marks a seat in the JSON Schema: the name of a set, or the table."""

    def __get_pydantic_json_schema__(self, _: CoreSchema, __: GetJsonSchemaHandler) -> dict[str, Any]:
        table = {key: value for key, value in Seat.model_json_schema().items() if key != "$defs"}
        return {"anyOf": [{"type": "string"}, table]}


Files = Annotated[
    dict[Name, str],
    BeforeValidator(lambda value: {ONLY_MESH: value} if isinstance(value, str) else value),
    WithJsonSchema({"anyOf": [{"type": "string"}, {"type": "object", "additionalProperties": {"type": "string"}}]}),
]


class Mount(StiffnessMatrix):
    """Springs, and dampers, between the mean motion of a face and the ground."""

    damping: DampingMatrix | None = Field(None, description="damping to the ground")


class Join(Part):
    """Two faces that touch, such as the flanges of bolted halves."""

    faces: tuple[str, str] = Field(description="names of the two face sets")
    stiffness: si.StiffnessPerArea | None = Field(
        None, description="stiffness of the joint per area, the same along and across it; default: tied"
    )


class Bore(Part):
    """The outer ring of a bearing in a box."""

    diameter: si.PositiveLength = Field(description="outer diameter of the bearing")
    width: si.PositiveLength = Field(description="width of the bearing")


class Ribs(Part):
    """Ribs around the outside of a box, in planes across x, y or z."""

    x: tuple[si.Length, ...] = Field((), description="x of the middle of each rib that runs around in a plane across x")
    y: tuple[si.Length, ...] = Field((), description="the same across y")
    z: tuple[si.Length, ...] = Field((), description="the same across z")
    thickness: si.PositiveLength = Field(description="thickness of each")
    height: si.PositiveLength = Field(description="how far they stand out of the walls")


class Feet(Part):
    """Four feet at the corners of a face of a box; their soles are the set `feet`."""

    side: Literal["-y", "+y", "-x", "+x"] = Field("-y", description="face of the box that they stand on")
    size: Annotated[tuple[si.PositiveLength, si.PositiveLength, si.PositiveLength], listed(3, _EXTENTS)] = Field(
        description="extents of each foot along x, y and z"
    )


class Box(Part):
    """A casing in numbers, meshed by rotorgear: a box with its edges along x, y and z, and a bored block for each bearing."""

    corners: Annotated[
        tuple[
            Annotated[tuple[si.Length, si.Length, si.Length], listed(3, _CORNER)],
            Annotated[tuple[si.Length, si.Length, si.Length], listed(3, _CORNER)],
        ],
        listed(2, "two opposite corners of the inner space"),
    ] = Field(description="two opposite corners x y z of the inner space")
    wall: si.PositiveLength = Field(description="thickness of the walls")
    walls: tuple[si.Length, ...] = Field((), description="z of the middle of each inner wall across the shafts")
    boss: si.PositiveLength | None = Field(
        None, description="least thickness of the block around the bore of a bearing; default: that of the walls"
    )
    bores: dict[Name, Bore] = Field(
        default_factory=dict,
        description="diameter and width of the outer ring by the name of the bearing; default: those of its designation",
    )
    ribs: Ribs | None = Field(None, description="ribs on the outside")
    feet: Feet | None = Field(None, description="feet; without them hold a face: '-x', '+x', '-y', '+y', '-z' or '+z'")
    element: si.PositiveLength | None = Field(
        None,
        description="largest size of an element; default: a tenth of the longest edge, four times the wall at least",
    )

    @property
    def largest_element(self) -> float:
        """Largest size of an element in m: given, or the default."""
        longest = max(abs(b - a) for a, b in zip(*self.corners, strict=True)) + 2.0 * self.wall
        return self.element or max(0.1 * longest, 4.0 * self.wall)


class Casing(Part):
    """An elastic body from a finite-element mesh, reduced to the motions of its bearing seats and a few modes of its own."""

    mesh: Files = Field(
        default_factory=dict,
        description="file of the mesh, beside the model file; or several by name: `{ lower = ..., upper = ... }`",
    )
    box: Box | None = Field(None, description="walls, ribs and feet in numbers, in place of a mesh")
    matrices: str | None = Field(
        None, description="file of a body that was reduced elsewhere (.npz with stiffness and mass), in place of a mesh"
    )
    interface: dict[Name, Annotated[tuple[si.Length, si.Length, si.Length], listed(3, _POINT)]] = Field(
        default_factory=dict,
        description="seats in `matrices` with their points x y z, in the order of their motions; default: as the file says",
    )
    unit: Literal["m", "dm", "cm", "mm", "um", "in", "ft"] | None = Field(
        None, description="unit of length of the mesh: such files carry none"
    )
    material: str | None = Field(None, description="name of a material; or E, nu and density below")
    youngs_modulus: si.Modulus | None = Field(None, description="Young's modulus E, in place of a material")
    poisson_ratio: si.Ratio | None = Field(None, description="Poisson's ratio nu, in place of a material")
    density: si.Density | None = Field(None, description="density, in place of a material")
    held: tuple[str, ...] = Field((), description="face or node sets that are held fixed")
    mounts: dict[str, Mount] = Field(default_factory=dict, description="face or node sets on springs to the ground")
    seats: dict[Name, Annotated[Seat, TextOrTable()]] = Field(
        default_factory=dict,
        description="where bearings sit, by the name of the bearing: a face or node set, or a place",
    )
    connection: Literal["mean", "rigid"] = Field(
        "mean",
        description="how a seat takes the motion of its bearing: as its mean, free to deform (RBE3), or as a rigid body (RBE2)",
    )
    joins: tuple[Join, ...] = Field((), description="faces that hold parts of the mesh together")
    splits: Annotated[int, Field(ge=0, le=4, strict=True)] = Field(
        0, description="how often every element is split in eight: the same body in a finer mesh"
    )
    modes_to: si.Frequency | None = Field(
        None,
        description="highest frequency of the fixed-interface modes that are kept; default: the lowest 20, more where an "
        "analysis asks beyond half of their frequencies",
    )
    damping_ratio: si.Ratio = Field(0.0, description="damping ratio of every elastic mode of the casing by itself")
    mass: si.PositiveMass | None = Field(None, description="mass, if it is known: the mesh is checked against it")
    mass_tolerance: si.PositiveRatio = Field(0.05, description="how far the mesh's mass may be off that mass")
