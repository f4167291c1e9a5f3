"""How large the parts are shown, and where: sizes that the model gives or plausible ones, and the axes of the shafts.

A disk with mass m and polar inertia J is shown as a solid cylinder, D = sqrt(8 J/m), w = 4 m/(pi rho D^2); one without mass as a
cylinder of width D/5, D^5 = 160 J/(pi rho). A lumped gear is shown with its pitch cylinder r = r_b/cos a. Shafts stand at their
positions; those without one beside their mates in mesh, in line with what they are coupled to, or else side by side.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import permutations

import numpy as np

from rotorgear.model.model import Model
from rotorgear.model.parts.frame import Frame, frame_along

# A shaft without sections has no diameter: parts that need one take this share of its largest body, or this many m.
NOMINAL_SHARE = 0.2
NOMINAL_DIAMETER = 0.02
# A lumped gear without a width is shown this wide, relative to its pitch radius.
LUMPED_WIDTH = 0.3
# A ring is shown with this outer radius, relative to its pitch radius.
RING = 1.15


@dataclass(frozen=True)
class BodySize:
    """A cylinder about a shaft: outer diameter and the range of z it covers, in m."""

    diameter: float
    low: float
    high: float


def pitch_radius(model: Model, name: str) -> float:
    """Working pitch radius in m of a gear in its first mesh; without a mesh that of its own pressure angle."""
    gear = model.layout.gear(name)
    for mesh in model.layout.meshes:
        if gear in mesh.gears:
            return gear.base_radius / math.cos(mesh.pressure_angle)
    geometry = gear.geometry
    angle = geometry.transverse_pressure_angle if geometry else gear.part.transverse_pressure_angle or 0.0
    return gear.base_radius / math.cos(angle)


def helix_width(model: Model, name: str) -> float:
    """Width in m of one helix as it is shown."""
    return model.layout.gear(name).part.width or LUMPED_WIDTH * pitch_radius(model, name)


def gear_size(model: Model, name: str) -> BodySize:
    """Tip cylinder of a gear over all its helices, of a ring its outer surface."""
    gear = model.layout.gear(name)
    geometry = gear.geometry
    diameter = geometry.effective_tip_diameter if geometry else 2.0 * pitch_radius(model, name)
    if gear.part.internal:
        diameter = gear.ring_diameter or RING * abs(geometry.root_diameter if geometry else diameter)
    planes = gear.planes
    half = 0.5 * helix_width(model, name)
    return BodySize(diameter, planes[0] - half, planes[-1] + half)


def disk_size(model: Model, name: str) -> BodySize:
    """Cylinder of a disk, never thinner than the shaft it sits on."""
    disk = model.disks[name]
    shaft = model.shafts[disk.shaft]
    z = model.layout.place(f"disks.{name}").z
    density = model.material_of(disk.shaft, name=disk.material).density
    mass = disk.mass or 0.0
    inertia = disk.polar_inertia or 2.0 * (disk.diametral_inertia or 0.0)
    if disk.outer_diameter is not None and disk.width is not None:
        diameter = disk.outer_diameter
        width = disk.width
    elif mass > 0.0 and inertia > 0.0:  # m = rho pi D^2 w / 4, J = m D^2 / 8
        diameter = math.sqrt(8.0 * inertia / mass)
        width = 4.0 * mass / (math.pi * density * diameter**2)
    elif inertia > 0.0:  # the same with w = D / 5
        diameter = (160.0 * inertia / (math.pi * density)) ** 0.2
        width = diameter / 5.0
    else:
        diameter = (20.0 * mass / (math.pi * density)) ** (1.0 / 3.0)
        width = diameter / 5.0
    diameter = max(diameter, 1.3 * shaft.diameter_at(z)) or NOMINAL_DIAMETER
    width = width or 0.2 * diameter
    return BodySize(diameter, z - 0.5 * width, z + 0.5 * width)


def ball_radius(model: Model, name: str) -> float:
    """Radius in m of a point mass as a ball of the shaft's material, at least a little above the shaft's surface."""
    point = model.point_masses[name]
    volume = point.mass / model.material_of(point.shaft).density
    return max((0.75 * volume / math.pi) ** (1.0 / 3.0), 0.55 * shaft_diameter(model, point.shaft, point.at))


def shaft_diameter(model: Model, shaft: str, at: float | str) -> float:
    """Diameter in m of a shaft at a place, or a nominal one for a shaft without sections; never 0."""
    diameter = model.shafts[shaft].diameter_at(model.layout.at(shaft, at).z)
    if diameter:
        return diameter
    bodies = [body.diameter for body in bodies_on(model, shaft)]
    return NOMINAL_SHARE * max(bodies) if bodies else NOMINAL_DIAMETER


def hidden_hole(model: Model, shaft: str, low: float, high: float) -> tuple[float, float]:
    """Smallest outer radius in m of a shaft between two values of z, and a radius inside its wall there; 0, 0 without sections.

    The second is 0 for a solid shaft: a body may close its hole where nobody looks.
    """
    left = model.shafts[shaft].start
    outer = [0.0]
    bore = [0.0]
    for section in model.shafts[shaft].sections:
        if left < high and left + section.length > low:
            diameters = section.stiffness_diameters()
            outer.append(0.5 * min(diameters[0::2]))
            bore.append(0.5 * max(diameters[1::2]))
        left += section.length
    least = min(outer[1:], default=0.0)
    return least, 0.5 * (least + max(bore)) if max(bore) > 0.0 else 0.0


def bodies_on(model: Model, shaft: str) -> list[BodySize]:
    """Sizes of all gears and disks on a shaft."""
    gears = [gear_size(model, name) for name, gear in model.gears.items() if gear.shaft == shaft]
    return gears + [disk_size(model, name) for name, disk in model.disks.items() if disk.shaft == shaft]


Axis = tuple[float, float]
# Directions in which a mate without a given centre-line angle is tried, in rad from +x.
_DIRECTIONS = tuple(math.radians(angle) for angle in (0, 60, -60, 90, -90, 120, -120, 180, 30, -30, 150, -150))
# Gears in mesh overlap by the depth of their teeth; what overlaps more than this is in the way.
_OVERLAP = 0.85


def display_frames(model: Model) -> dict[str, Frame]:
    """Frames of all shafts as they are shown, in the order of the file: their own, or beside their mates."""
    given = {name: shaft.origin for name, shaft in model.shafts.items()}
    if all(given.values()):
        return {name: shaft.frame for name, shaft in model.shafts.items()}
    # Axes that are not parallel to z, and planets with axes of their own, have positions.
    axes = _display_axes(model)
    return {
        name: shaft.frame if given[name] else frame_along(axes[name], (0.0, 0.0, 1.0), None)
        for name, shaft in model.shafts.items()
    }


def _display_axes(model: Model) -> dict[str, Axis]:
    """Axis (x, y) in m of every shaft for display, shaft -> (x, y)."""
    # Given positions are kept. Their neighbours are placed one by one; a shaft that no neighbour leads to begins a group of its
    # own, to the right of all others.
    axes: dict[str, Axis] = {
        name: (shaft.origin[0], shaft.origin[1]) for name, shaft in model.shafts.items() if shaft.origin is not None
    }
    envelopes = {}
    for name, part in model.shafts.items():
        # Cylinders that a shaft and its bodies fill.
        cylinders = []
        left = part.start
        for section in part.sections:
            outer, _, outer_end, _ = section.stiffness_diameters()
            cylinders.append(BodySize(max(outer, outer_end), left, left + section.length))
            left += section.length
        cylinders += bodies_on(model, name)
        envelopes[name] = cylinders or [BodySize(shaft_diameter(model, name, "start"), part.start, part.end)]
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


def _place_neighbours(model: Model, axes: dict[str, Axis], envelopes: dict[str, list[BodySize]]) -> bool:
    """Place one shaft that is coupled to or in mesh with a placed one; whether there was one."""
    # Coupled shafts are in line where there is room, else they are placed by what they mesh with.
    for coupling in model.couplings.values():
        for known, new in permutations((coupling.from_shaft, coupling.to_shaft)):
            if known in axes and new not in axes and _free(axes[known], new, axes, envelopes):
                axes[new] = axes[known]
                return True
    for mesh in model.meshes.values():
        for one, other in permutations((mesh.pinion, mesh.gear)):
            known = model.layout.gear(one).shaft
            new = model.layout.gear(other).shaft
            if known not in axes or new in axes:
                continue
            turn = math.pi if one == mesh.gear else 0.0
            given = mesh.centre_line_angle
            directions = _DIRECTIONS if given is None else (given + turn,)
            radii = pitch_radius(model, one), pitch_radius(model, other)
            ring = model.layout.gear(mesh.gear).part.internal
            distance = abs(radii[0] - radii[1]) if ring else sum(radii)
            x, y = axes[known]
            places = [(x + distance * math.cos(angle), y + distance * math.sin(angle)) for angle in directions]
            axes[new] = next((at for at in places if given is not None or _free(at, new, axes, envelopes)), places[0])
            return True
    return False


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
