"""Derivatives of natural frequencies and mode shapes with respect to numbers of a model, at standstill or rotating.

With Q(w) = K + i w W G - w^2 M, Q phi = 0 and no damping (Fox and Kapoor 1968, Rates of change of eigenvalues and eigenvectors,
AIAA Journal 6; Lancaster 1964, On eigenvalues of matrices dependent on a parameter, Numerische Mathematik 6):

    dw/dx = phi^H Q' phi / phi^H (2 w M - i W G) phi,    phi^H Q' phi = strain' + w W swept' - w^2 kinetic',

where strain' and kinetic' are the changes of phi^H K phi and phi^H M phi with phi held. They are central differences of
energies summed element by element: no eigenproblem is solved again, and nothing cancels as it would in K' phi of a stiff shaft.
A diameter enters to the fourth power, a place by the lengths beside it: the same few lines serve any number of the file. The
stiffness k of a spring enters as k dK/dk = K_spring, whose energy needs neither differences nor another assembly.

Shapes follow from Nelson's method (1976, Simplified calculation of eigenvector derivatives, AIAA Journal 14): the bordered system

    [ Q   B] [phi']   [-Q' phi]
    [C^H  0] [ .  ] = [   c   ],    B = (2 w M - i W G) Phi,    C = M Phi,

is regular where w is a simple eigenvalue, and phi' is exact, without a sum over modes that would have to be cut. Around an
eigenvalue of several modes all of them are in Phi (Ojalvo 1988, AIAA Journal 26): what leaves their space is exact. What phi'
has along Phi is scale, phase or a turn among the modes: c keeps the modal mass at standstill, c = -phi^T M' phi / 2, and is 0
elsewhere.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from rotorgear.analysis.sensitivity.forms import Floats, Shapes
from rotorgear.analysis.static.state_at import linear_system
from rotorgear.errors import AnalysisError
from rotorgear.model.layout.state import SPRING_TABLES, State
from rotorgear.model.model import Model
from rotorgear.model.numbers import FreeNumbers
from rotorgear.system.assembly import assemble
from rotorgear.system.groups import ElementGroup
from rotorgear.system.system import System

# Half width of the central differences in x = ln p: their error is h^2 / 6 times the third derivative, some 1e-9 here, and
# rounding is 1e-15 / h of the energies.
STEP = 1e-4
# Modes whose w^2 agree to this share of it are taken as one eigenvalue; simple ones are exact to rounding over it.
EQUAL = 1e-7
# Stiffness of shafts, casings and elastic gears follows from drawings and a modulus known to a few per cent.
SPRINGS = ("meshes", *SPRING_TABLES)


@dataclass(frozen=True)
class Change:
    """What one number changes at fixed shapes X (n, m), per unit of its coordinate.

    Attributes:
        form: phi^H Q' phi (m,).
        kinetic: phi^H M' phi (m,).
        forces: Q' X (n, m); None where shapes were not asked for.
    """

    form: Floats
    kinetic: Floats
    forces: Shapes | None


def systems_beside(
    models: Iterable[Model], system: System, speed: float, address: str, *, beside: State | None = None
) -> tuple[System, System]:
    """The linear systems above and below `system` in one number, on its mesh.

    Args:
        models: with more and with less of the number.
        speed: of the reference shaft in rad/s, 0 at standstill.
        address: of the number.
        beside: a state whose face maps serve.

    Raises:
        AnalysisError: the number moves a place away from another one that it coincides with.
    """
    above, below = (linear_system(model, [speed or None], system.plan, beside=beside) for model in models)
    if not above.n == below.n == system.n:
        # Two places that coincide part under the change, and shapes of one mesh mean nothing on the other.
        raise AnalysisError(
            f"{address}: a change moves a place away from another one that it coincides with, so that the shafts are cut "
            "otherwise; move one of them by a hair in the file, or leave it out"
        )
    return above, below


def beside(numbers: FreeNumbers, x: Floats, j: int, system: System, speed: float) -> tuple[System, System]:
    """The systems a `STEP` above and below x (p,) in free number j, as in `systems_beside`."""
    step = STEP * np.eye(len(x))[j]
    return systems_beside((numbers.at(x + step), numbers.at(x - step)), system, speed, numbers.addresses[j])


def springs_of(model: Model, system: System) -> dict[str, list[ElementGroup]]:
    """Springs whose stiffness matrix is in proportion to the number that the file gives, by the address of that number.

    Where a law is linearised about an equilibrium, or a mesh has the stiffness of its load, any number may change any spring.
    """
    groups: dict[str, list[ElementGroup]] = {}
    if not system.state.is_flow or any(isinstance(mesh.stiffness, str) for mesh in model.meshes.values()):
        return groups
    for group in system.groups:
        if group.part.partition(".")[0] in SPRINGS and group.matrices.strain is not None:
            groups.setdefault(f"{group.part}.stiffness", []).append(group)
    return groups


def changes_of(
    numbers: FreeNumbers,
    x: Floats,
    system: System,
    speed: float,
    eigenvalues: Floats,
    X: Shapes,
    *,
    shapes: bool = False,
) -> list[Change]:
    """Return what each free number changes about x (p,), where the model has a system, at shapes X (n, m) with w^2 (m,).

    Raises:
        AnalysisError: a number that moves a place away from another one that it coincides with.
    """
    found = []
    springs = springs_of(numbers.model, system)
    for j, address in enumerate(numbers.addresses):
        if address in springs:
            strain, _ = _energies(springs[address], system.dofs.expand(X))
            K = assemble(springs[address], system.dofs, lambda group: group.matrices.stiffness) if shapes else None
            found.append(Change(strain, np.zeros(len(strain)), None if K is None else K @ X))
            continue
        above, below = beside(numbers, x, j, system, speed)
        sides = (_energies(side.groups_at(speed), side.dofs.expand(X)) for side in (above, below))
        strain, kinetic = ((high - low) / (2.0 * STEP) for high, low in zip(*sides, strict=True))
        form = strain - eigenvalues * kinetic
        if speed:
            # i phi^H G phi = -2 a^T G b of phi = a + i b.
            G = above.gyroscopic - below.gyroscopic
            swept = -2.0 * np.sum(np.real(X) * (G @ np.imag(X)), axis=0) / (2.0 * STEP)
            form = form + np.sqrt(eigenvalues) * speed * swept
        forces = changed_forces(above, below, 2.0 * STEP, speed, eigenvalues, X) if shapes else None
        found.append(Change(form, kinetic, forces))
    return found


def frequency_slopes(system: System, speed: float, changes: list[Change], eigenvalues: Floats, X: Shapes) -> Floats:
    """Return d ln f / dx (m, p) of modes with w^2 (m,) and shapes X (n, m), of modal mass 1 at standstill."""
    omega = np.sqrt(eigenvalues)
    size = 2.0 * eigenvalues
    if speed:
        size = size * np.real(np.sum(X.conj() * (system.mass @ X), axis=0))
        size -= omega * speed * np.real(1j * np.sum(X.conj() * (system.gyroscopic @ X), axis=0))
    return np.array([change.form / size for change in changes]).T.reshape(len(omega), len(changes))


def shape_slopes(
    system: System, speed: float, changes: list[Change], eigenvalues: Floats, vectors: Shapes, chosen: NDArray[np.intp]
) -> Shapes:
    """Return d phi / dx (n, k, p) of k chosen ones of the modes `vectors` (n, m) with w^2 (m,).

    Modes at one frequency are any basis of their space: what they turn into within it means nothing, and is left 0.
    """
    found: Shapes = np.zeros((len(vectors), len(chosen), len(changes)), dtype=complex if speed else float)
    for i, mode in enumerate(chosen):
        equal = np.flatnonzero(np.abs(eigenvalues - eigenvalues[mode]) <= EQUAL * eigenvalues[mode])
        along = np.zeros((len(equal), len(changes)))
        if not speed:
            along[np.flatnonzero(equal == mode)[0]] = [-0.5 * change.kinetic[i] for change in changes]
        forces = np.stack([np.asarray(change.forces)[:, i] for change in changes], axis=1)
        found[:, i] = bordered(system, speed, eigenvalues[mode], vectors[:, equal], forces, along)
    return found


def bordered(system: System, speed: float, eigenvalue: float, modes: Shapes, forces: Shapes, along: Floats) -> Shapes:
    """phi' (n, p) by Nelson's system: Q phi' = -`forces` (n, p) outside `modes` (n, c), and C^H phi' = `along` (c, p)."""
    from scipy.sparse.linalg import splu

    M = system.mass
    Q = system.stiffness(speed) - eigenvalue * M
    C = M @ modes
    B = C
    if speed:
        w = np.sqrt(eigenvalue)
        Q = Q + 1j * w * speed * system.gyroscopic
        B = 2.0 * w * C - 1j * speed * (system.gyroscopic @ modes)
    A = sp.csc_array(sp.block_array([[Q, sp.csc_array(B)], [sp.csc_array(C).conj().T, None]]))
    # Stiffnesses in N/m are beside ones in N m/rad, and the border beside both: all are scaled to unit size first.
    scale = 1.0 / np.sqrt(np.maximum(abs(A).max(axis=1).toarray().ravel(), 1e-300))
    S = sp.diags_array(scale)
    right: NDArray[Any] = scale[:, None] * np.vstack([-forces, along])
    return np.asarray(scale[:, None] * splu(sp.csc_array(S @ A @ S)).solve(right))[: len(modes)]


def changed_forces(above: System, below: System, width: float, speed: float, eigenvalues: Floats, X: Shapes) -> Shapes:
    """Q' X (n, m) at w^2 (m,) from the systems at both ends of a width."""
    K = (above.stiffness(speed) @ X - below.stiffness(speed) @ X) / width
    M = (above.mass @ X - below.mass @ X) / width
    if not speed:
        return np.asarray(K - eigenvalues * M)
    G = (above.gyroscopic @ X - below.gyroscopic @ X) / width
    return np.asarray(K + 1j * np.sqrt(eigenvalues) * speed * G - eigenvalues * M)


def _energies(groups: list[ElementGroup], q: Shapes) -> tuple[Floats, Floats]:
    """phi^H K phi and phi^H M phi, (m,) each, of some groups, summed element by element from strains, for all dofs q (a, m)."""
    strain = np.zeros(q.shape[1])
    kinetic = np.zeros(q.shape[1])
    for part in (q.real, q.imag) if np.iscomplexobj(q) else (q,):
        for group in groups:
            local = part[group.dofs]  # (e, d, m)
            m = group.matrices
            if m.mass is not None:
                kinetic += np.einsum("edm,edm->m", local, m.mass @ local)
            if m.strain is not None and m.modulus is not None:
                strains = m.strain @ local
                strain += np.einsum("esm,esm->m", strains, m.modulus @ strains)
    return strain, kinetic
