"""Foreign text as a terminal may show it."""

from __future__ import annotations

import re

# Control characters but for the end of a line and the tabulator, and marks that turn the direction of what follows: a terminal
# obeys them, so that a title could write over what stands above it, or into the clipboard.
_OBEYED = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u2028\u2029\u202a-\u202e\u2066-\u2069\ufeff]")


def shown(text: str) -> str:
    """The text with a mark in place of every character that a terminal would obey."""
    return _OBEYED.sub("\ufffd", text)
