"""Loaded tooth contact over a mesh cycle: forces of all slices, transmission error and stiffness.

Unknown are the normal forces F >= 0 of the slices and the approach delta of the gears along the line of action:
    C F + gap - delta cos b_b >= 0,   F >= 0,   sum F = T_1 / (r_b1 cos b_b),
with C from the finite-element compliance of the patches; on its diagonal the patch of half-width c is replaced by the Hertz strip
of half-width a: K F' (1/4 + ln(c cos b_b / a)) for each body, K = 2 (1 - nu^2)/(pi E), F' = F cos b_b / dz, a^2 = 4 F' R/(pi E*).
a depends on F, so the contact is solved again until the forces rest. (c lies in the transverse section; c cos b_b is the patch's
half-width across the contact line.) Reference: K. L. Johnson, Contact Mechanics, sections 4.2 and 5.6.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg as la

from rotorgear.errors import ConvergenceError
from rotorgear.solvers.time.unilateral import unilateral

# Rounds of force and half-width: few are needed as a rule, since a enters by its logarithm only.
_OUTER_ROUNDS = 80
# Change of the forces over the load at which they count as resting.
_FORCE_TOLERANCE = 1e-12
# Share of the mean load per slice that an unloaded slice counts as carrying: its strip must have a width.
_TRACE = 1e-6
# The local part of a slice's compliance is kept above this share of K, so that it stays positive.
_LEAST_LOCAL = 0.05


@dataclass(frozen=True)
class PositionContact:
    """The slices at one position of the mesh cycle.

    Attributes:
        compliance: C without its local part (n, n) (m/N) between normal forces and approaches, patches spread over c.
        gap: (n,) along the flank normal before loading (m).
        length: (n,) length of each slice's contact line, dz / cos b_b (m).
        local: (n, 2) K of both bodies (m^2/N).
        log_width: (n, 2) logarithm of the patches' half-widths across the contact line (m).
        radius: (n,) relative radius of curvature R (m).
        modulus: E* of the pair (Pa).
    """

    compliance: np.ndarray
    gap: np.ndarray
    length: np.ndarray
    local: np.ndarray
    log_width: np.ndarray
    radius: np.ndarray
    modulus: float


@dataclass(frozen=True)
class ContactState:
    """Solution at one position.

    Attributes:
        force: (n,) normal forces (N).
        approach: of the gears along the flank normal (m).
        tangent: stiffness at the load along the flank normal (N/m).
        strip: (n,) half-widths of the Hertz strips (m), 0 where unloaded.
        residual: largest violation of the contact conditions (m).
    """

    force: np.ndarray
    approach: float
    tangent: float
    strip: np.ndarray
    residual: float


def hertz_half_width(load: np.ndarray, radius: np.ndarray, modulus: float) -> np.ndarray:
    """a (m) of a line contact under load (N/m)."""
    return np.sqrt(4.0 * np.maximum(load, 0.0) * radius / (np.pi * modulus))


def solve_contact(contact: PositionContact, total: float) -> ContactState:
    """Solve one position for a total normal force (N).

    Raises:
        ConvergenceError: the compliance is not positive definite, or the forces don't come to rest.
    """
    n = len(contact.gap)
    force = np.full(n, total / n)
    start: np.ndarray | None = None
    for _ in range(_OUTER_ROUNDS):
        C = contact.compliance + np.diag(_local(contact, force, total, tangent=False))
        previous = force
        force, approach = unilateral(C, contact.gap, total, start)
        start = force > 0.0  # the slices in contact hardly change between rounds
        change = float(np.abs(force - previous).max()) / total
        if change <= _FORCE_TOLERANCE:
            break
    else:
        raise ConvergenceError(
            f"The loaded contact did not come to rest in {_OUTER_ROUNDS} rounds; the last change was {change:.1e} of the "
            "load. Use a finer preset or a smaller misalignment."
        )

    # Contact conditions: no opening where a force acts, no overlap anywhere.
    opening = C @ force + contact.gap - approach
    loaded = np.flatnonzero(force > 0.0)
    residual = max(float(np.abs(opening[loaded]).max()), float(np.maximum(-opening, 0.0).max()))

    # Tangent stiffness dF / d delta = 1^T C_t^-1 1 over the slices in contact: all of them approach alike.
    C_t = contact.compliance[np.ix_(loaded, loaded)] + np.diag(_local(contact, force, total, tangent=True)[loaded])
    tangent = float(la.solve(C_t, np.ones(len(loaded)), assume_a="pos", check_finite=False).sum())
    return ContactState(
        force=force,
        approach=approach,
        tangent=tangent,
        strip=hertz_half_width(force / contact.length, contact.radius, contact.modulus),
        residual=residual,
    )


def _local(contact: PositionContact, force: np.ndarray, total: float, *, tangent: bool) -> np.ndarray:
    """Local compliance (n,) of the slices, secant or tangent; an unloaded slice counts as carrying a trace of the load."""
    load = np.maximum(force, _TRACE * total / len(force)) / contact.length
    a = hertz_half_width(load, contact.radius, contact.modulus)
    # d(F' ln 1/a)/dF' takes 1/2 off the secant's 1/4 + ln(c/a), because a grows as sqrt(F').
    share = (-0.25 if tangent else 0.25) + contact.log_width - np.log(a)[:, None]
    return np.asarray(np.sum(contact.local * np.maximum(share, _LEAST_LOCAL), axis=1) / contact.length)
