"""What `response` says that it leaves out of loaded teeth, beside what a transient with the same map really does.

    python -m validation.benchmarks.left_out_size                     # spur pair, bare and relieved flanks
    python -m validation.benchmarks.left_out_size --form helical loop --flank bare --torque 1 2

At each speed the largest order of the approach is taken: its amplitude by the response, the size printed beside it, and the
actual difference, of complex amplitudes, to a transient that has settled. Speeds at which teeth part are listed without a ratio.
"""

from __future__ import annotations

import argparse
import itertools
from dataclasses import dataclass

import numpy as np

import rotorgear as rg
from validation.benchmarks.crawl import FLANKS, FORMS, TORQUE, case

# Damping ratio of the mesh and of the elastic modes.
DAMPING = 0.03
# Mesh frequencies in Hz.
FREQUENCIES = (400.0, 700.0, 1000.0, 1400.0, 2000.0, 2500.0, 2900.0, 3400.0, 4000.0, 5000.0, 7000.0)
STEPS = 96
SETTLED = 150
KEPT = 16
WORKING = {"loop": "stage_1a"}


@dataclass(frozen=True)
class Size:
    """One speed: order of the mesh and its amplitude in m, what is printed and what is so in m, and whether teeth part."""

    order: int
    amplitude: float
    printed: float | None
    actual: float
    part: bool


def damped(form: str, flank: str, torque: float) -> rg.Model:
    """A gearbox of a crawl with the damping of this comparison."""
    model = case(form, flank, torque)
    mesh = WORKING.get(form, "stage")
    return model.with_({f"meshes.{mesh}.damping_ratio": DAMPING, "damping.modal_ratio": DAMPING})


def size_at(model: rg.Model, mesh: str, frequency: float) -> Size:
    """Compare at one mesh frequency in Hz."""
    pinion = model.layout.mesh(mesh).pinion
    per_turn = abs(model.layout.train.ratio(pinion.shaft)) * (pinion.part.teeth or 1)
    speed = 2.0 * np.pi * frequency / per_turn
    found = rg.response(model, speeds=[speed], elements=1, method="direct")
    (peak,) = [one for one in found.largest if one.quantity == "approach" and one.part == mesh]
    contacts = found.contacts_of(mesh)
    here = contacts[int(np.argmax(np.abs(found.approach[peak.order, 0, contacts])))]
    period = 1.0 / frequency
    run = rg.transient(
        model,
        speed=speed,
        time=KEPT * period,
        discard=SETTLED * period,
        steps=STEPS,
        records=STEPS,
        elements=1,
        method="exponential",
        error_estimate=False,
    )
    last = slice(-KEPT * STEPS, None)
    wave = np.exp(-1j * found.ratio[peak.order] * speed * run.time[last])
    amplitude = 2.0 * np.mean(run.approach[last, here] * wave)
    return Size(
        order=round(found.ratio[peak.order] / per_turn),
        amplitude=peak.amplitude,
        printed=peak.left_out,
        actual=float(abs(amplitude - found.approach[peak.order, 0, here])),
        part=bool(peak.teeth_part) or bool(np.any(run.mesh_force[last, here] <= 0.0)),
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description="What response leaves out: printed and actual.")
    parser.add_argument("--form", nargs="+", choices=FORMS, default=["spur"])
    parser.add_argument("--flank", nargs="+", choices=FLANKS, default=["bare", "relieved"])
    parser.add_argument(
        "--torque", nargs="+", type=float, default=[1.0], help="shares of 2000 N m, or of the model's own"
    )
    parser.add_argument("--hz", nargs="+", type=float, default=list(FREQUENCIES), help="mesh frequencies")
    asked = parser.parse_args()
    print(
        "form        flanks      torque  mesh Hz  order  amplitude um  printed um  actual um  actual/printed",
        flush=True,
    )
    ratios = []
    for form, flank, share in itertools.product(asked.form, asked.flank, asked.torque):
        model = damped(form, flank, share * TORQUE)
        for frequency in asked.hz:
            size = size_at(model, WORKING.get(form, "stage"), frequency)
            if size.part or size.printed is None:
                told = "teeth part"
            else:
                ratios.append(size.actual / size.printed)
                told = f"{ratios[-1]:.2f}"
            printed = f"{1e6 * size.printed:10.4f}" if size.printed is not None else " " * 10
            print(
                f"{form:11s} {flank:10s} {share:7g} {frequency:8g} {size.order:6d} {1e6 * size.amplitude:13.4f}  {printed} "
                f"{1e6 * size.actual:10.4f}  {told:>14s}",
                flush=True,
            )
    within = sum(0.5 <= ratio <= 2.0 for ratio in ratios)
    print(f"{within} of {len(ratios)} within 0.5 and 2, from {min(ratios):.2f} to {max(ratios):.2f}")


if __name__ == "__main__":
    main()
