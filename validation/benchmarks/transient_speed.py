"""Speed of the transient's methods against a textbook Newmark loop that factors its matrix in every iteration.

    python -m validation.benchmarks.transient_speed

The split-torque gearbox with about 600 dofs and 8 contact lines that part: k(t) +-25 %, e 4 um, a fifth of the torque,
200 steps in a period of the fastest mesh. Prints, in CPU seconds of one thread, steps in a second of each, their ratios, the
difference of the contact forces, and the share of the in-cache matrix-vector bandwidth that the exponential method reaches.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

import rotorgear as rg
from rotorgear.model.parts.mesh import ErrorHarmonic, StiffnessHarmonic
from rotorgear.solvers.time.contact_equilibrium import equilibrium
from rotorgear.solvers.time.exponential import Exponential
from rotorgear.solvers.time.local_system import (
    LocalSystem,
    MotionState,
    Rotation,
    evaluated,
    local_values,
    state_at_rest,
)
from rotorgear.solvers.time.newmark import Newmark
from rotorgear.system.local import local_model
from rotorgear.system.plan import Plan
from rotorgear.system.system import System

MODEL = Path(__file__).resolve().parents[2] / "models" / "split_torque.toml"
STEPS = 20_000
NAIVE_STEPS = 300
PER_PERIOD = 200


def parting_gearbox(elements: int = 5, share: float = 0.2) -> LocalSystem:
    """The split-torque gearbox with contacts that part: less torque, more excitation, some damping."""
    model = rg.load(MODEL)
    operation = model.operation.model_copy(update={"power": share * (model.operation.power or 0.0)})
    meshes = {
        name: mesh.model_copy(
            update={
                "transmission_error": (ErrorHarmonic(harmonic=1, amplitude=4e-6),),
                "damping_ratio": 0.04,
                "backlash": 1e-4,
                "stiffness_variation": (StiffnessHarmonic(harmonic=1, amplitude=0.25),),
            }
        )
        for name, mesh in model.meshes.items()
    }
    damping = model.damping.model_copy(update={"rayleigh_beta": 2e-6})
    given = model.model_copy(update={"operation": operation, "meshes": meshes, "damping": damping, "unbalances": {}})
    speed = float(model.operation.speed or 0.0)
    return local_model(System(given, plan=Plan(elements)), Rotation.constant(speed), speed).local


def step_of(system: LocalSystem) -> float:
    """A 200th of a period of the fastest mesh in s."""
    order = max(law.order for law in system.forces.laws)  # type: ignore[attr-defined]
    return 2.0 * np.pi / (order * float(system.rotation.speeds[0])) / PER_PERIOD


def refactoring(system: LocalSystem, h: float, start: MotionState, steps: int) -> np.ndarray:
    """Textbook Newmark: assemble and factor K + 2/h C + 4/h^2 M in each Newton iteration; contact forces (steps, m)."""
    D = system.velocity_terms(float(system.rotation.speeds[0]))
    q = start.q.copy()
    v = start.v.copy()
    a = start.a.copy()
    B = system.B
    found = np.zeros((steps, system.m))
    for number in range(steps):
        t = (number + 1) * h
        new = q + h * v
        for _ in range(20):
            acceleration = 4.0 / h**2 * (new - q - h * v) - a
            velocity = v + 0.5 * h * (a + acceleration)
            F, Kd, Kv, _ = evaluated(system, B.T @ new, B.T @ velocity, t)
            rest = system.load - system.M @ acceleration - D @ velocity - system.K @ new - B @ F
            tangent = sp.diags_array(Kd) + 2.0 / h * sp.diags_array(Kv)
            S = sp.csc_array(system.K + 2.0 / h * D + 4.0 / h**2 * system.M + B @ tangent @ B.T)
            change = splu(S).solve(rest)
            new = new + change
            if np.abs(change).max() <= 1e-10 * np.abs(new).max():
                break
        acceleration = 4.0 / h**2 * (new - q - h * v) - a
        q = new
        v = v + 0.5 * h * (a + acceleration)
        a = acceleration
        found[number] = local_values(system, q, v, t)[0]
    return found


@dataclass(frozen=True)
class Timed:
    """Contact forces (r, m), and CPU seconds a step, of preparing and of the loop."""

    F: np.ndarray
    preparing: float
    seconds: float


def timed(system: LocalSystem, method: Any, h: float, start: MotionState, steps: int, every: int = 1) -> Timed:
    """Run a method once for its compilation and once for the clock; the loop is timed, not the records of fields."""
    before = time.process_time()
    stepper = method.prepare(system, h, float(system.rotation.speeds[0]), 1e-10)
    preparing = time.process_time() - before
    state = start.copy()
    stepper.start(state)
    stepper.advance(state.copy(), every, every)
    before = time.process_time()
    records = stepper.advance(state, steps, every)
    return Timed(records.F, preparing, time.process_time() - before)


def cache_bandwidth(n: int = 240) -> float:
    """Bytes a second of a matrix-vector product whose matrix stays in the second-level cache."""
    A = np.random.default_rng(1).standard_normal((n, n))
    x = np.ones(n)
    best = np.inf
    for _ in range(5):
        before = time.process_time()
        for _ in range(2000):
            A @ x
        best = min(best, time.process_time() - before)
    return 2000 * 8.0 * n * n / best


def main() -> None:
    """Print the table."""
    from rotorgear.solvers.sparse.factor import single_thread

    with single_thread(0):
        system = parting_gearbox()
        h = step_of(system)
        start = state_at_rest(system, h, equilibrium(system).q)
        newmark = timed(system, Newmark(), h, start, STEPS, 10)
        exponential = timed(system, Exponential(), h, start, STEPS, 10)
        before = time.process_time()
        naive = refactoring(system, h, start, NAIVE_STEPS)
        naive_rate = NAIVE_STEPS / (time.process_time() - before)
        bandwidth = cache_bandwidth()
    rates = {
        "refactoring Newmark": naive_rate,
        "condensed Newmark": STEPS / newmark.seconds,
        "exponential": STEPS / exponential.seconds,
    }
    short = timed(system, Newmark(), h, start, NAIVE_STEPS).F
    print(f"{system.n} dofs, {system.m} contact lines, {len(naive)} and {STEPS} steps of {h:.3g} s")
    for name, rate in rates.items():
        print(f"{name:20s} {rate:10.0f} steps in 1 s   {rate / naive_rate:6.0f} x refactoring")
    difference = np.abs(short - naive).max() / np.abs(naive).max()
    print(f"condensed and refactoring Newmark differ by {difference:.1e} of the largest force")
    nz = system.n
    m = system.m
    # e, g and y once, G and both rows of C (displacements and velocities) for each contact line.
    moved = 8.0 * nz * (6 * m + 6) * rates["exponential"]
    share = f"{moved / bandwidth:.2f} of the in-cache bandwidth of {bandwidth / 1e9:.1f} GB/s"
    print(f"exponential moves {moved / 1e9:.1f} GB/s, {share}")
    print(f"complex modes: {exponential.preparing:.2f} s once")


__all__ = ["main", "parting_gearbox", "refactoring", "step_of", "timed"]

if __name__ == "__main__":
    main()
