"""What the stated error estimates are worth: estimate over true error of all models and all analyses.

python -m validation.benchmarks.estimates models      natural frequencies, a line a model
python -m validation.benchmarks.estimates analyses    a line an analysis, and the ratios outside of bounds
python -m validation.benchmarks.estimates analyses sweep orbits    the same of some analyses
python -m validation.benchmarks.estimates quantiles   stated errors of the quantiles of a scatter beside those of many samples
"""

from __future__ import annotations

import math
import sys
import tempfile
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import rotorgear as rg
from rotorgear.analysis.accuracy import study_by_name
from rotorgear.analysis.modal.refine import DEFAULT_ACCURACY
from rotorgear.analysis.studies.meshes import REFERENCE
from tests.free_trains import chain, train
from tests.overhung import overhung_disk
from tests.unit.analysis.impact_oscillator import ImpactOscillator
from tests.unit.casings.blocks import block_model

ROOT = Path(__file__).resolve().parents[2]
# What the tables are made from, for docs/machinery/made.py.
INPUTS = ("models/*.toml", "validation/cases/*/*.toml")
MODES = 24
LOW = 0.5
HIGH = 3.0
# Ten times the accuracy of the reference: below, the ratio of estimate and error is that of the reference.
RESOLVED = 1e-9
# The site shows all models, the table these.
SHOWN = (
    "geared_pair",
    "helicopter",
    "jeffcott",
    "overhung_pinion",
    "planetary",
    "split_torque",
    "split_torque_casing",
    "split_torque_journals",
    "three_disk_rotor/model",
    "timoshenko_beam/pinned_pinned_d200",
    "two_disk_rotor/example_5_9_1",
    "wind_turbine",
)

MESHES: dict[str, Any] = {"elements": (1, 2, 4, 8), "accuracies": (1e-2, 1e-4, 1e-6), "repeat": 1}
STEPS: dict[str, Any] = {"steps": (40, 80, 160), "accuracies": (1e-2,), "repeat": 1}
POINT: dict[str, Any] = {"steps": (50, 100, 200), "counts": (50,), "starts": 8}
MOTION: dict[str, Any] = {"harmonics": (10, 20, 40), "densities": (8, 16), "repeat": 1}
FEW: dict[str, Any] = {"modes": 12, **MESHES}
DAMPED: dict[str, Any] = {"modal_damping": 0.01, **MESHES}
PARTING = ImpactOscillator(W=0.7, ripple=1.4, z=0.05)
LIGHT = ImpactOscillator(W=1.6, ripple=0.3, z=0.003)


def _block() -> rg.Model:
    """A block as a casing, from a mesh of a few bricks."""
    return block_model(Path(tempfile.mkdtemp()), counts=(2, 1, 3))


# Models that are not among the shipped ones: unequal inertias, an idler, light damping, flanks that part, balls, a casing.
OWN: dict[str, Callable[[], rg.Model]] = {
    "overhung disk": overhung_disk,
    "unequal chain": lambda: chain([2e-3, 3e-2, 8e-3]),
    "idler": lambda: train(stiffness_variation=[{"harmonic": 1, "amplitude": 0.15}]),
    "parting pair": PARTING.model,
    "lightly damped pair": LIGHT.model,
    "balls": lambda: rg.load(ROOT / "models" / "jeffcott.toml").with_(
        {"bearings.left.rolling": {"designation": "6204"}, "operation.gravity": [0.0, -9.81, 0.0]}
    ),
    "block": _block,
}
# Model, analysis, and what it is asked for besides the series: some minutes in all.
CASES: tuple[tuple[str, str, dict[str, Any]], ...] = (
    ("jeffcott", "modal", FEW),
    ("jeffcott", "modal", {"speed": "1500 rpm", **FEW}),
    ("jeffcott", "campbell", {**MESHES, "modes": 6}),
    ("jeffcott", "critical", {"stop": "20000 rpm", **MESHES}),
    ("jeffcott", "frf", DAMPED),
    ("flexible_pair", "modal", MESHES),
    ("flexible_pair", "modal", {"speed": "3000 rpm", **MESHES}),
    ("flexible_pair", "campbell", {**MESHES, "modes": 6}),
    ("flexible_pair", "static", MESHES),
    ("flexible_pair", "response", MESHES),
    ("flexible_pair", "frf", MESHES),
    ("flexible_pair", "transient", STEPS),
    ("helical_pair", "modal", {"speed": "3000 rpm", **FEW}),
    ("helical_pair", "static", MESHES),
    ("helical_pair", "frf", MESHES),
    ("geared_pair", "modal", FEW),
    ("geared_pair", "modal", {"speed": "1500 rpm", **FEW}),
    ("geared_pair", "frf", DAMPED),
    ("backlash_pair", "transient", STEPS),
    ("overhung_pinion", "modal", {"speed": "3000 rpm", **FEW}),
    ("overhung_pinion", "frf", DAMPED),
    ("relieved_pair", "modal", {"speed": "3000 rpm", **FEW}),
    ("relieved_pair", "frf", DAMPED),
    ("split_torque", "modal", FEW),
    ("split_torque", "modal", {"speed": "3000 rpm", **FEW}),
    ("split_torque", "critical", MESHES),
    ("split_torque", "static", MESHES),
    ("web_wheel", "modal", {"speed": "1000 rpm", **FEW}),
    ("overhung disk", "modal", {"speed": 700.0, **FEW}),
    ("overhung disk", "campbell", {**MESHES, "modes": 5}),
    ("overhung disk", "critical", MESHES),
    ("overhung disk", "response", DAMPED),
    ("overhung disk", "state-space", {"speed": 700.0, **MESHES}),
    ("jeffcott", "state-space", DAMPED),
    ("flexible_pair", "state-space", MESHES),
    ("unequal chain", "transient", STEPS),
    ("idler", "transient", STEPS),
    ("parting pair", "transient", STEPS),
    ("lightly damped pair", "transient", STEPS),
    ("parting pair", "sweep", {"speed": PARTING.speed(PARTING.W), **POINT}),
    ("lightly damped pair", "sweep", {"speed": LIGHT.speed(LIGHT.W), **POINT}),
    ("unequal chain", "sweep", {"speed": 450.0, **POINT}),
    ("backlash_pair", "sweep", {"speed": "4000 rpm", **POINT}),
    ("backlash_pair", "orbits", {"speed": "4000 rpm", **MOTION}),
    ("parting pair", "orbits", {"speed": PARTING.speed(PARTING.W), **MOTION}),
    ("idler", "orbits", {"speed": 110.0, **MOTION}),
    ("relieved_pair", "mesh", {}),
    ("split_torque_journals", "bearing", {"bearing": "input_left", "repeat": 1}),
    ("split_torque_journals", "bearing", {"bearing": "branch_a_left", "repeat": 1}),
    ("balls", "bearing", {"speed": "1500 rpm", "repeat": 1}),
    ("block", "casing", {"modes": 6, "finest": 20_000, "fixed": (5, 10), "repeat": 1}),
)


class Study(NamedTuple):
    """A study of a model: its name, the command's options, and what came out."""

    name: str
    analysis: str
    at: str
    result: rg.ConvergenceStudy | rg.MeshConvergenceStudy | rg.SweepConvergenceStudy
    effectivity: tuple[float, float]


@cache
def of_models() -> list[Study]:
    """Studies of the frequencies of all models with shafts that bend or twist; those of points have nothing to discretise."""
    return [
        study_of(name)
        for name, file in files().items()
        if any(shaft.sections for shaft in rg.load(file).shafts.values())
    ]


def study_of(name: str) -> Study:
    """The study of the frequencies of a model, with the range of estimate over error of all modes and discretisations."""
    model = rg.load(files()[name])
    result = rg.convergence_study(model, modes=MODES, repeat=1)
    truth = rg.modal(model, modes=MODES, accuracy=REFERENCE).natural_frequency_hz
    ranges = []
    for row in result.rungs:
        options = {"elements": int(row.setting)} if row.family == "elements" else {"accuracy": row.setting}
        ranges.append(_effectivity(rg.modal(model, modes=MODES, **options), truth))
    known = [(low, high) for low, high in ranges if math.isfinite(low)]
    whole = (min(low for low, _ in known), max(high for _, high in known)) if known else (math.nan, math.nan)
    return Study(name, "modal", "", result, whole)


@cache
def of_analyses(*names: str) -> list[Study]:
    """Studies of some analyses by their names; of all without."""
    found = []
    for name, analysis, options in [case for case in CASES if not names or case[1] in names]:
        model = OWN[name]() if name in OWN else rg.load(ROOT / "models" / f"{name}.toml")
        result = study_by_name(analysis)(model, **options)
        speed = options.get("speed", options.get("bearing", ""))
        at = f" at {speed if isinstance(speed, str) else f'{speed:.4g} rad/s'}" if speed else ""
        found.append(Study(name, analysis, at, result, (math.nan, math.nan)))
    return found


def files() -> dict[str, Path]:
    """The models of the repository and of its cases, by name."""
    found = {file.stem: file for file in sorted((ROOT / "models").glob("*.toml"))}
    cases = sorted((ROOT / "validation" / "cases").glob("*/*.toml"))
    return found | {f"{file.parent.name}/{file.stem}": file for file in cases}


def _effectivity(result: rg.ModalResult, truth: np.ndarray) -> tuple[float, float]:
    """Smallest and largest ratio of estimate and true error over the modes where both mean something."""
    count = min(len(result), len(truth))
    exact = truth[:count]
    error = np.abs(result.natural_frequency_hz[:count] / np.where(exact > 0.0, exact, 1.0) - 1.0)
    told = ~result.rigid[:count] & (error > RESOLVED) & np.isfinite(result.error_estimate[:count])
    if not told.any():
        return math.nan, math.nan
    ratio = result.error_estimate[:count][told] / error[told]
    return float(ratio.min()), float(ratio.max())


def row_of(study: Study) -> list[str]:
    """A model's line: dofs, CPU time, error and estimate at the default accuracy, and the range of their ratios."""
    usual = next(row for row in study.result.rungs if row.family == "accuracy" and row.setting == DEFAULT_ACCURACY)
    return [
        study.name,
        str(usual.dofs),
        f"{usual.seconds:.3f} s",
        f"{usual.error:.1e}",
        f"{usual.estimate:.1e}",
        span(study.effectivity),
    ]


def span(ratios: tuple[float, float]) -> str:
    """A range in words; "" of none."""
    return f"{ratios[0]:.2f} to {ratios[1]:.2f}" if math.isfinite(ratios[0]) else ""


def models() -> Iterator[str]:
    """The lines of some models, and the range over all."""
    yield f"{'model':34}  dofs  CPU time    error  estimate  effectivity"
    for study in of_models():
        if study.name in SHOWN:
            name, dofs, seconds, error, estimate, ratios = row_of(study)
            yield f"{name:34}  {dofs:>4}  {seconds:>8}  {error:>7}  {estimate:>8}  {ratios}".rstrip()
    spans = [study.effectivity for study in of_models() if math.isfinite(study.effectivity[0])]
    all_of_them = (min(low for low, _ in spans), max(high for _, high in spans))
    yield f"over all {len(spans)} models of the repository and its validation cases: {span(all_of_them)}"


class Judged(NamedTuple):
    """A row of a study: what ran, its true and its stated error and their ratio, seconds, and below what nothing is told."""

    method: str
    error: float
    estimate: float
    ratio: float | None
    seconds: float
    resolution: float = 0.0


def judged(result: rg.ConvergenceStudy | rg.MeshConvergenceStudy | rg.SweepConvergenceStudy) -> Iterator[Judged]:
    """The rows of a study of any kind that state an error."""
    if isinstance(result, rg.ConvergenceStudy):
        for row in result.rungs:
            if row.dofs:
                yield Judged(row.method, row.error, row.estimate, row.effectivity, row.seconds, result.resolution)
    elif isinstance(result, rg.SweepConvergenceStudy):
        for point in result.rungs:
            method = f"{point.steps} steps, {point.count} periods"
            yield Judged(method, point.error, point.estimate, point.effectivity, point.seconds)
    else:
        for mesh in result.rungs:
            for name in ("mean_stiffness", "peak_to_peak_stiffness", "ste_peak_to_peak"):
                if mesh.estimate is not None:
                    error, estimate = (getattr(one, name) for one in (mesh.error, mesh.estimate))
                    seconds = mesh.fe_seconds + mesh.contact_seconds
                    method = f"{mesh.method}, {name.replace('_', ' ')}"
                    yield Judged(method, error, estimate, estimate / error if error else None, seconds)


def analyses(*names: str) -> Iterator[str]:
    """The lines of some analyses by their names, of all without, and what is outside."""
    yield "analysis     studies  ratios  smallest  largest  within  both below    error  CPU time  of"
    outside: list[str] = []
    total = inside = 0
    for analysis in dict.fromkeys(study.analysis for study in of_analyses(*names)):
        mine = [study for study in of_analyses(*names) if study.analysis == analysis]
        ratios: list[float] = []
        below: list[bool] = []
        for study in mine:
            rows = list(judged(study.result))
            known = [(row.method, row.ratio) for row in rows if row.ratio is not None and math.isfinite(row.ratio)]
            ratios += [ratio for _, ratio in known]
            small = [row for row in rows if row.error <= row.resolution]
            below += [row.estimate <= HIGH * row.resolution for row in small]
            missed = [f"{method} ({ratio:.2f})" for method, ratio in known if not LOW <= ratio <= HIGH]
            if missed:
                outside += [f"outside: {study.name}, {analysis}{study.at}", *(f"  {one}" for one in missed)]
        within = sum(LOW <= ratio <= HIGH for ratio in ratios)
        total, inside = total + len(ratios), inside + within
        ends = [f"{min(ratios):.2f}", f"{max(ratios):.2f}"] if ratios else ["", ""]
        both = f"{sum(below)} of {len(below)}" if below else ""
        finest = list(judged(mine[0].result))[-1]
        yield (
            f"{analysis:11}  {len(mine):7}  {len(ratios):6}  {ends[0]:>8}  {ends[1]:>7}  {within:6}  {both:>10}  "
            f"{finest.error:7.1e}  {finest.seconds:6.3f} s  {mine[0].name}"
        )
    yield f"within: {inside} of {total} ({100.0 * inside / total:.0f} %)"
    yield from outside


# Of a scatter: samples of a run, runs, and samples that are taken for the truth.
SAMPLES = 256
SEEDS = 6
MANY = 8192


def quantiles() -> Iterator[str]:
    """Both quantiles of all frequencies of some models, sampled several times."""
    yield "model             sampling  quantiles  stated over true  within two stated errors"
    for name in ("geared_pair", "jeffcott"):
        model = rg.load(ROOT / "models" / f"{name}.toml")
        free = "bearings.*.stiffness" + (", meshes.*.stiffness" if model.meshes else "")
        truth = rg.scatter(model, free, modes=6, samples=MANY, seed=99).bands
        for sampling in ("sobol", "random"):
            off, stated = [], []
            for seed in range(1, SEEDS + 1):
                found = rg.scatter(model, free, modes=6, samples=SAMPLES, seed=seed, sampling=sampling).bands
                for row, exact in zip(found, truth, strict=True):
                    off += [row.low_hz / exact.low_hz - 1.0, row.high_hz / exact.high_hz - 1.0]
                    stated += [row.low_error_hz / exact.low_hz, row.high_error_hz / exact.high_hz]
            ratio = np.sqrt(np.mean(np.square(stated)) / np.mean(np.square(off)))
            near = np.mean(np.abs(off) <= 2.0 * np.array(stated))
            yield f"{name:16}  {sampling:8}  {len(off):9}  {ratio:16.2f}  {100.0 * near:20.0f} %"


if __name__ == "__main__":
    for line in {"models": models, "analyses": analyses, "quantiles": quantiles}[sys.argv[1]](*sys.argv[2:]):
        print(line, flush=True)
