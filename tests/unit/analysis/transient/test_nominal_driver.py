"""Meshes whose file names the driver: the same motion, told from the flanks that the file calls the driving ones."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from tests.models import spur_pair

_OPENS = [{"harmonic": 1, "amplitude": "4 um", "phase": "20 deg"}]
_CLOSES = [{"harmonic": 1, "amplitude": "4 um", "phase": "200 deg"}]


def braked(driver: str | None, error: list[dict[str, Any]], **changes: Any) -> rg.Model:
    """The pinion is held back by 80 N m net, so the wheel drives it."""
    return spur_pair(
        operation__torque=None,
        operation__output_shaft=None,
        meshes__pair__transmission_error=error,
        meshes__pair__nominal_driver=driver,
        loads={
            "push": {"shaft": "one", "kind": "input", "torque": "20 N m"},
            "brake": {"shaft": "one", "kind": "output", "torque": "100 N m"},
            "drive": {"shaft": "two", "kind": "input"},
        },
        **({"meshes__pair__phase": "0 deg"} | changes),
    )


@pytest.mark.parametrize("backlash", [None, "30 um", "0 um"])
def test_a_transient_is_the_same_motion_with_the_signs_of_the_other_flanks(backlash: str | None) -> None:
    run: dict[str, Any] = {"time": 0.02, "discard": 0.02, "steps": 200}
    plain = rg.transient(braked(None, _CLOSES, meshes__pair__backlash=backlash), **run)
    named = rg.transient(braked("pinion", _OPENS, meshes__pair__backlash=backlash), **run)
    assert plain.mesh_force.min() > 0.0 > named.mesh_force.max()
    assert named.warnings == plain.warnings
    np.testing.assert_allclose(named.mesh_force, -plain.mesh_force, rtol=1e-6)
    if backlash is not None:
        assert named.contact_time[0].tolist() == pytest.approx([0.0, 0.0, 1.0])
    assert np.isnan(named.dynamic_factor[0])


def test_the_gear_named_that_drives_anyway_changes_nothing() -> None:
    run: dict[str, Any] = {"time": 0.01, "steps": 200}
    plain, named = (rg.transient(braked(driver, _OPENS), **run) for driver in (None, "gear"))
    np.testing.assert_array_equal(named.mesh_force, plain.mesh_force)


def test_a_response_has_the_error_of_the_flanks_that_the_file_names() -> None:
    speeds = [100.0, 150.0, 200.0, 300.0]
    plain = rg.response(braked(None, _CLOSES), speeds=speeds)
    named = rg.response(braked("pinion", _OPENS), speeds=speeds)
    np.testing.assert_allclose(named.mesh_force, plain.mesh_force, rtol=1e-9)


def test_phases_that_follow_from_the_teeth_are_those_of_the_named_flanks() -> None:
    # The same flanks touch in both, so a file that leaves the phases open has the same motion as one that lets the gear drive.
    loaded = braked("pinion", [], meshes__pair__phase=None)
    phases = [
        part.law.phase for model in (loaded, spur_pair(meshes__pair__transmission_error=[])) for part in _parts(model)
    ]
    assert phases[0] == pytest.approx(phases[1])


def _parts(model: rg.Model) -> list[Any]:
    from rotorgear.solvers.time.local_system import Rotation
    from rotorgear.system.local import local_model
    from rotorgear.system.system import System

    return [part for part in local_model(System(model), Rotation.constant(1.0), 1.0).parts if part.is_mesh]
