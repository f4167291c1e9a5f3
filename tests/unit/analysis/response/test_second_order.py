"""The size of what a response leaves out of loaded teeth, against the nonlinear oscillator solved to the end."""

from __future__ import annotations

import math

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.model.layout.mesh_layout import MeshLayout
from tests.models import lumped_gear
from tests.unit.analysis.written_maps import ripple, written

K = 4e8
BASE = 0.06
RADIUS = 0.15
J = 0.02
TORQUE = 1000.0
FORCE = TORQUE / BASE
# Both gears have the inertia of `lumped_gear`: 1/M = r_1^2/J + r_2^2/J along the line of action.
M_E = J / (BASE**2 + RADIUS**2)
W_N = math.sqrt(K / M_E)
SAMPLES = 64


def pair() -> rg.Model:
    return rg.Model(
        motions=["torsion"],
        operation={"input_shaft": "1", "output_shaft": "2", "speed": 100.0, "torque": TORQUE},
        shafts={"1": {"position": [0.0, 0.0]}, "2": {"position": [0.228, 0.0]}},
        gears={"p": lumped_gear("1", BASE, teeth=24), "g": lumped_gear("2", RADIUS, teeth=60)},
        meshes={"m": {"pinion": "p", "gear": "g", "stiffness": K}},
    )


def oscillator(a: float, zeta: float, w: float, phase: float) -> np.ndarray:
    """Coefficients of Re(c_n e^{i n w t}), n from 0, of M (x'' + 2 zeta W x') + k (1 + a cos(w t + phase)) x = F_0."""
    angle = 2.0 * np.pi * np.arange(SAMPLES) / SAMPLES
    n = np.arange(SAMPLES // 2 + 1)
    factor = -M_E * (n * w) ** 2 + 2j * zeta * W_N * M_E * n * w
    inertia = np.fft.irfft(factor[:, None] * np.fft.rfft(np.eye(SAMPLES), axis=0), SAMPLES, axis=0)
    x = np.linalg.solve(inertia + np.diag(K * (1.0 + a * np.cos(angle + phase))), np.full(SAMPLES, FORCE))
    assert x.min() > 0.0
    return np.asarray(2.0 * np.fft.rfft(x) / SAMPLES)


@pytest.mark.parametrize(("q", "a"), [(0.5, 0.05), (0.9, 0.02), (1.0, 0.03), (1.05, 0.05), (2.0, 0.05), (2.0, 0.2)])
def test_what_is_left_out_is_of_the_size_that_is_printed(q: float, a: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(MeshLayout, "contact_map", written(ripple(K, a)))
    model = pair()
    zeta = 0.05
    w = q * W_N
    phase = model.torque_flow().phases["m"]
    assert phase is not None
    result = rg.response(model, speeds=[w / 24.0], modal_damping=zeta)
    peak = next(peak for peak in result.largest if peak.quantity == "approach")
    n = int(result.orders[peak.order].removeprefix("mesh m ").removesuffix("x"))
    exact = oscillator(a, zeta, w, phase)
    missing = abs(exact[n] - result.approach[peak.order, 0, 0])
    assert peak.amplitude == pytest.approx(abs(result.approach[peak.order, 0, 0]))
    assert not peak.teeth_part
    assert peak.left_out is not None
    assert 0.5 < missing / peak.left_out < 2.0


def test_where_teeth_part_it_says_so_and_gives_no_size(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(MeshLayout, "contact_map", written(ripple(K, 0.2)))
    result = rg.response(pair(), speeds=[W_N / 24.0], modal_damping=0.02)
    peak = next(peak for peak in result.largest if peak.quantity == "approach")
    assert peak.teeth_part
    assert peak.left_out is None
    assert "teeth part" in str(result)


def test_at_a_crawl_nothing_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(MeshLayout, "contact_map", written(ripple(K, 0.2)))
    result = rg.response(pair(), speeds=[1e-4 * W_N / 24.0], modal_damping=0.05)
    for peak in result.largest:
        if peak.quantity == "approach":
            assert peak.left_out is not None
            assert peak.left_out < 1e-3 * peak.amplitude
