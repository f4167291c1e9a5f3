"""Eigenvalue problems: symmetric, damped, over a parameter."""
