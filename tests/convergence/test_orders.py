"""Orders of convergence of the basic element, measured against exact solutions of the continuous shaft (cases A1 and A2)."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from tests.paths import ROOT, VALIDATION
from validation.case import Expectation, read_case

ENDS = ("pinned_pinned", "clamped_free", "free_free", "clamped_clamped", "clamped_pinned")


def exact(case: str, model: str, mode: str) -> float:
    """The exact frequency in Hz of a model and mode, from expected.csv."""
    line: Expectation = next(
        line
        for line in read_case(case).expectations
        if (line.model, line.mode, line.quantity) == (model, mode, "frequency_hz")
    )
    return line.number


def lowest(case: str, model: str, elements: int) -> float:
    """The lowest elastic frequency in Hz."""
    result = rg.modal(rg.load(VALIDATION / case / model), elements=elements, modes=6, error_estimate=False)
    return float(result.frequency_hz[~result.rigid][0])


def order(case: str, model: str, mode: str, coarse: int) -> float:
    """Order of the lowest frequency from `coarse` to twice as many elements."""
    true = exact(case, model, mode)
    errors = [lowest(case, model, count) / true - 1.0 for count in (coarse, 2 * coarse)]
    assert min(errors) > 0.0, "frequencies of a conforming element come from above"
    return float(np.log2(errors[0] / errors[1]))


@pytest.mark.parametrize("ends", ENDS)
def test_slender_bending_converges_with_nearly_order_4_while_elements_are_longer_than_thick(ends: str) -> None:
    assert 3.4 <= order("timoshenko_beam", f"{ends}_d20.toml", "1+2", 5) <= 4.1


@pytest.mark.parametrize("ends", ENDS)
def test_thick_bending_converges_with_order_2(ends: str) -> None:
    assert order("timoshenko_beam", f"{ends}_d200.toml", "1+2", 20) == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("ends", ENDS)
def test_slender_bending_falls_back_to_order_2_once_elements_are_shorter_than_thick(ends: str) -> None:
    assert order("timoshenko_beam", f"{ends}_d20.toml", "1+2", 160) == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("model", sorted({line.model for line in read_case("axial_and_torsional_bars").expectations}))
def test_axial_and_torsional_motion_converge_with_order_2(model: str) -> None:
    assert order("axial_and_torsional_bars", model, "1", 20) == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize(("model", "count"), [("pinned_pinned_d200.toml", 20), ("pinned_pinned_d20.toml", 5)])
def test_the_error_estimate_of_a_mode_is_its_true_error_in_both_ranges_of_the_order(model: str, count: int) -> None:
    result = rg.modal(rg.load(VALIDATION / "timoshenko_beam" / model), elements=count, modes=2)
    true = result.frequency_hz / exact("timoshenko_beam", model, "1+2") - 1.0
    np.testing.assert_allclose(result.error_estimate, true, rtol=0.1)


@pytest.mark.parametrize("ends", ENDS)
def test_an_asked_accuracy_is_kept_by_every_mode_that_was_asked_for(ends: str) -> None:
    model = rg.load(VALIDATION / "timoshenko_beam" / f"{ends}_d20.toml")
    true = np.repeat([exact("timoshenko_beam", f"{ends}_d20.toml", f"{k}+{k + 1}") for k in (1, 3, 5, 7, 9)], 2)
    for accuracy in (1e-3, 1e-5, 1e-7):
        result = rg.modal(model, modes=14 if ends == "free_free" else 10, accuracy=accuracy)
        error = np.abs(result.frequency_hz[~result.rigid] / true - 1.0)
        assert error.max() <= accuracy


def test_the_printed_mesh_of_the_geared_pair_lies_up_to_16_percent_off_the_converged_rotor() -> None:
    model = rg.load(ROOT / "models" / "geared_pair.toml")
    coarse, fine = (
        rg.modal(model, speed="1500 rpm", modes=14, elements=count, error_estimate=False).frequency_hz[1:]
        for count in (1, 12)
    )
    off = coarse / fine - 1.0
    assert off.max() == pytest.approx(0.157, abs=0.002)
    assert off.min() == pytest.approx(0.0148, abs=0.0005)
