"""Harmonic solutions and receptances."""
