"""What results tell of planetary motions: their classes, and what a carrier that turns sees of them, over modes or branches."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from rotorgear.results.schema import of
from rotorgear.results.table import Column, exact


def classes_over(axis: str, note: str) -> Any:
    """Declare the classes, in words."""
    return of("classes of a planetary mode", "", axis, note=note, column="class", default=())


def class_energy_over(*axes: str) -> Any:
    """Declare the shares of the classes of all stages by their names."""
    return of(
        "share of a class in the kinetic energy",
        "",
        "CLASS",
        *axes,
        note=" of a planetary stage, such as `stage rotational`: what is missing from 1 moves elsewhere",
        default_factory=dict,
    )


def carrier_frequency_over(*axes: str) -> Any:
    """Declare the frequencies in the frame of each carrier."""
    return of(
        "frequency in the frame of a carrier",
        "Hz",
        "CARRIER",
        *axes,
        note=" that turns, of the part with the most energy; `null`: its stage rests",
        default_factory=dict,
    )


def carrier_share_over(*axes: str) -> Any:
    """Declare the shares of what each carrier sees at these frequencies."""
    return of(
        "share of what a carrier sees at that frequency",
        "",
        "CARRIER",
        *axes,
        note=", in the kinetic energy of its stage",
        default_factory=dict,
    )


def carrier_columns(frequency: dict[str, np.ndarray], share: dict[str, np.ndarray]) -> list[Column]:
    """Columns of the frequencies (m,) of m modes in the frame of each carrier, with the share (m,) where that is not all."""

    def seen(carrier: str, k: int) -> str:
        text = exact(".4f")(frequency[carrier][k])
        return f"{text}, {100.0 * share[carrier][k]:.0f} %" if share[carrier][k] < 0.995 else text

    return [Column(f"from {carrier} Hz", partial(seen, carrier), left=False) for carrier in frequency]
