"""One sample of a scattering model: modes beside the nominal ones, margins of excitations, load shares.

A mode is known again by its shape, never by its number: nominal and sampled modes are assigned one to one by most common energy.
Nominal modes that the scatter turns into each other, as at a veering, form a group, and the group is compared as the space that
its modes span: with W the unitary part of the overlaps between both (polar decomposition), the diagonal of W diag(w) W^H holds
the frequencies that belong to the nominal shapes. They pass through a veering smoothly, and their slopes are those of energies.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
from numpy.typing import NDArray

from rotorgear.analysis.scatter.family import Family, sample_at
from rotorgear.analysis.sensitivity.forms import (
    GYROSCOPIC,
    MASS,
    STIFFNESS,
    FormModes,
    FormNames,
    Shapes,
    coupling,
    modes_of,
    overlaps,
    participations,
)
from rotorgear.analysis.static.shares import load_shares
from rotorgear.analysis.static.state_at import state_at
from rotorgear.analysis.static.static import solved
from rotorgear.errors import RotorgearError
from rotorgear.progress import silent
from rotorgear.results.campbell import ExcitationOrder
from rotorgear.system.plan import Plan

# Modes beside those that are wanted, so that the last ones find themselves again.
SPARE = 6
# A nominal mode that a sample holds less of than this is lost there.
LEAST_HELD = 0.5
# Two modes of which one sample holds this share of one in the other turn into each other.
_TURNED = 0.2
# Half width of the differences of energies and forces, in standard deviations: nothing is solved again but statics.
_STEP = 1e-3
_STATIC_STEP = 0.05


@dataclass(frozen=True)
class Study:
    """What every sample is asked.

    Attributes:
        family: the forms of the model.
        count: number of wanted modes m.
        wide, least: of `modes_of`.
        nominal: the nominal modes, m and some spare ones.
        groups: modes that are compared as one space, each a tuple of numbers from 0; every nominal mode is in one.
        lines: excitations, and
        hz: their frequencies (l,).
        share: least participation that counts.
        names: which form is whose.
        shared: (gear, mesh) of the s load shares; empty without statics.
    """

    family: Family
    count: int
    wide: int
    least: float
    nominal: FormModes
    groups: tuple[tuple[int, ...], ...]
    lines: tuple[ExcitationOrder, ...]
    hz: NDArray[np.float64]
    share: float
    names: FormNames
    shared: tuple[tuple[str, str], ...]


def run_samples(study: Study, Z: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Values of each sample z of a block Z (b, p): see `_sample`; NaN where a sample has no modes."""
    rows = [_sample(study, z) for z in Z]
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def _sample(study: Study, z: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """followed_hz (m,): the frequency of each nominal shape; hz (m,): of the mode assigned to it; margin (l,); shares (s,)."""
    m = study.count
    nothing = {
        "followed_hz": np.full(m, np.nan),
        "hz": np.full(m, np.nan),
        "margin": np.full(len(study.hz), np.nan),
        "shares": np.full(len(study.shared), np.nan),
    }
    try:
        forms = study.family.at(z)
        modes = modes_of(forms, len(study.nominal.omega) + SPARE, study.least, study.wide)
        # Frequencies of the nominal shapes and of the modes assigned to them, and how much of each shape its group holds.
        common, at = _assigned(study, modes)
        own = modes.omega[at]
        followed = own.copy()
        held = np.zeros(len(at))
        for group in study.groups:
            rows = list(group)
            inside = common[rows][:, at[rows]]
            held[rows] = np.sum(np.abs(inside) ** 2, axis=1)
            if len(rows) > 1:
                W = la.polar(inside)[0]
                followed[rows] = np.real(np.sum(np.abs(W) ** 2 * own[rows], axis=1))
        taken = participations(study.names, study.lines, forms, modes)
        shares = shares_at(study, z)
    except (RotorgearError, np.linalg.LinAlgError):
        # A sample beyond what the model can be: counted and said, not hidden.
        return nothing
    margin = np.array(
        [
            nearest_margin(modes.omega / (2.0 * np.pi), row >= study.share, f)
            for row, f in zip(taken, study.hz, strict=True)
        ]
    ).reshape(len(study.hz))
    two_pi = 2.0 * np.pi
    return {
        "followed_hz": np.where(held >= LEAST_HELD, followed / two_pi, np.nan)[:m],
        "hz": (own / two_pi)[:m],
        "margin": margin,
        "shares": shares,
    }


def groups_of(study: Study, Z: NDArray[np.float64]) -> tuple[tuple[int, ...], ...]:
    """Nominal modes that turn into each other at some of the samples Z (b, p), as groups; every mode is in one."""
    tied = np.zeros((len(study.nominal.omega),) * 2, dtype=bool)
    for z in Z:
        try:
            modes = modes_of(study.family.at(z), len(study.nominal.omega) + SPARE, study.least, study.wide)
        except (RotorgearError, np.linalg.LinAlgError):
            continue  # counted where the sample itself is run
        common, at = _assigned(study, modes)
        tied |= np.abs(common[:, at]) ** 2 > _TURNED
    groups: list[set[int]] = []
    for a, row in enumerate(tied):
        linked = {int(b) for b in np.flatnonzero(row)} | {a}
        joined = [group for group in groups if group & linked]
        groups = [group for group in groups if not group & linked] + [linked.union(*joined)]
    return tuple(sorted(tuple(sorted(group)) for group in groups))


def _assigned(study: Study, modes: FormModes) -> tuple[Shapes, NDArray[np.intp]]:
    """Overlaps of nominal and sampled modes (k, k'), and the sampled mode of each nominal one."""
    from scipy.optimize import linear_sum_assignment

    common = overlaps(study.family.nominal[STIFFNESS], study.family.nominal[MASS], study.nominal, modes)
    return common, linear_sum_assignment(-(np.abs(common) ** 2))[1]


def nearest_margin(hz: NDArray[np.float64], able: NDArray[np.bool_], line_hz: float) -> float:
    """f / f_line - 1 of the nearest mode that takes part; NaN without one."""
    if not able.any():
        return float("nan")
    ratio = hz[able] / line_hz - 1.0
    return float(ratio[np.argmin(np.abs(ratio))])


def shares_at(study: Study, z: NDArray[np.float64]) -> NDArray[np.float64]:
    """Load shares of the model at z (p,), with the face maps of the nominal one, (s,); NaN of one that it has not."""
    if not study.shared:
        return np.zeros(0)
    family = study.family
    nominal = state_at(family.spreads.numbers.model, [family.speed])
    model = sample_at(family.spreads, tuple(map(float, z)))
    found = load_shares(solved(model, Plan(1), family.speed, silent, nominal).equilibrium)
    return np.array([found.get(key, np.nan) for key in study.shared])


def frequency_slopes(study: Study) -> NDArray[np.float64]:
    """d ln w / dz at the nominal model, (m, p), of the wanted modes."""
    family = study.family
    omega = study.nominal.omega
    Q = study.nominal.q
    slopes = []
    for z in _STEP * np.eye(len(family.spreads)):
        change = (family.at(z)[:3] - family.at(-z)[:3]) / (2.0 * _STEP)
        K, M, G = (Q.conj().T @ change[form] @ Q for form in (STIFFNESS, MASS, GYROSCOPIC))
        slopes.append(np.real(np.diagonal(coupling(K, M, G, omega))) / omega)
    return np.array(slopes).T[: study.count]


def share_slopes(study: Study) -> NDArray[np.float64]:
    """d share / dz at the nominal model, (s, p), by statics on both sides."""
    spreads = study.family.spreads
    found = np.zeros((len(study.shared), len(spreads)))
    if study.shared:
        for j, z in enumerate(_STATIC_STEP * np.eye(len(spreads))):
            above, below = (shares_at(study, side * z) for side in (1.0, -1.0))
            found[:, j] = (above - below) / (2.0 * _STATIC_STEP)
    return found
