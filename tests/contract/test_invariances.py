"""What must not change the modes of a running gearbox: turning it, mirroring it, reading it from the other end, names."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.quantity import RPM_PER_RAD_S
from tests.paths import MODELS

Table = dict[str, Any]
OTHER = {"right": "left", "left": "right"}


def helical_pair() -> Table:
    """The example with bearings that differ along x and y, and a contact away from the pitch point."""
    table = tomllib.loads((MODELS / "helical_pair.toml").read_text())
    table["meshes"]["stage"]["contact_position"] = 4e-3
    table["shafts"]["output"]["position"] = [0.135 * np.cos(0.4), 0.135 * np.sin(0.4)]
    table["shafts"]["input"]["position"] = [0.0, 0.0]
    return table


def along_x_and_y(table: Table, ratio: float) -> Table:
    """Bearings `ratio` times as stiff along y as along x, with a cross term."""
    for name, bearing in table["bearings"].items():
        k = 2e8 if name.startswith("input") else 4e8
        bearing["stiffness"] = {"x": k, "y": ratio * k, "xy": 2e7, "yx": 2e7, "axial": 1e8}
    return table


def turned(table: Table) -> Table:
    """The gearbox turned by 90 degrees about z."""
    for shaft in table["shafts"].values():
        x, y = shaft["position"]
        shaft["position"] = [-y, x]
    for bearing in table["bearings"].values():
        k = bearing["stiffness"]
        k["x"], k["y"], k["xy"], k["yx"] = k["y"], k["x"], -k["yx"], -k["xy"]
    return table


def mirrored(table: Table) -> Table:
    """The mirror image in the plane x = 0: right hands become left ones, and spins turn round."""
    for shaft in table["shafts"].values():
        shaft["position"] = [-shaft["position"][0], shaft["position"][1]]
    for gear in table["gears"].values():
        gear["hand"] = OTHER[gear["hand"]]
    for bearing in table["bearings"].values():
        k = bearing["stiffness"]
        k["xy"], k["yx"] = -k["xy"], -k["yx"]
    table["operation"]["speed"] = "-2970 rpm"
    return table


def renamed(table: Table) -> Table:
    """The wheel called pinion and the pinion called wheel."""
    mesh = table["meshes"]["stage"]
    mesh["pinion"], mesh["gear"] = mesh["gear"], mesh["pinion"]
    return table


def from_the_other_side(table: Table) -> Table:
    """The gearbox read from z = +infinity: z and x change sign (a rotation about y), and so do spins."""
    for shaft in table["shafts"].values():
        lengths = [float(s["length"].removesuffix(" mm")) * 1e-3 for s in shaft["sections"]]
        start = float(shaft["start"].removesuffix(" mm")) * 1e-3
        shaft["start"] = -(start + sum(lengths))
        shaft["sections"] = shaft["sections"][::-1]
        shaft["position"] = [-shaft["position"][0], shaft["position"][1]]
    for bearing in table["bearings"].values():
        bearing["at"] = -float(bearing["at"].removesuffix(" mm")) * 1e-3
        k = bearing["stiffness"]
        k["xy"], k["yx"] = -k["xy"], -k["yx"]
    for disk in table["disks"].values():
        disk["at"] = {"start": "end", "end": "start"}[disk["at"]]
    table["operation"]["speed"] = "-2970 rpm"
    return table


def driven_by_the_wheel(table: Table) -> Table:
    """The power flows the other way: a speed increaser of the same speeds."""
    table["operation"] = {
        "input_shaft": "output",
        "output_shaft": "input",
        "speed": table_speed(table),
        "power": "60 kW",
    }
    return table


def table_speed(table: Table) -> float:
    """Speed of the output shaft in rad/s, with its sense."""
    return -2970.0 / RPM_PER_RAD_S * table["gears"]["pinion"]["teeth"] / table["gears"]["wheel"]["teeth"]


def eigenvalues(table: Table) -> np.ndarray:
    """Lowest 16 eigenvalues at the speed of operation."""
    model = rg.Model(**table)
    assert model.operation is not None
    found = rg.modal(model, speed=model.operation.speed, modes=16, elements=2).eigenvalues
    return np.asarray(found)


CHANGES: list[Callable[[Table], Table]] = [turned, mirrored, renamed, from_the_other_side]


@pytest.mark.parametrize("flow", [lambda table: table, driven_by_the_wheel], ids=["reducer", "increaser"])
@pytest.mark.parametrize("change", CHANGES)
def test_the_modes_stay_when_only_the_view_changes(
    change: Callable[[Table], Table], flow: Callable[[Table], Table]
) -> None:
    before = eigenvalues(flow(along_x_and_y(helical_pair(), 3.0)))
    table = change(along_x_and_y(helical_pair(), 3.0))
    if flow is driven_by_the_wheel:
        sign = -1.0 if change in (mirrored, from_the_other_side) else 1.0
        table = flow(table)
        table["operation"]["speed"] *= sign
    after = eigenvalues(table)
    np.testing.assert_allclose(after[2:], before[2:], rtol=1e-7)


def test_the_flow_of_power_changes_the_modes_of_a_contact_beside_the_pitch_point() -> None:
    """So the test above does see the working flank and the side of the contact."""
    driving = eigenvalues(along_x_and_y(helical_pair(), 3.0))
    driven = eigenvalues(driven_by_the_wheel(along_x_and_y(helical_pair(), 3.0)))
    assert np.max(np.abs(driven[2:] / driving[2:] - 1.0)) > 1e-4
