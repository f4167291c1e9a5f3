"""Compliance of a gear's teeth from its geometry: outline, mesh, condensed pitch, chain of pitches; kept on disk by a hash.

Everything is in normal modules and for a Young's modulus of 1, so that gears of any size and steel share one entry.

What a gear in space takes in memory and seconds is told before it is computed. Layers are stacked by dense Cholesky
factorisations (`sector.py`): with i unknowns of a plane that are condensed and k that are kept, joining p and q layers takes a
matrix of size N = 3 i + (2 (p + q) + 1) k, or less where an outer plane of theirs is one of the whole stack and is condensed
before. Of that, i unknowns are eliminated by

    i^3/3 + i^2 (N - i) + 2 i (N - i)^2 operations.

The largest of these matrices decides the memory, their sum the time. The gauge is a factorisation of the same kind, a few
milliseconds long, on the machine at hand. `python -m validation.benchmarks.mesh_cost` prints forecast and measurement.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import astuple, dataclass, replace
from typing import Any

import numpy as np
import scipy.linalg as la

from rotorgear.errors import AnalysisError
from rotorgear.files.cache import read_entry, write_entry
from rotorgear.fingerprint import fingerprint
from rotorgear.gears.geometry.blank import BlankShape, solid_blank
from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.outline import ToothOutline, tooth_outline
from rotorgear.gears.tooth_fe.blank_section import AXIAL_SIDE, BlankSection, torsional_flexibility
from rotorgear.gears.tooth_fe.gear_compliance import GearCompliance, chained
from rotorgear.gears.tooth_fe.mesh import LEAST_INNER, PitchMesh, pitch_mesh
from rotorgear.gears.tooth_fe.points import MeshSize
from rotorgear.gears.tooth_fe.sector import Sector, layered_sector, plane_sector
from rotorgear.gears.tooth_fe.settings import ToothFe
from rotorgear.gears.tooth_fe.wheel_compliance import wheel_flexibility
from rotorgear.gears.tooth_fe.wheel_sector import SEATS, WheelSector, even_wheel, layered_wheel
from rotorgear.memory import free_memory
from rotorgear.progress import Progress, part_of, silent

# Where compliances are computed: what other sources kept is passed over.
MAKERS = ("gears/tooth_fe",)
# A process keeps this many compliances in memory; one in 3D takes several MB.
_MOST_KEPT = 16
_KEPT: dict[str, GearCompliance] = {}
# The largest matrix stands in memory as often, copies included; and what the program takes by itself (bytes).
_COPIES = 3.3
_PROGRAM = 150e6
# Size of the gauge. Whole compliances run at this share of its speed: they also assemble, copy and solve for the flanks.
_GAUGE = 700
_SHARE = 0.8


def plane_unknowns(key: ComplianceKey, mesh: PitchMesh) -> tuple[int, int, int, int]:
    """Unknowns of one plane of a gear in space: that are condensed, that are kept, and of these on a cut and on the flank."""
    flank = len(mesh.flank)
    # A wheel keeps its seat on the blank, too: one node of it in each cut, the others between.
    seat = 3 if key.blank else 0
    cut = 3 * len(mesh.left) + seat
    free = 3 * (len(mesh.points) - len(mesh.inner))
    return free - 6 * len(mesh.left) - flank, 2 * cut + flank + seat * (2 * SEATS - 1), cut, flank


def forecast(key: ComplianceKey, mesh: PitchMesh) -> tuple[float, float]:
    """Memory (bytes) of the process and seconds that this machine needs for a gear in layers."""
    inside, kept, cut, flank = plane_unknowns(key, mesh)
    planes = 2 * key.size.face + 1
    sizes = _joints(inside, kept, key.size.face)
    operations = sum(_eliminated(size, inside) for size in sizes)
    operations += (planes * flank) ** 3
    operations += 4.0 * (key.arc or abs(key.geometry.teeth)) * (planes * cut) ** 3
    return _PROGRAM + _COPIES * 8.0 * max(sizes) ** 2, operations / (_SHARE * _speed())


def _joints(inside: int, kept: int, layers: int) -> list[int]:
    """Sizes of the matrices, each of which loses the inside of one plane, in the order of `sector.stacked_layers`."""

    def size(planes_inside: int, layers: int) -> int:
        return planes_inside * inside + (2 * layers + 1) * kept

    sizes = [size(3, 1)]
    block = 1
    stack = 0
    rest = layers
    while rest > 2 or (rest == 2 and stack):
        if rest % 2:
            sizes.append(size(2, stack + block))
            stack += block
        rest //= 2
        block *= 2
        sizes.append(size(3, block))
    if layers == 1:
        return [*sizes, size(2, 1), size(1, 1)]
    if not stack:
        sizes.append(size(2, block))
    return [*sizes, size(2, block), size(1, layers)]


def _eliminated(size: int, inside: int) -> float:
    """Operations that eliminate the `inside` unknowns of a dense matrix."""
    rest = float(size - inside)
    return inside**3 / 3.0 + inside**2 * rest + 2.0 * inside * rest**2


def _speed() -> float:
    """Operations a second of this machine, with as many threads as it takes."""
    matrix = np.eye(2 * _GAUGE) + 1e-3
    seconds = []
    for _ in range(3):  # others may use the machine for a moment
        start = time.perf_counter()
        L = la.cholesky(matrix[:_GAUGE, :_GAUGE], lower=True, check_finite=False)
        W = la.solve_triangular(L, matrix[:_GAUGE, _GAUGE:], lower=True, check_finite=False)
        matrix[_GAUGE:, _GAUGE:] -= 1e-9 * (W.T @ W)
        seconds.append(time.perf_counter() - start)
    return _eliminated(2 * _GAUGE, _GAUGE) / max(min(seconds), 1e-6)


# Teeth to either side of a loaded one whose response is kept; a pair further away is not felt.
REACH = 4
# Largest depth below the root circle, in normal modules, of the part of a rim that is meshed with the teeth.
SEAT_DEPTH = 3.0
# Elements of the blank along a face that is loaded evenly.
_POLYNOMIAL_CELLS = 12
# Radius over that of the root of the core that is held where shaft and gear are one: too small to matter.
_LEAST_BORE = 0.1


@dataclass(frozen=True)
class ComplianceKey:
    """All that the compliance of a gear depends on; lengths in normal modules.

    Attributes:
        geometry: of the gear, with a normal module of 1.
        size: of the mesh.
        inner_radius: of the held circle, around a ring that of its outer surface.
        poisson_ratio: of the material.
        width: of the face; 0 for a plane model.
        arc: pitches of a rim; 0 for a full ring or a wheel.
        blank: of a wheel; None where the inner circle is held.
        face: width of the rim of a wheel, also of a plane model; 0 where the inner circle is held.
        coarseness: of the blank's mesh over the usual one.
    """

    geometry: GearGeometry
    size: MeshSize
    inner_radius: float
    poisson_ratio: float
    width: float
    arc: int
    blank: BlankShape | None = None
    face: float = 0.0
    coarseness: float = 1.0

    @property
    def held_radius(self) -> float:
        """Radius of the circle that is held: the bore of a wheel, else the inner circle of the pitches."""
        return self.blank.bore_radius if self.blank else self.inner_radius


def compliance_key(
    geometry: GearGeometry,
    fe: ToothFe,
    poisson_ratio: float,
    width: float,
    bore_radius: float,
    *,
    space: bool,
    blank: BlankShape | None = None,
) -> ComplianceKey:
    """What to compute for a gear.

    Args:
        geometry: in m.
        fe: settings of the model.
        poisson_ratio: of the material.
        width: of the face (m).
        bore_radius: where a ring is held (m), one with its teeth inside at its outer surface; 0 for a solid shaft and gear.
        space: whether the model is three-dimensional.
        blank: of the gear (m), seen along its own face; None: a full disc of that bore.
    """
    m = geometry.normal_module
    tip = geometry.effective_tip_diameter / m
    unit = replace(
        geometry, normal_module=1.0, tip_diameter=_rounded(tip), profile_shift=_rounded(geometry.profile_shift)
    )
    root = 0.5 * abs(unit.root_diameter)
    body = fe.body_of(blank, bore_radius if geometry.is_internal else None)
    wheel: BlankShape | None = None
    if body == "wheel":
        shape = blank or solid_blank(bore_radius)
        wheel = BlankShape(*(_rounded(size / m) for size in astuple(shape))).with_core(
            root
        )  # a core that is held where shaft and gear are one
        inner = _seat_radius(wheel, root)
    elif geometry.is_internal:
        inner = bore_radius / m if body == "ring" else root + fe.rim_thickness
    elif body == "ring":
        inner = bore_radius / m if bore_radius > 0.0 else _LEAST_BORE * root
    else:
        inner = max(root - fe.rim_thickness, LEAST_INNER * root)
    return ComplianceKey(
        unit,
        fe.even_size if wheel and not space else fe.mesh_size(width / m, space=space),
        _rounded(inner),
        poisson_ratio,
        _rounded(width / m) if space else 0.0,
        fe.arc if body == "rim" else 0,
        wheel,
        _rounded(width / m) if wheel else 0.0,
        fe.blank_coarseness if wheel else 1.0,
    )


def _seat_radius(blank: BlankShape, root: float) -> float:
    """Where the pitches of a wheel end: inside of a rim that is not too thick to be meshed with the teeth, else within it."""
    depth = min(SEAT_DEPTH, (1.0 - LEAST_INNER) * root)
    if not blank.is_solid and root - blank.rim_radius <= depth * (1.0 + 1e-9):
        return blank.rim_radius
    # A rim that is little thicker, or a solid blank with a thin wall, is cut in its own middle.
    return max(root - depth, 0.5 * (root + max(blank.rim_radius, blank.bore_radius)))


def _rounded(value: float) -> float:
    """To twelve digits, so that rounding in the units does not make another gear."""
    return float(f"{value:.12g}")


def pitch_of(key: ComplianceKey) -> tuple[ToothOutline, PitchMesh]:
    """Outline and mesh of one pitch."""
    outline = tooth_outline(key.geometry)
    return outline, pitch_mesh(outline, key.size, key.inner_radius)


def gear_compliance(key: ComplianceKey, progress: Progress = silent, *, fresh: bool = False) -> GearCompliance:
    """Compliance of a gear, from the disk where it is known; `fresh`: computed in any case, to measure how long it takes.

    Raises:
        AnalysisError: teeth that can't be made or meshed, or that take more memory than there is.
        MissingExtraError: scikit-fem is not installed and the gear is not known yet.
    """
    return _computed(key, progress) if fresh else cached(key, lambda: _computed(key, progress))


def cached(key: Any, compute: Callable[[], GearCompliance]) -> GearCompliance:
    """The compliance of a frozen key from memory, from disk, or computed and kept."""
    text = f"{fingerprint(*MAKERS)} {key!r}"
    if text not in _KEPT:
        stored = read_entry("teeth", "gear", text)
        compliance = compute() if stored is None else GearCompliance(**stored)
        if stored is None:
            write_entry("teeth", "gear", text, vars(compliance))
        while len(_KEPT) >= _MOST_KEPT:
            _KEPT.pop(next(iter(_KEPT)))  # the oldest: dicts keep their order
        _KEPT[text] = compliance
    return _KEPT[text]


def forget() -> None:
    """Drop what is kept in memory; the disk stays."""
    _KEPT.clear()


def _computed(key: ComplianceKey, progress: Progress) -> GearCompliance:
    outline, mesh = pitch_of(key)
    if key.width:
        memory, seconds = forecast(key, mesh)
        free = free_memory()
        if free is not None and memory > free:
            raise AnalysisError(
                f"These teeth in space would take {1e-9 * memory:.2g} GB of memory, and {1e-9 * free:.2g} GB are free: "
                'take tooth_fe = { preset = "preview" } (--preset preview), a narrower face, or a machine with more memory.'
            )
        progress(0.0, f"teeth in space, about {seconds:.0f} s and {1e-9 * memory:.1f} GB")
    height = np.linspace(-0.5 * key.width, 0.5 * key.width, 2 * key.size.face + 1) if key.width else np.zeros(1)
    teeth = key.arc or abs(key.geometry.teeth)
    reach = min(REACH, (teeth - 1) // 2)
    if key.blank is not None:
        wheel = sector_of(key, mesh, part_of(progress, 0.0, 0.6))
        assert isinstance(wheel, WheelSector)
        # Polynomials along the face are smooth: on a wide one a dozen elements follow them.
        side = AXIAL_SIDE if key.width else max(AXIAL_SIDE, key.face / _POLYNOMIAL_CELLS)
        blank = BlankSection(key.blank, key.face, key.inner_radius, key.poisson_ratio, side, key.coarseness)
        G, asymmetry = wheel_flexibility(wheel, blank, teeth, reach, part_of(progress, 0.6, 1.0))
        if not key.width:
            # Means along the face for forces of the whole face: a plane model has those of a unit width.
            G = G * key.face
        unknowns = wheel.unknowns * teeth + blank.unknowns
    else:
        sector = sector_of(key, mesh, progress)
        G, asymmetry = chained(sector, teeth, reach, ring=key.arc == 0)
        unknowns = sector.unknowns * teeth
    return GearCompliance(
        flexibility=G,
        roll=mesh.roll,
        height=height,
        flank_start=outline.form_roll_length,
        flank_end=outline.tip_roll_length,
        base_radius=outline.geometry.base_radius,
        unknowns=unknowns,
        asymmetry=asymmetry,
    )


def sector_of(key: ComplianceKey, mesh: PitchMesh, progress: Progress = silent) -> Sector:
    """Superelement of a pitch: in layers or in the plane; of a wheel by polynomials along a face that is loaded evenly."""
    if key.width:
        layered = layered_wheel if key.blank else layered_sector
        return layered(mesh, key.poisson_ratio, key.width, key.size.face, progress)
    if key.blank is None:
        return plane_sector(mesh, key.poisson_ratio)
    return even_wheel(mesh, key.poisson_ratio, key.face, key.size.face, centred=key.blank.web_position == 0.0)


def wind_up(key: ComplianceKey) -> float:
    """Deflection along the flank normal of all teeth by the rotation that a unit normal force gives rim against bore.

    In the units of the compliance: for a Young's modulus and a module of 1, of a plane model for a unit width. A ring or a full
    disc of width b under shear, r phi' = T / (2 pi r^2 b G), turns by T (1/r_i^2 - 1/r_f^2) / (4 pi b G).
    """
    g = key.geometry
    arm = g.base_radius * math.cos(g.base_helix_angle)
    root = 0.5 * abs(g.root_diameter)
    if key.blank is None:
        shear = 0.5 / (1.0 + key.poisson_ratio)
        twist = g.sign * (1.0 / key.inner_radius**2 - 1.0 / root**2) / (4.0 * math.pi * shear)
        return arm**2 * twist / (key.width or 1.0)
    # A plane model has the force of a unit width.
    return (
        arm**2 * torsional_flexibility(key.blank, key.face, root, key.poisson_ratio) * (1.0 if key.width else key.face)
    )
