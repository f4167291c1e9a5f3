"""Radial internal clearance of deep groove ball bearings by bore and class, in um: ISO 5753-1:2009, table 1, cylindrical bore."""

from __future__ import annotations

CLASSES = ("C2", "CN", "C3", "C4", "C5")
# Bore up to and including, mm; least and largest clearance of each class, um. The first row begins above 10 mm.
_FROM = 10.0
_TABLE = (
    (18.0, (0, 9), (3, 18), (11, 25), (18, 33), (25, 45)),
    (24.0, (0, 10), (5, 20), (13, 28), (20, 36), (28, 48)),
    (30.0, (1, 11), (5, 20), (13, 28), (23, 41), (30, 53)),
    (40.0, (1, 11), (6, 20), (15, 33), (28, 46), (40, 64)),
    (50.0, (1, 11), (6, 23), (18, 36), (30, 51), (45, 73)),
    (65.0, (1, 15), (8, 28), (23, 43), (38, 61), (55, 90)),
    (80.0, (1, 15), (10, 30), (25, 51), (46, 71), (65, 105)),
    (100.0, (1, 18), (12, 36), (30, 58), (53, 84), (75, 120)),
    (120.0, (2, 20), (15, 41), (36, 66), (61, 97), (90, 140)),
)


def class_clearance(bore: float, name: str) -> tuple[float, float] | None:
    """Return the least and the largest clearance in m of a class at a bore in m; None where the table has no such bore."""
    if not 1e3 * bore > _FROM:
        return None
    for most, *classes in _TABLE:
        if 1e3 * bore <= most * (1.0 + 1e-12):
            least, largest = classes[CLASSES.index(name)]
            return 1e-6 * least, 1e-6 * largest
    return None
