"""Time integration, and the local forces that act in it."""
