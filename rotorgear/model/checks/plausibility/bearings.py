"""Bearings that the physics of a machine makes unlikely: stiffness, damping, films, rolling elements, pedestals, couplings."""

from __future__ import annotations

import math
from collections.abc import Iterator

from rotorgear.model.checks.plausibility.sentence import ASK, GRAVITY, mass_of, outside, said
from rotorgear.model.layout.layout import Layout
from rotorgear.model.parts.bearings.geometry import BearingGeometry
from rotorgear.model.parts.shaft import Shaft
from rotorgear.model.parts.supports import Bearing, StiffnessMatrix

# Sag of a rotor on its bearings in m; stiffness of a bearing in N/m that nothing reaches.
_SAG = 1e-3
_STIFFEST = 1e12
# Damping of a bearing over the critical one.
_OVERDAMPED = 1e3
# Twist of a coupling under the torque of the operating point in rad.
_TWIST = 0.5


def bearings(layout: Layout) -> Iterator[str]:
    model = layout.model
    weights = {name: GRAVITY * mass_of(layout, name) for name in model.shafts}
    for name, bearing in model.bearings.items():
        address = f"bearings.{name}"
        held = sum(other.shaft == bearing.shaft for other in model.bearings.values())
        weight = weights[bearing.shaft] / held if model.has("bending") else 0.0
        matrix = bearing.stiffness or (bearing.table[0].stiffness if bearing.table else None)
        yield from _stiffness(f"{address}.stiffness", matrix, weight)
        if bearing.pedestal is not None:
            yield from _stiffness(f"{address}.pedestal.stiffness", bearing.pedestal.stiffness, weight, given=True)
        for kind, geometry in bearing.geometries.items():
            for key, value, usual, words, slips in geometry.judged():
                yield from outside(f"{address}.{kind}.{key}", value, usual, words, slips)
            yield from _fits(f"{address}.{kind}.{geometry.ring}", geometry, layout.model.shafts[bearing.shaft])
        yield from _dampers(address, bearing, weights[bearing.shaft] / GRAVITY)


def _fits(address: str, geometry: BearingGeometry, shaft: Shaft) -> Iterator[str]:
    """Size of what surrounds the shaft against the shaft."""
    if not shaft.sections:
        return
    thick = max(section.outer_diameter for section in shaft.sections)
    thin = min(section.outer_diameter for section in shaft.sections)
    size = geometry.surrounds
    share = (geometry.fits[0] * thin, geometry.fits[1] * thick)
    words = (f"{size:.4g} m on a shaft of {thin:.4g} to {thick:.4g} m", f"{share[0]:.2g} to {share[1]:.2g} m")
    yield from outside(address, size, share, words, ("is its unit right?", "mm meant?"))


def _dampers(address: str, bearing: Bearing, mass: float) -> Iterator[str]:
    """Damping across the shaft against that which is critical with its stiffness and the mass of the rotor."""
    if bearing.stiffness is None or bearing.damping is None or not mass:
        return
    stiffness = max(bearing.stiffness.as_rows()[i][i] for i in range(2))
    damping = max(bearing.damping.as_rows()[i][i] for i in range(2))
    if stiffness <= 0.0:
        return
    ratio = damping / (2.0 * math.sqrt(stiffness * mass))
    words = (f"{damping:.4g} N s/m, {ratio:.3g} of the critical damping", f"up to {_OVERDAMPED:g} of it")
    yield from outside(f"{address}.damping", ratio, (0.0, _OVERDAMPED), words, ASK)


def _stiffness(address: str, matrix: StiffnessMatrix | None, weight: float, given: bool = False) -> Iterator[str]:
    """Stiffness across the shaft against the weight on it; `given`: directions without one are rigid."""
    if matrix is None:
        return
    rows = matrix.as_rows()
    across = [rows[i][i] for i in range(2) if rows[i][i] or not given]
    if not any(any(row) for row in rows):
        if not given:
            yield said(address, "0 in all directions", "1e6 to 1e10 N/m", "it holds nothing; leave it out")
        return
    if not across:
        return
    if max(across) > _STIFFEST:
        yield said(address, f"{max(across):.4g} N/m", "1e6 to 1e10 N/m", "is its unit right?")
    softest = min(across)
    if max(across) > 0.0 and weight > _SAG * softest:
        sag = "no stiffness across" if softest == 0.0 else f"{softest:.4g} N/m, on which its rotor sags by"
        amount = "" if softest == 0.0 else f" {1e3 * weight / softest:.3g} mm"
        yield said(address, f"{sag}{amount}", "1e6 to 1e10 N/m", "N/mm or N/um meant?")


def couplings(layout: Layout) -> Iterator[str]:
    """Twist of couplings under the torque of the operating point."""
    operation = layout.model.operation
    if operation is None:
        return
    speed = abs(operation.speed or 0.0)
    torque = operation.torque or (operation.power / speed if operation.power and speed else 0.0)
    for name, coupling in layout.model.couplings.items():
        stiffness = coupling.stiffness.as_rows()[5][5]
        ratio = abs(float(layout.train.ratio(coupling.from_shaft)))
        if stiffness <= 0.0 or not ratio:
            continue
        twist = torque / ratio / stiffness
        words = (
            f"{stiffness:.4g} N m/rad, which the whole torque of the operating point would twist by {twist:.3g} rad",
            f"up to {_TWIST:g} rad",
        )
        yield from outside(f"couplings.{name}.stiffness", twist, (0.0, _TWIST), words, ("", "kN m/rad meant?"))
