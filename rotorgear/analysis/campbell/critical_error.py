"""Discretisation error of critical speeds, from the error of the mode that the line meets.

At a critical speed Im s(W) = p W. A mesh that puts s off by e |s| at a held speed moves the crossing by

    dW / W = e / (1 - s' / p),     s' = Im ds/dW = - Im [ y^H (s D_1 + K_1) x / y^H (2 s M + D) x ] ,

with the left shape y, and D = D_0 + W D_1 and K = K_0 + W K_1 near that speed. A line that runs along its mode (s' = p) has a
critical speed that nothing holds, and an error without bound.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rotorgear.analysis.common.casings import reduction_errors
from rotorgear.analysis.modal.refine import errors_of, total_error
from rotorgear.solvers.eigen.synchronous import Affine, Synchronous
from rotorgear.system.bubble_errors import left_shapes
from rotorgear.system.system import System


def speed_error(system: System, ranges: Sequence[Affine], root: Synchronous, order: float, sense: float) -> float:
    """Estimated relative error of one critical speed; 0 where no shaft is cut into elements, infinite where they are too coarse.

    It is that of shaft elements and of the reduction of casings.

    Args:
        system: the discretised model.
        ranges: its matrices as functions of the size of the speed.
        root: the critical speed, its mode in the free dofs.
        order: of the line that meets it.
        sense: sign of the rotation.
    """
    speed = sense * root.speed
    s = np.array([root.eigenvalue])
    x = root.vector[:, None]
    error = float(total_error(errors_of(system, speed, s, x, np.array([False])), 1)[0])
    error += float(reduction_errors(system, s, x)[0])
    if not 0.0 < error < np.inf:
        return error
    here = min(ranges, key=lambda piece: max(piece.low - root.speed, root.speed - piece.high))
    D, _ = here.at(root.speed)
    y = left_shapes(system, speed, s, x)[:, 0].conj()
    K_slope = here.K1 if here.K2 is None else here.K1 + 2.0 * root.speed * here.K2
    turned = y @ (root.eigenvalue * (here.D1 @ root.vector) + K_slope @ root.vector)
    held = y @ (2.0 * root.eigenvalue * (here.M @ root.vector) + D @ root.vector)
    slope = -float(np.imag(turned / held))
    along = abs(1.0 - slope / order)
    return error / along if along else np.inf
