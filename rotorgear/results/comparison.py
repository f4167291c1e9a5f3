"""Comparison of natural frequencies with the lines of a test rig: what matches, what does not, and what chance gives.

Errors are those of the mode relative to the rig, e = f_mode / f_rig - 1. A line of unknown origin, thrown at random on
the band (uniform in log frequency), lies within the tolerance t of a mode where f_mode / (1 + t) <= f <= f_mode / (1 -
t); the share of the band that these intervals cover together is what one match is worth. Significance by random lists:
Davison & Hinkley, Bootstrap Methods and their Application (1997), section 4.2.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

from rotorgear.errors import ModelError, Problem
from rotorgear.results.result import Result
from rotorgear.results.schema import Record, derived, of
from rotorgear.results.table import Block, Column, Line, Table, table_of

EVIDENCE_LEVEL = 0.05
# So many modes stand in a line.
_ABREAST = 5
_UNFITTED = "if it was not fitted to these lines"


# A number that the lines settle to less than half is never called identified.
IDENTIFIED = 0.5
# Below this share the lines say nothing that anybody could use.
UNSEEN = 0.01


class LearntParameter(Record):
    """One uncertain number, before and after the lines; standard deviations relative to its value."""

    address: str = of("address in the model file")
    prior: float = of("relative standard deviation before the test")
    sigma: float = of("relative standard deviation after the test")
    learnt: float = of("share of the prior variance that the lines removed", form=".0%")


def learnt_words(rows: tuple[LearntParameter, ...], lines: int, what: str) -> str:
    """Two sentences: how many numbers the lines teach, and which ones best and not at all.

    Args:
        rows: the parameters.
        lines: number of measured values.
        what: the measured values in the plural, such as "matched lines".
    """
    total = sum(row.learnt for row in rows)
    best = max(rows, key=lambda row: row.learnt)
    head = (
        f"The {lines} {what} teach {total:.1f} of {len(rows)} parameters. Best known: {best.address}, "
        f"±{100 * best.sigma:.2g} % from ±{100 * best.prior:.2g} %"
    )
    unseen = [row.address for row in rows if row.learnt < UNSEEN]
    return f"{head}. They say next to nothing of {', '.join(unseen)}." if unseen else f"{head}."


class RigLine(Record):
    """One measured line: frequency and standard uncertainty in Hz, damping ratio as a fraction of critical.

    Raises:
        ModelError: a number that no measurement can have; all of them at once.
    """

    frequency_hz: float = of("frequency", "Hz", note=", measured")
    label: str = of("label", note=', or `""`', default="")
    uncertainty_hz: float | None = of(
        "standard uncertainty", "Hz", note=" of the measured frequency, or `null`", default=None
    )
    damping_ratio: float | None = of("damping ratio", note=", measured, as a fraction, or `null`", default=None)

    def __post_init__(self) -> None:
        super().__post_init__()
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


class ExcitationLine(Record):
    """A frequency at which the machine is driven whatever its modes are: a shaft order or a mesh order."""

    name: str = of("name", note=" of a shaft or mesh order")
    frequency_hz: float = of("frequency", "Hz")

    def __str__(self) -> str:
        return f"{self.name} {self.frequency_hz:.1f} Hz"


class Candidate(Record):
    """A mode beside a rig line: number (from 1, rigid modes counted), frequency, its error against that line in %.

    `matched_elsewhere`: the mode is the partner of another rig line.
    """

    mode_number: int = of("number of the mode", note=", from 1, rigid-body modes counted")
    frequency_hz: float = of("frequency", "Hz")
    error_percent: float = of("frequency of the mode over that of the rig, less 1", "%")
    matched_elsewhere: bool = of("whether the mode belongs to another rig line", default=False)

    def words(self, separator: str = " ") -> str:
        """Number, frequency and error."""
        return f"{self.mode_number}: {self.frequency_hz:.1f} Hz{separator}({self.error_percent:+.2f} %)"


class Match(Record):
    """A rig line and its mode, within the tolerance.

    `within_uncertainty` is None where the rig states no uncertainty. `runner_up` is given where the assignment is
    ambiguous: the next mode is within the tolerance too, and either within twice the error of the chosen one or within
    the reading accuracy of the line (its stated uncertainty, else 0.1 %). `excitations` coincide with the rig line,
    `mode_excitations` with the mode.
    """

    rig: RigLine = of("rig line", record=RigLine)
    mode_number: int = of("number of the mode", note=", from 1, rigid-body modes counted", column="mode")
    mode_frequency_hz: float = of("frequency of the mode", "Hz", form=".1f", column="model Hz")
    mode_description: str = of("what moves")
    error_percent: float = of("frequency of the mode over that of the rig, less 1", "%", form="+.2f", column="error %")
    within_uncertainty: bool | None = of(
        "whether the difference is within the rig's uncertainty", note="; `null`: none stated"
    )
    runner_up: Candidate | None = of(
        "another mode that fits nearly as well", record=Candidate, note="; `null` where the choice is clear"
    )
    mode_damping_ratio: float | None = of("damping ratio of the mode", note="; `null` at standstill")
    excitations: tuple[ExcitationLine, ...] = of(
        "shaft and mesh orders that coincide with it", "", "excitation", record=ExcitationLine
    )
    mode_excitations: tuple[ExcitationLine, ...] = of(
        "shaft and mesh orders that coincide with the mode", "", "excitation", record=ExcitationLine
    )

    @derived("whether the mode is within the tolerance", note=": `true`, since what is outside is no match")
    def within_tolerance(self) -> bool:
        """What is outside is no match."""
        return True

    def notes(self) -> list[str]:
        """What there is to know of the pair: label, mode, coincidences, the rig's own uncertainty, damping."""
        rig = self.rig
        notes = [text for text in (rig.label, self.mode_description) if text]
        if self.excitations:
            notes.append(f"rig line coincides with {_names(self.excitations)}")
        extra = [line for line in self.mode_excitations if line not in self.excitations]
        if extra:
            notes.append(f"mode coincides with {_names(extra)}")
        if self.within_uncertainty is not None:
            side = "within" if self.within_uncertainty else "outside"
            notes.append(f"{side} the rig's own +/- {rig.uncertainty_hz:.3g} Hz")
        if rig.damping_ratio is not None and self.mode_damping_ratio is not None:
            notes.append(f"damping: rig {100 * rig.damping_ratio:.3g} %, model {100 * self.mode_damping_ratio:.3g} %")
        return notes


class UnmatchedRigLine(Record):
    """A rig line without a mode; the nearest elastic mode is outside the tolerance or the partner of another line."""

    rig: RigLine = of("rig line", record=RigLine)
    nearest_mode: Candidate | None = of("nearest elastic mode", record=Candidate, note="; `null` where there is none")
    excitations: tuple[ExcitationLine, ...] = of(
        "shaft and mesh orders that coincide with it", "", "excitation", record=ExcitationLine
    )

    def sentence(self, tolerance: float) -> str:
        """How far the nearest mode is, and which excitation the line coincides with."""
        label = f" ({self.rig.label})" if self.rig.label else ""
        text = f"Rig line {self.rig.frequency_hz:.1f} Hz{label} has no mode within {100 * tolerance:.3g} %"
        nearest = self.nearest_mode
        if nearest and nearest.matched_elsewhere:
            text += f" to itself; the nearest, {nearest.words()}, belongs to another line"
        elif nearest:
            text += f"; the nearest is {nearest.words()}"
        if self.excitations:
            text += f". It coincides with {_names(self.excitations)}"
        return f"{text}."


class UnmatchedMode(Record):
    """An elastic mode inside the band to which no rig line was assigned."""

    mode_number: int = of("number of the mode", note=" in the band without a rig line")
    frequency_hz: float = of("frequency", "Hz")
    description: str = of("what moves")
    excitations: tuple[ExcitationLine, ...] = of(
        "shaft and mesh orders that coincide with it", "", "excitation", record=ExcitationLine
    )


class Chance(Record):
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

    band_low_hz: float = of("lowest frequency of a random line", "Hz")
    band_high_hz: float = of("highest frequency of a random line", "Hz")
    modes_in_band: int = of("elastic modes in the band")
    coverage: float = of("share of the band that lies within the tolerance of some mode")
    expected_random_matches: float = of("mean number of matches of a random list of as many lines")
    probability_as_many: float = of("share of random lists that match at least as many lines")
    probability_as_close: float = of("share of random lists that come at least as close in the sum of |ln(mode / rig)|")
    binomial_expected: float = of("mean number of matches in closed form, if lines could share a mode")
    binomial_probability: float = of("share of lists that match as many in closed form, if lines could share a mode")
    samples: int = of("number of random lists")
    seed: int = of("seed of the random lists")

    @derived("whether chance matches as many in at most 2.5 % of cases")
    def number_is_evidence(self) -> bool:
        """True where chance matches as many in at most 2.5 % of cases: 5 %, shared by two looks at the same data."""
        return self._is_rare(self.probability_as_many)

    @derived("whether chance comes as close in at most 2.5 % of cases")
    def closeness_is_evidence(self) -> bool:
        """True where chance comes as close in at most 2.5 % of cases."""
        return self._is_rare(self.probability_as_close)

    @derived("how shares of the band are measured")
    def measure(self) -> str:
        """Random lines are uniform in log frequency."""
        return "log frequency"

    def _is_rare(self, probability: float) -> bool:
        """Whether a sampled probability is below the level by more than twice its own sampling error."""
        error = (probability * (1.0 - probability) / self.samples) ** 0.5
        return probability + 2.0 * error <= EVIDENCE_LEVEL / 2


class Comparison(Result, kind="compare"):
    """The whole comparison; relative tolerances as fractions, `warnings` as sentences."""

    matches: tuple[Match, ...] = of("matches", "", "match", record=Match)
    unmatched_rig: tuple[UnmatchedRigLine, ...] = of(
        "rig lines without a mode", "", "unmatched_line", record=UnmatchedRigLine
    )
    unmatched_modes: tuple[UnmatchedMode, ...] = of(
        "modes in the band without a rig line", "", "unmatched_mode", record=UnmatchedMode
    )
    tolerance: float = of("tolerance", note=": largest relative difference of a match")
    excitation_tolerance: float = of("relative distance at which a line coincides with an excitation")
    chance: Chance = of("what chance gives", record=Chance)
    stiffnesses: tuple[LearntParameter, ...] = of(
        "what the matched lines teach of each stiffness",
        "",
        "stiffness",
        record=LearntParameter,
        note="; empty where nothing matched or only frequencies were given",
        default=(),
    )

    @derived(
        "effective number of parameters that the lines teach", note=": the sum of the learnt shares; `null` without any"
    )
    def learnt_parameters(self) -> float | None:
        """Sum of the learnt shares."""
        return sum(row.learnt for row in self.stiffnesses) if self.stiffnesses else None

    @derived("number of rig lines", json="rig_lines")
    def rig_count(self) -> int:
        """The number of rig lines."""
        return len(self.matches) + len(self.unmatched_rig)

    @derived("what the agreement is worth", note=", in one sentence")
    def verdict(self) -> str:
        """One sentence that says what the agreement is worth."""
        # A rig line at a frequency of excitation may be forced response, which says nothing about the modes.
        lines: Sequence[Match | UnmatchedRigLine] = (*self.matches, *self.unmatched_rig)
        driven = sum(1 for line in lines if line.excitations)
        if driven == 0:
            return f"{_finding(self)}."
        verb = "coincides" if driven == 1 else "coincide"
        which = f"{driven} of the {self.rig_count} rig lines {verb} with an excitation line"
        return f"{_finding(self)}; {which} and may be no natural frequency at all."

    def tables(self) -> Iterator[Block]:
        """The matches, lines and modes without a partner, what chance gives and what the agreement is worth."""
        if self.matches:
            yield self._matches()
        for line in self.unmatched_rig:
            yield from (line.sentence(self.tolerance), "")
        yield from self._unmatched_modes()
        chance = self.chance
        yield (
            f"Chance: {100 * chance.coverage:.1f} % of the band {chance.band_low_hz:.1f} to {chance.band_high_hz:.1f} Hz "
            f"(measured in log frequency) lies within {100 * self.tolerance:.3g} % of one of its "
            f"{chance.modes_in_band} modes. Of {chance.samples} random lists of {self.rig_count}, the mean matches "
            f"{chance.expected_random_matches:.2f}; {100 * chance.probability_as_many:.3g} % match as many as the rig, "
            f"{100 * chance.probability_as_close:.3g} % come as close. Independent lines in closed form: "
            f"{chance.binomial_expected:.2f}, {100 * chance.binomial_probability:.3g} %."
        )
        yield ""
        if self.stiffnesses:
            prior = f"{100 * self.stiffnesses[0].prior:.0f} %"
            taken = f"if stiffnesses are known to {prior} and lines to 0.5 % where they state nothing"
            yield f"{learnt_words(self.stiffnesses, len(self.matches), 'matched lines')} This holds {taken}."
            yield ""
        for note in self.remarks():
            yield from (note, "")
        yield Line(self.verdict)

    def _matches(self) -> Table:
        columns = (
            Column("rig Hz", "rig.frequency_hz", ".1f"),
            "mode_number",
            "mode_frequency_hz",
            "error_percent",
            Column("runner-up", lambda match: match.runner_up.words("\n") if match.runner_up else ""),
            Column("note", lambda match: "\n".join(match.notes())),
        )
        return table_of(self, "matches", *columns, caption="Rig comparison", titled=True, ruled=True)

    def _unmatched_modes(self) -> Iterator[str]:
        """The modes without a rig line, number and frequency, then those that an excitation meets by name."""
        modes = self.unmatched_modes
        if not modes:
            return
        count = f"{len(modes)} of {self.chance.modes_in_band} elastic modes in the band, no. and Hz"
        yield f"Without a rig line: {count}"
        cells = [f"{mode.mode_number:>4} {mode.frequency_hz:>8.1f}" for mode in modes]
        for first in range(0, len(cells), _ABREAST):
            yield "  ".join(cells[first : first + _ABREAST])
        met = [f"mode {mode.mode_number} with {_names(mode.excitations)}" for mode in modes if mode.excitations]
        yield f"Of these coincide: {'; '.join(met)}." if met else ""
        if met:
            yield ""


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
        missing = count - matched
        rest = f", though {missing} rig line{'s have' if missing > 1 else ' has'} no mode" if missing else ""
        return f"{head}, while {cover}: {rare}, so the agreement is evidence for the model {_UNFITTED}{rest}"
    if chance.closeness_is_evidence:
        close = f"{_percent(chance.probability_as_close)} of random lists come as close, which is evidence {_UNFITTED}"
        return f"{head}, but {cover}: {random}, so that alone is no evidence for the model; only {close}"
    return f"{head}, but {cover}: {random}, so the agreement is no evidence for the model"


def _percent(share: float) -> str:
    return f"{100.0 * share:.3g} %"


def _names(lines: Iterable[ExcitationLine]) -> str:
    return ", ".join(str(line) for line in lines)
