"""What a transient records beside its contacts: bearing forces, motions of points, bearings and gears, as rows on q, v and a."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rotorgear.analysis.common.points import point_rows
from rotorgear.model.parts.fields import DOF_NAMES
from rotorgear.solvers.time.local_system import Fields, Observed
from rotorgear.system.local import LocalModel

_AXES = ("x", "y", "z")


@dataclass(frozen=True)
class Channels:
    """p channels: value = Y_q q + Y_v v + Y_a a + Y_F F, with rows (p, n) and (p, m) by kind for those that have any."""

    names: tuple[str, ...]
    units: tuple[str, ...]
    rows: dict[str, tuple[np.ndarray, np.ndarray]]

    def values(self, fields: Fields, F: np.ndarray) -> np.ndarray:
        """Values (r, p) at the recorded steps with the local forces F (r, m)."""
        values = np.zeros((len(F), len(self.names)))
        for kind, (which, Y) in self.rows.items():
            values[:, which] += F @ Y.T if kind == "F" else fields.rows(kind, Y)
        return values

    def observed(self, n: int, m: int) -> Observed:
        """The channels as rows that integrators gather statistics of at every step, for n dofs and m local forces."""
        rows = {kind: np.zeros((len(self.names), m if kind == "F" else n)) for kind in "qvaF"}
        for kind, (which, Y) in self.rows.items():
            rows[kind][which] = Y
        return Observed(**rows)


def channels(local: LocalModel) -> Channels:
    """Return the channels of a model."""
    every: list[tuple[str, str, dict[str, np.ndarray]]] = []
    every += _bearing_forces(local)
    every += _points(local)
    every += _orbits(local)
    every += _rotations(local)
    names = tuple(item[0] for item in every)
    units = tuple(item[1] for item in every)
    rows = {}
    for kind in "qvaF":
        which = np.array([i for i, item in enumerate(every) if kind in item[2]], dtype=int)
        if which.size:
            rows[kind] = (which, np.array([every[i][2][kind] for i in which]))
    return Channels(names, units, rows)


def _row(local: LocalModel, node: int, dof: int) -> np.ndarray:
    return _row_of(local, 6 * node + dof)


def _row_of(local: LocalModel, dof: int) -> np.ndarray:
    return np.asarray(local.system.dofs.transform[[dof], :].toarray()[0])


def _bearing_forces(local: LocalModel) -> list[tuple[str, str, dict[str, np.ndarray]]]:
    """Force of the shaft on each bearing, by its springs and dampers or its rolling elements."""
    forces: list[tuple[str, str, dict[str, np.ndarray]]] = []
    T = local.system.dofs.transform
    beta = local.system.model.damping.rayleigh_beta
    firsts = local.local.forces.first
    rolling = {
        part.part: (int(first), part.law.components)
        for part, first in zip(local.parts, firsts, strict=False)
        if part.part.startswith("bearings.")
    }
    for part, first in zip(local.parts, firsts, strict=False):
        if part.part.startswith("nonlinear_elements."):
            directions = local.system.model.nonlinear_elements[part.label].directions
            for k, direction in enumerate(directions):
                unit = "N" if direction in _AXES else "N m"
                forces.append((f"{part.part} force {direction}", unit, {"F": np.eye(local.local.m)[int(first) + k]}))
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
        for k, axis in enumerate(_AXES):
            rows = {} if group.part in rolling else {"q": stiffness[-6 + k] @ motions}
            if group.part in rolling and k < rolling[group.part][1]:
                rows["F"] = np.eye(local.local.m)[rolling[group.part][0] + k]
            if damping.any():
                rows["v"] = damping[-6 + k] @ motions
            if any(row.any() for row in rows.values()):
                forces.append((f"{group.part} force {axis}", "N", rows))
    return forces


def _points(local: LocalModel) -> list[tuple[str, str, dict[str, np.ndarray]]]:
    """Displacement, velocity and acceleration of each named point in its direction."""
    histories = []
    for name, point in local.system.model.points.items():
        dof = DOF_NAMES.index(point.direction)
        row = point_rows(local.system, (name,)).toarray()[0]
        unit = "m" if dof < 3 else "rad"
        for kind, what, per in (("q", "displacement", ""), ("v", "velocity", "/s"), ("a", "acceleration", "/s^2")):
            histories.append((f"points.{name} {what}", unit + per, {kind: row}))
    return histories


def _orbits(local: LocalModel) -> list[tuple[str, str, dict[str, np.ndarray]]]:
    """x and y of the shaft in each bearing."""
    model = local.system.model
    orbits = []
    for name in model.bearings:
        node = local.system.nodes.at(*local.system.layout.place(f"bearings.{name}"))
        for dof, axis in ((0, "x"), (1, "y")):
            row = _row(local, node, dof)
            if row.any():
                orbits.append((f"bearings.{name} displacement {axis}", "m", {"q": row}))
    return orbits


def _rotations(local: LocalModel) -> list[tuple[str, str, dict[str, np.ndarray]]]:
    """Fluctuation of the speed of each gear; of one whose teeth turn against its shaft, that of the teeth."""
    model = local.system.model
    fluctuations = []
    for name in model.gears:
        row = _row_of(local, int(local.system.nodes.of_gear(name, *local.system.layout.place(f"gears.{name}"))[5]))
        if row.any():
            fluctuations.append((f"gears.{name} speed fluctuation", "rad/s", {"v": row}))
    return fluctuations
