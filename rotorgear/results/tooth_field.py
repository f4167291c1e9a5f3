"""Displacement and stress of the teeth of both gears at one position of the mesh cycle, with the pressure between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class ToothField:
    """Finite elements of some pitches of one gear, in the place where they mesh (m; the pinion's axis is the z axis).

    Attributes:
        points: (p, 3); cells: (e, 9) of biquadratic quadrangles or (e, 27) of triquadratic hexahedra, in VTK's order.
        tooth: (p,) number of the pitch, 0 for that of pair 0.
        displacement: (p, 3) in m; von_mises, largest_principal: (p,) in Pa, averaged at the nodes.
        root_stress: largest principal stress (Pa) in the fillet on the loaded side of all teeth.
    """

    name: str
    points: np.ndarray
    cells: np.ndarray
    tooth: np.ndarray
    displacement: np.ndarray
    von_mises: np.ndarray
    largest_principal: np.ndarray
    root_stress: float


@dataclass(frozen=True)
class ContactField:
    """Slices that carry load: (n, 2, 3) ends of each on the flanks (m), line load (N/m), half-width (m), pressure (Pa), pair."""

    ends: np.ndarray
    line_load: np.ndarray
    half_width: np.ndarray
    pressure: np.ndarray
    pair: np.ndarray


@dataclass(frozen=True)
class ToothFields:
    """Both gears and the contact at one position (mesh periods) of the first helix."""

    mesh: str
    position: float
    gears: tuple[ToothField, ToothField]
    contact: ContactField
