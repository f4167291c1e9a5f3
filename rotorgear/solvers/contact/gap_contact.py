"""Compiled: contact of two sides across a gap, once for all solvers: static and time integration, lanes and trajectories.

    x: approach of the front sides     front side: depth = x        back side: depth = -x - clearance
    F = side [k depth + c s(depth) depth'],    s = min(depth/regularisation, 1), or depth/reference for penetration damping

The functions take numbers or lanes of numbers (solvers/contact/vectors.py) and have no branches over either: only kinds and
modes, which are equal in all lanes, may branch. They are compiled into their callers. Lanes branch over the kind themselves and
call `tied_contact` or `gap_contact`: seven numbers in 32 lanes that come from either of two branches fill all vector registers,
which cost 5 to 8 % of a sweep. The reciprocal 1/depth comes from outside,
for lanes don't divide; a unilateral contact has a clearance without end.
Kahraman and Singh, J. Sound Vib. 142 (1990) 49; Hunt and Crossley, J. Applied Mechanics 42 (1975) 440.
"""

from __future__ import annotations

from collections import namedtuple

from rotorgear.solvers.contact.kinds import ADHESIVE, BILATERAL, PENETRATION
from rotorgear.solvers.contact.vectors import formula, larger, smaller, where_positive

# Of a contact: its force; the tangents of that in x and x'; the part of the tangent in x that comes from the growth of the
# damping with depth; the side that touches (1, -1, or 0 apart), the penetration there, and the damper's share of the force there.
Contact = namedtuple("Contact", "force stiffness damping growth side depth resisted")
# Of the damping: the integral of s over x, s itself, and the side that touches.
Momentum = namedtuple("Momentum", "integral share side")


@formula
def penetration(clearance, x):
    """The side that touches and its penetration depth, 0 where both are apart."""
    behind = -x - clearance
    side = where_positive(x, 1.0, where_positive(behind, -1.0, 0.0))
    return side, larger(larger(x, behind), 0.0)


@formula
def contact(kind, mode, k, c, clearance, per_depth, x, rate):
    """Force and tangents of a contact at the approach x and its rate; see solvers/contact/kinds.py for kinds and modes."""
    if kind == BILATERAL:
        return tied_contact(k, c, x, rate)
    return gap_contact(mode, k, c, clearance, per_depth, x, rate)


@formula
def tied_contact(k, c, x, rate):
    """A bilateral contact, which never parts."""
    return Contact(k * x + c * rate, k, c, 0.0 * c, where_positive(x, 1.0, 1.0), x, c * rate)


@formula
def gap_contact(mode, k, c, clearance, per_depth, x, rate):
    """Two sides across a dead zone, or one side that pushes only."""
    side, depth = penetration(clearance, x)
    closing = side * rate
    share = depth * per_depth
    slope = per_depth
    if mode != PENETRATION:
        slope = where_positive(1.0 - share, per_depth, 0.0)
        share = smaller(share, 1.0)
    elastic = k * depth
    viscous = c * share * closing
    total = elastic + viscous
    holds = side * side
    if mode != ADHESIVE:
        # The sides let go rather than pull. A condition, not a largest of viscous and -elastic, which would leave rounding.
        holds = where_positive(total, holds, 0.0)
    damping = holds * c * share
    growth = holds * (c * slope * closing)
    resisted = where_positive(holds, viscous, -elastic)
    return Contact(side * (holds * total), holds * k + growth, damping, growth, side, depth, resisted)


@formula
def curve_contact(mode, elastic, stiffness, damping, growth, x, rate):
    """One side that pushes by a curve: its elastic force at x and the tangent of that, its damping there and how that grows."""
    viscous = damping * rate
    total = elastic + viscous
    side = where_positive(x, 1.0, 0.0)
    holds = side
    if mode != ADHESIVE:
        holds = where_positive(total, holds, 0.0)
    bend = holds * growth * rate
    resisted = where_positive(holds, viscous, -elastic)
    return Contact(
        holds * total, holds * stiffness + bend, holds * damping, bend, side, larger(x, 0.0), side * resisted
    )


@formula
def momentum(clearance, regularisation, per_depth, x):
    """What damping takes up of the momentum for c = 1 on the way to x, whatever the rate: G = int s dx."""
    side, depth = penetration(clearance, x)
    share = smaller(depth * per_depth, 1.0)
    return Momentum(side * share * (depth - 0.5 * share * regularisation), share, side)
