"""Draws the pictures of docs/theory_structure.md into docs/pictures/theory_*.svg: python docs/draw_theory_structure.py"""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import numba
import numpy as np
from machinery.figures import COLOURS, save
from matplotlib.axes import Axes
from matplotlib.patches import Arc

import rotorgear as rg
from rotorgear.analysis.modal.refine import errors_of, total_error
from rotorgear.analysis.modal.solve import Wanted, solve
from rotorgear.elements.gear_mesh import ContactGeometry, flank_normal
from rotorgear.gears.stiffness.face_load import uniform_line
from rotorgear.solvers.contact.gap_contact import gap_contact
from rotorgear.solvers.contact.kinds import ADHESIVE, NON_ADHESIVE
from rotorgear.system.plan import Plan
from rotorgear.system.system import System

ROOT = Path(__file__).parents[1]


def shaft_estimate() -> None:
    """Error of bending frequencies and its estimate, by halving basic elements and by raising the order."""
    model = rg.load(ROOT / "models" / "jeffcott.toml")

    def modes(elements: int, order: int) -> tuple[int, np.ndarray, np.ndarray]:
        system = System(model, plan=Plan(elements, order))
        found = solve(system, Wanted(None, 12, None, ("bending",)))
        parts = errors_of(system, None, found.eigenvalues, found.vectors, found.rigid)
        return system.n, np.abs(found.eigenvalues), total_error(parts, len(found.eigenvalues))

    truth = modes(4, 10)[1]
    series = {
        "basic elements, halved": [modes(n, 1) for n in (1, 2, 4, 8, 16, 32)],
        "one element a segment, order raised": [modes(1, p) for p in (1, 2, 3, 4, 5, 6, 7, 8)],
    }
    figure, both = plt.subplots(1, 2, figsize=(9.0, 3.3), sharey=True)
    for axes, (title, found) in zip(both, series.items(), strict=True):
        for number, (place, colour) in enumerate(zip((0, 2, 4), COLOURS, strict=False), 1):
            rows = [(n, w[place] / truth[place] - 1.0, e[place]) for n, w, e in found if len(w) > place]
            n, error, estimate = np.array(rows).T
            shown = error > 1e-11
            axes.loglog(n[shown], error[shown], "-", color=colour, label=f"bending pair {number}, true")
            finite = shown & np.isfinite(estimate)
            axes.loglog(
                n[finite], estimate[finite], "o", mfc="none", color=colour, label=f"bending pair {number}, estimate"
            )
        axes.set_title(title, fontsize=9)
        axes.set_xlabel("degrees of freedom")
        axes.grid(alpha=0.3)
    both[0].set_ylabel("relative error of the frequency")
    both[0].set_xticks([20, 50, 100, 200, 400], ["20", "50", "100", "200", "400"])
    both[1].set_xticks([20, 30, 50, 80], ["20", "30", "50", "80"])
    for axes in both:
        axes.minorticks_off()
    both[1].legend(fontsize=7, loc="lower left")
    save(figure, "shaft_estimate")


def mesh_normal() -> None:
    """The transverse plane of a mesh: pitch circles, base circles, e, t, n_t, and one contact point for both gears."""
    a = np.radians(26.0)
    r1, r2 = 1.0, 1.6
    geometry = ContactGeometry(0.0, float(a), 0.0, 0, 1, float(r1 * np.cos(a)), float(r2 * np.cos(a)))
    n = flank_normal(geometry)[:2]
    figure, axes = plt.subplots(figsize=(7.4, 4.3))
    pitch = np.array([r1, 0.0])
    for centre, r, colour in ((0.0, r1, COLOURS[0]), (r1 + r2, r2, COLOURS[1])):
        axes.add_patch(plt.Circle((centre, 0.0), r, fill=False, color=colour, linewidth=1.2))
        axes.add_patch(
            plt.Circle((centre, 0.0), r * np.cos(a), fill=False, color=colour, linewidth=0.9, linestyle="--")
        )
        axes.plot([centre], [0.0], "o", color=colour, markersize=4)
    first = pitch - r1 * np.sin(a) * n
    last = pitch + r2 * np.sin(a) * n
    axes.plot([first[0], last[0]], [first[1], last[1]], color="#555555", linewidth=1.0)
    axes.plot(*np.array([first, last]).T, "s", color="#555555", markersize=3)
    contact = pitch + 0.3 * n
    for centre, colour in ((0.0, COLOURS[0]), (r1 + r2, COLOURS[1])):
        axes.annotate("", contact, (centre, 0.0), arrowprops={"arrowstyle": "->", "color": colour, "linewidth": 1.3})

    def arrow(
        start: np.ndarray, step: np.ndarray, text: str, shift: tuple[float, float], colour: str = "black"
    ) -> None:
        axes.annotate("", start + step, start, arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 1.6})
        axes.text(*(start + step + np.array(shift)), text, fontsize=11, color=colour, ha="center", va="center")

    arrow(contact, 0.85 * n, "$n_t$", (0.14, 0.06), COLOURS[2])
    arrow(np.array([-1.1, -1.5]), np.array([0.7, 0.0]), "$e$", (0.12, 0.0))
    arrow(np.array([-1.1, -1.5]), np.array([0.0, 0.5]), "$t$", (-0.11, 0.03))
    axes.plot([r1, r1], [-0.25, 1.2], color="#999999", linewidth=0.8, linestyle=":")
    axes.add_patch(Arc((r1, 0.0), 1.9, 1.9, theta1=90.0 - np.degrees(a), theta2=90.0))
    axes.text(r1 + 0.18, 1.0, r"$\alpha$", fontsize=11)
    axes.plot(*pitch, "o", color="black", markersize=3)
    axes.plot(*contact, "o", color=COLOURS[2], markersize=5)
    grey = {"arrowstyle": "-", "color": "#999999", "linewidth": 0.7}
    axes.annotate("pitch point", pitch, (1.45, -0.35), fontsize=8, arrowprops=grey)
    axes.text(0.33, 0.24, r"$r_{w1} e + \xi\, n_t$", fontsize=10, color=COLOURS[0], ha="center")
    axes.text(2.0, 0.28, r"$-r_{w2} e + \xi\, n_t$", fontsize=10, color=COLOURS[1], ha="center")
    axes.text(-0.05, -0.12, "pinion", fontsize=9, ha="right", color=COLOURS[0])
    axes.text(r1 + r2 + 0.1, -0.12, "gear", fontsize=9, color=COLOURS[1])
    axes.annotate("base tangent point\nof the pinion", first, (0.75, -1.5), fontsize=8, ha="center", arrowprops=grey)
    axes.annotate("base tangent point\nof the gear", last, (1.85, 0.75), fontsize=8, arrowprops=grey)
    axes.annotate(
        "",
        (-0.28, 0.36),
        (0.28, 0.36),
        arrowprops={"arrowstyle": "->", "connectionstyle": "arc3,rad=0.6", "color": "black"},
    )
    axes.text(0.0, 0.56, "torque, $s = +1$", fontsize=9, ha="center")
    axes.set_xlim(-1.25, 4.3)
    axes.set_ylim(-1.65, 1.65)
    axes.set_aspect("equal")
    axes.axis("off")
    save(figure, "mesh_normal")


def loop_split() -> None:
    """Mean forces of the meshes of a loop over the index error of one of them, and the derivative at zero."""
    model = rg.load(ROOT / "models" / "split_torque.toml")
    there = rg.static(model)
    names = list(dict.fromkeys(there.contact_mesh))

    def by_mesh(values: np.ndarray) -> np.ndarray:
        return np.array(
            [sum(v for v, m in zip(values, there.contact_mesh, strict=True) if m == name) for name in names]
        )

    errors = np.linspace(-1000e-6, 1000e-6, 61)
    forces = np.array(
        [by_mesh(rg.static(model.with_({"meshes.stage_2b.index_error": float(e)})).mesh_force) for e in errors]
    )
    row = there.force_derivative[there.parameter.index("meshes.stage_2b.index_error")]
    start, slope = by_mesh(there.mesh_force), by_mesh(row)
    figure, axes = plt.subplots(figsize=(6.4, 3.4))
    for k, (name, colour) in enumerate(zip(names, COLOURS, strict=True)):
        axes.plot(1e6 * errors, 1e-3 * forces[:, k], color=colour, label=name)
        near = np.array([-600e-6, 800e-6])
        axes.plot(1e6 * near, 1e-3 * (start[k] + slope[k] * near), ":", color=colour, linewidth=1.0)
    axes.set_ylim(-3.0, 128.0)
    axes.set_xlabel("index error of stage_2b, µm")
    axes.set_ylabel("force along the flank normal, kN")
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(1.01, 0.5))
    save(figure, "loop_split")


@numba.njit
def _contact(mode: int, k: float, c: float, clearance: float, per_depth: float, x: float, rate: float) -> float:
    return gap_contact(mode, k, c, clearance, per_depth, x, rate).force


def _law(axes: Axes) -> None:
    """The force of a dead zone over the approach, at rest and on the way in and out."""
    x = np.linspace(-2.2, 1.2, 801)
    kinds = (
        (0.0, NON_ADHESIVE, "-", COLOURS[0], "at rest"),
        (2.0, NON_ADHESIVE, "-", COLOURS[1], "closing fast"),
        (-2.0, NON_ADHESIVE, "-", COLOURS[2], "parting fast"),
        (-2.0, ADHESIVE, ":", COLOURS[3], "parting fast, adhesive"),
    )
    for rate, mode, line, colour, label in kinds:
        # On the other side the flanks close where x falls.
        force = [_contact(mode, 1.0, 0.15, 1.0, 5.0, at, rate if at > -0.5 else -rate) for at in x]
        axes.plot(x, force, line, color=colour, label=label, linewidth=1.3)
    axes.axhline(0.0, color="black", linewidth=0.6)
    axes.set_xticks([-1.0, 0.0], ["$-b$", "0"])
    axes.set_yticks([0.0], ["0"])
    axes.set_xlabel("approach $x$")
    axes.set_ylabel("force $F$")
    axes.legend(fontsize=7, loc="upper left")
    axes.grid(alpha=0.3)


def _line_loads(axes: Axes) -> None:
    """Load per width along a face for some misalignments, in units of the mean one."""
    for f, colour in zip((0.0, 1.0, 2.0, 6.0), COLOURS, strict=True):
        face = uniform_line(1.0, 1.0, 1.0, f)
        axes.plot(
            face.z, face.line_load, color=colour, label=f"$k f/F = {f:g}$, $K_{{H\\beta}} = {face.load_factor:.2f}$"
        )
    axes.set_xlabel("place along the face $z/b$")
    axes.set_ylabel("load per width over the mean")
    axes.legend(fontsize=7)
    axes.grid(alpha=0.3)


def contact_laws() -> None:
    """A contact with its corners, and the face of a mesh that opens."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.3))
    _law(left)
    _line_loads(right)
    figure.subplots_adjust(wspace=0.25)
    save(figure, "contact_laws")


if __name__ == "__main__":
    shaft_estimate()
    mesh_normal()
    loop_split()
    contact_laws()
