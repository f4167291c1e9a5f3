"""Small models and helpers for the contract tests, in SI."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.linalg as la

import rotorgear as rg
from rotorgear.elements.gear_mesh import ContactGeometry
from rotorgear.elements.shaft import ShaftElements
from rotorgear.system.system import System

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
