"""A basis of the rigid-body motions that a person can read: motions and shafts that do not move each other stand apart."""

from __future__ import annotations

import numpy as np
import scipy.linalg as la

from rotorgear.system.system import System


def sorted_rigid(system: System, R: np.ndarray) -> np.ndarray:
    """Turn a basis of the rigid-body motions so that motions and shafts which do not move each other stand apart."""
    everything = system.dofs.expand(R)
    # A rigid casing is known by its seats, which count as nodes of shafts behind the last one.
    seats = [
        everything[system.nodes.of_seat(name, k)]
        for name in system.model.casings
        for k in range(len(system.layout.casing(name).seats))
    ]
    q = np.concatenate(
        [everything[: 6 * len(system.nodes)].reshape(len(system.nodes), 6, R.shape[1]), *([seats] if seats else [])]
    )
    shafts = {name: k for k, name in enumerate(system.model.shafts)}
    weight = np.array([1.0 + shafts[name] for name in system.nodes.shaft] + [1.0 + len(shafts)] * len(seats))
    kinds = np.array([1.0, 1.0, 2.0, 1.0, 1.0, 3.0]) * np.sqrt(2.0)
    scaled = q * np.sqrt(np.outer(weight, kinds))[:, :, None]
    flat = scaled.reshape(-1, q.shape[2])
    plain = q.reshape(-1, q.shape[2])
    try:
        turned = R @ la.eigh(flat.T @ flat, plain.T @ plain)[1]
    except la.LinAlgError:
        # Inertias of more than 16 decades: motions that differ in the light parts only are one in all digits. Any basis serves.
        return R
    norm = np.sqrt(np.einsum("nm,nm->m", turned, system.mass @ turned))
    return np.asarray(turned / np.where(norm > 0.0, norm, 1.0))
