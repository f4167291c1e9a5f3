"""Sliding friction of the teeth of one helix: it acts across the line of action, with the place of contact as its arm.

Displacements: d0 along the flank normal, which gives the normal force N of `mesh_contact`, d1 across the line of
action at the pitch point, d2 the relative rotation. At the place xi of a contact, xi = p_bt (p/2 pi) from the pitch point, the
flanks slide with

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
from rotorgear.forces.mesh_contact import ORDER, PHASE, MeshContact
from rotorgear.solvers.time.compiled import force_function, schedule_function

_SLICES = 9
_STATE = 5
_normal_schedule = mesh_contact.schedule
_normal_force = mesh_contact.force
# Places of the parameters: what moves, what resists, and where those of the contact begin.
BASE_PITCH, PATH_START, PATH_END, CLOSING = range(4)
COEFFICIENT, OVERLAP, VISCOSITY, LINE_LOAD, ROLLING, SMOOTH, SLICES, CONTACT = range(4, 12)
# Places of the state after that of the contact: W, the number of places of contact, and for each of those xi and mu.
W, COUNT, PLACES = range(_STATE, _STATE + 3)
# Places of contact at once in a slice, and the first and the second part of each.
MOST, XI, MU = 4, 0, 1
PLACE = 2
_TURN = 2.0 * np.pi
# Benedict and Kelley's mu = 0.0127 log10(29.66 ...) is held between nothing and this.
_LARGEST_MU = 0.2


@schedule_function
def schedule(angle, speed, time, p, s):  # type: ignore[no-untyped-def]
    """Fill the state of the contact, W, and for each place of contact xi and its coefficient of friction."""
    _normal_schedule(angle, speed, time, p[CONTACT:], s[:_STATE])
    pitch = p[BASE_PITCH]
    slices = int(p[SLICES])
    s[W] = p[CLOSING] * speed
    cycle = p[CONTACT + ORDER] * angle + p[CONTACT + PHASE]
    count = 0.0
    for i in range(slices):
        late = p[OVERLAP] * ((i + 0.5) / slices - 0.5)
        share = cycle / _TURN - late
        first = pitch * (share - np.floor(share))
        while first - pitch >= p[PATH_START]:
            first -= pitch
        for j in range(MOST):
            at = PLACES + PLACE * (MOST * i + j)
            xi = first + j * pitch
            s[at + XI] = 0.0
            s[at + MU] = 0.0
            if not p[PATH_START] <= xi <= p[PATH_END]:
                continue
            count += 1
            s[at + XI] = xi
            s[at + MU] = p[COEFFICIENT]
            if p[VISCOSITY] > 0.0:
                slide = max(abs(xi * s[W]), p[SMOOTH])
                roll = max(abs(p[ROLLING] * speed), p[SMOOTH])
                x = 29.66 * p[LINE_LOAD] / (p[VISCOSITY] * slide * roll * roll)
                s[at + MU] = min(max(0.0127 * np.log10(max(x, 1.0)), 0.0), _LARGEST_MU)
    s[COUNT] = count


@force_function
def force(p, s, d, v, F, Kd, Kv, energy):  # type: ignore[no-untyped-def]
    """Friction across the line of action and its moment; another law applies the normal force itself."""
    F[:] = 0.0
    Kd[:] = 0.0
    Kv[:] = 0.0
    n = np.zeros(1)
    kd = np.zeros(1)
    kv = np.zeros(1)
    e = np.zeros(4)
    _normal_force(p[CONTACT:], s[:_STATE], d[:1], v[:1], n, kd, kv, e)
    energy[:] = 0.0, 0.0, 0.0, e[3]
    if s[COUNT] == 0.0:
        return
    N = abs(n[0])
    sign = 1.0 if n[0] >= 0.0 else -1.0
    for i in range(MOST * int(p[SLICES])):
        at = PLACES + PLACE * i
        mu = s[at + MU]
        if mu == 0.0:
            continue
        xi = s[at + XI]
        driven = xi * s[W]
        slide = driven + v[1] + xi * v[2]
        t = np.tanh(slide / p[SMOOTH])
        largest = mu * N / s[COUNT]
        friction = largest * t
        slope = largest * (1.0 - t * t) / p[SMOOTH]
        F[1] += friction
        F[2] += xi * friction
        Kv[4] += slope
        Kv[5] += xi * slope
        Kv[7] += xi * slope
        Kv[8] += xi * xi * slope
        in_normal = mu / s[COUNT] * t * sign
        Kd[3] += in_normal * kd[0]
        Kd[6] += xi * in_normal * kd[0]
        Kv[3] += in_normal * kv[0]
        Kv[6] += xi * in_normal * kv[0]
        energy[1] += friction * driven
        energy[2] += friction * slide


@dataclass(frozen=True)
class MeshFriction(ForceLaw):
    """Sliding friction of one helix of a mesh."""

    title: ClassVar[str] = "tooth friction"
    # Along the normal, across the line of action, and relative rotation.
    components: ClassVar[int] = 3

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
    def slices(self) -> int:
        """Slices of the face: one for spur teeth."""
        return _SLICES if self.overlap > 0.0 else 1

    def functions(self) -> tuple[Any, Any]:
        """Return the compiled functions schedule and force."""
        return schedule, force

    def state_size(self) -> int:
        """State of the contact, W, number of contacts, and for each (xi, mu)."""
        return PLACES + PLACE * MOST * self.slices

    def parameters(self) -> np.ndarray:
        """The fields in the order of their declaration, the number of slices, then the parameters of the contact."""
        own = [getattr(self, name) for name in self.declared() if name != "contact"]
        return np.concatenate([own, [self.slices], self.contact.parameters()])

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
