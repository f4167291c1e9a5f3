"""Where the shafts are shown: at their positions; those without one beside their mates in mesh, in line with what they are
coupled to, or else side by side."""

from __future__ import annotations

import math

import numpy as np

from rotorgear.export.sizes import BodySize, bodies_on, pitch_radius, shaft_diameter
from rotorgear.model.model import Model

Axis = tuple[float, float]
# Directions in which a mate without a given centre-line angle is tried, in rad from +x.
_DIRECTIONS = tuple(math.radians(angle) for angle in (0, 60, -60, 90, -90, 120, -120, 180, 30, -30, 150, -150))
# Gears in mesh overlap by the depth of their teeth; what overlaps more than this is in the way.
_OVERLAP = 0.85


def display_axes(model: Model) -> dict[str, Axis]:
    """Axis (x, y) in m of every shaft for display, shaft -> (x, y)."""
    # Given positions stand. From them on neighbours are placed one by one; what nothing leads to begins a group of its own, to
    # the right of all.
    axes: dict[str, Axis] = {name: shaft.position for name, shaft in model.shafts.items() if shaft.position is not None}
    envelopes = {name: _envelope(model, name) for name in model.shafts}
    while len(axes) < len(model.shafts):
        if _place_neighbours(model, axes, envelopes):
            continue
        start = next(name for name in model.shafts if name not in axes)
        if not axes:
            axes[start] = (0.0, 0.0)
            continue
        reach = {name: 0.5 * max(body.diameter for body in envelope) for name, envelope in envelopes.items()}
        right = max(axis[0] + reach[name] for name, axis in axes.items())
        axes[start] = (float(right + 1.2 * reach[start]), float(np.mean([axis[1] for axis in axes.values()])))
    return axes


def _envelope(model: Model, shaft: str) -> list[BodySize]:
    """Cylinders that a shaft and its bodies fill."""
    part = model.shafts[shaft]
    cylinders = []
    left = part.start
    for section in part.sections:
        outer, _, outer_end, _ = section.stiffness_diameters()
        cylinders.append(BodySize(max(outer, outer_end), left, left + section.length))
        left += section.length
    cylinders += bodies_on(model, shaft)
    return cylinders or [BodySize(shaft_diameter(model, shaft, "start"), part.start, part.end)]


def _place_neighbours(model: Model, axes: dict[str, Axis], envelopes: dict[str, list[BodySize]]) -> bool:
    """Place one shaft that is coupled to or in mesh with a placed one; whether there was one."""
    # Coupled shafts are in line where there is room, else they are placed by what they mesh with.
    for coupling in model.couplings.values():
        for known, new in _both_ways(coupling.from_shaft, coupling.to_shaft):
            if known in axes and new not in axes and _free(axes[known], new, axes, envelopes):
                axes[new] = axes[known]
                return True
    for mesh in model.meshes.values():
        for one, other in _both_ways(mesh.pinion, mesh.gear):
            known = model.layout.gear(one).shaft
            new = model.layout.gear(other).shaft
            if known not in axes or new in axes:
                continue
            turn = math.pi if one == mesh.gear else 0.0
            given = mesh.centre_line_angle
            directions = _DIRECTIONS if given is None else (given + turn,)
            distance = pitch_radius(model, one) + pitch_radius(model, other)
            x, y = axes[known]
            places = [(x + distance * math.cos(angle), y + distance * math.sin(angle)) for angle in directions]
            axes[new] = next((at for at in places if given is not None or _free(at, new, axes, envelopes)), places[0])
            return True
    return False


def _both_ways(one: str, other: str) -> tuple[tuple[str, str], tuple[str, str]]:
    return (one, other), (other, one)


def _free(at: Axis, new: str, axes: dict[str, Axis], envelopes: dict[str, list[BodySize]]) -> bool:
    """Whether a shaft's cylinders have room at an axis."""
    for name, other in axes.items():
        distance = math.hypot(at[0] - other[0], at[1] - other[1])
        for a in envelopes[new]:
            for b in envelopes[name]:
                same_place = min(a.high, b.high) > max(a.low, b.low) or (a.low == b.low and a.high == b.high)
                if same_place and distance < _OVERLAP * 0.5 * (a.diameter + b.diameter):
                    return False
    return True
