"""What analyses say of loaded teeth and of the stiffness models of meshes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from rotorgear.model.layout.assembly import unlike_gears
from rotorgear.note import Note
from rotorgear.system.system import System

if TYPE_CHECKING:
    from rotorgear.gears.maps.contact_map import ContactMap
    from rotorgear.gears.maps.face_map import FaceMap


def unlike_teeth_left_out(system: System) -> Iterator[Note]:
    """Yield a fact for each gear whose teeth differ where it is not known which of them are in its meshes at one time."""
    _, unknown = system.state.tooth_numbers
    for name, meshes in unlike_gears(system.layout.meshes).items():
        if name in unknown:
            where = " and ".join(f"meshes.{mesh.name}" for mesh in meshes)
            why = "its errors of single teeth begin with tooth 0 in each, whatever the angle between the meshes"
            yield Note(f"gears.{name}", f"which of its teeth are in {where} at one time", why)


def map_errors(maps: Iterable[tuple[str, ContactMap | FaceMap | None]]) -> Iterator[Note]:
    """Yield a fact for each mesh, by its name, on how far its maps of loaded teeth are from contacts they have not seen."""
    most: dict[str, float] = {}
    for name, one in maps:
        if one is not None and one.error >= 0.0:  # none was solved for maps that are written by hand
            most[name] = max(most.get(name, 0.0), one.error)
    for name, error in most.items():
        what = "what lies between positions and loads of the map of its loaded teeth"
        why = "the approach at the worst of 16 contacts solved there is off by so much"
        yield Note(f"meshes.{name}", what, why, f"{1e6 * error:.1g} um")


def mesh_stiffness_warnings(system: System) -> Iterator[Note]:
    """Yield what the stiffness models themselves warn about."""
    for name, helices in system.state.curves.items():
        sentences = dict.fromkeys(sentence for curve in helices for sentence in curve.warnings)
        yield from (Note(f"meshes.{name}", sentence) for sentence in sentences)
