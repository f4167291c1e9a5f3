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
from math import cos, pi, sin
from typing import Any, ClassVar

import numpy as np

from rotorgear.forces.law import ForceLaw, Repeats, parameter, refuse
from rotorgear.solvers.contact.kinds import ADHESIVE, BILATERAL, DEAD_ZONE, NON_ADHESIVE, PENETRATION, UNILATERAL
from rotorgear.solvers.lanes.columns import ERROR, PUSH, SLOPE, STIFFNESS, TABLE_ROWS, Column
from rotorgear.solvers.time.compiled import force_function, schedule_function

# The words of model files, and the kinds of contact and damping that compiled code branches on.
GAPS = {"dead zone": DEAD_ZONE, "unilateral": UNILATERAL, "bilateral": BILATERAL}
DAMPINGS = {"non-adhesive": NON_ADHESIVE, "adhesive": ADHESIVE, "penetration": PENETRATION}
# Teeth that part excite at least so many harmonics of their mesh order.
_PARTING = 3
# Coefficients of a tabulated stiffness below this share of the largest do not count as harmonics.
_SMALL = 0.02
_MOST_HARMONICS = 10
_HEAD = 16
_TURN = 2.0 * pi


@schedule_function
def schedule(angle, speed, time, p, s):  # type: ignore[no-untyped-def]
    """Fill k, k', e, e', impact."""
    rate = p[6] * speed
    phase = p[6] * angle + p[7]
    nk = int(p[8])
    ne = int(p[9])
    pieces = int(p[10])
    c1 = np.cos(phase)
    s1 = np.sin(phase)
    place = 16
    for which in range(2):
        value = 0.0
        slope = 0.0
        cn = 1.0
        sn = 0.0
        for n in range(1, (nk if which == 0 else ne) + 1):
            cn, sn = cn * c1 - sn * s1, sn * c1 + cn * s1
            a = p[place]
            b = p[place + 1]
            value += a * cn + b * sn
            slope += n * (b * cn - a * sn)
            place += 2
        if which == 0:
            s[0] = p[0] * (1.0 + value)
            s[1] = p[0] * slope * rate
        else:
            s[2] = p[11] + value
            s[3] = slope * rate
    if pieces > 0:
        share = phase / 6.283185307179586
        share -= np.floor(share)
        if share > 1.0 - 1e-9:
            share -= 1.0
        base = place
        i = 0
        while i < pieces - 1 and share >= p[base + 3 * (i + 1)] - 1e-9:
            i += 1
        left = p[base + 3 * i]
        right = p[base + 3 * (i + 1)] if i < pieces - 1 else 1.0
        rise = p[base + 3 * i + 2] - p[base + 3 * i + 1]
        value = p[base + 3 * i + 1] + rise * (share - left) / (right - left)
        if abs(share - left) <= 1e-9:  # on a jump: the mean of both sides, which keeps the order of an implicit method
            value = 0.5 * (p[base + 3 * i + 1] + p[base + 3 * ((i + pieces - 1) % pieces) + 2])
        s[0] = p[0] * value
        s[1] = p[0] * rise / (right - left) * rate / 6.283185307179586
    s[4] = 0.0
    if p[12] != 0.0:
        share = phase / 6.283185307179586 + p[14]
        share -= np.floor(share)
        if share < p[13]:
            s[4] = p[12] * np.sin(3.141592653589793 * share / p[13])


@force_function
def force(p, s, d, v, F, Kd, Kv, energy):  # type: ignore[no-untyped-def]
    """Force along the line of contact, positive when the working flanks are pressed."""
    c = p[1]
    backlash = p[2]
    gap = int(p[3])
    mode = int(p[4])
    ramp = p[5]
    k = s[0]
    dk = s[1]
    de = s[3]
    x = d[0] - s[2]
    rate = v[0] - de
    side = 0.0
    depth = 0.0
    if gap == 2 or x > 0.0:
        side = 1.0
        depth = x
    elif gap == 0 and x < -backlash:
        side = -1.0
        depth = -x - backlash
    F[0] = s[4]
    Kd[0] = 0.0
    Kv[0] = 0.0
    energy[0] = 0.0
    energy[1] = -s[4] * v[0]
    energy[2] = 0.0
    energy[3] = side
    if side == 0.0:
        return
    elastic = k * depth
    viscous = 0.0
    in_depth = k
    in_rate = 0.0
    if c != 0.0:
        closing = side * rate
        share = 1.0
        slope = 0.0
        if gap != 2 and (mode == 2 or depth < ramp):
            share = depth / ramp
            slope = 1.0 / ramp
        viscous = c * share * closing
        if mode != 1 and gap != 2 and elastic + viscous < 0.0:
            viscous = -elastic
            in_depth = 0.0
        else:
            in_depth += c * slope * closing
            in_rate = c * share
    total = side * (elastic + viscous)
    F[0] += total
    Kd[0] = in_depth
    Kv[0] = in_rate
    energy[0] = 0.5 * k * depth * depth
    energy[1] += 0.5 * dk * depth * depth - total * de
    energy[2] = side * viscous * rate


@dataclass(frozen=True)
class MeshContact(ForceLaw):
    """Contact of one helix of a mesh."""

    title: ClassVar[str] = "tooth contact"

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
        """Return head and tables in a row."""
        k = _pairs(self.stiffness_cos, self.stiffness_sin)
        e = _pairs(self.error_cos, self.error_sin)
        head = [
            self.stiffness,
            self.damping,
            self.backlash,
            GAPS[self.gap],
            DAMPINGS[self.contact_damping],
            self.ramp,
            self.order,
            self.phase,
            len(k) // 2,
            len(e) // 2,
            len(self.pieces),
            self.error_mean,
            self.impact,
            self.impact_share,
            self.impact_phase,
            0.0,
        ]
        return np.array([*head, *k, *e, *(x for piece in self.pieces for x in piece)], dtype=float)

    def closed_stiffness(self) -> np.ndarray:
        """The mean stiffness, as with teeth that never part."""
        return np.array([[self._mean_stiffness()]])

    def reference_stiffness(self) -> np.ndarray:
        """The mean stiffness; nothing for a flank that is mostly open."""
        return self.closed_stiffness() if self.expanded else np.zeros((1, 1))

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
        return replace(
            self,
            stiffness_cos=(),
            stiffness_sin=(),
            pieces=(),
            error_cos=(),
            error_sin=(),
            impact=0.0,
            stiffness=self._mean_stiffness(),
        )

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

    def columns(self, speed: float = 1.0) -> tuple[Column, ...]:
        """The contact, in whole vector registers."""
        return (
            Column(
                GAPS[self.gap],
                DAMPINGS[self.contact_damping],
                self._mean_stiffness(),
                self.damping,
                np.inf if self.gap == "unilateral" else self.backlash,
                self.ramp,
                self.impact,
                counted=True,
            ),
        )

    def table(self, angles: np.ndarray, states: np.ndarray, order: float) -> np.ndarray:
        """k over its mean, e, its slope over the sweep's time, and the impact over its peak."""
        k, _, e, slope, push = states.T
        mean = self._mean_stiffness()
        found = np.zeros((len(angles), 1, TABLE_ROWS))
        found[:, 0, STIFFNESS] = k / mean if mean else 1.0
        found[:, 0, ERROR] = e
        found[:, 0, SLOPE] = slope / order
        found[:, 0, PUSH] = push / self.impact if self.impact else 0.0
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


def _pairs(cosines: tuple[float, ...], sines: tuple[float, ...]) -> list[float]:
    """a_1, b_1, a_2, b_2 ... with zeros for what is missing."""
    count = max(len(cosines), len(sines))
    padded = [(*series, *([0.0] * (count - len(series)))) for series in (cosines, sines)]
    return [float(x) for pair in zip(*padded, strict=True) for x in pair]


def harmonics(amplitudes: tuple[float, ...], phases: tuple[float, ...]) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Cosine and sine parts of sum A_n cos(n p + psi_n)."""
    turned = [(a, phases[n] if n < len(phases) else 0.0) for n, a in enumerate(amplitudes)]
    return tuple(a * cos(psi) for a, psi in turned), tuple(-a * sin(psi) for a, psi in turned)
