"""Result of a run-up: forces, transmission errors and accelerations by order and speed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from rotorgear.model.model import Model
from rotorgear.results.modal import NodeTable, Piece


@dataclass(frozen=True)
class ResponseResult:
    """Linear response of a model at s speeds to o orders, complex amplitudes of Re(x e^{+iwt}).

    Attributes:
        model: the model; speeds: of the reference shaft in rad/s, (s,).
        orders: name of each order; ratio: frequency over the reference speed, (o,).
        contact_mesh, contact_helix: mesh of each of the c contacts, and 0 or 1 for the helix at the smaller or larger z.
        mean_force: (c,) static force of each contact in N, about which the response is linear.
        mesh_force: (o, s, c) dynamic force along the flank normal in N, without the mean.
        transmission_error: (o, s, c) dynamic transmission error r_b1 theta_1 + r_b2 theta_2 in the plane of action, m.
        bearings: their names; bearing_force: (o, s, b, 3) force on the shaft in N.
        points: names of the points; acceleration: (o, s, k) along the direction of each, m/s^2 or rad/s^2.
        places: gears, disks and bearings by address; displacement: x y z tx ty tz of each, (o, s, d, 6), m and rad.
        shape_speed: speed of the deflection shapes in rad/s; shapes: (p, 6, o) displacements there in m and rad.
        nodes: where the p nodes are.
        damping_ratio: added to every elastic mode.
        solver_error: largest relative error of the reduced basis against direct solutions at `checked` points; 0 for direct.
        error_estimate: relative change of forces at the peaks on a finer mesh; NaN where it was left out.
    """

    model: Model
    speeds: np.ndarray
    orders: tuple[str, ...]
    ratio: np.ndarray
    contact_mesh: tuple[str, ...]
    contact_helix: np.ndarray
    mean_force: np.ndarray
    mesh_force: np.ndarray
    transmission_error: np.ndarray
    bearings: tuple[str, ...]
    bearing_force: np.ndarray
    points: tuple[str, ...]
    acceleration: np.ndarray
    places: tuple[str, ...]
    displacement: np.ndarray
    shape_speed: float
    shapes: np.ndarray
    nodes: NodeTable
    damping_ratio: float
    solver_error: float
    checked: int
    error_estimate: float
    dofs: int
    discretisation: tuple[Piece, ...]
    seconds: dict[str, float]
    left_out: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    method: str = ""

    @property
    def speed_rpm(self) -> np.ndarray:
        """Speeds of the reference shaft in rpm, (s,)."""
        return self.speeds * 30.0 / np.pi

    @property
    def frequency_hz(self) -> np.ndarray:
        """Frequency of each order at each speed, (o, s)."""
        return self.ratio[:, None] * np.abs(self.speeds) / (2.0 * np.pi)

    def contacts_of(self, mesh: str) -> list[int]:
        """Numbers of the contacts of a mesh."""
        return [k for k, name in enumerate(self.contact_mesh) if name == mesh]

    def peaks(self) -> list[tuple[str, str, float, float, float]]:
        """Largest dynamic force of each mesh: (mesh, order, rpm, Hz, amplitude in N of its most loaded helix)."""
        rows = []
        for mesh in dict.fromkeys(self.contact_mesh):
            size = np.abs(self.mesh_force[:, :, self.contacts_of(mesh)]).max(axis=2)
            o, s = np.unravel_index(int(np.argmax(size)), size.shape)
            rows.append(
                (mesh, self.orders[o], float(self.speed_rpm[s]), float(self.frequency_hz[o, s]), float(size[o, s]))
            )
        return rows

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON, amplitudes by order and speed; the keys are documented in docs/json.md."""
        meshes = list(dict.fromkeys(self.contact_mesh))

        def by_mesh(values: np.ndarray) -> dict[str, Any]:
            return {mesh: [np.abs(values[:, :, k]).tolist() for k in self.contacts_of(mesh)] for mesh in meshes}

        force = np.abs(self.bearing_force)
        moved = np.abs(self.displacement)
        return {
            "analysis": "response",
            "title": self.model.title,
            "speed_rpm": self.speed_rpm.tolist(),
            "order": list(self.orders),
            "frequency_ratio": self.ratio.tolist(),
            "frequency_hz": self.frequency_hz.tolist(),
            "mean_mesh_force_n": {mesh: self.mean_force[self.contacts_of(mesh)].tolist() for mesh in meshes},
            "mesh_force_n": by_mesh(self.mesh_force),
            "dynamic_transmission_error_m": by_mesh(self.transmission_error),
            "bearing_force_n": {
                name: {axis: force[:, :, k, j].tolist() for j, axis in enumerate("xyz")}
                for k, name in enumerate(self.bearings)
            },
            "acceleration": {name: np.abs(self.acceleration[:, :, k]).tolist() for k, name in enumerate(self.points)},
            "displacement_m": {
                place: {axis: moved[:, :, k, j].tolist() for j, axis in enumerate("xyz")}
                for k, place in enumerate(self.places)
            },
            "shape_speed_rpm": self.shape_speed * 30.0 / np.pi,
            "damping_ratio": self.damping_ratio,
            "solver_error": self.solver_error,
            "checked": self.checked,
            "error_estimate": self.error_estimate if np.isfinite(self.error_estimate) else None,
            "dofs": self.dofs,
            "nodes": len(self.nodes.shaft),
            "seconds": float(self.seconds.get("total", 0.0)),
            "left_out": list(self.left_out),
            "warnings": list(self.warnings),
            "method": self.method,
        }
