"""Error against run time of one periodic motion over harmonics and instants."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import speed_in_si
from rotorgear.analysis.common.study import REPEAT, Judged, Setting, Study
from rotorgear.analysis.orbits.family import SPEED, SystemFamily, range_of
from rotorgear.analysis.orbits.orbits import HARMONICS, INSTANTS, equations_of, scale_of
from rotorgear.analysis.orbits.places import told_of
from rotorgear.analysis.orbits.refined import change
from rotorgear.analysis.orbits.start import run_periods
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.progress import Progress, part_of, silent
from rotorgear.results.convergence import ConvergenceStudy
from rotorgear.solvers.periodic.arclength import at_value
from rotorgear.solvers.periodic.balance import Grid
from rotorgear.solvers.periodic.harmonic_orbits import HarmonicOrbits
from rotorgear.solvers.periodic.shooting import ShootingOrbits
from rotorgear.solvers.sparse.factor import single_thread

COUNTS = (5, 10, 20, 40, 80)
# Instants for each of the default number of harmonics.
DENSITIES = (6, 8, 16, 32, 64)
# The reference has so many times the most harmonics, as long as its equations are no more than this.
_FINER = 3
_MOST_UNKNOWNS = 2500
# A branch needs a range: the motion is the one at its begin.
_RANGE = 1.01
_STEPS = 8000
_ROUNDING = 1e-9


@recorded
def orbits_convergence_study(
    model: Model,
    *,
    speed: float | str | None = None,
    excite: str | None = None,
    harmonics: Sequence[int] = COUNTS,
    densities: Sequence[int] = DENSITIES,
    repeat: int = REPEAT,
    progress: Progress = silent,
) -> ConvergenceStudy:
    """Solve for one periodic motion with series of harmonics and of instants, by harmonic balance.

    Errors and estimates are those of the displacements of every mesh contact (without meshes, of those across bearings, nonlinear
    elements and at unbalances): the largest difference of their coefficients over the largest harmonic of that displacement; the
    estimate is the change with twice the harmonics and instants, as `orbits` states it.
    Small systems are compared with shooting, another method. Larger ones are compared with harmonic balance of more harmonics; a
    transient that starts on that motion tells how near it comes back after one period.

    All begin at the motion of the reference, as a branch begins each point near the one before. The time is that of the motion
    and its multipliers, without the estimate, which a branch makes at three points.

    Args:
        model, excite: as for `orbits`.
        speed: of the input shaft, in rad/s or as a text; the operating speed where not given.
        harmonics: numbers of harmonics, each with 16 instants a harmonic.
        densities: instants for each of 30 harmonics, 5 or more.
        repeat: runs of each rung that are timed at least.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: no speed, nothing that tells motions apart, fewer than 5 instants a harmonic, or no periodic motions.
        ConvergenceError: the static state does not lead to a motion at this speed.
    """
    given = speed_in_si(speed)
    if given is None:
        given = model.operation.speed if model.operation else None
    if not given:
        raise AnalysisError("the model gives no speed of operation: ask for one (speed, or --speed)")
    if min(densities, default=INSTANTS) < 5:
        raise AnalysisError(f"densities: got {min(densities)}, expected 5 instants a harmonic or more")
    family = SystemFamily(model, [range_of(model, SPEED, [given, _RANGE * given])], excite, None)
    told = told_of(family)
    columns = told.columns
    plant = family.plant(0.0)
    scale = scale_of(plant)

    def solved(grid: Grid, begin: np.ndarray | None) -> tuple[HarmonicOrbits, np.ndarray]:
        own = HarmonicOrbits(family.plant, grid, scale)
        start = own.start(0.0) if begin is None else own.unknowns(_cut(begin, grid.harmonics))
        return own, at_value(own, start, 0.0).y

    with single_thread(0):
        progress(0.0, "reference")
        order = family.order
        finest = min(_FINER * max(harmonics), (_MOST_UNKNOWNS // plant.m - 1) // 2)
        own, y = solved(Grid(HARMONICS, INSTANTS * HARMONICS, order), None)
        half, y = solved(Grid(finest // 2, INSTANTS * (finest // 2), order), own.coefficients(y))
        coarser = half.coefficients(y)
        best, y = solved(Grid(finest, INSTANTS * finest, order), coarser)
        truth = best.coefficients(y)
        motion = best.state(y, 0.0)
        other, method = equations_of("auto", family, best.grid, scale)
        if isinstance(other, ShootingOrbits):
            node = at_value(other, other.from_motion(*motion, plant), 0.0)
            balance = truth
            truth = other.cycle(node.y, 0.0).displacement
            gap = float(change(balance, truth, columns).max())
            # Shooting is the better of the two by far: their difference is more than it is off by.
            doubt = max(0.1 * gap, _ROUNDING)
            words = f"{method}, {gap:.0e} from harmonic balance with {finest} harmonics"
        else:
            # From order 2 on a third of the last change is more than the finer one is off by.
            doubt = max(float(change(coarser, truth, columns).max()) / 3.0, _ROUNDING)
            _, d = run_periods(family.system([0.0]), order, 1, *motion, _STEPS)
            seen = d[:, columns]
            missed = np.abs(seen[-1] - (plant.B.T @ motion[0])[columns]) / np.ptp(seen, axis=0)
            words = (
                f"harmonic balance with {finest} harmonics; a transient that starts there comes back to "
                f"{missed.max():.0e} of its peak to peak after a period"
            )

    def run(options: dict[str, Any]) -> tuple[HarmonicOrbits, np.ndarray]:
        found, y = solved(Grid(options["harmonics"], options["instants"], order), truth)
        found.multipliers(y, 0.0)
        return found, y

    def judge(found: tuple[HarmonicOrbits, np.ndarray]) -> Judged:
        orbits, y = found
        c = orbits.coefficients(y)
        finer = orbits.finer()
        better = finer.coefficients(at_value(finer, orbits.lifted(y, finer), 0.0).y)
        return Judged(orbits.size, change(c, truth, columns), change(c, better, columns))

    settings = [
        Setting(f"{h} harmonics, {INSTANTS * h} instants", "harmonics", h, {"harmonics": h, "instants": INSTANTS * h})
        for h in harmonics
        if 2 * h <= finest
    ]
    settings += [
        Setting(f"{HARMONICS} harmonics, {HARMONICS * n} instants", "instants", n, _instants(n))
        for n in densities
        if finest >= 2 * HARMONICS
    ]
    study = Study(run, judge, doubt, rising=("harmonics", "instants"), repeat=repeat)
    rungs = study.rungs(settings, part_of(progress, 0.3, 1.0))
    compared = "contacts" if told.contacts.column.size else "bearings, elements and unbalances"
    return ConvergenceStudy(
        model.title or "model",
        "orbits",
        words,
        columns.size,
        rungs,
        compared=f"displacements of the {compared}",
        resolution=doubt,
    )


def _instants(density: int) -> dict[str, int]:
    return {"harmonics": HARMONICS, "instants": HARMONICS * density}


def _cut(c: np.ndarray, harmonics: int) -> np.ndarray:
    """Coefficients (harmonics + 1, m): the first of c, zeros beyond its last."""
    out = np.zeros((harmonics + 1, c.shape[1]), complex)
    kept = min(len(c), harmonics + 1)
    out[:kept] = c[:kept]
    return out
