"""Draws the stress in the root fillets of both gears while a tooth passes through the mesh."""

from __future__ import annotations

from typing import Any

from rotorgear.plots.figure import axes_for
from rotorgear.results.root_stress import RootStress

_COLOURS = ("#1f5fa8", "#b3541e")


def root_stress(result: RootStress, ax: Any = None) -> Any:
    """Draw the largest principal stress at the 30 degree tangent, and the largest of the fillet.

    Args:
        result: root stresses over the mesh cycle.
        ax: axes to draw on; those of a new figure for None.

    Returns:
        The axes.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    axis = axes_for(ax, (8.0, 4.6), f"{result.mesh}: {result.pinion_torque_n_m:.5g} N m on the pinion")
    for gear, colour in zip(result.gears, _COLOURS, strict=True):
        axis.plot(gear.phase, 1e-6 * gear.largest, color=colour, lw=1.6, label=f"{gear.name}, largest of the fillet")
        axis.plot(
            gear.phase, 1e-6 * gear.at_tangent, color=colour, lw=1.2, ls="--", label=f"{gear.name}, 30 deg tangent"
        )
        if gear.nominal is not None:
            axis.axhline(1e-6 * gear.nominal, color=colour, lw=0.8, ls=":", label=f"{gear.name}, nominal by ISO 6336-3")
    axis.axvline(0.0, color="#777777", lw=0.8)
    axis.set_xlabel("mesh periods from contact at the pitch point")
    axis.set_ylabel("largest principal stress, MPa")
    axis.grid(True, alpha=0.25)
    axis.legend(frameon=False, fontsize=8)
    return axis
