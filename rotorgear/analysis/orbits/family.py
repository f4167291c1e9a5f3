"""The local system of a model over one or two parameters, and what of it excites."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise

import numpy as np
import scipy.sparse as sp

from rotorgear.analysis.orbits.between import Between, between
from rotorgear.analysis.sweep.axes import number_places
from rotorgear.analysis.sweep.point import orders_of, shared_period
from rotorgear.analysis.transient.request import prepare
from rotorgear.errors import AnalysisError
from rotorgear.model.address import changed, tables_of, value_at
from rotorgear.model.model import Model
from rotorgear.model.parts.old_names import current_address
from rotorgear.solvers.batch.columns import PRESCRIBED
from rotorgear.solvers.periodic.plant import Plant, Plants
from rotorgear.solvers.time.local_forces import LocalLaw, gather
from rotorgear.solvers.time.local_system import LocalSystem, Rotation
from rotorgear.system.local import LocalModel

# Periods of the fastest mesh that a motion may take at most: unknowns grow with them.
MOST_TURNS = 8
SPEED = "operation.speed"
_KEPT = 400
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
    from rotorgear.analysis.sweep.axes import axis_of

    address = current_address(address)
    parts = ends.split(":") if isinstance(ends, str) else list(ends)
    if len(parts) != 2:
        raise AnalysisError(f"over {address}: got '{ends}', expected FROM:TO such as '3000 rpm:6000 rpm'")
    axis = axis_of(address, [part.strip() if isinstance(part, str) else part for part in parts])
    first, last = axis.values
    if first == last:
        raise AnalysisError(f"over {address}: both ends are {first:g}, expected two different values")
    data = tables_of(model)
    places = number_places(data, address)
    found = []
    for value in (first, last):
        own = Model(**changed(data, [(places, axis.text(value))]))
        read = value_at(tables_of(own), places[0])
        read = read.get("radial") if isinstance(read, dict) else read
        if not isinstance(read, int | float):
            raise AnalysisError(f"over {address}: it is no number that can be followed")
        found.append(float(read))
    per_unit = (found[1] - found[0]) / (last - first) if axis.unit else 1.0
    return Range(address, found[0], found[1], axis.unit, per_unit)


class SystemFamily:
    """Plants of a model over the shares (0 to 1) of one or two ranges.

    Args:
        model: the model. ranges: what changes. excite: name of what excites alone. elements: in each shaft segment.
    """

    def __init__(self, model: Model, ranges: Sequence[Range], excite: str | None, elements: int | None) -> None:
        self._data = tables_of(model)
        self._ranges = ranges
        self._places = [number_places(self._data, one.address) for one in ranges]
        self._elements = elements
        self._speed_axis = next((i for i, one in enumerate(ranges) if one.address == SPEED), None)
        if self._speed_axis is not None and ranges[self._speed_axis].begin * ranges[self._speed_axis].end <= 0.0:
            raise AnalysisError(f"over {SPEED}: the range must not reach standstill, where nothing repeats")
        self._plants = Plants()
        self._known: dict[tuple[float, ...], Plant] = {}
        self._systems: dict[tuple[float, ...], LocalSystem] = {}
        self._through: Between | None = None
        self._asked_between = False
        first = self.model_at([0.0] * len(ranges))
        if not first.operation or not first.operation.speed:
            raise AnalysisError("the model gives no speed of operation: set operation.speed, or follow over it")
        # Whether another speed changes nothing but the rotation. The place of a journal goes with it: its heat balance, and the
        # teeth that feel the tilt of its shaft.
        films = [bearing.film for bearing in first.bearings.values() if bearing.film is not None]
        self._free_speed = self._speed_axis is not None and not (
            first.operation.power is not None
            or any(load.power is not None or load.speed_power for load in first.loads.values())
            or any(bearing.table for bearing in first.bearings.values())
            or any(shaft.internal_damping for shaft in first.shafts.values())
            or any(film.settles for film in films)
            or (films and first.meshes)
            or first.nonlinear_elements
        )
        self.local, self.rest, self.static_force, _ = self._built([0.0] * len(ranges))
        self.order, self.excited, self.notes = _excitation(self.local, excite)
        self._varied = [i for i, part in enumerate(self.local.parts) if _keeps(part.law, self.order)]
        # A force that neither varies nor depends on the motion is a load.
        self._acting = [
            i
            for i, part in enumerate(self.local.parts)
            if self._varies(i) or any(column.kind != PRESCRIBED for column in part.law.columns())
        ]
        self.parts = tuple(self.local.parts[i] for i in self._acting)

    @property
    def label(self) -> str:
        """What excites, in words."""
        return ", ".join(self.excited)

    def model_at(self, shares: Sequence[float]) -> Model:
        """The model at shares of the ranges."""
        values = [one.at(share) for one, share in zip(self._ranges, shares, strict=True)]
        return Model(**changed(self._data, zip(self._places, values, strict=True)))

    def _built(self, shares: Sequence[float]) -> tuple[LocalModel, object, np.ndarray, float]:
        task = prepare(self.model_at(shares), None, self._elements)
        local = task.local
        ratio = local.system.model.damping.modal_ratio
        if ratio:
            local = replace(local, local=with_modal_damping(local.local, ratio))
        return local, task.rest, task.rest_force, task.largest

    def system(self, shares: Sequence[float]) -> LocalSystem:
        """The local system at shares of the ranges, what does not excite at its mean."""
        key = list(shares)
        speed = None
        if self._free_speed:
            assert self._speed_axis is not None
            speed = self._ranges[self._speed_axis].at(key[self._speed_axis])
            key[self._speed_axis] = 0.0
        own = self._systems.get(tuple(key))
        if own is None:
            own = self._between(key) or self._exact(key)
            if len(self._systems) > _KEPT:
                self._systems.clear()
            self._systems[tuple(key)] = own
        if speed is None:
            return own
        turned = replace(own, rotation=Rotation.constant(speed))
        # Sums of the same matrices: computed once for both.
        for name in ("stiffness_about", "damping_about"):
            turned.__dict__[name] = getattr(own, name)
        return turned

    def _exact(self, shares: Sequence[float]) -> LocalSystem:
        """The system assembled at shares of the ranges."""
        return self._with_means((self._built(shares)[0] if any(shares) else self.local).local)

    def _between(self, shares: Sequence[float]) -> LocalSystem | None:
        """The system between exact ones where a single range, besides a speed that only turns, leads there smoothly."""
        moving = [i for i in range(len(shares)) if not (self._free_speed and i == self._speed_axis)]
        if len(moving) != 1 or shares[moving[0]] in (0.0, 1.0) or not -_BEYOND < shares[moving[0]] < 1.0 + _BEYOND:
            return None
        own = moving[0]
        if not self._asked_between:
            self._asked_between = True
            base = [0.0] * len(shares)
            over = self._ranges[own]

            def exact(share: float) -> LocalSystem:
                return self._exact([*base[:own], share, *base[own + 1 :]])

            if own == self._speed_axis:
                self._through = between(exact, lambda share: over.at(share) / over.begin)
            else:
                self._through = between(exact)
        return self._through.at(shares[own]) if self._through else None

    def _varies(self, i: int) -> bool:
        return i in self._varied and not self.local.parts[i].law.steady

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
        return [p, *[0.0] * (len(self._ranges) - 1)]

    def plant(self, *shares: float) -> Plant:
        """The plant at shares of the ranges, those not given 0."""
        shares = (*shares, *[0.0] * (len(self._ranges) - len(shares)))
        if shares not in self._known:
            if len(self._known) > _KEPT:
                self._known.clear()
            self._known[shares] = self._plants.of(self.system(shares))
        return self._known[shares]


def _keeps(law: LocalLaw, order: float) -> bool:
    """Whether a law stays as it is: it repeats with the base period, or nothing of it varies."""
    ratios = [each.order / order for each in law.repeats()]
    return all(abs(ratio - round(ratio)) < 1e-6 and round(ratio) >= 1 for ratio in ratios)


def _excitation(local: LocalModel, excite: str | None) -> tuple[float, tuple[str, ...], tuple[str, ...]]:
    """Base order, labels of what excites, and sentences on what is at its mean.

    Raises:
        AnalysisError: nothing repeats, or only after too long a time.
    """
    for part in local.parts:
        if why := part.law.unsettled():
            raise AnalysisError(f"{part.part}: {why.replace('sweeps', 'orbits').replace('sweep', 'orbits')}")
    varying = [part for part in local.parts if not part.law.steady]
    if excite is None:
        chosen = varying
    else:
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
    orders: list[Fraction] = []
    for part in chosen:
        orders += orders_of(part.law, part.label)
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
    still = sorted({p.part for p in varying if not _keeps(p.law, base)})
    notes = (f"excitation by {', '.join(still)}: at its mean, because one stage excites at a time",) if still else ()
    return base, labels, notes


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


_MOST_DENSE = 600
