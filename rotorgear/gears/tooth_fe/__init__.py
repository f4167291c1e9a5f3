"""Tooth compliance by finite elements."""
