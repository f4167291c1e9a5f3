"""Rigid directions of bearings: held exactly, with the reaction that equilibrium asks for, in all analyses."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.errors import ModelError
from rotorgear.system.system import flow_system
from tests.bar_casing import write_bar

K = {"x": 3e7, "y": 5e7, "z": 2e7}
C = {"x": 200.0, "y": 400.0}
TIME: dict[str, Any] = {"time": "20 ms", "discard": "0 s", "steps": 60, "error_estimate": False}


def rotor(left: dict[str, Any], right: dict[str, Any], **more: Any) -> rg.Model:
    """An overhung rotor with weight, unbalances beside and in a bearing, and a load on a bearing."""
    data = {
        "operation": {"input_shaft": "a", "speed": 300.0, "gravity": (0.0, -9.81, 0.0)},
        "shafts": {
            "a": {"sections": [{"length": 0.3, "outer_diameter": 0.03}, {"length": 0.25, "outer_diameter": 0.04}]}
        },
        "disks": {
            "d": {"shaft": "a", "at": 0.2, "mass": 5.0, "polar_inertia": 0.02, "diametral_inertia": 0.01},
            "e": {"shaft": "a", "at": 0.55, "mass": 2.0, "polar_inertia": 0.01, "diametral_inertia": 0.006},
        },
        "bearings": {"l": {"shaft": "a", "at": 0.05, **left}, "r": {"shaft": "a", "at": 0.4, **right}},
        "unbalances": {
            "u": {"shaft": "a", "at": 0.2, "magnitude": 1e-4},
            "v": {"shaft": "a", "at": 0.05, "magnitude": 3e-4, "phase": 0.4},
        },
        "loads": {
            "tip": {"shaft": "a", "at": 0.55, "force": (10.0, -20.0, 35.0)},
            "on": {"shaft": "a", "at": 0.4, "force": (7.0, 0.0, 0.0)},
        },
        "damping": {"rayleigh_alpha": 3.0, "rayleigh_beta": 2e-6},
    }
    return rg.Model(**data, **more)


def on_springs(rigid: bool) -> rg.Model:
    """The rotor in springs and dampers, which are pedestals without mass below rigid bearings, or the bearings themselves."""
    x, y, z = (K[name] for name in "xyz")
    springs = {"stiffness": {"x": x, "y": y, "axial": z}, "damping": C}
    if not rigid:
        return rotor(springs, springs)
    bearing = {"stiffness": {"radial": "rigid", "axial": "rigid"}, "pedestal": springs}
    return rotor(bearing, bearing)


def test_a_rigid_bearing_holds_as_a_fixed_support_does_and_its_dofs_are_gone() -> None:
    y = {"y": 2e7}
    rigid = rotor({"stiffness": {"radial": "rigid", "axial": "rigid"}}, {"stiffness": {"x": "rigid", **y}})
    supports = {
        "l": {"shaft": "a", "at": 0.05, "fixed": ["x", "y", "z"]},
        "r": {"shaft": "a", "at": 0.4, "fixed": ["x"]},
    }
    free = {"stiffness": {"torsion": 0.0}}
    fixed = rotor(free, {"stiffness": y}, supports=supports)
    stiff = rotor({"stiffness": {"radial": 1e12, "axial": 1e12}}, {"stiffness": {"x": 1e12, **y}})
    found, exact, near = (rg.modal(model, modes=8, elements=3, speed=300.0) for model in (rigid, fixed, stiff))
    assert found.dofs == exact.dofs == near.dofs - 4
    assert any("4 dofs taken away by rigid meshes, couplings and bearings" in str(note) for note in found.left_out)
    np.testing.assert_array_equal(found.frequency_hz, exact.frequency_hz)
    np.testing.assert_allclose(found.frequency_hz, near.frequency_hz, rtol=1e-4, atol=1e-6)
    assert flow_system(rigid).dofs.selects
    reactions = rg.static(rigid).bearing_force
    held = rg.static(fixed).support_force
    np.testing.assert_allclose(reactions["l"][:3], held["l"][:3], rtol=1e-9)
    assert reactions["r"][0] == pytest.approx(held["r"][0], rel=1e-9)
    lines = [rg.campbell(model, stop=400.0, points=3, modes=4, elements=2).frequency_hz for model in (rigid, fixed)]
    np.testing.assert_array_equal(*lines)


def test_three_rigid_bearings_share_a_beam_as_the_books_have_it() -> None:
    section = {"length": 0.4, "outer_diameter": 0.02}
    beam = {"sections": [section, section], "shear_deformation": False}
    data: dict[str, Any] = {
        "operation": {"input_shaft": "a"},
        "shafts": {"a": beam},
        "bearings": {
            name: {"shaft": "a", "at": at, "stiffness": "rigid"} for name, at in (("a", 0.0), ("b", 0.4), ("c", 0.8))
        },
        "loads": {name: {"shaft": "a", "at": at, "force": (0.0, -16.0, 0.0)} for name, at in (("p", 0.2), ("q", 0.6))},
    }
    result = rg.static(rg.Model(**data))
    # Two equal spans, loads P in their middles: 5/16, 22/16 and 5/16 P (Roark).
    np.testing.assert_allclose([result.bearing_force[name][1] for name in "abc"], [5.0, 22.0, 5.0], rtol=1e-9)
    for one in data["shafts"]["a"]["sections"]:
        one["rigid"] = True
    with pytest.raises(rg.AnalysisError, match=r"bearings\.c: a rigid member in x that closes a loop"):
        rg.static(rg.Model(**data))
    del data["bearings"]["b"]
    ends = rg.static(rg.Model(**data)).bearing_force
    np.testing.assert_allclose([ends[name][1] for name in "ac"], [16.0, 16.0], rtol=1e-12)


def test_rigid_bearings_on_springs_without_mass_are_these_springs() -> None:
    rigid, plain = (on_springs(kind) for kind in (True, False))
    assert flow_system(rigid).n == flow_system(plain).n
    forces = [rg.static(model).bearing_force for model in (rigid, plain)]
    for name in "lr":
        np.testing.assert_allclose(forces[0][name], forces[1][name], rtol=1e-9, atol=1e-9)
    for method in ("direct", "modal"):
        options: dict[str, Any] = {"speeds": [100.0, 300.0, 500.0], "elements": 1, "method": method}
        found = [rg.response(model, modal_damping=0.01, **options).bearing_force for model in (rigid, plain)]
        limit = {"direct": 1e-9, "modal": 1e-5}[method] * np.abs(found[1]).max()
        np.testing.assert_allclose(*found, rtol=0.0, atol=limit)
    runs = [rg.transient(model, method="exponential", **TIME) for model in (rigid, plain)]
    for name in [f"bearings.{bearing} force {axis}" for bearing in "lr" for axis in "xy"]:
        histories = [run.history(name) for run in runs]
        assert np.ptp(histories[1]) > 1.0
        np.testing.assert_allclose(*histories, rtol=0.0, atol=1e-8 * np.ptp(histories[1]))


def test_the_force_in_a_rigid_bearing_on_the_ground_holds_what_turns_and_what_weighs() -> None:
    bearing = {"stiffness": {"radial": "rigid", "axial": "rigid"}}
    rigid = rotor(bearing, {"stiffness": "rigid"})
    stiff = rotor({"stiffness": {"radial": 1e11, "axial": 1e11}}, {"stiffness": 1e11})
    forces = [rg.response(model, speeds=[100.0, 300.0], elements=2).bearing_force for model in (rigid, stiff)]
    np.testing.assert_allclose(*forces, rtol=0.0, atol=2e-4 * np.abs(forces[0]).max())
    run = rg.transient(rigid, method="exponential", **TIME)
    # Nothing shakes along the axis: the bearing carries the push of the load.
    assert run.history("bearings.l force z").mean() == pytest.approx(35.0, rel=1e-9)
    up = rg.transient(rigid, **{**TIME, "speed": [(0.0, 100.0), (0.02, 300.0)]})
    assert any("bearings.l force x: gyroscopic terms take part in it" in str(note) for note in up.left_out)


def in_bar(path: Path, stiffness: dict[str, Any]) -> rg.Model:
    """A shaft in two seats of a bar that is held at its ends, one of them beside the shaft's bearing."""
    bearings = {
        "seat_1": {"shaft": "a", "at": 0.11, "stiffness": stiffness, "casing": "bar"},
        "seat_3": {"shaft": "a", "at": 0.3, "stiffness": {**stiffness, "axial": 1e8}, "casing": "bar"},
    }
    return rg.Model(
        operation={"input_shaft": "a", "speed": 200.0, "gravity": (0.0, -9.81, 0.0)},
        shafts={"a": {"position": (0.0, 0.0), "sections": [{"length": 0.4, "outer_diameter": 0.02}]}},
        disks={"d": {"shaft": "a", "at": 0.22, "mass": 4.0, "polar_inertia": 0.01, "diametral_inertia": 0.006}},
        bearings=bearings,
        casings={"bar": {"matrices": str(path)}},
        unbalances={"u": {"shaft": "a", "at": 0.22, "magnitude": 1e-4}},
        damping={"rayleigh_beta": 1e-6},
    )


def test_rigid_bearings_in_seats_carry_as_very_stiff_ones(tmp_path: Path) -> None:
    path = write_bar(tmp_path / "bar.npz", z=np.linspace(0.0, 0.4, 5), diameter=0.05, seats=[1, 3], held=[0, 4])
    rigid, stiff = (in_bar(path, {"radial": k, "tilt": k_t}) for k, k_t in (("rigid", "rigid"), (1e12, 1e10)))
    systems = [flow_system(model) for model in (rigid, stiff)]
    assert systems[0].n == systems[1].n - 8
    found, near = (rg.modal(model, modes=6, elements=2).frequency_hz for model in (rigid, stiff))
    np.testing.assert_allclose(found, near, rtol=1e-4, atol=1e-6)
    statics = [rg.static(model) for model in (rigid, stiff)]
    for name, force in statics[1].casing_seat_force.items():
        size = np.abs(force).max()
        np.testing.assert_allclose(statics[0].casing_seat_force[name], force, rtol=0.0, atol=1e-4 * size)
    answers = [rg.response(model, speeds=[100.0, 400.0], elements=2, method="direct") for model in (rigid, stiff)]
    for field in ("bearing_force", "casing_seat_force"):
        one, other = (getattr(answer, field) for answer in answers)
        np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-4 * np.abs(other).max())


def pair(**bearing: Any) -> rg.Model:
    """A spur pair with backlash whose pinion gives way along one axis alone."""
    gear = {"kind": "spur", "at": "start", "teeth": 40, "base_radius": 0.0564, "mass": 1.8, "diametral_inertia": 1.6e-3}
    return rg.Model(
        motions=("bending", "torsion"),
        operation={"input_shaft": "a", "output_shaft": "b", "speed": 600.0, "torque": 10.0},
        shafts={"a": {"position": (0.0, 0.0)}, "b": {"position": (0.12, 0.0)}},
        gears={name: {**gear, "shaft": name, "polar_inertia": 3.2e-3} for name in "ab"},
        meshes={
            "m": {
                "pinion": "a",
                "gear": "b",
                "stiffness": 1.6e8,
                "damping_ratio": 0.05,
                "backlash": 40e-6,
                "transmission_error": [{"harmonic": 1, "amplitude": 2e-6}],
            }
        },
        **bearing,
    )


def test_sweeps_and_orbits_with_rigid_directions_are_those_with_fixed_ones() -> None:
    y = {"y": 2e8}
    damping = {"y": 2e3}
    models = []
    for held in (True, False):
        x = {"x": "rigid", "tilt": "rigid"} if held else {}
        bearings = {
            "a": {"shaft": "a", "at": "start", "stiffness": {**y, **x}, "damping": damping},
            "b": {"shaft": "b", "at": "start", "stiffness": {"radial": "rigid", "tilt": "rigid"} if held else y},
        }
        fixed = {
            "a": {"shaft": "a", "at": "start", "fixed": ["x", "tilt_x", "tilt_y"]},
            "b": {"shaft": "b", "at": "start", "fixed": ["x", "y", "tilt_x", "tilt_y"]},
        }
        models.append(pair(bearings=bearings, supports={} if held else fixed))
    swept = [rg.sweep(model, {"operation.speed": [500.0]}, discard=60, sample=4) for model in models]
    np.testing.assert_allclose(swept[0].largest_force, swept[1].largest_force, rtol=1e-12)
    found = [rg.orbits(model, {"operation.speed": "500:520"}, step=0.5) for model in models]
    assert found[0].dofs == 3
    np.testing.assert_allclose(found[0].largest_force, found[1].largest_force, rtol=1e-9)


@pytest.mark.parametrize(
    ("part", "address"),
    [
        ({"bearings": {"b": {"stiffness": {"torsion": "rigid"}}}}, "bearings.b.stiffness.torsion"),
        ({"bearings": {"b": {"stiffness": {"radial": "rigid"}, "damping": {"x": 3.0}}}}, "bearings.b.damping"),
        ({"bearings": {"b": {"stiffness": {"x": "rigid", "xy": 3.0}}}}, "bearings.b.stiffness"),
        ({"bearings": {"b": {"stiffness": 1e8, "pedestal": {"stiffness": {"x": "rigid", "y": 1e8}}}}}, None),
        ({"bearings": {"b": {"stiffness": "rigid", "rolling": {"designation": "6206"}}}}, "bearings.b.stiffness"),
        ({"bearings": {"b": {"stiffness": "stiff"}}}, "bearings.b.stiffness.radial"),
        ({"supports": {"b": {"stiffness": {"x": "rigid"}}}}, "supports.b.stiffness"),
    ],
)
def test_what_can_be_no_rigid_direction_is_refused_where_it_stands(part: dict[str, Any], address: str | None) -> None:
    for table in part.values():
        table["b"] |= {"shaft": "a", "at": 0.1}
    with pytest.raises(ModelError) as error:
        rg.Model(
            operation={"input_shaft": "a"},
            shafts={"a": {"sections": [{"length": 0.3, "outer_diameter": 0.03}]}},
            **part,
        )
    assert [problem.address for problem in error.value.problems] == [address or "bearings.b.pedestal.stiffness"]


def test_a_map_over_bearing_stiffness_names_a_rigid_one() -> None:
    bearing = {"stiffness": 1e8}
    with pytest.raises(rg.AnalysisError, match=r"bearings\.r\.stiffness: rigid across"):
        rg.critical_map(rotor(bearing, {"stiffness": "rigid"}))


def test_a_coupling_may_be_rigid_in_some_directions() -> None:
    def joined(torsion: float | str) -> rg.Model:
        return rg.Model(
            motions=("torsion",),
            operation={"input_shaft": "a"},
            shafts={"a": {}, "b": {}, "c": {}},
            disks={
                name: {"shaft": name, "at": "start", "polar_inertia": J}
                for name, J in (("a", 0.1), ("b", 0.2), ("c", 0.4))
            },
            couplings={
                "ab": {"from_shaft": "a", "to_shaft": "b", "stiffness": {"torsion": torsion}},
                "bc": {"from_shaft": "b", "to_shaft": "c", "stiffness": {"torsion": 1e4}},
            },
        )

    exact = np.sqrt(1e4 * (1.0 / 0.3 + 1.0 / 0.4)) / (2.0 * np.pi)
    found = rg.modal(joined("rigid"), modes=3)
    assert found.dofs == 2
    np.testing.assert_allclose(found.frequency_hz, [0.0, exact], rtol=1e-12)
    whole = joined(1e4).with_({"couplings.ab.stiffness": "rigid"})
    assert whole.couplings["ab"].rigid_directions == (0, 1, 2, 3, 4, 5)
