"""Which teeth of a gear are in its meshes at one time.

With phi = z s (theta - psi') the mesh phase of a gear that is not folded back into one turn, theta being the angle of its tooth 0
and psi' where the flank of that tooth touches at the pitch point, the tooth at the pitch point is number phi / 2 pi. Teeth count
in the order in which they come into mesh. For pinion and gear, with the pinion's half tooth thickness h at the working circle in
pitches, and T the sense of the torque on it,

    phi_1 / 2 pi = s_1 [z_1 (theta_1 - psi) / 2 pi + T h],
    phi_2 / 2 pi = s_2 [z_2 (theta_2 - psi - pi) / 2 pi + T (1/2 - h)],

which differ by a whole number where the teeth fit (`assembly.py`). A map of loaded teeth lets tooth 0 of both gears mesh first.
A gear whose teeth differ does so in its first mesh; in the others its map begins with the teeth that stand there then.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from rotorgear.model.layout.mesh_layout import MeshLayout

if TYPE_CHECKING:
    from rotorgear.model.layout.gear_layout import GearLayout
    from rotorgear.model.layout.layout import Layout


class Pressed(Protocol):
    """Which flanks of a mesh carry: sense of the torque on the pinion about +z, and whether the pinion drives."""

    @property
    def torque_sense(self) -> int:
        """+1 or -1."""

    @property
    def pinion_drives(self) -> bool:
        """Whether it turns in the sense of that torque."""


@dataclass(frozen=True)
class ToothNumbers:
    """Where maps of loaded teeth begin.

    Attributes:
        ahead: mesh -> base pitches by which its map is ahead when the reference mark is at +x; 0 where none is named.
        unknown: gears whose teeth differ and whose meshes can't all begin with the teeth that stand there.
    """

    ahead: Mapping[str, int]
    unknown: tuple[str, ...]


def tooth_numbers(layout: Layout, direction: int, pressed: Mapping[str, Pressed]) -> ToothNumbers:
    """Find them for meshes whose flanks are pressed so."""
    wanted: dict[str, list[tuple[GearLayout, int]]] = {}
    unknown = []
    for name, meshes in unlike_gears(layout).items():
        numbers = {mesh.name: _tooth(layout, direction, mesh, name, pressed[mesh.name]) for mesh in meshes}
        # Where the gear drives in one mesh and the pinion in another, the map of one runs against the order of the teeth.
        senses = {pressed[mesh.name].pinion_drives for mesh in meshes}
        if len(senses) > 1 or None in numbers.values():
            unknown.append(name)
            continue
        first = numbers[meshes[0].name]
        for mesh in meshes:
            number = numbers[mesh.name]
            assert number is not None
            assert first is not None
            wanted.setdefault(mesh.name, []).append((layout.gear(name), number - first))
    ahead = {}
    for mesh_name, gears in wanted.items():
        found = _together([(number, gear.part.teeth or 1) for gear, number in gears])
        if found is None:
            unknown += [gear.name for gear, _ in gears]
        else:
            ahead[mesh_name] = found
    return ToothNumbers(ahead, tuple(dict.fromkeys(unknown)))


def unlike_gears(layout: Layout) -> dict[str, list[MeshLayout]]:
    """Gears whose teeth differ, and their meshes of loaded teeth where these are several."""
    meshes: dict[str, list[MeshLayout]] = {}
    for mesh in layout.meshes:
        if mesh.part.stiffness == "tooth_fe":
            for gear in mesh.gears:
                if gear.flank.single_teeth or (gear.flanks_differ and gear.flank_of("right").single_teeth):
                    meshes.setdefault(gear.name, []).append(mesh)
    return {name: found for name, found in meshes.items() if len(found) > 1}


def _tooth(layout: Layout, direction: int, mesh: MeshLayout, name: str, state: Pressed) -> int | None:
    """Number of the tooth of a gear that stands at the pitch point of a mesh; None where the file gives the phase instead."""
    is_pinion = mesh.pinion.name == name
    gear = mesh.pinion if is_pinion else mesh.gear
    shaft = layout.assembly.shaft
    if mesh.part.phase is not None or mesh.pinion.shaft not in shaft or mesh.gear.shaft not in shaft:
        return None

    def turns(gear: GearLayout, towards: float, half: float) -> float:
        sense = direction * layout.train.sense(gear.shaft)
        pitches = (gear.part.teeth or 0) * (layout.assembly.angle(gear) - towards) / (2.0 * math.pi)
        return sense * (pitches + state.torque_sense * half)

    half = mesh.half_tooth * (mesh.pinion.part.teeth or 0) / (2.0 * math.pi)
    phase = turns(mesh.pinion, mesh.psi, half) % 1.0
    if is_pinion:
        return round(turns(gear, mesh.psi, half) - phase)
    return round(turns(gear, mesh.psi + math.pi, 0.5 - half) - phase)


def _together(wanted: list[tuple[int, int]]) -> int | None:
    """The smallest number with the wanted rests (rest, divisor) by all divisors; None where there is none."""
    period = math.lcm(*(divisor for _, divisor in wanted))
    rest, divisor = wanted[0]
    fits = (n for n in range(rest % divisor, period, divisor) if all((n - r) % z == 0 for r, z in wanted))
    return next(fits, None)
