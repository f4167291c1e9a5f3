"""The error estimate of a mode against its true error, where the estimate is not just an energy: lumped mass, damping, spin."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import rotorgear as rg

HELD = {
    "pinned": {"a": (0.0, ["x", "y", "z", "torsion"]), "b": (1.0, ["x", "y"])},
    "clamped": {"a": (0.0, ["all"])},
    "clamped at both ends": {"a": (0.0, ["all"]), "b": (1.0, ["all"])},
}


def beam(held: str, rayleigh_alpha: float = 0.0, **shaft: Any) -> rg.Model:
    """A steel shaft of 1 m and 50 mm."""
    supports = {name: {"shaft": "s", "at": z, "fixed": fixed} for name, (z, fixed) in HELD[held].items()}
    return rg.Model(
        shafts={"s": {"sections": [{"length": 1.0, "outer_diameter": 0.05}], **shaft}},
        supports=supports,
        operation={"input_shaft": "s"},
        damping={"rayleigh_alpha": rayleigh_alpha},
    )


@pytest.mark.parametrize("held", HELD)
@pytest.mark.parametrize("elements", [8, 16, 32])
def test_the_estimate_of_lumped_mass_is_within_a_factor_of_two(held: str, elements: int) -> None:
    exact = rg.modal(beam(held), modes=12, accuracy=1e-9).frequency_hz
    result = rg.modal(beam(held, mass_matrix="lumped"), modes=12, elements=elements)
    error = np.abs(result.frequency_hz / exact - 1.0)
    told = np.isfinite(result.error_estimate) & (error < 0.1)
    assert told.sum() >= 10
    ratio = result.error_estimate[told] / error[told]
    assert np.all((ratio > 0.5) & (ratio < 2.0)), ratio


@pytest.mark.parametrize(
    ("speed", "alpha", "internal"),
    [(0.0, 500.0, 0.0), (100.0, 5000.0, 0.0), (300.0, 0.0, 1e-5), (500.0, 200.0, 2e-5), (3000.0, 0.0, 0.0)],
)
@pytest.mark.parametrize("held", ["pinned", "clamped"])
def test_the_estimate_of_damped_and_gyroscopic_modes_is_within_a_factor_of_three(
    held: str, speed: float, alpha: float, internal: float
) -> None:
    model = beam(held, alpha, internal_damping=internal)
    exact = rg.modal(model, speed=speed, modes=10, accuracy=1e-10).eigenvalues
    result = rg.modal(model, speed=speed, modes=6, elements=4)
    error = np.array([np.min(np.abs(exact - s)) / np.abs(s) for s in result.eigenvalues])
    ratio = result.error_estimate / error
    assert np.all((ratio > 1 / 3) & (ratio < 3)), ratio


@pytest.mark.parametrize("held", HELD)
def test_a_lumped_shaft_is_refined_until_no_mode_is_missing(held: str) -> None:
    exact = rg.modal(beam(held), modes=8, accuracy=1e-6).frequency_hz
    result = rg.modal(beam(held, mass_matrix="lumped"), modes=8)
    np.testing.assert_allclose(result.frequency_hz, exact, rtol=1e-3)


def test_no_mode_below_the_limit_is_an_empty_result() -> None:
    assert len(rg.modal(beam("pinned"), fmax=50.0)) == 0


def test_more_modes_than_anyone_reads_are_refused_before_they_are_sought() -> None:
    with pytest.raises(rg.AnalysisError, match="modes lie below 1e\\+08 Hz"):
        rg.modal(beam("pinned"), fmax=1e8)
    with pytest.raises(rg.AnalysisError, match="elements on one shaft"):
        rg.modal(beam("pinned"), elements=10**8)


def test_damping_that_gathers_modes_without_end_is_named() -> None:
    model = beam("pinned", internal_damping=1e-4)
    assert any("without end at 1592 Hz" in line for line in rg.modal(model, speed=0.0, modes=24).warnings)


@pytest.mark.long  # it tries finer meshes first
def test_an_accuracy_of_modes_that_gather_without_end_is_refused() -> None:
    model = beam("pinned", internal_damping=1e-4)
    with pytest.raises(rg.AnalysisError, match="without end at 1592 Hz"):
        rg.modal(model, speed=0.0, modes=14, accuracy=1e-10)


@pytest.mark.parametrize("elements", [2, 4, 8])
def test_a_coarse_free_beam_is_estimated_although_its_elements_hide_the_error_from_the_next_order(
    elements: int,
) -> None:
    """With two elements the error of the first mode shows four orders up, not in the next ones."""
    model = rg.Model(shafts={"s": {"sections": [{"length": 1.0, "outer_diameter": 0.02}]}}, motions=["bending"])
    exact = rg.modal(model, modes=14, accuracy=1e-10)
    result = rg.modal(model, modes=14, elements=elements)
    told = ~result.rigid & np.isfinite(result.error_estimate)
    count = len(result)
    error = np.abs(result.frequency_hz / np.where(told, exact.frequency_hz[:count], 1.0) - 1.0)[told]
    ratio = result.error_estimate[told] / error
    assert told.sum() >= 2
    assert np.all((ratio > 0.5) & (ratio < 2.0)), ratio
