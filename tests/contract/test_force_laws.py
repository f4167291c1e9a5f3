"""What every local force law holds: tangents are difference quotients, energies balance, and a passive law gives nothing."""

from __future__ import annotations

import pickle
import re
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.integrate import trapezoid

from rotorgear.errors import AnalysisError
from rotorgear.forces import registry
from rotorgear.forces.law import ForceLaw
from rotorgear.solvers.batch.columns import OWN_LAW, PRESCRIBED, Columns

LAWS = [(f"{name} {i}", law) for name in registry.names() for i, law in enumerate(registry.law_of(name).examples())]
TIME = 3.7e-4
ANGLE = 0.61
SPEED = 120.0


def motions(law: ForceLaw, count: int = 12) -> list[tuple[np.ndarray, np.ndarray]]:
    """Displacements and velocities on both sides of every gap, away from kinks."""
    k = law.components
    random = np.random.default_rng(3)
    size = np.array([4e-5, 4e-5, 4e-5, 1e-3, 1e-3][:k])
    return [
        (size * random.uniform(-2.0, 2.0, k), 2e-2 * size / 4e-5 * random.uniform(-1.0, 1.0, k)) for _ in range(count)
    ]


def at(law: ForceLaw, d: np.ndarray, v: np.ndarray, later: float = 0.0):  # type: ignore[no-untyped-def]
    return law.evaluate(d, v, time=TIME + later, angle=ANGLE + SPEED * later, speed=SPEED)


@pytest.mark.parametrize(("name", "law"), LAWS, ids=[name for name, _ in LAWS])
def test_tangents_are_difference_quotients(name: str, law: ForceLaw) -> None:
    for d, v in motions(law):
        value = at(law, d, v)
        k = law.components
        for which, given in (("d", value.in_displacement), ("v", value.in_velocity)):
            for j in range(k):
                step = np.zeros(k)
                step[j] = 1e-10 if which == "d" else 1e-7
                dd, dv = (step, 0.0 * step) if which == "d" else (0.0 * step, step)
                quotient = (at(law, d + dd, v + dv).force - at(law, d - dd, v - dv).force) / (2.0 * step[j])
                floor = 1e-12 * np.abs(value.force).max() / step[j]
                assert given[:, j] == pytest.approx(quotient, rel=2e-4, abs=1e-5 * np.abs(given).max() + floor), (
                    d,
                    v,
                    which,
                    j,
                )


@pytest.mark.parametrize(("name", "law"), LAWS, ids=[name for name, _ in LAWS])
def test_stored_energy_is_what_comes_in_less_what_is_dissipated(name: str, law: ForceLaw) -> None:
    dt = 1e-9
    for d, v in motions(law):
        value = at(law, d, v)
        change = (at(law, d + v * dt, v, dt).stored - at(law, d - v * dt, v, -dt).stored) / (2.0 * dt)
        flow = float(value.force @ v) + value.power_in - value.dissipated
        size = abs(value.power_in) + abs(value.dissipated) + np.abs(value.force * v).sum()
        assert change == pytest.approx(flow, rel=1e-5, abs=1e-5 * size + 1e-9 * value.stored / dt * 1e-3)


@pytest.mark.parametrize(("name", "law"), LAWS, ids=[name for name, _ in LAWS])
def test_dissipation_is_never_negative_and_a_passive_law_gives_no_energy(name: str, law: ForceLaw) -> None:
    still = law.mean() if law.passive else law
    assert all(at(law, d, v).dissipated >= 0.0 for d, v in motions(law, 60))
    if not law.passive:
        return
    k = law.components
    t = np.linspace(0.0, 1.0, 4001)
    size = np.array([6e-5, 5e-5, 5e-5, 1e-3, 1e-3][:k])[:, None]
    shift = 1.3 * np.arange(k)[:, None]
    d = size * np.sin(2.0 * np.pi * t + shift)
    v = size * 2.0 * np.pi * np.cos(2.0 * np.pi * t + shift)
    force = np.array([still.evaluate(d[:, i], v[:, i]).force for i in range(t.size)]).T
    work = float(trapezoid(np.sum(force * v, axis=0), t))
    assert work >= -1e-4 * float(trapezoid(np.abs(np.sum(force * v, axis=0)), t))


@pytest.mark.parametrize(("name", "law"), LAWS, ids=[name for name, _ in LAWS])
def test_a_law_declares_its_parameters_with_unit_and_meaning(name: str, law: ForceLaw) -> None:
    assert law.title
    assert law.declared()
    assert all(each.meaning for each in law.declared().values())
    assert law.reference_stiffness().shape == law.reference_damping().shape == (law.components, law.components)


@pytest.mark.parametrize(("name", "law"), LAWS, ids=[name for name, _ in LAWS])
def test_a_law_that_ignores_velocities_says_so_rightly(name: str, law: ForceLaw) -> None:
    if not law.uses_velocity:
        for d, v in motions(law):
            assert np.array_equal(at(law, d, v).force, at(law, d, -v).force)


@pytest.mark.parametrize(("name", "law"), LAWS, ids=[name for name, _ in LAWS])
def test_many_instants_at_once_are_the_same_instants_one_by_one(name: str, law: ForceLaw) -> None:
    d, v = (np.array(x) for x in zip(*motions(law), strict=True))
    t = TIME + 1e-5 * np.arange(len(d))
    many = law.evaluate_many(d, v, time=t, angle=ANGLE + SPEED * t, speed=SPEED)
    for i in range(len(d)):
        one = law.evaluate(d[i], v[i], time=t[i], angle=ANGLE + SPEED * t[i], speed=SPEED)
        for part in ("force", "in_displacement", "in_velocity", "stored", "power_in", "dissipated", "contact"):
            assert np.array_equal(getattr(many, part)[i], getattr(one, part)), part


@pytest.mark.parametrize(("name", "law"), LAWS, ids=[name for name, _ in LAWS])
def test_linearised_is_the_slope_of_the_mean_force(name: str, law: ForceLaw) -> None:
    d, v = motions(law)[0]
    about = law.linearised(d, v, speed=SPEED)
    k = law.components
    floor = 1e-6 * np.abs(about.force).max()
    for j in range(k):
        step = np.eye(k)[j]
        for slope, up, down, size in (
            (about.stiffness, (d + 1e-10 * step, v), (d - 1e-10 * step, v), 2e-10),
            (about.damping, (d, v + 1e-7 * step), (d, v - 1e-7 * step), 2e-7),
        ):
            difference = law.linearised(*up, speed=SPEED).force - law.linearised(*down, speed=SPEED).force
            assert slope[:, j] == pytest.approx(
                difference / size, rel=1e-3, abs=1e-5 * np.abs(slope).max() + floor * 1e-6 / size
            )


def test_rolling_bearings_linearised_about_their_centre_are_isotropic_at_any_angle_of_the_cage() -> None:
    for name in ("ball_bearing", "roller_bearing"):
        law = registry.law_of(name).examples()[0]
        for phase in (0.0, 0.3):
            about = replace(law, phase=phase, clearance=-20e-6).linearised()
            assert about.stiffness[0, 0] == pytest.approx(about.stiffness[1, 1], rel=1e-12)
            assert about.stiffness[0, 1] == pytest.approx(0.0, abs=1e-9 * about.stiffness[0, 0])


@pytest.mark.parametrize(("name", "law"), LAWS, ids=[name for name, _ in LAWS])
def test_a_law_refuses_what_is_out_of_its_declared_bounds_and_says_them(name: str, law: ForceLaw) -> None:
    for key, about in law.declared().items():
        outside = [about.least - 1.0] if about.least is not None else []
        outside += [about.most + 1.0] if about.most is not None else []
        outside += [bound for bound in (about.above, about.below) if bound is not None]
        if isinstance(getattr(law, key), float):
            outside += [np.nan, np.inf]
        for value in outside or (["glue"] if about.choices else []):
            with pytest.raises(
                AnalysisError, match=rf"{type(law).__name__}\.{key}: got .*, expected {re.escape(about.expected)}"
            ):
                replace(law, **{key: value})


@pytest.mark.parametrize(("name", "law"), LAWS, ids=[name for name, _ in LAWS])
def test_a_law_survives_pickling_and_copying(name: str, law: ForceLaw) -> None:
    assert pickle.loads(pickle.dumps(law)) == law == replace(law)


@pytest.mark.parametrize(("name", "law"), LAWS, ids=[name for name, _ in LAWS])
def test_what_repeats_is_the_same_after_whole_periods_and_differs_between(name: str, law: ForceLaw) -> None:
    d, v = (np.array(x) for x in zip(*motions(law), strict=True))

    def force(turn: float) -> np.ndarray:
        return law.evaluate_many(d, v, angle=ANGLE + turn, speed=SPEED).force

    turns = [2.0 * np.pi / each.order for each in law.repeats()]
    for turn in turns:
        assert force(turn) == pytest.approx(force(0.0), rel=1e-9, abs=1e-12)
        others = [force(0.37 * turn), force(0.61 * turn)]
        assert any(np.abs(other - force(0.0)).max() > 1e-9 * np.abs(other).max() for other in others)
    if not turns:
        assert np.array_equal(force(1.0), force(0.0))


@pytest.mark.parametrize(("name", "law"), LAWS, ids=[name for name, _ in LAWS])
def test_the_elastic_force_is_the_gradient_of_the_stored_energy(name: str, law: ForceLaw) -> None:
    if not law.passive:
        return
    still = law.mean()
    for d, _ in motions(law):
        for step in 1e-9 * np.eye(law.components):
            rise = (still.evaluate(d + step).stored - still.evaluate(d - step).stored) / 2e-9
            force = still.evaluate(d).force
            assert force @ (step / 1e-9) == pytest.approx(rise, rel=1e-5, abs=1e-6 * np.abs(force).max())


@pytest.mark.parametrize(("name", "law"), LAWS, ids=[name for name, _ in LAWS])
def test_the_impulse_is_the_integral_of_the_damping_force_whatever_the_velocity(name: str, law: ForceLaw) -> None:
    end = np.full(law.components, 5e-5)
    expected = law.impulse(end, angle=ANGLE)
    if not np.any(expected):
        return
    for rate in (1e-3, 0.1):
        d = np.linspace(-1e-5, 5e-5, 60001)[:, None] * np.ones(law.components)  # from between the sides into contact
        moving = law.evaluate_many(d, rate, angle=ANGLE).force - law.evaluate_many(d, 0.0, angle=ANGLE).force
        assert trapezoid(moving, dx=1e-9 / rate, axis=0) == pytest.approx(expected, rel=1e-4)


def test_damping_that_sets_in_with_contact_has_an_impulse() -> None:
    contact = registry.law_of("mesh_contact").examples()[0]
    assert contact.impulse(5e-5)[0] > 0.0 > contact.impulse(-9e-5)[0]
    assert contact.impulse(-1e-5)[0] == 0.0


@cache
def contacts_alone() -> Any:
    """`contacts`, which compiled functions alone may call, as a function for Python."""
    import numba

    from rotorgear.solvers.batch.kernel_parts import contacts

    @numba.njit
    def called(columns, table, weight, d, F, found, used):  # type: ignore[no-untyped-def]
        contacts(columns, table, weight, d, F, found, used)

    return called


@pytest.mark.parametrize(("name", "law"), LAWS, ids=[name for name, _ in LAWS])
def test_in_lanes_a_law_is_what_it_is_alone(name: str, law: ForceLaw) -> None:
    from rotorgear.solvers.batch.kernel_parts import FOUND, IN_D, IN_V, SIDE
    from rotorgear.solvers.contact.vectors import BATCH

    columns = Columns.of(law.columns(SPEED)).scaled(SPEED)
    if np.all(columns.kind == OWN_LAW):
        return  # run by the same compiled function, tested in test_sweep_laws.py
    k = law.components
    state = np.zeros(law.state_size())
    law.functions()[0](ANGLE, 1.0, 0.0, law.parameters(), state)
    table = law.table(np.array([ANGLE]), state[None], 1.0)[0]
    moved = motions(law, BATCH)
    d, found, F, used = (np.zeros((rows, BATCH)) for rows in (2 * k, FOUND * k, k, k))
    d[0::2] = np.array([one for one, _ in moved]).T
    d[1::2] = np.array([rate for _, rate in moved]).T / SPEED
    values, tables = (np.repeat(each[:, :, None], BATCH, axis=2) for each in (columns.values, table))
    acting = columns._replace(jumping=True, values=values)
    contacts_alone()(acting, tables, 1.0, d, F, found.reshape(k, FOUND, BATCH), used)
    for lane, (one, rate) in enumerate(moved):
        alone = law.evaluate(one, rate, angle=ANGLE, speed=SPEED)
        assert SPEED**2 * F[:, lane] == pytest.approx(alone.force, rel=1e-12)
        if np.all(columns.kind < PRESCRIBED):
            assert SPEED**2 * found[IN_D, lane] == pytest.approx(alone.in_displacement[0, 0], rel=1e-12)
            assert SPEED * found[IN_V, lane] == pytest.approx(alone.in_velocity[0, 0], rel=1e-12)
            assert found[SIDE, lane] == alone.contact


def test_an_unknown_law_is_answered_with_those_that_exist() -> None:
    with pytest.raises(AnalysisError, match="no force law 'glue'; there are mesh_contact"):
        registry.law_of("glue")


@pytest.mark.parametrize(("name", "law"), LAWS, ids=[name for name, _ in LAWS])
@pytest.mark.parametrize("speed", [0.0, 310.0])
def test_linearisations_about_several_displacements_are_those_about_each(
    name: str, law: ForceLaw, speed: float
) -> None:
    places = np.array([[3e-6], [-2e-5], [7e-5]]) * np.linspace(0.4, 1.3, law.components)
    for place, found in zip(places, law.linearised_at(places, speed=speed), strict=True):
        alone = law.linearised(place, speed=speed)
        np.testing.assert_array_equal(found.force, alone.force)
        np.testing.assert_array_equal(found.stiffness, alone.stiffness)
        np.testing.assert_array_equal(found.damping, alone.damping)
