"""One sample of a scattering model: modes beside the nominal ones, margins of excitations, load shares.

A mode is known again by its shape, never by its number: nominal and sampled modes are assigned one to one by most common energy.
Nominal modes that the scatter turns into each other, as at a veering, form a group, and the group is compared as the space that
its modes span: with W the unitary part of the overlaps between both (polar decomposition), the diagonal of W diag(w) W^H holds
the frequencies that belong to the nominal shapes. They pass through a veering smoothly, and their slopes are those of energies.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg as la
from numpy.typing import NDArray

from rotorgear.analysis.scatter.family import Family, sample_at
from rotorgear.analysis.sensitivity.forms import Floats, FormModes, FormNames, Shapes, coupling, modes_of, overlaps
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
        lines: excitations.
        share: least participation that counts.
        shared: (gear, mesh) of the s load shares; empty without statics.
    """

    family: Family
    count: int
    wide: int
    least: float
    nominal: FormModes
    groups: tuple[tuple[int, ...], ...]
    lines: tuple[ExcitationOrder, ...]
    share: float
    shared: tuple[tuple[str, str], ...]

    @cached_property
    def names(self) -> FormNames:
        """Which form is whose."""
        return FormNames.of(self.family.spreads.numbers.model, self.family.speed)

    @cached_property
    def hz(self) -> Floats:
        """Frequencies of the excitations (l,)."""
        return np.array([line.frequency_hz(self.family.speed or 0.0) for line in self.lines])


def run_samples(study: Study, Z: Floats) -> dict[str, Floats]:
    """Values of each sample z of a block Z (b, p): see `_sample`; NaN where a sample has no modes."""
    rows = [_sample(study, z) for z in Z]
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def _sample(study: Study, z: Floats) -> dict[str, Floats]:
    """followed_hz (m,): the frequency of each nominal shape; hz (m,): of the mode assigned to it; margin (l,); shares (s,)."""
    m = study.count
    try:
        forms = study.family.at(z)
        # Frequencies of the nominal shapes and of the modes assigned to them, and how much of each shape its group holds.
        modes, common, at = _assigned(study, forms)
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
        taken = study.names.participations(study.lines, forms, modes)
        shares = shares_at(study, z)
    except (RotorgearError, np.linalg.LinAlgError):
        # A sample beyond what the model can be: counted and said, not hidden.
        sizes = {"followed_hz": m, "hz": m, "margin": len(study.hz), "shares": len(study.shared)}
        return {name: np.full(size, np.nan) for name, size in sizes.items()}
    two_pi = 2.0 * np.pi
    hz = modes.omega / two_pi
    margin = [nearest_margin(hz, row >= study.share, f) for row, f in zip(taken, study.hz, strict=True)]
    return {
        "followed_hz": np.where(held >= LEAST_HELD, followed / two_pi, np.nan)[:m],
        "hz": (own / two_pi)[:m],
        "margin": np.array(margin, dtype=float),
        "shares": shares,
    }


def groups_of(study: Study, Z: Floats) -> tuple[tuple[int, ...], ...]:
    """Nominal modes that turn into each other at some of the samples Z (b, p), as groups; every mode is in one."""
    tied = np.zeros((len(study.nominal.omega),) * 2, dtype=bool)
    for z in Z:
        try:
            _, common, at = _assigned(study, study.family.at(z))
        except (RotorgearError, np.linalg.LinAlgError):
            continue  # counted where the sample itself is run
        tied |= np.abs(common[:, at]) ** 2 > _TURNED
    groups: list[set[int]] = []
    for a, row in enumerate(tied):
        linked = {int(b) for b in np.flatnonzero(row)} | {a}
        joined = [group for group in groups if group & linked]
        groups = [group for group in groups if not group & linked] + [linked.union(*joined)]
    return tuple(sorted(tuple(sorted(group)) for group in groups))


def _assigned(study: Study, forms: Floats) -> tuple[FormModes, Shapes, NDArray[np.intp]]:
    """Modes of a sample, overlaps of nominal and sampled modes (k, k'), and the sampled mode of each nominal one."""
    from scipy.optimize import linear_sum_assignment

    modes = modes_of(forms, len(study.nominal.omega) + SPARE, study.least, study.wide)
    K, M = study.family.nominal[:2]
    common = overlaps(K, M, study.nominal, modes)
    return modes, common, linear_sum_assignment(-(np.abs(common) ** 2))[1]


def nearest_margin(hz: Floats, able: NDArray[np.bool_], line_hz: float) -> float:
    """f / f_line - 1 of the nearest mode that takes part; NaN without one."""
    if not able.any():
        return float("nan")
    ratio = hz[able] / line_hz - 1.0
    return float(ratio[np.argmin(np.abs(ratio))])


def shares_at(study: Study, z: Floats) -> Floats:
    """Load shares of the model at z (p,), with the face maps of the nominal one, (s,); NaN of one that it has not."""
    if not study.shared:
        return np.zeros(0)
    family = study.family
    nominal = state_at(family.spreads.numbers.model, [family.speed])
    model = sample_at(family.spreads, tuple(map(float, z)))
    found = load_shares(solved(model, Plan(1), family.speed, silent, nominal))
    return np.array([found.get(key, np.nan) for key in study.shared])


def frequency_slopes(study: Study) -> Floats:
    """d ln w / dz at the nominal model, (m, p), of the wanted modes."""
    family = study.family
    omega = study.nominal.omega
    Q = study.nominal.q
    slopes = []
    for z in _STEP * np.eye(len(family.spreads)):
        change = (family.at(z)[:3] - family.at(-z)[:3]) / (2.0 * _STEP)
        change = np.array([Q.conj().T @ form @ Q for form in change])
        slopes.append(np.real(np.diagonal(coupling(change, omega))) / omega)
    return np.array(slopes).T[: study.count]


def share_slopes(study: Study) -> Floats:
    """d share / dz at the nominal model, (s, p), by statics on both sides."""
    spreads = study.family.spreads
    found = np.zeros((len(study.shared), len(spreads)))
    if study.shared:
        for j, z in enumerate(_STATIC_STEP * np.eye(len(spreads))):
            above, below = (shares_at(study, side * z) for side in (1.0, -1.0))
            found[:, j] = (above - below) / (2.0 * _STATIC_STEP)
    return found
