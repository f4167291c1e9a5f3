"""Frequency responses as a table for the terminal, 80 columns wide."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.tables.common import error_words, heading, lines, notes_of, table

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.frequency_response import FrequencyResponse

# So many peaks of each response are listed.
_PEAKS = 6


def frf_table(result: FrequencyResponse, *, quantity: str = "receptance") -> RenderableType:
    """Return title, the highest peaks of each response, and notes, of receptance, mobility or accelerance."""
    from rich.console import Group

    hz = result.frequency_hz
    title = f"{result.model.title or 'Model'}: {quantity}, {hz[0]:.6g} to {hz[-1]:.6g} Hz"
    speed = (
        f", {result.model.reference_shaft} at {result.speed * RPM_PER_RAD_S:.6g} rpm"
        if result.speed
        else ", at standstill"
    )
    out = table("force at", "response at", "peak Hz", quantity, "unit", left=2)
    coarse = False
    for i, entry in enumerate(result.inputs):
        for o, place in enumerate(result.outputs):
            for peak in result.peaks(o, i, quantity)[:_PEAKS]:
                coarse |= not peak.resolved
                sign = "" if peak.resolved else "> "
                out.add_row(
                    entry, place, f"{peak.frequency_hz:.2f}", f"{sign}{peak.size:.3e}", result.unit(o, i, quantity)
                )
    notes = [
        f"{len(hz)} frequencies, {result.dofs} dofs, {result.seconds['total']:.2f} s; {result.method}",
        f"residual {error_words(result.residual)} of the forces inside; on a finer mesh the peaks change by "
        f"{error_words(result.error_estimate)}",
        f"damping ratio added to every elastic mode: {result.damping_ratio:g}",
        *(["> the peak is narrower than a step of the frequencies, and higher than at any of them"] if coarse else []),
        *notes_of(result),
    ]
    return Group(heading(f"{title}{speed}"), "", out, "", *lines(*notes), "")
