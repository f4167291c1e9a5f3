"""Result of a sweep: Poincare sections, Lyapunov exponents, response types and indicators over one or two parameters."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from rotorgear.model.model import Model
from rotorgear.results.portrait import Portraits, portrait_dict
from rotorgear.results.reduction import Reduction


@dataclass(frozen=True)
class SweepResult:
    """p points with r runs each, c mesh contacts, s sections a run, t exponents. NaN where a point or run failed.

    Attributes:
        model: the model whose parameters were changed.
        address, unit: of the a parameters; values: (p, a) in these units; shape: (a,) points along each.
        run: names of the runs of each point: "static", "start 2", "up", "down".
        contact: names of the contacts.
        frequency: (p,) of the fastest mesh in Hz; turns: (p,) its periods in the common one of all meshes.
        section: displacement in m and velocity in m/s of the contacts along their normal (without the transmission error) at the
            end of each least common period, (p, r, s, c, 2).
        motion: (p * r) kinds: "1T", "2T", ..., "quasi-periodic", "chaotic", "not settled", "not periodic", "failed".
        lyapunov, lyapunov_error: (p, r, t) exponents and their standard errors, per period of the fastest mesh.
        peak_to_peak: of the approach d - e, amplitude: of d itself, rms: of d about its mean, (p, r, c) in m.
        mean_force, rms_force, largest_force: (p, r, c) in N, the rms about the mean; static_force: (p, c) in N;
            static_deflection: (p, c) in m.
        driving, apart, back: (p, r, c) shares of the time; losses: (p, r, c) contact losses in a period of the fastest mesh.
        failure: (p,) why a point failed, "" where it did not.
        steps: (p,) in a period of the fastest mesh; settle, count: least common periods that settled and counted.
        tolerance, chaos: of the criterion, see analysis/sweep/classify.py.
        dofs, seconds, method, warnings: cost, and sentences. reduction: how large systems were reduced; None where none was.
        portraits: trajectories of some points, where they were asked for.
    """

    model: Model
    address: tuple[str, ...]
    unit: tuple[str, ...]
    values: np.ndarray
    shape: np.ndarray
    run: tuple[str, ...]
    contact: tuple[str, ...]
    frequency: np.ndarray
    turns: np.ndarray
    section: np.ndarray
    motion: tuple[str, ...]
    lyapunov: np.ndarray
    lyapunov_error: np.ndarray
    peak_to_peak: np.ndarray
    amplitude: np.ndarray
    rms: np.ndarray
    mean_force: np.ndarray
    rms_force: np.ndarray
    largest_force: np.ndarray
    static_force: np.ndarray
    static_deflection: np.ndarray
    driving: np.ndarray
    apart: np.ndarray
    back: np.ndarray
    losses: np.ndarray
    failure: tuple[str, ...]
    steps: np.ndarray
    settle: int
    count: int
    tolerance: float
    chaos: float
    dofs: int
    seconds: dict[str, float]
    method: str
    warnings: tuple[str, ...] = ()
    reduction: Reduction | None = None
    portraits: Portraits | None = None

    @property
    def dynamic_factor(self) -> np.ndarray:
        """(p, r, c) largest force over the static one; NaN where no load flows."""
        static = self.static_force[:, None, :]
        return np.where(static > 0.0, self.largest_force / np.where(static > 0.0, static, 1.0), np.nan)

    @property
    def period_words(self) -> str:
        """The least common period T in words."""
        turns = sorted({int(n) for n in self.turns if n})
        if turns == [1]:
            return "the mesh period"
        return f"{turns[0]}{f' to {turns[-1]}' if len(turns) > 1 else ''} periods of the fastest mesh"

    def motion_at(self, point: int, run: int = 0) -> str:
        """Response type of a run."""
        return self.motion[point * len(self.run) + run]

    def route(self, run: int = 0) -> list[tuple[str, int, int]]:
        """Response types along the points with the first and last point of each."""
        found: list[tuple[str, int, int]] = []
        for p in range(len(self.values)):
            kind = self.motion_at(p, run)
            if found and found[-1][0] == kind:
                found[-1] = (kind, found[-1][1], p)
            else:
                found.append((kind, p, p))
        return found

    def to_dict(self) -> dict[str, Any]:
        """Everything but the sections as plain values for JSON; the keys are documented in docs/json.md."""
        return {
            "analysis": "sweep",
            "title": self.model.title,
            "parameters": [{"address": a, "unit": u} for a, u in zip(self.address, self.unit, strict=True)],
            "points": [self._point(p) for p in range(len(self.values))],
            "portraits": self._portraits(),
            "settle_periods": self.settle,
            "counted_periods": self.count,
            "tolerance": self.tolerance,
            "chaos": self.chaos,
            "dofs": self.dofs,
            "reduction": self.reduction.to_dict() if self.reduction else None,
            "seconds": float(self.seconds.get("total", 0.0)),
            "seconds_by_step": {name: float(value) for name, value in self.seconds.items() if name != "total"},
            "method": self.method,
            "warnings": list(self.warnings),
        }

    def _point(self, p: int) -> dict[str, Any]:
        return {
            "values": [float(x) for x in self.values[p]],
            "mesh_frequency_hz": _number(self.frequency[p]),
            "mesh_periods": int(self.turns[p]),
            "steps": int(self.steps[p]),
            "failure": self.failure[p],
            "runs": [self._run(p, r) for r in range(len(self.run))],
        }

    def _portraits(self) -> list[dict[str, Any]]:
        own = self.portraits
        if own is None:
            return []
        return [
            {
                "values": [float(x) for x in self.values[p]],
                "start": self.run[r],
                **portrait_dict(own, k, j, self.contact),
            }
            for k, p in enumerate(own.point.tolist())
            for j, r in enumerate(own.run.tolist())
        ]

    def _run(self, p: int, r: int) -> dict[str, Any]:
        return {
            "start": self.run[r],
            "motion": self.motion_at(p, r),
            "lyapunov": [_number(x) for x in self.lyapunov[p, r]],
            "lyapunov_error": [_number(x) for x in self.lyapunov_error[p, r]],
            "contacts": [self._contact(p, r, c) for c in range(len(self.contact))],
        }

    def _contact(self, p: int, r: int, c: int) -> dict[str, Any]:
        names = {
            "peak_to_peak_m": self.peak_to_peak,
            "peak_to_peak_dte_m": self.amplitude,
            "rms_dte_m": self.rms,
            "mean_force_n": self.mean_force,
            "rms_force_n": self.rms_force,
            "largest_force_n": self.largest_force,
            "dynamic_factor": self.dynamic_factor,
            "driving_share": self.driving,
            "apart_share": self.apart,
            "back_share": self.back,
            "losses_per_mesh_period": self.losses,
        }
        return {
            "name": self.contact[c],
            "static_force_n": _number(self.static_force[p, c]),
            "static_deflection_m": _number(self.static_deflection[p, c]),
            **{name: _number(table[p, r, c]) for name, table in names.items()},
        }


def _number(value: float) -> float | None:
    """A float for JSON; what is not finite becomes null."""
    return float(value) if np.isfinite(value) else None
