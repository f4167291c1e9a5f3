"""What the laws of loaded teeth share: their maps give the approach under loads, and repeat with the mesh cycle.

    e + delta_0(u):     p = order * angle + phase,     u = forward * (order * angle + path phase) / 2 pi

with the error e(p) of the flanks and the first touch delta_0 at the position u in the cycle.
"""

from __future__ import annotations

import numpy as np

from rotorgear.forces.law import ForceLaw, Repeats
from rotorgear.forces.mesh_contact import DAMPINGS
from rotorgear.solvers.time.compiled import compiled

# Harmonics of a base pitch that count: teeth part, and corners strike.
_HARMONICS = 10
# Loads between which a map is turned over.
_LOADS = 1500
_TURN = 2.0 * np.pi
# Places of the parameters, which cosine and sine of each harmonic of e follow, and then the rows of the map; COAST is where the
# parameters of the coast flanks begin, or 0; LENGTH the numbers in a row.
(
    SPACING,
    PER_K,
    C,
    MODE,
    PER_DEPTH,
    ORDER,
    PHASE,
    PATH_PHASE,
    FORWARD,
    PERIODS,
    ROWS,
    HARMONICS,
    E_MEAN,
    COAST,
    LENGTH,
    SERIES,
) = range(16)
# Places of the state: e + delta_0 and its rate, then for each of the four rows about the position where it begins, its weight,
# and the rate of that.
E_NOW, E_RATE, ABOUT = range(3)
BEGIN, WEIGHT, RATE = range(3)
ROW = 3
NEAREST = 4
FLANK_STATE = ABOUT + ROW * NEAREST


@compiled(entry=False)
def place_flank(angle, speed, p, s):  # type: ignore[no-untyped-def]
    """Fill e + delta_0, its rate, and the rows of the map about the position."""
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


class LoadedMap(ForceLaw):
    """A contact by a map: the approach (..., p, l) at p even positions of its cycle under l loads."""

    load: np.ndarray
    approach: np.ndarray
    stiffness: float
    damping: float
    contact_damping: str
    reference: float
    order: float
    phase: float
    path_phase: float
    forward: int
    periods: int
    error_mean: float
    error_cos: tuple[float, ...]
    error_sin: tuple[float, ...]

    def __eq__(self, other: object) -> bool:
        """Whether all parameters are the same, arrays element by element."""
        return type(other) is type(self) and all(
            np.array_equal(getattr(self, name), getattr(other, name)) for name in self.declared()
        )

    def __hash__(self) -> int:
        """Of the loads: equal laws have equal ones."""
        return hash(self.load.tobytes())

    @property
    def can_part(self) -> bool:
        """The flanks push only."""
        return True

    @property
    def known_up_to(self) -> float:
        """The largest load of the map."""
        return float(self.load[-1])

    @property
    def spacing(self) -> float:
        """Step of x in m, over all of which the map is turned over."""
        raise NotImplementedError

    @property
    def rows(self) -> np.ndarray:
        """The map turned over, a row for each position."""
        raise NotImplementedError

    def loads_between(self) -> np.ndarray:
        """Loads in N between which the map is turned over, dense where little carries: half up to a fiftieth of the largest."""
        share = np.linspace(0.0, 1.0, _LOADS)
        return np.asarray(self.load[-1] * np.concatenate([0.02 * share[:-1], 0.02 + 0.98 * share]))

    def of_the_map(self) -> np.ndarray:
        """The parameters that every such law begins with: head, series of e, and rows."""
        count = max(len(self.error_cos), len(self.error_sin))
        series = np.zeros((count, 2))
        series[: len(self.error_cos), 0] = self.error_cos
        series[: len(self.error_sin), 1] = self.error_sin
        head = np.zeros(SERIES)
        head[SPACING] = self.spacing
        head[PER_K] = self.damping / self.stiffness
        head[C] = self.damping
        head[MODE] = DAMPINGS[self.contact_damping]
        head[PER_DEPTH] = 1.0 / self.reference
        head[ORDER] = self.order
        head[PHASE] = self.phase
        head[PATH_PHASE] = self.path_phase
        head[FORWARD] = self.forward
        head[PERIODS] = self.periods
        head[ROWS] = self.rows.shape[0]
        head[HARMONICS] = count
        head[E_MEAN] = self.error_mean
        head[LENGTH] = self.rows.shape[1]
        return np.concatenate([head, series.ravel(), self.rows.ravel()])

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

    def repeats(self) -> tuple[Repeats, ...]:
        """The mesh cycle, or the several base pitches after which the map repeats."""
        if not self.order or (self.approach.shape[-2] == 1 and not (self.error_cos or self.error_sin)):
            return ()
        highest = max(_HARMONICS, len(self.error_cos), len(self.error_sin))
        return (Repeats(abs(self.order) / self.periods, highest * self.periods),)
