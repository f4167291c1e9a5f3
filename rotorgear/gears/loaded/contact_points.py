"""Contact lines of a pair over the mesh cycle, cut into slices, and what each slice loads on both gears.

Pair k at position u touches at the pinion's roll length xi_1 = xi_C + (u + k) p_bt + z tan b_b. Each line is cut exactly where
contact begins and ends, at the face's ends, and into slices; beyond the ends of the line of action a tip corner touches. Lines
of all lengths have the same number of slices, so that they change smoothly with u, and slices are finer towards the ends of a
line, where its load falls or rises most.
A slice presses on a patch of half-width c with semi-elliptic pressure (Gauss-Chebyshev quadrature of the second kind across,
Gauss-Legendre along the slice), spread over the flank's nodes by the quadratic shape functions.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise

import numpy as np

from rotorgear.gears.geometry.line_of_action import LineOfAction
from rotorgear.gears.tooth_fe.elasticity import quadratic
from rotorgear.gears.tooth_fe.gear_compliance import GearCompliance

# Quadrature points of a patch across and along a slice.
_ACROSS = 24
_ALONG = 3
# Pieces of a contact line shorter than this share of a slice are dropped, for they carry nothing. At the end of a misaligned face
# pieces of 0.03 carry 80 N, and where they were dropped the approach jumped by 0.02 um.
_SLIVER = 0.001
# How much finer they are there: 0 for equal slices, 1 for those of a half circle. Against three times as many slices, ripples of
# six helical pairs err by half to a ninth of what equal slices of one length did, whose number changed with u.
_GRADING = 0.4
# Corner contacts are followed up to this share of the base pitch beyond either end of a contact line. That stretch is cut into so
# many slices, finer towards its nearest place, where it touches first: where the line ends, or the face. Their borders are the
# same whatever the load, so that nothing depends on how far corners are followed: six slices of the stretch that touches moved
# harmonics by 3 nm. Borders that stood still while the face's end passed over them gave a misaligned helix, whose corner touches
# there first, a peak to peak that was 4 % off and a largest pressure 14 % off; with these it is 0.4 and 0.7 % against seven times
# as many slices.
MOST_BEYOND = 0.45
_CORNER_SLICES = 12
_CORNER_GRADING = 2.0


@dataclass(frozen=True)
class Slices:
    """n slices at all positions of a cycle; with q places along each.

    Attributes:
        position: (n,) number of the position in the cycle.
        pair: (n,) number k of the tooth pair.
        z: (n, q) places from the middle of the common face.
        length: (n,) along the axis.
        weight: (q,) shares of a slice that its places stand for.
        roll: (2, n, q) roll lengths on pinion and gear.
        gap: (n, q) kinematic gap of a corner contact, 0 on the line of action, along the flank normal.
        corner: (n,) whether it is a corner contact.
    """

    position: np.ndarray
    pair: np.ndarray
    z: np.ndarray
    length: np.ndarray
    weight: np.ndarray
    roll: np.ndarray
    gap: np.ndarray
    corner: np.ndarray

    def __len__(self) -> int:
        return len(self.pair)

    def at(self, position: int) -> np.ndarray:
        """Numbers of the slices at one position; they stand in the order of their positions."""
        low, high = np.searchsorted(self.position, [position, position + 1])
        return np.arange(low, high)

    def take(self, here: np.ndarray | slice) -> Slices:
        """Some of the slices."""
        return replace(self, roll=self.roll[:, here], **{name: getattr(self, name)[here] for name in OF_SLICES})


# Arrays with an entry for each slice in their first axis.
OF_SLICES = ("position", "pair", "z", "length", "gap", "corner")


def contact_slices(
    line: LineOfAction,
    positions: np.ndarray,
    width: float,
    slices: int,
    beyond: tuple[float, float],
    *,
    stations: bool = False,
) -> Slices:
    """Cut the contact lines at positions u (p,) (in base pitches from the pitch point).

    Args:
        line: line of action.
        positions: (p,) any values; pair k is at u + k.
        width: common face width.
        slices: how many over the whole face.
        beyond: how far before the start and after the end corner contacts are followed (m on the line of action).
        stations: slices stand at fixed places along the face instead, for slices that don't feel each other.
    """
    tangent = float(np.tan(line.base_helix_angle))
    half = 0.5 * width
    whole = (tangent == 0.0 and slices == 1) or stations
    along, weight = (np.array([0.0]), np.array([1.0])) if whole else _legendre()
    # Number of position, pair and zone, places along the face and length of each slice. Zone 0: the gear's tip
    # corner before the start of contact; 1: the line of action; 2: the pinion's corner after its end.
    first = line.start - beyond[0]
    last = line.end + beyond[1]
    zones = [(first, line.start), (line.start, line.end), (line.end, last)]
    away = _corner_borders(MOST_BEYOND * line.base_pitch, 4.0 * tangent * half / slices)
    step = width / slices
    centres = -half + step * (np.arange(slices) + 0.5)
    pieces: list[tuple[int, int, int, np.ndarray, float]] = []
    for p, u in enumerate(positions):
        low = (first - tangent * half - line.pitch_point) / line.base_pitch - u
        high = (last + tangent * half - line.pitch_point) / line.base_pitch - u
        for k in range(int(np.ceil(low)), int(np.floor(high)) + 1):
            middle = line.pitch_point + (u + k) * line.base_pitch
            for number, ends in enumerate(zones):
                if tangent == 0.0 or stations:
                    # The ends of the line of action belong to it, not to the corners: no slice is counted twice.
                    on_line = middle + centres * tangent
                    inside = (on_line > ends[0]) & (on_line < ends[1])
                    if number == 1:
                        inside = (on_line >= ends[0]) & (on_line <= ends[1])
                    cut = [(centre + 0.5 * step * along, step) for centre in centres[inside]]
                elif number == 1:
                    cut = _line_pieces(middle, tangent, ends, half, slices)
                else:
                    cut = _corner_pieces(middle, tangent, ends, half, slices, away, after=number == 2)
                pieces += [(p, k, number, z, length) for z, length in cut]
    position, pair, zone = (np.array([piece[i] for piece in pieces], int) for i in range(3))
    z = np.array([piece[3] for piece in pieces]).reshape(len(pieces), len(weight))

    # On the line of action both roll lengths add up to T1T2; at a corner one gear touches with its tip, off that line.
    on_pinion = (line.pitch_point + (positions[position] + pair) * line.base_pitch)[:, None] + z * tangent
    roll = np.stack([on_pinion, line.length - on_pinion])
    gap = np.zeros(on_pinion.shape)
    before = zone == 0
    after = zone == 2
    for gear, corner, excess in ((1, before, line.start - on_pinion), (0, after, on_pinion - line.end)):
        if corner.any():
            gap[corner], mate = line.corner(gear, np.maximum(excess[corner], 0.0))
            roll[gear, corner] = line.tip[gear]
            roll[1 - gear, corner] = mate
    return Slices(
        position=position,
        pair=pair,
        z=z,
        length=np.array([piece[4] for piece in pieces]),
        weight=weight,
        roll=roll,
        gap=gap * np.cos(line.base_helix_angle),
        corner=zone != 1,
    )


@cache
def _legendre() -> tuple[np.ndarray, np.ndarray]:
    """Gauss-Legendre places on -1 ... 1 along a slice, and their shares of it."""
    x, w = np.polynomial.legendre.leggauss(_ALONG)
    return x, 0.5 * w


def _line_pieces(
    middle: float, tangent: float, ends: tuple[float, float], half: float, slices: int
) -> list[tuple[np.ndarray, float]]:
    """Places and lengths of the slices of an oblique contact line on the line of action, as many as the longest line has."""
    step = 2.0 * half / slices
    low = max(-half, (ends[0] - middle) / tangent)
    high = min(half, (ends[1] - middle) / tangent)
    length = high - low
    if length < _SLIVER * step:
        return []
    longest = min(2.0 * half, (ends[1] - ends[0]) / tangent)  # its slices are no shorter than a step
    places = np.linspace(-1.0, 1.0, max(1, int(longest / step + 1e-9)) + 1)
    places = (1.0 - _GRADING) * places + _GRADING * np.sin(0.5 * np.pi * places)
    return _between(0.5 * (low + high) + 0.5 * length * places, 0.0)


def _corner_borders(reach: float, longest: float) -> np.ndarray:
    """Rising borders from 0 to `reach` on the line of action, no farther than `longest` apart where that is not 0 (m)."""
    borders = reach * (np.arange(_CORNER_SLICES + 1) / _CORNER_SLICES) ** _CORNER_GRADING
    if not longest:
        return borders
    parts = np.ceil(np.diff(borders) / longest).astype(int)
    pieces = [np.linspace(a, b, n, endpoint=False) for a, b, n in zip(borders, borders[1:], parts, strict=False)]
    return np.append(np.concatenate(pieces), reach)


def _corner_pieces(
    middle: float, tangent: float, ends: tuple[float, float], half: float, slices: int, away: np.ndarray, *, after: bool
) -> list[tuple[np.ndarray, float]]:
    """Places and lengths of the slices of an oblique corner contact, whose borders are so far `away` from its nearest place.

    That is the end of the line of action, or of the face. Slices that begin farther out than corners are followed, outside
    `ends`, are left out.
    """
    before = min(ends[1], middle + tangent * half) - away[::-1]
    behind = max(ends[0], middle - tangent * half) + away
    borders = behind if after else before
    followed = (borders[1:] > ends[0]) & (borders[:-1] < ends[1])
    chosen = np.flatnonzero(followed)
    if not len(chosen):
        return []
    places = np.clip((borders[chosen[0] : chosen[-1] + 2] - middle) / tangent, -half, half)
    return _between(places, _SLIVER * 2.0 * half / slices)


def _between(borders: np.ndarray, least: float) -> list[tuple[np.ndarray, float]]:
    """Places and lengths of the slices between rising borders that are longer than `least`."""
    along = _legendre()[0]
    return [
        (0.5 * (first + last) + 0.5 * (last - first) * along, last - first)
        for first, last in pairwise(borders)
        if last - first > least
    ]


@dataclass(frozen=True)
class PatchLoads:
    """Unit normal forces on the slices of one gear.

    Attributes:
        loads: nodal loads (n, nodes), in the order of the gear's compliance: planes along the face, nodes across in each.
        layers: (n, 2) first and last layer of elements along the face that a slice loads.
        across: nodes across the flank in a plane.
        log_width: (n,) mean logarithm of the patches' half-widths in the transverse section, in normal modules.
    """

    loads: np.ndarray
    layers: np.ndarray
    across: int
    log_width: np.ndarray

    def moved(self, flexibility: np.ndarray, rows: np.ndarray) -> np.ndarray:
        """Displacements (m, nodes) of the flank's nodes for the slices `rows` (m,): P G, by the layers that a slice loads."""
        found = np.empty((len(rows), self.loads.shape[1]))
        first = self.layers[rows, 0]
        for layer in np.unique(first):
            of_layer = np.flatnonzero(first == layer)
            these = rows[of_layer]
            # Layer e has the planes 2 e to 2 e + 2.
            nodes = slice(2 * layer * self.across, (2 * int(self.layers[these, 1].max()) + 3) * self.across)
            found[of_layer] = self.loads[these, nodes] @ flexibility[nodes]
        return found


def patch_loads(
    slices: Slices, gear: int, compliance: GearCompliance, module: float, least: np.ndarray, most: float
) -> PatchLoads:
    """Spread the slices over the flank of one gear.

    Args:
        slices: the slices.
        gear: 0 or 1, whose roll lengths count.
        compliance: of that gear, in normal modules.
        module: normal module (m).
        least: (n,) least half-width c of each slice's patch, in normal modules.
        most: largest half-width, where none of the least ones is larger.
    """
    # Patches are measured along the flank: arc = xi^2 / (2 r_b). They end with the flank, so that no pressure acts beyond it.
    base = compliance.base_radius
    arc = (slices.roll[gear] / module) ** 2 / (2.0 * base)
    low = compliance.flank_start**2 / (2.0 * base)
    high = compliance.flank_end**2 / (2.0 * base)
    c = np.clip(np.minimum(arc - low, high - arc), least[:, None], np.maximum(least, most)[:, None])

    # Gauss-Chebyshev, second kind: its weight function sqrt(1 - t^2) is the semi-elliptic pressure itself.
    k = np.arange(1, _ACROSS + 1) * np.pi / (_ACROSS + 1)
    spread = np.clip(arc[..., None] + c[..., None] * np.cos(k), low, high)
    weights = 2.0 / (_ACROSS + 1) * np.sin(k) ** 2
    across = _shares(compliance.roll**2 / (2.0 * base), spread, weights[None, None] * slices.weight[:, None])
    log_width = np.sum(np.log(c) * slices.weight, axis=1)
    if len(compliance.height) == 1:
        return PatchLoads(across.sum(axis=1), np.zeros((len(slices), 2), int), len(compliance.roll), log_width)
    # The face of the gear runs the other way, so that both are the same kind of body.
    z = (slices.z if gear == 0 else -slices.z) / module
    along = _shares(compliance.height, z[..., None], np.ones((1, 1, 1)))
    loads = np.matmul(along.transpose(0, 2, 1), across).reshape(len(slices), -1)
    ends = np.stack([z.min(axis=1), z.max(axis=1)], axis=1)
    return PatchLoads(loads, _element(compliance.height[::2], ends), len(compliance.roll), log_width)


def _element(ends: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Number of the element, between rising ends, in which each place lies."""
    return np.clip(np.searchsorted(ends, places, side="right") - 1, 0, len(ends) - 2)


def _shares(nodes: np.ndarray, places: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Sum of weighted quadratic shape functions at places (n, q, m) on a line of nodes (2 e + 1,), shape (n, q, nodes)."""
    n, q, m = places.shape
    ends = nodes[::2]
    element = _element(ends, places)
    t = np.clip(2.0 * (places - ends[element]) / (ends[element + 1] - ends[element]) - 1.0, -1.0, 1.0)
    shapes = quadratic(t) * np.broadcast_to(weights, (n, q, m))[..., None]
    row = np.arange(n * q).reshape(n, q, 1, 1) * len(nodes)
    index = row + 2 * element[..., None] + np.arange(3)
    return np.bincount(index.ravel(), shapes.ravel(), n * q * len(nodes)).reshape(n, q, len(nodes))
