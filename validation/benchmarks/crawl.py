"""Responses and transients at a crawl against the quasi-static state of the loaded teeth: harmonics 1 to 5 and peak to peak.

    python -m validation.benchmarks.crawl                     # spur pair, responses
    python -m validation.benchmarks.crawl --transient --torque 0.5 1 2
    python -m validation.benchmarks.crawl --only herringbone loop --transient

The force of a lone mesh is given by the torque, so that its transmission error at a crawl is that of the loaded contact at
this force ("contact"): solved here at 1024 positions of a base pitch, without any map. Where helices and branches share the
load, the reference is the joint state of all contacts ("joint"), with maps of `--positions` in a base pitch; the approach is
compared there, for a joint state knows its contacts. Errors of harmonics of the mesh are relative to themselves, or to half the
largest one where that is more: 1 % of that is the measure. Peak to peak is that of the sum of all orders of the response, and of
all steps of the transient. "mean" is the largest difference of a mean force from that of `static`.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np

import rotorgear as rg
from rotorgear.analysis.static.mean_state import mean_state
from rotorgear.gears.loaded.contact_map import ContactMap
from rotorgear.gears.loaded.mesh_cycle import mesh_cycle
from rotorgear.gears.loaded.solved_map import contact_map
from rotorgear.gears.loaded.tooth_contact import contact_problem
from rotorgear.model.layout.mesh_layout import MeshLayout
from rotorgear.system.system import System

POSITIONS = 1024
TORQUE = 2000.0
HARMONICS = 5
# Steps and records of a transient in a mesh period, which takes so many seconds: some 1/500 of the lowest elastic mode.
STEPS = 512
PERIOD = 0.5
ODD = 1  # the tooth with the pitch error
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


def loop(torque: float) -> rg.Model:
    """The split-torque gearbox with loaded teeth in its first stage; the torque is a share of its own."""
    given = rg.load(MODELS / "split_torque.toml")
    assert given.operation is not None
    teeth = {
        name: mesh.model_copy(update={"stiffness": "tooth_fe", "transmission_error": ()})
        if name.startswith("stage_1")
        else mesh.model_copy(update={"transmission_error": (), "stiffness_variation": ()})
        for name, mesh in given.meshes.items()
    }
    pinion = given.layout.mesh("stage_1a").pinion.part.teeth or 1
    power = given.operation.power
    changed = {"speed": 2.0 * np.pi / (pinion * PERIOD), "power": None}
    full = power / given.operation.speed if power else given.operation.torque
    changed["torque"] = torque / TORQUE * full
    return given.model_copy(
        update={
            "meshes": teeth,
            "operation": given.operation.model_copy(update=changed),
            "damping": given.damping.model_copy(update={"modal_ratio": 0.05}),
        }
    )


CASES: dict[str, Callable[[float], rg.Model]] = {
    "bare": lambda torque: pair(torque),
    "relieved": lambda torque: pair(
        torque, tip_relief={"pinion": "30 um", "wheel": None}, tip_relief_diameter={"pinion": "177.5 mm", "wheel": None}
    ),
    "crowned": lambda torque: pair(torque, flank={"pinion": {"crowning": "10 um"}, "wheel": None}),
    "pitch": lambda torque: pair(torque, flank={"pinion": {"pitch_errors": {str(ODD): "20 um"}}, "wheel": None}),
    "misaligned": lambda torque: pair(torque, mesh={"misalignment": "20 um"}),
    "helical": lambda torque: pair(torque, "helical"),
    "herringbone": lambda torque: pair(torque, "herringbone"),
    "loop": loop,
}


@dataclass(frozen=True)
class Curves:
    """What a contact does over its cycle of whole base pitches.

    Attributes:
        periods: base pitches in the cycle. values: (p, c) in m, transverse, evenly spaced over it.
        force: (c,) mean forces along the flank normal in N.
        lone: whether they are transmission errors of a lone mesh, and not approaches.
    """

    periods: int
    values: np.ndarray
    force: np.ndarray
    lone: bool

    @property
    def harmonics(self) -> np.ndarray:
        """Amplitudes (5, c) of the orders of the mesh."""
        return mesh_orders(self.values, self.periods)

    @property
    def peak_to_peak(self) -> np.ndarray:
        """(c,) in m."""
        return np.asarray(np.ptp(self.values, axis=0))


def mesh_orders(values: np.ndarray, periods: int) -> np.ndarray:
    """Amplitudes (5, c) of the mesh in values (p, c) over a cycle of so many periods."""
    spectrum = 2.0 * np.abs(np.fft.rfft(values, axis=0)) / len(values)
    return np.asarray(spectrum[periods : (HARMONICS + 1) * periods : periods])


def reference(model: rg.Model, positions: int) -> Curves:
    """The loaded contact at the force of a lone mesh; of several contacts their joint state."""
    force = rg.static(model).mesh_force
    states = model.mean_load(1).forces
    if len(states) == 1:
        return Curves(*contact(model), np.asarray(force), lone=True)

    def fine(mesh: MeshLayout, helix: int, force: float, sense: int = 1, near: bool = False) -> ContactMap | None:
        if mesh.part.stiffness != "tooth_fe" or not force:
            return None
        return contact_map(mesh.helix_teeth(helix, sense), float(f"{force:.12g}"), positions, near)

    assert model.operation is not None
    with patch.object(MeshLayout, "contact_map", fine):
        setup = mean_state(
            System(model, load=model.mean_load(1).of_kind("static")), float(model.operation.speed or 0.0)
        )
    assert setup.joint is not None
    cosine = np.cos([state.contact.base_helix_angle for state in setup.lines.states])
    (cycle,) = setup.joint.cycles
    return Curves(cycle.periods, cycle.approach / cosine, np.asarray(force), lone=False)


def contact(model: rg.Model) -> tuple[int, np.ndarray]:
    """Periods of the cycle, and transmission error (p, 1) of the loaded contact of a lone mesh without any map."""
    (state,) = model.mean_load(1).forces
    mesh = model.layout.mesh(state.contact.mesh)
    load = state.normal_force * np.cos(state.contact.base_helix_angle)
    problem = contact_problem(mesh.helix_teeth(0, state.torque_sense))

    def period(number: int) -> np.ndarray:
        return np.asarray(mesh_cycle(problem, load, number + np.arange(POSITIONS) / POSITIONS).deflection)

    if not any(flank.single_teeth for flank in problem.flanks):
        return 1, period(0)[:, None]
    # Some pitches before and behind the odd tooth are their own; all others are alike.
    periods = problem.teeth[0]
    own = {number % periods: period(number % periods) for number in range(ODD - 3, ODD + 4)}
    alike = period(periods // 2)
    return periods, np.concatenate([own.get(number, alike) for number in range(periods)])[:, None]


def of_response(model: rg.Model, truth: Curves) -> Curves:
    """The sum of all orders of a response at a crawl."""
    assert model.operation is not None
    found = rg.response(model, speeds=[float(model.operation.speed or 0.0)], elements=1, method="direct")
    table = (found.transmission_error if truth.lone else found.approach)[:, 0]
    first = model.layout.mesh(found.contact_mesh[0]).pinion
    number = found.ratio / (abs(model.layout.train.ratio(first.shaft)) * (first.part.teeth or 0)) * truth.periods
    angle = 2.0 * np.pi * np.arange(8 * POSITIONS * truth.periods) / (8 * POSITIONS * truth.periods)
    whole = np.zeros((len(angle), table.shape[1]))
    for n, row in zip(np.round(number), table, strict=True):
        whole += (np.exp(1j * n * angle)[:, None] * row).real
    return Curves(truth.periods, whole, found.mean_force, truth.lone)


@dataclass(frozen=True)
class Measured:
    """Errors of one analysis: of harmonics (5, c), of peak to peak (c,), of the mean forces, and what it took in s."""

    harmonics: np.ndarray
    peak_to_peak: np.ndarray
    force: float
    seconds: float


def compared(harmonics: np.ndarray, width: np.ndarray, force: np.ndarray, truth: Curves, seconds: float) -> Measured:
    """Relative errors against the reference."""
    exact = truth.harmonics
    scale = np.maximum(exact, 0.5 * exact.max(axis=0))
    moving = truth.peak_to_peak > 1e-3 * truth.peak_to_peak.max()
    return Measured(
        ((harmonics - exact) / scale)[:, moving],
        (width / truth.peak_to_peak - 1.0)[moving],
        float(np.abs(force - truth.force).max() / truth.force.max()),
        seconds,
    )


def measured(model: rg.Model, truth: Curves, analysis: str) -> Measured:
    """Errors of a response or of a transient at a crawl."""
    begun = time.perf_counter()
    if analysis == "response":
        found = of_response(model, truth)
        return compared(found.harmonics, found.peak_to_peak, found.force, truth, time.perf_counter() - begun)
    cycle = truth.periods * PERIOD
    run = rg.transient(
        model,
        time=cycle,
        discard=max(cycle, 4.0 * PERIOD) if truth.periods == 1 else cycle,
        steps=STEPS,
        records=STEPS,
        elements=1,
        method="exponential",
        error_estimate=False,
    )
    values = (run.transmission_error if truth.lone else run.approach)[run.counted][-STEPS * truth.periods :]
    width = np.ptp(run.transmission_error_range if truth.lone else run.approach_range, axis=1)
    force = run.mesh_force[run.counted].mean(axis=0)
    return compared(mesh_orders(values, truth.periods), width, force, truth, time.perf_counter() - begun)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description="Responses and transients at a crawl against loaded teeth.")
    parser.add_argument(
        "--only", nargs="+", choices=list(CASES), default=["bare", "relieved", "crowned", "pitch", "misaligned"]
    )
    parser.add_argument(
        "--torque", nargs="+", type=float, default=[1.0], help="shares of 2000 N m, or of the loop's own torque"
    )
    parser.add_argument("--transient", action="store_true", help="transients too")
    parser.add_argument(
        "--positions", type=int, default=POSITIONS, help="in a base pitch, of the maps of a joint state"
    )
    asked = parser.parse_args()
    print("flanks       torque  reference  h1 um   pp um  analysis   h1 to h5       pp     mean      s", flush=True)
    for name in asked.only:
        for share in asked.torque:
            model = CASES[name](share * TORQUE)
            truth = reference(model, asked.positions)
            kind = "contact" if truth.lone else "joint"
            first = f"{1e6 * truth.harmonics[0].max():5.3f}  {1e6 * truth.peak_to_peak.max():6.3f}"
            for analysis in ("response", *(["transient"] if asked.transient else [])):
                off = measured(model, truth, analysis)
                print(
                    f"{name:12s} {share:6g}  {kind:9s}  {first}  {analysis:9s} {100.0 * np.abs(off.harmonics).max():7.2f} % "
                    f"{100.0 * off.peak_to_peak[np.argmax(np.abs(off.peak_to_peak))]:+7.2f} % {100.0 * off.force:6.3f} % "
                    f"{off.seconds:6.1f}",
                    flush=True,
                )


if __name__ == "__main__":
    main()
