"""A layout as a problem of optimisation: free numbers in units of their bounds, penalty, gradient, margins.

A place on a shaft stays within it, and on its side of the gears, disks and bearings beside it. Where the model refuses a value
within the bounds, the bound is drawn in until the model takes it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.common.request import direction_of
from rotorgear.analysis.layout.modes_at_speed import ModesAtSpeed, state_of, total_mass, with_deviations
from rotorgear.analysis.layout.penalty import near_modes, penalty, penalty_slopes
from rotorgear.analysis.sensitivity.derivatives import systems_beside
from rotorgear.analysis.static.state_at import linear_system, state_at
from rotorgear.errors import AnalysisError, ModelError
from rotorgear.model.model import Model
from rotorgear.model.numbers import Numbers
from rotorgear.results.campbell import ExcitationOrder
from rotorgear.system.plan import Plan
from rotorgear.system.system import System, flow_system

DEFAULT_BOUNDS = "-20 %:20 %"
# A place moves by so much of its shaft where nothing is said.
_OF_SHAFT = 0.1
# It keeps this share of the shaft's length from its neighbours.
_APART = 0.01
_BISECTIONS = 8


def bounds_of(
    numbers: Numbers, given: Mapping[str, str]
) -> tuple[NDArray[np.float64], NDArray[np.float64], tuple[str, ...]]:
    """Return lower and upper bounds (p,) and sentences on those that were drawn in.

    Args:
        numbers: the free numbers.
        given: pattern of addresses -> "LOW:HIGH", each a share of the value added to it ("-20 %:20 %") or a value with its unit.

    Raises:
        AnalysisError: bounds that are none, or do not hold the value of the file.
    """
    low = np.zeros(len(numbers.addresses))
    high = np.zeros(len(numbers.addresses))
    notes: list[str] = []
    texts: dict[int, str] = {}
    for pattern, text in given.items():
        found = numbers.matching(pattern)
        if not found:
            raise AnalysisError(f"bounds: '{pattern}' is none of the free numbers")
        texts |= dict.fromkeys(found, text)
    for j, address in enumerate(numbers.addresses):
        place = address.endswith(".at")
        if j in texts or not place:
            text = texts.get(j, DEFAULT_BOUNDS)
            if text.count(":") != 1:
                raise AnalysisError(f"bounds of {address}: got '{text}', expected LOW:HIGH such as '-20 %:20 %'")
            ends = []
            for end in map(str.strip, text.split(":")):
                # A share is added to the value.
                share = end.endswith("%")
                size = numbers.size(j, end.lstrip("+-") if share else end, "bounds")
                ends.append(numbers.start[j] + (-size if end.startswith("-") else size) if share else size)
            low[j], high[j] = ends
        else:
            reach = _OF_SHAFT * _length(numbers.model, address)
            low[j] = numbers.start[j] - reach
            high[j] = numbers.start[j] + reach
        if low[j] >= high[j]:
            raise AnalysisError(
                f"bounds of {address}: {low[j]:g} to {high[j]:g} leave no room; give the lower one first"
            )
        if not low[j] <= numbers.start[j] <= high[j]:
            raise AnalysisError(
                f"bounds of {address}: {low[j]:g} to {high[j]:g} do not hold its value {numbers.start[j]:g}"
            )
        if place:
            first, last = _room(numbers.model, address, float(numbers.start[j]))
            # Rounding of sums of lengths must not shut out the place where the file has it.
            low[j] = min(max(low[j], first), numbers.start[j])
            high[j] = max(min(high[j], last), numbers.start[j])
            if low[j] == high[j]:
                raise AnalysisError(f"{address}: there is no room beside it; leave it out, or move what is there")
        for side, bound in ((-1, low), (1, high)):
            taken = _taken(numbers, j, float(bound[j]))
            if taken != bound[j]:
                name = "lower" if side < 0 else "upper"
                notes.append(
                    f"{address}: its {name} bound is {taken:.6g} and not {bound[j]:.6g}, which the model refuses"
                )
                bound[j] = taken
    return low, high, tuple(notes)


def _length(model: Model, address: str) -> float:
    shaft = _shaft(model, address)
    return float(sum(section.length for section in model.shafts[shaft].sections))


def _shaft(model: Model, address: str) -> str:
    table, name, _ = address.split(".")
    return str(getattr(model, table)[name].shaft)


def _room(model: Model, address: str, here: float) -> tuple[float, float]:
    """Where a part may be without a jump over its neighbours or off its shaft."""
    shaft = _shaft(model, address)
    part = model.shafts[shaft]
    first = float(part.start)
    last = first + _length(model, address)
    apart = _APART * (last - first)
    own = address.removesuffix(".at")
    low = first
    high = last
    for table in ("gears", "disks", "bearings"):
        for name, other in getattr(model, table).items():
            if f"{table}.{name}" == own or other.shaft != shaft:
                continue
            at = getattr(other, "at", 0.0)
            z = first if at == "start" else last if at == "end" else float(at)
            half = 0.5 * (getattr(other, "width", None) or 0.0)
            if getattr(other, "kind", "") == "herringbone":
                half = 2.0 * half + 0.5 * (getattr(other, "gap", None) or 0.0)
            if z - half <= here <= z + half:
                continue  # it is there already, as a disk on a bearing's place
            if z < here:
                low = max(low, min(z + half + apart, here))
            else:
                high = min(high, max(z - half - apart, here))
    return low, high


def _taken(numbers: Numbers, j: int, bound: float) -> float:
    """The bound, or the last value towards it that the model takes."""

    def refuses(value: float) -> bool:
        values = numbers.start.copy()
        values[j] = value
        try:
            numbers.at(values)
        except ModelError:
            return True
        return False

    if not refuses(bound):
        return bound
    good = float(numbers.start[j])
    bad = bound
    for _ in range(_BISECTIONS):
        middle = 0.5 * (good + bad)
        if refuses(middle):
            bad = middle
        else:
            good = middle
    return good


# Half width of the differences of matrices, as a share of the bounds: their error is its square.
_STEP = 1e-5
# A place that coincides with another one is differentiated a hair beside it, where the shaft is cut alike on both sides.
_HAIR = 2e-3
# The search asks for a hair more than the margin: its mesh and the finer one that judges it differ by less.
_EDGE = 1.001


@dataclass
class Problem:
    """Free numbers x = low + t (high - low).

    Attributes:
        numbers, low, high: the numbers and their bounds (p,).
        speeds: of the reference shaft in rad/s.
        lines: excitations.
        plan: the mesh.
        below_hz: highest frequency of the modes in Hz.
        margin: that the penalty asks for, a little more than
        asked: the margin itself.
        least: least participation that counts.
        deviations: standard deviations of a mode's frequency that are added to its margin, by [scatter] of the model; None:
            scatter is not looked at.
        own_maps: whether loaded teeth that tilt have their own face maps in each layout, which take nearly all the time; else
            those of the file, as long as they hold.
        solutions, gradients: how many were needed so far.
    """

    numbers: Numbers
    low: NDArray[np.float64]
    high: NDArray[np.float64]
    speeds: tuple[float, ...]
    lines: tuple[ExcitationOrder, ...]
    plan: Plan
    below_hz: float
    margin: float
    asked: float
    least: float
    deviations: float | None = None
    own_maps: bool = False
    solutions: int = field(default=0)
    gradients: int = field(default=0)

    def values(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        """The numbers at t (p,)."""
        return self.low + np.clip(t, 0.0, 1.0) * (self.high - self.low)

    @property
    def start(self) -> NDArray[np.float64]:
        """t of the file (p,)."""
        return np.asarray((self.numbers.start - self.low) / (self.high - self.low))

    def states(self, t: NDArray[np.float64]) -> list[ModesAtSpeed]:
        """The modes at every speed."""
        model = self.numbers.at(self.values(t))
        beside = None if self.own_maps else state_at(self.numbers.model, [self.speeds[0]])
        self.solutions += len(self.speeds)
        found = [
            state_of(
                linear_system(model, [speed], self.plan, beside=beside),
                speed,
                self.lines,
                self.below_hz,
                margin=self.margin,
                least=self.least,
            )
            for speed in self.speeds
        ]
        if self.deviations is None:
            return found
        return [with_deviations(state, model, self.asked, self.least) for state in found]

    def _wide(self, state: ModesAtSpeed, margin: float) -> NDArray[np.float64]:
        """A margin with the deviations of each mode beside each line, (l, m)."""
        if state.sigma is None or not self.deviations:
            return np.full(state.taken.shape, margin)
        return np.asarray(margin + self.deviations * state.sigma * state.hz / state.line_hz[:, None])

    def penalty(self, states: list[ModesAtSpeed]) -> float:
        """J of all speeds."""
        return sum(penalty(near_modes(state, self._wide(state, self.margin), self.least)) for state in states)

    def slopes(self, t: NDArray[np.float64], states: list[ModesAtSpeed]) -> NDArray[np.float64]:
        """dJ/dt (p,)."""
        self.gradients += 1
        # Differences need room on both sides: a bound may be where the model ends.
        inside = self._apart(np.clip(t, 2.0 * _STEP, 1.0 - 2.0 * _STEP))
        if not np.array_equal(inside, t):
            t = inside
            states = self.states(t)
        total = np.zeros(len(t))
        for state in states:

            def beside(j: int, state: ModesAtSpeed = state) -> tuple[System, System, float]:
                return self._beside(t, j, state)

            near = near_modes(state, self._wide(state, self.margin), self.least)
            total += penalty_slopes(state, near, self.lines, beside, len(t))
        return total

    def mass(self, t: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]:
        """Mass of the rotors in kg and its derivatives (p,)."""

        def at(point: NDArray[np.float64]) -> float:
            return total_mass(self._at_rest(self.low + point * (self.high - self.low)))

        # Masses are polynomials of low degree: wide central differences are as good as exact.
        steps = 1e-3 * np.eye(len(t))
        return at(t), np.array([(at(t + step) - at(t - step)) / 2e-3 for step in steps])

    def margins_kept(self, states: list[ModesAtSpeed]) -> bool:
        """Whether no mode that counts is within the margin that was asked for, deviations included."""
        return all(
            not np.any(
                (np.abs(state.hz / state.line_hz[:, None] - 1.0) < _EDGE * self._wide(state, self.asked))
                & (state.taken >= self.least)
            )
            for state in states
        )

    def _beside(self, t: NDArray[np.float64], j: int, state: ModesAtSpeed) -> tuple[System, System, float]:
        step = _STEP * np.eye(len(t))[j]
        above, below = systems_beside(
            [self.numbers.at(self.low + at * (self.high - self.low)) for at in (t + step, t - step)],
            state.system,
            state.speed,
            self.numbers.addresses[j],
            beside=state.system.state,
        )
        return above, below, 2.0 * _STEP

    def _apart(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        """t with places moved a hair from others that they coincide with."""
        places = [j for j, name in enumerate(self.numbers.addresses) if name.endswith((".at", ".start", ".length"))]
        moved = t.copy()
        for j in places:
            step = np.zeros(len(t))
            step[j] = _STEP
            sizes = {self._size(moved + side * step) for side in (-1.0, 0.0, 1.0)}
            if len(sizes) > 1:
                moved[j] += _HAIR if t[j] < 0.5 else -_HAIR
        return moved

    def _size(self, t: NDArray[np.float64]) -> int:
        """Number of dofs at t: it changes where places part or come together."""
        return self._at_rest(self.values(t)).n

    def _at_rest(self, values: NDArray[np.float64]) -> System:
        """The system at some values (p,), for what no equilibrium changes: masses and places."""
        model = self.numbers.at(values)
        return flow_system(model, self.plan, direction=direction_of(self.speeds[0]))
