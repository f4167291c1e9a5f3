"""The verb behind `rotorgear accuracy`: error against run time of an analysis over a series of discretisations."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence

from rotorgear.analysis.studies.casing import casing_convergence_study
from rotorgear.analysis.studies.meshes import (
    campbell_convergence_study,
    convergence_study,
    critical_convergence_study,
    frf_convergence_study,
    response_convergence_study,
    state_space_convergence_study,
    static_convergence_study,
)
from rotorgear.analysis.studies.motions import (
    orbits_convergence_study,
    sweep_convergence_study,
    transient_convergence_study,
)
from rotorgear.analysis.studies.parts import bearing_convergence_study, mesh_convergence_study
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.results.convergence import ConvergenceStudy, MeshConvergenceStudy, SweepConvergenceStudy

AnyStudy = ConvergenceStudy | MeshConvergenceStudy | SweepConvergenceStudy
# An analysis with a study of its own gets a line here; the command and its refusals follow from it.
STUDIES: dict[str, Callable[..., AnyStudy]] = {
    "modal": convergence_study,
    "campbell": campbell_convergence_study,
    "critical": critical_convergence_study,
    "static": static_convergence_study,
    "response": response_convergence_study,
    "frf": frf_convergence_study,
    "state-space": state_space_convergence_study,
    "mesh": mesh_convergence_study,
    "bearing": bearing_convergence_study,
    "transient": transient_convergence_study,
    "sweep": sweep_convergence_study,
    "orbits": orbits_convergence_study,
    "casing": casing_convergence_study,
}
# Verbs that have no discretisation of their own, and where the errors of their numbers are stated.
_ELSEWHERE = {
    "scatter": "its samples share the modes of --analysis modal, and it states the errors of their basis and of its indices",
    "update": "it fits the modes of --analysis modal, and its intervals are those of the measurement",
    "optimise": "it moves the modes of --analysis modal",
    "compare": "it pairs the modes of --analysis modal with measured ones",
    "sensors": "it reads the modes of --analysis modal",
    "standards": "it reads --analysis response and --analysis critical",
    "gear": "it is closed formulas",
}
# Arguments that the command spells otherwise.
_SPELLED = {"stop": "to"}


def accuracy(
    model: Model,
    analysis: str = "modal",
    *,
    speed: float | str | None = None,
    stop: float | str | None = None,
    modes: int | None = None,
    fmax: float | None = None,
    at: str | None = None,
    reference: Sequence[float] | None = None,
    mesh: str | None = None,
    torque: float | str | None = None,
    bearing: str | None = None,
    time: float | str | None = None,
    modal_damping: float | None = None,
    casing: str | None = None,
    coupled: bool | None = None,
    finest: int | None = None,
    excite: str | None = None,
    progress: Progress = silent,
) -> AnyStudy:
    """Run an analysis of a model over a series of discretisations, each with its error and run time.

    Args:
        model: a checked model.
        analysis: what is run: modal, campbell, critical, static, response, frf, state-space, mesh (teeth in contact),
            bearing (film or rolling elements), transient, sweep, orbits (one periodic motion) or casing (its mesh
            and its reduction).
        speed: speed of the input shaft in rad/s or with its unit, as in that analysis; not for a mesh.
        stop: for campbell and critical: the highest speed of the range.
        modes: for modal, campbell and casing: number of modes that are compared (default: 24, of a casing 8).
        fmax: for response, frf and state-space: highest frequency in Hz.
        at: for frf and state-space: where force and response are (default: the first disk, gear or bearing).
        reference: for modal: natural frequencies in Hz to compare with (default: the model's own finest).
        mesh: for mesh: its name; it may be left out where there is only one.
        torque: for mesh: torque on the pinion in N m or with its unit (default: that of the model).
        bearing: for bearing: its name; it may be left out where only one has a law.
        time: for transient: time that is evaluated (default: 8 periods of the slowest mesh).
        modal_damping: for response, frf, state-space and transient: damping ratio of every elastic mode.
        casing: for casing: its name; it may be left out where there is only one.
        coupled: for casing: modes of the gearbox with it, not its own.
        finest: for casing: largest number of unknowns of the mesh to compare with (default: 300 000).
        excite: for orbits: name of the mesh whose stage excites alone.
        progress: callable that is told fraction and step.

    Returns:
        Of teeth a `MeshConvergenceStudy`, of a point of a sweep a `SweepConvergenceStudy`, of all others a
        `ConvergenceStudy`. The functions behind, such as `convergence_study`, also choose the series itself.

    Raises:
        AnalysisError: no such analysis, or an argument that belongs to another one.
    """
    arguments = dict(locals())
    if analysis in _ELSEWHERE:
        raise AnalysisError(f"--analysis: {analysis} has no study of its own: {_ELSEWHERE[analysis]}")
    if analysis not in STUDIES:
        names = list(STUDIES)
        raise AnalysisError(f"--analysis: got '{analysis}', expected {', '.join(names[:-1])} or {names[-1]}")
    given = {name: value for name, value in arguments.items() if value is not None and name != "analysis"}
    taken = {name: inspect.signature(study).parameters for name, study in STUDIES.items()}
    for name in given:
        if name not in taken[analysis]:
            homes = [other for other, parameters in taken.items() if name in parameters]
            spelled = _SPELLED.get(name, name).replace("_", "-")
            raise AnalysisError(f"--{spelled} belongs to --analysis {' or '.join(homes)}, not to {analysis}")
    return STUDIES[analysis](**given)
