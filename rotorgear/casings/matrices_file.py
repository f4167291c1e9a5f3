"""Bodies that were reduced elsewhere: K and M from a NumPy archive.

    stiffness, mass        (n, n) in SI: six dofs a seat (x y z, rotations about x y z, in model coordinates), then all others
    seats, positions       (s,) names and (s, 3) reference points in m; or the `interface` of the model file
    damping                (n, n)
    rigid                  (n, 6): the dofs in unit displacements along x, y, z and in rotations about the origin of the model,
                           where others than those of the seats move in them
    weight                 (n, 3): forces on the dofs for 1 m/s^2 along x, y and z
    surface_points, surface_triangles, surface_basis       (p, 3), (t, 3) and (p, 3, n): what is drawn, and what radiates

Everything beside stiffness and mass may be left out, but some interface must be given.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import scipy.linalg as la

from rotorgear.casings.reduced_body import ReducedBody, Surface, mass_properties, modal_damping, rigid_coordinates
from rotorgear.errors import AnalysisError
from rotorgear.files.archive import read_arrays
from rotorgear.files.bounds import MATRICES
from rotorgear.files.read import UnreadableError
from rotorgear.quantity import LARGEST

_SURFACE = ("surface_points", "surface_triangles", "surface_basis")
_KNOWN = ("stiffness", "mass", "seats", "positions", "damping", "rigid", "weight", *_SURFACE)
# A body in which a rigid motion of the seats has more strain energy than this share of the single terms is held to the ground.
_STRAINED = 1e-8
_UNKNOWN = (float("nan"), np.full(3, np.nan), np.full((3, 3), np.nan))
# Largest difference of a matrix from its transpose, relative to its largest entry, that rounding explains.
_SYMMETRIC = 1e-8
# An eigenvalue that is negative by more than this share of the largest is not caused by rounding, even in single precision.
_NEGATIVE = 1e-5


def read_matrices(
    path: Path, interface: Mapping[str, tuple[float, float, float]], damping_ratio: float, name_of_casing: str
) -> ReducedBody:
    """Return the body of a file.

    Args:
        path: of the .npz.
        interface: names of the seats with their reference points in m, in the order of the dofs; empty to take those of the file.
        damping_ratio: of every elastic mode, beside the damping of the file.
        name_of_casing: in the model file.

    Raises:
        AnalysisError: no such file, no archive, or arrays that do not fit each other.
    """
    address = f"casings.{name_of_casing}.matrices"
    arrays = _arrays(path, address)
    for name in ("stiffness", "mass"):
        if name not in arrays:
            raise AnalysisError(f"{address}: '{path.name}' has no array '{name}'; it has {', '.join(arrays) or 'none'}")
    stiffness, mass = (_symmetric(arrays, name, address) for name in ("stiffness", "mass"))
    n = len(stiffness)
    if interface:
        seats = tuple(interface)
        points = np.array(list(interface.values()), float)
    elif "seats" in arrays and "positions" in arrays:
        seats = tuple(str(name) for name in np.atleast_1d(arrays["seats"]))
        points = np.atleast_2d(np.asarray(arrays["positions"], float))
    else:
        raise AnalysisError(
            f"{address}: '{path.name}' does not say where its seats are: give the arrays seats and positions in it, or "
            "interface = { input_left = ['-55 mm', '130 mm', '20 mm'] } beside matrices, in the order of the dofs"
        )
    count = len(seats)
    if points.shape != (count, 3) or len(set(seats)) != count:
        raise AnalysisError(f"{address}: {count} names of seats with {len(points)} reference points in '{path.name}'")
    for name, columns in (("mass", n), ("damping", n), ("weight", 3), ("rigid", 6)):
        if name in arrays and arrays[name].shape != (n, columns):
            expected = f"expected ({n}, {columns})"
            raise AnalysisError(f"{address}: {name} is {arrays[name].shape} in '{path.name}', {expected}")
    if n < 6 * count:
        raise AnalysisError(f"{address}: {n} dofs in '{path.name}', but {count} seats have {6 * count}")
    try:
        squares = la.eigvalsh(stiffness, mass)
    except la.LinAlgError:
        raise AnalysisError(f"{address}: the mass matrix in '{path.name}' is not positive definite") from None
    if squares[0] < -_NEGATIVE * np.abs(squares).max():
        raise AnalysisError(
            f"{address}: the stiffness in '{path.name}' has a negative eigenvalue: it drives a motion instead of resisting it"
        )
    damping = modal_damping(mass, stiffness, damping_ratio)
    if "damping" in arrays:
        damping = damping + _symmetric(arrays, "damping", address)
    rigid = arrays.get("rigid", rigid_coordinates(n, points))
    strained = rigid.T @ stiffness @ rigid
    parts = np.einsum("nm,n,nm->m", rigid, np.abs(np.diagonal(stiffness)), rigid)
    held = bool(np.any(np.abs(np.diagonal(strained)) > _STRAINED * parts))
    force = mass @ rigid
    if "weight" in arrays or held:
        force = np.hstack([arrays.get("weight", np.full((n, 3), np.nan)), np.full((n, 3), np.nan)])
    body_mass, centre, inertia = mass_properties(rigid.T @ mass @ rigid) if not held else _UNKNOWN
    inside = slice(6 * count, None)
    fixed = la.eigvalsh(stiffness[inside, inside], mass[inside, inside]) if n > 6 * count else np.zeros(0)
    return ReducedBody(
        name=name_of_casing,
        seats=seats,
        seat_points=points,
        mass=mass,
        stiffness=stiffness,
        damping=damping,
        rigid=None if held else rigid,
        inertia_force=force,
        body_mass=body_mass,
        centre=centre,
        inertia=inertia,
        fixed_frequency=np.sqrt(np.maximum(fixed, 0.0)) / (2.0 * np.pi),
        surface=_surface(arrays, n, path, address),
        held=held,
    )


def _arrays(path: Path, address: str) -> dict[str, np.ndarray]:
    if path.suffix.lower() in (".op4", ".pch", ".op2"):
        raise AnalysisError(
            f"{address}: '{path.name}' is a file of Nastran, which is not read; write its matrices into a NumPy archive "
            "(np.savez with stiffness, mass, seats, positions) and name that"
        )
    try:
        arrays = read_arrays(path, MATRICES.most_bytes)
    except UnreadableError as error:
        if error.missing:
            raise AnalysisError(f"{address}: there is no file '{path}'") from None
        raise AnalysisError(
            f"{address}: '{path.name}' can't be read as a NumPy archive (.npz): {error.reason}"
        ) from None
    for name in arrays:
        if name not in _KNOWN:
            known = ", ".join(_KNOWN)
            raise AnalysisError(
                f"{address}: '{path.name}' has an array '{name}' that means nothing here; known are {known}"
            )
        if arrays[name].dtype.kind in "fiuc" and not np.all(np.abs(arrays[name]) < LARGEST):
            raise AnalysisError(
                f"{address}: {name} has entries that are no finite numbers below {LARGEST:g} in '{path.name}'"
            )
    return arrays


def _symmetric(arrays: Mapping[str, np.ndarray], name: str, address: str) -> np.ndarray:
    """A symmetric matrix of finite numbers, (n, n)."""
    A = arrays[name]
    if A.ndim != 2 or A.shape[0] != A.shape[1] or A.dtype.kind not in "fiu":
        raise AnalysisError(f"{address}: {name} is an array {A.shape} of {A.dtype}, not a square matrix of numbers")
    A = np.asarray(A, float)
    if not np.all(np.isfinite(A)):
        raise AnalysisError(f"{address}: {name} has entries that are no finite numbers")
    if np.abs(A - A.T).max(initial=0.0) > _SYMMETRIC * np.abs(A).max(initial=0.0):
        raise AnalysisError(f"{address}: {name} is not symmetric")
    return 0.5 * (A + A.T)


def _surface(arrays: Mapping[str, np.ndarray], n: int, path: Path, address: str) -> Surface | None:
    """What is drawn of the body, where the file has it."""
    there = [name for name in _SURFACE if name in arrays]
    if not there:
        return None
    if len(there) < len(_SURFACE):
        named = ", ".join(_SURFACE)
        raise AnalysisError(f"{address}: '{path.name}' has {', '.join(there)} only; a surface needs {named}")
    points, triangles, basis = (arrays[name] for name in _SURFACE)
    p = len(points)
    fits = points.shape == (p, 3) and triangles.ndim == 2 and triangles.shape[1] == 3 and basis.shape == (p, 3, n)
    if not fits or (triangles.size and not 0 <= triangles.min() <= triangles.max() < p):
        raise AnalysisError(
            f"{address}: the surface in '{path.name}' does not fit: points {points.shape}, triangles {triangles.shape}, "
            f"basis {basis.shape}; expected (p, 3), (t, 3) with numbers below p, and (p, 3, {n})"
        )
    return Surface(np.asarray(points, float), np.asarray(triangles, int), np.asarray(basis, float))
