"""All that a reduced casing depends on, as plain values in SI: what the model file says, and what its body is kept under."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from rotorgear.casings.assembly import Elastic
    from rotorgear.casings.box import BoxShape
    from rotorgear.casings.patches import Cylinder

Rows = tuple[tuple[float, ...], ...]

# Fixed-interface modes up to this multiple of an analysis's highest frequency bring its error to some 2e-3 without residual
# shapes, and well below 1e-3 with them.
BEYOND = 2.0


@dataclass(frozen=True)
class MountSettings:
    """A set on springs and dampers to the ground: 6 x 6 in x y z rx ry rz of its mean motion."""

    set: str
    stiffness: Rows
    damping: Rows


@dataclass(frozen=True)
class JoinSettings:
    """Two sets that are tied, or held together by a stiffness per area in N/m^3."""

    first: str
    second: str
    stiffness: float | None


@dataclass(frozen=True)
class CasingSettings:
    """A casing as the model file gives it.

    Attributes:
        name: in the model file.
        files: name and path of each mesh.
        unit: of their lengths in m.
        material: of all of it.
        held: sets that are fixed.
        mounts: sets on springs.
        seats: name of each seat, and its set or bore.
        connection: "mean" or "rigid".
        joins: of faces.
        modes_to: Hz; None: the lowest fixed-interface modes, as many as `reduction.USUAL`.
        damping_ratio: of every elastic mode.
        mass: as stated, in kg; or None.
        mass_tolerance: as a share.
        splits: how often every element is split in eight.
        box: what is meshed here, in place of files.
        table: of the model file that it stands in.
    """

    name: str
    files: tuple[tuple[str, Path], ...]
    unit: float
    material: Elastic
    held: tuple[str, ...] = ()
    mounts: tuple[MountSettings, ...] = ()
    seats: tuple[tuple[str, str | Cylinder], ...] = ()
    connection: Literal["mean", "rigid"] = "mean"
    joins: tuple[JoinSettings, ...] = ()
    modes_to: float | None = None
    damping_ratio: float = 0.0
    mass: float | None = None
    mass_tolerance: float = 0.05
    splits: int = 0
    box: BoxShape | None = None
    table: str = "casings"

    @property
    def address(self) -> str:
        """Where it stands in the model file."""
        return f"{self.table}.{self.name}"
