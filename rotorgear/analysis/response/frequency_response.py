"""Frequency responses between places: H(w) = P_o^T (K + i w C - w^2 M)^-1 P_i, by direct solutions, or in a basis of some.

Ewins, Modal Testing, 2nd ed., chapter 2 (Research Studies Press 2000).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from rotorgear.analysis.common.casings import with_casing_modes
from rotorgear.analysis.common.discretise import pieces
from rotorgear.analysis.common.forecast import Forecast
from rotorgear.analysis.common.left_out import GIVE_DAMPING, left_out
from rotorgear.analysis.common.points import moving_rows, rotates
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import check_modal_damping, check_request, check_whole, missed, speed_in_si
from rotorgear.analysis.common.stream import Piece, Stream, unkept
from rotorgear.analysis.common.stream import pieces as kept_pieces
from rotorgear.analysis.modal.refine import all_finer
from rotorgear.analysis.response.mesh import aims, damped_plant, highest_peaks, meshed
from rotorgear.analysis.response.outputs import Outputs, output_rows, output_unit
from rotorgear.analysis.static.mean_state import about_mean
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model, model_hash
from rotorgear.note import Note
from rotorgear.progress import Progress, part_of, silent
from rotorgear.results.frequency_response import FrequencyResponse
from rotorgear.results.laws import about_state, law_rows
from rotorgear.solvers.frequency.frequency_range import FrequencyRange
from rotorgear.solvers.frequency.harmonic import Dynamics
from rotorgear.solvers.sparse.factor import single_thread
from rotorgear.solvers.sparse.pencil import EPS
from rotorgear.system.bubble_errors import ForcedChanges
from rotorgear.system.damped_range import damped_up_to, undamped_above
from rotorgear.system.system import System

POINTS = 1000
_CHECKED_ON_FINER = 4
# Rounding below this is nothing beside the error of any mesh, and is not told.
_ROUNDING = 1e-9
_UNDAMPED = Note(
    "",
    "nothing damps the model",
    f"heights near a resonance are those of the nearest frequency; {GIVE_DAMPING}, or --modal-damping",
)


@recorded
def frf(
    model: Model,
    frequencies: Sequence[float] | np.ndarray | None = None,
    *,
    inputs: Sequence[str],
    outputs: Sequence[str],
    fmax: float | None = None,
    fmin: float | None = None,
    points: int = POINTS,
    speed: float | str | None = None,
    modal_damping: float = 0.0,
    elements: int | None = None,
    accuracy: float | None = None,
    stream: Stream | None = None,
    progress: Progress = silent,
) -> FrequencyResponse:
    """Return receptances between places, with the model's damping and, at a speed, its gyroscopic moments.

    Args:
        model: any model; contacts are closed, on the flanks that its loads choose.
        frequencies: frequencies in Hz, positive, (f,), in place of an evenly spaced range.
        inputs: places where unit forces act: points, a part and a direction such as "bearings.left:x", a seat of a casing such
            as "casings.box.left:x", or the point of its surface next to a place, "casings.box(0 mm; 280 mm; 200 mm):y".
        outputs: places where the response is read, named as the inputs are, and points that read a load.
        fmax: highest frequency of the range in Hz.
        fmin: lowest frequency of the range in Hz (default: one step).
        points: number of frequencies between them, evenly spaced.
        speed: speed of the input shaft in rad/s or with its unit (default: standstill).
        modal_damping: as in `response`.
        elements: as in `response`.
        accuracy: refine the mesh until each response is estimated to be within this share of its largest (default: modes up to
            the highest frequency are refined to 1e-3, whatever that makes of the responses).
        stream: keeps solutions while frequencies are solved (`rotorgear.stream`), and starts an interrupted run again.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: a place that the model has not, a frequency that is not positive.
        ConvergenceError: an undamped resonance is hit exactly.
    """
    turns = speed_in_si(speed) or 0.0
    if frequencies is None:
        frequencies = _evenly_spaced(fmin, fmax, points)
    hz = np.sort(np.asarray(frequencies, float).ravel())
    check_request(elements=elements, accuracy=accuracy)
    if not hz.size or not np.all(np.isfinite(hz)) or hz[0] <= 0.0:
        raise AnalysisError("frequencies: expected at least one, all of them positive, in Hz")
    check_modal_damping(modal_damping)
    places = checked_places(model, inputs, outputs)
    asked = (hz.tolist(), tuple(inputs), tuple(outputs), turns, modal_damping, elements, accuracy)
    piece = kept_pieces(stream, {"model": model_hash(model), "run": repr(asked)})
    given = model
    model, few = with_casing_modes(model, float(hz[-1]))
    zeta = modal_damping + model.damping.modal_ratio
    about = about_mean(model, [turns or None], turns)

    for aim in aims(accuracy):
        progress(0.02, "discretisation")
        system = meshed(model, about, turns, float(hz[-1]), elements, aim)
        limit = damped_up_to(system, 2.0 * np.pi * float(hz[-1]))
        solved = _solved(system, turns, hz, (inputs, outputs), (limit, zeta), progress, piece)
        receptance = solved.receptance
        progress(0.96, "error estimate")
        where = (inputs, outputs), (limit, zeta)
        estimate = receptance_error(system, turns, hz, receptance, solved.bubble_change, *where, piece)
        if solved.error > _ROUNDING:
            estimate = max(estimate, solved.error)
        if accuracy is None or estimate <= accuracy:
            break
    short = missed(accuracy, estimate, "ask for less, or give more damping to resonances in the range")
    progress(1.0, "done")
    return FrequencyResponse(
        model=given,
        speed=turns,
        frequency_hz=hz,
        **places,
        receptance=receptance,
        damping_ratio=zeta,
        residual=solved.residual,
        error_estimate=estimate,
        dofs=system.n,
        discretisation=pieces(system),
        laws=law_rows(system.state.operating),
        left_out=(
            *about[1].notes,
            *left_out(system, "frf", turns, modal_damping=modal_damping),
            *undamped_above(limit, zeta),
        ),
        warnings=(*few, *([] if zeta or system.damping(turns).nnz else [_UNDAMPED]), *([short] if short else [])),
        status=short or "success",
        method=solved.method + about_state(system.state),
    )


def checked_places(model: Model, inputs: Sequence[str], outputs: Sequence[str]) -> dict[str, Any]:
    """Places of forces and of displacements with their units, as results have them.

    Raises:
        AnalysisError: there is none of either, or one that the model has not.
    """
    if not inputs or not outputs:
        raise AnalysisError("inputs and outputs: expected at least one place where a force acts and one that is read")
    return {
        "inputs": tuple(inputs),
        "outputs": tuple(outputs),
        "input_units": tuple("N m" if rotates(model, text) else "N" for text in inputs),
        "output_units": tuple(output_unit(model, text) for text in outputs),
    }


def _evenly_spaced(fmin: float | None, fmax: float | None, points: int) -> np.ndarray:
    """Frequencies in Hz; without `fmin` from one step above 0, where the receptance of a rigid-body rotation is infinite."""
    check_whole("the number of points", points, 2)
    if fmax is None:
        raise AnalysisError(
            "a frequency response needs its frequencies, or fmax (--fmax), the highest of a range in Hz"
        )
    low = fmax / points if fmin is None else fmin
    if not 0.0 < low < fmax < float("inf"):
        raise AnalysisError(f"fmin and fmax: got {low:g} and {fmax:g} Hz, expected 0 < fmin < fmax")
    return np.linspace(low, fmax, points)


@dataclass(frozen=True)
class _Solved:
    """Receptances over frequencies.

    Attributes:
        receptance: (f, o, i).
        bubble_change: what polynomials that the shaft elements lack would change of the receptance at each input, (f, i).
        residual: the largest, relative to the forces inside.
        error: of the solution, relative: that of a basis; or, if larger, what the rounding of M and K may change: a relative
            change eps of their entries moves the receptance f^T q at the input by up to eps |q|^T (|K| + w^2 |M|) |q|, relative
            to the largest receptance there.
        method: in words.
    """

    receptance: np.ndarray
    bubble_change: np.ndarray
    residual: float
    error: float
    method: str


def _solved(
    system: System,
    speed: float,
    hz: np.ndarray,
    places: tuple[Sequence[str], Sequence[str]],
    damping: tuple[float, float],
    progress: Progress,
    piece: Piece = unkept,
) -> _Solved:
    """Solve each frequency for forces at the first of the places and displacements at the second ones.

    Args:
        system, speed, hz, places: what is solved.
        damping: frequency in rad/s up to which modes have a damping ratio beside the damping of the model, and that ratio.
        progress: is told how far it is.
        piece: does the work of a piece, or takes it over.
    """
    plant = damped_plant(system, speed, *damping)
    dynamics = plant.dynamics(speed)
    outputs = output_rows(plant, places[1], speed)
    w = 2.0 * np.pi * hz
    f = moving_rows(system, places[0]).T

    def solve(at: np.ndarray) -> Sequence[np.ndarray]:
        done = piece(lambda: {"solutions": tuple(np.ascontiguousarray(dynamics.solve(float(one), f)) for one in at)})
        solutions: tuple[np.ndarray, ...] = done["solutions"]
        return solutions

    with single_thread(system.n):
        found = FrequencyRange(dynamics, w, f, part_of(progress, 0.05, 0.5), solve)
        rows = []
        measuring = Forecast("frf", 0.0, whole="for the frequencies").measuring(progress, 0.95)
        for at in found.blocks():
            measuring(0.5 + 0.45 * at[0] / len(hz), f"{hz[at[0]]:.5g} Hz")
            rows.append(
                piece(partial(_block, system, dynamics, speed, w[at], f, outputs, partial(found.solutions, at)))
            )
    receptance, change = (np.concatenate([row[name] for row in rows]) for name in ("receptance", "change"))
    residual, moved, largest = (
        np.max([row[name] for row in rows], axis=0) for name in ("residual", "moved", "largest")
    )
    rounding = float(np.max(moved / np.where(largest > 0.0, largest, np.inf), initial=0.0))
    return _Solved(receptance, change, float(residual.max()), max(rounding, found.error), found.method)


def _block(
    system: System,
    dynamics: Dynamics,
    speed: float,
    w: np.ndarray,
    f: np.ndarray,
    outputs: Outputs,
    solve: Callable[[], np.ndarray],
) -> dict[str, np.ndarray]:
    """Receptances at some frequencies w (b,) in rad/s, and what shares in their errors: the largest of each input (i,)."""
    solutions = solve()
    size_K = abs(system.stiffness(speed))
    size_M = abs(system.mass)
    bubbles = ForcedChanges.of(system)
    columns: list[tuple[np.ndarray, float, float, float]] = []
    for k in range(f.shape[1]):
        q = solutions[:, :, k].T
        size = np.abs(q)
        felt = EPS * np.sum(size * (size_K @ size + w**2 * (size_M @ size)), axis=0)
        columns.append(
            (
                bubbles.change(speed, w, q, turning=False),
                dynamics.relative_residual(w, f[:, [k]], q),
                float(felt.max()),
                float(np.abs(f[:, k] @ q).max()),
            )
        )
    change, residual, moved, largest = map(np.array, zip(*columns, strict=True))
    found = {"receptance": outputs.of(w, solutions), "change": change.T}
    return {**found, "residual": residual, "moved": moved, "largest": largest}


def receptance_error(
    system: System,
    speed: float,
    hz: np.ndarray,
    receptance: np.ndarray,
    bubble_change: np.ndarray,
    places: tuple[Sequence[str], Sequence[str]],
    damping: tuple[float, float],
    piece: Piece = unkept,
) -> float:
    """Change of receptances (f, o, i) at rising frequencies (f,) in Hz by a finer mesh, over the largest of each response.

    The finer mesh is looked at where a response has its highest peak, and at the peaks of `bubble_change` (f, i), what the
    elements lack: a higher mode may have the larger error where the response itself is low. `damping`, `piece`: as in `_solved`.
    """
    if not any(system.nodes.elements.values()):
        return 0.0
    highest = highest_peaks(np.abs(receptance).reshape(len(hz), -1), 1)
    at = np.union1d(highest, highest_peaks(bubble_change, _CHECKED_ON_FINER))
    there = _solved(system.with_plan(all_finer(system)), speed, hz[at], places, damping, silent, piece).receptance
    return relative_change(there, receptance[at], np.abs(receptance).max(axis=0))


def relative_change(exact: np.ndarray, receptance: np.ndarray, largest: np.ndarray | None = None) -> float:
    """Largest difference of receptances (f, o, i), each relative to the largest size of its response.

    Args:
        exact, receptance: at the same frequencies.
        largest: (o, i) sizes of the responses over more frequencies than these.
    """
    size = np.abs(exact).max(axis=0)
    if largest is not None:
        size = np.maximum(size, largest)
    return float(np.max(np.abs(exact - receptance) / np.where(size > 0.0, size, 1.0)))
