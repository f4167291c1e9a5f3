"""Sliding friction of the teeth of one helix: it acts across the line of action, with the place of contact as its arm.

Displacements: d0 along the flank normal, which gives the normal force N of `mesh_contact`, d1 across the line of
action at the pitch
point, d2 the relative rotation. At the place xi of a contact, xi = p_bt (p/2 pi) from the pitch point, the flanks slide with

    v_s = xi W + d1' + xi d2',    W = |w_p| + |w_g|,    F1 = sum F_s,  F2 = sum xi F_s,   F_s = mu N_j tanh(v_s/v_0)

All contacts between the two ends of the path share N evenly. Helical teeth are cut into slices across the face whose phase lags.
mu is given, or Benedict and Kelley's, ASLE Trans. 4 (1961) 59:  mu = 0.0127 log10(29.66 w/(eta v_s v_r^2)), w in N/m,
eta in mPa s.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from rotorgear.forces import mesh_contact
from rotorgear.forces.law import ForceLaw, Repeats, parameter, refuse
from rotorgear.forces.mesh_contact import MeshContact
from rotorgear.solvers.time.compiled import force_function, schedule_function

_HEAD = 16
_SLICES = 9
_STATE = 5
_normal_schedule = mesh_contact.schedule
_normal_force = mesh_contact.force


@schedule_function
def schedule(angle, speed, time, p, s):  # type: ignore[no-untyped-def]
    """Fill the state of the contact, W, and for each place of contact xi and its share of mu N."""
    _normal_schedule(angle, speed, time, p[16:], s[:5])
    pitch = p[0]
    start = p[1]
    end = p[2]
    overlap = p[3]
    slices = int(p[4])
    mu = p[5]
    viscosity = p[6]
    line_load = p[7]
    closing = p[8]
    rolling = p[9]
    s[5] = closing * speed
    cycle = p[16 + 6] * angle + p[16 + 7]
    total = 0.0
    for i in range(slices):
        late = overlap * ((i + 0.5) / slices - 0.5)
        share = cycle / 6.283185307179586 - late
        first = pitch * (share - np.floor(share))
        while first - pitch >= start:
            first -= pitch
        count = 0
        for j in range(4):
            s[7 + 8 * i + 2 * j] = 0.0
            s[8 + 8 * i + 2 * j] = 0.0
            xi = first + j * pitch
            if start <= xi <= end:
                count += 1
                s[7 + 8 * i + 2 * j] = xi
                s[8 + 8 * i + 2 * j] = 1.0
        for j in range(4):
            if s[8 + 8 * i + 2 * j] > 0.0:
                coefficient = mu
                if viscosity > 0.0:
                    slide = max(abs(s[7 + 8 * i + 2 * j] * s[5]), p[10])
                    roll = max(abs(rolling * speed), p[10])
                    x = 29.66 * line_load / (viscosity * slide * roll * roll)
                    coefficient = min(max(0.0127 * np.log10(max(x, 1.0)), 0.0), 0.2)
                s[8 + 8 * i + 2 * j] = coefficient
        total += count
    s[6] = total


@force_function
def force(p, s, d, v, F, Kd, Kv, energy):  # type: ignore[no-untyped-def]
    """Friction across the line of action and its moment; the normal force itself acts in a law of its own."""
    for i in range(3):
        F[i] = 0.0
    for i in range(9):
        Kd[i] = 0.0
        Kv[i] = 0.0
    n = np.zeros(1)
    kd = np.zeros(1)
    kv = np.zeros(1)
    e = np.zeros(4)
    _normal_force(p[16:], s[:5], d[:1], v[:1], n, kd, kv, e)
    energy[0] = 0.0
    energy[1] = 0.0
    energy[2] = 0.0
    energy[3] = e[3]
    if s[6] == 0.0:
        return
    N = abs(n[0])
    sign = 1.0 if n[0] >= 0.0 else -1.0
    for i in range(int(p[4])):
        for j in range(4):
            mu = s[8 + 8 * i + 2 * j]
            if mu == 0.0:
                continue
            xi = s[7 + 8 * i + 2 * j]
            driven = xi * s[5]
            slide = driven + v[1] + xi * v[2]
            t = np.tanh(slide / p[10])
            one = mu * N / s[6]
            own = one * t
            slope = one * (1.0 - t * t) / p[10]
            F[1] += own
            F[2] += xi * own
            Kv[4] += slope
            Kv[5] += xi * slope
            Kv[7] += xi * slope
            Kv[8] += xi * xi * slope
            Kd[3] += mu / s[6] * t * sign * kd[0]
            Kd[6] += xi * mu / s[6] * t * sign * kd[0]
            Kv[3] += mu / s[6] * t * sign * kv[0]
            Kv[6] += xi * mu / s[6] * t * sign * kv[0]
            energy[1] += own * driven
            energy[2] += own * slide


@dataclass(frozen=True)
class MeshFriction(ForceLaw):
    """Sliding friction of one helix of a mesh."""

    title: ClassVar[str] = "tooth friction"

    contact: MeshContact = parameter("", "the normal contact that gives N")  # noqa: RUF009
    base_pitch: float = parameter("m", "transverse base pitch p_bt", above=0.0)
    start: float = parameter("m", "start of the path of contact, xi from the pitch point")
    end: float = parameter("m", "its end")
    closing: float = parameter("rad/rad", "(|w_p| + |w_g|) for each rad/s of the reference")
    coefficient: float = parameter("", "mu", 0.0, least=0.0)
    overlap: float = parameter("", "overlap ratio of helical teeth; 0 for spur", 0.0, least=0.0)
    viscosity: float = parameter("mPa s", "viscosity for Benedict and Kelley's mu, in place of mu", 0.0, least=0.0)
    line_load: float = parameter("N/m", "mean load on a metre of face, for that mu", 0.0)
    rolling: float = parameter(
        "m/rad", "rolling speed at the pitch point for each rad/s of the reference, for that mu", 0.0
    )
    smooth: float = parameter("m/s", "sliding speed v_0 over which friction changes its sense", 0.05, above=0.0)

    def check(self) -> None:
        """The path of contact has a length, of fewer than four base pitches."""
        if not self.end > self.start:
            raise refuse(self, "end", "an end of the path of contact beyond its start")
        if self.end - self.start >= 4.0 * self.base_pitch:
            raise refuse(self, "end", "fewer than four teeth in contact")

    @property
    def components(self) -> int:
        """Along the normal, across the line of action, and relative rotation."""
        return 3

    @property
    def slices(self) -> int:
        """Slices of the face: one for spur teeth."""
        return _SLICES if self.overlap > 0.0 else 1

    def functions(self) -> tuple[Any, Any]:
        """Return the compiled functions schedule and force."""
        return schedule, force

    def state_size(self) -> int:
        """State of the contact, W, number of contacts, and for each (xi, mu)."""
        return _STATE + 2 + 8 * self.slices

    def parameters(self) -> np.ndarray:
        """Own parameters in a head, then those of the contact."""
        head = [
            self.base_pitch,
            self.start,
            self.end,
            self.overlap,
            self.slices,
            self.coefficient,
            self.viscosity,
            self.line_load,
            self.closing,
            self.rolling,
            self.smooth,
        ]
        return np.concatenate([head, np.zeros(_HEAD - len(head)), self.contact.parameters()])

    def mean(self) -> MeshFriction:
        """Nothing remains: over a mesh cycle approach and recess cancel nearly."""
        return replace(self, coefficient=0.0, viscosity=0.0)

    def repeats(self) -> tuple[Repeats, ...]:
        """The mesh cycle of its contact."""
        return tuple(Repeats(each.order) for each in self.contact.repeats())

    @classmethod
    def examples(cls) -> tuple[MeshFriction, ...]:
        """Spur teeth with a given coefficient, and helical ones with a lubricant."""
        normal = MeshContact(3e8, 900.0, 40e-6, ramp=2e-6, order=20.0, phase=0.3)
        return (
            cls(normal, 8.5e-3, -6e-3, 7e-3, 1.5, 0.06),
            cls(normal, 8.5e-3, -6e-3, 7e-3, 1.5, overlap=1.4, viscosity=20.0, line_load=2e5, rolling=0.02),
        )
