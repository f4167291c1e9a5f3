"""Derivatives of natural frequencies and mode shapes with respect to free numbers of a model.

With (K - w^2 M) phi = 0 and phi^T M phi = 1 (Fox and Kapoor 1968, Rates of change of eigenvalues and eigenvectors, AIAA Journal
6):

    d w^2 / dx = phi^T (K' - w^2 M') phi,    so    d ln f / dx = (strain' - w^2 kinetic') / (2 w^2),

where strain' and kinetic' are the changes of phi^T K phi and phi^T M phi with phi held. They are central differences of
energies summed element by element: no eigenproblem is solved again, and nothing cancels as it would in K' phi of a stiff shaft.
A diameter enters to the fourth power, a place by the lengths beside it: the same few lines serve any number of the file. The
stiffness k of a spring enters as k dK/dk = K_spring, whose energy needs neither differences nor another assembly.

Shapes follow from Nelson's method (1976, Simplified calculation of eigenvector derivatives, AIAA Journal 14): the bordered system

    [K - w^2 M   M phi] [  phi'  ]   [-(K' - w^2 M') phi]
    [phi^T M     0    ] [-(w^2)' ] = [-phi^T M' phi / 2 ]

is regular where w is a simple eigenvalue, and phi' is exact, without a sum over modes that would have to be cut. Around an
eigenvalue of several modes stand all of them in the border (Ojalvo 1988, AIAA Journal 26): what leaves their space is exact.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from rotorgear.analysis.rig.learnt import SPRINGS
from rotorgear.analysis.static.state_at import linear_system
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.model.numbers import FreeNumbers
from rotorgear.system.assembly import assemble
from rotorgear.system.groups import ElementGroup
from rotorgear.system.plan import Plan
from rotorgear.system.system import System

# Half width of the central differences in x = ln p: their error is h^2 / 6 times the third derivative, some 1e-9 here, and
# rounding is 1e-15 / h of the energies.
STEP = 1e-4
# Modes whose w^2 agree to this share of it are taken as one eigenvalue; simple ones are exact to rounding over it.
EQUAL = 1e-7


@dataclass(frozen=True)
class Changes:
    """What one free number changes at fixed shapes X (n, m), per unit of x = ln p.

    Attributes:
        strain: of phi^T K phi (m,).
        kinetic: of phi^T M phi (m,).
        stiffness_times: K' X (n, m), None where shapes were not asked for.
        mass_times: M' X (n, m), the same.
    """

    strain: NDArray[np.float64]
    kinetic: NDArray[np.float64]
    stiffness_times: NDArray[np.float64] | None
    mass_times: NDArray[np.float64] | None


def changes_of(
    numbers: FreeNumbers,
    x: NDArray[np.float64],
    system: System,
    plan: Plan,
    X: NDArray[np.float64],
    *,
    shapes: bool = False,
) -> list[Changes]:
    """Return what each number changes about x (p,), where the model has a system on the mesh of a plan, at shapes X (n, m).

    Raises:
        AnalysisError: a number that moves a place away from another one that it coincides with.
    """
    found = []
    springs = springs_of(numbers.model, system)
    for j, address in enumerate(numbers.addresses):
        part, _, name = address.rpartition(".")
        if name == "stiffness" and part in springs:
            found.append(_of_spring(system, springs[part], X, shapes))
            continue
        above, below = beside(numbers, x, j, system, plan)
        strain, kinetic = (
            (high - low) / (2.0 * STEP) for high, low in zip(energies(above, X), energies(below, X), strict=True)
        )
        K = (above.stiffness() @ X - below.stiffness() @ X) / (2.0 * STEP) if shapes else None
        M = (above.mass @ X - below.mass @ X) / (2.0 * STEP) if shapes else None
        found.append(Changes(strain, kinetic, K, M))
    return found


def beside(
    numbers: FreeNumbers, x: NDArray[np.float64], j: int, system: System, plan: Plan, speed: float = 0.0
) -> tuple[System, System]:
    """The systems above and below x (p,) in number j, on the mesh of a plan.

    Raises:
        AnalysisError: a number that moves a place away from another one that it coincides with.
    """
    step = np.zeros(len(x))
    step[j] = STEP
    above = system_of(numbers.at(x + step), plan, speed)
    below = system_of(numbers.at(x - step), plan, speed)
    if not above.n == below.n == system.n:
        # Two places that coincide part under the change, and shapes of one mesh mean nothing on the other.
        raise AnalysisError(
            f"{numbers.addresses[j]}: a change moves a place away from another one that it coincides with, so that the "
            "shafts are cut otherwise; move one of them by a hair in the file, or leave it out"
        )
    return above, below


def springs_of(model: Model, system: System, speed: float = 0.0) -> dict[str, list[ElementGroup]]:
    """Springs whose stiffness matrix is in proportion to the number that the file gives, by address.

    Where a law is linearised about an equilibrium, or a mesh has the stiffness of its load, any number may change any spring.
    """
    if not system.state.is_flow:
        return {}
    if any(isinstance(mesh.stiffness, str) for mesh in model.meshes.values()):
        return {}
    groups: dict[str, list[ElementGroup]] = {}
    for group in system.groups:
        if group.part.partition(".")[0] in SPRINGS and group.matrices.strain is not None:
            groups.setdefault(group.part, []).append(group)
    return groups


def _of_spring(system: System, groups: list[ElementGroup], X: NDArray[np.float64], shapes: bool) -> Changes:
    """What the log of a spring's stiffness changes: its own energy and forces."""
    strain, _ = group_energies(groups, system.dofs.expand(X))
    nothing = np.zeros(X.shape[1])
    if not shapes:
        return Changes(strain, nothing, None, None)
    K = assemble(groups, system.dofs, lambda group: group.matrices.stiffness)
    return Changes(strain, nothing, K @ X, np.zeros_like(X))


def system_of(model: Model, plan: Plan, speed: float = 0.0) -> System:
    """The linear system of a model about its equilibrium at a speed in rad/s, 0 at standstill, on the mesh of a plan."""
    return linear_system(model, [speed or None], plan)


def frequency_derivatives(changes: list[Changes], eigenvalues: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return d ln f / dx, (m, p), of modes with eigenvalues w^2 (m,) and modal mass 1."""
    columns = [(change.strain - eigenvalues * change.kinetic) / (2.0 * eigenvalues) for change in changes]
    return np.array(columns).T.reshape(len(eigenvalues), len(changes))


def shape_derivatives(
    system: System,
    changes: list[Changes],
    eigenvalues: NDArray[np.float64],
    vectors: NDArray[np.float64],
    chosen: NDArray[np.intp],
) -> NDArray[np.float64]:
    """Return d phi / dx, (n, k, p), of k chosen ones of the modes `vectors` (n, m), modal mass 1, with eigenvalues w^2 (m,).

    Modes at one frequency are any basis of their space: what they turn into within it means nothing, and is left 0.
    """
    K = system.stiffness()
    M = system.mass
    n = len(vectors)
    found = np.zeros((n, len(chosen), len(changes)))
    for i, mode in enumerate(chosen):
        w2 = eigenvalues[mode]
        equal = np.flatnonzero(np.abs(eigenvalues - w2) <= EQUAL * w2)
        border = sp.csc_array(M @ vectors[:, equal])
        bordered = sp.csc_array(sp.block_array([[K - w2 * M, border], [border.T, None]]))
        right = np.zeros((n + len(equal), len(changes)))
        own = n + int(np.flatnonzero(equal == mode)[0])
        for j, change in enumerate(changes):
            assert change.stiffness_times is not None
            assert change.mass_times is not None
            # What of it lies along M phi, the change of w^2, goes to the multipliers of the border.
            right[:n, j] = -(change.stiffness_times[:, i] - w2 * change.mass_times[:, i])
            right[own, j] = -0.5 * change.kinetic[i]
        found[:, i] = solved(bordered, right)[:n]
    return found


def energies(
    system: System, X: NDArray[np.float64], speed: float = 0.0
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return phi^T K phi and phi^T M phi, (m,) each, summed element by element from strains, for shapes X (n, m)."""
    return group_energies(system.groups_at(speed), system.dofs.expand(X))


def group_energies(
    groups: list[ElementGroup], q: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The same of some groups, for shapes q (a, m) of all dofs."""
    strain = np.zeros(q.shape[1])
    kinetic = np.zeros(q.shape[1])
    for group in groups:
        local = q[group.dofs]  # (e, d, m)
        m = group.matrices
        if m.mass is not None:
            kinetic += np.einsum("edm,edm->m", local, m.mass @ local)
        if m.strain is not None and m.modulus is not None:
            strains = m.strain @ local
            strain += np.einsum("esm,esm->m", strains, m.modulus @ strains)
    return strain, kinetic


def solved(A: sp.csc_array, right: NDArray[Any]) -> NDArray[Any]:
    """The answer of a bordered system, real or complex."""
    from scipy.sparse.linalg import splu

    # Stiffnesses in N/m stand beside ones in N m/rad, and the border beside both: to unit size first.
    scale = 1.0 / np.sqrt(np.maximum(abs(A).max(axis=1).toarray().ravel(), 1e-300))
    S = sp.diags_array(scale)
    return np.asarray(scale[:, None] * splu(sp.csc_array(S @ A @ S)).solve(scale[:, None] * right))
