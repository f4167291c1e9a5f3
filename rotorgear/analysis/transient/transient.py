"""Nonlinear transient: time response with backlash, k(t) and e(t), to a stated accuracy."""

from __future__ import annotations

import time as clock
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from rotorgear.analysis.common.left_out import left_out
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import missed
from rotorgear.analysis.common.stations import shapes_at_stations
from rotorgear.analysis.static.mean_state import mean_torsion_notes
from rotorgear.analysis.transient.balance import off_statics
from rotorgear.analysis.transient.choice_of_step import Choice, fine_enough
from rotorgear.analysis.transient.histories import Histories, Stream
from rotorgear.analysis.transient.notes import transient_left_out, transient_warnings
from rotorgear.analysis.transient.request import Grid, base_frequencies, grid_of, integrator_of, quantity, run_up
from rotorgear.analysis.transient.statistics import Judged, judged, of_channels, of_meshes
from rotorgear.analysis.transient.task import Task, coarser, damped, prepare, run_task
from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.model.model import Model
from rotorgear.old_names import renamed_arguments
from rotorgear.progress import Progress, silent
from rotorgear.results.transient import TransientResult
from rotorgear.solvers.time.explicit import Explicit, check_length
from rotorgear.solvers.time.exponential import Exponential
from rotorgear.solvers.time.local_system import Integrator
from rotorgear.solvers.time.statistics import STATISTICS, gain
from rotorgear.system.system import System

DEFAULT_ACCURACY = 0.01


@renamed_arguments(settle="discard")
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
    accuracy: float | None = None,
    method: str = "auto",
    modes: int | None = None,
    modal_damping: float | None = None,
    rho_inf: float | None = None,
    beta: float | None = None,
    gamma: float | None = None,
    elements: int | None = None,
    error_estimate: bool = True,
    frames: int = 0,
    stream: Stream | None = None,
    progress: Progress = silent,
) -> TransientResult:
    """Return the time response of a model from its static equilibrium.

    Args:
        model: a model, or its assembled system.
        speed: speed of the input shaft in rad/s or with its unit (default: the operating speed); in Python also pairs (time,
            speed), linear in between.
        speed_to: run up (or down) from `speed` to this one within the time evaluated, which `time` has to say.
        time: time that is evaluated, in s or with its unit, such as "0.2 s" (default: 30 periods of the slowest mesh).
        discard: time of the transient before it, which is computed but not evaluated.
        steps: number of steps in a period of the fastest mesh (default: the step is halved until the accuracy is reached or out
            of reach).
        records: number of records in a period of the fastest mesh (default: 40).
        accuracy: wanted relative accuracy of the statistics (default: 0.01, unless `steps` is given).
        method: auto, newmark, hht, generalised-alpha, exponential or explicit.
        modes: number of modes kept by the exponential method, with residual vectors (default: all).
        modal_damping: damping ratio added to every elastic mode, in place of the one in the model; exponential method only.
        rho_inf: what remains of the highest frequencies after a step of hht or generalised-alpha: 1 damps nothing, 0 most.
        beta: of newmark (default: 1/4).
        gamma: of newmark (default: 1/2).
        elements: number of basic elements in each shaft segment (default: one of second order).
        error_estimate: compare with a run of twice the step; False leaves it out.
        frames: number of records at the end that keep the motion of all nodes, for an animation.
        stream: keeps chunks while the run goes on (`rotorgear.stream`), and starts an interrupted run again.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: nothing to run, or a request that makes no sense.
        ConvergenceError: not even the first records came to be. A run that stops later returns what it has, and says
        so in `status`.
    """
    begun = clock.perf_counter()
    if steps is not None and accuracy is not None:
        raise AnalysisError("steps and accuracy: give one of the two; steps fixes the step, accuracy chooses it")
    if accuracy is not None and not 1e-8 <= accuracy < 1.0:
        raise AnalysisError(f"the accuracy must lie between 1e-8 and 1, got {accuracy:g}")
    if frames < 0:
        raise AnalysisError(f"frames: got {frames}, expected 0 or more")
    duration = [None if x is None else quantity(x, "time", name) for x, name in ((time, "time"), (discard, "discard"))]
    if speed_to is not None:
        speed = run_up(model, speed, speed_to, *duration)
    task = prepare(damped(model, modal_damping), speed, elements)
    frequencies = base_frequencies(task.local.system, task.largest)
    grid = grid_of(task.local.local, frequencies, duration[0], duration[1], steps, records)
    integrator, reason = integrator_of(
        method,
        task.local.local,
        grid.records * grid.every,
        modal_ratio=task.local.system.model.damping.modal_ratio,
        modes=modes,
        rho_inf=rho_inf,
        beta=beta,
        gamma=gamma,
    )
    laps = {"model": clock.perf_counter() - begun}
    choice = Choice(grid)
    if isinstance(integrator, Explicit):
        check_length(task.local.local, grid.records * grid.spacing)
    elif steps is None:
        choice = fine_enough(task, integrator, grid, accuracy or DEFAULT_ACCURACY, progress)
        grid = choice.grid
    laps["choice of step"] = clock.perf_counter() - begun - sum(laps.values())
    others = _comparisons(task, integrator, grid, progress) if error_estimate else []
    laps["error estimate"] = clock.perf_counter() - begun - sum(laps.values())
    found = run_task(
        task,
        integrator,
        grid,
        progress,
        stream=stream,
        frames=frames,
        key=f"{method} {modes} {rho_inf} {beta} {gamma}",
    )
    laps["integration"] = clock.perf_counter() - begun - sum(laps.values())
    laps["total"] = clock.perf_counter() - begun
    progress(1.0, "done")
    result = _result(task, grid, integrator, reason, found, others, laps, estimated=error_estimate)
    # A run without an estimate, or one that ended early, has said so already.
    if steps is not None or result.status != "success" or not np.isfinite(result.error_estimate):
        return result
    wanted = accuracy or DEFAULT_ACCURACY
    fastest = max(frequencies.values(), default=np.nan)
    remedy = choice.remedy(result.error_estimate, wanted, fastest, integrator.name)
    short = missed(wanted, result.error_estimate, remedy)
    return replace(result, status=short, warnings=(*result.warnings, short)) if short else result


def _result(
    task: Task,
    grid: Grid,
    integrator: Integrator,
    reason: str,
    found: Histories,
    others: list[tuple[Histories, float]],
    laps: dict[str, float],
    *,
    estimated: bool,
) -> TransientResult:
    system = task.local.system
    local = task.local.local
    of_run = judged(found, task)
    errors, largest = _errors(of_run, found, others, task)
    contacts = of_meshes(found, task)
    force = contacts.force
    seen = of_channels(found, task)
    t = found.table("t")
    meshes = [i for i, part in enumerate(task.local.parts) if part.is_mesh]
    columns = [int(local.forces.first[i]) for i in meshes]
    transverse = np.array([task.local.parts[i].transverse for i in meshes])
    steps = int(found.state.gathered.steps[0])
    negative = found.state.gathered.sums[columns, 2] / (steps or np.nan)
    if found.ledger is None:
        raise ConvergenceError(found.status)
    motion_time = np.concatenate([np.zeros(0), *(t for t, _ in found.motion)])
    motion = np.vstack([np.zeros((0, local.n)), *(q for _, q in found.motion)])
    nodes, shapes = shapes_at_stations(system, system.dofs.transform @ motion.T)
    result = TransientResult(
        model=system.model,
        time=t,
        angle=local.rotation.angle(t),
        speed=local.rotation.speed(t),
        settle=grid.settled * grid.spacing,
        contact=tuple(task.local.parts[i].label for i in meshes),
        approach=found.table("d")[:, columns] / transverse,
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
        contact_losses=found.state.events[meshes, 3],
        channel=task.channels.names,
        unit=task.channels.units,
        values=found.table("values"),
        value_mean=seen.mean,
        value_rms=seen.rms,
        value_range=np.column_stack([seen.least, seen.largest]),
        quantity=of_run.name,
        quantity_value=of_run.value,
        quantity_error=errors,
        quantity_scale=of_run.scale,
        energy=found.ledger,
        step=grid.spacing / grid.every,
        steps=found.state.step,
        every=grid.every,
        error_estimate=largest,
        dofs=local.n,
        seconds=laps,
        method=integrator.name,
        reason=reason,
        mesh_frequency=task.frequencies,
        nodes=nodes,
        motion_time=motion_time,
        motion=shapes,
        status=found.status,
        left_out=(
            *left_out(system, "time", task.largest),
            *transient_left_out(task.local),
            *mean_torsion_notes(task.local.system, task.largest),
        ),
    )
    notes = transient_warnings(result, task.rest, task.local, estimated=estimated, keeps_energy=integrator.keeps_energy)
    if result.status == "success":
        notes += off_statics(found, task, errors[: len(STATISTICS) * len(meshes) : len(STATISTICS)])
    return replace(result, warnings=notes)


def _comparisons(task: Task, integrator: Integrator, grid: Grid, progress: Progress) -> list[tuple[Histories, float]]:
    """Worse or better runs, each with the factor by which the run that counts is nearer to the truth, less 1.

    Twice the step is four times worse, less a margin. An explicit method chooses its own steps: there a hundred times the
    tolerance takes their place, looked at half as often, for means and extremes hang on that. Where modes are cut, a run has half
    as many more.
    """
    double, ratio = coarser(grid)
    if isinstance(integrator, Explicit):
        loose = Explicit(100.0 * integrator.relative)
        return [(run_task(task, loose, double, progress, text="looser tolerance"), 1.0)]
    try:
        found = [(run_task(task, integrator, double, progress, text="twice the step"), gain(ratio))]
    except ConvergenceError:
        return []
    if isinstance(integrator, Exponential) and integrator.modes is not None:
        fuller = Exponential(int(1.5 * integrator.modes), integrator.modal_ratio)
        found.append((run_task(task, fuller, grid, progress, text="more modes"), 1.0))
    return found


def _errors(
    of_run: Judged, found: Histories, others: list[tuple[Histories, float]], task: Task
) -> tuple[np.ndarray, float]:
    """Errors of the statistics: the sum of those that the comparisons tell, and the largest."""
    if not others or any(run.status != "success" for run in (found, *(run for run, _ in others))):
        return np.full(of_run.value.size, np.nan), float("nan")
    pairs = [of_run.errors(judged(run, task), factor) for run, factor in others]
    return np.sum([errors for errors, _ in pairs], axis=0), float(sum(largest for _, largest in pairs))
