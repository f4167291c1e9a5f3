"""What a transient was asked for, with its defaults: speed over time, duration, first step, method and the reason for it.

A transient made ready, and its runs: the one that counts, and those that choose the step and tell its error.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from rotorgear.analysis.common.discretise import plan_in_time
from rotorgear.analysis.common.request import check_modal_damping, check_whole, needed_speed, quantity
from rotorgear.analysis.static.about_equilibrium import state_in_time
from rotorgear.analysis.static.mean_state import springs_about_mean
from rotorgear.analysis.transient.channels import Channels, channels
from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.memory import free_memory
from rotorgear.model.model import Model
from rotorgear.solvers.time.contact_equilibrium import Equilibrium, equilibrium, free_motions
from rotorgear.solvers.time.exponential import Exponential
from rotorgear.solvers.time.local_system import Integrator, LocalSystem, Rotation, contact_rates
from rotorgear.solvers.time.newmark import Newmark, held_by_contacts
from rotorgear.solvers.time.sisters import sisters_of
from rotorgear.system.local import LocalModel, local_model
from rotorgear.system.planets import sister_places
from rotorgear.system.system import System, flow_system

# What the forces that hold a model where a run starts are: those at t = 0, their means, none.
STARTS = ("equilibrium", "mean", "rest")
METHODS = ("auto", "newmark", "hht", "generalised-alpha", "exponential", "explicit")
# Periods of the slowest mesh that settle, and as many that count.
PERIODS = 30
# Records and first steps in a period of the fastest mesh, first steps in a period of the contact resonance.
RECORDS = 40
STEPS = 100
CONTACT_STEPS = 20
# Largest system whose complex modes are all found without being asked: dense matrices of 2n.
_ALL_MODES = 900
MOST_STEPS = 200_000_000
# Bytes that the histories of a run fill unless `records` asks for more; they are copied once when the result is made.
MOST_HISTORY = 1e9
_LEAST_RECORDS = 4
_SHORT = 1e-9  # s


@dataclass(frozen=True)
class Grid:
    """Times of a run: spacing of the records in s, their number, the first that counts, and steps in a spacing at first.

    `kept`: of so many records the histories hold one.
    """

    spacing: float
    records: int
    settled: int
    every: int
    kept: int = 1


def rotation_of(system: System, speed: float | str | Sequence[tuple[float, float | str]] | None) -> Rotation:
    """Speed of the reference over time from a number, a text, or pairs of time and speed."""
    if speed is None or isinstance(speed, int | float | str):
        return Rotation.constant(needed_speed(speed, system.model))
    pairs = [(quantity(t, "time", "speed"), quantity(w, "speed", "speed")) for t, w in speed]
    return Rotation(np.array([t for t, _ in pairs]), np.array([w for _, w in pairs]))


def run_up(
    model: Model | System,
    speed: float | str | Sequence[tuple[float, float | str]] | None,
    speed_to: float | str,
    time: float | None,
    discard: float | None,
) -> list[tuple[float, float | str]]:
    """Pairs of time in s and speed: `speed` while the transient is discarded, then linear to `speed_to`.

    Raises:
        AnalysisError: no speed to start from, or no time for the run-up.
    """
    if isinstance(speed, Sequence) and not isinstance(speed, str):
        raise AnalysisError("speed_to: goes with one speed to start from, not with pairs of time and speed")
    first = speed if speed is not None else (model.model if isinstance(model, System) else model).operating_speed
    if first is None or time is None:
        raise AnalysisError(
            "speed_to (--speed-to) needs a speed to start from (--speed) and a time for the run-up (--time)"
        )
    start = discard or 0.0
    return [(start, first), (start + time, speed_to)]


def base_frequencies(task: Task) -> list[float]:
    """Frequencies in Hz that lay the times out: those of the meshes, else of bearings' elements, else of the shafts."""
    system = task.local.system
    turns = {name: abs(float(system.train.ratio(name)) * task.largest) / (2.0 * np.pi) for name in system.model.shafts}
    bearings = system.model.bearings.values()
    rolling = [bearing.rolling.elements * turns[bearing.shaft] for bearing in bearings if bearing.rolling]
    return [f for f in task.frequencies.values() or rolling or turns.values() if f]


def grid_of(
    task: Task,
    time: float | None,
    settle: float | None,
    steps: int | None,
    records: int | None,
    interval: float | None = None,
) -> tuple[Grid, float]:
    """Lay the times out; with the frequency in Hz of the fastest mesh, in whose periods steps are counted, or 0.

    Raises:
        AnalysisError: nothing says how long to run, or the run would have too many steps.
    """
    for name, count_wanted in (("steps", steps), ("records", records)):
        if count_wanted is not None:
            check_whole(f"the number of {name}", count_wanted)
    for name, given in (("time", time), ("interval", interval)):
        if given is not None and not 0.0 < given < np.inf:
            raise AnalysisError(f"{name}: got {given}, expected more than 0")
    if interval is not None and records is not None:
        raise AnalysisError("records and interval (--records, --interval): give one of the two")
    # Highest frequency at which a contact alone would vibrate on the inertia it meets: sqrt(k b^T M^-1 b).
    local = task.local.local
    rates = contact_rates(local.M, local.B.toarray(), local.forces.reference_stiffness)
    contact = float(rates.max(initial=0.0)) / (2.0 * np.pi)
    frequencies = base_frequencies(task)
    if not frequencies and interval is not None:
        frequencies = [1.0 / (RECORDS * interval)]
    fastest = max(frequencies, default=0.0)
    slowest = min(frequencies, default=0.0)
    if fastest == 0.0 and (time is None or contact == 0.0):
        raise AnalysisError(
            "nothing turns that says how long to run and in what steps: give a time, and a speed or meshes"
        )
    base = fastest or contact
    settle = settle if settle is not None else (0.0 if time is not None else PERIODS / slowest)
    total = settle + (time if time is not None else PERIODS / slowest)
    spacing = interval or 1.0 / (base * (records or RECORDS))
    wanted = 1.0 / (base * steps) if steps else min(1.0 / (base * STEPS), 1.0 / (max(contact, 1e-300) * CONTACT_STEPS))
    every = max(1, int(np.ceil(spacing / wanted * (1.0 - 1e-9))))
    if steps and every * wanted < spacing * (1.0 - 1e-9):
        spacing = every * wanted  # so that the steps asked for are exact
    count = int(np.ceil(total / spacing - 1e-6))
    if count < _LEAST_RECORDS:
        raise AnalysisError(
            f"{total:g} s gives only {count} records {spacing:.3g} s apart, at least {_LEAST_RECORDS} are needed: "
            "ask for more time, or for more records in a period of the fastest mesh (records, --records)"
        )
    if count * every > MOST_STEPS:
        raise AnalysisError(
            f"{total:g} s would take {count * every:.3g} steps of {spacing / every:.3g} s; ask for less time, or set the steps"
            + ("" if steps else _of_stiff_contact(task, rates))
        )
    return Grid(spacing, count, round(settle / spacing), every, _kept(task, count, records or interval)), fastest


def _of_stiff_contact(task: Task, rates: np.ndarray) -> str:
    """What makes automatic steps short, and what to do about it; `rates` (m,) in rad/s of the local displacements."""
    column = int(np.argmax(rates))
    part = task.local.parts[int(np.searchsorted(task.local.local.forces.first, column, side="right")) - 1]
    remedy = "take stiffness = 'rigid' for teeth that are stiff beside all else" if part.is_mesh else "soften it"
    return (
        f" (steps), which method = 'newmark' stays stable with: they are so short because {part.part} vibrates at "
        f"{rates[column] / (2.0 * np.pi):.3g} Hz on the inertia that it meets; {remedy}"
    )


def history_bytes(task: Task, records: int) -> float:
    """What the histories of so many records hold: time, displacement and force of each law, and the channels."""
    local = task.local.local
    return 8.0 * records * (1 + 2 * local.m + local.watched_vectors.shape[1] + len(task.channels.names))


def _kept(task: Task, count: int, asked: float | None) -> int:
    """Of how many of the `count` records one is kept; all of those that were asked for.

    Raises:
        AnalysisError: those that were asked for need more memory than is free.
    """
    size = history_bytes(task, count)
    if asked is None:
        return max(1, math.ceil(size / MOST_HISTORY))
    free = free_memory()
    if free is not None and 2.0 * size > free:
        raise AnalysisError(
            f"the histories of {count:.3g} records take {2e-9 * size:.3g} GB while the result is made, and {1e-9 * free:.3g} GB "
            "are free: ask for fewer records in a period of the fastest mesh (records, --records), or for less time"
        )
    return 1


def check_method(method: str, rho_inf: float | None, beta: float | None, gamma: float | None) -> None:
    """Refuse, before anything is prepared, an unknown method and parameters that it does not have or bear.

    Raises:
        AnalysisError: with the method or the parameter.
    """
    if method not in METHODS:
        raise AnalysisError(f"method: got '{method}', expected one of {', '.join(METHODS)}")
    for name, value, least, most, methods in (
        ("rho_inf", rho_inf, 0.0, 1.0, ("hht", "generalised-alpha")),
        ("beta", beta, 0.0, 10.0, ("newmark",)),
        ("gamma", gamma, 0.5, 10.0, ("newmark",)),
    ):
        if value is not None and not least <= value <= most:
            raise AnalysisError(f"{name} must lie between {least:g} and {most:g}, got {value:g}")
        if value is not None and method not in methods:
            raise AnalysisError(f"{name} belongs to the method {' or '.join(methods)}; the method here is {method}")


def integrator_of(
    task: Task,
    grid: Grid,
    method: str,
    modes: int | None,
    rho_inf: float | None,
    beta: float | None,
    gamma: float | None,
) -> tuple[Integrator, str]:
    """Return the integrator and why it was chosen.

    Raises:
        AnalysisError: a method that this model can't take.
    """
    local = task.local.local
    modal_ratio = task.local.system.model.damping.modal_ratio
    if modes is not None:
        check_whole("the number of modes", modes)
        modes = None if modes >= local.n else modes
    reason = "as asked for"
    if method == "auto":
        method, reason = _chosen(local, grid.records * grid.every, modal_ratio, modes)
        if method == "exponential" and not (modal_ratio or modes):
            candidate = Exponential()
            try:
                # In steps so short that all contacts are among the modes: a step that is halved may come to that.
                candidate.prepare(local, _SHORT, float(local.rotation.speeds[0]))
                return candidate, reason
            except ConvergenceError as error:
                method = "newmark"
                reason = f"not exponential: {str(error).partition(';')[0]}"
    if modal_ratio and method != "exponential":
        raise AnalysisError(
            "damping.modal_ratio acts on modes: only the exponential method at constant speed can take it"
        )
    if method == "exponential":
        if local.changes is not None:
            raise AnalysisError("method exponential: it needs a constant speed; use newmark for a run-up")
        return Exponential(modes, modal_ratio), reason
    if method == "explicit":
        if local.sisters.planets.size:
            raise AnalysisError("method explicit: it does not take planets that go round; use newmark or exponential")
        from rotorgear.solvers.time.explicit import Explicit

        return Explicit(), reason
    if method == "hht":
        return Newmark.hht(0.05 if rho_inf is None else (1.0 - rho_inf) / (1.0 + rho_inf)), reason
    if method == "generalised-alpha":
        return Newmark.generalised_alpha(0.95 if rho_inf is None else rho_inf), reason
    g = 0.5 if gamma is None else gamma
    return Newmark(0.25 * (0.5 + g) ** 2 if beta is None else beta, g), reason


def _chosen(local: LocalSystem, steps: int, modal_ratio: float, modes: int | None) -> tuple[str, str]:
    """The cheaper method for the same error, from measured costs (docs/transient.md)."""
    gyroscopic = local.G is not None and local.G.nnz > 0
    if local.changes is not None or (gyroscopic and not local.rotation.is_constant):
        return "newmark", "the speed changes, and with it the gyroscopic terms"
    if np.any(local.M.diagonal() <= 0.0):
        if held_by_contacts(local):
            # Without inertia, Newmark's rule lets what meets and parts swing from step to step.
            return "generalised-alpha", "nothing but contacts holds a degree of freedom without inertia"
        return "newmark", "a degree of freedom has no inertia"
    if modal_ratio or modes is not None:
        return "exponential", "damping by modes" if modal_ratio else "a number of modes was asked for"
    if local.n > _ALL_MODES:
        return "newmark", f"{local.n} dofs are too many for all complex modes"
    newmark = steps * (3e-6 + 4e-8 * local.n)
    exponential = 2e-8 * local.n**3 + 0.6 * steps * (2e-6 + 2e-8 * local.n)
    if exponential < newmark:
        return "exponential", f"constant speed, {local.n} dofs, and enough steps to pay for the complex modes"
    return "newmark", f"too few steps ({steps}) to pay for the complex modes of {local.n} dofs"


@dataclass(frozen=True)
class Task:
    """A model made ready: local forces, channels, static state and forces, mesh frequencies in Hz, largest speed in rad/s.

    `start` is one of `STARTS`, and `begin` the displacements (n,) there.
    """

    local: LocalModel
    channels: Channels
    rest: Equilibrium
    rest_force: np.ndarray
    frequencies: dict[str, float]
    largest: float
    start: str
    begin: np.ndarray


def prepare(
    model: Model | System,
    speed: float | str | Sequence[tuple[float, float | str]] | None,
    elements: int | None,
    start: str = STARTS[0],
) -> Task:
    """Make a model ready.

    Raises:
        AnalysisError: nothing is free to move, the speed makes no sense, or no such start.
    """
    if start not in STARTS:
        raise AnalysisError(f"start: got '{start}', expected one of {', '.join(STARTS)}")
    given = model if isinstance(model, System) else flow_system(model, plan_in_time(elements))
    rotation = rotation_of(given, speed)
    largest = float(rotation.speeds[np.argmax(np.abs(rotation.speeds))])
    direction = -1 if largest < 0.0 else 1
    if direction != given.direction:
        given = given.with_state(given.model.torque_flow(direction))
    found = state_in_time(given.model, largest, direction)
    # Forces and flanks of a given torque flow are kept where the equilibrium has none of the teeth; what else a given state has
    # is linear about another equilibrium, and motions in time take the laws themselves.
    keep = given.state.is_flow and not found.faces
    given = given.with_state(replace(given.state, films=found.films) if keep else found)
    given.require_freedom()
    local = springs_about_mean(local_model(given, rotation, largest, along_faces=True), largest)
    rest = equilibrium(local.local)
    mean = equilibrium(replace(local.local, forces=local.local.forces.mean), rest.free)
    force = mean.force if mean.converged else np.full(local.local.m, np.nan)
    begin = {"equilibrium": rest.q, "mean": mean.q, "rest": np.zeros(local.local.n)}[start]
    seen = channels(local, largest)
    observed = seen.observed(local.local.n, local.local.m)
    rates = None
    if local.local.changes is not None:
        # What planets see of rates has the speed and its square: three speeds say it all.
        ahead = observed
        seen = channels(local, 0.0)
        observed = seen.observed(local.local.n, local.local.m)
        behind = channels(local, -largest).observed(local.local.n, local.local.m)
        none = observed.plus(-1.0, observed)
        by_square = none.plus(0.5, ahead).plus(0.5, behind).plus(-1.0, observed)
        rates = none.plus(0.5 / largest, ahead).plus(-0.5 / largest, behind), none.plus(1.0 / largest**2, by_square)
    seen_sisters = sisters_of(sister_places(given.layout, [*local.watched_names, *seen.names]))
    local = replace(local, local=replace(local.local, observed=observed, rates=rates, seen_sisters=seen_sisters))
    meshes = {name: given.layout.mesh_frequency(name, largest) for name in given.model.meshes}
    return Task(local, seen, rest, force, {name: f for name, f in meshes.items() if f}, largest, start, begin)


def motions_without_strain(local: LocalSystem, K: sp.csc_array) -> np.ndarray:
    """Motions R (n, r) that a stiffness leaves free, K R = 0.

    They don't depend on inertia: what has none gets what makes it no slower than the others.

    Raises:
        ConvergenceError: they are not told apart from the others.
    """
    mass = local.M.diagonal()
    stiffness = local.stiffness_about.diagonal()
    fastest = float(np.max(stiffness / np.where(mass > 0.0, mass, np.inf)))
    light = np.where(mass > 0.0, 0.0, stiffness / (fastest or 1.0))
    return free_motions(sp.csc_array(local.M + sp.diags_array(light)), K)


def damped(model: Model | System, modal_damping: float | None) -> Model | System:
    """The model with another damping ratio of its modes."""
    if modal_damping is None:
        return model
    check_modal_damping(modal_damping)
    given = model.model if isinstance(model, System) else model
    damping = given.damping.model_copy(update={"modal_ratio": modal_damping})
    changed = given.model_copy(update={"damping": damping})
    return flow_system(changed, model.plan).with_state(model.state) if isinstance(model, System) else changed


def coarser(grid: Grid) -> tuple[Grid, float]:
    """The grid of twice the step, or of three times where steps between records are three, and by how much its step is larger.

    Where every step is recorded, every second record is missing.
    """
    if grid.every == 1:
        return replace(grid, spacing=2.0 * grid.spacing, records=grid.records // 2, settled=grid.settled // 2), 2.0
    every = grid.every // 2
    return replace(grid, every=every), grid.every / every
