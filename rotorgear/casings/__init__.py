"""Elastic bodies from finite-element meshes: read, assembled, and reduced to the motions of their seats and a few modes."""
