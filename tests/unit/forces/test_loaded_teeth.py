"""The law of loaded teeth: what the map says is what it does, at rest, in time and where teeth part."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rotorgear.errors import AnalysisError
from rotorgear.forces.loaded_map import STEPS
from rotorgear.forces.loaded_teeth import LoadedTeeth
from validation.oscillators import integrate, local_system

LAW = LoadedTeeth.examples()[0]
ROWS = len(LAW.approach)


def angle_at(law: LoadedTeeth, u: float) -> float:
    """Angle of the reference at which the path stands at u base pitches."""
    return float((2.0 * np.pi * u * law.forward - law.path_phase) / law.order)


def error(law: LoadedTeeth, angle: float) -> float:
    p = law.order * angle + law.phase
    terms = [a * np.cos(n * p) for n, a in enumerate(law.error_cos, 1)]
    return law.error_mean + sum(terms) + sum(b * np.sin(n * p) for n, b in enumerate(law.error_sin, 1))


@pytest.mark.parametrize("law", LoadedTeeth.examples()[:5])
def test_under_each_load_of_the_map_the_flanks_have_its_approach(law: LoadedTeeth) -> None:
    """Where it bends most, it stays within 1 % of a step of the force, which is 1/384 of the range."""
    for row in (0, 17, 40):
        angle = angle_at(law, row * law.periods / ROWS)
        for load, approach in zip(law.load[2:], law.approach[row, 2:], strict=True):
            force = law.evaluate(approach + error(law, angle), 0.0, angle=angle).force[0]
            assert force == pytest.approx(load, rel=5e-5, abs=1e-2 * law.load[-1] / STEPS)


def test_the_flanks_push_only_and_never_less_for_more_approach() -> None:
    for u in np.linspace(0.0, 1.0, 37):
        angle = angle_at(LAW, u)
        first = np.interp(u * ROWS, np.arange(ROWS + 1), np.append(LAW.approach[:, 0], LAW.approach[0, 0]))
        touch = first + error(LAW, angle)
        d = touch + np.linspace(-1e-5, 2.5e-5, 500)
        values = LAW.evaluate_many(d[:, None], 0.0, angle=angle)
        force = values.force[:, 0]
        assert np.all(force[d <= touch - 1e-15] == 0.0)
        assert np.all(np.diff(force) >= 0.0)
        assert np.all(np.diff(force[d > touch + 1e-9]) > 0.0)
        assert np.array_equal(values.contact, (d > touch).astype(int))


def test_damping_is_in_proportion_to_the_stiffness_that_carries() -> None:
    angle = angle_at(LAW, 0.25)
    for load, approach in zip(LAW.load[4:], LAW.approach[ROWS // 4, 4:], strict=True):
        value = LAW.evaluate(approach + error(LAW, angle), 0.0, angle=angle)
        share = value.in_velocity[0, 0] / LAW.damping
        assert share == pytest.approx(value.in_displacement[0, 0] / LAW.stiffness, rel=0.02), load


def test_above_its_largest_load_the_map_goes_on_along_its_tangent() -> None:
    approach = LAW.approach[0, -1] + error(LAW, angle_at(LAW, 0.0))
    at, above = (LAW.evaluate(approach + past, angle=angle_at(LAW, 0.0)) for past in (0.0, 1e-5))
    tangent = (above.force - at.force)[0] / 1e-5
    assert tangent == pytest.approx(above.in_displacement[0, 0], rel=1e-3)


def test_run_the_other_way_the_map_is_met_from_its_end() -> None:
    there, back = (replace(LAW, forward=sign, path_phase=0.0, error_cos=()) for sign in (1, -1))
    d = LAW.approach.max(axis=0)[5]
    for angle in (0.01, 0.1, 0.2):
        assert there.evaluate(d, angle=angle).force == pytest.approx(back.evaluate(d, angle=-angle).force, rel=1e-12)


def test_a_map_over_several_base_pitches_repeats_after_all_of_them() -> None:
    law = LoadedTeeth.examples()[4]
    (repeats,) = law.repeats()
    assert repeats.order == pytest.approx(abs(law.order) / 2)
    d = law.approach.mean()
    turn = 2.0 * np.pi / law.order
    now, half, whole = (law.evaluate(d, angle=0.2 + k * turn).force[0] for k in range(3))
    assert whole == pytest.approx(now, rel=1e-9)
    assert abs(half - now) > 1e-3 * now


def test_the_mean_map_has_the_mean_approach_under_each_load() -> None:
    bare = replace(LAW, error_cos=())
    for load, approach in zip(bare.load[2:], bare.approach.mean(axis=0)[2:], strict=True):
        force = bare.mean().evaluate(approach).force[0]
        assert force == pytest.approx(load, rel=5e-5, abs=1e-2 * bare.load[-1] / STEPS)


def test_the_coast_flanks_push_back_behind_the_backlash() -> None:
    law = LoadedTeeth.examples()[3]
    assert law.coast is not None
    gap = law.coast.error_mean + law.coast.approach.min()
    free = law.evaluate(-0.5 * gap, angle=0.1)
    assert free.force[0] == 0.0 == free.contact
    deep = law.evaluate(-2.0 * gap, -0.01, angle=0.1)
    alone = law.coast.evaluate(2.0 * gap, 0.01, angle=0.1)
    assert deep.force[0] == pytest.approx(-alone.force[0], rel=1e-12)
    assert deep.in_displacement == pytest.approx(alone.in_displacement, rel=1e-12)
    assert deep.contact == -1


@pytest.mark.parametrize("share", [0.1, 0.2, 0.4])
def test_at_a_crawl_a_mass_follows_the_static_curve(share: float) -> None:
    """m x'' + F(x, u) = W: slow against sqrt(k/m), x(t) is the approach under W at each position."""
    mass = 0.4
    weight = share * LAW.load[-1]
    crawl = np.sqrt(LAW.stiffness / mass) / 400.0
    law = replace(LAW, damping=0.1 * np.sqrt(LAW.stiffness * mass), error_cos=())
    static = np.array([np.interp(weight, law.load, row) for row in law.approach])
    u = np.arange(ROWS) / ROWS
    period = 2.0 * np.pi / crawl
    speed = crawl / law.order
    start = float(np.interp(law.path_phase / (2.0 * np.pi), u, static))
    steps = 400 * ROWS
    local = local_system(mass, 0.0, 0.0, [weight], [(law, [1.0])], speed=speed)
    found = integrate(local, "average acceleration", period / steps, 2 * steps, [start], [0.0], steps // ROWS)
    turned = (np.arange(ROWS) / ROWS + law.path_phase / (2.0 * np.pi)) % 1.0
    expected = np.interp(turned, np.append(u, 1.0), np.append(static, static[0]))
    assert found.q[-ROWS - 1 : -1, 0] == pytest.approx(expected, abs=0.005 * np.ptp(static))


def test_what_does_not_rise_is_refused() -> None:
    with pytest.raises(AnalysisError, match=r"LoadedTeeth\.load"):
        replace(LAW, load=LAW.load[::-1])
    with pytest.raises(AnalysisError, match=r"LoadedTeeth\.approach"):
        replace(LAW, approach=LAW.approach[:, ::-1])


def test_force_tangents_and_energies_are_those_of_the_two_laws_that_became_this_one() -> None:
    """Written by the law of one map and the law of several tilts, before they were put together."""
    written = json.loads((Path(__file__).parent / "loaded_teeth_apart.json").read_text())
    for law, rows in zip(LoadedTeeth.examples(), written, strict=True):
        random = np.random.default_rng(7)
        size = np.array([3e-5, 1.5e-4])[: law.components]
        found = []
        for _ in rows[::2]:
            d = size * random.uniform(-1.0, 1.5, law.components)
            v = 500.0 * size * random.uniform(-1.0, 1.0, law.components)
            angle = float(random.uniform(-7.0, 7.0))
            for one in (law, law.mean()):
                at = one.evaluate(d, v, angle=angle, speed=120.0)
                tangents = np.concatenate([at.in_displacement.ravel(), at.in_velocity.ravel()])
                found.append([*at.force, *tangents, at.stored, at.power_in, at.dissipated, at.contact])
        expected = np.array(rows)
        assert np.abs(expected[:, -1]).sum() >= 4  # not all of them apart
        np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())


@pytest.mark.parametrize("law", [LAW, LoadedTeeth.examples()[5]])
def test_laws_that_differ_in_stiffness_and_errors_read_the_same_rows(law: LoadedTeeth) -> None:
    other = replace(law, load=law.load.copy(), approach=law.approach.copy(), stiffness=2e8, error_mean=1e-6)
    assert other.inverse[1] is law.inverse[1]
    with pytest.raises(ValueError, match="read-only"):
        law.inverse[1][0, 0] = 1.0
    stiffer = replace(law, approach=0.5 * law.approach)
    assert not np.array_equal(stiffer.inverse[1], law.inverse[1])


def test_a_map_too_large_to_be_kept_is_inverted_alike(monkeypatch: pytest.MonkeyPatch) -> None:
    kept = LAW.inverse[1]
    monkeypatch.setattr("rotorgear.forces.loaded_map._LARGE", 0.0)
    assert LAW.inverse[1] is not kept
    assert np.array_equal(LAW.inverse[1], kept)


def test_tilts_come_with_moments_and_without_coast_flanks_on_their_line() -> None:
    face = LoadedTeeth.examples()[5]
    with pytest.raises(AnalysisError, match=r"LoadedTeeth\.tilt"):
        replace(face, tilt=face.tilt[:1], approach=face.approach[:1], moment=face.moment[:1])
    with pytest.raises(AnalysisError, match=r"LoadedTeeth\.approach"):
        replace(face, tilt=face.tilt[1:])
    with pytest.raises(AnalysisError, match=r"LoadedTeeth\.moment"):
        replace(face, moment=())
    with pytest.raises(AnalysisError, match=r"LoadedTeeth\.coast"):
        replace(face, coast=LAW)
