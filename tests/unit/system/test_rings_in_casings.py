"""Rings that stand in a casing: a bar as the casing of its matrices, against the same bar as a shaft that is held."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from tests.bar_casing import STEEL, write_bar
from tests.planetary import GROUND, helical_stage

PLACES = np.array([-0.3, -0.18, -0.07, 0.0])
LOADED = '[operation]\ngravity = [1.0, -9.0, 4.0]\ntorque = 700\noutput_shaft = "carrier"'
CENTRAL = {name: springs for name, springs in GROUND.items() if name != "ring"}


def on_a_bar() -> str:
    """The ring at the end of a bar that is held at its other end."""
    sections = ", ".join(
        f"{{length = {length!r}, outer_diameter = 0.12, elements = 1}}" for length in np.diff(PLACES).tolist()
    )
    bar = f'[shafts.ring]\nstart = -0.3\nmaterial = "bar"\nsections = [{sections}]'
    E, G, _, rho = STEEL
    material = f"[materials.bar]\nyoungs_modulus = {E}\nshear_modulus = {G}\ndensity = {rho}"
    held = '[supports.ring]\nshaft = "ring"\nat = "start"\nfixed = ["all"]'
    text = helical_stage(4, teeth=(26, 36, 98), ground=CENTRAL, loss=2e-6, more=f"{material}\n{held}")
    return text.replace("[shafts.ring]", bar).replace("[operation]", LOADED)


def in_a_casing(folder: Path) -> str:
    """The same with the bar as a casing of its matrices."""
    file = write_bar(folder / "bar.npz", z=PLACES, diameter=0.12, seats=[3], held=[0])
    casing = f'[casings.bar]\nmatrices = "{file}"\nseats = {{ring = "seat_3"}}'
    text = helical_stage(4, teeth=(26, 36, 98), ground=CENTRAL, loss=2e-6, more=casing)
    text = text.replace("[shafts.ring]\nspeed_ratio = 0\n", "").replace("[operation]", LOADED)
    return text.replace('internal = true\nshaft = "ring"\nat = 0', 'internal = true\ncasing = "bar"')


def test_a_ring_in_a_casing_is_that_on_the_same_bar(tmp_path: Path) -> None:
    shaft = rg.loads(on_a_bar())
    casing = rg.loads(in_a_casing(tmp_path))
    assert casing.layout.train.ratios["ring"] == 0
    for speed in (None, "5000 rpm"):
        there, here = (rg.modal(model, speed=speed, modes=14, elements=1) for model in (shaft, casing))
        assert here.frequency_hz[1:] == pytest.approx(there.frequency_hz[1:], rel=1e-9)
    moved, still = (rg.static(model, elements=1, speed=0.0) for model in (casing, shaft))
    assert moved.mesh_force == pytest.approx(still.mesh_force, rel=1e-9)
    # The seat hands the torque on the ring over, which Willis gives.
    assert moved.casing_seat_force["bar.seat_3"][5] == pytest.approx(-700.0 * 98 / 26, rel=1e-9)


def test_what_keeps_a_ring_from_its_seat_is_said(tmp_path: Path) -> None:
    text = in_a_casing(tmp_path)
    with pytest.raises(rg.ModelError, match=r"gears\.ring: got casing and shaft, expected one of the two ways"):
        rg.loads(text.replace('casing = "bar"', 'casing = "bar"\nshaft = "carrier"\nat = 0'))
    with pytest.raises(
        rg.ModelError, match=r"gears\.ring\.casing: got 'bar', expected a casing with a seat of this name"
    ):
        rg.loads(text.replace('matrices = "', 'mesh = "').replace('{ring = "seat_3"}', '{other = "seat_3"}'))
    with pytest.raises(rg.ModelError, match=r"gears\.sun\.casing: got 'bar' of an external gear"):
        rg.loads(text.replace('shaft = "sun"\nat = 0\nwidth', 'casing = "bar"\nwidth'))


def test_a_seat_feels_what_its_ring_hands_on_as_the_end_of_the_same_bar_does(tmp_path: Path) -> None:
    """Forces and moments of a response inside the bar at its end, beyond which is the ring."""
    error = '[meshes."planet_ring#2"]\ntransmission_error = [{harmonic = 1, amplitude = 3e-6, phase = 0.4}]'
    at = "\n".join(
        f'[points.{name}]\nshaft = "ring"\nat = "end"\nquantity = "{quantity}"{more}'
        for name, quantity, more in (
            ("n", "axial", ""),
            ("t", "torque", ""),
            ("vx", "shear", '\ndirection = "x"'),
            ("vy", "shear", '\ndirection = "y"'),
            ("mx", "bending", '\ndirection = "x"'),
            ("my", "bending", '\ndirection = "y"'),
        )
    )
    ask = {"speeds": ["1300 rpm", "4100 rpm"], "elements": 1, "method": "direct", "modal_damping": 0.013}
    beside = rg.response(rg.loads(f"{on_a_bar()}\n{error}\n{at}"), **ask)  # type: ignore[arg-type]
    seat = rg.response(rg.loads(f"{in_a_casing(tmp_path)}\n{error}"), **ask)  # type: ignore[arg-type]
    assert seat.casing_seats == ("bar.seat_3",)
    on_seat = seat.casing_seat_force[:, :, 0, :]
    inside = beside.internal_load
    names = list(beside.load_points)
    order = [names.index(name) for name in ("vx", "vy", "n", "mx", "my", "t")]
    assert on_seat == pytest.approx(inside[..., order], rel=1e-8, abs=1e-8 * np.abs(inside).max())
    # One mesh that differs brings all three classes, and each component of the seat has its own.
    assert np.all(np.abs(on_seat).max(axis=(0, 1)) > 1.0)
