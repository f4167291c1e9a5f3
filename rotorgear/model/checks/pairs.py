"""What is odd where the teeth of two gears meet, and the ball that a gear is measured over."""

from __future__ import annotations

import math
from collections.abc import Iterator

from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.measure import ideal_ball_diameter
from rotorgear.model.layout.mesh_layout import MeshLayout
from rotorgear.model.parts.gear import Gear

# The ideal ball is rounded up to a multiple of this (m), or of a fortieth of a smaller module.
_BALL_STEP = 0.25e-3
# Less clearance between tip and root than this share of the module is worth a word (ISO 53 has 0.25).
_LEAST_CLEARANCE = 0.1


def ball_diameter(gear: Gear, geometry: GearGeometry) -> float:
    """Diameter (m) of the balls a gear is measured over: given, or the ideal one rounded up."""
    if gear.ball_diameter is not None:
        return gear.ball_diameter
    step = min(_BALL_STEP, geometry.normal_module / 4.0)
    return step * math.ceil(ideal_ball_diameter(geometry) / step - 1e-9)


def mesh_findings(mesh: MeshLayout) -> Iterator[str]:
    """Sentences on a mesh whose teeth meet where they shouldn't, or hardly."""
    from rotorgear.gears.geometry.outline import tooth_outline

    pair = mesh.pair
    first = mesh.pinion.geometry
    second = mesh.gear.geometry
    if pair is None or first is None or second is None:
        return
    if pair.interference:
        yield "a tip reaches below its mate's base tangent point (interference); contact ratios are nominal"
    active = pair.active_root_diameters(first, second)
    for own, mate, g, h, used in (
        (mesh.pinion.name, mesh.gear.name, first, second, active[0]),
        (mesh.gear.name, mesh.pinion.name, second, first, active[1]),
    ):
        form = 2.0 * tooth_outline(g).form_radius
        if not pair.interference and used < form * (1.0 - 1e-6):
            yield (
                f"the tip of '{mate}' works down to diameter {1e3 * used:.6g} mm of '{own}', whose involute begins at "
                f"{1e3 * form:.6g} mm: contact begins in the fillet; reduce the tip diameter of '{mate}'"
            )
        clearance = pair.centre_distance - 0.5 * (h.effective_tip_diameter + g.root_diameter)
        if clearance < _LEAST_CLEARANCE * g.normal_module:
            yield f"between the tip of '{mate}' and the root of '{own}' are only {1e3 * clearance:.3g} mm"
    if pair.total_contact_ratio < 1.0:
        yield f"total contact ratio {pair.total_contact_ratio:.3g} is below 1, the teeth lose contact"
    if mesh.backlash.least < -1e-9:
        jam = f"{-1e6 * mesh.backlash.least:.3g} um along the flank normal"
        yield f"the axes are too close: the teeth would jam by {jam}; give allowances, or move the axes apart"
