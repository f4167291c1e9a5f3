"""Elastic bodies from meshes and matrices: casings with the seats that bearings stand in, and the bodies of gears.

The model file is turned into the plain values that `rotorgear/casings` reduces a body from; bore and rim are the two seats of
the body of a gear.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rotorgear.casings.settings import CasingSettings, JoinSettings, MountSettings
from rotorgear.errors import AnalysisError
from rotorgear.forces.designations import designated
from rotorgear.model.parts.casing import ONLY_MESH, UNIT_LENGTHS, Box, Seat
from rotorgear.model.parts.gear import Gear
from rotorgear.model.parts.shaft import LIBRARY, Material, Place
from rotorgear.model.parts.supports import Bearing, NonlinearElement
from rotorgear.model.parts.tables import Tables
from rotorgear.progress import listener
from rotorgear.quantity import did_you_mean, millimetres

if TYPE_CHECKING:
    from rotorgear.casings.box import BoxSeat, BoxShape
    from rotorgear.casings.patches import Cylinder
    from rotorgear.casings.reduced_body import ReducedBody
    from rotorgear.casings.wheel import ReducedWheel

# A shaft whose axis misses the reference point of a seat by more than this (m) stands in another one.
_OFF_AXIS = 5e-3


# Settings that casings and gear bodies have by one name.
_SAME = ("connection", "modes_to", "damping_ratio", "mass_tolerance")


# The seat of a bearing or nonlinear element: its casing, its number there, and the arm (3,) in m to the part from the reference
# point of the seat, which carries it rigidly.
BearingSeat = tuple[str, int, np.ndarray]


def reduced(model: Tables, name: str) -> ReducedBody:
    """The reduced body of a casing; whoever is `listening` hears of its progress.

    Raises:
        AnalysisError: its file can't be read, or does not fit.
        MissingExtraError: meshio or scikit-fem is not installed.
    """
    casing = model.casings[name]
    if casing.matrices is not None:
        from rotorgear.casings.matrices_file import read_matrices

        return read_matrices(Path(casing.matrices), casing.interface, casing.damping_ratio, name)
    from rotorgear.casings.casing import reduced_casing

    return reduced_casing(casing_settings(model, name), progress=listener())


def casing_settings(model: Tables, name: str) -> CasingSettings:
    """The settings of a casing whose fields are in order."""
    from rotorgear.casings.assembly import Elastic

    casing = model.casings[name]
    shape = None if casing.box is None else box_shape(model, name)
    # Checked: where there is no material, all three values are given.
    material = Elastic(casing.youngs_modulus or 0.0, casing.poisson_ratio or 0.0, casing.density or 0.0)
    if casing.material is not None:
        known = model.materials.get(casing.material) or LIBRARY[casing.material]
        material = Elastic(known.youngs_modulus, known.nu, known.density)
    none = ((0.0,) * 6,) * 6
    return CasingSettings(
        name=name,
        files=tuple((part, Path(file)) for part, file in casing.mesh.items()),
        unit=UNIT_LENGTHS[casing.unit or "m"],  # checked: a mesh has one
        material=material,
        held=casing.held,
        mounts=tuple(
            MountSettings(place, mount.as_rows(), mount.damping.as_rows() if mount.damping else none)
            for place, mount in casing.mounts.items()
        ),
        seats=(
            tuple((bearing, _place(seat)) for bearing, seat in casing.seats.items())
            if shape is None
            else tuple((seat.name, _bore(seat)) for seat in shape.seats)
        ),
        box=shape,
        joins=tuple(JoinSettings(*one.faces, one.stiffness) for one in casing.joins),
        mass=casing.mass,
        splits=casing.splits,
        **{key: getattr(casing, key) for key in _SAME},
    )


def box_shape(model: Tables, name: str) -> BoxShape:
    """A box in plain values, with a seat for each bearing that names it as its casing; checked: all have bores along z."""
    from rotorgear.casings.box import BoxSeat, BoxShape

    box = model.casings[name].box
    assert box is not None, "asked for boxes only"
    low, high = (_three(edge(box.corners, axis=0)) for edge in (np.min, np.max))
    seats = []
    for part_name, part in parts_in(model, name).items():
        diameter, width = bore_sizes(box, part_name, part) or (0.0, 0.0)
        shaft = model.shafts[part.shaft]
        at = _three(shaft.frame.at(shaft.station(part.at)))
        seats.append(BoxSeat(part_name, at, 0.5 * diameter, width))
    ends = [
        (shaft.frame.at(shaft.station("start")), shaft.frame.at(shaft.station("end")))
        for shaft in model.shafts.values()
    ]
    return BoxShape(
        low=low,
        high=high,
        wall=box.wall,
        walls=box.walls,
        boss=box.boss or box.wall,
        seats=tuple(seats),
        shafts=tuple((*_three(begin)[:2], float(begin[2]), float(end[2])) for begin, end in ends),
        ribs=(box.ribs.x, box.ribs.y, box.ribs.z) if box.ribs else ((), (), ()),
        rib=(box.ribs.thickness, box.ribs.height) if box.ribs else (0.0, 0.0),
        feet=box.feet.size if box.feet else (),
        feet_side=box.feet.side if box.feet else "-y",
        element=box.largest_element,
    )


def parts_in(model: Tables, name: str) -> dict[str, Bearing | NonlinearElement]:
    """Bearings and nonlinear elements that stand in a casing."""
    parts: dict[str, Bearing | NonlinearElement] = {**model.bearings, **model.nonlinear_elements}
    return {part_name: part for part_name, part in parts.items() if part.casing == name}


def bore_sizes(box: Box, name: str, part: Bearing | NonlinearElement) -> tuple[float, float] | None:
    """Diameter and width in m of the outer ring of a bearing: given, or of its designation; None where neither tells them."""
    if name in box.bores:
        return box.bores[name].diameter, box.bores[name].width
    rolling = part.rolling if isinstance(part, Bearing) else None
    ring = designated(rolling.designation or "") if rolling is not None else None
    if rolling is None or ring is None or not math.isfinite(ring.outer + ring.width):
        return None
    rows = 1 if rolling.arrangement == "single" else 2
    return ring.outer, ring.width + (rows - 1) * (rolling.row_distance or ring.width)


def _bore(seat: BoxSeat) -> Cylinder:
    """The bore of a seat of a box."""
    from rotorgear.casings.patches import Cylinder

    x, y, z = seat.at
    return Cylinder((x, y, z), (0.0, 0.0, 1.0), -0.5 * seat.width, 0.5 * seat.width, seat.radius)


def wheel_settings(name: str, gear: Gear, material: Material) -> CasingSettings:
    """The settings of the body of a gear with a mesh whose fields are in order."""
    from rotorgear.casings.assembly import Elastic

    body = gear.body
    assert body.mesh is not None, "asked for gears with a mesh only"
    assert body.unit is not None, "checked: a mesh has a unit"
    assert body.seat is not None, "checked: a mesh has a bore"
    assert body.rim is not None, "checked: a mesh has a rim"
    return CasingSettings(
        name=f"{name}.body",
        files=((ONLY_MESH, Path(body.mesh)),),
        unit=UNIT_LENGTHS[body.unit],
        material=Elastic(material.youngs_modulus, material.nu, material.density),
        seats=(("seat", _place(body.seat)), ("rim", _place(body.rim))),
        mass=gear.mass,
        table="gears",
        **{key: getattr(body, key) for key in _SAME},
    )


def _place(seat: Seat) -> str | Cylinder:
    """Name of a set, or a bore."""
    from rotorgear.casings.patches import Cylinder

    if seat.set is not None:
        return seat.set
    # Checked: where there is no set, the whole place is given.
    axis = seat.axis or "z"
    center = seat.center or (0.0, 0.0)
    direction = [float(axis == name) for name in "xyz"] if isinstance(axis, str) else axis
    line = np.array(direction) / math.hypot(*direction)
    place = np.array(center if len(center) == 3 else np.insert(center, "xyz".index(str(axis)), 0.0))
    return Cylinder(_three(place), _three(line), seat.begin or 0.0, seat.to or 0.0, seat.radius or 0.0)


def _three(values: np.ndarray) -> tuple[float, float, float]:
    x, y, z = values.tolist()
    return x, y, z


def reduced_wheel(name: str, gear: Gear, material: Material) -> ReducedWheel:
    """The reduced body of a gear; whoever is `listening` hears of its progress.

    Raises:
        AnalysisError: what is wrong with its mesh, or moments of inertia that the gear states otherwise.
        MissingExtraError: meshio or scikit-fem is not installed.
    """
    from rotorgear.casings.casing import reduced_gear_body

    wheel = reduced_gear_body(wheel_settings(name, gear, material), progress=listener())
    for key in ("polar_inertia", "diametral_inertia"):
        value = getattr(wheel, key)
        stated = getattr(gear, key)
        if stated is not None and abs(value - stated) > gear.body.mass_tolerance * stated:
            raise AnalysisError(
                f"gears.{name}.{key}: the mesh has {value:.6g} kg m^2, and {stated:.6g} kg m^2 are stated. A gear with a mesh "
                "has the mass of the mesh, counted once: leave the value out, correct the mesh, or give body.mass_tolerance."
            )
    return wheel


def find_seat(model: Tables, address: str, place: Place, body_of: Callable[[str], ReducedBody]) -> BearingSeat | None:
    """The seat of a part such as "bearings.left" at its place; None where it stands on the ground.

    Raises:
        AnalysisError: the casing has no such seat, or the shaft's axis does not run through it.
    """
    table, _, wanted = address.partition(".")
    casing = getattr(model, table)[wanted].casing
    if casing is None:
        return None
    body = body_of(casing)
    said = model.casings[casing].seats.get(wanted)
    if model.casings[casing].matrices is not None and said is not None and said.set is not None:
        wanted = said.set  # a file of matrices has names of its own
    if wanted not in body.seats:
        hint = did_you_mean(wanted, body.seats, f"there is: {', '.join(body.seats) or 'none'}")
        raise AnalysisError(
            f"{address}.casing: casing '{casing}' has no seat '{wanted}': {hint} "
            f"(casings.{casing}.seats says which seat a bearing stands in)"
        )
    number = body.seats.index(wanted)
    frame = model.shafts[place.shaft].frame
    arm = frame.at(place.z) - body.seat_points[number]
    across = frame.axes[:, :2].T @ arm
    off = math.hypot(*across)
    if off > _OFF_AXIS:
        # What of its position must change: all three coordinates where that lies across an inclined axis.
        wanted_place = frame.origin - frame.axes[:, :2] @ across
        count = 3 if frame.is_turned else 2
        raise AnalysisError(
            f"{address}.casing: the axis of shaft '{place.shaft}' misses seat '{wanted}' of casing '{casing}' by "
            f"{millimetres(off)}: give the shaft the position "
            f"{', '.join(millimetres(float(x)) for x in wanted_place[:count])}, or name another seat"
        )
    return casing, number, arm
