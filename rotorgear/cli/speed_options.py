"""Options of the commands that look over a range of speeds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from rotorgear.cli.common import parse_speed
from rotorgear.errors import AnalysisError

if TYPE_CHECKING:
    import numpy as np

    from rotorgear.model.model import Model

FromOption = Annotated[str, typer.Option("--from", help="Lowest speed of the input shaft, such as '500 rpm'.")]
ToOption = Annotated[
    str | None,
    typer.Option("--to", help="Highest speed (default 1.25 times the operating speed).", show_default=False),
]


def speeds_between(model: Model, start: str, stop: str | None, points: int) -> np.ndarray:
    """Evenly spaced speeds in rad/s."""
    from rotorgear.analysis.campbell.speeds import highest_speed, speed_range

    low = parse_speed(start)
    assert low is not None
    return speed_range(low, highest_speed(model, parse_speed(stop)), points)


def parse_orders(text: str | None, option: str, default: tuple[float, ...]) -> tuple[float, ...]:
    """Positive numbers from a text such as "1,2,0.5"; "none" for no orders."""
    if text is None:
        return default
    if text.strip() in ("", "none"):
        return ()
    try:
        found = tuple(float(part) for part in text.split(","))
    except ValueError:
        found = (-1.0,)
    if any(not 0.0 < order < float("inf") for order in found):
        raise AnalysisError(f"{option}: got '{text}', expected positive numbers such as 1,2,3 (or none)")
    return found
