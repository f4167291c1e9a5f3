"""How the gears of a train are put together: the angle of every gear, and whether the loops close.

With theta the direction of a tooth's middle, the pitch point lies at

    a_p = z_p (psi - theta_p) / 2 pi    and    a_g = z_g (psi + pi - theta_g) / 2 pi

pitches from a tooth of pinion and gear. A tooth of one stands in a space of the other when a_p + a_g + 1/2 is whole. That
fixes the gears one after the other, starting at the reference shaft; the last mesh of a loop asks for a clocking of its
gear on the shaft, or some part of a pitch is missing. Parker and Lin, J. Mech. Design 126 (2004) 525, for planets.

Then it is known, too, which teeth of a gear are in its meshes at one time. With phi = z s (theta - psi') the mesh phase of a
gear that is not folded back into one turn, theta being the angle of its tooth 0 and psi' where the flank of that tooth touches
at the pitch point, the tooth at the pitch point is number phi / 2 pi. Teeth count in the order in which they come into mesh.
For pinion and gear, with the pinion's half tooth thickness h at the working circle in pitches, and T the sense of the torque
on it,

    phi_1 / 2 pi = s_1 [z_1 (theta_1 - psi) / 2 pi + T h],
    phi_2 / 2 pi = s_2 [z_2 (theta_2 - psi - pi) / 2 pi + T (1/2 - h)],

which differ by a whole number where the teeth fit (as above). A map of loaded teeth lets tooth 0 of both gears mesh first.
A gear whose teeth differ does so in its first mesh; in the others its map begins with the teeth that stand there then.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from rotorgear.model.layout.gear_layout import GearLayout
from rotorgear.model.layout.mesh_layout import MeshLayout
from rotorgear.model.layout.train import Train
from rotorgear.model.parts.carrier import written_name


@dataclass
class Assembly:
    """Angles (rad) when the mark of the reference shaft is at +x.

    Attributes:
        shaft: direction of the mark of each shaft that meshes and couplings reach.
        clocking: gear -> angle of a tooth's middle from the mark of its shaft, where it is not 0.
        loops: the mesh that closes each loop; the gear whose place on its shaft was left to close it, "" where none was; and what
            is missing with the clockings of the file, in pitches, -1/2 to 1/2.
    """

    shaft: dict[str, float]
    clocking: dict[str, float]
    loops: list[tuple[str, str, float]] = field(default_factory=list)

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
    every = [mesh for mesh in meshes if mesh.has_teeth]
    waiting = list(every)
    done = Assembly({train.reference: 0.0}, dict(clocking))
    couplings = list(rigid)
    held: dict[str, int] = {}  # shaft -> by which parts of a turn all its meshes let it be put in elsewhere
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
            # The clocking of a gear that is free yet closes the loop; without one a part of a pitch is missing.
            rest = _wrapped(sum(_pitches(done, mesh, gear) for gear in mesh.gears) + 0.5, 1.0)
            rest = 0.0 if abs(rest) < 1e-9 else _next_tooth(done, mesh, rest, held)
            free = [gear for gear in mesh.gears if gear.name not in fixed and gear.name not in done.clocking]
            for gear in free[:1]:
                pitch = 2.0 * math.pi / (gear.part.teeth or 1)
                angle = _wrapped(_side(mesh, gear) * pitch * rest, pitch)
                # Planets are cut as one: all sisters of a gear have its place on their shafts.
                sisters = (one for other in every for one in other.gears)
                alike = {one.name for one in sisters if written_name(one.name) == written_name(gear.name)}
                done.clocking |= dict.fromkeys(alike if gear.carrier_shaft else (gear.name,), angle)
            done.loops.append((mesh.name, free[0].name if free else "", _side(mesh, mesh.pinion) * rest))
        else:
            wanted, known = mesh.gears if mesh.gear.shaft in done.shaft else (mesh.gear, mesh.pinion)
            fit = _pitches(done, mesh, known) % 1.0 + 0.5
            pitch = _side(mesh, wanted) * 2.0 * math.pi / (wanted.part.teeth or 1)
            tooth = _towards_pitch_point(mesh, wanted) + pitch * fit
            done.shaft[wanted.shaft] = tooth - done.clocking.get(wanted.name, 0.0)
        fixed |= {gear.name for gear in mesh.gears}
        for gear in mesh.gears:
            held[gear.shaft] = math.gcd(held.get(gear.shaft, 0), gear.part.teeth or 0)


def _next_tooth(done: Assembly, mesh: MeshLayout, rest: float, held: Mapping[str, int]) -> float:
    """What a loop misses where a stepped planet is put in at those of its teeth that fit best.

    Turned by a part 1/h of a turn, which its other meshes do not see, its gear moves on by z/h pitches here.
    """
    for gear in mesh.gears:
        h = held.get(gear.shaft, 0)
        z = gear.part.teeth or 0
        if gear.carrier_shaft is None or h <= 1 or z % h == 0:
            continue
        side = _side(mesh, gear)
        steps = min(range(h), key=lambda j: abs(_wrapped(rest - side * j * z / h, 1.0)))
        done.shaft[gear.shaft] += steps * 2.0 * math.pi / h
        left = _wrapped(rest - side * steps * z / h, 1.0)
        return 0.0 if abs(left) < 1e-9 else left
    return rest


def _pitches(done: Assembly, mesh: MeshLayout, gear: GearLayout) -> float:
    """a_p or a_g: pitches from a tooth of a gear to the pitch point, of a bevel gear about its axis away from the apex."""
    return (
        _side(mesh, gear)
        * (gear.part.teeth or 0)
        * (_towards_pitch_point(mesh, gear) - done.angle(gear))
        / (2.0 * math.pi)
    )


def _towards_pitch_point(mesh: MeshLayout, gear: GearLayout) -> float:
    """Direction of the pitch point from a gear's axis, in the frame of its shaft."""
    return mesh.gear_psi if gear is mesh.gear else mesh.psi


def _side(mesh: MeshLayout, gear: GearLayout) -> int:
    """-1 of a gear whose teeth pass the pitch point the other way: a ring, and a bevel gear whose z leads to the apex; else 1."""
    if mesh.meeting is None:
        return -1 if gear.part.internal else 1
    return mesh.meeting.sides[1 if gear is mesh.gear else 0]


def _wrapped(value: float, period: float) -> float:
    return value - period * round(value / period)


def tooth_numbers(
    assembly: Assembly,
    meshes: Iterable[MeshLayout],
    direction: int,
    pressed: Mapping[str, tuple[int, bool]],
) -> tuple[dict[str, int], list[str]]:
    """Find where maps of loaded teeth begin.

    Args:
        assembly: angles of the gears.
        meshes: those of the model.
        direction: +1 or -1, sense in which the reference shaft turns.
        pressed: mesh -> which flanks carry: the sense of the torque on the pinion about +z, and whether the pinion drives.

    Returns:
        Mesh -> base pitches by which its map is ahead when the reference mark is at +x, 0 where none is named; and the gears
        whose teeth differ and whose meshes can't all begin with the teeth that stand there.
    """
    wanted: dict[str, list[tuple[GearLayout, int]]] = {}
    unknown = []
    for name, shared in unlike_gears(meshes).items():
        numbers = [_tooth(assembly, direction, mesh, name, pressed[mesh.name][0]) for mesh in shared]
        # Where the gear drives in one mesh and the pinion in another, the map of one runs against the order of the teeth.
        senses = {pressed[mesh.name][1] for mesh in shared}
        known = [number for number in numbers if number is not None]
        if len(senses) > 1 or len(known) < len(numbers):
            unknown.append(name)
            continue
        for mesh, number in zip(shared, known, strict=True):
            gear = mesh.pinion if mesh.pinion.name == name else mesh.gear
            wanted.setdefault(mesh.name, []).append((gear, number - known[0]))
    ahead = {}
    for mesh_name, gears in wanted.items():
        # The smallest number with the wanted rests by all numbers of teeth, if there is one.
        rests = [(number, gear.part.teeth or 1) for gear, number in gears]
        period = math.lcm(*(teeth for _, teeth in rests))
        found = next((n for n in range(period) if all((n - rest) % teeth == 0 for rest, teeth in rests)), None)
        if found is None:
            unknown += [gear.name for gear, _ in gears]
        else:
            ahead[mesh_name] = found
    return ahead, unknown


def unlike_gears(meshes: Iterable[MeshLayout]) -> dict[str, list[MeshLayout]]:
    """Gears whose teeth differ, and their meshes of loaded teeth where these are several."""
    found: dict[str, list[MeshLayout]] = {}
    for mesh in meshes:
        if mesh.part.stiffness == "tooth_fe":
            for gear in mesh.gears:
                if gear.flank.single_teeth or (gear.flanks_differ and gear.flank_of("right").single_teeth):
                    found.setdefault(gear.name, []).append(mesh)
    return {name: shared for name, shared in found.items() if len(shared) > 1}


def _tooth(assembly: Assembly, direction: int, mesh: MeshLayout, name: str, pressed: int) -> int | None:
    """Number of the tooth of a gear that stands at the pitch point of a mesh; None where the file gives the phase instead."""
    is_pinion = mesh.pinion.name == name
    if mesh.part.phase is not None or not {mesh.pinion.shaft, mesh.gear.shaft} <= assembly.shaft.keys():
        return None

    def turns(gear: GearLayout, towards: float, half: float) -> float:
        pitches = (gear.part.teeth or 0) * (assembly.angle(gear) - towards) / (2.0 * math.pi)
        return direction * mesh.sense(gear) * (pitches + pressed * half)

    half = mesh.half_tooth * (mesh.pinion.part.teeth or 0) / (2.0 * math.pi)
    phase = turns(mesh.pinion, mesh.psi, half) % 1.0
    if is_pinion:
        return round(turns(mesh.pinion, mesh.psi, half) - phase)
    return round(turns(mesh.gear, mesh.gear_psi, 0.5 - half) - phase)
