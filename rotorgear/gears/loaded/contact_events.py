"""Where tooth pairs come into contact and leave it, found by the contact itself.

Between a position where pair k carries nothing and one where it does, the least of the openings of its slices under load,

    s_k(u) = min (C F + gap - delta)_j,     for slices that carry: -C_jj F_j, the overlap that their own force takes away,

crosses zero (`MeshCycle.opening`). On the open side it is smooth, so that chords find the crossing within a few solutions. What
the geometry of a spur pair knows beforehand are the ends A and E of the line of action, which with the base pitch are those of
single contact too (B, D), and where linear reliefs begin.
"""

from __future__ import annotations

import numpy as np

from rotorgear.gears.loaded.mesh_cycle import MeshCycle
from rotorgear.gears.loaded.tooth_contact import line_of_action
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair

# A chord's zero keeps this share of the bracket away from its ends, until the bracket is short.
_INSIDE = 1e-3
# A position nearer to one end of a bracket than this share of its length shows that chords come from that side.
_NEAR = 0.3
# Brackets shorter than this, in base pitches, are not looked into any more.
_FOUND = 1e-5
# Positions to either side of a step, in base pitches.
_BESIDE = 4e-6


def contact_events(cycle: MeshCycle, period: float) -> tuple[np.ndarray, np.ndarray]:
    """Guesses (k,) of where pairs come and go, and the solved position (k,) next to each.

    Args:
        cycle: at rising positions within one cycle.
        period: its length in base pitches, after which pair k stands where pair k + period stood.
    """
    n = len(cycle.position)
    u = cycle.position
    # Beyond both ends the cycle goes on, with other pairs in these ones' places.
    around = np.concatenate([u[-2:] - period, u, u[:2] + period])
    pair = cycle.slices.pair
    nearest_pair = int(pair.min())
    least = np.full((int(pair.max()) - nearest_pair + 1, n), np.inf)
    np.minimum.at(least, (pair - nearest_pair, cycle.slices.position), cycle.opening)
    nowhere = np.full(n, np.inf)
    turn = round(period)

    def of_pair(k: int) -> np.ndarray:
        """Infinite where the pair is too far away to have slices."""
        return np.asarray(least[k - nearest_pair]) if 0 <= k - nearest_pair < len(least) else nowhere

    guesses = []
    nearest = []
    for k in range(nearest_pair - turn, nearest_pair + len(least) + turn):
        s = np.concatenate([of_pair(k - turn)[-2:], of_pair(k), of_pair(k + turn)[:2]])
        for i in np.flatnonzero((s[1:-2] < 0.0) != (s[2:-1] < 0.0)) + 1:
            share = _crossing(around[i - 1 : i + 3], s[i - 1 : i + 3])
            if around[i + 1] - around[i] > _FOUND:
                guesses.append(around[i] + share * (around[i + 1] - around[i]))
            nearest.append(around[i] if share < 0.5 else around[i + 1])
    return np.mod(guesses, period), np.mod(nearest, period)


def _crossing(u: np.ndarray, s: np.ndarray) -> float:
    """Share of the way from the second to the third of four positions where s crosses zero."""
    opened_first = s[1] > 0.0
    u = u if opened_first else -u[::-1]
    before, low, high, _ = s if opened_first else s[::-1]
    width = u[2] - u[1]
    share = 0.5
    if np.isfinite(low) and np.isfinite(high):
        share = low / (low - high)
    if np.isfinite(low) and np.isfinite(before) and before > low:
        # The open side is smooth: its own chord goes on to the crossing.
        ahead = low / (before - low) * (u[1] - u[0]) / width
        share = ahead if ahead < 1.0 else share
    # Chords that come from one side only are made to overshoot: then the crossing is between two near positions.
    beside = (u[1] - u[0] < _NEAR * width, u[3] - u[2] < _NEAR * width)
    if beside == (True, False):
        share = min(2.0 * share, 0.5)
    elif beside == (False, True):
        share = max(2.0 * share - 1.0, 0.5)
    share = float(np.clip(share, _INSIDE, 1.0 - _INSIDE))
    return share if opened_first else 1.0 - share


def known_events(teeth: ToothPair, shift: float = 0.0) -> np.ndarray:
    """Positions in the first base pitch where a curve of a spur pair has a kink by its geometry alone; helical teeth have none.

    shift: position of the helix when the cycle begins.
    """
    line = line_of_action(teeth)
    if line.base_helix_angle:
        return np.empty(0)
    ends = [line.start, line.end]
    for gear, flank in enumerate((teeth.first_flank, teeth.second_flank)):
        begin = []
        if flank.tip_relief:
            begin.append(line.tip[gear] - flank.tip_relief_length)
        if flank.root_relief:
            begin.append(line.form[gear] + flank.root_relief_length)
        # Roll lengths of the pinion at these places.
        ends += [roll if gear == 0 else line.length - roll for roll in begin]
    u = (np.array(ends) - line.pitch_point) / line.base_pitch - shift
    if line.interference:
        # Where a tip reaches below the involute of its mate contact ends at once: the curves have a step between two positions.
        u = np.concatenate([u - _BESIDE, u + _BESIDE])
    return np.unique(np.mod(u, 1.0))
