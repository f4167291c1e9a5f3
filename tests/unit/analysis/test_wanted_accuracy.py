"""A wanted accuracy is reached, by the estimate that the result states, or a warning and the status say that it is not."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.errors import AnalysisError
from tests.overhung import overhung_disk
from tests.paths import MODELS


def undamped() -> rg.Model:
    """Its modes as sensors and scatter take them."""
    return overhung_disk().with_({f"bearings.{name}.damping": {"radial": 0.0} for name in "ab"})


def backlash(**more: Any) -> rg.Model:
    return rg.load(MODELS / "backlash_pair.toml").with_(more)


PLACE = ["disks.d:y"]
# What the accuracy of each verb is held to.
ESTIMATED: dict[str, tuple[Callable[[float], Any], Callable[[Any], Any]]] = {
    "modal": (lambda a: rg.modal(overhung_disk(), modes=6, accuracy=a), lambda r: r.error_estimate),
    "modal at speed": (
        lambda a: rg.modal(overhung_disk(), modes=6, speed=800.0, accuracy=a),
        lambda r: r.error_estimate,
    ),
    "campbell": (
        lambda a: rg.campbell(overhung_disk(), modes=4, points=3, accuracy=a),
        lambda r: r.error_estimate,
    ),
    "critical": (
        lambda a: rg.critical(overhung_disk(), stop=1500.0, accuracy=a),
        lambda r: [each.error_estimate for each in r.speeds],
    ),
    "static": (lambda a: rg.static(overhung_disk(), accuracy=a), lambda r: r.error_estimate),
    "response": (lambda a: rg.response(overhung_disk(), points=3, accuracy=a), lambda r: r.error_estimate),
    "frf": (
        lambda a: rg.frf(
            overhung_disk(),
            inputs=PLACE,
            outputs=PLACE,
            fmax=300.0,
            points=20,
            modal_damping=0.01,
            accuracy=a,
        ),
        lambda r: r.error_estimate,
    ),
    "state_space": (
        lambda a: rg.state_space(overhung_disk(), inputs=PLACE, outputs=PLACE, fmax=300.0, accuracy=a),
        lambda r: [r.reduction_error, r.error_estimate],
    ),
    "transient": (
        lambda a: rg.transient(backlash(**{"operation.torque": 500.0}), time=4e-4, discard=2e-4, accuracy=a),
        lambda r: r.error_estimate,
    ),
    "orbits": (
        lambda a: rg.orbits(
            backlash(), {"operation.speed": "4000 rpm:4001 rpm"}, method="harmonic balance", points=4, accuracy=a
        ),
        lambda r: r.error_estimate,
    ),
}


# Long: orbits that try for as many harmonics as there may be.
WANTED = [
    pytest.param(verb, wanted, marks=[pytest.mark.long] if (verb, wanted) == ("orbits", 1e-8) else [])
    for verb in ESTIMATED
    for wanted in (1e-4, 1e-8)
]


@pytest.mark.parametrize(("verb", "wanted"), WANTED)
def test_a_wanted_accuracy_is_reached_or_said_to_be_missed(verb: str, wanted: float) -> None:
    run, estimate_of = ESTIMATED[verb]
    result = run(wanted)
    estimate = float(np.max(estimate_of(result)))
    said = [warning for warning in result.warnings if "not reached" in warning]
    assert result.to_dict()["status"] == result.status
    if result.status == "success":
        assert estimate <= wanted
        assert not said
    else:
        assert estimate > wanted
        assert said == [result.status]
        assert result.status.startswith(f"accuracy {wanted:g} not reached")


@pytest.mark.parametrize("wanted", [0.0, -1e-3, 1.0, 1e-14, float("nan")])
@pytest.mark.parametrize("verb", ESTIMATED)
def test_an_accuracy_that_is_none_is_refused_with_its_bounds(verb: str, wanted: float) -> None:
    with pytest.raises(AnalysisError, match="the accuracy must lie between"):
        ESTIMATED[verb][0](wanted)


MODES_OF: dict[str, tuple[float | None, Callable[[float], Any]]] = {
    "sensors": (None, lambda a: rg.sensors(undamped(), count=5, modes=5, accuracy=a).mode_hz),
    "scatter": (
        800.0,
        lambda a: [
            band.nominal_hz
            for band in rg.scatter(undamped(), "bearings.*.stiffness", sigma=0.1, samples=4, modes=4, accuracy=a).bands
        ],
    ),
}


@pytest.mark.parametrize("verb", MODES_OF)
def test_verbs_over_modes_solve_them_on_the_mesh_of_that_accuracy(verb: str) -> None:
    speed, frequencies = MODES_OF[verb]
    fine = rg.modal(undamped(), modes=8, speed=speed, accuracy=1e-10)
    elastic = fine.frequency_hz[~fine.rigid]
    found = np.asarray(frequencies(1e-8))
    assert found == pytest.approx(elastic[: len(found)], rel=1e-8)
    for wanted in (0.0, 1e-14):
        with pytest.raises(AnalysisError, match="the accuracy must"):
            frequencies(wanted)
