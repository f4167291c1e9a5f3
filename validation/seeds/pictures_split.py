"""python -m validation.seeds.pictures_split [NAME ...]: draw the studies of the split-torque gearbox to docs/pictures/."""

from __future__ import annotations

from typing import Any

import rotorgear as rg
from rotorgear.plots.figure import COLOURS
from validation.cases.split_torque_lines.spectrum import run as split_torque
from validation.seeds.models import loaded
from validation.seeds.pictures import Picture, draw


def draw_split_spectrum(figure: Any) -> None:
    """Acceleration at the output bearing with the printed harmonics of the transmission error."""
    lines, _ = split_torque()
    axes = figure.subplots()
    keep = lines.frequency_hz < 20e3
    axes.vlines(
        lines.frequency_hz[keep], 1e-6 * lines.amplitude[keep].max(), lines.amplitude[keep], color=COLOURS[0], lw=1.0
    )
    axes.set_yscale("log")
    axes.set_ylim(1e-4 * lines.amplitude[keep].max(), 3.0 * lines.amplitude[keep].max())
    meshes = rg.check(loaded("split_torque")).to_dict()["meshes"]
    hz = {row["name"]: row["mesh_frequency_hz"] for row in meshes}
    for stage, mesh, count, style in ((2, "stage_2a", 5, ":"), (1, "stage_1a", 2, "--")):
        for number in range(1, count + 1):
            label = f"stage {stage} and its harmonics" if number == 1 else None
            axes.axvline(hz[mesh] * number, color=COLOURS[3 - stage], lw=0.5, ls=style, label=label)
    axes.set_xlabel("frequency, Hz")
    axes.set_ylabel("acceleration at the output bearing, m/s$^2$")
    axes.legend(fontsize=7)
    axes.grid(alpha=0.25)


PICTURES: dict[str, Picture] = {
    "seeds_split_spectrum": (draw_split_spectrum, (8.0, 4.5)),
}

if __name__ == "__main__":
    draw(PICTURES)
