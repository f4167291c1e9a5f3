"""Loaded tooth contact at one position of the mesh cycle: forces of all slices, approach and tangent stiffness.

Unknown are the normal forces F >= 0 of the slices and the approach delta of the gears along the flank normal:
    C F + g(F) + gap - delta >= 0,   F >= 0,   F (C F + g(F) + gap - delta) = 0,   sum F = T_1 / (r_b1 cos b_b),
with C from the finite-element compliance of patches of half-width c, and g what the Hertz strip of half-width a adds to it:
    g = K F' (1/4 + ln(c/a)) for each body,   F' = F / l,   a^2 = 4 F' R/(pi E*),   K = 2 (1 - nu^2)/(pi E),
l being the length of the slice's contact line. dg/dF' = K (ln(c/a) - 1/4), and C + dg/dF is positive definite while no strip is
wider than its patch: the conditions are those of the least of a convex energy,
    E(F) = F C F / 2 + sum of the integrals of g + gap F   over   F >= 0, sum F = given.
Newton's method with the exact tangent of g: each round solves a quadratic problem with its inequalities, and a line search
along it never lets the energy rise, so that the rounds can't run in a circle.
References: K. L. Johnson, Contact Mechanics, sections 4.2 and 5.6; Nocedal and Wright, Numerical Optimization, chapters 3 and 18.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.linalg.lapack import dposv

from rotorgear.errors import ConvergenceError
from rotorgear.solvers.contact.unilateral import unilateral

# Newton's rounds: four to eight as a rule.
_ROUNDS = 100
# Change of the forces over the load in the last round. The error left after it is about its square.
_FORCE_TOLERANCE = 1e-8
# Energies are known to this share of load times approach.
_ENERGY_ROUNDING = 1e-16
# A line search ends where the slope of the energy has fallen to this share of the first one.
_SLOPE_LEFT = 0.1
# Share of the mean load per slice below which g is taken proportional to F: its true tangent at zero is infinite.
_TRACE = 1e-6


@dataclass(frozen=True)
class PositionContact:
    """The slices at one position of the mesh cycle.

    Attributes:
        compliance: C without its local part (n, n) (m/N) between normal forces and approaches, patches spread over c.
        gap: (n,) along the flank normal before loading (m).
        length: (n,) length of each slice's contact line, dz / cos b_b (m).
        local: (2,) K of both bodies (m^2/N).
        log_width: (n, 2) logarithm of the patches' half-widths c across the contact line (m).
        radius: (n,) relative radius of curvature R (m).
        modulus: E* of the pair (Pa).
        least_tangent: dg/dF' over K is kept above it: 0.01 is that of c = 1.3 a. Where slices feel each other through elements
            that are hardly finer, wider strips than patches would not be convex; elsewhere it may be negative.
    """

    compliance: np.ndarray
    gap: np.ndarray
    length: np.ndarray
    local: np.ndarray
    log_width: np.ndarray
    radius: np.ndarray
    modulus: float
    least_tangent: float = 0.01

    def with_arrays(self, of: Callable[[str], Any]) -> PositionContact:
        """The same pair with other arrays of slices, by their names."""
        return replace(self, **{name: of(name) for name in ("compliance", "gap", "length", "log_width", "radius")})

    def chosen(self, which: Any) -> PositionContact:
        """Arrays at some places, or one, of their first axis: that of many contacts, or of the slices."""
        return self.with_arrays(lambda name: getattr(self, name)[which])


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


def solve_contact(
    contact: PositionContact, total: float, start: np.ndarray | None = None, tolerance: float = _FORCE_TOLERANCE
) -> ContactState:
    """Solve one position for a total normal force (N).

    Args:
        contact: the slices.
        total: sum of the normal forces (N).
        start: (n,) forces to begin with, of any positive sum; default: spread evenly.
        tolerance: change of the forces over the load in the last round.

    Raises:
        ConvergenceError: the compliance is not positive definite, the load is lost in the gaps, or the forces don't come to rest.
    """
    if total * contact.compliance.diagonal().max() <= np.finfo(float).eps * np.abs(contact.gap).max():
        raise ConvergenceError(
            f"The load of {total:.3g} N presses the teeth together by less than the rounding of their gaps; "
            "give a larger torque, or a mesh stiffness that does not follow the load"
        )
    force = np.full(len(contact.gap), total / len(contact.gap)) if start is None else start * (total / start.sum())
    added, tangent = _local(contact, force, total)
    for _ in range(_ROUNDS):
        target, approach = unilateral(
            contact.compliance + np.diag(tangent), contact.gap + added - tangent * force, total, force > 0.0
        )
        step = target - force
        opening = contact.compliance @ force + added + contact.gap
        fall = -float(step @ opening)
        small = float(np.abs(step).max()) <= tolerance * total
        if small or fall <= _ENERGY_ROUNDING * total * abs(approach):
            # No opening where a force acts, no overlap anywhere.
            opening = contact.compliance @ target + _local(contact, target, total)[0] + contact.gap - approach
            loaded = target > 0.0
            return ContactState(
                force=target,
                approach=approach,
                tangent=float(_stiffness(contact, target, np.ones((len(target), 1)))[0, 0]),
                strip=hertz_half_width(target / contact.length, contact.radius, contact.modulus),
                residual=max(float(np.abs(opening[loaded]).max()), float(np.maximum(-opening, 0.0).max())),
            )
        share, added, tangent = _share_of_step(contact, force, step, fall, total)
        force = force + share * step
    raise ConvergenceError(
        f"The loaded contact did not come to rest in {_ROUNDS} rounds; the last change was "
        f"{float(np.abs(step).max()) / total:.1e} of the load. Use a finer preset or a smaller misalignment."
    )


def _share_of_step(
    contact: PositionContact, force: np.ndarray, step: np.ndarray, fall: float, total: float
) -> tuple[float, np.ndarray, np.ndarray]:
    """Share t of a step up to which the energy falls, and g (n,) in m and dg/dF (n,) in m/N there.

    The slope of the energy rises with t; at the share it is not positive. fall: less the slope at t = 0.
    """
    opening = contact.compliance @ force + contact.gap
    change = contact.compliance @ step

    def slope(t: float) -> tuple[float, np.ndarray, np.ndarray]:
        added, tangent = _local(contact, force + t * step, total)
        return float(step @ (opening + t * change + added)), added, tangent

    at_high, added, tangent = slope(1.0)
    if at_high <= 0.0:
        return 1.0, added, tangent
    low = 0.0
    at_low = -fall
    high = 1.0
    for _ in range(60):
        # The chord's zero; in the middle where it clings to an end.
        t = low - at_low * (high - low) / (at_high - at_low)
        t = min(max(t, low + 0.1 * (high - low)), high - 1e-9 * (high - low))
        at_t, added, tangent = slope(t)
        if at_t > 0.0:
            high = t
            at_high = at_t
            continue
        low = t
        at_low = at_t
        if at_t >= -_SLOPE_LEFT * fall:
            return low, added, tangent
    return low, *_local(contact, force + low * step, total)


def moment_and_tangents(contact: PositionContact, state: ContactState, z: np.ndarray) -> tuple[float, np.ndarray]:
    """Moment of the slices' forces about the middle of the face, and how force and moment follow approach and tilt.

    A tilt phi about the middle opens the flanks by phi z:  C F + g(F) + gap + phi z - delta = 0 where slices touch. So with
    X = (C + dg/dF)^-1 over these slices, dF = X (1 ddelta - z dphi).

    Args:
        contact, state: a position and its solution.
        z: (n,) places of the slices from the middle of the face (m).

    Returns:
        M = sum F z (N m), and d(F, M)/d(delta, phi) (2, 2) in N/m, N, N and N m.
    """
    shapes = np.stack([np.ones(len(z)), z], axis=1)
    return float(state.force @ z), _stiffness(contact, state.force, shapes) * np.array([1.0, -1.0])


def tangent_compliance(contact: PositionContact, force: np.ndarray) -> np.ndarray:
    """C + dg/dF (n, n) in m/N of all slices, under forces (n,)."""
    return np.asarray(contact.compliance + np.diag(_local(contact, force, float(force.sum()))[1]))


def _stiffness(contact: PositionContact, force: np.ndarray, shapes: np.ndarray) -> np.ndarray:
    """S' (C + dg/dF)^-1 S over the slices in contact, for shapes S (n, m) of approach: (m, m)."""
    loaded = np.flatnonzero(force > 0.0)
    C = tangent_compliance(contact, force)[loaded[:, None], loaded]
    S = shapes[loaded]
    # A strip may have become wider than its patch allows in the very last step: the tangent exists all the same.
    _, solved, failed = dposv(C.T, S)
    return np.asarray(S.T @ (np.linalg.solve(C, S) if failed else solved))


def _local(contact: PositionContact, force: np.ndarray, total: Any) -> tuple[np.ndarray, np.ndarray]:
    """g (n,) in m and dg/dF (n,) in m/N of slices under forces (n,) of the sum `total`; axes before the slices are free."""
    load = force / contact.length
    trace = _TRACE * total / force.shape[-1] / contact.length
    above_trace = np.maximum(load, trace)
    a = hertz_half_width(above_trace, contact.radius, contact.modulus)
    share = contact.log_width - np.log(a)[..., None]  # ln(c/a) of both bodies

    # Beyond the load at which the tangent has fallen to its least value, g goes on along that tangent.
    least = 0.25 + contact.least_tangent
    held = above_trace[..., None] * np.exp(2.0 * np.minimum(share - least, 0.0))
    secant = held * (0.25 + np.maximum(share, least)) + contact.least_tangent * (above_trace[..., None] - held)
    g = secant @ contact.local
    slope = np.maximum(share - 0.25, contact.least_tangent) @ contact.local
    below = load < trace
    proportional = g / trace
    return np.where(below, proportional * load, g), np.where(below, proportional, slope) / contact.length


def solve_many(contact: PositionContact, total: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Approaches (b,) in m and tangent stiffnesses (b,) in N/m of many contacts of few slices at once.

    The active set and Newton's step are taken together (primal-dual active set): few slices settle in some rounds. Those that do
    not are solved one by one.

    Args:
        contact: b of them, all arrays with a first axis for them.
        total: (b,) normal forces (N).
    """
    b, n = contact.gap.shape
    F = np.broadcast_to(total[:, None] / n, (b, n)).copy()
    active = np.ones((b, n), bool)
    approach = np.zeros(b)
    tangent = np.zeros(b)
    running = np.arange(b)
    for _ in range(_ROUNDS):
        here = contact.chosen(running)
        force = F[running]
        touches = active[running]
        added, slope = _local(here, force, total[running, None])
        # Slices out of contact keep a row of their own: F = 0.
        A = here.compliance + slope[:, :, None] * np.eye(n)
        A = np.where(touches[:, :, None] & touches[:, None, :], A, np.eye(n))
        right = np.stack([touches, np.where(touches, here.gap + added - slope * force, 0.0)], axis=-1)
        solved = np.linalg.solve(A, right.astype(float))
        stiffness = solved[..., 0].sum(axis=1)
        delta = (total[running] + solved[..., 1].sum(axis=1)) / stiffness
        target = delta[:, None] * solved[..., 0] - solved[..., 1]
        opening = np.einsum("bij,bj->bi", here.compliance, target) + here.gap - delta[:, None]
        wanted = np.where(touches, target > 0.0, opening < 0.0)
        converged = (wanted == touches).all(axis=1)
        converged &= np.abs(target - force).max(axis=1) <= _FORCE_TOLERANCE * total[running]
        approach[running] = delta
        tangent[running] = stiffness
        F[running] = np.maximum(target, 0.0)
        active[running] = np.where(wanted.any(axis=1)[:, None], wanted, touches)
        running = running[~converged]
        if not len(running):
            break
    for i in running:
        state = solve_contact(contact.chosen(i), float(total[i]))
        approach[i] = state.approach
        tangent[i] = state.tangent
    return approach, tangent
