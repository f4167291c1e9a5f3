"""Forces that follow from displacements: of meshes on gears, of bearings and supports on shafts."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rotorgear.analysis.static.solve import Equilibrated
from rotorgear.elements.spring import rigid_transfer
from rotorgear.model.layout.casings import BearingSeat
from rotorgear.model.parts.fields import DOF_NAMES
from rotorgear.system.groups import ElementGroup

# What a dof is met by: forces at x y z, moments at the rotations, and neither at inner coordinates of casings and gear bodies.
_FORCE = 0
_MOMENT = 1
_INNER = 2
_OF_MOTIONS = (_FORCE, _FORCE, _FORCE, _MOMENT, _MOMENT, _MOMENT)


def forces_on_gears(equilibrium: Equilibrated) -> np.ndarray:
    """Force of the pinion on the gear at each contact, (c, 3), in the frame of the gear: the normal force along v."""
    groups = [group for group in equilibrium.system.groups if group.part.startswith("meshes.")]
    rows = []
    for group, force in zip(groups, equilibrium.force, strict=True):
        assert group.matrices.strain is not None
        rows.append(force * -group.matrices.strain[0, 0, 6:9])
    return np.array(rows).reshape(-1, 3)


# Dofs of an element beyond those of shafts, springs and meshes.
_MANY = 40


def inner(group: ElementGroup, q: np.ndarray) -> np.ndarray:
    """Force that an element's own strains put on its dofs, (e, d)."""
    B = group.matrices.strain
    D = group.matrices.modulus
    Z = group.matrices.circulation
    parts = [part for part in (D, Z) if part is not None]
    if B is None or not parts:
        return np.zeros(group.dofs.shape)
    total = sum(parts[1:], parts[0])
    if B.shape[2] > _MANY:  # a product of four at once takes the fourth power of them
        strains = np.einsum("etf,ef->et", B, q[group.dofs])
        return np.asarray(np.einsum("esd,es->ed", B, np.einsum("est,et->es", total, strains)))
    return np.asarray(np.einsum("esd,est,etf,ef->ed", B, total, B, q[group.dofs]))


def bearing_forces(equilibrium: Equilibrated) -> dict[str, np.ndarray]:
    """Force and moment of each bearing on its shaft, (6,), and of each nonlinear element by its address."""
    q = equilibrium.system.dofs.expand(equilibrium.q)
    forces = {
        group.part.removeprefix("bearings."): -inner(group, q)[0, -6:]
        for group in equilibrium.groups
        if group.part.startswith("bearings.") and not group.part.endswith(".pedestal")
    }
    for law in equilibrium.laws:
        node = equilibrium.system.nodes.at(*equilibrium.system.layout.place(law.part.part))
        on_shaft = -law.part.columns[6 * node : 6 * node + 6] @ law.force
        name = law.part.part.removeprefix("bearings.")
        forces[name] = forces.get(name, 0.0) + on_shaft
    kept = equilibrium.system.conditions
    if kept.of_bearings:
        rigid = kept.forces(equilibrium.loads - _of_elements(equilibrium))
        for k in kept.of_bearings:
            forces[kept.parts[k].removeprefix("bearings.")][kept.components[k]] -= rigid[k]
    return forces


def _in_seats(equilibrium: Equilibrated) -> Iterator[tuple[BearingSeat, np.ndarray]]:
    """The seat of each bearing and nonlinear element that is in one, and force and moment (6,) on its shaft in the model."""
    system = equilibrium.system
    forces = bearing_forces(equilibrium)
    for address, seat in system.layout.seats:
        on_shaft = forces.get(address.removeprefix("bearings."))
        if on_shaft is not None:
            frame = system.model.shafts[system.layout.place(address).shaft].frame
            yield seat, frame.six @ on_shaft
    # What is missing for equilibrium at a ring comes from its seat.
    rest = inner_forces(equilibrium) - equilibrium.loads if system.layout.ring_seats else np.zeros(0)
    for name, seat in system.layout.ring_seats.items():
        place = system.layout.place(f"gears.{name}")
        node = system.nodes.at(*place)
        yield seat, system.model.shafts[place.shaft].frame.six @ rest[6 * node : 6 * node + 6]


def casing_forces(equilibrium: Equilibrated) -> dict[str, np.ndarray]:
    """Force and moment about the origin of the model of the ground on each casing, at what is held and at mounts, (6,).

    They are what the bearings put on its seats and its weight leave to balance; a body without known weight has none.
    """
    system = equilibrium.system
    gravity = system.model.operation.gravity if system.model.operation else None
    seated = list(_in_seats(equilibrium))
    found = {}
    for name in system.model.casings:
        body = system.layout.casing(name)
        total = np.zeros(6)
        if gravity:
            if not np.isfinite(body.body_mass):
                continue
            weight = body.body_mass * np.array(gravity)
            total += np.concatenate([weight, np.cross(body.centre, weight)])
        for (casing, number, arm), on_shaft in seated:
            if casing == name:
                place = body.seat_points[number] + arm
                total -= np.concatenate([on_shaft[:3], on_shaft[3:] + np.cross(place, on_shaft[:3])])
        found[name] = -total
    return found


def ground_forces(equilibrium: Equilibrated) -> dict[str, np.ndarray]:
    """The same by held sets and mounts, "box.feet" -> (6,); of casings from meshes."""
    system = equilibrium.system
    gravity = np.array(system.model.operation.gravity or np.zeros(3)) if system.model.operation else np.zeros(3)
    q = system.dofs.expand(equilibrium.q)
    found = {}
    for name in system.model.casings:
        body = system.layout.casing(name)
        if body.ground_force is None or body.ground_weight is None:
            continue
        wrenches = body.ground_force @ q[system.nodes.of_casing(name)] + body.ground_weight @ gravity
        for place, wrench in zip(body.ground_sets, wrenches.reshape(-1, 6), strict=True):
            found[f"{name}.{place}"] = wrench
    return found


def seat_forces(equilibrium: Equilibrated) -> dict[str, np.ndarray]:
    """Force, and moment about its point, of the parts in a seat on the casing: "box.left" -> (6,)."""
    system = equilibrium.system
    found: dict[str, np.ndarray] = {}
    for (casing, number, arm), on_shaft in _in_seats(equilibrium):
        name = f"{casing}.{system.layout.casing(casing).seats[number]}"
        moment = on_shaft[3:] + np.cross(arm, on_shaft[:3])
        found[name] = found.get(name, np.zeros(6)) - np.concatenate([on_shaft[:3], moment])
    return found


def support_forces(equilibrium: Equilibrated) -> dict[str, np.ndarray]:
    """Force and moment of each support on its shaft, (6,): of its springs, and what it holds fixed."""
    system = equilibrium.system
    q = system.dofs.expand(equilibrium.q)
    rest = inner_forces(equilibrium) - equilibrium.loads
    forces = {}
    for group in equilibrium.groups:
        if group.part.startswith("supports."):
            forces[group.part.removeprefix("supports.")] = -inner(group, q)[0, -6:]
    for name, support in system.model.supports.items():
        node = system.nodes.at(*system.layout.place(f"supports.{name}"))
        held = [k for k, dof in enumerate(DOF_NAMES) if dof in support.fixed or "all" in support.fixed]
        if held:
            # What is missing for equilibrium at the node, with that of the nodes which rigid sections tie to it.
            missing = np.zeros(6)
            for other in system.rigid_with(node):
                arm = rigid_transfer(np.array([0.0, 0.0, system.nodes.z[other] - system.nodes.z[node]]))
                missing += arm.T @ rest[6 * other : 6 * other + 6]
            forces[name][held] += missing[held]
    return forces


def element_forces(equilibrium: Equilibrated) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Dofs (e, d) and forces (e, d) on them of the elements of each group, contacts with their gaps closed first, and of laws."""
    q = equilibrium.system.dofs.expand(equilibrium.q)
    closed = equilibrium.closed
    meshes = zip(equilibrium.force[closed], equilibrium.moment[closed], strict=True)
    for group in equilibrium.groups:
        if group.part.startswith("meshes."):
            assert group.matrices.strain is not None
            strains = group.matrices.strain[0]
            yield group.dofs[:1], (np.array(next(meshes))[: len(strains)] @ strains)[None]
        else:
            yield group.dofs, inner(group, q)
    for law in equilibrium.laws:
        yield np.arange(len(q))[None], (law.part.columns @ law.force)[None]


def inner_forces(equilibrium: Equilibrated) -> np.ndarray:
    """Sum of the forces of all elements and rigid members on all dofs, (a,)."""
    total = _of_elements(equilibrium)
    kept = equilibrium.system.conditions
    return total + kept.rows.T @ kept.forces(equilibrium.loads - total)


def rigid_forces(equilibrium: Equilibrated) -> np.ndarray:
    """Force along the flank normal of each contact of a rigid mesh, (m,): below 0 on the flank behind."""
    kept = equilibrium.system.conditions
    return kept.forces(equilibrium.loads - _of_elements(equilibrium))[kept.of_meshes]


def _of_elements(equilibrium: Equilibrated) -> np.ndarray:
    """Sum of the forces of all elements on all dofs, (a,)."""
    total = np.zeros(equilibrium.system.dofs.transform.shape[0])
    for dofs, force in element_forces(equilibrium):
        np.add.at(total, dofs, force)
    return total


def imbalance(equilibrium: Equilibrated) -> float:
    """Largest force that is missing at a free dof, relative to the largest of an element or load; moments, inner coordinates too.

    A moment is small beside the largest moment, or beside the largest force at the size of the model.
    """
    system = equilibrium.system
    T = system.dofs.transform
    missing = -equilibrium.loads
    most = np.abs(equilibrium.loads)
    for dofs, force in element_forces(equilibrium):
        np.add.at(missing, dofs, force)
        np.maximum.at(most, dofs, np.abs(force))
    kind = np.full(len(most), _INNER)
    kind[: 6 * len(system.nodes)] = np.tile(_OF_MOTIONS, len(system.nodes))
    for name in system.model.casings:
        seats = len(system.layout.casing(name).seats)
        kind[system.nodes.of_casing(name)[: 6 * seats]] = np.tile(_OF_MOTIONS, seats)
    sizes = np.array([most[kind == one].max(initial=0.0) for one in (_FORCE, _MOMENT, _INNER)])
    sizes[_MOMENT] = max(sizes[_MOMENT], sizes[_FORCE] * np.ptp(system.positions(), axis=0).max())
    sizes[_INNER] = max(sizes[_INNER], sizes[_FORCE])  # statics mostly leaves them at rest
    beside = sizes[kind[np.asarray(abs(T).argmax(axis=0)).ravel()]]
    return float(np.max(np.abs(T.T @ missing) / np.where(beside > 0.0, beside, 1.0), initial=0.0))
