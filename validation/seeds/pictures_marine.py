"""python -m validation.seeds.pictures_marine [NAME ...]: draw the studies of the marine dual-turbine train to docs/pictures/."""

from __future__ import annotations

from typing import Any

import numpy as np

import rotorgear as rg
from rotorgear.plots.figure import COLOURS
from validation.seeds import kept, marine
from validation.seeds.models import loaded
from validation.seeds.pictures import Picture, dots, draw


def marine_ratio() -> tuple[np.ndarray, dict[float, rg.SweepResult]]:
    """The set R000 over the load ratio at both total torques."""
    ratios = np.linspace(0.1, 1.2, 221)
    return ratios, {
        total: rg.sweep(
            loaded(marine.MODEL),
            {"load ratio": list(ratios)},
            steps=marine.STEPS,
            discard=marine.SETTLE,
            sample=marine.COUNT,
            change=lambda _, at, total=total: marine.operating(at[0], total),
        )
        for total in (30e3, 35e3)
    }


def draw_marine_ratio(figure: Any) -> None:
    """Bifurcation over the load ratio at 30 and 35 kN m, with exponent and shares of time."""
    ratios, results = marine_ratio()
    axes = figure.subplots(3, 2, sharex=True, sharey="row", height_ratios=(3, 1.2, 1.2))
    for column, (total, result) in zip(axes.T, results.items(), strict=True):
        i = result.contact.index("first_lp")
        column[0].set_title(f"total torque {total / 1e3:.0f} kN m", fontsize=9)
        dots(column[0], ratios, result, i, 0.6)
        column[1].plot(ratios, result.lyapunov[:, 0, 0], color=COLOURS[0], lw=0.8)
        column[1].axhline(0.0, color="k", lw=0.5)
        back = result.back[:, 0, i]
        column[2].plot(ratios, back, color=COLOURS[1], lw=0.8, label="back side")
        column[2].plot(ratios, result.apart[:, 0, i], color=COLOURS[2], lw=0.8, label="apart")
        column[2].set_xlabel(r"load ratio $T_\mathrm{LP}/T_\mathrm{HP}$")
        for one in column[1:]:
            one.grid(alpha=0.25)
    axes[0, 0].set_ylabel("deflection, LP first stage, um")
    axes[1, 0].set_ylabel("LE per $T_{m1}$")
    axes[2, 0].set_ylabel("share of time")
    axes[2, 1].legend(fontsize=7)


def draw_marine_regions(figure: Any) -> None:
    """Indicators and exponent with the fitted and with the printed stiffness, and their printed values."""
    ratios = [round(0.1 + 0.05 * i, 2) for i in range(23)]
    nominal = 15e3 / marine.PITCH_RADIUS / marine.STIFFNESS
    printed = {"LE": (-0.02, 0.15, -0.01), "Am": (1.5, 5.8, 2.2), "zeta": (0.65, 0.35, 0.10)}
    axes = figure.subplots(3, 1, sharex=True)
    for soft, colour, label in ((False, 0, "fitted stiffness"), (True, 1, "printed stiffness")):
        found = marine.contact(ratios, table_stiffness=soft)
        size = nominal * (100.0 if soft else 1.0)
        rows = (
            [c.exponent for c in found],
            [c.peak_to_peak / size for c in found],
            [c.back for c in found],
        )
        for one, row in zip(axes, rows, strict=True):
            one.plot(ratios, row, ".-", color=COLOURS[colour], lw=0.8, ms=4, label=label)
    for one, (name, values) in zip(axes, printed.items(), strict=True):
        one.plot((0.3, 0.6, 1.0), values, "ks", ms=5, mfc="none", label="printed")
        one.set_ylabel(
            {
                "LE": "LE per $T_{m1}$",
                "Am": "peak to peak over\nstatic deflection",
                "zeta": "share of time\non back side",
            }[name]
        )
        one.grid(alpha=0.25)
    axes[0].legend(fontsize=7)
    axes[2].set_xlabel(r"load ratio $T_\mathrm{LP}/T_\mathrm{HP}$ at 30 kN m")


def draw_marine_map(figure: Any) -> None:
    """Regions of the LP first stage over total torque and load ratio."""
    axes = figure.subplots()
    colours = {"I": COLOURS[0], "II": COLOURS[1], marine.OPEN: COLOURS[4], "III": COLOURS[2]}
    words = {
        "I": "I: back side, not chaotic",
        "II": "II: chaotic, amplitude above 3",
        marine.OPEN: "open: weak chaos, not settled, or another region later",
        "III": "III: driving side",
    }
    known = kept.values("marine")
    rows = [known[f"map_{total / 1e3:.0f}"].split() for total in marine.TOTALS]
    for name, colour in colours.items():
        places = [
            (gamma, 1e-3 * total)
            for total, row in zip(marine.TOTALS, rows, strict=True)
            for gamma, region in zip(marine.RATIOS, row, strict=True)
            if region == name
        ]
        if places:
            axes.plot(*zip(*places, strict=True), "s", ms=9, mew=0, color=colour, label=words[name])
    totals = np.linspace(min(marine.TOTALS), max(marine.TOTALS), 200)
    change = marine.DRAG / (totals - marine.DRAG)
    shown = change <= marine.RATIOS[-1]
    axes.plot(change[shown], 1e-3 * totals[shown], "k--", lw=0.9, label="no net torque of the LP branch")
    axes.plot((0.3, 0.6, 1.0), (30.0, 30.0, 30.0), "kx", ms=7, label="printed as I, II, III")
    axes.set_xlabel(r"load ratio $T_\mathrm{LP}/T_\mathrm{HP}$")
    axes.set_ylabel("total torque, kN m")
    axes.legend(fontsize=7, loc="upper center", bbox_to_anchor=(0.5, 1.2), ncols=3)


PICTURES: dict[str, Picture] = {
    "seeds_marine_ratio": (draw_marine_ratio, (9.0, 6.0)),
    "seeds_marine_regions": (draw_marine_regions, (7.0, 6.0)),
    "seeds_marine_map": (draw_marine_map, (7.5, 4.5)),
}

if __name__ == "__main__":
    draw(PICTURES)
