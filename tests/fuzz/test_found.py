"""What mutants brought to light, each with its seed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.response.run_up import choose_method
from rotorgear.analysis.static.solve import equilibrate
from rotorgear.errors import AnalysisError, ConvergenceError, RotorgearError
from rotorgear.gears.loaded.loaded_contact import PositionContact, solve_contact
from rotorgear.system.system import System
from tests.fuzz.runner import mutant
from tests.paths import ROOT


def model_of(name: str, seed: int, folder: Path) -> rg.Model:
    path = folder / "mutant.toml"
    path.write_text(mutant(seed, name)[1], encoding="utf-8")
    return rg.load(path)


def test_inertias_of_26_decades_leave_any_basis_of_the_rigid_motions(tmp_path: Path) -> None:
    found = rg.modal(model_of("flexible_pair", 10025, tmp_path), modes=12)
    assert found.rigid.sum() >= 9


def test_places_on_a_shaft_without_length_are_one(tmp_path: Path) -> None:
    found = rg.check(model_of("marine_double_reduction", 10934, tmp_path))
    assert any("gears.hp_pinion at 9.99988867e-321 m taken to" in warning for warning in found.warnings)


def test_few_speeds_are_solved_directly_however_many_orders_there_are() -> None:
    assert choose_method("auto", 5, 87, 300)[0] == "direct"  # seed 10235: 12 CPU s in place of 63
    assert choose_method("auto", 221, 87, 300)[0] == "modal"
    assert choose_method("modal", 5, 87, 300)[0] == "modal"


@pytest.mark.parametrize("name", ["jeffcott", "helical_pair"])
def test_explicit_steps_that_would_not_come_through_are_refused(name: str) -> None:  # seeds 10488 and 5378
    with pytest.raises(
        AnalysisError, match=r"would take about .* evaluations: explicit steps follow the fastest motion"
    ):
        rg.transient(rg.load(ROOT / "models" / f"{name}.toml"), method="explicit")


def test_a_reduced_system_that_is_singular_is_told(tmp_path: Path) -> None:
    model = model_of("geared_pair", 20003, tmp_path)
    place = [f"disks.{next(iter(model.disks))}:y"]
    # Whether it is singular to the last digit hangs on the rounding of the processor: it is told then, and right else.
    found: rg.StateSpace | None = None
    told = ""
    try:
        found = rg.state_space(model, inputs=place, outputs=place, fmax=500.0, elements=1)
    except ConvergenceError as refusal:
        told = str(refusal)
    if found is None:
        assert "the reduced system is singular at" in told
    else:
        hz = np.linspace(50.0, 500.0, 10)
        direct = rg.frf(model, hz, inputs=place, outputs=place, elements=1).receptance
        assert np.abs(found.receptance(hz) - direct).max() < 1e-3 * np.abs(direct).max()
    with pytest.raises(RotorgearError, match="dynamic stiffness is singular at a frequency that counts"):
        rg.sweep(model, {"operation.speed": [model.operation.speed]}, discard=2, sample=9)


def test_modes_up_to_a_frequency_of_300_digits_are_refused_as_too_many() -> None:  # seed 40018
    with pytest.raises(AnalysisError, match="modes lie below 1e\\+300 Hz, more than"):
        rg.campbell(rg.load(ROOT / "models" / "geared_pair.toml"), fmax=1e300)


def test_more_modes_than_lie_below_a_frequency_are_those_below_it() -> None:  # seeds 102328 and 103338
    pair = rg.load(ROOT / "models" / "torsion_chain.toml")
    first = rg.modal(pair, modes=2)
    both = rg.modal(pair, fmax=float(1.01 * first.frequency_hz[-1]), modes=12)
    assert np.allclose(both.frequency_hz, first.frequency_hz, rtol=1e-3)
    endless = rg.modal(pair, fmax=1e300, modes=2, elements=3, error_estimate=False)
    assert np.allclose(endless.frequency_hz, rg.modal(pair, modes=2, elements=3).frequency_hz, rtol=1e-12)


@pytest.mark.parametrize("seed", [40023, 40063])  # modal: a minute and more
def test_a_film_that_carries_nothing_is_in_equilibrium_where_it_is_centred(seed: int, tmp_path: Path) -> None:
    model = model_of("geared_pair", seed, tmp_path)
    assert model.operation is not None
    speed = model.operation.speed
    [law] = equilibrate(System(model, state=model.torque_flow(speed).of_kind("static")), speed).laws
    assert np.abs(law.force).max() < 1e-9
    assert np.hypot(*law.d) < 1e-12 * law.part.law.clearance


def test_teeth_under_a_load_that_is_lost_in_their_gaps_are_refused() -> None:  # seed 101511: a torque of 2e-27 N m
    slices = PositionContact(
        gap=np.array([1.001e-5, 1e-5]),
        compliance=np.array([[2e-9, 1e-9], [1e-9, 2e-9]]),
        length=np.full(2, 1e-3),
        local=np.full(2, 1.4e-12),
        log_width=np.full((2, 2), np.log(2e-4)),
        radius=np.full(2, 1e-2),
        modulus=2e11,
    )
    with pytest.raises(ConvergenceError, match="by less than the rounding of their gaps; give a larger torque"):
        solve_contact(slices, 1e-26)
    assert solve_contact(slices, 1.0).force.sum() == pytest.approx(1.0)
