"""Teeth on blanks of our own by plain 3D elements of a cyclic sector: python -m validation.benchmarks.cyclic_wheel [NAME ...]

A sector of one pitch, teeth, rim, web and hub, is meshed with quadratic hexahedra (27 nodes) down to the held bore. Nothing is
condensed, and no harmonics round the axis or polynomials along the face stand in for elements, as they do in `gears/tooth_fe`.
With u of pitch k = u e^(i n k a), a = 2 pi / z, the cut on the right follows that on the left, turned by a pitch:

    u_right = e^(i n a) R(a) u_left,      K_n = T_n^H K T_n,      u = (1/z) sum over n of T_n K_n^-1 T_n^H f.

All z harmonics together are the whole wheel, exactly. The mesh is a product of a plane one and of lines along the axis, so that
K is a sum of Kronecker products over the parts of the blank.
Reference: D. L. Thomas, International Journal for Numerical Methods in Engineering 14 (1979) 81.

Printed are mean, middle and both ends of the deflection along the face under an even load, and wind-up, for a unit load per
length and a Young's modulus of 1, and how far the program's default mesh is from them.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from rotorgear.gears.geometry.blank import BlankShape, solid_blank
from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.outline import tooth_outline
from rotorgear.gears.tooth_fe.compliance_model import compliance_key, gear_compliance, wind_up
from rotorgear.gears.tooth_fe.elasticity import assembled, component_dofs, element_matrices, lame
from rotorgear.gears.tooth_fe.mesh import PitchMesh, pitch_mesh, scikit_fem
from rotorgear.gears.tooth_fe.points import MeshSize
from rotorgear.gears.tooth_fe.settings import ToothFe
from validation.benchmarks.wheel_compliance import PATCH, patch_shares

NU = 0.3


@dataclass(frozen=True)
class Wheel:
    """A wheel in modules: teeth, face, and blank; with a spur standard rack of 20 deg."""

    teeth: int
    width: float
    blank: BlankShape

    @property
    def gear(self) -> GearGeometry:
        """Its teeth."""
        return GearGeometry(self.teeth, 1.0, math.radians(20.0), 0.0)


@dataclass(frozen=True)
class Sizes:
    """Elements of the reference: of the pitch, and largest sides in modules along the axis and the radius."""

    pitch: MeshSize = field(default_factory=lambda: MeshSize(7, 2, 4, 2, 3))
    axial: float = 1.1
    radial: float = 2.0


@dataclass(frozen=True)
class Deflection:
    """Deflection along the flank's normal for a unit load per length that is even along the face, times E.

    Attributes:
        mean, middle: over the face and in its middle.
        ends: at the lower and the upper end.
        wind_up: of them by the rotation of the root circle against the bore.
    """

    mean: float
    middle: float
    ends: tuple[float, float]
    wind_up: float


def _blank(teeth: int, width: float, rim: float, web: float, position: float, bore: float, hub: float) -> BlankShape:
    """Rim in modules from the root circle, web and its position as shares of the face, bore and hub as radii."""
    return BlankShape(bore, 0.5 * teeth - 1.25 - rim, web * width, position * width, hub, width)


def _wheel(teeth: int, width: float, rim: float, web: float, position: float, bore: float, hub: float) -> Wheel:
    return Wheel(teeth, width, _blank(teeth, width, rim, web, position, bore, hub))


# Depth of the mesh of the teeth below the root circle, in modules.
_SEAT = 3.0

# Blanks that the design's table does not have: webs off the middle and flush with an end, thick rims, few teeth.
WHEELS = {
    "solid": Wheel(36, 8.0, solid_blank(6.0)),
    "centred": _wheel(36, 8.0, 2.0, 0.25, 0.0, 5.0, 7.0),
    "quarter": _wheel(36, 8.0, 2.0, 0.25, 0.2, 5.0, 7.0),
    "flush": _wheel(36, 8.0, 2.0, 0.25, 0.375, 5.0, 7.0),
    "flush, thin": _wheel(48, 10.0, 1.5, 0.12, -0.44, 6.0, 8.0),
    "thick rim": _wheel(30, 6.0, 5.0, 0.4, 0.3, 3.0, 4.5),
}


def cyclic_deflection(wheel: Wheel, sizes: Sizes | None = None) -> Deflection:
    """The reference."""
    sector = _sector(wheel, sizes or Sizes())
    width = wheel.width
    mesh = sector.pitch
    z = sector.z
    p = len(sector.points)
    face = np.flatnonzero(np.abs(z) < 0.5 * width * (1.0 + 1e-9))
    along = _line_weights(z[face]) / width
    across = _across(mesh.roll, wheel.gear)
    force = np.zeros((len(z), p, 3))
    force[np.ix_(face, mesh.flank, [0, 1])] = -width * along[:, None, None] * across[:, None] * mesh.normal
    K = _stiffness(sector)
    a = 2.0 * math.pi / wheel.teeth

    moved = np.zeros(force.size)
    rotation = 0.0
    for n in range(wheel.teeth // 2 + 1):
        T = _joined(sector, complex(np.exp(1j * n * a)), a)
        factor = splu(sp.csc_matrix(T.conj().T @ K @ T), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
        u = (T @ factor.solve(T.conj().T @ force.ravel())).real / wheel.teeth
        moved += u if n == 0 or 2 * n == wheel.teeth else 2.0 * u
        if n == 0:
            # Clockwise about the axis, on the circle where the mesh of the teeth ends.
            x, y = sector.points[mesh.inner].T
            on_circle = u.reshape(len(z), p, 3)[np.ix_(face, mesh.inner)]
            turned = (on_circle[..., 0] * y - on_circle[..., 1] * x) / (x**2 + y**2)
            rotation = float(along @ turned @ _line_weights(np.arctan2(x, y)) / a)
    deflection = -np.einsum("zki,ki,k->z", moved.reshape(len(z), p, 3)[:, mesh.flank, :2], mesh.normal, across)[face]

    # From that circle to the root circle: a ring under shear, which the torque of the unit line load turns.
    seat = float(np.hypot(*sector.points[mesh.inner[0]]))
    arm = wheel.gear.base_radius
    shear = 0.5 / (1.0 + NU)
    ring = arm**2 * (1.0 / seat**2 - 1.0 / (0.5 * wheel.gear.root_diameter) ** 2) / (4.0 * math.pi * shear)
    return Deflection(
        mean=float(along @ deflection),
        middle=float(np.interp(0.0, z[face], deflection)),
        ends=(float(deflection[0]), float(deflection[-1])),
        wind_up=-arm * rotation + ring,
    )


def program_deflection(wheel: Wheel, size: MeshSize | None = None) -> Deflection:
    """The same by the program, in space."""
    fe = ToothFe(body="wheel", size=size)
    key = compliance_key(wheel.gear, fe, NU, wheel.width, wheel.blank.bore_radius, space=True, blank=wheel.blank)
    found = gear_compliance(key)
    planes = len(found.height)
    along = _line_weights(found.height) / wheel.width
    across = _across(found.roll, wheel.gear)
    G = found.response(0).reshape(planes, len(across), planes, len(across))
    deflection = wheel.width * np.einsum("r,hrks,s,k->h", across, G, across, along)
    return Deflection(
        mean=float(along @ deflection),
        middle=float(deflection[planes // 2]),
        ends=(float(deflection[0]), float(deflection[-1])),
        wind_up=wheel.width * wind_up(key),
    )


@dataclass(frozen=True)
class _Sector:
    """The mesh of one pitch of teeth and blank.

    Attributes:
        pitch: plane mesh of the teeth, whose nodes come first.
        points: (p, 2) of all plane nodes.
        parts: scikit-fem mesh in the plane, numbers (9, e) of its nodes, and span along the axis, of each part.
        z: (h,) places of the planes of nodes along the axis.
        left: (c,) nodes of one cut.
        right: (c,) those of the other, in the same order.
        held: nodes on the bore.
    """

    pitch: PitchMesh
    points: np.ndarray
    parts: tuple[tuple[Any, np.ndarray, tuple[float, float]], ...]
    z: np.ndarray
    left: np.ndarray
    right: np.ndarray
    held: np.ndarray

    def layers(self, span: tuple[float, float]) -> np.ndarray:
        """First planes of the layers of elements within a span along the axis."""
        middle = self.z[1::2]
        return 2 * np.flatnonzero((middle > span[0]) & (middle < span[1]))


def _sector(wheel: Wheel, sizes: Sizes) -> _Sector:
    """The pitch's own mesh, and below it rings of quadrangles with the same columns."""
    skfem = scikit_fem()
    blank = wheel.blank
    half = 0.5 * wheel.width
    hub = 0.5 * blank.hub_width
    web = (blank.web_position - 0.5 * blank.web_thickness, blank.web_position + 0.5 * blank.web_thickness)
    seat = max(blank.rim_radius, 0.5 * wheel.gear.root_diameter - _SEAT)
    mesh = pitch_mesh(tooth_outline(wheel.gear), sizes.pitch, seat)
    points = mesh.points
    parts: list[tuple[Any, np.ndarray, tuple[float, float]]] = [(mesh.mesh, mesh.cells, (-half, half))]
    left = [mesh.inner[:1], mesh.left]
    right = [mesh.inner[-1:], mesh.right]
    circle = mesh.inner
    angle = np.arctan2(*points[circle].T)
    outer = seat
    for inner, span in ((blank.rim_radius, (-half, half)), (blank.hub_radius, web), (blank.bore_radius, (-hub, hub))):
        if outer - inner < 1e-9 * seat:
            continue
        rows = max(2, math.ceil((outer - inner) / sizes.radial))
        r = np.linspace(outer, inner, 2 * rows + 1)[1:]
        own = len(points) + np.arange(len(r) * len(angle)).reshape(len(r), len(angle))
        points = np.vstack([points, (r[:, None, None] * np.stack([np.sin(angle), np.cos(angle)], -1)).reshape(-1, 2)])
        rising = np.vstack([circle, own])[::-1]  # from the bore outwards, so that cells keep their sense
        flat = skfem.MeshQuad.init_tensor(np.arange(len(angle) // 2 + 1.0), np.arange(rows + 1.0))
        ring = skfem.MeshQuad2.from_mesh(flat)
        column, row = np.rint(2.0 * ring.doflocs).astype(int)
        number = rising[row, column]
        ring = skfem.MeshQuad2(np.ascontiguousarray(points[number].T), ring.t)
        parts.append((ring, number[ring.dofs.element_dofs], span))
        left.append(own[:, 0])
        right.append(own[:, -1])
        circle = own[-1]
        outer = inner
    lines = _lines([span for _, _, span in parts], sizes.axial)
    z = np.sort(np.concatenate([lines, 0.5 * (lines[1:] + lines[:-1])]))
    return _Sector(mesh, points, tuple(parts), z, np.concatenate(left), np.concatenate(right), circle)


def _lines(spans: Sequence[tuple[float, float]], largest: float) -> np.ndarray:
    """Lines through the ends of all spans, no farther apart than `largest`, and two layers at least in each interval."""
    ends = np.unique(np.round(np.ravel(spans), 9))
    found = [ends[:1]]
    for low, high in pairwise(ends):
        found.append(np.linspace(low, high, max(2, math.ceil((high - low) / largest)) + 1)[1:])
    return np.concatenate(found)


def _stiffness(sector: _Sector) -> sp.csc_array:
    """K of the sector for a Young's modulus of 1; unknowns plane by plane along the axis, node by node, (x, y, z)."""
    skfem = scikit_fem()
    lam, mu = lame(NU)
    p = len(sector.points)
    x, y, axial = (sp.csc_array((np.ones(p), (3 * np.arange(p) + i, np.arange(p))), (3 * p, p)) for i in range(3))
    in_plane = sp.csc_array(sp.hstack([x, y]))[:, np.arange(2 * p).reshape(2, p).T.ravel()]
    whole = sp.csc_array((3 * p * len(sector.z), 3 * p * len(sector.z)))
    for mesh, cells, span in sector.parts:
        basis = skfem.Basis(mesh, skfem.ElementQuad2(), intorder=4)
        nodes = component_dofs(cells, 1)
        N = np.stack([np.broadcast_to(np.asarray(shape[0].value), basis.dx.shape) for shape in basis.basis])
        dN = np.stack([np.asarray(shape[0].grad) for shape in basis.basis])
        mass = assembled(np.einsum("aeq,beq,eq->eab", N, N, basis.dx, optimize=True), nodes, p)
        slope = assembled(np.einsum("aieq,bieq,eq->eab", dN, dN, basis.dx, optimize=True), nodes, p)
        mixed = [
            assembled(np.einsum("aeq,beq,eq->eab", dN[:, i], N, basis.dx, optimize=True), nodes, p) for i in (0, 1)
        ]
        plane = assembled(element_matrices(basis, NU), component_dofs(cells, 2), 2 * p)
        M, R, T = _along_axis(sector.z, sector.layers(span))
        # With H the plane's own stiffness: M H + T mu Q in the plane, T (lambda + 2 mu) Q + M mu grad.grad along the axis, and
        # lambda R C_i + mu R^T C_i^T between both.
        even = in_plane @ plane @ in_plane.T + mu * axial @ slope @ axial.T
        twice = mu * (x @ mass @ x.T + y @ mass @ y.T) + (lam + 2.0 * mu) * axial @ mass @ axial.T
        across = sum(
            lam * sp.kron(R, to @ C @ axial.T) + mu * sp.kron(R.T, to @ C.T @ axial.T)
            for to, C in zip((x, y), mixed, strict=True)
        )
        whole = whole + sp.kron(M, even) + sp.kron(T, twice) + across + across.T
    return sp.csc_array(whole)


def _along_axis(z: np.ndarray, layers: np.ndarray) -> tuple[sp.csc_array, sp.csc_array, sp.csc_array]:
    """Integrals of N N, N N' and N' N' over some layers of quadratic shape functions along the axis."""
    t, weight = np.polynomial.legendre.leggauss(3)
    N = np.stack([0.5 * t * (t - 1.0), 1.0 - t * t, 0.5 * t * (t + 1.0)])
    slope = np.stack([t - 0.5, -2.0 * t, t + 0.5])
    half = 0.5 * (z[layers + 2] - z[layers])
    nodes = layers[:, None] + np.arange(3)

    def integral(first: np.ndarray, second: np.ndarray, factor: np.ndarray) -> sp.csc_array:
        return assembled(factor[:, None, None] * np.einsum("aq,bq,q->ab", first, second, weight), nodes, len(z))

    return integral(N, N, half), integral(N, slope, np.ones(len(layers))), integral(slope, slope, 1.0 / half)


def _joined(sector: _Sector, phase: complex, angle: float) -> sp.csc_array:
    """T_n: all displacements from those that are free, the right cut following the left one by a phase and a pitch."""
    p = len(sector.points)
    there = np.zeros((len(sector.z), p), bool)
    for _, cells, span in sector.parts:
        for layer in sector.layers(span):
            there[layer : layer + 3, np.unique(cells)] = True
    there[:, sector.held] = False
    c = math.cos(angle)
    s = math.sin(angle)
    blocks = sp.lil_array((3 * p, 3 * p), dtype=complex)
    blocks.setdiag(1.0)
    turn = phase * np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    for one, other in zip(sector.left, sector.right, strict=True):
        blocks[3 * other : 3 * other + 3, 3 * other : 3 * other + 3] = 0.0
        blocks[3 * other : 3 * other + 3, 3 * one : 3 * one + 3] = turn
    free = there.copy()
    free[:, sector.right] = False
    T = sp.csc_array(sp.kron(sp.eye_array(len(sector.z)), sp.csc_array(blocks)))
    return sp.csc_array(T[:, np.flatnonzero(np.repeat(free.ravel(), 3))])


def _line_weights(z: np.ndarray) -> np.ndarray:
    """Integrals of quadratic shape functions along a rising line of nodes (2 e + 1,)."""
    weight = np.zeros(len(z))
    for i in range(0, len(z) - 1, 2):
        weight[i : i + 3] += (z[i + 2] - z[i]) * np.array([1.0, 4.0, 1.0]) / 6.0
    return weight


def _across(roll: np.ndarray, gear: GearGeometry) -> np.ndarray:
    """Nodal shares of a unit load at the pitch point, semi-elliptic over a patch along the flank."""
    return patch_shares(roll, gear, PATCH, elliptic=True)


HEADS = ("mean  middle   lower   upper", "  mean   middle    lower    upper")


def main(names: Sequence[str]) -> None:
    """Print the table, and the tilts."""
    print(f"{'':14}3D sector                                program against it")
    print(f"{'wheel':14}{HEADS[0]}  wind-up   {HEADS[1]}  wind-up  without  CPU s")
    for name, wheel in WHEELS.items():
        if names and name not in names:
            continue
        start = time.process_time()
        truth = cyclic_deflection(wheel)
        seconds = time.process_time() - start
        ours = program_deflection(wheel)
        print(
            f"{name:12}{truth.mean:7.3f} {truth.middle:7.3f} {truth.ends[0]:7.3f} {truth.ends[1]:7.3f} {truth.wind_up:8.3f}"
            f"  {_percent(ours.mean, truth.mean)} {_percent(ours.middle, truth.middle)}"
            f" {_percent(ours.ends[0], truth.ends[0])} {_percent(ours.ends[1], truth.ends[1])}"
            f" {_percent(ours.wind_up, truth.wind_up)}"
            f" {_percent(ours.mean - ours.wind_up, truth.mean - truth.wind_up)} {seconds:6.0f}",
            flush=True,
        )


def _percent(value: float, known: float) -> str:
    return f"{100.0 * (value / known - 1.0):+6.2f}%"


if __name__ == "__main__":
    main(sys.argv[1:])
