"""Draws docs/pictures/theory_contact.svg, theory_teeth.svg, theory_bearings.svg and theory_bodies.svg of docs/theory_parts.md:
python docs/draw_theory_parts.py [FOLDER for copies as PNG]

All curves are computed by the program; models and meshes are those of the pages on loaded teeth, bearings, casings and gear
bodies. It takes a minute.
"""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import scipy.linalg as la
from machinery.snippets import marked_blocks
from matplotlib.figure import Figure

DOCS = Path(__file__).resolve().parent
BLUE, ORANGE, GREEN, GREY = "#1f4e79", "#c55a11", "#3a7d44", "#7f7f7f"
plt.rcParams |= {"font.size": 9.0, "svg.hashsalt": "rotorgear", "axes.spines.top": False, "axes.spines.right": False}


def from_page(page: str) -> None:
    """Write the files that a page shows into this folder."""
    for block in marked_blocks(DOCS / f"{page}.md"):
        if block.verb == "file":
            Path(block.argument).write_text(block.text, encoding="utf-8")


def contact(figure: Figure) -> None:
    """What elements see of a contact, and that the width of the patch drops out."""
    import rotorgear as rg
    from rotorgear.gears.loaded import loaded_contact
    from rotorgear.gears.loaded.mesh_cycle import mesh_cycle
    from rotorgear.gears.loaded.tooth_contact import contact_problem

    left, right = figure.subplots(1, 2, width_ratios=[1.25, 1.0])
    c, a = 1.0, 0.32
    x = np.linspace(-c, c, 301)
    left.fill_between(x, 0.0, 0.75 * np.sqrt(1.0 - x**2), color=BLUE, alpha=0.2, linewidth=0)
    left.plot(x, 0.75 * np.sqrt(1.0 - x**2), color=BLUE)
    s = np.linspace(-a, a, 301)
    left.plot(s, 0.75 * c / a * np.sqrt(np.maximum(1.0 - (s / a) ** 2, 0.0)), color=ORANGE)
    left.axhline(0.0, color="black", linewidth=1.0)
    # Displacements under both, below the flank: K F' x^2 / c^2 inside, potential of the pressure outside.
    wide = np.linspace(-1.7, 1.7, 401)

    def sunk(half: float) -> np.ndarray:
        ratio = np.maximum(np.abs(wide) / half, 1.0)
        root = np.sqrt(ratio**2 - 1.0)
        outside = np.log(ratio + root) + ratio**2 - ratio * root - 1.0
        return np.log(2.0 / half) + 0.5 - np.where(np.abs(wide) <= half, (wide / half) ** 2, 1.0 + outside)

    shift = 0.45
    left.plot(wide, -shift * sunk(c) - 0.35, color=BLUE, linestyle="--")
    left.plot(wide, -shift * sunk(a) - 0.35, color=ORANGE, linestyle="--")
    left.annotate("pressure of the patch,\nhalf-width $c$", (0.75, 0.5), (0.85, 1.15), arrowprops={"arrowstyle": "-"})
    left.annotate("Hertz strip,\nhalf-width $a$", (-0.2, 1.9), (-1.65, 1.75), arrowprops={"arrowstyle": "-"})
    left.text(1.8, -0.06, "flank,\nsunk", ha="left", va="top")
    top, bottom = -shift * (np.log(2.0) + 0.25) - 0.35, -shift * (np.log(2.0 / a) + 0.5) - 0.35
    left.annotate("", (0.0, top), (0.0, bottom), arrowprops={"arrowstyle": "<->", "color": GREEN})
    left.text(
        0.42, -1.35, r"$g = KF'\,\left(\frac{1}{4} + \ln\frac{c}{a}\right)$", color=GREEN, va="center", fontsize=11
    )
    left.set(xlim=(-1.8, 2.35), ylim=(-1.75, 2.6))
    left.axis("off")

    request = rg.load("pair.toml")
    teeth = request.layout.mesh("stage").working_teeth(1)
    load = 2000.0 / request.layout.mesh("stage").pinion.base_radius
    widths = np.array([0.05, 0.08, 0.12, 0.18, 0.27, 0.4, 0.55])
    position = np.array([0.0])
    local = loaded_contact._local
    whole, elements = [], []
    for width in widths:
        problem = contact_problem(replace(teeth, fe=replace(teeth.fe, patch=float(width), preset="fine")))
        cycle = mesh_cycle(problem, load, position)
        whole.append(cycle.deflection[0] * 1e6)
        loaded_contact._local = lambda contact, force, total: (0.0 * force, 0.0 * force)
        elements.append(mesh_cycle(problem, load, position).deflection[0] * 1e6)
        loaded_contact._local = local
    strip = float(cycle.strip.max()) / problem.module
    right.plot(widths, whole, "o-", color=BLUE, label="elements and local part")
    right.plot(widths, elements, "s--", color=ORANGE, label="elements alone")
    right.axvline(strip, color=GREY, linewidth=0.8)
    right.text(strip * 1.05, 0.55 * max(whole), "$a$ of the strip", color=GREY)
    right.set(
        xscale="log",
        xlabel="half-width $c$ of the patch, normal modules",
        ylabel="approach at the pitch point, um",
        ylim=(0.0, 1.15 * max(whole)),
    )
    right.set_xticks([0.05, 0.1, 0.2, 0.5], ["0.05", "0.1", "0.2", "0.5"])
    right.xaxis.set_minor_formatter("")
    right.legend(frameon=False, loc="lower left")


def teeth(figure: Figure) -> None:
    """Secant and tangent stiffness, beside the models without contact; and the load along a face that is misaligned."""
    import rotorgear as rg
    from rotorgear.gears.stiffness.face_load import uniform_line

    model = rg.load("pair.toml")
    left, right = figure.subplots(1, 2, width_ratios=[1.35, 1.0])
    found = rg.mesh(model, "stage")
    assert found.tangent is not None
    u = np.linspace(0.0, 1.0, 601)
    left.plot(
        u, 1e-9 * np.interp(u, found.position, found.tangent, period=1.0), color=ORANGE, label="loaded teeth, tangent"
    )
    left.plot(u, 1e-9 * found.at(u)[0], color=BLUE, label="loaded teeth, secant")
    for name, style, colour in (("potential_energy", "--", GREEN), ("contact_line", ":", GREY), ("iso", "-.", GREY)):
        curve = rg.mesh(model, "stage", stiffness=name)
        label = {"potential_energy": "potential energy", "contact_line": "contact lines", "iso": "ISO 6336-1"}[name]
        left.plot(curve.position, 1e-9 * curve.stiffness, style, color=colour, label=label)
    left.set(
        xlabel="position in the mesh period", ylabel=r"$F_{bt}/\delta$ and $dF_{bt}/d\delta$, GN/m", ylim=(0.0, None)
    )
    left.legend(frameon=False, fontsize=8)

    # In shares of F/b and of k b / F.
    for f, colour in ((0.0, GREY), (1.0, BLUE), (2.0, GREEN), (6.0, ORANGE)):
        face = uniform_line(1.0, 1.0, 1.0, f)
        right.plot(
            face.z, face.line_load, color=colour, label=f"$k f/F$ = {f:.0f}, $K_{{H\\beta}}$ = {face.load_factor:.2f}"
        )
        right.plot([face.load_place], [0.0], marker="^", color=colour, clip_on=False, zorder=5)
    right.set(
        xlabel="place along the face $z/b$", ylabel="load per width over $F/b$", ylim=(0.0, None), xlim=(-0.5, 0.5)
    )
    right.legend(frameon=False, fontsize=8)


def bearings(figure: Figure) -> None:
    """The corner in the law of a ball bearing, and a film's estimate beside its error."""
    import rotorgear as rg
    from rotorgear.analysis.bearing.state import carried, change_of_tangents, law_at, laws_of, relative
    from rotorgear.forces.ball_bearing import BallBearing
    from rotorgear.forces.journal_film import JournalFilm

    left, right = figure.subplots(1, 2)
    y = np.linspace(-16e-6, -4e-6, 601)
    law = BallBearing(9, 12e-3, 60e-3, clearance=10e-6, order=1.0)
    pitch = law.cycle()
    d = np.zeros((len(y), 5))
    d[:, 1] = y
    several = [law.evaluate_many(d, 0.0 * d, angle=np.full(len(y), pitch * share)) for share in np.arange(64) / 64]
    for number, colour in ((16, GREEN), (32, BLUE), (48, ORANGE)):
        left.plot(
            1e6 * y,
            1e-6 * several[number].in_displacement[:, 0, 0],
            color=colour,
            linewidth=1.0,
            label=f"cage turned by {number / 64:.2g} pitch",
        )
    mean = np.mean([one.in_displacement[:, 0, 0] for one in several], axis=0)
    left.plot(1e6 * y, 1e-6 * mean, color="black", linewidth=1.8, label="mean over a pitch")
    left.set(xlabel="displacement $y$, um", ylabel="$K_{xx}$, N/um")
    left.legend(frameon=False, fontsize=8)

    model = rg.load("turbine.toml")
    speed = 9000.0 * np.pi / 30.0
    state = law_at(laws_of(model, speed), "bearings.left")
    film = state.part.law
    assert isinstance(film, JournalFilm)
    cells = np.array([30, 60, 120, 240, 480])
    runs = [carried(state, replace(film, around=int(n), along=max(int(n) // 20, 2)), speed) for n in cells]
    finest = carried(state, replace(film, around=960, along=48), speed)
    error = [
        max(
            relative(one.stiffness - finest.stiffness, finest.stiffness),
            relative(one.damping - finest.damping, finest.damping),
        )
        for one in runs
    ]
    estimate = [change_of_tangents(one, finer) for one, finer in zip(runs, [*runs[1:], finest], strict=True)]
    right.loglog(cells[:-1], error[:-1], "o-", color=BLUE, label="error against 960 cells")
    right.loglog(cells[:-1], estimate[:-1], "s--", color=ORANGE, label="estimate that is printed")
    right.set(xlabel="cells around the journal", ylabel="relative error of $K$ and $C$")
    right.set_xticks(cells[:-1], [str(n) for n in cells[:-1]])
    right.xaxis.set_minor_formatter("")
    right.legend(frameon=False, fontsize=8)


def bodies(figure: Figure) -> None:
    """The error of a reduction beside its estimate, and the waves of a wheel that turns."""
    import rotorgear as rg
    from rotorgear.casings.fe_body import finite_element_body
    from rotorgear.casings.reduction import held_modes, reduce
    from rotorgear.model.layout.casings import casing_settings

    left, right = figure.subplots(1, 2)
    settings = casing_settings(rg.load("geared_box.toml"), "box")
    fe = finite_element_body(settings)
    whole = held_modes(fe, 12).frequency
    reference, _, _ = reduce(fe, None)
    for kept, colour in ((5, ORANGE), (10, GREEN), (20, BLUE)):
        fixed = reference.fixed_frequency
        body, _, _ = reduce(
            fe, float(0.5 * (fixed[kept - 1] + fixed[min(kept, len(fixed) - 1)])) if kept < 20 else None
        )
        hz, shapes = body.modes()
        count = len(whole)
        error = hz[:count] / whole - 1.0
        told = [0.5 * (body.eigenvalue_error((2.0 * np.pi * hz[k]) ** 2, shapes[:, k]) or 0.0) for k in range(count)]
        ratio = hz[:count] / body.left_frequency
        real = error > 1e-9
        left.loglog(ratio[real], error[real], "o", color=colour, label=f"{len(body.fixed_frequency)} modes: error")
        finite = np.isfinite(told)
        left.loglog(ratio[finite], np.array(told)[finite], "_", color=colour, markersize=11, markeredgewidth=1.6)
    x = np.array([0.1, 0.9])
    left.loglog(x, 2e-3 * x**6, color=GREY, linewidth=0.8)
    left.text(0.094, 2e-8, "slope 6", color=GREY)
    left.plot([], [], "_", color="black", markersize=11, label="estimate")
    left.set(
        xlabel="frequency over the first that is left out", ylabel="relative error of a frequency", ylim=(1e-9, 1.0)
    )
    left.legend(frameon=False, fontsize=8)

    wheel = rg.load(DOCS.parent / "models" / "elastic_wheel.toml").layout.elastic_bodies["wheel"]
    speeds = np.linspace(0.0, 2.0 * np.pi * 250.0, 26)
    for n, colour in ((0, GREY), (2, BLUE), (3, ORANGE)):
        own = np.flatnonzero(wheel.diameters == n)[: 2 if n else 1]
        G = wheel.gyroscopic[6:, 6:][np.ix_(own, own)]
        S = wheel.spin_stiffness[np.ix_(own, own)]
        K = np.diag(wheel.stiffness[own])
        rates = []
        for W in speeds:
            k = len(own)
            A = np.block([[np.zeros((k, k)), np.eye(k)], [-(K + W**2 * S), -W * G]])
            rates.append(np.sort(np.abs(la.eigvals(A).imag))[::2] / (2.0 * np.pi))
        hz = speeds / (2.0 * np.pi)
        lines = np.array(rates)
        for number, line in enumerate(lines.T):
            right.plot(hz, line, color=colour, label=f"{n} nodal diameters" if number == 0 else None)
        if n:
            for side in (-1.0, 1.0):
                right.plot(hz, wheel.frequency[own[0]] + side * n * hz, ":", color=colour, linewidth=0.9)
    right.plot([], [], ":", color="black", label=r"$\omega \pm nW$")
    right.set(xlabel=r"speed $W/2\pi$, Hz", ylabel="frequency seen from the ground, Hz", ylim=(0.0, None))
    right.legend(frameon=False, fontsize=8)


def main() -> None:
    """Draw all of them."""
    copies = Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else None
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        shutil.copytree(DOCS.parent / "models", "models")
        for page in ("mesh", "bearings", "casings"):
            from_page(page)
        for draw, name in ((contact, "contact"), (teeth, "teeth"), (bearings, "bearings"), (bodies, "bodies")):
            figure = plt.figure(figsize=(8.6, 3.3), layout="constrained")
            draw(figure)
            figure.savefig(DOCS / "pictures" / f"theory_{name}.svg", metadata={"Date": None})
            if copies:
                figure.savefig(copies / f"theory_{name}.png", dpi=110)
            plt.close(figure)
        os.chdir(DOCS)


if __name__ == "__main__":
    main()
