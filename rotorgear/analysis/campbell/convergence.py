"""Error against run time of Campbell diagrams and critical speeds over a series of discretisations."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rotorgear.analysis.campbell.campbell import campbell
from rotorgear.analysis.campbell.critical import critical
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.study import ACCURACIES, ELEMENTS, REPEAT, Judged, Study, mesh_settings
from rotorgear.analysis.modal.convergence import REFERENCE, RESOLUTION, as_continuum
from rotorgear.analysis.modal.modal import modal
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.progress import Progress, part_of, silent
from rotorgear.results.campbell import CampbellResult
from rotorgear.results.convergence import ConvergenceStudy
from rotorgear.results.critical import CriticalResult

# Speeds of the diagrams that are compared, the first and last of them its ends.
POINTS = 3
# A mode whose damped frequency is below this share of |s| does not oscillate, and is on no branch.
_OSCILLATES = 1e-9


@recorded
def campbell_convergence_study(
    model: Model,
    *,
    stop: float | str | None = None,
    modes: int = 24,
    elements: Sequence[int] = ELEMENTS,
    accuracies: Sequence[float] = ACCURACIES,
    repeat: int = REPEAT,
    progress: Progress = silent,
) -> ConvergenceStudy:
    """Run a Campbell diagram of three speeds over a series of discretisations.

    The errors are those of |s| of the lowest branches at every speed, against the modes at that speed by `modal`: solved for
    themselves, without the reduced basis and without following branches.

    Args:
        model, stop: as for `campbell`.
        modes: how many branches are compared.
        elements, accuracies, repeat: as for `convergence_study`.
        progress: callable that is told fraction and step.
    """

    def run(options: dict[str, float]) -> CampbellResult:
        return campbell(model, stop=stop, points=POINTS, modes=modes, **options)  # type: ignore[arg-type]

    coarse = run({"accuracy": 1e-2})
    truth = []
    for k, speed in enumerate(coarse.speeds):
        progress(0.4 * k / POINTS, f"reference, speed {k + 1} of {POINTS}")
        finest = modal(as_continuum(model), speed=float(speed), modes=modes + 12, accuracy=REFERENCE)
        s = finest.eigenvalues
        truth.append(np.sort(np.abs(s[~finest.rigid & (s.imag > _OSCILLATES * np.abs(s))]))[:modes])
    count = min(len(found) for found in truth)

    def judge(result: CampbellResult) -> Judged:
        error = np.full((POINTS, count), np.inf)
        estimate = np.full((POINTS, count), np.inf)
        for k, exact in enumerate(truth):
            size = np.where(np.isfinite(result.eigenvalues[k]), np.abs(result.eigenvalues[k]), np.inf)
            lowest = np.argsort(size)[:count]
            there = np.isfinite(size[lowest])
            error[k, : len(lowest)][there] = np.abs(size[lowest][there] / exact[: len(lowest)][there] - 1.0)
            estimate[k, : len(lowest)][there] = result.error_estimate[lowest][there]
        # A branch has one estimate, the larger of both ends: it is for the worst of its speeds.
        return Judged(result.dofs, error.max(axis=0), estimate.max(axis=0))

    study = Study(run, judge, RESOLUTION, repeat=repeat)
    rungs = study.rungs(mesh_settings(elements, accuracies), part_of(progress, 0.4, 1.0))
    words = f"modes solved for themselves at each of {POINTS} speeds, meshes refined to {REFERENCE:g}"
    return ConvergenceStudy(
        model.title or "model", "campbell", words, count, rungs, compared="branches", resolution=RESOLUTION
    )


@recorded
def critical_convergence_study(
    model: Model,
    *,
    stop: float | str | None = None,
    elements: Sequence[int] = ELEMENTS,
    accuracies: Sequence[float] = ACCURACIES,
    repeat: int = REPEAT,
    progress: Progress = silent,
) -> ConvergenceStudy:
    """Find the critical speeds over a series of discretisations.

    The reference are the critical speeds on the finest mesh, each of them confirmed by the modes at that speed.

    Args:
        model, stop: as for `critical`.
        elements, accuracies, repeat: as for `convergence_study`.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: no critical speed in the range.
    """
    progress(0.0, "reference")
    finest = critical(as_continuum(model), stop=stop, accuracy=REFERENCE)
    truth = _by_line(finest)
    count = sum(len(speeds) for speeds, _ in truth.values())
    if not count:
        raise AnalysisError("there is no critical speed in this range, so there is no error to measure; raise --to")
    confirmed = max(_met(model, finest, k) for k in range(count))

    def judge(result: CriticalResult) -> Judged:
        error = []
        estimate = []
        here = _by_line(result)
        for line, (exact, _) in truth.items():
            speeds, told = here.get(line, (np.zeros(0), np.zeros(0)))
            # A critical speed near the end of the range may lie beyond it on a coarse mesh.
            both = min(len(speeds), len(exact))
            error.append(np.abs(speeds[:both] / exact[:both] - 1.0))
            estimate.append(told[:both])
        return Judged(result.dofs, np.concatenate(error), np.concatenate(estimate))

    study = Study(lambda options: critical(model, stop=stop, **options), judge, RESOLUTION, repeat=repeat)
    rungs = study.rungs(mesh_settings(elements, accuracies), part_of(progress, 0.1, 1.0))
    words = (
        f"the mesh refined to {REFERENCE:g}, {finest.dofs} dofs; the modes at these speeds, solved for themselves, meet the "
        f"lines to {confirmed:.0e}"
    )
    return ConvergenceStudy(
        model.title or "model", "critical", words, count, rungs, compared="critical speeds", resolution=RESOLUTION
    )


def _by_line(result: CriticalResult) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Critical speeds of each line by size, and their estimated errors."""
    found: dict[str, tuple[np.ndarray, np.ndarray]] = {}
    for line in dict.fromkeys(item.line for item in result.speeds):
        own = sorted((item for item in result.speeds if item.line == line), key=lambda item: abs(item.speed))
        found[line] = np.array([abs(item.speed) for item in own]), np.array([item.error_estimate for item in own])
    return found


def _met(model: Model, finest: CriticalResult, k: int) -> float:
    """Relative distance of the nearest mode at a critical speed from its line, by the modal analysis."""
    item = finest.speeds[k]
    w = 2.0 * np.pi * item.frequency_hz
    found = modal(
        as_continuum(model),
        speed=item.speed,
        fmax=1.05 * item.frequency_hz / (1.0 - item.damping_ratio**2) ** 0.5,
        accuracy=REFERENCE,
    )
    return float(np.min(np.abs(found.eigenvalues.imag - w)) / w)
