"""Compare natural frequencies with the lines of a test rig: one-to-one on log frequency, beside what chance gives.

The assignment is globally optimal (`solvers/eigen/assignment.py`): first as many lines as possible within the tolerance, then
the least sum of |ln(f_mode / f_rig)|. A pair outside the tolerance is no match; both sides are then listed as unmatched. Rigid
modes take no part.

What a random list of lines would match is the yardstick. N random lines, uniform in log frequency over the band and independent,
are assigned one-to-one to the same modes as the rig lines were. Monte Carlo significance (1 + hits) / (1 + samples): Davison &
Hinkley, Bootstrap Methods and their Application (1997), section 4.2. In closed form, if lines could share a mode: the number of
matches is binomial with the covered share of the band as probability.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rotorgear.analysis.common.excitation import excitation_lines
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import check_whole, share_of, speed_or_operating
from rotorgear.analysis.modal.modal import modal
from rotorgear.analysis.rig.posterior import learnt_stiffnesses
from rotorgear.analysis.rig.rig_file import refuse_repeated, rig_lines_of
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.note import Note
from rotorgear.progress import Progress, silent
from rotorgear.results.comparison import (
    Candidate,
    Chance,
    Comparison,
    ExcitationLine,
    Match,
    RigLine,
    UnmatchedMode,
    UnmatchedRigLine,
)
from rotorgear.results.modal import ModalResult
from rotorgear.solvers.eigen.assignment import ROUNDING, assign, covered_share, miss_cost

# A random list that does as well to the last digit is a hit; rounding must not decide it.
TIE = 1e-12
# A rig line that states no uncertainty is not trusted beyond this when two modes compete for it.
READING_ACCURACY = 1e-3
# Modes of a model are found up to this much above the highest line of the rig, so that every line meets all its candidates.
ABOVE_RIG = 1.15


def estimate_chance(
    rig_hz: NDArray[np.float64],
    mode_hz: NDArray[np.float64],
    tolerance: float,
    band: tuple[float, float],
    *,
    samples: int = 2000,
    seed: int = 0,
) -> Chance:
    """Return what chance gives for as many lines as `rig_hz` (r,) against the elastic modes `mode_hz` (m,), all in Hz.

    Args:
        tolerance: relative, between 0 and 1.
        band: lowest and highest frequency of a random line, in Hz.
        samples, seed: number of random lists, and their seed.
    """
    low, high = band
    in_reach = mode_hz[(mode_hz >= low * (1.0 - tolerance)) & (mode_hz <= high * (1.0 + tolerance))]
    matched, distance = _score(rig_hz, mode_hz, tolerance)
    draws = np.random.default_rng(seed).random((samples, rig_hz.size))
    scores = np.array([_score(low * (high / low) ** draw, in_reach, tolerance) for draw in draws])
    coverage = covered_share(mode_hz, tolerance, low, high)
    return Chance(
        band_low_hz=low,
        band_high_hz=high,
        modes_in_band=int(np.count_nonzero((mode_hz >= low) & (mode_hz <= high))),
        coverage=coverage,
        expected_random_matches=float(scores[:, 0].mean()),
        probability_as_many=significance(scores[:, 0] >= matched),
        probability_as_close=significance(scores[:, 1] <= distance + TIE),
        binomial_expected=rig_hz.size * coverage,
        binomial_probability=binomial_tail(rig_hz.size, matched, coverage),
        samples=samples,
        seed=seed,
    )


def binomial_tail(count: int, at_least: int, probability: float) -> float:
    """Return the probability of `at_least` or more successes in `count` independent trials.

    The tail is the incomplete beta function I_p(k, n - k + 1) (Abramowitz & Stegun 26.5.24), whose terms do not overflow.
    """
    from scipy.special import betainc

    return 1.0 if at_least == 0 else float(betainc(at_least, count - at_least + 1, probability))


def _score(lines: NDArray[np.float64], modes: NDArray[np.float64], tolerance: float) -> tuple[int, float]:
    """Return the number of matches and the sum of |ln(f / r)|, an unmatched line counting with the full tolerance."""
    pairs = assign(lines, modes, tolerance)
    distance = math.fsum(abs(math.log(modes[mode] / lines[line])) for line, mode in pairs)
    return len(pairs), distance + (lines.size - len(pairs)) * miss_cost(tolerance)


def significance(hits: NDArray[np.bool_]) -> float:
    """Monte Carlo significance: of random lists that do as well, and of the one that was measured."""
    return float((1 + np.count_nonzero(hits)) / (1 + hits.size))


@recorded
def compare_lines(
    frequency_hz: ArrayLike,
    descriptions: Sequence[str],
    rig_lines: Sequence[RigLine],
    *,
    rigid: ArrayLike | None = None,
    damping_ratio: ArrayLike | None = None,
    strain_energy: Mapping[str, ArrayLike] | None = None,
    excitations: Sequence[ExcitationLine] = (),
    tolerance: float = 0.05,
    excitation_tolerance: float = 0.005,
    band: tuple[float, float] | None = None,
    known_to_hz: float | None = None,
    seed: int = 0,
    samples: int = 2000,
) -> Comparison:
    """Assign rig lines to modes and say what the agreement is worth.

    Args:
        frequency_hz: natural frequencies in Hz (m,), in any order; modes are numbered from 1 in this order.
        descriptions: one line a mode (m).
        rig_lines: the measured lines, in any order.
        rigid: True for rigid-body modes (m,); they, and modes at 0 Hz, are never matched.
        damping_ratio: of the modes, as fractions (m,); NaN where unknown.
        strain_energy: share of each part in the strain energy of the modes, part -> (m,), from which follows what the matched
            lines teach of the stiffnesses.
        excitations: shaft and mesh orders. One coincides with a rig line within `excitation_tolerance` or the line's
            own uncertainty, whichever is larger, and with a mode within `excitation_tolerance`.
        tolerance: largest |f_mode / f_rig - 1| of a match.
        band: the frequency range in Hz that the rig looked at, for the chance; default: from the lowest to the highest
            rig line, widened by the tolerance at both ends.
        known_to_hz: frequency up to which all modes are given, where it is above the last one.
        seed, samples: of the random lists.

    Raises:
        AnalysisError: no rig lines, the same line twice, arrays of different length, tolerances, band or samples that
            make no sense.
    """
    frequency = np.asarray(frequency_hz, dtype=float)
    is_rigid = np.zeros(frequency.shape, dtype=bool) if rigid is None else np.asarray(rigid, dtype=bool)
    damping = np.full(frequency.shape, np.nan) if damping_ratio is None else np.asarray(damping_ratio, dtype=float)
    sizes = {"frequency_hz": frequency.shape, "descriptions": (len(descriptions),)}
    sizes |= {"rigid": is_rigid.shape, "damping_ratio": damping.shape}
    if frequency.ndim != 1 or len(set(sizes.values())) > 1:
        raise AnalysisError(f"the modes to compare need one entry a mode in every list, got shapes {sizes}")
    if not np.all(np.isfinite(frequency) & (frequency >= 0.0)):
        raise AnalysisError("the natural frequencies to compare must be finite and not negative")
    # The modes that may be matched, ascending in frequency.
    elastic = np.flatnonzero(~is_rigid & (frequency > 0.0))
    elastic = elastic[np.argsort(frequency[elastic], kind="stable")]
    lines = sorted(rig_lines_of(rig_lines), key=lambda line: line.frequency_hz)
    refuse_repeated(lines)
    rig_hz = np.array([line.frequency_hz for line in lines])
    tolerance = share_of(tolerance, "tolerance", "0.05")
    if excitation_tolerance:
        share_of(excitation_tolerance, "excitation_tolerance", "0.005")
    check_whole("the number of random lists (samples)", samples)
    low, high = map(float, band or (rig_hz[0] / (1.0 + tolerance), rig_hz[-1] * (1.0 + tolerance)))
    if not (0.0 < low < high < np.inf and low <= rig_hz[0] and rig_hz[-1] <= high):
        between = f"{rig_hz[0]:g} to {rig_hz[-1]:g} Hz"
        raise AnalysisError(
            f"the band must be positive and contain the rig lines ({between}), got {low:g} to {high:g} Hz"
        )
    pairs = {row: int(elastic[column]) for row, column in assign(rig_hz, frequency[elastic], tolerance)}
    taken = frozenset(pairs.values())

    def nearest(line: RigLine, without: int = -1) -> Candidate | None:
        others = elastic[elastic != without]
        if others.size == 0:
            return None
        mode = int(others[np.argmin(np.abs(np.log(frequency[others] / line.frequency_hz)))])
        hz = float(frequency[mode])
        return Candidate(mode + 1, hz, 100.0 * (hz / line.frequency_hz - 1.0), mode in taken)

    def driving(hz: float, uncertainty: float | None = None) -> tuple[ExcitationLine, ...]:
        return excitations_at(excitations, hz, max(excitation_tolerance * hz, uncertainty or 0.0) + ROUNDING * hz)

    def match(line: RigLine, mode: int) -> Match:
        hz = float(frequency[mode])
        miss = abs(hz - line.frequency_hz)
        # The next mode where it could as well be the partner (the criterion is stated in `Match`).
        other = nearest(line, without=mode)
        accuracy = READING_ACCURACY * line.frequency_hz if line.uncertainty_hz is None else line.uncertainty_hz
        if other and (
            abs(other.error_percent) > 100.0 * (tolerance + ROUNDING)
            or abs(other.frequency_hz - line.frequency_hz) > max(2.0 * miss, accuracy)
        ):
            other = None
        return Match(
            rig=line,
            mode_number=mode + 1,
            mode_frequency_hz=hz,
            mode_description=descriptions[mode],
            error_percent=100.0 * (hz / line.frequency_hz - 1.0),
            within_uncertainty=None if line.uncertainty_hz is None else miss <= line.uncertainty_hz + ROUNDING * hz,
            runner_up=other,
            mode_damping_ratio=None if np.isnan(damping[mode]) else float(damping[mode]),
            excitations=driving(line.frequency_hz, line.uncertainty_hz),
            mode_excitations=driving(hz),
        )

    warnings = []
    highest = float(frequency[elastic[-1]]) if elastic.size else 0.0
    if elastic.size == 0:
        warnings.append(Note("", "there are no elastic modes to compare with"))
    elif max(highest, known_to_hz or 0.0) < high:
        why = (
            f"if the model has more, compute them up to {high:.1f} Hz, so that every rig line meets all its candidates and the "
            "chance is not underestimated"
        )
        warnings.append(Note("", f"the elastic modes given end at {highest:.1f} Hz", why))
    if rig_hz.size == 1 and band is None:
        why = "give the band that was measured to make the chance meaningful"
        warnings.append(Note("", "a single rig line spans no band of its own", why))
    unmatched = [int(mode) for mode in elastic if mode not in taken and low <= frequency[mode] <= high]
    return Comparison(
        matches=tuple(match(lines[row], mode) for row, mode in pairs.items()),
        unmatched_rig=tuple(
            UnmatchedRigLine(line, nearest(line), driving(line.frequency_hz, line.uncertainty_hz))
            for row, line in enumerate(lines)
            if row not in pairs
        ),
        unmatched_modes=tuple(
            UnmatchedMode(mode + 1, hz, descriptions[mode], driving(hz))
            for mode, hz in ((mode, float(frequency[mode])) for mode in unmatched)
        ),
        tolerance=tolerance,
        excitation_tolerance=excitation_tolerance,
        chance=estimate_chance(rig_hz, frequency[elastic], tolerance, (low, high), samples=samples, seed=seed),
        stiffnesses=learnt_stiffnesses(strain_energy or {}, list(pairs.values()), [lines[row] for row in pairs]),
        warnings=tuple(warnings),
    )


def modes_beside(
    source: Model | ModalResult,
    fmax: float,
    speed: float | str | None,
    accuracy: float | None,
    elements: int | None,
    progress: Progress,
) -> tuple[ModalResult, tuple[ExcitationLine, ...]]:
    """Modes of a model up to a frequency in Hz, or those given; and lines of excitation at their speed, else the operating one.

    Raises:
        AnalysisError: settings of a model beside a result.
    """
    if isinstance(source, Model):
        source = modal(source, speed=speed, fmax=fmax, accuracy=accuracy, elements=elements, progress=progress)
    elif speed is not None or accuracy is not None or elements is not None:
        raise AnalysisError("--speed, --accuracy and --elements belong to a model; a result has its own")
    turning = speed_or_operating(source.speed, source.model)
    return source, excitation_lines(source.model, turning) if turning else ()


def excitations_at(excitations: Sequence[ExcitationLine], hz: float, reach: float) -> tuple[ExcitationLine, ...]:
    """Those within a distance in Hz of a frequency."""
    return tuple(line for line in excitations if abs(line.frequency_hz - hz) <= reach)


@recorded
def compare(
    source: Model | ModalResult,
    rig: str | Path | Sequence[RigLine | float],
    *,
    tolerance: float = 0.05,
    speed: float | str | None = None,
    accuracy: float | None = None,
    elements: int | None = None,
    known_to_hz: float | None = None,
    excitation_tolerance: float = 0.005,
    band: tuple[float, float] | None = None,
    seed: int = 0,
    samples: int = 2000,
    progress: Progress = silent,
) -> Comparison:
    """Assign the lines of a rig to modes and say what the agreement is worth.

    Lines of excitation are those at the speed of the analysis, else at the operating point.

    Args:
        source: modes of a model, or a model, whose modes are then found up to 1.15 times the highest line.
        rig: measured frequencies (CSV); in Python also lines, or plain frequencies in Hz.
        tolerance: largest relative difference |f_mode / f_rig - 1| of a match.
        speed: as in `modal`; a saved result has its own.
        accuracy: as in `modal`; a saved result has its own.
        elements: as in `modal`; a saved result has its own.
        known_to_hz: frequency up to which a result has all modes, where that is above its last one.
        excitation_tolerance: relative distance within which an order of a shaft or a mesh coincides with a line or a mode.
        band: frequency range in Hz that the rig looked at, for the chance of a match (default: from the lowest to the highest
            line, widened by the tolerance at both ends).
        seed: seed of the random lists that chance is found from.
        samples: number of random lists that chance is found from.
        progress: callable that is told fraction and step.

    Returns:
        Matches, lines and modes without a partner, and what chance alone would give.

    Raises:
        AnalysisError: no lines, the same line twice, settings that make no sense, or settings of a model beside a result.
        ModelError: a rig file that can't be read.
    """
    lines = rig_lines_of(rig)
    highest = ABOVE_RIG * max(line.frequency_hz for line in lines)
    result, excitations = modes_beside(source, highest, speed, accuracy, elements, progress)
    return compare_lines(
        result.frequency_hz,
        result.description,
        lines,
        rigid=result.rigid,
        # At standstill without damping a ratio of 0 is no statement about the damping.
        damping_ratio=result.damping_ratio if result.speed is not None else None,
        strain_energy=result.strain_energy,
        excitations=excitations,
        tolerance=tolerance,
        excitation_tolerance=excitation_tolerance,
        band=band,
        known_to_hz=highest if isinstance(source, Model) else known_to_hz,
        seed=seed,
        samples=samples,
    )
