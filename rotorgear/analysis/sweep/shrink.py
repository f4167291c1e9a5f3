"""The points of a sweep that are too large for its kernel, reduced model by model."""

from __future__ import annotations

from collections.abc import Sequence

from rotorgear.analysis.sweep.point import Point, ready_reduced
from rotorgear.analysis.sweep.reduce import Large, Reducer, Wanted
from rotorgear.errors import RotorgearError
from rotorgear.progress import Progress
from rotorgear.results.sweep import Reduction


def shrunk(
    points: Sequence[Point | Large | None], failure: Sequence[str], wanted: Wanted, progress: Progress, share: float
) -> tuple[list[Point | None], list[str], Reduction | None]:
    """Return the points with the large ones reduced, why points failed, and what was reduced.

    Args:
        points: in their order; those that failed are None. failure: why.
        wanted: what a reduction must reach. progress: is told `share` all the time, and how far a basis is.
    """
    groups: dict[bytes, list[int]] = {}
    for i, point in enumerate(points):
        if isinstance(point, Large):
            groups.setdefault(point.key, []).append(i)
    done: list[Point | None] = [None if isinstance(point, Large) else point for point in points]
    reasons = list(failure)
    reducer = Reducer(wanted)
    for number, members in enumerate(groups.values()):
        own = [point for point in (points[i] for i in members) if isinstance(point, Large)]
        text = f"basis {number + 1} of {len(groups)}: " if len(groups) > 1 else "basis: "

        def heard(size: int, error: float, text: str = text) -> None:
            progress(share, f"{text}{size} coordinates, {100.0 * error:.2g} % off")

        try:
            for i, large, found in zip(members, own, reducer(own, heard), strict=True):
                done[i] = ready_reduced(large, found)
        except RotorgearError as error:
            for i in members:
                done[i] = None
                reasons[i] = str(error)
    return done, reasons, reducer.summary
