"""Error against run time of the tooth model of one mesh over its presets and mesh sizes."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from rotorgear.results.mesh import MeshErrors


@dataclass(frozen=True)
class MeshRung:
    """One mesh of the teeth.

    Attributes:
        method: preset or mesh, in words. elements: of one pitch, both gears alike; layers: along the face, 0 for a plane model.
        dofs: of both gears. fe_seconds, contact_seconds: CPU time of both compliances, and of the contact over a cycle.
        mean_stiffness_n_per_m, peak_to_peak_stiffness_n_per_m, ste_peak_to_peak_m: of one helix.
        error: relative errors against the reference; estimate: what an analysis with this preset says itself, None where there
            is no estimate.
    """

    method: str
    elements: int
    layers: int
    dofs: int
    fe_seconds: float
    contact_seconds: float
    mean_stiffness_n_per_m: float
    peak_to_peak_stiffness_n_per_m: float
    ste_peak_to_peak_m: float
    error: MeshErrors
    estimate: MeshErrors | None


@dataclass(frozen=True)
class MeshConvergenceStudy:
    """Rungs of one mesh at one load; `reference` says what the errors are measured against."""

    title: str
    mesh: str
    body: str
    base_force_n: float
    reference: str
    rungs: tuple[MeshRung, ...]

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON; the keys are the attributes'."""
        return {**asdict(self), "analysis": "accuracy", "of": "mesh"}
