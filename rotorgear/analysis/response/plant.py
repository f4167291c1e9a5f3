"""A gearbox as a linear plant: its dynamic stiffness at every speed, and what is read off a displacement.

A bearing in a seat has no mass, so that its force on the seat is -(K q + C q') in its rows of the seat; of rings that stand in
seats see `ring_seats`. The ground holds a body by

    f = Ψᵀ (M a + C v + K u)

with static shapes Ψ for unit motions of the ground at one place (`rotorgear.casings`). Damping of modes of the whole
gearbox, D = M V diag(2 ζ ω) Vᵀ M, brakes every point of the casing as accelerations V diag(2 ζ ω) Vᵀ M q' would.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property, partial
from itertools import chain

import numpy as np
import scipy.sparse as sp

from rotorgear.analysis.common.points import motion_points, point_rows
from rotorgear.analysis.common.stations import part_nodes
from rotorgear.analysis.response.order import Order
from rotorgear.analysis.response.ring_seats import RingSeats
from rotorgear.solvers.frequency.harmonic import Dynamics, DynamicsOverSpeed, LowRank
from rotorgear.solvers.sparse.entries import on_one_pattern
from rotorgear.solvers.sparse.factor import Factor
from rotorgear.solvers.sparse.sums import SparseSums
from rotorgear.system.bubble_errors import ForcedChanges
from rotorgear.system.contacts import ContactLines, contact_lines
from rotorgear.system.groups import relative_motion
from rotorgear.system.internal_loads import LoadRows, load_rows, read_loads
from rotorgear.system.rigid_forces import from_loads, on_shafts, rigid_rows
from rotorgear.system.system import System


@dataclass(frozen=True)
class Readings:
    """Amplitudes at one speed; at several of them each array has one axis more in front, (s, o, ...).

    Attributes:
        mesh_force, transmission_error, approach: (o, c), the approach in the middle of the face, transverse.
        pressed: (o, c) approach along the flank normal at the place of the face where the contact has its stiffness.
        bearing_force: (o, b, 3); acceleration: of the named points of a motion, (o, k).
        internal_load: of the points that read a load inside a shaft or coupling, (o, l).
        displacement: x y z tx ty tz at gears, disks and bearings, (o, d, 6).
        normal_velocity: of the casings with a surface, root of the mean of |v_n|^2 over it, (o, k).
        casing_seat_force: on seats of casings, (o, s, 6); casing_ground_force: of the ground on casings, (o, g, 6).
        bubble_change: (o,) size of what polynomials that the shaft elements lack would change, as a change of f^H q.
    """

    mesh_force: np.ndarray
    transmission_error: np.ndarray
    approach: np.ndarray
    pressed: np.ndarray
    bearing_force: np.ndarray
    acceleration: np.ndarray
    internal_load: np.ndarray
    displacement: np.ndarray
    normal_velocity: np.ndarray
    casing_seat_force: np.ndarray
    casing_ground_force: np.ndarray
    bubble_change: np.ndarray

    @property
    def stacked(self) -> np.ndarray:
        """All forces, (o, c + 3 b); where a model has neither mesh nor bearing, the displacements of its parts, (o, 3 d).

        Where it has no part on a shaft either, the accelerations of its points, (o, k).
        """
        orders = self.mesh_force.shape[:-1]
        forces = np.concatenate([self.mesh_force, self.bearing_force.reshape(*orders, -1)], axis=-1)
        if forces.size:
            return forces
        return self.displacement[..., :3].reshape(*orders, -1) if self.displacement.size else self.acceleration

    @property
    def judged(self) -> list[np.ndarray]:
        """What the error of a mesh is looked at in, each by its own largest: forces (o, k), and each internal load (o, 1)."""
        return [self.stacked, *(self.internal_load[..., [k]] for k in range(self.internal_load.shape[-1]))]


# What of the readings is in the result of a response.
READ = tuple(item.name for item in fields(Readings) if item.name not in ("pressed", "bubble_change"))


def gathered(parts: Sequence[Readings], how: Callable[[list[np.ndarray]], np.ndarray] = np.stack) -> Readings:
    """Several readings as one: quantity by quantity, one after the other (s, o, ...), or as `how` puts their arrays together."""
    names = [item.name for item in fields(Readings)]
    return Readings(**{name: how([getattr(part, name) for part in parts]) for name in names})


def force_rows(
    system: System, speed: float, parts: Sequence[Sequence[str]], taken: slice
) -> tuple[np.ndarray, np.ndarray]:
    """Rows on all dofs that give the force of parts by stiffness and by damping, each (k r, a), at a reference speed.

    Args:
        system: the model. speed: of the reference shaft in rad/s.
        parts: addresses of those whose forces are added, for each of k places.
        taken: the r dofs of a part's element that are those of its place.
    """
    count = len(range(*taken.indices(12)))
    K, C = (np.zeros((count * len(parts), system.dofs.transform.shape[0])) for _ in "KC")
    beta = system.model.damping.rayleigh_beta
    groups = system.groups_at(speed)
    for number, names in enumerate(parts):
        rows = slice(count * number, count * number + count)
        for group in groups:
            if group.part not in names:
                continue
            columns = group.dofs[0]
            m = group.matrices
            for term in (m.stiffness, m.circulatory):
                if term is not None:
                    K[rows, columns] += term[0][taken]
            if m.damping is not None:
                C[rows, columns] += m.damping[0][taken]
            if beta and m.stiffness is not None:
                C[rows, columns] += beta * m.stiffness[0][taken]
    return K, C


def _damped_lines(system: System) -> ContactLines:
    """The contacts of a system with Rayleigh's share of their damping."""
    lines = contact_lines(system)
    return replace(lines, damping=lines.damping + system.model.damping.rayleigh_beta * lines.stiffness)


class GroundLoads:
    """Force, and moment about the origin of the model, of the ground on each held set and mount of casings from meshes.

    Args:
        system: the model.
    """

    def __init__(self, system: System) -> None:
        given = system.model.damping
        self._parts = []
        names: list[str] = []
        for casing in system.model.casings:
            body = system.layout.casing(casing)
            K = body.ground_force
            C = body.ground_damping
            M = body.ground_mass
            if K is None or C is None or M is None or not body.ground_sets:  # it floats, or was reduced elsewhere
                continue
            names += [f"{casing}.{place}" for place in body.ground_sets]
            own = sp.csr_array(system.dofs.transform)[system.nodes.of_casing(casing), :]
            # Rayleigh's damping is one of every part of the gearbox.
            C = C + given.rayleigh_beta * K + given.rayleigh_alpha * M
            self._parts.append((own, K, C, M))
        self.names = tuple(names)

    def read(self, w: np.ndarray, q: np.ndarray, brake: np.ndarray | None) -> np.ndarray:
        """Amplitudes (o, g, 6) for displacements q (n, o) at frequencies w (o,); all in SI.

        `brake` are the accelerations (n, o) that the damping of modes acts as.
        """
        found = [np.zeros((len(w), 0))]
        for own, K, C, M in self._parts:
            u = own @ q
            accelerations = -(w**2) * u
            if brake is not None:
                accelerations = accelerations + own @ brake
            found.append((K @ u + (C @ u) * (1j * w) + M @ accelerations).T)
        return np.hstack(found).reshape(len(w), -1, 6)


class Plant:
    """Matrices of a system over speed, with the modal damping that was asked for.

    `seats` names the parts in each seat of a casing, such as "box.left" -> ["bearings.left"].

    Args:
        system: the system about its mean state.
        damping: modes (n, m), mass-normalised, their frequencies w (m,) in rad/s and the damping ratio they get.
    """

    def __init__(self, system: System, damping: tuple[np.ndarray, np.ndarray, float] | None = None) -> None:
        self.system = system
        self.lines = _damped_lines(system)
        self._acting = self.lines if system.released is system else _damped_lines(system.released)
        self._rigid: LoadRows | None = None
        self.low_rank: LowRank | None = None
        self.damped: tuple[np.ndarray, LowRank] | None = None
        if damping is not None and damping[2] > 0.0 and damping[1].size:
            modes, w, zeta = damping
            self.low_rank = LowRank(np.asarray(system.mass @ modes), 2.0 * zeta * w, w)
            self.damped = modes, self.low_rank
        self.has_tables = system.has_tables
        self.places = part_nodes(system)
        rows = [6 * node + dof for node in self.places.values() for dof in range(6)]
        self._place_rows = sp.csr_array(system.dofs.transform)[rows, :]
        self.points = motion_points(system.model)
        self._points = point_rows(system, self.points).toarray()
        self.load_units = read_loads(system.model)
        self.surfaces = {
            name: surface
            for name in system.model.casings
            if (surface := system.layout.casing(name).surface) is not None
        }
        self._normal_motion = {
            name: surface.normal_motion() / surface.normals_and_areas()[1].sum()
            for name, surface in self.surfaces.items()
        }
        self.seats: dict[str, list[str]] = {}
        rings = ((f"gears.{name}", seat) for name, seat in system.layout.ring_seats.items())
        for part, (casing, number, _) in chain(system.layout.seats, rings):
            name = f"{casing}.{system.layout.casing(casing).seats[number]}"
            self.seats.setdefault(name, []).append(part)
        self.rings = RingSeats(system)
        self._with_rings = [list(self.seats).index(name) for name in self.rings.names]
        self.ground = GroundLoads(system)
        self._parts: tuple[sp.csc_array, ...] | None = None
        self._sums: SparseSums | None = None
        self._rows: tuple[tuple[np.ndarray, ...], tuple[sp.csr_array, ...]] | None = None
        self._load_rows: LoadRows | None = None
        self._bubbles = ForcedChanges.of(system)

    def dynamics(self, speed: float) -> Dynamics:
        """M, D and K at a reference speed in rad/s."""
        system = self.system
        if system.in_powers is not None and not system.model.damping.rayleigh_beta:
            shape = system.mass.shape
            K, D = (
                sp.csc_array((weights @ values, rows, ends), shape=shape)
                for weights, (ends, rows, values) in zip(
                    (system.powers(speed), np.array([1.0, speed])), self._in_powers, strict=True
                )
            )
            return Dynamics(system.mass, D, K, self.low_rank, partial(self._factored, speed))
        if self.has_tables:
            K = sp.csc_array(system.stiffness(speed) + system.circulatory(speed))
            D = sp.csc_array(system.damping(speed) + speed * system.gyroscopic)
            return Dynamics(system.mass, D, K, self.low_rank)
        K0, turning, C, G = self._linear_parts()
        K = sp.csc_array(K0 + speed * turning) if turning.nnz else K0
        # A sum of sparse matrices of unlike patterns costs more than all else at a speed.
        D = sp.csc_array((C.data + speed * G.data, C.indices, C.indptr), shape=C.shape)
        return Dynamics(system.mass, D, K, self.low_rank, partial(self._factored, speed))

    def over_speed(self, speed: float) -> DynamicsOverSpeed:
        """Dynamics over the reference speed in rad/s; of a model with tables those of this speed at any."""
        if self.has_tables:
            nothing = sp.csc_array(self.system.mass.shape)
            return DynamicsOverSpeed(self.dynamics(speed), nothing, nothing)
        _, turning, _, G = self._linear_parts()
        return DynamicsOverSpeed(self.dynamics(0.0), G, turning)

    def _linear_parts(self) -> tuple[sp.csc_array, ...]:
        """Of a model without tables: K at standstill, what it grows by with the reference speed, and C and G on one pattern."""
        if self._parts is None:
            system = self.system
            still = system.circulatory(0.0)
            turning = sp.csc_array(system.circulatory(1.0) - still)
            # Rows of the transposed matrices are columns.
            ends, rows, values = on_one_pattern(system.damping(0.0).T, system.gyroscopic.T)
            damping = [sp.csc_array((data, rows, ends), shape=turning.shape) for data in values]
            self._parts = sp.csc_array(system.stiffness(0.0) + still), turning, *damping
        return self._parts

    @cached_property
    def _in_powers(self) -> tuple[tuple[np.ndarray, np.ndarray, np.ndarray], ...]:
        """Column ends, rows and values (k, entries) of what K and D add up from over powers of the speed, each on one pattern."""
        powers = self.system.in_powers
        assert powers is not None
        parts = (powers.of_stiffness, (self.system.damping(0.0), self.system.gyroscopic))
        # Rows of the transposed matrices are columns.
        found = (on_one_pattern(*(one.T for one in every)) for every in parts)
        return tuple((ends, rows, np.array(values)) for ends, rows, values in found)

    def _factored(self, speed: float, w: float) -> Factor:
        """Factors of K + i w D - w^2 M at a reference speed and a frequency in rad/s, of a model without tables or in powers."""
        system = self.system
        powers = system.in_powers
        if self._sums is None:
            damping = (system.damping(0.0), system.gyroscopic)
            parts = self._linear_parts() if powers is None else (*powers.of_stiffness, *damping)
            self._sums = SparseSums(system.mass, *parts)
        of_stiffness = (1.0, speed) if powers is None else system.powers(speed)
        return self._sums.factor((-(w**2), *of_stiffness, 1j * w, 1j * w * speed))

    def loads(self, orders: list[Order], speed: float) -> tuple[np.ndarray, np.ndarray]:
        """Frequencies (o,) in rad/s and loads (n, o) of all orders at a reference speed."""
        w = np.array([order.frequency_at(speed) for order in orders])
        loads = self._on_all(orders, np.full(len(orders), speed))
        return w, loads if self.system.released is self.system else np.asarray(self.system.followers.T @ loads)

    def _on_all(self, orders: list[Order], speeds: np.ndarray) -> np.ndarray:
        """Loads (b, o) of orders at a reference speed for each, on the dofs of rigid members, too."""
        return np.array([order.load(self._acting, speed) for order, speed in zip(orders, speeds, strict=True)]).T

    def read(self, orders: list[Order], speed: float | np.ndarray, w: np.ndarray, q: np.ndarray) -> Readings:
        """What the displacements q (n, o) of the orders mean, at one reference speed in rad/s or at one for each.

        Of a model with tables it is one.
        """
        lines = self.lines
        error = np.array([order.error for order in orders])
        varied = np.array([order.force for order in orders])
        approach = (lines.vectors.T @ q).T
        force = lines.forces(approach - error, w, np.reshape(speed, (-1, 1))) + varied
        held, seated = (-(K @ q + (C @ q) * (1j * w)).T for K, C in self._force_rows(np.ravel(speed)[0]))
        moved = (self._points @ q).T
        about = float(np.ravel(speed)[0])
        inside = self.load_rows(about).amplitudes(w, q, np.asarray(speed) - about).T
        there = (self._place_rows @ q).T.reshape(len(w), len(self.places), 6)
        place = np.array([state.face.place if state.face else 0.0 for state in lines.states])
        middle = approach - place * (lines.tilt.T @ q).T
        transverse = middle / np.cos([state.contact.base_helix_angle for state in lines.states])
        rotation = (lines.rotation.T @ q).T
        normal = w[:, None] * self._normal(q)
        lacking = self._bubbles.change(speed, w, q, turning=True)
        on_seats = np.asarray(seated).reshape(len(w), -1, 6)
        held = held.reshape(len(w), -1, 3)
        self._add_rigid(orders, np.broadcast_to(speed, len(w)), w, q, held, on_seats)
        brake = self._brake(w, q) if self.ground.names or self.rings.names else None
        if self.rings.names:
            couple = np.array([order.couple for order in orders])
            on_seats[:, self._with_rings] += self.rings.read(lines, force, couple, w, q, brake)
        return Readings(
            mesh_force=force,
            transmission_error=rotation,
            approach=transverse,
            pressed=approach,
            bearing_force=held,
            acceleration=-(w**2)[:, None] * moved,
            internal_load=inside,
            displacement=there,
            normal_velocity=normal,
            casing_seat_force=on_seats,
            casing_ground_force=self.ground.read(w, q, brake),
            bubble_change=lacking,
        )

    def load_rows(self, speed: float) -> LoadRows:
        """Loads of the points that read one, from displacements, at a reference speed in rad/s."""
        if self.has_tables:
            return self._braked(load_rows(self.system, speed))
        self._load_rows = self._load_rows or load_rows(self.system)
        return self._braked(self._load_rows.at(speed))

    def rigid_rows(self, speed: float) -> LoadRows:
        """Forces of the rigid directions of bearings by displacements, at a reference speed in rad/s; loads act beside them."""
        if self.has_tables:
            return self._braked(rigid_rows(self.system, speed))
        self._rigid = self._rigid or rigid_rows(self.system)
        return self._braked(self._rigid.at(speed))

    def _braked(self, rows: LoadRows) -> LoadRows:
        """Rows with the damping of modes."""
        if self.damped is None:
            return rows
        modes, (P, d, _) = self.damped
        return rows.braked(modes, d, P)

    def _add_rigid(
        self,
        orders: list[Order],
        speeds: np.ndarray,
        w: np.ndarray,
        q: np.ndarray,
        held: np.ndarray,
        on_seats: np.ndarray,
    ) -> None:
        """Add the forces of rigid directions to those on bearings (o, b, 3) and on seats (o, s, 6); as in `read`."""
        directions = on_shafts(self.system)
        if not directions:
            return
        about = float(speeds[0])
        forces = self.rigid_rows(about).amplitudes(w, q, speeds - about)
        forces = forces + from_loads(self.system) @ self._on_all(orders, speeds)
        bearings = list(self.system.model.bearings)
        seats = list(self.seats.values())
        for (name, k), force in zip(directions, forces, strict=True):
            if k < 3:
                held[:, bearings.index(name), k] -= force
            address = f"bearings.{name}"
            for number, parts in enumerate(seats):
                if address in parts:
                    _, relative = relative_motion(self.system.layout, self.system.nodes, address)
                    on_seats[:, number] -= force[:, None] * relative[k, :6]

    def _brake(self, w: np.ndarray, q: np.ndarray) -> np.ndarray | None:
        """Accelerations (n, o) that the damping of modes acts as, of displacements q (n, o) at frequencies w (o,)."""
        if self.damped is None:
            return None
        modes, (P, d, _) = self.damped
        return np.asarray(modes @ (d[:, None] * (P.T @ q)) * (1j * w))

    def _normal(self, q: np.ndarray) -> np.ndarray:
        """Root of the mean square of the normal displacement over each casing's surface, (o, k), from q (n, o)."""
        T = self.system.dofs.transform
        found = np.zeros((q.shape[1], len(self.surfaces)))
        for k, (name, W) in enumerate(self._normal_motion.items()):
            own = T[self.system.nodes.of_casing(name), :] @ q
            found[:, k] = np.sqrt(np.maximum(np.real(np.einsum("no,no->o", own.conj(), W @ own)), 0.0))
        return found

    def _force_rows(self, speed: float) -> tuple[tuple[np.ndarray, ...], tuple[sp.csr_array, ...]]:
        """Rows that give forces from displacements and from velocities: along x y z on each bearing's node (3 b, n) and, about
        its point, on each seat that has a part in it (6 s, n)."""
        if self._rows is None or self.system.has_varying_springs or self.system.layout.elastic_bodies:
            T = self.system.dofs.transform
            bearings = [(f"bearings.{name}",) for name in self.system.model.bearings]
            on_nodes = force_rows(self.system, speed, bearings, slice(-6, -3))
            in_seats = force_rows(self.system, speed, tuple(self.seats.values()), slice(0, 6))
            self._rows = (
                tuple(np.asarray((T.T @ rows.T).T) for rows in on_nodes),
                tuple(sp.csr_array(sp.csr_array(rows) @ sp.csr_array(T)) for rows in in_seats),
            )
        return self._rows
