"""A transient made ready, and its runs: the one that counts, and those that choose the step and tell its error."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rotorgear.analysis.common.discretise import plan_in_time
from rotorgear.analysis.static.about_equilibrium import state_in_time
from rotorgear.analysis.static.mean_state import springs_about_mean
from rotorgear.analysis.transient.channels import Channels, channels
from rotorgear.analysis.transient.histories import Histories, Stream, integrate
from rotorgear.analysis.transient.request import Grid, mesh_frequencies, rotation_of
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model, model_hash
from rotorgear.progress import Progress
from rotorgear.solvers.time.contact_equilibrium import Equilibrium, equilibrium, forces_at_rest
from rotorgear.solvers.time.local_system import Integrator, state_at_rest
from rotorgear.solvers.time.run import Schedule
from rotorgear.system.local import LocalModel, local_model
from rotorgear.system.system import System, flow_system


@dataclass(frozen=True)
class Task:
    """A model made ready: local forces, channels, static state and forces, mesh frequencies in Hz, largest speed in rad/s."""

    local: LocalModel
    channels: Channels
    rest: Equilibrium
    rest_force: np.ndarray
    frequencies: dict[str, float]
    largest: float


def prepare(
    model: Model | System, speed: float | str | Sequence[tuple[float, float | str]] | None, elements: int | None
) -> Task:
    """Make a model ready.

    Raises:
        AnalysisError: nothing is free to move, or the speed makes no sense.
    """
    given = model if isinstance(model, System) else flow_system(model, plan_in_time(elements))
    rotation = rotation_of(given, speed)
    largest = float(rotation.speeds[np.argmax(np.abs(rotation.speeds))])
    direction = -1 if largest < 0.0 else 1
    if direction != given.direction:
        given = given.with_state(given.model.torque_flow(direction))
    found = state_in_time(given.model, largest, direction)
    # Forces and flanks of a given torque flow stay where the equilibrium says nothing of the teeth; what else a given state has
    # is linear about another equilibrium, and motions in time take the laws themselves.
    keep = given.state.is_flow and not found.faces
    given = given.with_state(replace(given.state, films=found.films) if keep else found)
    if given.n == 0:
        raise AnalysisError("the model has no free degree of freedom: its supports and motions hold everything")
    local = springs_about_mean(local_model(given, rotation, largest, along_faces=True), largest)
    rest = equilibrium(local.local)
    force = forces_at_rest(local.local, tuple(part.law.mean() for part in local.parts))
    seen = channels(local)
    observed = seen.observed(local.local.n, local.local.m)
    local = replace(local, local=replace(local.local, observed=observed))
    return Task(local, seen, rest, force, mesh_frequencies(given, largest), largest)


def damped(model: Model | System, modal_damping: float | None) -> Model | System:
    """The model with another damping ratio of its modes."""
    if modal_damping is None:
        return model
    if not 0.0 <= modal_damping < 1.0:
        raise AnalysisError(f"the damping ratio of the modes must lie between 0 and 1, got {modal_damping:g}")
    given = model.model if isinstance(model, System) else model
    damping = given.damping.model_copy(update={"modal_ratio": modal_damping})
    changed = given.model_copy(update={"damping": damping})
    return flow_system(changed, model.plan).with_state(model.state) if isinstance(model, System) else changed


def run_task(
    task: Task,
    integrator: Integrator,
    grid: Grid,
    progress: Progress,
    *,
    stream: Stream | None = None,
    text: str = "",
    key: str = "",
    frames: int = 0,
) -> Histories:
    """Integrate over a grid; `text` names a run that only serves another one, which an interruption ends for good."""
    h = grid.spacing / grid.every
    system = task.local.local
    settings = {
        "model": model_hash(task.local.system.model),
        "run": f"{h!r} {grid.records} {grid.every} {grid.settled} {system.n} {system.watched_vectors.shape[1]} "
        f"{integrator.name} {key} {system.rotation.times.tolist()} "
        f"{system.rotation.speeds.tolist()}",
    }

    def told(fraction: float, step: str) -> None:
        progress(fraction, f"{text}: {step}" if text else step)

    found = integrate(
        system,
        integrator,
        Schedule(h, grid.records * grid.every, grid.every),
        state_at_rest(system, h, task.rest.q),
        task.channels,
        grid.settled,
        stream=stream,
        settings=settings,
        frames=frames,
        progress=told,
    )
    if text and found.status.startswith("interrupted"):
        raise KeyboardInterrupt
    return found


def coarser(grid: Grid) -> tuple[Grid, float]:
    """The grid of twice the step, or of three times where steps between records are three, and by how much its step is larger.

    Where every step is recorded, every second record is missing.
    """
    if grid.every == 1:
        return replace(grid, spacing=2.0 * grid.spacing, records=grid.records // 2, settled=grid.settled // 2), 2.0
    every = grid.every // 2
    return replace(grid, every=every), grid.every / every
