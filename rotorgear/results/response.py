"""Result of a run-up: forces, transmission errors and accelerations by order and speed."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.quantity import RPM_PER_RAD_S, counted
from rotorgear.results.laws import AboutEquilibrium
from rotorgear.results.modal import NODE_COUNT, NodeTable, Piece
from rotorgear.results.schema import Record, derived, force_and_moment, of
from rotorgear.results.table import TRANSMISSION_WORDS, Block, Column, Line, Table, error_words, grid, table_of

# Rows of a run of orders before the rest of it shares one.
_SHOWN = 5


class Peak(Record):
    """The largest amplitude of a quantity over orders and speeds, and what the linear analysis leaves out there."""

    quantity: str = of(
        "quantity",
        note=": mesh force, transmission error, approach, bearing force, seat force, ground force, acceleration, "
        "internal load, displacement or normal velocity",
        column="largest of",
    )
    part: str = of("mesh, bearing, point, place, seat, or held set or mount", column="of")
    unit: str = of("unit of the amplitudes")
    order: int = of("number of the order", note=", from 0", column="order no")
    speed_rpm: float = of("speed of the input shaft", "rpm", form=".1f", column="rpm")
    frequency_hz: float = of("frequency", "Hz", form=".1f", column="Hz")
    amplitude: float = of("amplitude", note=" in that unit")
    left_out: float | None = of(
        "size of what the linear analysis of loaded teeth leaves out",
        note=" of this quantity at this order and speed; `null` where no loaded teeth shake, or where they part",
    )
    teeth_part: bool = of("whether the linear solution would part loaded teeth there")
    axis: str = of("axis of the amplitude", note=' of a force or displacement, "x", "y" or "z"; else `""`', default="")


class LimitLine(Record):
    """A target over speed for one quantity, all orders together or one of them, and how the run-up stands against it.

    Between its corners the line is straight; outside of them it says nothing.
    """

    at: str = of("mesh, bearing or point", column="limit of")
    order: str = of("order", note='; `""`: all orders together, the root of their sum of squares', column="order")
    unit: str = of("unit of the amplitudes")
    speed_rpm: np.ndarray = of("speeds of its corners", "rpm", "corner")
    amplitude: np.ndarray = of("limit", "", "corner", note=" at these speeds, half of peak to peak")
    ratio: float = of(
        "largest ratio of the amplitude to the limit", note=" at the speeds asked for", column="of limit", form=".3g"
    )
    worst_rpm: float = of("speed of that ratio", "rpm", column="at rpm", form=".1f")
    reached: float = of("amplitude there", note=" in that unit", column="reached", form=".4g")
    allowed: float = of("limit there", note=" in that unit", column="limit", form=".4g")
    exceeded_rpm: float = of(
        "range of speed above the limit",
        "rpm",
        note=": sum of the steps between asked speeds",
        column="rpm above",
        form=".1f",
    )

    def over(self, speed_rpm: np.ndarray) -> np.ndarray:
        """The limit at some speeds (...), NaN outside of the line."""
        return straight_between(self.speed_rpm, self.amplitude, speed_rpm)

    @property
    def level_db(self) -> float:
        """By how many dB the amplitude is above the limit at worst; negative below it."""
        return float(20.0 * np.log10(max(self.ratio, 1e-30)))


def straight_between(corners_rpm: np.ndarray, amplitude: np.ndarray, speed_rpm: np.ndarray) -> np.ndarray:
    """The limit at some speeds (...) of either sense by its corners (c,), NaN outside of them."""
    return np.interp(np.abs(speed_rpm), corners_rpm, amplitude, left=np.nan, right=np.nan)


# rho c of air at 20 degrees and 1 atm, in kg/(m^2 s).
AIR_IMPEDANCE = 1.204 * 343.2


class ResponseResult(AboutEquilibrium, kind="response"):
    """Linear response of a model at s speeds to o orders, complex amplitudes of Re(x e^{+iwt}) about the static forces."""

    json_axes = (
        "MESH",
        "BEARING",
        "POINT",
        "GAUGE",
        "PLACE",
        "CASING.SEAT",
        "CASING.SET",
        "CASING",
        "AXIS",
        "order",
        "speed",
    )

    speeds: np.ndarray = of("speed of the input shaft", "rad/s", "speed", json="speed_rpm")
    orders: tuple[str, ...] = of("name of each order", "", "order", json="order")
    ratio: np.ndarray = of("frequency over that of the input shaft", "", "order", json="frequency_ratio")
    fixed_frequency: np.ndarray = of(
        "frequency that does not go with the speed", "Hz", "order", note=" of a load; else 0", json="fixed_frequency"
    )

    @property
    def speed_rpm(self) -> np.ndarray:
        """Speeds of the reference shaft in rpm, (s,)."""
        return self.speeds * RPM_PER_RAD_S

    @derived("frequency", "Hz", "order", "speed", note=" of each order at each speed")
    def frequency_hz(self) -> np.ndarray:
        """Frequency of each order at each speed, (o, s)."""
        return self.ratio[:, None] * np.abs(self.speeds) / (2.0 * np.pi) + self.fixed_frequency[:, None]

    contact_mesh: tuple[str, ...] = of("mesh of each contact", "", "contact", json=None)
    contact_helix: np.ndarray = of("0 or 1 for the helix at the smaller or larger z", "", "contact", json=None)
    mean_force: np.ndarray = of(
        "mean force", "N", "contact", note=": the static force about which it is linear", json="mean_mesh_force_n"
    )
    mesh_stiffness: np.ndarray = of(
        "stiffness along the flank normal", "N/m", "contact", note="; of loaded teeth the mean tangent of a mesh cycle"
    )
    mesh_force: np.ndarray = of(
        "force along the flank normal", "N", "order", "speed", "contact", note=": the dynamic force, without the mean"
    )
    transmission_error: np.ndarray = of(
        "transmission error", "m", "order", "speed", "contact", note=": rotation at the base circles of each helix"
    )
    approach: np.ndarray = of(
        "approach", "m", "order", "speed", "contact", note=" of the flanks, transverse, with bending and axial motion"
    )
    bearings: tuple[str, ...] = of("names of the bearings", "", "bearing", json=None)
    bearing_force: np.ndarray = of("force on the shaft", "N", "order", "speed", "bearing", "xyz")
    points: tuple[str, ...] = of("names of the points", "", "point", json=None)
    acceleration: np.ndarray = of(
        "acceleration of a named point", "m/s^2, rad/s^2", "order", "speed", "point", note=" along its direction"
    )
    load_points: tuple[str, ...] = of(
        "names of the points that read a load", "", "gauge", json=None, default=(), kw_only=True
    )
    internal_load: np.ndarray = of(
        "load inside a shaft or coupling",
        "N, N m",
        "order",
        "speed",
        "gauge",
        note=" at a point that reads one",
        default_factory=lambda: np.zeros((0, 0, 0)),
        kw_only=True,
    )
    places: tuple[str, ...] = of("gears, disks and bearings by address", "", "place", json=None)
    displacement: np.ndarray = of(
        "displacements x y z tx ty tz",
        "m, rad",
        "order",
        "speed",
        "place",
        "component",
        json="displacement_m",
        note=" of each gear, disk and bearing; x, y and z are written",
    )
    casings: tuple[str, ...] = of(
        "names of the casings with a surface", "", "casing", json=None, default=(), kw_only=True
    )
    casing_seats: tuple[str, ...] = of(
        "seats that something stands in", "", "seat", json=None, default=(), kw_only=True
    )
    casing_seat_force: np.ndarray = of(
        "force and moment on a seat of a casing",
        "N, N m",
        "order",
        "speed",
        "seat",
        "component",
        json=force_and_moment("casing_seat", "the casing"),
        note="; the moment about the point of the seat",
        default_factory=lambda: np.zeros((0, 0, 0, 6)),
        kw_only=True,
    )
    casing_grounds: tuple[str, ...] = of(
        "held sets and mounts of casings", "", "ground", json=None, default=(), kw_only=True
    )
    casing_ground_force: np.ndarray = of(
        "force and moment of the ground on a casing at one held set or mount",
        "N, N m",
        "order",
        "speed",
        "ground",
        "component",
        json=force_and_moment("casing_ground", "the casing"),
        note="; the moment about the origin of the model",
        default_factory=lambda: np.zeros((0, 0, 0, 6)),
        kw_only=True,
    )
    normal_velocity: np.ndarray = of(
        "normal velocity of a casing",
        "m/s",
        "order",
        "speed",
        "casing",
        note=": root of the mean over its surface of the square of the amplitude",
        default_factory=lambda: np.zeros((0, 0, 0)),
        kw_only=True,
    )
    surface_area: np.ndarray = of(
        "surface of a casing",
        "m^2",
        "casing",
        note=", inside and out",
        json="casing_surface_m2",
        default_factory=lambda: np.zeros(0),
        kw_only=True,
    )

    @derived(
        "equivalent radiated power",
        "W",
        "order",
        "speed",
        "casing",
        note=" of a casing, 1/2 ρ c ∑ v_n² A with ρ c = 413 kg/m²s of air, as if all of its surface radiated like a large plate",
    )
    def radiated_power(self) -> np.ndarray:
        """1/2 rho c sum of v_n^2 A in W, (o, s, k); those of the orders add up."""
        return 0.5 * AIR_IMPEDANCE * self.normal_velocity**2 * self.surface_area

    shape_speed: float = of("speed of the deflection shapes", "rad/s")
    shapes: np.ndarray = of("displacements x y z tx ty tz", "m, rad", "node", "component", "order", json=None)
    nodes: NodeTable = of("nodes", record=NodeTable, json=NODE_COUNT)
    damping_ratio: float = of("damping ratio", note=" added to every elastic mode")
    solver_error: float = of("solver error", note=": of the reduced basis at the points checked; direct: the residual")
    checked: int = of("number of points checked")
    error_estimate: float = of(
        "estimated relative discretisation error",
        note=": change of the largest forces on a finer mesh",
        form=error_words,
    )
    discretisation: tuple[Piece, ...] = of("how each shaft segment was divided", "", "piece", record=Piece, json=None)

    largest: tuple[Peak, ...] = of(
        "largest amplitudes", "", "peak", note=" of each quantity", record=Peak, default=(), kw_only=True
    )

    limits: tuple[LimitLine, ...] = of(
        "limits",
        "",
        "limit",
        note=" of the quantities, and how the run-up stands against them",
        record=LimitLine,
        default=(),
        kw_only=True,
    )

    def name_at(self, at: str | None = None) -> str:
        """Name of the mesh, bearing or point of an address; without one that of the most loaded mesh, else the first bearing."""
        if at is None:
            at = max(self.peaks(), key=lambda row: row[4])[0] if self.contact_mesh else next(iter(self.bearings), "")
        return at.rpartition(".")[2]

    def amplitude_over_speed(self, at: str, order: str = "") -> np.ndarray:
        """What `amplitudes_of` tells of one order (s,), or, "", of all together: the root of their sum of squares."""
        size = self.amplitudes_of(at)[2]
        return size[self.orders.index(order)] if order else np.sqrt((size**2).sum(axis=0))

    def amplitudes_of(self, at: str | None = None) -> tuple[str, str, np.ndarray]:
        """What a mesh (its most loaded helix), a bearing (all three forces) or a point tells: words, unit, amplitudes (o, s).

        Raises:
            AnalysisError: no such mesh, bearing or point.
        """
        name = self.name_at(at)
        if name in self.contact_mesh:
            force = np.abs(self.mesh_force[:, :, self.contacts_of(name)])
            return f"dynamic force of mesh {name}", "N", force.max(axis=2)
        if name in self.bearings:
            force = self.bearing_force[:, :, self.bearings.index(name)]
            words = f"force of bearing {name} (root of the sum of squares of x, y, z)"
            return words, "N", np.linalg.norm(np.abs(force), axis=2)
        unit = unit_at(self.model, name)
        if name in self.points:
            return f"acceleration at {name}", unit, np.abs(self.acceleration[:, :, self.points.index(name)])
        if name in self.load_points:
            return f"load at {name}", unit, np.abs(self.internal_load[:, :, self.load_points.index(name)])
        known = [*dict.fromkeys(self.contact_mesh), *self.bearings, *self.points, *self.load_points]
        raise AnalysisError(
            f"'{at}' is no mesh, bearing or point of the model: expected one of {', '.join(known) or 'none'}"
        )

    def contacts_of(self, mesh: str) -> list[int]:
        """Numbers of the contacts of a mesh."""
        return [k for k, name in enumerate(self.contact_mesh) if name == mesh]

    def peaks(self) -> list[tuple[str, str, float, float, float]]:
        """Largest dynamic force of each mesh: (mesh, order, rpm, Hz, amplitude in N of its most loaded helix)."""
        rows = []
        for mesh in dict.fromkeys(self.contact_mesh):
            size = np.abs(self.mesh_force[:, :, self.contacts_of(mesh)]).max(axis=2)
            o, s = np.unravel_index(int(np.argmax(size)), size.shape)
            rows.append(
                (mesh, self.orders[o], float(self.speed_rpm[s]), float(self.frequency_hz[o, s]), float(size[o, s]))
            )
        return rows

    def tables(self) -> Iterator[Block]:
        """The orders, the largest amplitude of each quantity, and notes."""
        first, last = self.speed_rpm[[0, -1]]
        at = f"{first:.6g} rpm" if len(self.speeds) == 1 else f"{first:.6g} to {last:.6g} rpm"
        yield Line(f"{self.model.title or 'Model'}: forced response, {self.model.reference_shaft} at {at}")
        rows = []
        for one, other in _rows_of_orders(self.orders):
            ends = dict.fromkeys((one, other))
            rows.append(
                (
                    " to ".join(str(o + 1) for o in ends),
                    " to ".join(self.orders[o] if o == one else self.orders[o].rpartition(" ")[2] for o in ends),
                    " to ".join(f"{self.ratio[o]:.6g}" for o in ends),
                    " to ".join(f"{self.frequency_hz[o, -1]:.2f}" for o in ends),
                )
            )
        heads = ("no", "order", "times input", f"Hz at {abs(last):.6g} rpm")
        yield from ("", grid(rows, *heads, left=2, caption="Orders"), "", self._largest(), "")
        if self.limits:
            yield from (self._limits(), "")
        if self.contact_mesh:
            yield TRANSMISSION_WORDS
        yield "amplitudes are half of peak to peak, each order by itself; forces without their mean"
        if any(peak.axis for peak in self.largest):
            yield "x, y or z: the axis of this amplitude; a picture shows the root of the sum of squares of all three"
        yield f"{counted(len(self.speeds), 'speeds')}, {self.dofs} dofs, {self.cost}; {self.method}"
        yield (
            f"solver error {error_words(self.solver_error)} at {self.checked} points checked; "
            f"on a finer mesh the peaks change by {error_words(self.error_estimate)}"
        )
        yield f"damping ratio added to every elastic mode: {self.damping_ratio:g}"
        for k, name in enumerate(self.casings):
            power = self.radiated_power[:, :, k].sum(axis=0)
            s = int(np.argmax(power))
            if power[s] > 0.0:
                yield (
                    f"casing {name}: equivalent radiated power of all orders {power[s]:.3g} W at most, "
                    f"{10.0 * np.log10(power[s] / 1e-12):.1f} dB, at {self.speed_rpm[s]:.1f} rpm"
                )
        yield from (*self.remarks(), "")

    def _limits(self) -> Table:
        """How each quantity stands against its limit."""
        return table_of(
            self,
            "limits",
            "at",
            Column("order", lambda line: line.order or "all"),
            "ratio",
            Column("dB", lambda line: f"{line.level_db:+.1f}", left=False),
            "reached",
            "allowed",
            Column("unit", lambda line: line.unit.replace("^", "")),
            "worst_rpm",
            "exceeded_rpm",
        )

    def _largest(self) -> Table:
        """The largest amplitude of each quantity, the order, speed and frequency of it, and what is left out of it."""

        def amplitude(peak: Peak, value: float | None, form: str) -> str:
            factor, unit = (1e6, "um") if peak.unit == "m" else (1.0, peak.unit.replace("^", ""))
            return "-" if value is None else f"{factor * value:{form}} {unit}"

        columns: list[Column | str] = [
            Column("", "quantity", lambda quantity: "transm. error" if quantity == "transmission error" else quantity),
            Column(" ", lambda peak: f"{peak.part} {peak.axis}".rstrip()),
            Column("order no", lambda peak: peak.order + 1),
            "speed_rpm",
            "frequency_hz",
            Column("amplitude", lambda peak: amplitude(peak, peak.amplitude, ".4g"), left=False),
        ]
        if any(peak.left_out is not None or peak.teeth_part for peak in self.largest):
            left_out = Column(
                "left out",
                lambda peak: "teeth part" if peak.teeth_part else amplitude(peak, peak.left_out, ".2g"),
                left=False,
            )
            columns.append(left_out)
        return table_of(self, "largest", *columns)


# Reference of a level by its unit: ISO 1683 for forces and accelerations; there is none for the others.
_REFERENCES = {"N": (1e-6, "1 uN"), "m/s^2": (1e-6, "1 um/s^2")}


def unit_at(model: Model, name: str) -> str:
    """Unit of what a mesh, bearing or point of a model tells."""
    point = model.points.get(name)
    if point is None or name in model.meshes or name in model.bearings:
        return "N"
    if point.quantity is not None:
        return point.load_unit
    return "rad/s^2" if point.turns else "m/s^2"


def reference_of(unit: str) -> tuple[float, str]:
    """Reference of a level in dB, and its words."""
    return _REFERENCES.get(unit, (1.0, f"1 {unit}"))


def _rows_of_orders(orders: tuple[str, ...]) -> list[tuple[int, int]]:
    """First and last number of each row of the table of orders: a long run of high orders of one part shares a row."""
    rows: list[tuple[int, int]] = []
    start = 0
    for _, group in groupby(order.rpartition(" ")[0] for order in orders):
        end = start + len(list(group))
        shown = start + _SHOWN if end - start > 2 * _SHOWN else end
        rows += [(o, o) for o in range(start, shown)]
        rows += [(shown, end - 1)] if shown < end else []
        start = end
    return rows
