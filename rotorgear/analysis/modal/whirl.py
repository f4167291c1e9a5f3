"""Sense of whirl of modes: forward where the precession has the sense of a shaft's own spin.

An orbit X, Y (or a tilt tx, ty) sweeps -2 Im(conj(X) Y) about +z. Weighted with the inertia of each degree of freedom and
divided by the same sum of |X|^2 + |Y|^2, a circle gives +-1 and a line 0, for shafts that bend and for disks that only tilt.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from rotorgear.analysis.modal.energies import Energies
from rotorgear.results.modal import WHIRL_WORDS
from rotorgear.system.system import System

# Below this share of the inertia-weighted orbit a mode is called planar.
_PLANAR = 0.02
# Nodes that sweep against the rest with more than this share make a mode mixed.
_MIXED = 0.05
# A shaft with less of the kinetic energy in bending does not give the mode its sense.
_LEAST_BENDING = 0.05
# With less than this its orbit is rounding.
_MOVES = 1e-8


@dataclass(frozen=True)
class Whirl:
    """Precession of m modes in the sense of each shaft's own spin.

    Attributes:
        net: shaft -> (m,) from -1 (backward circle) to 1 (forward circle); 0 for a shaft at rest.
        numbers: shaft -> (m,) into `WHIRL_WORDS`; that of "" where the shaft does not bend.
    """

    net: dict[str, np.ndarray]
    numbers: dict[str, np.ndarray]


def orbits(system: System, inertia: np.ndarray, shapes: np.ndarray, shaft: str) -> tuple[np.ndarray, np.ndarray]:
    """Swept area and size of the orbits of a shaft's nodes, inertia-weighted, each (nodes, m).

    `inertia` (6 p,) is the diagonal of the mass matrix over the nodes, `shapes` (p, 6, m).
    """
    numbers = system.nodes.on_shaft(shaft)
    weight = inertia.reshape(-1, 6)[numbers][:, [0, 3], None]
    first = shapes[numbers][:, [0, 3]]
    second = shapes[numbers][:, [1, 4]]
    swept = -2.0 * np.sum(weight * np.imag(first.conj() * second), axis=1)
    return swept, np.sum(weight * (np.abs(first) ** 2 + np.abs(second) ** 2), axis=1)


def whirl_of(system: System, shapes: np.ndarray, speed: float) -> Whirl:
    """Whirl of modes with shapes (p, 6, m) at a speed of the input shaft.

    A mode is forward for a shaft when it precesses as that shaft itself turns, not as the input does. "mixed" has nodes on the
    shaft that sweep in either sense, "planar" hardly sweeps at all.
    """
    modes = shapes.shape[2]
    net = {name: np.zeros(modes) for name in system.model.shafts}
    numbers = {name: np.zeros(modes, np.int8) for name in system.model.shafts}
    if not speed or not system.model.has("bending"):
        return Whirl(net, numbers)
    inertia = system.nodal_inertia
    for name in system.model.shafts:
        spin = np.sign(system.train.ratio(name) * speed)
        if spin == 0.0:
            continue
        swept, size = orbits(system, inertia, shapes, name)
        total = size.sum(axis=0)
        moves = total > 0.0
        net[name] = spin * np.where(moves, swept.sum(axis=0) / np.where(moves, total, 1.0), 0.0)
        area = np.abs(swept).sum(axis=0)
        one_way = np.maximum(swept, 0.0).sum(axis=0)
        other_way = np.maximum(-swept, 0.0).sum(axis=0)
        mixed = np.minimum(one_way, other_way) > _MIXED * area
        # The first that holds counts.
        holds = [~moves, area < _PLANAR * total, mixed, net[name] > 0.0]
        words = [WHIRL_WORDS.index(word) for word in ("", "planar", "mixed", "forward")]
        numbers[name] = np.select(holds, words, WHIRL_WORDS.index("backward")).astype(np.int8)
    return Whirl(net, numbers)


def bending_shares(energies: Energies, shafts: Iterable[str]) -> dict[str, np.ndarray]:
    """Share of each shaft's bending in the kinetic energy of each mode, of those that bend: shaft -> (m,)."""
    found = {name: energies.kinetic_by_shaft.get((name, "bending")) for name in shafts}
    return {name: share for name, share in found.items() if share is not None}


def whirl_words(whirl: Whirl, energies: Energies) -> tuple[str, ...]:
    """One word a mode, for the shaft with the most bending: forward, backward, mixed, planar, or ""."""
    shares = bending_shares(energies, whirl.numbers)
    if not shares:
        return ("",) * len(next(iter(whirl.net.values())))
    names = list(shares)
    table = np.array([shares[name] for name in names])
    most = table.argmax(axis=0)
    words = (WHIRL_WORDS[whirl.numbers[names[n]][k]] for k, n in enumerate(most))
    return tuple(word if bends >= _LEAST_BENDING else "" for word, bends in zip(words, table.max(axis=0), strict=True))


def whirl_word_among(whirl: Whirl, energies: Energies, shafts: Iterable[str], mode: int) -> str:
    """The word of one mode for that one of some shafts which bends most; "" where none of them does."""
    shares = {name: float(share[mode]) for name, share in bending_shares(energies, shafts).items()}
    name = max(shares, key=lambda key: shares[key], default="")
    return WHIRL_WORDS[whirl.numbers[name][mode]] if name and shares[name] >= _MOVES else ""
