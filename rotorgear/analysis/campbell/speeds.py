"""Speeds of the input shaft that an analysis is asked for, and the mesh that the modes at both ends of a range need."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from rotorgear.analysis.common.discretise import cut_of
from rotorgear.analysis.common.excitation import excitation_orders
from rotorgear.analysis.common.request import check_whole, speed_in_si
from rotorgear.analysis.modal.modal import ModalRequest, modes_about
from rotorgear.analysis.modal.mode_count import expected_modes
from rotorgear.analysis.static.state_at import linear_system
from rotorgear.errors import AnalysisError
from rotorgear.model.layout.state import State
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.system.plan import PieceKey, Plan
from rotorgear.system.system import System, flow_system

DEFAULT_SPEEDS = 51
_BEYOND = 1.25
# How far above the first order of a mesh modes are followed, and between which numbers of modes.
_ABOVE = 1.05
_FEW = 15.0
_MANY = 120.0


def highest_speed(model: Model, given: float | str | None = None) -> float:
    """The end of a speed range in rad/s: what is given, else 1.25 times the operating speed.

    Raises:
        AnalysisError: neither is known.
    """
    if given is not None:
        return speed_in_si(given)
    operating = model.operating_speed
    if not operating:
        raise AnalysisError("the model has no operating speed: give the highest speed (--to '12000 rpm')")
    return _BEYOND * operating


def mesh_reach(model: Model) -> tuple[float | None, str]:
    """Up to which frequency in Hz to follow modes where nothing is asked for, and what that leaves out.

    It is a little above the first order of every mesh at the operating speed. None: so few modes lie below it that the default
    number reaches further, or so many that they are followed only when asked for.
    """
    speed = model.operating_speed
    lines = excitation_orders(model, (), (1,)) if speed else ()
    highest = max((line.frequency_hz(speed or 0.0) for line in lines), default=0.0)
    expected = expected_modes(model, 2.0 * np.pi * highest)
    if expected <= _FEW:
        return None, ""
    fmax = _ABOVE * highest
    if expected <= _MANY:
        return fmax, ""
    return None, (
        f"modes up to the first order of every mesh at the operating speed, {highest:.5g} Hz: about {expected:.0f}; "
        f"--fmax {fmax:.4g} follows them"
    )


def chosen_speeds(
    model: Model,
    given: Sequence[float | str] | None,
    start: float | str = 0.0,
    stop: float | str | None = None,
    points: int = DEFAULT_SPEEDS,
) -> np.ndarray:
    """Speeds in rad/s (k,), ascending in size, each once.

    Args:
        model: whose operating speed ends a range that has no end.
        given: the speeds; None: evenly spaced ones.
        start, stop, points: of these; `stop` is 1.25 times the operating speed where not given.

    Raises:
        AnalysisError: fewer than two different speeds, or speeds of both senses.
    """
    if given is None:
        ends = speed_in_si(start), highest_speed(model, stop)
        check_whole("the number of points", points, 2)
        speeds = np.linspace(*ends, points)
    else:
        speeds = np.array([speed_in_si(value) for value in given], float)
    if speeds.size and (speeds.min() < 0.0 < speeds.max()):
        raise AnalysisError(
            "the speeds go through zero into the other sense of rotation, which loads other flanks: analyse each sense by itself"
        )
    unique = np.array(sorted(set(speeds.tolist()), key=abs))
    if len(unique) < 2:
        raise AnalysisError(f"a diagram over speed needs at least 2 different speeds, got {len(unique)}")
    return unique


def system_for_speeds(
    model: Model | System,
    speeds: Sequence[float],
    asked: ModalRequest,
    state: State | None = None,
    progress: Progress = silent,
) -> System:
    """Return a system whose lowest modes that oscillate are estimated to be within the accuracy at each of some speeds in rad/s.

    A system is taken as it is, and `asked.elements` fixes the mesh. Without a state the modes at each speed are about their own
    equilibrium, and the system about its torque flow. Errors are those of `modal`.
    """
    if isinstance(model, System):
        return model
    if asked.elements is not None and asked.accuracy is not None:
        raise AnalysisError("elements and accuracy: give one of the two; elements fixes the mesh, accuracy refines it")
    turning = [speed for speed in speeds if speed]
    direction = -1 if turning and turning[0] < 0.0 else 1

    def cut(plan: Plan) -> System:
        if state is None:
            return flow_system(model, plan, direction=direction)
        return linear_system(model, speeds, plan, state=state)

    if asked.elements is not None:
        check_whole("the number of elements", asked.elements)
        return cut(Plan(asked.elements))
    cuts: list[dict[PieceKey, tuple[int, int]]] = []
    for k, speed in enumerate(dict.fromkeys(speeds)):
        progress(0.1 * k, "refining the mesh")
        here = replace(asked, speed=speed)
        found = modes_about(model, here, state)
        # Rigid and overdamped modes are no branches: as many more are needed.
        others = len(found) - int(np.count_nonzero(~found.rigid & (np.abs(found.eigenvalues.imag) > 0.0)))
        if asked.modes is not None and others:
            found = modes_about(model, replace(here, modes=asked.modes + others, fmax=None), state)
        cuts.append(cut_of(found.discretisation))
    return cut(Plan(cut={key: max(cut[key] for cut in cuts) for key in cuts[0]}))
