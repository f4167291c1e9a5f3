"""python -m validation.seeds.pictures_pair24 [NAME ...]: draw studies of the pair of 24 degrees of freedom to docs/pictures/."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

import rotorgear as rg
from rotorgear.plots.figure import COLOURS
from validation.seeds import pair24
from validation.seeds.models import changed, loaded
from validation.seeds.pictures import Picture, dots, draw


def pair24_over(name: str) -> tuple[np.ndarray, rg.SweepResult]:
    """Set 1 of the 24-dof pair at 6000 rpm over its torque (N m), damping ratio, backlash (um) or stiffness (N/m)."""
    base = loaded(pair24.MODEL)
    # type: ignore[arg-type]
    mean = float(base.meshes["left"].stiffness)
    c = base.meshes["left"].damping or 0.0
    values = np.linspace(
        *{"torque": (50.0, 600.0), "damping": (0.03, 0.15), "backlash": (5.0, 100.0), "stiffness": (1e9, 4e9)}[name],
        111,
    )

    def at(_: rg.Model, value: tuple[float, ...]) -> rg.Model:
        x = value[0]
        mesh = {
            "torque": {},
            "damping": {"damping": c * x / 0.06},
            "backlash": {"backlash": 1e-6 * x},
            "stiffness": {"stiffness": x, "damping": c * math.sqrt(x / mean)},
        }[name]
        loads: dict[str, Any] = {}
        if name == "torque":
            loads = {f"input_{side}": {"torque": 0.5 * x} for side in ("left", "right")}
            loads["output_left"] = {"torque": 0.5 * x * 41.0 / 22.0}
        return changed(base, loads=loads, meshes={"left": mesh, "right": mesh})

    return values, rg.sweep(
        base, {name: list(values)}, change=at, steps=pair24.STEPS, discard=pair24.LONG_SETTLE, sample=150, exponents=0
    )


def draw_pair24_studies(figure: Any) -> None:
    """Bifurcation diagrams of set 1 at 6000 rpm over torque, damping, backlash and stiffness."""
    labels = {
        "torque": "torque, N m",
        "damping": "damping ratio of the mesh",
        "backlash": "backlash, um",
        "stiffness": "mesh stiffness of a helix, N/um",
    }
    for axes, (name, label) in zip(figure.subplots(2, 2).flat, labels.items(), strict=True):
        values, result = pair24_over(name)
        dots(axes, values * (1e-6 if name == "stiffness" else 1.0), result, 0, 1.0)
        axes.set_xlabel(label)
        axes.set_ylabel("deflection at the section, um", fontsize=8)


def draw_pair24_set2(figure: Any) -> None:
    """Set 2 over the speed."""
    speeds = np.linspace(3000.0, 40000.0, 371)
    result = pair24.route(pair24.SECOND, speeds, pair24.SETTLE_2, pair24.KEPT_2)
    top, below = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1))
    dots(top, speeds, result, 0, 1.6)
    top.set_ylabel("deflection at the section, um")
    below.plot(speeds, result.lyapunov[:, 0, 0], color=COLOURS[0], lw=0.8)
    below.axhline(0.02, color="k", lw=0.5, ls="--")
    below.set_ylabel("LE per\nmesh period")
    below.set_xlabel("pinion speed, rpm")
    below.grid(alpha=0.25)


PICTURES: dict[str, Picture] = {
    "seeds_pair24_studies": (draw_pair24_studies, (9.0, 6.5)),
    "seeds_pair24_set2": (draw_pair24_set2, (8.0, 5.0)),
}

if __name__ == "__main__":
    draw(PICTURES)
