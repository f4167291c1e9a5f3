"""What a model allows but its maker should know: odd gears, unloaded meshes, parts that nothing drives or holds."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from rotorgear.analysis.common.gear_bodies import gear_body_warnings
from rotorgear.analysis.common.mesh_notes import mesh_stiffness_warnings
from rotorgear.gears.geometry.geometry import check_gear
from rotorgear.model.checks.meshes import mesh_findings
from rotorgear.quantity import millimetres
from rotorgear.system.system import System

# Share of a face that neighbours may have in common, and that may stand beyond its shaft, by rounding of the drawing.
_TOUCH = 1e-3


def model_warnings(system: System) -> Iterator[str]:
    """Yield a sentence for everything that is worth a second look."""
    model = system.model
    for name, gear in model.gears.items():
        for sentence in check_gear(gear.geometry) if gear.geometry else ():
            yield f"gears.{name}: {sentence}"
    yield from _faces(system)
    for mesh in system.layout.meshes:
        pinion = mesh.pinion.part
        teeth = mesh.gear.part.teeth
        yield from (f"meshes.{mesh.name}: {sentence}" for sentence in mesh_findings(mesh))
        if pinion.lumped and pinion.teeth and teeth:
            off = mesh.gear.base_radius / mesh.pinion.base_radius * pinion.teeth / teeth - 1.0
            if abs(off) > 1e-6:
                said = f"the base radii's ratio is {100 * off:+.3g} % off that of the teeth, which set the speeds"
                yield f"meshes.{mesh.name}: {said}"
        if system.state.applied and any(force.assumed for force in system.state.of_mesh(mesh.name)):
            yield f"meshes.{mesh.name}: no torque flows through it; its driving flank is taken from the sense of rotation"
    yield from mesh_stiffness_warnings(system)
    yield from gear_body_warnings(system)
    train = system.train
    for name in model.shafts:
        if train.ratios[name] == 0 and model.shafts[name].speed_ratio != 0.0:
            by = f"nothing drives it from shaft '{train.reference}', so it stands still"
            yield f"shafts.{name}: {by}; give speed_ratio if it turns"
    if not system.state.applied and model.meshes:
        yield "no torque is given: driving flanks follow from the sense of rotation, power flowing out from the input shaft"
    for name, bearing in model.bearings.items():
        if bearing.table and model.operating_speed is not None:
            turning = abs(train.ratio(bearing.shaft) * model.operating_speed)
            if not bearing.table[0].speed <= turning <= bearing.table[-1].speed:
                yield f"bearings.{name}: its table does not reach the operating speed"
    # A coupling ties its two points as if they were at one place: far apart, a shaft likely starts where it should not.
    for name, coupling in model.couplings.items():
        first, second = (place.z for place in system.layout.places(f"couplings.{name}"))
        second += float(model.shafts[coupling.from_shaft].frame.sees(model.shafts[coupling.to_shaft].frame).origin[2])
        length = max(model.shafts[coupling.from_shaft].length, model.shafts[coupling.to_shaft].length)
        if length and abs(second - first) > 0.25 * length:
            gap = 1e3 * abs(second - first)
            yield f"couplings.{name}: its two points are {gap:.6g} mm apart along z; check the shafts' start"


def _faces(system: System) -> Iterator[str]:
    """Gears that stand in one another, and gears that hang over the end of their shaft."""
    faces: dict[str, list[tuple[float, float, str]]] = {}
    for gear in system.layout.gears:
        half = 0.0 if gear.part.is_bevel else 0.5 * gear.part.total_width
        faces.setdefault(gear.shaft, []).append((gear.z - half, gear.z + half, gear.name))
    for shaft, found in faces.items():
        part = system.model.shafts[shaft]
        found.sort()
        for first, second in pairwise(found):
            shared = min(first[1], second[1]) - second[0]
            if shared > _TOUCH * (second[1] - second[0]) or second[0] == first[0]:
                where = f"{millimetres(second[0])}" if shared <= 0.0 else f"over {millimetres(shared)}"
                yield f"gears.{first[2]} and gears.{second[2]} stand in one another on shaft '{shaft}' ({where}); check their at"
        for start, end, name in found:
            beyond = max(part.start - start, end - part.end)
            # A ring stands around what it meshes with, on an arm at the end of its shaft.
            if part.sections and beyond > _TOUCH * (end - start) and not system.model.layout.gear(name).part.internal:
                yield f"gears.{name}: its face hangs over the end of shaft '{shaft}' by {millimetres(beyond)}; check its at"
