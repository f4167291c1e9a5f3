"""Contact lines of a pair over one mesh period, their length, and a mesh stiffness in proportion to it.

In the plane of action pair j touches along xi = (u + j) p_bt + z tan b_b, |z| <= b/2, between start and end of contact. The
mean of their length over a period is eps_alpha b / cos b_b. Lengths in m.

The stiffness has the mean of ISO 6336-1 and the ripple of that length: k(u) = c_gamma_alpha b L(u) / L_mean: the teeth are
taken as equally stiff along the path of contact, so that the ripple is that of the length alone. A value per position is the
mean over its interval of the period, so that jumps of spur gears (a pair that enters) do not depend on where the positions
happen to fall.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

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


def contact_lines(teeth: ToothPair, positions: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Pairs in contact and their ends along the face.

    Args:
        teeth: the pair.
        positions: u, shape (n,).

    Returns:
        xi (n, j) of each pair at z = 0, and the z of both ends of its line (n, j); equal where the pair does not touch.
    """
    pair = teeth.pair
    half = 0.5 * teeth.width
    slope = math.tan(pair.base_helix_angle)
    reach = half * slope
    # All pairs that touch somewhere on the face at some position 0 <= u < 1, and one more at either end.
    first = math.floor((pair.start_of_contact - reach) / teeth.first.transverse_base_pitch) - 1
    last = math.ceil((pair.end_of_contact + reach) / teeth.first.transverse_base_pitch) + 1
    xi = (np.asarray(positions, float)[:, None] + np.arange(first, last + 1)) * teeth.first.transverse_base_pitch
    # Lines of spur teeth touch over the whole face or not at all: xi / slope has no value.
    if slope == 0.0:
        inside = (xi >= pair.start_of_contact) & (xi <= pair.end_of_contact)
        return xi, np.where(inside, -half, 0.0), np.where(inside, half, 0.0)
    low = np.clip((pair.start_of_contact - xi) / slope, -half, half)
    return xi, low, np.maximum(np.clip((pair.end_of_contact - xi) / slope, -half, half), low)


def contact_line_length(teeth: ToothPair, positions: np.ndarray) -> np.ndarray:
    """Length of all contact lines of one helix at positions u (n,), shape (n,)."""
    _, low, high = contact_lines(teeth, positions)
    return np.asarray(np.sum(high - low, axis=1) / math.cos(teeth.pair.base_helix_angle))


def mean_contact_line_length(teeth: ToothPair) -> float:
    """Mean over a mesh period: eps_alpha b / cos b_b."""
    return teeth.pair.transverse_contact_ratio * teeth.width / math.cos(teeth.pair.base_helix_angle)
