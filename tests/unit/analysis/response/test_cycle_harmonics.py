"""What varies over a mesh cycle as a curve, in the forced response: Fourier coefficients, and against the transient."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.response.cycle_harmonics import (
    HIGHEST,
    harmonics_of_pieces,
    harmonics_of_pulse,
    strong,
    that_matter,
)
from rotorgear.errors import AnalysisError
from tests.models import spur_pair

MESH = 24 * 1500.0 / 60.0


def sampled(x: np.ndarray) -> np.ndarray:
    return 2.0 * np.fft.rfft(x)[1 : HIGHEST + 1] / x.size


def test_coefficients_of_straight_pieces_are_those_of_their_samples() -> None:
    pieces = ((0.0, 1.2, 0.9), (0.3, 1.4, 1.4), (0.55, 0.8, 1.2))
    u = (np.arange(200_000) + 0.5) / 200_000
    x = np.piecewise(
        u,
        [u < 0.3, (u >= 0.3) & (u < 0.55), u >= 0.55],
        [lambda s: 1.2 - s, lambda s: 1.4 + 0.0 * s, lambda s: 0.8 + 0.4 * (s - 0.55) / 0.45],
    )
    turn = np.exp(-1j * np.pi * np.arange(1, HIGHEST + 1) / u.size)  # the samples stand in the middle of their strips
    assert harmonics_of_pieces(pieces)[:HIGHEST] == pytest.approx(sampled(x) / x.mean() * turn, abs=1e-8)


def test_coefficients_of_a_pulse_are_those_of_its_samples() -> None:
    u = np.arange(200_000) / 200_000
    late = (u - 0.4) % 1.0
    x = np.where(late < 0.25, np.sin(np.pi * late / 0.25), 0.0)
    assert harmonics_of_pulse(0.25, 0.4)[:HIGHEST] == pytest.approx(sampled(x), abs=1e-8)


def test_weak_harmonics_do_not_count() -> None:
    assert strong(np.array([1.0, 0.001, 0.5j])) == ([(1, 1.0), (3, 0.5j)], pytest.approx(0.001))


@pytest.mark.parametrize(
    "mesh",
    [
        {"stiffness": {"mean": "3e8 N/m", "amplitudes": [0.004, 0.002], "phases": ["30 deg", "100 deg"]}},
        {"corner_impact": {"force": "40 N", "duration": 0.3, "at": 0.2}},
        {"stiffness": [float(k) for k in 3e8 * (1.0 + 0.004 * np.array([0.0, 1.0, 0.4, -0.5, -1.0, 0.6]))]},
    ],
    ids=["series", "impact", "list"],
)
@pytest.mark.parametrize("pinion_drives", [True, pytest.param(False, marks=pytest.mark.long)])
def test_the_response_is_that_of_the_transient(mesh: dict[str, Any], pinion_drives: bool) -> None:
    changes = {f"meshes__pair__{key}": value for key, value in mesh.items()}
    if not pinion_drives:
        changes |= {
            "operation__input_shaft": "two",
            "operation__output_shaft": "one",
            "operation__speed": "1000 rpm",
            "operation__torque": "300 N m",
        }
    model = spur_pair(meshes__pair__transmission_error=[], **changes)
    run = rg.transient(
        model, method="exponential", discard=0.3, time=0.05, steps=1200, records=240, error_estimate=False
    )
    lines = 2.0 * np.fft.rfft(run.mesh_force[-7200:, 0]) / 7200.0  # 30 whole periods
    found = rg.response(model, speeds=["1500 rpm" if pinion_drives else "1000 rpm"])
    for number in (1, 2, 3):
        place = next((i for i, order in enumerate(found.orders) if order.endswith(f"pair {number}x")), None)
        if place is None:
            assert abs(lines[30 * number]) < 0.02 * np.abs(lines[30:]).max()
            continue
        assert abs(found.mesh_force[place, 0, 0]) == pytest.approx(abs(lines[30 * number]), rel=0.02)


def test_harmonics_are_kept_until_the_peak_to_peak_is_there() -> None:
    u = np.arange(256) / 256
    x = np.cos(2 * np.pi * u) + 0.3 * np.cos(6 * np.pi * u - 0.4) + 1e-4 * np.cos(18 * np.pi * u)
    numbers, _, weak, change = that_matter(x[:, None])
    assert numbers == [1, 3]
    assert weak == pytest.approx(1e-4)
    assert change == pytest.approx(abs(np.ptp(x - 1e-4 * np.cos(18 * np.pi * u)) / np.ptp(x) - 1.0))


def test_a_kink_needs_many_harmonics_and_what_is_left_out_is_said() -> None:
    u = np.arange(256) / 256
    x = np.maximum(np.abs(u - 0.5), 0.2)[:, None]
    numbers, major, weak, change = that_matter(x)
    size = np.abs(np.fft.rfft(x[:, 0]))
    left = np.delete(size, [0, *numbers])
    assert len(numbers) > 8
    assert weak == pytest.approx(left.max() / size[1:].max())
    assert 0.0 < change <= 0.005
    assert major == {n for n in numbers if size[n] > 0.004 * size[1:].max()}


def test_a_lone_blow_in_a_long_cycle_takes_the_orders_that_its_peak_to_peak_needs() -> None:
    """What one tooth of 34 does: hundreds of orders, most of them small."""
    u = 34.0 * np.arange(34 * 128) / (34 * 128)
    x = np.cos(2.0 * np.pi * u) + 8.0 * np.maximum(1.0 - np.abs(u - 10.0) / 0.7, 0.0)
    numbers, major, _, _ = that_matter(x[:, None])
    spectrum = np.fft.rfft(x)
    spectrum[[n for n in range(1, len(spectrum)) if n not in numbers]] = 0.0
    assert np.ptp(np.fft.irfft(spectrum, len(x))) == pytest.approx(np.ptp(x), rel=0.005)
    assert len(major) < len(numbers)


def test_the_first_orders_of_the_mesh_are_kept_beside_larger_ones_of_the_shaft() -> None:
    """The fourth order of the mesh is half a percent of its second, and a 2000th of what an odd tooth does."""
    u = 34.0 * np.arange(34 * 64) / (34 * 64)
    mesh = sum(a * np.cos(2.0 * np.pi * n * u) for n, a in ((1, 0.14), (2, 0.15), (3, 0.07), (4, 0.0008)))
    x = mesh + 1.6 * np.cos(2.0 * np.pi * u / 34.0)
    numbers, major, weak, _ = that_matter(x[:, None], 34)
    assert numbers == [1, 34, 68, 102, 136]
    assert 136 not in major
    assert weak == 0.0


def test_a_constant_has_no_harmonics_and_neither_has_its_rounding() -> None:
    assert that_matter(np.full((64, 2), 3.0)) == ([], set(), 0.0, 0.0)
    rounded = 3.0 + 4e-16 * np.random.default_rng(1).integers(-2, 3, (64, 2))
    assert that_matter(rounded) == ([], set(), 0.0, 0.0)
    assert that_matter(rounded - 3.0, sizes=np.full(2, 3.0)) == ([], set(), 0.0, 0.0)
    assert strong(harmonics_of_pieces(((0.0, 0.3, 0.3), (0.31, 0.3, 0.3), (0.77, 0.3, 0.3)))) == ([], 0.0)


@pytest.mark.parametrize("stiffness", ["iso", "2.1e8 N/m"])
def test_a_mesh_of_constant_stiffness_excites_nothing(stiffness: str) -> None:
    """The rounding of constant pieces was five orders of the mesh, with forces of 1e-12 N."""
    model = spur_pair(meshes__pair__transmission_error=[], meshes__pair__stiffness=stiffness)
    with pytest.raises(AnalysisError, match="nothing excites"):
        rg.response(model, points=5)


def test_a_constant_table_over_the_angle_excites_nothing_beside_an_unbalance() -> None:
    table = {"over": "angle", "places": [0.3, 1.1, 4.9], "components": ["force_y", "moment_x"]}
    values = [[100.0 / 3.0] * 3, [7.0 / 3.0] * 3]
    model = spur_pair(meshes__pair__transmission_error=[], meshes__pair__stiffness="2.1e8 N/m").with_(
        {
            "loads.weight": rg.Load(shaft="one", at="start", history=table | {"values": values}),
            "unbalances.u": rg.Unbalance(shaft="two", at="start", magnitude=1e-5),
        }
    )
    assert [order.split()[0] for order in rg.response(model, points=5).orders] == ["shaft"]
