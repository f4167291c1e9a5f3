"""Map of one helix whose flanks tilt against each other: (F, M)(delta, tilt, u), from contact maps at some misalignments.

At a misalignment f the contact map has approach delta(F; u) and moment M(F; u) about the middle of the face. A tilt that closes
the flanks at larger z takes f away: tilt = (f_0 - f)/b, f_0 being what is given. Contact is elastic, so that F and M are the
derivatives of one energy,

    F = dW/d delta,    M = dW/d tilt,

and with both known at every tilt W is a Hermite cubic in the tilt between two of them (forces/loaded_teeth.py). At a tilt that
was solved, F and M are those of the contact.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from rotorgear.gears.maps.contact_map import ContactMap
from rotorgear.gears.maps.solved_map import contact_map
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair

# Misalignments that are solved, about that of the state, in units of its spread: none at the state itself, so that tangents are
# central differences there.
_PLACES = (-2.0, -0.8, -0.15, 0.15, 0.8, 2.0)


@dataclass(frozen=True)
class FaceMap:
    """(F, M)(delta, tilt, u) of one helix.

    Attributes:
        tilt: (k,) rising, m/m, closing the flanks at larger z.
        maps: the contact map at each tilt, with its moment about the middle of the face; all at the same positions.
    """

    tilt: np.ndarray
    maps: tuple[ContactMap, ...]

    @property
    def position(self) -> np.ndarray:
        """(p,) u in base pitches, evenly spaced from 0 over `periods`."""
        return self.maps[0].position

    @property
    def periods(self) -> int:
        """Base pitches after which the maps repeat."""
        return self.maps[0].periods

    @property
    def error(self) -> float:
        """The largest one of the maps, in m."""
        return max(one.error for one in self.maps)

    @property
    def mirrored(self) -> FaceMap:
        """The same seen from the other end of the face."""
        turned = [replace(one, moment=None if one.moment is None else -one.moment) for one in reversed(self.maps)]
        return FaceMap(-self.tilt[::-1], tuple(turned))

    def no_load(self, tilt: float, u: np.ndarray) -> np.ndarray:
        """Approach (r,) in m at first touch, at a tilt and positions u (r,)."""
        touch = np.stack([one.no_load(u) for one in self.maps])
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
    maps = tuple(contact_map(replace(teeth, misalignment=f), load, near=near) for f in asked)
    return FaceMap(np.array([(given - f) / teeth.width for f in asked]), maps)
