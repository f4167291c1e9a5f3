"""Nonlinear transient: time response with backlash, k(t) and e(t), to a stated accuracy."""

from __future__ import annotations

import time as clock
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rotorgear.analysis.notes import left_out
from rotorgear.analysis.transient_channels import Channels, channels
from rotorgear.analysis.transient_histories import Histories, Stream, integrate
from rotorgear.analysis.transient_notes import transient_left_out, transient_warnings
from rotorgear.analysis.transient_request import (
    Grid,
    base_frequencies,
    grid_of,
    integrator_of,
    mesh_frequencies,
    quantity,
    rotation_of,
)
from rotorgear.analysis.transient_statistics import Statistics, compared, statistics
from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.results.transient import TransientResult
from rotorgear.solvers.equilibrium import Equilibrium, equilibrium, still_forces
from rotorgear.solvers.exponential import Exponential
from rotorgear.solvers.local_system import Integrator, state_at_rest
from rotorgear.solvers.run import Schedule
from rotorgear.system.local import LocalModel, local_model
from rotorgear.system.plan import Plan
from rotorgear.system.system import System

DEFAULT_ACCURACY = 0.01
# One element of this order a piece, unless elements are asked for.
_PLAN = Plan(elements=1, order=2)
_HALVINGS = 6
# The search for a step runs over so many steps at most.
_PROBE = 60_000


def transient(
    model: Model | System,
    *,
    speed: float | str | Sequence[tuple[float, float | str]] | None = None,
    time: float | str | None = None,
    settle: float | str | None = None,
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
    stream: Stream | None = None,
    progress: Progress = silent,
) -> TransientResult:
    """Return the time response of a model from its static equilibrium.

    Args:
        model: a model, or its assembled system.
        speed: of the input shaft in rad/s or as a text, or pairs (time, speed), linear in between. None: the operating speed.
        time: duration that counts in s or as a text; 30 periods of the slowest mesh where it is not given.
        settle: time before it, whose response does not count.
        steps: steps in a period of the fastest mesh; without it the step is halved until the accuracy is reached.
        records: records in a period of the fastest mesh; 40 where not given.
        accuracy: wanted relative accuracy of the statistics; 0.01 where neither it nor `steps` is given.
        method: auto, newmark, hht, generalised-alpha, exponential or explicit.
        modes: for the exponential method: so many real modes and residual vectors in place of all.
        modal_damping: damping ratio added to every elastic mode, in place of the one in the model; exponential method only.
        rho_inf: for hht and generalised-alpha: what remains of the highest frequencies after a step, 0 to 1.
        beta, gamma: for newmark; 1/4 and 1/2 where not given.
        elements: basic elements in each piece of shaft; one of second order where not given.
        error_estimate: False leaves the comparison with twice the step out.
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
    if modal_damping is not None and not 0.0 <= modal_damping < 1.0:
        raise AnalysisError(f"the damping ratio of the modes must lie between 0 and 1, got {modal_damping:g}")
    task = _task(model, speed, elements)
    duration = [None if x is None else quantity(x, "time", name) for x, name in ((time, "time"), (settle, "settle"))]
    grid = grid_of(
        task.local.local, base_frequencies(task.local.system, task.largest), duration[0], duration[1], steps, records
    )
    integrator, reason = integrator_of(
        method, task.local.local, grid.records * grid.every, modal_ratio=task.local.system.model.damping.modal_ratio if
        modal_damping is None else modal_damping,
        modes=modes, rho_inf=rho_inf, beta=beta, gamma=gamma,
    )  # fmt: skip
    laps = {"model": clock.perf_counter() - begun}
    if steps is None:
        grid = _fine_enough(task, integrator, grid, accuracy or DEFAULT_ACCURACY, progress)
    laps["choice of step"] = clock.perf_counter() - begun - sum(laps.values())
    others: list[Histories] = []
    if error_estimate:
        double = replace(grid, every=max(1, grid.every // 2)) if grid.every > 1 else None
        others.append(_run(task, integrator, double or _skipping(grid), progress, text="twice the step"))
        if isinstance(integrator, Exponential) and integrator.modes is not None:
            fuller = Exponential(int(1.5 * integrator.modes), integrator.modal_ratio)
            others.append(_run(task, fuller, grid, progress, text="more modes"))
    laps["error estimate"] = clock.perf_counter() - begun - sum(laps.values())
    found = _run(
        task,
        integrator,
        grid,
        progress,
        stream=stream,
        key=f"{method} {modes} {modal_damping} {rho_inf} {beta} {gamma}",
    )
    laps["integration"] = clock.perf_counter() - begun - sum(laps.values())
    laps["total"] = clock.perf_counter() - begun
    progress(1.0, "done")
    return _result(task, grid, integrator.name, reason, found, others, laps)


@dataclass(frozen=True)
class _Task:
    local: LocalModel
    channels: Channels
    rest: Equilibrium
    rest_force: np.ndarray
    frequencies: dict[str, float]
    largest: float


def _task(
    model: Model | System, speed: float | str | Sequence[tuple[float, float | str]] | None, elements: int | None
) -> _Task:
    if elements is not None and elements < 1:
        raise AnalysisError(f"the number of elements must be at least 1, got {elements}")
    given = model if isinstance(model, System) else System(model, plan=Plan(elements) if elements else _PLAN)
    rotation = rotation_of(given, speed)
    largest = float(rotation.speeds[np.argmax(np.abs(rotation.speeds))])
    direction = -1 if largest < 0.0 else 1
    if direction != given.direction:
        given = System(given.model, plan=given.plan, direction=direction)
    if given.n == 0:
        raise AnalysisError("the model has no free degree of freedom: its supports and motions hold everything")
    local = local_model(given, rotation, largest)
    rest, force = equilibrium(local.local), still_forces(local.local, tuple(part.law.mean() for part in local.parts))
    return _Task(local, channels(local), rest, force, mesh_frequencies(given, largest), largest)


def _run(
    task: _Task,
    integrator: Integrator,
    grid: Grid,
    progress: Progress,
    *,
    stream: Stream | None = None,
    text: str = "",
    key: str = "",
) -> Histories:
    h = grid.spacing / grid.every
    system = task.local.local
    settings = {
        "model": task.local.system.model.model_dump_json(exclude_none=True),
        "run": f"{h!r} {grid.records} {grid.every} {grid.settled} {system.n} {integrator.name} {key} "
        f"{system.rotation.times.tolist()} {system.rotation.speeds.tolist()}",
    }

    def told(fraction: float, step: str) -> None:
        progress(fraction, f"{text}: {step}" if text else step)

    return integrate(
        system, integrator, Schedule(h, grid.records * grid.every, grid.every), state_at_rest(system, h, task.rest.q),
        task.channels, grid.settled, stream=stream, settings=settings, progress=told,
    )  # fmt: skip


def _skipping(grid: Grid) -> Grid:
    """The grid of twice the step where every step is recorded: every second record is missing."""
    return replace(grid, spacing=2.0 * grid.spacing, records=grid.records // 2, settled=grid.settled // 2)


def _fine_enough(task: _Task, integrator: Integrator, grid: Grid, accuracy: float, progress: Progress) -> Grid:
    """Halve the step until the statistics of a run, or of its beginning, agree with those of twice the step."""
    records = min(grid.records, max(_PROBE // grid.every, 8))
    probe = replace(grid, records=records, settled=min(grid.settled, records // 2))
    last = statistics(_run(task, integrator, probe, progress, text="choosing the step"), task, probe.settled)
    for _ in range(_HALVINGS):
        finer = replace(probe, every=2 * probe.every)
        now = statistics(_run(task, integrator, finer, progress, text="choosing the step"), task, probe.settled)
        error = compared(now, last)[1]
        # What the finer of the two was found to be good for.
        if error <= accuracy:
            # Second order: the coarser one is four times worse.
            return replace(grid, every=finer.every if 4.0 * error > accuracy else probe.every)
        probe, last = finer, now
    return replace(grid, every=probe.every)


def _result(
    task: _Task,
    grid: Grid,
    method: str,
    reason: str,
    found: Histories,
    others: list[Histories],
    laps: dict[str, float],
) -> TransientResult:
    system, local = task.local.system, task.local.local
    own: Statistics = statistics(found, task, grid.settled)
    errors, largest = _errors(own, found, others, task, grid)
    t = found.table("t")
    meshes = [i for i, part in enumerate(task.local.parts) if part.is_mesh]
    columns = [int(local.forces.first[i]) for i in meshes]
    events = found.state.events[meshes].astype(float)
    if found.ledger is None:
        raise ConvergenceError(found.status)
    result = TransientResult(
        model=system.model, time=t, angle=local.rotation.angle(t), speed=local.rotation.speed(t),
        settle=grid.settled * grid.spacing,
        contact=tuple(task.local.parts[i].label for i in meshes),
        deflection=found.table("d")[:, columns], mesh_force=found.table("F")[:, columns],
        mean_force=task.rest_force[columns],
        contact_time=events[:, :3] / np.maximum(events[:, :3].sum(axis=1, keepdims=True), 1.0),
        contact_losses=found.state.events[meshes, 3],
        channel=task.channels.names, unit=task.channels.units, values=found.table("values"),
        quantity=own.name, quantity_value=own.value, quantity_error=errors, energy=found.ledger,
        step=grid.spacing / grid.every, steps=found.state.step, every=grid.every, error_estimate=largest,
        dofs=local.n, seconds=laps, method=method, reason=reason, mesh_frequency=task.frequencies,
        status=found.status, left_out=(*left_out(system, float(local.rotation.speeds[0])), *transient_left_out(task.local)),
    )  # fmt: skip
    return replace(result, warnings=transient_warnings(result, task.rest, task.local))


def _errors(
    own: Statistics, found: Histories, others: list[Histories], task: _Task, grid: Grid
) -> tuple[np.ndarray, float]:
    """Errors of the statistics: that of the step, from twice the step, and that of missing modes, from half as many more."""
    if not others or any(run.status != "success" for run in (found, *others)):
        return np.full(own.value.size, np.nan), float("nan")
    pairs = [
        compared(own, statistics(run, task, _settled_of(run, grid)), 1.0 if number else 3.0)
        for number, run in enumerate(others)
    ]
    return np.sum([errors for errors, _ in pairs], axis=0), float(sum(largest for _, largest in pairs))


def _settled_of(run: Histories, grid: Grid) -> int:
    t = run.table("t")
    return int(np.searchsorted(t, grid.settled * grid.spacing * (1.0 - 1e-9)))
