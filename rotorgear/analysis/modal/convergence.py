"""Error against run time: runs an analysis of a model over a series of discretisations and compares with a reference."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Any

import numpy as np

from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.modal.modal import modal
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.results.convergence import ConvergenceStudy, Rung
from rotorgear.results.modal import ModalResult
from rotorgear.system.system import System

ELEMENTS = (1, 2, 4, 8, 16)
ACCURACIES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-7, 1e-9)
REFERENCE = 1e-10
# Errors below this are rounding and say nothing of an order.
_ROUNDING = 1e-11


@recorded
def convergence_study(
    model: Model,
    *,
    speed: float | str | None = None,
    modes: int = 24,
    elements: Sequence[int] = ELEMENTS,
    accuracies: Sequence[float] = ACCURACIES,
    reference: Sequence[float] | None = None,
    repeat: int = 3,
    progress: Progress = silent,
) -> ConvergenceStudy:
    """Run the modal analysis of a model over a series of discretisations.

    Args:
        model: the model.
        speed: as for `modal`.
        modes: how many modes are compared (rigid ones count, but have no error).
        elements: numbers of basic elements in each shaft segment.
        accuracies: relative accuracies to refine to.
        reference: natural frequencies in Hz of the modes that are not rigid; None for the model's own finest (accuracy 1e-10).
        repeat: runs of each rung; the median time counts.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: the reference has fewer frequencies than asked for, or the model has no elastic mode.
    """
    truth, words = _reference(model, speed, modes, reference)
    settings: list[tuple[str, float, dict[str, Any]]] = [("elements", n, {"elements": n}) for n in elements]
    settings += [("accuracy", a, {"accuracy": a}) for a in accuracies]
    rungs: list[Rung] = []
    for number, (family, setting, options) in enumerate(settings):
        progress(number / len(settings), f"{family} {setting:g}")
        if family == "elements" and not System(model, int(setting)).n:
            continue  # so coarse that the supports hold everything
        seconds = []
        for _ in range(max(repeat, 1)):
            start = time.perf_counter()
            result = modal(model, speed=speed, modes=modes, **options)
            seconds.append(time.perf_counter() - start)
        frequencies = _elastic(result)
        # A discretisation with too few modes has no answer for the last ones.
        error = np.inf
        if len(frequencies) >= len(truth):
            error = float(np.max(np.abs(frequencies[: len(truth)] / truth - 1.0)))
        coarser = rungs[-1] if rungs and rungs[-1].family == family == "elements" else None
        order = None
        if coarser is not None and np.isfinite(coarser.error) and min(error, coarser.error) >= _ROUNDING:
            # error ~ h^p with the element length h = L / n: p = log(e_1 / e_2) / log(n_2 / n_1)
            order = float(np.log(coarser.error / error) / np.log(setting / coarser.setting))
        words_of = {
            "elements": f"{setting:g} basic element{'s'[: setting != 1]} per segment",
            "accuracy": f"accuracy {setting:g}",
        }
        rungs.append(
            Rung(
                words_of[family],
                family,
                float(setting),
                result.dofs,
                float(np.median(seconds)),
                error,
                float(np.max(result.error_estimate)),
                order,
            )
        )
    progress(1.0, "done")
    return ConvergenceStudy(model.title or "model", "modal", words, len(truth), tuple(rungs))


def _elastic(result: ModalResult) -> np.ndarray:
    """Natural frequencies in Hz of the modes that are not rigid, nor roots at zero."""
    return result.natural_frequency_hz[~result.rigid & (np.abs(result.eigenvalues) > 0.0)]


def _reference(
    model: Model, speed: float | str | None, modes: int, given: Sequence[float] | None
) -> tuple[np.ndarray, str]:
    """Frequencies in Hz that stand for the truth, (m,), and where they come from."""
    finest = modal(model, speed=speed, modes=modes, accuracy=REFERENCE)
    computed = _elastic(finest)
    if computed.size == 0:
        raise AnalysisError("the model has no elastic mode among those asked for, so there is no error to measure")
    if given is None:
        return computed, f"the model itself at accuracy {REFERENCE:g}, {finest.dofs} dofs"
    truth = np.sort(np.asarray(given, float))
    if truth.size == 0 or not np.all(np.isfinite(truth) & (truth > 0.0)):
        raise AnalysisError("the reference needs positive frequencies in Hz")
    if truth.size > computed.size:
        raise AnalysisError(
            f"the reference has {truth.size} frequencies, but only {computed.size} elastic modes are computed; raise modes"
        )
    return truth, f"{truth.size} given frequencies"
