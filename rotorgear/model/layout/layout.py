"""The layout of a model: everything that follows from it before any load flows, each fact derived once.

A fact is derived when it is first asked for. So checks ask the same objects as the analyses do, for as much as the sound
parts of a broken file allow.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

from rotorgear.errors import Problem
from rotorgear.gears.geometry.blank import RigidBody, hollow_cylinder
from rotorgear.model.layout.assembly import Assembly, put_together
from rotorgear.model.layout.carriers import PlanetSet, planet_sets
from rotorgear.model.layout.casings import BearingSeat, find_seat, reduced
from rotorgear.model.layout.external_loads import ExternalLoad, external_loads
from rotorgear.model.layout.gear_layout import GearLayout, given_body, inertia_is_given
from rotorgear.model.layout.mesh_layout import MeshLayout
from rotorgear.model.layout.train import Train
from rotorgear.model.layout.walk import walk
from rotorgear.model.parts.carrier import MARK
from rotorgear.model.parts.load import Load
from rotorgear.model.parts.shaft import Place
from rotorgear.model.parts.tables import Tables

# Pitches by which a loop may miss: beyond, the tips of teeth meet tips.
MOST_MISSED = 0.25
# Of rigid couplings in the torque flow, N m/rad: far above those of steel, and far below what numbers can hold.
STIFF_IN_TORSION = 1e10

if TYPE_CHECKING:
    import numpy as np

    from rotorgear.casings.reduced_body import ReducedBody
    from rotorgear.casings.wheel import ReducedWheel
    from rotorgear.gears.tooth_fe.blank_section import BlankTorsion


class Layout:
    """What follows from the parts of a model alone. What depends on loads is a `State`.

    Attributes:
        model: the parts; those that the layout is asked for must be in order.
    """

    def __init__(self, model: Tables) -> None:
        self.model = model
        self._gears: dict[str, GearLayout] = {}
        self._meshes: dict[str, MeshLayout] = {}
        self._casings: dict[str, ReducedBody] = {}

    # Derived values are cheaper to derive again than to carry to another process.
    def __reduce__(self) -> tuple[Callable[[Tables], Layout], tuple[Tables]]:
        return Layout, (self.model,)

    def gear(self, name: str) -> GearLayout:
        """A gear on its shaft."""
        if name not in self._gears:
            self._gears[name] = GearLayout(self.model, name)
        return self._gears[name]

    def mesh(self, name: str) -> MeshLayout:
        """Two gears in mesh."""
        if name not in self._meshes:
            part = self.model.meshes[name]
            pair = self.gear(part.pinion), self.gear(part.gear)
            self._meshes[name] = MeshLayout(name, part, *pair, partial(getattr, self, "train"))
        return self._meshes[name]

    @cached_property
    def elastic_bodies(self) -> dict[str, ReducedWheel]:
        """The bodies of all gears that have a mesh."""
        found = {gear.name: gear.wheel for gear in self.gears if gear.wheel is not None}
        for mesh in self.meshes if found else ():
            mesh.check_rims()
        return found

    def casing(self, name: str) -> ReducedBody:
        """The reduced body of a casing, made once and kept; whoever is `listening` hears of its progress.

        Raises:
            AnalysisError: what is wrong with its mesh or its matrices.
            MissingExtraError: meshio or scikit-fem is not installed.
        """
        if name not in self._casings:
            self._casings[name] = reduced(self.model, name)
        return self._casings[name]

    def seat(self, address: str) -> BearingSeat | None:
        """The seat that a bearing or nonlinear element stands in; None where it stands on the ground.

        Raises:
            AnalysisError: the casing has no such seat, or the shaft does not run through it.
        """
        return find_seat(self.model, address, self.place(address), self.casing)

    @property
    def seats(self) -> Iterator[tuple[str, BearingSeat]]:
        """Address and seat of each bearing and nonlinear element that stands in one; errors as of `seat`."""
        for address, _ in self.model.parts_of("bearings", "nonlinear_elements"):
            if (seat := self.seat(address)) is not None:
                yield address, seat

    @cached_property
    def ring_seats(self) -> dict[str, BearingSeat]:
        """Seats of the rings that stand in casings, by the name of the gear; errors as of `seat`."""
        found = {name: self.seat(f"gears.{name}") for name, gear in self.model.gears.items() if gear.casing is not None}
        return {name: seat for name, seat in found.items() if seat is not None}

    @property
    def gears(self) -> Iterator[GearLayout]:
        """All gears in the order of the file."""
        return (self.gear(name) for name in self.model.gears)

    @property
    def meshes(self) -> Iterator[MeshLayout]:
        """All meshes in the order of the file."""
        return (self.mesh(name) for name in self.model.meshes)

    @cached_property
    def _walked(self) -> tuple[Train, list[Problem]]:
        return walk(self.model)

    @property
    def train(self) -> Train:
        """Speed and sense of every shaft."""
        return self._walked[0]

    @property
    def train_problems(self) -> list[Problem]:
        """Loops with two ratios, and given speed ratios that contradict the train."""
        return self._walked[1]

    @property
    def direction(self) -> int:
        """+1 or -1: sense in which the reference shaft turns at the operating speed; +1 where the file gives none."""
        speed = self.model.operating_speed
        return -1 if speed is not None and speed < 0.0 else 1

    @cached_property
    def assembly(self) -> Assembly:
        """Angles of all gears, and how loops close."""
        rigid = [(c.from_shaft, c.to_shaft) for c in self.model.couplings.values() if c.turns_both]
        clocking = {name: gear.clocking for name, gear in self.model.gears.items() if gear.clocking is not None}
        return put_together(self.train, self.meshes, rigid, clocking)

    @cached_property
    def planets(self) -> tuple[PlanetSet, ...]:
        """The planets of all carriers."""
        return planet_sets(self.model) if self.model.carriers else ()

    @cached_property
    def clocking_gaps(self) -> dict[str, float]:
        """Mesh that closes a loop which the clockings of the file miss -> by how far its pinion's teeth stand behind, about +z.

        In m along the flank normal. A loop that misses by more than a quarter of a pitch can't be put together, and is not here.
        """
        return {
            name: rest * self.mesh(name).base_pitch
            for name, closing, rest in self.assembly.loops
            if not closing and rest and abs(rest) <= MOST_MISSED
        }

    def turns(self, shaft: str) -> float:
        """Speed of a shaft over that of the reference shaft in its own axes: those of a planet go round with its carrier."""
        carrier = self.model.shafts[shaft].carrier
        if carrier is None:
            return self.train.ratio(shaft)
        return float(self.train.ratios[shaft] - self.train.ratios[self.model.carriers[carrier].shaft])

    def mesh_frequency(self, mesh: str, speed: float) -> float | None:
        """Mesh frequency in Hz at a speed of the reference shaft in rad/s; None where no teeth are given."""
        pinion = self.mesh(mesh).pinion
        if pinion.part.teeth is None:
            return None
        return abs(self.mesh(mesh).turns(pinion) * speed) * pinion.part.teeth / (2.0 * math.pi)

    def places(self, address: str) -> tuple[Place, ...]:
        """Where a part stands, such as "bearings.left": both ends of a coupling, both nodes of a herringbone gear, else one.

        A force on a gear is where the gear has its nodes. A torque without a place is at the start of its shaft if it is an
        input, else at the end. A point on another part is where that part's first node is.
        """
        table, _, name = address.partition(".")
        part: Any = getattr(self.model, table)[name]
        if table == "gears":
            return self.gear(name).places
        if table == "couplings":
            return self.at(part.from_shaft, part.from_at), self.at(part.to_shaft, part.to_at)
        if table == "nonlinear_elements" and part.to_shaft is not None:
            to_at = part.at if part.to_at is None else part.to_at
            return self.at(part.shaft, part.at), self.at(part.to_shaft, to_at)
        if table == "loads" and part.gear is not None:
            return self.gear(part.gear).places
        if table == "loads" and part.point is not None:
            return self.places(f"points.{part.point}")[:1]
        if table == "loads":
            return (self.load_place(part),)
        if table == "points" and part.on_casing is not None:
            return ()
        if table == "points" and part.on is not None:
            return self.places(part.on)[:1]
        return (self.at(part.shaft, part.at),)

    def place(self, address: str) -> Place:
        """The (first) place of a part."""
        return self.places(address)[0]

    def at(self, shaft: str, at: float | str) -> Place:
        """A place on a shaft: z in m, or "start" or "end"."""
        return Place(shaft, self.model.shafts[shaft].station(at))

    def load_place(self, load: Load) -> Place:
        """Where a torque acts."""
        end = "start" if load.kind == "input" else "end"
        return self.at(load.on_shaft, end if load.at is None else load.at)

    def carrier_place(self, mesh: str) -> Place | None:
        """Where the pins of the carrier are held that a mesh goes round with; None of one that stands still."""
        gears = self.mesh(mesh).gears
        carrier = next((name for gear in gears if (name := gear.shaft_part.carrier) is not None), None)
        if carrier is None:
            return None
        part = self.model.carriers[carrier]
        return self.at(part.shaft, part.at)

    def pin_error(self, shaft: str) -> tuple[float, float] | None:
        """How far the pin of a planet's shaft is off its place, onwards and outwards (m); None where it is not."""
        carrier = self.model.shafts[shaft].carrier
        errors = () if carrier is None else self.model.carriers[carrier].pin_errors
        return errors[int(shaft.partition(MARK)[2]) - 1] if errors else None

    def carrier_pin(self, bearing: str) -> tuple[Place, np.ndarray] | None:
        """Where a planet's bearing is held: the carrier's node, and the arm (3,) in m from it along the carrier's axes."""
        place = self.place(bearing)
        planet = self.model.shafts[place.shaft]
        if planet.carrier is None:
            return None
        part = self.model.carriers[planet.carrier]
        held = self.at(part.shaft, part.at)
        arm = self.model.shafts[part.shaft].frame.inside(planet.frame.at(place.z)) - [0.0, 0.0, held.z]
        return held, arm

    def disk_body(self, name: str) -> RigidBody:
        """Mass and inertias of a disk, given or of a plain cylinder.

        Raises:
            ValueError: the sizes make no disk; the text is what was expected.
        """
        disk = self.model.disks[name]
        if inertia_is_given(disk):
            return given_body(disk)
        place = self.place(f"disks.{name}")
        bore = self.model.shafts[place.shaft].diameter_at(place.z) if disk.bore is None else disk.bore
        density = self.model.material_of(disk.shaft, name=disk.material).density
        return hollow_cylinder(disk.outer_diameter or 0.0, bore, disk.width or 0.0, density)

    @cached_property
    def elastic_gears(self) -> dict[str, BlankTorsion]:
        """Gears whose teeth turn against their shaft: those whose mesh stiffness leaves their wind-up to the rotor model."""
        return {gear.name: gear.torsion for mesh in self.meshes for gear in mesh.elastic_gears}

    @cached_property
    def teeth_on_bodies(self) -> dict[tuple[str, Place], float]:
        """Stiffness (N m/rad) of teeth against the node of their gear, by gear and place: of its web, or its body from a mesh."""
        found = {
            (name, place): 1.0 / torsion.flexibility
            for name, torsion in self.elastic_gears.items()
            for place in self.gear(name).places
        }
        for name, wheel in self.elastic_bodies.items():
            found[name, self.place(f"gears.{name}")] = 1.0 / float(wheel.rim_flexibility[5, 5])
        return found

    @cached_property
    def turning_couplings(self) -> tuple[tuple[Place, Place, float], ...]:
        """Ends and torsional stiffness (N m/rad) of the couplings that make both shafts turn at one speed.

        Of rigid ones one that is stiff beside all others, by which the torque flow finds the flanks.
        """
        return tuple(
            (
                self.at(c.from_shaft, c.from_at),
                self.at(c.to_shaft, c.to_at),
                min(c.torsional_stiffness, STIFF_IN_TORSION),
            )
            for c in self.model.couplings.values()
            if c.turns_both
        )

    @cached_property
    def external_loads(self) -> tuple[ExternalLoad, ...]:
        """Forces and moments from outside."""
        return external_loads(self.model, self.train, self.places)

    @property
    def loaded_from_outside(self) -> bool:
        """Whether a constant force or moment acts from outside."""
        return any(load.constant.any() for load in self.external_loads)

    @cached_property
    def bodies(self) -> tuple[tuple[str, Place, RigidBody], ...]:
        """Address, place and rigid body of all gears, disks and point masses, one for each node; gears with a mesh are none."""
        found = [body for gear in self.gears if gear.part.body.mesh is None for body in gear.node_bodies]
        others = {f"disks.{name}": self.disk_body(name) for name in self.model.disks}
        for name, point in self.model.point_masses.items():
            others[f"point_masses.{name}"] = RigidBody(point.mass, 0.0, 0.0)
        found += [(address, self.place(address), body) for address, body in others.items()]
        return tuple(found)
