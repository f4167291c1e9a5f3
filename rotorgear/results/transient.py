"""Result of a transient analysis: histories, statistics with their error, contact events, energies, cost."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from rotorgear.model.model import Model
from rotorgear.results.modal import NodeTable


@dataclass(frozen=True)
class EnergyLedger:
    """Energies in J at times (e,), all since t = 0: what came in, what is stored, what was dissipated, and the rest.

    numerical = stored - stored(0) - load_work - excitation_work + dissipated: what the integration itself made or lost. `share`
    is its largest size over the largest of the others.
    """

    time: np.ndarray
    kinetic: np.ndarray
    strain: np.ndarray
    contact: np.ndarray
    load_work: np.ndarray
    excitation_work: np.ndarray
    dissipated: np.ndarray
    numerical: np.ndarray
    share: float


@dataclass(frozen=True)
class TransientResult:
    """r recorded instants of c contacts and p channels.

    Attributes:
        model: the model that was analysed.
        time: (r,) in s. angle, speed: (r,) of the reference shaft in rad and rad/s.
        settle: time in s from which statistics count; start_step: first record from there on.
        contact: names of the contacts. deflection: (r, c) approach of the flanks along their normal in m, without the
            transmission error (the dynamic transmission error). mesh_force: (r, c) in N, positive on the working flank.
        mean_force: (c,) static mean force of each contact in N.
        contact_time: (c, 3) share of the time on the working flank, apart, on the coast flank; contact_losses: (c,) how often.
        channel, unit: names and units of the channels; values: (r, p).
        quantity: names of the statistics with an error; quantity_value, quantity_error: (s,), the error absolute.
        energy: ledger. step: h in s; steps: of the run; every: of them one record.
        error_estimate: largest relative error of the quantities. dofs, seconds, method, reason of its choice.
        nodes: where the motion is known; motion_time (w,), motion (p, 6, w): displacements of the nodes in m and rad at the
            last w records, where frames were asked for.
        mesh_frequency: of each mesh in Hz at the first speed.
        status: "success", or why the run ended early; left_out, warnings: sentences.
    """

    model: Model
    time: np.ndarray
    angle: np.ndarray
    speed: np.ndarray
    settle: float
    contact: tuple[str, ...]
    deflection: np.ndarray
    mesh_force: np.ndarray
    mean_force: np.ndarray
    contact_time: np.ndarray
    contact_losses: np.ndarray
    channel: tuple[str, ...]
    unit: tuple[str, ...]
    values: np.ndarray
    quantity: tuple[str, ...]
    quantity_value: np.ndarray
    quantity_error: np.ndarray
    energy: EnergyLedger
    step: float
    steps: int
    every: int
    error_estimate: float
    dofs: int
    seconds: dict[str, float]
    method: str
    reason: str
    mesh_frequency: dict[str, float]
    nodes: NodeTable
    motion_time: np.ndarray
    motion: np.ndarray
    status: str = "success"
    left_out: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()

    @property
    def counted(self) -> np.ndarray:
        """(r,) whether a record counts in the statistics."""
        return self.time >= self.settle * (1.0 - 1e-12)

    @property
    def spacing(self) -> float:
        """Time between two records in s."""
        return self.step * self.every

    @property
    def dynamic_factor(self) -> np.ndarray:
        """(c,) largest mesh force over the static mean force; NaN where no load flows."""
        own = self.mesh_force[self.counted]
        peak = own.max(axis=0) if own.size else np.full(len(self.contact), np.nan)
        safe = np.where(self.mean_force > 0.0, self.mean_force, 1.0)
        return np.where(self.mean_force > 0.0, peak / safe, np.nan)

    def history(self, name: str) -> np.ndarray:
        """History (r,) of a channel, or of "force NAME" or "deflection NAME" of a contact.

        Raises:
            KeyError: no such history.
        """
        if name in self.channel:
            return np.asarray(self.values[:, self.channel.index(name)])
        what, _, contact = name.partition(" ")
        if contact in self.contact and what in ("force", "deflection"):
            table = self.mesh_force if what == "force" else self.deflection
            return np.asarray(table[:, self.contact.index(contact)])
        raise KeyError(name)

    def to_dict(self) -> dict[str, Any]:
        """Everything but the histories as plain values for JSON; the keys are documented in docs/json.md."""
        return {
            "analysis": "transient",
            "title": self.model.title,
            "status": self.status,
            "speed_rpm": [float(self.speed[0] * 30.0 / np.pi), float(self.speed[-1] * 30.0 / np.pi)],
            "time_s": float(self.time[-1]),
            "settle_s": self.settle,
            "step_s": self.step,
            "steps": self.steps,
            "records": len(self.time),
            "mesh_frequency_hz": dict(self.mesh_frequency),
            "contacts": [self._contact(i) for i in range(len(self.contact))],
            "channels": [self._channel(i) for i in range(len(self.channel))],
            "quantities": [
                {"name": name, "value": _number(value), "error": _number(error)}
                for name, value, error in zip(self.quantity, self.quantity_value, self.quantity_error, strict=True)
            ],
            "error_estimate": _number(self.error_estimate),
            "energy": {
                "load_work_j": _number(self.energy.load_work[-1]),
                "excitation_work_j": _number(self.energy.excitation_work[-1]),
                "dissipated_j": _number(self.energy.dissipated[-1]),
                "numerical_j": _number(self.energy.numerical[-1]),
                "numerical_share": _number(self.energy.share),
            },
            "dofs": self.dofs,
            "seconds": float(self.seconds.get("total", 0.0)),
            "seconds_by_step": {name: float(value) for name, value in self.seconds.items() if name != "total"},
            "method": self.method,
            "reason": self.reason,
            "left_out": list(self.left_out),
            "warnings": list(self.warnings),
        }

    def _contact(self, i: int) -> dict[str, Any]:
        force = self.mesh_force[self.counted, i]
        x = self.deflection[self.counted, i]
        return {
            "name": self.contact[i],
            "static_force_n": _number(self.mean_force[i]),
            "mean_force_n": _number(_mean(force)),
            "rms_force_n": _number(_rms(force)),
            "largest_force_n": _number(force.max(initial=-np.inf)),
            "smallest_force_n": _number(force.min(initial=np.inf)),
            "dynamic_factor": _number(self.dynamic_factor[i]),
            "peak_to_peak_dte_m": _number(np.ptp(x) if x.size else np.nan),
            "driving_share": _number(self.contact_time[i, 0]),
            "apart_share": _number(self.contact_time[i, 1]),
            "back_share": _number(self.contact_time[i, 2]),
            "losses": int(self.contact_losses[i]),
        }

    def _channel(self, i: int) -> dict[str, Any]:
        own = self.values[self.counted, i]
        return {
            "name": self.channel[i],
            "unit": self.unit[i],
            "mean": _number(_mean(own)),
            "rms": _number(_rms(own)),
            "largest": _number(own.max(initial=-np.inf)),
            "smallest": _number(own.min(initial=np.inf)),
        }


def _mean(x: np.ndarray) -> float:
    return float(x.mean()) if x.size else float("nan")


def _rms(x: np.ndarray) -> float:
    """Root mean square about the mean."""
    return float(x.std()) if x.size else float("nan")


def _number(value: float) -> float | None:
    """A float for JSON; what is not finite becomes null."""
    return float(value) if np.isfinite(value) else None
