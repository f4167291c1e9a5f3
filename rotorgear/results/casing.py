"""What a casing is by itself: mass, modes, stiffness of its seats, and how far its mesh and its reduction are to be trusted."""

from __future__ import annotations

import numpy as np

from rotorgear.results.result import Result
from rotorgear.results.schema import Record, of


class CasingSeat(Record):
    """One bearing seat."""

    name: str = of("name", note=": that of its bearing")
    point_m: np.ndarray = of("point about which it turns", "m", "xyz")
    area_m2: float = of("area", "m^2", note="; 0 where its nodes make no face")
    nodes: int = of("nodes")
    stiffness: np.ndarray = of(
        "stiffness of the seat", "", "motion", "motion", note=", x y z rx ry rz in N/m, N and N m/rad; see `others`"
    )
    others: str = of("state of the other seats", note=': `"free"` where the casing is held, `"held"` where it floats')


class CasingRow(Record):
    """One casing. Errors are relative; those of frequencies are estimates."""

    files: tuple[str, ...] = of("mesh files", "", "file")
    element: str = of("element", note=": tetra10, hexahedron20 or hexahedron27")
    elements: int = of("elements")
    nodes: int = of("nodes")
    dofs: int = of("degrees of freedom", note=" of the mesh")
    size_m: np.ndarray = of("size along x y z", "m", "xyz")
    mass_kg: float = of("mass", "kg")
    centre_m: np.ndarray = of("centre of mass", "m", "xyz")
    inertia_kg_m2: np.ndarray = of("inertia tensor about the centre of mass", "kg m^2", "xyz", "xyz")
    connection: str = of("connection of the seats", note=': `"mean"` or `"rigid"`')
    jacobian_least: float = of("least Jacobian over that of the straight element", note=", of the mesh as it was read")
    straightened: tuple[int, ...] = of("elements that were made straight", "", "element", note=", numbered from 1")
    rigid_residual: float = of("|K R| / (|K| |R|) of rigid-body motions R")
    rigid_frequency_hz: float = of("largest frequency of a rigid-body motion", "Hz", note=": rounding")
    free_frequency_hz: np.ndarray = of("frequency of the free casing", "Hz", "mode", note=", without rigid modes")
    free_mesh_error: np.ndarray = of("frequency error of the mesh", "", "mode", note=", of the free modes")
    held_frequency_hz: np.ndarray = of("frequency of the held casing", "Hz", "mode", note="; empty where it floats")
    held_mesh_error: np.ndarray = of("frequency error of the mesh", "", "mode", note=", of the held modes")
    fixed_frequency_hz: np.ndarray = of("frequency of fixed-interface modes that are kept", "Hz", "fixed_mode")
    coordinates: int = of("coordinates of the reduced casing")
    reduced_frequency_hz: np.ndarray = of(
        "frequency of the reduced casing", "Hz", "reduced_mode", note=", elastic, as it is held, with its seats free"
    )
    reduction_error: np.ndarray = of("frequency error of the reduction", "", "reduced_mode")
    seats: tuple[CasingSeat, ...] = of("bearing seats", "", "seat", record=CasingSeat)
    notes: tuple[str, ...] = of("sentences", "", "note", note=" on what was done with the mesh")
    memory_bytes: float | None = of("largest memory of the process", "B", note=", or `null`")
    seconds: dict[str, float] = of("wall time", "s", "STEP")
    points: np.ndarray = of("points of the surface", "m", "point", "xyz", json=None)
    triangles: np.ndarray = of("triangles of the surface", "", "triangle", "corner", json=None)
    free_shapes: np.ndarray = of(
        "displacement of the surface in free modes", "", "point", "xyz", "mode", note=", modal mass 1", json=None
    )
    held_shapes: np.ndarray = of(
        "displacement of the surface in held modes", "", "point", "xyz", "mode", note=", modal mass 1", json=None
    )


class CasingSurvey(Result, kind="casing"):
    """The casings of a model by themselves."""

    title: str = of("title of the model")
    casings: dict[str, CasingRow] = of("casings", "", "CASING", record=CasingRow)
