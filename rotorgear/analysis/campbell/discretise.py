"""The mesh for an analysis over a range of speeds: what the modes at both ends need for an accuracy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from rotorgear.analysis.common.discretise import cut_of
from rotorgear.analysis.common.request import check_whole
from rotorgear.analysis.modal.modal import ModalRequest, modes_about
from rotorgear.analysis.static.state_at import linear_system
from rotorgear.errors import AnalysisError
from rotorgear.model.layout.state import State
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.system.plan import PieceKey, Plan
from rotorgear.system.system import System, flow_system


def system_for_speeds(
    model: Model | System,
    speeds: Sequence[float],
    *,
    modes: int | None,
    fmax: float | None,
    elements: int | None,
    accuracy: float | None,
    only: tuple[str, ...] = (),
    state: State | None = None,
    progress: Progress = silent,
) -> System:
    """Return a system whose lowest modes that oscillate are estimated to be within the accuracy at each of some speeds in rad/s.

    A system is taken as it is, and `elements` fixes the mesh. Without a state the modes at each speed are about their own
    equilibrium, and the system about its torque flow. Errors are those of `modal`.
    """
    if isinstance(model, System):
        return model
    if elements is not None and accuracy is not None:
        raise AnalysisError("elements and accuracy: give one of the two; elements fixes the mesh, accuracy refines it")
    turning = [speed for speed in speeds if speed]
    direction = -1 if turning and turning[0] < 0.0 else 1

    def cut(plan: Plan) -> System:
        if state is None:
            return flow_system(model, plan, direction=direction)
        return linear_system(model, speeds, plan, state=state)

    if elements is not None:
        check_whole("the number of elements", elements)
        return cut(Plan(elements))
    cuts: list[dict[PieceKey, tuple[int, int]]] = []
    for k, speed in enumerate(dict.fromkeys(speeds)):
        progress(0.1 * k, "refining the mesh")
        asked = ModalRequest(speed, modes, fmax, accuracy=accuracy, only=only)
        found = modes_about(model, asked, state)
        if modes is not None:
            # Rigid and overdamped modes are no branches: as many more are needed.
            still = len(found) - int(np.count_nonzero(~found.rigid & (np.abs(found.eigenvalues.imag) > 0.0)))
            if still:
                found = modes_about(model, replace(asked, modes=modes + still, fmax=None), state)
        cuts.append(cut_of(found.discretisation))
    finest = {key: max(cut[key] for cut in cuts) for key in cuts[0]}
    return cut(Plan(cut=finest))
