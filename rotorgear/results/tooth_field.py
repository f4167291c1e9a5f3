"""Displacement and stress of the teeth of both gears at one position of the mesh cycle, with the pressure between them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rotorgear.quantity import counted
from rotorgear.results.result import Result
from rotorgear.results.schema import Record, of
from rotorgear.results.table import Block, Column, Line, table_of


class ToothField(Record):
    """Finite elements of some pitches of one gear, in the place where they mesh; the pinion's axis is the z axis.

    Cells are biquadratic quadrangles (9 nodes) or triquadratic hexahedra (27), in VTK's order. Stresses are averaged at nodes.
    """

    name: str = of("name", note=" of the gear")
    points: np.ndarray = of("nodes of the elements", "m", "node", "xyz", json=None)
    cells: np.ndarray = of("nodes of each cell", "", "cell", "corner", json=None)
    tooth: np.ndarray = of("number of the pitch", "", "node", json=None, note=", 0 for that of pair 0")
    displacement: np.ndarray = of("displacement of the nodes", "m", "node", "xyz", json=None)
    von_mises: np.ndarray = of("von Mises stress", "Pa", "node", json=None)
    largest_principal: np.ndarray = of("largest principal stress", "Pa", "node", json=None)
    root_stress: float = of(
        "largest principal stress in the fillets on the loaded side", "Pa", form=".4g", column="root stress MPa"
    )


class ContactField(Record):
    """The n slices that carry load."""

    ends: np.ndarray = of("ends of each slice on the flanks", "m", "slice", "end", "xyz", json=None)
    line_load: np.ndarray = of("force per length of contact line", "N/m", "slice")
    half_width: np.ndarray = of("half-width of the contact", "m", "slice")
    pressure: np.ndarray = of("largest contact pressure", "Pa", "slice")
    pair: np.ndarray = of("number of the tooth pair", "", "slice")


class ToothFields(Result, kind="tooth_field"):
    """Both gears and the contact at one position of the first helix."""

    mesh: str = of("mesh", note=": its name")
    position: float = of("position", "mesh periods")
    gears: tuple[ToothField, ToothField] = of("both gears", "", "pinion_and_gear", record=ToothField)
    contact: ContactField = of("slices that carry load", record=ContactField)

    def tables(self) -> Iterator[Block]:
        """The largest stresses and pressure."""
        yield Line(f"Mesh '{self.mesh}' at {self.position:g} mesh periods")
        nodes = Column("nodes", lambda gear: len(gear.points))
        cells = Column("cells", lambda gear: len(gear.cells))
        yield table_of(self, "gears", Column("gear", "name"), nodes, cells, "root_stress")
        pressure = 1e-6 * self.contact.pressure.max(initial=0.0)
        yield from (f"{counted(len(self.contact.pair), 'loaded slices')}, largest pressure {pressure:.4g} MPa", "")
