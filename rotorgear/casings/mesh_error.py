"""How much too large the eigenvalues of a mesh are, by what elements of the next order would take up.

A mode (λ_h, u) of quadratic elements leaves the residual r(v) = λ_h ∫ ρ u·v - ∫ σ(u):ε(v) in the cubic functions v that they
lack: on edges, and on the faces of tetrahedra (quadratic ones on the faces of hexahedra of 20 nodes). With these it would have

    λ_h - λ ≈ r · e less,    K_cc e = r,

where K_cc is the stiffness of these functions alone: the hierarchical estimate (Zienkiewicz, Gago and Kelly, Computers &
Structures 16, 1983). The condition of K_cc does not depend on the size of the elements, so that a few steps of conjugate
gradients on elements one by one are enough. Frequencies err by half of it, relatively. What orders beyond the next would bring
is not in it: beside sharp re-entrant edges and clamped faces it is too small by a factor of two or so.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from rotorgear.casings.elements import Element
from rotorgear.casings.fe_body import FiniteElementBody

_DEGREE = 6  # products of gradients of cubic functions, with some to spare
_CHUNK = 2000
_ENOUGH = 1e-2  # of the estimate itself
_MOST_STEPS = 60


def eigenvalue_errors(fe: FiniteElementBody, eigenvalues: np.ndarray, shapes: np.ndarray) -> np.ndarray:
    """Estimate λ_h - λ (k,) in (rad/s)^2 of modes of a mesh.

    Args:
        fe: the body.
        eigenvalues: λ_h (k,).
        shapes: (3p, k), of modal mass 1.
    """
    system = _system(fe, eigenvalues, shapes)
    free = system.free
    r = system.residual * free[:, None, None]
    x = np.zeros_like(r)
    step = system.preconditioned(r) * free[:, None, None]
    direction = step.copy()
    product = np.einsum("gik,gik->k", r, step)
    energy = np.zeros(r.shape[2])
    # Conjugate gradients for all modes side by side: the energy r·x grows towards the estimate with every step.
    for _ in range(_MOST_STEPS):
        image = system.stiffness_times(direction) * free[:, None, None]
        length = product / np.maximum(np.einsum("gik,gik->k", direction, image), 1e-300)
        x += length * direction
        r -= length * image
        gained = length * product
        energy += gained
        if np.all(gained <= _ENOUGH * energy):
            break
        step = system.preconditioned(r) * free[:, None, None]
        former = product
        product = np.einsum("gik,gik->k", r, step)
        direction = step + product / np.maximum(former, 1e-300) * direction
    return energy


@dataclass(frozen=True)
class _System:
    """K_cc by elements, and residuals (g, 3, k) of the g functions that the elements lack."""

    elements: np.ndarray
    gather: sp.csr_array
    residual: np.ndarray
    blocks: np.ndarray
    free: np.ndarray

    def stiffness_times(self, x: np.ndarray) -> np.ndarray:
        """K_cc x for x (g, 3, k)."""
        k = x.shape[2]
        local = np.asarray(self.gather @ x.reshape(len(x), -1)).reshape(len(self.elements), -1, k)
        return np.asarray(self.gather.T @ (self.elements @ local).reshape(-1, 3 * k)).reshape(x.shape)

    def preconditioned(self, r: np.ndarray) -> np.ndarray:
        """The answer of each function's own 3 x 3 block."""
        return np.asarray(np.linalg.solve(self.blocks, r))


def _system(fe: FiniteElementBody, eigenvalues: np.ndarray, shapes: np.ndarray) -> _System:
    mesh = fe.mesh
    shape = mesh.element
    number, sign, free = _functions(fe)
    count = int(number.max()) + 1
    k = shapes.shape[1]
    m = number.shape[1]
    places, weights = shape.quadrature(_DEGREE)
    values, gradients = shape.shapes(places)
    own_values, own_gradients = _missing(shape, places)
    lame, shear = fe.settings.material.lame
    density = fe.settings.material.density
    moved = shapes.reshape(len(mesh.points), 3, k)
    elements = np.empty((len(mesh.cells), 3 * m, 3 * m))
    residual = np.zeros((len(mesh.cells), m, 3, k))
    for start in range(0, len(mesh.cells), _CHUNK):
        cells = mesh.cells[start : start + _CHUNK]
        here = slice(start, start + len(cells))
        J = np.einsum("eni,njq->eqij", mesh.points[cells], gradients, optimize=True)
        volume = np.linalg.det(J) * weights
        inverse = np.linalg.inv(J)
        slope = np.einsum("eqji,njq->eqni", inverse, gradients, optimize=True)
        own_slope = np.einsum("eqji,njq->eqni", inverse, own_gradients, optimize=True) * sign[here][:, None, :, None]
        weighted = (own_slope * np.sqrt(volume)[:, :, None, None]).reshape(len(cells), -1, 3 * m)
        G = np.matmul(weighted.transpose(0, 2, 1), weighted).reshape(-1, m, 3, m, 3)
        trace = shear * np.einsum("eaibi->eab", G)
        K = lame * G + shear * G.transpose(0, 1, 4, 3, 2)
        for i in range(3):
            K[:, :, i, :, i] += trace
        elements[here] = K.reshape(len(cells), 3 * m, 3 * m)
        u_slope = np.einsum("enik,eqnj->eqijk", moved[cells], slope, optimize=True)
        stress = shear * (u_slope + u_slope.transpose(0, 1, 3, 2, 4))
        pressure = lame * np.einsum("eqiik->eqk", u_slope)
        for i in range(3):
            stress[:, :, i, i] += pressure
        stress *= volume[:, :, None, None, None]
        inner = np.einsum("eqijk,eqnj->enik", stress, own_slope, optimize=True)
        u = np.einsum("nq,enik->eqik", values, moved[cells], optimize=True) * (density * volume)[:, :, None, None]
        inertia = np.einsum("eqik,nq->enik", u, own_values, optimize=True) * sign[here][:, :, None, None] * eigenvalues
        residual[here] = inertia - inner
    rows = np.arange(number.size)
    gather = sp.csr_array((np.ones(number.size), (rows, number.ravel())), shape=(number.size, count))
    own = elements.reshape(-1, m, 3, m, 3)
    diagonal = np.stack([own[:, a, :, a, :] for a in range(m)], axis=1).reshape(-1, 9)
    blocks = np.asarray(gather.T @ diagonal).reshape(count, 3, 3)
    summed = np.asarray(gather.T @ residual.reshape(-1, 3 * k)).reshape(count, 3, k)
    return _System(elements, gather, summed, blocks, free)


def _functions(fe: FiniteElementBody) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Numbers (e, m) of the functions of each element, their signs (e, m), and which of them are free (g,): not on held faces.

    A cubic function of an edge changes its sign with the edge's direction, which is that of rising numbers of nodes.
    """
    mesh = fe.mesh
    shape = mesh.element
    edges = mesh.cells[:, np.array(shape.edges)]
    keys = np.sort(edges, axis=2).reshape(-1, 2)
    names, number = np.unique(keys, axis=0, return_inverse=True)
    number = number.reshape(len(mesh.cells), -1)
    sign = np.where(edges[:, :, 0] < edges[:, :, 1], 1.0, -1.0)
    stuck = np.zeros(len(mesh.points), dtype=bool)
    stuck[fe.held] = True
    # Functions on tied faces would part them.
    stuck[fe.joined.tied] = True
    free = ~stuck[names].all(axis=1)
    if shape.kind != "hexahedron27":  # which has its faces' functions
        faces = np.sort(mesh.cells[:, np.array(shape.faces)], axis=2)
        face_names, face_number = np.unique(faces.reshape(-1, faces.shape[2]), axis=0, return_inverse=True)
        number = np.hstack([number, len(names) + face_number.reshape(len(mesh.cells), -1)])
        sign = np.hstack([sign, np.ones((len(mesh.cells), len(shape.faces)))])
        free = np.concatenate([free, ~stuck[face_names].all(axis=1)])
    return number, sign, free


def _missing(shape: Element, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Values (m, q) and gradients (m, 3, q) of the functions of the next order on the reference cell: edges, then faces."""
    values: list[np.ndarray] = []
    gradients: list[np.ndarray] = []

    def product(*factors: tuple[np.ndarray, np.ndarray]) -> None:
        value = np.prod([factor[0] for factor in factors], axis=0)
        gradient = np.zeros((3, places.shape[1]))
        for i, (_, slope) in enumerate(factors):
            rest = np.prod([factor[0] for j, factor in enumerate(factors) if j != i], axis=0)
            gradient += slope * rest
        values.append(value)
        gradients.append(gradient)

    def linear(constant: float, slope: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return constant + slope @ places, np.broadcast_to(slope[:, None], places.shape)

    unit = np.eye(3)
    if shape.corners == 4:
        barycentric = [linear(1.0, -np.ones(3)), *(linear(0.0, unit[i]) for i in range(3))]
        for i, j in shape.edges:
            a, b = barycentric[i], barycentric[j]
            product(a, b, (a[0] - b[0], a[1] - b[1]))
        for face in shape.faces:
            product(*(barycentric[i] for i in face))
        return np.array(values), np.array(gradients)

    def towards(axis: int, side: float) -> tuple[np.ndarray, np.ndarray]:
        """1 on one side of the cube, 0 on the other."""
        return linear(0.0, unit[axis]) if side else linear(1.0, -unit[axis])

    corners = shape.nodes[:8]
    for i, j in shape.edges:
        along = int(np.argmax(np.abs(corners[j] - corners[i])))
        rising = corners[j, along] - corners[i, along]
        across = [towards(axis, corners[i, axis]) for axis in range(3) if axis != along]
        middle = linear(rising, -2.0 * rising * unit[along])
        product(towards(along, 0.0), towards(along, 1.0), middle, *across)
    if shape.kind == "hexahedron20":
        for face in shape.faces:
            normal = int(np.argmin(np.ptp(corners[list(face)], axis=0)))
            bubble = [towards(axis, side) for axis in range(3) if axis != normal for side in (0.0, 1.0)]
            product(towards(normal, corners[face[0], normal]), *bubble)
    return np.array(values), np.array(gradients)
