"""Forced responses as tables for the terminal, 80 columns wide."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np

from rotorgear.results.tables.common import TRANSMISSION_WORDS, error_words, heading, lines, notes_of, table

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.response import ResponseResult


# Rows of a run of orders before the rest of it shares one.
_SHOWN = 5
_SHORT = {"transmission error": "transm. error"}


def response_table(result: ResponseResult) -> RenderableType:
    """Return title, tables of the largest values and notes as one rich renderable."""
    from rich.console import Group

    first = result.speed_rpm[0]
    last = result.speed_rpm[-1]
    speeds = f"{first:.6g} rpm" if len(result.speeds) == 1 else f"{first:.6g} to {last:.6g} rpm"
    title = f"{result.model.title or 'Model'}: forced response, {result.model.reference_shaft} at {speeds}"
    orders = table("no", "order", "times input", f"Hz at {abs(last):.6g} rpm", left=2)
    for first_one, last_one in _rows_of_orders(result.orders):
        ends = dict.fromkeys((first_one, last_one))
        orders.add_row(
            " to ".join(str(o + 1) for o in ends),
            " to ".join(result.orders[o] if o == first_one else result.orders[o].rpartition(" ")[2] for o in ends),
            " to ".join(f"{result.ratio[o]:.6g}" for o in ends),
            " to ".join(f"{result.frequency_hz[o, -1]:.2f}" for o in ends),
        )
    notes = [
        *((TRANSMISSION_WORDS,) if result.contact_mesh else ()),
        "amplitudes are half of peak to peak, each order by itself; forces without their mean",
        f"{len(result.speeds)} speeds, {result.dofs} dofs, {result.seconds['total']:.2f} s; {result.method}",
        f"solver error {error_words(result.solver_error)} at {result.checked} points checked; "
        f"on a finer mesh the peaks change by {error_words(result.error_estimate)}",
        f"damping ratio added to every elastic mode: {result.damping_ratio:g}",
        *_radiated(result),
        *notes_of(result),
    ]
    return Group(heading(title), "", orders, "", _largest(result), "", *lines(*notes), "")


def _radiated(result: ResponseResult) -> Iterator[str]:
    """The largest equivalent radiated power of each casing, all orders together."""
    for k, name in enumerate(result.casings):
        power = result.radiated_power[:, :, k].sum(axis=0)
        s = int(np.argmax(power))
        if power[s] > 0.0:
            yield (
                f"casing {name}: equivalent radiated power of all orders {power[s]:.3g} W at most, "
                f"{10.0 * np.log10(power[s] / 1e-12):.1f} dB, at {result.speed_rpm[s]:.1f} rpm"
            )


def _rows_of_orders(orders: tuple[str, ...]) -> list[tuple[int, int]]:
    """First and last number of each row of the table of orders: a long run of high orders of one part shares a row."""
    rows: list[tuple[int, int]] = []
    start = 0
    for _, group in groupby(order.rpartition(" ")[0] for order in orders):
        end = start + len(list(group))
        shown = start + _SHOWN if end - start > 2 * _SHOWN else end
        rows += [(o, o) for o in range(start, shown)]
        rows += [(shown, end - 1)] if shown < end else []
        start = end
    return rows


def _largest(result: ResponseResult) -> Any:
    """The largest amplitude of each quantity, the order, speed and frequency of it, and what is left out of it."""
    loaded = any(peak.left_out is not None or peak.teeth_part for peak in result.largest)
    columns = ("largest of", "", "order no", "rpm", "Hz", "amplitude", *(("left out",) if loaded else ()))
    out = table(*columns, left=2)
    for peak in result.largest:
        factor, unit = (1e6, "um") if peak.unit == "m" else (1.0, peak.unit.replace("^", ""))
        left = "-" if peak.left_out is None else f"{factor * peak.left_out:.2g} {unit}"
        out.add_row(
            _SHORT.get(peak.quantity, peak.quantity),
            peak.part,
            str(peak.order + 1),
            f"{peak.speed_rpm:.1f}",
            f"{peak.frequency_hz:.1f}",
            f"{factor * peak.amplitude:.4g} {unit}",
            *((("teeth part" if peak.teeth_part else left),) if loaded else ()),
        )
    return out
