"""Measured frequency responses and order cuts beside a model, as tables."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rotorgear.results.frf_comparison import FrfComparison, OrderComparison
from rotorgear.results.tables.common import heading, lines, notes_of, table

if TYPE_CHECKING:
    from rich.console import RenderableType


def compare_frf_table(result: FrfComparison) -> RenderableType:
    """What `rotorgear compare --frf` prints."""
    from rich.console import Group

    pairs = table("response", "force", "FRAC", "of sizes", "model/rig", left=2)
    for pair in result.pairs:
        pairs.add_row(pair.response, pair.reference, f"{pair.frac:.3f}", f"{pair.size_frac:.3f}", f"{pair.ratio:.3g}")
    hz = result.frequency_hz
    said = [
        f"Mean FRAC {result.mean_frac:.3f} over {len(hz)} frequencies, {hz[0]:.5g} to {hz[-1]:.5g} Hz.",
        *result.verdicts,
    ]
    said += notes_of(result)
    parts: list[Any] = [heading(result.title)] if result.title else []
    return Group(*parts, pairs, *lines("", *said))


def compare_orders_table(result: OrderComparison) -> RenderableType:
    """What `rotorgear compare --orders` prints."""
    from rich.console import Group

    cuts = table("point", "order", "model/rig", "correlation", "peak: rig", "model", left=2)
    for cut in result.cuts:
        cuts.add_row(
            cut.point,
            cut.order,
            f"{cut.level_db:+.1f} dB",
            f"{cut.correlation:.2f}",
            f"{cut.rig_peak_rpm:.0f} rpm",
            f"{cut.model_peak_rpm:.0f} rpm",
        )
    said = [f"No order of the model: {', '.join(result.without)}."] if result.without else []
    said += notes_of(result)
    parts: list[Any] = [heading(result.title)] if result.title else []
    return Group(*parts, cuts, *lines("", *said))
