"""Error against run time of a transient over steps, methods and numbers of modes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from rotorgear.analysis.common.discretise import plan_in_time
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.study import Judged, Setting, Study
from rotorgear.analysis.transient.transient import transient
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.progress import Progress, part_of, silent
from rotorgear.results.convergence import ConvergenceStudy
from rotorgear.results.transient import TransientResult
from rotorgear.system.system import flow_system

STEPS = (40, 80, 160, 320, 640)
ACCURACIES = (1e-2, 1e-3, 1e-4)
REFERENCE_STEPS = 5120
_RECORDS = 40
_PERIODS = 8
_METHODS = ("newmark", "generalised-alpha", "exponential")
_SHARES = (0.25, 0.5)


@recorded
def transient_convergence_study(
    model: Model,
    *,
    speed: float | str | None = None,
    time: float | str | None = None,
    modal_damping: float | None = None,
    steps: Sequence[int] = STEPS,
    accuracies: Sequence[float] = ACCURACIES,
    repeat: int = 1,
    progress: Progress = silent,
) -> ConvergenceStudy:
    """Run a transient from its equilibrium over a series of steps, methods and numbers of modes, and to accuracies.

    Error and estimate are those of the statistics that a transient states an error for: mean, rms, largest and smallest of every
    contact force, loss and coast, transmission error and approach peak to peak, each relative to its own size, and rms of every
    channel, relative to the largest of its kind. The reference is the exponential method with all modes
    and 5120 steps in a period of the fastest mesh, another method than Newmark's family; it is compared with Newmark's method at
    as many steps, and errors below their difference are not judged.

    Args:
        model, speed, modal_damping: as for `transient`. Damping by modes leaves only the exponential method.
        time: duration in s or as a text; 8 periods of the slowest mesh where not given.
        steps: numbers of steps in a period of the fastest mesh, multiples of 40.
        accuracies: accuracies that the analysis chooses its step for itself.
        repeat: runs of each rung that are timed at least.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: a model without meshes, or without excitation.
    """
    if not model.meshes:
        raise AnalysisError("the convergence study of a transient compares contact forces: the model has no mesh")
    system = flow_system(model, plan_in_time())
    fixed: dict[str, Any] = {"speed": speed, "discard": 0.0, "records": _RECORDS, "modal_damping": modal_damping}
    if time is None:
        # The mesh frequencies stand in any transient: the shortest one, without damping by modes, which Newmark can't take.
        bare: dict[str, Any] = {"speed": speed, "discard": 0.0, "records": _RECORDS, "modal_damping": 0.0, "time": 1e-4}
        short = transient(system, method="newmark", steps=_RECORDS, error_estimate=False, **bare)
        time = _PERIODS / min(short.mesh_frequency.values())
    fixed["time"] = time
    damped = model.damping.modal_ratio if modal_damping is None else modal_damping
    progress(0.0, "reference")
    truth = transient(system, method="exponential", steps=REFERENCE_STEPS, error_estimate=False, **fixed)
    if truth.mesh_force.std(axis=0).max() <= 1e-9 * np.abs(truth.mesh_force).max():
        raise AnalysisError("nothing moves: give a transmission error, a stiffness variation or an unbalance")
    known = np.isfinite(truth.quantity_scale) & (truth.quantity_scale > 0.0)
    size = truth.quantity_scale[known]

    def errors(found: TransientResult) -> np.ndarray:
        return np.abs(found.quantity_value[known] - truth.quantity_value[known]) / size

    def judge(found: TransientResult) -> Judged:
        return Judged(found.dofs, errors(found), np.array([found.error_estimate]))

    words = f"the exponential method with all modes and {REFERENCE_STEPS} steps in a mesh period"
    doubt = 1e-9
    if not damped:
        progress(0.1, "reference by another method")
        other = transient(system, method="newmark", steps=REFERENCE_STEPS, error_estimate=False, **fixed)
        # Newmark's method is the worse of the two by far: their difference is more than the reference is off by.
        doubt = max(0.1 * float(errors(other).max(initial=0.0)), doubt)
        words += f", {10.0 * doubt:.0e} from Newmark's method with as many"
    cut = [int(share * truth.dofs) for share in _SHARES]
    plans: list[tuple[str, dict[str, Any]]] = [
        (name, {"method": name}) for name in _METHODS if not damped or name == "exponential"
    ]
    plans += [(f"{n} modes", {"method": "exponential", "modes": n}) for n in cut if n > 20]
    settings = [
        Setting(f"{name}, {count} steps", name, float(count), {**options, "steps": count})
        for name, options in plans
        for count in steps
    ]
    settings += [Setting(f"accuracy {a:g}", "accuracy", a, {"accuracy": a}) for a in accuracies]
    # With modes missing the error does not fall with the step: there is no order to measure.
    rising = tuple(name for name in _METHODS)
    study = Study(lambda options: transient(system, **options, **fixed), judge, doubt, rising=rising, repeat=repeat)
    rungs = study.rungs(settings, part_of(progress, 0.2, 1.0))
    return ConvergenceStudy(
        model.title or "model", "transient", words, len(size), rungs, compared="statistics", resolution=doubt
    )
