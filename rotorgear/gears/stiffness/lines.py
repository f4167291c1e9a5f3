"""Mesh stiffness in proportion to the length of the contact lines, with the mean of ISO 6336-1.

k(u) = c_gamma_alpha b L(u) / L_mean: the teeth are taken as equally stiff along the path of contact, so that the ripple is
that of the length alone. A value per position is the mean over its interval of the period, so that jumps of spur gears
(a pair that enters) do not depend on where the positions happen to fall.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rotorgear.gears.stiffness.contact_lines import contact_line_length
from rotorgear.gears.stiffness.iso import iso_stiffness
from rotorgear.gears.stiffness.mesh_stiffness import MeshStiffness, ToothPair

# Positions within an interval of the period over which the length is averaged.
_FINER = 32


def contact_line_stiffness(teeth: ToothPair, load: float | None, positions: int) -> MeshStiffness:
    """The mean of ISO 6336-1, spread over the period as the contact lines are."""
    mean = iso_stiffness(teeth, load, positions)
    inside = (np.arange(_FINER) + 0.5) / _FINER - 0.5
    u = (mean.position[:, None] + inside / positions).ravel()
    length = contact_line_length(teeth, u).reshape(positions, _FINER).mean(axis=1)
    # Over the mean of the sampled length, not eps_alpha b / cos b_b: the mean stiffness is then that of ISO to the last digit.
    return replace(mean, model="contact_line", transverse=mean.transverse * length / length.mean())
