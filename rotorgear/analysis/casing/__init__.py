"""Casings by themselves."""
