"""Errors of the mesh of state spaces: what is stated against responses on a much finer mesh, on rotors of three kinds."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg

# A stepped rotor on two soft and damped bearings, a torsional train of unequal inertias, an overhung disk with skew stiffness.
STEPPED = """
operation = { input_shaft = "r", speed = "4000 rpm" }
shafts.r = { sections = [
    { length = "180 mm", outer_diameter = "30 mm" }, { length = "320 mm", outer_diameter = "48 mm" },
    { length = "150 mm", outer_diameter = "26 mm" } ] }
disks.d = { shaft = "r", at = "300 mm", mass = "6 kg", polar_inertia = "0.04 kg m^2", diametral_inertia = "0.022 kg m^2" }
bearings.a = { shaft = "r", at = "start", stiffness = { radial = "3e7 N/m", axial = "1e7 N/m" }, damping = { radial = 700.0 } }
supports.a = { shaft = "r", at = "start", stiffness = { torsion = "1e3 N m/rad" } }
bearings.b = { shaft = "r", at = "600 mm", stiffness = { radial = "5e7 N/m" }, damping = { radial = "400 N s/m" } }
"""
TRAIN = """
operation = { input_shaft = "r", speed = "1500 rpm" }
damping = { rayleigh_beta = "2e-6 s" }
shafts.r = { sections = [ { length = "900 mm", outer_diameter = "22 mm" }, { length = "500 mm", outer_diameter = "35 mm" } ] }
disks.d = { shaft = "r", at = "start", mass = "2 kg", polar_inertia = "0.02 kg m^2", diametral_inertia = "0.012 kg m^2" }
disks.e = { shaft = "r", at = "end", mass = "1 kg", polar_inertia = "0.0006 kg m^2", diametral_inertia = "0.0005 kg m^2" }
bearings.a = { shaft = "r", at = "200 mm", stiffness = { radial = "1e8 N/m", axial = "1e8 N/m", torsion = "900 N m/rad" } }
bearings.b = { shaft = "r", at = "1200 mm", stiffness = { radial = "1e8 N/m" } }
"""
OVERHUNG = """
operation = { input_shaft = "r", speed = "9000 rpm" }
shafts.r = { internal_damping = "4e-6 s", sections = [ { length = "520 mm", outer_diameter = "40 mm", bore = "12 mm" } ] }
disks.d = { shaft = "r", at = "end", mass = "4 kg", polar_inertia = "0.03 kg m^2", diametral_inertia = "0.016 kg m^2" }
bearings.a = { shaft = "r", at = "start", stiffness = { x = 4e7, y = 6e7, xy = 2e6, yx = -2e6, axial = 1e7 } }
supports.a = { shaft = "r", at = "start", stiffness = { torsion = "1e3 N m/rad" } }
bearings.b = { shaft = "r", at = "300 mm", stiffness = { radial = "8e7 N/m" }, damping = { radial = "600 N s/m" } }
"""
# What the reference itself may be off.
_RESOLVED = 1e-7
CASES = [
    (STEPPED, ["disks.d:x", "bearings.a:y"], ["disks.d:x", "bearings.b:x"], 900.0),
    (TRAIN, ["disks.d:torsion"], ["disks.e:torsion", "disks.d:torsion"], 1500.0),
    (OVERHUNG, ["disks.d:x"], ["disks.d:x", "disks.d:y"], 700.0),
]


@pytest.mark.parametrize(("text", "inputs", "outputs", "fmax"), CASES, ids=["stepped", "train", "overhung"])
@pytest.mark.parametrize(
    "mesh", [{"accuracy": 3e-3}, {"accuracy": 1e-5}, {"elements": 1}, {"elements": 1, "full": True}]
)
def test_stated_errors_are_those_of_the_responses(text, inputs, outputs, fmax, mesh):
    model = rg.loads(text)
    places = {"inputs": inputs, "outputs": outputs, "speed": model.operating_speed}
    found = rg.state_space(model, fmax=fmax, **places, **mesh)
    hz = np.unique(np.concatenate([np.linspace(fmax / 200, fmax, 200), peaks(found, fmax)]))
    whole = rg.frf(model, hz, **places, accuracy=1e-8).receptance
    error = float(np.max(np.abs(found.receptance(hz) - whole) / np.abs(whole).max(axis=0)))
    stated = found.error_estimate + found.reduction_error
    if error > _RESOLVED:
        assert 0.5 < stated / error < 3.0
    if "accuracy" in mesh:
        assert max(error, found.error_estimate, found.reduction_error) < mesh["accuracy"]
    else:
        assert error > _RESOLVED


def peaks(system: rg.StateSpace, fmax: float) -> np.ndarray:
    """Frequencies in Hz on the tops and flanks of the peaks of a system."""
    A, *_ = system.first_order()
    poles = np.linalg.eigvals(A)
    poles = poles[(poles.imag > 1.0) & (poles.imag < 2.0 * np.pi * fmax)]
    return np.concatenate([(poles.imag + k * poles.real) / (2.0 * np.pi) for k in np.linspace(-2.0, 2.0, 9)])
