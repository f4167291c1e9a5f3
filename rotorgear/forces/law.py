"""What every force law is and answers: the tutorial for a law of your own.

A law tells the force F along k relative displacements d of two places, or of one place against ground, from d, the velocities v,
and the angle, speed and time of the reference shaft. F acts against d: a spring has F = k d. Laws know nothing of degrees of
freedom, of solvers or of analyses; analyses know nothing of laws but what is written here, so a law of one file works in all.

1. **Compiled functions.** `schedule(angle, speed, time, p, s)` fills the state s with what depends on time only, once a step.
   `force(p, s, d, v, F, Kd, Kv, energy)` fills F (k,), its tangents dF/dd and dF/dv (k*k, row by row), and energy = [stored,
   power that prescribed motion puts in, power dissipated, contact: 1, 0 apart, -1 on the other side].
2. **Parameters.** The law is a frozen dataclass; each field is declared with its SI unit, its meaning and its bounds, which are
   checked when a law is made. `p` holds the fields in the order of their declaration, unless `parameters` says otherwise.
3. **A name.** `@rg.register_law("name")` makes it known to model files and to `registry.law_of`.

A stop with a damper, whole:

    from dataclasses import dataclass
    import rotorgear as rg

    STIFFNESS, DAMPING, GAP = range(3)

    @rg.force_function
    def force(p, s, d, v, F, Kd, Kv, energy):
        depth = max(d[0] - p[GAP], 0.0)
        F[0] = p[STIFFNESS] * depth + p[DAMPING] * v[0]
        Kd[0] = p[STIFFNESS] if depth > 0.0 else 0.0
        Kv[0] = p[DAMPING]
        energy[:] = 0.5 * p[STIFFNESS] * depth**2, 0.0, p[DAMPING] * v[0] ** 2, 1.0 if depth > 0.0 else 0.0

    @rg.register_law("stop")
    @dataclass(frozen=True)
    class Stop(rg.ForceLaw):
        title = "stop"
        stiffness: float = rg.parameter("N/m", "k", least=0.0)
        damping: float = rg.parameter("N s/m", "c", 0.0, least=0.0)
        gap: float = rg.parameter("m", "clearance", 0.0, least=0.0)

        def functions(self):
            return rg.no_schedule, force

        @classmethod
        def examples(cls):
            return (cls(1e7, 10.0, 1e-5),)

The rest of `ForceLaw` has answers that hold for any law; a law says more where it knows more: what repeats as the reference turns
(`repeats`), about which stiffness and damping solvers may expand (`reference_stiffness`), what remains without what varies
(`mean`), and, so that sweeps take it in whole vector registers rather than one system at a time, its `columns` and `table`.
tests/contract/test_force_laws.py holds every law of the registry to what it says, on its `examples`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import MISSING, dataclass, field, fields
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.solvers.batch.columns import OWN_LAW, TABLE_ROWS, Column
from rotorgear.solvers.time.local_forces import Repeats

if TYPE_CHECKING:
    from rotorgear.forces.inside import OilField, RollingLoads

__all__ = ["ForceLaw", "LawValue", "Linearised", "Parameter", "Repeats", "parameter", "refuse"]


@dataclass(frozen=True)
class Parameter:
    """What a law declares of a parameter.

    Attributes:
        unit: SI; meaning: in words; default: None where one must be given.
        least, most: bounds that are allowed themselves; above, below: bounds that are not.
        choices: the words allowed, of a parameter that is a word.
    """

    unit: str
    meaning: str
    default: Any = None
    least: float | None = None
    above: float | None = None
    most: float | None = None
    below: float | None = None
    choices: tuple[str, ...] = ()

    @property
    def expected(self) -> str:
        """The bounds in words, "a number of at least 0"."""
        if self.choices:
            return "one of " + ", ".join(self.choices)
        words = {"of at least": self.least, "above": self.above, "of at most": self.most, "below": self.below}
        given = [f"{word} {bound:g}" for word, bound in words.items() if bound is not None]
        return "a finite number" + (" " if given else "") + " and ".join(given)

    def allows(self, value: Any) -> bool:
        """Whether a value lies within the bounds; of a sequence, all that it holds. Other objects are not judged."""
        if self.choices:
            return value in self.choices
        if isinstance(value, tuple | list):
            return all(self.allows(each) for each in value)
        if not isinstance(value, int | float):
            return not isinstance(value, str)
        return bool(
            np.isfinite(value)
            and (self.least is None or value >= self.least)
            and (self.above is None or value > self.above)
            and (self.most is None or value <= self.most)
            and (self.below is None or value < self.below)
        )


def parameter(
    unit: str,
    meaning: str,
    default: Any = MISSING,
    *,
    least: float | None = None,
    above: float | None = None,
    most: float | None = None,
    below: float | None = None,
    choices: tuple[str, ...] = (),
) -> Any:
    """Declare a parameter of a law: its SI unit, what it means, its default and its bounds.

    Args:
        unit: SI unit of the value, "" for none.
        meaning: what it is, in words.
        default: value where none is given; without it one has to be given.
        least: bound from below that the value itself may have.
        above: bound from below that the value must exceed.
        most: bound from above that the value itself may have.
        below: bound from above that the value must stay under.
        choices: texts that are allowed, for a parameter that is a word.

    Returns:
        The field of a dataclass.
    """
    known = None if default is MISSING else default
    about = {"parameter": Parameter(unit, meaning, known, least, above, most, below, choices)}
    return field(metadata=about) if default is MISSING else field(default=default, metadata=about)


@dataclass(frozen=True)
class LawValue:
    """Force (k,), its tangents in d and v (k, k), stored energy, powers put in and dissipated, and the state of contact.

    At r instants each of them has one axis more in front, (r, k) and so on.
    """

    force: np.ndarray
    in_displacement: np.ndarray
    in_velocity: np.ndarray
    stored: Any
    power_in: Any
    dissipated: Any
    contact: Any


@dataclass(frozen=True)
class Linearised:
    """Mean force (k,), stiffness dF/dd and damping dF/dv (k, k) of a law about a state."""

    force: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray


@dataclass(frozen=True)
class ForceLaw(ABC):
    """Base of all laws. What a law must answer is abstract; the rest has answers that hold for any law."""

    title: ClassVar[str]
    # Whether the force alone can't bring energy into the structure while nothing prescribed moves.
    passive: ClassVar[bool] = True
    # Whether the energy that it stores is the potential of its elastic force. Time integration then keeps energy to rounding
    # where sides meet and part; a law that does not say so is taken half way through each step, and may gain energy there.
    conserves: ClassVar[bool] = False
    # Whether it carries a load while its shaft stands still; a film does not.
    carries_at_rest: ClassVar[bool] = True
    # Whether its force has kinks at many places, as a film has wherever a node of its grid begins to cavitate.
    many_kinks: ClassVar[bool] = False
    # Names of the parameters that say how many cells its grid has each way; a law that is a formula has none.
    grid: ClassVar[tuple[str, ...]] = ()
    # Name of the parameter that holds the turns of the law's shaft for each turn of the reference; a model file fills it in.
    shaft_ratio: ClassVar[str] = ""

    def __post_init__(self) -> None:
        """Hold all parameters to their declared bounds, then to what the law itself checks.

        Raises:
            AnalysisError: a parameter is out of its bounds.
        """
        for name, about in self.declared().items():
            if not about.allows(getattr(self, name)):
                raise refuse(self, name, about.expected)
        self.check()

    def check(self) -> None:  # noqa: B027  most laws have nothing to check
        """Refuse parameters that do not go together, by `raise refuse(...)`."""

    @property
    def components(self) -> int:
        """Number k of relative displacements."""
        return 1

    @property
    def uses_velocity(self) -> bool:
        """Whether force or energy depend on the velocities v."""
        return True

    @property
    def extents(self) -> np.ndarray:
        """Displacements (k,) that change the force by the size of its parts, where these cancel; 0: no parts do.

        The clearance of a film: without a load its force is rounding of pressures of this size times the tangent.
        """
        return np.zeros(self.components)

    # The compiled side.

    @abstractmethod
    def functions(self) -> tuple[Any, Any]:
        """Return the compiled functions schedule and force."""

    def parameters(self) -> np.ndarray:
        """Return p as the compiled functions read it: the fields in the order of their declaration."""
        return np.array([getattr(self, name) for name in self.declared()], dtype=float)

    def state_size(self) -> int:
        """Length of the state s that the schedule fills."""
        return 0

    # About which state solvers may expand.

    def reference_stiffness(self) -> np.ndarray:
        """Linear stiffness (k, k) about which a solver may expand; nothing of the result depends on it."""
        return np.zeros((self.components, self.components))

    def reference_damping(self) -> np.ndarray:
        """Linear damping (k, k) about which a solver may expand; nothing of the result depends on it."""
        return np.zeros((self.components, self.components))

    def closed_stiffness(self) -> np.ndarray:
        """Mean stiffness (k, k) with all contacts closed: the measure of compliances at this place."""
        return self.reference_stiffness()

    def linearised(self, d: Any = 0.0, v: Any = 0.0, *, speed: float = 0.0, points: int | None = None) -> Linearised:
        """Mean force, stiffness and damping about displacements d and velocities v (k,), as linear analyses take them.

        What varies in time is left out (`mean`). Rolling elements and the like that turn are averaged over a `cycle`, at
        `points` (32) places, because an analysis at speed may not depend on where one of them happens to be; at speed 0 they
        are at angle 0.
        """
        still = self.mean()
        k = self.components
        count = points or CYCLE_POINTS
        angles = still.cycle() * np.arange(count) / count if still.cycle() and speed else np.zeros(1)
        if angles.size == 1:
            value = still.evaluate(d, v, speed=speed)
            return Linearised(value.force, value.in_displacement, value.in_velocity)
        d, v = (np.broadcast_to(np.asarray(x, float), (angles.size, k)) for x in (d, v))
        values = still.evaluate_many(d, v, angle=angles, speed=speed)
        return Linearised(*(x.mean(axis=0) for x in (values.force, values.in_displacement, values.in_velocity)))

    def linearised_at(self, places: np.ndarray, *, speed: float = 0.0) -> Iterator[Linearised]:
        """`linearised` about each of r displacements (r, k) at rest; what is averaged over a cycle in one compiled loop for all.

        A call of such a loop takes as long as some hundred evaluations of a rolling bearing.
        """
        still = self.mean()
        if not (still.cycle() and speed):
            yield from (self.linearised(d, speed=speed) for d in places)
            return
        r = len(places)
        angles = np.tile(still.cycle() * np.arange(CYCLE_POINTS) / CYCLE_POINTS, r)
        values = still.evaluate_many(np.repeat(places, CYCLE_POINTS, axis=0), angle=angles, speed=speed)
        about = (values.force, values.in_displacement, values.in_velocity)
        means = (x.reshape(r, CYCLE_POINTS, *x.shape[1:]).mean(axis=1) for x in about)
        yield from (Linearised(*one) for one in zip(*means, strict=True))

    def settled(self, d: Any) -> ForceLaw:
        """The law as it stays for small motions about displacements d (k,): an inlet that statics place stays there then."""
        return self

    @property
    def cells(self) -> str:
        """Cells of its grid each way, as they are printed."""
        return " x ".join(str(getattr(self, key)) for key in self.grid)

    def rough(self) -> ForceLaw:
        """A law of about the same stiffness that costs less, for what no result depends on."""
        return self

    def inside(self, d: Any, *, angle: float = 0.0, speed: float = 0.0) -> RollingLoads | OilField | None:
        """What a bearing looks like inside at displacements d (k,); None for laws that know nothing of it."""
        return None

    def beyond(self, d: Any, speed: float) -> str:
        """Why the law does not hold at displacements d (k,) in equilibrium at a speed of the reference, as a clause; or ""."""
        return ""

    # What the law says of itself to the reader of a result.

    @property
    def can_part(self) -> bool:
        """Whether its sides can lose contact."""
        return False

    @property
    def steady(self) -> bool:
        """Whether nothing of the law varies as the reference turns."""
        return not self.repeats()

    @property
    def known_up_to(self) -> float:
        """Largest force in N for which the law was made; it goes on above as it says."""
        return float("inf")

    def left_out(self) -> tuple[str, ...]:
        """What the law leaves out or takes in its place, as clauses behind the name of its part."""
        return ()

    def doubts(self, d: Any, speed: float) -> Iterator[tuple[str, str]]:
        """What the law leaves out in equilibrium at displacements d (k,), and of which of its parts; nothing by default."""
        yield from ()

    # What varies as the reference turns.

    def repeats(self) -> tuple[Repeats, ...]:
        """What of the law varies with the angle of the reference; nothing by default."""
        return ()

    def mean(self) -> ForceLaw:
        """Return the law without anything that varies in time."""
        return self

    def cycle(self) -> float:
        """Radians of the reference after which the mean law is the same again; 0 where it does not depend on the angle."""
        return 0.0

    def unsettled(self) -> str:
        """Why the law allows no settled motion, as a clause; empty where it does."""
        return ""

    def impulse(self, d: Any, *, angle: float = 0.0) -> np.ndarray:
        """Momentum (k,) that damping takes up between the free state and displacements d, whatever the velocity on the way.

        It serves where damping sets in so suddenly that no step of a sensible length sees it: J = int F_v dt, F_v = f(d) d'.
        Zero for laws whose damping has no such jump.
        """
        return np.zeros(self.components)

    # How sweeps take the law: by whole vector registers where its columns say how, else by its compiled functions.

    def columns(self, speed: float = 1.0) -> tuple[Column, ...]:
        """How each of the k displacements acts in a sweep at a speed of the reference in rad/s."""
        return (Column(OWN_LAW),) * self.components

    def table(self, angles: np.ndarray, states: np.ndarray, order: float) -> np.ndarray:
        """What varies in the columns, (r, k, 4) in the rows of solvers/batch/columns.py.

        Args:
            angles: of the reference, (r,). states: of the schedule there at unit speed, (r, s).
            order: radians of the sweep's time for each of the reference.
        """
        return np.zeros((len(angles), self.components, TABLE_ROWS))

    def table_key(self) -> bytes:
        """Bytes that two laws share where their tables are the same."""
        return b""

    @classmethod
    @abstractmethod
    def examples(cls) -> tuple[ForceLaw, ...]:
        """Laws with sensible parameters, for the contract tests."""

    @classmethod
    def declared(cls) -> dict[str, Parameter]:
        """Name -> unit, meaning, default and bounds of every parameter."""
        return {item.name: item.metadata["parameter"] for item in fields(cls)}

    @classmethod
    def required(cls) -> tuple[str, ...]:
        """Names of the parameters that have no default."""
        return tuple(item.name for item in fields(cls) if item.default is MISSING and item.default_factory is MISSING)

    def evaluate(self, d: Any, v: Any = 0.0, *, time: float = 0.0, angle: float = 0.0, speed: float = 0.0) -> LawValue:
        """Return force and tangents at displacements d and velocities v (k,), a time, and angle and speed of the reference."""
        schedule, force = self.functions()
        k = self.components
        p = np.ascontiguousarray(self.parameters(), dtype=float)
        state = np.zeros(self.state_size())
        schedule(angle, speed, time, p, state)
        d, v = (np.ascontiguousarray(np.broadcast_to(np.asarray(x, float), k)).copy() for x in (d, v))
        F = np.zeros(k)
        Kd = np.zeros(k * k)
        Kv = np.zeros(k * k)
        energy = np.zeros(4)
        force(p, state, d, v, F, Kd, Kv, energy)
        stored, power_in, dissipated, contact = map(float, energy)
        return LawValue(F, Kd.reshape(k, k), Kv.reshape(k, k), stored, power_in, dissipated, int(contact))

    def evaluate_many(self, d: Any, v: Any = 0.0, *, time: Any = 0.0, angle: Any = 0.0, speed: Any = 0.0) -> LawValue:
        """`evaluate` at r instants in one compiled loop: d and v (r, k); time, angle and speed (r,) or the same for all."""
        from rotorgear.solvers.time.arguments import Answer
        from rotorgear.solvers.time.kernel_contact import evaluate_instants, no_force, no_schedule

        schedule, force = self.functions()
        k = self.components
        r = len(d)
        # Copies: what numpy broadcasts is read-only, for which numba would compile the loop once more.
        d, v = (np.array(np.broadcast_to(np.asarray(x, float), (r, k)), order="C") for x in (d, v))
        time, angle, speed = (np.array(np.broadcast_to(np.asarray(x, float), r)) for x in (time, angle, speed))
        p = np.ascontiguousarray(self.parameters(), dtype=float)
        answer = Answer(np.zeros((r, k)), np.zeros((r, k * k)), np.zeros((r, k * k)), np.zeros((r, 4)))
        # As tuples of two, so that numba takes the functions by pointer and keeps the loop on disk, whatever the law.
        laws = (schedule, no_schedule), (force, no_force)
        evaluate_instants(*laws, p, np.zeros(self.state_size()), angle, speed, time, d, v, answer)
        Kd = answer.Kd.reshape(r, k, k)
        Kv = answer.Kv.reshape(r, k, k)
        stored, power_in, dissipated, contact = answer.energy.T
        return LawValue(answer.F, Kd, Kv, stored, power_in, dissipated, contact.astype(np.int64))


# Places of a rolling element in its pitch over which a linearisation averages.
CYCLE_POINTS = 32


def refuse(law: ForceLaw, name: str, expected: str) -> AnalysisError:
    """Return the error for a parameter out of its bounds."""
    return AnalysisError(f"{type(law).__name__}.{name}: got {getattr(law, name)!r}, expected {expected}")
