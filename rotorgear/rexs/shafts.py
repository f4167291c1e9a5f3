"""Shafts of a REXS file: sections, materials and axes; axes that the file does not place follow from its stages."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from rotorgear.rexs.account import Account
from rotorgear.rexs.document import Component
from rotorgear.rexs.structure import Axis, Frame, Pair, Structure, axis_in
from rotorgear.rexs.toml_text import Names, Table, number, quantity, row

# Ends of neighbouring sections closer than this are one place: files write differences of rounded coordinates.
_SAME_PLACE = 1e-6
# Decimals of a place in m that follows from an angle: the sine of 180 deg is no length.
_PICOMETRE = 12
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
class Piece:
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

    def reversed(self) -> Piece:
        """The same section looked at from the other end."""
        return replace(self, outer=self.outer[::-1], inner=self.inner[::-1])


@dataclass(frozen=True)
class ShaftPart:
    """A shaft of the model: its component, name, axis and sections by rising u."""

    component: Component
    name: str
    axis: Axis
    pieces: tuple[Piece, ...]

    @property
    def start(self) -> float:
        """Smallest z."""
        return min(self.axis.z(self.pieces[0].u), self.axis.z(self.pieces[-1].end))

    @property
    def end(self) -> float:
        """Largest z."""
        return max(self.axis.z(self.pieces[0].u), self.axis.z(self.pieces[-1].end))

    def diameter(self, z: float) -> float:
        """The largest outer diameter of the sections at a place."""
        u = (z - self.axis.origin) * self.axis.sense
        there = [max(p.outer) for p in self.pieces if p.u - _SAME_PLACE <= u <= p.end + _SAME_PLACE]
        return max(there, default=max(self.pieces[-1].outer))

    def place(self, component: Component, z: float, account: Account) -> float:
        """A z that lies on the shaft; outside by no more than rounding it is drawn in, else a problem."""
        inside = min(max(z, self.start), self.end)
        if abs(inside - z) > _SAME_PLACE:
            account.missing(
                component,
                f"its place, {1e3 * (z - self.axis.origin) * self.axis.sense:.6g} mm from the origin of {self.component}, "
                "lies off that shaft's sections",
            )
        return inside


def read_pieces(shaft: Component, structure: Structure, account: Account) -> tuple[Piece, ...]:
    """The sections of a shaft by rising u, without gaps; a gap is filled with the section before it, and told."""
    pieces: list[Piece] = []
    before = 0.0
    sections = structure.parts_of(shaft, "shaft_section")
    for section in sections or [shaft]:
        length = account.number(section, ("length",), "length")
        begin = account.number(section, ("outer_diameter_begin", "outer_diameter", "outer_diameter_end"), "length")
        if length is None or begin is None:
            what = "length and outer_diameter_begin"
            account.missing(
                section, f"{what} are needed" if sections else f"a shaft needs shaft_section parts with {what}"
            )
            continue
        if length < -_SAME_PLACE:
            account.missing(section, "its length must not be negative")
        if length <= _SAME_PLACE:
            continue
        u = account.number(section, ("u_coordinate_on_shaft",), "length") if sections else 0.0
        u = before if u is None else u
        end = account.number(section, ("outer_diameter_end",), "length") or begin
        bore = account.number(section, ("inner_diameter_begin", "inner_diameter"), "length") or 0.0
        bore_end = account.number(section, ("inner_diameter_end",), "length")
        inner = (bore, bore if bore_end is None else bore_end)
        before = u + length
        if begin <= inner[0] or end <= inner[1] or min(inner) < 0.0:
            account.missing(section, "outer diameters must be larger than inner ones, and both not negative")
            continue
        pieces.append(Piece(u, length, (begin, end), inner))
    pieces.sort(key=lambda piece: piece.u)
    out: list[Piece] = []
    for piece in pieces:
        gap = piece.u - out[-1].end if out else 0.0
        if gap < -_SAME_PLACE:
            account.missing(shaft, f"its sections overlap at u = {1e3 * piece.u:.6g} mm; they must follow one another")
        if gap > sum(item.length for item in pieces):
            account.missing(
                shaft,
                f"its sections must follow one another; there is none from u = {1e3 * out[-1].end:.6g} to {1e3 * piece.u:.6g} mm",
            )
        elif gap > _SAME_PLACE:
            last = out[-1]
            reason = f"no section of {shaft} from u = {1e3 * last.end:.6g} to {1e3 * piece.u:.6g} mm: as the one before"
            sizes = f"{1e3 * last.outer[1]:.6g} mm"
            remark = account.assume("shafts.sections.outer_diameter", sizes, reason)
            out.append(Piece(last.end, gap, (last.outer[1],) * 2, (last.inner[1],) * 2, remark))
        out.append(
            replace(piece, u=out[-1].end, length=piece.end - out[-1].end) if out and gap >= -_SAME_PLACE else piece
        )
    return tuple(out)


def shaft_axes(structure: Structure, pairs: list[Pair]) -> dict[str, Axis]:
    """Axes of all shafts by number, in the frame of the model; it becomes that of the shafts where these run otherwise.

    Shafts that the file does not place follow from the centre distance and the angle of the stages: the second gear is
    at v = a sin(phi), w = a cos(phi) from the first, phi = rotating_angle_around_neg_u_axis counted from w.
    """
    account = structure.account
    shafts = structure.document.of_type("shaft")
    placed = {shaft.id: frame for shaft in shafts if (frame := structure.frame(shaft)) is not None}
    first = next(iter(placed.values()), None)
    if first is not None and axis_in(first, structure.model) is None:
        structure.model = Frame(structure.model.origin, first.axes)
    axes: dict[str, Axis] = {}
    for shaft in shafts:
        if shaft.id in placed:
            axis = axis_in(placed[shaft.id], structure.model)
            if axis is None:
                account.missing(
                    shaft, "its axis is not parallel to that of the first shaft; all shafts must be parallel"
                )
            axes[shaft.id] = axis or Axis(0.0, 0.0, 0.0, 1)
    if shafts and not axes:
        axes[shafts[0].id] = Axis(0.0, 0.0, 0.0, 1)
        reason = f"{shafts[0]} has no support_vector: the origin of the model"
        account.assume(f"shafts.{shafts[0].name or shafts[0].id}.position", "x = y = z = 0", reason)
    _by_stages(axes, structure, pairs)
    for shaft in shafts:
        if shaft.id not in axes:
            account.missing(shaft, "support_vector is needed, or a stage with a placed shaft and a centre_distance")
    return axes


def _by_stages(axes: dict[str, Axis], structure: Structure, pairs: list[Pair]) -> None:
    """Place shafts beside placed ones, until no stage leads to another."""
    account = structure.account
    waiting = list(pairs)
    while waiting:
        rest = []
        for pair in waiting:
            owners = [structure.shaft_of(gear) for gear in pair.members]
            known = [owner is not None and owner.id in axes for owner in owners]
            if all(known) or None in owners:
                continue
            if not any(known):
                rest.append(pair)
                continue
            k = known.index(True)
            old = owners[k]
            new = owners[1 - k]
            assert old is not None
            assert new is not None
            a = account.number(pair.stage, ("center_distance", "centre_distance"), "length")
            if not a or a < 0.0:
                continue
            phi = account.number(pair.stage, ("rotating_angle_around_neg_u_axis",), "angle")
            where = f"{new} has no support_vector: by centre distance and angle of {pair.stage}"
            if phi is None:
                phi = math.pi / 2.0
                where = f"{new} has no support_vector, {pair.stage} no angle: beside the other shaft, faces aligned"
            turn = 1.0 if k == 0 else -1.0
            base = axes[old.id]
            places = [account.number(gear, ("u_coordinate_on_shaft",), "length") or 0.0 for gear in pair.members]
            shift = places[k] - places[1 - k]
            x = round(base.x + turn * a * math.sin(phi), _PICOMETRE)
            y = round(base.y + turn * a * math.cos(phi), _PICOMETRE)
            axes[new.id] = Axis(x, y, base.origin + base.sense * shift, base.sense, base.rotation)
            account.assume(
                f"shafts.{new.name or new.id}.position", f"x = {1e3 * x:.6g} mm, y = {1e3 * y:.6g} mm", where
            )
        if len(rest) == len(waiting):
            return
        waiting = rest


def shaft_table(part: ShaftPart, material: str, comment: str) -> Table:
    """The table of a shaft."""
    table = Table(f"shafts.{part.name}", str(part.component))
    position = f"[{quantity(part.axis.x, 'length')}, {quantity(part.axis.y, 'length')}]"
    table.add("position", position)
    table.add(
        "start", quantity(part.start, "length"), "" if part.axis.sense > 0 else "u of the file runs against z here"
    )
    if material:
        table.add("material", f'"{material}"', comment)
    pieces = part.pieces if part.axis.sense > 0 else tuple(piece.reversed() for piece in part.pieces[::-1])
    lines = ["["]
    for piece in pieces:
        values = {"length": quantity(piece.length, "length"), "outer_diameter": quantity(piece.outer[0], "length")}
        if piece.outer[1] != piece.outer[0]:
            values["outer_diameter_end"] = quantity(piece.outer[1], "length")
        if piece.inner[0] or piece.inner[1]:
            values["bore"] = quantity(piece.inner[0], "length")
        if piece.inner[1] != piece.inner[0]:
            values["bore_end"] = quantity(piece.inner[1], "length")
        lines.append(f"    {row(**values)}," + (f"  # {piece.remark}" if piece.remark else ""))
    table.add("sections", "\n".join([*lines, "]"]))
    return table


class Materials:
    """Tables of the materials that shafts and gears refer to, each written once."""

    def __init__(self, structure: Structure, account: Account) -> None:
        self.structure = structure
        self.account = account
        self.tables: list[Table] = []
        self._names = Names()
        self._known: dict[str, str] = {}

    def of(self, owner: Component, address: str) -> tuple[str, str]:
        """Name of a part's material and a comment; "" where it is steel of the library."""
        material = self.structure.referenced(owner, "material")
        if material is None:
            for section in self.structure.parts_of(owner, "shaft_section"):
                material = material or self.structure.referenced(section, "material")
        if material is None:
            return "steel", self.account.assume(f"{address}.material", "steel", "the file names no material")
        if material.id not in self._known:
            self._known[material.id] = self._written(material)
        return self._known[material.id], ""

    def _written(self, material: Component) -> str:
        account = self.account
        name = self._names.of(f"{material.name or 'material'}", "material", material.id)
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
