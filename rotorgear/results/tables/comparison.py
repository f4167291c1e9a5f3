"""The rig comparison as a table for the terminal: matches, what is left over on both sides, and what chance gives."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from rotorgear.results.comparison import Candidate, Comparison, ExcitationLine, Match, UnmatchedRigLine, learnt_words
from rotorgear.results.tables.common import notes_of

if TYPE_CHECKING:
    from rich.console import RenderableType


def compare_table(comparison: Comparison) -> RenderableType:
    """Return the comparison as one rich renderable that fits 80 columns."""
    from rich import box
    from rich.console import Group
    from rich.table import Table
    from rich.text import Text

    chance = comparison.chance
    by_chance = (
        f"Chance: {100 * chance.coverage:.1f} % of the band {chance.band_low_hz:.1f} to {chance.band_high_hz:.1f} Hz "
        f"(measured in log frequency) lies within {100 * comparison.tolerance:.3g} % of one of its "
        f"{chance.modes_in_band} modes. Of {chance.samples} random lists of {comparison.rig_count}, the mean matches "
        f"{chance.expected_random_matches:.2f}; {100 * chance.probability_as_many:.3g} % match as many as the rig, "
        f"{100 * chance.probability_as_close:.3g} % come as close. Independent lines in closed form: "
        f"{chance.binomial_expected:.2f}, {100 * chance.binomial_probability:.3g} %."
    )
    rest = [by_chance, *_learnt(comparison), *notes_of(comparison)]
    matches = Table(title="Rig comparison", title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False)
    for name in ("rig Hz", "mode", "model Hz", "error %"):
        matches.add_column(name, justify="right", no_wrap=True)
    matches.add_column("runner-up", no_wrap=True)
    matches.add_column("note", overflow="fold", ratio=1)
    for match in comparison.matches:
        cells = (
            f"{match.rig.frequency_hz:.1f}",
            str(match.mode_number),
            f"{match.mode_frequency_hz:.1f}",
            f"{match.error_percent:+.2f}",
            _candidate(match.runner_up, "\n") if match.runner_up else "",
            "\n".join(_notes(match)),
        )
        matches.add_row(*(Text(cell) for cell in cells))  # brackets in a label are no markup
    parts: list[RenderableType] = [
        *([matches] if comparison.matches else []),
        *(Text(f"{_unmatched_line(line, comparison.tolerance)}\n") for line in comparison.unmatched_rig),
        *_unmatched_modes(comparison),
        *(Text(f"{paragraph}\n") for paragraph in rest),
        Text(comparison.verdict, style="bold"),
    ]
    return Group(*parts)


def _learnt(comparison: Comparison) -> list[str]:
    """What the matched lines would teach of the stiffnesses, and what is assumed for it."""
    rows = comparison.stiffnesses
    if not rows:
        return []
    taken = f"if stiffnesses are known to {100 * rows[0].prior:.0f} % and lines to 0.5 % where they state nothing"
    return [f"{learnt_words(rows, len(comparison.matches), 'matched lines')} This holds {taken}."]


def _notes(match: Match) -> list[str]:
    rig = match.rig
    notes = [text for text in (rig.label, match.mode_description) if text]
    if match.excitations:
        notes.append(f"rig line coincides with {_names(match.excitations)}")
    extra = [line for line in match.mode_excitations if line not in match.excitations]
    if extra:
        notes.append(f"mode coincides with {_names(extra)}")
    if match.within_uncertainty is not None:
        side = "within" if match.within_uncertainty else "outside"
        notes.append(f"{side} the rig's own +/- {rig.uncertainty_hz:.3g} Hz")
    if rig.damping_ratio is not None and match.mode_damping_ratio is not None:
        notes.append(f"damping: rig {100 * rig.damping_ratio:.3g} %, model {100 * match.mode_damping_ratio:.3g} %")
    return notes


def _unmatched_line(line: UnmatchedRigLine, tolerance: float) -> str:
    label = f" ({line.rig.label})" if line.rig.label else ""
    text = f"Rig line {line.rig.frequency_hz:.1f} Hz{label} has no mode within {100 * tolerance:.3g} %"
    nearest = line.nearest_mode
    if nearest and nearest.matched_elsewhere:
        text += f" to itself; the nearest, {_candidate(nearest)}, belongs to another line"
    elif nearest:
        text += f"; the nearest is {_candidate(nearest)}"
    if line.excitations:
        text += f". It coincides with {_names(line.excitations)}"
    return f"{text}."


def _unmatched_modes(comparison: Comparison) -> Iterable[RenderableType]:
    """Yield the modes without a rig line, number and frequency, then those that an excitation meets by name."""
    from rich.columns import Columns
    from rich.text import Text

    modes = comparison.unmatched_modes
    if not modes:
        return
    yield Text(
        f"Without a rig line: {len(modes)} of {comparison.chance.modes_in_band} elastic modes in the band, no. and Hz"
    )
    yield Columns([Text(f"{mode.mode_number:>4} {mode.frequency_hz:>8.1f}") for mode in modes], padding=(0, 2))
    met = [f"mode {mode.mode_number} with {_names(mode.excitations)}" for mode in modes if mode.excitations]
    yield Text(f"Of these coincide: {'; '.join(met)}.\n" if met else "")


def _candidate(candidate: Candidate, separator: str = " ") -> str:
    return f"{candidate.mode_number}: {candidate.frequency_hz:.1f} Hz{separator}({candidate.error_percent:+.2f} %)"


def _names(lines: Iterable[ExcitationLine]) -> str:
    return ", ".join(str(line) for line in lines)
