"""Frequency responses in an update: receptances against direct solutions, slopes against quotients, numbers given back."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.rig.measured import MeasuredFrf
from rotorgear.analysis.rig.receptance_model import ReceptanceModel
from rotorgear.analysis.rig.rig_model import RigModel
from rotorgear.errors import AnalysisError
from rotorgear.model.numbers import free_numbers
from rotorgear.system.plan import Plan
from tests.paths import MODELS

FREE = "meshes.*.stiffness, bearings.*.stiffness"
OUTPUTS = ("disks.generator:x", "gears.pinion:y", "gears.wheel:x")
INPUT = "gears.pinion:y"
HZ = np.linspace(5.0, 90.0, 80)
ZETA = 0.02


@pytest.fixture(scope="module")
def pair():
    return rg.load(MODELS / "geared_pair.toml")


def responses_of(model: rg.Model, noise: float = 0.0, speed: float | None = None) -> MeasuredFrf:
    """What a rig shows of a model: every frequency solved directly, on a mesh of its own."""
    found = rg.frf(model, HZ, inputs=[INPUT], outputs=OUTPUTS, modal_damping=ZETA, elements=1, speed=speed)
    H = found.receptance[:, :, 0].T
    random = np.random.default_rng(3)
    error = noise * (random.standard_normal(H.shape) + 1j * random.standard_normal(H.shape)) / np.sqrt(2.0)
    return MeasuredFrf(HZ, OUTPUTS, (INPUT,) * len(OUTPUTS), H * (1.0 + error))


@pytest.mark.parametrize("speed", [pytest.param(0.0, marks=pytest.mark.long), 157.0])
def test_receptances_and_slopes_are_those_of_the_whole_system(pair, speed):
    free = f"{FREE}, shafts.rotor_1.sections[1].outer_diameter, disks.generator.mass, bearings.rotor_1_left.damping"
    damped = pair.with_("bearings.rotor_1_left.damping", {"x": 2e4, "y": 3e4})
    numbers = free_numbers(damped, free)
    given = RigModel(numbers, Plan(2), 200.0, speed=speed)
    hz = HZ[::10]
    model = ReceptanceModel(given, hz, OUTPUTS, (INPUT,), ZETA)
    h = 1e-3
    slope_errors = []
    for phase in (1.0, 1.2, 1.4):
        x = 0.1 * np.sin(phase + np.arange(len(numbers.addresses)))
        here = model.look(x, given.modes(x))
        direct = rg.frf(
            numbers.at(x), hz, inputs=[INPUT], outputs=OUTPUTS, modal_damping=ZETA, elements=2, speed=speed or None
        )
        size = np.abs(direct.receptance).max(axis=0)
        assert np.max(np.abs(here.H - direct.receptance) / size) < 1e-7
        assert model.error(x, here) < 1e-7
        slopes = model.slopes(x, here)
        errors = []
        for j in (0, 5, 7) if speed else range(8):

            def at(side: float, x: np.ndarray = x, j: int = j) -> np.ndarray:
                point = x.copy()
                point[j] += side
                return model.look(point, given.modes(point)).H

            by_quotient = (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h)
            errors.append(np.abs(slopes[j] - by_quotient).max() / np.abs(by_quotient).max())
        slope_errors.append(errors)
    # At a point here and there rounding reaches a slope through the modal damping of soft modes, 1.1e-6 at the first one; a
    # wrong slope is wrong at all.
    assert np.median(slope_errors, axis=0).max() < 1e-6


def test_responses_alone_give_back_every_number_and_say_what_they_hold_out(pair):
    x = 0.2 * np.random.default_rng(7).standard_normal(5)
    rig = responses_of(free_numbers(pair, FREE).at(x), noise=0.05)
    result = rg.update(pair, frf=rig, free=FREE, prior="20 %", modal_damping=ZETA, elements=1)
    error = np.log([row.factor for row in result.parameters]) - x
    sigma = np.array([row.sigma for row in result.parameters])
    assert np.abs(error / sigma).max() < 3.5
    assert sigma.max() < 0.05
    assert 0.8 < result.chi_squared / result.measured_values < 1.1
    assert result.modal_solutions <= 20
    assert len(result.responses) == len(OUTPUTS)
    for row in result.responses:
        assert row.frac_before < 0.9
        assert min(row.frac_after, row.frac_held_out) > 0.98
    assert "predicts responses it has not seen better" in result.text().replace("\n", " ")


@pytest.mark.long
def test_a_damping_that_is_free_is_found_beside_the_stiffness(pair):
    damped = pair.with_("damping", {"modal_ratio": 0.01})
    rig = responses_of(pair.with_("damping", {"modal_ratio": 0.015}), noise=0.01)
    free = "damping.modal_ratio, meshes.*.stiffness"
    result = rg.update(damped, frf=rig, free=free, modal_damping=ZETA, frf_noise=0.01, elements=1)
    assert result.parameters[0].factor == pytest.approx(1.5, rel=0.02)
    assert result.parameters[1].factor == pytest.approx(1.0, abs=0.02)


def test_responses_beside_lines_at_a_speed_share_the_numbers_of_a_campaign(pair):
    soft = pair.with_("meshes.pair.stiffness", "1.2e8 N/m")
    modes = rg.modal(soft, speed="1500 rpm", fmax=45.0, elements=1)
    lines = [float(f) for f in modes.natural_frequency_hz[~modes.rigid]][:4]
    turning = rg.Campaign(lines, speed="1500 rpm", frf=responses_of(soft, speed=157.0796), name="turning")
    result = rg.update(pair, campaigns=[turning], free="meshes.*.stiffness", prior=0.4, modal_damping=ZETA, elements=1)
    assert result.parameters[0].factor == pytest.approx(1.2e8 / 1e8, rel=2e-2)
    assert len(result.lines) == 4
    assert len(result.responses) == 3


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"modal_damping": 1.5}, "modal damping"),
        ({"frf_noise": 0.0}, "frf_noise"),
        ({"frf": "dead"}, "is 0 or no number at 5 Hz and 79 more"),
        ({"frf": "nowhere"}, "is no place"),
        ({"campaigns": [rg.Campaign([10.0])]}, "campaigns have their own"),
    ],
)
def test_responses_that_can_not_be_compared_are_refused_in_a_sentence(pair, change, words):
    flat = MeasuredFrf(HZ, (INPUT,), (INPUT,), np.full((1, len(HZ)), 1e-8 + 0j))
    given = {"dead": replace(flat, receptance=0.0 * flat.receptance), "nowhere": replace(flat, responses=("roof:x",))}
    if isinstance(change.get("frf"), str):
        change = {"frf": given[change["frf"]]}
    with pytest.raises(AnalysisError, match=words):
        rg.update(pair, **({"frf": flat, "modal_damping": ZETA, "elements": 1, "free": FREE} | change))


def test_a_model_that_nothing_damps_is_not_compared_with_responses(pair):
    bare = pair.with_({f"bearings.{name}.damping": None for name in pair.bearings})
    flat = MeasuredFrf(HZ, (INPUT,), (INPUT,), np.full((1, len(HZ)), 1e-8 + 0j))
    with pytest.raises(AnalysisError, match="nothing damps the model"):
        rg.update(bare, frf=flat, free=FREE, elements=1)
