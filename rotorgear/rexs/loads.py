"""Speed, torques, forces and additional masses of a REXS file: of the components, or of one of its load cases.

Additional masses (from 1.3 on) are disks or point masses of a shaft, with the unbalance of their eccentricity.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from rotorgear.rexs.account import Account
from rotorgear.rexs.document import Component
from rotorgear.rexs.shafts import ShaftPart
from rotorgear.rexs.structure import Structure
from rotorgear.rexs.toml_text import Names, Table, quantity, text
from rotorgear.rexs.train import speed_ratios

MASS = "additional_mass"
# Moments about v and w that differ by less are those of a body of revolution, written with few digits.
_ALIKE = 1e-3
_ROUNDING = 1e-12


def mass_tables(part: Component, names: Names, shafts: dict[str, ShaftPart], structure: Structure) -> list[Table]:
    """Tables of an additional mass; none, and a problem on the account, where its mass or its place is not said.

    A mass m with its centre off the axis by e has the unbalance m e.
    """
    account = structure.account
    shaft = shafts.get(structure.shaft_of(part))
    if shaft is None:
        account.left_out.append(f"{part}: it is on no shaft")
        return []
    mass = account.number(part, ("mass_of_component", "mass"), "mass")
    if not mass or mass < 0.0:
        account.missing(part, "mass_of_component is needed, above 0")
        return []
    u = account.number(part, ("u_coordinate_on_shaft",), "length")
    frame = structure.frame(part)
    if u is not None:
        along = shaft.axis.z(u)
    elif frame is not None:
        along = float(shaft.axis.base.sees(frame.origin)[0])
    else:
        account.missing(part, "its place is needed: u_coordinate_on_shaft or support_vector")
        return []
    z = shaft.place(part, along, account)
    moments = [account.number(part, (f"moment_of_inertia_{axis}_axis",), "inertia") or 0.0 for axis in "uvw"]
    polar, *across = (max(value, 0.0) for value in moments)
    name = names.of(part.name, "mass", part.id)
    body = shaft.table(f"{'disks' if polar or any(across) else 'point_masses'}.{name}", str(part), z)
    body.add("mass", quantity(mass, "mass"))
    if polar or any(across):
        diametral = 0.5 * sum(across)
        comment = ""
        if abs(across[0] - across[1]) > _ALIKE * diametral:
            said = f"{across[0]:.6g} about v, {across[1]:.6g} kg m^2 about w"
            reason = f"a shaft's bodies are round here; the file says {said}"
            comment = account.assume(f"{body.header}.diametral_inertia", f"{diametral:.6g} kg m^2", reason)
        body.add("polar_inertia", quantity(polar, "inertia"))
        body.add("diametral_inertia", quantity(diametral, "inertia"), comment)
    tables = [body]
    eccentricity = account.numbers(part, "eccentricity_vector", "length", 3)
    if eccentricity is not None and math.hypot(*eccentricity[1:]) > 0.0:
        axes = frame.axes if frame is not None else structure.model.axes
        _, x, y = shaft.axis.base.axes @ (np.array(eccentricity) @ axes)
        table = shaft.table(f"unbalances.{name}", f"eccentricity of {part}", z)
        table.add("magnitude", quantity(mass * math.hypot(x, y), "unbalance"))
        # A planet's own x points outwards.
        table.add("phase", quantity(math.atan2(y, x) - (shaft.pins.offset if shaft.pins else 0.0), "angle"))
        tables.append(table)
    return tables


@dataclass(frozen=True)
class Torque:
    """A place where torque enters or leaves: z in m, torque about +z in N m or None where power (W) or the train gives it."""

    component: Component
    shaft: ShaftPart
    z: float
    torque: float | None
    power: float | None = None


def given_speeds(shafts: dict[str, ShaftPart], account: Account) -> list[tuple[float, ShaftPart, bool]]:
    """Speeds about +z in rad/s that the file states, and whether it says that they define others; these first.

    A speed of 0 counts only where it defines others: then the shaft is held.
    """
    known = []
    for shaft in shafts.values():
        own = account.number(shaft.component, ("rotational_speed", "speed"), "speed")
        defines = account.truth(shaft.component, "defines_speed")
        if own or (own == 0.0 and defines):
            known.append((0 if defines else 1 if defines is None else 2, own * shaft.axis.sense, shaft))
    known.sort(key=lambda item: item[0])
    return [(speed, shaft, rank == 0) for rank, speed, shaft in known]


def load_tables(
    shafts: dict[str, ShaftPart], tables: list[Table], structure: Structure
) -> tuple[Table | None, list[Table]]:
    """The operation (None without speed and torque) and the loads.

    Args:
        shafts: of the model by number. tables: of the train. structure: of the file.
    """
    account = structure.account
    names = Names()
    loads = []
    torques = []
    for load in structure.document.of_type("external_load"):
        shaft = shafts.get(structure.shaft_of(load))
        if shaft is None:
            account.left_out.append(f"{load}: it is on no shaft")
            continue
        u = account.number(load, ("u_coordinate_on_shaft",), "length")
        z = shaft.place(load, shaft.start if u is None else shaft.axis.z(u), account)
        torque = account.number(load, ("torque_around_u_axis", "torque_acting_on_shaft_u", "torque"), "torque")
        if shaft.pins is not None and torque:
            account.left_out.append(f"{load}: a torque on a planet")
        elif torque is not None and torque != 0.0:
            torques.append(Torque(load, shaft, z, shaft.axis.sense * torque))
        elif account.truth(load, "transmits_torque"):
            torques.append(Torque(load, shaft, z, None, account.number(load, ("power",), "power")))
        force = _force_table(load, shaft, z, names, structure.account)
        if force is not None:
            loads.append(force)
    turning = ((speed, shaft) for speed, shaft, _ in given_speeds(shafts, account) if speed)
    speed, reference = next(turning, (0.0, None))
    torques.sort(key=lambda item: item.torque is None)
    if reference is None and not torques:
        account.assume("operation", "none", "the file gives neither speed nor torque: analyses are at standstill")
        return None, loads
    start = reference or torques[0].shaft
    ratio = speed_ratios(tables, start.name, speed)
    torques = [_of_power(item, speed * ratio.get(item.shaft.name, 0.0), account) for item in torques]
    operation, of_torques = _operation(speed, start, torques, ratio, names, account)
    return operation, [*loads, *of_torques]


def _of_power(item: Torque, speed: float, account: Account) -> Torque:
    """The torque that the power of a load means at the speed of its shaft in rad/s."""
    if item.torque is not None or not item.power or not speed:
        return item
    word = "drives" if item.power > 0.0 else "is taken"
    account.assume(
        f"loads.{item.component.name}", word, f"power of {item.power:.6g} W of {item.component}, by its sign"
    )
    return replace(item, torque=item.power / speed)


def _operation(
    speed: float, start: ShaftPart, torques: list[Torque], ratio: dict[str, float], names: Names, account: Account
) -> tuple[Table, list[Table]]:
    """Which torque drives follows from its power: torque times the speed of its shaft."""
    sense = speed or (torques[0].torque or 1.0)
    power = [(item.torque or 0.0) * ratio.get(item.shaft.name, 0.0) * sense for item in torques]
    drives = [item for item, own in zip(torques, power, strict=True) if own > 0.0]
    takes = [item for item, own in zip(torques, power, strict=True) if own < 0.0]
    open_ends = [item for item in torques if item.torque is None and item.shaft.name in ratio]
    table = Table("operation")
    if not drives and takes and open_ends:
        # Only what is taken is known: the other end drives.
        drives = open_ends[:1]
        open_ends = open_ends[1:]
    driver = drives[0].shaft if drives else start
    table.add("input_shaft", text(driver.name))
    own = speed * ratio.get(driver.name, 1.0)
    if speed:
        note = "" if driver is start else f"{start.component} defines {speed * 30.0 / math.pi:.6g} rpm"
        table.add("speed", quantity(own, "speed"), note)
    else:
        account.assume("operation.speed", "none", "the file gives no rotational speed: analyses are at standstill")
    if not drives or len([*drives, *takes, *open_ends]) < 2 or not speed:
        if torques:
            account.left_out.append("torques: a speed, a torque that drives and one that takes are needed")
        return table, []
    if len(open_ends) > 1:
        reason = f"{len(open_ends)} ends have no torque: {open_ends[0].component} takes the rest"
        account.assume("loads", "0 N m", reason)
        open_ends = open_ends[:1]
    all_given = not open_ends and all(item.torque is not None for item in drives)
    loads = []
    for kind, items in (("input", drives), ("output", [*takes, *open_ends])):
        for item in items:
            name = names.of(item.component.name, "load", item.component.id)
            entry = Table(f"loads.{name}", str(item.component))
            given = "" if item.torque is None else quantity(abs(item.torque), "torque")
            rest = ""
            if item.torque is not None and all_given and kind == "output" and item is takes[-1]:
                reason = f"the file says {abs(item.torque):.6g} N m; torques must balance"
                rest = account.assume(f"{entry.header}.torque", "the rest", reason)
                given = ""
            entry.add("shaft", text(item.shaft.name))
            entry.add("kind", text(kind))
            entry.add("at", quantity(item.z, "length"), rest)
            if given:
                entry.add("torque", given)
            loads.append(entry)
    return table, loads


def _force_table(load: Component, shaft: ShaftPart, z: float, names: Names, account: Account) -> Table | None:
    """A force, and a moment across the shaft, which the file gives along u, v, w of the shaft."""
    rotation = shaft.axis.rotation
    force = rotation @ [account.number(load, (f"force_{axis}_direction",), "force") or 0.0 for axis in "uvw"]
    across = [account.number(load, (f"torque_around_{axis}_axis",), "torque") or 0.0 for axis in "vw"]
    moment = rotation @ [0.0, *across]
    if not np.any(force) and not np.any(moment):
        return None
    # Components that are rounding of the rotation of axes are zero.
    force, moment = (np.where(np.abs(v) < _ROUNDING * np.abs(v).max(), 0.0, v) for v in (force, moment))
    table = shaft.table(f"loads.{names.of(f'{load.name} force', 'force', load.id)}", str(load), z)
    for key, kind, (along, x, y) in (("force", "force", force), ("moment", "torque", moment)):
        if any((along, x, y)):
            table.add(key, "[" + ", ".join(quantity(value, kind) for value in (x, y, along)) + "]")
    return table
