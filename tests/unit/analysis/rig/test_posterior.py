"""The linear Gaussian estimate against the textbook's normal equations, and in its limits."""

from __future__ import annotations

import numpy as np

from rotorgear.analysis.rig.posterior import Posterior


def random_posterior(lines, parameters, noise=0.005):
    random = np.random.default_rng(3)
    jacobian = random.uniform(0.0, 0.3, (lines, parameters))
    return Posterior(jacobian, noise * random.uniform(0.5, 2.0, lines), random.uniform(0.1, 0.4, parameters))


def test_covariance_and_estimate_are_those_of_the_normal_equations():
    for lines, parameters in ((4, 14), (9, 5)):
        p = random_posterior(lines, parameters)
        residual = np.random.default_rng(5).normal(size=lines) * 0.01
        N = np.diag(p.noise**-2.0)
        covariance = np.linalg.inv(p.jacobian.T @ N @ p.jacobian + np.diag(p.prior**-2.0))
        np.testing.assert_allclose(p.sigma, np.sqrt(np.diag(covariance)), rtol=1e-10)
        np.testing.assert_allclose(p.estimate(residual), covariance @ p.jacobian.T @ N @ residual, rtol=1e-9)
        np.testing.assert_allclose(p.correlation, covariance / np.outer(p.sigma, p.sigma), atol=1e-10)
        np.testing.assert_allclose(p.learnt, 1.0 - np.diag(covariance) / p.prior**2, atol=1e-12)
        np.testing.assert_allclose(p.learnt.sum(), p.shares.sum(), rtol=1e-12)


def test_lines_without_noise_leave_nothing_of_as_many_parameters():
    p = random_posterior(6, 6, noise=1e-9)
    np.testing.assert_allclose(p.learnt, 1.0, atol=1e-12)
    # sigma is then that of J^-1 N, far below what 1 - share could resolve in double precision.
    expected = np.sqrt(np.diag(np.linalg.inv(p.jacobian) @ np.diag(p.noise**2) @ np.linalg.inv(p.jacobian).T))
    np.testing.assert_allclose(p.sigma, expected, rtol=1e-3)


def test_what_no_line_depends_on_keeps_its_prior():
    p = random_posterior(4, 3)
    blind = Posterior(np.hstack([p.jacobian, np.zeros((4, 1))]), p.noise, np.append(p.prior, 0.25))
    assert blind.learnt[-1] == 0.0
    assert blind.sigma[-1] == 0.25
    np.testing.assert_allclose(blind.sigma[:3], p.sigma, rtol=1e-12)
