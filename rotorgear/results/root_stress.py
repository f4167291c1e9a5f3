"""Result of tooth root stresses over the mesh cycle: at the root section and where they are largest.

The section is that of ISO 6336-3: at the 30 degree tangent of the fillet, of a ring at that of 60 degrees.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rotorgear.results.result import Result
from rotorgear.results.schema import Record, of
from rotorgear.results.table import Block, Line, upright

# What is told of a gear, in this order.
_TOLD = (
    "name",
    "worst_at_tangent",
    "tangent_diameter",
    "worst_at_tangent_phase",
    "worst",
    "worst_diameter",
    "worst_z",
    "worst_phase",
    "nominal",
)


class GearRootStress(Record):
    """One gear: largest principal stress in the fillet of the loaded side while a tooth passes through the mesh."""

    name: str = of("name", note=" of the gear", column="gear")
    phase: np.ndarray = of(
        "position of the tooth", "mesh periods", "phase", note=" from its contact at the pitch point"
    )
    at_tangent: np.ndarray = of("stress at the root section", "Pa", "phase", note=", largest along the face")
    largest: np.ndarray = of("largest stress of the fillet", "Pa", "phase")
    tangent_diameter: float = of("diameter of the root section", "m", form=".3f", column="  diameter there, mm")
    tangent_thickness: float = of("thickness of the tooth there", "m")
    worst_at_tangent: float = of(
        "largest stress at the root section in the cycle", "Pa", form=".2f", column="at the root section, MPa"
    )
    worst_at_tangent_phase: float = of(
        "its position", note=" in mesh periods", form=".3f", column="  in mesh periods from C"
    )
    worst: float = of("largest stress in the cycle", "Pa", form=".2f", column="largest, MPa")
    worst_phase: float = of(
        "position of the largest stress", note=" in mesh periods", form=".3f", column="  in mesh periods from C"
    )
    worst_diameter: float = of("diameter of the largest stress", "m", form=".3f", column="  diameter there, mm")
    worst_z: float = of(
        "its place along the face", "m", note="; 0: plane model", form=".2f", column="  along the face, mm"
    )
    nominal: float | None = of(
        "nominal stress of ISO 6336-3 without factors of load",
        "Pa",
        note=": method B, the whole load at the outer point of single contact; `null` where there is none",
        form=".2f",
        column="nominal, ISO 6336-3, MPa",
    )


class RootStress(Result, kind="root_stress"):
    """Both gears of the first helix of a mesh."""

    title: str = of("title of the model")
    mesh: str = of("mesh", note=": its name")
    preset: str = of("preset of the finite elements")
    pinion_torque_n_m: float = of("torque on the pinion about +z", "N m")
    positions: int = of("positions in the mesh period")
    gears: tuple[GearRootStress, GearRootStress] = of("both gears", "", "pinion_and_gear", record=GearRootStress)

    def tables(self) -> Iterator[Block]:
        """The largest stresses of the cycle, of both gears side by side."""
        yield Line(self.title or "Mesh", f": mesh '{self.mesh}', root stress over the mesh cycle")
        yield f"{self.pinion_torque_n_m:.6g} N m on the pinion, preset {self.preset}, {self.positions} positions"
        yield from ("", upright(self, "gears", "largest principal stress", *_TOLD), "")
        yield from self.remarks()
        yield f"{self.cost}"
