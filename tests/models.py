"""Small models for tests, and shapes and matrices of theirs: one home, in SI where they are not the text of a file."""

from __future__ import annotations

import copy
import math
from typing import Any

import numpy as np
import scipy.linalg as la

import rotorgear as rg
from rotorgear.elements.gear_mesh import ContactGeometry
from rotorgear.elements.shaft_section import ShaftElements
from rotorgear.system.system import System
from tests.paths import ROOT

E = 210e9
NU = 0.3
RHO = 7850.0
G = E / 2.6
STEEL: dict[str, Any] = {"steel": {"youngs_modulus": E, "poisson_ratio": NU, "density": RHO}}


def disk(
    shaft: str = "rotor", at: Any = "end", mass: float = 0.0, polar: float = 0.0, tilt: float = 0.0
) -> dict[str, Any]:
    """A disk with given inertia."""
    return {"shaft": shaft, "at": at, "mass": mass, "polar_inertia": polar, "diametral_inertia": tilt}


def clamp(*fixed: str, shaft: str = "rotor", at: Any = "start") -> dict[str, Any]:
    """A support that holds some motions fixed, all where none is named."""
    return {"shaft": shaft, "at": at, "fixed": list(fixed) or ["all"]}


def bearing(shaft: str = "rotor", at: Any = "start", **stiffness: float) -> dict[str, Any]:
    """A bearing with a diagonal stiffness."""
    return {"shaft": shaft, "at": at, "stiffness": stiffness}


def cantilever(*sections: dict[str, Any], **shaft: Any) -> rg.Model:
    """A shaft "rotor" of steel, clamped at its left end."""
    return rg.Model(materials=STEEL, shafts={"rotor": {"sections": sections, **shaft}}, supports={"clamp": clamp()})


def lumped_gear(shaft: str, radius: float, hand: str | None = None, helix: float = 0.4, **given: Any) -> dict[str, Any]:
    """A gear by its base radius, at the start of its shaft; helical where it has a hand."""
    kind = {"kind": "spur"} if hand is None else {"kind": "helical", "hand": hand, "base_helix_angle": helix}
    inertia = {"mass": 5.0, "polar_inertia": 0.02, "diametral_inertia": 0.015}
    return {"shaft": shaft, "at": "start", "base_radius": radius, **kind, **inertia, **given}


def lumped_pair(first: dict[str, Any], second: dict[str, Any], mesh: dict[str, Any], **parts: Any) -> rg.Model:
    """Two gears on rigid points "one" and "two", with one mesh."""
    angles = {"centre_line_angle": 0.3, "pressure_angle": 0.4}
    return rg.Model(
        shafts={"one": {}, "two": {}},
        gears={"pinion": first, "wheel": second},
        meshes={"pair": {"pinion": "pinion", "gear": "wheel", "stiffness": 1e8, **angles, **mesh}},
        **parts,
    )


def elements(length: float, *diameters: float, count: int = 1, kappa: float = np.nan) -> ShaftElements:
    """`count` equal elements: outer and inner diameter at the left end, the same at the right end."""
    d = np.array([diameters if len(diameters) == 4 else diameters * 2] * count, float)
    one = np.ones(count)
    return ShaftElements(length * one, d, d, E * one, G * one, NU * one, RHO * one, kappa * one)


def static(model: rg.Model, shaft: str, z: float, load: dict[int, float], count: int = 1) -> np.ndarray:
    """Displacements (6,) at a place under a load there; dof number -> force in N or N m."""
    system = System(model, count)
    node = system.nodes.at(shaft, z)
    force = np.zeros(6 * len(system.nodes))
    for dof, value in load.items():
        force[6 * node + dof] = value
    q = la.solve(system.stiffness().toarray(), system.dofs.transform.T @ force, assume_a="pos")
    return system.dofs.expand(q)[6 * node : 6 * node + 6]


def rigid_motions(points: np.ndarray) -> np.ndarray:
    """The six rigid-body motions at the dofs of nodes at `points` (p, 3): shape (6 p, 6), about the origin."""
    from rotorgear.elements.spring import rigid_transfer

    return np.vstack([rigid_transfer(point) for point in points])


def random_contact(rng: np.random.Generator) -> ContactGeometry:
    """A contact of random place, angles, hand and sense."""
    hand = int(rng.integers(-1, 2))
    return ContactGeometry(
        psi=rng.uniform(-np.pi, np.pi),
        pressure_angle=rng.uniform(0.2, 0.6),
        base_helix_angle=rng.uniform(0.05, 0.6) * abs(hand),
        hand=hand,
        torque_sense=int(rng.choice([-1, 1])),
        pinion_base_radius=rng.uniform(0.02, 0.3),
        gear_base_radius=rng.uniform(0.02, 0.3),
        pinion_offset=rng.uniform(-0.1, 0.1),
        gear_offset=rng.uniform(-0.1, 0.1),
        contact_position=rng.uniform(-0.01, 0.01),
    )


def pair_points(contact: ContactGeometry) -> np.ndarray:
    """Places of the two gear nodes of a contact with the pinion's axis at the origin, shape (2, 3)."""
    distance = (contact.pinion_base_radius + contact.gear_base_radius) / np.cos(contact.pressure_angle)
    centre = distance * np.array([np.cos(contact.psi), np.sin(contact.psi)])
    return np.array([[0.0, 0.0, -contact.pinion_offset], [*centre, -contact.gear_offset]])


def disk_in_bearing(
    bearing: str,
    force: str,
    *,
    name: str = "front",
    speed: str = "3000 rpm",
    mass: float = 10.0,
    motions: str = "",
    fixed: str = '"z", "tilt_x", "tilt_y"',
) -> rg.Model:
    """The model.

    Args:
        bearing: its keys, such as 'journal = { ... }'. force: of the pull, three components as the file has them.
        name, speed, mass: of the bearing, of the shaft, of the disk in kg. motions, fixed: lists as the file has them.
    """
    return rg.loads(f"""
{f"motions = [{motions}]" if motions else ""}
[operation]
input_shaft = "rotor"
speed = "{speed}"
[shafts.rotor]
[bearings.{name}]
shaft = "rotor"
at = "start"
{bearing}
[supports.guide]
shaft = "rotor"
at = "start"
fixed = [{fixed}]
[disks.d]
shaft = "rotor"
at = "start"
mass = {mass}
polar_inertia = 0.1
diametral_inertia = 0.1
[loads.pull]
shaft = "rotor"
at = "start"
force = {force}
""")


_DATA: dict[str, Any] = {
    "title": "Spur pair",
    "operation": {"input_shaft": "one", "output_shaft": "two", "speed": "1500 rpm", "torque": "200 N m"},
    "materials": {"steel": {"youngs_modulus": "206 GPa", "poisson_ratio": 0.3, "density": "7850 kg/m^3"}},
    "shafts": {
        "one": {
            "position": ["0 mm", "0 mm"],
            "material": "steel",
            "sections": [{"length": "120 mm", "outer_diameter": "40 mm"}],
        },
        "two": {
            "position": ["120 mm", "0 mm"],
            "material": "steel",
            "sections": [{"length": "120 mm", "outer_diameter": "50 mm"}],
        },
    },
    "gears": {
        "pinion": {
            "shaft": "one",
            "at": "60 mm",
            "kind": "spur",
            "teeth": 24,
            "normal_module": "4 mm",
            "width": "30 mm",
        },
        "wheel": {
            "shaft": "two",
            "at": "60 mm",
            "kind": "spur",
            "teeth": 36,
            "normal_module": "4 mm",
            "width": "30 mm",
        },
    },
    "meshes": {
        "pair": {
            "pinion": "pinion",
            "gear": "wheel",
            "stiffness": "3e8 N/m",
            "damping_ratio": 0.05,
            "transmission_error": [
                {"harmonic": 1, "amplitude": "4 um"},
                {"harmonic": 2, "amplitude": "1 um", "phase": "40 deg"},
            ],
        }
    },
    "bearings": {
        name: {
            "shaft": shaft,
            "at": at,
            "stiffness": {"radial": "2e8 N/m", "axial": "5e7 N/m"},
            "damping": {"radial": "3e3 N s/m", "axial": "1e3 N s/m"},
        }
        for name, shaft, at in (("a", "one", "start"), ("b", "one", "end"), ("c", "two", "start"), ("d", "two", "end"))
    },
    "damping": {"rayleigh_beta": "2e-6 s"},
    "points": {"housing": {"on": "bearings.d", "direction": "y"}},
}


def spur_pair(**changes: Any) -> rg.Model:
    """Return the model; `changes` by address, with __ between names: meshes__pair__backlash="0.1 mm". None removes."""
    data = copy.deepcopy(_DATA)
    for address, value in changes.items():
        *way, last = address.split("__")
        place = data
        for name in way:
            place = place.setdefault(name, {})
        if value is None:
            place.pop(last, None)
        else:
            place[last] = value
    return rg.Model(**data)


def pair_file(
    helix: float = 0.0,
    kind: str = "spur",
    torque: str = "1000 N m",
    mesh: str = 'stiffness = "tooth_fe"',
    pinion: str = "",
    wheel: str = "",
    hand: tuple[str, str] = ("right", "left"),
) -> str:
    """Text of a model: two shafts in stiff bearings, a torque on the pinion's, the rest on the wheel's."""
    distance = 285.0 / math.cos(math.radians(helix))
    text = 'schema_version = 1\ntitle = "Pair 34/80"\n'
    text += '[operation]\ninput_shaft = "one"\noutput_shaft = "two"\nspeed = "1000 rpm"\n'
    text += f'[loads.drive]\nshaft = "one"\nkind = "input"\ntorque = "{torque}"\n' if torque else ""
    text += '[loads.brake]\nshaft = "two"\nkind = "output"\n' if torque else ""
    for name, x, teeth, own, extra in (("one", 0.0, 34, hand[0], pinion), ("two", distance, 80, hand[1], wheel)):
        text += f'[shafts.{name}]\nposition = ["{x!r} mm", "0 mm"]\n'
        text += 'sections = [{ length = "300 mm", outer_diameter = "80 mm" }]\n'
        text += f'[gears.{"pinion" if name == "one" else "wheel"}]\nshaft = "{name}"\nat = "150 mm"\nkind = "{kind}"\n'
        text += f'teeth = {teeth}\nnormal_module = "5 mm"\nwidth = "54 mm"\n'
        text += f'helix_angle = "{helix} deg"\nhand = "{own}"\n' if helix else ""
        text += 'gap = "20 mm"\n' if kind == "herringbone" else ""
        text += extra + "\n"
        for end in ("start", "end"):
            text += f'[bearings.{name}_{end}]\nshaft = "{name}"\nat = "{end}"\n'
            text += 'stiffness = { radial = "1e9 N/m", axial = "1e9 N/m" }\n'
    return text + f'[meshes.pair]\npinion = "pinion"\ngear = "wheel"\n{mesh}\n'


def record_beside_a_pair() -> rg.TimeComparison:
    """A swelling torque on the pinion of the backlash pair, and any acceleration of its wheel."""
    pair = rg.load(ROOT / "models" / "backlash_pair.toml")
    points = {name: {"on": f"gears.{name}", "direction": "torsion"} for name in ("pinion", "wheel")}
    time = 1e-4 * np.arange(60)
    torque = rg.Channel("pinion", "N m", np.sin(300.0 * time))
    heard = rg.Channel("wheel", "rad/s^2", 40.0 * np.cos(300.0 * time))
    record = rg.TimeRecord(time, (torque, heard))
    return rg.compare_time(pair.with_("points", points), record, steps=40, ring_down="0:5 ms")
