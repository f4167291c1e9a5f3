"""Where a run begins: a disk on a spring under its weight and an unbalance or a harmonic force, against the closed form."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from tests.models import clamp, disk

M, K, C, G = 3.0, 4.0e5, 60.0, 9.81
SPEED = 140.0
UNBALANCE = 2e-3  # kg m


def oscillator(**parts: Any) -> rg.Model:
    """A disk whose shaft has no length, on a spring and a damper along y, with its weight."""
    return rg.Model(
        operation={"input_shaft": "rotor", "speed": SPEED, "gravity": [0.0, -G, 0.0]},
        shafts={"rotor": {}},
        disks={"mass": disk("rotor", "start", M, 0.1, 0.1)},
        bearings={"spring": {"shaft": "rotor", "at": "start", "stiffness": {"y": K}, "damping": {"y": C}}},
        supports={"held": clamp("x", "z", "tilt_x", "tilt_y", "torsion")},
        points={"seen": {"on": "disks.mass", "direction": "y"}},
        **parts,
    )


UNBALANCED = {"unbalances": {"u": {"shaft": "rotor", "at": "start", "magnitude": UNBALANCE, "phase": 1.2}}}
PUSHED = {
    "loads": {
        "push": {"shaft": "rotor", "at": "start", "force": [0.0, 500.0, 0.0], "frequency": 35.0, "phase": 0.7},
    }
}


def exact(t: np.ndarray, begin: float, F: complex, w: float) -> np.ndarray:
    """y(t) of M y'' + C y' + K y = Re(F exp(i w t)) about its sag, from y = begin at rest."""
    Y = F / (K - M * w**2 + 1j * w * C)
    s = -C / (2.0 * M) + 1j * np.sqrt(K / M - (C / (2.0 * M)) ** 2)
    # a of Re(a exp(s t)), from displacement and velocity at t = 0.
    y, v = begin - Y.real, -(1j * w * Y).real
    a = y - 1j * (v - s.real * y) / s.imag
    return np.real(a * np.exp(s * t) + Y * np.exp(1j * w * t))


@pytest.mark.parametrize("start", ["equilibrium", "mean", "rest"])
@pytest.mark.parametrize(
    ("parts", "force", "w"),
    [
        (UNBALANCED, -1j * UNBALANCE * SPEED**2 * np.exp(1.2j), SPEED),
        (PUSHED, 500.0 * np.exp(0.7j), 70.0 * np.pi),
    ],
)
def test_one_mass_begins_where_the_start_says(start: str, parts: dict[str, Any], force: complex, w: float) -> None:
    found = rg.transient(oscillator(**parts), time=0.2, discard=0.0, steps=None, accuracy=1e-5, start=start)
    sag = -M * G / K
    begin = {"equilibrium": force.real / K, "mean": 0.0, "rest": -sag}[start]
    history = found.history(next(name for name in found.channel if "seen displacement" in name))
    expected = sag + exact(found.time, begin, force, w)
    assert found.start == start
    np.testing.assert_allclose(history, expected, atol=2e-3 * np.abs(expected - sag).max())
    assert any("t = 0" in note for note in found.warnings) == (start == "equilibrium")


def test_another_start_is_refused_by_name() -> None:
    with pytest.raises(rg.AnalysisError, match="start: got 'gap', expected one of equilibrium, mean, rest"):
        rg.transient(oscillator(**UNBALANCED), time=0.1, start="gap")


def test_a_pair_starts_from_rest_with_flanks_that_just_touch() -> None:
    pair = rg.load("models/backlash_pair.toml").with_({"meshes.pair.transmission_error": ()})
    found = {start: rg.transient(pair, time=2e-3, discard=0.0, start=start) for start in ("rest", "equilibrium")}
    static = found["rest"].mean_force[0]
    assert abs(found["rest"].mesh_force[0, 0]) < 0.05 * static
    assert found["equilibrium"].mesh_force[0, 0] == pytest.approx(static, rel=0.3)
