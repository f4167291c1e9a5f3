"""Update free numbers of a model by what a test rig measured: the most probable values, and what the rig taught.

The log of each number is normal about the file's value with the spread of the prior, each measured ln f, each displacement of a
measured shape and each ln H of a frequency response about the model's with its noise (`misfit.py`). Steps towards the most
probable numbers take derivatives from the modes themselves (`analysis/sensitivity`), so that each costs one modal solution.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import check_modal_damping, share_of, speed_in_si
from rotorgear.analysis.rig.compare import ABOVE_RIG
from rotorgear.analysis.rig.frf_misfit import FrfMisfit
from rotorgear.analysis.rig.likeness import frac, mac
from rotorgear.analysis.rig.measured import Campaign, Measured, MeasuredFrf, joined, read_campaigns
from rotorgear.analysis.rig.misfit import SHAPE_NOISE, Fit, Misfit, approach, first_fit, most_probable
from rotorgear.analysis.rig.posterior import LINE_NOISE, Posterior, line_noise
from rotorgear.analysis.rig.receptance_model import CARRIED
from rotorgear.analysis.rig.rig_model import RigModel, plan_of
from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.model.model import Model
from rotorgear.model.numbers import DEFAULT_PRIOR, free_numbers
from rotorgear.note import Note
from rotorgear.progress import Progress, silent
from rotorgear.results.comparison import RigLine
from rotorgear.results.update import UpdatedLine, UpdatedParameter, UpdatedResponse, UpdateResult
from rotorgear.system.plan import Plan

# Noise of a measured frequency response, as a share of its size.
FRF_NOISE = 0.05
# Noise of a measured damping ratio, as a share of it.
DAMPING_NOISE = 0.1
# The mesh is finer than the noise by a tenth, within these bounds.
_MESH_ERROR = (1e-10, 1e-4)
_BOTH = "its factor is that of both values"


@recorded
def update(
    model: Model,
    rig: str | Path | Measured | Sequence[RigLine | float] | None = None,
    *,
    shapes: str | Path | None = None,
    frf: str | Path | MeasuredFrf | None = None,
    frf_motion: str | None = None,
    points: str | Path | None = None,
    free: str | Iterable[str] = "bearings.*.stiffness, meshes.*.stiffness",
    prior: float | str | Mapping[str, float | str] = DEFAULT_PRIOR,
    shape_noise: float = SHAPE_NOISE,
    frf_noise: float = FRF_NOISE,
    damping_noise: float = DAMPING_NOISE,
    modal_damping: float = 0.0,
    speed: float | str | None = None,
    campaigns: str | Path | Sequence[Campaign] | None = None,
    tolerance: float = 0.05,
    accuracy: float | None = None,
    elements: int | None = None,
    progress: Progress = silent,
) -> UpdateResult:
    """Return the most probable free numbers of a model, given what a rig measured.

    Args:
        model: the model.
        rig: measured frequencies (CSV); in Python also lines, plain frequencies in Hz, or lines with measured shapes
            (`rg.Measured`).
        shapes: measured mode shapes with their frequencies (UFF, dataset 55), in place of the frequencies alone.
        frf: measured frequency responses (UFF, dataset 58), beside frequencies or shapes or alone; in Python also what
            `rg.read_rig_frf` read.
        frf_motion: what responses are where neither their type in the file nor their unit says it: "displacement", "velocity" or
            "acceleration".
        points: table of the sensors of shapes and responses (CSV: point,node,direction; default: each node is at the nearest
            place of the model).
        free: addresses of the free numbers, with commas between; "*" stands for all names or places there.
        prior: relative standard deviation of the free numbers before the test; in Python also by address.
        shape_noise: standard deviation of a measured displacement, as a share of the root mean square of its shape.
        frf_noise: standard deviation of a measured frequency response, as a share of its size.
        damping_noise: relative standard deviation of the damping ratios of lines, such as those of ring-downs; they are compared
            where a damping is among the free numbers.
        modal_damping: damping ratio added to every elastic mode of the frequency responses.
        speed: speed of the input shaft while it was measured, in rad/s or with its unit (default: standstill).
        campaigns: several campaigns, each at its speed and in its state of the gearbox, in place of all these: their file
            (TOML); in Python also a list of `rg.Campaign`.
        tolerance: largest relative difference |f_mode / f_rig - 1| of a pair where no shapes were measured.
        accuracy: relative accuracy of the frequencies that the mesh is refined to (default: a tenth of the least noise of a
            line, at most 1e-4).
        elements: as in `modal`.
        progress: callable that is told fraction and step.

    Returns:
        Numbers with their spread before and after, lines with predictions from the others, the updated model.

    Raises:
        AnalysisError: no lines, no line near a mode, points that the model has not, noise that makes no sense.
        ModelError: addresses that lead nowhere, a rig file that can't be read.
        ConvergenceError: the steps do not converge.
    """
    shape_noise = share_of(shape_noise, "shape_noise", "0.02")
    frf_noise = share_of(frf_noise, "frf_noise", "0.05")
    damping_noise = share_of(damping_noise, "damping_noise", "0.1")
    check_modal_damping(modal_damping)
    several: Sequence[Campaign] = (Campaign(rig, shapes, points, speed, frf=frf, frf_motion=frf_motion),)
    if campaigns is not None:
        if several[0] != Campaign():
            raise AnalysisError(
                "campaigns have their own rig, shapes, frf, points and speed: give these in each of them"
            )
        several = read_campaigns(campaigns) if isinstance(campaigns, str | Path) else tuple(campaigns)
        if not several:
            raise AnalysisError("there are no campaigns to update by")
    tolerance = share_of(tolerance, "tolerance", "0.05")
    numbers = free_numbers(model, free, prior)
    progress(0.05, "mesh")
    measured = []
    models = []
    responses = {}
    # A stiffness that is a third too low hides a line's mode a sixth below it: all modes are wanted that may belong to it.
    reach = ABOVE_RIG * (1.0 + 0.5 * float(numbers.prior.max()))
    for number, campaign in enumerate(several):
        own = model.with_(campaign.changes) if campaign.changes else model
        given, receptances = campaign.measured(own)
        measured.append(given)
        fmax = reach * max((line.frequency_hz for line in given.lines), default=0.0)
        if receptances:
            fmax = max(CARRIED * float(receptances.frequency_hz[-1]), fmax)
        least = min((line_noise(line) for line in given.lines), default=LINE_NOISE)
        wanted = accuracy or float(np.clip(0.1 * least, *_MESH_ERROR))
        plan = Plan(elements) if elements else plan_of(own, fmax, wanted)
        there = free_numbers(own, numbers.addresses, prior)
        models.append(RigModel(there, plan, fmax, given.points, speed_in_si(campaign.speed) or 0.0))
        if receptances:
            responses[number] = FrfMisfit(models[-1], receptances, frf_noise, modal_damping)
    every, owner = joined(measured)
    damps = damping_noise if any("damping" in address for address in numbers.addresses) else None
    problem = Misfit(tuple(models), every, owner, shape_noise, tolerance, responses, damping_noise=damps)
    start = first_fit(problem)
    if not start.pairs and not responses:
        raise AnalysisError("no line of the rig is near a mode of the model: check units, or raise --tolerance")
    doubts = [doubt for number, one in responses.items() for doubt in one.doubts(start.x, start.modes.parts[number])]
    try:
        near = approach(problem, start, progress)
        end, posterior = most_probable(problem, near, progress)
    except ConvergenceError as error:
        raise ConvergenceError("; ".join([str(error), *doubts])) from None
    doubts += [
        Note("", f"campaign {one.name or number}: {address} is free and has another value there", _BOTH)
        for number, one in enumerate(several, start=1)
        for address in numbers.addresses
        if any(address == name or address.startswith(f"{name}.") for name in one.changes)
    ]
    names = [one.name if len(several) > 1 else "" for one in several]
    return _result(model, names, problem, start, end, posterior, doubts)


def _result(
    model: Model, campaigns: list[str], problem: Misfit, start: Fit, state: Fit, p: Posterior, doubts: list[Note]
) -> UpdateResult:
    from scipy.stats import chi2

    numbers = problem.numbers
    first = {pair.line: pair.mode for pair in start.pairs}
    before_hz = start.modes.frequency_hz
    after_hz = state.modes.frequency_hz
    before_mac = mac(problem.shapes, start.modes.at_points)
    after_mac = mac(problem.shapes, state.modes.at_points)
    lines = []
    for pair in state.pairs:
        line = pair.line
        mode = pair.mode
        campaign = problem.owner[line]
        # As the other lines predict it, with the noise of the line.
        row = int(np.flatnonzero(state.owner == line)[0])
        rest, x = _without(state, p, state.owner == line)
        slope = p.jacobian[row]
        spread = float(rest.spread_of(slope[None])[0])
        old = first.get(line, mode)
        has_shape = bool(len(problem.shape_points(line)))
        lines.append(
            UpdatedLine(
                rig=problem.given.lines[line],
                campaign=campaigns[campaign],
                mode_number=int(state.modes.numbers[mode]),
                before_hz=float(before_hz[min(old, len(before_hz) - 1)]),
                after_hz=float(after_hz[mode]),
                held_out_hz=float(after_hz[mode] * np.exp(slope @ (x - state.x))),
                held_out_sigma=float(np.hypot(p.noise[row], spread)),
                damping_before=float(start.modes.damping_ratio[old]) if problem.measures_damping(line) else None,
                damping_after=float(state.modes.damping_ratio[mode]) if problem.measures_damping(line) else None,
                mac_before=float(before_mac[line, old]) if has_shape else None,
                mac_after=float(after_mac[line, mode]) if has_shape else None,
            )
        )
    paired = {pair.line for pair in state.pairs}
    # Each shape has a scale of its own, or its place among close ones, that is fitted to it.
    fitted = (
        len(pair.near) * (2 if problem.owner[pair.line] in problem.turning else 1)
        for pair in state.pairs
        if len(problem.shape_points(pair.line))
    )
    count = len(state.residual) - sum(fitted)
    left_out: list[str] = []
    if problem.given.lines:
        what = "damping" if problem.turning else "damping and rotation"
        if any(row.damping_after is not None for row in lines):
            what = f"what {what} does to shapes and frequencies"
        where = "at the speeds of the campaigns" if problem.turning else "at standstill"
        left_out.append(Note("", what, f"lines are undamped natural frequencies {where}"))
        left_out.append("the spread of lines predicted from the others is that of the linear model about the estimate")
    for number, response in problem.responses.items():
        error = response.basis_error(state.x, state.modes.parts[number])
        why = f"within {error:.0e} of the whole system's at 3 peaks"
        left_out += [*response.notes, Note("", "shapes above those that carry the responses", why)]
    one_sensor = Note(
        "", "shapes at a single sensor have a size and no direction to compare", "the frequencies alone are used"
    )
    rows = np.column_stack([p.prior, p.sigma, p.learnt, np.exp(state.x)]).tolist()
    return UpdateResult(
        model=model,
        parameters=tuple(UpdatedParameter(a, *row) for a, row in zip(numbers.addresses, rows, strict=True)),
        lines=tuple(lines),
        responses=tuple(_response_rows(campaigns, problem, start, state, p)),
        unmatched=tuple(line for k, line in enumerate(problem.given.lines) if k not in paired),
        correlation=p.correlation,
        points=problem.given.points,
        chi_squared=state.objective,
        measured_values=count,
        misfit_probability=float(chi2.sf(state.objective, count)),
        modal_solutions=problem.solutions,
        dofs=state.modes.parts[0].system.n,
        method="Gauss-Newton on ln f, shapes and ln H, derivatives from the modes",
        left_out=tuple(left_out),
        warnings=(
            *problem.given.notes,
            *([one_sensor] if len(problem.given.points) == 1 else []),
            *(note for one in problem.responses.values() for note in one.given.notes),
            *doubts,
        ),
    )


def _response_rows(
    campaigns: list[str], problem: Misfit, start: Fit, state: Fit, p: Posterior
) -> Iterator[UpdatedResponse]:
    """Each measured frequency response beside the model before, after, and after all others alone."""
    owner = 0
    for number, one in problem.responses.items():
        before = one.computed(start.x, start.modes.parts[number])
        after = one.computed(state.x, state.modes.parts[number])
        pairs = zip(one.given.responses, one.given.references, one.measured, before, after, strict=True)
        for response, reference, rig, first, last in pairs:
            owner -= 1
            own = state.owner == owner
            moved = p.jacobian[own] @ (_without(state, p, own)[1] - state.x)
            half = len(moved) // 2
            yield UpdatedResponse(
                campaign=campaigns[number],
                response=response,
                reference=reference,
                frac_before=frac(rig, first),
                frac_after=frac(rig, last),
                frac_held_out=frac(rig, last * np.exp(moved[:half] + 1j * moved[half:])),
            )


def _without(state: Fit, p: Posterior, own: NDArray[np.bool_]) -> tuple[Posterior, NDArray[np.float64]]:
    """What all other rows teach, and the numbers that they make most probable, to first order about the estimate."""
    rest = Posterior(p.jacobian[~own], p.noise[~own], p.prior)
    return rest, rest.estimate((state.residual + p.jacobian @ state.x)[~own])
