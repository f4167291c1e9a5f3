"""Gears by themselves: involute geometry, blanks, tooth stiffness. Nothing here knows of degrees of freedom."""
