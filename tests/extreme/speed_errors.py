"""Errors of Campbell diagrams and critical speeds against closed forms."""

from __future__ import annotations

from collections.abc import Sequence

import mpmath as mp
import numpy as np

import rotorgear as rg

RPM = np.pi / 30.0


def tilting(polar: float, diametral: float, spring: float) -> rg.Model:
    """A disk that only tilts, on a spring: I_d w^2 - W I_p w - k = 0 for the forward whirl, and with -W for the backward one."""
    hold = rg.Support(shaft="p", at=0.0, fixed=("x", "y"), stiffness=rg.StiffnessMatrix(tilt=spring))
    disk = rg.Disk(shaft="p", at=0.0, mass=0.0, polar_inertia=polar, diametral_inertia=diametral)
    return rg.Model(
        shafts={"p": rg.Shaft()},
        disks={"d": disk},
        supports={"h": hold},
        operation=rg.Operation(input_shaft="p", speed=100.0),
        motions=("bending",),
    )


def whirls_of_tilting(polar: float, diametral: float, spring: float, top: float, count: int = 5) -> float:
    """Both branches from standstill to the top speed in rad/s; the one that is not there has NaN, and none may be made up."""
    found = rg.campbell(tilting(polar, diametral, spring), start=0.0, stop=top, points=count)
    worst = 0.0
    for speed, roots in zip(found.speeds, found.eigenvalues, strict=True):
        h = mp.mpf(float(speed)) * mp.mpf(polar) / (2 * mp.mpf(diametral))
        root = mp.sqrt(h**2 + mp.mpf(spring) / mp.mpf(diametral))
        # The difference of two near numbers: the smaller root from the product of both.
        forward = h + root
        exact = [forward, (mp.mpf(spring) / mp.mpf(diametral)) / forward]
        computed = sorted((abs(complex(s)) for s in roots if np.isfinite(s)), reverse=True)
        if len(computed) != 2:
            return np.inf
        worst = max(worst, *(float(abs(mp.mpf(w) / e - 1)) for w, e in zip(computed, exact, strict=True)))
    return worst


def critical_of_tilting(polar: float, diametral: float, spring: float, top: float) -> float:
    """W^2 (I_d - I_p) = k forward, W^2 (I_d + I_p) = k backward; a disk flatter than I_p = I_d has none forward."""
    found = rg.critical(tilting(polar, diametral, spring), stop=top)
    exact = [mp.sqrt(mp.mpf(spring) / (mp.mpf(diametral) + mp.mpf(polar)))]
    if polar < diametral:
        exact.append(mp.sqrt(mp.mpf(spring) / (mp.mpf(diametral) - mp.mpf(polar))))
    exact = [w for w in exact if w <= top]
    speeds = sorted(row.speed for row in found.speeds if row.line.endswith("1x"))
    if len(speeds) != len(exact):
        return np.inf
    return max((float(abs(mp.mpf(w) / e - 1)) for w, e in zip(speeds, exact, strict=True)), default=0.0)


def masses(stiffnesses: Sequence[float], mass: float = 2.0) -> rg.Model:
    """Point masses on shafts of one speed, each on its own spring."""
    names = [f"p{k}" for k in range(len(stiffnesses))]
    return rg.Model(
        shafts={name: rg.Shaft(speed_ratio=None if k == 0 else 1.0) for k, name in enumerate(names)},
        point_masses={name: rg.PointMass(shaft=name, at=0.0, mass=mass) for name in names},
        bearings={
            name: rg.Bearing(shaft=name, at=0.0, stiffness=rg.StiffnessMatrix(radial=k))
            for name, k in zip(names, stiffnesses, strict=True)
        },
        supports={f"t_{name}": rg.Support(shaft=name, at=0.0, fixed=("tilt_x", "tilt_y")) for name in names},
        operation=rg.Operation(input_shaft="p0", speed=100.0),
        motions=("bending",),
    )


def critical_of_masses(stiffnesses: Sequence[float], mass: float = 2.0) -> float:
    """W = sqrt(k/m), along x and along y."""
    exact = sorted(float(mp.sqrt(mp.mpf(k) / mp.mpf(mass))) for k in stiffnesses for _ in range(2))
    found = rg.critical(masses(stiffnesses, mass), stop=2.0 * exact[-1], shaft_orders=(1.0,))
    values = sorted(row.speed for row in found.speeds)
    if len(values) != len(exact):
        return np.inf
    return max(abs(w / e - 1.0) for w, e in zip(values, exact, strict=True))
