"""Measured shapes, frequency responses and order cuts beside a model, as tables."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from rotorgear.results.comparison import learnt_words
from rotorgear.results.correlation import ShapeComparison
from rotorgear.results.tables.common import heading, lines, notes_of, table

if TYPE_CHECKING:
    from rich.console import RenderableType


def compare_shapes_table(result: ShapeComparison) -> RenderableType:
    """What `rotorgear compare --shapes` prints."""
    from rich.console import Group

    modes = table("rig Hz", "mode", "model Hz", "error", "MAC", "phase", "", left=0)
    for match in result.matches:
        close = "with " + ", ".join(str(k) for k in match.close_to) if match.close_to else ""
        modes.add_row(
            f"{match.rig.frequency_hz:.2f}",
            str(match.mode_number),
            f"{match.mode_frequency_hz:.2f}",
            f"{match.error_percent:+.2f} %",
            "-" if math.isnan(match.mac) else f"{match.mac:.3f}",
            f"{match.phase_collinearity:.2f}",
            close,
        )
    said = list(result.verdicts)
    for group in result.subspaces:
        numbers = " and ".join(str(k) for k in group.mode_numbers)
        angles = ", ".join(f"{57.29577951308232 * angle:.1f}" for angle in group.angles)
        said.append(
            f"Modes {numbers} are too close to be told apart: principal angles to the measured plane {angles} degrees."
        )
    if result.unmatched:
        said.append(f"Without a mode: {', '.join(f'{line.frequency_hz:.1f}' for line in result.unmatched)} Hz.")
    if result.stiffnesses:
        said.append(learnt_words(result.stiffnesses, len(result.matches), "matched lines"))
    said += notes_of(result)
    parts: list[Any] = [heading(result.title)] if result.title else []
    return Group(*parts, modes, *lines("", *said))
