"""What scattering numbers do to first order: slopes of frequencies from energies, of load shares from statics."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.scatter.forms import GYROSCOPIC, MASS, STIFFNESS
from rotorgear.analysis.scatter.samples import Study, shares_at

# Half width of the differences of energies and forces, in standard deviations: nothing is solved again but statics.
_STEP = 1e-3
_STATIC_STEP = 0.05


def frequency_slopes(study: Study) -> NDArray[np.float64]:
    """d ln w / dz at the nominal model, (m, p), of the wanted modes."""
    coupling = couplings(study)
    own = np.real(np.diagonal(coupling, axis1=1, axis2=2)).T
    return np.asarray((own / study.nominal.omega[:, None])[: study.count])


def couplings(study: Study) -> NDArray[np.complex128]:
    """Change of the frequencies of all nominal modes as a matrix among them, (p, k, k), in rad/s per standard deviation.

    H_ab = phi_a^H (K' - w_a w_b M' + i (w_a + w_b) / 2 (W G)') phi_b / (2 sqrt(w_a w_b)): slopes of frequencies on its diagonal,
    and the slopes of modes that meet are its eigenvalues among them.
    """
    family = study.family
    omega = study.nominal.omega
    Q = study.nominal.q
    p = len(family.spreads)
    root = np.sqrt(np.outer(omega, omega))
    found = np.zeros((p, len(omega), len(omega)), dtype=complex)
    for j in range(p):
        z = np.zeros(p)
        z[j] = _STEP
        change = (family.at(z)[:3] - family.at(-z)[:3]) / (2.0 * _STEP)
        K, M, G = (Q.conj().T @ change[form] @ Q for form in (STIFFNESS, MASS, GYROSCOPIC))
        found[j] = (K - np.outer(omega, omega) * M + 0.5j * np.add.outer(omega, omega) * G) / (2.0 * root)
    return found


def share_slopes(study: Study) -> NDArray[np.float64]:
    """d share / dz at the nominal model, (s, p), by statics on both sides."""
    spreads = study.family.spreads
    found = np.zeros((len(study.shared), len(spreads)))
    if study.shared:
        for j in range(len(spreads)):
            z = np.zeros(len(spreads))
            z[j] = _STATIC_STEP
            above, below = (shares_at(study, side * z) for side in (1.0, -1.0))
            found[:, j] = (above - below) / (2.0 * _STATIC_STEP)
    return found
