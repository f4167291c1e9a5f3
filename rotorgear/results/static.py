"""Result of a static analysis: deflections, forces of meshes and bearings, how branches and helices share the load."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from rotorgear.model.model import Model
from rotorgear.results.modal import NodeTable


@dataclass(frozen=True)
class Share:
    """Share of a mesh in the load of a gear that it drives, or is driven by, together with other meshes.

    `factor` is the number of these meshes times the share (the sharing factor K_gamma of the group is the largest one);
    `decided_by` is "stiffness" in a loop and "loads" where equilibrium alone decides.
    """

    gear: str
    mesh: str
    share: float
    factor: float
    decided_by: str


@dataclass(frozen=True)
class LoopAssembly:
    """How a closed loop of gears goes together.

    Attributes:
        mesh: the mesh that closes the loop.
        gear: the gear that closes it by its place on the shaft; "" where all clockings are given.
        clocking_deg: angle of that gear's tooth from the shaft's mark.
        rest_pitches: what is missing where the gear stands at angle 0 (or as the file says), in pitches.
    """

    mesh: str
    gear: str
    clocking_deg: float
    rest_pitches: float


@dataclass(frozen=True)
class StaticResult:
    """Static equilibrium of a model with p nodes and c contacts (helices of meshes, in the order of the file).

    Attributes:
        model: the model; speed: speed of the reference shaft in rad/s (for bearings with tables), None without one.
        nodes: where the nodes are; displacement: x y z tx ty tz of each, (p, 6).
        contact_mesh, contact_helix: mesh of each contact, and 0 or 1 for the helix at the smaller or larger z.
        driver: gear that drives at each contact; carries: (c,) whether the contact is closed.
        mesh_force: (c,) N along the flank normal; mesh_force_on_gear: (c, 3) N, x y z, of the pinion on the gear.
        mesh_deflection: (c,) approach of the flanks in m.
        bearing_force, support_force: force and moment on the shaft by name, (6,), N and N m.
        shares: sharing of each gear with several meshes; helix_share: (c,) share of a helix in its mesh.
        parameter, parameter_unit: what the shares depend on; force_derivative: (k, c), change of each contact's force for a
            unit of each; share_derivative: (k, g), change of each row of `shares`. For a stiffness the unit is 100 %.
        mesh_phase: phase of each mesh in pitches, NaN where teeth are missing; assembly: how loops close.
        torque: applied torques by name in N m about +z.
        imbalance: largest force that is missing for equilibrium of the whole, relative to the sum of all.
        error_estimate: relative change of mesh and bearing forces against a mesh of half the element length.
    """

    model: Model
    speed: float | None
    nodes: NodeTable
    displacement: np.ndarray
    contact_mesh: tuple[str, ...]
    contact_helix: np.ndarray
    driver: tuple[str, ...]
    carries: np.ndarray
    mesh_force: np.ndarray
    mesh_force_on_gear: np.ndarray
    mesh_deflection: np.ndarray
    bearing_force: dict[str, np.ndarray]
    support_force: dict[str, np.ndarray]
    shares: tuple[Share, ...]
    helix_share: np.ndarray
    parameter: tuple[str, ...]
    parameter_unit: tuple[str, ...]
    force_derivative: np.ndarray
    share_derivative: np.ndarray
    mesh_phase: dict[str, float]
    assembly: tuple[LoopAssembly, ...]
    torque: dict[str, float]
    point_displacement: dict[str, float]
    imbalance: float
    error_estimate: float
    dofs: int
    seconds: dict[str, float]
    left_out: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    method: str = ""
    place_displacement: dict[str, np.ndarray] = field(default_factory=dict)

    def contacts_of(self, mesh: str) -> list[int]:
        """Numbers of the contacts of a mesh."""
        return [k for k, name in enumerate(self.contact_mesh) if name == mesh]

    @property
    def sharing_factor(self) -> float:
        """The largest sharing factor of all groups of meshes; 1 where none shares."""
        return max((row.factor for row in self.shares), default=1.0)

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON; the keys are documented in docs/json.md."""
        meshes = list(dict.fromkeys(self.contact_mesh))

        def by_mesh(values: np.ndarray) -> dict[str, Any]:
            return {mesh: values[self.contacts_of(mesh)].tolist() for mesh in meshes}

        return {
            "analysis": "static",
            "title": self.model.title,
            "speed_rpm": None if self.speed is None else self.speed * 30.0 / np.pi,
            "torque_n_m": dict(self.torque),
            "mesh_force_n": by_mesh(self.mesh_force),
            "mesh_force_on_gear_n": by_mesh(self.mesh_force_on_gear),
            "mesh_deflection_m": by_mesh(self.mesh_deflection),
            "mesh_carries": by_mesh(self.carries),
            "mesh_driver": {mesh: self.driver[self.contacts_of(mesh)[0]] for mesh in meshes},
            "helix_share": by_mesh(self.helix_share),
            "shares": [asdict(row) for row in self.shares],
            "sharing_factor": self.sharing_factor,
            "bearing_force_n": {name: value[:3].tolist() for name, value in self.bearing_force.items()},
            "bearing_moment_n_m": {name: value[3:].tolist() for name, value in self.bearing_force.items()},
            "support_force_n": {name: value[:3].tolist() for name, value in self.support_force.items()},
            "support_moment_n_m": {name: value[3:].tolist() for name, value in self.support_force.items()},
            "displacement": {place: value.tolist() for place, value in self.place_displacement.items()},
            "point_displacement": dict(self.point_displacement),
            "sensitivity": [
                {
                    "parameter": name,
                    "unit": unit,
                    "mesh_force_n": by_mesh(self.force_derivative[k]),
                    "share": self.share_derivative[k].tolist(),
                }
                for k, (name, unit) in enumerate(zip(self.parameter, self.parameter_unit, strict=True))
            ],
            "mesh_phase": {name: float(v) if np.isfinite(v) else None for name, v in self.mesh_phase.items()},
            "assembly": [asdict(row) for row in self.assembly],
            "imbalance": self.imbalance,
            "error_estimate": self.error_estimate if np.isfinite(self.error_estimate) else None,
            "dofs": self.dofs,
            "nodes": len(self.nodes.shaft),
            "seconds": float(self.seconds.get("total", 0.0)),
            "left_out": list(self.left_out),
            "warnings": list(self.warnings),
            "method": self.method,
        }
