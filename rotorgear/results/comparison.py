"""Comparison of natural frequencies with the lines of a test rig: what matches, what does not, and what chance gives.

Errors are those of the mode relative to the rig, e = f_mode / f_rig - 1. A line of unknown origin, thrown at random on
the band (uniform in log frequency), lies within the tolerance t of a mode where f_mode / (1 + t) <= f <= f_mode / (1 -
t); the share of the band that these intervals cover together is what one match is worth. Significance by random lists:
Davison & Hinkley, Bootstrap Methods and their Application (1997), section 4.2.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from rotorgear.errors import ModelError, Problem

EVIDENCE_LEVEL = 0.05
_UNFITTED = "if it was not fitted to these lines"


@dataclass(frozen=True)
class RigLine:
    """One measured line: frequency and standard uncertainty in Hz, damping ratio as a fraction of critical.

    Raises:
        ModelError: a number that no measurement can have; all of them at once.
    """

    frequency_hz: float
    label: str = ""
    uncertainty_hz: float | None = None
    damping_ratio: float | None = None

    def __post_init__(self) -> None:
        problems = []
        frequency = self.frequency_hz
        uncertainty = self.uncertainty_hz
        damping = self.damping_ratio
        if not (math.isfinite(frequency) and frequency > 0.0):
            problems.append(Problem("frequency_hz", repr(frequency), "a positive frequency such as '361 Hz'"))
        elif uncertainty is not None and not 0.0 <= uncertainty < frequency:
            expected = "an uncertainty from 0 up to the frequency itself, such as '2 Hz' or '1 %'"
            problems.append(Problem("uncertainty_hz", repr(uncertainty), expected))
        if damping is not None and not 0.0 <= damping < 1.0:
            expected = "a damping ratio from 0 to below 1, such as 0.012 or '1.2 %'"
            problems.append(Problem("damping_ratio", repr(damping), expected))
        if problems:
            raise ModelError(problems, "rig line")


@dataclass(frozen=True)
class ExcitationLine:
    """A frequency at which the machine is driven whatever its modes are: a shaft order or a mesh order."""

    name: str
    frequency_hz: float

    def __str__(self) -> str:
        return f"{self.name} {self.frequency_hz:.1f} Hz"


@dataclass(frozen=True)
class Candidate:
    """A mode beside a rig line: number (from 1, rigid modes counted), frequency, its error against that line in %.

    `matched_elsewhere`: the mode is the partner of another rig line.
    """

    mode_number: int
    frequency_hz: float
    error_percent: float
    matched_elsewhere: bool = False


@dataclass(frozen=True)
class Match:
    """A rig line and its mode, within the tolerance.

    `within_uncertainty` is None where the rig states no uncertainty. `runner_up` is given where the assignment is
    ambiguous: the next mode is within the tolerance too, and either within twice the error of the chosen one or within
    the reading accuracy of the line (its stated uncertainty, else 0.1 %). `excitations` coincide with the rig line,
    `mode_excitations` with the mode.
    """

    rig: RigLine
    mode_number: int
    mode_frequency_hz: float
    mode_description: str
    error_percent: float
    within_uncertainty: bool | None
    runner_up: Candidate | None
    mode_damping_ratio: float | None
    excitations: tuple[ExcitationLine, ...]
    mode_excitations: tuple[ExcitationLine, ...]


@dataclass(frozen=True)
class UnmatchedRigLine:
    """A rig line without a mode; the nearest elastic mode is outside the tolerance or the partner of another line."""

    rig: RigLine
    nearest_mode: Candidate | None
    excitations: tuple[ExcitationLine, ...]


@dataclass(frozen=True)
class UnmatchedMode:
    """An elastic mode inside the band to which no rig line was assigned."""

    mode_number: int
    frequency_hz: float
    description: str
    excitations: tuple[ExcitationLine, ...]


@dataclass(frozen=True)
class Chance:
    """What a random list of as many lines would do, each uniform in log frequency from band_low_hz to band_high_hz.

    Attributes:
        modes_in_band: elastic modes inside the band.
        coverage: share of log(band_high / band_low) that lies within the tolerance of some mode (exact union of
            intervals).
        expected_random_matches: mean number of one-to-one matches of `samples` random lists.
        probability_as_many: that a random list matches at least as many lines, (1 + hits) / (1 + samples).
        probability_as_close: that a random list has at most the observed sum of |ln(f_mode / f_rig)|, in which an
            unmatched line counts with the full tolerance, -ln(1 - t).
        binomial_expected, binomial_probability: the first and second of these three in closed form for independent
            lines that may share a mode; upper bounds, and equal to the samples where hardly two lines compete for one
            mode.
        samples, seed: of the random lists.

    None of this knows about a model that was fitted to the very lines it is compared with: such a list matches by
    construction.
    """

    band_low_hz: float
    band_high_hz: float
    modes_in_band: int
    coverage: float
    expected_random_matches: float
    probability_as_many: float
    probability_as_close: float
    binomial_expected: float
    binomial_probability: float
    samples: int
    seed: int

    @property
    def number_is_evidence(self) -> bool:
        """True where chance matches as many in at most 2.5 % of cases: 5 %, shared by two looks at the same data."""
        return self._is_rare(self.probability_as_many)

    @property
    def closeness_is_evidence(self) -> bool:
        """True where chance comes as close in at most 2.5 % of cases."""
        return self._is_rare(self.probability_as_close)

    def _is_rare(self, probability: float) -> bool:
        """Whether a sampled probability is below the level by more than twice its own sampling error."""
        error = (probability * (1.0 - probability) / self.samples) ** 0.5
        return probability + 2.0 * error <= EVIDENCE_LEVEL / 2


@dataclass(frozen=True)
class Comparison:
    """The whole comparison; relative tolerances as fractions, `warnings` as sentences."""

    matches: tuple[Match, ...]
    unmatched_rig: tuple[UnmatchedRigLine, ...]
    unmatched_modes: tuple[UnmatchedMode, ...]
    tolerance: float
    excitation_tolerance: float
    chance: Chance
    warnings: tuple[str, ...] = ()

    @property
    def rig_count(self) -> int:
        """The number of rig lines."""
        return len(self.matches) + len(self.unmatched_rig)

    @property
    def verdict(self) -> str:
        """One sentence that says what the agreement is worth."""
        return f"{_finding(self)}{_driven(self)}."

    def to_dict(self) -> dict[str, Any]:
        """Return plain data for JSON.

        Keys: `verdict`; `tolerance`, `excitation_tolerance` (fractions); `rig_lines` (their number); `warnings`;
        `matches`: list of `rig` {`frequency_hz`, `label`, `uncertainty_hz`, `damping_ratio`}, `mode_number` (from 1),
        `mode_frequency_hz`, `mode_description`, `error_percent` (mode relative to rig), `within_tolerance` (true),
        `within_uncertainty` (null: none stated), `runner_up` (null: not ambiguous) {`mode_number`, `frequency_hz`,
        `error_percent`, `matched_elsewhere`}, `mode_damping_ratio`, `excitations` and `mode_excitations` [{`name`,
        `frequency_hz`}]; `unmatched_rig`: list of `rig`, `nearest_mode` (keys as in `runner_up`; null: no elastic
        mode), `excitations`; `unmatched_modes`: list of `mode_number`, `frequency_hz`, `description`, `excitations`;
        `chance`: the attributes of `Chance`, `number_is_evidence`, `closeness_is_evidence` and `measure` (how the share
        of the band is measured).
        """
        worth = {name: getattr(self.chance, name) for name in ("number_is_evidence", "closeness_is_evidence")}
        return {
            "verdict": self.verdict,
            "tolerance": self.tolerance,
            "excitation_tolerance": self.excitation_tolerance,
            "rig_lines": self.rig_count,
            "matches": [{**asdict(match), "within_tolerance": True} for match in self.matches],
            "unmatched_rig": [asdict(line) for line in self.unmatched_rig],
            "unmatched_modes": [asdict(mode) for mode in self.unmatched_modes],
            "chance": {**asdict(self.chance), **worth, "measure": "log frequency"},
            "warnings": list(self.warnings),
        }


def _finding(comparison: Comparison) -> str:
    """Return the finding of the verdict: the matches against what chance gives."""
    chance = comparison.chance
    count = comparison.rig_count
    matched = len(comparison.matches)
    within = f"within {_percent(comparison.tolerance)}"
    random = f"a random list would match {chance.expected_random_matches:.1f} of {count}"
    if matched == 0:
        lines = "The rig line is not" if count == 1 else f"None of the {count} rig lines is"
        return f"{lines} {within} of a mode, where {random}: the modes given do not reproduce the rig"
    head = f"{matched} of {count} rig lines {'is' if matched == 1 else 'are'} {within}"
    cover = f"{_percent(chance.coverage)} of the band lies {within} of some mode"
    if chance.number_is_evidence:
        rare = f"{random}, and as many in {_percent(chance.probability_as_many)} of cases"
        worth = f"so the agreement is evidence for the model {_UNFITTED}{_missing(count - matched)}"
        return f"{head}, while {cover}: {rare}, {worth}"
    if chance.closeness_is_evidence:
        close = f"{_percent(chance.probability_as_close)} of random lists come as close, which is evidence {_UNFITTED}"
        return f"{head}, but {cover}: {random}, so that alone is no evidence for the model; only {close}"
    return f"{head}, but {cover}: {random}, so the agreement is no evidence for the model"


def _missing(count: int) -> str:
    return f", though {count} rig line{'s have' if count > 1 else ' has'} no mode" if count else ""


def _driven(comparison: Comparison) -> str:
    """Return the clause on rig lines that may be forced response, or nothing."""
    lines: Sequence[Match | UnmatchedRigLine] = (*comparison.matches, *comparison.unmatched_rig)
    driven = sum(1 for line in lines if line.excitations)
    if driven == 0:
        return ""
    verb = "coincides" if driven == 1 else "coincide"
    which = f"{driven} of the {comparison.rig_count} rig lines {verb} with an excitation line"
    return f"; {which} and may be no natural frequency at all"


def _percent(share: float) -> str:
    return f"{100.0 * share:.3g} %"
