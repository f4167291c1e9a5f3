"""C34 and C35 of docs/conventions.md: the contact of a bevel pair, and its ratio."""

from __future__ import annotations

import math

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.elements.gear_mesh import contact_vector
from rotorgear.elements.spring import rigid_transfer
from rotorgear.model.layout.state import contact_geometry
from tests.unit.system.test_bevel import CASES, crossed, hand_of


# Shaft angle 90 deg, teeth 17/41, spiral 35 deg, pressure angle 20 deg, F_t 5000 N: forces away from the apex and towards the own
# axis of pinion and gear, by the formulas of textbooks, for a right-hand pinion that turns clockwise and counter-clockwise.
@pytest.mark.parametrize(("s", "h"), [(1, 1), (-1, -1), (1, -1), (-1, 1)])
@pytest.mark.parametrize("sides", [(1, 1), (1, -1), (-1, 1), (-1, -1)])
def test_c34_bevel_teeth_push_as_textbooks_say_whichever_way_the_axes_point(
    s: int, h: int, sides: tuple[int, int]
) -> None:
    teeth = (17, 41)
    F_t, beta, alpha = 5000.0, math.radians(35.0), math.radians(20.0)
    delta = (math.atan2(17, 41), math.atan2(41, 17))
    module = 0.003
    radii = [0.5 * z * module / math.cos(beta) for z in teeth]
    R = radii[0] / math.sin(delta[0])
    # Axes away from the apex, which is the origin: z and x; those of the shafts lead there or from there.
    axes = (np.array([0.0, 0.0, 1.0]) * sides[0], np.array([1.0, 0.0, 0.0]) * sides[1])
    tables = crossed(CASES["square"], supports={}, bearings={})
    for i, (shaft, gear) in enumerate((("one", "pinion"), ("two", "wheel"))):
        tables["shafts"][shaft] = {
            "position": (0.0, 0.0, 0.0),
            "axis": axes[i].tolist(),
            "start": sides[i] * R * math.cos(delta[i]),
        }
        tables["gears"][gear] |= {"at": "start", "teeth": teeth[i], "mean_normal_module": module, "spiral_angle": beta}
        tables["gears"][gear] |= hand_of((h, -h)[i])
    # The torque on the pinion is s about its axis away from the apex.
    operation = {"input_shaft": "one", "speed": 100.0 * s * sides[0]}
    loads = {
        "in": {"shaft": "one", "kind": "input", "torque": F_t * radii[0]},
        "out": {"shaft": "two", "kind": "output"},
    }
    model = rg.Model(**tables | {"operation": operation, "loads": loads})
    (force,) = model.torque_flow().forces
    v = contact_vector(contact_geometry(force))
    on_gear = force.normal_force * -v[6:9] @ model.shafts["two"].frame.axes.T
    on_pinion = -force.normal_force * v[:3] @ model.shafts["one"].frame.axes.T
    assert on_gear == pytest.approx(-on_pinion, rel=1e-12)
    sh = s * h
    axial = [
        F_t / math.cos(beta) * (math.tan(alpha) * math.sin(d) + sign * sh * math.sin(beta) * math.cos(d))
        for d, sign in zip(delta, (1, -1), strict=True)
    ]
    radial = [
        F_t / math.cos(beta) * (math.tan(alpha) * math.cos(d) - sign * sh * math.sin(beta) * math.sin(d))
        for d, sign in zip(delta, (1, -1), strict=True)
    ]
    assert [axial[0], radial[0]] == pytest.approx(
        [4084.9729, 711.2614] if sh > 0 else [-2383.1390, 3393.1614], abs=1e-4
    )
    # The pinion's axis is z, the pitch point lies in the plane of z and x.
    assert on_pinion == pytest.approx([-radial[0], -s * F_t, axial[0]], rel=1e-12)
    assert on_gear == pytest.approx([axial[1], s * F_t, -radial[1]], rel=1e-12)
    # Rigid motions of both bodies in space strain nothing, nor does the train as it turns.
    motions = np.vstack([
        model.shafts[place.shaft].frame.six.T @ rigid_transfer(model.shafts[place.shaft].frame.at(place.z))
        for place in (force.contact.pinion_place, force.contact.gear_place)
    ])  # fmt: skip
    assert np.abs(v @ motions).max() < 1e-12
    assert v[5] + v[11] * model.layout.train.ratio("two") == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("sides", [(1, 1), (1, -1), (-1, 1), (-1, -1)])
def test_c35_the_ratio_changes_its_sign_with_each_axis_that_leads_to_the_apex(sides: tuple[int, int]) -> None:
    """The pitch point of both gears has one velocity, w_1 x P = w_2 x P with P from the apex."""
    tables = crossed(CASES["sharp"])
    for i, shaft in enumerate(("one", "two")):
        if sides[i] < 0:
            # The same shaft told from its other end, and its gear with it.
            part = tables["shafts"][shaft]
            part["axis"] = (-np.array(part.get("axis", (0.0, 0.0, 1.0)))).tolist()
            part.pop("x_axis", None)
            length = sum(section["length"] for section in part["sections"])
            part |= {"start": -length, "sections": part["sections"][::-1]}
            tables["gears"][("pinion", "wheel")[i]]["at"] *= -1.0
    tables |= {"bearings": {}, "supports": {}, "loads": {}}
    model = rg.Model(**tables)
    ratio = model.layout.train.ratio("two")
    assert ratio == -sides[0] * sides[1] * 23 / 52
    mesh = model.layout.mesh("pair")
    assert mesh.bevel is not None
    assert mesh.meeting is not None
    one, two = (model.shafts[name].frame for name in ("one", "two"))
    apex = one.at(mesh.meeting.apex[0])
    foot = one.at(mesh.contacts[0].contact_z) - apex
    out = one.axes[:, 0] * math.cos(mesh.psi) + one.axes[:, 1] * math.sin(mesh.psi)
    P = foot + mesh.bevel.mean_radii[0] * out
    assert np.cross(one.axes[:, 2], P) == pytest.approx(np.cross(ratio * two.axes[:, 2], P), abs=1e-9)
