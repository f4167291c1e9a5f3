"""Frequencies at which a reduced system of a sweep is compared with the whole one.

    harmonics of every mesh up to the highest tabulated, and at least 3 where teeth part, at up to 16 of the speeds
    an even grid up to the highest of these at the highest speed
    natural frequencies in that range

Compared a little off the axis, s = w (i + 0.005), as with a damping ratio of 0.005 more: models without damping have finite peaks
then, and the frequencies need not hit them.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rotorgear.solvers.frequency.receptance import Probes
from rotorgear.solvers.time.local_forces import LocalLaw

HIGHEST = 10
_ASIDE = 0.005
_PARTING = 3
# Coefficients of a tabulated stiffness below this share of the largest do not count.
_SMALL = 0.02
_SPEEDS = 16
_GRID = 48
_NATURAL = 96


def harmonics(law: LocalLaw) -> int:
    """How many harmonics of its order a law has, 1 to 10; at least 3 for teeth that part."""
    from rotorgear.forces.mesh_contact import MeshContact

    if not isinstance(law, MeshContact):
        return 1
    found = [1, len(law.stiffness_cos), len(law.error_cos), 1 if law.gap == "bilateral" else _PARTING]
    if law.pieces:
        sizes = np.abs(np.fft.rfft([share for _, share, _ in law.pieces]))[1 : HIGHEST + 1]
        found.append(1 + int(np.flatnonzero(sizes >= _SMALL * sizes.max(initial=0.0)).max(initial=0)))
    if law.impact:
        found.append(int(np.ceil(1.0 / law.impact_share)))
    return min(max(found), HIGHEST)


def rates(laws: Sequence[LocalLaw], speed: float) -> np.ndarray:
    """Rad/s of all harmonics of all laws at a speed of the reference, each once."""
    found = [abs(getattr(law, "order", 0.0) * speed) * h for law in laws for h in range(1, harmonics(law) + 1)]
    return np.unique(np.round([w for w in found if w > 0.0], 6))


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
