"""Gear sheets and loaded teeth over the mesh cycle."""
