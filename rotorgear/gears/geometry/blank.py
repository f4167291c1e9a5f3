"""Gear blanks made of concentric hollow cylinders: their shape, mass and moments of inertia.

m = rho pi (D^2 - d^2) w / 4,   I_p = m (D^2 + d^2) / 8,   I_d = I_p / 2 + m w^2 / 12 about the centre of mass;
off-centre parts by the parallel-axis theorem. The teeth count as a solid ring up to the reference diameter.
Reference: any text on rigid-body mechanics. SI units. An impossible shape raises ValueError with a sentence; the caller
knows the address.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

# Radius over that of the root of the core that is held where shaft and gear are one.
_CORE = 0.1


@dataclass(frozen=True)
class RigidBody:
    """A body of revolution: mass (kg), polar and diametral moment of inertia (kg m^2) about its centre of mass."""

    mass: float
    polar_inertia: float
    diametral_inertia: float


@dataclass(frozen=True)
class BlankShape:
    """Sizes of the blank of one helix, in m or in normal modules; its rim is as wide as the face.

    Attributes:
        bore_radius: where it is held.
        rim_radius: inside of the rim; the bore's for a solid blank.
        web_thickness: along the axis.
        web_position: of the web's middle along the axis, from the middle of the face.
        hub_radius: outside of the hub; the bore's where the web reaches the bore.
        hub_width: along the axis, about the middle of the face.
    """

    bore_radius: float
    rim_radius: float
    web_thickness: float
    web_position: float
    hub_radius: float
    hub_width: float

    @property
    def is_solid(self) -> bool:
        """Whether there is neither web nor hub."""
        return self.rim_radius <= self.bore_radius

    def with_core(self, root_radius: float) -> BlankShape:
        """The same; where shaft and gear are one, with a held core too small to matter."""
        core = max(self.bore_radius, _CORE * root_radius)
        return replace(
            self, bore_radius=core, rim_radius=max(self.rim_radius, core), hub_radius=max(self.hub_radius, core)
        )

    def scaled(self, factor: float) -> BlankShape:
        """All lengths times a factor."""
        return BlankShape(**{size.name: factor * getattr(self, size.name) for size in fields(self)})

    def mirrored(self) -> BlankShape:
        """The blank seen from the other end of its axis."""
        return replace(self, web_position=-self.web_position)


def solid_blank(bore_radius: float) -> BlankShape:
    """A full disc."""
    return BlankShape(bore_radius, bore_radius, 0.0, 0.0, bore_radius, 0.0)


def _require_positive(**lengths: float) -> None:
    """ValueError unless every named value is positive and finite."""
    for name, value in lengths.items():
        if not 0.0 < value < math.inf:
            raise ValueError(f"the {name.replace('_', ' ')} must be positive and finite, not {value:g}")


def _mm(length: float) -> str:
    return f"{1e3 * length:.6g} mm"


def _require(holds: bool, sentence: str) -> None:
    """ValueError with a sentence unless a condition holds."""
    if not holds:
        raise ValueError(sentence)


def hollow_cylinder(outer_diameter: float, bore: float, width: float, density: float) -> RigidBody:
    """A cylinder (m, m, m, kg/m^3), solid for bore = 0; ValueError unless 0 <= bore < outer diameter."""
    _require_positive(outer_diameter=outer_diameter, width=width, density=density)
    _require(
        0.0 <= bore < outer_diameter,
        f"the bore of {_mm(bore)} must be 0 or more and below the outer diameter of {_mm(outer_diameter)}",
    )
    # (D - d)(D + d), not D^2 - d^2, which would cancel in a thin ring.
    mass = density * math.pi / 4 * (outer_diameter - bore) * (outer_diameter + bore) * width
    polar = mass * (outer_diameter**2 + bore**2) / 8
    return RigidBody(mass, polar, polar / 2 + mass * width**2 / 12)


def mass_centre(bodies: Sequence[RigidBody], offsets: Sequence[float]) -> float:
    """Axial position (m) of the common centre of mass of coaxial bodies whose own centres lie at `offsets` (m)."""
    if not bodies or len(bodies) != len(offsets):
        raise ValueError(f"give one offset for each body and at least one body, not {len(offsets)} for {len(bodies)}")
    return sum(body.mass * z for body, z in zip(bodies, offsets, strict=True)) / sum(body.mass for body in bodies)


def stack(bodies: Sequence[RigidBody], offsets: Sequence[float]) -> RigidBody:
    """Coaxial bodies with centres at axial `offsets` (m) as one body about their common `mass_centre`."""
    centre = mass_centre(bodies, offsets)
    shifted = (body.mass * (z - centre) ** 2 for body, z in zip(bodies, offsets, strict=True))
    return RigidBody(
        mass=sum(body.mass for body in bodies),
        polar_inertia=sum(body.polar_inertia for body in bodies),
        diametral_inertia=sum(body.diametral_inertia for body in bodies) + sum(shifted),
    )


def gear_blank(
    reference_diameter: float,
    bore: float,
    width: float,
    density: float,
    *,
    root_diameter: float | None = None,
    rim_thickness: float | None = None,
    web_thickness: float | None = None,
    web_position: float = 0.0,
    hub_diameter: float | None = None,
    hub_width: float | None = None,
) -> RigidBody:
    """A gear body, one helix, all parts concentric, about the middle of the face (m, kg/m^3).

    Without rim_thickness: a solid ring from the bore to the reference diameter. With it: a rim from
    root_diameter - 2 rim_thickness to the reference diameter, a web of web_thickness, its middle at web_position from that of
    the face, and a hub (hub_width, or as wide as the gear) around the bore; without hub_diameter the web reaches the bore.

    Raises:
        ValueError: parts that don't fit, or one without another that it needs.
    """
    if rim_thickness is None:
        if web_position or any(part is not None for part in (web_thickness, hub_diameter, hub_width)):
            raise ValueError(
                "a web or a hub needs a rim: give the rim thickness as well, or leave them out for a solid blank"
            )
        return hollow_cylinder(reference_diameter, bore, width, density)
    if root_diameter is None or web_thickness is None:
        raise ValueError("a gear with a rim needs its root diameter and its web thickness as well")
    if hub_diameter is None and hub_width is not None:
        raise ValueError("a hub width needs a hub diameter: give it as well, or leave the hub width out")
    _require_positive(face_width=width, rim_thickness=rim_thickness, web_thickness=web_thickness)

    # The rim is measured from the root circle, as gear standards do (s_R of ISO 6336-1).
    rim_inside = root_diameter - 2.0 * rim_thickness
    _require(
        rim_inside > 0.0,
        f"a rim {_mm(rim_thickness)} thick leaves no room inside the root diameter of {_mm(root_diameter)}",
    )
    web_inside = bore if hub_diameter is None else hub_diameter
    _require(
        rim_inside > web_inside,
        f"the rim's inner diameter of {_mm(rim_inside)} must be above the diameter of {_mm(web_inside)} of the hub or bore "
        "inside it: make the rim thinner, or leave it out for a solid blank",
    )
    web = f"a web {_mm(web_thickness)} thick"
    _require(web_thickness <= width, f"{web} is wider than the face width of {_mm(width)}")
    # The end of the web that is farther from the middle of the face.
    reach = abs(web_position) + 0.5 * web_thickness
    web += f" at {_mm(web_position)} from the middle of the face reaches beyond"
    _require(reach <= 0.5 * width * (1.0 + 1e-9), f"{web} the face width of {_mm(width)}")
    parts = [
        hollow_cylinder(reference_diameter, rim_inside, width, density),
        hollow_cylinder(rim_inside, web_inside, web_thickness, density),
    ]
    offsets = [0.0, web_position]
    if hub_diameter is not None:
        hub_width = width if hub_width is None else hub_width
        _require(hub_diameter > bore, f"the hub diameter of {_mm(hub_diameter)} must be above the bore of {_mm(bore)}")
        _require(
            hub_width >= web_thickness,
            f"a hub {_mm(hub_width)} wide is narrower than its web of {_mm(web_thickness)}",
        )
        _require(reach <= 0.5 * hub_width * (1.0 + 1e-9), f"{web} the hub, {_mm(hub_width)} wide")
        parts.append(hollow_cylinder(hub_diameter, bore, hub_width, density))
        offsets.append(0.0)
    # About the middle of the face: a web off the middle adds m e^2.
    whole = stack(parts, offsets)
    arm = mass_centre(parts, offsets)
    return replace(whole, diametral_inertia=whole.diametral_inertia + whole.mass * arm**2)
