"""Update free numbers of a model by the lines and shapes of a test rig: the most probable values, and what the rig taught.

The log of each number is normal about the file's value with the spread of the prior, each measured ln f and each displacement
of a measured shape about the model's with its noise. Gauss-Newton finds the most probable numbers (Tarantola 2005, Inverse
problem theory, section 3.4),

    x = S W^T (1 + W W^T)^-1 N^-1 (y - f(x_k) + J x_k),    W = N^-1 J S,

with J from the modes themselves (`sensitivity.py`), so that a step costs one modal solution. Shapes have no scale: the residual
of measured y and shape phi is y - a phi with the a that fits best, and its derivative loses what lies along phi. Shapes of
close modes are compared as the plane they span: y less its projection on it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.rig.compare_result import ABOVE_RIG, rig_lines_of
from rotorgear.analysis.rig.learnt import line_noise
from rotorgear.analysis.rig.mac import mac
from rotorgear.analysis.rig.measured import Measured
from rotorgear.analysis.rig.mesh_of_model import plan_of
from rotorgear.analysis.rig.pairing import pairs_of
from rotorgear.analysis.rig.posterior import Posterior
from rotorgear.analysis.rig.rig_model import RigModel, RigModes
from rotorgear.analysis.rig.shape_file import read_rig_shapes
from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.model.free_numbers import DEFAULT_PRIOR, free_numbers
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.results.comparison import RigLine
from rotorgear.results.update import UpdatedLine, UpdatedParameter, UpdateResult
from rotorgear.system.plan import Plan

# Noise of a measured displacement, as a share of the root mean square of its shape.
SHAPE_NOISE = 0.02
# Shapes of modes closer than this in ln f turn into each other at the slightest change: their plane is compared, not each.
CLOSE = 0.03
# How much the noise is enlarged on the way: by these shares of a shape's root mean square, and so much of ln f at 1.
_LOOSENESS = (0.5, 0.2, 0.07)
_LOOSE_FREQUENCY = 0.1
# So much further apart are modes still close.
_LOOSE_CLOSE = 0.15
# The mesh is finer than the noise by a tenth, within these bounds.
_MESH_ERROR = (1e-10, 1e-4)
_MOST_SOLUTIONS = 40
_LOOKS = 2
# A step that changes the objective by less than this share moves no number by more than a twentieth of what it is known to.
_AT_REST = 1e-5
# A misfit of so many times the number of values, and steps that lessen it by less than this share.
_MISFIT = 2.0
_CRAWL = 0.01


@recorded
def update(
    model: Model,
    rig: str | Path | Measured | Sequence[RigLine | float] | None = None,
    *,
    shapes: str | Path | None = None,
    points: str | Path | None = None,
    free: str | Iterable[str] = "bearings.*.stiffness, meshes.*.stiffness",
    prior: float | str | Mapping[str, float | str] = DEFAULT_PRIOR,
    shape_noise: float = SHAPE_NOISE,
    tolerance: float = 0.05,
    accuracy: float | None = None,
    elements: int | None = None,
    progress: Progress = silent,
) -> UpdateResult:
    """Return the most probable free numbers of a model, given what a rig measured at standstill.

    Args:
        model: the model.
        rig: a rig file (CSV), lines, plain frequencies in Hz, or lines with measured shapes (`rg.Measured`).
        shapes: in place of it, a universal file with shapes and their frequencies, and
        points: its table of sensors, as in `rg.read_rig_shapes`; None: each node is at the nearest place of the model.
        free: addresses of numbers, with commas between; "*" stands for all names or places there.
        prior: relative standard deviation of the free numbers before the test, of all or by address.
        shape_noise: standard deviation of a measured displacement over the root mean square of its shape.
        tolerance: largest |f_mode / f_rig - 1| of a pair where no shapes were measured.
        accuracy: relative accuracy of the frequencies that the mesh is refined to; default: a tenth of the least noise of a line,
            at most 1e-4.
        elements: so many basic elements in each piece of a section, and no refinement.
        progress: callable that is told fraction and step.

    Returns:
        Numbers with their spread before and after, lines with predictions from the others, the updated model.

    Raises:
        AnalysisError: no lines, no line near a mode, points that the model has not, noise that makes no sense.
        ModelError: addresses that lead nowhere, a rig file that can't be read.
        ConvergenceError: the steps don't come to rest.
    """
    given = _measured(model, rig, shapes, points)
    given.check_points(model)
    if not 0.0 < shape_noise < 1.0:
        raise AnalysisError(f"the noise of shapes is a share between 0 and 1, such as 0.02; got {shape_noise:g}")
    numbers = free_numbers(model, free, prior)
    # A stiffness that is a third too low hides a line's mode a sixth below it: all modes are wanted that may belong to it.
    reach = ABOVE_RIG * (1.0 + 0.5 * float(numbers.prior.max()))
    fmax = reach * max(line.frequency_hz for line in given.lines)
    progress(0.05, "mesh")
    least = min(line_noise(line) for line in given.lines)
    plan = Plan(elements) if elements else plan_of(model, fmax, accuracy or float(np.clip(0.1 * least, *_MESH_ERROR)))
    problem = _Problem(RigModel(numbers, plan, fmax, given.points), given, shape_noise, tolerance)
    start = problem.start()
    if not start.pairs:
        raise AnalysisError("no line of the rig is near a mode of the model: check units, or raise --tolerance")
    near = problem.approach(start, progress)
    state, posterior = problem.estimate(near, progress)
    return _result(problem, start, state, posterior)


def _measured(
    model: Model,
    rig: str | Path | Measured | Sequence[RigLine | float] | None,
    shapes: str | Path | None,
    points: str | Path | None,
) -> Measured:
    """What was measured, from whichever of the two it is given by."""
    if (rig is None) == (shapes is None):
        raise AnalysisError("give what was measured: --rig lines.csv, or --shapes rig.uff with --points sensors.csv")
    if shapes is not None:
        return read_rig_shapes(shapes, points, model)
    if points is not None:
        raise AnalysisError("--points belongs to --shapes: the table of sensors says where each node is")
    assert rig is not None
    return rig if isinstance(rig, Measured) else Measured(rig_lines_of(rig))


@dataclass(frozen=True)
class _Pair:
    """A line and its mode; `near` are the modes close to it, itself among them."""

    line: int
    mode: int
    near: tuple[int, ...]


@dataclass(frozen=True)
class _State:
    """The model at x beside the rig.

    Attributes:
        x: logs of the factors (p,).
        modes: of the model there.
        pairs: lines and modes.
        residual: measured less computed: of each pair ln f, then its shape (n,).
        noise: standard deviations of the rows (n,).
        owner: line of each row (n,).
        objective: squared residuals in units of the noise, and of x in units of the prior.
    """

    x: NDArray[np.float64]
    modes: RigModes
    pairs: tuple[_Pair, ...]
    residual: NDArray[np.float64]
    noise: NDArray[np.float64]
    owner: NDArray[np.intp]
    objective: float


@dataclass(frozen=True)
class _Problem:
    """The estimate of a model's numbers; `looseness` adds to the noise while modes may still be taken for others."""

    model: RigModel
    given: Measured
    shape_noise: float
    tolerance: float
    looseness: float = 0.0

    def start(self) -> _State:
        """The state of the file's numbers."""
        x = np.zeros(len(self.model.numbers.addresses))
        modes = self.model.modes(x)
        return self._beside(x, modes, self._pairs(x, modes, None))

    def approach(self, start: _State, progress: Progress) -> _State:
        """One step each against noise that is less and less enlarged; modes are paired anew after each.

        Far from the truth close modes stand in for each other, and full trust in a wrong pair would lead astray.
        """
        state = start
        posterior = None
        for k, looseness in enumerate(_LOOSENESS):
            progress(0.1 + 0.1 * k, f"approach {k + 1}")
            loose = replace(self, looseness=looseness)
            state = loose._beside(state.x, state.modes, loose._pairs(state.x, state.modes, posterior))
            posterior = loose._linear(state)
            x = posterior.estimate(state.residual + posterior.jacobian @ state.x)
            modes = self.model.modes(x)
            state = loose._beside(x, modes, state.pairs)
        return self._beside(x, modes, self._pairs(x, modes, posterior))

    def estimate(self, state: _State, progress: Progress) -> tuple[_State, Posterior]:
        """The most probable x and the posterior about it, by steps of Levenberg (1944) and Marquardt (1963).

        With `damping` 0 a step is Gauss-Newton's. Where the objective would grow, it is held back in the metric of the priors.
        Pairs are looked at again when it rests.
        """
        posterior = self._linear(state)
        damping = 0.0
        looked = 0
        while self.model.solutions < _MOST_SOLUTIONS:
            progress(0.4 + 0.5 * self.model.solutions / _MOST_SOLUTIONS, f"modal solution {self.model.solutions + 1}")
            # |N^-1 (r - J d)|^2 + |S^-1 (x + d)|^2 + damping |S^-1 d|^2, squared out for d, is a prior about -x / (1 + damping).
            pull = state.x / (1.0 + damping)
            held = Posterior(posterior.jacobian, posterior.noise, posterior.prior / np.sqrt(1.0 + damping))
            step = held.estimate(state.residual + posterior.jacobian @ pull) - pull
            x = state.x + step
            modes = self.model.modes(x)
            trial = self._beside(x, modes, _followed(state, modes))
            gain = state.objective - trial.objective
            level = abs(gain) < _AT_REST * max(1.0, state.objective)
            if gain < 0.0 and not level:
                damping = max(10.0 * damping, 1.0)
                continue
            rests = level and damping < 1.0
            state = trial
            posterior = self._linear(state)
            damping = 0.1 * damping if damping > 0.1 else 0.0
            crawls = 0.0 <= gain < _CRAWL * state.objective and state.objective > _MISFIT * len(state.residual)
            if crawls and looked < _LOOKS:
                # A misfit that steps no longer lessen is a wrong pair, most likely: all pairs are open again.
                looked += 1
                damping = 0.0
                state = self.approach(state, progress)
                posterior = self._linear(state)
            elif rests:
                pairs = self._pairs(state.x, state.modes, posterior)
                if pairs == state.pairs or looked == _LOOKS:
                    return state, posterior
                looked += 1
                state = self._beside(state.x, state.modes, pairs)
                posterior = self._linear(state)
        raise ConvergenceError(
            f"the update did not come to rest within {_MOST_SOLUTIONS} modal solutions: free fewer numbers, or give smaller "
            "priors"
        )

    def _pairs(self, x: NDArray[np.float64], modes: RigModes, known: Posterior | None) -> tuple[_Pair, ...]:
        """Pair lines and modes, by what is known of the numbers so far."""
        hz = np.array([line.frequency_hz for line in self.given.lines])
        noise = max(line_noise(line) for line in self.given.lines)
        spread = np.full(len(modes.eigenvalues), np.hypot(noise, _LOOSE_FREQUENCY * self.looseness))
        if self.given.points:
            every = np.arange(len(modes.eigenvalues))
            slopes, _ = self.model.derivatives(x, modes, every, shapes=False)
            prior = self.model.numbers.prior
            before = np.sqrt(np.sum((slopes * prior) ** 2, axis=1)) if known is None else known.spread_of(slopes)
            spread = np.hypot(spread, before)
        found = pairs_of(hz, modes.frequency_hz, spread, self.given.real_shapes, modes.at_points, self.tolerance)
        return tuple(_Pair(line, mode, _close(modes, mode, self.looseness)) for line, mode in found)

    def shape_points(self, line: int) -> NDArray[np.intp]:
        """Points at which the shape of a line is compared; a shape at a single point is all scale."""
        known = np.flatnonzero(np.isfinite(self.given.real_shapes[line]))
        return known if len(known) > 1 else known[:0]

    def _beside(self, x: NDArray[np.float64], modes: RigModes, pairs: tuple[_Pair, ...]) -> _State:
        """Residuals of the model at x."""
        residual: list[float] = []
        noise: list[float] = []
        owner: list[int] = []
        for pair in pairs:
            rig = self.given.lines[pair.line]
            residual.append(float(np.log(rig.frequency_hz / modes.frequency_hz[pair.mode])))
            noise.append(float(np.hypot(line_noise(rig), _LOOSE_FREQUENCY * self.looseness)))
            owner.append(pair.line)
            points = self.shape_points(pair.line)
            if len(points):
                y = self.given.real_shapes[pair.line, points]
                residual += list(_off_subspace(modes.at_points[np.ix_(np.array(pair.near), points)].T, y))
                share = np.hypot(self.shape_noise, self.looseness)
                noise += [float(share * np.sqrt(np.mean(y**2)))] * len(points)
                owner += [pair.line] * len(points)
        r = np.array(residual)
        sigma = np.array(noise)
        objective = float(np.sum((r / sigma) ** 2) + np.sum((x / self.model.numbers.prior) ** 2))
        return _State(x, modes, pairs, r, sigma, np.array(owner, dtype=np.intp), objective)

    def _linear(self, state: _State) -> Posterior:
        """The linear model about a state."""
        modes = state.modes
        with_shapes = bool(self.given.points)
        chosen = sorted({k for pair in state.pairs for k in (pair.near if with_shapes else (pair.mode,))})
        place = {mode: k for k, mode in enumerate(chosen)}
        at = np.array(chosen, dtype=np.intp)
        slopes, shape_slopes = self.model.derivatives(state.x, modes, at, shapes=with_shapes)
        rows: list[NDArray[np.float64]] = []
        for pair in state.pairs:
            rows.append(slopes[place[pair.mode]])
            points = self.shape_points(pair.line)
            if len(points):
                basis = modes.at_points[np.ix_(np.array(pair.near), points)].T
                share = np.linalg.lstsq(basis, self.given.real_shapes[pair.line, points], rcond=None)[0]
                change = sum(a * shape_slopes[place[k]][points] for a, k in zip(share, pair.near, strict=True))
                rows += list(_off_subspace(basis, np.asarray(change)))
        return Posterior(np.array(rows).reshape(-1, len(state.x)), state.noise, self.model.numbers.prior)


def _close(modes: RigModes, mode: int, looseness: float) -> tuple[int, ...]:
    """The modes that are close to one, itself among them."""
    near = np.abs(np.log(modes.eigenvalues / modes.eigenvalues[mode])) < 2.0 * (CLOSE + _LOOSE_CLOSE * looseness)
    return tuple(int(k) for k in np.flatnonzero(near))


def _followed(before: _State, modes: RigModes) -> tuple[_Pair, ...]:
    """The pairs of a state with each mode at its new place: the one-to-one assignment of most overlap."""
    from scipy.optimize import linear_sum_assignment

    old = sorted({k for pair in before.pairs for k in pair.near})
    _, new = linear_sum_assignment(-before.modes.overlap(modes)[old])
    now = {k: int(mode) for k, mode in zip(old, new, strict=True)}
    return tuple(_Pair(pair.line, now[pair.mode], tuple(sorted(now[k] for k in pair.near))) for pair in before.pairs)


def _off_subspace(basis: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
    """What of y (s,) or (s, p) is no combination of the columns of a basis (s, c)."""
    Q = np.linalg.qr(basis)[0]
    return np.asarray(y - Q @ (Q.T @ y))


def _result(problem: _Problem, start: _State, state: _State, p: Posterior) -> UpdateResult:
    from scipy.stats import chi2

    numbers = problem.model.numbers
    first = {pair.line: pair.mode for pair in start.pairs}
    shapes = problem.given.real_shapes
    before_mac = mac(shapes, start.modes.at_points)
    after_mac = mac(shapes, state.modes.at_points)
    lines = []
    for pair in state.pairs:
        line = pair.line
        mode = pair.mode
        held_out, sigma = _held_out(state, p, pair)
        old = first.get(line, mode)
        has_shape = bool(len(problem.shape_points(line)))
        lines.append(
            UpdatedLine(
                rig=problem.given.lines[line],
                mode_number=mode + 1,
                before_hz=float(start.modes.frequency_hz[min(old, len(start.modes.eigenvalues) - 1)]),
                after_hz=float(state.modes.frequency_hz[mode]),
                held_out_hz=held_out,
                held_out_sigma=sigma,
                mac_before=float(before_mac[line, old]) if has_shape else None,
                mac_after=float(after_mac[line, mode]) if has_shape else None,
            )
        )
    paired = {pair.line for pair in state.pairs}
    # Each shape has a scale of its own, or its place among close ones, that is fitted to it.
    fitted = (len(pair.near) for pair in state.pairs if len(problem.shape_points(pair.line)))
    count = len(state.residual) - sum(fitted)
    rows = zip(numbers.addresses, p.prior, p.sigma, p.learnt, np.exp(state.x), strict=True)
    return UpdateResult(
        model=numbers.model,
        parameters=tuple(
            UpdatedParameter(address, float(prior), float(sigma), float(learnt), float(factor))
            for address, prior, sigma, learnt, factor in rows
        ),
        lines=tuple(lines),
        unmatched=tuple(line for k, line in enumerate(problem.given.lines) if k not in paired),
        correlation=p.correlation,
        points=problem.given.points,
        chi_squared=state.objective,
        measured_values=count,
        misfit_probability=float(chi2.sf(state.objective, count)),
        modal_solutions=problem.model.solutions,
        dofs=state.modes.system.n,
        method="Gauss-Newton on ln f and shapes, derivatives from the modes",
        left_out=(
            "damping and rotation: lines are undamped natural frequencies at standstill",
            "the spread of lines predicted from the others is that of the linear model about the estimate",
        ),
        warnings=problem.given.notes,
    )


def _held_out(state: _State, p: Posterior, pair: _Pair) -> tuple[float, float]:
    """Frequency of a line in Hz as the other lines predict it, and its relative standard deviation with the noise of the line."""
    others = state.owner != pair.line
    linear = state.residual + p.jacobian @ state.x
    rest = Posterior(p.jacobian[others], p.noise[others], p.prior)
    own = int(np.flatnonzero(state.owner == pair.line)[0])
    slope = p.jacobian[own]
    x = rest.estimate(linear[others])
    predicted = float(state.modes.frequency_hz[pair.mode] * np.exp(slope @ (x - state.x)))
    spread = float(rest.spread_of(slope[None])[0])
    return predicted, float(np.hypot(p.noise[own], spread))
