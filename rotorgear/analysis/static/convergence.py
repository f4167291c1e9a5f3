"""Error against run time of the static analysis over numbers of elements."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import speed_in_si
from rotorgear.analysis.common.study import REPEAT, Judged, Study, mesh_settings
from rotorgear.analysis.static.static import forces_of, solved, static
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.results.convergence import ConvergenceStudy
from rotorgear.results.static import StaticResult
from rotorgear.system.plan import Plan

ELEMENTS = (1, 2, 4, 8, 16)
ACCURACIES = (1e-3, 1e-6)
# Internal polynomials up to this order beside the exact static shapes: a mesh that no rung has.
_ORDER = 4
# Forces come out of differences of stiff and soft parts: rounding of one in 1e9 is none to speak of.
RESOLUTION = 1e-9


@recorded
def static_convergence_study(
    model: Model,
    *,
    speed: float | str | None = None,
    elements: Sequence[int] = ELEMENTS,
    accuracies: Sequence[float] = ACCURACIES,
    repeat: int = REPEAT,
    progress: Progress = silent,
) -> ConvergenceStudy:
    """Run the static analysis over numbers of elements.

    The errors are those of the forces of contacts, bearings and supports, relative to the largest. The basic element is exact in
    statics: what remains is rounding, and the study shows that it is no more.

    Args:
        model, speed: as for `static`.
        elements, accuracies, repeat: as for `convergence_study`.
        progress: callable that is told fraction and step.
    """
    given = speed_in_si(speed)
    if given is None and model.operation:
        given = model.operation.speed
    finest = solved(model, Plan(1, _ORDER), given, silent).equilibrium
    truth = forces_of(finest)
    size = max(float(np.abs(truth).max(initial=0.0)), np.finfo(float).tiny)

    def judge(result: StaticResult) -> Judged:
        held = (*result.bearing_force.values(), *result.support_force.values())
        forces = np.concatenate([result.mesh_force, *held])
        return Judged(result.dofs, np.abs(forces - truth) / size, np.array([result.error_estimate]))

    study = Study(
        lambda options: static(model, speed=speed, **options), judge, RESOLUTION, repeat=repeat, below="rounding only"
    )
    rungs = study.rungs(mesh_settings(elements, accuracies), progress)
    words = f"elements with internal polynomials up to order {_ORDER}, {finest.system.n} dofs"
    return ConvergenceStudy(
        model.title or "model", "static", words, len(truth), rungs, compared="forces", resolution=RESOLUTION
    )
