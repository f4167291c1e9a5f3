"""Pictures of a page laid out once, with few ticks: three quarters of the time that matplotlib takes for a logarithmic axis.

matplotlib makes three lines and two texts of each tick, goes through all of them at each measurement of the layout, and reads
a power of ten as a formula. Here the small ticks of an axis are one line of markers, and powers of ten are letters.
"""

from __future__ import annotations

from typing import Any

import numpy as np

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def settle(figure: Any) -> None:
    """Put ticks and axes of a figure where they are to stay; afterwards it is drawn without being laid out again."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    for axes in figure.axes:
        _small_ticks(axes, axes.xaxis, axes.get_xaxis_transform())
        _small_ticks(axes, axes.yaxis, axes.get_yaxis_transform())
    layout = figure.get_layout_engine()
    if layout is not None:
        FigureCanvasAgg(figure)  # which measures letters quickly
        layout.execute(figure)
        figure.set_layout_engine(None)


def _small_ticks(axes: Any, axis: Any, along: Any) -> None:
    """Draw the small ticks of an axis as one line, and name its powers of ten by letters; `along`: its own transform."""
    from matplotlib.lines import Line2D
    from matplotlib.markers import TICKDOWN, TICKLEFT
    from matplotlib.ticker import LogFormatterSciNotation, NullLocator

    form = axis.get_major_formatter()
    if axis.get_scale() == "log" and type(form) is LogFormatterSciNotation:
        axis.set_major_formatter(power_of_ten)
    places = axis.get_minorticklocs()
    # Over less than a decade small ticks have names, which stay.
    if not len(places) or any(axis.get_minor_formatter().format_ticks(places)):
        return
    low, high = sorted(axis.get_view_interval())
    places = places[(places >= low) & (places <= high)]
    edge = np.zeros(len(places))
    x, y = (places, edge) if axis is axes.xaxis else (edge, places)
    look = axis.get_minor_ticks(1)[0].tick1line
    ticks = Line2D(
        x, y, ls="none", marker=TICKDOWN if axis is axes.xaxis else TICKLEFT, color=look.get_color(), transform=along
    )
    ticks.set(markersize=look.get_markersize(), markeredgewidth=look.get_markeredgewidth(), clip_on=False)
    ticks.set_in_layout(False)
    axis.set_minor_locator(NullLocator())
    axes.add_artist(ticks)


def power_of_ten(value: float, _: int | None = None) -> str:
    """A power of ten in letters: 1000 is 10³; any other value as it is."""
    power = round(np.log10(value)) if value > 0.0 else 0
    return f"10{str(power).translate(_RAISED)}" if np.isclose(value, 10.0**power, rtol=1e-9, atol=0.0) else f"{value:g}"
