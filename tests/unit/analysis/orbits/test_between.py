"""Systems between exact ones: polynomials where numbers are smooth, assembly where they are not."""

from __future__ import annotations

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.analysis.orbits.between import between
from rotorgear.analysis.orbits.family import SystemFamily, range_of
from rotorgear.errors import ConvergenceError, ModelError
from tests.paths import MODELS
from validation.studies.dead_zone import HALF_BACKLASH, STIFFNESS, TEETH, DeadZone


def _family(name: str, address: str, ends: str, excite: str | None = None) -> SystemFamily:
    model = rg.load(MODELS / name)
    return SystemFamily(model, [range_of(model, address, ends)], excite, None)


def test_constant_power_over_speed_is_a_polynomial_to_rounding() -> None:
    family = _family("split_torque.toml", "operation.speed", "3000 rpm:20000 rpm", "stage_2a")
    share = 0.371
    near = family.system([share])
    exact = family._exact([share])
    assert family._through is not None
    # Torques go with 1/speed, the ramp of a damper with the speed: times the speed both are of degree 2 at most.
    assert family._through.shares.size == 3
    assert near.load == pytest.approx(exact.load, rel=1e-10, abs=1e-10 * np.abs(exact.load).max())
    assert near.forces.parameters == pytest.approx(exact.forces.parameters, rel=1e-10)
    assert near.rotation.speeds == pytest.approx(exact.rotation.speeds, rel=1e-13)
    # What does not change is the same object, so that plants share factors.
    assert near.K is family._through.first.K


def test_a_constant_force_is_a_load_and_no_unknown() -> None:
    family = _family("split_torque.toml", "operation.speed", "9000 rpm:9500 rpm", "stage_1a")
    assert len(family.local.parts) == 12
    assert [part.is_mesh for part in family.parts] == [True] * 8
    turning = _family("split_torque.toml", "operation.speed", "9000 rpm:9500 rpm", "unbalances.input")
    assert [part.part for part in turning.parts if not part.is_mesh] == ["unbalances.input"]


def test_a_kink_is_no_polynomial() -> None:
    family = _family("backlash_pair.toml", "operation.torque", "100 N m:200 N m")
    first = family.system([0.0])

    def kinked(share: float) -> object:
        from dataclasses import replace

        return replace(first, load=first.load * (1.0 + abs(share - 0.4)))

    assert between(kinked) is None  # type: ignore[arg-type]


def test_a_load_at_its_mean_still_loads_the_mesh_and_its_ripple_is_gone() -> None:
    case = DeadZone(amplitude=0.05)
    text = case.text(1.2).replace(f"ripple_order = {TEETH}", "ripple_order = 7")
    error = f"backlash = {2.0 * HALF_BACKLASH!r}\ntransmission_error = [{{ harmonic = 1, amplitude = 1e-7 }}]"
    model = rg.loads(text.replace(f"backlash = {2.0 * HALF_BACKLASH!r}", error))
    ends = [case.speed(1.2), case.speed(1.25)]
    found = rg.orbits(model, {"operation.speed": ends}, excite="pair", step=0.5, method="harmonic balance")
    assert found.mean_force[:, 0] == pytest.approx(case.mean * STIFFNESS * HALF_BACKLASH, rel=1e-10)
    quiet = rg.loads(text.replace(f"backlash = {2.0 * HALF_BACKLASH!r}", error).replace("ripple = 1.0", "ripple = 0.0"))
    same = rg.orbits(quiet, {"operation.speed": ends}, step=0.5, method="harmonic balance")
    assert found.first_harmonic[0] == pytest.approx(same.first_harmonic[0], rel=1e-9)


def test_the_centrifugal_terms_of_an_elastic_wheel_go_with_the_speed_that_is_followed() -> None:
    model = rg.load(MODELS / "elastic_wheel.toml")
    speed = model.operating_speed
    assert speed
    family = SystemFamily(model, [range_of(model, "operation.speed", [0.5 * speed, 2.0 * speed])], None, 1)
    twice = model.with_({"operation.speed": 2.0 * speed})
    there = SystemFamily(twice, [range_of(twice, "operation.speed", [2.0 * speed, 3.0 * speed])], None, 1)
    found, wanted = family.system([1.0]).K.toarray(), there.system([0.0]).K.toarray()
    assert found == pytest.approx(wanted, rel=1e-12, abs=1e-12 * abs(wanted).max())


def test_a_value_that_no_model_has_shortens_a_step_beyond_the_range_and_is_refused_within() -> None:
    address = "gears.wheel.polar_inertia"
    family = _family("backlash_pair.toml", address, "1e-3 kg m^2:3e-3 kg m^2")
    assert family.system([1.7]).n == family.system([0.0]).n
    with pytest.raises(ConvergenceError, match="leaves the range"):
        family.system([-2.3])  # -3.6e-3 kg m^2
    with pytest.raises(ModelError, match=address):
        _family("backlash_pair.toml", address, "-1e-3 kg m^2:3e-3 kg m^2")
