"""Draws frequency responses: size on a logarithmic scale and phase below."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.plots.figure import COLOURS, figure_for, label, name_axes, plain_axis
from rotorgear.results.frequency_response import FrequencyResponse


def frf(result: FrequencyResponse, fig: Any = None, *, quantity: str = "receptance") -> np.ndarray:
    """Draw frequency responses: size on a logarithmic scale above, phase below.

    Args:
        result: responses between places.
        fig: figure to draw on; a new one for None.
        quantity: "receptance", "mobility" or "accelerance".

    Returns:
        Both axes.

    Raises:
        AnalysisError: no such quantity. MissingExtraError: matplotlib is not installed.
    """
    figure = figure_for(fig, (9.0, 6.0), result.model.title or "Frequency response")
    size, phase = figure.subplots(2, 1, sharex=True, height_ratios=[2.4, 1.0])
    values = result.of(quantity)
    pairs = [(o, i) for i in range(len(result.inputs)) for o in range(len(result.outputs))]
    for number, (o, i) in enumerate(pairs):
        colour = COLOURS[number % len(COLOURS)]
        style = ("-", "--", ":")[number // len(COLOURS) % 3]
        name = f"{result.inputs[i]} to {result.outputs[o]}"
        size.semilogy(result.frequency_hz, np.abs(values[:, o, i]), color=colour, ls=style, lw=1.3, label=name)
        phase.plot(result.frequency_hz, np.degrees(np.angle(values[:, o, i])), color=colour, ls=style, lw=1.0)
    units = dict.fromkeys(result.unit(o, i, quantity) for o, i in pairs)
    name_axes(size, "", f"{quantity}, {', '.join(units)}", legend=1)
    name_axes(phase, label(result, "frequency_hz"), "phase, deg")
    phase.set_ylim(-190, 190)
    phase.set_yticks([-180, -90, 0, 90, 180])
    for axis in (size, phase):
        plain_axis(axis)
    return np.array([size, phase])
