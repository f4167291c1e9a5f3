"""Where the components of a REXS file are, and which belong to which; and what this import refuses by its name.

Support vectors and axes are given in the frame of the component that they refer to. u runs along a shaft, w is a second axis,
v = w x u. Model files have z along u, x along v and y along w of the gear unit.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.rexs.account import Account
from rotorgear.rexs.document import Component, Document

# Axes of one gearbox are given with ten digits or more; a tenth of a millirad apart is a drawing's rounding, not an angle.
_PARALLEL = 1e-4


@dataclass(frozen=True)
class Frame:
    """Origin (3,) in m and axes u, v, w as rows (3, 3) of a component, in the space of the file."""

    origin: np.ndarray
    axes: np.ndarray


@dataclass(frozen=True)
class Axis:
    """The axis of a shaft in the frame of the model: x and y in m, z of its origin, and -1 where u runs against z.

    `rotation` (3, 3) takes components along u, v, w of the shaft to those along z, x, y of the model.
    """

    x: float
    y: float
    origin: float
    sense: int
    rotation: tuple[tuple[float, ...], ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))

    def z(self, u: float) -> float:
        """z of a coordinate u on the shaft, both in m."""
        return self.origin + self.sense * u


def axis_in(frame: Frame, model: Frame) -> Axis | None:
    """The axis of a shaft in the model's frame; None where it is not parallel to the model's u."""
    u = model.axes @ frame.axes[0]
    if abs(abs(u[0]) - 1.0) > _PARALLEL**2 or np.hypot(u[1], u[2]) > _PARALLEL:
        return None
    along, x, y = model.axes @ (frame.origin - model.origin)
    rotation = tuple(tuple(float(entry) for entry in row) for row in model.axes @ frame.axes.T)
    return Axis(float(x), float(y), float(along), 1 if u[0] > 0.0 else -1, rotation)


GEAR = "cylindrical_gear"
STAGE = "cylindrical_stage"
# What a gearbox of external cylindrical gears on parallel shafts can't have.
_REFUSED = {
    "planetary_stage": "a planetary stage",
    "planet_carrier": "a planet carrier",
    "ring_gear": "an internal (ring) gear",
    "worm_stage": "a worm stage",
    "worm_gear": "a worm",
    "worm_wheel": "a worm wheel",
    "bevel_stage": "a bevel stage",
    "bevel_gear": "a bevel gear",
    "hypoid_stage": "a hypoid stage",
    "general_stage": "a stage of no stated kind",
    "general_gear": "a gear of no stated kind",
}
# Parts that carry no stiffness or mass of their own here: data of other parts, results, lubrication, strength.
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
    GEAR,
    STAGE,
    "root",
    "load_spectrum",
    "flank_geometry",
    "cylindrical_gear_flank",
    "stage_gear_data",
    "cylindrical_stage_gear_data",
    "cylindrical_gear_manufacturing_settings",
    "rack_shaped_tool",
    "gear_shaped_tool",
    "cylindrical_gear_tool",
    "tool",
    "general_stage_data",
}
# Words in the type of a component that holds contact or strength data of a part and is none itself.
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
_ON_SHAFT = ("assembly", "ordered_assembly", "side", "connection", "coupling")
_DATA = (
    "flank",
    "stage_gear_data",
    "reference",
    "ordered_reference",
    "manufacturing_step",
    "assembly",
    "ordered_assembly",
)


@dataclass(frozen=True)
class Pair:
    """A stage: two gears in mesh."""

    stage: Component
    members: tuple[Component, Component]


def refuse_other_kinds(document: Document, source: str) -> None:
    """Refuse planetary, worm and bevel gearing, by its stage where the file has one, else by a gear of it.

    Raises:
        AnalysisError: the file has some; it is named.
    """
    for component in sorted(document.components.values(), key=lambda part: not part.type.endswith("_stage")):
        word = _REFUSED.get(component.type)
        spline = component.type.startswith("involute_spline")
        if word is None and not spline and component.type.endswith(("_stage", "_gear", "_wheel", "_rack")):
            word = None if component.type in (GEAR, STAGE) else f"a {component.type.replace('_', ' ')}"
        teeth = component.attributes.get("number_of_teeth")
        if word is None and component.type == GEAR and teeth is not None and str(teeth.raw).startswith("-"):
            word = "an internal gear (negative number of teeth)"
        if word:
            raise AnalysisError(
                f"{source}: the file has {word}, {component}; external cylindrical gears on parallel shafts can be "
                "imported, no others"
            )


class Structure:
    """Frames and relations of the components of a document, asked for by what they mean.

    `model` is the frame of the model in the space of the file, by default that of the gear unit.

    Args:
        document: of the file; account: where parts that are left out are noted.
    """

    def __init__(self, document: Document, account: Account) -> None:
        self.document = document
        self.account = account
        self._frames: dict[str, Frame | None] = {}
        units = [frame for unit in document.of_type("gear_unit") if (frame := self.frame(unit)) is not None]
        self.model = units[0] if units else Frame(np.zeros(3), np.eye(3))

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
            # A gear unit refers to itself, and its frame is that of the space.
            if number and number != component.id and number not in below:
                reference = self.document.components.get(number)
                base = self.frame(reference, (*below, component.id)) if reference is not None else None
            base = base or Frame(np.zeros(3), np.eye(3))
            axes = np.eye(3)
            u = np.array(account.numbers(component, "u_axis_vector", "length", 3) or (1e-3, 0.0, 0.0))
            w = np.array(account.numbers(component, "w_axis_vector", "length", 3) or (0.0, 0.0, 1e-3))
            if np.linalg.norm(u) and np.linalg.norm(np.cross(w, u)):
                u = u / np.linalg.norm(u)
                v = np.cross(w, u)
                v = v / np.linalg.norm(v)
                axes = np.array([u, v, np.cross(u, v)])
            else:
                account.missing(component, "its axes u and w must be two directions, and are not")
            found = Frame(base.origin + np.array(support) @ base.axes, axes @ base.axes)
        self._frames[component.id] = found
        return found

    def place(self, frame: Frame) -> np.ndarray:
        """z, x and y (3,) of the origin of a frame in the model, in m."""
        return np.asarray(self.model.axes @ (frame.origin - self.model.origin))

    def shaft_of(self, component: Component, *roles: str) -> Component | None:
        """The shaft that a component is on (in some of the roles of that shaft, where they are given)."""
        wanted = roles or ("assembly", "inner_part", "shaft", "side_1")
        for relation in self.document.relations:
            if relation.type in _ON_SHAFT and component.id in (number for _, number in relation.refs):
                for number in relation.at(*wanted):
                    owner = self.document.components.get(number)
                    if owner is not None and owner.type == "shaft" and owner.id != component.id:
                        return owner
        return None

    def parts_of(self, owner: Component, *types: str) -> list[Component]:
        """The components of some types that a component is put together from, in the order of the file."""
        found: dict[str, Component] = {}
        for relation in self.document.relations:
            if relation.type in ("assembly", "ordered_assembly") and owner.id in relation.at("assembly"):
                for number in relation.at("part"):
                    part = self.document.components.get(number)
                    if part is not None and part.type in types:
                        found[part.id] = part
        return list(found.values())

    def referenced(self, owner: Component, kind: str) -> Component | None:
        """The component of a type that another one refers to."""
        for relation in self.document.relations:
            if relation.type in ("reference", "ordered_reference") and owner.id in relation.at("origin"):
                for number in relation.at("referenced"):
                    found = self.document.components.get(number)
                    if found is not None and found.type == kind:
                        return found
        return None

    def data_of(self, gear: Component) -> list[Component]:
        """The gear and all that holds data of it, nearest first: versions moved attributes between these components."""
        near: dict[str, Component] = {gear.id: gear}
        for relation in self.document.relations:
            numbers = [number for _, number in relation.refs]
            if relation.type in _DATA and gear.id in numbers:
                for role, number in relation.refs:
                    found = self.document.components.get(number)
                    if (
                        found is None
                        or role in ("stage", "assembly", "origin")
                        or found.type in ("material", "shaft", STAGE)
                    ):
                        continue
                    near[number] = found
        for component in list(near.values())[1:]:
            for kind in (
                "rack_shaped_tool",
                "cylindrical_gear_tool",
                "gear_shaped_tool",
                "cylindrical_gear_manufacturing_settings",
            ):
                tool = self.referenced(component, kind)
                if tool is not None:
                    near[tool.id] = tool
        return list(near.values())

    def pairs(self) -> list[Pair]:
        """The stages with their two gears; a stage with fewer or more is a problem."""
        found = []
        for stage in self.document.of_type(STAGE):
            gears: dict[str, None] = {}
            for relation in self.document.relations:
                if relation.type in ("stage", "stage_gear_data") and stage.id in relation.at("stage"):
                    gears |= dict.fromkeys(relation.at("gear_1", "gear_2", "gear"))
            known = [self.document.components[number] for number in gears if number in self.document.components]
            if len(known) == 2 and all(gear.type == GEAR for gear in known):
                found.append(Pair(stage, (known[0], known[1])))
            else:
                self.account.missing(stage, f"a relation with two cylindrical gears is needed; it has {len(known)}")
        return found

    def note_left_out(self, taken: set[str]) -> None:
        """Name the parts of the file that the model has not."""
        counts: dict[str, int] = {}
        for component in self.document.components.values():
            kind = component.type
            if component.id in taken or kind in _SILENT or any(word in kind for word in _DATA_WORDS):
                continue
            counts[kind] = counts.get(kind, 0) + 1
        for kind, count in counts.items():
            self.account.left_out.append(f"{count} x {kind}" if count > 1 else kind)
