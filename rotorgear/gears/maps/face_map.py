"""Map of one helix whose flanks tilt against each other: (F, M)(delta, tilt, u), from contact maps at some misalignments.

At a misalignment f the contact map has approach delta(F; u) and moment M(F; u) about the middle of the face. A tilt that closes
the flanks at larger z takes f away: tilt = (f_0 - f)/b, f_0 being what is given. Contact is elastic, so that F and M are the
derivatives of one energy,

    F = dW/d delta,    M = dW/d tilt,

and with both known at every tilt W is a Hermite cubic in the tilt between two of them (forces/loaded_face.py). At a tilt that was
solved, F and M are those of the contact.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import PchipInterpolator

from rotorgear.gears.maps.solved_map import contact_map
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair

# Misalignments that are solved, about that of the state, in units of its spread: none at the state itself, so that tangents are
# central differences there.
_PLACES = (-2.0, -0.8, -0.15, 0.15, 0.8, 2.0)
# Loads to each step of load of a map.
_FINER = 8


@dataclass(frozen=True)
class FaceMap:
    """(F, M)(delta, tilt, u) of one helix.

    Attributes:
        tilt: (k,) rising, m/m, closing the flanks at larger z.
        position: (p,) u in base pitches, evenly spaced from 0 over `periods`.
        periods: base pitches after which the map repeats.
        load: (l,) forces along the flank normal in N, rising from 0.
        approach: (k, p, l) in the middle of the face, in m, at these loads.
        moment: (k, p, l) about the middle of the face, in N m.
        warnings: sentences.
        error: largest one of the maps at its tilts, in m.
    """

    tilt: np.ndarray
    position: np.ndarray
    periods: int
    load: np.ndarray
    approach: np.ndarray
    moment: np.ndarray
    warnings: tuple[str, ...] = ()
    error: float = float("nan")

    @property
    def mirrored(self) -> FaceMap:
        """The same seen from the other end of the face."""
        return replace(self, tilt=-self.tilt[::-1], approach=self.approach[::-1], moment=-self.moment[::-1])

    def approaches(self, u: np.ndarray) -> np.ndarray:
        """Approach (k, r, l) in m at all tilts and loads of the map, at positions u (r,)."""
        at = np.mod(u / self.periods, 1.0) * len(self.position)
        index = np.minimum(at.astype(int), len(self.position) - 1)
        share = (at - index)[:, None]
        following = (index + 1) % len(self.position)
        return np.asarray((1.0 - share) * self.approach[:, index] + share * self.approach[:, following])

    def no_load(self, tilt: float, u: np.ndarray) -> np.ndarray:
        """Approach (r,) in m at first touch, at a tilt and positions u (r,)."""
        touch = self.approaches(u)[:, :, 0]
        return np.array([np.interp(tilt, self.tilt, column) for column in touch.T])


def misalignments(state: float, given: float, deflection: float) -> tuple[float, ...]:
    """Misalignments (m), falling, at which a helix is solved for a map about a state.

    Args:
        state: misalignment of the mean state.
        given: that of unloaded shafts.
        deflection: approach of the flanks under the mean load: misalignments of its size move the load along the face.
    """
    spread = max(abs(state - given), deflection)
    # Rounding of the equilibrium must not make another map.
    return tuple(float(f"{state - place * spread:.9g}") for place in _PLACES)


def holds(asked: tuple[float, ...], state: float) -> bool:
    """Whether a map at misalignments (m), falling, is one about another state too: one cell at least on either side of it."""
    return asked[-2] <= state <= asked[1]


def face_map(teeth: ToothPair, load: float, asked: tuple[float, ...], given: float, near: bool = False) -> FaceMap:
    """Solve the map of a pair for some misalignments.

    Args:
        teeth: one helix, along the path of contact.
        load: working force (N) along the flank normal.
        asked: misalignments (m), falling.
        given: the misalignment (m) at no tilt.
        near: for linear analyses: fewer loads, up to about twice the working one.

    Raises:
        What `contact_map` raises.
    """
    maps = [contact_map(replace(teeth, misalignment=f), load, near=near) for f in asked]
    # Where a contact under the largest loads is no line any more, its map ends earlier.
    solved = min((one.load for one in maps), key=len)
    at = np.arange(_FINER * (len(solved) - 1) + 1) / _FINER
    loads = np.interp(at, np.arange(len(solved)), solved)
    return FaceMap(
        tilt=np.array([(given - f) / teeth.width for f in asked]),
        position=maps[0].position,
        periods=maps[0].periods,
        load=loads,
        # Between its loads the curve is the map's own, which knows its tangents.
        approach=np.stack([one.approaches(loads) for one in maps]),
        moment=np.stack([PchipInterpolator(one.load, one.moment, axis=1)(loads) for one in maps]),
        warnings=tuple(dict.fromkeys(note for one in maps for note in one.warnings)),
        error=max(one.error for one in maps),
    )
