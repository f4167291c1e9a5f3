"""Where the components of a REXS file are, and which belong to which; and what this import refuses by its name.

Support vectors and axes are given in the frame of the component that they refer to. u runs along a shaft, w is a second axis,
v = w x u. Model files have z along u, x along v and y along w of the gear unit; shafts that are not parallel to it have axes of
their own, z along u, x along v and y along w of the first of each direction.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.rexs.account import Account
from rotorgear.rexs.document import Component, Document, Relation

# Axes of one gearbox are given with ten digits or more; a tenth of a millirad apart is a drawing's rounding, not an angle.
_PARALLEL = 1e-4


@dataclass(frozen=True, eq=False)
class Frame:
    """Origin (3,) in m and axes u, v, w as rows (3, 3) of a component, in the space of the file."""

    origin: np.ndarray
    axes: np.ndarray

    def sees(self, place: np.ndarray) -> np.ndarray:
        """Coordinates (3,) along its u, v and w, in m, of a place (3,) in the space of the file."""
        return np.asarray(self.axes @ (place - self.origin))


SPACE = Frame(np.zeros(3), np.eye(3))


@dataclass(frozen=True, eq=False)
class Axis:
    """The axis of a shaft.

    Its z, x and y are those along u, v and w of `base`, which all parallel shafts share: the model's frame, or one of the same
    origin and another direction.

    Attributes:
        x, y: in m.
        origin: z of its u = 0 in m. sense: -1 where u runs against z.
        rotation: (3, 3), takes components along u, v, w of the shaft to those along z, x, y of the model.
        base: of its direction.
    """

    x: float
    y: float
    origin: float
    sense: int
    rotation: np.ndarray
    base: Frame

    def z(self, u: float) -> float:
        """z of a coordinate u on the shaft, both in m."""
        return self.origin + self.sense * u

    def distance(self, other: Axis) -> float:
        """Distance in m of a parallel axis."""
        return float(np.hypot(self.x - other.x, self.y - other.y))


def axis_in(frame: Frame, base: Frame, model: Frame) -> Axis | None:
    """The axis of a shaft with its frame; None where it is not parallel to u of a base."""
    u = base.axes @ frame.axes[0]
    if abs(abs(u[0]) - 1.0) > _PARALLEL**2 or np.hypot(u[1], u[2]) > _PARALLEL:
        return None
    along, x, y = base.sees(frame.origin)
    return Axis(float(x), float(y), float(along), 1 if u[0] > 0.0 else -1, model.axes @ frame.axes.T, base)


# Frames that stand in one another.
_DEEPEST = 100
GEAR = "cylindrical_gear"
RING = "ring_gear"
BEVEL = "bevel_gear"
GEARS = (GEAR, RING, BEVEL)
STAGE = "cylindrical_stage"
BEVEL_STAGE = "bevel_stage"
PLANETARY = "planetary_stage"
# What has no counterpart in a model file.
_REFUSED = {
    "worm_stage": "a worm stage",
    "worm_gear": "a worm",
    "worm_wheel": "a worm wheel",
    "hypoid_stage": "a hypoid stage",
    "general_stage": "a stage of no stated kind",
    "general_gear": "a gear of no stated kind",
}
# Parts that carry no stiffness or mass of their own here: data of other parts, results, lubrication.
_SILENT = {
    "gear_unit",
    "gear_casing",
    "lubricant",
    "material",
    "assembly_group",
    "shaft_section",
    "rolling_bearing_row",
    "rolling_element",
    "rolling_element_contact",
    "external_load",
    "shaft",
    *GEARS,
    STAGE,
    BEVEL_STAGE,
    PLANETARY,
    "planet_carrier",
    "root",
    "load_spectrum",
    "general_stage_data",
}
# Words in the type of a component that holds contact, strength or tool data of a part and is none itself.
_DATA_WORDS = (
    "data_set",
    "flank",
    "stage_gear_data",
    "tool",
    "manufacturing",
    "point",
    "curve",
    "list",
    "notch",
    "groove",
)
ASSEMBLIES = ("assembly", "ordered_assembly")
_REFERENCES = ("reference", "ordered_reference")
ON_SHAFT = (*ASSEMBLIES, "side", "connection", "coupling")
_TOOLS = (
    "rack_shaped_tool",
    "cylindrical_gear_tool",
    "gear_shaped_tool",
    "cylindrical_gear_manufacturing_settings",
)
_DATA = (*_REFERENCES, *ASSEMBLIES, "flank", "stage_gear_data", "manufacturing_step")


@dataclass(frozen=True)
class Pair:
    """A stage: two gears in mesh."""

    stage: Component
    members: tuple[Component, Component]


def is_internal(gear: Component) -> bool:
    """Whether a gear is a toothed ring: by its type, or by a negative number of teeth."""
    teeth = gear.attributes.get("number_of_teeth")
    return gear.type == RING or (gear.type == GEAR and teeth is not None and str(teeth.raw).strip().startswith("-"))


def refuse_other_kinds(document: Document, source: str) -> None:
    """Refuse worms, hypoid stages, racks and the like, by their stage where the file has one, else by a gear of it.

    Raises:
        AnalysisError: the file has some; it is named.
    """
    for component in sorted(document.components.values(), key=lambda part: not part.type.endswith("_stage")):
        word = _REFUSED.get(component.type)
        spline = component.type.startswith("involute_spline")
        known = (*GEARS, STAGE, BEVEL_STAGE, PLANETARY)
        if word is None and not spline and component.type.endswith(("_stage", "_gear", "_wheel", "_rack")):
            word = None if component.type in known else f"a {component.type.replace('_', ' ')}"
        if word:
            raise AnalysisError(
                f"{source}: the file has {word}, {component}; cylindrical gears, external and internal, bevel gears and "
                "planetary stages can be imported, no others"
            )


class Structure:
    """Frames and relations of the components of a document, by their meaning.

    `model` is the frame of the model in the space of the file, by default that of the gear unit.

    Args:
        document: of the file; account: where parts that are left out are noted.
    """

    def __init__(self, document: Document, account: Account) -> None:
        self.document = document
        self.account = account
        self._frames: dict[str, Frame | None] = {}
        # Relations by the components that take part, in the order of the file.
        self._of: dict[str, list[Relation]] = {}
        for relation in document.relations:
            for number in dict.fromkeys(number for _, number in relation.refs):
                self._of.setdefault(number, []).append(relation)
        frames = map(self.frame, self.units)
        self.model = next(filter(None, frames), SPACE)

    @property
    def units(self) -> list[Component]:
        """The gear units of the file; a sound one has one."""
        return self.document.of_type("gear_unit")

    def frame(self, component: Component, below: tuple[str, ...] = ()) -> Frame | None:
        """Frame of a component; None where the file gives it no support vector."""
        account = self.account
        if component.id in self._frames:
            return self._frames[component.id]
        support = account.numbers(component, "support_vector", "length", 3)
        found = None
        if support is not None:
            base = None
            number = account.text(component, "reference_component_for_position").removesuffix(".0")
            reference = self.document.components.get(number)
            # A gear unit refers to itself, and its frame is that of the space.
            if len(below) >= _DEEPEST:
                account.missing(component, f"frames in frames go {_DEEPEST} deep, and this one deeper")
            elif reference is not None and number != component.id and number not in below:
                base = self.frame(reference, (*below, component.id))
            base = base or SPACE
            axes = np.eye(3)
            u = np.array(account.numbers(component, "u_axis_vector", "length", 3) or (1e-3, 0.0, 0.0))
            w = np.array(account.numbers(component, "w_axis_vector", "length", 3) or (0.0, 0.0, 1e-3))
            if np.linalg.norm(u) and np.linalg.norm(np.cross(w, u)):
                u = u / np.linalg.norm(u)
                v = np.cross(w, u) / np.linalg.norm(np.cross(w, u))
                axes = np.array([u, v, np.cross(u, v)])
            else:
                account.missing(component, "its axes u and w must be two directions, and are not")
            found = Frame(base.origin + np.array(support) @ base.axes, axes @ base.axes)
        self._frames[component.id] = found
        return found

    def without(self, dropped: set[str]) -> Structure:
        """This structure without some components, whose frames still hold what refers to them."""
        if not dropped:
            return self
        kept = {number: part for number, part in self.document.components.items() if number not in dropped}
        rest = Structure(replace(self.document, components=kept), self.account)
        rest._frames = {number: self.frame(part) for number, part in kept.items()}
        rest.model = self.model
        return rest

    def shaft_of(self, component: Component, *roles: str) -> str:
        """Number of the shaft that a component is on (in some of the roles of that shaft, where they are given), or ""."""
        wanted = roles or ("assembly", "inner_part", "shaft", "side_1")
        for relation in self._of.get(component.id, ()):
            if relation.type in ON_SHAFT:
                for owner in self._known(relation.at(*wanted)):
                    if owner.type == "shaft" and owner.id != component.id:
                        return owner.id
        return ""

    def _known(self, numbers: Iterable[str]) -> list[Component]:
        """The components of some numbers, without numbers that the file lacks."""
        return [self.document.components[number] for number in numbers if number in self.document.components]

    def _linked(self, owner: Component, types: tuple[str, ...], role: str, *others: str) -> list[Component]:
        """The components in some roles of relations of some types in which a component has another role."""
        relations = [one for one in self._of.get(owner.id, ()) if one.type in types and owner.id in one.at(role)]
        return self._known(dict.fromkeys(number for relation in relations for number in relation.at(*others)))

    def beside(self, part: Component) -> list[Component]:
        """The components that a bearing or a coupling sits between."""
        numbers: list[str] = []
        for relation in self._of.get(part.id, ()):
            if relation.type in ON_SHAFT:
                numbers += relation.at("inner_part", "outer_part", "side_1", "side_2")
        return self._known(number for number in dict.fromkeys(numbers) if number != part.id)

    def shafts_of(self, stage: Component, relation: str) -> list[str]:
        """Numbers of the shafts that a planetary stage names by a relation, such as planet_shaft."""
        found = self._linked(stage, (relation,), PLANETARY, "shaft")
        return [part.id for part in found if part.type == "shaft"]

    def parts_of(self, owner: Component, *types: str) -> list[Component]:
        """The components of some types that a component is put together from, in the order of the file."""
        return [part for part in self._linked(owner, ASSEMBLIES, "assembly", "part") if part.type in types]

    def referenced(self, owner: Component, kind: str) -> Component | None:
        """The component of a type that another one refers to."""
        found = self._linked(owner, _REFERENCES, "origin", "referenced")
        return next((component for component in found if component.type == kind), None)

    def data_of(self, gear: Component) -> list[Component]:
        """The gear and all that holds data of it, nearest first: versions moved attributes between these components."""
        near: dict[str, Component] = {gear.id: gear}
        for relation in self._of.get(gear.id, ()):
            if relation.type in _DATA:
                others = [number for role, number in relation.refs if role not in ("stage", "assembly", "origin")]
                known = self._known(others)
                near |= {part.id: part for part in known if part.type not in ("material", "shaft", STAGE, BEVEL_STAGE)}
        for component in list(near.values())[1:]:
            for kind in _TOOLS:
                tool = self.referenced(component, kind)
                if tool is not None:
                    near[tool.id] = tool
        return list(near.values())

    def pairs(self) -> list[Pair]:
        """The stages with their two gears, those with a ring last; a stage with fewer or more is a problem."""
        found = []
        for stage in self.document.of_type(STAGE, BEVEL_STAGE):
            kind, kinds = ("bevel", (BEVEL,)) if stage.type == BEVEL_STAGE else ("cylindrical", (GEAR, RING))
            known = self._linked(stage, ("stage", "stage_gear_data"), "stage", "gear_1", "gear_2", "gear")
            if len(known) == 2 and all(gear.type in kinds for gear in known):
                found.append(Pair(stage, (known[0], known[1])))
            else:
                self.account.missing(stage, f"a relation with two {kind} gears is needed; it has {len(known)}")
        return sorted(found, key=lambda pair: any(map(is_internal, pair.members)))

    def note_left_out(self, taken: set[str]) -> None:
        """Note the parts of the file that are not in the model."""
        kinds = Counter(part.type for part in self.document.components.values() if part.id not in taken)
        for kind, count in kinds.items():
            if kind not in _SILENT and not any(word in kind for word in _DATA_WORDS):
                self.account.left_out.append(f"{count} x {kind}" if count > 1 else kind)
