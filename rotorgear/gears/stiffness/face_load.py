"""How a helix carries along its face: force F and moment M about the middle of the face, for misaligned flanks.

The gears approach by delta in the middle of the face, and the flanks stand apart by f z/b at a place z of the face of width b,
f being the misalignment. With the forces F_i at the places z_i,

    F = sum F_i,    M = sum F_i z_i,    d(F, M)/d(delta, tilt) = k (1, e)^T (1, e) + k_t (0, 1)^T (0, 1),

where the tilt (m/m) closes the flanks at larger z: a spring k at the place e, the centre of stiffness, and one against tilt
about it. The largest load per width over the mean one is the face load factor K_Hbeta (ISO 6336-1, 7.2).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from rotorgear.errors import AnalysisError


@dataclass(frozen=True)
class FaceSpring:
    """A face that is linear about a state: k (N/m), the place e of its centre from the middle of the face (m), and k_t (N m)."""

    stiffness: float
    place: float
    tilt_stiffness: float


# Places along the face at which the load of a line of springs is told.
_PLACES = 41


@dataclass(frozen=True, eq=False)  # it holds arrays
class FaceLoad:
    """One helix under its mean load, along the flank normal.

    Attributes:
        width: b (m).
        misalignment: f (m), positive where the flanks stand apart at larger z.
        force: F (N).
        moment: M (N m) about the middle of the face.
        approach: delta in the middle of the face (m).
        static: what changes of the mean load and of the misalignment meet.
        dynamic: what small motions about the state meet.
        z: (n,) places from the middle of the face (m).
        line_load: (n,) load per width there, mean of the mesh cycle (N/m).
        load_factor: K_Hbeta, largest load per width over the mean one.
        peak_place: z of the largest load per width (m).
        peak_pressure: largest contact pressure of the mesh cycle (Pa); None where the teeth are not looked at.
        warnings: sentences.
    """

    width: float
    misalignment: float
    force: float
    moment: float
    approach: float
    static: FaceSpring
    dynamic: FaceSpring
    z: np.ndarray
    line_load: np.ndarray
    load_factor: float
    peak_place: float
    peak_pressure: float | None = None
    warnings: tuple[str, ...] = ()

    @property
    def load_place(self) -> float:
        """M / F (m): where the load stands from the middle of the face."""
        return self.moment / self.force

    @property
    def mirrored(self) -> FaceLoad:
        """The same seen from the other end of the face."""
        return replace(
            self,
            misalignment=-self.misalignment,
            moment=-self.moment,
            static=replace(self.static, place=-self.static.place),
            dynamic=replace(self.dynamic, place=-self.dynamic.place),
            line_load=np.flip(self.line_load),
            z=-np.flip(self.z),
            peak_place=-self.peak_place,
        )


def uniform_line(stiffness: float, width: float, force: float, misalignment: float) -> FaceLoad:
    """A line of springs k/b that only push, over the face: p(z) = (k/b) (delta - f z/b) >= 0.

    While the whole face carries, delta = F/k, M = -k b f/12 and K_Hbeta = 1 + k |f|/(2 F). With a larger misalignment a
    length a = b sqrt(2 F/(k |f|)) carries, from one end of the face on, and K_Hbeta = 2 b/a (ISO 6336-1, equations for
    K_Hbeta below and above 2, with the stiffness k/b for c_gamma_beta).

    Args:
        stiffness: k (N/m) of the whole face along the flank normal.
        width: b (m).
        force: F (N), positive.
        misalignment: f (m).

    Raises:
        AnalysisError: a width or force that is not positive.
    """
    if not (width > 0.0 and force > 0.0):
        raise AnalysisError(f"A loaded face needs a width and a force, not {width:g} m and {force:g} N.")
    size = abs(misalignment)
    side = -math.copysign(1.0, misalignment)  # the end that carries more
    if 0.5 * stiffness * size <= force:
        carries = width
        approach = force / stiffness
        factor = 1.0 + 0.5 * stiffness * size / force
    else:
        carries = width * math.sqrt(2.0 * force / (stiffness * size))
        approach = size / width * (carries - 0.5 * width)
        factor = 2.0 * width / carries
    # The part of the face that carries is a uniform line of its own.
    spring = FaceSpring(
        stiffness * carries / width, 0.5 * side * (width - carries), stiffness * carries**3 / (12.0 * width)
    )
    z = np.linspace(-0.5 * width, 0.5 * width, _PLACES)
    return FaceLoad(
        width=width,
        misalignment=misalignment,
        force=force,
        moment=force * spring.place - spring.tilt_stiffness * misalignment / width,
        approach=approach,
        static=spring,
        dynamic=spring,
        z=z,
        line_load=stiffness / width * np.maximum(approach - misalignment * z / width, 0.0),
        load_factor=factor,
        peak_place=0.5 * side * width if misalignment else 0.0,
    )
