"""Damping ratios of lines, such as those of ring-downs, teach the dampers of a model."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.rig.measured import joined
from rotorgear.analysis.rig.misfit import Misfit, first_fit
from rotorgear.analysis.rig.rig_model import RigModel
from rotorgear.model.numbers import free_numbers
from rotorgear.system.plan import Plan
from tests.unit.analysis.rig.test_compare_time import chain

FREE = (
    "couplings.*.stiffness.torsion, couplings.*.damping.torsion, supports.ground.damping.torsion, damping.modal_ratio"
)


def held_chain() -> rg.Model:
    """The chain of three inertias, held by a spring."""
    return chain(
        supports={
            "ground": {"shaft": "a", "at": "start", "stiffness": {"torsion": 400.0}, "damping": {"torsion": 0.02}},
        },
        damping={"modal_ratio": 0.004},
    )


def lines_of(model: rg.Model) -> list[rg.RigLine]:
    """Natural frequencies and damping ratios of the damped model, by its complex modes."""
    modes = rg.modal(model, speed=0.0, modes=9)
    swings = modes.frequency_hz > 0.0
    pairs = zip(modes.natural_frequency_hz[swings], modes.damping_ratio[swings], strict=True)
    return [rg.RigLine(float(f), "", 1e-5 * float(f), float(zeta)) for f, zeta in pairs]


def test_slopes_of_damping_ratios_are_those_of_differences() -> None:
    numbers = free_numbers(held_chain(), FREE + ", disks.jb.polar_inertia")
    model = RigModel(numbers, Plan(1), 500.0)
    x = 0.1 * np.random.default_rng(3).standard_normal(len(numbers.addresses))
    modes = model.modes(x)
    every = np.arange(len(modes.eigenvalues))
    slopes = model.damping_slopes(x, modes, every)
    for j in range(len(x)):
        step = 1e-4 * np.eye(len(x))[j]
        above, below = (np.log(model.modes(x + s).damping_ratio) for s in (step, -step))
        np.testing.assert_allclose(slopes[:, j], (above - below) / 2e-4, rtol=1e-5, atol=1e-6)


def test_slopes_of_a_misfit_of_two_campaigns_are_those_of_differences() -> None:
    """Lines with damping ratios at rest and of a heavier disk: the second campaign's modes stand behind the first's."""
    model = held_chain()
    heavy = {"disks.jb.polar_inertia": 1.5 * model.disks["jb"].polar_inertia}
    campaigns = [rg.Campaign(lines_of(model)), rg.Campaign(lines_of(model.with_(heavy)), changes=heavy)]
    free = "couplings.*.stiffness.torsion, couplings.k1.damping.torsion, supports.ground.damping.torsion"
    every, owner = joined([campaign.measured(model)[0] for campaign in campaigns])
    there = [RigModel(free_numbers(model.with_(one.changes), free), Plan(1), 500.0) for one in campaigns]
    misfit = Misfit(tuple(there), every, owner, 1e-3, 0.5, damping_noise=1e-2)
    x = 0.1 * np.random.default_rng(5).standard_normal(len(misfit.numbers.addresses))
    pairs = first_fit(misfit).pairs
    assert {every.lines[pair.line].damping_ratio is None for pair in pairs} == {False}
    here = misfit.beside(x, misfit.modes(x), pairs)
    slopes = misfit.linear(here).jacobian
    for j in range(len(x)):
        step = 1e-4 * np.eye(len(x))[j]
        above, below = (misfit.beside(x + s, misfit.modes(x + s), pairs).residual for s in (step, -step))
        np.testing.assert_allclose(slopes[:, j], (below - above) / 2e-4, rtol=1e-4, atol=1e-6)


def test_dampers_and_springs_are_found_from_ring_downs() -> None:
    truth = {
        "couplings.k0.stiffness.torsion": 1000.0,
        "couplings.k1.damping.torsion": 0.05,
        "supports.ground.damping.torsion": 0.03,
    }
    lines = lines_of(held_chain().with_(truth))
    free = "couplings.*.stiffness.torsion, couplings.k1.damping.torsion, supports.ground.damping.torsion"
    result = rg.update(held_chain(), lines, free=free, prior="60 %", damping_noise=1e-3)
    found = {row.address: row.factor for row in result.parameters}
    start = {
        "couplings.k0.stiffness.torsion": 900.0,
        "couplings.k1.damping.torsion": 0.02,
        "supports.ground.damping.torsion": 0.02,
    }
    for address, value in truth.items():
        assert found[address] * start[address] == pytest.approx(value, rel=0.01), address
    for line in result.lines:
        assert line.damping_after == pytest.approx(line.rig.damping_ratio, rel=5e-3)
    assert "damping" in result.text()
    # Where nothing that damps is free, damping is not compared.
    other = rg.update(held_chain(), lines, free="couplings.*.stiffness.torsion", prior="60 %")
    assert all(line.damping_after is None for line in other.lines)
