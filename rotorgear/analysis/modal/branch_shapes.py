"""What modes of a reduced basis look like: coordinates of modal mass 1, energy shares, whirl, for many modes at once."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np

from rotorgear.analysis.common.stations import shapes_at_stations
from rotorgear.analysis.modal.describe import describe
from rotorgear.analysis.modal.energies import Energies, mode_energies
from rotorgear.analysis.modal.planet_classes import PlanetClasses, classes_of
from rotorgear.analysis.modal.whirl import Whirl, whirl_of, whirl_words
from rotorgear.results.modal import WHIRL_WORDS
from rotorgear.solvers.sparse.entries import column_forms
from rotorgear.system.system import System

# Numbers of shapes that are held at once, at most.
_CHUNK = 4_000_000


@dataclass(frozen=True)
class Portraits:
    """Energies and whirl of m modes."""

    energies: Energies
    whirl: Whirl

    @cached_property
    def words(self) -> tuple[str, ...]:
        """Whirl of the shaft that bends most, as in a modal result."""
        return whirl_words(self.whirl, self.energies)


class BasisShapes:
    """The basis of a system at all its dofs, nodes and stations.

    Args:
        system: the system; parts: basis of each group over the free dofs, (n, r_g).
    """

    def __init__(self, system: System, parts: list[np.ndarray]) -> None:
        self.system = system
        self.offsets = np.cumsum([0, *(V.shape[1] for V in parts)])
        whole = np.hstack(parts)
        self.mass = whole.T @ (system.mass @ whole)
        self.everything = np.asarray(system.dofs.expand(whole))
        self.nodes, self.stations = shapes_at_stations(system, self.everything)

    def coordinates(self, group: int, q: np.ndarray) -> np.ndarray:
        """Coordinates (r, m) in the whole basis of modes q (r_g, m) of one group, of modal mass 1."""
        own = slice(*self.offsets[group : group + 2])
        norm = np.sqrt(np.abs(column_forms(self.mass[own, own], q)))
        whole = np.zeros((int(self.offsets[-1]), q.shape[1]), complex)
        whole[own] = q / np.where(norm > 0.0, norm, 1.0)
        return whole

    def portraits(self, coordinates: np.ndarray, speeds: np.ndarray, known: float = 0.0) -> Portraits:
        """Energies and whirl of modes (r, m) at speeds (m,) in rad/s; at `known` the matrices of all parts are known."""
        batches = self._batches(speeds)
        if not batches:
            return self._portraits(coordinates, np.array([known]))
        back = np.argsort(np.concatenate(batches), kind="stable")
        found = [self._portraits(coordinates[:, own], speeds[own]) for own in batches]

        def join(tables: list[dict[Any, np.ndarray]]) -> dict[Any, np.ndarray]:
            return {key: np.concatenate([table[key] for table in tables])[back] for key in tables[0]}

        energies = [[getattr(part.energies, item.name) for part in found] for item in fields(Energies)]
        whirl = Whirl(join([part.whirl.net for part in found]), join([part.whirl.numbers for part in found]))
        return Portraits(Energies(*map(join, energies)), whirl)

    def classes(self, coordinates: np.ndarray, speeds: np.ndarray, energies: Energies) -> PlanetClasses:
        """The classes of modes (r, m) of a model with planets at speeds (m,) in rad/s, with their energies."""
        own = energies.kinetic_by_shaft
        width = max(1, _CHUNK // max(self.everything.shape[0], 1))
        found = []
        for first in range(0, max(len(speeds), 1), width):
            part = slice(first, first + width)
            q = self.everything @ coordinates[:, part]
            found.append(classes_of(self.system, q, {key: of[part] for key, of in own.items()}, speeds[part]))

        def join(tables: list[dict[str, np.ndarray]]) -> dict[str, np.ndarray]:
            return {key: np.concatenate([table[key] for table in tables]) for key in tables[0]}

        words = tuple(text for part in found for text in part.words)
        energy, shift, share = (
            join([getattr(part, name) for part in found]) for name in ("energy", "shift", "seen_share")
        )
        return PlanetClasses(energy, words, shift, share)

    def descriptions(self, coordinates: np.ndarray, speeds: np.ndarray) -> tuple[str, ...]:
        """One line for each mode."""
        lines: list[str] = []
        nothing = np.zeros(1, bool)
        for k in range(coordinates.shape[1]):
            one = coordinates[:, [k]]
            energies = self._portraits(one, speeds[[k]]).energies
            lines += describe(self.system, self.everything @ one, energies, nothing, nothing)
        return tuple(lines)

    def _batches(self, speeds: np.ndarray) -> list[np.ndarray]:
        """Numbers of modes that are looked at together: of one speed where bearings depend on it."""
        order = np.arange(len(speeds))
        if self.system.has_tables:
            return [order[speeds == speed] for speed in dict.fromkeys(speeds.tolist())]
        width = max(1, _CHUNK // max(self.everything.shape[0], 1))
        still = speeds == 0.0  # at standstill nothing whirls
        return [own[k : k + width] for own in [order[still], order[~still]] for k in range(0, len(own), width)]

    def _portraits(self, coordinates: np.ndarray, speeds: np.ndarray) -> Portraits:
        speed = float(speeds[0]) if len(speeds) else 0.0
        rigid = np.zeros(coordinates.shape[1], bool)
        energies = mode_energies(self.system, speed, self.everything @ coordinates, rigid)
        shapes = np.asarray(self.stations[: len(self.system.nodes)] @ coordinates)
        return Portraits(energies, whirl_of(self.system, shapes, speed))


def whirl_numbers(words: tuple[str, ...]) -> np.ndarray:
    """Numbers into `WHIRL_WORDS`, (m,)."""
    return np.array([WHIRL_WORDS.index(word) for word in words], dtype=np.int8)
