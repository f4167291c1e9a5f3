"""Error against run time of the tooth model of one mesh over its presets and mesh sizes."""

from __future__ import annotations

from rotorgear.results.parts.mesh import MeshErrors
from rotorgear.results.result import Result
from rotorgear.results.schema import Record, of


class MeshRung(Record):
    """One mesh of the teeth."""

    method: str = of("what was asked for", note=": a preset, or a mesh between them")
    elements: int = of("elements of a pitch in the transverse plane")
    layers: int = of("layers along the face", note="; 0: a plane model")
    dofs: int = of("degrees of freedom", note=" of both gears")
    fe_seconds: float = of("CPU time of both compliances", "s")
    contact_seconds: float = of("CPU time of the contact over a cycle", "s")
    mean_stiffness_n_per_m: float = of("mean stiffness", "N/m")
    peak_to_peak_stiffness_n_per_m: float = of("peak to peak of the stiffness", "N/m")
    ste_peak_to_peak_m: float = of("peak to peak of the transmission error", "m")
    error: MeshErrors = of("relative errors against the reference", record=MeshErrors)
    estimate: MeshErrors | None = of(
        "what an analysis with this preset estimates itself", record=MeshErrors, note="; `null` for other meshes"
    )


class MeshConvergenceStudy(Result, kind="mesh_convergence", analysis="accuracy"):
    """Rungs of one mesh at one load; `reference` says what the errors are measured against."""

    title: str = of("title of the model")
    analysis: str = of("analysis that is measured", json="of", default="mesh", kw_only=True)
    mesh: str = of("mesh")
    body: str = of("what the teeth stand on")
    base_force_n: float = of("tangential force F_bt at the base circle", "N", note=" of the helix")
    reference: str = of("what the errors are measured against")
    rungs: tuple[MeshRung, ...] = of("discretisations", "", "rung", record=MeshRung)
