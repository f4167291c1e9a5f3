"""What holds the shafts: bearings on pedestals, supports to ground, couplings between shaft ends, and other force laws."""

from __future__ import annotations

import math
from dataclasses import fields
from itertools import takewhile
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from rotorgear.model.parts import fields as si
from rotorgear.model.parts.bearings.geometry import BearingGeometry, Oil
from rotorgear.model.parts.bearings.journal import JournalGeometry
from rotorgear.model.parts.bearings.rolling import RollingElements
from rotorgear.model.parts.bearings.thrust import ThrustGeometry
from rotorgear.model.parts.fields import RIGID, Flag, Part, Station
from rotorgear.model.parts.problems import class_at
from rotorgear.quantity import QuantityError, parse_in_unit

if TYPE_CHECKING:
    from rotorgear.forces.law import ForceLaw, Parameter

Rows = tuple[tuple[float, ...], ...]
# Keys that say what stands on the diagonal of a 6 x 6, in its order.
_DIAGONAL = (("x", "radial"), ("y", "radial"), ("axial",), ("tilt_x", "tilt"), ("tilt_y", "tilt"), ("torsion",))
_TORSION = 5
FixedDof = Literal["x", "y", "z", "tilt_x", "tilt_y", "torsion", "all"]


class _SixBySix(Part):
    """What stiffness and damping share: a diagonal shorthand, cross terms in the plane, or the full matrix."""

    @property
    def given(self) -> frozenset[str]:
        """Names of the entries that have a value."""
        return frozenset(name for name in type(self).model_fields if getattr(self, name) is not None)

    def as_rows(self) -> Rows:
        """The 6 x 6 matrix as rows, in the order x y z tilt_x tilt_y torsion; 0 in directions that are rigid."""
        values = {name: getattr(self, name) or 0.0 for name in type(self).model_fields if name != "matrix"}
        matrix = getattr(self, "matrix", None)
        if matrix is not None:
            return matrix
        given = [next((values[key] for key in keys if values[key]), 0.0) for keys in _DIAGONAL]
        diagonal = [0.0 if value == RIGID else value for value in given]
        rows = [[diagonal[i] if i == j else 0.0 for j in range(6)] for i in range(6)]
        rows[0][1] = values["xy"]
        rows[1][0] = values["yx"]
        return tuple(tuple(row) for row in rows)


class StiffnessMatrix(_SixBySix):
    """Stiffness of a bearing, support or coupling."""

    radial: si.StiffnessOrRigid | None = Field(None, description="along x and y")
    x: si.StiffnessOrRigid | None = Field(None, description="along x")
    y: si.StiffnessOrRigid | None = Field(None, description="along y")
    axial: si.StiffnessOrRigid | None = Field(None, description="along z")
    xy: si.SignedStiffness | None = Field(None, description="cross term: force along x from a displacement along y")
    yx: si.SignedStiffness | None = Field(None, description="cross term: force along y from a displacement along x")
    tilt: si.RotationalStiffnessOrRigid | None = Field(None, description="about x and y")
    tilt_x: si.RotationalStiffnessOrRigid | None = Field(None, description="about x")
    tilt_y: si.RotationalStiffnessOrRigid | None = Field(None, description="about y")
    torsion: si.RotationalStiffnessOrRigid | None = Field(None, description="about z")
    matrix: si.Matrix6 | None = Field(None, description="the full 6 x 6, in place of all the others")

    @property
    def rigid(self) -> tuple[int, ...]:
        """Numbers of the directions that do not give, in the order x y z tilt_x tilt_y torsion."""
        return tuple(k for k, keys in enumerate(_DIAGONAL) if any(getattr(self, key) == RIGID for key in keys))


class DampingMatrix(_SixBySix):
    """Viscous damping of a bearing, support or coupling."""

    radial: si.Damping | None = Field(None, description="along x and y")
    x: si.Damping | None = Field(None, description="along x")
    y: si.Damping | None = Field(None, description="along y")
    axial: si.Damping | None = Field(None, description="along z")
    xy: si.SignedDamping | None = Field(None, description="cross term: force along x from a velocity along y")
    yx: si.SignedDamping | None = Field(None, description="cross term: force along y from a velocity along x")
    tilt: si.RotationalDamping | None = Field(None, description="about x and y")
    tilt_x: si.RotationalDamping | None = Field(None, description="about x")
    tilt_y: si.RotationalDamping | None = Field(None, description="about y")
    torsion: si.RotationalDamping | None = Field(None, description="about z")
    matrix: si.Matrix6 | None = Field(None, description="the full 6 x 6, in place of all the others")


def _radial(value: Any) -> Any:
    """One number for the stiffness or damping of a bearing is the radial one, as on a drawing."""
    return {"radial": value} if isinstance(value, int | float | str) and not isinstance(value, bool) else value


def _or_one_number(schema: dict[str, Any]) -> None:
    """Editors are told of the number, too."""
    schema["anyOf"] = [{"type": "number"}, {"type": "string"}, *schema["anyOf"]]


def _all_rigid(value: Any) -> Any:
    """A coupling without any give is rigid in all directions."""
    return dict.fromkeys(("radial", "axial", "tilt", "torsion"), RIGID) if value == RIGID else value


def _or_rigid(schema: dict[str, Any]) -> None:
    """Editors are told of the word, too."""
    schema["anyOf"] = [{"type": "string", "enum": [RIGID]}, *schema["anyOf"]]


class TableRow(Part):
    """A bearing's matrices at one speed of its shaft."""

    speed: si.Speed = Field(description="speed of the bearing's own shaft, without sign")
    stiffness: StiffnessMatrix = Field(description="stiffness at that speed")
    damping: DampingMatrix | None = Field(None, description="damping at that speed")


class Pedestal(Part):
    """A flexible pedestal with mass in series with a bearing. A direction without stiffness is rigid."""

    mass: si.Mass = Field(0.0, description="mass that moves with the bearing's housing")
    stiffness: StiffnessMatrix = Field(description="stiffness to ground along x, y and z")
    damping: DampingMatrix | None = Field(None, description="damping to ground along x, y and z")


class Bearing(Part):
    """A bearing between a shaft and the ground, a pedestal or a casing: a stiffness, or a law by its geometry."""

    shaft: str = Field(description="name of the shaft")
    at: Station = Field(description="z of the bearing")
    stiffness: Annotated[StiffnessMatrix | None, BeforeValidator(_radial)] = Field(
        None, description="stiffness; one number is the radial one; or give a table", json_schema_extra=_or_one_number
    )
    damping: Annotated[DampingMatrix | None, BeforeValidator(_radial)] = Field(
        None, description="damping; one number is the radial one", json_schema_extra=_or_one_number
    )
    table: tuple[TableRow, ...] = Field(
        (), description="rows over speed, linear in between, in place of stiffness and damping"
    )
    rolling: RollingElements | None = Field(None, description="rolling elements, by their contacts")
    journal: JournalGeometry | None = Field(None, description="journal bearing by its geometry, in place of all these")
    thrust: ThrustGeometry | None = Field(None, description="thrust bearing by its geometry, likewise")
    pedestal: Pedestal | None = Field(None, description="flexible pedestal; default: rigid ground")
    casing: str | None = Field(
        None, description="name of the casing that the bearing stands on: its seat has the bearing's name"
    )

    @classmethod
    def kinds(cls) -> dict[str, type[BearingGeometry]]:
        """The kinds that are given by their geometry, by their keys: its fields of such a class."""
        found = {key: class_at((key,), cls) for key in cls.model_fields}
        return {key: kind for key, kind in found.items() if kind is not None and issubclass(kind, BearingGeometry)}

    @property
    def geometries(self) -> dict[str, BearingGeometry]:
        """Its geometry by the key of its kind; a sound bearing has one, or none and a stiffness."""
        return {key: part for key in type(self).model_fields if isinstance(part := getattr(self, key), BearingGeometry)}

    @property
    def geometry(self) -> BearingGeometry | None:
        """Its geometry, whatever its kind; None of one that is a stiffness alone."""
        return next(iter(self.geometries.values()), None)

    def beside(self, kind: str) -> dict[str, Any]:
        """What else it is given by than one kind, by the keys: stiffness, damping, the kinds before that one, and a table."""
        keys = ("stiffness", "damping", *takewhile(kind.__ne__, self.kinds()), "table")
        return {key: getattr(self, key) for key in keys if getattr(self, key)}

    @property
    def has_law(self) -> bool:
        """Whether its geometry gives a force law."""
        return self.geometry is not None

    def law(self, ratio: float, sense: float) -> ForceLaw:
        """The force law of a bearing that is given by its geometry.

        Args:
            ratio: turns of its shaft for each turn of the reference.
            sense: of rotation of the reference for which it is built, 1 or -1.
        """
        assert self.geometry is not None
        linear = [row[i] for i, row in enumerate(self.stiffness.as_rows())] if self.stiffness else [0.0] * 6
        return self.geometry.law(ratio, sense, linear)

    @property
    def has_film(self) -> bool:
        """Whether oil carries in it, which it does only while its shaft turns."""
        return self.film is not None

    @property
    def film(self) -> Oil | None:
        """Its geometry where oil carries in it; None where none does."""
        return self.geometry if isinstance(self.geometry, Oil) else None

    @property
    def rigid_directions(self) -> tuple[int, ...]:
        """Numbers of the directions in which the shaft and what it stands on move as one."""
        return () if self.stiffness is None else self.stiffness.rigid

    @property
    def is_linear(self) -> bool:
        """Whether it has a stiffness that linear analyses take."""
        return not self.has_law or self.stiffness is not None


class Support(Part):
    """A support to ground: springs, dampers, and motions that are held fixed."""

    shaft: str = Field(description="name of the shaft")
    at: Station = Field(description="z of the support")
    stiffness: StiffnessMatrix | None = Field(None, description="stiffness to ground")
    damping: DampingMatrix | None = Field(None, description="damping to ground")
    fixed: tuple[FixedDof, ...] = Field((), description="motions held fixed: x y z tilt_x tilt_y torsion, or all")


class Coupling(Part):
    """A coupling between two coaxial points: shaft ends, gear halves, or an inner and an outer shaft."""

    from_shaft: str = Field(description="name of the first shaft")
    from_at: Station = Field("end", description="z on the first shaft; default: its end")
    to_shaft: str = Field(description="name of the second shaft")
    to_at: Station = Field("start", description="z on the second shaft; default: its start")
    stiffness: Annotated[StiffnessMatrix | None, BeforeValidator(_all_rigid)] = Field(
        None,
        description="stiffness; with a torsional one, both shafts turn at one speed; or rigid, in all directions",
        json_schema_extra=_or_rigid,
    )
    damping: DampingMatrix | None = Field(None, description="damping")
    rigid: Flag = Field(False, description="true: both ends move as one body, in place of a stiffness")

    @property
    def rigid_directions(self) -> tuple[int, ...]:
        """Numbers of the directions in which both ends move as one."""
        if self.rigid:
            return tuple(range(6))
        return () if self.stiffness is None else self.stiffness.rigid

    @property
    def torsional_stiffness(self) -> float:
        """Of a rigid one infinite, in N m/rad."""
        if _TORSION in self.rigid_directions:
            return math.inf
        return 0.0 if self.stiffness is None else self.stiffness.as_rows()[5][5]

    @property
    def turns_both(self) -> bool:
        """Whether its torsional stiffness makes both shafts turn at one speed."""
        return self.torsional_stiffness > 0.0


ElementDof = Literal["x", "y", "z", "tilt_x", "tilt_y", "torsion"]


def _known_laws(schema: dict[str, Any]) -> None:
    """Editors, the page and the reference list the laws of the package; other names are those of laws of one's own."""
    from rotorgear.forces.registry import shipped  # laws are loaded for models that name one only

    schema["anyOf"] = [{"type": schema.pop("type"), "enum": list(shipped())}, {"type": "string"}]


class NonlinearElement(Part):
    """A force law on a shaft, against the ground or against another shaft."""

    law: str = Field(
        description="name of the force law, of the package or registered from Python", json_schema_extra=_known_laws
    )
    shaft: str = Field(description="name of the shaft")
    at: Station = Field(description="z of the element")
    to_shaft: str | None = Field(None, description="name of a second shaft; default: the ground")
    to_at: Station | None = Field(None, description="z on the second shaft; default: that on the first")
    casing: str | None = Field(None, description="name of a casing that it stands in, in place of the ground")
    directions: tuple[ElementDof, ...] = Field(
        ("x", "y"), min_length=1, description="displacements of the shaft that the law acts on, in its order"
    )
    parameters: dict[str, Any] = Field(
        default_factory=dict,
        description="parameters of the law: numbers in SI or texts with units, as it declares them",
    )
    stiffness: StiffnessMatrix | None = Field(
        None, description="stiffness that linear analyses take; default: the tangent of the law at the equilibrium"
    )
    damping: DampingMatrix | None = Field(None, description="damping that goes with a given stiffness")
    table: tuple[TableRow, ...] = Field((), description="rows over speed, linear in between, in place of stiffness")

    @property
    def is_given(self) -> bool:
        """Whether linear analyses have a stiffness for it."""
        return self.stiffness is not None or bool(self.table)


def law_parameters(law: type[ForceLaw], given: dict[str, Any]) -> tuple[dict[str, Any], dict[str, str]]:
    """Parameters of a law in SI, and what was expected of those that make no sense, by name."""
    kinds = {item.name: str(item.type) for item in fields(law)}
    found: dict[str, Any] = {}
    wrong: dict[str, str] = {}
    for name, about in law.declared().items():
        if name not in given:
            continue
        try:
            value = _in_si(given[name], about, kinds[name])
        except QuantityError as error:
            wrong[name] = str(error)
            continue
        if about.allows(value):
            found[name] = value
        else:
            wrong[name] = about.expected + (f" ({about.unit})" if about.unit else "")
    return found, wrong


def _in_si(value: Any, about: Parameter, kind: str) -> Any:
    """A value of the file as the law's dataclass takes it."""
    if isinstance(value, list | tuple):
        return tuple(_in_si(each, about, "float") for each in value)
    if about.choices:
        return value
    if kind == "bool":
        if not isinstance(value, bool):
            raise QuantityError("true or false")
        return value
    number = parse_in_unit(value, about.unit)
    if kind != "int":
        return number
    if number != int(number):
        raise QuantityError("a whole number")
    return int(number)


def element_law(element: NonlinearElement, ratio: float) -> ForceLaw:
    """The law of an element on a shaft that turns at `ratio` times the speed of the reference.

    A law that needs the rotation of its shaft names the parameter that holds this ratio (`shaft_ratio`); what the file gives
    for it counts more.
    """
    from rotorgear.forces.registry import law_of

    law = law_of(element.law)
    given, _ = law_parameters(law, element.parameters)
    if law.shaft_ratio and law.shaft_ratio not in given:
        given[law.shaft_ratio] = ratio
    return law(**given)
