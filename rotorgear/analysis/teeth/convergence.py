"""Error against run time of the tooth model: presets and mesh sizes of one mesh against a finer one."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

import numpy as np

from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.teeth.errors import error_parts
from rotorgear.analysis.teeth.helices import Cycle, solve_helices
from rotorgear.analysis.teeth.request import MeshRequest, mesh_request
from rotorgear.gears.loaded.mesh_cycle import MeshCycle, mesh_cycle
from rotorgear.gears.loaded.tooth_contact import ContactProblem, contact_problem, in_space
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.gears.tooth_fe.points import MeshSize
from rotorgear.gears.tooth_fe.settings import PRESETS, sized
from rotorgear.model.layout.mesh_layout import mirrored
from rotorgear.model.model import Model
from rotorgear.progress import Progress, part_of, silent
from rotorgear.results.convergence import MeshConvergenceStudy, MeshRung
from rotorgear.results.mesh import MeshErrors

POSITIONS = 64
# Meshes between the presets, and the reference: rows and columns, and thickness of a layer in normal modules.
_PLANE = {"coarse": MeshSize(4, 2, 4, 2, 3), "medium": MeshSize(8, 3, 6, 3, 5)}
_SPACE = {"coarse": (MeshSize(5, 2, 4, 2, 3), 3.6), "medium": (MeshSize(7, 2, 4, 2, 3), 2.7)}
_REFERENCE = (MeshSize(24, 6, 16, 6, 10), (MeshSize(12, 4, 7, 3, 4), 0.54))


@dataclass(frozen=True)
class _Run:
    problem: ContactProblem
    cycle: MeshCycle
    fe_seconds: float
    contact_seconds: float


@recorded
def mesh_convergence_study(
    model: Model, mesh: str | None = None, *, torque: float | str | None = None, progress: Progress = silent
) -> MeshConvergenceStudy:
    """Run the loaded contact of one helix of a mesh over presets and mesh sizes, without stored compliances.

    Args:
        model, mesh, torque: as for `mesh`.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: a mesh or load that can't be.
    """
    request = mesh_request(model, mesh, "tooth_fe", torque, {})
    assert request.teeth is not None
    teeth = request.teeth if request.senses[0] > 0 else mirrored(request.teeth)
    space = in_space(replace(teeth, fe=replace(teeth.fe, preset="default")))[0]
    runs: list[tuple[str, ToothPair]] = [
        (name, replace(teeth, fe=sized(teeth.fe, size, teeth.width / teeth.first.normal_module)))
        for name, size in (_SPACE if space else _PLANE).items()
    ]
    runs += [(f"preset {name}", replace(teeth, fe=replace(teeth.fe, preset=name))) for name in PRESETS]
    runs.sort(key=lambda run: run[0] == "preset fine")
    runs.sort(key=lambda run: run[0] != "preset preview" if space else _elements(run[1]))
    finest = sized(replace(teeth.fe, preset="fine"), _REFERENCE[space], teeth.width / teeth.first.normal_module)
    steps = len(runs) + 4
    truth = _run(replace(teeth, fe=finest), request.base_force, part_of(progress, 0.0, 4.0 / steps))
    rungs = []
    for number, (name, pair) in enumerate(runs):
        run = _run(pair, request.base_force, part_of(progress, (number + 4) / steps, (number + 5) / steps))
        rungs.append(_rung(name, pair, run, truth.cycle, request))
    progress(1.0, "done")
    size = finest.mesh_size(teeth.width / teeth.first.normal_module, space=space)
    layers = f" in {size.face} layers" if size.face else ""
    words = f"{size.elements} elements a pitch{layers}, {truth.problem.unknowns} dofs, {truth.problem.slices} slices"
    return MeshConvergenceStudy(model.title, request.name, truth.problem.body, request.base_force, words, tuple(rungs))


def _elements(teeth: ToothPair) -> int:
    return teeth.fe.mesh_size(teeth.width / teeth.first.normal_module, space=in_space(teeth)[0]).elements


def _run(teeth: ToothPair, load: float, progress: Progress) -> _Run:
    start = time.process_time()
    problem = contact_problem(teeth, part_of(progress, 0.0, 0.8), fresh=True)
    middle = time.process_time()
    cycle = mesh_cycle(problem, load, np.arange(POSITIONS) / POSITIONS, part_of(progress, 0.8, 1.0))
    return _Run(problem, cycle, middle - start, time.process_time() - middle)


def _rung(name: str, teeth: ToothPair, run: _Run, truth: MeshCycle, request: MeshRequest) -> MeshRung:
    k = run.cycle.secant
    error = run.cycle.deflection
    size = teeth.fe.mesh_size(teeth.width / teeth.first.normal_module, space=in_space(teeth)[0])
    return MeshRung(
        name,
        size.elements,
        size.face,
        run.problem.unknowns,
        run.fe_seconds,
        run.contact_seconds,
        float(k.mean()),
        float(np.ptp(k)),
        float(np.ptp(error)),
        _errors(k, error, truth),
        _estimate(name, teeth, request),
    )


def _errors(k: np.ndarray, error: np.ndarray, truth: MeshCycle) -> MeshErrors:
    other = truth.secant
    other_error = truth.deflection
    return MeshErrors(
        abs(float(k.mean()) / float(other.mean()) - 1.0),
        abs(float(np.ptp(k)) / float(np.ptp(other)) - 1.0),
        abs(float(np.ptp(error)) / float(np.ptp(other_error)) - 1.0),
    )


def _estimate(name: str, teeth: ToothPair, request: MeshRequest) -> MeshErrors | None:
    """The estimate of an analysis with this preset, of one helix; its compliances may come from the disk."""
    if not name.startswith("preset"):
        return None
    one = replace(request, senses=(1,))
    found = solve_helices(one, teeth, request.base_force, Cycle(POSITIONS), judged=True)
    parts = error_parts(one, teeth, found)
    return parts.total if parts else None
