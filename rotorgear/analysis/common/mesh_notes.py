"""What a linear analysis says of the stiffness of its meshes: which mean it takes, at which load, and what that leaves out."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from rotorgear.model.layout.assembly import unlike_gears
from rotorgear.system.system import System

if TYPE_CHECKING:
    from rotorgear.gears.maps.contact_map import ContactMap
    from rotorgear.gears.maps.face_map import FaceMap
    from rotorgear.gears.stiffness.mesh_stiffness import MeshStiffness


def mesh_stiffness_left_out(system: System) -> Iterator[str]:
    """Yield a sentence for each mesh whose stiffness is a model's or a list, because its mean over the period is taken."""
    for name, mesh in system.model.meshes.items():
        if isinstance(mesh.stiffness, tuple):
            mean = sum(mesh.stiffness) / len(mesh.stiffness)
            share = (max(mesh.stiffness) - min(mesh.stiffness)) / mean
            ripple = f"ripple of the given stiffness, {100.0 * share:.3g} % peak to peak"
            yield f"meshes.{name}: {ripple}; its mean {mean:.4g} N/m is taken"
        elif curve := system.state.whole_curve(name):
            taken = sum(force.contact.stiffness for force in system.state.of_mesh(name))
            joint = curve.model == "tooth_fe" and all(force.start is not None for force in system.state.of_mesh(name))
            yield f"meshes.{name}: {_over_cycle(curve.about_load, taken) if joint else _of_model(curve.about_load, taken)}"
        if mesh.stiffness == "tooth_fe" and not mesh.tilt:
            yield f"meshes.{name}: the tilt of its gears along the face, which its teeth do not feel without tilt = true"


def unlike_teeth_left_out(system: System) -> Iterator[str]:
    """Yield a sentence for each gear whose teeth differ where it is not known which of them are in its meshes at one time."""
    unknown = system.state.tooth_numbers.unknown
    for name, meshes in unlike_gears(system.layout.meshes).items():
        if name in unknown:
            where = " and ".join(f"meshes.{mesh.name}" for mesh in meshes)
            yield (
                f"which teeth of gears.{name} are in {where} at one time: its errors of single teeth begin with tooth 0 in each, "
                "whatever the angle between the meshes"
            )


def map_errors(maps: Iterable[tuple[str, ContactMap | FaceMap | None]]) -> Iterator[str]:
    """Yield a sentence for each mesh, by its name, on how far its maps of loaded teeth are from contacts they have not seen."""
    most: dict[str, float] = {}
    for name, one in maps:
        if one is not None and one.error >= 0.0:  # none was solved for maps that are written by hand
            most[name] = max(most.get(name, 0.0), one.error)
    for name, error in most.items():
        yield (
            f"meshes.{name}: what lies between positions and loads of the map of its loaded teeth, {1e6 * error:.1g} um of the "
            "approach at the worst of 16 contacts solved there"
        )


def _over_cycle(curve: MeshStiffness, taken: float) -> str:
    """Of loaded teeth about the joint state of all contacts over the mesh cycle."""
    share = float(np.ptp(curve.transverse)) / curve.mean
    helices = "" if curve.helices == 1 else " of both helices"
    return (
        f"ripple of {100.0 * share:.3g} % peak to peak; the mean tangent of its loaded teeth over the mesh cycle, "
        f"{taken:.4g} N/m along the flank normal{helices}, all contacts in equilibrium together, is taken"
    )


def _of_model(curve: MeshStiffness, taken: float) -> str:
    share = float(np.ptp(curve.transverse)) / curve.mean
    ripple = (
        f"ripple of {100.0 * share:.3g} % peak to peak" if share else f"ripple, which '{curve.model}' does not know"
    )
    load = "without a load" if not curve.load else f"at F_bt = {curve.load:.4g} N"
    helices = "" if curve.helices == 1 else " of both helices"
    return (
        f"{ripple}; the mean stiffness of '{curve.model}', {taken:.4g} N/m along the flank normal "
        f"({curve.definition}, {load}{helices}), is taken"
    )


def mesh_stiffness_warnings(system: System) -> Iterator[str]:
    """Yield what the stiffness models themselves warn about."""
    for name, helices in system.state.curves.items():
        sentences = dict.fromkeys(sentence for curve in helices for sentence in curve.warnings)
        yield from (f"meshes.{name}: {sentence}" for sentence in sentences)
