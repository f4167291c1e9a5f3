"""Frequencies at which a reduced system of a sweep is compared with the whole one.

    harmonics of all that repeats, as far as its law says that they matter and up to the 10th, at up to 16 of the speeds
    an even grid up to the highest of these at the highest speed
    natural frequencies in that range

Compared a little off the axis, s = w (i + 0.005), as with a damping ratio of 0.005 more: models without damping have finite peaks
then, and the frequencies need not hit them.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rotorgear.analysis.common.excitation import rates
from rotorgear.solvers.frequency.contact_basis import Probes
from rotorgear.solvers.time.local_forces import LocalLaw

_ASIDE = 0.005
_SPEEDS = 16
_GRID = 48
_NATURAL = 96


def probes_for(laws: Sequence[LocalLaw], speeds: Sequence[float], natural: np.ndarray, damping: float = 0.0) -> Probes:
    """Return where receptances are compared.

    Args:
        laws: what acts. speeds: of the reference in rad/s. natural: (p,) rad/s. damping: ratio of all modes that D does not hold.
    """
    several = np.unique(speeds)
    several = several[np.unique(np.linspace(0, len(several) - 1, _SPEEDS).round().astype(int))]
    fastest = float(several[np.argmax(np.abs(several))])
    pairs = [(float(speed), w) for speed in several for w in rates(laws, float(speed))]
    top = rates(laws, fastest).max()
    inside = natural[(natural > 0.0) & (natural <= top)]
    inside = inside[np.unique(np.linspace(0, len(inside) - 1, min(_NATURAL, len(inside))).round().astype(int))]
    pairs += [(fastest, float(w)) for w in (*np.linspace(top / _GRID, top, _GRID), *inside)]
    speed, w = np.array(pairs).T
    return Probes(speed, w * (1j + _ASIDE + damping))
