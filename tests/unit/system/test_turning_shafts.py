"""Shafts that turn against the reference at another speed: internal damping, whirl, bearing tables, crossings, forces."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from tests.models import STEEL, E, clamp, disk, lumped_gear

Table = dict[str, Any]


def driven(ratio: float, shaft: Table, **parts: Any) -> rg.Model:
    """A shaft "rotor" that a point "drive" turns through gears at -ratio; the mesh is too soft to matter."""
    gear = {"mass": 0.0, "polar_inertia": 0.0, "diametral_inertia": 0.0}
    mesh = {"pinion": "p", "gear": "g", "stiffness": 1e-6, "centre_line_angle": 0.3, "pressure_angle": 0.4}
    supports = {"drive": clamp(shaft="drive"), **parts.pop("supports", {})}
    return rg.Model(
        **{
            "operation": {"input_shaft": "drive"},
            "shafts": {"drive": {}, "rotor": shaft},
            "gears": {
                "p": lumped_gear("drive", 0.1 * ratio, **gear),
                "g": lumped_gear("rotor", 0.1, **gear),
            },
            "meshes": {"m": mesh},
            "supports": supports,
            **parts,
        }
    )


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_internal_damping_of_a_driven_shaft_destabilises_whirl_in_the_sense_of_its_own_spin(sense: float) -> None:
    eta = 2e-4
    mass = 10.0
    k = 48 * E * (np.pi * 0.02**4 / 64)
    external = 0.5 * eta * k
    model = driven(
        2.0,
        {
            "material": "light",
            "sections": [{"length": 1.0, "outer_diameter": 0.02}],
            "internal_damping": eta,
            "shear_deformation": False,
        },
        motions=["bending"],
        materials={"light": {**STEEL["steel"], "density": 1e-6}},
        disks={"disk": disk(at=0.5, mass=mass)},
        supports={
            "left": clamp("x", "y"),
            "right": clamp("x", "y", at="end"),
            "dashpot": {"shaft": "rotor", "at": 0.5, "damping": {"radial": external}},
        },
    )
    threshold = np.sqrt(k / mass) * (1.0 + external / (eta * k))
    for share, stable in ((0.99, True), (1.01, False)):
        result = rg.modal(model, speed=sense * share * threshold / 2.0, modes=2, elements=1)
        assert sorted(result.whirl) == ["backward", "forward"]
        forward = result.whirl.index("forward")
        assert result.whirl_by_shaft["rotor"][forward] == pytest.approx(1.0, abs=1e-6)
        assert (result.eigenvalues.real[forward] < 0.0) is np.bool_(stable)
        assert result.eigenvalues.real[1 - forward] < 0.0


RIGID = {"sections": [{"length": 0.4, "outer_diameter": 0.1, "rigid": True, "material": "massless"}]}
MASSLESS = {"massless": {"youngs_modulus": 2.1e11, "shear_modulus": 8e10, "density": 1e-9}}
BODY = {"disk": {"shaft": "rotor", "at": 0.2, "mass": 10.0, "polar_inertia": 0.12, "diametral_inertia": 0.2}}


def between_bearings(ratio: float = 0.0, **bearing: Any) -> rg.Model:
    """A rigid disk between two equal bearings, on the reference shaft (ratio 0) or on one that is driven at -ratio."""
    bearings = {end: {"shaft": "rotor", "at": end, **bearing} for end in ("start", "end")}
    parts: Table = {"materials": MASSLESS, "disks": BODY, "bearings": bearings}
    held = {"axial": {"shaft": "rotor", "at": "start", "fixed": ["z", "torsion"]}}
    if ratio:
        return driven(ratio, RIGID, supports=held, **parts)
    return rg.Model(shafts={"rotor": RIGID}, operation={"input_shaft": "rotor", "speed": 800.0}, supports=held, **parts)


@pytest.mark.parametrize("ratio", [0.0, 0.5])
def test_stiffness_and_damping_of_a_table_are_those_of_the_shafts_own_speed(ratio: float) -> None:
    rows = [
        {"speed": speed, "stiffness": {"radial": k}, "damping": {"radial": c}}
        for speed, k, c in ((0.0, 1e6, 100.0), (400.0, 3e6, 500.0), (1000.0, 4e6, 800.0))
    ]
    model = between_bearings(ratio, table=rows)
    for own, k, c in ((100.0, 1.5e6, 200.0), (300.0, 2.5e6, 400.0), (550.0, 3.25e6, 575.0)):
        found = rg.modal(model, speed=own / (ratio or 1.0), modes=12, elements=1, error_estimate=False)
        # Two bearings carry the mass: m s^2 + 2 c s + 2 k = 0.
        expected = complex(-c / 10.0, np.sqrt(2.0 * k / 10.0 - (c / 10.0) ** 2))
        assert np.min(np.abs(found.eigenvalues - expected)) < 1e-6 * abs(expected)


@pytest.mark.parametrize("ratio", [0.0, 0.5])
def test_unbalance_meets_forward_modes_only(ratio: float) -> None:
    """W^2 (I_d - I_p) = 2 k l^2 forward, W^2 (I_d + I_p) = 2 k l^2 backward, and W^2 m = 2 k in translation both ways."""
    model = between_bearings(ratio, stiffness={"radial": 1e6})
    own = ratio or 1.0
    result = rg.campbell(model, speeds=np.linspace(0.0, 1500.0 / own, 16).tolist(), shaft_orders=[1.0], elements=1)
    seen = {
        kind: [
            (item.speed * own, item.excited) for item in result.crossings if item.whirl == kind and "rotor" in item.line
        ]
        for kind in ("forward", "backward")
    }
    tilt = 2.0 * 1e6 * 0.2**2
    forward = np.sqrt(tilt / (0.2 - 0.12))
    backward = np.sqrt(tilt / (0.2 + 0.12))
    assert any(abs(speed / forward - 1.0) < 1e-6 and excited for speed, excited in seen["forward"])
    assert any(abs(speed / backward - 1.0) < 1e-6 for speed, _ in seen["backward"])
    assert not any(excited for speed, excited in seen["backward"] if abs(speed / backward - 1.0) < 1e-6)


def test_a_margin_is_the_frequency_of_the_mode_over_that_of_the_line_less_one() -> None:
    model = between_bearings(stiffness={"radial": 1e6})
    result = rg.campbell(model, speeds=np.linspace(0.0, 1500.0, 16).tolist(), shaft_orders=[1.0], elements=1)
    tilt = 2.0 * 1e6 * 0.2**2
    half = 0.12 * 800.0 / (2.0 * 0.2)
    modes = [np.sqrt(2e6 / 10.0), half + np.hypot(half, np.sqrt(tilt / 0.2))]  # those with a forward share
    nearest = min(modes, key=lambda w: abs(w - 800.0))
    (margin,) = [item for item in result.margins if item.line.endswith(" 1x")]
    assert margin.frequency_hz == pytest.approx(800.0 / (2.0 * np.pi))
    assert 2.0 * np.pi * margin.mode_hz == pytest.approx(nearest, rel=1e-6)
    assert margin.margin == pytest.approx(nearest / 800.0 - 1.0, rel=1e-6)
    assert margin.crossing_speed == pytest.approx(np.sqrt(tilt / (0.2 - 0.12)), rel=1e-6)


def test_bearing_forces_and_inertia_are_in_balance_with_stiffness_proportional_damping() -> None:
    beta = 2e-4
    data = {
        "damping": {"rayleigh_beta": beta},
        "unbalances": {"u": {"shaft": "rotor", "at": 0.2, "magnitude": 1e-3, "phase": 0.6}},
        "points": {"pickup": {"on": "disks.disk", "direction": "y"}},
    }
    still = between_bearings(stiffness={"radial": 1e6}, damping={"radial": 100.0})
    model = rg.Model(
        **{
            name: getattr(still, name) for name in ("shafts", "operation", "supports", "materials", "disks", "bearings")
        },
        **data,
    )
    speed = 380.0
    result = rg.response(model, speeds=[speed], elements=1)
    moved = result.displacement[0, 0, result.places.index("disks.disk"), :2]
    assert result.acceleration[0, 0, 0] == pytest.approx(-(speed**2) * moved[1], rel=1e-9)
    unbalance = 1e-3 * speed**2 * np.exp(0.6j) * np.array([1.0, -1.0j])
    held = result.bearing_force[0, 0, :, :2].sum(axis=0)
    assert held + unbalance == pytest.approx(-10.0 * speed**2 * moved, rel=1e-6)
    k = 2e6 + 1j * speed * (200.0 + beta * 2e6)
    assert moved[0] == pytest.approx(unbalance[0] / (k - 10.0 * speed**2), rel=1e-6)


def test_speeds_too_far_apart_for_a_peak_are_named_by_its_half_power_width() -> None:
    """The width at half power is 2 zeta w: seen by speeds half of it apart, missed by coarser ones."""
    c = 60.0
    still = between_bearings(stiffness={"radial": 1e6}, damping={"radial": c})
    data = {
        name: getattr(still, name) for name in ("shafts", "operation", "supports", "materials", "disks", "bearings")
    }
    model = rg.Model(**data, unbalances={"u": {"shaft": "rotor", "at": 0.2, "magnitude": 1e-3}})
    w = np.sqrt(2e6 / 10.0)
    zeta = 2.0 * c / (2.0 * 10.0 * w)
    extra = 0.5 * zeta
    width = 2.0 * (zeta + extra) * w
    for share, told in ((0.45, False), (0.55, True)):
        step = share * width
        speeds = (w + step * np.arange(-6, 4)).tolist()
        assert speeds[-1] < 0.9 * np.sqrt(8e4 / 0.2)  # the tilting modes, which are damped otherwise, stay above
        result = rg.response(model, speeds=speeds, modal_damping=extra, elements=1)
        assert any("half power" in text for text in result.warnings) is told


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_damping_that_turns_with_the_shaft_does_not_see_a_whirl_that_turns_with_it_too(sense: float) -> None:
    """Under unbalance the bent shaft stands still for an observer on it: internal damping changes nothing."""

    def moved(eta: float) -> np.ndarray:
        shaft = {"sections": [{"length": 1.0, "outer_diameter": 0.03}], "internal_damping": eta}
        model = rg.Model(
            operation={"input_shaft": "rotor"},
            motions=["bending"],
            shafts={"rotor": shaft},
            disks={"disk": disk(at=0.4, mass=6.0, polar=0.02, tilt=0.01)},
            bearings={
                end: {"shaft": "rotor", "at": end, "stiffness": {"radial": 3e6}, "damping": {"radial": 300.0}}
                for end in ("start", "end")
            },
            unbalances={"u": {"shaft": "rotor", "at": 0.4, "magnitude": 1e-4, "phase": 0.3}},
        )
        return rg.response(model, speeds=[sense * 120.0], elements=3).displacement

    still = moved(0.0)
    assert moved(3e-4) == pytest.approx(still, abs=1e-8 * np.abs(still).max())


def test_terms_taken_by_strains_are_those_of_the_matrices_on_counter_rotating_shafts() -> None:
    shaft = {"sections": [{"length": 0.5, "outer_diameter": 0.03}], "internal_damping": 2e-4}
    bearing = {"shaft": "rotor", "stiffness": {"x": 2e6, "y": 3e6, "xy": 4e5, "yx": -4e5}, "damping": {"radial": 300.0}}
    model = driven(
        2.0,
        shaft,
        materials=STEEL,
        bearings={end: {"at": end, **bearing} for end in ("start", "end")},
        damping={"rayleigh_beta": 1e-5},
    )
    system = rg.System(model, 2)
    for speed in (70.0, -130.0):
        forms = system.strain_forms(speed)
        B = forms.strain
        for D, whole in (
            (forms.modulus, system.stiffness(speed)),
            (forms.viscosity, system.damping(speed)),
            (forms.circulation, system.circulatory(speed)),
        ):
            expected = whole.toarray()
            assert (B.T @ D @ B).toarray() == pytest.approx(expected, abs=1e-9 * np.abs(expected).max())
            assert np.abs(expected).max() > 0.0
