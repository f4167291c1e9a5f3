"""Surfaces of bearings, supports and couplings: rings and signs that stretch between what they join, as springs do."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rotorgear.export.attachment import Attachment, Skeleton
from rotorgear.export.parts import Detail, Piece
from rotorgear.export.sizes import shaft_diameter
from rotorgear.export.surface import Surface, beam, hollow_cylinder, join, make_surface, wedge
from rotorgear.model.model import Model
from rotorgear.model.parts.supports import Bearing, Coupling

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


def bearing_pieces(model: Model, skeleton: Skeleton, detail: Detail) -> Iterator[Piece]:
    """Yield each bearing as a ring between shaft and housing, and a foot between housing and ground."""
    for name, bearing in model.bearings.items():
        z = model.layout.place(f"bearings.{name}").z
        radius = 0.5 * shaft_diameter(model, bearing.shaft, bearing.at)
        half = _RING_HALF * radius
        housing = _RING * radius
        axis = (*skeleton.axes[bearing.shaft], 0.0)
        ring = hollow_cylinder(housing, radius, z - half, z + half, detail.segments).moved(axis)
        foot = wedge(-housing, -housing - _FOOT_HEIGHT * radius, _FOOT_HALF * radius, z - half, z + half).moved(axis)
        if bearing.casing is not None:
            yield Piece(
                f"bearings.{name}", "bearing", bearing.shaft, ring, _seated(skeleton, bearing, z, ring, housing)
            )
            continue
        on_shaft = np.hypot(*(ring.points - np.array(axis))[:, :2].T) < 0.5 * (radius + housing)
        on_ground = np.array([False, True, True] * 2)
        surface = join([ring, foot])
        # The ring stretches from the shaft to the housing, the foot from the housing to the ground.
        ground = skeleton.on_ground(surface.points)
        held = skeleton.on_pedestal(name, surface.points) if bearing.pedestal else ground
        carried = skeleton.rigid(bearing.shaft, z, surface.points)
        attachment = _select([held, carried, ground], np.concatenate([on_shaft.astype(int), 2 * on_ground]))
        yield Piece(f"bearings.{name}", "bearing", bearing.shaft, surface, attachment)


def _seated(skeleton: Skeleton, bearing: Bearing, z: float, ring: Surface, housing: float) -> Attachment:
    """What carries the ring of a bearing in a casing: inside the shaft, outside the casing, which is nearest there."""
    assert bearing.casing is not None
    axis = np.array([*skeleton.axes[bearing.shaft], 0.0])
    inside = np.hypot(*(ring.points - axis)[:, :2].T) < (1.0 - 1e-9) * housing
    carried = skeleton.rigid(bearing.shaft, z, ring.points)
    return _select([skeleton.on_casing(bearing.casing, ring.points), carried], inside.astype(int))


def casing_pieces(model: Model, skeleton: Skeleton, detail: Detail) -> Iterator[Piece]:
    """Yield the surface of each casing that has one; it belongs to no shaft."""
    for name in model.casings:
        surface = model.layout.casing(name).surface
        if surface is not None:
            placed = make_surface(surface.points, [], [surface.triangles])
            yield Piece(f"casings.{name}", "casing", "", placed, skeleton.on_casing(name, placed.points))


def support_pieces(model: Model, skeleton: Skeleton, detail: Detail) -> Iterator[Piece]:
    """Yield each support as the sign for the ground below the shaft."""
    for name, support in model.supports.items():
        z = model.layout.place(f"supports.{name}").z
        radius = 0.5 * shaft_diameter(model, support.shaft, support.at)
        bottom = -(1.0 + _SIGN_HEIGHT) * radius
        thickness = _SIGN_THICKNESS * radius
        surface = wedge(-radius, bottom, _SIGN_HALF * radius, z - thickness, z + thickness)
        surface = surface.moved((*skeleton.axes[support.shaft], 0.0))
        carried = skeleton.rigid(support.shaft, z, surface.points)
        attachment = _select([carried, skeleton.on_ground(surface.points)], np.array([0, 1, 1] * 2))
        yield Piece(f"supports.{name}", "support", support.shaft, surface, attachment)


def coupling_pieces(model: Model, skeleton: Skeleton, detail: Detail) -> Iterator[Piece]:
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
            flange = flange.moved((*skeleton.axes[shaft], 0.0))
            carried = skeleton.rigid(shaft, z, flange.points)
            yield Piece(f"couplings.{name}", "coupling", shaft, flange, carried)
        yield from _link(model, skeleton, name, coupling, radius, detail)


def _link(
    model: Model, skeleton: Skeleton, name: str, coupling: Coupling, radius: float, detail: Detail
) -> Iterator[Piece]:
    """Yield a sleeve between flanges that face each other, or a bar to a shaft that is shown beside the first."""
    shafts = coupling.from_shaft, coupling.to_shaft
    z = [place.z for place in model.layout.places(f"couplings.{name}")]
    start, end = (np.array([*skeleton.axes[s], place]) for s, place in zip(shafts, z, strict=True))
    if np.allclose(start, end, rtol=0.0, atol=1e-6 * radius):
        return
    if np.allclose(start[:2], end[:2], rtol=0.0, atol=1e-6 * radius):
        sleeve = hollow_cylinder(_SLEEVE * radius, 0.9 * _SLEEVE * radius, min(z), max(z), detail.segments)
        surface = sleeve.moved((*start[:2], 0.0))
        to_second = np.abs(surface.points[:, 2] - z[1]) < np.abs(surface.points[:, 2] - z[0])
    else:
        surface = beam(start, end, 0.3 * radius)
        to_second = np.arange(8) >= 4
    carried = [skeleton.rigid(s, place, surface.points) for s, place in zip(shafts, z, strict=True)]
    yield Piece(f"couplings.{name}", "coupling", shafts[0], surface, _select(carried, to_second.astype(int)))


def _select(choices: list[Attachment], which: np.ndarray) -> Attachment:
    """For each point one of several attachments."""
    rows = np.arange(len(which))
    names = Attachment.__dataclass_fields__
    return Attachment(**{name: np.stack([getattr(c, name) for c in choices])[which, rows] for name in names})
