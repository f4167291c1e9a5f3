"""Responses and transients at a crawl against the quasi-static state of the loaded teeth: harmonics 1 to 5 and peak to peak.

    python -m validation.benchmarks.crawl                     # spur pair with all flanks, responses and transients
    python -m validation.benchmarks.crawl --form helical herringbone loop --torque 0.5 1 2
    python -m validation.benchmarks.crawl --form overhung --flank bare misaligned

The force of a lone mesh is given by the torque, so that its transmission error at a crawl is that of the loaded contact at
this force ("contact"). Where its shafts tilt its flanks ("overhung"), the contact is solved at five misalignments, and at each
position tilt and moment agree ("coupled"). Where helices and branches share the load, the reference is the joint state of all
contacts ("joint"). No map takes part in any of them (`crawl_reference.py`). The approach is compared in a joint state, for it
knows its contacts, and of those the ones of loaded teeth. Errors of harmonics, of the mesh and with a pitch error of the shaft of
the odd tooth too, are relative to themselves, or to half the largest one of their kind where that is more: 1 % of that is the
measure. Peak to peak is that of the sum of all orders of the response, and of all steps of the transient. "mean" is the largest
difference of a mean force from that of `static`.
"""

from __future__ import annotations

import argparse
import itertools
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import rotorgear as rg
from validation.benchmarks.crawl_reference import ODD, Curves, lines_of, reference

TORQUE = 2000.0
# Of a base pitch, at which a response is drawn for its peak to peak.
POINTS = 8192
# A mesh period of a transient takes so many seconds: some 1/500 of the lowest elastic mode. It has so many records, and steps
# unless asked for more: kinks of the approach within a step leave 0.05 to 0.15 nm with these.
PERIOD = 0.5
STEPS = 512
# The force of a step is its mean, and shafts at rest under it stand at the step's end: half a step behind the teeth.
# A lone mesh has its force from the torque; where contacts share it, that turns what they pass on to each other, to first order.
JOINT_STEPS = 2048
ANALYSES = ("response", "transient")
MODELS = Path(__file__).parents[2] / "models"


def pair(torque: float, kind: str = "spur", mesh: dict[str, Any] | None = None, **flank: Any) -> rg.Model:
    """The pair 34/80 of docs/mesh.md; `flank` goes to both gears, by the gear's name where it is a table of both."""
    herringbone = {"gap": "20 mm", "helix_angle": "20 deg", "width": "40 mm"}
    form = {"spur": {}, "helical": {"helix_angle": "12 deg"}, "herringbone": herringbone}[kind]
    angle = np.radians(float(str(form.get("helix_angle", "0 deg")).split()[0]))
    gears = {}
    for name, shaft, teeth, hand in (("pinion", "input", 34, "right"), ("wheel", "output", 80, "left")):
        own = {key: value[name] if isinstance(value, dict) and name in value else value for key, value in flank.items()}
        own = {key: value for key, value in own.items() if value is not None}
        gears[name] = {
            "shaft": shaft,
            "at": "100 mm",
            "kind": kind,
            "teeth": teeth,
            "normal_module": "5 mm",
            "width": "54 mm",
            **form,
            **({"hand": hand} if angle else {}),
            **own,
        }
    ends = [(shaft, end) for shaft in ("input", "output") for end in ("start", "end")]
    centre = 0.285 / np.cos(angle)
    stagger = {"stagger": 0.5} if kind == "herringbone" else {}
    return rg.Model(
        operation={
            "input_shaft": "input",
            "output_shaft": "output",
            "torque": torque,
            "speed": 2.0 * np.pi / (34.0 * PERIOD),
        },
        shafts={
            "input": {"position": [0.0, 0.0], "sections": [{"length": "200 mm", "outer_diameter": "80 mm"}]},
            "output": {"position": [centre, 0.0], "sections": [{"length": "200 mm", "outer_diameter": "120 mm"}]},
        },
        gears=gears,
        meshes={
            "stage": {
                "pinion": "pinion",
                "gear": "wheel",
                "stiffness": "tooth_fe",
                "damping_ratio": 0.05,
                **stagger,
                **(mesh or {}),
            }
        },
        bearings={
            f"{shaft}_{end}": {"shaft": shaft, "at": end, "stiffness": {"radial": "5e8 N/m", "axial": "1e8 N/m"}}
            for shaft, end in ends
        },
        damping={"modal_ratio": 0.05},
    )


def loop(torque: float, **changes: Any) -> rg.Model:
    """The split-torque gearbox with loaded teeth in its first stage; the torque is a share of its own."""
    given = rg.load(MODELS / "split_torque.toml").with_(changes)
    assert given.operation is not None
    teeth = {
        name: mesh.model_copy(update={"stiffness": "tooth_fe", "transmission_error": ()})
        if name.startswith("stage_1")
        else mesh.model_copy(update={"transmission_error": (), "stiffness_variation": ()})
        for name, mesh in given.meshes.items()
    }
    return at_a_crawl(given.model_copy(update={"meshes": teeth}), "stage_1a", torque)


def overhung(torque: float, **changes: Any) -> rg.Model:
    """The pinion beside its bearings, whose teeth feel how its shaft bends."""
    return at_a_crawl(rg.load(MODELS / "overhung_pinion.toml").with_(changes), "stage", torque)


def at_a_crawl(model: rg.Model, mesh: str, torque: float) -> rg.Model:
    """At the speed where this mesh takes its period, damped, with a share of 2000 N m of its own torque."""
    operation = model.operation
    assert operation is not None
    full = operation.power / operation.speed if operation.power and operation.speed else operation.torque
    pinion = model.layout.mesh(mesh).pinion
    speed = 2.0 * np.pi / ((pinion.part.teeth or 1) * abs(model.layout.train.ratio(pinion.shaft)) * PERIOD)
    changed = {"speed": speed, "power": None, "torque": torque / TORQUE * (full or 0.0)}
    return model.model_copy(
        update={
            "operation": operation.model_copy(update=changed),
            "damping": model.damping.model_copy(update={"modal_ratio": 0.05}),
        }
    )


FORMS = ("spur", "helical", "herringbone", "loop", "overhung")
FLANKS = ("bare", "relieved", "crowned", "pitch", "misaligned")


def case(form: str, flank: str, torque: float) -> rg.Model:
    """A gearbox whose pinion has such flanks."""
    if form in ("loop", "overhung"):
        gear, mesh = ("pinion_1", "stage_1a") if form == "loop" else ("pinion", "stage")
        given = rg.load(MODELS / ("split_torque.toml" if form == "loop" else "overhung_pinion.toml"))
        tip = given.layout.gear(gear).geometry
        assert tip is not None
        start = tip.effective_tip_diameter - 0.5 * tip.normal_module
        changes = {
            "bare": {},
            "relieved": {f"gears.{gear}.tip_relief": 20e-6, f"gears.{gear}.tip_relief_diameter": start},
            "crowned": {f"gears.{gear}.flank.crowning": 10e-6},
            "pitch": {f"gears.{gear}.flank.pitch_errors": {str(ODD): 10e-6}},
            "misaligned": {f"meshes.{mesh}.misalignment": 20e-6},
        }[flank]
        return loop(torque, **changes) if form == "loop" else overhung(torque, **changes)
    angle = {"spur": 0.0, "helical": 12.0, "herringbone": 20.0}[form]
    start = 1e3 * (0.170 / np.cos(np.radians(angle)) + 0.0075)
    of_flank: dict[str, dict[str, Any]] = {
        "bare": {},
        "relieved": {
            "tip_relief": {"pinion": "30 um", "wheel": None},
            "tip_relief_diameter": {"pinion": f"{start:.9g} mm", "wheel": None},
        },
        "crowned": {"flank": {"pinion": {"crowning": "10 um"}, "wheel": None}},
        "pitch": {"flank": {"pinion": {"pitch_errors": {str(ODD): "20 um"}}, "wheel": None}},
        "misaligned": {"mesh": {"misalignment": "20 um"}},
    }
    return pair(torque, form, **of_flank[flank])


def of_response(model: rg.Model, truth: Curves) -> Curves:
    """The sum of all orders of a response at a crawl."""
    assert model.operation is not None
    found = rg.response(model, speeds=[float(model.operation.speed or 0.0)], elements=1, method="direct")
    table = (found.transmission_error if truth.lone else found.approach)[:, 0]
    first = model.layout.mesh(found.contact_mesh[0]).pinion
    number = found.ratio / (abs(model.layout.train.ratio(first.shaft)) * (first.part.teeth or 0)) * truth.periods
    angle = 2.0 * np.pi * np.arange(POINTS * truth.periods) / (POINTS * truth.periods)
    whole = np.zeros((len(angle), table.shape[1]))
    for n, row in zip(np.round(number), table, strict=True):
        whole += (np.exp(1j * n * angle)[:, None] * row).real
    return Curves(truth.periods, whole, found.mean_force, truth.lone, truth.teeth)


@dataclass(frozen=True)
class Measured:
    """Errors of one analysis: of harmonics (k, 5, c), of peak to peak (c,), of the mean forces, and what it took in s."""

    harmonics: np.ndarray
    peak_to_peak: np.ndarray
    force: float
    seconds: float


def compared(harmonics: np.ndarray, width: np.ndarray, force: np.ndarray, truth: Curves, seconds: float) -> Measured:
    """Relative errors against the reference."""
    exact = truth.harmonics
    scale = np.maximum(exact, 0.5 * exact.max(axis=1, keepdims=True))
    return Measured(
        ((harmonics - exact) / scale)[..., truth.teeth],
        (width / truth.peak_to_peak - 1.0)[truth.teeth],
        float(np.abs(force - truth.force).max() / truth.force.max()),
        seconds,
    )


def measured(model: rg.Model, truth: Curves, analysis: str, steps: int = STEPS) -> Measured:
    """Errors of a response or of a transient at a crawl, with so many steps in a mesh period."""
    begun = time.process_time()
    if analysis == "response":
        found = of_response(model, truth)
        return compared(found.harmonics, found.peak_to_peak, found.force, truth, time.process_time() - begun)
    cycle = truth.periods * PERIOD
    run = rg.transient(
        model,
        time=cycle,
        discard=max(cycle, 4.0 * PERIOD) if truth.periods == 1 else cycle,
        steps=steps,
        records=STEPS,
        elements=1,
        method="exponential",
        error_estimate=False,
    )
    values = (run.transmission_error if truth.lone else run.approach)[run.counted][-STEPS * truth.periods :]
    width = np.ptp(run.transmission_error_range if truth.lone else run.approach_range, axis=1)
    force = run.mesh_force[run.counted].mean(axis=0)
    return compared(lines_of(values, truth.periods), width, force, truth, time.process_time() - begun)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description="Responses and transients at a crawl against loaded teeth.")
    parser.add_argument("--form", nargs="+", choices=FORMS, default=["spur"])
    parser.add_argument("--flank", nargs="+", choices=FLANKS, default=list(FLANKS))
    parser.add_argument(
        "--torque", nargs="+", type=float, default=[1.0], help="shares of 2000 N m, or of the model's own torque"
    )
    parser.add_argument("--analysis", nargs="+", choices=ANALYSES, default=list(ANALYSES))
    parser.add_argument(
        "--positions",
        type=int,
        default=1024,
        help="of the reference in a base pitch; a multiple of 6 spares joint states work, as helices share their places",
    )
    parser.add_argument(
        "--steps",
        type=int,
        help=f"of a transient in a mesh period (default: {STEPS}, and {JOINT_STEPS} where contacts share the load)",
    )
    asked = parser.parse_args()
    print(
        "form        flanks      torque  reference  h1 um   pp um  analysis   h1 to h5       pp     mean      s",
        flush=True,
    )
    for form, flank, share in itertools.product(asked.form, asked.flank, asked.torque):
        model = case(form, flank, share * TORQUE)
        truth = reference(model, asked.positions)
        steps = asked.steps or (STEPS if truth.lone else JOINT_STEPS)
        tilts = any(mesh.tilt for mesh in model.meshes.values())
        kind = "contact" if truth.lone else "coupled" if tilts else "joint"
        first = f"{1e6 * truth.harmonics[0, 0].max():6.3f}  {1e6 * truth.peak_to_peak.max():6.3f}"
        for analysis in asked.analysis:
            off = measured(model, truth, analysis, steps)
            worst = off.peak_to_peak[np.argmax(np.abs(off.peak_to_peak))]
            print(
                f"{form:11s} {flank:10s} {share:7g}  {kind:9s} {first}  {analysis:9s} "
                f"{100.0 * np.abs(off.harmonics).max():7.2f} % {100.0 * worst:+7.2f} % {100.0 * off.force:6.3f} % "
                f"{off.seconds:6.1f}",
                flush=True,
            )


if __name__ == "__main__":
    main()
