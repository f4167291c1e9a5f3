"""Derivatives of modes with respect to numbers of a model, and energies and modes over a few shapes."""
