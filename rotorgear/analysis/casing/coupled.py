"""Modes of a whole gearbox with one of its casings: the casing reduced, or every node of its mesh beside the rotors.

Undamped and at standstill. The whole problem has the unknowns x = [u of the free nodes; dofs of all else], the motions of seats
being means of the nodes' (or, rigid, unknowns of their own):

    (K_fe + Pᵀ K_r P) x = λ (M_fe + Pᵀ M_r P) x
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from rotorgear.casings.casing import keep
from rotorgear.casings.constrained import lowest_modes
from rotorgear.casings.fe_body import FiniteElementBody, finite_element_body
from rotorgear.casings.mesh_error import eigenvalue_errors
from rotorgear.casings.reduction import reduce_in_basis
from rotorgear.model.layout.casings import casing_settings
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.solvers.sparse.large import factor_positive
from rotorgear.system.assembly import assemble
from rotorgear.system.system import flow_system

# A mode below this share of the highest one compared is a rigid motion.
_RIGID = 1e-3


@dataclass(frozen=True)
class CoupledModes:
    """Elastic modes of a gearbox.

    Attributes:
        frequency: (k,) in Hz, rising.
        mesh_error: (k,) estimated relative error by the mesh of the casing.
        reduction_error: (k,) by its reduction.
        dofs: of the mesh.
    """

    frequency: np.ndarray
    mesh_error: np.ndarray
    reduction_error: np.ndarray
    dofs: int


def reduced_modes(model: Model, name: str, count: int, progress: Progress = silent) -> CoupledModes:
    """The lowest elastic modes with the casing read, reduced as its settings say, and put between the rotors."""
    settings = casing_settings(model, name)
    fe = finite_element_body(settings, progress)
    body, _, basis = reduce_in_basis(fe, settings.modes_to, progress)
    keep(settings, body)
    system = flow_system(model)
    eigenvalues, shapes = la.eigh(system.stiffness().toarray(), system.mass.toarray())
    chosen = _elastic(eigenvalues, count)
    eigenvalues = eigenvalues[chosen]
    own = system.dofs.expand(shapes[:, chosen])[system.nodes.of_casing(name)]
    reduction = [body.eigenvalue_error(value, shape) or 0.0 for value, shape in zip(eigenvalues, own.T, strict=True)]
    return CoupledModes(
        frequency=np.sqrt(eigenvalues) / (2.0 * np.pi),
        mesh_error=0.5 * eigenvalue_errors(fe, eigenvalues, basis @ own) / eigenvalues,
        reduction_error=0.5 * np.array(reduction),
        dofs=fe.dofs,
    )


def whole_frequencies(model: Model, name: str, count: int, progress: Progress = silent) -> np.ndarray:
    """The lowest elastic frequencies (count,) in Hz with every node of the casing's mesh: nothing of it is reduced."""
    system = flow_system(model)
    fe = finite_element_body(casing_settings(model, name), progress)
    shapes, seats = _mesh_space(fe)
    of_casing = system.nodes.of_casing(name)
    numbers = np.flatnonzero(np.abs(system.dofs.transform[of_casing, :]).sum(axis=0))
    others = np.setdiff1d(np.arange(system.n), numbers)
    # The reduced body's other coordinates have no part in the matrices of the rotors.
    rows = sp.csr_array((np.ones(len(others)), (others, np.arange(len(others)))), shape=(system.n, len(others)))
    means = sp.coo_array(seats)
    motions = sp.csr_array((means.data, (numbers[means.row], means.col)), shape=(system.n, seats.shape[1]))
    P = sp.hstack([motions, rows], format="csr")
    groups = [group for group in system.groups_at(0.0) if group.part != f"casings.{name}"]
    mass = sp.kron(fe.matrices.mass, sp.eye_array(3), format="csr")
    springs, flexibility = fe.springs()
    spring = sp.csr_array(shapes.T @ springs)
    empty = sp.csr_array((len(others), len(others)))
    rotor_stiffness = assemble(groups, system.dofs, lambda g: g.matrices.stiffness)
    rotor_mass = assemble(groups, system.dofs, lambda g: g.matrices.mass)
    casing_stiffness = fe.stiffness_in(shapes) + (spring / flexibility) @ spring.T
    K = sp.csr_array(sp.block_diag([casing_stiffness, empty]) + P.T @ (rotor_stiffness @ P))
    M = sp.csr_array(sp.block_diag([shapes.T @ mass @ shapes, empty]) + P.T @ (rotor_mass @ P))
    # Rotors may turn freely: a shift below the elastic modes makes the matrix one that is positive.
    shift = float(K.diagonal().sum() / M.diagonal().sum()) * 1e-8
    factor = factor_positive(sp.csr_array(K + shift * M), 1, f"casings.{name} with the rotors", progress)
    squares, _ = lowest_modes(factor.solve, lambda x: np.asarray(M @ x), K.shape[0], count + 8)
    squares = squares - shift
    return np.asarray(np.sqrt(squares[_elastic(squares, count)]) / (2.0 * np.pi))


def _mesh_space(fe: FiniteElementBody) -> tuple[sp.csr_array, sp.csr_array]:
    """Displacements (3p, f) of the mesh from its unknowns, and motions (6 s, f) of the seats from them."""
    if fe.settings.connection == "mean":
        space = fe.free_space(held=True, rigid_seats=False)
        return space.shapes, sp.csr_array(space.forces(fe.mean_weights(fe.seats)).T)
    space = fe.free_space(held=True, rigid_seats=True)
    count = space.seats.shape[1]
    motions = sp.hstack([sp.csr_array((count, space.shapes.shape[1])), sp.eye_array(count)], format="csr")
    return sp.csr_array(sp.hstack([space.shapes, space.seats], format="csr")), sp.csr_array(motions)


def _elastic(eigenvalues: np.ndarray, count: int) -> np.ndarray:
    """Numbers of the lowest elastic modes among rising eigenvalues: rigid ones are far below all of them."""
    highest = eigenvalues[min(count, len(eigenvalues) - 1)]
    return np.flatnonzero(eigenvalues > _RIGID**2 * highest)[:count]
