"""Error against run time of a transient over steps, methods and numbers of modes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from rotorgear.analysis.common.discretise import plan_in_time
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.transient.transient import transient
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.results.convergence import ConvergenceStudy, Rung
from rotorgear.results.transient import TransientResult
from rotorgear.system.system import System

STEPS = (40, 80, 160, 320, 640)
REFERENCE_STEPS = 5120
_RECORDS = 40
_PERIODS = 8
_METHODS = ("newmark", "generalised-alpha", "exponential")
_SHARES = (0.25, 0.5)
_ROUNDING = 1e-9
# Less is no order: the error is one of missing modes.
_NO_ORDER = 0.1


@recorded
def transient_convergence_study(
    model: Model,
    *,
    speed: float | str | None = None,
    time: float | str | None = None,
    modal_damping: float | None = None,
    steps: Sequence[int] = STEPS,
    progress: Progress = silent,
) -> ConvergenceStudy:
    """Run a transient from its equilibrium over a series of steps, methods and numbers of modes.

    The error is the root mean square of the difference of all contact forces from the reference, over that of their change; the
    reference is the exponential method with all modes and 5120 steps in a period of the fastest mesh.

    Args:
        model, speed, modal_damping: as for `transient`. Damping by modes leaves only the exponential method.
        time: duration in s or as a text; 8 periods of the slowest mesh where not given.
        steps: numbers of steps in a period of the fastest mesh, multiples of 40.

    Raises:
        AnalysisError: a model without meshes, or without excitation.
    """
    if not model.meshes:
        raise AnalysisError("the convergence study of a transient compares contact forces: the model has no mesh")
    system = System(model, plan=plan_in_time())
    fixed: dict[str, Any] = {"speed": speed, "discard": 0.0, "records": _RECORDS, "modal_damping": modal_damping}
    if time is None:
        # The mesh frequencies stand in any transient: the shortest one, without damping by modes, which Newmark can't take.
        bare: dict[str, Any] = {"speed": speed, "discard": 0.0, "records": _RECORDS, "modal_damping": 0.0, "time": 1e-4}
        short = transient(system, method="newmark", steps=_RECORDS, error_estimate=False, **bare)
        time = _PERIODS / min(short.mesh_frequency.values())
    fixed["time"] = time
    damped = model.damping.modal_ratio if modal_damping is None else modal_damping
    truth = transient(system, method="exponential", steps=REFERENCE_STEPS, error_estimate=False, **fixed)
    if truth.mesh_force.std(axis=0).max() <= 1e-9 * np.abs(truth.mesh_force).max():
        raise AnalysisError("nothing moves: give a transmission error, a stiffness variation or an unbalance")
    cut = [int(share * truth.dofs) for share in _SHARES]
    plans: list[tuple[str, dict[str, Any]]] = [
        (name, {"method": name}) for name in _METHODS if not damped or name == "exponential"
    ]
    plans += [(f"{n} modes", {"method": "exponential", "modes": n}) for n in cut if n > 20]
    rungs: list[Rung] = []
    for number, (name, options) in enumerate(plans):
        for count in steps:
            progress((number + count / (2.0 * max(steps))) / len(plans), f"{name}, {count} steps")
            found = transient(system, steps=count, **options, **fixed)
            rungs.append(_rung(name, count, found, truth, rungs))
    progress(1.0, "done")
    words = f"the exponential method with all modes and {REFERENCE_STEPS} steps in a mesh period"
    return ConvergenceStudy(model.title or "model", "transient", words, len(truth.contact), tuple(rungs))


def _rung(name: str, count: int, found: TransientResult, truth: TransientResult, before: list[Rung]) -> Rung:
    n = min(len(found.time), len(truth.time))
    difference = found.mesh_force[:n] - truth.mesh_force[:n]
    change = truth.mesh_force[:n] - truth.mesh_force[:n].mean(axis=0)
    error = float(np.sqrt(np.mean(difference**2) / np.mean(change**2)))
    rung = Rung(
        f"{name}, {count} steps",
        name,
        float(count),
        found.dofs,
        found.seconds["integration"],
        error,
        found.error_estimate,
        None,
    )
    last = before[-1] if before and before[-1].family == name else None
    if last is None or min(error, last.error) < _ROUNDING:
        return rung
    order = float(np.log(last.error / error) / np.log(count / last.setting))
    return replace(rung, order=order if order > _NO_ORDER else None)
