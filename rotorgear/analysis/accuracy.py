"""The verb behind `rotorgear accuracy`: error against run time of an analysis over a series of discretisations."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from importlib import import_module

from rotorgear.analysis.common.stream import Stream, pieces
from rotorgear.analysis.common.study import keeping
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model, model_hash
from rotorgear.progress import Progress, silent
from rotorgear.results.convergence import ConvergenceStudy, MeshConvergenceStudy, SweepConvergenceStudy

AnyStudy = ConvergenceStudy | MeshConvergenceStudy | SweepConvergenceStudy
# An analysis with a study of its own gets a line here, the file of the study and its function; the command and its refusals
# follow from it. All analyses together take a second to load: what is misspelt is refused before.
STUDIES = {
    "modal": ("meshes", "convergence_study"),
    "campbell": ("meshes", "campbell_convergence_study"),
    "critical": ("meshes", "critical_convergence_study"),
    "static": ("meshes", "static_convergence_study"),
    "response": ("meshes", "response_convergence_study"),
    "frf": ("meshes", "frf_convergence_study"),
    "state-space": ("meshes", "state_space_convergence_study"),
    "mesh": ("parts", "mesh_convergence_study"),
    "bearing": ("parts", "bearing_convergence_study"),
    "transient": ("motions", "transient_convergence_study"),
    "sweep": ("motions", "sweep_convergence_study"),
    "orbits": ("motions", "orbits_convergence_study"),
    "casing": ("casing", "casing_convergence_study"),
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
    stream: Stream | None = None,
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
        stream: keeps rows while the study goes on (`rotorgear.stream`), and starts an interrupted one again.
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
    given = {
        name: value for name, value in arguments.items() if value is not None and name not in ("analysis", "stream")
    }
    taken = {name: inspect.signature(study_by_name(name)).parameters for name in STUDIES}
    for name in given:
        if name not in taken[analysis]:
            homes = [other for other, parameters in taken.items() if name in parameters]
            spelled = _SPELLED.get(name, name).replace("_", "-")
            raise AnalysisError(f"--{spelled} belongs to --analysis {' or '.join(homes)}, not to {analysis}")
    asked = {name: value for name, value in given.items() if name not in ("model", "progress")}
    with keeping(pieces(stream, {"model": model_hash(model), "run": f"{analysis} {asked}"})):
        return study_by_name(analysis)(**given)


def study_by_name(analysis: str) -> Callable[..., AnyStudy]:
    """The study of an analysis in `STUDIES`."""
    file, name = STUDIES[analysis]
    study: Callable[..., AnyStudy] = getattr(import_module(f"rotorgear.analysis.studies.{file}"), name)
    return study
