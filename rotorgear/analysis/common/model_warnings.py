"""What a model allows but its maker should know: odd gears, unloaded meshes, parts that nothing drives or holds."""

from __future__ import annotations

from collections.abc import Iterator

from rotorgear.analysis.common.mesh_notes import mesh_stiffness_warnings
from rotorgear.gears.geometry.geometry import check_gear
from rotorgear.model.checks.pairs import mesh_findings
from rotorgear.model.layout.mesh_geometry import base_radius, gear_geometry
from rotorgear.system.system import System


def model_warnings(system: System) -> Iterator[str]:
    """Yield a sentence for everything that is worth a second look."""
    yield from _gears(system)
    yield from _meshes(system)
    yield from mesh_stiffness_warnings(system)
    yield from _train(system)
    yield from _couplings(system)


def _gears(system: System) -> Iterator[str]:
    for name, gear in system.model.gears.items():
        geometry = gear_geometry(gear)
        for sentence in check_gear(geometry) if geometry else ():
            yield f"gears.{name}: {sentence}"


def _meshes(system: System) -> Iterator[str]:
    model = system.model
    for name, mesh in model.meshes.items():
        pinion = model.gears[mesh.pinion]
        gear = model.gears[mesh.gear]
        yield from (f"meshes.{name}: {sentence}" for sentence in mesh_findings(model, name))
        if pinion.lumped and pinion.teeth and gear.teeth:
            off = base_radius(gear) / base_radius(pinion) * pinion.teeth / gear.teeth - 1.0
            if abs(off) > 1e-6:
                yield f"meshes.{name}: the base radii's ratio is {100 * off:+.3g} % off that of the teeth, which set the speeds"
        if system.flow.applied and any(force.assumed for force in system.flow.of_mesh(name)):
            yield f"meshes.{name}: no torque flows through it; its driving flank is taken from the sense of rotation"


def _train(system: System) -> Iterator[str]:
    model = system.model
    train = system.train
    for name in model.shafts:
        if train.ratios[name] == 0:
            by = f"nothing drives it from shaft '{train.reference}', so it stands still"
            yield f"shafts.{name}: {by}; give speed_ratio if it turns"
    if not system.flow.applied and model.meshes:
        yield "no torque is given: driving flanks follow from the sense of rotation, power flowing out from the input shaft"
    for name, bearing in model.bearings.items():
        if bearing.table and model.operation and model.operation.speed is not None:
            own = abs(train.ratio(bearing.shaft) * model.operation.speed)
            if not bearing.table[0].speed <= own <= bearing.table[-1].speed:
                yield f"bearings.{name}: its table does not reach the operating speed"


def _couplings(system: System) -> Iterator[str]:
    for name, coupling in system.model.couplings.items():
        first = system.model.shafts[coupling.from_shaft].station(coupling.from_at)
        second = system.model.shafts[coupling.to_shaft].station(coupling.to_at)
        length = max(system.model.shafts[coupling.from_shaft].length, system.model.shafts[coupling.to_shaft].length)
        if length and abs(second - first) > 0.25 * length:
            gap = 1e3 * abs(second - first)
            yield f"couplings.{name}: its two points are {gap:.6g} mm apart along z; check the shafts' start"
