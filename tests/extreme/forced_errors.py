"""Errors of statics, frequency responses and unbalance responses against closed forms."""

from __future__ import annotations

from collections.abc import Sequence

import mpmath as mp
import numpy as np

import rotorgear as rg
from tests.extreme.models import points, rotor_model
from tests.extreme.references import Rotor, Segment, Spring

G_EARTH = 9.81


def static_estimate(left: float, right: float) -> float:
    """Error of the sag of a rod over the estimate that the result states."""
    segment = Segment(1.0, 0.05)
    return sag(segment, left, right) / rg.static(_sagging(segment, left, right)).error_estimate


def _sagging(segment: Segment, left: float, right: float) -> rg.Model:
    half = Segment(segment.length / 2.0, segment.outer, segment.inner)
    return rotor_model(
        Rotor([half, half], {0: Spring(left), 2: Spring(right)}),
        operation=rg.Operation(input_shaft="s", gravity=(0.0, -G_EARTH, 0.0)),
        points={"middle": rg.Point(shaft="s", at=half.length, direction="y")},
    )


def sag(segment: Segment, left: float, right: float) -> float:
    """Shaft under its own weight on two springs: deflection in the middle and both bearing forces.

    y = 5 q L^4 / (384 E I) + q L^2 / (8 kappa G A) + q L (1/k_1 + 1/k_2) / 4; each bearing carries q L / 2.
    """
    found = rg.static(_sagging(segment, left, right))
    area, inertia, _, shear = segment.section()
    L = mp.mpf(segment.length)
    q = segment.rho * area * mp.mpf(G_EARTH)
    bent = 5 * q * L**4 / (384 * segment.E * inertia) + q * L**2 / (8 * shear)
    exact = bent + q * L * (1 / mp.mpf(left) + 1 / mp.mpf(right)) / 4
    errors = [abs(mp.mpf(-found.point_displacement["middle"]) / exact - 1)]
    errors += [abs(mp.mpf(float(np.linalg.norm(found.bearing_force[b][:2]))) / (q * L / 2) - 1) for b in ("b0", "b2")]
    return float(max(errors))


def mass_on_spring(stiffness: float, damping: float, mass: float = 2.0, unbalance: float = 0.0) -> rg.Model:
    """A point mass in a bearing, equal along x and y."""
    bearing = rg.Bearing(
        shaft="p",
        at=0.0,
        stiffness=rg.StiffnessMatrix(radial=stiffness),
        damping=rg.DampingMatrix(radial=damping) if damping else None,
    )
    return rg.Model(
        operation=rg.Operation(input_shaft="p", speed=100.0),
        shafts={"p": rg.Shaft()},
        point_masses={"m": rg.PointMass(shaft="p", at=0.0, mass=mass)},
        bearings={"b": bearing},
        supports={"tilt": rg.Support(shaft="p", at=0.0, fixed=("tilt_x", "tilt_y"))},
        unbalances={"u": rg.Unbalance(shaft="p", at=0.0, magnitude=unbalance)} if unbalance else {},
        motions=("bending",),
    )


def receptance(stiffness: float, damping: float, ratios: Sequence[float], mass: float = 2.0) -> float:
    """H = 1 / (k - m w^2 + i w c) at multiples of sqrt(k/m)."""
    w0 = mp.sqrt(mp.mpf(stiffness) / mp.mpf(mass))
    hertz = [float(mp.mpf(r) * w0 / (2 * mp.pi)) for r in ratios]
    found = rg.frf(mass_on_spring(stiffness, damping, mass), hertz, inputs=["bearings.b:x"], outputs=["bearings.b:x"])
    errors = []
    for f, h in zip(hertz, found.receptance[:, 0, 0], strict=True):
        w = 2 * mp.pi * mp.mpf(f)
        exact = 1 / mp.mpc(stiffness - mass * w**2, w * damping)
        errors.append(float(abs(mp.mpc(complex(h)) / exact - 1)))
    return max(errors)


def chain_estimate(stiffness: float) -> float:
    """Error of a receptance over the estimate that the result states: a soft ground under a stiff coupling."""
    return chain_receptance([0.3, 0.2], [stiffness], 1.0, 0.1, per_estimate=True)


def chain_receptance(
    inertias: Sequence[float], springs: Sequence[float], ground: float, hertz: float, *, per_estimate: bool = False
) -> float:
    """Torsional chain, the first point held by a spring: solves (K - w^2 M) q = e_last with 40 digits."""
    n = len(inertias)
    hold = {"g": rg.Support(shaft="p0", at=0.0, stiffness=rg.StiffnessMatrix(torsion=ground))}
    chain = points(
        list(inertias),
        list(springs),
        supports=hold,
        operation=rg.Operation(input_shaft="p0"),
        points={f"q{k}": rg.Point(shaft=f"p{k}", at=0.0, direction="torsion") for k in range(n)},
    )
    found = rg.frf(chain, [hertz], inputs=[f"q{n - 1}"], outputs=[f"q{k}" for k in range(n)], speed=0.0)
    w = 2 * mp.pi * mp.mpf(hertz)
    Z = mp.diag([-(w**2) * mp.mpf(J) for J in inertias])
    Z[0, 0] += mp.mpf(ground)
    for k, value in enumerate(springs):
        for a in (k, k + 1):
            for b in (k, k + 1):
                Z[a, b] += mp.mpf(value) if a == b else -mp.mpf(value)
    load = mp.zeros(n, 1)
    load[n - 1] = 1
    exact = mp.lu_solve(Z, load)
    computed = found.receptance[0, :, 0]
    error = max(float(abs(mp.mpc(complex(h)) / e - 1)) for h, e in zip(computed, exact, strict=True))
    return error / found.error_estimate if per_estimate else error


def unbalance_response(stiffness: float, damping: float, rad_s: Sequence[float], mass: float = 2.0) -> float:
    """Whirl radius r = u W^2 / (k - m W^2 + i W c) of a point mass."""
    u = 1e-5
    found = rg.response(mass_on_spring(stiffness, damping, mass, u), speeds=list(rad_s))
    at = found.places.index("bearings.b")
    errors = []
    for k, speed in enumerate(rad_s):
        W = mp.mpf(speed)
        exact = abs(u * W**2 / mp.mpc(stiffness - mass * W**2, W * damping))
        errors.append(abs(mp.mpf(float(np.abs(found.displacement[:, k, at]).max())) / exact - 1))
    return float(max(errors))
