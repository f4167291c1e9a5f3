"""Scattering numbers of a model: each a function of a coordinate z of mean 0 and variance 1, independent of the others.

    normal      p = p_0 + s z
    lognormal   p = p_0 exp(s z): s is the standard deviation of ln p, about that of p over p_0
    uniform     p = p_0 + s z,  -sqrt(3) <= z <= sqrt(3): limits p_0 +- sqrt(3) s

A tolerance is 3 s of the first two and sqrt(3) s, the limits themselves, of a uniform number. A tolerance class of ISO 1328-1
stands for the gap that two gears make before their mesh carries: the cumulative pitch deviation of each runs through its
tolerance once a turn, F_pT / 2 sin(psi) at a random angle psi, of standard deviation F_pT / (2 sqrt 2); along the flank normal
times cos a_t cos b_b.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rotorgear.errors import ModelError, Problem
from rotorgear.gears.geometry.flank_tolerance import FLANK_CLASSES, cumulative_pitch_tolerance
from rotorgear.model.model import Model
from rotorgear.model.numbers import Numbers, numbers_of
from rotorgear.model.parts.operation import Scatter

DISTRIBUTIONS = ("normal", "lognormal", "uniform")
# Samples reach this many standard deviations.
_REACH = 4.5
_INDEX_ERROR = ".index_error"


@dataclass(frozen=True, eq=False)  # arrays are compared entry by entry; what is kept of some spreads is theirs alone
class Spreads:
    """p scattering numbers.

    Attributes:
        numbers: the numbers.
        size: s of each, in the unit of its coordinate; a share where it is log-normal (p,).
        distribution: of each.
    """

    numbers: Numbers
    size: NDArray[np.float64]
    distribution: tuple[str, ...]

    def __len__(self) -> int:
        return len(self.size)

    def values(self, z: NDArray[np.float64]) -> NDArray[np.float64]:
        """Coordinates of the numbers at z (p,)."""
        start = self.numbers.start
        moved = self.size * z
        log = np.array([kind == "lognormal" for kind in self.distribution])
        return np.where(log, start * np.exp(np.where(log, moved, 0.0)), start + np.where(log, 0.0, moved))

    def at(self, z: NDArray[np.float64]) -> Model:
        """The model at z (p,).

        Raises:
            ModelError: values that the model can't have.
        """
        try:
            return self.numbers.at(self.values(z))
        except ModelError as error:
            hint = "its scatter reaches there: make it smaller"
            raise ModelError([replace(problem, hint=problem.hint or hint) for problem in error.problems]) from None

    @property
    def reach(self) -> NDArray[np.float64]:
        """Largest |z| of each number that samples come to (p,)."""
        return np.array([math.sqrt(3.0) if kind == "uniform" else _REACH for kind in self.distribution])

    def coordinates(self, u: NDArray[np.float64]) -> NDArray[np.float64]:
        """z (n, p) of points u (n, p) of the unit cube."""
        from scipy.special import ndtri

        uniform = np.array([kind == "uniform" for kind in self.distribution])
        # No point of a finite sample is at the end of an infinite tail.
        bell = ndtri(np.clip(u, 3.4e-6, 1.0 - 3.4e-6))
        return np.where(uniform, math.sqrt(3.0) * (2.0 * u - 1.0), bell)


def spreads_of(model: Model, given: Mapping[str, Scatter]) -> Spreads:
    """Return the scattering numbers that some addresses name; of two patterns for one number the later counts.

    Raises:
        ModelError: addresses that lead nowhere, sizes that the number can't have, a class of ISO 1328 where there is none.
    """
    spreads = _spreads(model, given)
    if not np.any(spreads.size > 0.0):
        raise ModelError([Problem("scatter", "", "at least one number that scatters")])
    return spreads


def _spreads(model: Model, given: Mapping[str, Scatter]) -> Spreads:
    """The numbers, which may all have no scatter."""
    numbers = numbers_of(model, list(given))
    size = np.zeros(len(numbers.addresses))
    kinds = ["normal"] * len(size)
    for pattern, entry in given.items():
        for j in numbers.matching(pattern):
            size[j] = _size(numbers, j, entry)
            kinds[j] = entry.distribution
    spreads = Spreads(numbers, size, tuple(kinds))
    # A number that is positive may not scatter through 0: a stiffness or diameter below is none.
    through = np.array(kinds) != "lognormal"
    through &= (numbers.start > 0.0) & (size * spreads.reach >= numbers.start)
    for j in np.flatnonzero(through).tolist():
        address = numbers.addresses[j]
        if not address.endswith((".at", ".start", "position[0]", "position[1]", "position[2]", _INDEX_ERROR)):
            hint = "take distribution 'lognormal', or a smaller size"
            got = f"{100.0 * size[j] / numbers.start[j]:.3g} % {kinds[j]}"
            raise _refused(address, got, "a spread that keeps the number above 0", hint)
    return spreads


def _refused(address: str, got: str, expected: str, hint: str = "") -> ModelError:
    return ModelError([Problem(f"scatter of {address}", got, expected, hint)])


def scatter_problems(model: Model) -> list[Problem]:
    """Mistakes in the table [scatter] of a model: the first one of each of its rows."""
    found = []
    right: dict[str, Scatter] = {}
    for pattern, entry in model.scatter.items():
        try:
            numbers = numbers_of(model, [pattern])
            for j in range(len(numbers.addresses)):
                _size(numbers, j, entry)
            right[pattern] = entry
        except ModelError as error:
            problem = error.problems[0]
            at = f'scatter."{pattern}"'
            # What is wrong with one of the numbers that a "*" names is said with its own address.
            where = "" if problem.address in (pattern, "") else f"{problem.address}: "
            found.append(Problem(at, problem.value, f"{where}{problem.expected}", problem.hint))
    try:
        # Of two rows for one number the later counts, so that spreads through 0 are looked for in all rows together.
        if right:
            _spreads(model, right)
    except ModelError as error:
        found += error.problems
    return found


def graded_errors(model: Model) -> dict[str, Scatter]:
    """Index errors of meshes whose two gears have a tolerance class of ISO 1328-1."""
    found = {}
    for name in model.meshes:
        gears = [gear.part for gear in model.layout.mesh(name).gears]
        if all(gear.accuracy_grade for gear in gears):
            found[f"meshes.{name}{_INDEX_ERROR}"] = Scatter(grade=max(gear.accuracy_grade or 1 for gear in gears))
    return found


def _size(numbers: Numbers, j: int, entry: Scatter) -> float:
    address = numbers.addresses[j]
    start = float(numbers.start[j])
    if entry.grade is not None:
        size = _graded(numbers.model, address, entry.grade)
    elif entry.tolerance is not None:
        wide = numbers.size(j, entry.tolerance, "tolerance")
        size = wide / (math.sqrt(3.0) if entry.distribution == "uniform" else 3.0)
    else:
        assert entry.sigma is not None
        size = numbers.size(j, entry.sigma, "sigma")
    if size < 0.0:
        raise _refused(address, f"{size:g}", "a size that is not negative")
    if entry.distribution == "lognormal":
        if start == 0.0:
            raise _refused(address, "lognormal", "a number other than 0", "take normal")
        return size / abs(start)
    return size


def _graded(model: Model, address: str, grade: int) -> float:
    """Standard deviation of an index error by a class of ISO 1328-1, in m."""
    table, _, rest = address.partition(".")
    name = rest.removesuffix(_INDEX_ERROR)
    if table != "meshes" or not rest.endswith(_INDEX_ERROR):
        hint = "a class of ISO 1328-1 is one of an index_error of a mesh; give sigma or tolerance"
        raise _refused(address, f"grade {grade}", "an address such as meshes.*.index_error", hint)
    if grade > FLANK_CLASSES:
        hint = "the classes of ISO 1328-1:2013"
        raise _refused(address, f"grade {grade}", f"1 to {FLANK_CLASSES}", hint)
    variance = 0.0
    for gear in model.layout.mesh(name).gears:
        g = gear.geometry
        if g is None:
            hint = "give teeth and module, or sigma or tolerance of the index error"
            raise _refused(address, f"grade {grade}", "gears with teeth", hint)
        own = gear.part.accuracy_grade or grade
        along = math.cos(g.transverse_pressure_angle) * math.cos(g.base_helix_angle)
        variance += (cumulative_pitch_tolerance(g, own) * along) ** 2 / 8.0
    return math.sqrt(variance)
