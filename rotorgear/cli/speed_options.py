"""Options of the commands that look over a range of speeds."""

from __future__ import annotations

from typing import Annotated

import typer

from rotorgear.errors import AnalysisError

FromOption = Annotated[
    str | None,
    typer.Option(
        "--from",
        help="Lowest speed of the input shaft (default 0 rpm; with oil films the lowest at which they carry).",
        show_default=False,
    ),
]
ToOption = Annotated[
    str | None,
    typer.Option("--to", help="Highest speed (default 1.25 times the operating speed).", show_default=False),
]


def parse_orders(text: str | None, option: str, default: tuple[float, ...]) -> tuple[float, ...]:
    """Positive numbers from a text such as "1,2,0.5"; "none" for no orders."""
    if text is None:
        return default
    if text.strip() in ("", "none"):
        return ()
    try:
        orders = tuple(float(part) for part in text.split(","))
    except ValueError:
        orders = (-1.0,)
    if any(not 0.0 < order < float("inf") for order in orders):
        raise AnalysisError(f"{option}: got '{text}', expected positive numbers such as 1,2,3 (or none)")
    return orders


def parse_mesh_orders(text: str | None, default: tuple[int, ...]) -> list[int]:
    """Whole numbers of --mesh-orders: between its harmonics a mesh excites nothing."""
    orders = parse_orders(text, "--mesh-orders", default)
    if any(order != int(order) for order in orders):
        raise AnalysisError(f"--mesh-orders: got '{text}', expected whole numbers such as 1,2,3")
    return [int(order) for order in orders]
