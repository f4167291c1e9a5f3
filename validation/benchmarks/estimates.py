"""What the stated error estimates are worth: estimate over true error of all models and all analyses.

python -m validation.benchmarks.estimates models      natural frequencies, a line a model
python -m validation.benchmarks.estimates analyses    a line an analysis, and the ratios outside of bounds with their reasons
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import rotorgear as rg
from rotorgear.analysis.accuracy import STUDIES
from rotorgear.analysis.modal.refine import DEFAULT_ACCURACY
from rotorgear.analysis.studies.meshes import REFERENCE

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
    "jeffcott",
    "overhung_pinion",
    "split_torque",
    "split_torque_casing",
    "split_torque_journals",
    "three_disk_rotor/model",
    "timoshenko_beam/pinned_pinned_d200",
    "two_disk_rotor/example_5_9_1",
)

MESHES: dict[str, Any] = {"elements": (1, 2, 4, 8), "accuracies": (1e-2, 1e-4, 1e-6), "repeat": 1}
STEPS: dict[str, Any] = {"steps": (40, 80, 160), "accuracies": (1e-2,), "repeat": 1}
FEW: dict[str, Any] = {"modes": 12, **MESHES}
DAMPED: dict[str, Any] = {"modal_damping": 0.01, **MESHES}
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
)


class Study(NamedTuple):
    """A study of a model: its name, the command's options, and what came out."""

    name: str
    analysis: str
    at: str
    result: rg.ConvergenceStudy
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
def of_analyses() -> list[Study]:
    """Studies of all analyses."""
    found = []
    for name, analysis, options in CASES:
        result = STUDIES[analysis](rg.load(ROOT / "models" / f"{name}.toml"), **options)
        assert isinstance(result, rg.ConvergenceStudy)
        at = f" at {options['speed']}" if "speed" in options else ""
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


def analyses() -> Iterator[str]:
    """The lines of the analyses, and what is outside."""
    yield "analysis   studies  ratios  smallest  largest  within  both below    error  CPU time  of"
    outside: list[str] = []
    for analysis in dict.fromkeys(study.analysis for study in of_analyses()):
        mine = [study for study in of_analyses() if study.analysis == analysis]
        ratios: list[float] = []
        below: list[bool] = []
        for study in mine:
            known = [(row.method, row.effectivity) for row in study.result.rungs if row.effectivity is not None]
            ratios += [ratio for _, ratio in known]
            small = [row for row in study.result.rungs if row.error <= study.result.resolution and row.dofs]
            below += [row.estimate <= HIGH * study.result.resolution for row in small]
            missed = [f"{method} ({ratio:.2f})" for method, ratio in known if not LOW <= ratio <= HIGH]
            if missed:
                outside += [f"outside: {study.name}, {analysis}{study.at}", *(f"  {one}" for one in missed)]
        within = sum(LOW <= ratio <= HIGH for ratio in ratios)
        ends = [f"{min(ratios):.2f}", f"{max(ratios):.2f}"] if ratios else ["", ""]
        both = f"{sum(below)} of {len(below)}" if below else ""
        finest = mine[0].result.rungs[-1]
        yield (
            f"{analysis:9}  {len(mine):7}  {len(ratios):6}  {ends[0]:>8}  {ends[1]:>7}  {within:6}  {both:>10}  "
            f"{finest.error:7.1e}  {finest.seconds:6.3f} s  {mine[0].name}"
        )
    yield from outside


if __name__ == "__main__":
    for line in {"models": models, "analyses": analyses}[sys.argv[1]]():
        print(line, flush=True)
