"""One line a person can read for each mode: which shafts move in which motion, together or against each other."""

from __future__ import annotations

import numpy as np

from rotorgear.analysis.modal.casing_words import casing_words
from rotorgear.analysis.modal.energies import Energies
from rotorgear.system.dofs import MOTION_DOFS
from rotorgear.system.system import System

# A second shaft is named when it has at least this part of the first one's energy in the same motion.
_COMPANION = 0.5
# So many companions are named, the others counted.
_MOST_NAMED = 3
# A mode whose first motion has less than this share is described by its two strongest motions.
_DOMINANT = 0.5


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
    together: list[str] = []
    against: list[str] = []
    for _, (name, _) in mates[:_MOST_NAMED]:
        (together if _agree(system, shape, motion, shaft, name) >= 0 else against).append(name)
    if len(mates) > _MOST_NAMED:
        (together or against).append(f"{len(mates) - _MOST_NAMED} more")
    if together:
        text += f" with {_and(together)}"
    if against:
        text += f" against {_and(against)}"
    text += f", {100.0 * total:.0f} %"
    if total < _DOMINANT:
        rest = [item for item in ranked[1:] if item not in mates]
        if rest:
            text += f"; {_words(system, q, *rest[0][1])}, {100.0 * rest[0][0]:.0f} %"
    return text


def _words(system: System, q: np.ndarray, shaft: str, motion: str) -> str:
    """A motion of a shaft, or of a casing by its address."""
    table, _, name = motion.partition(".")
    if table == "casings":
        return f"casing {name}: {casing_words(system.layout.casing(name), q[system.nodes.of_casing(name)])}"
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
