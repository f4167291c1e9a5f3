"""Errors of rolling bearings and oil films against closed forms, and against themselves in other units."""

from __future__ import annotations

from typing import Any

import mpmath as mp
import numpy as np

import rotorgear as rg

ROLLERS = {"kind": "roller", "elements": 13, "element_diameter": 11e-3, "length": 11e-3, "pitch_diameter": 65.5e-3}
BALLS = {"kind": "ball", "elements": 9, "element_diameter": 11.5e-3, "pitch_diameter": 43.5e-3}
ANGULAR = {**BALLS, "contact_angle": 0.7}
FILM = {"diameter": 60e-3, "length": 30e-3, "clearance": 60e-6, "viscosity": 0.02}
LOBES = {**FILM, "lobes": 3, "preload": 0.4}
PADS = {**FILM, "pads": 5, "preload": 0.3}
# How each key goes with the unit of length, everything of one stress alike.
_LENGTHS = ("element_diameter", "length", "pitch_diameter", "diameter", "clearance")


def loaded(inside: dict[str, Any], force: tuple[float, float, float], speed: float = 100.0) -> rg.Model:
    """A weightless body in one bearing under a force in N."""
    kind = "rolling" if "elements" in inside else "journal"
    axial = force[2] != 0.0
    held = ("tilt_x", "tilt_y") if axial else ("tilt_x", "tilt_y", "z")
    return rg.Model(
        operation=rg.Operation(input_shaft="p", speed=speed),
        shafts={"p": rg.Shaft()},
        point_masses={"m": rg.PointMass(shaft="p", at=0.0, mass=1.0)},
        bearings={"b": rg.Bearing(shaft="p", at=0.0, **{kind: inside})},
        supports={"t": rg.Support(shaft="p", at=0.0, fixed=held)},
        loads={"push": {"shaft": "p", "at": 0.0, "force": force}},
        points={axis: rg.Point(shaft="p", at=0.0, direction=axis) for axis in ("x", "y", "z")},
        motions=("bending", "axial"),
    )


def moved(model: rg.Model) -> np.ndarray:
    """Displacement (3,) in m under the load."""
    found = rg.static(model)
    return np.array([found.point_displacement[axis] for axis in "xyz"])


def power_law(inside: dict[str, Any], force: float, exponent: float) -> float:
    """Without clearance deflections go as a power of a radial load: 9/10 of line contacts, 2/3 of points."""
    usual = moved(loaded(inside, (0.0, -1e3, 0.0)))
    found = moved(loaded(inside, (0.0, -force, 0.0)))
    exact = (mp.mpf(force) / mp.mpf(1e3)) ** mp.mpf(exponent)
    return float(abs(mp.mpf(float(np.hypot(*found[:2]))) / (exact * mp.mpf(float(np.hypot(*usual[:2])))) - 1))


def axial_angle(force: float) -> float:
    """Angular contact balls under a push: F = Z c (A (cos a0 / cos a - 1))^(3/2) sin a, z = A sin (a - a0) / cos a.

    The constant c is that at 1 kN; A = (f_i + f_e - 1) D.
    """
    a0 = mp.mpf(ANGULAR["contact_angle"])
    A = mp.mpf("0.05") * mp.mpf(ANGULAR["element_diameter"])

    def load(z: float) -> mp.mpf:
        along, across = A * mp.sin(a0) + mp.mpf(z), A * mp.cos(a0)
        far = mp.sqrt(along**2 + across**2)
        return (far - A) ** mp.mpf(1.5) * along / far

    usual, found = (float(moved(loaded(ANGULAR, (0.0, 0.0, push)))[2]) for push in (1e3, force))
    return float(abs(load(found) / load(usual) / (mp.mpf(force) / 1000) - 1))


def scaled(inside: dict[str, Any], scale: float) -> float:
    """All lengths times a factor, forces times its square: displacements times the factor."""
    other = {key: scale * value if key in _LENGTHS else value for key, value in inside.items()}
    push = (0.0, -800.0, 300.0 if "contact_angle" in inside else 0.0)
    usual = moved(loaded(inside, push))
    found = moved(loaded(other, tuple(scale**2 * part for part in push)))  # type: ignore[arg-type]
    return float(np.abs(found / scale - usual).max() / np.abs(usual).max())


def thick_and_slow(inside: dict[str, Any], factor: float) -> float:
    """A film knows viscosity times speed alone: thicker oil that turns as much slower stands where it stood."""
    usual = moved(loaded(inside, (0.0, -800.0, 0.0), speed=100.0))
    found = moved(loaded({**inside, "viscosity": factor * inside["viscosity"]}, (0.0, -800.0, 0.0), 100.0 / factor))
    return float(np.abs(found - usual).max() / np.abs(usual).max())


SHORT = {"viscosity": 0.02, "radius": 25e-3, "length": 20e-3, "clearance": 50e-6}


def ocvirk(load: float, speed: float) -> float:
    """A short bearing: the gap and the eccentricity at a load, each relative to itself.

    S (L/D)^2 = (1 - e^2)^2 / (pi e sqrt(pi^2 (1 - e^2) + 16 e^2)) with S = mu N L D / W (R/c)^2.
    """
    model = rg.Model(
        operation=rg.Operation(input_shaft="p", speed=speed),
        shafts={"p": rg.Shaft()},
        point_masses={"m": rg.PointMass(shaft="p", at=0.0, mass=1.0)},
        nonlinear_elements={"f": {"law": "journal_bearing", "shaft": "p", "at": 0.0, "parameters": SHORT}},
        supports={"t": rg.Support(shaft="p", at=0.0, fixed=("tilt_x", "tilt_y"))},
        loads={"push": {"shaft": "p", "at": 0.0, "force": (0.0, -load, 0.0)}},
        points={axis: rg.Point(shaft="p", at=0.0, direction=axis) for axis in ("x", "y")},
        motions=("bending",),
    )
    found = rg.static(model)
    away = mp.sqrt(sum(mp.mpf(found.point_displacement[axis]) ** 2 for axis in "xy")) / mp.mpf(SHORT["clearance"])
    mu, R, L, c = (mp.mpf(SHORT[key]) for key in ("viscosity", "radius", "length", "clearance"))
    number = mu * mp.mpf(speed) / (2 * mp.pi) * L * 2 * R / mp.mpf(load) * (R / c) ** 2 * (L / (2 * R)) ** 2

    def off(gap: mp.mpf) -> mp.mpf:
        e = 1 - gap
        return mp.log((1 - e**2) ** 2 / (mp.pi * e * mp.sqrt(mp.pi**2 * (1 - e**2) + 16 * e**2)) / number)

    low, high = mp.mpf("1e-12"), 1 - mp.mpf("1e-12")
    for _ in range(140):
        middle = mp.sqrt(low * high)
        low, high = (middle, high) if off(middle) < 0 else (low, middle)
    gap = low
    return float(max(abs((1 - away) / gap - 1), abs(away / (1 - gap) - 1)))


def sheet_stiffness(force: float) -> float:
    """The sheet of a roller bearing: dF/dy = 10/9 F/y along a load that has no clearance to cross."""
    model = loaded(ROLLERS, (0.0, -force, 0.0))
    sheet = rg.bearing(model, "b")
    y = float(moved(model)[1])
    return float(abs(abs(sheet.bearing_stiffness[1, 1] * y) / (10.0 / 9.0 * force) - 1.0))
