"""Discretisation: nodes at the ends of sections and at every part, and elements in each piece between them.

Places closer than 1e-9 of the shaft's length are one node.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from rotorgear.elements.shaft_bubbles import bubble_motions
from rotorgear.errors import AnalysisError
from rotorgear.model.layout.layout import Layout
from rotorgear.model.parts.references import ON_SHAFTS
from rotorgear.model.parts.tables import Tables
from rotorgear.system.plan import Plan

MERGE_DISTANCE = 1e-9
MOST_ELEMENTS = 200_000
# What the dofs of a casing are called where those of shafts are called by their motion.
CASING = "casing"
# The same for coordinates of elastic gear bodies with two and more nodal diameters; those with one bend like a shaft.
GEAR_BODY = "gear body"
# Displacements of teeth that follow from the coordinates of a gear body: no dofs of their own.
FOLLOWS = "follows"


@dataclass(frozen=True)
class Element:
    """One shaft element.

    Attributes:
        left, right: its nodes; length in m.
        section: number of its section, and where in that section it begins and ends (0 to 1).
        piece: number of its piece from the left end of the shaft.
        order: polynomial order; internal: number of its first internal dof among those of all elements.
    """

    left: int
    right: int
    length: float
    section: int
    start: float
    stop: float
    piece: int = 0
    order: int = 1
    internal: int = 0


@dataclass
class Nodes:
    """Nodes of a model and the shaft elements between them.

    Attributes:
        shaft: name of the shaft of each node; of a pedestal's node, that of its bearing.
        z: z of each node in m.
        pedestal: name of the bearing whose pedestal a node is, else "".
        elements: shaft -> its elements from left to right.
        internal: the motion of each internal dof: those of the elements in their order, then those of elastic gears, then
            those of casings, whose motion is "casing", then those of gear bodies and of the teeth on them.
        teeth: gear and z of its node -> number of its internal dof, the rotation of teeth that turn against their shaft.
        casings: casing -> number of the first of its internal dofs, and of the first behind them.
        bodies: gear with an elastic body -> the same.
        feet: (mesh, helix) and gear with an elastic body -> number of the first of the six motions of its teeth there.
        merged: sentences about places that became one node.
    """

    shaft: list[str] = field(default_factory=list)
    z: list[float] = field(default_factory=list)
    pedestal: list[str] = field(default_factory=list)
    elements: dict[str, list[Element]] = field(default_factory=dict)
    internal: list[str] = field(default_factory=list)
    teeth: dict[tuple[str, float], int] = field(default_factory=dict)
    casings: dict[str, tuple[int, int]] = field(default_factory=dict)
    bodies: dict[str, tuple[int, int]] = field(default_factory=dict)
    feet: dict[tuple[tuple[str, int], str], int] = field(default_factory=dict)
    merged: list[str] = field(default_factory=list)
    _on_shaft: dict[str, tuple[np.ndarray, np.ndarray]] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.z)

    def at(self, shaft: str, z: float) -> int:
        """Number of the node of a shaft nearest to z."""
        numbers, places = self._on_shaft[shaft]
        return int(numbers[np.argmin(np.abs(places - z))])

    def of_pedestal(self, bearing: str) -> int:
        """Number of the node of a bearing's pedestal."""
        return self.pedestal.index(bearing)

    def of_gear(self, gear: str, shaft: str, z: float) -> np.ndarray:
        """Numbers (6,) of the dofs of a gear's teeth: those of its node, with the teeth's own rotation where they have one."""
        dofs = 6 * self.at(shaft, z) + np.arange(6)
        if (gear, z) in self.teeth:
            dofs[5] = 6 * len(self) + self.teeth[gear, z]
        return dofs

    def of_teeth(self, contact: tuple[str, int], gear: str, shaft: str, z: float) -> np.ndarray:
        """Numbers (6,) of the dofs of a gear's teeth in a contact (mesh, helix): on an elastic body they move by themselves."""
        if (contact, gear) not in self.feet:
            return self.of_gear(gear, shaft, z)
        return 6 * len(self) + self.feet[contact, gear] + np.arange(6)

    def of_body(self, gear: str) -> np.ndarray:
        """Numbers (k,) of the elastic dofs of a gear body."""
        return 6 * len(self) + np.arange(*self.bodies[gear])

    def of_casing(self, casing: str) -> np.ndarray:
        """Numbers (n,) of the dofs of a casing: six a seat, then its other ones."""
        return 6 * len(self) + np.arange(*self.casings[casing])

    def of_seat(self, casing: str, seat: int) -> np.ndarray:
        """Numbers (6,) of the dofs of a seat, counted from 0."""
        return self.of_casing(casing)[6 * seat : 6 * seat + 6]

    def on_shaft(self, shaft: str) -> np.ndarray:
        """Numbers of the nodes of a shaft from left to right."""
        return self._on_shaft[shaft][0]


def places(layout: Layout) -> dict[str, list[tuple[float, str]]]:
    """List (z, what) of all places that need a node, for every shaft."""
    model = layout.model
    found: dict[str, list[tuple[float, str]]] = {}
    for name, shaft in model.shafts.items():
        ends = np.cumsum([shaft.start, *[section.length for section in shaft.sections]])
        found[name] = [(float(ends[0]), "start")]
        found[name] += [(float(z), f"end of section {number}") for number, z in enumerate(ends[1:])]
    for address, part in model.parts_of(*ON_SHAFTS, "couplings", "loads", "unbalances", "points"):
        # Torques without a place stand at an end of their shaft, a point on a part where that part has its node.
        if address.startswith(("loads.", "points.")) and (part.shaft is None or part.at is None):
            continue
        for place in layout.places(address):
            found[place.shaft].append((place.z, address))
    for name, carrier in model.carriers.items():
        found[carrier.shaft].append((layout.at(carrier.shaft, carrier.at).z, f"carriers.{name}"))
    # Teeth that are cut on a shaft tilt with it between the ends of their face.
    for mesh in layout.meshes:
        for gear in mesh.gears if mesh.part.tilt else ():
            for helix in range(mesh.helices if gear.part.integral else 0):
                found[gear.shaft] += [(z, f"meshes.{mesh.name} face") for z in mesh.own_face(gear, helix) or ()]
    return found


def discretise(layout: Layout, plan: Plan) -> Nodes:
    """Return nodes and shaft elements of a model as a plan cuts it.

    Raises:
        AnalysisError: a plan with more elements than a computer of this time can take.
    """
    model = layout.model
    nodes = Nodes()
    for name, wanted in places(layout).items():
        _add_shaft(nodes, model, name, wanted, plan)
    for name, bearing in model.bearings.items():
        if bearing.pedestal is not None:
            place = layout.place(f"bearings.{name}")
            nodes.shaft.append(place.shaft)
            nodes.z.append(place.z)
            nodes.pedestal.append(name)
    for name in layout.elastic_gears:
        for place in layout.gear(name).places:
            nodes.teeth[name, place.z] = len(nodes.internal)
            nodes.internal.append("torsion")
    for name in model.casings:
        first = len(nodes.internal)
        nodes.internal += [CASING] * layout.casing(name).size
        nodes.casings[name] = (first, len(nodes.internal))
    for name, wheel in layout.elastic_bodies.items():
        nodes.bodies[name] = (len(nodes.internal), len(nodes.internal) + wheel.size)
        # Coordinates of a gear body go by the motion of shafts that they take part in.
        twists = np.abs(wheel.rim_motion[5]) * wheel.rim_radius > np.abs(wheel.rim_motion[2])
        for diameters, twist in zip(wheel.diameters, twists, strict=True):
            uniform = "torsion" if twist else "axial"
            nodes.internal.append(uniform if diameters == 0 else "bending" if diameters == 1 else GEAR_BODY)
    for mesh in layout.meshes:
        for contact in mesh.contacts:
            for gear in mesh.gears:
                if gear.name in nodes.bodies:
                    nodes.feet[(mesh.name, contact.helix), gear.name] = len(nodes.internal)
                    nodes.internal += [FOLLOWS] * 6
    return nodes


def _add_shaft(nodes: Nodes, model: Tables, shaft: str, wanted: list[tuple[float, str]], plan: Plan) -> None:
    part = model.shafts[shaft]
    # A shaft without length has one place, whatever z its parts give.
    tolerance = MERGE_DISTANCE * part.length if part.sections else np.inf
    kept: list[tuple[float, str]] = []
    for place, what in sorted(wanted):
        if not kept or place - kept[-1][0] > tolerance:
            kept.append((place, what))
        elif place - kept[-1][0] > 4.0 * np.finfo(float).eps * max(abs(place), part.length):
            nodes.merged.append(
                f"shafts.{shaft}: {what} at {place:.9g} m taken to {kept[-1][1]} at {kept[-1][0]:.9g} m, one node"
            )
    breaks = [place for place, _ in kept]
    ends = np.cumsum([part.start, *[section.length for section in part.sections]])
    z: list[float] = [breaks[0]]
    pieces: list[Element] = []
    first = len(nodes)
    for piece, (left, right) in enumerate(pairwise(breaks)):
        number = int(np.clip(np.searchsorted(ends, 0.5 * (left + right)) - 1, 0, len(part.sections) - 1))
        section = part.sections[number]
        count, order = (1, 1) if section.rigid else plan.of((shaft, piece), section.elements)
        if part.mass_matrix == "lumped":  # it has no orders; more elements serve
            count = count * order
            order = 1
        if len(pieces) + count > MOST_ELEMENTS:
            raise AnalysisError(
                f"shafts.{shaft}: more than {MOST_ELEMENTS} elements on one shaft, got {count} between two places; ask for fewer"
            )
        motions = bubble_motions(order, part.shear_deformation)
        edges = np.linspace(left, right, count + 1)
        # A short section far along the shaft: the difference of its ends has lost digits that its length has.
        slack = 8.0 * np.finfo(float).eps * max(abs(part.start), abs(part.end))
        whole = abs(left - ends[number]) <= slack and abs(right - ends[number + 1]) <= slack
        length = (section.length if whole else right - left) / count
        share = np.clip((edges - ends[number]) / section.length, 0.0, 1.0)
        for k in range(count):
            node = first + len(z) - 1
            within = (float(share[k]), float(share[k + 1]))
            own = {"piece": piece, "order": order, "internal": len(nodes.internal)}
            pieces.append(Element(node, node + 1, length, number, *within, **own))
            nodes.internal += motions
            z.append(float(edges[k + 1]))
    nodes.z += z
    nodes.shaft += [shaft] * len(z)
    nodes.pedestal += [""] * len(z)
    nodes.elements[shaft] = pieces
    nodes._on_shaft[shaft] = (np.arange(first, first + len(z)), np.array(z))
