"""Compare measured mode shapes with those of a model: pairs by frequency and shape, beside what chance gives.

A measured mode is not the nearest one in frequency and shape: between two modes that veer both are mixtures of what the model
has, and its springs are known to 30 % only. So springs are first moved to where lines and shapes want them (`misfit.py`, a step
each against less and less enlarged noise), lines are paired with the modes there, and each of these is followed back to the model
as it is, along a straight path in the logs of the stiffnesses: one-to-one by overlap in mass, in halves where a mode turns too
far in one step.

Modes closer to each other than the model knows their frequencies turn into each other at the slightest change. A measured shape
is compared with the plane that they span, and several of them by principal angles (Bjorck and Golub 1973), never one by one.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.common.discretise import cut_of
from rotorgear.analysis.common.points import point_node
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import check_whole, share_of
from rotorgear.analysis.rig.compare import ABOVE_RIG, excitations_at, modes_beside, significance
from rotorgear.analysis.rig.likeness import mac, pairs_by_both
from rotorgear.analysis.rig.measured import Measured, read_rig_shapes
from rotorgear.analysis.rig.misfit import SHAPE_NOISE, Fit, Misfit, approach, first_fit
from rotorgear.analysis.rig.posterior import DEFAULT_PRIOR, LINE_NOISE, learnt_stiffnesses, spring_shares
from rotorgear.analysis.rig.rig_model import RigModel
from rotorgear.analysis.rig.sensor_errors import sensor_doubts
from rotorgear.analysis.sensitivity.derivatives import SPRINGS
from rotorgear.errors import AnalysisError
from rotorgear.model.address import tables_of
from rotorgear.model.model import Model
from rotorgear.model.numbers import free_numbers, is_number
from rotorgear.progress import Progress, silent
from rotorgear.results.comparison import RigLine
from rotorgear.results.correlation import ALIKE, ShapeChance, ShapeComparison, ShapeMatch, Subspace
from rotorgear.results.modal import ModalResult
from rotorgear.system.plan import Plan

# A mode is followed where this share of it is in one mode of the next place, or after this many halvings of a step.
_CLEAR = 0.6
_HALVES = 5


def identified_pairs(
    model: Model, plan: Plan, fmax: float, given: Measured, tolerance: float
) -> list[tuple[int, int]] | None:
    """Return (line, elastic mode of the model), ascending in lines; None where no spring is uncertain or no line is near a mode.

    Args:
        model: the model, at standstill.
        plan: its mesh.
        fmax: highest frequency in Hz of the modes that lines may belong to.
        given: measured shapes.
        tolerance: largest |f_mode / f_rig - 1| of a line without shape.
    """
    tables = tables_of(model)
    addresses = [
        f"{table}.{name}.stiffness"
        for table in SPRINGS
        for name, part in tables.get(table, {}).items()
        if is_number(part.get("stiffness"))
    ]
    if not addresses:
        return None
    part = RigModel(free_numbers(model, addresses, DEFAULT_PRIOR), plan, fmax, given.points)
    misfit = Misfit((part,), given, np.zeros(len(given.lines), dtype=np.intp), SHAPE_NOISE, tolerance)
    start = first_fit(misfit)
    if not start.pairs:
        return None
    end = approach(misfit, start, silent)
    back = followed(misfit, end, start, [pair.mode for pair in end.pairs])
    return [(pair.line, mode) for pair, mode in zip(end.pairs, back, strict=True) if mode >= 0]


def followed(misfit: Misfit, here: Fit, there: Fit, wanted: list[int], halves: int = _HALVES) -> list[int]:
    """Numbers at `there` of the modes that have the numbers `wanted` at `here`; -1 of one that left the range."""
    from scipy.optimize import linear_sum_assignment

    overlap = here.modes.overlap(there.modes)
    rows, columns = linear_sum_assignment(-overlap)
    now = dict(zip(rows.tolist(), columns.tolist(), strict=True))
    clear = all(overlap[k, now[k]] > _CLEAR for k in wanted if k in now)
    if clear or halves == 0:
        return [now.get(k, -1) for k in wanted]
    x = 0.5 * (here.x + there.x)
    middle = misfit.beside(x, misfit.modes(x), ())
    return followed(misfit, middle, there, followed(misfit, here, middle, wanted, halves - 1), halves - 1)


# A pair lies within four standard deviations, so that a model without uncertain springs reaches as far as the tolerance.
_DEVIATIONS = 4.0
_EXCITED = 0.005
# Pairs take some ten modal solutions, which a whole casing would make slow: larger models are paired as they are.
_MOST_DOFS = 5000


@recorded
def compare_shapes(
    source: Model | ModalResult,
    shapes: str | Path | Measured,
    *,
    points: str | Path | None = None,
    tolerance: float = 0.05,
    speed: float | str | None = None,
    accuracy: float | None = None,
    elements: int | None = None,
    samples: int = 500,
    seed: int = 0,
    progress: Progress = silent,
) -> ShapeComparison:
    """Pair measured shapes with modes and say what the agreement is worth, and what the sensors can tell.

    Args:
        source: modes of a model, or a model, whose modes are then found up to 1.3 times the highest line.
        shapes: measured mode shapes: a universal file (dataset 55); in Python also what it holds.
        points: table of the sensors (CSV: point,node,direction; default: each node is at the nearest place of the model).
        tolerance: as in `compare`.
        speed: as in `compare`.
        accuracy: as in `compare`.
        elements: as in `compare`.
        samples: as in `compare`.
        seed: as in `compare`.
        progress: callable that is told fraction and step.

    Returns:
        Matches with MAC, tables of MAC among rig and model, COMAC, groups of close modes, sensors in doubt, and chance.

    Raises:
        AnalysisError: no shapes, places that the model has not, a tolerance that makes no sense.
        ModelError: a file that can't be read.
    """
    model = source if isinstance(source, Model) else source.model
    given = shapes if isinstance(shapes, Measured) else read_rig_shapes(shapes, points, model)
    if given.shapes is None or not given.lines or not given.points:
        raise AnalysisError("there are no measured shapes to compare with")
    tolerance = share_of(tolerance, "tolerance", "0.05")
    check_whole("the number of random lists (samples)", samples)
    given.check_points(model)
    # A line may have a mode that softer springs than the model's have brought down.
    highest = ABOVE_RIG * (1.0 + 0.5 * DEFAULT_PRIOR) * max(line.frequency_hz for line in given.lines)
    result, excitations = modes_beside(source, highest, speed, accuracy, elements, progress)
    modes = _Modes.of(result, given.points)
    alike = modes.likeness(given.shapes)
    rig_hz = np.array([line.frequency_hz for line in given.lines])
    spread = np.hypot(tolerance / _DEVIATIONS, modes.spread)
    # At standstill by what springs of 30 % may do, else by frequency and shape as they are.
    found = None
    if result.speed is None and result.dofs <= _MOST_DOFS:
        found = identified_pairs(model, Plan(cut=cut_of(result.discretisation)), highest, given, tolerance)
    pairs = [(line, mode) for line, mode in found or () if mode < len(modes.hz)]
    # Lines that no springs bring to a mode, because a sensor is wrong or the model is, go by the modes that are left as they are.
    lines = np.setdiff1d(np.arange(len(rig_hz)), [line for line, _ in pairs])
    left = np.setdiff1d(np.arange(len(modes.hz)), [mode for _, mode in pairs])
    if len(lines) and len(left):
        others, _ = pairs_by_both(rig_hz[lines], modes.hz[left], spread[left], alike[np.ix_(lines, left)])
        pairs += [(int(lines[line]), int(left[mode])) for line, mode in others]
    pairs.sort()
    chance = _chance(modes, rig_hz, alike, spread, tolerance, samples, seed)
    matches = []
    for line, mode in pairs:
        rig = given.lines[line]
        shape = given.shapes[line]
        known = np.isfinite(shape)
        own = modes.at_points[mode, known]
        size = np.sum(np.abs(own) ** 2)
        reach = max(_EXCITED * rig.frequency_hz, rig.uncertainty_hz or 0.0)
        matches.append(
            ShapeMatch(
                rig=rig,
                mode_number=int(modes.number[mode]),
                mode_frequency_hz=float(modes.hz[mode]),
                error_percent=float(100.0 * (modes.hz[mode] / rig.frequency_hz - 1.0)),
                mac=float(alike[line, mode]),
                scale=float(np.abs(np.vdot(own, shape[known])) / size) if size > 0.0 else float("nan"),
                phase_collinearity=phase_collinearity(shape),
                close_to=tuple(int(modes.number[k]) for k in modes.group[mode] if k != mode),
                excitations=excitations_at(excitations, rig.frequency_hz, reach),
            )
        )
    paired = {line for line, _ in pairs}
    seen = [(line, mode) for line, mode in pairs if np.isfinite(given.shapes[line]).any()]
    matched = [given.shapes[line] for line, _ in seen]
    groups = [list(modes.group[mode]) for _, mode in seen]
    progress(0.95, "sensors")
    distances = [sensor.distance for sensor in given.sensors] or [None] * len(given.points)
    return ShapeComparison(
        model=model,
        points=given.points,
        distance=np.array([np.nan if distance is None else distance for distance in distances]),
        rig_hz=rig_hz,
        mode_number=modes.number,
        mode_hz=modes.hz,
        mac=alike,
        auto_mac=mac(given.shapes, given.shapes),
        model_auto_mac=mac(modes.at_points, modes.at_points),
        comac=_comac(matched, [modes.at_points[group] for group in groups], len(given.points)),
        matches=tuple(matches),
        unmatched=tuple(line for k, line in enumerate(given.lines) if k not in paired),
        subspaces=_subspaces(modes, seen, given.lines, given.shapes),
        doubts=sensor_doubts(
            given.points, modes.axes, np.array(matched), [modes.everywhere[group] for group in groups]
        ),
        tolerance=tolerance,
        chance=chance,
        stiffnesses=learnt_stiffnesses(
            result.strain_energy, [int(modes.number[mode]) - 1 for _, mode in pairs], [given.lines[k] for k, _ in pairs]
        ),
        dofs=result.dofs,
        left_out=result.left_out,
        warnings=(*given.notes, *result.warnings),
        method="pairs by ln f and shape, springs known to 30 %",
    )


@dataclass(frozen=True)
class _Modes:
    """Elastic modes at s sensors.

    Attributes:
        number: in the result, from 1 (m,).
        hz: frequencies (m,).
        spread: relative standard deviation of each, by springs that are known to 30 % and reading (m,).
        at_points: along the sensors (m, s).
        everywhere: all six motions at the places of the sensors (m, s, 6).
        axes: direction of each sensor, 0 to 5 (s,).
        group: of each mode, the modes that are too close to be told from it, itself among them.
    """

    number: NDArray[np.intp]
    hz: NDArray[np.float64]
    spread: NDArray[np.float64]
    at_points: NDArray[np.complex128]
    everywhere: NDArray[np.complex128]
    axes: NDArray[np.intp]
    group: tuple[tuple[int, ...], ...]

    @classmethod
    def of(cls, result: ModalResult, points: tuple[str, ...]) -> _Modes:
        result.nodes.require()
        elastic = np.flatnonzero(~result.rigid & (result.natural_frequency_hz > 0.0))
        if not elastic.size:
            raise AnalysisError("there are no elastic modes to compare with")
        elastic = elastic[np.argsort(result.natural_frequency_hz[elastic], kind="stable")]
        hz = result.natural_frequency_hz[elastic]
        nodes, axes = np.array([point_node(result.model, result.nodes, name) for name in points]).T
        everywhere = np.moveaxis(result.shapes[nodes][:, :, elastic], 2, 0)
        error = np.nan_to_num(result.error_estimate[elastic], nan=0.0)
        _, springs = spring_shares(result.strain_energy, elastic)
        spread = np.hypot(LINE_NOISE, 0.5 * DEFAULT_PRIOR * np.sqrt(np.sum(springs**2, axis=0)))
        at_points = everywhere[:, np.arange(len(points)), axes]
        # Chains of modes, ascending, whose neighbours are closer than their errors, or than a line can be read.
        near = np.diff(np.log(hz)) <= np.maximum(error[1:] + error[:-1], LINE_NOISE)
        chain = np.concatenate([[0], np.cumsum(~near)])
        group = tuple(tuple(map(int, np.flatnonzero(chain == number))) for number in chain)
        return cls(elastic + 1, hz, spread, at_points, everywhere, axes, group)

    def likeness(self, shapes: NDArray[np.complex128]) -> NDArray[np.float64]:
        """MAC of shapes (n, s) and modes, (n, m); of close modes the share of the shape in their plane."""
        found = mac(shapes, self.at_points)
        whole = bool(np.isfinite(shapes).all())
        for group in dict.fromkeys(self.group):
            if len(group) < 2:
                continue
            plane = self.at_points[list(group)]
            if whole:
                inside = np.sum(np.abs(shapes @ _basis(plane).conj()) ** 2, axis=1)
                share = inside / np.maximum(np.sum(np.abs(shapes) ** 2, axis=1), 1e-300)
            else:
                share = np.full(len(shapes), np.nan)
                for k, shape in enumerate(shapes):
                    known = np.isfinite(shape)
                    size = float(np.sum(np.abs(shape[known]) ** 2))
                    if size > 0.0:
                        Q = _basis(plane[:, known])
                        share[k] = np.sum(np.abs(Q.conj().T @ shape[known]) ** 2) / size
            found[:, list(group)] = share[:, None]
        return found


def _basis(plane: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Orthonormal columns (s, r) of what modes (c, s) span; modes that are the same at the sensors count once."""
    left, singular, _ = np.linalg.svd(plane.T, full_matrices=False)
    return np.asarray(left[:, singular > 1e-9 * singular[0]])


def phase_collinearity(shape: NDArray[np.complex128]) -> float:
    """Modal phase collinearity of a shape (s,) (Pappa, Elliott and Schenk 1993): 1 where all parts are in phase, 0 on a circle.

    The share by which the larger principal axis of (Re, Im) exceeds the smaller one, squared.
    """
    known = shape[np.isfinite(shape)]
    if known.size < 2 or not np.abs(known).any():
        return 1.0
    x = known.real
    y = known.imag
    xx = float(x @ x)
    yy = float(y @ y)
    xy = float(x @ y)
    return ((xx - yy) ** 2 + 4.0 * xy**2) / (xx + yy) ** 2


def _comac(
    shapes: list[NDArray[np.complex128]], planes: list[NDArray[np.complex128]], count: int
) -> NDArray[np.float64]:
    """COMAC (s,) (Lieven and Ewins 1988) of matched shapes and what of their modes fits them best, all of one size."""
    cross = np.zeros(count)
    rig = np.zeros(count)
    computed = np.zeros(count)
    for shape, plane in zip(shapes, planes, strict=True):
        known = np.isfinite(shape)
        y = shape[known] / np.sqrt(np.mean(np.abs(shape[known]) ** 2))
        Q = _basis(plane[:, known])
        fit = Q @ (Q.conj().T @ y)
        cross[known] += np.real(np.conj(y) * fit)
        rig[known] += np.abs(y) ** 2
        computed[known] += np.abs(fit) ** 2
    size = rig * computed
    return np.where(size > 0.0, cross**2 / np.where(size > 0.0, size, 1.0), np.nan)


def _subspaces(
    modes: _Modes, pairs: list[tuple[int, int]], lines: tuple[RigLine, ...], shapes: NDArray[np.complex128]
) -> tuple[Subspace, ...]:
    """Groups of close modes that measured shapes belong to, with the principal angles between both."""
    found = []
    for group in dict.fromkeys(modes.group[mode] for _, mode in pairs):
        if len(group) < 2:
            continue
        members = [line for line, mode in pairs if mode in group]
        known = np.isfinite(shapes[members]).all(axis=0)
        cosines = np.linalg.svd(
            _basis(shapes[members][:, known]).conj().T @ _basis(modes.at_points[list(group)][:, known]),
            compute_uv=False,
        )
        angles = np.arccos(np.clip(cosines[: len(members)], 0.0, 1.0))
        found.append(
            Subspace(
                tuple(int(modes.number[k]) for k in group),
                tuple(float(modes.hz[k]) for k in group),
                tuple(lines[k].frequency_hz for k in members),
                tuple(float(angle) for angle in angles),
            )
        )
    return tuple(found)


def _chance(
    modes: _Modes,
    rig_hz: NDArray[np.float64],
    alike: NDArray[np.float64],
    spread: NDArray[np.float64],
    tolerance: float,
    samples: int,
    seed: int,
) -> ShapeChance:
    """What random lists do, assigned in the same way.

    Shapes are mixed at random from those of the model, each of one size: so they move as this structure can, which is harder to
    beat than any direction in space.
    """
    random = np.random.default_rng(seed)
    low = rig_hz.min() / (1.0 + tolerance)
    high = rig_hz.max() * (1.0 + tolerance)
    size = np.sqrt(np.sum(np.abs(modes.at_points) ** 2, axis=1, keepdims=True))
    unit = modes.at_points / np.where(size > 0.0, size, 1.0)

    def score(hz: NDArray[np.float64], likeness: NDArray[np.float64]) -> tuple[int, float]:
        pairs, cost = pairs_by_both(hz, modes.hz, spread, likeness)
        good = sum(abs(modes.hz[k] / hz[i] - 1.0) <= tolerance and likeness[i, k] >= ALIKE for i, k in pairs)
        return int(good), cost

    many, distance = score(rig_hz, alike)
    scores = []
    for _ in range(samples):
        hz = low * (high / low) ** random.random(len(rig_hz))
        shapes = random.standard_normal((len(rig_hz), len(unit))) @ unit
        scores.append(score(hz, modes.likeness(shapes)))
    counts, distances = np.array(scores).T
    chance = (significance(counts >= many), significance(distances <= distance))
    return ShapeChance(float(counts.mean()), *chance, samples, seed)
