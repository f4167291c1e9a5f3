"""Mean contact forces against statics: over a settled time, forces balance the loads on every free motion of what they join.

With R the motions that neither springs nor bearings hold (K R = 0, contacts left out), M-orthonormal, the equations of motion
give in the mean over a time T

    R^T B mean(F) = R^T f - R^T M [q'(T) - q'(0)]/T

and the last term goes to zero as the run settles or T grows. So the part of the mean forces that R sees is that of statics.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from rotorgear.analysis.transient.histories import Histories
from rotorgear.analysis.transient.notes import adrift
from rotorgear.analysis.transient.task import Task
from rotorgear.errors import RotorgearError
from rotorgear.solvers.time.contact_equilibrium import free_motions
from rotorgear.solvers.time.statistics import Statistics

# Share of the static force that a mean may be off beside its error: what is left of a start, and incomplete periods.
_SHARE = 0.01
_SEEN = 1e-9
_ROUNDING = 1e-6


def off_statics(found: Histories, task: Task, error: np.ndarray) -> tuple[str, ...]:
    """Sentences on contacts whose mean force differs from statics by more than its error (c,)."""
    local = task.local.local
    force = Statistics.of_steps(found.state.gathered).chosen(slice(0, local.m))
    meshes = [i for i, part in enumerate(task.local.parts) if part.is_mesh]
    known = np.all(np.isfinite(task.rest_force)) and task.rest.converged
    steady = local.rotation.is_constant and not adrift(task.rest, task.local)
    if not (np.all(np.isfinite(force.mean)) and meshes and known and steady):
        return ()
    # Motions without strain don't depend on inertia: what has none gets what makes it no slower than the others.
    mass = local.M.diagonal()
    stiffness = local.stiffness_about.diagonal()
    fastest = float(np.max(stiffness / np.where(mass > 0.0, mass, np.inf)))
    light = np.where(mass > 0.0, 0.0, stiffness / (fastest or 1.0))
    try:
        A = free_motions(sp.csc_array(local.M + sp.diags_array(light)), local.K).T @ local.B.toarray()
    except RotorgearError as refusal:
        return (f"mean contact forces are not compared with statics: {refusal}",)
    _, size, V = np.linalg.svd(A, full_matrices=False)
    seen = V[size > _SEEN * size.max(initial=0.0)]
    off = seen.T @ (seen @ (force.mean - task.rest_force))
    # Of flanks that carry nothing, statics leave the rounding of what the others carry.
    rounding = _ROUNDING * float(np.abs(task.rest_force).max(initial=0.0))
    notes = []
    for k, i in enumerate(meshes):
        j = int(local.forces.first[i])
        scale = float(np.hypot(force.mean[j], force.rms[j]))
        allowed = max(_SHARE * max(abs(task.rest_force[j]), scale), float(np.nan_to_num(error[k])), rounding)
        if abs(off[j]) > allowed:
            notes.append(
                f"{task.local.parts[i].label}: the mean contact force is {force.mean[j]:.4g} N, the loads need "
                f"{force.mean[j] - off[j]:.4g} N by statics: not settled, no whole number of periods, or too large a step"
            )
    return tuple(notes)
