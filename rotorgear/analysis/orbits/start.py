"""Where a branch begins: Newton's method from the static state, or from the end of a transient."""

from __future__ import annotations

import numpy as np

from rotorgear.analysis.orbits.family import SystemFamily
from rotorgear.analysis.orbits.follow import AnyOrbits
from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.progress import Progress
from rotorgear.solvers.periodic.arclength import Node, at_value
from rotorgear.solvers.periodic.harmonic_orbits import HarmonicOrbits
from rotorgear.solvers.time.contact_equilibrium import equilibrium
from rotorgear.solvers.time.exponential import Exponential
from rotorgear.solvers.time.local_system import Integrator, LocalSystem, Records, State, state_at_rest
from rotorgear.solvers.time.newmark import Newmark
from rotorgear.solvers.time.run import Schedule, run

# Shares of the range at which a branch may begin.
_PLACES = (0.0, 1.0, 0.5, 0.75, 0.25)
# Base periods of the transient that a branch may begin from, and its steps in each.
_SETTLE = 400
_STEPS = 400
_MOST_DENSE = 400


def integrator_for(system: LocalSystem) -> Integrator:
    """The exponential method where all modes are cheap."""
    return Exponential() if system.n <= _MOST_DENSE and np.all(system.M.diagonal() > 0.0) else Newmark()


def run_periods(
    system: LocalSystem, order: float, periods: int, q: np.ndarray, v: np.ndarray, steps: int = _STEPS
) -> tuple[State, np.ndarray]:
    """Run over base periods from a motion: the state at the end, and local displacements at all steps (r, m)."""
    T = 2.0 * np.pi / (order * abs(float(system.rotation.speeds[0])))
    h = T / steps
    state = state_at_rest(system, h, q, v)
    found: list[np.ndarray] = []

    def keep(records: Records, _: State) -> None:
        found.append(records.d)

    run(system, integrator_for(system), Schedule(h, periods * steps, 1), state, keep)
    return state, np.concatenate(found)


def first_node(orbits: AnyOrbits, family: SystemFamily, *, from_transient: bool, progress: Progress) -> Node:
    """A solution at the begin of the range, or else at another value, by Newton's method or a transient.

    Raises:
        AnalysisError: no way leads to a periodic motion.
    """
    ways = [(p, False) for p in _PLACES if not from_transient] + [(p, True) for p in _PLACES]
    why = ""
    for p, settling in ways:
        try:
            y = settled(orbits, family, p, progress) if settling else orbits.start(p)
            return at_value(orbits, y, p, -1.0 if p == 1.0 else 1.0)
        except ConvergenceError as error:
            why = str(error)
    raise AnalysisError(
        f"no periodic motion was found in the range ({why}): neither from the static state nor by transients of {_SETTLE} "
        "periods; try another range"
    )


def settled(orbits: AnyOrbits, family: SystemFamily, p: float, progress: Progress) -> np.ndarray:
    """Unknowns of the motion at the end of a transient from rest."""
    progress(0.02, "settling by a transient")
    shares = family.shares_at(p)
    system = family.system(shares)
    state, d = run_periods(system, family.order, _SETTLE, equilibrium(system).q, np.zeros(system.n))
    if isinstance(orbits, HarmonicOrbits):
        # The records begin one step behind the begin of a period.
        return orbits.from_samples(np.roll(d[-_STEPS:], 1, axis=0))
    return orbits.from_motion(state.q, state.v, family.plant(*shares))
