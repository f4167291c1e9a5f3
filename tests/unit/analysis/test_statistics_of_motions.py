"""Statistics of motions and their errors, against an oscillator with impacts that is solved exactly."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.solvers.time.statistics import STATISTICS, PeriodicCurve, over_period
from tests.unit.analysis.impact_oscillator import ImpactOscillator

# Flanks that stay together, flanks that part, flanks that strike on both sides; some are lightly damped.
LINEAR = ImpactOscillator(W=1.6, ripple=1.5, z=0.03)
PARTING = ImpactOscillator(W=1.2, ripple=2.0, z=0.03)
STRIKING = ImpactOscillator(W=0.5, ripple=2.0, z=0.02)
# One motion alone to settle on.
SETTLING = ImpactOscillator(W=0.7, ripple=1.4, z=0.05)
# Motions of two steps part, however small both are.
CHAOTIC = ImpactOscillator(W=0.9, ripple=3.0, z=0.02)
# Below this share of its size a statistic is right to rounding, and its error is nothing to judge.
ROUNDING = 1e-11


def of_orbit(found: rg.OrbitsResult, i: int) -> np.ndarray:
    """`STATISTICS` of a point, without the smallest force, which orbits do not tell."""
    return np.array(
        [
            found.mean_force[i, 0],
            found.rms_force[i, 0],
            found.largest_force[i, 0],
            np.nan,
            found.apart[i, 0],
            found.back[i, 0],
            found.peak_to_peak_transmission_error[i, 0],
            found.peak_to_peak_approach[i, 0],
        ]
    )


def exact_of(case: ImpactOscillator, found: rg.OrbitsResult, i: int) -> np.ndarray:
    """The exact statistics at a point, from its state at the begin of the period."""
    c = found.displacement_harmonics[i, :, 0]
    w = 2.0 * np.pi / found.period[i]
    rate = 1j * w * np.arange(len(c)) * c
    at = replace(case, W=case.W * found.value[i] / case.speed(case.W))
    return at.exact(c.real.sum(), rate.real.sum())


def test_the_exact_oscillator_is_linear_where_its_flanks_do_not_part() -> None:
    assert LINEAR.exact(2e-6, 0.0) == pytest.approx(LINEAR.linear(), rel=1e-9)


@pytest.mark.parametrize(
    ("case", "method"),
    [
        (LINEAR, "shooting"),
        (LINEAR, "harmonic balance"),
        (PARTING, "shooting"),
        (PARTING, "harmonic balance"),
        (STRIKING, "shooting"),
    ],
    ids=["linear shooting", "linear balance", "parting shooting", "parting balance", "striking shooting"],
)
def test_statistics_of_an_orbit_are_exact_to_their_stated_errors(case: ImpactOscillator, method: str) -> None:
    ends = [case.speed(case.W), case.speed(1.02 * case.W)]
    found = rg.orbits(case.model(), {"operation.speed": ends}, method=method, step=0.5, points=2)
    assert found.statistic == STATISTICS
    effectivity = []
    for i in range(len(found.value)):
        exact = exact_of(case, found, i)
        error = np.abs(of_orbit(found, i) - exact)
        size = np.where(np.isin(np.arange(8), (4, 5)), 1.0, np.maximum(np.abs(exact), 1e-300))
        judged = error > ROUNDING * size
        assert np.all(error[np.isfinite(error)] <= 1e-4 * size[np.isfinite(error)])
        effectivity += list(found.statistics_error[i, 0][judged] / error[judged])
    assert min(effectivity) > 0.3
    assert 0.5 < np.median(effectivity) < 3.0
    # The loss is no whole multiple of an instant.
    loss = found.apart[0, 0] * found.instants
    assert loss == 0.0 or abs(loss - round(loss)) > 1e-3


def test_shooting_states_its_own_error() -> None:
    found = rg.orbits(
        PARTING.model(), {"operation.speed": [PARTING.speed(1.2), PARTING.speed(1.22)]}, step=0.5, points=2
    )
    assert "shooting" in found.method
    assert found.error_estimate < 1e-8


@pytest.mark.parametrize("method", ["newmark", "exponential"])
@pytest.mark.parametrize("case", [LINEAR, SETTLING], ids=["linear", "parting"])
def test_errors_of_a_transient_are_those_of_each_statistic(case: ImpactOscillator, method: str) -> None:
    periods = int(np.ceil(23.0 * case.W / (2.0 * np.pi * case.z)))
    times = {"time": 40 * case.period, "discard": periods * case.period}
    found = rg.transient(case.model(), method=method, steps=80, **times)
    number = [found.quantity.index(f"{what} pair") for what in STATISTICS]
    value, error, scale = found.quantity_value[number], found.quantity_error[number], found.quantity_scale[number]
    exact = case.exact(*_state(found))
    off = np.abs(value - exact)
    # Of a mean that the loads prescribe nothing is left.
    judged = (off > 1e-9 * scale) & (np.array(STATISTICS) != "mean force")
    effectivity = error[judged] / off[judged]
    assert effectivity.min() > 0.3
    assert 0.5 < np.median(effectivity) < 3.0
    shown = np.array(STATISTICS) != "smallest force"  # in no table, and with an error of its own
    assert found.error_estimate > 0.3 * (off / scale)[shown].max()
    assert scale[1] == pytest.approx(value[1])
    assert scale[-2:] == pytest.approx(value[-2:])


def test_errors_of_chaos_are_how_much_other_steps_differ() -> None:
    times = {"time": 64 * CHAOTIC.period, "discard": 150 * CHAOTIC.period}
    found = rg.transient(CHAOTIC.model(), **times)
    assert "the scatter of the record" in found.error_source
    assert "as in chaos" in found.status
    covered = []
    for steps in (90, 110, 130, 150, 170):
        other = rg.transient(CHAOTIC.model(), steps=steps, error_estimate=False, **times)
        off = np.abs(found.quantity_value - other.quantity_value)
        judged = (found.quantity_scale < np.inf) & (off > 1e-7 * found.quantity_scale)
        covered += list(off[judged] <= found.quantity_error[judged])
    assert np.mean(covered) >= 0.9


def test_errors_of_a_run_up_are_those_of_each_statistic() -> None:
    model = PARTING.model()
    speed = PARTING.speed(0.5)
    options = {"speed": speed, "speed_to": 3.0 * speed, "time": 60 * PARTING.period}
    truth = rg.transient(model, method="newmark", steps=4800, error_estimate=False, **options)
    for steps in (60, 120):
        found = rg.transient(model, steps=steps, **options)
        off = np.abs(found.quantity_value - truth.quantity_value)
        judged = (off > 1e-5 * found.quantity_scale) & np.isfinite(found.quantity_scale)
        effectivity = found.quantity_error[judged] / off[judged]
        assert effectivity.min() > 0.3
        assert 0.5 < np.median(effectivity) < 3.0
        assert found.error_estimate > 0.5 * (off / found.quantity_scale)[judged].max()


def test_a_run_prints_the_error_of_each_statistic_beside_it() -> None:
    found = rg.transient(LINEAR.model(), steps=40, time=20 * LINEAR.period, discard=0.0)
    text = str(found)
    table = text[text.index("Estimated errors, relative") :].splitlines()
    heads, row = table[1].split(), table[2].split()
    assert heads == ["contact", "mean", "rms", "largest", "TE", "appr.", "loss", "coast"]
    stated = float(row[heads.index("rms")])
    assert stated == pytest.approx(found.error_of("rms force pair"), rel=0.15)
    number = found.quantity.index("rms force pair")
    assert found.error_of("rms force pair") == found.quantity_error[number] / found.contacts[0].rms_force_n
    assert "a third of the step and of twice the step" in text.replace("\n", " ")
    unknown = rg.transient(LINEAR.model(), steps=40, time=20 * LINEAR.period, discard=0.0, error_estimate=False)
    assert "Estimated errors" not in str(unknown)
    with pytest.raises(KeyError):
        found.error_of("rms force other")


def test_errors_of_a_sweep_are_those_of_each_statistic() -> None:
    speeds = [SETTLING.speed(W) for W in (0.68, 0.7, 0.72)]
    found = rg.sweep(SETTLING.model(), {"operation.speed": speeds}, discard=150, sample=40, steps=100)
    assert found.statistic == (*STATISTICS, "penetration")
    effectivity = []
    for p, speed in enumerate(speeds):
        assert found.motion_at(p) == "1T"
        own = replace(SETTLING, W=SETTLING.W * speed / SETTLING.speed(SETTLING.W))
        exact = own.exact(*found.section[p, 0, -1, 0])
        told = found.points[p].runs[0].contacts[0]
        value = [told.mean_force_n, told.rms_force_n, told.largest_force_n, np.nan, told.apart_share, told.back_share]
        value += [told.peak_to_peak_transmission_error_m, told.peak_to_peak_approach_m]
        # Without an error of the teeth the flanks penetrate as they approach.
        error = np.abs(np.append(value, told.peak_to_peak_m) - np.append(exact, exact[-1]))
        judged = error > 1e-9 * np.maximum(np.abs(np.append(exact, exact[-1])), 1e-300)
        effectivity += list(told.statistics_error[judged] / error[judged])
    assert min(effectivity) > 0.3
    assert 0.5 < np.median(effectivity) < 5.0


def _state(found: rg.TransientResult) -> tuple[float, float]:
    """d and v at the end, which is that of a period."""
    d = found.approach[:, 0]
    h = found.spacing
    return float(d[-1]), float((3.0 * d[-1] - 4.0 * d[-2] + d[-3]) / (2.0 * h))


def test_a_motion_that_has_not_settled_is_told_by_the_size_of_what_moves() -> None:
    # The mean force is many times what moves about it: relative to the force nothing is to be seen.
    case = ImpactOscillator(W=1.005, ripple=0.002, z=0.002)
    found = rg.transient(case.model(), steps=40, time=60 * case.period, discard=0.0, error_estimate=False)
    assert found.contacts[0].rms_force_n < 0.3 * found.contacts[0].mean_force_n
    assert any("halves" in note for note in found.warnings)


def test_statistics_over_a_period_know_impacts_shorter_than_an_instant_is_long() -> None:
    # d = cos t touches a spring beyond .99 for .283 of 2 pi, of which 40 instants see one: F = (d - .99)+ in closed form.
    N = 40
    t = 2.0 * np.pi * (np.arange(N) + 0.3) / N
    bound = 0.99
    half = np.arccos(bound)
    curve = PeriodicCurve(2.0 * np.pi, np.cos(t)[:, None], -np.sin(t)[:, None])

    def laws(t: np.ndarray, d: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return np.maximum(d - bound, 0.0), (d > bound).astype(float)

    force, shares = over_period(curve, laws)
    mean = (np.sin(half) - bound * half) / np.pi
    square = (0.5 * half + 0.25 * np.sin(2.0 * half) - 2.0 * bound * np.sin(half) + bound**2 * half) / np.pi
    assert force.mean[0] == pytest.approx(mean, rel=2e-3)
    assert force.rms[0] == pytest.approx(np.sqrt(square - mean**2), rel=2e-3)
    assert force.largest[0] == pytest.approx(1.0 - bound, rel=1e-3)
    assert force.least[0] == 0.0
    assert shares[0] == pytest.approx([half / np.pi, 1.0 - half / np.pi, 0.0], rel=2e-3)
