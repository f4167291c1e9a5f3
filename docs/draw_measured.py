"""Draws the pictures of docs/measured.md into docs/pictures/measured_*.png: python docs/draw_measured.py"""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np

import rotorgear as rg
from rotorgear.plots.figure import BLUE, GREY, ORANGE, name_axes, new_figure, plain_axis
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


def save(figure: Any, name: str) -> None:
    """Write a picture."""
    rg.plot.save(figure.axes[0], PICTURES / f"measured_{name}.png")
    print(f"drew measured_{name}.png")


def main() -> None:
    """Draw all of them."""
    figure = new_figure((6.0, 3.0), "Compressor rotor, free-free: four bending modes")
    differences(
        figure.subplots(), "compressor_rotor", {"rotor": "reading of the drawing", "other": "the other reading"}, 3.0
    )
    save(figure, "compressor_rotor")
    figure = new_figure((6.0, 3.0), "Rotor on leaf springs: five modes")
    differences(figure.subplots(), "leaf_spring_rotor", {"rotor": ""}, 3.0)
    save(figure, "leaf_spring_rotor")

    figure = new_figure((6.0, 3.0), "Shaft of 6 mm: torsional stiffness over the length that hubs hold")
    axis = figure.subplots()
    held = np.linspace(0.0, 40.0, 9)
    axis.plot(held, [shaft.measure("", str(x)) for x in held], color=ORANGE, label="model")
    axis.axhline(35.7, color=BLUE, label="measured")
    plain_axis(axis)
    name_axes(axis, x="rigid length at each end, mm", y="stiffness, N m/rad", legend=2)
    save(figure, "thruster_shaft")

    figure = new_figure((6.0, 3.0), "Journal bearing: largest film pressure")
    axis = figure.subplots()
    for load, colour in (("150", BLUE), ("450", ORANGE)):
        own = [row for row in lines("journal_pressure") if f" {load} N" in row["quantity"]]
        rpm = [float(row["quantity"].split()[2]) for row in own]
        computed = [film.measure(row["quantity"], "") for row in own]
        axis.plot(rpm, [float(row["expected"]) for row in own], "o", color=colour, label=f"measured, {load} N")
        axis.plot(rpm, computed, color=colour, label=f"film, {load} N")
    plain_axis(axis)
    name_axes(axis, x="speed, rpm", y="pressure, kPa", legend=2)
    save(figure, "journal_pressure")

    figure = new_figure((6.0, 3.0), "Split path: share of the path that is ahead")
    axis = figure.subplots()
    stiffness = np.geomspace(5.0, 60.0, 12)
    axis.axhspan(50.0, 53.0, color=GREY, alpha=0.15, lw=0, label="measured: at most 53 %")
    axis.plot(stiffness, [split.measure("", str(k)) for k in stiffness], color=ORANGE, label="statics, 1.2 mrad")
    plain_axis(axis)
    name_axes(axis, x="assumed stiffness of a path, kN m/rad", y="share, %", legend=1)
    save(figure, "split_path")


if __name__ == "__main__":
    main()
