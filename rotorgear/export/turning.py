"""A gearbox whose carriers turn, at a moment of its motion: everything stands where the train has taken it.

Where the carrier has gone on by an angle a, each shaft has turned by a times the ratio of their speeds, planets stand round by a,
and what of their displacements follows the circle of pins is that of their new directions (`solvers/time/sisters.py`).

A vibration passes through all its phases while the pins are at one place, and is shown slower: from picture to picture go
several periods, and in one that is shown the pins go on to the next place.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from rotorgear.export.attachment import nodes_in_order
from rotorgear.export.layout import display_frames
from rotorgear.export.solids import Solids
from rotorgear.model.layout.carriers import PlanetSet
from rotorgear.model.model import Model
from rotorgear.model.parts.frame import Frame
from rotorgear.results.modal import NodeTable
from rotorgear.solvers.time.sisters import sister_turn, taken_round
from rotorgear.system.planets import turning_carriers

# Kinds of parts whose points go round with their shaft; what holds them has a side that stands still.
_TURNING = ("shaft", "stripe", "gear", "disk", "point mass")
# Share of a shape below which planets have no motion that stays with each of them.
_NOTHING = 1e-6


@dataclass(frozen=True)
class Turning:
    """How the solids of a model go round.

    Attributes:
        model: of the result; nodes: its nodes; solids: where everything stands at the start, with shafts in these frames.
        sets: planets whose carriers turn.
        sense: +1 or -1 of the reference shaft.
    """

    model: Model
    nodes: NodeTable
    solids: Solids
    frames: dict[str, Frame]
    sets: tuple[PlanetSet, ...]
    sense: float

    def leading(self, shape: np.ndarray) -> PlanetSet:
        """The planets that move most in a shape (p, 6)."""
        return max(self.sets, key=lambda planets: float(np.abs(self._of_sisters(planets, shape)).max(initial=0.0)))

    def periods(self, shape: np.ndarray) -> int:
        """Periods after which the picture of a shape (p, 6) comes again, where the pins go on by one place in each.

        Motions that stay with each planet need a whole turn.
        """
        planets = self.leading(shape)
        N = len(planets.planets)
        own = self._of_sisters(planets, shape)
        T = sister_turn(planets.angles)
        mean = np.full((N, N), 1.0 / N)
        rest = np.abs(np.tensordot(np.eye(N) - mean + T @ T, own, axes=1)).max(initial=0.0)
        return N if rest > _NOTHING * np.abs(own).max(initial=0.0) else 1

    def at(self, shape: np.ndarray, periods: float) -> tuple[Solids, np.ndarray]:
        """Solids, and the displacements of the nodes (p, 6) that carry them, so many shown periods after the start."""
        leading = self.leading(shape)
        train = self.model.layout.train
        turn = self.sense * math.copysign(2.0 * math.pi / len(leading.planets), train.ratio(leading.shaft)) * periods
        return self.at_angle(shape, turn / train.ratio(leading.shaft))

    def at_angle(self, shape: np.ndarray, angle: float) -> tuple[Solids, np.ndarray]:
        """The same where the reference shaft has gone on by an angle in rad."""
        train = self.model.layout.train
        moved = np.array(shape)
        for planets in self.sets:
            numbers = self._numbers(planets)
            a = angle * train.ratio(planets.shaft)
            moved[numbers] = taken_round(sister_turn(planets.angles), a, shape[numbers])
        return self._turned(angle), moved

    def _numbers(self, planets: PlanetSet) -> np.ndarray:
        """Numbers (N, k) of the nodes of planets, those of one place in a column."""
        return np.array([nodes_in_order(self.nodes, planet) for planet in planets.planets])

    def _of_sisters(self, planets: PlanetSet, shape: np.ndarray) -> np.ndarray:
        """Displacements (N, k, 3) of planets."""
        return np.asarray(shape[self._numbers(planets)][..., :3])

    def _turned(self, angle: float) -> Solids:
        """The solids where the reference shaft has gone on by an angle in rad."""
        solids = self.solids
        assert solids.axes is not None  # of two planets, one has axes of its own
        layout = self.model.layout
        points = solids.points.copy()
        arm = solids.attachment.arm.copy()
        axes = solids.axes.copy()
        frame = solids.attachment.frame
        kind, shaft = _by_point(solids, solids.kind), _by_point(solids, solids.shaft)
        turning = np.isin(kind, [solids.kind_names.index(name) for name in _TURNING])
        names = list(self.model.shafts)
        for number, name in enumerate(names):
            own = turning & (frame == number) & (shaft == number)
            R = _rotation(angle * layout.turns(name))
            origin = self.frames[name].origin
            points[own] = origin + (points[own] - origin) @ (axes[number] @ R @ axes[number].T).T
            arm[own] = arm[own] @ R.T
        for planets in self.sets:
            carrier = self.frames[planets.shaft]
            R = _rotation(angle * layout.train.ratio(planets.shaft))
            in_space = carrier.axes @ R @ carrier.axes.T
            for planet in planets.planets:
                number = names.index(planet)
                own = shaft == number
                points[own] = carrier.origin + (points[own] - carrier.origin) @ in_space.T
                axes[number] = in_space @ axes[number]
                # The pin below its bearing belongs to the carrier.
                on_carrier = own & (frame == names.index(planets.shaft))
                arm[on_carrier] = arm[on_carrier] @ R.T
        return replace(solids, points=points, axes=axes, attachment=replace(solids.attachment, arm=arm))


def turning_of(model: Model, nodes: NodeTable, solids: Solids, speed: float | None) -> Turning | None:
    """How a model with planets goes round at a speed of the reference shaft in rad/s; None where no carrier turns."""
    sets = turning_carriers(model.layout) if speed else ()
    if not sets:
        return None
    return Turning(model, nodes, solids, display_frames(model), sets, math.copysign(1.0, speed or 1.0))


@dataclass(frozen=True)
class Motion:
    """A vibration of the solids of a result.

    Attributes:
        solids: at the start.
        shape: displacements of the nodes (p, 6), complex; their phase goes on by e^{+i phase}.
        scaled: displacements of the points (P, 3) at the start; scale: their factor.
        turning: how everything goes round beneath; None where no carrier turns.
    """

    solids: Solids
    shape: np.ndarray
    scaled: np.ndarray
    scale: float
    turning: Turning | None = None

    @property
    def periods(self) -> int:
        """Periods after which its picture comes again."""
        return 1 if self.turning is None else self.turning.periods(self.shape)

    @property
    def is_in_phase(self) -> bool:
        """Whether the second half of a period is the first one backwards."""
        return self.turning is None and not np.any(self.scaled.imag)

    def at(self, periods: float) -> tuple[np.ndarray, np.ndarray]:
        """Points (P, 3) at rest and their displacements (P, 3) so many periods after the start."""
        solids, scaled = self.solids, self.scaled
        if self.turning is not None:
            solids, moved = self.turning.at(self.shape, periods)
            scaled = self.scale * solids.displacement(moved)
        phase = 2.0 * math.pi * periods
        return solids.points, scaled.real * math.cos(phase) - scaled.imag * math.sin(phase)


def _rotation(angle: float) -> np.ndarray:
    """About z by an angle in rad, (3, 3)."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def _by_point(solids: Solids, by_cell: np.ndarray) -> np.ndarray:
    """Numbers (P,) of the points from those of their cells (C,); surfaces of parts share no points."""
    found = np.full(len(solids.points), -1)
    for cells, numbers in zip((solids.quads, solids.triangles), np.split(by_cell, [len(solids.quads)]), strict=True):
        found[cells.ravel()] = np.repeat(numbers, cells.shape[1])
    return found
