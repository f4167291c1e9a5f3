"""Where the rows of a rolling bearing stand, and the sides that they press to.

A row of the side +1 takes a push of the shaft towards +z; its lines of contact run outward and towards +z, so that they meet
the axis on the side of -z. In O arrangement (back to back) the two rows meet it outside of the pair, which then resists tilting
most, in X arrangement (face to face) inside; in tandem both take the same push.
"""

from __future__ import annotations


def rows_of(arrangement: str, distance: float) -> tuple[tuple[float, float], ...]:
    """Place along the shaft from the middle of the bearing in m, and side, of each row.

    Args:
        arrangement: "single", "O", "X", "tandem" or "four-point". distance: of the two rows of a pair in m.
    """
    half = 0.5 * distance
    return {
        "single": ((0.0, 1.0),),
        "O": ((-half, 1.0), (half, -1.0)),
        "X": ((-half, -1.0), (half, 1.0)),
        "tandem": ((-half, 1.0), (half, 1.0)),
        "four-point": ((0.0, 1.0), (0.0, -1.0)),
    }[arrangement]
