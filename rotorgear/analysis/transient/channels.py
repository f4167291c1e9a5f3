"""What a transient records beside its contacts: bearing forces, motions of points, bearings and gears, loads inside shafts.

They are rows on q, v and a.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rotorgear.analysis.common.points import motion_points, point_rows
from rotorgear.analysis.static.mean_state import springs_about_mean
from rotorgear.errors import AnalysisError
from rotorgear.model.parts.fields import DOF_NAMES
from rotorgear.solvers.time.arguments import Sisters
from rotorgear.solvers.time.local_system import Observed, Records
from rotorgear.solvers.time.sisters import sisters_of, turning_matrix
from rotorgear.system.internal_loads import load_rows, read_loads
from rotorgear.system.local import LocalModel
from rotorgear.system.planets import sister_places
from rotorgear.system.rigid_forces import from_loads, on_shafts

_AXES = ("x", "y", "z")


@dataclass(frozen=True)
class Channels:
    """p channels: value = Y_q q + Y_v v + Y_a a + Y_F F + c, with rows (p, n) and (p, m) by kind for those that have any.

    `constant`: c (p,), what weight adds to loads; sums that integrators gather are without it.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    rows: dict[str, tuple[np.ndarray, np.ndarray]]
    constant: np.ndarray

    def values(self, records: Records) -> np.ndarray:
        """Values (r, p) at the recorded steps, of planets that go round as if they stood where they began."""
        values = np.tile(self.constant, (len(records.t), 1))
        rows = self.rows
        if records.system.rates is not None:
            # In a run-up the rates that planets see are those at the speed of the moment.
            whole = records.system.observed_rows
            rows = {kind: (np.arange(len(self.names)), getattr(whole, kind)) for kind in "qvaF"}
        for kind, (which, Y) in rows.items():
            values[:, which] += records.F @ Y.T if kind == "F" else records.rows(kind, Y)
        return values

    def observed(self, n: int, m: int) -> Observed:
        """The channels as rows that integrators gather statistics of at every step, for n dofs and m local forces."""
        rows = {kind: np.zeros((len(self.names), m if kind == "F" else n)) for kind in "qvaF"}
        for kind, (which, Y) in self.rows.items():
            rows[kind][which] = Y
        return Observed(**rows)


def channels(local: LocalModel, speed: float) -> Channels:
    """Forces of bearings, motions of points, orbits of the shafts in their bearings, and fluctuations of the gears' speeds.

    Those of planets that go round are what they see at a speed of the reference in rad/s.
    """
    system = local.system
    every = list(_bearing_forces(local))
    constant = _add_rigid_directions(every, local, speed)
    for name in motion_points(system.model):
        dof = DOF_NAMES.index(system.model.points[name].direction)
        row = point_rows(system, (name,)).toarray()[0]
        unit = "m" if dof < 3 else "rad"
        for kind, what, per in (("q", "displacement", ""), ("v", "velocity", "/s"), ("a", "acceleration", "/s^2")):
            every.append((f"points.{name} {what}", unit + per, {kind: row}))
    for label, unit, by_kind, weight in _internal_loads(local):
        constant[label] = -weight
        every.append((label, unit, by_kind))

    motions = [
        (f"bearings.{name} displacement {axis}", "m", "q", 6 * system.nodes.at(*place) + k)
        for name, place in ((name, system.layout.place(f"bearings.{name}")) for name in system.model.bearings)
        for k, axis in enumerate("xy")
    ]
    for name in system.model.gears:
        # Of a gear whose teeth turn against its shaft, those of the teeth.
        dofs = system.nodes.of_gear(name, *system.layout.place(f"gears.{name}"))
        motions.append((f"gears.{name} speed fluctuation", "rad/s", "v", int(dofs[5])))
    for label, unit, kind, dof in motions:
        row = np.asarray(system.dofs.transform[[dof], :].toarray()[0])
        if row.any():  # the dof is free
            every.append((label, unit, {kind: row}))
    sisters = sisters_of(sister_places(system.layout, [name for name, *_ in every]))
    if sisters.planets.size:
        _see_where_planets_are([item[2] for item in every], speed, sisters)
    rows = {}
    for kind in "qvaF":
        which = np.array([i for i, item in enumerate(every) if kind in item[2]], dtype=int)
        if which.size:
            rows[kind] = (which, np.array([every[i][2][kind] for i in which]))
    names, units, _ = zip(*every, strict=True) if every else ((), (), ())
    return Channels(names, units, rows, np.array([constant.get(name, 0.0) for name in names]))


def _add_rigid_directions(
    every: list[tuple[str, str, dict[str, np.ndarray]]], local: LocalModel, speed: float
) -> dict[str, float]:
    """Add the force in each rigid direction of a bearing, which laws and loads on the dofs that it takes away join in.

    Returns:
        What constant loads add to the channels, by name.
    """
    found: dict[str, float] = {}
    known = {name: by_kind for name, _, by_kind in every}
    named = rigid_channels(local)
    if not named:
        return found
    free = springs_about_mean(local.released, speed).local
    E = local.system.followers
    P = from_loads(local.system)
    D = free.velocity_terms(float(free.rotation.speeds[0]))
    rows = {"q": -(P @ free.K) @ E, "v": -(P @ D) @ E, "a": -(P @ free.M) @ E, "F": -(P @ free.B)}
    for k, name in named.items():
        if name not in known:
            known[name] = {}
            every.append((name, "N", known[name]))
        for kind, whole in rows.items():
            row = np.asarray(whole)[k]
            if row.any():
                known[name][kind] = known[name].get(kind, 0.0) + row
        found[name] = float(P[k] @ free.load)
    return found


def rigid_channels(local: LocalModel) -> dict[int, str]:
    """The channel of each rigid direction of a bearing, by its number among them: of a run-up those without gyroscopic terms."""
    system = local.system
    axes = [(k, f"bearings.{name} force {_AXES[axis]}") for k, (name, axis) in enumerate(on_shafts(system)) if axis < 3]
    if local.local.rotation.is_constant or not axes:
        return dict(axes)
    turning = np.asarray((from_loads(system) @ system.released.gyroscopic) @ system.followers)
    return {k: name for k, name in axes if not turning[k].any()}


def _internal_loads(local: LocalModel) -> Iterator[tuple[str, str, dict[str, np.ndarray], float]]:
    """The load of each point that reads one, by kind of row, and the weight along its element.

    Raises:
        AnalysisError: a load that the speed of the shaft takes part in, where that changes.
    """
    system = local.system
    units = read_loads(system.model)
    if not units:
        return
    rotation = local.local.rotation
    rows = load_rows(system, float(rotation.speeds[0]))
    for k, (name, unit) in enumerate(units.items()):
        if not rotation.is_constant and any(part[k].any() for part in rows.per_speed):
            raise AnalysisError(
                f"points.{name}: gyroscopic moments take part in this load, which is known at a constant speed only: leave the "
                "point out of a run-up, or read a torque or an axial force"
            )
        quantity = system.model.points[name].quantity
        by_kind = {kind: row for kind, row in (("q", rows.q[k]), ("v", rows.v[k]), ("a", rows.a[k])) if row.any()}
        yield f"points.{name} {quantity}", unit, by_kind, float(rows.weight[k])


def _see_where_planets_are(rows: list[dict[str, np.ndarray]], speed: float, sisters: Sisters) -> None:
    """Make the rates in the rows of planets those that they see as they go round: v - W T q, a - 2 W T v + (W T)^2 q."""
    turning = speed * turning_matrix(sisters, len(rows))
    for places, N in zip(sisters.place, sisters.planets, strict=True):
        own = places[:N]
        T = turning[np.ix_(own, own)]
        none = np.zeros_like(next(iter(rows[own[0]].values())))
        q, v, a = (np.array([rows[i].get(kind, none) for i in own]) for kind in "qva")
        for i, of_q, of_v in zip(own, q - T @ v + T @ T @ a, v - 2.0 * T @ a, strict=True):
            rows[i] |= {"q": of_q, "v": of_v}


def _bearing_forces(local: LocalModel) -> Iterator[tuple[str, str, dict[str, np.ndarray]]]:
    """Force of the shaft on each element and bearing, by its law or by its springs and dampers."""
    T = local.system.dofs.transform
    beta = local.system.model.damping.rayleigh_beta
    # Rows that pick the local forces of each law.
    picks = np.split(np.eye(local.local.m), local.local.forces.first[1:-1])
    of_bearing = {part.part: rows for part, rows in zip(local.parts, picks, strict=False)}
    for part, rows in zip(local.parts, picks, strict=False):
        if part.part.startswith("nonlinear_elements."):
            directions = local.system.model.nonlinear_elements[part.label].directions
            for direction, row in zip(directions, rows, strict=True):
                yield f"{part.part} force {direction}", "N" if direction in _AXES else "N m", {"F": row}
    for group in local.groups:
        if not group.part.startswith("bearings.") or group.part.endswith(".pedestal"):
            continue
        motions = T[group.dofs[0], :].toarray()
        matrices = group.matrices
        none = np.zeros((motions.shape[0],) * 2)
        stiffness = sum((A[0] for A in (matrices.stiffness, matrices.circulatory) if A is not None), none)
        damping = none if matrices.damping is None else matrices.damping[0]
        # C = beta K damps in every part that has a stiffness, so a bearing has its share; alpha M is of the masses.
        if beta and matrices.stiffness is not None:
            damping = damping + beta * matrices.stiffness[0]
        law = of_bearing.get(group.part)
        for k, axis in enumerate(_AXES):
            by_kind = {} if law is not None else {"q": stiffness[-6 + k] @ motions}
            if law is not None and k < len(law):
                by_kind["F"] = law[k]
            if damping.any():
                by_kind["v"] = damping[-6 + k] @ motions
            if any(row.any() for row in by_kind.values()):
                yield f"{group.part} force {axis}", "N", by_kind
