"""Large systems of a sweep reduced to few coordinates: one basis for all points that differ in speed and load only.

Frequencies at which a reduced system of a sweep is compared with the whole one.

    harmonics of all that repeats, as far as its law says that they matter and up to the 10th, at up to 16 of the speeds
    an even grid up to the highest of these at the highest speed
    natural frequencies in that range

Compared a little off the axis, s = w (i + 0.005), as with a damping ratio of 0.005 more: models without damping have finite peaks
then, and the frequencies need not hit them.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from fractions import Fraction

import numpy as np

from rotorgear.analysis.common.casings import rates
from rotorgear.analysis.sweep.inside import Inside
from rotorgear.cpu import cpu_seconds
from rotorgear.errors import AnalysisError
from rotorgear.results.sweep import Reduction
from rotorgear.solvers.batch.columns import PRESCRIBED
from rotorgear.solvers.batch.small_system import Shapes
from rotorgear.solvers.frequency.contact_basis import Probes, Scale, candidates, choose, full_receptances, reduced
from rotorgear.solvers.time.local_forces import LocalLaw
from rotorgear.solvers.time.local_system import LocalSystem

_ASIDE = 0.005
_SPEEDS = 16
_GRID = 48
_NATURAL = 96


def probes_for(laws: Sequence[LocalLaw], speeds: Sequence[float], natural: np.ndarray, damping: float = 0.0) -> Probes:
    """Return where receptances are compared.

    Args:
        laws: what acts. speeds: of the reference in rad/s. natural: (p,) rad/s. damping: ratio of all modes that D does not hold.
    """
    several = np.unique(speeds)
    several = several[np.unique(np.linspace(0, len(several) - 1, _SPEEDS).round().astype(int))]
    fastest = float(several[np.argmax(np.abs(several))])
    pairs = [(float(speed), w) for speed in several for w in rates(laws, float(speed))]
    top = rates(laws, fastest).max()
    inside = natural[(natural > 0.0) & (natural <= top)]
    inside = inside[np.unique(np.linspace(0, len(inside) - 1, min(_NATURAL, len(inside))).round().astype(int))]
    pairs += [(fastest, float(w)) for w in (*np.linspace(top / _GRID, top, _GRID), *inside)]
    speed, w = np.array(pairs).T
    return Probes(speed, w * (1j + _ASIDE + damping))


# Coordinates of a reduced system at most: its cost grows with the square of them.
MOST_COORDINATES = 160
# A gearbox in its casing has some 280 modes below the third harmonic of a fast mesh, nearly all of which move its contacts.
MOST_WITH_BODIES = 320
# Modes that are chosen from.
_CANDIDATES = 300


@dataclass(frozen=True)
class Large:
    """A point before its reduction: the whole system, orders of what varies, names of contacts, speed in rad/s, added damping.

    `most`: coordinates that it may have. `inside`: loads that are read.
    """

    local: LocalSystem
    orders: list[Fraction]
    contact: tuple[str, ...]
    speed: float
    modal_ratio: float
    most: int = MOST_COORDINATES
    inside: Inside | None = None

    @property
    def key(self) -> bytes:
        """Bytes that points share which may share a basis."""
        digest = hashlib.blake2b(repr((self.orders, self.modal_ratio)).encode())
        for A in (self.local.M, self.local.D, self.local.K, self.local.B, self.local.G):
            for part in () if A is None else (A.data, A.indices, A.indptr):
                digest.update(np.ascontiguousarray(part).tobytes())
        for B in (self.local.forces.reference_stiffness, self.local.forces.reference_damping):
            digest.update(B.tobytes())
        return digest.digest()


class Reducer:
    """Reduces points of a sweep; modes that have served one model are tried first for the next one.

    Args:
        error: largest relative difference of receptances. modes: a number of modes in place of it, whatever the error.
    """

    def __init__(self, error: float = 0.01, modes: int | None = None) -> None:
        self._error = error
        self._asked = modes
        self._modes: np.ndarray | None = None
        self.found: list[Reduction] = []

    def __call__(
        self, points: Sequence[Large], heard: Callable[[int, float], None]
    ) -> list[tuple[LocalSystem, Shapes]]:
        """Reduce points with the same `key`: the system of each in the common basis, and the shapes of that.

        Args:
            points: at least one. heard: is told the size of the basis and its error while it grows.

        Raises:
            AnalysisError: no basis reaches the wanted error.
        """
        begun = cpu_seconds()
        first = max(points, key=lambda point: abs(point.speed))
        local = first.local
        scale = scale_of(first.local)
        # Shapes are for what the motion makes: prescribed forces are loads of their own.
        kinds = [column.kind for law in local.forces.laws for column in law.columns()]
        acting = np.flatnonzero(np.array(kinds) != PRESCRIBED)
        # Independent directions (n, l) of the loads.
        loads = np.unique(np.array([point.local.load for point in points]), axis=0).T
        loads = loads[:, np.any(loads != 0.0, axis=0)]
        if loads.shape[1]:
            U, sizes, _ = np.linalg.svd(loads, full_matrices=False)
            loads = np.asarray(U[:, sizes > 1e-10 * sizes[0]])
        among = candidates(local, loads, acting, _CANDIDATES)
        top = float(rates(local.forces.laws, first.speed).max())
        probes = probes_for(local.forces.laws, [point.speed for point in points], among.w, first.modal_ratio)
        full = full_receptances(local, probes)
        # The modes of the last model where they do; else chosen anew.
        old = self._modes
        if old is not None and not np.all((old >= among.rigid) & (old < among.rigid + among.modes)):
            old = None
        choice = choose(among, full, probes, scale, self._error, first.most, old, self._asked, heard)
        complete = choice.basis.shape[1] == local.n  # what is left then is rounding
        if self._asked is None and not (complete or choice.error <= self._error):
            way = (
                "run single speeds by the transient analysis"
                if first.most == MOST_WITH_BODIES
                else "lump the shafts (rigid gears on springs)"
            )
            raise AnalysisError(
                f"{local.n} dofs can't be reduced: with {choice.basis.shape[1]} coordinates (at most {first.most}) the "
                f"receptances at the contacts are {100.0 * choice.error:.2g} % off up to {top / 2.0 / np.pi:.6g} Hz, expected "
                f"{100.0 * self._error:.2g} %; lower the speed, {way}, or allow more (reduction_error, --reduction-error)"
            )
        own, V = reduced(local, among, choice.basis)
        shapes = Shapes.of(V, local.M, top)
        self._modes = choice.modes
        self.found.append(
            Reduction(
                local.n,
                own.n,
                len(choice.modes),
                float(among.w[choice.modes].max(initial=0.0)) / (2.0 * np.pi),
                among.rigid,
                own.n - len(choice.modes) - among.rigid,
                choice.closed,
                choice.apart,
                top / (2.0 * np.pi),
                probes.count,
                1,
                cpu_seconds() - begun,
                first.inside.difference(local, own, V, probes) if first.inside else 0.0,
            )
        )
        return [(replace(own, load=V.T @ point.local.load, forces=point.local.forces), shapes) for point in points]

    @property
    def summary(self) -> Reduction | None:
        """All bases as one: the largest values."""
        if not self.found:
            return None
        worst = {item.name: max(getattr(one, item.name) for one in self.found) for item in fields(Reduction)}
        return Reduction(**worst | {"bases": len(self.found), "seconds": sum(one.seconds for one in self.found)})


def scale_of(local: LocalSystem) -> Scale:
    """What receptances of a system are measured by: the stiffness of its laws with all contacts closed."""
    forces = local.forces
    root = np.zeros(forces.m)
    for law, at in zip(forces.laws, forces.first, strict=False):
        root[at : at + law.components] = np.sqrt(np.maximum(np.diag(law.closed_stiffness()), 0.0))
    return Scale(forces.reference_stiffness, forces.reference_damping, root)
