"""Result of a modal analysis: frequencies, damping, shapes by node, energies by part and motion, and what it cost."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from rotorgear.model.model import Model
from rotorgear.results.plain import plain


@dataclass(frozen=True)
class NodeTable:
    """Where the p nodes are: shaft's name, position (p, 3) in m, and the name of the bearing for a pedestal's node ("" else).

    The nodes of the model come first, then stations inside elements of higher order, where the shape is known as well.
    """

    shaft: tuple[str, ...]
    position: np.ndarray
    pedestal: tuple[str, ...]

    def on_shaft(self, shaft: str) -> np.ndarray:
        """Numbers of a shaft's nodes from left to right, without pedestals."""
        own = np.array([i for i, name in enumerate(self.shaft) if name == shaft and not self.pedestal[i]], dtype=int)
        return own[np.argsort(self.position[own, 2], kind="stable")] if own.size else own

    def nearest(self, shaft: str, z: float) -> int:
        """Number of the node of a shaft nearest to z."""
        numbers = self.on_shaft(shaft)
        return int(numbers[np.argmin(np.abs(self.position[numbers, 2] - z))])


@dataclass(frozen=True)
class Piece:
    """A stretch of shaft between two neighbouring places: from start to end (z in m), its elements and their order."""

    shaft: str
    start: float
    end: float
    elements: int
    order: int


@dataclass(frozen=True)
class ModalResult:
    """m modes of a model, lowest natural frequency first.

    Attributes:
        model: the model that was analysed.
        speed: speed of the reference shaft in rad/s; None for an undamped analysis at standstill.
        eigenvalues: s in rad/s, (m,) complex, one of each conjugate pair; real for overdamped and 0 for rigid modes.
        rigid: (m,) whether a mode is a rigid-body motion.
        shapes: (p, 6, m) complex, displacements x y z tx ty tz of all nodes; modal mass 1 (q^H M q), the largest displacement
            real and positive.
        nodes: where the p nodes are.
        error_estimate: (m,) estimated relative discretisation error of the natural frequency; infinite where a mode is finer
            than the mesh, NaN where the estimate was left out.
        kinetic_energy, strain_energy: share of each part in the energy of each mode, part -> (m,); sums to 1 over the parts.
        kinetic_by_motion: share of bending, axial and torsion in the kinetic energy, motion -> (m,).
        strain_by_motion: share of the shafts' bending, axial and torsion, of meshes, supports and couplings in strain energy.
        whirl: per mode "forward", "backward", "mixed", "planar", or "" where nothing whirls.
        whirl_by_shaft: shaft -> (m,), -1 (backward circle) to +1 (forward circle), in the sense of that shaft's own spin.
        description: one line a person can read for each mode.
        backward_error: (m,) residual relative to the matrices.
        dofs: number of degrees of freedom; discretisation: how each shaft segment was cut.
        seconds: wall time by step. left_out: sentences about what the model did not need. warnings: sentences.
        method: solver, and what its guards said.
    """

    model: Model
    speed: float | None
    eigenvalues: np.ndarray
    rigid: np.ndarray
    shapes: np.ndarray
    nodes: NodeTable
    error_estimate: np.ndarray
    kinetic_energy: dict[str, np.ndarray]
    strain_energy: dict[str, np.ndarray]
    kinetic_by_motion: dict[str, np.ndarray]
    strain_by_motion: dict[str, np.ndarray]
    whirl: tuple[str, ...]
    whirl_by_shaft: dict[str, np.ndarray]
    description: tuple[str, ...]
    backward_error: np.ndarray
    dofs: int
    discretisation: tuple[Piece, ...]
    seconds: dict[str, float]
    left_out: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    method: str = ""
    point_amplitudes: dict[str, np.ndarray] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.eigenvalues)

    @property
    def mesh_text(self) -> str:
        """The discretisation in a few words."""
        if not self.discretisation:
            return "no shaft elements"
        elements = sum(piece.elements for piece in self.discretisation)
        orders = sorted({piece.order for piece in self.discretisation})
        text = f"order {orders[0]}" if len(orders) == 1 else f"orders {orders[0]} to {orders[-1]}"
        return f"{elements} shaft element{'s'[: elements != 1]} of {text} in {len(self.discretisation)} pieces"

    @property
    def natural_frequency_hz(self) -> np.ndarray:
        """|s| / 2 pi, (m,)."""
        return np.where(self.rigid, 0.0, np.abs(self.eigenvalues) / (2.0 * np.pi))

    @property
    def frequency_hz(self) -> np.ndarray:
        """Damped frequency |Im s| / 2 pi, (m,)."""
        return np.where(self.rigid, 0.0, np.abs(self.eigenvalues.imag) / (2.0 * np.pi))

    @property
    def damping_ratio(self) -> np.ndarray:
        """-Re s / |s|, (m,); 0 for rigid modes, 1 for overdamped and -1 for divergent ones."""
        size = np.abs(self.eigenvalues)
        safe = np.where(size > 0.0, size, 1.0)
        return np.where(self.rigid | (size == 0.0), 0.0, -self.eigenvalues.real / safe) + 0.0

    def to_dict(self) -> dict[str, Any]:
        """Everything but the shapes as plain values for JSON; the keys are documented in docs/json.md."""
        return {
            "analysis": "modal",
            "title": self.model.title,
            "speed_rpm": None if self.speed is None else self.speed * 30.0 / np.pi,
            "frequency_hz": plain(self.frequency_hz),
            "natural_frequency_hz": plain(self.natural_frequency_hz),
            "damping_ratio": plain(self.damping_ratio),
            "rigid": [bool(value) for value in self.rigid],
            "description": list(self.description),
            "whirl": list(self.whirl),
            "error_estimate": plain(self.error_estimate),
            "eigenvalue_real_1_per_s": plain(self.eigenvalues.real),
            "eigenvalue_imag_1_per_s": plain(self.eigenvalues.imag),
            "kinetic_energy": {part: plain(share) for part, share in self.kinetic_energy.items()},
            "strain_energy": {part: plain(share) for part, share in self.strain_energy.items()},
            "kinetic_by_motion": {motion: plain(share) for motion, share in self.kinetic_by_motion.items()},
            "strain_by_motion": {motion: plain(share) for motion, share in self.strain_by_motion.items()},
            "point_amplitude": {name: plain(np.abs(value)) for name, value in self.point_amplitudes.items()},
            "backward_error": plain(self.backward_error),
            "dofs": self.dofs,
            "nodes": len(self.nodes.shaft),
            "discretisation": [asdict(piece) for piece in self.discretisation],
            "seconds": float(self.seconds.get("total", 0.0)),
            "seconds_by_step": {step: float(value) for step, value in self.seconds.items() if step != "total"},
            "left_out": list(self.left_out),
            "warnings": list(self.warnings),
            "method": self.method,
        }
