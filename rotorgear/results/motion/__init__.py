"""Motions in time: runs, sweeps over a parameter, periodic orbits."""
