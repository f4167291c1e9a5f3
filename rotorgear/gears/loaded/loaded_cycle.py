"""Loaded contact of one helix over positions of its cycle, from the teeth themselves."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from rotorgear.gears.loaded.mesh_cycle import MeshCycle, mesh_cycle
from rotorgear.gears.loaded.tooth_contact import ContactProblem, contact_problem
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.progress import Progress, part_of, silent

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
