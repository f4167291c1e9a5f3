"""Tooth contact of one helix as its loaded teeth have it: from maps over approach and position in the mesh cycle.

    x = d - e(p) - delta_0(u),     F = F(x, u) + c k_t(x, u)/k x',     k_t = dF/dx,     F = 0 for x <= 0

with p and u as in `loaded_map.py`. The map comes as approaches delta(F_j; u_i) under loads F_j from 0, all flanks, modifications,
pitch errors and corners inside (Ozguven and Houser, J. Sound Vib. 125 (1988) 71). It is inverted: forces at even steps
of x, linear between these, and smooth between positions: F rises with x, and a position has the given approach under each load.
Above the largest load it goes on along its tangent. The contact pushes only: teeth part by themselves. Coast flanks on the same
line are a map F_coast(-d).

Flanks that tilt against each other have maps at some tilts, and a moment M about the middle of the face:

    F = dW/dx + c k_t/k (x' + z_e d_2'),     M = dW/d d_2 + z_e (F - dW/dx),     k_t = d^2W/dx^2

with the displacements d = d_1 in the middle of the face and d_2 = tilt (m/m, closing the flanks at larger z). The energy
W(x, tilt, u) is a Hermite cubic in the tilt between two of those for which the contact was solved, with its force and moment
there: W_k and M_k are the integrals of F_k and dM_k/dx over x. So F and M follow from one energy, at those tilts they are the
contact's own, and both are nothing where the teeth part. Beyond the first and the last tilt the moment stays as it is there.
Damping acts at the place z_e of the face where the stiffness of the mean state has its centre; its k_t takes
the forces F_k alone, without the part of the cubic that the moments M_k make between two tilts.

Damping goes with the stiffness that carries, from zero at first touch over one step of x: c is what it is at k. It never pulls
where `contact_damping` is non-adhesive; "penetration" is c x/reference (Hunt and Crossley, J. Applied Mechanics 42 (1975) 440).
"""

from __future__ import annotations

from collections import namedtuple
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar
from weakref import WeakKeyDictionary, ref

import numpy as np

from rotorgear.forces.law import ForceLaw, Repeats, parameter, refuse
from rotorgear.forces.loaded_map import (
    ENERGY,
    FORCE,
    LIFT,
    MOMENT,
    NODE,
    NODE_OF_A_TILT,
    STEPS,
    STEPS_OF_A_TILT,
    TANGENT,
    inverted,
    is_large,
    shape_of_rows,
)
from rotorgear.forces.mesh_contact import DAMPINGS, pairs
from rotorgear.solvers.batch.columns import ERROR, OWN_LAW, SLOPE, STIFFNESS, TABLE_ROWS, Column
from rotorgear.solvers.contact.gap_contact import curve_contact
from rotorgear.solvers.contact.kinds import PENETRATION
from rotorgear.solvers.time.compiled import compiled, force_function, schedule_function

# Harmonics of a base pitch that count: teeth part, and corners strike.
_HARMONICS = 10
_TURN = 2.0 * np.pi
# Places of the parameters, which cosine and sine of each harmonic of e follow, and then the rows of the map; COAST is where the
# parameters of the coast flanks begin, or 0; LENGTH the numbers in a row.
PER_K, C, MODE, PER_DEPTH, ORDER, PHASE, PATH_PHASE, FORWARD, PERIODS, E_MEAN = range(10)
SPACING, ROWS, LENGTH, HARMONICS, COAST, SERIES = range(10, 16)
# The rows of flanks that tilt are followed by the place z_e, the number of tilts, and these.
PLACE, TILTS, FIRST_TILT = range(3)
# Places of the state: e + delta_0 and its rate, then for each of the four rows about the position where it begins, its weight,
# and the rate of that.
E_NOW, E_RATE, ABOUT = range(3)
BEGIN, WEIGHT, RATE = range(3)
ROW = 3
NEAREST = 4
FLANK_STATE = ABOUT + ROW * NEAREST
# Of the tilts on both sides of one: number of the first, shares a of their energies and b of their moments in W, and what these
# shares change by with the tilt, once and twice.
Between = namedtuple("Between", "first a b a_slope b_slope a_bend b_bend")
# Of the map: dW/dx and its slope, dW/d d_2 and its slopes in x and in the tilt, k_t and its slopes in x and in the tilt, W, and
# the rate of W as the flanks pass.
Mapped = namedtuple("Mapped", "force stiffness moment coupling against_tilt carries bend turn stored driven")


@compiled(entry=False)
def place_flank(angle, speed, p, s):  # type: ignore[no-untyped-def]
    """Fill the state of one side of the teeth: e + delta_0, its rate, and the rows of the map about the position."""
    rate = p[ORDER] * speed
    phase = p[ORDER] * angle + p[PHASE]
    error = p[E_MEAN]
    slope = 0.0
    count = int(p[HARMONICS])
    for n in range(1, count + 1):
        a = p[SERIES + 2 * n - 2]
        b = p[SERIES + 2 * n - 1]
        error += a * np.cos(n * phase) + b * np.sin(n * phase)
        slope += n * (b * np.cos(n * phase) - a * np.sin(n * phase))
    rows = int(p[ROWS])
    first = SERIES + 2 * count
    length = int(p[LENGTH])
    turns = p[FORWARD] * (p[ORDER] * angle + p[PATH_PHASE]) / _TURN / p[PERIODS]
    at = (turns - np.floor(turns)) * rows
    i = min(int(at), rows - 1)
    x = at - i
    # Cubic with the slopes of central differences (Catmull and Rom): rates without jumps, for work is done by them.
    weights = (
        0.5 * x * (2.0 * x - x * x - 1.0),
        0.5 * (2.0 + x * x * (3.0 * x - 5.0)),
        0.5 * x * (1.0 + 4.0 * x - 3.0 * x * x),
        0.5 * x * x * (x - 1.0),
    )
    slopes = (
        0.5 * (4.0 * x - 3.0 * x * x - 1.0),
        0.5 * x * (9.0 * x - 10.0),
        0.5 * (1.0 + 8.0 * x - 9.0 * x * x),
        0.5 * x * (3.0 * x - 2.0),
    )
    passing = rows * p[FORWARD] * rate / _TURN / p[PERIODS]
    touch = 0.0
    touch_rate = 0.0
    for k in range(NEAREST):
        begin = first + ((i + k - 1) % rows) * length
        own = ABOUT + ROW * k
        s[own + BEGIN] = begin
        s[own + WEIGHT] = weights[k]
        s[own + RATE] = slopes[k] * passing
        touch += weights[k] * p[begin]
        touch_rate += slopes[k] * passing * p[begin]
    s[E_NOW] = error + touch
    s[E_RATE] = slope * rate + touch_rate


@schedule_function
def schedule(angle, speed, time, p, s):  # type: ignore[no-untyped-def]
    """Fill the state of the working flanks, and that of the coast flanks behind it."""
    place_flank(angle, speed, p, s)
    coast = int(p[COAST])
    if coast > 0:
        place_flank(angle, speed, p[coast:], s[FLANK_STATE:])


@compiled(inner=True)
def between_tilts(p, tilts, count, tilt):  # type: ignore[no-untyped-def]
    """Hermite's cubics of a tilt between two that are known, straight on outside."""
    k = 0
    while k < count - 2 and tilt > p[tilts + k + 1]:
        k += 1
    width = p[tilts + k + 1] - p[tilts + k]
    y = (tilt - p[tilts + k]) / width
    inside = 1.0 if 0.0 <= y <= 1.0 else 0.0
    outside = 0.0 if inside > 0.0 else (y * width if y < 0.0 else (y - 1.0) * width)
    y = min(max(y, 0.0), 1.0)
    a_1 = y * y * (3.0 - 2.0 * y)
    a = (1.0 - a_1, a_1)
    b = (
        width * y * (1.0 - y) * (1.0 - y) + (outside if y == 0.0 else 0.0),
        width * y * y * (y - 1.0) + (outside if y == 1.0 else 0.0),
    )
    a_slope = (6.0 * y * (y - 1.0) / width, 6.0 * y * (1.0 - y) / width)
    b_slope = (1.0 + y * (3.0 * y - 4.0), y * (3.0 * y - 2.0))
    a_bend = (inside * (12.0 * y - 6.0) / width**2, inside * (6.0 - 12.0 * y) / width**2)
    b_bend = (inside * (6.0 * y - 4.0) / width, inside * (6.0 * y - 2.0) / width)
    return Between(k, a, b, a_slope, b_slope, a_bend, b_bend)


@compiled(inner=True)
def mapped(p, s, near, depth, tilts, steps, node):  # type: ignore[no-untyped-def]
    """What the map has at a depth of x beyond the first touch: linear in x, cubic between positions and between tilts."""
    h = p[SPACING]
    i = min(int(depth / h), steps - 1) if depth < steps * h else steps - 1
    past = depth - i * h
    elastic = 0.0
    stiffness = 0.0
    moment = 0.0
    coupling = 0.0
    against_tilt = 0.0
    carries = 0.0
    bend = 0.0
    turn = 0.0
    stored = 0.0
    driven = 0.0
    for row in range(NEAREST):
        about = ABOUT + ROW * row
        weight = s[about + WEIGHT]
        for k in range(2 if tilts else 1):
            a = near.a[k]
            b = near.b[k]
            at = int(s[about + BEGIN]) + 1 + node * ((near.first + k) * (steps + 1) + i)
            slope = (p[at + node + FORCE] - p[at + FORCE]) / h
            pushed = p[at + FORCE] + slope * past
            work = p[at + ENERGY] + p[at + FORCE] * past + 0.5 * slope * past * past
            steeper = (p[at + node + TANGENT] - p[at + TANGENT]) / h if past <= h else 0.0
            tangent = p[at + TANGENT] + steeper * past if past <= h else p[at + node + TANGENT]
            lift = 0.0
            lift_slope = 0.0
            turned = 0.0
            if tilts:
                lift_slope = (p[at + node + LIFT] - p[at + LIFT]) / h if past <= h else 0.0
                lift = p[at + LIFT] + lift_slope * past if past <= h else p[at + node + LIFT]
                turned = p[at + MOMENT] + p[at + LIFT] * past + 0.5 * lift_slope * past * past
                if past > h:
                    turned = p[at + node + MOMENT] + lift * (past - h)
                moment += weight * (near.a_slope[k] * work + near.b_slope[k] * turned)
                coupling += weight * (near.a_slope[k] * pushed + near.b_slope[k] * lift)
                against_tilt += weight * (near.a_bend[k] * work + near.b_bend[k] * turned)
                turn += weight * near.a_slope[k] * tangent
            elastic += weight * (a * pushed + b * lift)
            stiffness += weight * (a * slope + b * lift_slope)
            carries += weight * a * tangent
            bend += weight * a * steeper
            kept = a * work + b * turned
            stored += weight * kept
            driven += s[about + RATE] * kept
    return Mapped(elastic, stiffness, moment, coupling, against_tilt, carries, bend, turn, stored, driven)


def _force(tilts):  # type: ignore[no-untyped-def]
    """The compiled force of flanks that tilt, or of others: one text with other constants.

    With coast flanks that tilt as well, or a kernel that is a function of its own for both, flanks that tilt took 1.1 to 1.4
    times as long.
    """
    steps = STEPS_OF_A_TILT if tilts else STEPS
    node = NODE_OF_A_TILT if tilts else NODE

    @force_function
    def force(p, s, d, v, F, Kd, Kv, energy):  # type: ignore[no-untyped-def]
        """Force and moment, positive where the working flanks are pressed; the coast flanks push the other way."""
        F[:] = 0.0
        Kd[:] = 0.0
        Kv[:] = 0.0
        energy[:] = 0.0
        side = 1.0  # the working flanks, then the coast flanks
        while True:
            x = side * d[0] - s[E_NOW]
            rate = side * v[0] - s[E_RATE]
            place = 0.0
            alone = (1.0, 0.0)
            none = (0.0, 0.0)
            near = Between(0, alone, none, none, none, none, none)
            if tilts:
                behind = SERIES + 2 * int(p[HARMONICS]) + int(p[ROWS]) * int(p[LENGTH])
                place = p[behind + PLACE]
                rate += place * (side * v[1])
                near = between_tilts(p, behind + FIRST_TILT, int(p[behind + TILTS]), side * d[1])
            depth = max(x, 0.0)
            at = mapped(p, s, near, depth, tilts, steps, node)

            damping = p[PER_K] * at.carries
            growth = p[PER_K] * at.bend
            growth_tilt = p[PER_K] * at.turn
            if int(p[MODE]) == PENETRATION:
                damping = p[C] * depth * p[PER_DEPTH]
                growth = p[C] * p[PER_DEPTH]
                growth_tilt = 0.0
            now = curve_contact(int(p[MODE]), at.force, at.stiffness, damping, growth, x, rate)
            F[0] += side * now.force
            Kd[0] += now.stiffness
            Kv[0] += now.damping
            energy[0] += at.stored
            energy[1] += at.driven - now.force * s[E_RATE]
            energy[2] += now.resisted * rate
            energy[3] += side * now.side
            if tilts:
                holds = 1.0 if now.force != 0.0 else 0.0
                in_tilt = holds * (at.coupling + growth_tilt * rate)
                F[1] += side * (at.moment + place * (now.force - at.force))
                Kd[1] += in_tilt
                Kd[2] += at.coupling + place * (now.stiffness - at.stiffness)
                Kd[3] += at.against_tilt + place * (in_tilt - at.coupling)
                Kv[1] += now.damping * place
                Kv[2] += now.damping * place
                Kv[3] += now.damping * place * place
            if tilts or p[COAST] == 0.0:
                break
            side = -1.0
            s = s[FLANK_STATE:]
            p = p[int(p[COAST]) :]

    return force


# Law -> its parameters, where they are large and some system holds them.
_ALIVE: WeakKeyDictionary[LoadedTeeth, ref[np.ndarray]] = WeakKeyDictionary()

press = _force(tilts=False)
press_and_tilt = _force(tilts=True)


@dataclass(frozen=True, eq=False)
class LoadedTeeth(ForceLaw):
    """Contact of one helix by the map of its loaded teeth, or by maps at several tilts of its flanks."""

    title: ClassVar[str] = "loaded teeth"
    can_part: ClassVar[bool] = True
    conserves: ClassVar[bool] = True

    load: np.ndarray = parameter("N", "loads F_j along the flank normal, (l,), rising from 0")  # noqa: RUF009
    approach: np.ndarray = parameter(  # noqa: RUF009
        "m", "approach under these loads at even positions over all periods, (p, l), or (k, p, l) at k tilts"
    )
    stiffness: float = parameter("N/m", "stiffness k of the mean state, at which the damping is c", above=0.0)
    damping: float = parameter("N s/m", "damping coefficient c at the stiffness k", 0.0, least=0.0)
    contact_damping: str = parameter(
        "", "non-adhesive, adhesive or penetration", "non-adhesive", choices=tuple(DAMPINGS)
    )
    reference: float = parameter("m", "reference depth of penetration damping", 1e-6, above=0.0)
    order: float = parameter("rad/rad", "mesh phase for each radian of the reference", 0.0)
    phase: float = parameter("rad", "mesh phase p of the error at angle 0", 0.0)
    path_phase: float = parameter("rad", "mesh phase of the flanks' own contact at angle 0", 0.0)
    forward: int = parameter(
        "", "whether contact runs along the path as the map counts it: 1, or -1", 1, least=-1, most=1
    )
    periods: int = parameter("", "base pitches after which the map repeats", 1, least=1)
    error_mean: float = parameter("m", "constant part of e", 0.0)
    error_cos: tuple[float, ...] = parameter("m", "a_n of e(p)", ())
    error_sin: tuple[float, ...] = parameter("m", "b_n of e(p)", ())
    coast: LoadedTeeth | None = parameter("", "coast flanks, which d < 0 presses; of none that tilt", None)  # noqa: RUF009
    expanded: bool = parameter("", "whether solvers expand about k and c: not on a flank that is mostly open", True)
    tilt: np.ndarray = parameter("m/m", "tilts (k,), rising, that close the flanks at larger z; or none", ())  # noqa: RUF009
    moment: np.ndarray = parameter("N m", "moment (k, p, l) about the middle of the face", ())  # noqa: RUF009
    slope: np.ndarray = parameter("m/N", "change of the approach with the load, (p, l); or none: the monotone one", ())  # noqa: RUF009
    place: float = parameter("m", "place z_e of the stiffness k from the middle of the face", 0.0)
    tilt_stiffness: float = parameter(
        "N m", "stiffness of the mean state against a tilt about that place", 0.0, least=0.0
    )

    def __post_init__(self) -> None:
        """Take lists as arrays, as a model file gives them."""
        for name in ("load", "approach", "tilt", "moment", "slope"):
            object.__setattr__(self, name, np.asarray(getattr(self, name), dtype=float))
        object.__setattr__(self, "approach", np.atleast_2d(self.approach))
        super().__post_init__()

    def check(self) -> None:
        """Loads rise from 0, and so does the approach under them, at every position and tilt; several tilts have moments."""
        if self.load[0] != 0.0 or np.any(np.diff(self.load) <= 0.0):
            raise refuse(self, "load", "loads that rise from 0")
        if self.tilt.ndim != 1 or len(self.tilt) == 1 or np.any(np.diff(self.tilt) <= 0.0):
            raise refuse(self, "tilt", "at least two tilts, rising, or none")
        shape = self.approach.shape
        tilts = (len(self.tilt),) if self.tilt.size else ()
        if shape != (*tilts, shape[-2], *self.load.shape) or np.any(self.approach[..., 1:] <= self.approach[..., :-1]):
            raise refuse(self, "approach", "for each tilt and position an approach that rises with the load")
        if self.moment.shape != (shape if tilts else (0,)):
            raise refuse(self, "moment", "a moment for each approach at several tilts, and none without")
        if self.slope.shape != (0,) and (tilts or self.slope.shape != shape or np.any(self.slope < 0.0)):
            raise refuse(self, "slope", "none, or for each approach one that does not fall, and no tilts")
        if self.coast is not None and (tilts or self.coast.tilt.size):
            raise refuse(self, "coast", "coast flanks where neither side tilts")

    def __eq__(self, other: object) -> bool:
        """Whether all parameters are the same, arrays element by element."""
        return type(other) is type(self) and all(
            np.array_equal(getattr(self, name), getattr(other, name)) for name in self.declared()
        )

    def __hash__(self) -> int:
        """Of the loads: equal laws have equal ones."""
        return hash(self.load.tobytes())

    @property
    def components(self) -> int:
        """The approach, and the tilt where there are maps at several."""
        return 2 if self.tilt.size else 1

    @property
    def known_up_to(self) -> float:
        """The largest load of the map."""
        return float(self.load[-1])

    def functions(self) -> tuple[Any, Any]:
        """Return the compiled functions schedule and force."""
        return schedule, press_and_tilt if self.tilt.size else press

    def state_size(self) -> int:
        """Of each side of the teeth: e + delta_0, its rate, and four rows with their weights and rates."""
        return FLANK_STATE * (1 if self.coast is None else 2)

    @property
    def _maps(self) -> np.ndarray:
        """Approaches (k, p, l), also of one map without a tilt."""
        return self.approach if self.tilt.size else self.approach[None]

    @property
    def _slopes(self) -> np.ndarray | None:
        return self.slope[None] if self.slope.size else None

    @property
    def inverse(self) -> tuple[float, np.ndarray]:
        """Step of x in m and rows of the inverted map, as `inverted` has them."""
        return inverted(self.load, self._maps, self.moment, slope=self._slopes)

    @cached_property
    def _parameters(self) -> np.ndarray:
        return self._made()

    def _made(self) -> np.ndarray:
        """The parameters; a large map is inverted in its place among them."""
        series = pairs(self.error_cos, self.error_sin)
        face = [self.place, len(self.tilt), *self.tilt] if self.tilt.size else []
        shape = shape_of_rows(self._maps, bool(self.tilt.size))
        first = SERIES + len(series)
        behind = first + shape[0] * shape[1]
        coast = behind + len(face)
        found = np.empty(coast + (0 if self.coast is None else self.coast.parameter_count()))
        spacing, _ = inverted(self.load, self._maps, self.moment, found[first:behind].reshape(shape), self._slopes)
        head = [self.damping / self.stiffness, self.damping, DAMPINGS[self.contact_damping], 1.0 / self.reference]
        head += [self.order, self.phase, self.path_phase, self.forward, self.periods, self.error_mean]
        head += [spacing, *shape, len(series) // 2, 0 if self.coast is None else coast]
        found[:first] = [*head, *series]
        found[behind:coast] = face
        if self.coast is not None:
            found[coast:] = self.coast.parameters()
        return found

    def parameter_count(self) -> int:
        """How many parameters there are."""
        rows = shape_of_rows(self._maps, bool(self.tilt.size))
        own = SERIES + len(pairs(self.error_cos, self.error_sin)) + rows[0] * rows[1]
        own += 2 + len(self.tilt) if self.tilt.size else 0
        return own + (0 if self.coast is None else self.coast.parameter_count())

    def parameters(self) -> np.ndarray:
        """Return head, series of e and rows of the map, place and tilts, and all these of the coast flanks behind."""
        # Kept: statics over a cycle evaluate one law a thousand times. Large ones live as long as a system that asked for them,
        # for all systems of equal laws; of flanks without tilt statics ask the map itself.
        if self.tilt.size or not is_large(self._maps, tilted=False):
            return self._parameters
        alive = _ALIVE.get(self)
        found = alive() if alive else None
        if found is None:
            found = self._made()
            _ALIVE[self] = ref(found)
        return found

    def closed_stiffness(self) -> np.ndarray:
        """k at its place, and what resists a tilt about it."""
        at = np.array([1.0, self.place])
        whole = self.stiffness * np.outer(at, at) + np.diag([0.0, self.tilt_stiffness])
        return whole[: self.components, : self.components]

    def reference_stiffness(self) -> np.ndarray:
        """That of the mean state; nothing for a flank that is mostly open."""
        return self.closed_stiffness() if self.expanded else np.zeros((self.components, self.components))

    def reference_damping(self) -> np.ndarray:
        """c at its place, as with teeth that never part."""
        at = np.array([1.0, self.place])[: self.components]
        constant = self.expanded and self.contact_damping != "penetration"
        return (self.damping if constant else 0.0) * np.outer(at, at)

    def mean(self) -> LoadedTeeth:
        """The same maps at one position: the mean force has the mean approach and the mean moment."""
        return replace(
            self,
            approach=self.approach.mean(axis=-2, keepdims=True),
            moment=self.moment.mean(axis=-2, keepdims=True) if self.tilt.size else self.moment,
            slope=self.slope.mean(axis=-2, keepdims=True) if self.slope.size else self.slope,
            periods=1,
            error_cos=(),
            error_sin=(),
            coast=self.coast and self.coast.mean(),
        )

    def repeats(self) -> tuple[Repeats, ...]:
        """The mesh cycle, or the several base pitches after which the map repeats."""
        if not self.order or (self.approach.shape[-2] == 1 and not (self.error_cos or self.error_sin)):
            return ()
        highest = max(_HARMONICS, len(self.error_cos), len(self.error_sin))
        return (Repeats(abs(self.order) / self.periods, highest * self.periods),)

    def left_out(self) -> tuple[str, ...]:
        """Nothing of the loaded teeth but what moves too fast for them to be at rest; the damping is no part of their map."""
        damped = "no damping of the teeth is given"
        if self.damping and self.contact_damping == "penetration":
            damped = f"damping is {self.damping:.4g} N s/m times the deflection over {1e6 * self.reference:.3g} um"
        elif self.damping:
            damped = (
                f"damping goes with the stiffness that carries, {self.damping:.4g} N s/m at {self.stiffness:.4g} N/m, and is "
                "nothing where the teeth part"
            )
        return (
            f"inertia of the teeth on their bodies: they follow their static contact over the mesh cycle; {damped}",
        )

    def columns(self, speed: float = 1.0) -> tuple[Column, ...]:
        """By the compiled functions, one system at a time; contact is counted of the approach."""
        gap = 0.0 if self.coast is None else self.coast.error_mean + float(self.coast.approach[..., 0].mean())
        approach = Column(
            OWN_LAW, stiffness=self.stiffness, damping=self.damping, clearance=max(gap, 0.0), counted=True
        )
        return (approach, Column(OWN_LAW, stiffness=self.tilt_stiffness))[: self.components]

    def table(self, angles: np.ndarray, states: np.ndarray, order: float) -> np.ndarray:
        """e + delta_0 and its slope over the sweep's time, which the statistics of the approach take."""
        found = np.zeros((len(angles), self.components, TABLE_ROWS))
        found[:, 0, STIFFNESS] = 1.0
        found[:, 0, ERROR] = states[:, E_NOW]
        found[:, 0, SLOPE] = states[:, E_RATE] / order
        return found

    def table_key(self) -> bytes:
        """All that shapes delta_0 and e."""
        shape = (self.order, self.phase, self.path_phase, self.forward, self.periods, self.error_mean)
        return repr([*shape, self.error_cos, self.error_sin]).encode() + self.approach[..., 0].tobytes()

    @classmethod
    def examples(cls) -> tuple[LoadedTeeth, ...]:
        """A Hertzian pair with each damping, with coast flanks, over two base pitches the other way; a face with each damping."""
        load = 1000.0 * np.array([0.0, 0.01, 0.03, 0.08, 0.15, 0.3, 0.6, 1.0, 1.6, 2.5, 5.0])
        turn = 2.0 * np.pi * np.arange(64)[:, None] / 64
        soft = (1.0 + 0.2 * np.cos(turn)) / 3e8
        approach = 2e-6 * np.sin(turn) + soft * load + 1e-6 * (load / 1000.0) ** 0.7
        ripple: dict[str, Any] = {"order": 20.0, "phase": 0.3, "path_phase": 0.7, "error_cos": (1e-6,)}
        teeth = cls(load, approach, 3e8, 900.0, **ripple)
        coast = replace(teeth, phase=0.0, path_phase=0.2, error_mean=2e-5, error_cos=(-1e-6,))

        # A line of springs over a face that only push, and whose stiffness varies over the cycle.
        width = 0.2
        load = 1000.0 * np.concatenate([[0.0], np.geomspace(0.002, 40.0, 30)])
        tilt = np.linspace(-1.5e-4, 1.5e-4, 25)
        u = np.arange(32)[:, None] / 32
        k = 3e8 * (1.0 + 0.2 * np.cos(2.0 * np.pi * u))
        gape = np.maximum(np.abs(tilt), 1e-9)[:, None, None] * width
        # The part a of the face that carries: all of it, or from the end that the tilt closes.
        part = width * np.minimum(np.sqrt(2.0 * load / (k * gape)), 1.0)
        approach = np.where(part < width, gape * (part / width - 0.5), load / k) + 1e-6 * np.sin(2.0 * np.pi * u)
        side = np.sign(tilt)[:, None, None]
        moment = np.where(part < width, load * side * (0.5 * width - part / 3.0), k * width * side * gape / 12.0)
        along: dict[str, Any] = {"tilt": tilt, "moment": moment, "place": 0.01, "tilt_stiffness": 9e5}
        face = cls(load, approach, 3e8, 900.0, **along, **ripple)
        return (
            teeth,
            replace(teeth, contact_damping="adhesive"),
            replace(teeth, contact_damping="penetration", reference=3e-6),
            replace(teeth, coast=coast),
            cls(
                teeth.load,
                teeth.approach,
                3e8,
                forward=-1,
                periods=2,
                order=3.0,
                error_sin=(0.0, 1e-6),
                error_mean=1e-6,
            ),
            face,
            replace(face, contact_damping="adhesive"),
            replace(face, contact_damping="penetration", reference=3e-6, forward=-1),
        )
