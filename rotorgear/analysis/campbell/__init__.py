"""Modes over speed: Campbell diagrams, crossings, critical speeds."""
