"""Tooth contact along the flank normal: backlash, k(t), e(t), non-adhesive, adhesive or penetration-proportional damping.

    x = d - e(p) - s     working flank: penetration = x     coast flank (dead zone): penetration = -x - j
    F = k(p) penetration + c penetration'   on the working flank, the opposite on the coast flank;   p = order * angle + phase

`gap = "dead zone"`: both flanks on one line of action (Kahraman and Singh, J. Sound Vib. 142 (1990) 49); "unilateral": the
working flank alone, so that each flank may have its own normal; "bilateral": contact is never lost (linear).
Damping: "non-adhesive" never pulls, F >= 0; "adhesive" may pull while the flanks touch; "penetration": the coefficient is
c penetration/reference (Hunt and Crossley, J. Applied Mechanics 42 (1975) 440), and the force never pulls. Over the first `ramp`
of penetration, the regularisation depth, the damping grows from zero, so that the force is continuous.
k(p) = k [1 + sum a_n cos(n p) + b_n sin(n p)], or piecewise linear in p; e(p) alike. A half-sine `impact` adds to the force.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import chain, zip_longest
from math import pi
from typing import Any, ClassVar

import numpy as np

from rotorgear.forces.law import ForceLaw, Repeats, parameter, refuse
from rotorgear.solvers.batch.columns import ERROR, FORCE_SHARE, SLOPE, STIFFNESS, TABLE_ROWS, Column
from rotorgear.solvers.contact.gap_contact import contact, momentum
from rotorgear.solvers.contact.kinds import ADHESIVE, BILATERAL, DEAD_ZONE, NON_ADHESIVE, PENETRATION, UNILATERAL
from rotorgear.solvers.time.compiled import force_function, schedule_function

# The words of model files, and the kinds of contact and damping that compiled code branches on.
GAPS = {"dead zone": DEAD_ZONE, "unilateral": UNILATERAL, "bilateral": BILATERAL}
DAMPINGS = {"non-adhesive": NON_ADHESIVE, "adhesive": ADHESIVE, "penetration": PENETRATION}
# Least number of harmonics of the mesh order that teeth which part excite.
_PARTING = 3
# Coefficients of a tabulated stiffness below this share of the largest do not count as harmonics.
_SMALL = 0.02
_MOST_HARMONICS = 10
_TURN = 2.0 * pi
# Nearer than this share of a cycle to the start of a piece is on it.
_ON_JUMP = 1e-9
# Places of the parameters, which tables follow: cosine and sine of each harmonic of k, then of e, then the pieces of k.
K, C, BACKLASH, GAP, MODE, PER_DEPTH, ORDER, PHASE = range(8)
E_MEAN, PUSH, PUSH_SHARE, PUSH_PHASE, HARMONICS_K, HARMONICS_E, PIECES, TABLES = range(8, 16)
# Places of the state: k, its rate, e, its rate, impact.
K_NOW, K_RATE, E_NOW, E_RATE, PUSH_NOW = range(5)
# A piece of k: its start as a share of the mesh cycle, its first and its last value.
START, FIRST, LAST = range(3)
PIECE = 3


@schedule_function
def schedule(angle, speed, time, p, s):  # type: ignore[no-untyped-def]
    """Fill k, k', e, e', impact."""
    rate = p[ORDER] * speed
    phase = p[ORDER] * angle + p[PHASE]
    pieces = int(p[PIECES])
    c1 = np.cos(phase)
    s1 = np.sin(phase)
    place = TABLES
    for which in range(2):
        value = 0.0
        slope = 0.0
        cn = 1.0
        sn = 0.0
        for n in range(1, int(p[HARMONICS_K] if which == 0 else p[HARMONICS_E]) + 1):
            # cos(n p), sin(n p) by the addition theorem, for a call of both costs more than the rest of the loop.
            cn, sn = cn * c1 - sn * s1, sn * c1 + cn * s1
            a = p[place]
            b = p[place + 1]
            value += a * cn + b * sn
            slope += n * (b * cn - a * sn)
            place += 2
        if which == 0:
            s[K_NOW] = p[K] * (1.0 + value)
            s[K_RATE] = p[K] * slope * rate
        else:
            s[E_NOW] = p[E_MEAN] + value
            s[E_RATE] = slope * rate
    if pieces > 0:
        share = phase / _TURN
        share -= np.floor(share)
        if share > 1.0 - _ON_JUMP:
            share -= 1.0
        i = 0
        while i < pieces - 1 and share >= p[place + PIECE * (i + 1) + START] - _ON_JUMP:
            i += 1
        at = place + PIECE * i
        length = (p[at + PIECE + START] if i < pieces - 1 else 1.0) - p[at + START]
        rise = p[at + LAST] - p[at + FIRST]
        value = p[at + FIRST] + rise * (share - p[at + START]) / length
        if abs(share - p[at + START]) <= _ON_JUMP:
            # On a jump: the mean of both sides, which keeps the order of an implicit method.
            value = 0.5 * (p[at + FIRST] + p[place + PIECE * ((i + pieces - 1) % pieces) + LAST])
        s[K_NOW] = p[K] * value
        s[K_RATE] = p[K] * rise / length * rate / _TURN
    s[PUSH_NOW] = 0.0
    if p[PUSH] != 0.0:
        share = phase / _TURN + p[PUSH_PHASE]
        share -= np.floor(share)
        if share < p[PUSH_SHARE]:
            s[PUSH_NOW] = p[PUSH] * np.sin(pi * share / p[PUSH_SHARE])


@force_function
def force(p, s, d, v, F, Kd, Kv, energy):  # type: ignore[no-untyped-def]
    """Force along the line of contact, positive when the working flanks are pressed."""
    k = s[K_NOW]
    rate = v[0] - s[E_RATE]
    now = contact(int(p[GAP]), int(p[MODE]), k, p[C], p[BACKLASH], p[PER_DEPTH], d[0] - s[E_NOW], rate)
    F[0] = s[PUSH_NOW] + now.force
    Kd[0] = now.stiffness
    Kv[0] = now.damping
    energy[0] = 0.5 * k * now.depth * now.depth
    energy[1] = 0.5 * s[K_RATE] * now.depth * now.depth - now.force * s[E_RATE] - s[PUSH_NOW] * v[0]
    energy[2] = now.resisted * now.side * rate
    energy[3] = now.side


@dataclass(frozen=True)
class MeshContact(ForceLaw):
    """Contact of one helix of a mesh."""

    title: ClassVar[str] = "tooth contact"
    conserves: ClassVar[bool] = True

    stiffness: float = parameter("N/m", "mean stiffness k along the flank normal", least=0.0)
    damping: float = parameter("N s/m", "damping coefficient c", 0.0, least=0.0)
    backlash: float = parameter("m", "backlash j along the flank normal", 0.0, least=0.0)
    gap: str = parameter("", "dead zone, unilateral or bilateral", "dead zone", choices=tuple(GAPS))
    contact_damping: str = parameter(
        "", "non-adhesive, adhesive or penetration", "non-adhesive", choices=tuple(DAMPINGS)
    )
    ramp: float = parameter(
        "m",
        "regularisation depth, over which the damping grows to c; the reference depth of penetration damping",
        1e-9,
        above=0.0,
    )
    order: float = parameter("rad/rad", "mesh phase for each radian of the reference", 0.0)
    phase: float = parameter("rad", "mesh phase at angle 0", 0.0)
    stiffness_cos: tuple[float, ...] = parameter("", "a_n of k(p), relative to k", ())
    stiffness_sin: tuple[float, ...] = parameter("", "b_n of k(p), relative to k", ())
    pieces: tuple[tuple[float, float, float], ...] = parameter(
        "", "k(p)/k in place of harmonics: start as a share of the mesh cycle, value there, value at its end", ()
    )
    error_mean: float = parameter("m", "constant part of e", 0.0)
    error_cos: tuple[float, ...] = parameter("m", "a_n of e(p)", ())
    error_sin: tuple[float, ...] = parameter("m", "b_n of e(p)", ())
    impact: float = parameter("N", "peak of a half-sine force once a mesh cycle", 0.0)
    impact_share: float = parameter("", "its duration as a share of the mesh cycle", 0.25, above=0.0, most=1.0)
    impact_phase: float = parameter("", "share of the cycle by which it comes earlier", 0.0)
    expanded: bool = parameter("", "whether solvers expand about k and c: not on a flank that is mostly open", True)

    def check(self) -> None:
        """The pieces of the stiffness follow each other through the mesh cycle."""
        starts = [piece[0] for piece in self.pieces]
        if starts and (starts[0] != 0.0 or sorted(set(starts)) != starts or starts[-1] >= 1.0):
            raise refuse(self, "pieces", "rising starts from 0 to below 1")

    @property
    def uses_velocity(self) -> bool:
        """With damping, or an impact that does work."""
        return bool(self.damping or self.impact)

    def functions(self) -> tuple[Any, Any]:
        """Return the compiled functions schedule and force."""
        return schedule, force

    def state_size(self) -> int:
        """k, k', e, e' and the impact."""
        return 5

    def parameters(self) -> np.ndarray:
        """Return what is one number, then the tables, of which the numbers of entries come before them."""
        k = pairs(self.stiffness_cos, self.stiffness_sin)
        e = pairs(self.error_cos, self.error_sin)
        words = [GAPS[self.gap], DAMPINGS[self.contact_damping]]
        head = [self.stiffness, self.damping, self._clearance, *words, 1.0 / self.ramp, self.order, self.phase]
        head += [self.error_mean, self.impact, self.impact_share, self.impact_phase]
        counts = [len(k) // 2, len(e) // 2, len(self.pieces)]
        return np.array([*head, *counts, *k, *e, *(x for piece in self.pieces for x in piece)], dtype=float)

    def closed_stiffness(self) -> np.ndarray:
        """The mean stiffness, as with teeth that never part."""
        return np.array([[self._mean_stiffness()]])

    def reference_stiffness(self) -> np.ndarray:
        """The mean stiffness; nothing for a flank that is mostly open."""
        return self.closed_stiffness() if self.expanded else np.zeros((1, 1))

    @property
    def steady(self) -> bool:
        """Neither harmonics, nor pieces that differ, nor an impact: teeth that may part repeat, but excite nothing."""
        harmonics = any(map(any, (self.stiffness_cos, self.stiffness_sin, self.error_cos, self.error_sin)))
        values = {value for _, *ends in self.pieces for value in ends}
        return not (self.order and (harmonics or len(values) > 1 or self.impact))

    @property
    def can_part(self) -> bool:
        """Unless bilateral."""
        return self.gap != "bilateral"

    @property
    def _clearance(self) -> float:
        """Backlash; without end where there is no back flank."""
        return np.inf if self.gap == "unilateral" else self.backlash

    def _mean_stiffness(self) -> float:
        mean = 1.0
        if self.pieces:
            ends = [*(piece[0] for piece in self.pieces[1:]), 1.0]
            mean = sum(0.5 * (a + b) * (end - start) for (start, a, b), end in zip(self.pieces, ends, strict=True))
        return self.stiffness * mean

    def reference_damping(self) -> np.ndarray:
        """c, as with teeth that never part."""
        return np.array([[self.damping if self.expanded and self.contact_damping != "penetration" else 0.0]])

    def mean(self) -> MeshContact:
        """Return the contact without anything that varies in time."""
        varying: dict[str, Any] = dict.fromkeys(
            ("stiffness_cos", "stiffness_sin", "pieces", "error_cos", "error_sin"), ()
        )
        return replace(self, **varying, impact=0.0, stiffness=self._mean_stiffness())

    def repeats(self) -> tuple[Repeats, ...]:
        """The mesh cycle, with the harmonics that are tabulated, and at least 3 where teeth part."""
        if not self.order:
            return ()
        highest = [1, len(self.stiffness_cos), len(self.error_cos), 1 if self.gap == "bilateral" else _PARTING]
        if self.pieces:
            sizes = np.abs(np.fft.rfft([share for _, share, _ in self.pieces]))[1 : _MOST_HARMONICS + 1]
            highest.append(1 + int(np.flatnonzero(sizes >= _SMALL * sizes.max(initial=0.0)).max(initial=0)))
        if self.impact:
            highest.append(int(np.ceil(1.0 / self.impact_share)))
        return (Repeats(abs(self.order), max(highest)),)

    def impulse(self, d: Any, *, angle: float = 0.0) -> np.ndarray:
        """c times the integral of the damping's share over the approach d - e, where damping sets in with contact."""
        if self.gap == "bilateral" or self.contact_damping == "penetration":
            return np.zeros(1)
        state = np.zeros(self.state_size())
        schedule(angle, 0.0, 0.0, self.parameters(), state)
        x = float(np.ravel(d)[0]) - float(state[E_NOW])
        return np.array([self.damping * momentum(self._clearance, self.ramp, 1.0 / self.ramp, x).integral])

    def columns(self, speed: float = 1.0) -> tuple[Column, ...]:
        """The contact, in whole vector registers."""
        kinds = (GAPS[self.gap], DAMPINGS[self.contact_damping])
        sizes = (self._mean_stiffness(), self.damping, self._clearance, self.ramp, self.impact)
        return (Column(*kinds, *sizes, counted=True),)

    def table(self, angles: np.ndarray, states: np.ndarray, order: float) -> np.ndarray:
        """k over its mean, e, its slope over the sweep's time, and the impact over its peak."""
        k, _, e, slope, push = states.T
        mean = self._mean_stiffness()
        found = np.zeros((len(angles), 1, TABLE_ROWS))
        found[:, 0, STIFFNESS] = k / mean if mean else 1.0
        found[:, 0, ERROR] = e
        found[:, 0, SLOPE] = slope / order
        found[:, 0, FORCE_SHARE] = push / self.impact if self.impact else 0.0
        return found

    def table_key(self) -> bytes:
        """All that shapes k, e and the impact; of the sizes k and impact, only whether there is one."""
        sizes = {"stiffness", "damping", "backlash", "gap", "contact_damping", "ramp", "impact", "expanded"}
        shape = [getattr(self, name) for name in self.declared() if name not in sizes]
        return repr([bool(self.stiffness), bool(self.impact), *shape]).encode()

    @classmethod
    def examples(cls) -> tuple[MeshContact, ...]:
        """One of each gap and damping, with harmonics of stiffness and error."""
        ripple: dict[str, Any] = {
            "order": 20.0,
            "phase": 0.3,
            "stiffness_cos": (0.2, 0.05),
            "stiffness_sin": (0.1,),
            "error_cos": (2e-6,),
            "error_sin": (1e-6,),
        }
        return (
            cls(3e8, 900.0, 40e-6, ramp=2e-6, **ripple),
            cls(3e8, 900.0, 40e-6, contact_damping="adhesive", ramp=2e-6, **ripple),
            cls(3e8, 900.0, 40e-6, gap="unilateral", contact_damping="penetration", ramp=2e-5, **ripple),
            cls(3e8, 900.0, gap="bilateral", **ripple),
            cls(3e8, 900.0, 10e-6, ramp=2e-6, order=3.0, pieces=((0.0, 0.8, 1.0), (0.4, 1.2, 1.1)), impact=50.0),
        )


def pairs(cosines: tuple[float, ...], sines: tuple[float, ...]) -> list[float]:
    """a_1, b_1, a_2, b_2 ... with zeros for what is missing."""
    return [float(x) for x in chain.from_iterable(zip_longest(cosines, sines, fillvalue=0.0))]
