"""A layout as a problem of optimisation: free numbers in units of their bounds, penalty, gradient, margins.

A place on a shaft stays within it, and on its side of the gears, disks and bearings beside it. Where the model refuses a value
within the bounds, the bound is drawn in until the model takes it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from rotorgear.analysis.common.request import direction_of
from rotorgear.analysis.layout.modes_at_speed import ModesAtSpeed, state_of, total_mass, with_deviations
from rotorgear.analysis.layout.penalty import near_modes, penalty, penalty_slopes
from rotorgear.analysis.sensitivity.derivatives import systems_beside
from rotorgear.analysis.sensitivity.forms import Floats
from rotorgear.analysis.static.state_at import linear_system, state_at
from rotorgear.errors import AnalysisError, ModelError
from rotorgear.model.model import Model
from rotorgear.model.numbers import Numbers
from rotorgear.model.parts.gear import Gear
from rotorgear.model.parts.shaft import Shaft
from rotorgear.results.campbell import ExcitationOrder
from rotorgear.results.optimise import SOUGHT_FROM
from rotorgear.system.plan import Plan
from rotorgear.system.system import System, flow_system

DEFAULT_BOUNDS = "-20 %:20 %"
# A place moves by this share of its shaft where no bounds are given.
_OF_SHAFT = 0.1
# It keeps this share of the shaft's length from its neighbours.
_APART = 0.01
_BISECTIONS = 8


def bounds_of(numbers: Numbers, given: Mapping[str, str]) -> tuple[Floats, Floats, tuple[str, ...]]:
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
            reach = _OF_SHAFT * _shaft(numbers.model, address)[1].length
            low[j] = numbers.start[j] - reach
            high[j] = numbers.start[j] + reach
        both = f"bounds of {address}: {low[j]:g} to {high[j]:g}"
        if low[j] >= high[j]:
            raise AnalysisError(f"{both} leave no room; give the lower one first")
        if not low[j] <= numbers.start[j] <= high[j]:
            raise AnalysisError(f"{both} do not hold its value {numbers.start[j]:g}")
        if place:
            first, last = _room(numbers.model, address, float(numbers.start[j]))
            # Rounding of sums of lengths must not shut out the place where the file has it.
            low[j] = min(max(low[j], first), numbers.start[j])
            high[j] = max(min(high[j], last), numbers.start[j])
            if low[j] == high[j]:
                raise AnalysisError(f"{address}: there is no room beside it; leave it out, or move what is there")
        for side, bound in (("lower", low), ("upper", high)):
            taken = _taken(numbers, j, float(bound[j]))
            if taken != bound[j]:
                refused = f"not {bound[j]:.6g}, which the model refuses"
                notes.append(f"{address}: its {side} bound is {taken:.6g} and {refused}")
                bound[j] = taken
    return low, high, tuple(notes)


def _shaft(model: Model, address: str) -> tuple[str, Shaft]:
    """Name and part of the shaft that a part stands on, by the address of its place."""
    table, name, _ = address.split(".")
    shaft = getattr(model, table)[name].shaft
    return shaft, model.shafts[shaft]


def _room(model: Model, address: str, here: float) -> tuple[float, float]:
    """Where a part may be without a jump over its neighbours or off its shaft."""
    shaft, part = _shaft(model, address)
    low = part.start
    high = part.end
    apart = _APART * (high - low)
    own = address.removesuffix(".at")
    for other_address, other in model.parts_of("gears", "disks", "bearings"):
        if other_address == own or other.shaft != shaft:
            continue
        z = model.layout.at(shaft, other.at).z
        half = 0.5 * (other.total_width if isinstance(other, Gear) else getattr(other, "width", None) or 0.0)
        if z - half <= here <= z + half:
            continue  # it is there already, as a disk on a bearing's place
        if z < here:
            low = max(low, min(z + half + apart, here))
        else:
            high = min(high, max(z - half - apart, here))
    return low, high


def last_kept(good: float, bad: float, kept: Callable[[float], bool], times: int) -> float:
    """By bisection, the last value from a good one towards a bad one for which something is kept."""
    for _ in range(times):
        middle = 0.5 * (good + bad)
        if kept(middle):
            good = middle
        else:
            bad = middle
    return good


def _taken(numbers: Numbers, j: int, bound: float) -> float:
    """The bound, or the last value towards it that the model takes."""

    def taken(value: float) -> bool:
        values = numbers.start.copy()
        values[j] = value
        try:
            numbers.at(values)
        except ModelError:
            return False
        return True

    return bound if taken(bound) else last_kept(float(numbers.start[j]), bound, taken, _BISECTIONS)


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
    low: Floats
    high: Floats
    speeds: tuple[float, ...]
    lines: tuple[ExcitationOrder, ...]
    plan: Plan
    below_hz: float
    margin: float
    asked: float
    least: float
    deviations: float | None = None
    own_maps: bool = False
    solutions: int = 0
    gradients: int = 0

    def values(self, t: Floats) -> Floats:
        """The numbers at t (p,)."""
        return self.low + np.clip(t, 0.0, 1.0) * (self.high - self.low)

    @property
    def start(self) -> Floats:
        """t of the file (p,)."""
        return np.asarray((self.numbers.start - self.low) / (self.high - self.low))

    def states(self, t: Floats) -> list[ModesAtSpeed]:
        """The modes at every speed."""
        model = self.numbers.at(self.values(t))
        beside = None if self.own_maps else state_at(self.numbers.model, [self.speeds[0]])
        self.solutions += len(self.speeds)
        found = [
            state_of(system, speed, self.lines, self.below_hz, self.margin, self.least)
            for speed in self.speeds
            for system in [linear_system(model, [speed], self.plan, beside=beside)]
        ]
        if self.deviations is None:
            return found
        return [with_deviations(state, model, self.asked, self.least) for state in found]

    def _wide(self, state: ModesAtSpeed, margin: float) -> Floats:
        """A margin with the deviations of each mode beside each line, (l, m)."""
        if state.sigma is None or not self.deviations:
            return np.full(state.taken.shape, margin)
        return np.asarray(margin + self.deviations * state.sigma * state.hz / state.line_hz[:, None])

    def penalty(self, states: list[ModesAtSpeed]) -> float:
        """J of all speeds."""
        return sum(penalty(state, self._wide(state, self.margin), self.least) for state in states)

    def slopes(self, t: Floats, states: list[ModesAtSpeed]) -> Floats:
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

            near = list(near_modes(state, self._wide(state, self.margin), self.least))
            total += penalty_slopes(state, near, self.lines, beside, len(t))
        return total

    def mass(self, t: Floats) -> tuple[float, Floats]:
        """Mass of the rotors in kg and its derivatives (p,)."""

        def at(point: Floats) -> float:
            return total_mass(self._at_rest(point))

        # Masses are polynomials of low degree: wide central differences are as good as exact.
        steps = 1e-3 * np.eye(len(t))
        return at(t), np.array([(at(t + step) - at(t - step)) / 2e-3 for step in steps])

    def margins_kept(self, states: list[ModesAtSpeed]) -> bool:
        """Whether the penalty has no mode left within the margin that was asked for, deviations included.

        Both its edges are approached but not met: a hair inside them is enough.
        """
        for state in states:
            near = np.abs(state.hz / state.line_hz[:, None] - 1.0) < _EDGE * self._wide(state, self.asked)
            if np.any(near & (state.common >= SOUGHT_FROM * self.least)):
                return False
        return True

    def _beside(self, t: Floats, j: int, state: ModesAtSpeed) -> tuple[System, System, float]:
        step = _STEP * np.eye(len(t))[j]
        models = [self.numbers.at(self.low + at * (self.high - self.low)) for at in (t + step, t - step)]
        known = state.system
        above, below = systems_beside(models, known, state.speed, self.numbers.addresses[j], beside=known.state)
        return above, below, 2.0 * _STEP

    def _apart(self, t: Floats) -> Floats:
        """t with places moved a hair from others that they coincide with."""
        moved = t.copy()
        for j, step in enumerate(_STEP * np.eye(len(t))):
            if self.numbers.addresses[j].endswith((".at", ".start", ".length")):
                # The number of dofs changes where places part or come together.
                sizes = {self._at_rest(np.clip(moved + side * step, 0.0, 1.0)).n for side in (-1.0, 0.0, 1.0)}
                if len(sizes) > 1:
                    moved[j] += _HAIR if t[j] < 0.5 else -_HAIR
        return moved

    def _at_rest(self, t: Floats) -> System:
        """The system at t (p,), for what no equilibrium changes: masses and places."""
        model = self.numbers.at(self.low + t * (self.high - self.low))
        return flow_system(model, self.plan, direction=direction_of(self.speeds[0]))
