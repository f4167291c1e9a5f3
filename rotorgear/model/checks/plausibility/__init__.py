"""Values that the physics of a machine makes unlikely."""
