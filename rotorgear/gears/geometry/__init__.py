"""Involute geometry of gears and pairs, blanks, flanks, outlines, measures."""
