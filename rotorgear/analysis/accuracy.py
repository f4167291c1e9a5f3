"""The verb behind `rotorgear accuracy`: error against run time of an analysis over a series of discretisations."""

from __future__ import annotations

from collections.abc import Sequence

from rotorgear.analysis.modal.convergence import convergence_study
from rotorgear.analysis.sweep.convergence import sweep_convergence_study
from rotorgear.analysis.teeth.convergence import mesh_convergence_study
from rotorgear.analysis.transient.convergence import transient_convergence_study
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.results.convergence import ConvergenceStudy
from rotorgear.results.mesh_convergence import MeshConvergenceStudy
from rotorgear.results.sweep_convergence import SweepConvergenceStudy

# What each analysis takes besides the model.
OPTIONS = {
    "modal": ("speed", "modes", "reference"),
    "mesh": ("mesh", "torque"),
    "transient": ("speed", "time", "modal_damping"),
    "sweep": ("speed",),
}


def accuracy(
    model: Model,
    analysis: str = "modal",
    *,
    speed: float | str | None = None,
    modes: int | None = None,
    reference: Sequence[float] | None = None,
    mesh: str | None = None,
    torque: float | str | None = None,
    time: float | str | None = None,
    modal_damping: float | None = None,
    progress: Progress = silent,
) -> ConvergenceStudy | MeshConvergenceStudy | SweepConvergenceStudy:
    """Run an analysis of a model over a series of discretisations, each with its error and run time.

    Args:
        model: a checked model.
        analysis: "modal", "mesh" (teeth in contact), "transient" or "sweep".
        speed: of the input shaft, as in that analysis; not for a mesh.
        modes: modal: how many modes are compared; 24 where not given.
        reference: modal: natural frequencies in Hz to compare with, in place of the model's own finest.
        mesh: mesh: its name; None where there is only one.
        torque: mesh: on the pinion, in N m or as a text, in place of the model's.
        time: transient: duration; 8 periods of the slowest mesh where not given.
        modal_damping: transient: damping ratio of every elastic mode.
        progress: callable that is told fraction and step.

    Returns:
        Of modes and transients a `ConvergenceStudy`, of teeth a `MeshConvergenceStudy`, of a point of a sweep a
        `SweepConvergenceStudy`. The functions behind, such as `convergence_study`, also choose the series itself.

    Raises:
        AnalysisError: no such analysis, or an argument that belongs to another one.
    """
    if analysis not in OPTIONS:
        raise AnalysisError(
            f"--analysis: got '{analysis}', expected {', '.join(list(OPTIONS)[:-1])} or {list(OPTIONS)[-1]}"
        )
    given = {
        "speed": speed,
        "modes": modes,
        "reference": reference,
        "mesh": mesh,
        "torque": torque,
        "time": time,
        "modal_damping": modal_damping,
    }
    foreign = [name for name, value in given.items() if value is not None and name not in OPTIONS[analysis]]
    if foreign:
        homes = [name for name, own in OPTIONS.items() if foreign[0] in own]
        raise AnalysisError(
            f"--{foreign[0].replace('_', '-')} belongs to --analysis {' or '.join(homes)}, not to {analysis}"
        )
    if analysis == "mesh":
        return mesh_convergence_study(model, mesh, torque=torque, progress=progress)
    if analysis == "transient":
        return transient_convergence_study(
            model, speed=speed, time=time, modal_damping=modal_damping, progress=progress
        )
    if analysis == "sweep":
        return sweep_convergence_study(model, speed=speed, progress=progress)
    return convergence_study(model, speed=speed, modes=modes or 24, reference=reference, progress=progress)
