"""Equilibrium under constant loads: deflections, forces, load sharing."""
