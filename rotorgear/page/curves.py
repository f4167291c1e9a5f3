"""Two curves that only the page has: response to the rules' unbalance, and error against run time of its analyses."""

from __future__ import annotations

from typing import Any

from rotorgear.page.contents import Contents, error_of
from rotorgear.plots.figure import COLOURS, new_figure
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.standards import StandardsResult

# An error of zero has no place on a logarithmic axis.
_LEAST = 1e-13


def draw_unbalance(result: StandardsResult) -> Any:
    """Major axis of the orbit over the speed of the input shaft, a curve for each shaft."""
    axis = new_figure((9.0, 3.8)).subplots()
    rpm = result.curve_speeds * RPM_PER_RAD_S
    for k, (shaft, size) in enumerate(result.curves.items()):
        axis.semilogy(rpm, 1e6 * size, color=COLOURS[k % len(COLOURS)], lw=1.4, label=shaft)
    axis.axvline(result.operating_rpm, color="#444444", lw=0.8, ls="--")
    axis.set_xlabel(f"speed of {result.model.reference_shaft}, rpm")
    axis.set_ylabel("major axis, µm peak to peak")
    axis.grid(True, which="major", alpha=0.25)
    axis.set_xlim(rpm[0], rpm[-1])
    axis.legend(frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=6)
    return axis


def draw_errors(found: Contents) -> Any:
    """Estimated error against CPU seconds; analyses without an estimate are not drawn."""
    axis = new_figure((9.0, 3.4)).subplots()
    for k, (name, result) in enumerate(found.results.items()):
        error = error_of(result)
        if error is None:
            continue
        x = max(found.seconds[name], 1e-3)
        y = max(error, _LEAST)
        axis.plot(x, y, "o", color=COLOURS[k % len(COLOURS)], ms=6)
        axis.annotate(name, (x, y), xytext=(6, 4 if k % 2 else -11), textcoords="offset points", fontsize=9)
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.margins(0.15)
    low, high = axis.get_ylim()
    if high < 100.0 * low:  # at least two decades, so that their ticks are powers of ten
        axis.set_ylim(low / 10.0, high * 10.0)
    axis.set_xlabel("CPU seconds")
    axis.set_ylabel("largest estimated relative error")
    axis.grid(True, which="major", alpha=0.25)
    return axis
