"""Places of sensors as a table."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rotorgear.results.sensors import SensorPlan
from rotorgear.results.tables.common import heading, lines, notes_of, table

if TYPE_CHECKING:
    from rich.console import RenderableType


def sensors_table(result: SensorPlan) -> RenderableType:
    """What `rotorgear sensors` prints."""
    from rich.console import Group

    rows = table("place", "node", "along", "x mm", "y mm", "z mm", "independence")
    for sensor in result.sensors:
        where = (f"{1e3 * value:.1f}" for value in sensor.position)
        rows.add_row(sensor.place, str(sensor.node), sensor.direction, *where, f"{sensor.independence:.2f}")
    hz = result.mode_hz
    said = [
        f"{len(result.sensors)} of {result.candidates} places and directions for {len(hz)} modes, {hz[0]:.5g} to "
        f"{hz[-1]:.5g} Hz. Largest MAC of two of them: {result.worst:.2f}, with all places {result.all_auto_mac:.2f}.",
        *result.confused,
    ]
    said += notes_of(result)
    parts: list[Any] = [heading(result.title)] if result.title else []
    return Group(*parts, rows, *lines("", *said))
