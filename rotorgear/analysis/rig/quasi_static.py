"""What a model without vibration would answer to measured loads: the yardstick of a comparison over time.

Everything moves as it would if its springs had no time to swing: rigid motions R follow the loads with their inertia and the
dampers that brake them, and all else is deflected statically by what the loads, inertia and dampers leave of each other,

    R' M R r'' + R' D R r' = R' f,    K q = f - M R r'' - D R r',    R' M q = 0.

A record that this explains as well says nothing of the modes of the model.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg
import scipy.sparse as sp
from numpy.typing import NDArray

from rotorgear.analysis.transient.request import Task, motions_without_strain
from rotorgear.solvers.sparse.factor import factor_general


def quasi_static(task: Task, columns: NDArray[np.intp], loads: NDArray[np.float64], step: float) -> NDArray[np.float64]:
    """Channels (p, t) of a prepared transient, less their values at the start.

    Args:
        task: the model made ready. columns: (k,) local displacements along which the loads act.
        loads: (k, t) in N and N m at times `step` apart, linear in between.
    """
    local = task.local.local
    B = local.B[:, columns].toarray()
    change = loads - loads[:, :1]
    R = motions_without_strain(local, local.stiffness_about)
    D = sp.csc_array(local.velocity_terms(float(local.rotation.speeds[0])) + local.damping_about - local.D)
    r, rate, acceleration = _rigid_motion(R.T @ (local.M @ R), R.T @ (D @ R), R.T @ B @ change, step)
    # What the springs give way to: loads, and dampers that rigid motions pull at.
    driven = np.vstack([change, rate])
    weighted = sp.csc_array(local.M @ R)
    bordered = (
        sp.block_array([[local.stiffness_about, weighted], [weighted.T, None]]) if R.shape[1] else local.stiffness_about
    )
    right = np.vstack([np.hstack([B, -(D @ R)]), np.zeros((R.shape[1], len(driven)))])
    bent = factor_general(sp.csc_array(bordered)).solve(right)[: local.n]
    found = np.zeros((len(task.channels.names), change.shape[1]))
    for kind, (which, Y) in task.channels.rows.items():
        if kind in "qF":
            rows = Y if kind == "q" else Y @ np.asarray(local.forces.reference_stiffness) @ local.B.T.toarray()
            found[which] += (rows @ bent) @ driven + (rows @ R) @ r
        else:
            found[which] += (Y @ R) @ (rate if kind == "v" else acceleration)
    return found


def _rigid_motion(
    mass: NDArray[np.float64], damping: NDArray[np.float64], force: NDArray[np.float64], step: float
) -> tuple[NDArray[np.float64], ...]:
    """Places, rates and accelerations (r, t) from rest, exactly for forces (r, t) that are linear between instants."""
    count, times = force.shape
    if not count:
        return (force,) * 3
    drag = np.linalg.solve(mass, damping)
    push = np.linalg.solve(mass, force)
    nothing = np.zeros((count, count))
    one = np.eye(count)
    # Of (r, r', push, growth of push): its exponential over a step.
    whole = np.block(
        [
            [nothing, one, nothing, nothing],
            [nothing, -drag, one, nothing],
            [nothing, nothing, nothing, one / step],
            [nothing, nothing, nothing, nothing],
        ]
    )
    over = scipy.linalg.expm(step * whole)[: 2 * count]
    state = np.zeros((2 * count, times))
    for k in range(times - 1):
        state[:, k + 1] = over @ np.concatenate([state[:, k], push[:, k], push[:, k + 1] - push[:, k]])
    rate = state[count:]
    return state[:count], rate, push - drag @ rate
