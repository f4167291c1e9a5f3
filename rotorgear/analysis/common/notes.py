"""Warnings about a set of modes."""

from __future__ import annotations

import numpy as np

from rotorgear.analysis.common.mesh_notes import mesh_stiffness_warnings
from rotorgear.analysis.common.rings import ring_warnings
from rotorgear.system.system import System


def mode_warnings(system: System, asked: int | None, values: np.ndarray, fmax: float | None = None) -> tuple[str, ...]:
    """Say what is odd about a set of modes: merged nodes, fewer modes than asked for, unstable ones."""
    notes = [*system.nodes.merged, *mesh_stiffness_warnings(system), *ring_warnings(system, values)]
    if not len(values) and fmax is not None:
        notes.append(f"no mode lies at or below {fmax:g} Hz")
    elif asked is not None and fmax is None and len(values) < asked:
        notes.append(f"asked for {asked} modes, but this model has only {len(values)} with inertia; all are listed")
    unstable = int(np.sum(values.real > 1e-9 * np.abs(values)))
    if unstable:
        notes.append(f"{unstable} unstable mode{'s' if unstable > 1 else ''}: negative damping ratio, the motion grows")
    gathers = gathering(system)
    if gathers is not None and np.any((values.imag == 0.0) & (np.abs(values) >= gathers)):
        notes.append(
            f"damping in proportion to the stiffness gathers overdamped modes without end at {gathers / (2.0 * np.pi):.4g} Hz: "
            "those from there on are not all that there are"
        )
    return tuple(notes)


def gathering(system: System) -> float | None:
    """Lowest |s| in rad/s, 1/b, at which overdamped modes gather where damping b K goes with the stiffness; None without."""
    given = [shaft.internal_damping for shaft in system.model.shafts.values()]
    b = system.model.damping.rayleigh_beta + max(given, default=0.0)
    return 1.0 / b if b > 0.0 else None
