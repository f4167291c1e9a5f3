"""One point of a sweep made ready: the model at its parameters as a small system, with tables of what depends on time.

What repeats in a model that turns: orders of all laws, and the period that they have in common.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import gcd, lcm
from typing import TYPE_CHECKING

import numpy as np

from rotorgear.analysis.common.discretise import plan_in_time
from rotorgear.analysis.static.about_equilibrium import state_in_time
from rotorgear.analysis.static.mean_state import springs_about_mean
from rotorgear.analysis.sweep.inside import Inside
from rotorgear.analysis.sweep.reduce import MOST_COORDINATES, MOST_WITH_BODIES, Large
from rotorgear.analysis.transient.notes import damped_at_nodes, left_out_in_time
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.note import Note
from rotorgear.solvers.batch.columns import OWN_LAW, TABLE_ROWS, Columns
from rotorgear.solvers.batch.own_laws import OwnLaws, own_laws
from rotorgear.solvers.batch.small_system import MOST_DOFS, Shapes, SmallSystem, Still, small_system
from rotorgear.solvers.time.contact_equilibrium import Equilibrium, Expanded, unbalanced
from rotorgear.solvers.time.local_forces import LocalForces
from rotorgear.solvers.time.local_system import LocalSystem, Rotation, local_tangent
from rotorgear.solvers.time.sisters import over_a_turn, sisters_of
from rotorgear.system.internal_loads import load_rows, read_loads
from rotorgear.system.local import LocalModel, local_model
from rotorgear.system.planets import NotSeenFromCarrierError, sister_places, turning_carriers
from rotorgear.system.system import System, flow_system

if TYPE_CHECKING:
    from rotorgear.solvers.time.local_forces import LocalLaw


# Periods of the fastest mesh in the common one, at most.
MOST_TURNS = 1000
_WHOLE = 1e-9  # relative error of a fraction that approximates a ratio of speeds


def shared_period(orders: list[Fraction]) -> tuple[Fraction, int]:
    """The highest order, and how many of its periods everything that varies has in common, however many.

    Raises:
        AnalysisError: nothing varies.
    """
    if not orders:
        raise AnalysisError("nothing repeats: a sweep needs a mesh with teeth, or an unbalance, that turns")
    fastest = max(orders)
    base = Fraction(gcd(*(o.numerator for o in orders)), lcm(*(o.denominator for o in orders)))
    return fastest, int(fastest / base)


def common_period(orders: list[Fraction], meshes: Sequence[Fraction] = ()) -> tuple[Fraction, int]:
    """The highest order, and how many of its periods everything that varies has in common.

    Raises:
        AnalysisError: nothing varies, or the common period is too long; where that of the meshes alone is not, what else to
            leave out.
    """
    fastest, turns = shared_period(orders)
    if turns > MOST_TURNS:
        why = f"the meshes repeat together after {turns} periods of the fastest only (at most {MOST_TURNS})"
        remedy = "choose numbers of teeth with common factors"
        if 0 < len(meshes) < len(orders):
            alone = f"without unbalances and torque ripples the meshes repeat after {common_period(list(meshes))[1]}"
            remedy += f"; {alone}: leave these out, as by --over 'unbalances.*.magnitude=0 kg m'"
        raise AnalysisError(f"{why}; {remedy}")
    return fastest, turns


def orders_of(law: LocalLaw, label: str) -> list[Fraction]:
    """Orders of what varies in a law and belongs to the common period; none where it stays the same."""
    return [_in_whole_numbers(each.order, label) for each in law.repeats() if each.common]


def _in_whole_numbers(order: float, label: str) -> Fraction:
    found = Fraction(order).limit_denominator(100000)
    if abs(float(found) - order) > _WHOLE * order:
        raise AnalysisError(
            f"{label}: its order {order:.9g} of the input shaft is no ratio of whole numbers, so nothing repeats"
        )
    return found


def depends_on_speed(model: Model) -> bool:
    """Whether more than the rotation goes with the speed in any motion; laws of one's own may depend on it as they like."""
    return bool(
        (model.operation and model.operation.power is not None)
        or any(load.power is not None or load.speed_power for load in model.loads.values())
        or any(bearing.table for bearing in model.bearings.values())
        or any(shaft.internal_damping for shaft in model.shafts.values())
        or any(gear.body.mesh for gear in model.gears.values())  # centrifugal softening
        or turning_carriers(model.layout)
        or model.nonlinear_elements
    )


_KEPT = 1000  # states at rest
# Systems with casings are reduced from this many dofs on; below, there is nothing to gain.
LEAST_DOFS = 24


@dataclass(frozen=True)
class Point:
    """A small system with what a sweep reads off it.

    Attributes:
        system: for the kernels. forces: its laws. order: radians of the fastest mesh for each of the reference, with the
        sign of its speed.
        contact: names of the mesh contacts; static_force: theirs without anything that varies, (c,) in N.
        stiffness: their mean stiffness, (c,) in N/m. drift: whether the torques don't balance. rolling: whether rolling
        elements pass beside the meshes. shape: bytes that two points share where their tables are the same.
    """

    system: SmallSystem
    forces: LocalForces
    order: float
    contact: tuple[str, ...]
    static_force: np.ndarray
    stiffness: np.ndarray
    drift: bool
    rolling: bool
    shape: bytes

    @property
    def bare(self) -> Point:
        """The point without the shapes of its reduction, which its runs don't need."""
        return self if self.system.shapes is None else replace(self, system=replace(self.system, shapes=None))

    @property
    def kind(self) -> tuple[object, ...]:
        """What points in one block share."""
        c = self.system.columns
        own = self.system.own.forces
        sets = [part.tobytes() for sisters in (self.system.sisters, self.system.seen_sisters) for part in sisters]
        return (
            *sets,
            self.system.n,
            c.kind.tobytes(),
            c.mode.tobytes(),
            c.counted.tobytes(),
            len(self.system.rigid),
            len(self.system.carried),
            self.system.turns,
            len(self.system.loads.base),
            self.contact,
            own.kind.tobytes(),
            tuple(type(law) for law in own.laws),
            own.parameters_first.tobytes(),
            own.state_first.tobytes(),
        )


@dataclass(frozen=True)
class AtRest:
    """What of a point does not depend on its speed: local system, orders, names of contacts, state at rest, whether it drifts.

    `inside`: loads inside shafts and couplings that are read, at standstill where nothing but rotation depends on the speed.
    """

    local: LocalSystem
    orders: list[Fraction]
    contact: tuple[str, ...]
    rest: Equilibrium
    static: np.ndarray
    drifts: bool
    shapes: Shapes | None = None
    inside: Inside | None = None

    @cached_property
    def period(self) -> tuple[Fraction, int]:
        """The highest order, and how many of its periods everything that varies has in common."""
        return common_period(self.orders)

    @cached_property
    def shape(self) -> bytes:
        """Bytes that two points share where their tables are the same."""
        return b"".join(law.table_key() for law in self.local.forces.laws)

    @cached_property
    def rolling(self) -> bool:
        """Whether rolling elements pass beside the meshes."""
        return any(not each.common for law in self.local.forces.laws for each in law.repeats())

    @cached_property
    def still(self) -> Still:
        """The system as a small one, as far as it is the same at all speeds."""
        return Still(self.local, self.rest, self.shapes)

    def own_laws(self, own: np.ndarray, turn: float) -> OwnLaws:
        """The laws that a sweep takes by themselves, marked in `own` (m,), gathered once."""
        key = own.tobytes()
        if key not in self._own:
            self._own[key] = own_laws(self.local.forces, own, turn)
        return replace(self._own[key], turn=turn)

    @cached_property
    def _own(self) -> dict[bytes, OwnLaws]:
        return {}

    def about(self, other: AtRest) -> AtRest:
        """The same, with what it shares with another state of these matrices and this reference stiffness taken from there."""
        found = replace(self)
        # Laws that act by themselves have numbers of their own; where there are none, both have the same.
        own = {key: laws for key, laws in other._own.items() if not laws.forces.laws}
        found.__dict__.update(still=other.still.under(self.local, self.rest), period=other.period, _own=own)
        return found


@dataclass(frozen=True)
class Built:
    """A model as a system with local forces, before anything is solved.

    Attributes:
        local: the system. orders: periods of what varies in a turn of the reference. contact: names of its mesh contacts.
        left_out: what it leaves out. speed: at which it was built, rad/s. modal_ratio: damping added to every mode.
        is_large: whether it is to be reduced, to at most `most` coordinates. inside: loads that are read.
    """

    local: LocalSystem
    orders: list[Fraction]
    contact: tuple[str, ...]
    left_out: tuple[Note, ...]
    speed: float
    modal_ratio: float
    is_large: bool
    most: int
    inside: Inside | None


class PointMaker:
    """Makes models ready, and keeps states at rest for models where only the speed is another.

    `left_out` has the sentences of each model that was made ready anew on what is left out of it.

    Args:
        modes: of reductions, which all models get where it is given, and else those that are large or have dofs without inertia.
        elements: in each shaft segment.
    """

    def __init__(self, modes: int | None = None, elements: int | None = None) -> None:
        self._modes = modes
        self._elements = elements
        self._known: dict[str, AtRest | Large] = {}
        self._expanded_last: tuple[bytes, Expanded] | None = None
        self.left_out: list[tuple[str, ...]] = []

    def __call__(self, model: Model) -> Point | Large:
        """Make a model ready at its own speed; one that is to be reduced comes back whole, for a `Reducer`.

        Raises:
            AnalysisError: no speed, no mesh that turns, no common period, too many dofs, or forces that sweeps don't take.
        """
        speed = model.operating_speed
        if not model.operation or not speed:
            raise AnalysisError("the model gives no speed of operation: set operation.speed, or sweep over it")
        if not self.is_one_over_speed(model):
            return self._at(self._made(model, speed), speed, model.damping.modal_ratio)
        return self.over_speed(model)(speed)

    def is_one_over_speed(self, model: Model) -> bool:
        """Whether one state at rest serves a model at all speeds of one sense."""
        return not (
            depends_on_speed(model)
            or any(load.varies for load in model.loads.values())
            or any(bearing.has_film for bearing in model.bearings.values())
        )

    def over_speed(self, model: Model) -> Callable[[float], Point | Large]:
        """What makes a model ready at any speed of one sense, of which one state at rest serves all.

        Raises:
            AnalysisError: as for one speed.
        """
        assert model.operation is not None
        slow = speed_of_all(model)
        standing = model.operation.model_copy(update={"speed": slow})
        key = model.model_copy(update={"operation": standing}).model_dump_json(exclude_none=True)
        if key not in self._known:
            if len(self._known) >= _KEPT:
                self._known.clear()
            # At one speed for all: moving errors act on dampers at rest, and no point may depend on the first one.
            self._known[key] = self._made(model, slow)
        known = self._known[key]
        return lambda speed: self._at(known, speed, model.damping.modal_ratio)

    def made(self, built: Built, expanded: Expanded | None = None) -> AtRest | Large:
        """The state at rest of what was built, made ready for statics as `expanded`; the whole where it is to be reduced."""
        local, orders, contact = built.local, built.orders, built.contact
        if self._modes is not None or built.is_large or np.any(local.M.diagonal() <= 0.0):
            return Large(local, orders, contact, built.speed, built.modal_ratio, built.most, built.inside)
        return replace(at_rest(local, orders, contact, expanded or self._expanded(local)), inside=built.inside)

    def _at(self, known: AtRest | Large, speed: float, modal_ratio: float) -> Point | Large:
        return replace(known, speed=speed) if isinstance(known, Large) else ready(known, speed, modal_ratio)

    def _made(self, model: Model, speed: float) -> AtRest | Large:
        built = self.built(model, speed)
        self.left_out.append(built.left_out)
        return self.made(built)

    def built(self, model: Model, speed: float) -> Built:
        """The system of a model with local forces, about the state that motions at a speed in rad/s start from.

        Raises:
            AnalysisError: no mesh that turns, no common period, or forces that sweeps don't take.
        """
        system = flow_system(model, plan_in_time(self._elements)).with_state(state_in_time(model, speed))
        system.require_freedom()
        built = None
        if turning := turning_carriers(system.layout):
            try:
                built = _in_time(system.seen_from_carrier(), speed)
            except NotSeenFromCarrierError:
                if system.uneven_planets:
                    raise
        goes_round = bool(turning) and built is None
        built = built or _in_time(system, speed)
        # Watched is the approach of each contact in the transverse plane, too, behind the transmission errors.
        approach = built.local.B[:, built.mesh_columns].toarray() / built.transverse
        watched = np.hstack([built.local.watched_vectors, approach])
        seen = [name + what for what in ("", " approach") for name in built.watched_names]
        places = sister_places(system.layout, seen) if goes_round else ()
        built = replace(built, local=replace(built.local, watched=watched, seen_sisters=sisters_of(places)))
        for name in read_loads(model) if turning else ():
            raise AnalysisError(
                f"points.{name}: loads inside shafts are not told in sweeps of planets that go round: leave the point out, or "
                "ask for a transient"
            )
        inside = Inside(load_rows(system, speed), speed) if read_loads(model) else None
        left_out = (*left_out_in_time(built, speed, contacts_only=True), *damped_at_nodes(model))
        for part in built.parts:
            if why := part.law.unsettled():
                raise AnalysisError(f"{part.part}: {why}")
        meshes, others = (
            [o for part in built.parts if part.is_mesh is is_mesh for o in orders_of(part.law, part.label)]
            for is_mesh in (True, False)
        )
        if goes_round:
            # All repeats where it was before: with the planets there, too.
            others += [
                _in_whole_numbers(abs(system.train.ratio(planets.shaft)), f"carriers.{planets.carrier}")
                for planets in turning
            ]
        orders = meshes + others
        common_period(orders, meshes)
        contact = tuple(part.label for part in built.parts if part.is_mesh)
        # Casings and gear bodies bring static shapes at high frequencies, which few of the contacts' motions need.
        bodies = bool(system.model.casings) or bool(system.nodes.bodies)
        is_large = system.n > MOST_DOFS or (bodies and system.n > LEAST_DOFS)
        most = MOST_WITH_BODIES if bodies else MOST_COORDINATES
        return Built(built.local, orders, contact, left_out, speed, model.damping.modal_ratio, is_large, most, inside)

    def _expanded(self, local: LocalSystem) -> Expanded:
        """The system made ready for statics; that of the point before where its matrices are the same to the last bit."""
        about = local.stiffness_about
        key = b"".join(x.tobytes() for A in (local.M, about, local.B) for x in (A.data, A.indices, A.indptr))
        if self._expanded_last is None or key != self._expanded_last[0]:
            self._expanded_last = key, Expanded(local)
        return self._expanded_last[1]


def speed_of_all(model: Model) -> float:
    """The speed in rad/s at which models are made whose state at rest serves all speeds of their sense."""
    return 1.0 if (model.operating_speed or 0.0) > 0.0 else -1.0


def _in_time(system: System, speed: float) -> LocalModel:
    """The model as motions in time take it at a speed of the reference in rad/s."""
    return springs_about_mean(local_model(system, Rotation.constant(speed), speed), speed)


def at_rest(
    local: LocalSystem, orders: list[Fraction], contact: tuple[str, ...], expanded: Expanded | None = None
) -> AtRest:
    """Find the state at rest of a system with local forces.

    Args:
        local: the system. orders: periods of what varies in a turn of the reference. contact: names of its mesh contacts.
        expanded: the system made ready for statics, where it is.
    """
    expanded = expanded or Expanded(local)
    rest = expanded.equilibrium(local)
    mean = replace(local, forces=local.forces.mean)
    found = expanded.equilibrium(mean)
    # Contacts that are open at rest: what the driving flanks alone would carry.
    usable = found.converged and bool(np.all(np.isfinite(found.force)))
    static = found.force if usable else local.forces.reference_stiffness @ (local.B.T @ rest.q)
    static = over_a_turn(local.sisters, static)
    at_zero, _ = local_tangent(mean, np.zeros(local.m), 0.0)
    drifts = bool(rest.free.shape[1]) and unbalanced(local, rest.free, at_zero, expanded.separate)
    return AtRest(local, orders, contact, rest, static, drifts)


def ready_reduced(points: Sequence[Large], found: Sequence[tuple[LocalSystem, Shapes]]) -> Iterator[Point]:
    """Make points ready that share a `key`, each with its system in their common basis."""
    expanded = Expanded(found[0][0])
    first: AtRest | None = None
    for point, (local, shapes) in zip(points, found, strict=True):
        inside = point.inside and point.inside.within(shapes.vectors)
        known = replace(at_rest(local, point.orders, point.contact, expanded), shapes=shapes, inside=inside)
        known = known.about(first) if first else known
        first = first or known
        yield ready(known, point.speed, point.modal_ratio)


def ready(known: AtRest, speed: float, modal_ratio: float = 0.0) -> Point:
    """Make a system ready at a speed of the reference in rad/s; `modal_ratio` is added to every mode with strain."""
    fastest, turns = known.period
    laws = known.local.forces.laws
    columns = Columns.of([column for law in laws for column in law.columns(speed)])
    order = float(np.copysign(float(fastest), speed))
    one_at_a_time = known.own_laws(columns.kind == OWN_LAW, 1.0 / order)
    inside = known.inside.at(speed) if known.inside else ()
    w = float(fastest) * abs(speed)
    system = small_system(known.still, speed, columns, one_at_a_time, w, turns, modal_ratio, inside)
    # What the drive carries stays at its speed, whatever acts on it.
    drifts = len(system.carried) < len(system.rigid) and known.drifts
    counted = columns.counted
    return Point(
        system,
        replace(known.local.forces),  # without what was derived on the way: many points are kept
        order,
        known.contact,
        known.static[counted],
        columns.stiffness[counted],
        drifts,
        known.rolling,
        known.shape,
    )


def table_of(point: Point, steps: int) -> np.ndarray:
    """Tables of a point over its common period, (2 turns steps + 1, m, 4)."""
    from rotorgear.solvers.batch.kernel_parts import tabulate

    rows = 2 * point.system.turns * steps + 1
    angles = np.pi / steps / point.order * np.arange(rows)
    forces = point.forces
    states = np.zeros((rows, max(1, int(forces.state_first[-1]))))
    tabulate(forces.arguments(), angles, states)
    table = np.zeros((rows, forces.m, TABLE_ROWS))
    for i, law in enumerate(forces.laws):
        state = states[:, forces.state_first[i] : forces.state_first[i + 1]]
        table[:, forces.first[i] : forces.first[i + 1]] = law.table(angles, state, point.order)
    return table
