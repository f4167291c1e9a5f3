"""Classes of modes of planetary stages: rotational, translational, and of the planets alone.

Of N equal, equally spaced planets with displacements p_i in their own axes (outwards, onwards, along z), at the directions psi_i,

    c_k = N^{-1/2} sum_i p_i e^{-i k psi_i},    k = 0 ... N - 1,

keep the kinetic energy: sum_i p_i^H M p_i = sum_k c_k^H M c_k. Where springs to the ground have no preferred directions, a mode
has one class alone (Lin and Parker, J. Vib. Acoust. 121 (1999) 316; helical sets: Eritenel and Parker, J. Sound Vib. 325 (2009)
397):

* k = 0, rotational: all planets move alike, central shafts along and about their axes;
* k = 1 and N - 1, translational: they follow what moves the central shafts sideways or tilts them;
* the others, of planets alone: central shafts rest.

Elsewhere a mode has a share of each. A motion e^{i w t} of class k = 1 is seen from a carrier of speed W at w + W, k = N - 1 at
w - W, all others at w (`system/planets.py`). Of a central shaft, q - i S q with the quarter turn S of its plane belongs to
k = N - 1, for it goes round in the sense of +z.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg as la

from rotorgear.analysis.modal.solve import Modes
from rotorgear.model.layout.carriers import PlanetSet
from rotorgear.model.layout.layout import Layout
from rotorgear.results.modal import MODE_CLASSES
from rotorgear.system.groups import ElementGroup, by_motion
from rotorgear.system.planets import quarter_turn, sisters
from rotorgear.system.system import System

# Rows of energies by class; the two senses of translational motions are told apart by how a carrier sees them.
_ROTATIONAL, _AHEAD, _BEHIND, _PLANET = range(4)
_CLASS = np.array([0, 1, 1, 2])  # of each row, into MODE_CLASSES
_SHIFT = np.array([0.0, 1.0, -1.0, 0.0])  # speeds of the carrier by which it sees a row at another frequency
# Frequencies closer than this are one, and any combination of their shapes is a mode.
_ONE_FREQUENCY = 1e-9
# What of a class rounding leaves in a mode of another one.
_NOTHING = 1e-9
# Share of the kinetic energy of a mode below which a stage has no class in it.
_LEAST = 0.01
# Share of a stage's energy from which on its other classes are not told.
_PURE = 0.995
_AXIAL = "axial"
# What a helix couples with the motions of a class, and what moves apart from them in a spur stage.
_BESIDE = {"rotational": "axial", "translational": "tilting"}


@dataclass(frozen=True)
class PlanetClasses:
    """Classes of m modes of a model with planets; empty without them.

    Attributes:
        energy: "CARRIER CLASS" -> share of the kinetic energy (m,).
        words: the classes of each mode in a few words, (m).
        shift: carrier that turns -> what it adds to the frequency of the largest part of its stage, in rad/s (m,); NaN where
            that rests.
        seen_share: carrier that turns -> share of that part in the energy of the stage (m,).
    """

    energy: dict[str, np.ndarray]
    words: tuple[str, ...]
    shift: dict[str, np.ndarray]
    seen_share: dict[str, np.ndarray]

    def seen_hz(self, s: np.ndarray) -> dict[str, np.ndarray]:
        """Carrier that turns -> frequency in Hz at which it sees the largest part of its stage, of eigenvalues s (m,)."""
        return {carrier: np.abs(s.imag + shift) / (2.0 * np.pi) for carrier, shift in self.shift.items()}


@dataclass(frozen=True)
class _Stage:
    """A carrier with its planets, and the shafts on its axis that carry or touch them."""

    carrier: str
    shaft: str
    central: frozenset[str]
    planets: frozenset[str]
    helical: bool

    @property
    def shafts(self) -> frozenset[str]:
        return self.central | self.planets


@dataclass(frozen=True)
class _Part:
    """A motion (e, d, m) of elements with mass M (e, d, d) that belongs to one row of classes."""

    stage: _Stage
    row: int
    M: np.ndarray
    motion: np.ndarray
    axial: np.ndarray


def _stages(layout: Layout) -> list[_Stage]:
    """The stages whose planets have classes: two or more, equally spaced."""
    sets: dict[str, list[PlanetSet]] = {}
    for planets in layout.planets:
        sets.setdefault(planets.carrier, []).append(planets)
    found = []
    for carrier, members in sets.items():
        part = members[0].part
        if not part.is_regular and part.planets != 2:
            continue
        carried = frozenset(name for one in members for name in one.planets)
        meshes = [mesh for mesh in layout.meshes if any(gear.shaft in carried for gear in mesh.gears)]
        beside = {gear.shaft for mesh in meshes for gear in mesh.gears} | {part.shaft}
        # The helices of a herringbone push against each other.
        helical = any(sum(c.hand * np.sin(c.base_helix_angle) for c in mesh.contacts) != 0.0 for mesh in meshes)
        found.append(_Stage(carrier, part.shaft, frozenset(beside) - carried, carried, helical))
    return found


def _parts(system: System, stages: list[_Stage], q: np.ndarray) -> Iterator[_Part]:
    """All that moves of some stages in displacements q (a, m) of all dofs, class by class."""
    layout = system.layout
    sets = {planet: planets for planets in layout.planets for planet in planets.planets}
    by_carrier = {stage.carrier: stage for stage in stages}
    heavy = [group for group in system.groups if group.matrices.mass is not None]
    for carrier, alike in sisters(layout, heavy):
        stage = by_carrier.get(carrier)
        if stage is not None:
            yield from _of_planets(stage, alike, sets[alike[0].shaft].angles, q, plane=system.model.has("bending"))
    for stage in stages:
        for group in heavy:
            if group.shaft in stage.central and not group.body_motions:
                yield from _of_central(stage, group, q)


def _of_planets(
    stage: _Stage, alike: list[ElementGroup], angles: np.ndarray, q: np.ndarray, *, plane: bool
) -> Iterator[_Part]:
    """A part of all planets; in a model without bending (`plane` False) nothing follows translations."""
    local = np.stack([q[group.dofs] for group in alike])
    N = len(alike)
    M, axial = _mass(alike[0])
    for k in range(N):
        wave = np.exp(-1j * k * angles) / np.sqrt(N)
        row = _ROTATIONAL if k == 0 else _AHEAD if k == 1 else _BEHIND if k == N - 1 else _PLANET
        if not plane and k:
            row = _PLANET
        yield _Part(stage, row, M, np.tensordot(wave, local, axes=1), axial)


def _of_central(stage: _Stage, group: ElementGroup, q: np.ndarray) -> Iterator[_Part]:
    """A part of a shaft on the axis of a carrier."""
    local = q[group.dofs]
    M, axial = _mass(group)
    dofs, _ = by_motion(group.dof_motions)
    bends = np.isin(np.arange(local.shape[1]), dofs.get("bending", ()))
    yield _Part(stage, _ROTATIONAL, M, np.where(bends[:, None], 0.0, local), axial)
    turned = np.einsum("cd,edm->ecm", quarter_turn(group), local)
    for row, sense in ((_AHEAD, 1j), (_BEHIND, -1j)):
        yield _Part(stage, row, M, np.where(bends[:, None], 0.5 * (local + sense * turned), 0.0), axial)


def _mass(group: ElementGroup) -> tuple[np.ndarray, np.ndarray]:
    """The mass (e, d, d) between dofs of one motion, as energies are summed, and which dofs (d,) move along z."""
    dofs, same = by_motion(group.dof_motions)
    assert group.matrices.mass is not None
    return group.matrices.mass * same, np.isin(np.arange(same.shape[0]), dofs.get(_AXIAL, ()))


def separated(system: System, modes: Modes) -> Modes:
    """The same modes, those of one frequency combined such that each has one class."""
    stages = _stages(system.layout)
    if not stages:
        return modes
    s = modes.eigenvalues
    vectors = modes.vectors
    first = 0
    while first < len(s):
        last = first + 1
        while last < len(s) and abs(s[last] - s[first]) <= _ONE_FREQUENCY * abs(s[first]):
            last += 1
        if last - first > 1 and not modes.rigid[first:last].any():
            turn = _pure_combinations(system, stages, vectors[:, first:last])
            if turn is not None:
                turned = vectors[:, first:last] @ turn
                vectors = vectors.copy() if vectors is modes.vectors else vectors
                vectors[:, first:last] = turned
        first = last
    return modes if vectors is modes.vectors else replace(modes, vectors=vectors)


def _pure_combinations(system: System, stages: list[_Stage], V: np.ndarray) -> np.ndarray | None:
    """Combinations (r, r) of shapes V (n, r) of which each has one class; None where it has already.

    Energies of two pure shapes have cross terms within their common class alone: the eigenvectors of the weighted sum of the
    forms of all classes against the plain one are pure.
    """
    r = V.shape[1]
    forms: dict[tuple[str, int], np.ndarray] = {}
    for part in _parts(system, stages, system.dofs.expand(V)):
        form = np.einsum("edr,eds->rs", part.motion.conj(), part.M @ part.motion)
        # Shapes that are real stay so: both senses of a translation count as one class.
        form = form if np.iscomplexobj(V) else form.real
        key = (part.stage.carrier, int(_CLASS[part.row]) if not np.iscomplexobj(V) else part.row)
        forms[key] = forms.get(key, np.zeros((r, r))) + form
    plain = np.asarray(sum(forms.values()))
    sizes = np.array([form.diagonal().real for form in forms.values()])
    whole = np.where(sizes.sum(axis=0) > 0.0, sizes.sum(axis=0), 1.0)
    if np.all(np.max(sizes, axis=0) >= (1.0 - _NOTHING) * whole):
        return None
    weighted = np.asarray(sum((k + 1.0) * form for k, form in enumerate(forms.values())))
    M = V.conj().T @ (system.mass @ V)
    try:
        turn = la.eigh(weighted, plain + _NOTHING * M)[1]
    except la.LinAlgError:
        return None
    norm = np.sqrt(np.einsum("rk,rs,sk->k", turn.conj(), M, turn).real)
    return np.asarray(turn / norm)


def classes_of(
    system: System, q: np.ndarray, kinetic_by_shaft: dict[tuple[str, str], np.ndarray], speeds: float | np.ndarray
) -> PlanetClasses:
    """The classes of modes with displacements q (a, m) of all dofs.

    Args:
        kinetic_by_shaft: their kinetic energies, as of `mode_energies`.
        speeds: of the reference shaft in rad/s, of all modes or of each (m,).
    """
    m = q.shape[1]
    stages = _stages(system.layout)
    rows = {stage.carrier: np.zeros((4, m)) for stage in stages}
    axial = {stage.carrier: np.zeros((4, m)) for stage in stages}
    for part in _parts(system, stages, q):
        by_dof = np.einsum("edm,edm->dm", part.motion.conj(), part.M @ part.motion).real
        rows[part.stage.carrier][part.row] += by_dof.sum(axis=0)
        axial[part.stage.carrier][part.row] += by_dof[part.axial].sum(axis=0)
    energy: dict[str, np.ndarray] = {}
    shift: dict[str, np.ndarray] = {}
    seen_share: dict[str, np.ndarray] = {}
    said: list[dict[str, list[str]]] = [{} for _ in range(m)]
    for stage in stages:
        own = rows[stage.carrier]
        total = own.sum(axis=0)
        share = np.sum([v for (shaft, _), v in kinetic_by_shaft.items() if shaft in stage.shafts], axis=0)
        parts = own / np.where(total > 0.0, total, 1.0)
        for number, name in enumerate(MODE_CLASSES):
            energy[f"{stage.carrier} {name}"] = share * parts[number == _CLASS].sum(axis=0)
        if system.train.ratios[stage.shaft] != 0 and not system.is_seen_from_carrier:
            W = np.asarray(speeds) * system.train.ratio(stage.shaft)
            shifts = np.unique(_SHIFT)
            by_shift = np.stack([parts[shift == _SHIFT].sum(axis=0) for shift in shifts])
            rests = share < _LEAST
            shift[stage.carrier] = np.where(rests, np.nan, W * shifts[by_shift.argmax(axis=0)])
            seen_share[stage.carrier] = np.where(rests, np.nan, by_shift.max(axis=0))
        for mode in np.flatnonzero(share >= _LEAST):
            text = _words(stage, own[:, mode], axial[stage.carrier][:, mode])
            said[mode].setdefault(text, []).append(stage.carrier)
    # Of several stages each is named, those of one class together.
    named = len(stages) > 1
    words = ("; ".join(f"{' and '.join(who)}: {text}" if named else text for text, who in of.items()) for of in said)
    return PlanetClasses(energy, tuple(words), shift, seen_share)


def _words(stage: _Stage, energy: np.ndarray, axial: np.ndarray) -> str:
    """The classes of one mode, from the energies of its rows (4,) and what of them moves along the axis.

    That with nearly all of the energy, or each with its share.
    """
    own, along = (
        np.array([of[number == _CLASS].sum() for number in range(len(MODE_CLASSES))]) for of in (energy, axial)
    )
    shares = own / own.sum()
    names = []
    for number, name in enumerate(MODE_CLASSES):
        beside = _BESIDE.get(name, name)
        moves_beside = along[number] > 0.5 * own[number]
        coupled = stage.helical and beside != name
        names.append(f"{name}-{beside}" if coupled else beside if moves_beside else name)
    order = np.argsort(-shares, kind="stable")
    if shares[order[0]] >= _PURE:
        return names[order[0]]
    return ", ".join(f"{names[k]} {100.0 * shares[k]:.0f} %" for k in order if shares[k] >= 1.0 - _PURE)
