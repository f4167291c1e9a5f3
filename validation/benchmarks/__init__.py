"""Benchmarks: error against run time."""
