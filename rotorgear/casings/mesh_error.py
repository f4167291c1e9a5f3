"""How much too large the eigenvalues of a mesh are, by what elements of higher orders would take up.

A mode (λ_h, u) of quadratic elements leaves the residual r(v) = λ_h ∫ ρ u·v - ∫ σ(u):ε(v) in the functions v of the next order
that they lack: on edges and on the faces of tetrahedra; on edges, on faces and inside hexahedra. With these it would have

    λ_h - λ ≈ r · e less,    K_cc e = r,

where K_cc is the stiffness of these functions alone: the hierarchical estimate (Zienkiewicz, Gago and Kelly, Computers &
Structures 16, 1983). The condition of K_cc does not depend on the size of the elements, so that a few steps of conjugate
gradients on elements one by one are enough.

Where u is smooth the orders beyond the next bring little more; beside clamped faces and re-entrant edges they bring as much
again. Which of the two holds is seen in each element, as in hp-methods by the decay of Legendre coefficients (Houston and Süli,
Comput. Methods Appl. Mech. Eng. 194, 2005). Energies left by order p fall like p^-a, with a > 2 even at the tip of a crack
(Babuska and Suri, SIAM Review 36, 1994), so that the energies S_2 of the quadratic part of u and S_3 of e in an element tell a,
and with it the rest:

    S_3 / S_2 = (2^-a - 3^-a) / (1 - 2^-a),    all orders from 3 on: S_3 / (1 - (2/3)^a)

Frequencies err by half of it, relatively.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from rotorgear.casings.elements import Element
from rotorgear.casings.fe_body import FiniteElementBody
from rotorgear.casings.solid_mesh import STIFFNESS_DEGREE, in_space

# Products of gradients of the functions of the next order, with some to spare, by the number of corners.
_DEGREE = {4: 6, 8: 8}
_CHUNK = 1000
_ENOUGH = 1e-2  # of the estimate itself
_MOST_STEPS = 60
# The slowest decay of energies over the order in an elastic body, which is that beside the tip of a crack.
_CRACK = 2.0
# Values (q,) and gradient (3, q) of a function on the reference cell.
_Factor = tuple[np.ndarray, np.ndarray]


def eigenvalue_errors(fe: FiniteElementBody, eigenvalues: np.ndarray, shapes: np.ndarray) -> np.ndarray:
    """Estimate λ_h - λ (k,) in (rad/s)^2 of modes of a mesh, by itself or as a part of a larger structure.

    Args:
        fe: the body.
        eigenvalues: λ_h (k,).
        shapes: (3p, k), of modal mass 1 of the whole structure.
    """
    if not shapes.shape[1]:
        return np.zeros(0)
    number, sign, loose = _functions(fe)
    elements, residual = _system(fe, eigenvalues, shapes, sign)
    # Sums over the elements: of each function its residual r, and its own 3 x 3 block of K_cc, which conditions the steps.
    m = number.shape[1]
    gather = sp.csr_array((np.ones(number.size), (np.arange(number.size), number.ravel())))
    free = loose[:, None, None]
    r = np.asarray(gather.T @ residual.reshape(number.size, -1)).reshape(len(loose), 3, -1) * free
    of_elements = elements.reshape(-1, m, 3, m, 3)
    diagonal = np.stack([of_elements[:, a, :, a, :] for a in range(m)], axis=1).reshape(-1, 9).astype(float)
    blocks = np.asarray(gather.T @ diagonal).reshape(-1, 3, 3)

    def by_elements(x: np.ndarray) -> np.ndarray:
        """Values (e, 3m, k) of the functions of each element, from those of all functions (g, 3, k)."""
        found = np.asarray(gather @ x.reshape(len(x), -1)).reshape(len(elements), -1, x.shape[2])
        return found.astype(np.float32)

    x = np.zeros_like(r)
    step = np.linalg.solve(blocks, r) * free
    direction = step.copy()
    product = np.einsum("gik,gik->k", r, step)
    energy = np.zeros(r.shape[2])
    # Conjugate gradients for all modes side by side: the energy r·x grows towards the estimate with every step.
    for _ in range(_MOST_STEPS):
        forces = (elements @ by_elements(direction)).reshape(number.size, -1)
        image = np.asarray(gather.T @ forces).reshape(x.shape) * free
        length = product / np.maximum(np.einsum("gik,gik->k", direction, image), 1e-300)
        x += length * direction
        r -= length * image
        gained = length * product
        energy += gained
        if np.all(gained <= _ENOUGH * energy):
            break
        step = np.linalg.solve(blocks, r) * free
        former = product
        product = np.einsum("gik,gik->k", r, step)
        direction = step + product / np.maximum(former, 1e-300) * direction
    local = by_elements(x)
    cubic = np.asarray(np.einsum("eak,eak->ek", local, elements @ local), dtype=float)
    return np.asarray(np.sum(_all_orders(cubic, _quadratic_energies(fe, shapes)), axis=0))


def _all_orders(cubic: np.ndarray, quadratic: np.ndarray) -> np.ndarray:
    """Energies (e, k) of all orders from 3 on, from those of orders 3 and 2 in each element."""
    decay = np.linspace(_CRACK, 40.0, 2000)
    ratio = (2.0**-decay - 3.0**-decay) / (1.0 - 2.0**-decay)
    own = np.interp(cubic / np.maximum(quadratic, 1e-300), ratio[::-1], decay[::-1])
    return np.asarray(cubic / (1.0 - (2.0 / 3.0) ** own))


def _quadratic_energies(fe: FiniteElementBody, shapes: np.ndarray) -> np.ndarray:
    """Twice the strain energy (e, k), in each element, of what displacements (3p, k) have beyond those of its corners."""
    mesh = fe.mesh
    shape = mesh.element
    places, weights = shape.quadrature(STIFFNESS_DEGREE)
    gradients = shape.shapes(places)[1]
    # Of displacements of the nodes those that are left when the corners' linear ones are taken off.
    beyond = np.eye(len(shape.nodes))
    beyond[:, : shape.corners] -= shape.linear.shapes(shape.nodes.T)[0].T
    lame, shear = fe.settings.material.lame
    u = shapes.reshape(len(mesh.points), 3, -1)
    energies = np.empty((len(mesh.cells), u.shape[2]))
    for start in range(0, len(mesh.cells), _CHUNK):
        cells = mesh.cells[start : start + _CHUNK]
        volume, slopes = in_space(mesh.points[cells], gradients, weights)
        own = np.einsum("kn,enim->ekim", beyond, u[cells], optimize=True)
        slope = np.einsum("eqki,ekjm->eqijm", slopes, own, optimize=True)
        strain = 0.5 * (slope + slope.transpose(0, 1, 3, 2, 4))
        density = 2.0 * shear * np.einsum("eqijm,eqijm->eqm", strain, strain, optimize=True)
        density += lame * np.einsum("eqiim->eqm", strain) ** 2
        energies[start : start + len(cells)] = np.einsum("eqm,eq->em", density, volume)
    return energies


def _system(
    fe: FiniteElementBody, eigenvalues: np.ndarray, shapes: np.ndarray, sign: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """K_cc (e, 3m, 3m) and residuals (e, m, 3, k) of the m functions that each element lacks, of the signs (e, m)."""
    mesh = fe.mesh
    shape = mesh.element
    m = sign.shape[1]
    k = shapes.shape[1]
    places, weights = shape.quadrature(_DEGREE[shape.corners])
    values, gradients = shape.shapes(places)
    # Values (m, q) and gradients (m, 3, q) of the functions of the next order, in the order of `_functions`.
    products = _of_tetrahedron(shape, places) if shape.corners == 4 else _of_hexahedron(shape, places)
    multiplied = [_product(factors) for factors in products]
    own_values = np.array([value for value, _ in multiplied])
    own_gradients = np.array([gradient for _, gradient in multiplied])
    lame, shear = fe.settings.material.lame
    density = fe.settings.material.density
    moved = shapes.reshape(len(mesh.points), 3, k)
    # Single precision is enough for an estimate, and half the memory.
    elements = np.empty((len(mesh.cells), 3 * m, 3 * m), dtype=np.float32)
    residual = np.zeros((len(mesh.cells), m, 3, k))
    for start in range(0, len(mesh.cells), _CHUNK):
        cells = mesh.cells[start : start + _CHUNK]
        here = slice(start, start + len(cells))
        volume, slopes = in_space(mesh.points[cells], gradients, weights, np.vstack([gradients, own_gradients]))
        slope = slopes[:, :, : len(gradients)]
        own_slope = slopes[:, :, len(gradients) :] * sign[here][:, None, :, None]
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
    return elements, residual


def _functions(fe: FiniteElementBody) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Numbers (e, m) of the functions of each element, their signs (e, m), and which of them are free (g,): not on held faces.

    A cubic function of an edge changes its sign with the edge's direction, which is that of rising numbers of nodes. The faces of
    hexahedra have one function for each of their corners, so that both sides know which is which.
    """
    mesh = fe.mesh
    shape = mesh.element
    stuck = np.zeros(len(mesh.points), dtype=bool)
    stuck[fe.held] = True
    # Functions on tied faces would part them.
    stuck[fe.joined.tied] = True
    edges = mesh.cells[:, np.array(shape.edges)]
    names, number = np.unique(np.sort(edges, axis=2).reshape(-1, 2), axis=0, return_inverse=True)
    faces = mesh.cells[:, np.array(shape.faces)]
    ordered = np.sort(faces, axis=2)
    face_names, face_number = np.unique(ordered.reshape(-1, faces.shape[2]), axis=0, return_inverse=True)
    numbers = [number.reshape(len(mesh.cells), -1)]
    free = [~stuck[names].all(axis=1)]
    of_faces = face_number.reshape(len(mesh.cells), -1)
    free_faces = ~stuck[face_names].all(axis=1)
    if shape.corners == 4:
        numbers.append(len(names) + of_faces)
        free.append(free_faces)
    else:
        rank = np.sum(ordered[:, :, None, :] < faces[:, :, :, None], axis=3)
        numbers.append(len(names) + (4 * of_faces[:, :, None] + rank).reshape(len(mesh.cells), -1))
        numbers.append(len(names) + 4 * len(face_names) + np.arange(len(mesh.cells))[:, None])
        free += [np.repeat(free_faces, 4), np.ones(len(mesh.cells), dtype=bool)]
    sign = np.where(edges[:, :, 0] < edges[:, :, 1], 1.0, -1.0)
    all_numbers = np.hstack(numbers)
    others = np.ones((len(mesh.cells), all_numbers.shape[1] - sign.shape[1]))
    return all_numbers, np.hstack([sign, others]), np.concatenate(free)


def _of_tetrahedron(shape: Element, places: np.ndarray) -> list[list[_Factor]]:
    """A function of each edge, L_i L_j (L_i - L_j), and of each face, L_i L_j L_k, in the coordinates L of the corners."""
    unit = np.eye(3)
    L = [_linear(1.0, -np.ones(3), places), *(_linear(0.0, unit[axis], places) for axis in range(3))]
    edges = [[L[i], L[j], (L[i][0] - L[j][0], L[i][1] - L[j][1])] for i, j in shape.edges]
    faces = [[L[i] for i in face] for face in shape.faces]
    return edges + faces


def _of_hexahedron(shape: Element, places: np.ndarray) -> list[list[_Factor]]:
    """Functions of each edge (odd along it), of each face (one towards each of its corners), and of the inside."""
    unit = np.eye(3)
    corners = shape.nodes[:8]

    def towards(axis: int, side: float) -> _Factor:
        """1 on one side of the cube, 0 on the other."""
        return _linear(0.0, unit[axis], places) if side else _linear(1.0, -unit[axis], places)

    products = []
    for i, j in shape.edges:
        along = int(np.argmax(np.abs(corners[j] - corners[i])))
        rising = corners[j, along] - corners[i, along]
        ends = [towards(axis, corners[i, axis]) for axis in range(3) if axis != along]
        middle = _linear(rising, -2.0 * rising * unit[along], places)
        products.append([towards(along, 0.0), towards(along, 1.0), middle, *ends])
    for face in shape.faces:
        normal = int(np.argmin(np.ptp(corners[list(face)], axis=0)))
        across = [axis for axis in range(3) if axis != normal]
        bubble = [towards(axis, side) for axis in across for side in (0.0, 1.0)]
        for corner in face:
            own = [towards(axis, corners[corner, axis]) for axis in across]
            products.append([towards(normal, corners[face[0], normal]), *bubble, *own])
    products.append([towards(axis, side) for axis in range(3) for side in (0.0, 1.0)])
    return products


def _linear(constant: float, slope: np.ndarray, places: np.ndarray) -> _Factor:
    """A linear function and its gradient at all places."""
    return constant + slope @ places, np.broadcast_to(slope[:, None], places.shape)


def _product(factors: list[_Factor]) -> _Factor:
    """The product of functions, and its gradient by the product rule."""
    value = np.prod([factor[0] for factor in factors], axis=0)
    gradient = np.zeros_like(factors[0][1])
    for i, (_, slope) in enumerate(factors):
        rest = np.prod([factor[0] for j, factor in enumerate(factors) if j != i], axis=0)
        gradient += slope * rest
    return value, gradient
