"""Draws docs/pictures/measured.png, a panel for each machine of docs/measured.md: python docs/draw_measured.py"""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np

import rotorgear as rg
from rotorgear.plots.figure import BLUE, GREY, ORANGE, name_axes, new_figure, panels_of, plain_axis
from validation.measured.journal_pressure import film
from validation.measured.split_path import split
from validation.measured.thruster_shaft import shaft

# For docs/machinery/made.py.
INPUTS = (
    "validation/measured/compressor_rotor/expected.csv",
    "validation/measured/compressor_rotor/rotor.toml",
    "validation/measured/compressor_rotor/other.toml",
    "validation/measured/leaf_spring_rotor/expected.csv",
    "validation/measured/leaf_spring_rotor/rotor.toml",
    "validation/measured/journal_pressure/expected.csv",
)
PICTURES = Path(__file__).parent / "pictures"
MEASURED = Path(__file__).parents[1] / "validation" / "measured"


def lines(name: str) -> list[dict[str, str]]:
    """The lines of a case."""
    with (MEASURED / name / "expected.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def differences(axis: Any, name: str, readings: dict[str, str], tolerance: float) -> None:
    """Computed over measured frequencies of a case, less 1, in %, with the tolerance as a band."""
    axis.axhspan(-tolerance, tolerance, color=GREY, alpha=0.15, lw=0)
    axis.axhline(0.0, color=GREY, lw=0.8)
    for (model, label), colour, mark in zip(readings.items(), (BLUE, ORANGE), ("o", "s"), strict=False):
        own = [row for row in lines(name) if row["model"] == f"{model}.toml"]
        hz = [float(row["expected"]) for row in own]
        modes = rg.modal(rg.load(MEASURED / name / f"{model}.toml"), modes=16, accuracy=1e-6)
        elastic = modes.frequency_hz[~modes.rigid]
        numbers = [int(row["mode"].partition("+")[0]) for row in own]
        off = [100.0 * (elastic[k - 1] / f - 1.0) for k, f in zip(numbers, hz, strict=True)]
        axis.plot(range(1, len(own) + 1), off, mark, color=colour, label=label)
        axis.set_xticks(range(1, len(own) + 1), [f"{f:g}" for f in hz])
    plain_axis(axis)
    name_axes(
        axis,
        x="measured frequency, Hz",
        y="model over measured, less 1, %",
        legend=len(readings) if len(readings) > 1 else 0,
    )


def main() -> None:
    """Draw all of them."""
    figure = new_figure((11.0, 9.0))
    panels = iter(panels_of(figure, 5))
    axis = next(panels)
    differences(axis, "compressor_rotor", {"rotor": "reading of the drawing", "other": "the other reading"}, 3.0)
    axis.set_title("Compressor rotor, free-free: four bending modes", fontsize=10)
    axis = next(panels)
    differences(axis, "leaf_spring_rotor", {"rotor": ""}, 3.0)
    axis.set_title("Rotor on leaf springs: five modes", fontsize=10)

    axis = next(panels)
    held = np.linspace(0.0, 40.0, 9)
    axis.plot(held, [shaft.measure("", str(x)) for x in held], color=ORANGE, label="model")
    axis.axhline(35.7, color=BLUE, label="measured")
    plain_axis(axis)
    title = "Shaft of 6 mm: torsional stiffness"
    name_axes(axis, x="rigid length at each end, mm", y="stiffness, N m/rad", title=title, legend=2)

    axis = next(panels)
    for load, colour in (("150", BLUE), ("450", ORANGE)):
        own = [row for row in lines("journal_pressure") if f" {load} N" in row["quantity"]]
        rpm = [float(row["quantity"].split()[2]) for row in own]
        computed = [film.measure(row["quantity"], "") for row in own]
        axis.plot(rpm, [float(row["expected"]) for row in own], "o", color=colour, label=f"measured, {load} N")
        axis.plot(rpm, computed, color=colour, label=f"film, {load} N")
    plain_axis(axis)
    name_axes(axis, x="speed, rpm", y="pressure, kPa", title="Journal bearing: largest film pressure", legend=2)

    axis = next(panels)
    stiffness = np.geomspace(5.0, 60.0, 12)
    axis.axhspan(50.0, 53.0, color=GREY, alpha=0.15, lw=0, label="measured: at most 53 %")
    axis.plot(stiffness, [split.measure("", str(k)) for k in stiffness], color=ORANGE, label="statics, 1.2 mrad")
    plain_axis(axis)
    title = "Split path: share of the path that is ahead"
    name_axes(axis, x="assumed stiffness of a path, kN m/rad", y="share, %", title=title, legend=1)
    rg.plot.save(figure.axes[0], PICTURES / "measured.png")
    print("drew measured.png")


if __name__ == "__main__":
    main()
