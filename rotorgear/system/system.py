"""The assembled system of a model: M q'' + (C + W G) q' + K q = f, with W the spin of the reference shaft."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, wraps
from typing import Any, TypeVar

import numpy as np
import scipy.sparse as sp

from rotorgear.errors import AnalysisError
from rotorgear.model.layout.layout import Layout
from rotorgear.model.layout.state import Kind, State
from rotorgear.model.layout.train import Train
from rotorgear.model.model import Model
from rotorgear.system.assembly import StrainForms, assemble, strain_factor, strain_forms, without_negative
from rotorgear.system.dofs import DofMap, map_dofs, rigid_groups
from rotorgear.system.groups import ElementGroup, constant_groups, table_groups
from rotorgear.system.nodes import Nodes, discretise
from rotorgear.system.plan import Plan
from rotorgear.system.planets import PinLoad, pin_loads, planet_groups, seen_from_carrier, turning_carriers
from rotorgear.system.rigid_members import Conditions, conditions, followers, without_rigid


@dataclass(frozen=True)
class Matrices:
    """Sparse matrices at one speed, each (n, n): mass, damping, gyroscopic for unit reference spin, stiffness.

    `stiffness` may be non-symmetric (cross-coupled bearings, internal damping at speed); `symmetric` says whether it is not.
    """

    mass: sp.csc_array
    damping: sp.csc_array
    gyroscopic: sp.csc_array
    stiffness: sp.csc_array
    symmetric: bool


@dataclass(frozen=True)
class InPowers:
    """Sparse matrices (n, n) of the speed W in rad/s: K = stiffness + W^2 per_square + the sum of b_p pins_p, with b_p in N that
    the load of pin p has beyond its square of W, the circulatory N = circulation + W per_speed, and the damping."""

    stiffness: sp.csc_array
    per_square: sp.csc_array
    circulation: sp.csc_array
    per_speed: sp.csc_array
    pins: tuple[sp.csc_array, ...]
    damping: sp.csc_array

    @property
    def of_stiffness(self) -> tuple[sp.csc_array, ...]:
        """What K + N adds up from, with the weights of `System.powers`."""
        return sp.csc_array(self.stiffness + self.circulation), self.per_speed, self.per_square, *self.pins


Made = TypeVar("Made")


def _kept(method: Callable[[System, float], Made]) -> Callable[..., Made]:
    """Keep what a method made at the last speed; where parts have no tables of it, what is kept serves any speed."""

    @wraps(method)
    def kept(system: System, speed: float = 0.0) -> Made:
        at = speed if system.has_tables else 0.0
        last = system._last.get(method.__name__)
        if last is None or last[0] != at:
            last = system._last[method.__name__] = (at, method(system, at))
        made: Made = last[1]
        return made

    return kept


class System:
    """Nodes, degrees of freedom and matrices of a model.

    Args:
        model: a checked model.
        elements: basic elements in each shaft segment.
        plan: how finely each piece is cut, in place of `elements`.
        state: flanks, forces and tangents that it is about. None: those of the torque flow at the operating speed.
        load: old way to ask for a state.
        direction: old way to ask for a state.
    """

    def __init__(
        self,
        model: Model,
        elements: int | None = None,
        *,
        plan: Plan | None = None,
        state: State | None = None,
        load: State | None = None,
        direction: int | None = None,
    ) -> None:
        if direction is not None:
            warnings.warn(
                "System(direction=...) is now state=model.torque_flow(direction)", FutureWarning, stacklevel=2
            )
        if load is not None:
            warnings.warn("System(load=...) is now state=...", FutureWarning, stacklevel=2)
        self.model = model
        self.plan = plan or Plan(elements or 1)
        state = state or load or model.torque_flow(direction)
        # A state may have been found on a model that differs in what it does not depend on, such as modes of its casings.
        self.state = state if state.layout is model.layout else replace(state, layout=model.layout)
        self._last: dict[str, tuple[float, Any]] = {}
        self.is_seen_from_carrier = False
        self._is_released = False

    def require_freedom(self) -> None:
        """Refuse a model in which nothing can move.

        Raises:
            AnalysisError: it has no degree of freedom.
        """
        if self.n == 0:
            raise AnalysisError("the model has no free degree of freedom: its supports and motions hold everything")

    def with_plan(self, plan: Plan) -> System:
        """The same model under the same load on another mesh."""
        return self._alike(type(self)(self.model, plan=plan, state=self.state))

    def with_state(self, state: State) -> System:
        """The same mesh about another state."""
        return self._alike(type(self)(self.model, plan=self.plan, state=state))

    def seen_from_carrier(self) -> System:
        """The same in axes that turn with its carrier, where planets that are not alike have constant coefficients."""
        found = type(self)(self.model, plan=self.plan, state=self.state)
        found.is_seen_from_carrier = True
        return found

    def _alike(self, other: System) -> System:
        other.is_seen_from_carrier = self.is_seen_from_carrier
        other._is_released = self._is_released
        return other

    @cached_property
    def released(self) -> System:
        """The same with all dofs that rigid members take away; itself where nothing is rigid."""
        if not self.conditions.parts:
            return self
        found = self._alike(type(self)(self.model, plan=self.plan, state=self.state))
        found._is_released = True
        return found

    @property
    def load(self) -> State:
        """Old name of `state`."""
        warnings.warn("System.load is now System.state", FutureWarning, stacklevel=2)
        return self.state

    @property
    def layout(self) -> Layout:
        """What follows from the parts of the model before any load."""
        return self.state.layout

    @cached_property
    def nodes(self) -> Nodes:
        """Nodes of all parts, by the plan."""
        return discretise(self.layout, self.plan)

    @cached_property
    def dofs(self) -> DofMap:
        """Which of their displacements are degrees of freedom, and how the others follow."""
        return without_rigid(self._without_conditions, self.conditions, self.followers)

    @cached_property
    def followers(self) -> sp.csc_array:
        """E (b, n): the dofs of the `released` system from its own."""
        return followers(self.conditions)

    @cached_property
    def _without_conditions(self) -> DofMap:
        return map_dofs(self.layout, self.nodes)

    @cached_property
    def conditions(self) -> Conditions:
        """What rigid meshes, couplings and bearings keep at zero."""
        found = conditions(self.layout, self.nodes, self._without_conditions, self.state.rigid)
        return found.none if self._is_released else found

    @property
    def train(self) -> Train:
        """Speed and sense of every shaft."""
        return self.layout.train

    @property
    def direction(self) -> int:
        """+1 or -1: sense in which the reference shaft turns."""
        return self.state.direction

    @property
    def n(self) -> int:
        """Number of degrees of freedom."""
        return self.dofs.n

    @cached_property
    def has_tables(self) -> bool:
        """Whether stiffness or damping of some part depends on speed in another way than in proportion: tables, gear bodies."""
        bodies = any(gear.body.mesh for gear in self.model.gears.values())
        return (
            bodies
            or bool(turning_carriers(self.layout))
            or any(spring.varies for spring in self.state.springs.values())
        )

    @cached_property
    def groups(self) -> list[ElementGroup]:
        """Element groups without the bearings that have tables."""
        going_round = self._going_round[0]
        pins = self._pins if going_round else ()
        loads = [load.group_per_square(self.train.ratio(load.planets.shaft)) for load in pins]
        return [*self._constant, *going_round, *loads]

    @cached_property
    def _constant(self) -> list[ElementGroup]:
        return constant_groups(self.state, self.nodes)

    @property
    def uneven_planets(self) -> bool:
        """Whether planets go round whose matrices change as they do."""
        return self._going_round[1] is not None

    @cached_property
    def _going_round(self) -> tuple[list[ElementGroup], AnalysisError | None]:
        """What planets bring where their carriers turn, or why that is not built."""
        if self.is_seen_from_carrier:
            return seen_from_carrier(self.layout, self._constant), None
        try:
            return planet_groups(self.layout, self._constant), None
        except AnalysisError as error:
            return [], error

    def groups_at(self, speed: float) -> list[ElementGroup]:
        """All element groups at a reference speed in rad/s."""
        return [group.at(speed) for group in self.groups] + self.groups_of(speed)

    def groups_of(self, speed: float) -> list[ElementGroup]:
        """Those of them that are of one speed alone: bearings with tables, and loads of planets' pins."""
        error = self._going_round[1]
        # Statics takes planets as they stand at the moment, of which it says what it leaves out.
        if speed and error is not None and self.state.kind != "static":
            raise error
        tables = table_groups(self.state, self.nodes, speed)
        if not speed or error is not None or not turning_carriers(self.layout):
            return tables
        carried = seen_from_carrier if self.is_seen_from_carrier else planet_groups
        return tables + carried(self.layout, tables) + self._pin_groups(speed, tables)

    def of_carriers(self, speed: float) -> list[ElementGroup]:
        """What planets that go round bring at a reference speed in rad/s, beside contacts and elements that are laws."""
        if not turning_carriers(self.layout):
            return []
        linear = [group for group in self._constant if not group.part.startswith(("meshes.", "nonlinear_elements."))]
        loads = [load.group_per_square(self.train.ratio(load.planets.shaft)) for load in self._pins]
        of_speed = [group for group in self.groups_of(speed) if group.part.startswith("carriers.")]
        carried = seen_from_carrier if self.is_seen_from_carrier else planet_groups
        return [group.at(speed) for group in (*carried(self.layout, linear), *loads)] + of_speed

    @cached_property
    def has_varying_springs(self) -> bool:
        """Whether some bearing, support, coupling or element has a table over speed."""
        return any(spring.varies for spring in self.state.springs.values())

    @cached_property
    def _pins(self) -> list[PinLoad]:
        return pin_loads(self.layout, self.nodes, self.dofs, self._constant)

    def _pin_groups(self, speed: float, tables: list[ElementGroup]) -> list[ElementGroup]:
        """The loads of planets' pins at a reference speed in rad/s."""
        loads = self._pins
        if tables:
            loads = pin_loads(self.layout, self.nodes, self.dofs, [*self.groups, *tables])
        return [load.group(load.beyond(speed * self.train.ratio(load.planets.shaft))) for load in loads]

    @cached_property
    def in_powers(self) -> InPowers | None:
        """Its matrices by powers of the speed where nothing but planets that go round depends on it; None elsewhere."""
        if not turning_carriers(self.layout) or self.has_varying_springs or self.layout.elastic_bodies:
            return None
        still = self._sum(self.groups, lambda g: g.circulatory_at(0.0))
        return InPowers(
            stiffness=self._sum(self.groups, lambda g: g.matrices.stiffness),
            per_square=self.stiffness_per_square,
            circulation=still,
            per_speed=sp.csc_array(self._sum(self.groups, lambda g: g.circulatory_at(1.0)) - still),
            pins=tuple(self._sum([load.group(1.0)], lambda g: g.matrices.stiffness) for load in self._pins),
            damping=self._sum(self.groups, lambda g: g.matrices.damping),
        )

    def powers(self, speed: float) -> np.ndarray:
        """Weights of `InPowers.of_stiffness` at a reference speed in rad/s; errors as of `groups_of`."""
        if speed and self._going_round[1] is not None:
            raise self._going_round[1]
        loads = (load.beyond(speed * self.train.ratio(load.planets.shaft)) for load in self._pins)
        return np.array([1.0, speed, speed**2, *loads])

    @cached_property
    def mass(self) -> sp.csc_array:
        """Mass matrix, sparse (n, n)."""
        return self._sum(self.groups, lambda g: g.matrices.mass)

    @cached_property
    def nodal_inertia(self) -> np.ndarray:
        """Diagonal of the mass matrix over all six dofs of the p nodes, (6 p,), tied and held ones too."""
        of_parts = [
            (group.dofs.ravel(), np.diagonal(group.matrices.mass, axis1=1, axis2=2).ravel())
            for group in self.groups
            if group.matrices.mass is not None
        ]
        if not of_parts:
            return np.zeros(6 * len(self.nodes))
        dofs, inertia = (np.concatenate(every) for every in zip(*of_parts, strict=True))
        return np.bincount(dofs, inertia, minlength=self.dofs.transform.shape[0])[: 6 * len(self.nodes)]

    @cached_property
    def gyroscopic(self) -> sp.csc_array:
        """Gyroscopic matrix for unit spin of the reference shaft, sparse (n, n), skew."""
        G = self._sum(
            self.groups,
            lambda g: None if g.matrices.gyroscopic is None or not g.spin else g.spin * g.matrices.gyroscopic,
        )
        # Sums over the sisters of a planet round on both sides of the diagonal.
        return sp.csc_array(0.5 * (G - G.T)) if self.layout.planets else G

    @cached_property
    def stiffness_per_square(self) -> sp.csc_array:
        """What the stiffness grows by with the square of the reference speed, sparse (n, n), by gear bodies."""
        return self._sum(self.groups, lambda g: g.stiffness_per_square)

    @_kept
    def stiffness(self, speed: float = 0.0) -> sp.csc_array:
        """Symmetric part of the stiffness at a reference speed in rad/s, sparse (n, n); that of the last speed is kept."""
        if self.in_powers is not None:
            powers = self.in_powers
            return sp.csc_array(powers.stiffness + speed**2 * powers.per_square + self.stiffness_of(speed))
        return self._sum(self.groups_at(speed), lambda g: g.matrices.stiffness)

    def stiffness_of(self, speed: float) -> sp.csc_array:
        """The symmetric stiffness of what is of one speed alone (`groups_of`), sparse (n, n)."""
        return self._sum(self.groups_of(speed), lambda g: g.matrices.stiffness)

    def circulatory(self, speed: float = 0.0) -> sp.csc_array:
        """Non-symmetric stiffness of cross-coupled bearings and of internal damping at speed, sparse (n, n)."""
        if not (self.has_tables or self._circulates):
            return sp.csc_array((self.n, self.n))
        if self.in_powers is not None:
            return sp.csc_array(self.in_powers.circulation + speed * self.in_powers.per_speed)
        return self._sum(self.groups_at(speed), lambda g: g.circulatory_at(speed))

    @_kept
    def damping(self, speed: float = 0.0) -> sp.csc_array:
        """Damping matrix with the proportional part, sparse (n, n); that of the last speed is kept."""
        powers = self.in_powers
        C = powers.damping if powers is not None else self._sum(self.groups_at(speed), lambda g: g.matrices.damping)
        given = self.model.damping
        if given.rayleigh_alpha:
            C = C + given.rayleigh_alpha * self.mass
        if given.rayleigh_beta:
            C = C + given.rayleigh_beta * self.stiffness(speed)
        return sp.csc_array(C)

    def definite_stiffness(self, speed: float = 0.0) -> sp.csc_array:
        """The stiffness at a reference speed in rad/s with no spring below zero, sparse (n, n): see `without_negative`."""
        return self._sum(self.groups_at(speed), lambda g: without_negative(g.matrices))

    @_kept
    def strain_factor(self, speed: float = 0.0) -> sp.csr_array | None:
        """S with K = S^T S from element strains, sparse (s, n); None where a modulus is not positive. The last is kept."""
        return strain_factor(self.groups_at(speed), self.dofs)

    def strain_forms(self, speed: float = 0.0) -> StrainForms:
        """Stiffness, damping and circulatory terms at a reference speed in rad/s as strains and what acts on them."""
        return strain_forms(self.groups_at(speed), self.dofs, speed, self.model.damping.rayleigh_beta)

    def inertial_terms(self, speed: float = 0.0) -> sp.csc_array:
        """Part of the velocity terms that comes from inertia, alpha M + W G, sparse (n, n)."""
        alpha = self.model.damping.rayleigh_alpha
        turning = self._spinning(speed)
        return sp.csc_array(alpha * self.mass + turning) if alpha else turning

    def velocity_terms(self, speed: float | None) -> sp.csc_array | None:
        """C + W G at a speed, sparse (n, n); None where there is nothing of it, or at standstill without damping (speed None)."""
        if speed is None:
            return None
        D = self.damping(speed)
        if speed != 0.0:
            D = sp.csc_array(D + self._spinning(speed))
        return D if D.nnz and np.any(D.data) else None

    @property
    def dof_names(self) -> dict[str, str]:
        """Name -> SI unit of each row and column of the matrices, n of them, such as "shafts.input(120 mm):tilt_x" -> "rad"."""
        return self.dofs.names(self.nodes)

    def matrices(self, speed: float = 0.0) -> Matrices:
        """All matrices at a reference speed in rad/s."""
        skew = self.circulatory(speed)
        K = self.stiffness(speed)
        if skew.nnz:
            K = sp.csc_array(K + skew)
        return Matrices(self.mass, self.damping(speed), self.gyroscopic, K, not skew.nnz)

    def rigid_with(self, node: int) -> list[int]:
        """The nodes that rigid sections tie to a node, itself among them."""
        return next((group for group in rigid_groups(self.model, self.nodes) if node in group), [node])

    def positions(self) -> np.ndarray:
        """x, y, z of all nodes in the model in m, shape (p, 3); shafts without positions begin at the origin."""
        frames = {name: shaft.frame for name, shaft in self.model.shafts.items()}
        origins, along = np.array(
            [(frames[name].origin, frames[name].axes[:, 2]) for name in self.nodes.shaft]
        ).swapaxes(0, 1)
        return np.asarray(origins + np.array(self.nodes.z)[:, None] * along)

    @cached_property
    def _circulates(self) -> bool:
        """Whether a group without a table has a non-symmetric stiffness."""
        every = (group.matrices for group in self.groups)
        return any(m.circulation is not None or m.circulation_per_speed is not None for m in every)

    def _spinning(self, speed: float) -> sp.csc_array:
        """W G at a speed W in rad/s, sparse (n, n)."""
        G = self.gyroscopic
        return sp.csc_array((speed * G.data, G.indices, G.indptr), shape=G.shape)

    def _sum(self, groups: list[ElementGroup], term: Callable[[ElementGroup], np.ndarray | None]) -> sp.csc_array:
        return assemble(groups, self.dofs, term)


def flow_system(
    model: Model, plan: Plan | None = None, *, direction: int | None = None, kind: Kind = "dynamic"
) -> System:
    """The system about the torque flow of one sense of rotation, None for that of the operating speed, on the mesh of a plan.

    `kind` is the stiffness of its contacts where that depends on the load: "static" where an equilibrium is looked for.
    """
    return System(model, plan=plan, state=model.torque_flow(direction).of_kind(kind))
