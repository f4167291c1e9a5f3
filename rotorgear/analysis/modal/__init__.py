"""Natural frequencies and mode shapes, with what moves and how accurate they are."""
