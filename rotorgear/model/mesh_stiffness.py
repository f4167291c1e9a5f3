"""The stiffness of a mesh of the model: as the file gives it, or from a stiffness model at the mean load.

What a file gives acts along the flank normal of both helices together; a stiffness model answers in the transverse plane
for one helix. Here the two are brought to one `MeshStiffness` of the whole mesh.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from rotorgear.errors import AnalysisError
from rotorgear.model.inertia import bore_of
from rotorgear.model.mesh_geometry import base_helix_angle, gear_geometry, mesh_pair
from rotorgear.model.tables import Tables

if TYPE_CHECKING:
    from rotorgear.gears.mesh_stiffness import MeshStiffness, ToothBody, ToothPair

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
    from rotorgear.gears.mesh_stiffness import ToothPair

    names = (model.meshes[mesh].pinion, model.meshes[mesh].gear)
    first, second = (gear_geometry(model.gears[name]) for name in names)
    pair = mesh_pair(model, mesh)
    if first is None or second is None or pair is None:
        raise AnalysisError(f"meshes.{mesh}: gears given by their base radius have no teeth to look at.")
    width = min(model.gears[name].width or 0.0 for name in names)
    return ToothPair(first, second, pair, width, *(_tooth_body(model, name) for name in names))


def _tooth_body(model: Tables, name: str) -> ToothBody:
    from rotorgear.gears.mesh_stiffness import ToothBody

    gear, geometry = model.gears[name], gear_geometry(model.gears[name])
    material = model.material_of(gear.shaft, name=gear.material)
    inner, rim, web = 0.5 * bore_of(model, name), gear.body.rim_thickness, gear.body.web_thickness
    if rim is not None and geometry is not None:
        inner = 0.5 * geometry.root_diameter - rim
    share = 1.0 if web is None or not gear.width else web / gear.width
    return ToothBody(material.youngs_modulus, material.nu, inner, share, rim)


def stiffness_of_mesh(
    model: Tables, mesh: str, normal_force: float | None = None, positions: int = POSITIONS, name: str | None = None
) -> MeshStiffness:
    """Stiffness of a whole mesh over one mesh period.

    Args:
        model: a checked model.
        mesh: name of the mesh.
        normal_force: mean force (N) along the flank normal on one helix; None where none flows.
        positions: how many positions of one mesh period, for a stiffness model.
        name: a stiffness model in place of what the file says.

    Raises:
        AnalysisError: teeth or a load that the stiffness model can't do.
    """
    from rotorgear.gears.mesh_stiffness import mesh_stiffness
    from rotorgear.gears.stiffness_given import given_stiffness

    given = name or model.meshes[mesh].stiffness
    helices, angle = helix_count(model, mesh), base_helix_angle(model.gears[model.meshes[mesh].pinion])
    load = None if not normal_force else normal_force * math.cos(angle)
    if not isinstance(given, str):
        values = given if isinstance(given, tuple) else (given,)
        return given_stiffness(values, angle, helices, None if load is None else helices * load, positions)
    try:
        one = mesh_stiffness(given, tooth_pair(model, mesh), load, positions)
    except AnalysisError as error:
        raise AnalysisError(f"meshes.{mesh}: {error}") from None
    return one.of_both_helices() if helices == 2 else one
