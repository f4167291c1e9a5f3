"""Kinds of contact across a gap and of its damping, as integers that compiled code may branch on. Needs no compiler."""

# Two sides with a symmetric dead zone between them; one side that pushes only; a bilateral contact, which never parts.
DEAD_ZONE = 0
UNILATERAL = 1
BILATERAL = 2
# Damping that never makes the sides pull (non-adhesive); that may pull while they touch (adhesive); that grows with penetration
# and never pulls.
NON_ADHESIVE = 0
ADHESIVE = 1
PENETRATION = 2
