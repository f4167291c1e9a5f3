"""Comparison with test rigs, updating by them, places of sensors."""
