"""Follows branches of modes over speed: where they meet excitation lines, where they turn unstable, and margins from that.

The modes of each independent group of dofs are those of `SpeedModes.at`; a step is judged by `solvers.tracking` and halved where
it leaves a doubt. A root of a function of an eigenvalue over speed is bracketed by two speeds of the track and found by a
safeguarded secant; at every trial the eigenpair is refined in the reduced problem from the cubic through both ends.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import zgetrf, zgetrs

from rotorgear.analysis.campbell.snapshot_basis import SpeedModes
from rotorgear.analysis.modal.branch_shapes import BasisShapes, Portraits
from rotorgear.analysis.modal.whirl import whirl_word_among
from rotorgear.results.campbell import Crossing, ExcitationOrder, Margin
from rotorgear.solvers.eigen.reduced_pencil import Eigen, Pencil
from rotorgear.solvers.eigen.tracking import step

# Below this participation a line can't excite a mode.
EXCITED = 1e-4
_CLOSE = 1e-13
# An eigenpair is refined until q, of length 1, moves by less: what is left of s is of second order in it.
_SAME = 1e-10
_FACTORISATIONS = 8
_STEPS = 6
# A veering narrower than this share of the speed range is drawn as a crossing.
_NARROWEST = 2.0**-16
# A mode that ends (it stops to oscillate) is looked for down to this share.
_END = 2.0**-10


def track(
    family: SpeedModes, group: int, speeds: np.ndarray, watched: int
) -> tuple[np.ndarray, list[float], list[float]]:
    """Chain the modes at ascending speeds (k,) in rad/s.

    Args:
        family: the modes at any speed; group: number of the group of dofs.
        speeds: ascending; tables of bearings may have kinks at these speeds only.
        watched: how many of the lowest modes at a speed must be followed without doubt.

    Returns:
        (speeds, chains) place of each chain's mode at a speed, -1 where it doesn't oscillate; the speeds that were put between,
        and those at which two modes stayed hard to tell, in rad/s.
    """
    halved: list[float] = []
    unsure: list[float] = []
    span = abs(speeds[-1] - speeds[0])

    def modes(speed: float) -> Eigen:
        return family.at(speed)[group]

    def followed(chain: np.ndarray, partner: np.ndarray) -> np.ndarray:
        """The partner of each member of a chain, -1 where there is none."""
        return np.where(chain >= 0, partner[np.maximum(chain, 0)], -1) if len(partner) else np.full(len(chain), -1)

    def link(a: float, b: float) -> np.ndarray:
        """Partner at b of each mode at a (m_a,), over as many steps as it takes."""
        left = modes(a)
        right = modes(b)
        width = abs(b - a)
        partner, doubt = step(left, right, b - a, _NARROWEST * span)
        inner = np.arange(len(left.s)) < watched
        inner |= (partner >= 0) & (partner < watched)
        taken = np.isin(np.arange(len(right.s)), partner)
        ended = np.any(inner & (partner < 0)) or not taken[:watched].all()
        if not (np.any(doubt & inner & (partner >= 0)) or (ended and width > _END * span)):
            return partner
        middle = 0.5 * (a + b)
        if width <= _NARROWEST * span:
            unsure.append(middle)
            return partner
        halved.append(middle)
        return followed(link(a, middle), link(middle, b))

    chains = [np.arange(len(modes(speeds[0]).s))]
    for a, b in itertools.pairwise(speeds):
        here = followed(chains[-1], link(float(a), float(b)))
        new = np.setdiff1d(np.arange(len(modes(b).s)), here)
        chains = [np.append(row, np.full(len(new), -1)) for row in chains]
        chains.append(np.append(here, new))
    return np.array(chains), halved, unsure


@dataclass(frozen=True)
class Chain:
    """One branch: its group, and s and coordinates q in the group's basis at each speed; NaN where it doesn't oscillate."""

    group: int
    s: np.ndarray
    q: np.ndarray


# Where a function of a branch is zero: speed, eigenvalue, coordinates in the group's basis.
Root = tuple[float, complex, np.ndarray]
Measure = Callable[[complex, float], float]


def roots(modes: SpeedModes, chains: Sequence[Chain], speeds: np.ndarray, branch: int, measure: Measure) -> list[Root]:
    """Speeds at which `measure(s, speed)` of a branch changes sign, and where it is zero at a speed of the track above 0."""
    chain = chains[branch]
    values = np.array([measure(s, w) if np.isfinite(s) else np.nan for s, w in zip(chain.s, speeds, strict=True)])
    found = []
    for k in range(len(speeds) - 1):
        fa, fb = values[k : k + 2]
        if not (fa * fb < 0.0 or (fb == 0.0 and fa != 0.0)):
            continue
        a, b = (float(speed) for speed in speeds[k : k + 2])
        s = chain.s[k]
        q = chain.q[k]
        for _ in range(60):
            w = b - fb * (b - a) / (fb - fa) if fb != fa else 0.5 * (a + b)
            share = (w - speeds[k]) / (speeds[k + 1] - speeds[k])
            guess = (1.0 - share) * chain.s[k] + share * chain.s[k + 1]
            s, q = _nearest(modes, chain, w, guess, k, share)
            f = measure(s, w)
            if f == 0.0 or abs(b - a) <= _CLOSE * max(abs(a), abs(b)) or abs(f) <= _CLOSE * abs(s):
                break
            if f * fb < 0.0:
                a = b
                fa = fb
            else:  # Illinois: the end that stays counts half
                fa = 0.5 * fa
            b = w
            fb = f
        found.append((float(w), s, q))
    return found


def _nearest(
    modes: SpeedModes, chain: Chain, speed: float, guess: complex, k: int, share: float
) -> tuple[complex, np.ndarray]:
    """The branch at a speed between two of the track: refined from the nearer end's vector, or searched among all modes there."""
    pencil = modes.pencil(chain.group, speed)
    s, q = refined(pencil, guess, chain.q[k] if share < 0.5 else chain.q[k + 1])
    gap = abs(chain.s[k + 1] - chain.s[k]) + 1e-6 * abs(guess)
    if abs(s - guess) <= gap:
        return s, q
    found = modes.at(speed)[chain.group]
    best = int(np.argmin(np.abs(found.s - guess)))
    return complex(found.s[best]), found.q[:, best]


def refined(pencil: Pencil, s: complex, q: np.ndarray) -> tuple[complex, np.ndarray]:
    """The eigenpair next to s and q, from one factorisation at s (residual inverse iteration, Neumaier 1985).

    After a step of inverse iteration, u = Q(s)^-1 Q'(s) q, the eigenvalue follows from p^H Q(s') u = 0 with p = Q(s)^-H q, and
    u <- u - Q(s)^-1 Q(s') u leaves the share |s' - s| / |s'' - s| of its error, s'' the next eigenvalue.
    """
    for _ in range(_FACTORISATIONS):
        lu, pivots, singular = zgetrf(pencil.at(s))
        if singular:
            break
        u, _ = zgetrs(lu, pivots, 2.0 * s * (pencil.M @ q) + pencil.D @ q)
        p, _ = zgetrs(lu, pivots, q, trans=2)
        s = s - np.vdot(q, q) / np.vdot(q, u)
        q = u / np.linalg.norm(u)
        for _ in range(_STEPS):
            forms = (pencil.M @ q, pencil.D @ q, pencil.K @ q)
            a, b, c = (np.vdot(p, form) for form in forms)
            s = s - (a * s * s + b * s + c) / (2.0 * a * s + b)
            step, _ = zgetrs(lu, pivots, s * s * forms[0] + s * forms[1] + forms[2])
            # Close to s the factors take rounding for more of q itself.
            step = step - q * np.vdot(q, step)
            q = q - step
            q = q / np.linalg.norm(q)
            if np.linalg.norm(step) <= _SAME:
                return complex(s), q
    return complex(s), q


def participation(line: ExcitationOrder, seen: Portraits, k: int) -> float:
    """Share of the exciting meshes in the strain energy of mode k, or of the exciting shafts in its kinetic energy.

    First order of a shaft is unbalance, see `driven_by_unbalance`. Other orders of a shaft may act in any motion.
    """
    if line.kind != "shaft":
        strain = seen.energies.strain
        return sum(float(strain[f"meshes.{name}"][k]) for name in line.parts if f"meshes.{name}" in strain)
    if _is_unbalance(line):
        return sum(driven_by_unbalance(seen, name, k) for name in line.parts)
    kinetic = seen.energies.kinetic_by_shaft.items()
    return sum(float(share[k]) for name in line.parts for (shaft, _), share in kinetic if shaft == name)


def driven_by_unbalance(seen: Portraits, shaft: str, k: int) -> float:
    """Share of forward whirl of a shaft in the kinetic energy of mode k: (1 + w)/2 of its bending, w the net sense.

    Unbalance turns with its shaft, so it drives the forward part of an orbit only.
    """
    share = seen.energies.kinetic_by_shaft.get((shaft, "bending"))
    return 0.0 if share is None else float(share[k] * 0.5 * (1.0 + seen.whirl.net[shaft][k]))


def _is_unbalance(line: ExcitationOrder) -> bool:
    return line.kind == "shaft" and line.name.endswith(" 1x")


def whirl_for(line: ExcitationOrder, seen: Portraits, k: int) -> str:
    """Sense of whirl of mode k for the shaft whose line it is; for a mesh, for the shaft that bends most.

    Two shafts of one gearbox turn in opposite senses, so that one orbit is forward for one of them and backward for the other. Of
    several shafts with one line it is the one whose unbalance drives the mode.
    """
    if line.kind != "shaft":
        return seen.words[k]
    among = line.parts
    if _is_unbalance(line):
        driven = {name: driven_by_unbalance(seen, name, k) for name in line.parts}
        most = max(driven, key=lambda name: driven[name])
        among = (most,) if driven[most] >= EXCITED else among
    return whirl_word_among(seen.whirl, seen.energies, among, k)


def crossings(
    modes: SpeedModes,
    shapes: BasisShapes,
    chains: Sequence[Chain],
    speeds: np.ndarray,
    lines: Sequence[ExcitationOrder],
) -> tuple[Crossing, ...]:
    """All crossings of branches and lines, by speed."""
    hits: list[tuple[ExcitationOrder, int, Root]] = []
    for line in lines:

        def measure(s: complex, speed: float, order: float = line.order) -> float:
            return float(modes.damped(np.array([s]))[0].imag - order * abs(speed))

        for branch in range(len(chains)):
            hits += [(line, branch, root) for root in roots(modes, chains, speeds, branch, measure)]
    if not hits:
        return ()
    columns = [shapes.coordinates(chains[branch].group, q[:, None]) for _, branch, (_, _, q) in hits]
    seen = shapes.portraits(np.hstack(columns), np.array([speed for _, _, (speed, _, _) in hits]))
    found = []
    for place, (line, branch, (speed, s, _)) in enumerate(hits):
        s = modes.damped(np.array([s]))[0]
        share = participation(line, seen, place)
        found.append(
            Crossing(
                line.name,
                branch + 1,
                speed,
                float(s.imag) / (2.0 * np.pi),
                float(-s.real / abs(s)) + 0.0,
                whirl_for(line, seen, place),
                share,
                share >= EXCITED,
            )
        )
    return tuple(sorted(found, key=lambda item: (abs(item.speed), item.frequency_hz)))


def margins(
    lines: Sequence[ExcitationOrder], found: Sequence[Crossing], speed: float, s: np.ndarray, seen: Portraits
) -> tuple[Margin, ...]:
    """The mode next to each line at the operating speed; s (b,) are the branches there, NaN where one has none."""
    table = []
    known = np.flatnonzero(np.isfinite(s))
    top = float(s[known].imag.max(initial=0.0)) / (2.0 * np.pi)
    for line in lines:
        frequency = line.frequency_hz(speed)
        shares = {int(b): participation(line, seen, place) for place, b in enumerate(known)}
        able = [b for b, share in shares.items() if share >= EXCITED]
        speeds = [item.speed for item in found if item.line == line.name and item.excited]
        nearest = min(speeds, key=lambda value: abs(value - speed), default=float("nan"))
        if not able or frequency > top:
            table.append(Margin(line.name, frequency, 0, float("nan"), float("nan"), "", 0.0, nearest))
            continue
        best = min(able, key=lambda b: abs(s[b].imag / (2.0 * np.pi) - frequency))
        mode = float(s[best].imag / (2.0 * np.pi))
        whirl = whirl_for(line, seen, int(np.flatnonzero(known == best)[0]))
        table.append(Margin(line.name, frequency, best + 1, mode, mode / frequency - 1.0, whirl, shares[best], nearest))
    return tuple(table)
