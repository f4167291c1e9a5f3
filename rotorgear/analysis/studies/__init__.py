"""Convergence studies: each analysis over a series of its discretisations, against a reference."""
