"""Parts of a scatter by themselves: interpolated forms, eigenpairs that are followed, bands of given samples."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import scipy.sparse as sp

import rotorgear as rg
from rotorgear.analysis.scatter.family import (
    Family,
    _error,
    _interpolated,
    _inverse_iteration,
    basis_of,
    nominal_modes,
    sampled_system,
)
from rotorgear.analysis.scatter.gather import _bands, _group_bands, _leading, _margin_bands, quantile_error
from rotorgear.analysis.scatter.samples import nearest_margin
from rotorgear.analysis.static.state_at import linear_system
from rotorgear.model.parts.operation import Scatter
from rotorgear.model.spreads import spreads_of
from rotorgear.system.plan import Plan
from tests.paths import MODELS

NOTHING: Any = None
REACH = np.array([2.0, 3.5])


class Powers(Family):
    """Forms that change by powers of two numbers: K by z^3 and z, M by z^4 of the second, G by nothing."""

    def assembled(self, z: np.ndarray) -> np.ndarray:
        found = self.nominal.copy()
        found[0] += 0.3 * np.eye(3) * z[0] ** 3 + 0.1 * np.ones((3, 3)) * z[0]
        found[1] += 0.02 * np.diag([1.0, 2.0, 3.0]) * (z[1] ** 4 - 0.5 * z[1])
        return found


def powers(terms: Any = None) -> Powers:
    rng = np.random.default_rng(1)
    nominal = np.stack([form + form.T + 9.0 * np.eye(3) for form in rng.normal(size=(3, 3, 3))])

    class Two(SimpleNamespace):
        def __len__(self) -> int:
            return 2

    spreads = Two(reach=REACH)
    return Powers(spreads, None, NOTHING, np.eye(3), nominal, terms)


@pytest.mark.parametrize("points", [5, 6, 7])
def test_forms_of_powers_up_to_four_are_interpolated_exactly(points: int) -> None:
    bare = powers()
    parts = [_interpolated(bare, j, points) for j in range(2)]
    assert [sorted(part) for part in parts] == [[0], [1]]
    assert [len(part[form]) for form, part in enumerate(parts)] == [4, 5]  # T_0 to T_3, and to T_4
    terms = {
        form: (
            np.full(len(part[form]), form),
            np.arange(len(part[form])),
            part[form].reshape(len(part[form]), -1),
        )
        for form, part in enumerate(parts)
    }
    whole = powers(terms)
    for z in (np.array([1.3, -2.9]), np.array([-0.7, 0.4]), REACH):
        assert whole.at(z) == pytest.approx(bare.assembled(z), rel=1e-11)
    # Beyond its reach a number is held at its end.
    assert whole.at(2.0 * REACH) == pytest.approx(bare.assembled(REACH), rel=1e-11)


def test_errors_of_forms_are_relative_to_the_energies_of_their_shapes() -> None:
    exact = np.stack([np.diag([4.0, 9.0]), np.diag([1.0, 16.0]), np.zeros((2, 2))])
    for form, size in ((0, 2.0 * 3.0), (1, 1.0 * 4.0), (2, 2.0 * 4.0)):
        found = exact.copy()
        found[form, 0, 1] += 0.03 * size
        assert _error(found, exact) == pytest.approx(0.03)


def test_an_eigenpair_of_a_whole_gyroscopic_system_is_followed() -> None:
    rng = np.random.default_rng(3)
    A, B, C = (rng.normal(size=(6, 6)) for _ in range(3))
    K, M, W = A @ A.T + 6.0 * np.eye(6), B @ B.T + 6.0 * np.eye(6), C - C.T
    root = np.block([[np.zeros((6, 6)), np.eye(6)], [-np.linalg.solve(M, K), -np.linalg.solve(M, W)]])
    values, vectors = np.linalg.eig(root)
    k = int(np.argmin(np.where(values.imag > 0.0, values.imag, np.inf)))
    start = vectors[:6, k] + 0.05 * rng.normal(size=6)
    omega, q = _inverse_iteration(*(sp.csc_array(each) for each in (K, M, W)), 1.02 * values[k].imag, start)
    assert omega == pytest.approx(values[k].imag, rel=1e-10)
    s = 1j * omega
    assert np.abs((K + s * W + s**2 * M) @ q).max() < 1e-8 * np.abs(K @ q).max()
    assert np.vdot(q, M @ q).real == pytest.approx(1.0, rel=1e-9)


def test_the_nearest_mode_that_takes_part_gives_the_margin_with_its_sign() -> None:
    hz = np.array([80.0, 95.0, 104.0, 130.0])
    assert nearest_margin(hz, np.array([True, True, True, True]), 100.0) == pytest.approx(0.04)
    assert nearest_margin(hz, np.array([True, True, False, True]), 100.0) == pytest.approx(-0.05)
    assert math.isnan(nearest_margin(hz, np.zeros(4, bool), 100.0))


def study(**more: Any) -> Any:
    nominal = SimpleNamespace(omega=2.0 * np.pi * np.array([100.0, 220.0, 221.0, 400.0]))
    return SimpleNamespace(nominal=nominal, groups=((0,), (1, 2), (3,)), count=3, **more)


def test_bands_are_the_moments_and_quantiles_of_what_was_found() -> None:
    rng = np.random.default_rng(2)
    hz = np.array([100.0, 220.0, 221.0]) * np.exp(rng.normal(size=(64, 3)) * np.array([0.03, 0.01, 0.02]))
    hz[5, 0] = hz[9, 0] = np.nan
    rows = _bands(study(), {"followed_hz": hz}, [(0.03, "a", 0.7), (0.01, "b", 0.6), (0.02, "", 0.0)])
    for i, row in enumerate(rows):
        there = hz[np.isfinite(hz[:, i]), i]
        assert (row.nominal_hz, row.group) == (pytest.approx([100.0, 220.0, 221.0][i]), (1, 2, 2)[i])
        assert row.sigma == pytest.approx(np.log(there).std(ddof=1))
        assert row.mean_hz == pytest.approx(there.mean())
        assert (row.low_hz, row.high_hz) == pytest.approx(tuple(np.quantile(there, [0.05, 0.95])))
        assert row.found == pytest.approx(len(there) / 64)
    # Of a group the lowest and the highest of each sample.
    (group,) = _group_bands(study(), {"hz": hz})
    assert group.modes == (2, 3)
    assert group.lowest_hz == pytest.approx(np.quantile(hz[:, 1:].min(axis=1), 0.05))
    assert group.highest_hz == pytest.approx(np.quantile(hz[:, 1:].max(axis=1), 0.95))


def test_margins_count_by_their_size_and_the_share_below_the_least() -> None:
    lines = [SimpleNamespace(name="1x"), SimpleNamespace(name="2x")]
    taking = np.array([[1.0, 0.0, 0.4, 1.0], [0.1, 0.1, 0.1, 0.1]])
    names = SimpleNamespace(participations=lambda *_: taking)
    family = SimpleNamespace(nominal=None)
    asked = study(lines=lines, hz=np.array([110.0, 300.0]), share=0.3, names=names, family=family)
    margin = np.column_stack([np.linspace(-0.2, 0.1, 31), np.full(31, np.nan)])
    first, second = _margin_bands(asked, {"margin": margin}, 0.055)
    assert first.nominal == pytest.approx(100.0 / 110.0 - 1.0)
    size = np.abs(margin[:, 0])
    assert first.below == pytest.approx(np.mean(size < 0.055))
    assert first.below == pytest.approx(11 / 31)
    assert (first.low, first.median) == pytest.approx((np.quantile(size, 0.05), np.median(size)))
    assert (math.isnan(second.nominal), second.below) == (True, 0.0)


def test_standard_errors_of_quantiles_are_those_of_blocks() -> None:
    values = np.random.default_rng(7).normal(size=83)
    each = [np.quantile(values[10 * k : 10 * k + 10], 0.05) for k in range(8)]
    assert quantile_error(values, 0.05) == pytest.approx(np.std(each, ddof=1) / math.sqrt(8.0))
    assert math.isnan(quantile_error(values[:15], 0.05))
    # Of equal shares the first number of the file leads.
    assert _leading(np.array([0.2, 0.4 - 1e-9, 0.4]), ("a", "b", "c")) == ("b", pytest.approx(0.4))
    assert _leading(np.zeros(2), ("a", "b")) == ("", 0.0)


def test_the_basis_holds_what_scattering_numbers_add_to_modes_to_first_order() -> None:
    """Modes of a system whose bearings differ by a few percent lie in it ten times as well as in its modes alone."""
    pair = rg.load(MODELS / "geared_pair.toml")
    spreads = spreads_of(pair, {"bearings.*.stiffness": Scatter(sigma="10 %")})
    plan = Plan(1)
    system = linear_system(pair, [None], plan)
    values, X, rigid = nominal_modes(system, None, 8)
    V = basis_of(spreads, None, plan, system, values, X)
    assert V.T @ (system.mass @ V) == pytest.approx(np.eye(V.shape[1]), abs=1e-8)
    assert pytest.approx(V[:, : X.shape[1]]) == X
    assert X.shape[1] < V.shape[1] <= X.shape[1] + len(X.T) * 2 * len(spreads)
    left = []
    for size in (0.2, 0.1):
        other = sampled_system(spreads, size * np.linspace(-1.0, 1.0, len(spreads)), None, plan)
        q = nominal_modes(other, None, 8)[1][:, rigid : rigid + 3]
        for basis in (V, X):
            rest = q - basis @ (basis.T @ (system.mass @ q))
            left.append(np.sqrt(np.max(np.sum(rest * (system.mass @ rest), axis=0))))
    # Nearly all of the first order is there, by shapes of one shift for all modes.
    assert left[0] < 0.1 * left[1]
    assert left[2] < 0.1 * left[3]
    assert left[3] == pytest.approx(0.5 * left[1], rel=0.1)
