"""Response in time."""
