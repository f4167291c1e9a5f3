"""Element groups: the matrices of each part of a model with the global numbers of their degrees of freedom."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import groupby
from operator import attrgetter

import numpy as np

from rotorgear.elements.bodies import elastic_body, elastic_gear, gear_body, rigid_body
from rotorgear.elements.gear_mesh import (
    ContactGeometry,
    Face,
    equivalent_mass_general,
    equivalent_mass_torsion,
    gear_mesh,
)
from rotorgear.elements.matrices import ElementMatrices
from rotorgear.elements.shaft import shaft_elements, strain_motions
from rotorgear.elements.shaft_bubbles import bubble_motions
from rotorgear.elements.shaft_section import ShaftElements
from rotorgear.elements.spring import between, rigid_transfer, spring
from rotorgear.errors import AnalysisError
from rotorgear.model.layout.layout import Layout
from rotorgear.model.layout.spring import matrix_rows
from rotorgear.model.layout.state import MeshForce, State, contact_geometry
from rotorgear.model.parts.tables import Tables
from rotorgear.system.nodes import CASING, Element, Nodes

# Motion of the six dofs of a node.
_NODE_MOTIONS = ("bending", "bending", "axial", "bending", "bending", "torsion")


@lru_cache(maxsize=64)  # most groups of a model have the dofs of two nodes
def by_motion(motions: tuple[str, ...]) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Which of the d dofs with these motions move in each of them, and which two of them in the same one, (d, d)."""
    names = np.array(motions)
    return {motion: np.flatnonzero(names == motion) for motion in dict.fromkeys(motions)}, names[:, None] == names


@dataclass(frozen=True)
class ElementGroup:
    """Elements of one part.

    Attributes:
        part: address of the part, such as "shafts.input" or "meshes.stage_1".
        shaft: name of the shaft the part belongs to; "" for a mesh or a coupling.
        matrices: of its e elements with d dofs each.
        dofs: numbers among all dofs, those of nodes first, then internal ones, shape (e, d).
        spin: speed of its shaft over the reference speed.
        strain_motions: the motion each strain belongs to; empty for springs and meshes.
        body_motions: the motion of each dof of an elastic gear body behind those of its node.
    """

    part: str
    shaft: str
    matrices: ElementMatrices
    dofs: np.ndarray
    spin: float = 0.0
    strain_motions: tuple[str, ...] = ()
    body_motions: tuple[str, ...] = ()

    def at(self, speed: float) -> ElementGroup:
        """The group at a reference speed in rad/s: with the stiffness that its rotation brings."""
        m = self.matrices
        if m.modulus_per_square is None or m.modulus is None or not self.spin * speed:
            return self
        return replace(self, matrices=replace(m, modulus=m.modulus + (self.spin * speed) ** 2 * m.modulus_per_square))

    def turning_at(self, speed: float) -> ElementGroup:
        """The group at a reference speed in rad/s, its circulation that of this speed."""
        m = self.matrices
        if m.circulation_per_speed is None or not self.spin * speed:
            return self
        turning = self.spin * speed * m.circulation_per_speed
        Z = turning if m.circulation is None else m.circulation + turning
        return replace(self, matrices=replace(m, circulation=Z, circulation_per_speed=None))

    @property
    def stiffness_per_square(self) -> np.ndarray | None:
        """What the stiffness (e, d, d) grows by with the square of the reference speed; None where it does not."""
        K = self.matrices.carried(self.matrices.modulus_per_square)
        return None if K is None else self.spin**2 * K

    def circulatory_at(self, speed: float) -> np.ndarray | None:
        """Non-symmetric stiffness (e, d, d) at a reference speed in rad/s; None where there is none."""
        plain = self.matrices.circulatory
        turning = self.matrices.circulatory_per_speed
        if turning is None or not self.spin * speed:
            return plain
        return self.spin * speed * turning if plain is None else plain + self.spin * speed * turning

    @property
    def dof_motions(self) -> tuple[str, ...]:
        """The motion of each of the d dofs."""
        d = self.dofs.shape[1]
        if self.part.startswith("casings."):
            return (CASING,) * d
        if self.body_motions:
            return (*_NODE_MOTIONS, *self.body_motions)
        internal = self.strain_motions[6:] if d > 12 else ()
        return _NODE_MOTIONS * ((d - len(internal)) // 6) + internal


def node_dofs(*nodes: int) -> np.ndarray:
    """Numbers of the dofs of some nodes, six each, as one row (1, d)."""
    return np.concatenate([6 * node + np.arange(6) for node in nodes])[None]


def constant_groups(state: State, nodes: Nodes) -> list[ElementGroup]:
    """Groups that do not depend on speed, except through gyroscopic and circulatory terms in proportion to it."""
    layout = state.layout
    model = layout.model
    found = [group for name in model.shafts for group in _shaft(layout, nodes, name)]
    for address, place, b in layout.bodies:
        name = address.removeprefix("gears.")
        dofs = node_dofs(nodes.at(*place))
        if name in layout.elastic_gears:
            torsion = layout.elastic_gears[name]
            polar = b.polar_inertia * torsion.polar_share
            matrices = elastic_gear(b.mass, polar, b.diametral_inertia, 1.0 / torsion.flexibility)
            dofs = np.hstack([dofs, nodes.of_gear(name, *place)[None]])
        else:
            matrices = rigid_body(b.mass, b.polar_inertia, b.diametral_inertia)
        found.append(ElementGroup(address, place.shaft, matrices, dofs, layout.train.ratio(place.shaft)))
    for name, wheel in layout.elastic_bodies.items():
        place = layout.place(f"gears.{name}")
        own = nodes.of_body(name)
        dofs = np.hstack([node_dofs(nodes.at(*place)), own[None]])
        motions = tuple(nodes.internal[k - 6 * len(nodes)] for k in own)
        ratio = layout.train.ratio(place.shaft)
        found.append(ElementGroup(f"gears.{name}", place.shaft, gear_body(wheel), dofs, ratio, body_motions=motions))
    for force in state.forces:
        c = force.contact
        geometry = contact_geometry(force)
        face = face_of(layout, force) if force.face else None
        matrices = gear_mesh(geometry, c.stiffness, mesh_damping(layout, force, geometry), face)
        found.append(ElementGroup(f"meshes.{c.mesh}", "", matrices, mesh_dofs(layout, nodes, force)))
    for name in model.casings:
        casing = layout.casing(name)
        try:
            matrices = elastic_body(casing.stiffness, casing.mass, casing.damping, casing.seat_motions)
        except ValueError as error:
            raise AnalysisError(f"casings.{name}: {error}") from None
        found.append(ElementGroup(f"casings.{name}", "", matrices, nodes.of_casing(name)[None]))
    for table in ("bearings", "supports", "nonlinear_elements", "couplings"):
        for name, part in getattr(model, table).items():
            pedestal = part.pedestal if table == "bearings" else None
            if pedestal is not None:
                dofs = node_dofs(nodes.of_pedestal(name))
                matrices = spring(np.eye(6), matrix_rows(pedestal.stiffness), matrix_rows(pedestal.damping))
                found.append(ElementGroup(f"{table}.{name}.pedestal", part.shaft, matrices, dofs))
                if pedestal.mass:
                    weight = rigid_body(pedestal.mass, 0.0, 0.0)
                    found.append(ElementGroup(f"{table}.{name}.pedestal", part.shaft, weight, dofs))
            held = state.springs[f"{table}.{name}"]
            if not held.varies:
                found.append(_spring_group(layout, nodes, f"{table}.{name}", held.stiffness[0], held.damping[0]))
    return found


def table_groups(state: State, nodes: Nodes, speed: float) -> list[ElementGroup]:
    """Bearings and nonlinear elements that vary over the speed of their shaft, at a speed of the reference shaft in rad/s.

    Raises:
        AnalysisError: the speed of a bearing's shaft lies outside its table.
    """
    varying = [address for address, held in state.springs.items() if held.varies]
    return [_spring_group(state.layout, nodes, address, *state.spring_at(address, speed)) for address in varying]


def _spring_group(
    layout: Layout, nodes: Nodes, address: str, stiffness: np.ndarray, damping: np.ndarray
) -> ElementGroup:
    """What linear analyses take of a bearing, support, coupling or nonlinear element."""
    table, _, name = address.partition(".")
    part = getattr(layout.model, table)[name]
    shaft = "" if table == "couplings" or getattr(part, "to_shaft", None) else part.shaft
    dofs, relative = relative_motion(layout, nodes, address)
    return ElementGroup(address, shaft, spring(relative, stiffness, damping), dofs[None])


def relative_motion(layout: Layout, nodes: Nodes, address: str) -> tuple[np.ndarray, np.ndarray]:
    """Dofs (d,) that a bearing, support, coupling or nonlinear element joins, and its six relative displacements, (6, d).

    They are those of its shaft against what it stands on, in the frame of its shaft (of the first one of a coupling): the
    ground, a seat in a casing, a pedestal or another shaft.
    """
    table, _, name = address.partition(".")
    first, *other = layout.places(address)
    frame = layout.model.shafts[first.shaft].frame
    dofs = node_dofs(nodes.at(*first))[0]
    if table == "couplings":
        mate = frame.sees(layout.model.shafts[other[0].shaft].frame)
        points = [np.array([0.0, 0.0, first.z]), np.array([0.0, 0.0, other[0].z + mate.origin[2]])]
        relative = between(*points)
        relative[:, 6:] = relative[:, 6:] @ mate.six
        return np.concatenate([dofs, node_dofs(nodes.at(*other[0]))[0]]), relative
    pins = layout.carrier_pin(address) if table == "bearings" else None
    if pins is not None:
        # Of a planet's bearing, the carrier carries its end of it rigidly.
        place, arm = pins
        seen = layout.model.shafts[place.shaft].frame.sees(frame)
        carried = seen.six.T @ rigid_transfer(arm)
        return np.concatenate([node_dofs(nodes.at(*place))[0], dofs]), np.hstack([-carried, np.eye(6)])
    seat = layout.seat(address) if table in ("bearings", "nonlinear_elements") else None
    if seat is not None:
        casing, number, arm = seat
        # A casing moves along the axes of the model.
        carried = frame.six.T @ rigid_transfer(arm)
        return np.concatenate([nodes.of_seat(casing, number), dofs]), np.hstack([-carried, np.eye(6)])
    pedestal = layout.model.bearings[name].pedestal if table == "bearings" else None
    if pedestal is None and not other:
        return dofs, np.eye(6)
    # A law knows relative displacements of two nodes, whatever lies between them.
    ground = node_dofs(nodes.of_pedestal(name) if pedestal is not None else nodes.at(*other[0]))[0]
    moved = frame.sees(layout.model.shafts[other[0].shaft].frame).six if other else np.eye(6)
    return np.concatenate([ground, dofs]), np.hstack([-moved, np.eye(6)])


def _shaft(layout: Layout, nodes: Nodes, name: str) -> Iterator[ElementGroup]:
    model = layout.model
    shaft = model.shafts[name]
    ratio = layout.train.ratio(name)
    for rigid, order, elements, dofs in alike(model, nodes, name):
        data = element_data(model, name, elements)
        damping = 0.0 if rigid else shaft.internal_damping
        lumped = shaft.mass_matrix == "lumped"
        matrices = shaft_elements(data, order=order, lumped=lumped, internal_damping=damping)
        if rigid:  # it has mass, but nothing in it can strain
            matrices = ElementMatrices(mass=matrices.mass, gyroscopic=matrices.gyroscopic)
        motions = () if rigid else strain_motions(order, shaft.shear_deformation)
        yield ElementGroup(f"shafts.{name}", name, matrices, dofs, ratio, motions)


def alike(model: Tables, nodes: Nodes, shaft: str) -> Iterator[tuple[bool, int, list[Element], np.ndarray]]:
    """Yield (rigid, order, elements, dofs) for the elements of a shaft that share the first two.

    The dofs (e, d) are those of the left node, of the right node, and internal ones.
    """
    part = model.shafts[shaft]
    found: dict[tuple[bool, int], list[Element]] = {}
    for (section, order), run in groupby(nodes.elements[shaft], key=attrgetter("section", "order")):
        found.setdefault((part.sections[section].rigid, order), []).extend(run)
    for (rigid, order), elements in found.items():
        left, right, internal = np.array([(e.left, e.right, e.internal) for e in elements]).T[:, :, None]
        k = np.arange(6)
        inside = np.arange(len(bubble_motions(order, part.shear_deformation)))
        yield rigid, order, elements, np.hstack([6 * left + k, 6 * right + k, 6 * len(nodes) + internal + inside])


def element_data(model: Tables, name: str, elements: list[Element]) -> ShaftElements:
    """Sizes and material of some elements of a shaft."""
    shaft = model.shafts[name]
    table = []
    for section in shaft.sections:
        material = model.material_of(name, section)
        kappa = np.nan if section.shear_coefficient is None else section.shear_coefficient
        kappa = kappa if shaft.shear_deformation else np.inf
        table.append([material.youngs_modulus, material.g, material.nu, material.density, kappa])
    number = np.array([e.section for e in elements])
    E, G, nu, rho, kappas = np.array(table)[number].T
    length, start, stop = np.array([(e.length, e.start, e.stop) for e in elements]).T

    def ends(diameters: list[tuple[float, float, float, float]]) -> np.ndarray:
        whole = np.array(diameters)[number]
        left = whole[:, :2]
        return np.hstack([left + (whole[:, 2:] - left) * at[:, None] for at in (start, stop)])

    stiffness = ends([s.stiffness_diameters() for s in shaft.sections])
    mass = ends([s.mass_diameters() for s in shaft.sections])
    return ShaftElements(length, stiffness, mass, E, G, nu, rho, kappas)


def face_of(layout: Layout, force: MeshForce) -> Face:
    """How one contact carries along its face; one without a face of its own in the middle of it and without tilt stiffness."""
    mesh = layout.mesh(force.contact.mesh)
    ends = mesh.face(force.contact.helix)
    face = force.face
    if face is None:
        return Face(0.0, 0.0)
    if ends is None:
        return Face(face.place, face.tilt_stiffness)
    integral = (mesh.pinion.part.integral, mesh.gear.part.integral)
    return Face(face.place, face.tilt_stiffness, ends[1] - ends[0], integral)


def mesh_dofs(layout: Layout, nodes: Nodes, force: MeshForce) -> np.ndarray:
    """Numbers (1, d) of the dofs of one contact: of the teeth of both gears, and of the ends of faces cut on their shaft."""
    c = force.contact
    dofs = [
        nodes.of_teeth((c.mesh, c.helix), c.pinion, *c.pinion_place),
        nodes.of_teeth((c.mesh, c.helix), c.gear, *c.gear_place),
    ]
    mesh = layout.mesh(c.mesh)
    if force.face is not None:
        integral = (gear for gear in mesh.gears if gear.part.integral)
        ends = ((gear.shaft, z) for gear in integral for z in mesh.own_face(gear, c.helix) or ())
        dofs += [node_dofs(nodes.at(*end))[0] for end in ends]
    return np.concatenate(dofs)[None]


def mesh_damping(layout: Layout, force: MeshForce, geometry: ContactGeometry) -> float:
    """Damping coefficient of one helix in N s/m: given, or from the ratio and the inertia of that helix' share of the gears."""
    both = layout.mesh(force.contact.mesh)
    mesh = both.part
    if mesh.damping is not None:
        return mesh.damping / both.helices
    if mesh.damping_ratio == 0.0:
        return 0.0
    inertia = ("mass", "mass", "mass", "diametral_inertia", "diametral_inertia", "polar_inertia")
    first, second = (
        np.array([sum(getattr(body, name) for _, _, body in gear.node_bodies) / both.helices for name in inertia])
        for gear in both.gears
    )
    if mesh.equivalent_mass == "general":
        equivalent = equivalent_mass_general(geometry, first, second)
    else:
        radii = (geometry.pinion_base_radius, geometry.gear_base_radius)
        equivalent = equivalent_mass_torsion(first[5], second[5], *radii)
    return 2.0 * mesh.damping_ratio * float(np.sqrt(force.contact.stiffness * equivalent))
