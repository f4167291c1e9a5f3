"""The local system of a model over one or two parameters, what of it excites, and the displacements that tell its motions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
import scipy.sparse as sp

from rotorgear.analysis.common.discretise import plan_in_time
from rotorgear.analysis.orbits.between import Between, between
from rotorgear.analysis.sweep.axes import axis_of, number_places
from rotorgear.analysis.sweep.point import depends_on_speed, orders_of, shared_period
from rotorgear.analysis.transient.request import prepare
from rotorgear.errors import AnalysisError, ConvergenceError, ModelError
from rotorgear.model.address import changed, tables_of, value_at
from rotorgear.model.model import Model
from rotorgear.model.parts.carrier import MARK
from rotorgear.model.parts.fields import DOF_NAMES
from rotorgear.note import Note
from rotorgear.solvers.batch.columns import PRESCRIBED
from rotorgear.solvers.periodic.plant import Plant, Plants
from rotorgear.solvers.periodic.samples import MotionCycle
from rotorgear.solvers.time.local_forces import LocalLaw, gather
from rotorgear.solvers.time.local_system import LocalSystem, Rotation
from rotorgear.system.internal_loads import LoadRows, load_rows, read_loads
from rotorgear.system.local import LocalModel
from rotorgear.system.planets import NotSeenFromCarrierError, turning_carriers
from rotorgear.system.system import System, flow_system

# Periods of the fastest mesh that a motion may take at most: unknowns grow with them.
MOST_TURNS = 8
SPEED = "operation.speed"
_KEPT = 400
# Dofs up to which damping by modes is a matrix.
_MOST_DENSE = 600
# Shares beyond the ends of a range at which a step is looked at before it is cut: numbers between exact systems hold there, too.
_BEYOND = 0.05


@dataclass(frozen=True)
class Range:
    """A parameter: address, both ends in SI, unit it was given in and SI of one of it."""

    address: str
    begin: float
    end: float
    unit: str
    per_unit: float

    def at(self, share: float) -> float:
        """The value at a share of the range."""
        return self.begin + share * (self.end - self.begin)


def range_of(model: Model, address: str, ends: str | Sequence[float | str]) -> Range:
    """A range from a text "FROM:TO" or two values.

    Raises:
        AnalysisError: no two different values, or an address that leads nowhere.
    """
    parts = ends.split(":") if isinstance(ends, str) else list(ends)
    if len(parts) != 2:
        raise AnalysisError(f"over {address}: got '{ends}', expected FROM:TO such as '3000 rpm:6000 rpm'")
    axis = axis_of(address, [part.strip() if isinstance(part, str) else part for part in parts])
    first, last = axis.values
    if first == last:
        raise AnalysisError(f"over {address}: both ends are {first:g}, expected two different values")
    data = tables_of(model)
    places = number_places(data, address)
    # Both ends in SI, as the model reads them.
    read = [value_at(tables_of(Model(**changed(data, [(places, axis.text(x))]))), places[0]) for x in axis.values]
    begin, end = (value.get("radial") if isinstance(value, dict) else value for value in read)
    if not (isinstance(begin, int | float) and isinstance(end, int | float)):
        raise AnalysisError(f"over {address}: it is no number that can be followed")
    return Range(address, float(begin), float(end), axis.unit, (end - begin) / (last - first) if axis.unit else 1.0)


class SystemFamily:
    """Plants of a model over the shares (0 to 1) of one or two ranges.

    Args:
        model: the model. ranges: what changes. excite: name of what excites alone. elements: in each shaft segment.
    """

    def __init__(self, model: Model, ranges: Sequence[Range], excite: str | None, elements: int | None) -> None:
        self.ranges = ranges
        self._data = tables_of(model)
        self._places = [number_places(self._data, one.address) for one in ranges]
        self._elements = elements
        self._speed_axis = next((i for i, one in enumerate(ranges) if one.address == SPEED), None)
        if self._speed_axis is not None and ranges[self._speed_axis].begin * ranges[self._speed_axis].end <= 0.0:
            raise AnalysisError(f"over {SPEED}: the range must not reach standstill, where nothing repeats")
        self._plants = Plants()
        self._known: dict[tuple[float, ...], Plant] = {}
        self._systems: dict[tuple[float, ...], LocalSystem] = {}
        first = self._model_at([0.0] * len(ranges))
        if not first.operating_speed:
            raise AnalysisError("the model gives no speed of operation: set operation.speed, or follow over it")
        # The axis of a speed that changes nothing but the rotation. The place of a journal goes with it: its heat balance, and
        # the teeth that feel the tilt of its shaft.
        films = [bearing.film for bearing in first.bearings.values() if bearing.film is not None]
        held = depends_on_speed(first) or any(film.settles for film in films) or (films and first.meshes)
        self._turning = None if held else self._speed_axis
        self._moving = [i for i in range(len(ranges)) if i != self._turning]
        self.local = self._built([0.0] * len(ranges))
        self.order, excited, self.notes = _excitation(self.local, excite)
        if self.local.system.is_seen_from_carrier:
            seen = "are told in axes that turn with the carrier"
            carriers = turning_carriers(self.local.system.layout)
            self.notes += tuple(Note(f"carriers.{one.carrier}", "motions across shafts", seen) for one in carriers)
        # What excites, in words.
        self.label = ", ".join(excited)
        self._varied = [i for i, part in enumerate(self.local.parts) if _keeps(part.law, self.order)]
        # A force that neither varies nor depends on the motion is a load.
        self._acting = [
            i
            for i, part in enumerate(self.local.parts)
            if (i in self._varied and not part.law.steady)
            or any(column.kind != PRESCRIBED for column in part.law.columns())
        ]
        self.parts = tuple(self.local.parts[i] for i in self._acting)
        # Points that read a load, with its unit.
        self.loads = read_loads(first)
        self._rows = load_rows(self.local.system) if self.loads else None

    def _model_at(self, shares: Sequence[float]) -> Model:
        values = [one.at(share) for one, share in zip(self.ranges, shares, strict=True)]
        return Model(**changed(self._data, zip(self._places, values, strict=True)))

    def _built(self, shares: Sequence[float]) -> LocalModel:
        model = self._model_at(shares)
        if not turning_carriers(model.layout):
            local = prepare(model, None, self._elements).local
        else:
            # Seen from their carrier planets have the period of their meshes; from rest, a turn of the carrier.
            system = flow_system(model, plan_in_time(self._elements)).seen_from_carrier()
            _require_loads_along(system)
            try:
                local = prepare(system, None, self._elements).local
            except NotSeenFromCarrierError as error:
                carrier = turning_carriers(model.layout)[0].carrier
                raise AnalysisError(
                    f"carriers.{carrier}: motions of planets that go round repeat with their meshes as seen from their carrier "
                    f"alone, and {error.why}; from rest they repeat with a turn of the carrier, which takes too many harmonics. "
                    "Leave that out, or ask for a sweep, whose common period may be such a turn."
                ) from None
        ratio = local.system.model.damping.modal_ratio
        return replace(local, local=with_modal_damping(local.local, ratio)) if ratio else local

    def load_rows(self, p: float) -> LoadRows | None:
        """The rows of the loads inside shafts and couplings with the first range at p; None where no point reads one."""
        if self._rows is None:
            return None
        shares = self.shares_at(p)
        turns_alone = self._turning == 0
        rows = self._rows if turns_alone or not any(shares) else load_rows(self._built(shares).system)
        return rows.at(self.plant(p).speed)

    def system(self, shares: Sequence[float]) -> LocalSystem:
        """The local system at shares of the ranges, what does not excite at its mean."""
        key = list(shares)
        if self._turning is not None:
            key[self._turning] = 0.0
        own = self._systems.get(tuple(key))
        if own is None:
            share = key[self._moving[0]] if len(self._moving) == 1 else 0.0
            near = self._through if share not in (0.0, 1.0) and -_BEYOND < share < 1.0 + _BEYOND else None
            own = near.at(share) if near else self._exact(key)
            if len(self._systems) > _KEPT:
                self._systems.clear()
            self._systems[tuple(key)] = own
        if self._turning is None:
            return own
        turned = replace(own, rotation=Rotation.constant(self.ranges[self._turning].at(shares[self._turning])))
        # Sums of the same matrices: computed once for both.
        for name in ("stiffness_about", "damping_about"):
            turned.__dict__[name] = getattr(own, name)
        return turned

    def _exact(self, shares: Sequence[float]) -> LocalSystem:
        """The system assembled at shares of the ranges.

        Raises:
            ConvergenceError: beyond an end of a range, where an iteration may look, there is no such model.
        """
        try:
            local = self._built(shares) if any(shares) else self.local
        except (AnalysisError, ModelError):
            if all(0.0 <= share <= 1.0 for share in shares):
                raise
            raise ConvergenceError("a step leaves the range for values that no model has") from None
        return self._with_means(local.local)

    @cached_property
    def _through(self) -> Between | None:
        """Numbers between exact systems, where one range alone, besides a speed that only turns, leads there smoothly."""
        own = self._moving[0]
        over = self.ranges[own]

        def exact(share: float) -> LocalSystem:
            return self._exact([share if i == own else 0.0 for i in range(len(self.ranges))])

        def factor(share: float) -> float:
            return over.at(share) / over.begin if own == self._speed_axis else 1.0

        return between(exact, factor)

    def _with_means(self, local: LocalSystem) -> LocalSystem:
        """The system with what does not excite at its mean, constant forces as loads."""
        forces = local.forces
        laws = tuple(law if i in self._varied else law.mean() for i, law in enumerate(forces.laws))
        columns = [np.arange(a, b) for a, b in pairwise(forces.first)]
        load = local.load.copy()
        for i in set(range(len(laws))) - set(self._acting):
            load -= local.B[:, columns[i]] @ laws[i].evaluate(0.0).force  # type: ignore[attr-defined]
        kept = np.concatenate([*(columns[i] for i in self._acting), np.zeros(0, int)])
        acting = replace(
            gather(tuple(laws[i] for i in self._acting)),
            reference_stiffness=forces.reference_stiffness[np.ix_(kept, kept)],
            reference_damping=forces.reference_damping[np.ix_(kept, kept)],
        )
        return replace(local, B=sp.csc_array(local.B[:, kept]), forces=acting, load=load, observed=None)

    def shares_at(self, p: float) -> list[float]:
        """Shares of all ranges with the first one at p."""
        return [p, *[0.0] * (len(self.ranges) - 1)]

    def plant(self, *shares: float) -> Plant:
        """The plant at shares of the ranges, those not given 0."""
        shares = (*shares, *[0.0] * (len(self.ranges) - len(shares)))
        if shares not in self._known:
            if len(self._known) > _KEPT:
                self._known.clear()
            self._known[shares] = self._plants.of(self.system(shares))
        return self._known[shares]


def _require_loads_along(system: System) -> None:
    """Refuse loads across shafts that do not go round, which have no period as seen from a carrier.

    Raises:
        AnalysisError: naming the first point that reads one.
    """
    for name, point in system.model.points.items():
        if point.quantity in ("shear", "bending") and MARK not in f"{point.on or point.shaft}":
            raise AnalysisError(
                f"points.{name}: motions of planets that go round are told as seen from their carrier, where bending and shear "
                "of shafts beside them turn. Read torque or axial force, or ask for a transient."
            )


def _keeps(law: LocalLaw, order: float) -> bool:
    """Whether a law stays as it is: it repeats with the base period, or nothing of it varies."""
    ratios = [each.order / order for each in law.repeats()]
    return all(abs(ratio - round(ratio)) < 1e-6 and round(ratio) >= 1 for ratio in ratios)


def _excitation(local: LocalModel, excite: str | None) -> tuple[float, tuple[str, ...], tuple[Note, ...]]:
    """Base order, labels of what excites, and facts on what is at its mean.

    Raises:
        AnalysisError: nothing repeats, or only after too long a time.
    """
    for part in local.parts:
        if why := part.law.unsettled():
            raise AnalysisError(f"{part.part}: {why.replace('sweeps', 'orbits').replace('sweep', 'orbits')}")
    varying = [part for part in local.parts if not part.law.steady]
    chosen = varying
    if excite is not None:
        name = excite.rpartition(".")[2]
        chosen = [p for p in varying if name in (p.part.rpartition(".")[2], p.label)]
        chosen = chosen or [p for p in varying if p.part.rpartition(".")[2].startswith(name)]
        if not chosen:
            known = sorted({p.part for p in varying}) or ["none"]
            raise AnalysisError(f"excite: nothing that excites is named '{excite}'; there are {', '.join(known)}")
    rolling = [p for p in chosen if any(not each.common for each in p.law.repeats())]
    cycling = [p for p in local.parts if p.law.mean().cycle() and p not in chosen]
    if rolling or cycling:
        named = ", ".join(sorted({p.part for p in (*rolling, *cycling)}))
        raise AnalysisError(
            f"{named}: cages never repeat with the teeth, so there are no periodic motions; give a stiffness in place of the "
            "rolling elements, or take sweep"
        )
    orders = [order for part in chosen for order in orders_of(part.law, part.label)]
    if not orders:
        raise AnalysisError(
            "nothing excites: no transmission error, stiffness variation, unbalance or torque ripple repeats as the shafts turn"
        )
    fastest, turns = shared_period(orders)
    if turns > MOST_TURNS:
        meshes = [p.part for p in chosen if p.is_mesh] or [p.part for p in chosen]
        parts = list(dict.fromkeys(name.rpartition(".")[2] for name in meshes))
        period = 2.0 * np.pi * turns / (float(fastest) * abs(float(local.local.rotation.speeds[0])))
        raise AnalysisError(
            f"what excites repeats together only after {turns} periods of the fastest mesh, {period:.4g} s at the first speed "
            f"(at most {MOST_TURNS} periods): excite one stage at a time, the others at their mean, as by --excite {parts[0]}; "
            f"there are {', '.join(parts)}"
        )
    base = float(fastest / turns)
    labels = tuple(dict.fromkeys(p.part for p in varying if _keeps(p.law, base)))
    why = "one stage excites at a time, all else at its mean"
    still = {p.part: "" if _is_mean_free(p.law) else "what varies" for p in varying if not _keeps(p.law, base)}
    return base, labels, tuple(Note(part, still[part], why) for part in sorted(still))


def _is_mean_free(law: LocalLaw) -> bool:
    """Whether nothing is left of a law at its mean, such as of an unbalance."""
    given = all(column.kind == PRESCRIBED for column in law.columns())
    return given and not np.any(law.mean().evaluate(0.0).force)  # type: ignore[attr-defined]


def with_modal_damping(local: LocalSystem, ratio: float) -> LocalSystem:
    """The system with the same damping ratio added to every elastic mode.

    Raises:
        AnalysisError: too many dofs for all modes.
    """
    import scipy.linalg as la

    if local.n > _MOST_DENSE:
        raise AnalysisError(
            f"damping.modal_ratio asks for all modes of {local.n} dofs (at most {_MOST_DENSE}): give rayleigh damping instead"
        )
    M = local.M.toarray()
    K = local.stiffness_about.toarray()
    w2, V = la.eigh(0.5 * (K + K.T), M)
    w = np.sqrt(np.maximum(w2, 0.0))
    w[w < 1e-6 * w[-1]] = 0.0
    MV = M @ V
    return replace(local, D=sp.csc_array(local.D + (MV * (2.0 * ratio * w)) @ MV.T))


_PLACES = ("bearings", "nonlinear_elements", "unbalances")


@dataclass(frozen=True)
class Outputs:
    """All that a result tells of a motion, by columns of the local displacements.

    Attributes:
        contact: labels of the mesh contacts; contact_column, contact_law: their columns and the numbers of their laws.
        transverse: (c,) displacement of a contact over its approach in the transverse plane.
        place: names of the others, such as "bearings.front x"; place_column: theirs; place_unit: m or rad.
    """

    contact: tuple[str, ...]
    contact_column: np.ndarray
    contact_law: np.ndarray
    transverse: np.ndarray
    place: tuple[str, ...]
    place_column: np.ndarray
    place_unit: tuple[str, ...]

    @property
    def columns(self) -> np.ndarray:
        """The local displacements that tell one motion from another: of the contacts; without any, of the places."""
        if self.contact:
            return self.contact_column
        along = [unit == "m" for unit in self.place_unit]
        return self.place_column[along] if any(along) else self.place_column

    def extremes(self, cycle: MotionCycle) -> tuple[np.ndarray, np.ndarray]:
        """Least and largest approach of the contacts, (c, 2), and displacements of the places, (k, 2)."""
        both = cycle.extremes()
        return both[self.contact_column] / self.transverse[:, None], both[self.place_column]


def outputs_of(family: SystemFamily) -> Outputs:
    """Contacts and the displacements across bearings, nonlinear elements and at unbalances.

    Raises:
        AnalysisError: the model has neither.
    """
    plant = family.plant(0.0)
    firsts = plant.forces.first[:-1]
    law = np.array([i for i, part in enumerate(family.parts) if part.is_mesh], int)
    elements = family.local.system.model.nonlinear_elements
    places: list[tuple[str, int, str]] = []
    for part, first in zip(family.parts, firsts, strict=True):
        table = part.part.partition(".")[0]
        axes = DOF_NAMES[: part.law.components] if table in _PLACES else ()
        if table == "nonlinear_elements":
            axes = elements[part.label].directions
        # A displacement that supports hold is always zero.
        places += [
            (f"{part.part} {axis}", k, "rad" if axis in DOF_NAMES[3:] else "m")
            for k, axis in enumerate(axes, int(first))
            if plant.B[:, k].any()
        ]
    outputs = Outputs(
        contact=tuple(family.parts[i].label for i in law),
        contact_column=firsts[law],
        contact_law=law,
        transverse=np.array([family.parts[i].transverse for i in law]),
        place=tuple(label for label, _, _ in places),
        place_column=np.array([k for _, k, _ in places], int),
        place_unit=tuple(unit for _, _, unit in places),
    )
    if not outputs.columns.size:
        raise AnalysisError(
            "nothing tells one motion from another: orbits looks at meshes, bearings of rolling elements or oil films, nonlinear "
            "elements and unbalances, and the model has none of them; response solves for its forced motions"
        )
    return outputs
