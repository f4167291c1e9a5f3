"""Result of a mesh: stiffness, transmission error and load distribution of a pair of gears over the mesh cycle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

PLANE = "transverse, along the line of action: base force over approach"


@dataclass(frozen=True)
class MeshLoad:
    """What a mesh carries: torque (N m) on the pinion, force F_bt (N) at the base circle and F_n (N) along the flank normal,
    of all helices together, and where that is from."""

    pinion_torque_n_m: float
    base_force_n: float
    normal_force_n: float
    source: str


@dataclass(frozen=True)
class HelixContact:
    """Loaded contact of one helix over p positions, in n slices of the contact lines.

    Attributes:
        stiffness, tangent: (p,) N/m in the transverse plane; transmission_error, no_load_error: (p,) m.
        share: share (p,) of each tooth pair in the load, by its number.
        contact_ratio: mean number of pairs that carry load; geometric_contact_ratio: without load.
        position, pair: (n,) number of the position, and of the pair, of each slice.
        z, length: (n,) place from the middle of the face and length of the contact line (m).
        roll: (n, 2) roll lengths of both gears (m); force: (n,) N along the flank normal.
        half_width, pressure: (n,) half-width (m) and largest pressure (Pa) of the contact.
    """

    stiffness: np.ndarray
    tangent: np.ndarray
    transmission_error: np.ndarray
    no_load_error: np.ndarray
    share: dict[int, np.ndarray]
    contact_ratio: float
    geometric_contact_ratio: float
    position: np.ndarray
    pair: np.ndarray
    z: np.ndarray
    length: np.ndarray
    roll: np.ndarray
    force: np.ndarray
    half_width: np.ndarray
    pressure: np.ndarray

    @property
    def line_load(self) -> np.ndarray:
        """Force per length of contact line (n,), N/m."""
        return np.asarray(self.force / self.length)

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        carrying = self.force > 0.0
        return {
            "stiffness_n_per_m": self.stiffness.tolist(),
            "ste_m": self.transmission_error.tolist(),
            "no_load_te_m": self.no_load_error.tolist(),
            "contact_ratio": self.contact_ratio,
            "geometric_contact_ratio": self.geometric_contact_ratio,
            "load_share": {str(pair): values.tolist() for pair, values in self.share.items()},
            "largest_line_load_n_per_m": float(self.line_load.max()),
            "largest_pressure_pa": float(self.pressure.max()),
            "contact": {
                "position_number": self.position[carrying].tolist(),
                "pair": self.pair[carrying].tolist(),
                "z_m": self.z[carrying].tolist(),
                "pinion_roll_length_m": self.roll[carrying, 0].tolist(),
                "gear_roll_length_m": self.roll[carrying, 1].tolist(),
                "line_load_n_per_m": self.line_load[carrying].tolist(),
                "half_width_m": self.half_width[carrying].tolist(),
                "pressure_pa": self.pressure[carrying].tolist(),
            },
        }


@dataclass(frozen=True)
class MeshErrors:
    """Estimated relative errors: mean stiffness, its peak to peak over its own size, and the same of the transmission error."""

    mean_stiffness: float
    peak_to_peak_stiffness: float
    ste_peak_to_peak: float

    @property
    def worst(self) -> float:
        """The largest of them."""
        return max(self.mean_stiffness, self.peak_to_peak_stiffness, self.ste_peak_to_peak)


@dataclass(frozen=True)
class LoadPoint:
    """The same mesh at another load: factor, N/m and m."""

    factor: float
    mean_stiffness_n_per_m: float
    peak_to_peak_stiffness_n_per_m: float
    ste_peak_to_peak_m: float
    contact_ratio: float


@dataclass(frozen=True)
class MeshResult:
    """One mesh of a model over its mesh cycle, all helices together where nothing else is said.

    Attributes:
        model: stiffness model; preset: of the finite elements, None for another model.
        definition: "secant" or "tangent"; body: what the teeth stand on.
        position: (p,) mesh periods; stiffness, tangent: (p,) N/m in the transverse plane.
        transmission_error, no_load_error: (p,) m along the line of action; None where a model has none.
        helix: contact of each helix, empty for a model without contact.
        errors: estimates; None where a model has none. dofs: of the finite elements.
        loads: at other loads, where asked for.
    """

    title: str
    mesh: str
    pinion: str
    gear: str
    model: str
    preset: str | None
    definition: str
    body: str
    helices: int
    face_width: float
    base_helix_angle: float
    stagger: float
    load: MeshLoad | None
    position: np.ndarray
    stiffness: np.ndarray
    tangent: np.ndarray | None
    transmission_error: np.ndarray | None
    no_load_error: np.ndarray | None
    helix: tuple[HelixContact, ...]
    errors: MeshErrors | None
    dofs: int
    seconds: float
    seconds_by_step: dict[str, float]
    loads: tuple[LoadPoint, ...]
    warnings: tuple[str, ...]

    @property
    def mean_stiffness(self) -> float:
        """Mean of the transverse stiffness (N/m)."""
        return float(self.stiffness.mean())

    @property
    def mean_normal_stiffness(self) -> float:
        """Mean stiffness along the flank normal (N/m): what a model file takes as a number."""
        return self.mean_stiffness / float(np.cos(self.base_helix_angle)) ** 2

    @property
    def peak_to_peak_stiffness(self) -> float:
        """Largest less smallest transverse stiffness (N/m)."""
        return float(np.ptp(self.stiffness))

    @property
    def ste_peak_to_peak(self) -> float | None:
        """Largest less smallest transmission error under load (m)."""
        return None if self.transmission_error is None else float(np.ptp(self.transmission_error))

    def harmonics(self, count: int = 8) -> np.ndarray:
        """Complex c_h (count,) in N/m: k(u) = mean + sum_h Re(c_h e^{2 pi i h u}), over whole mesh periods."""
        return _harmonics(self.position, self.stiffness, count)

    def ste_harmonics(self, count: int = 8) -> np.ndarray | None:
        """The same of the transmission error under load, in m."""
        return None if self.transmission_error is None else _harmonics(self.position, self.transmission_error, count)

    def to_dict(self, harmonics: int = 8) -> dict[str, Any]:
        """Plain values for JSON."""
        k = self.harmonics(harmonics)
        e = self.ste_harmonics(harmonics)
        return {
            "analysis": "mesh",
            "title": self.title,
            "mesh": self.mesh,
            "pinion": self.pinion,
            "gear": self.gear,
            "model": self.model,
            "preset": self.preset,
            "definition": self.definition,
            "plane": PLANE,
            "body": self.body,
            "helices": self.helices,
            "stagger": self.stagger,
            "face_width_m": self.face_width,
            "base_helix_angle_deg": float(np.degrees(self.base_helix_angle)),
            "load": None if self.load is None else dict(vars(self.load)),
            "mean_stiffness_n_per_m": self.mean_stiffness,
            "mean_normal_stiffness_n_per_m": self.mean_normal_stiffness,
            "peak_to_peak_stiffness_n_per_m": self.peak_to_peak_stiffness,
            "mean_tangent_stiffness_n_per_m": None if self.tangent is None else float(self.tangent.mean()),
            "ste_peak_to_peak_m": self.ste_peak_to_peak,
            "position": self.position.tolist(),
            "stiffness_n_per_m": self.stiffness.tolist(),
            "tangent_stiffness_n_per_m": _plain(self.tangent),
            "ste_m": _plain(self.transmission_error),
            "no_load_te_m": _plain(self.no_load_error),
            "harmonics": [
                {
                    "order": h + 1,
                    "stiffness_n_per_m": float(abs(k[h])),
                    "stiffness_phase_deg": float(np.degrees(np.angle(k[h]))),
                    "ste_m": None if e is None else float(abs(e[h])),
                    "ste_phase_deg": None if e is None else float(np.degrees(np.angle(e[h]))),
                }
                for h in range(len(k))
            ],
            "helix": [helix.to_dict() for helix in self.helix],
            "error_estimate": None if self.errors is None else dict(vars(self.errors)),
            "loads": [dict(vars(point)) for point in self.loads],
            "dofs": self.dofs,
            "seconds": self.seconds,
            "seconds_by_step": self.seconds_by_step,
            "warnings": list(self.warnings),
        }


def _plain(values: np.ndarray | None) -> list[float] | None:
    return None if values is None else [float(value) for value in values]


def _harmonics(position: np.ndarray, values: np.ndarray, count: int) -> np.ndarray:
    """Amplitudes at whole orders of the mesh; positions are evenly spaced over whole periods from 0."""
    n = len(values)
    periods = round(n * float(position[1] - position[0])) if n > 1 else 1
    most = (n // periods - 1) // 2
    spectrum = 2.0 * np.fft.fft(values)[periods::periods][: min(count, most)] / n
    return np.asarray(spectrum)
