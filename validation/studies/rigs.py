"""Synthetic rigs: a split-torque gearbox whose stiffnesses nobody knows, measured with noise.

    python -m validation.studies.rigs           200 rigs: do stated intervals cover the truth, and are modes paired right? (long)
    python -m validation.studies.rigs 20        so many rigs
    python -m validation.studies.rigs 200 rigs.jsonl 400   for 400 CPU s; the same again goes on from the file
    python -m validation.studies.rigs 40 pairs  without updates: does `compare --shapes` pair lines with their modes?

Each rig is split_torque.toml with its 14 stiffnesses times exp(0.2 N(0, 1)); 20 elastic modes are measured to 0.5 %, with
shapes at 12 points to 2 % of their root mean square. The update starts from the file, with a prior of 20 %.
"""

from __future__ import annotations

import json
import sys
import time
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from scipy.optimize import linear_sum_assignment

import rotorgear as rg
from rotorgear.analysis.rig.likeness import pairs_of
from rotorgear.analysis.rig.measured import Measured
from rotorgear.analysis.rig.rig_model import RigModel, RigModes
from rotorgear.model.numbers import free_numbers
from rotorgear.results.comparison import RigLine
from rotorgear.system.plan import Plan

FREE = "bearings.*.stiffness, meshes.*.stiffness, supports.*.stiffness"
SPREAD = 0.20
FREQUENCY_NOISE = 0.005
SHAPE_NOISE = 0.02
MODES = 20
PLAN = Plan(1, 4)
# Pairs are judged on seeds that nobody looked at while the method was chosen.
FIRST_JUDGED = 5000
# Accelerometers on the bearings, radial and axial, as a rig has them.
SENSORS = {
    "input_left_x": ("bearings.input_left", "x"),
    "input_left_y": ("bearings.input_left", "y"),
    "input_right_y": ("bearings.input_right", "y"),
    "branch_a_left_x": ("bearings.branch_a_left", "x"),
    "branch_a_right_y": ("bearings.branch_a_right", "y"),
    "branch_a_right_z": ("bearings.branch_a_right", "z"),
    "branch_b_left_x": ("bearings.branch_b_left", "x"),
    "branch_b_right_y": ("bearings.branch_b_right", "y"),
    "branch_b_right_z": ("bearings.branch_b_right", "z"),
    "output_left_x": ("bearings.output_left", "x"),
    "output_right_y": ("bearings.output_right", "y"),
    "output_right_z": ("bearings.output_right", "z"),
}


def nominal() -> rg.Model:
    """The model of the designer, with the sensors as points."""
    model = rg.load("models/split_torque.toml")
    points = {name: {"on": on, "direction": direction} for name, (on, direction) in SENSORS.items()}
    return model.with_("points", points)


@dataclass(frozen=True)
class Rig:
    """One gearbox on the rig: the true factors x = ln(p / p0) of its stiffnesses, its lines, and which mode each line is."""

    x: np.ndarray
    measured: Measured


def draw(
    model: rg.Model, seed: int, *, frequency_noise: float = FREQUENCY_NOISE, shape_noise: float = SHAPE_NOISE
) -> Rig:
    """Return a rig of a seed."""
    random = np.random.default_rng(seed)
    numbers = free_numbers(model, FREE, SPREAD)
    x = SPREAD * random.standard_normal(len(numbers.addresses))
    modes = RigModel(numbers, PLAN, 3000.0, tuple(SENSORS)).modes(x)
    hz = modes.frequency_hz[:MODES] * np.exp(frequency_noise * random.standard_normal(MODES))
    shapes = modes.at_points[:MODES]
    size = np.sqrt(np.mean(shapes**2, axis=1, keepdims=True))
    noisy = shapes / size + shape_noise * random.standard_normal(shapes.shape)
    lines = tuple(RigLine(float(f), f"true mode {k + 1}", frequency_noise * float(f)) for k, f in enumerate(hz))
    return Rig(x, Measured(lines, tuple(SENSORS), noisy.astype(complex)))


@dataclass(frozen=True)
class Outcome:
    """What the update by one rig came to.

    Attributes:
        inside: whether the 90 % interval of each number holds the truth; empty where the update came to no end.
        right: lines with their mode, of all of them.
        alone: the same by frequency alone.
        solutions: modal solutions of the update.
    """

    seed: int
    inside: list[bool]
    right: int
    alone: int
    solutions: int


def outcome(model: rg.Model, seed: int) -> Outcome:
    """Update the file by the rig of a seed, and see what it found."""
    rig = draw(model, seed)
    own = RigModel(free_numbers(model, FREE, SPREAD), PLAN, 3000.0, tuple(SENSORS))
    modes = own.modes(0.0 * rig.x)
    hz = np.array([line.frequency_hz for line in rig.measured.lines])
    near = dict(pairs_of(hz, modes.frequency_hz, hz, np.zeros((MODES, 0)), modes.at_points, 0.05))
    alone = sum(near.get(k) == k for k in range(MODES))
    try:
        result = rg.update(model, rig.measured, free=FREE, prior=SPREAD, shape_noise=SHAPE_NOISE)
    except rg.ConvergenceError as error:
        print(f"rig {seed}: {error}")
        return Outcome(seed, [], 0, alone, 0)
    x = np.log([row.factor for row in result.parameters])
    sigma = np.array([row.sigma for row in result.parameters])
    inside = np.abs(x - rig.x) <= 1.6449 * sigma
    right = sum(line.rig.label == f"true mode {line.mode_number}" for line in result.lines)
    return Outcome(seed, inside.tolist(), right, alone, result.modal_solutions)


def calibration(rigs: int, file: Path | None = None, piece: float = np.inf) -> None:
    """Print how often stated 90 % intervals hold the truth, and how often lines find their modes.

    Args:
        rigs: how many.
        file: JSON lines of the rigs that are done; those in it are not done again.
        piece: CPU s after which the rest is left for another time.
    """
    model = nominal()
    numbers = free_numbers(model, FREE, SPREAD)
    done = [Outcome(**json.loads(row)) for row in file.read_text().splitlines()] if file and file.exists() else []
    known = {one.seed for one in done}
    start = time.process_time()
    for seed in range(rigs):
        if seed in known:
            continue
        if time.process_time() - start > piece:
            break
        done.append(outcome(model, seed))
        if file:
            with file.open("a") as kept:
                kept.write(json.dumps(asdict(done[-1])) + "\n")
    ended = [one for one in done if one.inside]
    inside = np.array([one.inside for one in ended])
    fresh = len(done) - len(known)
    print(f"{len(done)} rigs, {len(done) - len(ended)} without an estimate", end="")
    print(f", {(time.process_time() - start) / fresh:.1f} CPU s each" if fresh else "")
    print(f"90 % intervals hold the truth in {100 * inside.mean():.1f} % over all; by number:")
    for address, share in zip(numbers.addresses, 100 * inside.mean(axis=0), strict=True):
        print(f"  {address:36} {share:5.1f} %")
    right = 100 * np.mean([one.right for one in ended]) / MODES
    alone = 100 * np.mean([one.alone for one in done]) / MODES
    print(f"lines with the right mode: {right:.1f} % with shapes, {alone:.1f} % by frequency alone")
    solutions = [one.solutions for one in ended]
    print(f"modal solutions an update: {np.mean(solutions):.1f}, at most {max(solutions)}")


def pairing(rigs: int) -> None:
    """Print how often `compare --shapes` finds the modes of lines, on rigs that nothing was chosen by.

    Which mode of the file a true one is, is found by following all modes from the file's stiffnesses to the true ones in sixteen
    steps, by overlap in mass. Beside that stands the mode of the same number, which is another one where modes cross.
    """
    model = nominal()
    true_model = RigModel(free_numbers(model, FREE, SPREAD), PLAN, 3000.0, tuple(SENSORS))
    file_modes = true_model.modes(np.zeros(len(true_model.numbers.addresses)))
    right, same_number, alone = [], [], []
    for seed in range(FIRST_JUDGED, FIRST_JUDGED + rigs):
        rig = draw(model, seed)
        of_file = {int(true): k for k, true in enumerate(_followed(true_model, file_modes, rig.x)) if true >= 0}
        result = rg.compare_shapes(model, rig.measured, elements=1, samples=1)
        found = {int(match.rig.label.split()[-1]) - 1: match.mode_number - 1 for match in result.matches}
        right += [found.get(k) == of_file.get(k, -1) for k in range(MODES)]
        same_number += [found.get(k) == k for k in range(MODES)]
        by_frequency = rg.compare(model, rig.measured.lines, elements=1, samples=1)
        near = {int(match.rig.label.split()[-1]) - 1: match.mode_number - 1 for match in by_frequency.matches}
        alone += [near.get(k) == of_file.get(k, -1) for k in range(MODES)]
    print(f"{rigs} rigs, seeds from {FIRST_JUDGED}: lines with the right mode {100 * np.mean(right):.1f} % with shapes")
    print(
        f"{100 * np.mean(alone):.1f} % by frequency alone; with the mode of the same number {100 * np.mean(same_number):.1f} %"
    )


def _followed(model: RigModel, modes: RigModes, x: np.ndarray) -> np.ndarray:
    """Numbers at x of the modes (m,); -1 of one that left the range."""
    numbers = np.arange(len(modes.eigenvalues))
    for share in np.linspace(0.0, 1.0, 17)[1:]:
        there = model.modes(share * x)
        rows, columns = linear_sum_assignment(-modes.overlap(there))
        now = dict(zip(rows.tolist(), columns.tolist(), strict=True))
        numbers = np.array([now.get(int(k), -1) for k in numbers])
        modes = there
    return numbers


if __name__ == "__main__":
    words = sys.argv[1:]
    count = int(words[0]) if words else 200
    if words[1:] == ["pairs"]:
        pairing(count)
    else:
        calibration(count, Path(words[1]) if len(words) > 1 else None, float(words[2]) if len(words) > 2 else np.inf)
