"""The state of one helix that a linear analysis is about: what an equilibrium found, and no file gives."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class FaceState:
    """A contact along its face, linear about its mean state.

    F = start + k (v . q - gap - shift),    M - e F = couple + k_t (v_t . q).

    Attributes:
        place: e, where v stands, from the middle of the face (m).
        tilt_stiffness: k_t (N m).
        shift: what the tilt of the state adds to the approach at that place (m): with it, approaches are those in the middle.
        couple: N m about e where the shafts have not tilted.
    """

    place: float
    tilt_stiffness: float
    shift: float
    couple: float


@dataclass(frozen=True, eq=False)  # a state of its own: models that hold one are compared by what their files say
class HelixState:
    """A helix about its mean state over the mesh cycle, with the loaded teeth of the whole gearbox in equilibrium together.

    Attributes:
        force: mean (N) along the flank normal.
        torque_sense, pinion_drives: the flanks that work, as in `MeshForce`.
        stiffness: mean tangent (N/m) along the flank normal.
        start: F - k (delta - gap) (N).
        face: along the face; None of teeth that feel no tilt.
    """

    force: float
    torque_sense: int
    pinion_drives: bool
    stiffness: float
    start: float
    face: FaceState | None = None
