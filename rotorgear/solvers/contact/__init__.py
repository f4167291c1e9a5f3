"""Contact across a gap: its kinds, and its one formula for numbers and for lanes."""
