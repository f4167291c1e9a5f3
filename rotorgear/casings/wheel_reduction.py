"""Reduction of a gear body that turns: modes on its bore, what rim and acceleration move statically, and their nodal diameters.

The coordinates are modes with the bore at rest, up to a frequency, and what else answers statically to forces on the rim's mean
motion and to accelerations of the bore, so that the static flexibility between bore and rim is that of the mesh.

In a body of revolution a field that is turned about the axis is a field of the same body. Turned by a small angle dα it changes
by -L u dα, L u = ∂u/∂θ - k x u. Two modes of one frequency are its waves of n nodal diameters, f = u_1 + i u_2 ~ exp(i n θ), L f
= i n f; they are told by Λ = ∫ ρ Eᵀ L E dV, and n by the largest wave of the rim. With ∂u/∂θ = L u + k x u all that rotation
brings follows from integrals of the fields themselves:

    T = L + Z,    H = Lᵀ L + Lᵀ Z + Zᵀ L + Q,    Z = ∫ ρ Eᵀ (k x E) dV,    Q = ∫ ρ (k x E)ᵀ (k x E) dV

A body with equal parts about its axis, and a mesh, is one of revolution nearly: a wave of a body with N holes has others of n ± N
in it, and two modes may have frequencies apart. Every matrix is replaced by its mean over all angles, which drops what couples
different n, and the two modes by their mean. So the system seen from the ground has constant matrices; how far that moves
frequencies is measured and kept.

What rotation adds are integrals over the mesh, each the same for all three directions. A body turns about its axis with speed
W, and its displacements u(x, t) are seen from the ground, as a field over places x. What a particle meets is D u = ∂u/∂t + W
∂u/∂θ (the derivatives of the components along x y z that stand still), so that

    ∫ ρ v · D²u dV = M ü + 2 W T u̇ - W² H u,   T_ab = ∫ ρ N_a ∂N_b/∂θ dV,   H_ab = ∫ ρ ∂N_a/∂θ ∂N_b/∂θ dV

and the stresses s of the centrifugal forces at W = 1 stiffen it by W² S, S_ab = ∫ ∇N_aᵀ s ∇N_b dV (Lamb and Southwell, Proc. R.
Soc. A 99, 1921, for a disk). For a body of revolution none of these depends on the angle that it has turned by, and for all its
rigid motions S - H vanishes.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from rotorgear.casings.assembly import Elastic
from rotorgear.casings.constrained import Constrained, ElasticBody, modes_up_to
from rotorgear.casings.fe_body import FiniteElementBody
from rotorgear.casings.mesh_error import eigenvalue_errors
from rotorgear.casings.reduced_body import rigid_motions
from rotorgear.casings.reduction import USUAL, independent, surface_of, symmetric
from rotorgear.casings.solid_mesh import MASS_DEGREE, STIFFNESS_DEGREE, SolidMesh, in_space
from rotorgear.casings.wheel import ReducedWheel
from rotorgear.errors import AnalysisError
from rotorgear.progress import Progress, silent
from rotorgear.quantity import millimetres

_CHUNK = 4000  # elements at a time


def spin_integrals(mesh: SolidMesh, material: Elastic, stretched: np.ndarray) -> list[sp.csr_array]:
    """T and S (p, p) of the docstring above, for each of the three directions, integrated over a mesh.

    Args:
        mesh: in m, its axis of rotation z.
        material: of all of it.
        stretched: (3p,) displacements by the centrifugal forces at 1 rad/s.
    """
    shape = mesh.element
    places, weights = shape.quadrature(MASS_DEGREE)
    values, gradients = shape.shapes(places)
    stress_places, stress_weights = shape.quadrature(STIFFNESS_DEGREE)
    stress_gradients = shape.shapes(stress_places)[1]
    lame, shear = material.lame
    moved = stretched.reshape(-1, 3)
    k = mesh.cells.shape[1]
    transport, stiff = np.empty((2, len(mesh.cells), k, k))
    for start in range(0, len(mesh.cells), _CHUNK):
        here = slice(start, start + _CHUNK)
        corners = mesh.points[mesh.cells[here]]
        volume, slopes = in_space(corners, gradients, weights)
        x, y = np.einsum("kq,eki->ieq", values, corners[:, :, :2])
        turned = x[:, :, None] * slopes[..., 1] - y[:, :, None] * slopes[..., 0]  # ∂N/∂θ, (e, q, k)
        transport[here] = np.einsum("aq,eqb->eab", values, turned * (material.density * volume)[:, :, None])
        volume, slopes = in_space(corners, stress_gradients, stress_weights)
        strain = np.einsum("eki,eqkj->eqij", moved[mesh.cells[here]], slopes, optimize=True)
        stress = shear * (strain + strain.transpose(0, 1, 3, 2))
        stress += lame * np.einsum("eqii->eq", strain)[:, :, None, None] * np.eye(3)
        pulled = np.einsum("eqij,eqbj->ebiq", stress * volume[:, :, None, None], slopes, optimize=True)
        flat = (len(corners), k, -1)
        stiff[here] = slopes.transpose(0, 2, 3, 1).reshape(flat) @ pulled.reshape(flat).transpose(0, 2, 1)
    rows = np.repeat(mesh.cells, k, axis=1).ravel()
    columns = np.tile(mesh.cells, (1, k)).ravel()
    size = (len(mesh.points), len(mesh.points))
    return [sp.csr_array(sp.coo_array((part.ravel(), (rows, columns)), shape=size)) for part in (transport, stiff)]


# Two modes whose frequencies are nearer than this (relative) may be a pair.
_PAIR = 5e-3
# Λ of a pair is n; of two modes that are no pair it is rounding, far below this.
_TURNS = 0.3
# How far a body may be from one of revolution (relative): in its moments of inertia, and in the frequencies of its modes when it
# is taken for one.
_OFF_INERTIA = 0.02
_OFF = 0.1
# How far centres may be off the axis, over the radius of the rim.
_OFF_AXIS = 5e-3


def reduce_wheel(fe: FiniteElementBody, modes_to: float | None, progress: Progress = silent) -> ReducedWheel:
    """Reduce a body whose seats are its bore and its rim, in this order.

    Args:
        fe: the body, in the axes of the gear.
        modes_to: Hz; None: the lowest `USUAL` modes.
        progress: of the steps.

    Raises:
        AnalysisError: a body that is not near to one of revolution about z, or more memory than there is.
        ConvergenceError: a factorisation or an iteration that failed.
    """
    name = fe.settings.address
    bore, rim = fe.seats
    of_rim = _Rim(fe)
    _about_the_axis(fe, of_rim.radius)
    rigid_bore = fe.settings.connection == "rigid"
    clamped = replace(fe, held=bore.nodes if rigid_bore else fe.held, seats=(rim,))
    space = clamped.free_space(held=True, rigid_seats=False)
    R = rigid_motions(fe.mesh.points)
    body = ElasticBody(fe.stiffness_in(space.shapes), R[space.dofs][:, : 0 if rigid_bore else 6], name, progress)
    at_rest = np.zeros((len(space.dofs), 0)) if rigid_bore else space.forces(fe.mean_weights((bore,)))
    system = Constrained(body, at_rest)

    progress(0.4, f"{name}: modes on the bore")
    of_mass = partial(fe.mass_times, space=space)
    squares, modes, left = modes_up_to(system.solve, of_mass, len(space.dofs), modes_to, USUAL, name)
    # A pair is kept or left as a whole; `left` is the frequency of the first mode that is not kept.
    hz = np.sqrt(squares) / (2.0 * np.pi)
    kept = len(hz)
    while kept and left < (1.0 + _PAIR) * hz[kept - 1]:
        kept -= 1
        left = float(hz[kept])
    progress(0.7, f"{name}: static shapes of the rim")
    modes = space.shapes @ modes[:, :kept]
    rim_weights = fe.mean_weights((rim,))
    static = space.shapes @ system.solve(space.forces(np.hstack([rim_weights, fe.matrices.times_mass(R)])))
    error = 0.5 * eigenvalue_errors(clamped, squares[:kept], modes) / squares[:kept]
    mass_modes = fe.matrices.times_mass(modes)
    for _ in range(2):
        static -= modes @ (mass_modes.T @ static)
    E = np.hstack([modes, independent(static, fe.matrices.times_mass(static))])
    squares, turn = la.eigh(symmetric(E.T @ fe.stiffness_times(E)), symmetric(E.T @ fe.matrices.times_mass(E)))
    E = E @ turn

    progress(0.8, f"{name}: rotation")
    outward = (fe.mesh.points * np.array([1.0, 1.0, 0.0])).reshape(-1, 1)  # centrifugal acceleration at 1 rad/s
    stretched = space.shapes @ system.solve(space.forces(fe.matrices.times_mass(outward)))
    transport, spin_stress = spin_integrals(fe.mesh, fe.settings.material, stretched[:, 0])
    waves = _waves(fe, of_rim, E, np.sqrt(squares), transport)
    frequency = waves.frequency
    own = np.flatnonzero(waves.first < kept)
    averaged = float(np.abs(waves.shift[own]).max(initial=0.0))
    if averaged > _OFF:
        raise _no_revolution(name, f"taking it for one moves the frequency of a mode by {100.0 * averaged:.2g} %")

    E = E @ waves.shapes
    everything = np.hstack([R, E])
    across = _across(everything)
    M = waves.mean(symmetric(everything.T @ fe.matrices.times_mass(everything)))
    M[6:, 6:] = np.eye(len(frequency))
    Z = waves.mean(everything.T @ fe.matrices.times_mass(across))
    Q = waves.mean(across.T @ fe.matrices.times_mass(across))
    stress = waves.mean(la.block_diag(np.zeros((6, 6)), _each_direction(spin_stress, E)))
    L = waves.turning
    T = M @ L + Z
    H = L.T @ M @ L + L.T @ Z + Z.T @ L + Q
    rim_motion = np.zeros_like(M)
    # Motion of a rigid body about the origin from that about the middle of the rim: v - θ x r.
    about_origin = np.vstack([rigid_motions(-rim.point[None, :]), np.eye(6)[3:]])
    rim_motion[:6, 6:] = about_origin @ (rim_weights.T @ E)
    cosine, sine = of_rim.waves(E, waves.diameters)
    mass, centre, inertia = fe.mass_properties
    progress(1.0, f"{name}: reduced to {len(frequency)} coordinates")
    return ReducedWheel(
        mass=M,
        gyroscopic=T - T.T,
        frequency=frequency,
        diameters=waves.diameters,
        spin_stiffness=symmetric(stress - H)[6:, 6:],
        turning=L[6:, 6:],
        damping_ratio=fe.settings.damping_ratio,
        body_mass=mass,
        polar_inertia=float(inertia[2, 2]),
        diametral_inertia=float(0.5 * (inertia[0, 0] + inertia[1, 1])),
        centre=float(centre[2]),
        rim_motion=waves.mean(rim_motion)[:6, 6:],
        rim_cosine=cosine,
        rim_sine=sine,
        rim_radius=of_rim.radius,
        modes=len(own),
        left_frequency=left,
        averaged=averaged,
        notes=fe.mesh.notes,
        mesh_error=float(error.max(initial=0.0)),
        surface=surface_of(fe, E),
    )


@dataclass(frozen=True)
class _Waves:
    """The coordinates by nodal diameters.

    Attributes:
        shapes: (m, k) their sums of the m modes; pairs stand side by side, all in the order of their frequencies.
        diameters: (k,) n.
        frequency: (k,) in Hz: of pairs that of their mean stiffness.
        shift: (k,) by how much (relative) that is off the modes' own.
        first: (k,) number of the first mode that each is of.
    """

    shapes: np.ndarray
    diameters: np.ndarray
    frequency: np.ndarray
    shift: np.ndarray
    first: np.ndarray

    @cached_property
    def turning(self) -> np.ndarray:
        """L (6 + k, 6 + k) of rigid motions and coordinates, of a pair with L (u_1 + i u_2) = i n (u_1 + i u_2)."""
        n = np.concatenate([_RIGID_DIAMETERS, self.diameters])
        L = np.zeros((len(n), len(n)))
        first = np.flatnonzero(n)[::2]  # pairs stand side by side
        L[first, first + 1] = n[first]
        L[first + 1, first] = -n[first]
        return L

    def mean(self, X: np.ndarray) -> np.ndarray:
        """The mean over all angles of the body of a matrix (6 + k, 6 + k) of rigid motions and coordinates."""
        values, waves = la.eigh(-1j * self.turning)
        n = np.rint(values)
        Y = waves.conj().T @ X @ waves
        Y[n[:, None] != n[None, :]] = 0.0
        return np.asarray(np.real(waves @ Y @ waves.conj().T))


# Of the rigid motions x y z rx ry rz: x + i y turns like a wave of one nodal diameter.
_RIGID_DIAMETERS = np.array([1, 1, 0, 1, 1, 0])


def _waves(fe: FiniteElementBody, rim: _Rim, E: np.ndarray, rates: np.ndarray, transport: sp.csr_array) -> _Waves:
    """Modes E (3p, m) of the angular frequencies (m,) as waves; a mode whose partner is not among them is left out."""
    turned = _each_direction(transport, E) - E.T @ fe.matrices.times_mass(_across(E))
    turned = 0.5 * (turned - turned.T)
    found: list[tuple[float, int, int, list[np.ndarray], float]] = []
    single: list[int] = []

    def add(columns: list[np.ndarray], first: int, n: int) -> None:
        # The frequency of a pair is that of its mean stiffness.
        rate = float(np.sqrt(np.mean([rates**2 @ column**2 for column in columns])))
        members = np.flatnonzero(np.abs(np.array(columns)).max(axis=0) > 0.1)
        shift = float(np.abs(rate / rates[members] - 1.0).max())
        found.append((rate / (2.0 * np.pi), n, first, columns, shift))

    start = 0
    for stop in range(1, len(rates) + 1):
        if stop < len(rates) and rates[stop] < (1.0 + _PAIR) * rates[stop - 1]:
            continue
        values, parts = la.eigh(-1j * turned[start:stop, start:stop])
        for value, part in zip(values, parts.T, strict=True):
            if value > _TURNS:
                f = np.zeros(len(rates), dtype=complex)
                f[start:stop] = np.sqrt(2.0) * part
                add([f.real, f.imag], start, max(1, rim.largest(E @ f)))
        still = parts[:, np.abs(values) <= _TURNS]
        if still.shape[1]:
            # Shapes without waves are made modes again within their span, so that each keeps its own frequency.
            real = la.orth(np.hstack([still.real, still.imag]), rcond=1e-6)
            if start + 1 == stop:
                single.append(start)
            else:
                for column in (real @ la.eigh((real.T * rates[start:stop] ** 2) @ real)[1]).T:
                    alone = np.zeros(len(rates))
                    alone[start:stop] = column
                    add([alone], start, 0)
        start = stop
    # In a body with N equal parts the two waves of N/2 and of N nodal diameters have different frequencies.
    while single:
        k = single.pop(0)
        partner = max(single, key=lambda j: abs(turned[k, j]), default=None)
        alone = np.eye(len(rates))[k]
        if partner is not None and abs(turned[k, partner]) > max(_TURNS, 0.5 * rim.largest(E[:, k])):
            single.remove(partner)
            other = np.sign(turned[k, partner]) * np.eye(len(rates))[partner]
            add([alone, other], k, max(1, rim.largest(E @ (alone + 1j * other))))
        elif rim.largest(E[:, k]) == 0:
            add([alone], k, 0)
    found.sort(key=lambda one: (one[0], one[2]))
    sizes = [len(one[3]) for one in found]
    return _Waves(
        shapes=np.column_stack([column for one in found for column in one[3]]),
        diameters=np.repeat([one[1] for one in found], sizes),
        frequency=np.repeat([one[0] for one in found], sizes),
        shift=np.repeat([one[4] for one in found], sizes),
        first=np.repeat([one[2] for one in found], sizes),
    )


class _Rim:
    """The nodes of the rim about the axis.

    Attributes:
        angle, z: (r,) of the nodes in rad and m.
        weight: (r,) area of each in m^2.
        radius: mean radius in m.
    """

    def __init__(self, fe: FiniteElementBody) -> None:
        self.nodes = fe.seats[1].nodes
        x, y, self.z = fe.mesh.points[self.nodes].T
        self.angle = np.arctan2(y, x)
        self.weight = fe.seats[1].surface_mass @ np.ones(len(self.nodes))
        self.radius = float(self.weight @ np.hypot(x, y) / self.weight.sum())
        most = max(2, len(np.unique(np.round(self.angle, 6))) // 4)
        self._harmonics = np.exp(-1j * np.arange(most + 1)[:, None] * self.angle) * self.weight

    def along(self, fields: np.ndarray) -> np.ndarray:
        """Displacements (3, r, k) along radius, circumference and axis of fields (3p, k)."""
        x, y, z = fields.reshape(-1, 3, fields.shape[1])[self.nodes].transpose(1, 0, 2)
        c = np.cos(self.angle)[:, None]
        s = np.sin(self.angle)[:, None]
        return np.stack([c * x + s * y, c * y - s * x, z])

    def largest(self, field: np.ndarray) -> int:
        """The n >= 0 of the largest wave exp(i n θ), or of cos and sin together of a real field (3p,)."""
        power = np.sum(np.abs(self._harmonics @ self.along(field[:, None])[:, :, 0].T) ** 2, axis=1)
        power[1:] *= 2.0
        return int(np.argmax(power))

    def waves(self, fields: np.ndarray, diameters: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Cos nθ and sin nθ parts (2, 3, k) of displacements along radius, circumference and axis: at z = 0, and per m of z.

        Nearest over the area of the rim to v(θ) + z w(θ); of pairs together, as f ~ exp(i n θ).
        """
        along = self.along(fields)
        powers = np.array([np.ones(len(self.z)), self.z])
        moments = np.linalg.inv((powers * self.weight) @ powers.T)
        cosine = np.zeros((2, 3, fields.shape[1]))
        sine = np.zeros_like(cosine)
        for k in (*np.flatnonzero(diameters == 0), *np.flatnonzero(diameters)[::2]):
            n = int(diameters[k])
            f = along[:, :, k] + 1j * along[:, :, k + 1] if n else along[:, :, k]
            A = moments @ ((powers * self.weight) @ (f * np.exp(-1j * n * self.angle)).T)
            cosine[:, :, k] = A.real
            if n:
                # The pair is Re and Im of A exp(i n θ).
                cosine[:, :, k + 1] = A.imag
                sine[:, :, k] = -A.imag
                sine[:, :, k + 1] = A.real
        return cosine, sine


def _across(fields: np.ndarray) -> np.ndarray:
    """k x u (3p, k) of displacements."""
    u = fields.reshape(-1, 3, fields.shape[1])
    return np.asarray((u[:, [1, 0, 2]] * np.array([-1.0, 1.0, 0.0])[:, None]).reshape(fields.shape))


def _each_direction(scalar: sp.csr_array, fields: np.ndarray) -> np.ndarray:
    """Uᵀ (A x I) U for a matrix A (p, p) of nodes and fields U (3p, k)."""
    return np.asarray(fields.T @ (scalar @ fields.reshape(scalar.shape[0], -1)).reshape(fields.shape))


def _about_the_axis(fe: FiniteElementBody, radius: float) -> None:
    """The body turns about z, and its moments of inertia are those of a body of revolution."""
    name = fe.settings.address
    _, centre, inertia = fe.mass_properties
    places = {"the middle of the bore": fe.seats[0].point, "the middle of the rim": fe.seats[1].point}
    for what, place in (*places.items(), ("its centre of mass", centre)):
        off = float(np.hypot(place[0], place[1]))
        if off > _OFF_AXIS * radius:
            raise AnalysisError(
                f"{name}.mesh: {what} is {millimetres(off)} off the z axis. The mesh of a gear body is in the axes of its gear: "
                "z along the shaft, through the origin."
            )
    tilt = 0.5 * (inertia[0, 0] + inertia[1, 1])
    uneven = max(abs(inertia[0, 0] - inertia[1, 1]), 2.0 * np.abs(inertia[[0, 0, 1], [1, 2, 2]]).max()) / tilt
    if uneven > _OFF_INERTIA:
        raise _no_revolution(name, f"its moments of inertia differ by {100.0 * uneven:.2g} % across the axis")


def _no_revolution(name: str, why: str) -> AnalysisError:
    return AnalysisError(
        f"{name}: the body is not near to one of revolution about its axis: {why}. The matrices of a body that turns must not "
        "depend on its angle, which takes three or more equal parts around the axis, and a mesh that is fine enough."
    )
