"""Loaded tooth contact: positions, compliance, load distribution over the mesh cycle."""
