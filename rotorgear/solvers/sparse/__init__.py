"""Sparse factors, null spaces, equilibrium of linear systems."""
