"""Compliance of a gear's teeth from its geometry: outline, mesh, condensed pitch, chain of pitches; kept on disk by a hash.

Everything is in normal modules and for a Young's modulus of 1, so that gears of any size and steel share one entry.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.outline import ToothOutline, tooth_outline
from rotorgear.gears.tooth_fe.compliance_cache import cached
from rotorgear.gears.tooth_fe.gear_compliance import GearCompliance, chained
from rotorgear.gears.tooth_fe.mesh import LEAST_INNER, PitchMesh, pitch_mesh
from rotorgear.gears.tooth_fe.points import MeshSize
from rotorgear.gears.tooth_fe.sector import layered_sector, plane_sector
from rotorgear.gears.tooth_fe.settings import ToothFe
from rotorgear.progress import Progress, silent

# Teeth to either side of a loaded one whose response is kept; a pair further away is not felt.
REACH = 4


@dataclass(frozen=True)
class ComplianceKey:
    """All that the compliance of a gear depends on; lengths in normal modules.

    Attributes:
        geometry: of the gear, with a normal module of 1.
        size: of the mesh.
        inner_radius: of the held circle.
        poisson_ratio: of the material.
        width: of the face; 0 for a plane model.
        arc: pitches of a rim; 0 for a full ring.
    """

    geometry: GearGeometry
    size: MeshSize
    inner_radius: float
    poisson_ratio: float
    width: float
    arc: int


def compliance_key(
    geometry: GearGeometry, fe: ToothFe, poisson_ratio: float, width: float, bore_radius: float, *, space: bool
) -> ComplianceKey:
    """What to compute for a gear.

    Args:
        geometry: in m.
        fe: settings of the model.
        poisson_ratio: of the material.
        width: of the face (m).
        bore_radius: where a ring is held (m); 0 for a solid shaft and gear.
        space: whether the model is three-dimensional.
    """
    m = geometry.normal_module
    tip = geometry.effective_tip_diameter / m
    unit = replace(
        geometry, normal_module=1.0, tip_diameter=_rounded(tip), profile_shift=_rounded(geometry.profile_shift)
    )
    root = 0.5 * unit.root_diameter
    inner = bore_radius / m if fe.body == "ring" else max(root - fe.rim_thickness, LEAST_INNER * root)
    if fe.body == "ring" and inner <= 0.0:
        inner = 0.1 * root  # a solid shaft and gear: the held core is too small to matter
    return ComplianceKey(
        unit,
        fe.mesh_size(width / m, space=space),
        _rounded(inner),
        poisson_ratio,
        _rounded(width / m) if space else 0.0,
        0 if fe.body == "ring" else fe.arc,
    )


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
        AnalysisError: teeth that can't be made or meshed.
        MissingExtraError: scikit-fem is not installed and the gear is not known yet.
    """
    return _computed(key, progress) if fresh else cached(key, lambda: _computed(key, progress))


def _computed(key: ComplianceKey, progress: Progress) -> GearCompliance:
    outline, mesh = pitch_of(key)
    if key.width:
        sector = layered_sector(mesh, key.poisson_ratio, key.width, key.size.face, progress)
        height = np.linspace(-0.5 * key.width, 0.5 * key.width, 2 * key.size.face + 1)
    else:
        sector = plane_sector(mesh, key.poisson_ratio)
        height = np.zeros(1)
    teeth = key.geometry.teeth if key.arc == 0 else key.arc
    G, asymmetry = chained(sector, teeth, min(REACH, (teeth - 1) // 2), ring=key.arc == 0)
    return GearCompliance(
        flexibility=G,
        roll=mesh.roll,
        height=height,
        flank_start=outline.form_roll_length,
        flank_end=outline.tip_roll_length,
        base_radius=outline.geometry.base_radius,
        unknowns=sector.unknowns * teeth,
        asymmetry=asymmetry,
    )
