"""Stability of a gearbox on its bearings over speed: the least logarithmic decrement, and where it falls through zero."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq

from rotorgear.analysis.campbell.discretise import system_for_speeds
from rotorgear.analysis.modal.modal import modal
from rotorgear.analysis.static.solve import LawState
from rotorgear.analysis.static.state_at import state_at
from rotorgear.model.model import Model

_MODES = 24
# Smaller damping ratios are rounding of a mode that nothing damps.
_UNDAMPED = 1e-9
# The threshold is found to this share of its speed.
_THRESHOLD = 1e-5


class Decrements:
    """Least logarithmic decrements of a model at speeds in a range.

    The mesh is one that serves the modes at both ends of the range, and is found once.

    Args:
        model: a checked model. speeds: of the reference shaft in rad/s, not empty.
    """

    def __init__(self, model: Model, speeds: Sequence[float]) -> None:
        self._model = model
        ends = (min(speeds, key=abs), max(speeds, key=abs))
        self._system = system_for_speeds(model, ends, modes=_MODES, fmax=None, elements=None, accuracy=None)

    def at(self, speed: float, near: Sequence[LawState] = ()) -> tuple[float | None, float]:
        """Smallest decrement of what oscillates and is damped, None where nothing is, and its frequency in Hz.

        Args:
            speed: of the reference shaft in rad/s. near: the laws in a known equilibrium at that speed or near by.
        """
        state_at(self._model, [speed], near=near)  # which the modes find there
        modes = modal(self._system, speed=speed, modes=_MODES, error_estimate=False)
        s = modes.eigenvalues
        s = s[(s.imag > 0.0) & ~modes.rigid & (np.abs(s.real) > _UNDAMPED * np.abs(s))]
        if not s.size:
            return None, 0.0
        least = s[np.argmax(s.real / s.imag)]
        return float(-2.0 * np.pi * least.real / least.imag), float(least.imag / (2.0 * np.pi))

    def threshold(
        self, speeds: Sequence[float], decrements: Sequence[float | None], near: Sequence[Sequence[LawState]]
    ) -> tuple[float, float] | None:
        """Speed in rad/s and frequency in Hz where the least decrement falls through zero first, at its own equilibria.

        Args:
            speeds: rising in size. decrements: at these. near: the laws in equilibrium at these.
        """
        rows = list(zip(speeds, decrements, near, strict=True))
        for (low, begin, _), (high, end, laws) in pairwise(rows):
            if begin is None or end is None or not begin > 0.0 >= end:
                continue

            def decrement(speed: float, laws: Sequence[LawState] = laws) -> float:
                return self.at(speed, laws)[0] or 0.0

            speed = float(brentq(decrement, low, high, xtol=_THRESHOLD * abs(high)))
            return speed, self.at(speed, laws)[1]
        return None
