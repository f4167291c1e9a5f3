"""Checks of bevel pairs: two gears that fit, on axes that meet, each on its own cone."""

from __future__ import annotations

import math
from collections.abc import Iterator

from rotorgear.errors import Problem
from rotorgear.model.checks.gears import degrees
from rotorgear.model.layout.mesh_layout import MeshLayout
from rotorgear.model.parts.fields import RIGID
from rotorgear.model.parts.mesh import Mesh
from rotorgear.model.parts.problems import not_default, told
from rotorgear.quantity import millimetres

# A gear stands on its cone so far as that may be missed by this share of the mean normal module; axes meet so far as the digits
# of positions may miss it, for the contact is one point where they do.
_OFF = 0.05
_PASSING = 1e-3
# What a mesh says of cylindrical gears only.
_OF_CYLINDERS = (
    "centre_distance_allowance",
    "application_factor",
    "stagger",
    "misalignment",
    "tilt",
    "tooth_fe",
    "contact_position",
    "centre_line_angle",
    "pressure_angle",
    "helix_index_error",
    "friction_coefficient",
    "lubricant_viscosity",
)
_SAME = ("mean_normal_module", "outer_module", "normal_pressure_angle", "spiral_angle")


def bevel_problems(address: str, both: MeshLayout) -> Iterator[Problem]:
    """Yield what keeps two bevel gears from meshing on their shafts."""
    found = [*_settings(address, both.part), *_mates(address, both)]
    yield from found
    if not found:
        yield from _places(address, both)


def _settings(address: str, mesh: Mesh) -> Iterator[Problem]:
    for key in not_default(mesh, _OF_CYLINDERS):
        yield Problem(f"{address}.{key}", "a value", "nothing here", "it is not known of bevel gears")
    if isinstance(mesh.stiffness, str) and mesh.stiffness not in ("iso", RIGID):
        wanted = "a stiffness such as '5e8 N/m', or 'iso', the estimate of ISO 10300-1"
        yield Problem(
            f"{address}.stiffness", f"'{mesh.stiffness}' of bevel gears", wanted, "their teeth are not modelled"
        )


def _mates(address: str, both: MeshLayout) -> Iterator[Problem]:
    """Two gears of one module, pressure and spiral angle, and of opposite hands."""
    pinion = both.pinion.part
    gear = both.gear.part
    for key in _SAME:
        first = getattr(pinion, key)
        second = getattr(gear, key)
        if (first is None) != (second is None) or (first and not math.isclose(first, second, rel_tol=1e-9)):
            one, other = (
                "none" if x is None else millimetres(x) if key.endswith("module") else degrees(x)
                for x in (first, second)
            )
            text = f"a {key.replace('_', ' ')} of {one} on the pinion and {other} on the gear"
            yield Problem(address, text, "the same on both")
    same = pinion.hand is not None and pinion.hand == gear.hand
    hint = "bevel gears have opposite hands"
    yield from told(address, ("", same, f"two {pinion.hand}-hand gears", "a right-hand and a left-hand one", hint))


def _places(address: str, both: MeshLayout) -> Iterator[Problem]:
    met = both.meeting
    pair = both.bevel
    if both.pinion.shaft_part.origin is None or both.gear.shaft_part.origin is None:
        yield Problem(address, "bevel gears on shafts without a position", "positions of both shafts")
        return
    if met is None or pair is None:
        yield Problem(address, "bevel gears on parallel axes", "axes that meet", "give one of the shafts its axis")
        return
    slack = _OFF * pair.normal_module
    if pair.mean_cone_distance <= 0.0 or pair.normal_module <= 0.0:
        yield Problem(address, "a face that reaches beyond the apex", "a smaller width or a larger module")
        return
    if met.apart > _PASSING * pair.normal_module:
        hint = "hypoid gears, with axes that pass each other, are not built"
        got = f"axes that pass each other at {1e3 * met.apart:.6g} mm"
        yield Problem(address, got, "axes that meet", hint)
        return
    for gear, angle in zip(both.gears, pair.pitch_angles, strict=True):
        if not 0.0 < angle < 0.5 * math.pi - 1e-9:
            hint = "internal bevel and crown gears are not built: check the axes, and on which side of the apex the gears are"
            yield Problem(f"gears.{gear.name}", f"a pitch angle of {degrees(angle)}", "one below 90 deg", hint)
            return
    for gear, apex, side, distance in zip(both.gears, met.apex, met.sides, pair.mean_distances, strict=True):
        wanted = apex + side * distance
        if abs(gear.z - wanted) > slack:
            hint = f"its mean point lies {millimetres(distance)} from the apex, which is at z = {millimetres(apex)}"
            yield Problem(f"gears.{gear.name}.at", millimetres(gear.z), f"{millimetres(wanted)} on its cone", hint)
