"""Time response of the turbo-alternator to an unbalance, step for step against ROSS (MultiRotor, Newmark's method)."""

from __future__ import annotations

import sys
import time

import numpy as np

import rotorgear as rg
from rotorgear.model.parts.load import Unbalance
from rotorgear.solvers.time.local_system import Rotation, state_at_rest
from rotorgear.solvers.time.newmark import Newmark
from rotorgear.system.local import local_model
from rotorgear.system.system import System
from validation.benchmarks.peers.comparison import ross
from validation.benchmarks.peers.ross_geared import FILE, REFINE, SPEED, ross_rotor

STEP = 2e-4
STEPS = 400
MORE = 20_000
UNBALANCE = 0.01
TARGET = 50.0
AGREEMENT = 2e-2


def theirs() -> tuple[np.ndarray, float, int]:
    """x of the coupling's disk over time, processor seconds a step, dofs."""
    rotor = ross_rotor()
    t = STEP * np.arange(STEPS + 1)
    force = np.zeros((t.size, rotor.ndof))
    node = 2 * REFINE
    force[:, 6 * node] = UNBALANCE * SPEED**2 * np.cos(SPEED * t)
    force[:, 6 * node + 1] = UNBALANCE * SPEED**2 * np.sin(SPEED * t)
    begin = time.process_time()
    found = rotor.run_time_response(SPEED, force, t, method="newmark")
    return found.yout[:, 6 * node], (time.process_time() - begin) / STEPS, rotor.ndof


def ours() -> tuple[np.ndarray, float, int]:
    """The same from rest, with the contact as a local force."""
    model = rg.load(FILE)
    place = model.disks["coupling"]
    unbalance = Unbalance(shaft=place.shaft, at=place.at, magnitude=UNBALANCE)
    system = System(model.model_copy(update={"unbalances": {"u": unbalance}}), elements=REFINE)
    local = local_model(system, Rotation.constant(SPEED), SPEED).local
    stepper = Newmark().prepare(local, STEP, SPEED)
    state = state_at_rest(local, STEP, np.zeros(local.n))
    row = system.dofs.transform[[6 * system.nodes.at(place.shaft, float(place.at))], :].toarray()
    x = stepper.advance(state.copy(), STEPS, 1).rows("q", row)[:, 0]
    begin = time.process_time()
    stepper.advance(state, MORE, 10)
    return np.concatenate([[0.0], x]), (time.process_time() - begin) / MORE, local.n


def main() -> int:
    """Run both, print difference and times; 0 if they agree and the ratio of times is met."""
    (x, slow, n), (y, fast, m) = theirs(), ours()
    difference = float(np.abs(x - y).max() / np.abs(y).max())
    print(
        f"ROSS {ross.__version__}: {n} dofs, {1e6 * slow:.1f} us a step; rotorgear: {m} dofs, {1e6 * fast:.2f} us a step"
    )
    print(
        f"ratio {slow / fast:.0f}, wanted {TARGET:.0f}; largest difference {difference:.1e} of the largest displacement"
    )
    return 0 if difference < AGREEMENT and slow / fast > TARGET else 1


if __name__ == "__main__":
    sys.exit(main())
