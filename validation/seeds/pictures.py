"""python -m validation.seeds.pictures [NAME ...]: draw the studies of the five published systems to docs/pictures/."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import rotorgear as rg
from rotorgear.plots.figure import COLOURS, new_figure, save
from validation.cases.split_torque_lines.spectrum import run as split_torque
from validation.seeds import kept, marine, pair12, pair16, pair24
from validation.seeds.rows import changed, loaded

FOLDER = Path(__file__).resolve().parents[2] / "docs" / "pictures"


def dots(axes: Any, x: np.ndarray, result: rg.SweepResult, contact: int, size: float = 0.8) -> None:
    """Poincare points of a contact in um over x (p,)."""
    y = 1e6 * result.section[:, 0, :, contact, 0]
    axes.plot(np.repeat(x, y.shape[1]), y.ravel(), "k.", ms=size, mew=0, rasterized=True)
    axes.grid(alpha=0.25)
    axes.margins(x=0.01)


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
    known = kept.piece("marine", "map", marine.PIECES)["values"]
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


def draw_pair12_impact(figure: Any) -> None:
    """Printed impact forces and computed vibration over the contact ratio, with the spread over random sets."""
    left, right = figure.subplots(1, 2)
    ratio = [row[1] for row in pair12.TABLE]
    left.plot(ratio, [row[2] for row in pair12.TABLE], "ks-", ms=4, mfc="none", lw=0.8, label="printed, reference")
    left.plot(ratio, [row[3] for row in pair12.TABLE], "k.--", ms=5, lw=0.8, label="printed, proposed")
    left.set_ylabel("impact force, kN")
    known = pair12.values()
    rows = [
        (
            pair12.TABLE[i - 1][1],
            *(float(known[f"{key}_{i}"]) for key in ("rms", "low", "high", "rms_rotation", "fe_force")),
        )
        for i in (1, 3, 5)
    ]
    x, chosen, low, high, rotation, teeth = np.array(rows).T
    left.plot(x, teeth, "^-", ms=4, color=COLOURS[2], lw=0.8, label="from loaded teeth")
    right.fill_between(x, low, high, color=COLOURS[4], alpha=0.4, lw=0, label="10 to 90 % of 40 random sets")
    right.plot(x, chosen, ".-", color=COLOURS[0], lw=1.0, label="along the flank normal")
    right.plot(x, rotation, ".--", color=COLOURS[1], lw=1.0, label="in the rows of rotation only")
    right.plot(x, [pair12.PRINTED_RMS[at][0] for at in x], "ks", ms=5, mfc="none", label="printed")
    right.set_ylabel("rms of the circumferential acceleration, m/s$^2$")
    for one in (left, right):
        one.set_xlabel("printed contact ratio")
        one.set_ylim(bottom=0.0)
        one.legend(fontsize=7)
        one.grid(alpha=0.25)


def draw_pair16_factors(figure: Any) -> None:
    """Dynamic factors of both pairs over random sets of what is not given, beside the stated set and the printed number."""
    axes = figure.subplots()
    printed = {"a": 1.23, "b": 1.18}
    for place, (name, (teeth, helix, impact)) in enumerate(pair16.PAIRS.items()):
        sample = np.sort(pair16.spread(teeth, helix, impact))
        stated = pair16.run(loaded(pair16.FILES[name]))[0]
        share = (np.arange(sample.size) + 0.5) / sample.size
        axes.step(
            sample, share, where="mid", color=COLOURS[place], lw=1.2, label=f"pair {name.upper()}: 40 random sets"
        )
        axes.axvline(
            stated, color=COLOURS[place], lw=1.0, ls="--", label=f"pair {name.upper()}: stated set {stated:.3f}"
        )
        axes.axvline(
            printed[name], color=COLOURS[place], lw=1.0, ls=":", label=f"pair {name.upper()}: printed {printed[name]}"
        )
    axes.set_xlabel("dynamic factor $K_v$")
    axes.set_ylabel("share of the sets below")
    axes.legend(fontsize=7)
    axes.grid(alpha=0.25)


PICTURES: dict[str, tuple[Callable[[Any], None], tuple[float, float]]] = {
    "seeds_marine_ratio": (draw_marine_ratio, (9.0, 6.0)),
    "seeds_marine_regions": (draw_marine_regions, (7.0, 6.0)),
    "seeds_marine_map": (draw_marine_map, (7.5, 4.5)),
    "seeds_pair24_studies": (draw_pair24_studies, (9.0, 6.5)),
    "seeds_pair24_set2": (draw_pair24_set2, (8.0, 5.0)),
    "seeds_split_spectrum": (draw_split_spectrum, (8.0, 4.5)),
    "seeds_pair12_impact": (draw_pair12_impact, (9.0, 4.0)),
    "seeds_pair16_factors": (draw_pair16_factors, (7.0, 4.5)),
}


def main() -> None:
    """Draw the pictures that are named, or all."""
    parser = argparse.ArgumentParser(
        prog="python -m validation.seeds.pictures", description="Pictures of the five systems."
    )
    parser.add_argument("names", nargs="*", metavar="NAME", choices=[*PICTURES, []], help=", ".join(PICTURES))
    for name in parser.parse_args().names or PICTURES:
        draw, size = PICTURES[name]
        figure = new_figure(size)
        draw(figure)
        print(f"wrote {save(figure, FOLDER / f'{name}.png')}", flush=True)


if __name__ == "__main__":
    main()
