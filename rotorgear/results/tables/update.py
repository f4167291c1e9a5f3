"""The update of a model by a rig as tables: numbers before and after, lines with what was held out, and what it is worth."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rotorgear.results.comparison import learnt_words
from rotorgear.results.tables.common import heading, lines, notes_of, table
from rotorgear.results.update import UpdateResult

if TYPE_CHECKING:
    from rich.console import RenderableType


def update_table(result: UpdateResult) -> RenderableType:
    """What `rotorgear update` prints."""
    from rich.console import Group

    numbers = table("number", "prior", "times", "after", "learnt", "")
    for row in result.parameters:
        cells = (
            f"±{100 * row.prior:.3g} %",
            f"{row.factor:.4f}",
            f"±{100 * row.sigma:.2g} %",
            f"{100 * row.learnt:.0f} %",
        )
        numbers.add_row(row.address, *cells, "" if row.identified else "not identified")
    shapes = bool(result.points)
    several = any(line.campaign for line in result.lines)
    extra = ("MAC before", "after") if shapes else ()
    modes = table(
        *(("campaign",) if several else ()), "rig Hz", "mode", "before", "after", "held out", *extra, left=int(several)
    )
    for line in result.lines:
        f = line.rig.frequency_hz
        errors = (f"{100 * (hz / f - 1.0):+.2f} %" for hz in (line.before_hz, line.after_hz, line.held_out_hz))
        alike = ("-" if value is None else f"{value:.3f}" for value in (line.mac_before, line.mac_after))
        name = (line.campaign,) if several else ()
        modes.add_row(*name, f"{f:.2f}", str(line.mode_number), *errors, *(alike if shapes else ()))
    answers = table("response over force", "FRAC before", "after", "held out")
    for one in result.responses:
        pair = f"{one.campaign}: " * bool(one.campaign) + f"{one.response} over {one.reference}"
        fracs = (one.frac_before, one.frac_after, one.frac_held_out)
        answers.add_row(pair, *(f"{value:.3f}" for value in fracs))
    what = "measured values" if shapes or result.responses else "matched lines"
    said = [learnt_words(result.parameters, result.measured_values, what), *result.findings]
    unmatched = ", ".join(f"{line.frequency_hz:.1f}" for line in result.unmatched)
    said += [f"Without a mode: {unmatched} Hz."] if unmatched else []
    said += notes_of(result)
    said += [f"{result.modal_solutions} modal solutions of {result.dofs} dofs."]
    parts: list[Any] = [heading(result.title)] if result.title else []
    compared = [modes] if result.lines else []
    compared += [*(lines("") if compared else ()), answers] if result.responses else []
    return Group(*parts, numbers, *lines(""), *compared, *lines("", *said))
