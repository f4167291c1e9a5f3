"""A state space as text for the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.tables.common import error_words, heading, lines, notes_of, table

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.state_space import StateSpace


def state_space_table(result: StateSpace) -> RenderableType:
    """Return inputs and outputs with their units, the size, and how far the reduction is off."""
    from rich.console import Group

    turns = result.speed * RPM_PER_RAD_S
    speed = f"{result.model.reference_shaft} at {turns:.6g} rpm" if result.speed else "at standstill"
    out = table("kind", "place", "unit", left=3)
    for kind, places, units in (
        ("input", result.inputs, result.input_units),
        ("output", result.outputs, result.output_units),
    ):
        for place, unit in zip(places, units, strict=True):
            out.add_row(kind, place, unit)
    size = f"{2 * result.size} states"
    if result.reduced:
        size += f": {result.kept_modes} modes and {result.size - result.kept_modes} other shapes of {result.dofs} dofs"
        changed = error_words(result.reduction_error)
        error = f"the reduction changes responses up to {result.fmax:.6g} Hz by {changed} of their largest (estimated)"
    else:
        size += f", twice the {result.dofs} dofs: nothing is reduced"
        error = f"for frequencies up to {result.fmax:.6g} Hz"
    notes = [
        f"{size}; {result.seconds['total']:.2f} s",
        error,
        *notes_of(result),
    ]
    return Group(heading(f"{result.model.title or 'Model'}: state space, {speed}"), "", out, "", *lines(*notes))
