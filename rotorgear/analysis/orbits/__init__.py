"""Periodic motions as objects: branches over a parameter, their stability, and special points."""
