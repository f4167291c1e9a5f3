"""The stiffness of a mesh of the model: as the file gives it, or from a stiffness model at the mean load.

What a file gives acts along the flank normal of both helices together; a stiffness model answers in the transverse plane
for one helix. Here the two are brought to one `MeshStiffness` of the whole mesh.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from rotorgear.errors import AnalysisError
from rotorgear.model.layout.inertia import bore_of
from rotorgear.model.layout.mesh_geometry import base_helix_angle, gear_geometry, mesh_pair
from rotorgear.model.parts.flank import Flank
from rotorgear.model.parts.tables import Tables

if TYPE_CHECKING:
    from rotorgear.gears.geometry.flank import FlankModification
    from rotorgear.gears.stiffness.mesh_stiffness import MeshStiffness, ToothBody, ToothPair
    from rotorgear.gears.tooth_fe.settings import ToothFe
    from rotorgear.model.parts.mesh import Mesh

POSITIONS = 64


def is_modelled(model: Tables, mesh: str) -> bool:
    """Whether the file names a stiffness model for a mesh."""
    return isinstance(model.meshes[mesh].stiffness, str)


def given_mean(model: Tables, mesh: str) -> float | None:
    """Mean stiffness along the flank normal (N/m, both helices) that the file gives; None where it names a model."""
    given = model.meshes[mesh].stiffness
    if isinstance(given, str):
        return None
    return sum(given) / len(given) if isinstance(given, tuple) else given


def helix_count(model: Tables, mesh: str) -> int:
    """Helices of a mesh: 2 for a herringbone pair."""
    return 2 if model.gears[model.meshes[mesh].pinion].kind == "herringbone" else 1


def tooth_pair(model: Tables, mesh: str) -> ToothPair:
    """One helix of a mesh with its teeth and blanks.

    Raises:
        AnalysisError: gears that are given by their base radius.
    """
    from rotorgear.gears.stiffness.mesh_stiffness import ToothPair

    names = (model.meshes[mesh].pinion, model.meshes[mesh].gear)
    first, second = (gear_geometry(model.gears[name]) for name in names)
    pair = mesh_pair(model, mesh)
    if first is None or second is None or pair is None:
        raise AnalysisError(f"meshes.{mesh}: gears given by their base radius have no teeth to look at.")
    width = min(model.gears[name].width or 0.0 for name in names)
    bodies = [_tooth_body(model, name) for name in names]
    flanks = [_flank(model, name) for name in names]
    return ToothPair(
        first,
        second,
        pair,
        width,
        bodies[0],
        bodies[1],
        flanks[0],
        flanks[1],
        model.meshes[mesh].misalignment,
        _tooth_fe(model.meshes[mesh]),
    )


def mirrored(teeth: ToothPair) -> ToothPair:
    """The pair seen from the other end of the face: that of the other hand, or with the other flanks in contact."""
    flanks = [replace(flank, helix_slope=-flank.helix_slope) for flank in (teeth.first_flank, teeth.second_flank)]
    return replace(teeth, misalignment=-teeth.misalignment, first_flank=flanks[0], second_flank=flanks[1])


def _tooth_fe(mesh: Mesh) -> ToothFe:
    from rotorgear.gears.tooth_fe.settings import ToothFe

    table = mesh.tooth_fe
    return ToothFe(table.preset, table.body, table.rim_thickness, table.pitches, table.exclude_torsion)


def _flank(model: Tables, name: str) -> FlankModification:
    from rotorgear.gears.geometry.flank import FlankModification
    from rotorgear.gears.geometry.outline import tooth_outline

    gear = model.gears[name]
    geometry = gear_geometry(model.gears[name])
    given = gear.flank
    if geometry is None or (given == Flank() and not gear.tip_relief):
        return FlankModification()
    outline = tooth_outline(geometry)

    def roll(diameter: float | None) -> float:
        return math.sqrt(max(0.25 * (diameter or 0.0) ** 2 - geometry.base_radius**2, 0.0))

    return FlankModification(
        tip_relief=gear.tip_relief,
        tip_relief_length=outline.tip_roll_length - roll(gear.tip_relief_diameter),
        root_relief=given.root_relief,
        root_relief_length=roll(given.root_relief_diameter) - outline.form_roll_length,
        crowning=given.crowning,
        end_relief=given.end_relief,
        end_relief_length=given.end_relief_length,
        helix_slope=given.helix_slope,
        pitch_error=tuple((int(tooth), error) for tooth, error in sorted(given.pitch_errors.items())),
    )


def _tooth_body(model: Tables, name: str) -> ToothBody:
    from rotorgear.gears.stiffness.mesh_stiffness import ToothBody

    gear = model.gears[name]
    geometry = gear_geometry(model.gears[name])
    material = model.material_of(gear.shaft, name=gear.material)
    inner = 0.5 * bore_of(model, name)
    rim = gear.body.rim_thickness
    web = gear.body.web_thickness
    if rim is not None and geometry is not None:
        inner = 0.5 * geometry.root_diameter - rim
    share = 1.0 if web is None or not gear.width else web / gear.width
    return ToothBody(material.youngs_modulus, material.nu, inner, share, rim)


def helix_senses(model: Tables, mesh: str, sense: int = 1) -> tuple[int, ...]:
    """For each helix +1 where contact runs ahead at larger z (the pinion's teeth lead there), -1 where it runs behind.

    A right-hand helix is farther round about +z at larger z, so its flanks that push about +z (torque sense +1) lead there.
    A spur gear counts as +1.
    """
    pinion = model.gears[model.meshes[mesh].pinion]
    hand = {"right": 1, "left": -1, None: 1}[pinion.hand] * (sense if pinion.kind != "spur" else 1)
    return (hand, -hand)[: helix_count(model, mesh)]


def stiffness_of_mesh(
    model: Tables,
    mesh: str,
    normal_force: float | None = None,
    positions: int = POSITIONS,
    name: str | None = None,
    sense: int = 1,
) -> MeshStiffness:
    """Stiffness of a whole mesh over one mesh period.

    Args:
        model: a checked model.
        mesh: name of the mesh.
        normal_force: mean force (N) along the flank normal on one helix; None where none flows.
        positions: how many positions of one mesh period, for a stiffness model.
        name: a stiffness model in place of what the file says.
        sense: of the torque on the pinion about +z; it matters where flanks differ along the face.

    Raises:
        AnalysisError: teeth or a load that the stiffness model can't do.
    """
    from rotorgear.gears.stiffness.given import given_stiffness
    from rotorgear.gears.stiffness_models import mesh_stiffness

    given = name or model.meshes[mesh].stiffness
    helices = helix_count(model, mesh)
    angle = base_helix_angle(model.gears[model.meshes[mesh].pinion])
    # Rounding of the torque flow must not make another load: equal meshes are solved once.
    load = None if not normal_force else float(f"{normal_force * math.cos(angle):.12g}")
    if not isinstance(given, str):
        values = given if isinstance(given, tuple) else (given,)
        return given_stiffness(values, angle, helices, None if load is None else helices * load, positions)
    teeth = tooth_pair(model, mesh)
    try:
        found = [
            mesh_stiffness(given, teeth if ahead > 0 else mirrored(teeth), load, positions)
            for ahead in helix_senses(model, mesh, sense)
        ]
    except AnalysisError as error:
        raise AnalysisError(f"meshes.{mesh}: {error}") from None
    return found[0].of_both_helices(model.meshes[mesh].stagger, found[1]) if helices == 2 else found[0]
