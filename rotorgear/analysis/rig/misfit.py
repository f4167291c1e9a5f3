"""What a model with free numbers shows beside what was measured: residuals, their noise, and their derivatives.

What was measured in several states of the gearbox, or at several speeds, are campaigns: each has a model of its own, and all
share the logs of the free factors. Their modes follow one another in one list.

Shapes have no scale: the residual of measured y and shape phi is y - a phi with the a that fits best, and its derivative loses
what lies along phi. Shapes of close modes are compared as the plane they span: y less its projection on it. Frequency responses
follow the pairs of lines and modes (`frf_misfit.py`): they need none.

The most probable numbers are found by loose steps, which find the pairs, then by Gauss-Newton steps that are held back:

    x = S W^T (1 + W W^T)^-1 N^-1 (y - f(x_k) + J x_k),    W = N^-1 J S    (Tarantola 2005, Inverse problem theory, section 3.4)
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rotorgear.analysis.common.left_out import GIVE_DAMPING
from rotorgear.analysis.rig.frf_misfit import FrfMisfit
from rotorgear.analysis.rig.likeness import pairs_of
from rotorgear.analysis.rig.measured import Measured
from rotorgear.analysis.rig.posterior import Posterior, line_noise
from rotorgear.analysis.rig.rig_model import RigModel, RigModes
from rotorgear.analysis.sensitivity.forms import Shapes
from rotorgear.errors import AnalysisError, ConvergenceError
from rotorgear.model.numbers import FreeNumbers
from rotorgear.progress import Progress

# Noise of a measured displacement, as a share of the root mean square of its shape.
SHAPE_NOISE = 0.02
# Shapes of modes closer than this in ln f turn into each other at the slightest change: their plane is compared, not each.
CLOSE = 0.03
# Where looseness is 1, modes this much further apart still count as close, and ln f has this much more noise.
_LOOSE_CLOSE = 0.15
_LOOSE_FREQUENCY = 0.1
# Looseness of each step towards the numbers: what is added to the noise, as a share of a shape's root mean square.
_LOOSENESS = (0.5, 0.2, 0.07)
_MOST_SOLUTIONS = 40
_LOOKS = 2
# A step that changes the objective by less than this share moves no number by more than a twentieth of what it is known to.
_AT_REST = 1e-5
# Steps crawl where the misfit is this many times the number of values and they lessen it by less than this share.
_MISFIT = 2.0
_CRAWL = 0.01


@dataclass(frozen=True)
class CampaignModes:
    """Modes of all campaigns, one after the other: as `RigModes`, at the points of all (m, s)."""

    parts: tuple[RigModes, ...]
    at_points: Shapes

    @cached_property
    def frequency_hz(self) -> NDArray[np.float64]:
        """Natural frequencies in Hz, (m,)."""
        return np.concatenate([part.frequency_hz for part in self.parts])

    @cached_property
    def damping_ratio(self) -> NDArray[np.float64]:
        """Damping ratios of light damping, (m,)."""
        return np.concatenate([part.damping_ratio for part in self.parts])

    @cached_property
    def campaign(self) -> NDArray[np.intp]:
        """Number of the campaign that each mode belongs to, (m,)."""
        return np.repeat(np.arange(len(self.parts)), [len(part.eigenvalues) for part in self.parts])

    @cached_property
    def numbers(self) -> NDArray[np.intp]:
        """Number of each mode in its campaign, as `modal` counts (m,)."""
        return np.concatenate([part.numbers for part in self.parts])

    def overlap(self, other: CampaignModes) -> NDArray[np.float64]:
        """How far each mode here is one there (m, m'); nothing between campaigns."""
        found = np.zeros((len(self.campaign), len(other.campaign)))
        for number, (part, moved) in enumerate(zip(self.parts, other.parts, strict=True)):
            found[np.ix_(self.campaign == number, other.campaign == number)] = part.overlap(moved)
        return found


@dataclass(frozen=True)
class Pair:
    """A line and its mode; `near` are the modes close to it, itself among them."""

    line: int
    mode: int
    near: tuple[int, ...]


@dataclass(frozen=True)
class Fit:
    """The model at x beside the rig.

    Attributes:
        x: logs of the factors (p,).
        modes: of the model there.
        pairs: lines and modes.
        residual: measured less computed: of each pair ln f, ln zeta, then its shape; then ln H of frequency responses (n,).
        noise: standard deviations of the rows (n,).
        owner: line of each row; -1, -2 ... for the first frequency response, the second ... (n,).
        looseness: that of the noise.
        objective: squared residuals in units of the noise, and of x in units of the prior.
    """

    x: NDArray[np.float64]
    modes: CampaignModes
    pairs: tuple[Pair, ...]
    residual: NDArray[np.float64]
    noise: NDArray[np.float64]
    owner: NDArray[np.intp]
    objective: float
    looseness: float = 0.0


@dataclass(frozen=True)
class Misfit:
    """A model beside a rig.

    Attributes:
        models: those of all campaigns, with the same free factors.
        given: lines and shapes of all campaigns, at the points of all of them.
        owner: campaign of each line (n,).
        shape_noise: standard deviation of a measured displacement over the root mean square of its shape.
        tolerance: largest |f_mode / f_rig - 1| of a pair where no shapes were measured.
        damping_noise: relative standard deviation of a measured damping ratio; None: damping is not compared, since no free
            number damps.
        responses: frequency responses of some campaigns, by number.
        looseness: what is added to the noise while modes may still be taken for others.
    """

    models: tuple[RigModel, ...]
    given: Measured
    owner: NDArray[np.intp]
    shape_noise: float
    tolerance: float
    responses: Mapping[int, FrfMisfit] = field(default_factory=dict)
    looseness: float = 0.0
    damping_noise: float | None = None

    @cached_property
    def turning(self) -> frozenset[int]:
        """Campaigns at a speed: their shapes are complex, and both parts of a misfit count, each with its share of the noise."""
        return frozenset(number for number, model in enumerate(self.models) if model.speed)

    @property
    def numbers(self) -> FreeNumbers:
        """The free numbers, as the first campaign has them."""
        return self.models[0].numbers

    @property
    def solutions(self) -> int:
        """Eigenproblems solved: each campaign has one at every set of numbers, and the most of them counts."""
        return max(model.solutions for model in self.models)

    def modes(self, x: NDArray[np.float64]) -> CampaignModes:
        """The elastic modes at x."""
        parts = tuple(model.modes(x) for model in self.models)
        kind = np.result_type(float, *(part.at_points for part in parts))
        tables = []
        for model, part in zip(self.models, parts, strict=True):
            tables.append(np.zeros((len(part.eigenvalues), len(self.given.points)), dtype=kind))
            tables[-1][:, self._at(model)] = part.at_points
        return CampaignModes(parts, np.concatenate(tables))

    def derivatives(
        self, x: NDArray[np.float64], modes: CampaignModes, chosen: NDArray[np.intp], *, shapes: bool
    ) -> tuple[NDArray[np.float64], Shapes]:
        """d ln f / dx (k, p) and d phi / dx at the points (k, s, p) of k chosen modes."""
        slopes = np.zeros((len(chosen), len(x)))
        kind = complex if np.iscomplexobj(modes.at_points) else float
        moved = np.zeros((len(chosen), len(self.given.points), len(x)), dtype=kind)
        for number, (model, part) in enumerate(zip(self.models, modes.parts, strict=True)):
            rows = np.flatnonzero(modes.campaign[chosen] == number)
            if len(rows):
                first = int(np.searchsorted(modes.campaign, number))
                slopes[rows], at_points = model.derivatives(x, part, chosen[rows] - first, shapes=shapes)
                moved[np.ix_(rows, self._at(model))] = at_points
        return slopes, moved

    def _at(self, model: RigModel) -> NDArray[np.intp]:
        return np.array([self.given.points.index(point) for point in model.points], dtype=np.intp)

    @cached_property
    def shapes(self) -> Shapes:
        """The measured shapes (n, s): turned to be real where the gearbox stood still."""
        real = self.given.real_shapes
        if not self.turning or self.given.shapes is None:
            return real
        turns = np.isin(self.owner, list(self.turning))
        return np.where(turns[:, None], self.given.shapes, real)

    def measures_damping(self, line: int) -> bool:
        """Whether the damping ratio of a line is compared."""
        return self.damping_noise is not None and bool(self.given.lines[line].damping_ratio)

    def parts(self, line: int, values: Shapes) -> NDArray[np.float64]:
        """Real values of a line as they are; of a complex shape the real ones, then the imaginary ones."""
        if self.owner[line] not in self.turning:
            return np.real(values)
        return np.concatenate([np.real(values), np.imag(values)])

    def shape_points(self, line: int) -> NDArray[np.intp]:
        """Points at which the shape of a line is compared; a shape at a single point is all scale."""
        known = np.flatnonzero(np.isfinite(self.shapes[line]))
        return known if len(known) > 1 else known[:0]

    def beside(self, x: NDArray[np.float64], modes: CampaignModes, pairs: tuple[Pair, ...]) -> Fit:
        """Residuals of the model at x."""
        # Residuals, their noise, and the line or response that they are of.
        rows: list[tuple[NDArray[np.float64], ArrayLike, int]] = []
        for pair in pairs:
            rig = self.given.lines[pair.line]
            noise = np.hypot(line_noise(rig), _LOOSE_FREQUENCY * self.looseness)
            rows.append((np.array([np.log(rig.frequency_hz / modes.frequency_hz[pair.mode])]), noise, pair.line))
            if self.measures_damping(pair.line):
                zeta = modes.damping_ratio[pair.mode]
                if not zeta > 0.0:
                    raise AnalysisError(
                        f"the line at {rig.frequency_hz:.4g} Hz has a damping ratio, and nothing damps its mode: {GIVE_DAMPING}"
                    )
                doubt = np.hypot(float(self.damping_noise or 0.0), self.looseness)
                rows.append((np.array([np.log(float(rig.damping_ratio or 0.0) / zeta)]), doubt, pair.line))
            points = self.shape_points(pair.line)
            if len(points):
                y = self.shapes[pair.line, points]
                off = self.parts(pair.line, _off_subspace(modes.at_points[np.ix_(np.array(pair.near), points)].T, y))
                share = np.hypot(self.shape_noise, self.looseness) * np.sqrt(len(points) / len(off))
                rows.append((off, share * np.sqrt(np.mean(np.abs(y) ** 2)), pair.line))
        owner = -1
        for number, response in self.responses.items():
            for off, sigma in zip(*response.residual(x, modes.parts[number], self.looseness), strict=True):
                rows.append((off, sigma, owner))
                owner -= 1
        r = np.concatenate([np.zeros(0), *(off for off, _, _ in rows)])
        sigma = np.concatenate([np.zeros(0), *(np.broadcast_to(sigma, off.shape) for off, sigma, _ in rows)])
        whose = np.repeat(np.array([owner for _, _, owner in rows], np.intp), [len(off) for off, _, _ in rows])
        objective = float(np.sum((r / sigma) ** 2) + np.sum((x / self.numbers.prior) ** 2))
        return Fit(x, modes, pairs, r, sigma, whose, objective, self.looseness)

    def linear(self, state: Fit) -> Posterior:
        """The linear model about a state."""
        modes = state.modes
        with_shapes = bool(self.given.points)
        chosen = sorted({k for pair in state.pairs for k in (pair.near if with_shapes else (pair.mode,))})
        place = {mode: k for k, mode in enumerate(chosen)}
        at = np.array(chosen, dtype=np.intp)
        slopes, shape_slopes = self.derivatives(state.x, modes, at, shapes=with_shapes)
        rows: list[NDArray[np.float64]] = []
        for pair in state.pairs:
            rows.append(slopes[place[pair.mode]])
            if self.measures_damping(pair.line):
                number = int(modes.campaign[pair.mode])
                first = int(np.searchsorted(modes.campaign, number))
                one = np.array([pair.mode - first])
                rows.append(self.models[number].damping_slopes(state.x, modes.parts[number], one)[0])
            points = self.shape_points(pair.line)
            if len(points):
                basis = modes.at_points[np.ix_(np.array(pair.near), points)].T
                share = np.linalg.lstsq(basis, self.shapes[pair.line, points], rcond=None)[0]
                change = sum(a * shape_slopes[place[k]][points] for a, k in zip(share, pair.near, strict=True))
                rows += list(self.parts(pair.line, _off_subspace(basis, np.asarray(change))))
        jacobian = [np.array(rows).reshape(-1, len(state.x))]
        for number, response in self.responses.items():
            slopes = response.slopes(state.x, modes.parts[number], state.looseness)
            jacobian.append(slopes.reshape(-1, len(state.x)))
        return Posterior(np.concatenate(jacobian), state.noise, self.numbers.prior)

    def pairs(self, x: NDArray[np.float64], modes: CampaignModes, known: Posterior | None) -> tuple[Pair, ...]:
        """Pair lines and modes, by what is known of the numbers so far."""
        if not self.given.lines:
            return ()
        hz = np.array([line.frequency_hz for line in self.given.lines])
        noise = max(line_noise(line) for line in self.given.lines)
        every = np.arange(len(modes.campaign))
        spread = np.full(len(every), np.hypot(noise, _LOOSE_FREQUENCY * self.looseness))
        if self.given.points:
            slopes, _ = self.derivatives(x, modes, every, shapes=False)
            before = np.sqrt(np.sum((slopes * self.numbers.prior) ** 2, axis=1))
            spread = np.hypot(spread, before if known is None else known.spread_of(slopes))
        found: list[tuple[int, int]] = []
        for number in np.unique(self.owner):
            lines = np.flatnonzero(self.owner == number)
            own = np.flatnonzero(modes.campaign == number)
            shapes = (self.shapes[lines], modes.at_points[own])
            pairs = pairs_of(hz[lines], modes.frequency_hz[own], spread[own], *shapes, self.tolerance)
            found += [(int(lines[line]), int(own[mode])) for line, mode in pairs]
        # The modes that are close to one, itself among them.
        reach = 2.0 * (CLOSE + _LOOSE_CLOSE * self.looseness)
        eigenvalues = np.concatenate([part.eigenvalues for part in modes.parts])
        near = np.abs(np.log(eigenvalues[:, None] / eigenvalues)) < reach
        near &= modes.campaign[:, None] == modes.campaign
        return tuple(Pair(line, mode, tuple(map(int, np.flatnonzero(near[:, mode])))) for line, mode in found)


def _off_subspace(basis: Shapes, y: Shapes) -> Shapes:
    """What of y (s,) or (s, p) is no combination of the columns of a basis (s, c)."""
    Q = np.linalg.qr(basis)[0]
    return np.asarray(y - Q @ (Q.conj().T @ y))


def first_fit(misfit: Misfit) -> Fit:
    """The model with the numbers of the file beside the rig."""
    x = np.zeros(len(misfit.numbers.addresses))
    modes = misfit.modes(x)
    return misfit.beside(x, modes, misfit.pairs(x, modes, None))


def approach(misfit: Misfit, start: Fit, progress: Progress) -> Fit:
    """One step each against noise that is less and less enlarged; modes are paired anew after each.

    Far from the truth close modes are taken for each other, and full trust in a wrong pair would lead astray.
    """
    state = start
    posterior = None
    for k, looseness in enumerate(_LOOSENESS):
        progress(0.1 + 0.1 * k, f"approach {k + 1}")
        loose = replace(misfit, looseness=looseness)
        state = loose.beside(state.x, state.modes, loose.pairs(state.x, state.modes, posterior))
        posterior = loose.linear(state)
        x = posterior.estimate(state.residual + posterior.jacobian @ state.x)
        modes = misfit.modes(x)
        state = loose.beside(x, modes, state.pairs)
    return misfit.beside(x, modes, misfit.pairs(x, modes, posterior))


def most_probable(misfit: Misfit, state: Fit, progress: Progress) -> tuple[Fit, Posterior]:
    """The most probable x and the posterior about it, by steps of Levenberg (1944) and Marquardt (1963).

    With `damping` 0 a step is Gauss-Newton's. Where the objective would grow, it is held back in the metric of the priors.
    Pairs are looked at again when it rests.
    """
    posterior = misfit.linear(state)
    damping = 0.0
    looked = 0
    while (solved := misfit.solutions) < _MOST_SOLUTIONS:
        progress(0.4 + 0.5 * solved / _MOST_SOLUTIONS, f"modal solution {solved + 1}")
        # |N^-1 (r - J d)|^2 + |S^-1 (x + d)|^2 + damping |S^-1 d|^2, squared out for d, is a prior about -x / (1 + damping).
        pull = state.x / (1.0 + damping)
        held = Posterior(posterior.jacobian, posterior.noise, posterior.prior / np.sqrt(1.0 + damping))
        step = held.estimate(state.residual + posterior.jacobian @ pull) - pull
        x = state.x + step
        modes = misfit.modes(x)
        trial = misfit.beside(x, modes, _followed(state, modes))
        gain = state.objective - trial.objective
        level = abs(gain) < _AT_REST * max(1.0, state.objective)
        if gain < 0.0 and not level:
            damping = max(10.0 * damping, 1.0)
            continue
        rests = level and damping < 1.0
        state = trial
        posterior = misfit.linear(state)
        damping = 0.1 * damping if damping > 0.1 else 0.0
        crawls = 0.0 <= gain < _CRAWL * state.objective and state.objective > _MISFIT * len(state.residual)
        if crawls and looked < _LOOKS:
            # A misfit that steps no longer lessen is a wrong pair, most likely: all pairs are open again.
            looked += 1
            damping = 0.0
            state = approach(misfit, state, progress)
            posterior = misfit.linear(state)
        elif rests:
            pairs = misfit.pairs(state.x, state.modes, posterior)
            other = misfit.beside(state.x, state.modes, pairs)
            # Of close modes either may be a line's: as many pairs that fit worse would only be exchanged back.
            worse = len(pairs) == len(state.pairs) and other.objective >= state.objective
            if worse or pairs == state.pairs or looked == _LOOKS:
                return state, posterior
            looked += 1
            state = other
            posterior = misfit.linear(state)
    apart = state.objective / max(len(state.residual), 1)
    remedy = "free fewer numbers, or give smaller priors"
    if apart >= _MISFIT:
        remedy = "look at units, signs, places of sensors and damping by `rotorgear compare`, or free other numbers"
    raise ConvergenceError(
        f"the update did not come to rest within {_MOST_SOLUTIONS} modal solutions, with a misfit of {apart:.2g} times what "
        f"noise and priors allow: {remedy}"
    )


def _followed(before: Fit, modes: CampaignModes) -> tuple[Pair, ...]:
    """The pairs of a state with each mode at its new place: the one-to-one assignment of most overlap."""
    from scipy.optimize import linear_sum_assignment

    old = sorted({k for pair in before.pairs for k in pair.near})
    _, new = linear_sum_assignment(-before.modes.overlap(modes)[old])
    now = {k: int(mode) for k, mode in zip(old, new, strict=True)}
    return tuple(Pair(pair.line, now[pair.mode], tuple(sorted(now[k] for k in pair.near))) for pair in before.pairs)
