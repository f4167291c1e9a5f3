"""Static loads of a model over all dofs: applied torques, forces and moments from outside, weight."""

from __future__ import annotations

import numpy as np

from rotorgear.model.layout.external_loads import ExternalLoad
from rotorgear.model.parts.load import Load
from rotorgear.system.planets import turning_carriers
from rotorgear.system.system import System


def varying_load(system: System, name: str) -> Load | None:
    """The load behind an applied torque, where it varies."""
    table, _, own = name.partition(".")
    load = system.model.loads.get(own) if table == "loads" else None
    return load if load is not None and load.varies else None


def outer_loads(system: System, *, steady: bool = False) -> np.ndarray:
    """Applied torques, forces and moments from outside, and weight over all dofs, (a,).

    `steady` leaves out torques that change and loads over time or angle, which act as laws with their whole value. Moments that
    the balance of torques has already are not counted twice.
    """
    f = np.zeros(system.dofs.transform.shape[0])
    outside = np.zeros_like(f)
    histories = {load.address for load in system.layout.external_loads if load.history}
    for item in system.state.applied:
        if not (steady and (item.name in histories or varying_load(system, item.name) is not None)):
            f[6 * system.nodes.at(item.shaft, item.z) + 5] += item.torque
    for load in system.layout.external_loads:
        if not steady or load.history is None:
            outside += wrench_load(system, load, load.constant_on_structure)
    f = f + outside
    operation = system.model.operation
    return f + weight_loads(system, operation.gravity) if operation and operation.gravity else f


def wrench_load(system: System, load: ExternalLoad, wrench: np.ndarray) -> np.ndarray:
    """Force and moment (6,) at the places of a load, in the frame of its shaft and in equal parts, over all dofs (a,)."""
    f = np.zeros(system.dofs.transform.shape[0], wrench.dtype)
    for place in load.places:
        node = system.nodes.at(*place)
        f[6 * node : 6 * node + 6] += wrench / len(load.places)
    return f


def centrifugal_loads(system: System, speed: float) -> np.ndarray:
    """Steady centrifugal load of planets outwards, W^2 r M e, at a reference speed in rad/s, over all dofs (a,)."""
    f = np.zeros(system.dofs.transform.shape[0])
    for planets in turning_carriers(system.layout):
        W = system.train.ratio(planets.shaft) * speed
        for group in system.groups:
            if group.shaft in planets.planets and group.matrices.mass is not None:
                # The motions of an element's nodes come first, six each.
                outwards = (group.dofs % 6 == 0) & (group.dofs < 6 * len(system.nodes))
                load = np.einsum("eij,ej->ei", group.matrices.mass, outwards.astype(float))
                np.add.at(f, group.dofs, W**2 * planets.radius * load)
    return f


def orbit_loads(system: System) -> np.ndarray:
    """What accelerates the orbits of planets for a unit acceleration of the reference, over all dofs (a,).

    -W' r M S e onwards on the planets, and N m r^2 W' on the shaft of their carrier, which turns as it is prescribed to.
    """
    f = np.zeros(system.dofs.transform.shape[0])
    for planets in turning_carriers(system.layout):
        rate = system.train.ratio(planets.shaft)
        node = system.nodes.at(*system.layout.at(planets.shaft, planets.part.at))
        for group in system.groups:
            if group.shaft in planets.planets and group.matrices.mass is not None:
                onwards = (group.dofs % 6 == 1) & (group.dofs < 6 * len(system.nodes))
                load = np.einsum("eij,ej->ei", group.matrices.mass, onwards.astype(float))
                np.add.at(f, group.dofs, -rate * planets.radius * load)
                f[6 * node + 5] += rate * planets.radius**2 * float(np.sum(load[onwards]))
    return f


def weight_loads(system: System, gravity: tuple[float, float, float]) -> np.ndarray:
    """Weight of all parts in a field of gravity in m/s^2, (a,): M times the acceleration, so that it does the right work."""
    f = np.zeros(system.dofs.transform.shape[0])
    moved = weight_accelerations(system, gravity)
    for name in system.model.casings:
        forces = system.layout.casing(name).inertia_force[:, :3] @ np.array(gravity)
        # A body that was reduced elsewhere may come without its weight; results say so.
        f[system.nodes.of_casing(name)] += np.nan_to_num(forces)
    for group in system.groups:
        if group.matrices.mass is not None and not group.part.startswith("casings."):
            np.add.at(f, group.dofs, np.einsum("eij,ej->ei", group.matrices.mass, moved[group.dofs]))
    return f


def weight_accelerations(system: System, gravity: tuple[float, float, float]) -> np.ndarray:
    """A field of gravity in m/s^2 over all dofs, (a,), in the frame of each shaft."""
    moved = np.zeros(system.dofs.transform.shape[0])
    count = 6 * len(system.nodes)
    own = {name: np.array(gravity) @ shaft.frame.axes for name, shaft in system.model.shafts.items()}
    moved[:count].reshape(-1, 6)[:, :3] = [own[shaft] for shaft in system.nodes.shaft]
    return moved
