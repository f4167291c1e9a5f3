"""An elastic gear body that turns: six dofs of its node, then its elastic coordinates p, in axes that stand still.

    M q'' + (C + W G) q' + (K + W^2 S + W C L) q = f,      K = diag(w^2),  C = diag(2 zeta w) on p

The material damps in proportion to the rate p' + W L p that an observer on the body sees (L: `casings/wheel_reduction.py`). Its
rigid motions, those of the node, have neither stiffness nor damping.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rotorgear.elements.matrices import ElementMatrices

if TYPE_CHECKING:
    from rotorgear.casings.wheel import ReducedWheel


def gear_body(wheel: ReducedWheel) -> ElementMatrices:
    """Matrices of one body; gyroscopic, circulatory and centrifugal ones for unit spin."""
    elastic = np.hstack([np.zeros((wheel.size, 6)), np.eye(wheel.size)])
    viscosity = np.diag(2.0 * wheel.damping_ratio * np.sqrt(wheel.stiffness))
    damped = wheel.damping_ratio > 0.0
    return ElementMatrices(
        strain=elastic[None],
        modulus=np.diag(wheel.stiffness)[None],
        mass=wheel.mass[None],
        viscosity=viscosity[None] if damped else None,
        gyroscopic=wheel.gyroscopic[None],
        circulation_per_speed=(viscosity @ wheel.turning)[None] if damped else None,
        modulus_per_square=wheel.spin_stiffness[None],
    )
