"""Comparison with frequencies measured on a test rig."""
