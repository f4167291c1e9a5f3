"""Which mode of a model a measured shape is, where the model's springs are known to 30 % only.

A measured mode is not the nearest one in frequency and shape: between two modes that veer both are mixtures of what the model
has. So springs are first moved to where lines and shapes want them (`updating/estimate.py`, a step each against less and less
enlarged noise), lines are paired with the modes there, and each of these is followed back to the model as it is, along a straight
path in the logs of the stiffnesses: one-to-one by overlap in mass, in halves where a mode turns too far in one step.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.rig.learnt import SPRINGS, STIFFNESS_PRIOR
from rotorgear.analysis.rig.measured import Measured
from rotorgear.analysis.rig.rig_model import ComparedModes, RigModel
from rotorgear.analysis.updating.estimate import Estimate
from rotorgear.analysis.updating.misfit import Misfit
from rotorgear.model.address import tables_of
from rotorgear.model.model import Model
from rotorgear.model.numbers import free_numbers, is_number
from rotorgear.progress import silent
from rotorgear.system.plan import Plan

SHAPE_NOISE = 0.02
# A mode is followed where this share of it is in one mode of the next place, or after so many halves of a step.
_CLEAR = 0.6
_HALVES = 5


def identified_pairs(
    model: Model, plan: Plan, fmax: float, given: Measured, tolerance: float
) -> list[tuple[int, int]] | None:
    """Return (line, elastic mode of the model), ascending in lines; None where no spring is uncertain or no line is near a mode.

    Args:
        model: the model, at standstill.
        plan: its mesh.
        fmax: modes below so many Hz are looked at.
        given: measured shapes.
        tolerance: largest |f_mode / f_rig - 1| of a line without shape.
    """
    addresses = _springs(model)
    if not addresses:
        return None
    rig_model = RigModel(free_numbers(model, addresses, STIFFNESS_PRIOR), plan, fmax, given.points)
    steps = Estimate(Misfit(rig_model, given, SHAPE_NOISE, tolerance))
    start = steps.start()
    if not start.pairs:
        return None
    end = steps.approach(start, silent)
    wanted = np.array([pair.mode for pair in end.pairs], dtype=np.intp)
    back = followed(rig_model, (end.x, end.modes), (start.x, start.modes), wanted)
    return [(pair.line, int(mode)) for pair, mode in zip(end.pairs, back, strict=True) if mode >= 0]


def followed(
    model: RigModel,
    here: tuple[NDArray[np.float64], ComparedModes],
    there: tuple[NDArray[np.float64], ComparedModes],
    wanted: NDArray[np.intp],
    halves: int = _HALVES,
) -> NDArray[np.intp]:
    """Numbers at `there` of the modes that have the numbers `wanted` (k,) at `here`; -1 of one that left the range."""
    from scipy.optimize import linear_sum_assignment

    overlap = here[1].overlap(there[1])
    rows, columns = linear_sum_assignment(-overlap)
    now = dict(zip(rows.tolist(), columns.tolist(), strict=True))
    clear = all(k < 0 or overlap[k, now[k]] > _CLEAR for k in wanted if k < 0 or k in now)
    if clear or halves == 0:
        return np.array([now.get(int(k), -1) for k in wanted], dtype=np.intp)
    x = 0.5 * (here[0] + there[0])
    middle = (x, model.modes(x))
    return followed(model, middle, there, followed(model, here, middle, wanted, halves - 1), halves - 1)


def _springs(model: Model) -> list[str]:
    """Addresses of the stiffnesses that the file gives as numbers."""
    tables = tables_of(model)
    return [
        f"{table}.{name}.stiffness"
        for table in SPRINGS
        for name, part in tables.get(table, {}).items()
        if is_number(part.get("stiffness"))
    ]
