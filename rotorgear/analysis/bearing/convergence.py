"""Error against run time of one bearing: grids of a film, positions of rolling elements over which they are averaged."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.analysis.bearing.state import (
    Carried,
    address_of,
    by_its_law,
    carried,
    change_of_tangents,
    equilibrium_of,
    law_at,
    on_grid,
)
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import speed_in_si
from rotorgear.analysis.common.study import REPEAT, Judged, Setting, Study
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.progress import Progress, part_of, silent
from rotorgear.results.convergence import ConvergenceStudy

# Of the cells that the file gives, each way.
_GRIDS = (0.25, 0.5, 1.0)
_FINEST_GRID = 4.0
_POINTS = (2, 4, 8, 16, 32, 64)
_FINEST_POINTS = 1024
_ROUNDING = 1e-9


@recorded
def bearing_convergence_study(
    model: Model,
    bearing: str | None = None,
    *,
    speed: float | str | None = None,
    repeat: int = REPEAT,
    progress: Progress = silent,
) -> ConvergenceStudy:
    """Run one bearing at the load that its gearbox puts on it, over a series of grids or of positions of its elements.

    The errors are those of displacements, stiffness and damping, each relative to the largest of its kind; the estimate is
    twice the change of stiffness and damping on a grid of twice the cells, or with twice the positions, as on the sheet.

    Args:
        model, bearing, speed: as for `bearing`.
        repeat: runs of each rung that are timed at least.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: no such bearing, no equilibrium, or nothing in the bearing that a series could refine.
    """
    address = address_of(model, bearing)
    given = speed_in_si(speed)
    if given is None:
        given = (model.operation.speed if model.operation else None) or 0.0
    progress(0.0, "equilibrium of the gearbox")
    state = law_at(equilibrium_of(by_its_law(model, address), given), address)
    law = state.part.law
    film = bool(law.grid)
    if not film and not (law.cycle() and given):
        raise AnalysisError(
            f"{address}: its law is a formula without a grid or turning elements; there is nothing to refine"
        )

    def at(fineness: float) -> Carried:
        grid = on_grid(law, fineness) if film else law
        points = {} if film else {"points": int(fineness)}
        return carried(grid, state.force, state.d, given, **points)

    truth = at(_FINEST_GRID if film else _FINEST_POINTS)

    def changes(one: Carried, other: Carried, *keys: str) -> np.ndarray:
        found = []
        for key in keys:
            a = getattr(one, key).ravel()
            b = getattr(other, key).ravel()
            size = float(np.abs(b).max(initial=0.0))
            found.append((a - b) / size if size else np.zeros_like(a))
        return np.abs(np.concatenate(found))

    def run(options: dict[str, Any]) -> tuple[Carried, Carried]:
        return at(options["fineness"]), at(2.0 * options["fineness"])

    def judge(found: tuple[Carried, Carried]) -> Judged:
        here, finer = found
        estimate = np.array([change_of_tangents(here, finer)])
        return Judged(state.d.size, changes(here, truth, "d", "stiffness", "damping"), estimate)

    if film:
        settings = [Setting(f"{on_grid(law, g).cells} cells", "grid", g, {"fineness": g}) for g in _GRIDS]
        words = f"the film on {on_grid(law, _FINEST_GRID).cells} cells"
    else:
        settings = [Setting(f"{n} positions in a pitch", "positions", float(n), {"fineness": n}) for n in _POINTS]
        words = f"means over {_FINEST_POINTS} positions in a pitch"
    study = Study(run, judge, _ROUNDING, rising=("grid", "positions"), repeat=repeat)
    rungs = study.rungs(settings, part_of(progress, 0.3, 1.0))
    return ConvergenceStudy(
        model.title or address,
        "bearing",
        words,
        state.d.size + 2 * state.d.size**2,
        rungs,
        compared="displacements, stiffness and damping",
        resolution=_ROUNDING,
    )
