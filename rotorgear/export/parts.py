"""Surfaces of the parts of a gearbox, and what carries their points: bearings, supports and couplings stretch as springs do."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rotorgear.export.attachment import Attachment, Skeleton
from rotorgear.export.layout import (
    RING,
    ball_radius,
    disk_size,
    gear_size,
    helix_width,
    hidden_hole,
    pitch_radius,
    shaft_diameter,
)
from rotorgear.export.surface import (
    Surface,
    ball,
    beam,
    hollow_cylinder,
    join,
    make_surface,
    revolve,
    twisted_prism,
    wedge,
)
from rotorgear.export.teeth import DISK_GROOVES, contour_of, grooved_contour, tooth_phases, twist_rates
from rotorgear.model.layout.gear_layout import GearLayout
from rotorgear.model.model import Model
from rotorgear.model.parts.shaft import Shaft
from rotorgear.results.modal import body_name

# Stripes along a shaft, by which its twist is seen: how many, half their width in rad, and their height relative to the radius.
_STRIPES = 4
_STRIPE_HALF = math.radians(3.0)
_STRIPE_HEIGHT = 0.015
# A hole leaves at least a tenth of a body's least radius.
_LARGEST_HOLE = 0.9


@dataclass(frozen=True)
class Detail:
    """How fine the surfaces are.

    Attributes:
        segments: straight pieces around a shaft.
        slices: least number of pieces along a shaft.
        flank_points: points on a tooth flank from root to tip.
        arc_points: points between two grooves of a plain cylinder.
        twist_step: largest twist in rad between two points along a tooth.
    """

    segments: int
    slices: int
    flank_points: int
    arc_points: int
    twist_step: float


# For files that are to be small, and for pictures.
LIGHT = Detail(segments=24, slices=16, flank_points=2, arc_points=4, twist_step=math.radians(13.0))
FINE = Detail(segments=64, slices=32, flank_points=3, arc_points=8, twist_step=math.radians(5.0))


@dataclass(frozen=True)
class PartSurface:
    """One surface of a part: the part's address, what kind it is, the name of its shaft."""

    part: str
    kind: str
    shaft: str
    surface: Surface
    attachment: Attachment


def shaft_surfaces(model: Model, skeleton: Skeleton, detail: Detail) -> Iterator[PartSurface]:
    """Yield each shaft as a body of revolution with its steps, cones and bores, and stripes along it."""
    for name, shaft in model.shafts.items():
        if not shaft.sections:
            continue
        outer = _outline(shaft, shaft.length / detail.slices, bore=False)
        contour = np.vstack([outer, _outline(shaft, shaft.length / detail.slices, bore=True)[::-1]])
        for kind, surface in (
            ("shaft", revolve(contour, detail.segments, closed=True)),
            ("stripe", join([_stripe(outer, 2.0 * math.pi * k / _STRIPES) for k in range(_STRIPES)])),
        ):
            placed = skeleton.placed(name, surface)
            yield PartSurface(f"shafts.{name}", kind, name, placed, skeleton.along(name, placed.points))


def _outline(shaft: Shaft, step: float, bore: bool) -> np.ndarray:
    """Outer surface or bore of a shaft as (k, 2) radius and z from left to right, no two points the same."""
    points: list[tuple[float, float]] = []
    z = shaft.start
    for section in shaft.sections:
        outer, inner, outer_end, inner_end = section.stiffness_diameters()
        left, right = (inner, inner_end) if bore else (outer, outer_end)
        pieces = 1 if left == right == 0.0 else max(math.ceil(section.length / step - 1e-9), 1)
        share = np.linspace(0.0, 1.0, pieces + 1)
        radii = 0.5 * (left + (right - left) * share)
        points += zip(radii.tolist(), (z + section.length * share).tolist(), strict=True)
        z += section.length
    # Of two equal points, at a joint of sections of one diameter, the second stays: no cell of zero area.
    kept = [a for a, b in zip(points, [*points[1:], None], strict=True) if a != b]
    return np.array(kept)


def _stripe(outer: np.ndarray, angle: float) -> Surface:
    """A strip on the shaft's surface at an angle."""
    radius = outer[:, 0] * (1.0 + _STRIPE_HEIGHT)
    z = outer[:, 1]
    sides = (angle - _STRIPE_HALF, angle + _STRIPE_HALF)
    edges = [np.column_stack([radius * np.cos(a), radius * np.sin(a), z]) for a in sides]
    low = np.arange(len(z))
    high = len(z) + np.arange(len(z))
    return make_surface(np.vstack(edges), [np.column_stack([low[:-1], high[:-1], high[1:], low[1:]])])


def gear_surfaces(model: Model, skeleton: Skeleton, detail: Detail) -> Iterator[PartSurface]:
    """Yield the helices of each gear with their teeth, and the web and hub of one that has them."""
    phases = tooth_phases(model, skeleton.frames)
    for gear in model.layout.gears:
        for number, (plane, rate) in enumerate(zip(gear.planes, twist_rates(gear), strict=True)):
            if gear.part.is_bevel:
                surface = _cone(model, gear, detail)
            elif gear.part.internal and gear.geometry is None:
                inner = pitch_radius(model, gear.name)
                half = 0.5 * helix_width(model, gear.name)
                surface = hollow_cylinder(RING * inner, inner, plane - half, plane + half, 2 * detail.segments)
            else:
                surface = _helix(model, gear.name, plane, rate, phases[gear.name], detail)
            placed = skeleton.placed(gear.shaft, surface)
            place = gear.places[number if len(gear.places) == 2 else 0]
            wheel = gear.wheel
            if wheel is None or wheel.surface is None:
                attachment = skeleton.rigid(*place, placed.points)
            else:
                # The teeth move with the rim.
                body = body_name(gear.name)
                attachment = skeleton.on_casing(body, placed.points)
                shown = make_surface(wheel.surface.points, [], [wheel.surface.triangles])
                shown = skeleton.placed(gear.shaft, shown, place.z)
                yield PartSurface(
                    f"gears.{gear.name}", "gear", gear.shaft, shown, skeleton.on_casing(body, shown.points)
                )
            yield PartSurface(f"gears.{gear.name}", "gear", gear.shaft, placed, attachment)


def _cone(model: Model, gear: GearLayout, detail: Detail) -> Surface:
    """The pitch cone of a bevel gear about its own axis, over its face."""
    mesh = next((mesh for mesh in model.layout.meshes if gear in mesh.gears), None)
    z = gear.z
    half = 0.5 * helix_width(model, gear.name)
    radius = half
    rise = 0.0
    if mesh is not None and mesh.bevel is not None and mesh.meeting is not None:
        number = mesh.gears.index(gear)
        delta = mesh.bevel.pitch_angles[number]
        radius = mesh.bevel.mean_radii[number]
        rise = mesh.meeting.sides[number] * half * math.sin(delta)
        half *= math.cos(delta)
    hole = _hole(model, gear.shaft, z - half, z + half, None, radius - abs(rise))
    ends = [(radius - rise, z - half), (radius + rise, z + half), (hole, z + half), (hole, z - half)]
    return revolve(np.array(ends), detail.segments, closed=True)


def _helix(model: Model, name: str, plane: float, rate: float, phase: float, detail: Detail) -> Surface:
    """One helix of a gear about its own axis, with its web and hub."""
    gear = model.layout.gear(name).part
    half = 0.5 * helix_width(model, name)
    angles, radii = contour_of(model, name, pitch_radius(model, name), detail.flank_points, detail.arc_points)
    steps = max(math.ceil(abs(rate) * 2.0 * half / detail.twist_step), 1)
    z = plane + np.linspace(-half, half, steps + 1)
    if gear.internal:
        outer = 0.5 * gear_size(model, name).diameter
        return twisted_prism(angles + phase, radii, z, rate * (z - plane), outer)
    hole = _hole(model, gear.shaft, plane - half, plane + half, gear.body.bore, float(radii.min()))
    geometry = gear.geometry
    body = gear.body
    wheel = model.layout.gear(name).wheel
    if wheel is not None:
        hole = min(wheel.rim_radius, _LARGEST_HOLE * float(radii.min()))
    if geometry is None or body.rim_thickness is None:
        return twisted_prism(angles + phase, radii, z, rate * (z - plane), hole)

    # A rim is measured from the root circle; web and hub as wide as the helix unless they say otherwise.
    inner = max(0.5 * geometry.root_diameter - body.rim_thickness, hole)
    pieces = [twisted_prism(angles + phase, radii, z, rate * (z - plane), inner)]
    web = 0.5 * (body.web_thickness or 2.0 * half)
    middle = plane + body.web_position
    pieces.append(hollow_cylinder(inner, hole, middle - web, middle + web, detail.segments))
    if body.hub_diameter is not None:
        hub = 0.5 * (body.hub_width or 2.0 * half)
        pieces.append(hollow_cylinder(0.5 * body.hub_diameter, hole, plane - hub, plane + hub, detail.segments))
    return join(pieces)


def _hole(model: Model, shaft: str, low: float, high: float, bore: float | None, outer: float) -> float:
    """Radius of the hole of a body: its bore where that is to be seen, else one inside the wall of its shaft."""
    surface, inside = hidden_hole(model, shaft, low, high)
    radius = 0.5 * bore if bore is not None and 0.5 * bore > surface else inside
    return min(radius, _LARGEST_HOLE * outer)


def disk_surfaces(model: Model, skeleton: Skeleton, detail: Detail) -> Iterator[PartSurface]:
    """Yield each disk as a cylinder with four grooves, by which its rotation is seen."""
    for name, disk in model.disks.items():
        size = disk_size(model, name)
        angles, radii = grooved_contour(0.5 * size.diameter, DISK_GROOVES, 3 * detail.arc_points)
        hole = _hole(model, disk.shaft, size.low, size.high, disk.bore, float(radii.min()))
        surface = twisted_prism(angles, radii, np.array([size.low, size.high]), np.zeros(2), hole)
        placed = skeleton.placed(disk.shaft, surface)
        attachment = skeleton.rigid(*model.layout.place(f"disks.{name}"), placed.points)
        yield PartSurface(f"disks.{name}", "disk", disk.shaft, placed, attachment)


def point_mass_surfaces(model: Model, skeleton: Skeleton, detail: Detail) -> Iterator[PartSurface]:
    """Yield each point mass as a ball."""
    for name, point in model.point_masses.items():
        z = model.layout.place(f"point_masses.{name}").z
        placed = skeleton.placed(point.shaft, ball(ball_radius(model, name), detail.segments), z)
        attachment = skeleton.rigid(point.shaft, z, placed.points)
        yield PartSurface(f"point_masses.{name}", "point mass", point.shaft, placed, attachment)


# Sizes relative to the shaft's radius there: outer radius and half width of a bearing's ring, height and half width of its foot.
_RING = 1.55
_RING_HALF = 0.28
_FOOT_HEIGHT = 0.8
_FOOT_HALF = 0.6
# The same for a support's sign, and its half thickness.
_SIGN_HEIGHT = 1.1
_SIGN_HALF = 0.7
_SIGN_THICKNESS = 0.12
# A coupling: flange's radius and thickness, and the sleeve between two flanges.
_FLANGE = 1.35
_FLANGE_WIDTH = 0.35
_SLEEVE = 1.15


def bearing_surfaces(model: Model, skeleton: Skeleton, detail: Detail) -> Iterator[PartSurface]:
    """Yield each bearing as a ring between shaft and housing, and a foot between housing and ground."""
    for name, bearing in model.bearings.items():
        z = model.layout.place(f"bearings.{name}").z
        radius = 0.5 * shaft_diameter(model, bearing.shaft, bearing.at)
        half = _RING_HALF * radius
        housing = _RING * radius
        ring = hollow_cylinder(housing, radius, z - half, z + half, detail.segments)
        foot = wedge(-housing, -housing - _FOOT_HEIGHT * radius, _FOOT_HALF * radius, z - half, z + half)
        beside_axis = np.hypot(*ring.points[:, :2].T)
        ring, foot = (skeleton.placed(bearing.shaft, surface) for surface in (ring, foot))
        pin = model.layout.carrier_pin(f"bearings.{name}")
        if bearing.casing is not None or pin is not None:
            # Inside the shaft carries the ring, outside the casing, which is nearest there, or the carrier of a planet.
            surface = ring
            others = [
                skeleton.on_casing(bearing.casing or "", ring.points)
                if pin is None
                else skeleton.rigid(*pin[0], ring.points)
            ]
            which = (beside_axis < (1.0 - 1e-9) * housing).astype(int)
        else:
            # The ring stretches from the shaft to the housing, the foot from the housing to the ground.
            surface = join([ring, foot])
            ground = skeleton.on_ground(surface.points)
            others = [skeleton.on_pedestal(name, surface.points) if bearing.pedestal else ground, ground]
            which = np.concatenate([beside_axis < 0.5 * (radius + housing), [0, 2, 2] * 2]).astype(int)
        choices = [others[0], skeleton.rigid(bearing.shaft, z, surface.points), *others[1:]]
        yield PartSurface(f"bearings.{name}", "bearing", bearing.shaft, surface, _select(choices, which))


def casing_surfaces(model: Model, skeleton: Skeleton, detail: Detail) -> Iterator[PartSurface]:
    """Yield the surface of each casing that has one; it belongs to no shaft."""
    for name in model.casings:
        surface = model.layout.casing(name).surface
        if surface is not None:
            placed = make_surface(surface.points, [], [surface.triangles])
            yield PartSurface(f"casings.{name}", "casing", "", placed, skeleton.on_casing(name, placed.points))


def support_surfaces(model: Model, skeleton: Skeleton, detail: Detail) -> Iterator[PartSurface]:
    """Yield each support as the sign for the ground below the shaft."""
    for name, support in model.supports.items():
        z = model.layout.place(f"supports.{name}").z
        radius = 0.5 * shaft_diameter(model, support.shaft, support.at)
        bottom = -(1.0 + _SIGN_HEIGHT) * radius
        thickness = _SIGN_THICKNESS * radius
        surface = wedge(-radius, bottom, _SIGN_HALF * radius, z - thickness, z + thickness)
        surface = skeleton.placed(support.shaft, surface)
        carried = skeleton.rigid(support.shaft, z, surface.points)
        attachment = _select([carried, skeleton.on_ground(surface.points)], np.array([0, 1, 1] * 2))
        yield PartSurface(f"supports.{name}", "support", support.shaft, surface, attachment)


def coupling_surfaces(model: Model, skeleton: Skeleton, detail: Detail) -> Iterator[PartSurface]:
    """Yield the two flanges of each coupling and what joins them."""
    for name, coupling in model.couplings.items():
        ends = ((coupling.from_shaft, coupling.from_at), (coupling.to_shaft, coupling.to_at))
        middles = [0.5 * (model.shafts[shaft].start + model.shafts[shaft].end) for shaft, _ in ends]
        first_side = -1.0 if middles[0] <= middles[1] else 1.0
        radius = 0.5 * max(shaft_diameter(model, *end) for end in ends)
        for (shaft, at), side in zip(ends, (first_side, -first_side), strict=True):
            z = model.layout.at(shaft, at).z
            low, high = sorted((z, z + side * _FLANGE_WIDTH * radius))
            hole = 0.45 * model.shafts[shaft].diameter_at(z)
            flange = hollow_cylinder(_FLANGE * radius, hole, low, high, detail.segments)
            flange = skeleton.placed(shaft, flange)
            carried = skeleton.rigid(shaft, z, flange.points)
            yield PartSurface(f"couplings.{name}", "coupling", shaft, flange, carried)
        # Between them a sleeve where they face each other, or a bar to a shaft that is shown beside the first.
        shafts = coupling.from_shaft, coupling.to_shaft
        z1, z2 = (place.z for place in model.layout.places(f"couplings.{name}"))
        start = skeleton.frames[shafts[0]].at(z1)
        end = skeleton.frames[shafts[1]].at(z2)
        if np.allclose(start, end, rtol=0.0, atol=1e-6 * radius):
            continue
        beside = skeleton.frames[shafts[0]].inside(end)
        if np.allclose(beside[:2], 0.0, rtol=0.0, atol=1e-6 * radius):
            low, high = sorted((z1, float(beside[2])))
            sleeve = hollow_cylinder(_SLEEVE * radius, 0.9 * _SLEEVE * radius, low, high, detail.segments)
            to_second = np.abs(sleeve.points[:, 2] - beside[2]) < np.abs(sleeve.points[:, 2] - z1)
            surface = skeleton.placed(shafts[0], sleeve)
        else:
            surface = beam(start, end, 0.3 * radius)
            to_second = np.arange(8) >= 4
        by_ends = [skeleton.rigid(s, z, surface.points) for s, z in zip(shafts, (z1, z2), strict=True)]
        yield PartSurface(f"couplings.{name}", "coupling", shafts[0], surface, _select(by_ends, to_second.astype(int)))


def part_surfaces(model: Model, skeleton: Skeleton, detail: Detail) -> Iterator[PartSurface]:
    """Yield the surfaces of all parts of a model."""
    for of_kind in (
        shaft_surfaces,
        gear_surfaces,
        disk_surfaces,
        point_mass_surfaces,
        bearing_surfaces,
        support_surfaces,
        coupling_surfaces,
        casing_surfaces,
    ):
        yield from of_kind(model, skeleton, detail)


def _select(choices: list[Attachment], which: np.ndarray) -> Attachment:
    """For each point one of several attachments."""
    rows = np.arange(len(which))
    names = Attachment.__dataclass_fields__
    return Attachment(**{name: np.stack([getattr(c, name) for c in choices])[which, rows] for name in names})
