"""What an analysis does not take of the loads of a model."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np

from rotorgear.model.layout.external_loads import ExternalLoad
from rotorgear.model.parts.load import COMPONENTS
from rotorgear.system.system import System

Analysis = Literal["static", "response", "modes", "frf", "time"]
# The motion that each component of a load works on.
_MOTION = ("bending", "bending", "axial", "bending", "bending", "torsion")


def load_notes(system: System, analysis: Analysis) -> Iterator[str]:
    """Yield a sentence on each part of a load that an analysis leaves out.

    Args:
        system: the model.
        analysis: "modes" stands for modal, campbell and critical, "time" for transient and sweep.
    """
    for load in system.layout.external_loads:
        if dead := _without_motion(system, load):
            yield f"{load.address}: {dead}"
        if analysis == "static":
            yield from _varying_part(load)
        elif analysis == "response" and load.history is not None and load.history.over == "time":
            yield f"{load.address}: its history over time, of which only the values at time 0 act, on the mean state"
        elif analysis in ("modes", "frf"):
            what = (
                "free vibrations have no loads"
                if analysis == "modes"
                else "a frequency response is that to unit forces"
            )
            yield f"{load.address}: {what}; its constant part acts on the equilibrium that nonlinear parts are linear about"
    if analysis != "response":
        return
    from rotorgear.system.local_parts import varying_load

    for item in system.state.applied:
        torque = varying_load(system, item.name)
        if torque is not None and torque.speed_power:
            yield f"{item.name}: how its torque changes with the speed, which transients take"
        if torque is not None and torque.step_to != 1.0:
            yield f"{item.name}: its step in time, which transients take"


def _varying_part(load: ExternalLoad) -> Iterator[str]:
    if load.amplitude.any():
        yield f"{load.address}: it is harmonic and has no constant part; response and transient take it"
    elif load.history is not None:
        taken = "its mean over a turn acts" if load.history.over == "angle" else "its values at time 0 act"
        yield f"{load.address}: what varies of its history; {taken}"


def _without_motion(system: System, load: ExternalLoad) -> str:
    """The components that a model without some motions does not feel, in words."""
    given = (load.constant != 0.0) | (load.amplitude != 0.0)
    if load.history is not None:
        given |= np.isin(COMPONENTS, load.history.components)
    lost = [name for k, name in enumerate(COMPONENTS) if given[k] and not system.model.has(_MOTION[k])]
    return f"{', '.join(lost).replace('_', ' ')}, whose motion is not among those of the model" if lost else ""
