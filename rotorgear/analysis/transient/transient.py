"""Nonlinear transient: time response with backlash, k(t) and e(t), to a stated accuracy.

Mean contact forces against statics: over a settled time, forces balance the loads on every free motion of what they join.

With R the motions that neither springs nor bearings hold (K R = 0, contacts left out), M-orthonormal, the equations of motion
give in the mean over a time T

    R^T B mean(F) = R^T f - R^T M [q'(T) - q'(0)]/T

and the last term goes to zero as the run settles or T grows. So the part of the mean forces that R sees is that of statics.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from rotorgear.analysis.common.forecast import Forecast
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import check_whole, missed, quantity
from rotorgear.analysis.common.stations import shapes_at_stations
from rotorgear.analysis.common.stream import Stream
from rotorgear.analysis.transient.errors import FALLS, Stated, fine_enough, stated
from rotorgear.analysis.transient.histories import Histories, run_task
from rotorgear.analysis.transient.notes import (
    adrift,
    damped_at_nodes,
    damped_in_bearings,
    intact,
    left_out_in_time,
    thinned,
    transient_warnings,
)
from rotorgear.analysis.transient.request import (
    STARTS,
    Grid,
    Task,
    check_method,
    damped,
    grid_of,
    integrator_of,
    motions_without_strain,
    prepare,
    run_up,
)
from rotorgear.analysis.transient.statistics import of_channels, of_meshes, quantities_of
from rotorgear.cpu import Clock
from rotorgear.errors import AnalysisError, ConvergenceError, RotorgearError
from rotorgear.model.model import Model
from rotorgear.note import Note
from rotorgear.progress import Progress, silent
from rotorgear.results.transient import TransientResult
from rotorgear.solvers.time.explicit import Explicit, check_length
from rotorgear.solvers.time.local_system import Integrator
from rotorgear.solvers.time.statistics import STATISTICS, Statistics
from rotorgear.system.rigid_motions import rigid_motions
from rotorgear.system.system import System

DEFAULT_ACCURACY = 0.01


@recorded
def transient(
    model: Model | System,
    *,
    speed: float | str | Sequence[tuple[float, float | str]] | None = None,
    speed_to: float | str | None = None,
    time: float | str | None = None,
    discard: float | str | None = None,
    steps: int | None = None,
    records: int | None = None,
    interval: float | str | None = None,
    accuracy: float | None = None,
    method: str = "auto",
    modes: int | None = None,
    modal_damping: float | None = None,
    rho_inf: float | None = None,
    beta: float | None = None,
    gamma: float | None = None,
    elements: int | None = None,
    start: str = "equilibrium",
    error_estimate: bool = True,
    frames: int = 0,
    stream: Stream | None = None,
    progress: Progress = silent,
) -> TransientResult:
    """Return the time response of a model from a static state.

    Args:
        model: a model, or its assembled system.
        speed: speed of the input shaft in rad/s or with its unit (default: the operating speed); in Python also pairs (time,
            speed), linear in between.
        speed_to: run up (or down) from `speed` to this one within the time evaluated, which `time` has to say.
        time: time that is evaluated, in s or with its unit, such as "0.2 s" (default: 30 periods of the slowest mesh).
        discard: time of the transient before it, which is computed but not evaluated.
        steps: number of steps in a period of the fastest mesh (default: the step is halved until the accuracy is reached or out
            of reach).
        records: number of records in a period of the fastest mesh (default: 40, or fewer where the histories would take more
            than 1 GB).
        interval: time between two records, in s or with its unit, in place of records; steps are then counted in 40 of it where
            no mesh turns.
        accuracy: wanted relative accuracy of the statistics (default: 0.01, unless `steps` is given).
        method: auto, newmark, hht, generalised-alpha, exponential or explicit.
        modes: number of modes kept by the exponential method, with residual vectors (default: all).
        modal_damping: damping ratio added to every elastic mode, in place of the one in the model; exponential method only.
        rho_inf: what remains of the highest frequencies after a step of hht or generalised-alpha: 1 damps nothing, 0 most.
        beta: of newmark (default: 1/4).
        gamma: of newmark (default: 1/2).
        elements: number of basic elements in each shaft segment (default: one of second order).
        start: equilibrium (under all forces of t = 0, unbalances and harmonic forces among them), mean (equilibrium under the
            mean forces) or rest (nothing deformed, the working flanks just touch where no error parts them). In all of them the
            shafts turn at the prescribed speed, and nothing moves beside it.
        error_estimate: compare with runs of a third of the step and of twice the step, which take 3.5 times as long as the run
            itself; False leaves it out.
        frames: number of records at the end that keep the motion of all nodes, for an animation.
        stream: keeps chunks while the run goes on (`rotorgear.stream`), and starts an interrupted run again.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: nothing to run, or a request that makes no sense.
        ConvergenceError: not even the first records came to be. A run that stops later returns what it has, and says
            so in `status`.
    """
    clock = Clock()
    if steps is not None and accuracy is not None:
        raise AnalysisError("steps and accuracy: give one of the two; steps fixes the step, accuracy chooses it")
    if accuracy is not None and not 1e-8 <= accuracy < 1.0:
        raise AnalysisError(f"the accuracy must lie between 1e-8 and 1, got {accuracy:g}")
    check_method(method, rho_inf, beta, gamma)
    if steps is not None:
        check_whole("the number of steps", steps)
    if frames < 0:
        raise AnalysisError(f"frames: got {frames}, expected 0 or more")
    times = {"time": time, "discard": discard, "interval": interval}
    *duration, spacing = [None if x is None else quantity(x, "time", name) for name, x in times.items()]
    if speed_to is not None:
        speed = run_up(model, speed, speed_to, *duration)
    task = prepare(damped(model, modal_damping), speed, elements, start)
    grid, fastest = grid_of(task, duration[0], duration[1], steps, records, spacing)
    integrator, reason = integrator_of(task, grid, method, modes, rho_inf, beta, gamma)
    clock.lap("model")
    wanted = accuracy or DEFAULT_ACCURACY
    left = 1.0
    if isinstance(integrator, Explicit):
        check_length(task.local.local, grid.records * grid.spacing)
    elif steps is None:
        grid, left = fine_enough(task, integrator, grid, wanted, progress)
    clock.lap("choice of step")
    key = f"{method} {modes} {rho_inf} {beta} {gamma}" + f" {start}" * (start != STARTS[0])
    whole = "for the motion; the estimate of its error comes on top" if error_estimate else "in all"
    measuring = Forecast("transient", clock.worked, whole=whole).measuring(progress)
    found = run_task(task, integrator, grid, measuring, stream=stream, frames=frames, key=key)
    clock.lap("integration")
    told = stated(found, task, integrator, grid, progress) if error_estimate else None
    clock.lap("error estimate")
    progress(1.0, "done")
    result = replace(_result(task, grid, integrator, reason, found, told), seconds=clock.total())
    # A run without an estimate, or one that ended early, has said so already.
    if steps is not None or result.status != "success" or not np.isfinite(result.error_estimate):
        return result
    # What would reach the accuracy, by what a halving of the step left of the error.
    remedy = "smaller steps do not lower it"
    if told and told.parted:
        remedy += ": motions of two steps part, as in chaos; a longer time lowers the scatter of its statistics"
    elif left <= FALLS:
        remedy = "take more steps in a period of the fastest motion (--steps)"
        if fastest:
            count = (result.error_estimate / wanted) ** (-1.0 / np.log2(left)) / (result.step * fastest)
            many = f"{float(f'{count:.2g}'):.0f} steps in a mesh period (--steps)"
            remedy = f"about {many} of the same method ({integrator.name}) would reach it, by how it falls"
    short = missed(wanted, result.error_estimate, remedy)
    return replace(result, status=short, warnings=(*result.warnings, short)) if short else result


def _result(
    task: Task,
    grid: Grid,
    integrator: Integrator,
    reason: str,
    found: Histories,
    told: Stated | None,
) -> TransientResult:
    system = task.local.system
    local = task.local.local
    of_run = quantities_of(found, task)
    estimated = told is not None
    told = told or Stated(np.full(of_run.value.size, np.nan), float("nan"), "")
    contacts = of_meshes(found, task)
    force = contacts.force
    seen = of_channels(found, task)
    t = found.table("t")
    meshes = task.local.meshes
    columns = task.local.mesh_columns
    steps = int(found.state.gathered.steps[0])
    negative = found.state.gathered.sums[columns, 2] / (steps or np.nan)
    if found.ledger is None:
        raise ConvergenceError(found.status)
    motion = np.vstack([np.zeros((0, local.n)), *(q for _, q in found.motion)])
    nodes, shapes = shapes_at_stations(system, system.dofs.transform @ motion.T)
    result = TransientResult(
        model=system.model,
        time=t,
        angle=local.rotation.angle(t),
        speed=local.rotation.speed(t),
        settle=grid.settled * grid.spacing,
        contact=tuple(task.local.parts[i].label for i in meshes),
        approach=found.table("d")[:, columns] / task.local.transverse,
        transmission_error=found.table("watched"),
        approach_range=contacts.approach,
        transmission_error_range=contacts.transmission_error,
        mesh_force=found.table("F")[:, columns],
        mean_force=task.rest_force[columns],
        force_mean=force.mean,
        force_rms=force.rms,
        force_range=np.column_stack([force.least, force.largest]),
        impulse=np.column_stack([force.mean - negative, -negative]) * (steps * found.h),
        contact_time=contacts.shares,
        contact_losses=found.state.events[meshes, 3].astype(int),
        channel=task.channels.names,
        unit=task.channels.units,
        values=found.table("values"),
        value_mean=seen.mean,
        value_rms=seen.rms,
        value_range=np.column_stack([seen.least, seen.largest]),
        quantity=of_run.name,
        quantity_value=of_run.value,
        quantity_error=told.errors,
        quantity_scale=of_run.scale,
        energy=found.ledger,
        start=task.start,
        step=grid.spacing / grid.every,
        steps=found.state.step,
        every=grid.every * grid.kept,
        error_estimate=told.largest,
        error_source=told.source,
        dofs=local.n,
        method=integrator.name,
        reason=reason,
        mesh_frequency=task.frequencies,
        nodes=nodes,
        motion_time=np.concatenate([np.zeros(0), *(t for t, _ in found.motion)]),
        motion=shapes,
        status=found.status,
        left_out=(
            *left_out_in_time(task.local, task.largest),
            *damped_at_nodes(system.model),
            *damped_in_bearings(system.model),
            *thinned(task, grid),
        ),
    )
    notes = [*transient_warnings(result, task, estimated=estimated, keeps_energy=integrator.keeps_energy)]
    if result.status == "success":
        notes += off_statics(found, task, told.errors[: len(STATISTICS) * len(meshes) : len(STATISTICS)])
    return replace(result, left_out=(*result.left_out, *intact(result, task.local)), warnings=tuple(notes))


# Share of the static force that a mean may be off beside its error: what is left of a start, and incomplete periods.
_SHARE = 0.01
_SEEN = 1e-9
_ROUNDING = 1e-6


def off_statics(found: Histories, task: Task, error: np.ndarray) -> Iterator[Note]:
    """Yield facts on contacts whose mean force differs from statics by more than its error (c,)."""
    local = task.local.local
    force = Statistics.of_steps(found.state.gathered).chosen(slice(0, local.m))
    meshes = task.local.meshes
    known = np.all(np.isfinite(task.rest_force)) and task.rest.converged
    steady = local.rotation.is_constant and not list(adrift(task))
    if not (np.all(np.isfinite(force.mean)) and meshes and known and steady):
        return
    try:
        if local.sisters.planets.size:
            # What planets that go round bring beside their springs is no strain.
            free = rigid_motions(task.local.system, task.local.groups)
        else:
            free = motions_without_strain(local, local.K)
        A = free.T @ local.B.toarray()
    except RotorgearError as refusal:
        yield Note("", "mean contact forces are not compared with statics", str(refusal))
        return
    _, size, V = np.linalg.svd(A, full_matrices=False)
    seen = V[size > _SEEN * size.max(initial=0.0)]
    off = seen.T @ (seen @ (force.mean - task.rest_force))
    # Of flanks that carry nothing, statics leave the rounding of what the others carry.
    rounding = _ROUNDING * float(np.abs(task.rest_force).max(initial=0.0))
    for k, i in enumerate(meshes):
        j = int(local.forces.first[i])
        scale = float(np.hypot(force.mean[j], force.rms[j]))
        allowed = max(_SHARE * max(abs(task.rest_force[j]), scale), float(np.nan_to_num(error[k])), rounding)
        if abs(off[j]) > allowed:
            what = f"the mean contact force is {force.mean[j]:.4g} N, the loads need {force.mean[j] - off[j]:.4g} N by statics"
            why = "not settled, no whole number of periods, or too large a step"
            yield Note(task.local.parts[i].label, f"{what}: {why}")
