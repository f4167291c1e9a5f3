"""Forced response over speed and over frequency."""
