"""What a casing is by itself: mass, modes, stiffness of its seats, and how far its mesh and its reduction are to be trusted."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import numpy as np

from rotorgear.quantity import counted, millimetres
from rotorgear.results.result import Result
from rotorgear.results.schema import Record, of
from rotorgear.results.table import Block, Column, error_words, grid, table_of, written

# Products of inertia below this share of the largest are shown as 0.
_ROUNDING = 1e-9
# |K R| / (|K| |R|) of rigid-body motions that strain nothing.
_STRAINED = 1e-10


class CasingSeat(Record):
    """One bearing seat."""

    name: str = of("name", note=": that of its bearing", column="seat")
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
    seconds: dict[str, float] = of("CPU time", "s", "STEP")
    points: np.ndarray = of("points of the surface", "m", "point", "xyz", json=None)
    triangles: np.ndarray = of("triangles of the surface", "", "triangle", "corner", json=None)
    free_shapes: np.ndarray = of(
        "displacement of the surface in free modes", "", "point", "xyz", "mode", note=", modal mass 1", json=None
    )
    held_shapes: np.ndarray = of(
        "displacement of the surface in held modes", "", "point", "xyz", "mode", note=", modal mass 1", json=None
    )

    def facts(self) -> Iterator[tuple[str, str]]:
        """What is told of the casing: a name and its words."""
        yield ("mesh", f"{self.elements} {self.element}, {self.nodes} nodes, {self.dofs} dofs")
        yield ("size", " x ".join(millimetres(float(side)) for side in self.size_m))
        yield ("mass", f"{self.mass_kg:.6g} kg")
        yield ("centre", ", ".join(millimetres(float(x)) for x in self.centre_m))
        # Products of inertia of a symmetric body are rounding.
        inertia = self.inertia_kg_m2 * (abs(self.inertia_kg_m2) > _ROUNDING * abs(self.inertia_kg_m2).max())
        yield ("inertia xx yy zz", " ".join(f"{inertia[i, i]:.5g}" for i in range(3)) + " kg m^2")
        yield ("inertia xy yz zx", " ".join(written(inertia[i, (i + 1) % 3], ".5g") for i in range(3)) + " kg m^2")
        yield ("least Jacobian", f"{self.jacobian_least:.3g} of the straight element's")
        free_of_strain = self.rigid_residual < _STRAINED and self.rigid_frequency_hz < 1e-3 * self.free_frequency_hz[0]
        words = "strain nothing" if free_of_strain else f"are strained: {self.rigid_frequency_hz:.2g} Hz"
        compared = f"below {_STRAINED:.0e}" if free_of_strain else f"= {self.rigid_residual:.1e}"
        yield ("rigid-body motions", f"{words}: |K R|/|K||R| {compared}")
        fixed = self.fixed_frequency_hz
        reach = f", to {fixed[-1]:.0f} Hz" if len(fixed) else ""
        yield ("reduced to", f"{self.coordinates} coordinates: {counted(len(fixed), 'fixed-interface modes')}{reach}")
        yield ("seats", f"connection {self.connection}")
        if self.memory_bytes:
            yield ("largest memory", f"{self.memory_bytes / 1e9:.2f} GB")
        yield ("CPU seconds", ", ".join(f"{step} {value:.1f}" for step, value in self.seconds.items()))


class CasingSurvey(Result, kind="casing"):
    """The casings of a model by themselves."""

    title: str = of("title of the model")
    casings: dict[str, CasingRow] = of("casings", "", "CASING", record=CasingRow)

    def tables(self) -> Iterator[Block]:
        """Each casing: what it is, its modes and its seats."""
        yield from self.titled()
        for name, row in self.casings.items():
            yield grid(row.facts(), "", "", left=2, caption=f"casing {name}", titled=True, headed=False)
            yield from (*(f"  {note}" for note in row.notes), "")
            small = partial(error_words, decimals=1)
            columns = (
                (row.free_frequency_hz, ".2f"),
                (row.free_mesh_error, small),
                (row.held_frequency_hz, ".2f"),
                (row.held_mesh_error, small),
                (row.reduced_frequency_hz, ".2f"),
                (row.reduction_error, small),
            )
            modes = [
                (str(k + 1), *(written(values[k], form) if k < len(values) else "-" for values, form in columns))
                for k in range(max(len(values) for values, _ in columns))
            ]
            heads = ("mode", "free", "mesh err.", "held", "mesh err.", "reduced", "reduction err.")
            yield grid(modes, *heads, left=0, caption=f"Modes of casing {name}")
            yield from ("Frequencies in Hz, without rigid modes; errors are relative estimates of frequencies.", "")
            # A coordinate below 10 um is a mesh's own rounding of a zero; stiffness in MN/m and MN m/rad.
            point = [
                Column(x, "point_m", lambda x: f"{x:.4g}" if abs(x) >= 0.01 else "0", "mm", entry=(j,))
                for j, x in enumerate("xyz")
            ]
            stiffness = [
                Column(f"k_{x}", "stiffness", lambda k: f"{1e-6 * k:.4g}", entry=(i, i))
                for i, x in enumerate(("x", "y", "z", "rx", "ry", "rz"))
            ]
            top = ("casings", name)
            yield table_of(row, "seats", "name", *point, *stiffness, top=top, caption=f"Seats of casing {name}")
            others = row.seats[0].others if row.seats else "free"
            yield f"Points in mm; stiffness in MN/m and MN m/rad, the other seats {others}."
