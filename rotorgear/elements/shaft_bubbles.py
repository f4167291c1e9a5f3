"""Internal shape functions of a shaft element of order p: polynomials that vanish at both nodes ("bubbles").

With the Legendre polynomials P_k on -1..1 and phi_k(x) = sqrt((2k-1)/2) int_{-1}^x P_{k-1}, k >= 2 (Szabo and Babuska, Finite
Element Analysis, 1991): deflection k = 2..p+1, slope, stretch and twist k = 2..p. The nodal functions are exact static ones, so
their strain energy with any bubble is zero: the stiffness of the bubbles is uncoupled from that of the nodes, and only inertia
joins them. Without shear deformation the slope is the derivative of the deflection, whose bubbles are int int P_k, k = 2..p.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import legendre

from rotorgear.elements.shaft_section import ShaftElements, gauss, section


def bubble_motions(order: int, shear: bool) -> tuple[str, ...]:
    """Motion of each bubble of an element of an order, in their order: two planes of bending, axial, torsion."""
    slopes = order - 1
    plane = 0 if order < 2 else slopes + order if shear else slopes
    return ("bending",) * (2 * plane) + ("axial",) * slopes + ("torsion",) * slopes


def bubble_places(order: int, richer: int, shear: bool) -> np.ndarray:
    """Places of the bubbles of an order among those of a richer element."""

    def names(p: int) -> list[tuple[str, int]]:
        if p < 2:
            return []
        # With shear deformation the deflection has one polynomial more, and the slope its own.
        last = {"w": p + 1, "t": p} if shear else {"w": p}
        fields = [(axis + kind, end) for axis in "xy" for kind, end in last.items()] + [("z", p), ("r", p)]
        return [(field, k) for field, end in fields for k in range(2, end + 1)]

    rich = {name: place for place, name in enumerate(names(richer))}
    return np.array([rich[name] for name in names(order)], dtype=int)


def shaft_bubbles(data: ShaftElements, order: int, points: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Bubbles of e elements of one order >= 2 at g Gauss points.

    Returns:
        Their fields x y z theta_x theta_y theta_z (6, e, g, b); R (e, b, b), the strain-displacement matrix with D = 1, so that
        the stiffness is R^T R; and (b, b), which turns displacements and slopes by +90 degrees about z, and the strains likewise.
    """
    # NaN stands for Cowper's coefficient, which is finite; an infinite one switches shear deformation off.
    shear = bool(np.all(np.isfinite(data.shear_coefficient) | np.isnan(data.shear_coefficient)))
    at, weights, _ = gauss(points)
    L = data.length[:, None]
    area, inertia, ratio = section(data.stiffness_diameters, at)
    E = data.youngs_modulus[:, None]
    G = data.shear_modulus[:, None]
    W = L * weights

    # phi_k and d phi_k / dz for k = 2 ... p+1: (g, k) and (e, g, k).
    P = legendre.legvander(2.0 * at - 1.0, order + 1)
    k = np.arange(2, order + 2)
    value = (P[:, k] - P[:, k - 2]) / np.sqrt(2.0 * (2 * k - 1))
    slope = np.sqrt((2 * k - 1) / 2.0) * P[:, k - 1]
    derivative = (2.0 / data.length)[:, None, None] * slope
    deflection, tilt, bent, sheared = _plane(data, order, at, value, derivative, shear)
    rows = [np.sqrt(W * E * inertia)[:, :, None] * bent]
    if shear:
        rows.append(np.sqrt(W * data.kappa(ratio) * G * area)[:, :, None] * sheared)
    plane_root = _triangle(np.concatenate(rows, axis=1))
    along = value[:, : order - 1]
    spin = derivative[:, :, : order - 1]
    axial_root = _triangle(np.sqrt(W * E * area)[:, :, None] * spin)
    twist_root = _triangle(np.sqrt(W * 2.0 * G * inertia)[:, :, None] * spin)

    # Their order: plane xz, plane yz (slope -theta_x), axial, torsion.
    e, g, b = deflection.shape
    count = 2 * b + 2 * (order - 1)
    xz = slice(0, b)
    yz = slice(b, 2 * b)
    z = slice(2 * b, 2 * b + order - 1)
    theta_z = slice(2 * b + order - 1, count)
    fields = np.zeros((6, e, g, count))
    fields[0][:, :, xz] = deflection
    fields[4][:, :, xz] = tilt
    fields[1][:, :, yz] = deflection
    fields[3][:, :, yz] = -tilt
    fields[2][:, :, z] = fields[5][:, :, theta_z] = along
    strain = np.zeros((e, count, count))
    for own, root in ((xz, plane_root), (yz, plane_root), (z, axial_root), (theta_z, twist_root)):
        strain[:, own, own] = root
    turn = np.zeros((count, count))
    turn[xz, yz] = -np.eye(b)
    turn[yz, xz] = np.eye(b)
    return fields, strain, turn


def _plane(
    data: ShaftElements, order: int, at: np.ndarray, value: np.ndarray, derivative: np.ndarray, shear: bool
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Deflection, slope, curvature and shear strain of one plane's bubbles at the points, each (e, g, b)."""
    e = len(data.length)
    g = len(at)
    if not shear:
        # int int P_k, int P_k and P_k for k = 2 ... p, scaled to unit curvature energy; d/dz = (2 / L) d/dx.
        P = legendre.legvander(2.0 * at - 1.0, order + 2)
        k = np.arange(2, order + 1)
        once = (P[:, k + 1] - P[:, k - 1]) / (2 * k + 1)
        above = (P[:, k + 2] - P[:, k]) / ((2 * k + 3) * (2 * k + 1))
        twice = above - (P[:, k] - P[:, k - 2]) / ((2 * k + 1) * (2 * k - 1))
        scale = np.sqrt((2 * k + 1) / 2.0)
        half = (2.0 / data.length)[:, None, None]
        w = np.broadcast_to(scale * twice, (e, g, len(k)))
        return w, half * (scale * once), half**2 * (scale * P[:, k]), np.zeros(w.shape)

    # Deflection phi_2 ... phi_p+1 and slope phi_2 ... phi_p move on their own; the shear strain is w' - theta.
    slopes = order - 1
    w = np.concatenate([np.broadcast_to(value, (e, *value.shape)), np.zeros((e, g, slopes))], axis=2)
    t = np.concatenate([np.zeros((e, g, order)), np.broadcast_to(value[:, :slopes], (e, g, slopes))], axis=2)
    bent = np.concatenate([np.zeros((e, g, order)), derivative[:, :, :slopes]], axis=2)
    rising = np.concatenate([derivative, np.zeros((e, g, slopes))], axis=2)
    return w, t, bent, rising - t


def _triangle(rows: np.ndarray) -> np.ndarray:
    """Upper triangle R (e, b, b) with R^T R = rows^T rows; QR keeps the small strains exact."""
    return np.asarray(np.linalg.qr(rows, mode="r"))
