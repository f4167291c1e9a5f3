"""Periodic motions as solutions of equations: harmonic balance, shooting, arc length, Floquet multipliers, special points."""
