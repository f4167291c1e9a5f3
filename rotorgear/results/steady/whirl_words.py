"""The senses of whirl in words; results hold numbers into this tuple, "" for torsional and axial modes, which don't whirl."""

from __future__ import annotations

WHIRL_WORDS = ("", "forward", "backward", "mixed", "planar")
