"""Additional masses of a REXS file (from 1.3 on): disks or point masses of a shaft, with the unbalance of their eccentricity."""

from __future__ import annotations

import math

import numpy as np

from rotorgear.rexs.document import Component
from rotorgear.rexs.frames import Frame, Frames
from rotorgear.rexs.shafts import ShaftPart
from rotorgear.rexs.structure import Structure
from rotorgear.rexs.toml_text import Names, Table, quantity

MASS = "additional_mass"
# Moments about v and w that differ by less are those of a body of revolution, written with few digits.
_ALIKE = 1e-3


def mass_tables(
    part: Component, names: Names, shafts: dict[str, ShaftPart], structure: Structure, frames: Frames, model: Frame
) -> list[Table]:
    """Tables of an additional mass; none, and a problem on the account, where its mass or its place is not said.

    A mass m with its centre off the axis by e has the unbalance m e.
    """
    account = structure.account
    owner = structure.shaft_of(part)
    shaft = shafts.get(owner.id) if owner is not None else None
    if shaft is None:
        account.left_out.append(f"{part}: it stands on no shaft")
        return []
    mass = account.number(part, ("mass_of_component", "mass"), "mass")
    if not mass or mass < 0.0:
        account.missing(part, "mass_of_component is needed, above 0")
        return []
    u = account.number(part, ("u_coordinate_on_shaft",), "length")
    frame = frames.of(part)
    if u is None and frame is None:
        account.missing(part, "its place is needed: u_coordinate_on_shaft or support_vector")
        return []
    along = shaft.axis.z(u) if u is not None else float((model.axes @ (frame.origin - model.origin))[0])  # type: ignore[union-attr]
    z = shaft.place(part, along, account)
    tables = [_body(part, names.of(part.name, "mass", part.id), shaft, z, mass, structure)]
    eccentricity = account.numbers(part, "eccentricity_vector", "length", 3)
    if eccentricity is not None and math.hypot(*eccentricity[1:]) > 0.0:
        axes = frame.axes if frame is not None else model.axes
        _, x, y = model.axes @ (np.array(eccentricity) @ axes)
        name = tables[0].header.partition(".")[2]
        tables.append(_unbalance(part, name, shaft, z, mass, float(x), float(y)))
    return tables


def _body(part: Component, name: str, shaft: ShaftPart, z: float, mass: float, structure: Structure) -> Table:
    account = structure.account
    moments = [account.number(part, (f"moment_of_inertia_{axis}_axis",), "inertia") or 0.0 for axis in "uvw"]
    polar = max(moments[0], 0.0)
    across = [max(value, 0.0) for value in moments[1:]]
    kind = "disks" if polar or any(across) else "point_masses"
    table = Table(f"{kind}.{name}", str(part))
    table.add("shaft", f'"{shaft.name}"')
    table.add("at", quantity(z, "length"))
    table.add("mass", quantity(mass, "mass"))
    if kind == "point_masses":
        return table
    diametral = 0.5 * sum(across)
    comment = ""
    if abs(across[0] - across[1]) > _ALIKE * diametral:
        reason = (
            f"a shaft's bodies are round here; the file says {across[0]:.6g} about v, {across[1]:.6g} kg m^2 about w"
        )
        comment = account.assume(f"{table.header}.diametral_inertia", f"{diametral:.6g} kg m^2", reason)
    table.add("polar_inertia", quantity(polar, "inertia"))
    table.add("diametral_inertia", quantity(diametral, "inertia"), comment)
    return table


def _unbalance(part: Component, name: str, shaft: ShaftPart, z: float, mass: float, x: float, y: float) -> Table:
    """Unbalance of a mass whose centre lies at x and y in m from the axis."""
    table = Table(f"unbalances.{name}", f"eccentricity of {part}")
    table.add("shaft", f'"{shaft.name}"')
    table.add("at", quantity(z, "length"))
    table.add("magnitude", quantity(mass * math.hypot(x, y), "unbalance"))
    table.add("phase", quantity(math.atan2(y, x), "angle"))
    return table
