"""Error against run time: runs an analysis of a model over a series of discretisations and compares with a reference."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.study import ACCURACIES, ELEMENTS, REPEAT, Judged, Study, mesh_settings
from rotorgear.analysis.modal.modal import modal
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.results.convergence import ConvergenceStudy
from rotorgear.results.modal import ModalResult
from rotorgear.system.plan import Plan
from rotorgear.system.system import flow_system

REFERENCE = 1e-10
# Ten times the accuracy of the reference: below, the ratio of estimate and error is that of the reference.
RESOLUTION = 1e-9


@recorded
def convergence_study(
    model: Model,
    *,
    speed: float | str | None = None,
    modes: int = 24,
    elements: Sequence[int] = ELEMENTS,
    accuracies: Sequence[float] = ACCURACIES,
    reference: Sequence[float] | None = None,
    repeat: int = REPEAT,
    progress: Progress = silent,
) -> ConvergenceStudy:
    """Run the modal analysis of a model over a series of discretisations.

    The errors of the estimates are those of single frequencies: a mode counts with its own estimate.

    Args:
        model: the model.
        speed: as for `modal`.
        modes: how many modes are compared (rigid ones count, but have no error).
        elements: numbers of basic elements in each shaft segment.
        accuracies: relative accuracies to refine to.
        reference: natural frequencies in Hz of the modes that are not rigid; None for the model's own finest (accuracy 1e-10,
            by elements of high order, and with consistent mass where the model's is lumped).
        repeat: runs of each rung that are timed at least; the median time counts.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: the reference has fewer frequencies than asked for, or the model has no elastic mode.
    """
    truth, words = _reference(model, speed, modes, reference)

    def judge(result: ModalResult) -> Judged:
        elastic = ~result.rigid & (np.abs(result.eigenvalues) > 0.0)
        frequencies = result.natural_frequency_hz[elastic][: len(truth)]
        error = np.full(len(truth), np.inf)  # a discretisation with too few modes has no answer for the last ones
        error[: len(frequencies)] = np.abs(frequencies / truth[: len(frequencies)] - 1.0)
        estimate = np.full(len(truth), np.inf)
        estimate[: len(frequencies)] = result.error_estimate[elastic][: len(truth)]
        return Judged(result.dofs, error, estimate)

    # A mesh so coarse that the supports hold everything has nothing to solve.
    able = [n for n in elements if flow_system(model, Plan(n)).n]
    resolution = RESOLUTION if reference is None else 0.0
    study = Study(lambda options: modal(model, speed=speed, modes=modes, **options), judge, resolution, repeat=repeat)
    rungs = study.rungs(mesh_settings(able, accuracies), progress)
    return ConvergenceStudy(
        model.title or "model", "modal", words, len(truth), rungs, compared="frequencies", resolution=resolution
    )


def as_continuum(model: Model) -> Model:
    """The model with consistent mass on all shafts, whose frequencies at vanishing element length are the same."""
    lumped = [name for name, shaft in model.shafts.items() if shaft.mass_matrix == "lumped"]
    return model.with_({f"shafts.{name}.mass_matrix": "consistent" for name in lumped}) if lumped else model


def elastic_frequencies(result: ModalResult) -> np.ndarray:
    """Natural frequencies in Hz of the modes that are not rigid, nor roots at zero."""
    return result.natural_frequency_hz[~result.rigid & (np.abs(result.eigenvalues) > 0.0)]


def _reference(
    model: Model, speed: float | str | None, modes: int, given: Sequence[float] | None
) -> tuple[np.ndarray, str]:
    """Frequencies in Hz that stand for the truth, (m,), and where they come from."""
    finest = modal(as_continuum(model), speed=speed, modes=modes, accuracy=REFERENCE)
    computed = elastic_frequencies(finest)
    if computed.size == 0:
        raise AnalysisError("the model has no elastic mode among those asked for, so there is no error to measure")
    if given is None:
        order = max((piece.order for piece in finest.discretisation), default=1)
        return computed, f"elements of order up to {order}, refined to {REFERENCE:g}, {finest.dofs} dofs"
    truth = np.sort(np.asarray(given, float))
    if truth.size == 0 or not np.all(np.isfinite(truth) & (truth > 0.0)):
        raise AnalysisError("the reference needs positive frequencies in Hz")
    if truth.size > computed.size:
        raise AnalysisError(
            f"the reference has {truth.size} frequencies, but only {computed.size} elastic modes are computed; raise modes"
        )
    return truth, f"{truth.size} given frequencies"
