"""Stresses of the teeth in a few lines; the fields themselves are for ParaView."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rotorgear.results.tables.common import heading, lines, table

if TYPE_CHECKING:
    from rich.console import RenderableType

    from rotorgear.results.tooth_field import ToothFields


def tooth_field_table(result: ToothFields) -> RenderableType:
    """Return the largest stresses and pressure as one rich renderable."""
    from rich.console import Group

    out = table("gear", "nodes", "cells", "root stress MPa")
    for gear in result.gears:
        out.add_row(gear.name, str(len(gear.points)), str(len(gear.cells)), f"{1e-6 * gear.root_stress:.4g}")
    contact = result.contact
    pressure = f"{len(contact.pair)} loaded slices, largest pressure {1e-6 * contact.pressure.max(initial=0.0):.4g} MPa"
    return Group(heading(f"Mesh '{result.mesh}' at {result.position:g} mesh periods"), out, *lines(pressure), "")
