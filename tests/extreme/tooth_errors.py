"""Errors of gear sheets, meshes and transients at the borders of what teeth can be."""

from __future__ import annotations

import mpmath as mp
import numpy as np

import rotorgear as rg


def pair_of(
    teeth: tuple[int, int], *, shift: tuple[float, float] = (0.0, 0.0), module: float = 2e-3, **gears: object
) -> rg.Model:
    """A spur pair at the working distance without backlash."""
    alpha = mp.radians(20)
    inv = mp.tan(alpha) - alpha + 2 * mp.tan(alpha) * mp.mpf(sum(shift)) / sum(teeth)
    working = mp.findroot(lambda a: mp.tan(a) - a - inv, 0.37)
    distance = float(mp.mpf(module) * sum(teeth) / 2 * mp.cos(alpha) / mp.cos(working))
    parts = {
        name: rg.Gear(
            shaft=name, at=0.02, kind="spur", teeth=z, normal_module=module, width=20e-3, profile_shift=x, **gears
        )
        for name, z, x in zip("ab", teeth, shift, strict=True)
    }
    section = rg.Section(length=0.04, outer_diameter=10e-3 * module / 2e-3)
    return rg.Model(
        shafts={name: rg.Shaft(position=(at, 0.0), sections=(section,)) for name, at in (("a", 0.0), ("b", distance))},
        gears=parts,
        meshes={"m": rg.Mesh(pinion="a", gear="b", stiffness=1e8)},
        operation=rg.Operation(input_shaft="a", output_shaft="b", torque=5e3 * module, speed=100.0),
    )


def exact_contact_ratio(teeth: tuple[int, int], addendum: float, module: float = 2e-3) -> mp.mpf:
    """eps = (sqrt(ra1^2 - rb1^2) + sqrt(ra2^2 - rb2^2) - a sin alpha) / (pi m cos alpha), unshifted."""
    alpha = mp.radians(20)
    m = mp.mpf(module)
    path = -m * sum(teeth) / 2 * mp.sin(alpha)
    for z in teeth:
        path += mp.sqrt((m * z / 2 + mp.mpf(addendum) * m) ** 2 - (m * z / 2 * mp.cos(alpha)) ** 2)
    return path / (mp.pi * m * mp.cos(alpha))


def addendum_for(teeth: tuple[int, int], ratio: float) -> float:
    """Addendum factor at which the contact ratio is just `ratio`."""
    return float(mp.findroot(lambda h: exact_contact_ratio(teeth, h) - mp.mpf(ratio), 0.8))


def contact_ratio(teeth: tuple[int, int], wanted: float, off: float = 0.0, module: float = 2e-3) -> float:
    """Contact ratio of the gear sheet at an addendum that gives `wanted`, moved by a relative `off`."""
    addendum = addendum_for(teeth, wanted) * (1.0 + off)
    sheet = rg.gear(pair_of(teeth, module=module, addendum_factor=addendum))
    exact = exact_contact_ratio(teeth, addendum, module)
    return float(abs(mp.mpf(sheet.meshes[0].transverse_contact_ratio) / exact - 1))


def broken_contact(teeth: tuple[int, int]) -> float:
    """A contact ratio just below 1 must be told, just above 1 it must not: 0 where both are so."""
    said = []
    for off in (-1e-6, 1e-6):
        model = pair_of(teeth, addendum_factor=addendum_for(teeth, 1.0) * (1.0 + off))
        said.append(any("contact ratio" in warning for warning in rg.check(model).warnings))
    return 0.0 if said == [True, False] else np.inf


def undercut(teeth: int) -> float:
    """Undercut begins at x = h - z sin^2 alpha / 2 below the shift: told just below, not just above."""
    border = 1.0 - teeth / 2.0 * float(mp.sin(mp.radians(20)) ** 2)
    said = []
    for off in (-1e-6, 1e-6):
        model = pair_of((teeth, 60), shift=(border + off, -border - off))
        said.append(any("undercut" in warning and "gears.a" in warning for warning in rg.check(model).warnings))
    return 0.0 if said == [True, False] else np.inf


def iso_stiffness(scale: float) -> float:
    """Stiffness of a pair by ISO 6336 per width does not know the module, at one load per width."""
    values = []
    for module, width in ((2e-3, 20e-3), (2e-3 * scale, 20e-3)):
        model = pair_of((24, 36), module=module)
        found = rg.check(model.with_("meshes.m.stiffness", "iso"))
        values.append(found.meshes[0].stiffness_n_per_m / width)
    return abs(values[1] / values[0] - 1.0)
