"""Rigid meshes: one dof a contact follows from the others, and all analyses agree with those of very stiff teeth."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.errors import ModelError
from rotorgear.system.system import flow_system
from tests.unit.analysis.response.test_internal_loads import shaken
from tests.unit.analysis.static.test_static import changed, data_of

# A drive of a thruster on a bench: 22 inertias in kg m^2, springs and dampers between them, and gear stages of 3 and 4 whose
# wheels have no inertia, behind the inertias 12 and 17. Aalto University (2023), by the authors' data sheets.
INERTIA = (
    *(7.94e-4, 3.79e-6, 3.00e-6, 2.00e-6, 7.81e-3, 2.00e-6, 3.29e-6, 5.01e-5, 6.50e-6, 5.65e-5, 4.27e-6, 3.25e-4),
    *(1.20e-4, 1.15e-5, 1.32e-4, 4.27e-6, 2.69e-4, 1.80e-4, 2.00e-5, 2.00e-4, 4.27e-6, 4.95e-2),
)
STIFFNESS = (
    *(1.90e5, 6.95e3, 90.0, 90.0, 90.0, 90.0, 94.064, 4.19e4, 5.40e3, 4.19e4, 1.22e3),
    *(4.33e4, 3.10e4, 1.14e3, 3.10e4, 1.22e4, 4.43e4, 1.38e5, 2.00e4, 1.38e5, 1.22e4),
)
DAMPING = (
    *(8.08, 0.29, 0.24, 0.24, 0.24, 0.24, 0.0, 1.78, 0.23, 1.78, 0.52),
    *(1.84, 1.32, 0.05, 1.32, 0.52, 1.88, 5.86, 0.85, 5.86, 0.52),
)
STAGES = {12: 3, 17: 4}


def thruster(stiffness: float | str) -> dict[str, Any]:
    names = [f"s{number}" for number in range(1, 23)]
    lumped = {"kind": "spur", "mass": 0.0, "polar_inertia": 0.0, "diametral_inertia": 0.0}
    shafts = {**{name: {} for name in names}, "w12": {}, "w17": {}}
    gears: dict[str, Any] = {}
    meshes = {}
    couplings: dict[str, Any] = {}
    for number, ratio in STAGES.items():
        gears[f"p{number}"] = {**lumped, "shaft": f"s{number}", "at": "start", "teeth": 20, "base_radius": 0.02}
        gears[f"w{number}"] = {
            **lumped,
            "shaft": f"w{number}",
            "at": "start",
            "teeth": 20 * ratio,
            "base_radius": 0.02 * ratio,
        }
        meshes[f"m{number}"] = {
            "pinion": f"p{number}",
            "gear": f"w{number}",
            "stiffness": stiffness,
            "centre_line_angle": 0.0,
            "pressure_angle": 0.35,
        }
    for number, (k, c) in enumerate(zip(STIFFNESS, DAMPING, strict=True), 1):
        first = f"w{number}" if number in STAGES else f"s{number}"
        couplings[f"k{number}"] = {"from_shaft": first, "to_shaft": f"s{number + 1}", "stiffness": {"torsion": k}}
        if c:
            couplings[f"k{number}"]["damping"] = {"torsion": c}
    ground = {1: 0.003, 12: 0.0042, 17: 0.0042, 22: 0.24}
    return {
        "motions": ("torsion",),
        "operation": {"input_shaft": "s1", "output_shaft": "s22", "speed": 2000.0 * math.pi / 30.0, "torque": 1.0},
        "shafts": shafts,
        "disks": {
            f"j{number}": {"shaft": f"s{number}", "at": "start", "polar_inertia": J}
            for number, J in enumerate(INERTIA, 1)
        },
        "gears": gears,
        "meshes": meshes,
        "couplings": couplings,
        "supports": {f"d{n}": {"shaft": f"s{n}", "at": "start", "damping": {"torsion": c}} for n, c in ground.items()},
        "points": {
            "upper": {"on": "couplings.k9", "quantity": "torque"},
            "lower": {"on": "couplings.k19", "quantity": "torque"},
            "propeller": {"on": "disks.j22", "direction": "torsion"},
        },
    }


def test_each_rigid_mesh_takes_one_dof_away_and_frequencies_are_those_of_stiff_teeth() -> None:
    rigid = rg.Model(**thruster("rigid"))
    stiff = rg.Model(**thruster(1e12))
    found = rg.modal(rigid, modes=8)
    assert found.dofs == 22
    assert rg.modal(stiff, modes=8).dofs == 24
    assert any("taken away by rigid meshes, couplings and bearings" in str(note) for note in found.left_out)
    # Of a chain by itself, with inertias and springs referred to the first shaft.
    ratio = np.cumprod([1.0, *(1.0 / STAGES.get(number, 1) for number in range(1, 22))])
    M = np.diag(np.array(INERTIA) * ratio**2)
    K = np.zeros((22, 22))
    for number, k in enumerate(STIFFNESS):
        turns = np.zeros(22)
        # Behind a stage the spring begins at the wheel.
        turns[number] = -ratio[number + 1]
        turns[number + 1] = ratio[number + 1]
        K += k * np.outer(turns, turns)
    exact = np.sqrt(np.abs(np.linalg.eigvals(np.linalg.solve(M, K))))
    exact = np.sort(exact)[:8] / (2.0 * np.pi)
    np.testing.assert_allclose(found.frequency_hz[1:8], exact[1:], rtol=1e-8)
    np.testing.assert_allclose(rg.modal(stiff, modes=8).frequency_hz[1:8], exact[1:], rtol=1e-6)


def test_statics_tells_the_force_of_a_rigid_mesh() -> None:
    result = rg.static(rg.Model(**thruster("rigid")))
    assert result.rigid_mesh == ("m12", "m17")
    np.testing.assert_allclose(result.rigid_mesh_force, [1.0 / 0.02, 3.0 / 0.02], rtol=1e-12)
    assert result.load_at("upper") == pytest.approx(-1.0, rel=1e-12)
    assert result.load_at("lower") == pytest.approx(-12.0, rel=1e-12)
    assert "rigid meshes: m12 50.0 N; m17 150.0 N" in result.text()


def test_responses_are_those_of_stiff_teeth() -> None:
    hz = np.array([5.0, 28.0, 40.0, 66.0])
    options: dict[str, Any] = {"inputs": ["propeller"], "outputs": ["upper", "lower", "propeller"], "speed": 200.0}
    rigid, stiff = (rg.frf(rg.Model(**thruster(k)), hz, **options).receptance for k in ("rigid", 1e12))
    np.testing.assert_allclose(rigid, stiff, rtol=1e-5)
    moved = {
        **thruster("rigid"),
        "loads": {"pulse": {"shaft": "s22", "at": "start", "moment": (0.0, 0.0, 1.0), "frequency": 28.0}},
    }
    result = rg.response(rg.Model(**moved), speeds=[200.0])
    forced = np.abs(rg.frf(rg.Model(**moved), np.array([28.0]), **options).receptance[0, :2, 0])
    np.testing.assert_allclose(np.abs(result.internal_load[0, 0]), forced, rtol=1e-6)


def test_a_transient_of_rigid_teeth_is_that_of_stiff_ones() -> None:
    def run(stiffness: float | str, method: str) -> rg.TransientResult:
        data = thruster(stiffness)
        data["operation"] = {"input_shaft": "s1", "speed": 200.0}
        data["loads"] = {
            "motor": {"kind": "input", "shaft": "s1", "torque": 1.0},
            "ice": {
                "kind": "output",
                "shaft": "s22",
                "torque": 12.0,
                "step_to": 20.0,
                "step_at": 0.005,
                "step_duration": 0.002,
            },
        }
        options: dict[str, Any] = {"time": "0.05 s", "discard": "0 s", "steps": 100, "error_estimate": False}
        return rg.transient(rg.Model(**data), method=method, **options)

    rigid = run("rigid", "newmark")
    exact = run("rigid", "exponential")  # it needs inertia of every dof, which wheels without any don't have otherwise
    stiff = run(1e9, "newmark")
    for name in ("points.upper torque", "points.lower torque"):
        size = np.abs(rigid.history(name)).max()
        assert np.ptp(rigid.history(name)) > 0.1 * size
        np.testing.assert_allclose(rigid.history(name), exact.history(name), rtol=0.0, atol=1e-4 * size)
        np.testing.assert_allclose(rigid.history(name), stiff.history(name), rtol=0.0, atol=2e-3 * size)


def test_rigid_teeth_on_flexible_shafts_are_those_of_stiff_ones() -> None:
    data = shaken()
    data["points"] = {
        "m": {"on": "gears.wheel", "quantity": "torque"},
        "b": {"shaft": "output", "at": "40 mm", "quantity": "bending"},
    }
    models = []
    for k in ("rigid", 1e13):
        data["meshes"]["stage"] = {"pinion": "pinion", "gear": "wheel", "stiffness": k}
        models.append(rg.Model(**data))
    assert flow_system(models[0]).n == flow_system(models[1]).n - 1
    rigid, stiff = (rg.static(model) for model in models)
    np.testing.assert_allclose(rigid.rigid_mesh_force, stiff.mesh_force, rtol=1e-7)
    for name, force in stiff.bearing_force.items():
        np.testing.assert_allclose(rigid.bearing_force[name], force, rtol=1e-6, atol=1e-4)
    assert rigid.load_at("b") == pytest.approx(stiff.load_at("b"), rel=1e-7)
    frequencies = [rg.modal(model, modes=12, elements=4).frequency_hz for model in models]
    np.testing.assert_allclose(*frequencies, rtol=1e-5, atol=1e-3)
    responses = [rg.response(model, speeds=[100.0, 300.0], elements=2).internal_load for model in models]
    np.testing.assert_allclose(*responses, rtol=1e-5, atol=1e-6 * np.abs(responses[0]).max())


def test_a_support_beside_a_rigid_mesh_has_its_own_force() -> None:
    data = {
        "motions": ("torsion",),
        "operation": {"input_shaft": "a"},
        "shafts": {"a": {}, "b": {}},
        "gears": {
            name: {
                "shaft": name,
                "at": "start",
                "kind": "spur",
                "base_radius": r,
                "mass": 1.0,
                "polar_inertia": 0.1,
                "diametral_inertia": 0.1,
            }
            for name, r in (("a", 0.05), ("b", 0.12))
        },
        "meshes": {
            "m": {"pinion": "a", "gear": "b", "stiffness": "rigid", "centre_line_angle": 0.0, "pressure_angle": 0.3}
        },
        "supports": {"held": {"shaft": "b", "at": "start", "fixed": ["torsion"]}},
        "loads": {"f": {"shaft": "a", "at": "start", "moment": (0.0, 0.0, 7.0)}},
    }
    with pytest.raises(rg.AnalysisError, match="no free degree of freedom"):
        rg.static(rg.Model(**data))
    data["shafts"]["c"] = {}
    data["disks"] = {"c": {"shaft": "c", "at": "start", "polar_inertia": 0.1}}
    data["couplings"] = {"s": {"from_shaft": "c", "to_shaft": "a", "stiffness": {"torsion": 1e3}}}
    data["loads"]["f"]["shaft"] = "c"
    result = rg.static(rg.Model(**data))
    assert result.support_force["held"][5] == pytest.approx(7.0 * 0.12 / 0.05, rel=1e-12)


def test_a_loop_of_rigid_meshes_is_refused() -> None:
    data = data_of("split_torque")
    for mesh in data["meshes"].values():
        for key in ("damping_ratio", "damping", "index_error", "transmission_error", "stiffness_variation", "backlash"):
            mesh.pop(key, None)
        mesh["stiffness"] = "rigid"
    stiff = {**data, "motions": ["torsion"]}
    for shaft in stiff["shafts"].values():
        for section in shaft.get("sections", ()):
            section["rigid"] = True
    with pytest.raises(rg.AnalysisError, match="closes a loop of rigid members"):
        rg.modal(rg.Model(**stiff), modes=4)


def test_keys_of_teeth_that_give_are_refused_beside_rigid() -> None:
    data = changed(data_of("helical_pair"), "meshes.stage.stiffness", "rigid")
    with pytest.raises(ModelError) as error:
        rg.Model(**data)
    (problem,) = error.value.problems
    assert problem.address == "meshes.stage.damping_ratio"
    assert "stay in touch exactly" in str(problem)


def test_a_stiff_mesh_that_asks_for_too_many_steps_is_named_with_its_remedy() -> None:
    data = thruster(1e16)
    for gear in data["gears"].values():
        gear["polar_inertia"] = 1e-6
    with pytest.raises(rg.AnalysisError, match=r"because meshes\.m1\d vibrates at .* take stiffness = 'rigid'"):
        rg.transient(rg.Model(**data), time="10 s", discard="0 s")


def joined(**coupling: Any) -> rg.Model:
    """A shaft in two halves of unequal length, 40 mm apart where a rigid coupling joins them."""
    return rg.Model(
        operation={"input_shaft": "a", "gravity": (0.0, -9.81, 0.0)},
        shafts={
            "a": {"position": (0.0, 0.0), "sections": [{"length": 0.3, "outer_diameter": 0.03}]},
            "b": {"position": (0.0, 0.0), "start": 0.34, "sections": [{"length": 0.21, "outer_diameter": 0.04}]},
        },
        supports={"wall": {"shaft": "a", "at": "start", "fixed": ["all"]}},
        couplings={"flange": {"from_shaft": "a", "to_shaft": "b", **coupling}},
        loads={"tip": {"shaft": "b", "at": "end", "force": (10.0, -20.0, 35.0), "moment": (1.0, 2.0, 3.0)}},
        points={
            "torque": {"on": "couplings.flange", "quantity": "torque"},
            "shear": {"on": "couplings.flange", "quantity": "shear", "direction": "y"},
            "bending": {"on": "couplings.flange", "quantity": "bending", "direction": "x"},
        },
    )


def test_a_rigid_coupling_joins_two_shafts_as_a_rigid_section_without_mass_does() -> None:
    rigid = joined(rigid=True)
    sections = [
        {"length": 0.3, "outer_diameter": 0.03},
        {"length": 0.04, "outer_diameter": 0.03, "rigid": True, "material": "light"},
        {"length": 0.21, "outer_diameter": 0.04},
    ]
    whole = rg.Model(
        operation={"input_shaft": "a", "gravity": (0.0, -9.81, 0.0)},
        materials={"light": {"youngs_modulus": 206e9, "poisson_ratio": 0.3, "density": 1e-6}},
        shafts={"a": {"sections": sections}},
        supports={"wall": {"shaft": "a", "at": "start", "fixed": ["all"]}},
    )
    found, exact = (rg.modal(model, modes=8, elements=4).frequency_hz for model in (rigid, whole))
    np.testing.assert_allclose(found, exact, rtol=1e-7)


def test_statics_tells_the_load_in_a_rigid_coupling_as_in_a_stiff_one() -> None:
    rigid = rg.static(joined(rigid=True))
    stiff = rg.static(joined(stiffness={"radial": 1e10, "axial": 1e10, "tilt": 1e9, "torsion": 1e9}))
    weight = math.pi / 4.0 * 0.04**2 * 0.21 * 7850.0 * 9.81
    assert rigid.load_at("torque") == pytest.approx(3.0, rel=1e-9)
    assert rigid.load_at("shear") == pytest.approx(-20.0 - weight, rel=1e-9)
    assert rigid.load_at("bending") == pytest.approx(1.0 + 20.0 * 0.23 + weight * 0.125, rel=1e-9)
    for row in stiff.internal_loads:
        assert row.load == pytest.approx(rigid.load_at(row.point), rel=1e-9)


def test_a_load_in_a_rigid_coupling_is_refused_in_vibration() -> None:
    with pytest.raises(rg.AnalysisError, match=r"points\.torque: the load in a rigid coupling"):
        rg.frf(joined(rigid=True), np.array([10.0]), inputs=["supports.wall:x"], outputs=["torque"])


@pytest.mark.parametrize(
    ("coupling", "key"), [({}, "stiffness"), ({"rigid": True, "stiffness": {"torsion": 1.0}}, "stiffness")]
)
def test_a_coupling_is_rigid_or_has_a_stiffness(coupling: dict[str, Any], key: str) -> None:
    with pytest.raises(ModelError) as error:
        joined(**coupling)
    assert [problem.address for problem in error.value.problems] == [f"couplings.flange.{key}"]


def driven_pair(stage: float | str | None) -> rg.Model:
    """The backlash pair behind a drive that turns twice as fast, or with that drive's inertia on its pinion."""
    data = data_of("backlash_pair")
    J, own = 2e-3, 5e-4
    if stage is None:
        data["disks"] = {"m": {"shaft": "a", "at": "start", "polar_inertia": 4.0 * J + own}}
        return rg.Model(**data)
    data["shafts"]["d"] = {}
    gear = {"kind": "spur", "at": "start", "mass": 0.0, "diametral_inertia": 0.0}
    data["gears"] |= {
        "dp": {**gear, "shaft": "d", "teeth": 20, "base_radius": 0.02, "polar_inertia": J},
        "dw": {**gear, "shaft": "a", "teeth": 40, "base_radius": 0.04, "polar_inertia": own},
    }
    teeth = {"pinion": "dp", "gear": "dw", "centre_line_angle": 1.0, "pressure_angle": 0.3}
    data["meshes"]["stage"] = {**teeth, "stiffness": stage}
    return rg.Model(**data)


def test_periodic_motions_and_sweeps_behind_a_rigid_mesh_are_those_of_the_referred_inertia() -> None:
    """Orbits of the stage at 1e12 N/m are those within their error, too, at 20 times the run time: tried once."""
    lumped, rigid = (
        rg.orbits(driven_pair(stage), {"operation.speed": "4000 rpm:4060 rpm"}, step=0.5) for stage in (None, "rigid")
    )
    assert rigid.dofs == lumped.dofs == 2
    np.testing.assert_allclose(rigid.value, lumped.value, rtol=1e-9)
    for name in ("peak_to_peak_approach", "largest_force", "rms_force"):
        np.testing.assert_allclose(getattr(rigid, name), getattr(lumped, name), rtol=1e-7)
    largest = [np.abs(one.multipliers).max(axis=1) for one in (rigid, lumped)]
    np.testing.assert_allclose(*largest, rtol=1e-6)
    options: dict[str, Any] = {"discard": 400, "sample": 8}
    speeds = {"operation.speed": ["10000 rpm"]}
    swept = [rg.sweep(driven_pair(stage), speeds, **options) for stage in (None, "rigid")]
    np.testing.assert_allclose(swept[1].peak_to_peak_approach, swept[0].peak_to_peak_approach, rtol=1e-6)
