"""The short journal bearing, from its law to every analysis, against the closed forms of the short bearing."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.static.solve import equilibrate
from rotorgear.forces.journal_bearing import JournalBearing
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.system.system import System

VISCOSITY = 0.02
RADIUS = 25e-3
LENGTH = 25e-3
CLEARANCE = 50e-6
LAW = JournalBearing(VISCOSITY, RADIUS, LENGTH, CLEARANCE)


def rotor(rpm: float = 3000.0, **bearing: Any) -> rg.Model:
    """A heavy disk between two journal bearings."""
    parameters = {"viscosity": "20 mPa s", "radius": "25 mm", "length": "25 mm", "clearance": "50 um"}
    element = {"law": "journal_bearing", "shaft": "rotor", "parameters": parameters, **bearing}
    return rg.Model(
        motions=["bending"],
        operation={"input_shaft": "rotor", "speed": f"{rpm} rpm", "gravity": [0.0, -9.81, 0.0]},
        shafts={
            "rotor": {"position": [0.0, 0.0], "sections": [{"length": "300 mm", "outer_diameter": "50 mm"}] * 2},
        },
        disks={
            "disk": {
                "shaft": "rotor",
                "at": "300 mm",
                "mass": "60 kg",
                "polar_inertia": "0.5 kg m^2",
                "diametral_inertia": "0.3 kg m^2",
            }
        },
        unbalances={"disk": {"shaft": "rotor", "at": "300 mm", "magnitude": "100 g mm"}},
        nonlinear_elements={name: {"at": at, **element} for name, at in (("left", "start"), ("right", "end"))},
    )


def sommerfeld(eccentricity: float) -> float:
    """mu N L D / W (R/c)^2 (L/D)^2 of the short bearing (Ocvirk)."""
    e = eccentricity
    return float((1.0 - e**2) ** 2 / (np.pi * e * np.sqrt(np.pi**2 * (1.0 - e**2) + 16.0 * e**2)))


@pytest.mark.parametrize("rpm", [1000.0, 3000.0, 12000.0])
def test_the_journal_stands_where_ocvirks_load_relation_puts_it(rpm: float) -> None:
    model = rotor(rpm)
    state = equilibrate(System(model), model.operation.speed).laws[0]
    load = np.linalg.norm(rg.static(model).bearing_force["nonlinear_elements.left"])
    number = VISCOSITY * rpm / 60.0 * 2.0 * RADIUS * LENGTH / load * (RADIUS / CLEARANCE) ** 2
    e = float(np.hypot(*state.d)) / CLEARANCE
    assert number * (LENGTH / (2.0 * RADIUS)) ** 2 == pytest.approx(sommerfeld(e), rel=1e-6)
    # The attitude: tan phi = pi sqrt(1 - e^2) / 4 e between the load, which points down, and the line of centres.
    attitude = np.arctan2(abs(state.d[0]), -state.d[1])
    assert np.tan(attitude) == pytest.approx(np.pi * np.sqrt(1.0 - e**2) / (4.0 * e), rel=1e-6)
    # Turning counterclockwise from +x to +y, the journal climbs to the side that follows the load in the sense of rotation.
    assert state.d[0] > 0.0


def test_check_does_not_say_that_nothing_damps_where_a_film_does() -> None:
    said = [note for note in rg.check(rotor()).left_out if note.startswith("damping matrix")]
    assert said == ["damping matrix: empty; only nonlinear_elements.left, nonlinear_elements.right can damp"]


@pytest.mark.parametrize("e", [0.1, 0.4, 0.7, 0.9])
def test_stiffness_and_damping_are_those_published_for_the_short_bearing(e: float) -> None:
    # Friswell, Penny, Garvey and Lees, Dynamics of Rotating Machines, section 5.5.1: axes along and across the load.
    speed = 314.0
    phi = np.arctan2(np.pi * np.sqrt(1.0 - e**2), 4.0 * e)
    d = CLEARANCE * e * np.array([np.cos(phi), np.sin(phi)])
    about = LAW.linearised(d, speed=speed)
    load = np.linalg.norm(about.force)
    down = about.force / load
    axes = np.array([[-down[1], down[0]], down])
    K = axes @ about.stiffness @ axes.T * CLEARANCE / load
    C = axes @ about.damping @ axes.T * CLEARANCE * speed / load
    h = 1.0 / (np.pi**2 * (1.0 - e**2) + 16.0 * e**2) ** 1.5
    root = np.sqrt(1.0 - e**2)
    uu = 4.0 * h * (np.pi**2 * (2.0 - e**2) + 16.0 * e**2)
    vv = 4.0 * h * (np.pi**2 * (1.0 + 2.0 * e**2) + 32.0 * e**2 * (1.0 + e**2) / (1.0 - e**2))
    uv = h * np.pi * (np.pi**2 * (1.0 - e**2) ** 2 - 16.0 * e**4) / (e * root)
    vu = -h * np.pi * (np.pi**2 * (1.0 - e**2) * (1.0 + 2.0 * e**2) + 32.0 * e**2 * (1.0 + e**2)) / (e * root)
    assert K[0, 0] == pytest.approx(uu, rel=1e-6)
    assert K[1, 1] == pytest.approx(vv, rel=1e-6)
    assert sorted(np.abs([K[0, 1], K[1, 0]])) == pytest.approx(sorted(np.abs([uv, vu])), rel=1e-6)
    assert K[0, 1] * K[1, 0] == pytest.approx(uv * vu, rel=1e-6)
    c_uu = 2.0 * np.pi * h * root * (np.pi**2 * (1.0 + 2.0 * e**2) - 16.0 * e**2) / e
    c_uv = 8.0 * h * (np.pi**2 * (1.0 + 2.0 * e**2) - 16.0 * e**2)
    c_vv = 2.0 * np.pi * h * (np.pi**2 * (1.0 - e**2) ** 2 + 48.0 * e**2) / (e * root)
    assert C[0, 0] == pytest.approx(c_uu, rel=1e-6)
    assert C[1, 1] == pytest.approx(c_vv, rel=1e-6)
    assert abs(C[0, 1]) == abs(C[1, 0]) == pytest.approx(c_uv, rel=1e-6)


def test_the_film_sets_the_rotor_whirling_at_half_its_speed() -> None:
    speeds = [f"{rpm} rpm" for rpm in (2000, 4000, 6000, 8000, 10000)]
    result = rg.campbell(rotor(), speeds=speeds, modes=6)
    onset = min(result.onsets, key=lambda each: abs(each.speed))
    assert 2000.0 < onset.speed * RPM_PER_RAD_S < 10000.0
    assert onset.frequency_hz == pytest.approx(0.5 * onset.speed / (2.0 * np.pi), rel=0.1)
    assert "linear about the static equilibrium at 2000 to 10000 rpm" in result.method
    # The threshold that modes tell is where a transient about the equilibrium begins to grow.
    for factor, grows in ((0.85, False), (1.15, True)):
        modes = rg.modal(rotor(factor * onset.speed * RPM_PER_RAD_S), speed=factor * onset.speed, modes=6)
        assert bool(np.max(modes.eigenvalues.real) > 0.0) is grows


def test_a_transient_settles_in_the_static_equilibrium_and_circles_as_the_response_says() -> None:
    model = rotor()
    run = rg.transient(model, time=0.04, discard=0.2, method="newmark", accuracy=1e-3)
    force = np.array([run.history(f"nonlinear_elements.left force {axis}") for axis in "xy"])[:, run.counted]
    weight = rg.static(model).bearing_force["nonlinear_elements.left"][1]
    assert force.mean(axis=1) == pytest.approx([0.0, -weight], abs=0.01 * weight)
    answer = rg.response(model, speeds=["3000 rpm"], elements=1)
    place = answer.places.index("nonlinear_elements.left")
    assert np.ptp(force[1]) > 0.0
    assert np.abs(answer.displacement[0, 0, place, :2]).max() < 0.05 * CLEARANCE  # small, so that both agree
