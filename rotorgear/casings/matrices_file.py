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

import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import scipy.linalg as la

from rotorgear.casings.reduced_body import ReducedBody, Surface, modal_damping, rigid_coordinates
from rotorgear.errors import AnalysisError

_KNOWN = (
    "stiffness",
    "mass",
    "seats",
    "positions",
    "damping",
    "rigid",
    "weight",
    "surface_points",
    "surface_triangles",
    "surface_basis",
)
_SURFACE = ("surface_points", "surface_triangles", "surface_basis")
# A rigid motion of the seats with more strain energy than this share of its parts is held by something.
_STRAINED = 1e-8
_UNKNOWN = (float("nan"), np.full(3, np.nan), np.full((3, 3), np.nan))
# Largest difference of a matrix from its transpose, relative to its largest entry, that rounding explains.
_SYMMETRIC = 1e-8
# An eigenvalue below zero by more than this share of the largest is no rounding, of single precision either.
_PUSHES = 1e-5


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
    stiffness = _square(arrays, "stiffness", address)
    mass = _square(arrays, "mass", address)
    if stiffness is None or mass is None:
        missing = "stiffness" if stiffness is None else "mass"
        raise AnalysisError(f"{address}: '{path.name}' has no array '{missing}'; it has {', '.join(arrays) or 'none'}")
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
    if points.shape != (len(seats), 3) or len(set(seats)) != len(seats):
        raise AnalysisError(
            f"{address}: {len(seats)} names of seats with {len(points)} reference points in '{path.name}'"
        )
    damping = _square(arrays, "damping", address)
    for name, matrix in (("mass", mass), ("damping", damping)):
        if matrix is not None and len(matrix) != n:
            raise AnalysisError(
                f"{address}: {name} is {len(matrix)} x {len(matrix)} in '{path.name}', stiffness {n} x {n}"
            )
    if n < 6 * len(seats):
        raise AnalysisError(f"{address}: {n} dofs in '{path.name}', but {len(seats)} seats have {6 * len(seats)}")
    try:
        squares = la.eigvalsh(stiffness, mass)
    except la.LinAlgError:
        raise AnalysisError(f"{address}: the mass matrix in '{path.name}' is not positive definite") from None
    if squares[0] < -_PUSHES * np.abs(squares).max():
        raise AnalysisError(
            f"{address}: the stiffness in '{path.name}' pushes some motion on instead of holding it (an eigenvalue is negative)"
        )
    of_ratio = modal_damping(mass, stiffness, damping_ratio)
    for key, columns in (("weight", 3), ("rigid", 6)):
        if key in arrays and arrays[key].shape != (n, columns):
            raise AnalysisError(f"{address}: {key} is {arrays[key].shape} in '{path.name}', expected ({n}, {columns})")
    rigid = arrays.get("rigid", rigid_coordinates(n, points))
    strained = rigid.T @ stiffness @ rigid
    parts = np.einsum("nm,n,nm->m", rigid, np.abs(np.diagonal(stiffness)), rigid)
    held = bool(np.any(np.abs(np.diagonal(strained)) > _STRAINED * parts))
    force = mass @ rigid
    if "weight" in arrays or held:
        force = np.hstack([arrays.get("weight", np.full((n, 3), np.nan)), np.full((n, 3), np.nan)])
    body_mass, centre, inertia = _inertia(rigid.T @ mass @ rigid) if not held else _UNKNOWN
    inside = slice(6 * len(seats), None)
    fixed = la.eigvalsh(stiffness[inside, inside], mass[inside, inside]) if n > 6 * len(seats) else np.zeros(0)
    return ReducedBody(
        name=name_of_casing,
        seats=seats,
        seat_points=points,
        mass=mass,
        stiffness=stiffness,
        damping=of_ratio if damping is None else of_ratio + damping,
        rigid=None if held else rigid,
        inertia_force=force,
        body_mass=body_mass,
        centre=centre,
        inertia=inertia,
        fixed_frequency=np.sqrt(np.maximum(fixed, 0.0)) / (2.0 * np.pi),
        surface=_surface(arrays, n, path, address),
        held=held,
    )


def _inertia(M: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Mass, centre and inertia tensor about it from the mass matrix (6, 6) of the rigid motions about the origin.

    M = [[m 1, -m c~], [m c~, J_0]] with c~ the matrix of c x, and J_0 = J_c + m (c.c 1 - c c^T).
    """
    mass = float(np.trace(M[:3, :3])) / 3.0
    centre = np.array([M[5, 1] - M[4, 2], M[3, 2] - M[5, 0], M[4, 0] - M[3, 1]]) / (2.0 * mass)
    return mass, centre, M[3:, 3:] - mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))


def _arrays(path: Path, address: str) -> dict[str, np.ndarray]:
    if path.suffix.lower() in (".op4", ".pch", ".op2"):
        raise AnalysisError(
            f"{address}: '{path.name}' is a file of Nastran, which is not read; write its matrices into a NumPy archive "
            "(np.savez with stiffness, mass, seats, positions) and name that"
        )
    try:
        with np.load(path, allow_pickle=False) as file:
            if not isinstance(file, np.lib.npyio.NpzFile):
                raise ValueError("one array, not an archive")
            arrays = {name: file[name] for name in file.files}
    except FileNotFoundError:
        raise AnalysisError(f"{address}: there is no file '{path}'") from None
    except (OSError, ValueError, EOFError, zipfile.BadZipFile, zlib.error) as error:
        words = " ".join(str(error).split()) or "it is cut off"
        raise AnalysisError(f"{address}: '{path.name}' can't be read as a NumPy archive (.npz): {words}") from None
    unknown = [name for name in arrays if name not in _KNOWN]
    if unknown:
        raise AnalysisError(
            f"{address}: '{path.name}' has an array '{unknown[0]}' that means nothing here; known are {', '.join(_KNOWN)}"
        )
    return arrays


def _square(arrays: Mapping[str, np.ndarray], name: str, address: str) -> np.ndarray | None:
    """A symmetric matrix of finite numbers, (n, n)."""
    if name not in arrays:
        return None
    A = arrays[name]
    if A.ndim != 2 or A.shape[0] != A.shape[1] or A.dtype.kind not in "fiu":
        raise AnalysisError(
            f"{address}: {name} is an array {A.shape} of {A.dtype}, expected a square matrix of numbers"
        )
    A = np.asarray(A, float)
    if not np.all(np.isfinite(A)):
        raise AnalysisError(f"{address}: {name} has entries that are no finite numbers")
    if np.abs(A - A.T).max(initial=0.0) > _SYMMETRIC * np.abs(A).max(initial=0.0):
        raise AnalysisError(f"{address}: {name} is not symmetric")
    return 0.5 * (A + A.T)


def _surface(arrays: Mapping[str, np.ndarray], n: int, path: Path, address: str) -> Surface | None:
    there = [name for name in _SURFACE if name in arrays]
    if not there:
        return None
    if len(there) < len(_SURFACE):
        raise AnalysisError(
            f"{address}: '{path.name}' has {', '.join(there)} only; a surface needs {', '.join(_SURFACE)}"
        )
    points, triangles, basis = (arrays[name] for name in _SURFACE)
    p = len(points)
    fits = points.shape == (p, 3) and triangles.ndim == 2 and triangles.shape[1] == 3 and basis.shape == (p, 3, n)
    if not fits or (triangles.size and not 0 <= triangles.min() <= triangles.max() < p):
        raise AnalysisError(
            f"{address}: the surface in '{path.name}' does not fit: points {points.shape}, triangles {triangles.shape}, "
            f"basis {basis.shape}; expected (p, 3), (t, 3) with numbers below p, and (p, 3, {n})"
        )
    return Surface(np.asarray(points, float), np.asarray(triangles, int), np.asarray(basis, float))
