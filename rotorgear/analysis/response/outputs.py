"""What is read of a plant at places: motions of points and parts, and loads inside shafts and couplings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rotorgear.analysis.common.points import moving_rows, rotates
from rotorgear.analysis.response.plant import Plant
from rotorgear.model.model import Model
from rotorgear.system.internal_loads import read_loads


@dataclass(frozen=True)
class Outputs:
    """Rows (o, n) of o outputs on displacements, velocities and accelerations: y = q_rows q + v_rows v + a_rows a."""

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray

    @property
    def moves_only(self) -> bool:
        """Whether all of them are displacements."""
        return not (np.any(self.v) or np.any(self.a))

    @property
    def touched(self) -> np.ndarray:
        """(o, n) which displacements each of them reads."""
        return (self.q != 0.0) | (self.v != 0.0) | (self.a != 0.0)

    def cut(self, dofs: np.ndarray) -> Outputs:
        """The rows on some dofs."""
        return Outputs(self.q[:, dofs], self.v[:, dofs], self.a[:, dofs])

    def within(self, basis: np.ndarray) -> Outputs:
        """The rows on the coordinates of a basis (n, s)."""
        return Outputs(self.q @ basis, self.v @ basis, self.a @ basis)

    def of(self, w: np.ndarray, q: np.ndarray) -> np.ndarray:
        """Amplitudes (f, o, i) of displacements q (f, n, i) at frequencies w (f,) in rad/s."""
        found = self.q @ q
        if self.moves_only:
            return np.asarray(found)
        w = w[:, None, None]
        return np.asarray(found + 1j * w * (self.v @ q) - w**2 * (self.a @ q))


def output_rows(plant: Plant, names: Sequence[str], speed: float) -> Outputs:
    """The rows of places and of points that read a load, at a reference speed in rad/s.

    Raises:
        AnalysisError: a place that the model has not, or one that can't move.
    """
    known = list(read_loads(plant.system.model))
    loads = plant.load_rows(speed)
    moved = iter(moving_rows(plant.system, [name for name in names if name not in known]))
    none = np.zeros(plant.system.n)
    rows = [
        (loads.q[k], loads.v[k], loads.a[k]) if (k := _place(known, name)) is not None else (next(moved), none, none)
        for name in names
    ]
    return Outputs(*(np.array(kind).reshape(len(names), -1) for kind in zip(*rows, strict=True)))


def _place(known: list[str], name: str) -> int | None:
    return known.index(name) if name in known else None


def output_unit(model: Model, name: str) -> str:
    """Unit of an output.

    Raises:
        AnalysisError: a place that the model has not.
    """
    loads = read_loads(model)
    return loads[name] if name in loads else "rad" if rotates(model, name) else "m"
