"""Periodic motions of planets that go round, as seen from their carrier."""

from __future__ import annotations

import re

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.common.discretise import plan_in_time
from rotorgear.errors import AnalysisError
from rotorgear.solvers.time.local_system import Rotation
from rotorgear.system.local import local_model
from rotorgear.system.system import flow_system
from tests.planetary import GROUND, eigenvalues, springs
from tests.unit.analysis.transient.test_planets import stage

RPM = np.pi / 30.0
LOSS = 5e-5


def damped_stage() -> str:
    """Three planets on springs to the ground without preferred directions; all springs but those of the meshes are damped."""
    text = stage(150.0, 3, loss=LOSS, speed=2000.0 * RPM, ground=GROUND)
    for values in GROUND.values():
        losses = {name: LOSS * value for name, value in values.items()}
        text = text.replace(springs(values), f"{springs(values)}\ndamping = {springs(losses)}")
    return text


def test_motions_repeat_with_the_meshes_and_decay_as_linear_ones_do() -> None:
    """Where teeth stay closed multipliers are exp(s T) of the linear system in axes of the carrier, without the train's turn."""
    model = rg.loads(damped_stage())
    found = rg.orbits(
        model, {"operation.speed": "2000 rpm:2020 rpm"}, harmonics=2, instants=32, points=2, method="harmonic balance"
    )
    assert found.order == pytest.approx(98.0 * 28.0 / 126.0, rel=1e-12)
    speed = 2000.0 * RPM
    system = flow_system(model, plan_in_time(None)).seen_from_carrier()
    local = local_model(system, Rotation.constant(speed), speed).local
    D = local.damping_about.toarray() + speed * local.G.toarray()
    s = eigenvalues(local.M.toarray(), D, local.stiffness_about.toarray())
    own = np.sort(np.abs(np.exp(s * 2.0 * np.pi / (found.order * speed))))[::-1]
    assert own[:2] == pytest.approx(1.0, abs=1e-4)  # of the turn of the train: where it is, and another speed
    mine = np.sort(np.abs(found.multipliers[0]))[::-1]
    assert mine == pytest.approx(own[2 : 2 + len(mine)], rel=1e-4)
    swept = rg.sweep(model, {"operation.speed": ["2000 rpm"]}, discard=100, sample=4, exponents=0, steps=400)
    assert found.peak_to_peak_approach[0] == pytest.approx(swept.peak_to_peak_approach[0, 0], rel=1e-4)
    assert any("axes that turn with the carrier" in fact for fact in found.left_out)


@pytest.mark.parametrize(
    ("change", "why"),
    [
        (
            lambda text: text.replace("[supports.sun]", "[damping]\nmodal_ratio = 0.01\n[supports.sun]"),
            "damping.modal_ratio damps",
        ),
        (
            lambda text: text.replace('"y": 4e7', '"y": 5e7').replace("y = 40000000.0", "y = 5e7"),
            "supports.sun has preferred",
        ),
        (
            lambda text: text.replace("[shafts.sun]", "gravity = [0, -9.81, 0]\n[shafts.sun]", 1),
            "what is steady of the loads acts",
        ),
        (
            lambda text: text + '\n[unbalances.sun]\nshaft = "sun"\nat = 0\nmagnitude = 1e-5\n',
            "unbalances.sun acts across its axis",
        ),
    ],
)
def test_what_is_at_rest_beside_planets_is_refused_by_name(change, why: str) -> None:
    with pytest.raises(AnalysisError, match=re.escape(f"as seen from their carrier alone, and {why}")):
        rg.orbits(rg.loads(change(damped_stage())), {"operation.speed": "2000 rpm:2020 rpm"})
