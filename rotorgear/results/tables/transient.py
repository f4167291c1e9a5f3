"""The transient result as tables for the terminal."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.tables.common import TRANSMISSION_WORDS, notes_of

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.transient import TransientResult


# Channels that are kept, saved and drawn, but not listed.
_UNSHOWN = ("gears.",)
# Below this share of the largest component of its vector a component is what rounding and iterations leave of a zero.
_ROUNDING = 1e-9


def transient_table(result: TransientResult) -> RenderableType:
    """Return contacts, channels and notes as one rich renderable that fits 80 columns."""
    from rich.console import Group
    from rich.table import Table
    from rich.text import Text

    rpm = [f"{w * RPM_PER_RAD_S:.5g}" for w in (result.speed[0], result.speed[-1])]
    turns = rpm[0] if rpm[0] == rpm[1] else f"{rpm[0]} to {rpm[1]}"
    counted = f"{result.time[-1] - result.settle:.4g} s after {result.settle:.4g} s"
    if result.time[-1] <= result.settle:
        counted = (
            f"ended at {result.time[-1]:.4g} s, before the {result.settle:.4g} s that are discarded: nothing counts"
        )
    title = f"{result.model.title or 'Transient'}: {result.model.reference_shaft} at {turns} rpm, {counted}"
    contacts = Table(box=None, pad_edge=False, collapse_padding=True, header_style="bold")
    contacts.add_column("contact", overflow="fold")
    heads = ("static\nN", "mean", "rms", "largest", "K_dyn", "TE\num", "appr.\num", "loss\n%", "coast\n%", "losses")
    for name in heads:
        contacts.add_column(name, justify="right", no_wrap=True)
    for row in result.contacts:
        contacts.add_row(
            row.name,
            _value(row.static_force_n),
            _value(row.mean_force_n),
            _value(row.rms_force_n),
            _value(row.largest_force_n),
            f"{row.dynamic_factor:.3f}" if math.isfinite(row.dynamic_factor) else "-",
            _micrometres(row.peak_to_peak_transmission_error_m),
            _micrometres(row.peak_to_peak_approach_m),
            _percent(row.apart_share),
            _percent(row.back_share),
            str(row.losses),
        )
    parts: list[RenderableType] = [Text(title, style="bold"), contacts, Text("")]
    if result.channel:
        parts.append(_channels(result))
    notes = [
        "",
        *((f"TE: {TRANSMISSION_WORDS}; both peak to peak",) if result.contact else ()),
        f"{result.dofs} dofs, {result.steps} steps of {result.step:.4g} s, {result.seconds['total']:.2f} s; {result.method} "
        f"({result.reason})",
    ]
    if result.error_estimate == result.error_estimate:
        more_modes = ", and one of more modes" if "modes with" in result.method else ""
        notes.append(f"error: statistics within {result.error_estimate:.1e}, from a run of twice the step{more_modes}")
    notes.append(f"energy error: {result.energy.share:.1e} of the largest term")
    notes += notes_of(result)
    return Group(*parts, *(Text(note) for note in notes), "")


def _channels(result: TransientResult) -> Any:
    from rich.table import Table

    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column("channel", overflow="fold")
    for name in ("mean", "rms", "largest", "smallest"):
        table.add_column(name, justify="right")
    table.add_column("unit")
    shown = [row for row in result.channels if not row.name.startswith(_UNSHOWN)]
    scale: dict[str, float] = {}
    for row in shown:
        vector = row.name.rpartition(" ")[0] or row.name
        sizes = [abs(value) for value in (row.largest, row.smallest) if math.isfinite(value)]
        scale[vector] = max([scale.get(vector, 0.0), *sizes])
    for row in shown:
        if row.name.startswith("bearings.") and " displacement " in row.name:
            continue
        least = _ROUNDING * scale[row.name.rpartition(" ")[0] or row.name]
        values = (getattr(row, key) for key in ("mean", "rms", "largest", "smallest"))
        cells = ("0" if abs(value) < least else _value(value) for value in values)
        table.add_row(row.name.partition(".")[2], *cells, row.unit)
    return table


def _micrometres(length: float) -> str:
    return f"{1e6 * length:.2f}" if math.isfinite(length) else "-"


def _percent(share: float) -> str:
    return f"{100.0 * share:.1f}" if math.isfinite(share) else "-"


def _value(value: float) -> str:
    """Four digits, without an exponent where that is as short."""
    if not math.isfinite(value):
        return "-"
    return f"{value:.0f}" if 1e3 <= abs(value) < 1e6 else f"{value:.4g}"
