"""Models of the extreme cases, and how computed eigenvalues are compared with exact ones."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import mpmath as mp
import numpy as np

import rotorgear as rg
from tests.extreme.references import Rotor


def rotor_model(rotor: Rotor, *, internal_damping: float = 0.0, **tables: Any) -> rg.Model:
    """The model of a reference rotor: solved with elements=1 its matrices are those of the reference."""
    z = [float(place) for place in np.concatenate([[0.0], np.cumsum([s.length for s in rotor.segments])])]
    names = {(s.E, s.nu, s.rho): f"m{k}" for k, s in enumerate(rotor.segments)}
    sections = tuple(
        rg.Section(length=s.length, outer_diameter=s.outer, bore=s.inner, material=names[s.E, s.nu, s.rho])
        for s in rotor.segments
    )
    materials = {
        name: rg.Material(youngs_modulus=E, poisson_ratio=nu, density=rho) for (E, nu, rho), name in names.items()
    }
    bearings = {
        f"b{k}": rg.Bearing(
            shaft="s",
            at=z[k],
            stiffness=rg.StiffnessMatrix(radial=s.radial, axial=s.axial, torsion=s.torsion, tilt=s.tilt),
            damping=rg.DampingMatrix(radial=s.damping) if s.damping else None,
        )
        for k, s in rotor.springs.items()
    }
    disks = {
        f"d{k}": rg.Disk(shaft="s", at=z[k], mass=b.mass, polar_inertia=b.polar, diametral_inertia=b.diametral)
        for k, b in rotor.bodies.items()
    }
    shaft = rg.Shaft(sections=sections, internal_damping=internal_damping)
    return rg.Model(shafts={"s": shaft}, materials=materials, bearings=bearings, disks=disks, **tables)


def points(inertias: Sequence[float], stiffnesses: Sequence[float], **tables: Any) -> rg.Model:
    """A torsional chain: rigid points with moments of inertia (0 for none), joined by couplings."""
    shafts = {f"p{k}": rg.Shaft() for k in range(len(inertias))}
    disks = {
        f"d{k}": rg.Disk(shaft=f"p{k}", at=0.0, mass=0.0, polar_inertia=J, diametral_inertia=0.0)
        for k, J in enumerate(inertias)
        if J
    }
    couplings = {
        f"c{k}": rg.Coupling(from_shaft=f"p{k}", to_shaft=f"p{k + 1}", stiffness=rg.StiffnessMatrix(torsion=value))
        for k, value in enumerate(stiffnesses)
    }
    return rg.Model(shafts=shafts, disks=disks, couplings=couplings, **{"motions": ("torsion",), **tables})


def elastic(result: rg.ModalResult) -> np.ndarray:
    """Omega in rad/s of the modes that are not rigid."""
    return np.abs(result.eigenvalues[~result.rigid])


def frequency_error(result: rg.ModalResult, exact: Iterable[Any], rigid: int | None = None) -> float:
    """Largest relative error of omega, mode by mode from the lowest; wrong counts are an infinite error."""
    values = sorted(mp.mpf(w) for w in exact)
    highest = values[-1]
    true = [w for w in values if w > highest * mp.mpf(10) ** -18]  # what 40 digits leave of a rigid mode is 1e-20
    omega = elastic(result)
    count = int(np.count_nonzero(result.rigid))
    if count != (len(values) - len(true) if rigid is None else rigid) or not 0 < len(omega) <= len(true):
        return np.inf
    return max(abs(float(mp.mpf(float(w)) / t - 1)) for w, t in zip(omega, true, strict=False))


def root_error(result: rg.ModalResult, exact: Iterable[Any]) -> float:
    """Largest relative distance between the sets of computed and of exact s: none is missing, none is made up."""
    computed = [mp.mpc(complex(s)) for s in result.eigenvalues[~result.rigid]]
    true = [mp.mpc(s) for s in exact]

    def farthest(of: list[Any], among: list[Any]) -> float:
        return max(min(float(abs(a - b) / abs(a)) for b in among) for a in of)

    return max(farthest(computed, true), farthest(true, computed))
