"""Draws the pictures of docs/theory_motions.md into docs/pictures/theory_*.svg: python docs/draw_theory_motions.py"""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from machinery.figures import COLOURS, save

import rotorgear as rg
from rotorgear.analysis.rig.posterior import Posterior
from rotorgear.analysis.transient.request import prepare
from rotorgear.solvers.eigen.synchronous import Affine, synchronous_speeds
from rotorgear.solvers.sparse.factor import negative_eigenvalues
from rotorgear.solvers.time.exponential import Exponential
from rotorgear.solvers.time.local_system import Integrator, MotionState, Records, state_at_rest
from rotorgear.solvers.time.newmark import Newmark
from rotorgear.solvers.time.run import Schedule, run

ROOT = Path(__file__).parents[1]


def counts() -> None:
    """Count of modes by negative eigenvalues of Q(i w), and critical speeds of an overhung disk."""
    # A disk of 10 kg at the end of a massless cantilever: x, ty and y, -tx with the same stiffness.
    plane = np.array([[4.0e6, -0.8e6], [-0.8e6, 0.24e6]])
    K = la.block_diag(plane, plane)
    M = np.diag([10.0, 0.09, 10.0, 0.09])
    G = np.zeros((4, 4))
    G[1, 3], G[3, 1] = 0.16, -0.16
    speed = 900.0
    w = np.linspace(0.0, 3600.0, 721)
    scale = 1.0 / np.sqrt(np.diag(K))
    scaled = [(K + 1j * x * speed * G - x**2 * M) * scale[:, None] * scale for x in w]
    values = np.array([np.linalg.eigvalsh(Q) for Q in scaled])
    count = [negative_eigenvalues(Q) for Q in scaled]
    state = np.block([[np.zeros((4, 4)), np.eye(4)], [-np.linalg.solve(M, K), -np.linalg.solve(M, speed * G)]])
    modes = np.sort(np.linalg.eigvals(state).imag)[4:]
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.4))
    for k in range(4):
        left.plot(w, values[:, k], color=COLOURS[0], linewidth=1.2)
    left.axhline(0.0, color="black", linewidth=0.7)
    left.plot(modes, np.zeros(4), "o", color=COLOURS[1], markersize=5, label="modes at 900 rad/s")
    left.set_ylim(-3.0, 2.2)
    left.set_xlabel("w, rad/s")
    left.set_ylabel("eigenvalues of Q(i w), scaled")
    steps = left.twinx()
    steps.step(w, count, where="mid", color=COLOURS[2], linestyle="--", linewidth=1.4, label="negative pivots")
    steps.set_ylim(-0.2, 9.0)
    steps.set_yticks(range(5))
    steps.set_ylabel("count", color=COLOURS[2])
    lines = [*left.get_legend_handles_labels()[0], *steps.get_legend_handles_labels()[0]]
    left.legend(lines, [str(line.get_label()) for line in lines], loc="upper right", frameon=False)
    spins = np.linspace(1.0, 1500.0, 151)
    tracks = []
    for spin in spins:
        state[4:, 4:] = -np.linalg.solve(M, spin * G)
        tracks.append(np.sort(np.linalg.eigvals(state).imag)[4:])
    right.plot(spins, np.array(tracks), color=COLOURS[0], linewidth=1.2)
    right.plot(spins, spins, color="black", linewidth=0.8, linestyle=":")
    right.text(1370.0, 1460.0, "w = W", ha="right")
    none = sp.csc_array((4, 4))
    family = Affine(sp.csc_array(M), none, sp.csc_array(G), sp.csc_array(K), none, none, 0.0, 1500.0)
    for root in synchronous_speeds(family, 1.0):
        right.plot(root.speed, root.speed, "o", color=COLOURS[1], markersize=5)
    right.set_ylim(0.0, 3000.0)
    right.set_xlabel("speed W, rad/s")
    right.set_ylabel("natural frequency, rad/s")
    figure.tight_layout()
    save(figure, "counts")


def energy() -> None:
    """Energy of a pair that hammers within its backlash without damping, by four methods and many steps."""
    still = {"meshes.pair.damping_ratio": 0.0, "meshes.pair.stiffness_variation": []}
    still |= {"meshes.pair.transmission_error": []}
    task = prepare(rg.load(ROOT / "models" / "backlash_pair.toml").with_(still), None, None)
    system = task.local.local
    contact = np.sqrt(1.6e8 * 2.0 * 0.0564**2 / 3.2e-3)  # rad/s, of the pair on its mesh

    def run_of(method: Integrator, per_radian: float, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Times, and energies over the kinetic one at the start."""
        h = 1.0 / (per_radian * contact)
        v = np.array([3.0, 3.0])
        state = state_at_rest(system, h, task.rest.q, v)
        kept: list[np.ndarray] = []

        def keep(records: Records, _: MotionState) -> None:
            q, v = (records.rows(kind, np.eye(system.n)) for kind in "qv")
            kinetic = 0.5 * np.einsum("ri,ri->r", v, (system.M @ v.T).T)
            kept.append(np.column_stack([records.t, kinetic + records.energy[:, :, 0].sum(axis=1) - q @ system.load]))

        run(system, method, Schedule(h, int(time / h)), state, keep)
        t, total = np.vstack(kept).T
        start = 0.5 * v @ (system.M @ v)
        before = start + 0.5 * float(task.rest_force[0]) ** 2 / 1.6e8 - float(task.rest.q @ system.load)
        return t, (total - before) / start

    methods: dict[str, Integrator] = {
        "Newmark, force of the step": Newmark(),
        "generalised-alpha, rho = 1": Newmark.generalised_alpha(1.0),
        "HHT, alpha = 0.05": Newmark.hht(0.05),
        "exponential": Exponential(),
    }
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.4))
    for (name, method), colour in zip(methods.items(), COLOURS, strict=True):
        t, change = run_of(method, 2.5, 0.05)
        style = "--" if name == "exponential" else "-"
        left.plot(1e3 * t, 100.0 * change, style, color=colour, linewidth=1.2, label=name)
        steps = np.array([1.5, 2.5, 5.0, 10.0, 20.0, 40.0])
        worst = [np.abs(run_of(method, n, 0.05)[1]).max() for n in steps]
        right.loglog(1.0 / steps, worst, style, marker="o", markersize=3, color=colour, linewidth=1.2)
    left.set_xlabel("time, ms")
    left.set_ylabel("change of energy, % of the kinetic one")
    left.set_ylim(-2.5, 9.0)
    left.legend(frameon=False, fontsize=8, loc="upper left")
    right.set_xticks([0.02, 0.05, 0.1, 0.2, 0.5, 1.0], labels=["0.02", "0.05", "0.1", "0.2", "0.5", "1"])
    right.minorticks_off()
    right.set_xlabel("step times contact frequency, rad")
    right.set_ylabel("largest change of energy")
    figure.tight_layout()
    save(figure, "energy")


def multipliers() -> None:
    """A branch of periodic motions through a fold, and its multipliers about the unit circle."""
    model = rg.load(ROOT / "models" / "backlash_pair.toml")
    found = rg.orbits(model, {"operation.speed": "2400 rpm:4000 rpm"})
    rpm = found.value * 30.0 / np.pi
    height = 1e6 * np.ptp(found.approach_extremes[:, 0], axis=-1)
    mu = found.multipliers[:, :2]
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.7))
    for number in range(len(found.branches)):
        own = found.branch == number
        left.plot(rpm[own], height[own], color="0.75", linewidth=0.8)
        for stable, colour in ((True, COLOURS[0]), (False, COLOURS[1])):
            shown = own & (found.stable == stable)
            left.plot(np.where(shown, rpm, np.nan)[own], np.where(shown, height, np.nan)[own], ".-", color=colour, ms=4)
            right.plot(mu[shown].real.ravel(), mu[shown].imag.ravel(), ".", color=colour, ms=5)
    marks = {"fold": "s", "period doubling": "D"}
    for point in found.special_points:
        at = 1e6 * np.ptp(point.approach_extremes[0])
        left.plot(point.value * 30.0 / np.pi, at, marks.get(point.kind, "o"), color="black", ms=6, mfc="none")
        left.annotate(point.kind, (point.value * 30.0 / np.pi, at), xytext=(6, 8), textcoords="offset points")
    left.set_ylim(0.0, 138.0)
    left.plot([], [], color=COLOURS[0], label="stable")
    left.plot([], [], color=COLOURS[1], label="unstable")
    left.legend(frameon=False, loc="center right")
    left.set_xlabel("speed, rpm")
    left.set_ylabel("peak to peak of the approach, um")
    turn = np.linspace(0.0, 2.0 * np.pi, 200)
    right.plot(np.cos(turn), np.sin(turn), color="black", linewidth=0.7)
    right.set_xlim(-2.2, 2.2)
    right.set_ylim(-1.4, 1.4)
    right.set_aspect("equal")
    right.set_xlabel("Re mu")
    right.set_ylabel("Im mu")
    figure.tight_layout()
    save(figure, "multipliers")


def posterior() -> None:
    """What one line and two lines teach of two stiffnesses."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.5))
    turn = np.linspace(0.0, 2.0 * np.pi, 200)
    circle = np.array([np.cos(turn), np.sin(turn)])
    left.plot(*(30.0 * circle), color="black", linewidth=0.8, label="prior, 30 %")
    cases = {"one line": [[0.30, 0.15]], "two lines": [[0.30, 0.15], [0.10, 0.36]]}
    for (name, rows), colour in zip(cases.items(), COLOURS, strict=False):
        known = Posterior(np.array(rows), np.full(len(rows), 0.02), np.full(2, 0.3))
        spread = np.outer(known.sigma, known.sigma) * known.correlation
        ellipse = 100.0 * la.cholesky(spread, lower=True) @ circle
        text = ", ".join(f"{100.0 * share:.0f} %" for share in known.learnt)
        left.plot(*ellipse, color=colour, linewidth=1.4, label=f"{name}: learnt {text}")
    left.set_aspect("equal")
    left.set_xlim(-40.0, 40.0)
    left.set_ylim(-40.0, 62.0)
    left.set_xlabel("ln of the first stiffness, % off")
    left.set_ylabel("ln of the second one, % off")
    left.legend(frameon=False, fontsize=8, loc="upper center")
    s = np.logspace(-2.0, 2.0, 200)
    right.semilogx(s, s**2 / (1.0 + s**2), color=COLOURS[0], linewidth=1.4, label="share from the lines")
    right.semilogx(s, 1.0 / np.sqrt(1.0 + s**2), color=COLOURS[1], linewidth=1.4, label="spread after over before")
    right.set_xlabel("singular value s of a direction")
    right.legend(frameon=False, loc="center right", fontsize=8)
    figure.tight_layout()
    save(figure, "posterior")


if __name__ == "__main__":
    for draw in (counts, energy, multipliers, posterior):
        draw()
