"""What acts locally beside the teeth's normal contact: rolling bearings, nonlinear elements, tooth friction, unbalances,
torques that vary, and what pulls planets in a run-up.

A law is imported where a model has it, because its import compiles it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rotorgear.elements.gear_mesh import ContactGeometry, sliding_vectors
from rotorgear.errors import AnalysisError
from rotorgear.model.layout.external_loads import ExternalLoad
from rotorgear.model.layout.state import MeshForce
from rotorgear.model.parts.carrier import written_name
from rotorgear.model.parts.fields import DOF_NAMES
from rotorgear.model.parts.load import COMPONENTS
from rotorgear.model.parts.supports import element_law
from rotorgear.quantity import ZERO_CELSIUS
from rotorgear.solvers.time.local_system import Rotation
from rotorgear.system.groups import node_dofs, relative_motion
from rotorgear.system.loads import centrifugal_loads, orbit_loads, varying_load, wrench_load
from rotorgear.system.system import System

if TYPE_CHECKING:
    from rotorgear.forces.law import ForceLaw
    from rotorgear.forces.mesh_contact import MeshContact


# Temperatures in deg C beyond which mineral oil is no liquid, and Vogel's equation no viscosity.
_LIQUID = (-60.0, 200.0)


@dataclass(frozen=True)
class LocalPart:
    """A law and where it acts.

    Attributes:
        part, label: its part of the model and its name; law: what acts.
        columns: (a, k) of its displacements among all dofs.
        rotation: of a mesh contact: (a,) column among all dofs of its transmission error, r_b1 tz_1 + r_b2 tz_2, in m.
        transverse: of a mesh contact: cos(beta_b), approach along the flank normal over that in the transverse plane.
    """

    part: str
    label: str
    law: ForceLaw
    columns: np.ndarray
    rotation: np.ndarray | None = None
    transverse: float = 1.0

    @property
    def is_mesh(self) -> bool:
        """Whether it is the contact of a mesh."""
        return self.rotation is not None


def columns_at(system: System, dofs: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Columns (a, k) among all dofs of vectors (k, d) on some dofs (d,)."""
    found = np.zeros((system.dofs.transform.shape[0], len(rows)))
    np.add.at(found, dofs, rows.T)
    return found


def columns_of_node(system: System, shaft: str, z: float, components: list[int]) -> np.ndarray:
    """Columns (a, k) among all dofs of some of the six displacements of a shaft at z."""
    return columns_at(system, node_dofs(system.nodes.at(shaft, z))[0], np.eye(6)[components])


def _joined(system: System, address: str, law: ForceLaw, components: list[int]) -> LocalPart:
    """A law between a shaft and what its part stands on, along some of the six relative displacements."""
    film = system.state.films.get(address)
    if film is not None:
        law = law.kept_at(*film)  # type: ignore[attr-defined]
    dofs, relative = relative_motion(system.layout, system.nodes, address)
    return LocalPart(address, address.partition(".")[2], law, columns_at(system, dofs, relative[components]))


def element_parts(system: System) -> Iterator[LocalPart]:
    """Yield the general nonlinear elements: displacements of their shaft, against the ground or another shaft."""
    for name, element in system.model.nonlinear_elements.items():
        law = element_law(element, float(system.train.ratio(element.shaft)))
        along = [DOF_NAMES.index(direction) for direction in element.directions]
        yield _joined(system, f"nonlinear_elements.{name}", law, along)


def bearing_parts(system: System) -> Iterator[LocalPart]:
    """Yield the bearings with a force law: rolling elements or an oil film.

    Raises:
        AnalysisError: the oil of a film would flow in as no liquid.
    """
    built_for = -1.0 if (system.model.operating_speed or 0.0) < 0.0 else 1.0
    for name, bearing in system.model.bearings.items():
        if not bearing.has_law:
            continue
        inlet = bearing.film.inlet_temperature if bearing.film is not None else None
        if inlet is not None and not _LIQUID[0] <= inlet - ZERO_CELSIUS <= _LIQUID[1]:
            raise AnalysisError(
                f"bearings.{name}: the oil would flow in at {inlet - ZERO_CELSIUS:.4g} degC, where mineral oil is no liquid "
                f"({_LIQUID[0]:g} to {_LIQUID[1]:g} degC); check inlet_temperature and its unit"
            )
        law = bearing.law(float(system.train.ratio(bearing.shaft)), built_for)
        yield _joined(system, f"bearings.{name}", law, list(range(law.components)))


def without_linear_part(system: System) -> list[LocalPart]:
    """Nonlinear elements, and bearings that have a law alone: in statics their laws hold the shafts, but where the state has a
    spring in their place.
    """
    bearings = system.model.bearings
    alone = [part for part in bearing_parts(system) if bearings[part.label].stiffness is None]
    return [part for part in (*alone, *element_parts(system)) if part.part not in system.state.tangents]


def expansion_stiffness(law: ForceLaw, load: float, speed: float) -> np.ndarray:
    """Diagonal stiffness (k, k) about which solvers may expand a law that names none: at displacements where it carries a load.

    Nothing of a result depends on it, but a motion that only this law holds must not count as free.
    """
    given = law.reference_stiffness()
    if np.any(given):
        return np.asarray(given)
    largest = np.zeros(law.components)
    carries = False
    law = law.rough()
    for sizes in np.split(np.logspace(-8.0, -2.0, 25), 5):  # metres or radians
        places = np.outer([side for size in sizes for side in (size, -size)], np.ones(law.components))
        for about in law.linearised_at(places, speed=speed):
            stiffness = np.diag(about.stiffness)
            if not (np.all(np.isfinite(stiffness)) and np.all(np.isfinite(about.force))):
                continue
            # Beyond the load only what nothing has held so far counts: a wall is stiffer by orders than what carries.
            largest = np.where(carries & (largest > 0.0), largest, np.maximum(largest, stiffness))
            carries = carries or bool(np.abs(about.force).max() >= load)
            if carries and np.all(largest > 0.0):
                return np.diag(largest)
    return np.diag(largest)


def friction_part(
    system: System,
    force: MeshForce,
    geometry: ContactGeometry,
    label: str,
    contact: MeshContact,
    dofs: np.ndarray,
    column: np.ndarray,
) -> Iterator[LocalPart]:
    """Yield the friction of one helix, where the mesh has one."""
    both = system.layout.mesh(force.contact.mesh)
    mesh = both.part
    pair = both.pair
    if not mesh.rubs or pair is None:
        return
    from rotorgear.forces.mesh_friction import MeshFriction

    teeth = both.pinion.geometry
    assert teeth is not None
    # With the gear driving, the contacts run from the end of the path to its start: mirror them.
    sense = 1.0 if force.pinion_drives else -1.0
    ends = sorted((sense * pair.start_of_contact, sense * pair.end_of_contact))
    pinion, gear = (both.turns(gear) for gear in both.gears)
    rolling = 2.0 * teeth.base_radius * np.tan(geometry.pressure_angle) * abs(pinion)
    law = MeshFriction(
        contact=contact,
        base_pitch=2.0 * np.pi * teeth.base_radius / teeth.teeth,
        start=ends[0],
        end=ends[1],
        closing=sense * (pinion - gear),
        coefficient=mesh.friction_coefficient,
        overlap=pair.overlap_ratio,
        viscosity=1e3 * (mesh.lubricant_viscosity or 0.0),
        line_load=force.normal_force / both.width,
        rolling=float(rolling),
    )
    across = columns_at(system, dofs, np.array([[1.0], [sense]]) * sliding_vectors(geometry))
    yield LocalPart(f"meshes.{both.name}", f"{label} friction", law, np.hstack([column, across]))


def unbalance_parts(system: System, rotation: Rotation) -> Iterator[LocalPart]:
    """Yield the unbalances: two components that turn with their shaft, accelerated along their path where its speed changes."""
    if not system.model.unbalances:
        return
    from rotorgear.forces.rotating_force import RotatingForce

    times, accelerations = rotation.accelerations
    for name, item in system.model.unbalances.items():
        place = system.layout.place(f"unbalances.{name}")
        # In the axes of a planet, which go round with its carrier, it turns with what is left of the speed.
        turns = system.layout.turns(item.shaft)
        size = item.magnitude
        if turns and turns != system.train.ratio(item.shaft):
            size *= (system.train.ratio(item.shaft) / turns) ** 2
        law = RotatingForce(
            size,
            turns,
            item.phase,
            2.0,
            plane=True,
            times=times,
            accelerations=accelerations,
        )
        yield LocalPart(f"unbalances.{name}", name, law, columns_of_node(system, *place, [0, 1]))


def load_parts(system: System) -> Iterator[LocalPart]:
    """Yield the loads that vary with time or speed."""
    varying = [(item, load) for item in system.state.applied if (load := varying_load(system, item.name)) is not None]
    if not varying:
        return
    from rotorgear.forces.torque_curve import TorqueCurve

    speed = abs(system.model.operating_speed or 0.0)
    for item, load in varying:
        ratio = float(system.train.ratio(item.shaft))
        law = TorqueCurve(
            item.torque,
            ratio,
            load.speed_power,
            speed * abs(ratio) or 1.0,
            ripple=load.ripple,
            order=load.ripple_order * abs(ratio),
            step=load.step_to,
            step_time=load.step_at,
            step_rise=load.step_duration,
        )
        yield LocalPart(item.name, item.name, law, columns_of_node(system, item.shaft, item.z, [5]))


def external_parts(system: System) -> Iterator[LocalPart]:
    """Yield the forces and moments from outside that vary: each along its own direction in the space of the dofs."""
    if not system.layout.external_loads:
        return
    from rotorgear.forces.rotating_force import RotatingForce
    from rotorgear.forces.tabulated_force import TabulatedForce

    for load in system.layout.external_loads:
        name = load.address.removeprefix("loads.")
        shaft = load.places[0].shaft
        # In axes of its own that go round, beside those of its sisters.
        if system.layout.turns(shaft) != system.train.ratio(shaft):
            yield from _on_planets(system, load)
            continue
        if load.history is None:
            size = float(np.linalg.norm(load.amplitude))
            if size:
                column = wrench_load(system, load, load.amplitude / size)[:, None]
                law = RotatingForce(size, load.order, load.phase, frequency=load.frequency)
                yield LocalPart(load.address, name, law, column)
            continue
        for component, values in zip(load.history.components, load.history.values, strict=True):
            k = COMPONENTS.index(component)
            over_angle = load.history.over == "angle"
            table = TabulatedForce(load.history.places, values, over_angle, load.ratio, float(load.history.mean[k]))
            column = wrench_load(system, load, load.frame.own(np.eye(6)[k]))[:, None]
            yield LocalPart(load.address, f"{name} {component}", table, column)


def _on_planets(system: System, load: ExternalLoad) -> Iterator[LocalPart]:
    """A load on a planet whose carrier turns: each component in its own axes that varies on one of its sisters.

    What turns with sisters has the same component of each of them.
    """
    from rotorgear.forces.rotating_force import RotatingForce
    from rotorgear.forces.tabulated_force import TabulatedForce

    def own(one: ExternalLoad) -> np.ndarray:
        """Amplitude (6, 1), or mean and values (6, 1 + p)."""
        if one.history is None:
            return one.amplitude[:, None]
        values = np.zeros((6, 1 + len(one.history.places)))
        rows = [COMPONENTS.index(component) for component in one.history.components]
        values[:, 0] = one.history.mean
        values[rows, 1:] = one.history.values
        return one.frame.own(values.T).T

    alike = [one for one in system.layout.external_loads if written_name(one.address) == written_name(load.address)]
    varies = np.any([np.any(own(one) != 0.0, axis=1) for one in alike], axis=0)
    for k in np.flatnonzero(varies):
        first, *rest = own(load)[k].tolist()
        law: RotatingForce | TabulatedForce
        if load.history is None:
            law = RotatingForce(first, load.order, load.phase, frequency=load.frequency)
        else:
            law = TabulatedForce(load.history.places, tuple(rest), load.history.over == "angle", load.ratio, first)
        column = wrench_load(system, load, np.eye(6)[k])[:, None]
        yield LocalPart(load.address, f"{load.address.removeprefix('loads.')} {COMPONENTS[k]}", law, column)


# Intervals of all tables of the square of the speed over time, which is linear in between: off by the square of their share.
_INTERVALS = 1000


def run_up_parts(system: System, rotation: Rotation) -> tuple[LocalPart, LocalPart]:
    """The centrifugal load of the planets of all carriers, and what their orbits need to be accelerated, over time."""
    from rotorgear.forces.tabulated_force import TabulatedForce

    each = max(1, _INTERVALS // max(rotation.times.size - 1, 1))
    parts = (
        np.linspace(a, b, each, endpoint=False) for a, b in zip(rotation.times[:-1], rotation.times[1:], strict=True)
    )
    times = np.concatenate([*parts, rotation.times[-1:]])
    squares = rotation.speed(times) ** 2
    begins, steps = (np.array(values) for values in rotation.accelerations)
    # Both sides of each change of the acceleration.
    sides = np.column_stack([np.nextafter(begins, -np.inf), begins]).ravel()
    accelerations = np.column_stack([np.append(0.0, steps[:-1]), steps]).ravel()
    at_start = (float(np.interp(0.0, times, squares)), rotation.acceleration(0.0))
    found = []
    for label, column, table, mean in (
        ("centrifugal load of planets", centrifugal_loads(system, 1.0), (times, squares), at_start[0]),
        ("acceleration of planets", orbit_loads(system), (sides, accelerations), at_start[1]),
    ):
        places, values = (tuple(one.tolist()) for one in table)
        law = TabulatedForce(places, values, average=mean)
        found.append(LocalPart("carriers", label, law, column[:, None]))
    return found[0], found[1]
