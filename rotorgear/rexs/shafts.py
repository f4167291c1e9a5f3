"""Shafts of a REXS file: sections, materials and axes; axes that the file does not place follow from its stages."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np

from rotorgear.rexs.account import Account
from rotorgear.rexs.document import Component
from rotorgear.rexs.structure import BEVEL_STAGE, SPACE, Axis, Frame, Pair, Structure, axis_in, is_internal
from rotorgear.rexs.toml_text import Names, Table, number, quantity, row, text

# Ends of neighbouring sections closer than this are one place: files write differences of rounded coordinates.
_SAME_PLACE = 1e-6
# Decimals of a place in m that follows from an angle: the sine of 180 deg is no length.
_PICOMETRE = 12
CENTRE_DISTANCE = ("center_distance", "centre_distance")
# Numbers of a material: key, attributes, kind, bounds beyond which a value is a placeholder, the value of steel and its text.
_OF_STEEL = (
    (
        "youngs_modulus",
        ("elastic_modulus", "youngs_modulus", "modulus_of_elasticity"),
        "modulus",
        (1e8, 1e12),
        206e9,
        "206 GPa",
    ),
    ("poisson_ratio", ("poisson_ratio", "poissons_ratio"), "ratio", (1e-9, 0.5 - 1e-9), 0.3, "0.3"),
    ("density", ("density",), "density", (100.0, 25000.0), 7850.0, "7850 kg/m^3"),
)


@dataclass(frozen=True)
class Section:
    """A section of a shaft from u to u + length: outer and inner diameters at its begin and its end, all in m."""

    u: float
    length: float
    outer: tuple[float, float]
    inner: tuple[float, float]
    remark: str = ""

    @property
    def end(self) -> float:
        """u of its end."""
        return self.u + self.length


@dataclass(frozen=True)
class Pins:
    """Where planets stand: name of their carrier, radius of the circle in m, angle ahead of its +x in rad, and how many."""

    carrier: str
    radius: float
    offset: float
    count: int


@dataclass(frozen=True)
class ShaftPart:
    """A shaft of the model: its component, name, axis and sections by rising u; of a planet where its pins stand.

    That of a gear in the casing has no sections.
    """

    component: Component
    name: str
    axis: Axis
    sections: tuple[Section, ...]
    pins: Pins | None = None

    @property
    def ends(self) -> tuple[float, float]:
        """Smallest and largest z."""
        if not self.sections:
            return self.axis.origin, self.axis.origin
        low, high = sorted((self.axis.z(self.sections[0].u), self.axis.z(self.sections[-1].end)))
        return low, high

    @property
    def start(self) -> float:
        """Smallest z."""
        return self.ends[0]

    def diameter(self, z: float) -> float:
        """The largest outer diameter of the sections at a place."""
        return max((max(p.outer) for p in self._at(z)), default=0.0)

    def bore(self, z: float) -> float:
        """The smallest bore of the sections at a place."""
        return min((min(p.inner) for p in self._at(z)), default=0.0)

    def _at(self, z: float) -> list[Section]:
        u = (z - self.axis.origin) * self.axis.sense
        return [p for p in self.sections if p.u - _SAME_PLACE <= u <= p.end + _SAME_PLACE] or list(self.sections[-1:])

    def table(self, header: str, remark: str, z: float) -> Table:
        """The table of a part that is on the shaft at z."""
        return Table(header, remark, [("shaft", text(self.name), ""), ("at", quantity(z, "length"), "")])

    def place(self, component: Component, z: float, account: Account) -> float:
        """A z on the shaft: one that is outside by rounding is moved to the end, any other is a problem."""
        low, high = self.ends
        inside = min(max(z, low), high)
        if abs(inside - z) > _SAME_PLACE:
            u = f"{1e3 * (z - self.axis.origin) * self.axis.sense:.6g} mm"
            off = f"its place, {u} from the origin of {self.component}, lies off that shaft's sections"
            account.missing(component, off)
        return inside


def read_sections(shaft: Component, structure: Structure) -> tuple[Section, ...]:
    """The sections of a shaft by rising u, without gaps; a gap is filled with the section before it, with a remark."""
    account = structure.account
    given: list[Section] = []
    u = 0.0
    components = structure.parts_of(shaft, "shaft_section")
    for part in components or [shaft]:
        length = account.number(part, ("length",), "length")
        begin = account.number(part, ("outer_diameter_begin", "outer_diameter", "outer_diameter_end"), "length")
        if length is None or begin is None:
            what = "length and outer_diameter_begin"
            needs = f"{what} are needed" if components else f"a shaft needs shaft_section parts with {what}"
            account.missing(part, needs)
            continue
        if length < -_SAME_PLACE:
            account.missing(part, "its length must not be negative")
        if length <= _SAME_PLACE:
            continue
        stated = account.number(part, ("u_coordinate_on_shaft",), "length") if components else 0.0
        # A section without a place follows the one before it.
        u = u if stated is None else stated
        end = account.number(part, ("outer_diameter_end",), "length") or begin
        bore = account.number(part, ("inner_diameter_begin", "inner_diameter"), "length") or 0.0
        bore_end = account.number(part, ("inner_diameter_end",), "length")
        inner = (bore, bore if bore_end is None else bore_end)
        if begin <= inner[0] or end <= inner[1] or min(inner) < 0.0:
            account.missing(part, "outer diameters must be larger than inner ones, and both not negative")
        else:
            given.append(Section(u, length, (begin, end), inner))
        u += length
    given.sort(key=lambda section: section.u)
    sections = given[:1]
    for section in given[1:]:
        last = sections[-1]
        gap = section.u - last.end
        range_of_u = f"from u = {1e3 * last.end:.6g} to {1e3 * section.u:.6g} mm"
        if gap < -_SAME_PLACE:
            account.missing(
                shaft, f"its sections must follow one another; they overlap at u = {1e3 * section.u:.6g} mm"
            )
            sections.append(section)
            continue
        if gap > sum(item.length for item in given):
            account.missing(shaft, f"its sections must follow one another; there is none {range_of_u}")
        elif gap > _SAME_PLACE:
            reason = f"no section of {shaft} {range_of_u}: as the one before"
            sizes = f"{1e3 * last.outer[1]:.6g} mm"
            remark = account.assume("shafts.sections.outer_diameter", sizes, reason)
            sections.append(Section(last.end, gap, (last.outer[1],) * 2, (last.inner[1],) * 2, remark))
        start = sections[-1].end
        sections.append(replace(section, u=start, length=section.end - start))
    return tuple(sections)


def shaft_axes(structure: Structure, pairs: list[Pair], unplaced: Collection[str] = ()) -> dict[str, Axis]:
    """Axes of all shafts by number.

    The frame of the model takes the directions of the first shaft where none is parallel to it. Shafts that the file does not
    place follow from the centre distance and the angle of cylindrical stages: the second gear is at v = a sin(phi),
    w = a cos(phi) from the first, phi = rotating_angle_around_neg_u_axis counted from w.

    Args:
        structure: of the file. pairs: its stages.
        unplaced: numbers of shafts that need no place.
    """
    account = structure.account
    shafts = structure.document.of_type("shaft")
    placed = {shaft.id: frame for shaft in shafts if (frame := structure.frame(shaft)) is not None}
    frames = list(placed.values())
    if frames and not any(axis_in(frame, structure.model, SPACE) for frame in frames):
        structure.model = Frame(structure.model.origin, frames[0].axes)
    model = structure.model
    bases = [model]
    axes: dict[str, Axis] = {}
    for shaft_id, frame in placed.items():
        if all(axis_in(frame, base, model) is None for base in bases):
            bases.append(Frame(model.origin, frame.axes))
        axes[shaft_id] = next(filter(None, (axis_in(frame, base, model) for base in bases)))
    if shafts and not axes:
        axes[shafts[0].id] = Axis(0.0, 0.0, 0.0, 1, np.eye(3), model)
        reason = f"{shafts[0]} has no support_vector: the origin of the model"
        account.assume(f"shafts.{shafts[0].name or shafts[0].id}.position", "x = y = z = 0", reason)
    _by_stages(axes, structure, [pair for pair in pairs if pair.stage.type != BEVEL_STAGE])
    for shaft in shafts:
        if shaft.id not in axes and shaft.id not in unplaced:
            wanted = "support_vector is needed, or a cylindrical stage with a placed shaft and a centre_distance"
            account.missing(shaft, wanted)
    return axes


def _by_stages(axes: dict[str, Axis], structure: Structure, pairs: list[Pair]) -> None:
    """Place shafts beside placed ones, until no stage leads to another."""
    account = structure.account
    waiting = list(pairs)
    while waiting:
        rest = []
        for pair in waiting:
            owners = [structure.shaft_of(gear) for gear in pair.members]
            known = [owner in axes for owner in owners]
            if all(known) or "" in owners:
                continue
            if not any(known):
                rest.append(pair)
                continue
            k = known.index(True)
            new = structure.document.components[owners[1 - k]]
            a = account.number(pair.stage, CENTRE_DISTANCE, "length")
            # That of an internal pair is negative where its ring is.
            if a and any(map(is_internal, pair.members)):
                a = abs(a)
            if not a or a < 0.0:
                continue
            axes[new.id] = _beside(axes[owners[k]], a, pair, k, new, account)
        if len(rest) == len(waiting):
            return
        waiting = rest


def _beside(base: Axis, a: float, pair: Pair, k: int, new: Component, account: Account) -> Axis:
    """The axis of a shaft at a distance a in m from that of gear number k of a stage."""
    phi = account.number(pair.stage, ("rotating_angle_around_neg_u_axis",), "angle")
    where = f"{new} has no support_vector: by centre distance and angle of {pair.stage}"
    if phi is None:
        phi = math.pi / 2.0
        where = f"{new} has no support_vector, {pair.stage} no angle: beside the other shaft, faces aligned"
    turn = 1.0 if k == 0 else -1.0
    places = [account.number(gear, ("u_coordinate_on_shaft",), "length") or 0.0 for gear in pair.members]
    shift = places[k] - places[1 - k]
    x = round(base.x + turn * a * math.sin(phi), _PICOMETRE)
    y = round(base.y + turn * a * math.cos(phi), _PICOMETRE)
    account.assume(f"shafts.{new.name or new.id}.position", f"x = {1e3 * x:.6g} mm, y = {1e3 * y:.6g} mm", where)
    return replace(base, x=x, y=y, origin=base.origin + base.sense * shift)


def shaft_table(part: ShaftPart, material: str, comment: str, model: Frame, given: tuple[str, ...] = ()) -> Table:
    """The table of a shaft.

    Args:
        part: the shaft. material: its name, and the comment beside it.
        model: frame of the model.
        given: key, value and comment of its speed, where the train needs one.
    """
    several = f"; {part.pins.count} of them, written once" if part.pins else ""
    table = Table(f"shafts.{part.name}", f"{part.component}{several}")
    forward = part.axis.sense > 0
    _add_place(table, part, model)
    table.add(
        "start",
        quantity(part.start, "length"),
        "" if forward or not part.sections else "u of the file runs against z here",
    )
    if given:
        table.add(*given)
    if not part.sections:
        return table
    if material:
        table.add("material", text(material), comment)
    lines = ["["]
    for section in part.sections if forward else part.sections[::-1]:
        # Both ends from left to right.
        outer, inner = (ends if forward else ends[::-1] for ends in (section.outer, section.inner))
        values = {"length": quantity(section.length, "length"), "outer_diameter": quantity(outer[0], "length")}
        if outer[1] != outer[0]:
            values["outer_diameter_end"] = quantity(outer[1], "length")
        if inner[0] or inner[1]:
            values["bore"] = quantity(inner[0], "length")
        if inner[1] != inner[0]:
            values["bore_end"] = quantity(inner[1], "length")
        lines.append(f"    {row(**values)}," + (f"  # {section.remark}" if section.remark else ""))
    table.add("sections", "\n".join([*lines, "]"]))
    return table


def _add_place(table: Table, part: ShaftPart, model: Frame) -> None:
    """Where the shaft stands: on a carrier's pins, along z of the model, or along an axis of its own."""
    axis = part.axis
    if part.pins is not None:
        table.add("carrier", text(part.pins.carrier))
        table.add("radius", quantity(part.pins.radius, "length"))
        if part.pins.offset:
            table.add("offset", quantity(part.pins.offset, "angle"), "from +x of the carrier's shaft")
        return
    if axis.base is model:
        table.add("position", f"[{quantity(axis.x, 'length')}, {quantity(axis.y, 'length')}]")
        return
    # Components along z, x and y of the model.
    across = np.array([0.0, axis.x, axis.y]) @ axis.base.axes @ model.axes.T
    turned = axis.base.axes @ model.axes.T
    z, x, y = (round(value, _PICOMETRE) for value in across.tolist())
    table.add("position", "[" + ", ".join(quantity(value, "length") for value in (x, y, z)) + "]", "of its z = 0")
    for key, direction in (("axis", turned[0]), ("x_axis", turned[1])):
        z, x, y = (round(value, _PICOMETRE) for value in direction.tolist())
        table.add(key, "[" + ", ".join(number(value) for value in (x, y, z)) + "]")


class Materials:
    """Tables of the materials that shafts and gears refer to, each written once."""

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        self.tables: list[Table] = []
        self._names = Names()
        self._known: dict[str, str] = {}

    def of(self, owner: Component, address: str) -> tuple[str, str]:
        """Name of a part's material and a comment; "" where it is steel of the library."""
        structure = self.structure
        parts = [owner, *structure.parts_of(owner, "shaft_section")]
        material = next(filter(None, (structure.referenced(part, "material") for part in parts)), None)
        if material is None:
            return "steel", structure.account.assume(f"{address}.material", "steel", "the file names no material")
        if material.id not in self._known:
            self._known[material.id] = self._written(material)
        return self._known[material.id], ""

    def _written(self, material: Component) -> str:
        account = self.structure.account
        name = self._names.of(material.name or "material", "material", material.id)
        table = Table(f"materials.{name}", str(material))
        for key, names, kind, bounds, steel, shown in _OF_STEEL:
            value = account.number(material, names, kind)
            note = ""
            if value is None or not bounds[0] <= value <= bounds[1]:
                value = steel
                note = account.assume(f"{table.header}.{key}", shown, f"{material} states none: that of steel")
            table.add(key, number(value) if kind == "ratio" else quantity(value, kind), note)
        self.tables.append(table)
        return name
