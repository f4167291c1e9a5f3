"""Mesh stiffness from finite elements and loaded tooth contact, as a stiffness model among the others."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.gears.loaded.mesh_cycle import MeshCycle, mesh_cycle
from rotorgear.gears.loaded.tooth_contact import ContactProblem, contact_problem
from rotorgear.gears.stiffness.mesh_stiffness import MeshStiffness, ToothPair
from rotorgear.progress import Progress, listener, part_of, silent

_kept_problem = lru_cache(maxsize=8)(contact_problem)


def loaded_cycle(
    teeth: ToothPair, load: float, positions: np.ndarray, progress: Progress = silent
) -> tuple[ContactProblem, MeshCycle]:
    """Loaded contact of one helix at positions u (p,) for F_bt = load (N); the compliance comes first."""
    # The compliance takes most of the time. It is computed here, with progress, and kept by its own key; the
    # second call only puts the problem together, and keeps it by the teeth alone (a listener is no key).
    contact_problem(teeth, part_of(progress, 0.0, 0.8))
    problem = _kept_problem(teeth)
    return problem, mesh_cycle(problem, load, positions, part_of(progress, 0.8, 1.0))


def tooth_fe_stiffness(teeth: ToothPair, load: float | None, positions: int) -> MeshStiffness:
    """Secant and tangent stiffness of one helix over one mesh period at F_bt = load (N)."""
    if not load:
        raise AnalysisError(
            "The stiffness of loaded teeth needs a load: give the torque or power that the mesh carries."
        )
    problem, cycle = loaded_cycle(teeth, load, np.arange(positions) / positions, listener())
    return MeshStiffness(
        model="tooth_fe",
        position=cycle.position,
        transverse=cycle.secant,
        definition="secant",
        helices=1,
        load=cycle.load,
        body=problem.body,
        base_helix_angle=problem.line.base_helix_angle,
        warnings=problem.warnings + cycle.warnings,
        tangent=cycle.tangent,
    )
