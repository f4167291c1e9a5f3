"""Misprints of the five accounts as numbers: by how much a printed equation breaks a law that it must keep.

Of a stiffness r vᵀ, whose forces act along r and whose deflection is measured along v, the asymmetry is the largest entry of
|r vᵀ - v rᵀ| over the largest of |r vᵀ|: 0 where work is kept.
"""

from __future__ import annotations

import math

import numpy as np

from rotorgear.elements.gear_mesh import ContactGeometry, contact_vector


def asymmetry(pushed: np.ndarray, moved: np.ndarray) -> float:
    """Asymmetry of the stiffness whose force acts along `pushed` and whose deflection is measured along `moved`."""
    printed = np.outer(pushed, moved)
    return float(np.abs(printed - printed.T).max() / np.abs(printed).max())


def marine_balance() -> tuple[float, float]:
    """Largest torque (N m) that no forces of the marine train balance, by the printed equations and by the chain meant.

    Columns are the forces of both first and both second meshes, of the chain those of the quill shafts too; rows the bodies.
    """
    rp1, rg1, rp2, rg2 = 0.075, 0.24, 0.09, 0.3
    torques = np.array([15e3, 15e3, 0.0, 0.0, 0.0, 0.0, -320e3])
    printed = np.array(
        [[-rp1, 0, 0, 0], [0, -rp1, 0, 0], [rp1, 0, -rp2, 0], [0, rg1, 0, -rp2], [0, 0, rp2, 0], [0, 0, 0, rp2],
         [0, 0, rg2, 0]]
    )  # fmt: skip
    meant = np.array(
        [[-rp1, 0, 0, 0, 0, 0], [0, -rp1, 0, 0, 0, 0], [rg1, 0, 0, 0, -1, 0], [0, rg1, 0, 0, 0, -1],
         [0, 0, -rp2, 0, 1, 0], [0, 0, 0, -rp2, 0, 1], [0, 0, rg2, rg2, 0, 0]]
    )  # fmt: skip
    left = [matrix @ np.linalg.lstsq(matrix, -torques, rcond=None)[0] + torques for matrix in (printed, meant)]
    return float(np.abs(left[0]).max()), float(np.abs(left[1]).max())


def marine_stiffness() -> float:
    """Asymmetry: delta_1 joins bodies 1 and 4, its force acts on bodies 1 and 3."""
    moved, pushed = np.zeros(7), np.zeros(7)
    moved[[0, 3]] = 0.075, -0.24
    pushed[[0, 2]] = 0.075, -0.075
    return asymmetry(pushed, moved)


def pair24_force() -> tuple[float, float]:
    """Share of the tooth force that the printed signs, and opposite ones, leave on both gears of the 24-dof pair together."""
    angle, helix = math.radians(20.0), math.radians(22.0)
    along = np.array([math.sin(angle), math.cos(angle) * math.cos(helix), math.cos(angle) * math.sin(helix)])
    both = np.tile(np.eye(3), 2)
    left = [float(np.linalg.norm(both @ np.concatenate([along, sign * along]))) for sign in (1.0, -1.0)]
    return left[0], left[1]


def split_tilt() -> tuple[float, float]:
    """Strain (m) of a mesh of the split-torque gearbox as both gears turn by 1 rad about one axis: printed, and in rotorgear.

    About y the gear's centre sinks by the centre distance. The larger of both axes.
    """
    angle, helix = math.radians(28.3), math.radians(30.0)
    first, second = 0.05, 0.2
    distance = (first + second) / math.cos(angle)
    base_helix = math.asin(math.sin(helix) * math.cos(math.radians(25.0)))
    ours = contact_vector(ContactGeometry(1, 1, 0.0, angle, base_helix, first, second, 0.0, 0.0, 0.0))
    strains = []
    for tilt in ("x", "y"):
        moved = np.zeros(12)
        moved[[3, 9] if tilt == "x" else [4, 10]] = 1.0
        moved[8] = -distance if tilt == "y" else 0.0
        arms = (first + second) * (math.sin(angle) if tilt == "x" else math.cos(angle))
        strains.append((abs((arms + moved[8] - moved[2]) * math.sin(helix)), abs(float(ours @ moved))))
    return float(max(s[0] for s in strains)), float(max(s[1] for s in strains))


def impact_energy() -> tuple[float, float]:
    """Energy at the largest force of the 12-dof formula over that of the blow: q delta²/2 as printed, and delta²/(2 q)."""
    energy, hit, carrying, angle = 0.5, 2e-9, 5e-10, 0.1
    force = math.sqrt(2.0 * energy / (hit + carrying * math.cos(angle) ** 2))
    given = [(hit * force, hit), (carrying * math.cos(angle) * force, carrying)]
    return sum(0.5 * q * d**2 for d, q in given) / energy, sum(0.5 * d**2 / q for d, q in given) / energy


def pair16_axial() -> float:
    """Asymmetry: lambda has -z sin(beta), the axial row +F sin(beta)."""
    helix, angle = math.radians(20.86), math.radians(21.28)
    plane = math.cos(helix) * np.array([math.sin(angle), math.cos(angle), 0.085])
    moved = np.array([plane[0], plane[1], -math.sin(helix), plane[2]])
    pushed = np.array([plane[0], plane[1], math.sin(helix), plane[2]])
    return asymmetry(pushed, moved)
