"""How the gears of a train are put together: the angle of every gear, and whether the loops close.

With theta the direction of a tooth's middle, the pitch point lies at

    a_p = z_p (psi - theta_p) / 2 pi    and    a_g = z_g (psi + pi - theta_g) / 2 pi

pitches from a tooth of pinion and gear. A tooth of one stands in a space of the other when a_p + a_g + 1/2 is whole. That
fixes the gears one after the other, starting at the reference shaft; the last mesh of a loop asks for a clocking of its
gear on the shaft, or leaves a rest. Parker and Lin, J. Mech. Design 126 (2004) 525, for planets.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from rotorgear.model.layout.gear_layout import GearLayout
from rotorgear.model.layout.mesh_layout import MeshLayout
from rotorgear.model.layout.train import Train


@dataclass(frozen=True)
class Loop:
    """How a loop closes at its last mesh.

    Attributes:
        mesh: the mesh that closes the loop; gear: the gear whose place on its shaft was left to close it, "" where none was.
        clocking: angle of that gear on its shaft in rad, between plus and minus half its pitch.
        rest: what is missing with the clockings of the file (0 for the gear that closes it), in pitches, -1/2 to 1/2.
    """

    mesh: str
    gear: str
    clocking: float
    rest: float


@dataclass
class Assembly:
    """Angles (rad) when the mark of the reference shaft is at +x.

    Attributes:
        shaft: direction of the mark of each shaft that meshes and couplings reach.
        clocking: gear -> angle of a tooth's middle from the mark of its shaft, where it is not 0.
        loops: how each loop closes.
    """

    shaft: dict[str, float]
    clocking: dict[str, float]
    loops: list[Loop] = field(default_factory=list)

    def angle(self, gear: GearLayout) -> float:
        """theta, direction of a tooth's middle."""
        return self.shaft[gear.shaft] + self.clocking.get(gear.name, 0.0)


def put_together(
    train: Train, meshes: Iterable[MeshLayout], rigid: Iterable[tuple[str, str]], clocking: Mapping[str, float]
) -> Assembly:
    """Turn every shaft so that the teeth fit, from the reference shaft outwards.

    Args:
        train: the order in which shafts follow each other.
        meshes: those of the model.
        rigid: pairs of shafts that couplings keep at one angle.
        clocking: gear -> clocking that the file gives (rad).
    """
    waiting = [mesh for mesh in meshes if mesh.has_teeth]
    done = Assembly({train.reference: 0.0}, dict(clocking))
    couplings = list(rigid)
    fixed: set[str] = set()  # gears that a mesh holds already: they are not free to close a loop
    while True:
        for first, second in couplings:
            for one, other in ((first, second), (second, first)):
                if one in done.shaft:
                    done.shaft.setdefault(other, done.shaft[one])
        if not waiting:
            return done
        reached = {mesh.name: sum(gear.shaft in done.shaft for gear in mesh.gears) for mesh in waiting}
        ready = [mesh for mesh in waiting if reached[mesh.name]]
        if not ready:
            done.shaft[waiting[0].pinion.shaft] = 0.0  # a part of the train of its own
            continue
        # The walk goes outwards: a loop is closed by the mesh farthest from the input.
        open_ones = [mesh for mesh in ready if reached[mesh.name] == 1]
        mesh = min(open_ones or ready, key=lambda mesh: min(train.depth[gear.shaft] for gear in mesh.gears))
        waiting.remove(mesh)
        if reached[mesh.name] == 2:
            done.loops.append(_closed(done, mesh, fixed))
        else:
            wanted, known = mesh.gears if mesh.gear.shaft in done.shaft else (mesh.gear, mesh.pinion)
            fit = _pitches(done, mesh, known) % 1.0 + 0.5
            tooth = _towards_pitch_point(mesh, wanted) + 2.0 * math.pi / (wanted.part.teeth or 1) * fit
            done.shaft[wanted.shaft] = tooth - done.clocking.get(wanted.name, 0.0)
        fixed |= {gear.name for gear in mesh.gears}


def _closed(done: Assembly, mesh: MeshLayout, fixed: set[str]) -> Loop:
    """Close a loop by the clocking of a gear that is free yet, or leave a rest."""
    rest = _wrapped(sum(_pitches(done, mesh, gear) for gear in mesh.gears) + 0.5, 1.0)
    rest = 0.0 if abs(rest) < 1e-9 else rest
    for gear in mesh.gears:
        if gear.name not in fixed and gear.name not in done.clocking:
            pitch = 2.0 * math.pi / (gear.part.teeth or 1)
            done.clocking[gear.name] = _wrapped(pitch * rest, pitch)
            return Loop(mesh.name, gear.name, done.clocking[gear.name], rest)
    return Loop(mesh.name, "", 0.0, rest)


def _pitches(done: Assembly, mesh: MeshLayout, gear: GearLayout) -> float:
    """a_p or a_g: pitches from a tooth of a gear to the pitch point."""
    return (gear.part.teeth or 0) * (_towards_pitch_point(mesh, gear) - done.angle(gear)) / (2.0 * math.pi)


def _towards_pitch_point(mesh: MeshLayout, gear: GearLayout) -> float:
    """Direction of the pitch point from a gear's axis."""
    return mesh.psi + (math.pi if gear is mesh.gear else 0.0)


def _wrapped(value: float, period: float) -> float:
    return value - period * round(value / period)
