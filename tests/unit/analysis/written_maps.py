"""Contact maps that are written down, in place of those of loaded teeth."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from rotorgear.gears.maps.contact_map import ContactMap
from rotorgear.model.layout.mesh_layout import MeshLayout

LOADS = (0.0, 0.02, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 0.9, 1.0, 1.1, 1.2, 1.5, 2.0, 3.0)
Approach = Callable[[np.ndarray, np.ndarray], np.ndarray]  # delta(F, u)


def written(approach: Approach, periods: int = 1) -> Callable[..., ContactMap | None]:
    """Stands in for MeshLayout.contact_map: every helix has the map delta(F, u)."""

    def contact_map(mesh: MeshLayout, helix: int, normal_force: float, *_: object, **__: object) -> ContactMap | None:
        if not normal_force:
            return None
        u = np.arange(128 * periods) / 128
        F = normal_force * np.array(LOADS)
        return ContactMap(u, periods, F, approach(F[None, :], u[:, None]))

    return contact_map


def ripple(stiffness: float, a: float) -> Approach:
    """F = k (1 + a cos 2 pi u) delta."""
    return lambda F, u: F / (stiffness * (1.0 + a * np.cos(2.0 * np.pi * u)))
