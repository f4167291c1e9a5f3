"""What a model with free numbers shows beside what was measured: residuals, their noise, and their derivatives.

Shapes have no scale: the residual of measured y and shape phi is y - a phi with the a that fits best, and its derivative loses
what lies along phi. Shapes of close modes are compared as the plane they span: y less its projection on it. Frequency responses
follow the pairs of lines and modes (`frf_misfit.py`): they need none.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.rig.learnt import line_noise
from rotorgear.analysis.rig.measured import Measured
from rotorgear.analysis.rig.pairing import pairs_of
from rotorgear.analysis.rig.posterior import Posterior
from rotorgear.analysis.rig.rig_model import ComparedModel, ComparedModes, Shapes
from rotorgear.analysis.updating.frf_misfit import FrfMisfit

# Shapes of modes closer than this in ln f turn into each other at the slightest change: their plane is compared, not each.
CLOSE = 0.03
# So much further apart are modes still close, and so much more noise is in ln f, where looseness is 1.
_LOOSE_CLOSE = 0.15
_LOOSE_FREQUENCY = 0.1


@dataclass(frozen=True)
class Pair:
    """A line and its mode; `near` are the modes close to it, itself among them."""

    line: int
    mode: int
    near: tuple[int, ...]


@dataclass(frozen=True)
class State:
    """The model at x beside the rig.

    Attributes:
        x: logs of the factors (p,).
        modes: of the model there.
        pairs: lines and modes.
        residual: measured less computed: of each pair ln f, then its shape; then ln H of the frequency responses (n,).
        noise: standard deviations of the rows (n,).
        owner: line of each row; -1, -2 ... for the first frequency response, the second ... (n,).
        looseness: that of the noise.
        objective: squared residuals in units of the noise, and of x in units of the prior.
    """

    x: NDArray[np.float64]
    modes: ComparedModes
    pairs: tuple[Pair, ...]
    residual: NDArray[np.float64]
    noise: NDArray[np.float64]
    owner: NDArray[np.intp]
    objective: float
    looseness: float = 0.0


@dataclass(frozen=True)
class Misfit:
    """A model beside a rig; `looseness` adds to the noise while modes may still be taken for others.

    Of several campaigns, `campaign` is that of each line (n,); None: all lines are of one. Those in `turning` were measured at a
    speed: their shapes are complex, and both parts of what is left of them count, each with its share of the noise. `responses`
    are the frequency responses of some campaigns, by number.
    """

    model: ComparedModel
    given: Measured
    shape_noise: float
    tolerance: float
    looseness: float = 0.0
    campaign: NDArray[np.intp] | None = None
    turning: frozenset[int] = frozenset()
    responses: Mapping[int, FrfMisfit] = field(default_factory=dict)

    @cached_property
    def owner(self) -> NDArray[np.intp]:
        """Campaign of each line (n,)."""
        return np.zeros(len(self.given.lines), dtype=np.intp) if self.campaign is None else self.campaign

    @cached_property
    def shapes(self) -> Shapes:
        """The measured shapes (n, s): turned to be real where the gearbox stood still."""
        still = self.given.real_shapes
        if not self.turning or self.given.shapes is None:
            return still
        turns = np.isin(self.owner, list(self.turning))
        return np.where(turns[:, None], self.given.shapes, still)

    def parts(self, line: int, values: Shapes) -> Shapes:
        """Real values of a line as they are; of a complex shape the real ones, then the imaginary ones."""
        if self.owner[line] not in self.turning:
            return np.real(values)
        return np.concatenate([np.real(values), np.imag(values)])

    def shape_points(self, line: int) -> NDArray[np.intp]:
        """Points at which the shape of a line is compared; a shape at a single point is all scale."""
        known = np.flatnonzero(np.isfinite(self.shapes[line]))
        return known if len(known) > 1 else known[:0]

    def beside(self, x: NDArray[np.float64], modes: ComparedModes, pairs: tuple[Pair, ...]) -> State:
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
                y = self.shapes[pair.line, points]
                off = self.parts(pair.line, _off_subspace(modes.at_points[np.ix_(np.array(pair.near), points)].T, y))
                residual += list(off)
                share = np.hypot(self.shape_noise, self.looseness) * np.sqrt(len(points) / len(off))
                noise += [float(share * np.sqrt(np.mean(np.abs(y) ** 2)))] * len(off)
                owner += [pair.line] * len(off)
        parts = [(np.array(residual), np.array(noise), np.array(owner, dtype=np.intp))]
        first = 0
        for number, response in self.responses.items():
            rows, sigmas = response.residual(x, modes.parts[number], self.looseness)
            owners = -1 - (first + np.arange(len(rows)))
            parts.append((rows.ravel(), sigmas.ravel(), np.repeat(owners, rows.shape[1])))
            first += len(rows)
        r, sigma, whose = (np.concatenate(column) for column in zip(*parts, strict=True))
        objective = float(np.sum((r / sigma) ** 2) + np.sum((x / self.model.numbers.prior) ** 2))
        return State(x, modes, pairs, r, sigma, whose, objective, self.looseness)

    def linear(self, state: State) -> Posterior:
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
                share = np.linalg.lstsq(basis, self.shapes[pair.line, points], rcond=None)[0]
                change = sum(a * shape_slopes[place[k]][points] for a, k in zip(share, pair.near, strict=True))
                rows += list(self.parts(pair.line, _off_subspace(basis, np.asarray(change))))
        jacobian = [np.array(rows).reshape(-1, len(state.x))]
        for number, response in self.responses.items():
            slopes = response.slopes(state.x, modes.parts[number], state.looseness)
            jacobian.append(slopes.reshape(-1, len(state.x)))
        return Posterior(np.concatenate(jacobian), state.noise, self.model.numbers.prior)

    def pairs(self, x: NDArray[np.float64], modes: ComparedModes, known: Posterior | None) -> tuple[Pair, ...]:
        """Pair lines and modes, by what is known of the numbers so far."""
        if not self.given.lines:
            return ()
        hz = np.array([line.frequency_hz for line in self.given.lines])
        noise = max(line_noise(line) for line in self.given.lines)
        spread = np.full(len(modes.eigenvalues), np.hypot(noise, _LOOSE_FREQUENCY * self.looseness))
        if self.given.points:
            every = np.arange(len(modes.eigenvalues), dtype=np.intp)
            slopes, _ = self.model.derivatives(x, modes, every, shapes=False)
            prior = self.model.numbers.prior
            before = np.sqrt(np.sum((slopes * prior) ** 2, axis=1)) if known is None else known.spread_of(slopes)
            spread = np.hypot(spread, before)
        found: list[tuple[int, int]] = []
        for number in np.unique(self.owner):
            lines = np.flatnonzero(self.owner == number)
            own = np.flatnonzero(modes.campaign == number)
            pairs = pairs_of(
                hz[lines],
                modes.frequency_hz[own],
                spread[own],
                self.shapes[lines],
                modes.at_points[own],
                self.tolerance,
            )
            found += [(int(lines[line]), int(own[mode])) for line, mode in pairs]
        return tuple(Pair(line, mode, _close(modes, mode, self.looseness)) for line, mode in found)


def _close(modes: ComparedModes, mode: int, looseness: float) -> tuple[int, ...]:
    """The modes that are close to one, itself among them."""
    near = np.abs(np.log(modes.eigenvalues / modes.eigenvalues[mode])) < 2.0 * (CLOSE + _LOOSE_CLOSE * looseness)
    return tuple(int(k) for k in np.flatnonzero(near & (modes.campaign == modes.campaign[mode])))


def _off_subspace(basis: Shapes, y: Shapes) -> Shapes:
    """What of y (s,) or (s, p) is no combination of the columns of a basis (s, c)."""
    Q = np.linalg.qr(basis)[0]
    return np.asarray(y - Q @ (Q.conj().T @ y))
