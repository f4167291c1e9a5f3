"""Error against run time of forced responses and frequency responses over a series of discretisations."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.study import ELEMENTS, REPEAT, Judged, Study, mesh_settings
from rotorgear.analysis.modal.convergence import as_continuum, elastic_frequencies
from rotorgear.analysis.modal.modal import modal
from rotorgear.analysis.response.error import strongest_orders
from rotorgear.analysis.response.frequency_response import frf, relative_change
from rotorgear.analysis.response.response import response
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.progress import Progress, part_of, silent
from rotorgear.results.convergence import ConvergenceStudy
from rotorgear.results.frequency_response import FrequencyResponse
from rotorgear.results.response import ResponseResult

ACCURACIES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-6)
REFERENCE = 1e-9
# Amplitudes at a resonance of 0.1 % damping move 500 times as much as its frequency.
RESOLUTION = 1e-7
SPEEDS = 101
FREQUENCIES = 200
# A frequency response without a range goes this far above so many elastic modes.
_MODES = 6
_ABOVE = 1.1


@recorded
def response_convergence_study(
    model: Model,
    *,
    fmax: float | None = None,
    modal_damping: float = 0.0,
    elements: Sequence[int] = ELEMENTS,
    accuracies: Sequence[float] = ACCURACIES,
    repeat: int = REPEAT,
    progress: Progress = silent,
) -> ConvergenceStudy:
    """Run a forced response over speed on a series of meshes.

    The error of an order is the largest difference of its complex forces of contacts and bearings at any speed, relative to the
    largest; the strongest orders are compared. The reference is solved directly at every speed; the rungs may take modes.

    Args:
        model, fmax, modal_damping: as for `response`.
        elements, accuracies, repeat: as for `convergence_study`.
        progress: callable that is told fraction and step.
    """

    def run(options: dict[str, float], method: str = "auto") -> ResponseResult:
        return response(model, points=SPEEDS, fmax=fmax, modal_damping=modal_damping, method=method, **options)  # type: ignore[arg-type]

    progress(0.0, "reference")
    finest = response(
        as_continuum(model), points=SPEEDS, fmax=fmax, modal_damping=modal_damping, method="direct", accuracy=REFERENCE
    )
    truth = _forces(finest)
    size = np.abs(truth).max(axis=2)
    strongest = strongest_orders(size)
    if not size[:, strongest].any():
        raise AnalysisError("nothing moves: the excitations of the model come to nothing")

    def judge(result: ResponseResult) -> Judged:
        here = _forces(result)
        difference = np.abs(here - truth).max(axis=(0, 2))[strongest]
        largest = size.max(axis=0)[strongest]
        return Judged(
            result.dofs, difference / np.where(largest > 0.0, largest, 1.0), np.array([result.error_estimate])
        )

    study = Study(run, judge, RESOLUTION, repeat=repeat)
    rungs = study.rungs(mesh_settings(elements, accuracies), part_of(progress, 0.2, 1.0))
    words = f"direct solutions on a mesh of {finest.dofs} dofs, its own error estimated at {finest.error_estimate:.0e}"
    return ConvergenceStudy(
        model.title or "model",
        "response",
        words,
        len(strongest),
        rungs,
        compared="orders, each by its largest force over speed",
        resolution=RESOLUTION,
    )


@recorded
def frf_convergence_study(
    model: Model,
    *,
    fmax: float | None = None,
    modal_damping: float = 0.0,
    at: str | None = None,
    elements: Sequence[int] = ELEMENTS,
    accuracies: Sequence[float] = ACCURACIES,
    repeat: int = REPEAT,
    progress: Progress = silent,
) -> ConvergenceStudy:
    """Run a driving-point frequency response over a series of meshes.

    The error is the largest difference of the complex receptance at any frequency, relative to the largest receptance.

    Args:
        model, modal_damping: as for `frf`.
        fmax: highest frequency in Hz; above the sixth elastic mode where not given.
        at: where force and response are, as for `frf`; y of the first disk, gear or bearing where not given.
        elements, accuracies, repeat: as for `convergence_study`.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: no place to take, or no elastic mode that says how far to go.
    """
    place = at or _place(model)
    if fmax is None:
        found = elastic_frequencies(modal(model, modes=_MODES + 12))
        if not found.size:
            raise AnalysisError("the model has no elastic mode that says how far to go: give --fmax")
        fmax = _ABOVE * float(found[min(_MODES, found.size) - 1])

    def run(options: dict[str, float], of: Model = model) -> FrequencyResponse:
        return frf(
            of,
            inputs=[place],
            outputs=[place],
            fmax=fmax,
            points=FREQUENCIES,
            modal_damping=modal_damping,
            **options,  # type: ignore[arg-type]
        )

    progress(0.0, "reference")
    finest = run({"accuracy": REFERENCE}, as_continuum(model))

    def judge(result: FrequencyResponse) -> Judged:
        error = relative_change(finest.receptance, result.receptance)
        return Judged(result.dofs, np.array([error]), np.array([result.error_estimate]))

    study = Study(run, judge, RESOLUTION, repeat=repeat)
    rungs = study.rungs(mesh_settings(elements, accuracies), part_of(progress, 0.1, 1.0))
    words = (
        f"elements of high order, {finest.dofs} dofs, its own error estimated at {finest.error_estimate:.0e}; force and "
        f"response at {place}, {FREQUENCIES} frequencies to {fmax:.5g} Hz"
    )
    return ConvergenceStudy(
        model.title or "model", "frf", words, 1, rungs, compared="receptance", resolution=RESOLUTION
    )


def _forces(result: ResponseResult) -> np.ndarray:
    """All forces over speed, (s, o, f); displacements where the model has neither mesh nor bearing."""
    speeds = len(result.speeds)
    orders = len(result.orders)
    held = result.bearing_force.transpose(1, 0, 2, 3).reshape(speeds, orders, -1)
    forces = np.concatenate([result.mesh_force.transpose(1, 0, 2), held], axis=2)
    if forces.shape[2]:
        return forces
    return result.displacement[..., :3].transpose(1, 0, 2, 3).reshape(speeds, orders, -1)


def _place(model: Model) -> str:
    direction = "y" if model.has("bending") else "torsion"
    for table in ("disks", "gears", "bearings"):
        for name in getattr(model, table):
            return f"{table}.{name}:{direction}"
    raise AnalysisError("the model has no disk, gear or bearing to take a frequency response at: give a place (--at)")
