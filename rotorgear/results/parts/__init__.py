"""Sheets of single parts: gears and their meshes, bearings, casings."""
