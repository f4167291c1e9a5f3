"""What every local force law holds: tangents are difference quotients, energies balance, and a passive law gives nothing."""

from __future__ import annotations

import numpy as np
import pytest

from rotorgear.errors import AnalysisError
from rotorgear.forces import registry
from rotorgear.forces.law import ForceLaw

LAWS = [(f"{name} {i}", law) for name in registry.names() for i, law in enumerate(registry.law(name).examples())]
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
    work = float(np.trapezoid(np.sum(force * v, axis=0), t))
    assert work >= -1e-4 * float(np.trapezoid(np.abs(np.sum(force * v, axis=0)), t))


@pytest.mark.parametrize(("name", "law"), LAWS, ids=[name for name, _ in LAWS])
def test_a_law_declares_its_parameters_with_unit_and_meaning(name: str, law: ForceLaw) -> None:
    assert law.title
    assert law.declared()
    assert all(meaning for _, meaning in law.declared().values())
    assert law.reference_stiffness().shape == law.reference_damping().shape == (law.components, law.components)


@pytest.mark.parametrize(("name", "law"), LAWS, ids=[name for name, _ in LAWS])
def test_a_law_that_ignores_velocities_says_so_rightly(name: str, law: ForceLaw) -> None:
    if not law.uses_velocity:
        for d, v in motions(law):
            assert np.array_equal(at(law, d, v).force, at(law, d, -v).force)


def test_an_unknown_law_is_answered_with_those_that_exist() -> None:
    with pytest.raises(AnalysisError, match="no force law 'glue'; there are mesh_contact"):
        registry.law("glue")
