"""The joint quasi-static state of loaded contacts against closed forms, on contact maps that are written down."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.static.cycle import over_cycle
from rotorgear.analysis.static.joint_state import JointState
from rotorgear.analysis.static.solve import Equilibrated, equilibrate
from rotorgear.model.layout.mesh_layout import MeshLayout
from rotorgear.system.system import System
from tests.unit.analysis.written_maps import ripple, written

K = 4e8


def hertz(F: np.ndarray, u: np.ndarray) -> np.ndarray:
    """A no-load error, and a compliance that falls with the load, both over the cycle."""
    gap = 2e-6 * np.cos(2.0 * np.pi * u - 0.3) + 0.6e-6 * np.cos(4.0 * np.pi * u + 1.1)
    return np.asarray(gap + 4e-9 * (1.0 + 0.2 * np.sin(2.0 * np.pi * u)) * F**0.95)


def gear(shaft: str, teeth: int, hand: str, **more: Any) -> dict[str, Any]:
    return {
        "shaft": shaft,
        "at": "50 mm",
        "teeth": teeth,
        "normal_module": "4 mm",
        "helix_angle": "25 deg",
        "hand": hand,
        "width": "30 mm",
        "kind": "herringbone",
        "gap": "20 mm",
        **more,
    }


def herringbone(axial: float, stagger: float = 0.5, **operation: Any) -> rg.Model:
    """Two stiff shafts; the pinion's is held along its axis by `axial` (N/m)."""
    stiff = {"radial": "1e12 N/m", "axial": "1e12 N/m", "tilt": "1e12 N m/rad"}
    shafts = {
        name: {"position": [x, "0 mm"], "sections": [{"length": "100 mm", "outer_diameter": "60 mm", "rigid": True}]}
        for name, x in (("one", "0 mm"), ("two", "132.405347 mm"))
    }
    return rg.Model(
        operation={"input_shaft": "one", "output_shaft": "two", "speed": 100.0, "torque": 400.0, **operation},
        shafts=shafts,
        gears={"p": gear("one", 24, "right"), "g": gear("two", 36, "left")},
        meshes={"m": {"pinion": "p", "gear": "g", "stiffness": 2.0 * K, "stagger": stagger}},
        bearings={
            "a": {"shaft": "one", "at": "50 mm", "stiffness": {**stiff, "axial": axial}},
            "b": {"shaft": "two", "at": "50 mm", "stiffness": stiff},
        },
    )


def joint_of(model: rg.Model) -> tuple[Equilibrated, JointState]:
    load = model.torque_flow(1).of_kind("static")
    equilibrium, joint = over_cycle(equilibrate(System(model, state=load), 100.0), 100.0)
    assert joint is not None
    return equilibrium, joint


def harmonic(values: np.ndarray, n: int) -> np.ndarray:
    return np.asarray(2.0 * np.abs(np.fft.fft(values, axis=0)[n]) / len(values))


def rotation(model: rg.Model, joint: JointState) -> np.ndarray:
    """Transmission error over the cycle: on shafts that turn and shift along their axes only, the mean of both approaches."""
    beta = model.layout.mesh("m").pinion.base_helix_angle
    return np.asarray(joint.cycles[0].approach.mean(axis=1) / math.cos(beta))


def test_staggered_helices_on_stiff_shafts_leave_no_second_harmonic(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(MeshLayout, "contact_map", written(ripple(K, 0.05)))
    model = herringbone(axial=1e15)
    _, joint = joint_of(model)
    (cycle,) = joint.cycles
    # Both helices approach alike, and the sum of k (1 +- a cos) does not vary; each by itself would have a^2 delta peak to peak.
    mean = cycle.approach.mean()
    assert np.ptp(cycle.approach, axis=0) == pytest.approx(np.zeros(2), abs=0.01 * 0.05**2 * mean)
    # The map is smooth between its loads, so that F is k delta to its interpolation only.
    expected = K * mean * (1.0 + 0.05 * np.cos(2.0 * np.pi * cycle.position))
    assert joint.on_map(0, cycle.position) == pytest.approx(cycle.position + joint.pitch[0])
    shifted = np.roll(cycle.force[:, 0], round(128 * joint.pitch[0]) % 128)
    assert shifted == pytest.approx(expected, rel=2e-3)


def test_staggered_helices_of_a_floating_pinion_have_the_second_harmonic_of_their_mean(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    a = 0.05
    monkeypatch.setattr(MeshLayout, "contact_map", written(ripple(K, a)))
    model = herringbone(axial=1.0)
    _, joint = joint_of(model)
    (cycle,) = joint.cycles
    # Each helix carries half: delta = F_0 / k / (1 - a^2 cos^2 x) on the mean of both.
    mean = joint.force[0] / K
    x = 2.0 * np.pi * np.arange(512) / 512
    error = mean / (1.0 - (a * np.cos(x)) ** 2) / math.cos(model.layout.mesh("m").pinion.base_helix_angle)
    found = rotation(model, joint)
    assert cycle.force[:, 0] == pytest.approx(np.full(128, joint.force[0]), rel=1e-6)
    assert harmonic(found, 2) == pytest.approx(harmonic(error, 2), rel=1e-3)
    assert harmonic(found, 1) < 1e-3 * harmonic(found, 2)


def test_a_contact_whose_force_is_given_goes_along_its_own_map(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(MeshLayout, "contact_map", written(hertz))
    model = herringbone(axial=1.0, stagger=0.0)
    equilibrium, joint = joint_of(model)
    (cycle,) = joint.cycles
    contact_map = joint.maps[0]
    assert contact_map is not None
    u = joint.on_map(0, cycle.position)
    assert cycle.force == pytest.approx(np.full((128, 2), joint.force[0]), rel=1e-6)
    assert cycle.approach[:, 0] == pytest.approx(contact_map.approach_at(joint.force[0], u), rel=1e-5)
    assert joint.stiffness[0] == pytest.approx(contact_map.stiffness(cycle.approach[:, 0], u).mean(), rel=1e-9)
    # The equilibrium is the mean of the joint state, force and approach.
    assert equilibrium.force == pytest.approx(joint.force, rel=1e-9)
    found = equilibrium.lines.vectors.T @ equilibrium.q
    assert found == pytest.approx(joint.approach, rel=1e-9)


def test_where_the_gear_drives_the_cycle_runs_the_other_way(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(MeshLayout, "contact_map", written(hertz))
    forward = joint_of(herringbone(axial=1.0, stagger=0.0))[1]
    driven = {"input_shaft": "two", "output_shaft": "one", "torque": 600.0}
    backward = joint_of(herringbone(axial=1.0, stagger=0.0, **driven))[1]
    assert forward.sense == pytest.approx([1.0, 1.0])
    assert backward.sense == pytest.approx([-1.0, -1.0])
    contact_map = backward.maps[0]
    assert contact_map is not None
    (cycle,) = backward.cycles
    u = -(backward.pitch[0] + cycle.position)
    assert cycle.approach[:, 0] == pytest.approx(contact_map.approach_at(backward.force[0], u), rel=1e-5)


def test_statics_and_response_have_one_mean_force(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(MeshLayout, "contact_map", written(hertz))
    model = herringbone(axial=3e8)
    still = rg.static(model)
    moving = rg.response(model, speeds=[10.0], modal_damping=0.05)
    assert moving.mean_force == pytest.approx(still.mesh_force, rel=1e-9)


@pytest.mark.parametrize("axial", [1.0, 3e8, 1e15])
@pytest.mark.parametrize("stagger", [0.0, 0.5, 0.3])
def test_a_response_at_a_crawl_is_the_joint_state(
    axial: float, stagger: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(MeshLayout, "contact_map", written(hertz))
    model = herringbone(axial, stagger)
    _, joint = joint_of(model)
    (cycle,) = joint.cycles
    # A damping ratio of 0.05 would give 4e-8 of the mean force even at this speed.
    found = rg.response(model, speeds=[1e-3], modal_damping=1e-6)
    cosine = math.cos(model.layout.mesh("m").pinion.base_helix_angle)
    for got, exact in ((found.approach[:, 0] * cosine, cycle.approach), (found.mesh_force[:, 0], cycle.force)):
        coefficients = 2.0 * np.fft.fft(exact, axis=0)[1:20] / len(exact)
        # A force that stays the same has no harmonics but those of rounding.
        size = max(float(np.abs(coefficients).max()), 1e-6 * float(np.abs(exact).max()))
        for n, coefficient in enumerate(coefficients, 1):
            if f"mesh m {n}x" in found.orders:
                there = got[found.orders.index(f"mesh m {n}x")]
                assert there == pytest.approx(coefficient, rel=1e-6, abs=1e-5 * size)
            else:
                assert np.abs(coefficient).max() < 0.005 * size
    assert "mesh m 2x" in found.orders


def test_teeth_that_differ_shake_with_the_orders_of_their_shaft(monkeypatch: pytest.MonkeyPatch) -> None:
    def one_tooth(F: np.ndarray, u: np.ndarray) -> np.ndarray:
        bump = 5e-6 * np.exp(-(((u - 5.0) / 0.8) ** 2))
        return np.asarray(bump + F / K * (1.0 + 0.05 * np.cos(2.0 * np.pi * u)))

    monkeypatch.setattr(MeshLayout, "contact_map", written(one_tooth, periods=24))
    model = herringbone(axial=1.0, stagger=0.0)
    _, joint = joint_of(model)
    (cycle,) = joint.cycles
    assert cycle.periods == 24
    found = rg.response(model, speeds=[1e-3], modal_damping=0.05)
    cosine = math.cos(model.layout.mesh("m").pinion.base_helix_angle)
    coefficients = 2.0 * np.fft.fft(cycle.approach[:, 0]) / len(cycle.approach)
    for n in (1, 2, 3, 4, 5):
        order = found.orders.index(f"shaft one {n}x")
        assert found.ratio[order] == pytest.approx(n)
        assert found.approach[order, 0, 0] * cosine == pytest.approx(coefficients[n], rel=1e-6)
    assert found.approach[found.orders.index("mesh m 1x"), 0, 0] * cosine == pytest.approx(coefficients[24], rel=1e-6)
