"""Numerics floor: arrays in, arrays out. Factors, eigenvalues, statics, time and frequency solvers."""
