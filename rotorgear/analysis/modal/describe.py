"""One line a person can read for each mode: which shafts move in which motion, together or against each other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rotorgear.analysis.modal.energies import Energies
from rotorgear.system.dofs import MOTION_DOFS
from rotorgear.system.system import System

if TYPE_CHECKING:
    from rotorgear.casings.reduced_body import ReducedBody

# A second shaft is named when it has at least this part of the first one's energy in the same motion.
_COMPANION = 0.5
# Companions that are named, the others counted.
_MOST_NAMED = 3
# A mode whose first motion has less than this share is described by its two strongest motions.
_DOMINANT = 0.5
# From this share of its kinetic energy on a casing moves as a whole.
_AS_A_WHOLE = 0.5
_AXES = "xyz"


def describe(
    system: System, q: np.ndarray, energies: Energies, rigid: np.ndarray, real_root: np.ndarray
) -> tuple[str, ...]:
    """Return a line for each of m modes from the displacements q (a, m) of all dofs and their energies.

    `rigid` (m,) marks rigid-body modes; `real_root` (m,) those that do not oscillate.
    """
    lines = []
    for mode in range(q.shape[1]):
        shares = [(float(share[mode]), key) for key, share in energies.kinetic_by_shaft.items()]
        # Rounded, so that equal shares of equal shafts keep the order of the file.
        ranked = sorted(shares, key=lambda item: -round(item[0], 6))
        text = _line(system, q[:, mode], [item for item in ranked if item[0] > 0.0])
        if rigid[mode]:
            text = f"rigid body: {text}"
        elif real_root[mode]:
            text = f"no oscillation: {text}"
        lines.append(text)
    return tuple(lines)


def _line(system: System, q: np.ndarray, ranked: list[tuple[float, tuple[str, str]]]) -> str:
    """Words for displacements q (a,) from the shares (share, (shaft, motion)) of their kinetic energy, largest first."""
    if not ranked:
        return "no inertia takes part"
    share, (shaft, motion) = ranked[0]
    mates = [item for item in ranked[1:] if item[1][1] == motion and item[0] >= _COMPANION * share]
    shape = q[: 6 * len(system.nodes)].reshape(-1, 6)
    text = _words(system, q, shaft, motion)
    total = share + sum(item[0] for item in mates)
    moving: dict[str, list[str]] = {"with": [], "against": []}
    for _, (name, _) in mates[:_MOST_NAMED]:
        moving["with" if _agree(system, shape, motion, shaft, name) >= 0 else "against"].append(name)
    if len(mates) > _MOST_NAMED:
        (moving["with"] or moving["against"]).append(f"{len(mates) - _MOST_NAMED} more")
    text += "".join(f" {word} {_and(names)}" for word, names in moving.items() if names)
    text += f", {100.0 * total:.0f} %"
    rest = [item for item in ranked[1:] if item not in mates]
    if total < _DOMINANT and rest:
        text += f"; {_words(system, q, *rest[0][1])}, {100.0 * rest[0][0]:.0f} %"
    return text


def _words(system: System, q: np.ndarray, shaft: str, motion: str) -> str:
    """A motion of a shaft, or of a casing by its address."""
    table, _, name = motion.partition(".")
    if table == "casings":
        return f"casing {name}: {_casing_words(system.layout.casing(name), q[system.nodes.of_casing(name)])}"
    if table == "gears":
        p = q[system.nodes.of_body(name)]
        diameters = system.layout.elastic_bodies[name].diameters
        most = max(range(2, int(diameters.max()) + 1), key=lambda n: float(np.sum(np.abs(p[diameters == n]) ** 2)))
        return f"gear {name}: {most} nodal diameters"
    return f"{shaft} {motion}" if shaft else motion


def _and(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def _agree(system: System, shape: np.ndarray, motion: str, first: str, second: str) -> float:
    """Positive where two shafts move together at their largest displacement; torsion counts in each shaft's own sense."""
    dofs = [k for k in MOTION_DOFS[motion] if k in (0, 1, 2, 5)]
    peaks = []
    for name in (first, second):
        displacements = shape[system.nodes.on_shaft(name)][:, dofs]
        peak = displacements[np.argmax(np.sum(np.abs(displacements) ** 2, axis=1))]
        peaks.append(peak * (system.train.sense(name) if motion == "torsion" else 1))
    return float(np.real(np.sum(peaks[0].conj() * peaks[1])))


def _casing_words(body: ReducedBody, shape: np.ndarray) -> str:
    """Words for the coordinates (n,) of a body in a mode, real or complex."""
    whole = _whole_motion(body, shape)
    if whole:
        return whole
    if body.surface is None:
        return "bending"
    # The velocity along the normals decides, as it does for the sound: a wall that only slides does not bend.
    across = np.einsum("i,sij,j->s", shape.conj(), body.surface.motion_of_sides, shape, optimize=True).real
    side = int(np.argmax(across))
    return f"wall at {'-+'[side % 2]}{_AXES[side // 2]} bending"


def _whole_motion(body: ReducedBody, shape: np.ndarray) -> str:
    """The rigid-body motion nearest to a shape in kinetic energy, where it has the larger part of it; else ""."""
    M = body.mass
    R = body.seat_motions
    own = R.T @ M @ R
    parts = np.linalg.solve(own, R.T @ (M @ shape))
    total = float(np.real(np.conj(shape) @ M @ shape))
    if not np.real(np.conj(parts) @ own @ parts) > _AS_A_WHOLE * total:
        return ""
    # Displacement of the point where translation and rotation have no common energy, the centre of mass of what the seats see.
    mass = np.trace(own[:3, :3]) / 3.0
    centre = np.array([own[5, 1] - own[4, 2], own[3, 2] - own[5, 0], own[4, 0] - own[3, 1]]) / (2.0 * mass)
    along = parts[:3] + np.cross(parts[3:], centre)
    inertia = np.diagonal(own)[3:] - mass * (centre @ centre - centre**2)
    energies = np.concatenate([np.diagonal(own)[:3] * np.abs(along) ** 2, inertia * np.abs(parts[3:]) ** 2])
    largest = int(np.argmax(energies))
    return f"moving along {_AXES[largest]}" if largest < 3 else f"rocking about {_AXES[largest - 3]}"
