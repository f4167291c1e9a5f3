"""Phases of all meshes, and whether the loops of a train can be put together, from tooth numbers and centre lines.

With theta the direction of a tooth's middle, the pitch point lies at

    a_p = z_p (psi - theta_p) / 2 pi    and    a_g = z_g (psi + pi - theta_g) / 2 pi

pitches from a tooth of pinion and gear. A tooth of one stands in a space of the other when a_p + a_g + 1/2 is whole. That
fixes the gears one after the other, starting at the reference shaft; the last mesh of a loop asks for a clocking of its
gear on the shaft, or leaves a rest. The mesh then runs with the phase

    phi = 2 pi sigma (z_p (theta_p + s w - psi) / 2 pi),

counted from the moment when a contact stands at the pitch point: sigma the sense of rotation of the pinion, s the side of
the carrying flank and w half the angle of a tooth there. Parker and Lin, J. Mech. Design 126 (2004) 525, for planets.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from rotorgear.model.layout.mesh_geometry import centre_line, gear_geometry, pressure_angle
from rotorgear.model.layout.torque_flow import TorqueFlow
from rotorgear.model.layout.train import Train
from rotorgear.model.parts.gear import Gear
from rotorgear.model.parts.tables import Tables


@dataclass(frozen=True)
class Assembly:
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
class _Walk:
    """Angles of the shafts' marks, clockings of the gears (rad), and the gears that a mesh has fixed already."""

    shaft: dict[str, float] = field(default_factory=dict)
    clocking: dict[str, float] = field(default_factory=dict)
    fixed: set[str] = field(default_factory=set)
    loops: list[Assembly] = field(default_factory=list)


@dataclass(frozen=True)
class MeshPhases:
    """Phase of each mesh in rad, 0 to 2 pi (None without teeth), at the time when the mark of the reference shaft is at +x."""

    phase: dict[str, float | None]
    loops: tuple[Assembly, ...]
    clocking: dict[str, float]


def mesh_phases(model: Tables, train: Train, flow: TorqueFlow, direction: int = 1) -> MeshPhases:
    """Return the phases of all meshes and how the loops close, for a checked model."""
    done = _walk(model, train)
    phases: dict[str, float | None] = {}
    for name, mesh in model.meshes.items():
        pinion = model.gears[mesh.pinion]
        if mesh.phase is not None:
            phases[name] = mesh.phase % (2.0 * math.pi)
            continue
        if not pinion.teeth or pinion.shaft not in done.shaft:
            phases[name] = None
            continue
        theta = done.shaft[pinion.shaft] + done.clocking.get(mesh.pinion, 0.0)
        flank = flow.of_mesh(name)[0].torque_sense * _half_tooth(model, name)
        sense = direction * train.sense(pinion.shaft)
        phases[name] = (sense * pinion.teeth * (theta + flank - _psi(model, name))) % (2.0 * math.pi)
    return MeshPhases(phases, tuple(done.loops), done.clocking)


def _walk(model: Tables, train: Train) -> _Walk:
    done = _Walk({train.reference: 0.0}, {n: g.clocking for n, g in model.gears.items() if g.clocking is not None})
    waiting = [name for name, mesh in model.meshes.items() if _has_teeth(model, name)]
    couplings = [c for c in model.couplings.values() if c.stiffness.as_rows()[5][5] > 0.0]
    while True:
        for c in couplings:
            for one, other in ((c.from_shaft, c.to_shaft), (c.to_shaft, c.from_shaft)):
                if one in done.shaft:
                    done.shaft.setdefault(other, done.shaft[one])
        ready = [n for n in waiting if any(s in done.shaft for s in _shafts(model, n))]
        if not ready:
            rest = [shaft for mesh in waiting for shaft in _shafts(model, mesh)]
            if not rest:
                return done
            done.shaft[rest[0]] = 0.0  # a part of the train of its own
            continue
        # The walk goes outwards: a loop is closed by the mesh farthest from the input.
        open_ones = [n for n in ready if not all(s in done.shaft for s in _shafts(model, n))]
        name = min(open_ones or ready, key=lambda n: min(train.depth[s] for s in _shafts(model, n)))
        waiting.remove(name)
        _fit(model, done, name)


def _fit(model: Tables, done: _Walk, name: str) -> None:
    """Turn the shaft that a mesh reaches, or close a loop."""
    mesh = model.meshes[name]
    pinion = model.gears[mesh.pinion]
    gear = model.gears[mesh.gear]
    if gear.shaft not in done.shaft:
        done.shaft[gear.shaft] = _mate(model, done, name, of_gear=True) - done.clocking.get(mesh.gear, 0.0)
    elif pinion.shaft not in done.shaft:
        done.shaft[pinion.shaft] = _mate(model, done, name, of_gear=False) - done.clocking.get(mesh.pinion, 0.0)
    else:
        _close(model, done, name)
    done.fixed |= {mesh.pinion, mesh.gear}


def _close(model: Tables, done: _Walk, name: str) -> None:
    mesh = model.meshes[name]
    rest = _wrapped(_pitches(model, done, name, mesh.pinion) + _pitches(model, done, name, mesh.gear) + 0.5, 1.0)
    rest = 0.0 if abs(rest) < 1e-9 else rest
    for gear in (mesh.pinion, mesh.gear):
        if gear not in done.fixed and gear not in done.clocking:
            teeth = model.gears[gear].teeth or 1
            done.clocking[gear] = _wrapped(2.0 * math.pi * rest / teeth, 2.0 * math.pi / teeth)
            done.loops.append(Assembly(name, gear, done.clocking[gear], rest))
            return
    done.loops.append(Assembly(name, "", 0.0, rest))


def _pitches(model: Tables, done: _Walk, mesh: str, name: str) -> float:
    """a_p or a_g: pitches from a tooth of a gear to the pitch point."""
    gear = model.gears[name]
    at = _psi(model, mesh) + (0.0 if model.meshes[mesh].pinion == name else math.pi)
    theta = done.shaft[gear.shaft] + done.clocking.get(name, 0.0)
    return (gear.teeth or 0) * (at - theta) / (2.0 * math.pi)


def _mate(model: Tables, done: _Walk, mesh: str, *, of_gear: bool) -> float:
    """Direction of a tooth of the gear (or pinion) that fits the other one."""
    pair = model.meshes[mesh]
    known, wanted = (pair.pinion, pair.gear) if of_gear else (pair.gear, pair.pinion)
    at = _psi(model, mesh) + (math.pi if of_gear else 0.0)
    teeth = model.gears[wanted].teeth or 1
    return at + 2.0 * math.pi / teeth * (_pitches(model, done, mesh, known) % 1.0 + 0.5)


def _wrapped(value: float, period: float) -> float:
    return value - period * round(value / period)


def _has_teeth(model: Tables, name: str) -> bool:
    return all(model.gears[gear].teeth for gear in (model.meshes[name].pinion, model.meshes[name].gear))


def _shafts(model: Tables, name: str) -> tuple[str, str]:
    mesh = model.meshes[name]
    return model.gears[mesh.pinion].shaft, model.gears[mesh.gear].shaft


def _psi(model: Tables, name: str) -> float:
    line = centre_line(model, name)
    return line[1] if line else (model.meshes[name].centre_line_angle or 0.0)


def _half_tooth(model: Tables, name: str) -> float:
    """Half the angle of the pinion's tooth at the working circle in rad: a quarter of the pitch, and the profile shift."""
    gear: Gear = model.gears[model.meshes[name].pinion]
    geometry = gear_geometry(gear)
    teeth = gear.teeth or 1
    if geometry is None:
        return 0.5 * math.pi / teeth
    working = 2.0 * geometry.base_radius / math.cos(pressure_angle(model, name))
    return geometry.transverse_thickness(working) / working
