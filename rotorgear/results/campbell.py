"""Result of a Campbell analysis: branches of modes over speed, excitation lines, crossings, margins, onset of instability."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.laws import AboutEquilibrium
from rotorgear.results.modal import WHIRL_WORDS, WRITTEN_WHIRL, NodeTable, Piece
from rotorgear.results.planets import (
    carrier_columns,
    carrier_frequency_over,
    carrier_share_over,
    class_energy_over,
    classes_over,
)
from rotorgear.results.schema import Record, derived, of
from rotorgear.results.table import Block, Column, Line, error_words, exact, table_of, table_over

# So many crossings are listed; sidebands of a gearbox give thousands.
_MOST_CROSSINGS = 100


class ExcitationOrder(Record):
    """A line of excitation: `order` times the speed of the input shaft."""

    name: str = of("name", note=' of an excitation line, such as "mesh stage_1 2x"')
    kind: str = of("kind", note=': `"shaft"`, `"mesh"` or `"sideband"`')
    parts: tuple[str, ...] = of("parts", "", "part", note=": shafts or meshes that excite at this order")
    order: float = of("order", note=": frequency over that of the input shaft")

    def frequency_hz(self, speed: float) -> float:
        """Frequency in Hz at a speed of the input shaft in rad/s."""
        return float(self.order * abs(speed) / (2.0 * np.pi))


class Crossing(Record):
    """Where a branch meets a line.

    First order of a shaft: the participation is forward whirl of its bending only, which is what unbalance can drive.
    """

    line: str = of("excitation line", note=" that is met", column="line")
    branch: int = of("branch", note=", from 1", column="branch")
    speed: float = of("speed of the input shaft", "rad/s", note=" there", form=".2f", column="rpm")
    frequency_hz: float = of(
        "frequency", "Hz", note=" of the mode there, the damped one", form=exact(".3f"), column="Hz"
    )
    damping_ratio: float = of("damping ratio", note=" of the mode there", form=".3f", column="zeta %")
    whirl: str = of("sense of whirl", note=" there, for the shaft whose line it is", column="whirl")
    participation: float = of(
        "share of the exciting part in the energy of the mode",
        note=": a mesh in the strain energy, a shaft in the kinetic energy",
        form=".2f",
        column="energy\n%",
    )
    excited: bool = of("whether the line can excite the mode", note=": whether the participation is above 1e-4")


class Margin(Record):
    """The mode next to a line at the operating speed, among those that the line can excite."""

    line: str = of("excitation line", column="line")
    frequency_hz: float = of("frequency", "Hz", note=" of the line at the operating speed", form=".2f", column="Hz")
    branch: int = of(
        "branch", note=", from 1: the nearest that the line can excite; 0: none, or all lie below it", column="branch"
    )
    mode_hz: float = of("damped frequency of that branch", "Hz", note="; `null`: none", form=".2f", column="Hz")
    margin: float = of("margin", note=": `mode_hz` over `frequency_hz`, less 1", form="+.2f", column="margin %")
    whirl: str = of("sense of whirl", note=" of that branch for the shaft whose line it is", column="whirl")
    participation: float = of(
        "share of the exciting part in the energy of the mode",
        note=", as at a crossing",
        form=".2f",
        column="energy\n%",
    )
    crossing_speed: float = of(
        "nearest crossing that the line can excite", "rad/s", note="; `null`: none", form=".1f", column="crossing rpm"
    )


class Onset(Record):
    """Where a branch becomes unstable."""

    branch: int = of(
        "branch", note=" that becomes unstable, from 1; 0: a motion that does not oscillate", column="branch"
    )
    speed: float = of(
        "speed of the input shaft", "rad/s", note=" from which on it is unstable", form=".1f", column="from rpm"
    )
    frequency_hz: float = of("frequency", "Hz", note=" there", form=exact(".3f"), column="Hz")


class CampbellResult(AboutEquilibrium, kind="campbell"):
    """b branches of modes over k speeds; values are NaN where a branch does not oscillate, or is out of reach.

    The displacements of a branch at the p nodes and stations are `basis @ coordinates`; see `shapes`.
    """

    json_axes = ("SHAFT", "MOTION", "MESH", "CLASS", "CARRIER", "branch", "speed")

    speeds: np.ndarray = of("speed of the input shaft", "rad/s", "speed", json="speed_rpm", note=", ascending in size")
    operating_speed: float | None = of("operating speed of the model", "rad/s", note="; `null` without one")
    eigenvalues: np.ndarray = of("eigenvalue s", "rad/s", "speed", "branch", json=None)

    @property
    def speed_rpm(self) -> np.ndarray:
        """Speeds of the input shaft in rpm, (k,)."""
        return np.asarray(self.speeds * RPM_PER_RAD_S)

    @derived("frequency", "Hz", "speed", "branch", note=" of a branch, the damped one")
    def frequency_hz(self) -> np.ndarray:
        """Damped frequency Im s / 2 pi, (k, b)."""
        return np.asarray(self.eigenvalues.imag / (2.0 * np.pi))

    @derived("natural frequency", "Hz", "speed", "branch", note=", |s| / 2π")
    def natural_frequency_hz(self) -> np.ndarray:
        """|s| / 2 pi, (k, b)."""
        return np.asarray(np.abs(self.eigenvalues) / (2.0 * np.pi))

    @derived("damping ratio", "", "speed", "branch", note=", below 0 where the motion grows")
    def damping_ratio(self) -> np.ndarray:
        """-Re s / |s|, (k, b)."""
        return np.asarray(-self.eigenvalues.real / np.abs(self.eigenvalues) + 0.0)

    @derived("logarithmic decrement", "", "speed", "branch", note=", below 0 where the motion grows")
    def log_decrement(self) -> np.ndarray:
        """2 pi zeta / sqrt(1 - zeta^2), (k, b); negative where the motion grows."""
        return np.asarray(-2.0 * np.pi * self.eigenvalues.real / self.eigenvalues.imag + 0.0)

    whirl: np.ndarray = of(
        "sense of whirl",
        "",
        "speed",
        "branch",
        json=WRITTEN_WHIRL,
        note=': `"forward"`, `"backward"`, `"mixed"`, `"planar"` or `""`; in Python numbers into `WHIRL_WORDS`',
    )
    whirl_by_shaft: dict[str, np.ndarray] = of(
        "sense of whirl of each shaft", "", "SHAFT", "speed", "branch", note=", from -1 (backward) to +1 (forward)"
    )
    kinetic_by_motion: dict[str, np.ndarray] = of(
        "share of a motion in the kinetic energy", "", "MOTION", "speed", "branch"
    )
    strain_by_motion: dict[str, np.ndarray] = of(
        "share of a motion in the strain energy", "", "MOTION", "speed", "branch"
    )
    mesh_strain: dict[str, np.ndarray] = of("share of each mesh in the strain energy", "", "MESH", "speed", "branch")
    description: tuple[str, ...] = of(
        "what moves", "", "branch", note=", at the last speed at which the branch oscillates"
    )
    error_estimate: np.ndarray = of(
        "estimated relative discretisation error", "", "branch", note=", the larger of both ends", form=error_words
    )
    basis_error: float = of(
        "largest relative error of the reduced eigenvalues", note=" against true solutions at speeds outside the basis"
    )
    basis: np.ndarray = of("displacements of the basis", "m, rad", "node", "component", "vector", json=None)
    coordinates: np.ndarray = of("coordinates in the basis", "", "speed", "vector", "branch", json=None)
    nodes: NodeTable = of("nodes", record=NodeTable, json=None)
    lines: tuple[ExcitationOrder, ...] = of("excitation lines", "", "line", record=ExcitationOrder)
    crossings: tuple[Crossing, ...] = of("crossings", "", "crossing", record=Crossing)
    margins: tuple[Margin, ...] = of("margins", "", "margin", record=Margin)
    onsets: tuple[Onset, ...] = of("onsets of instability", "", "onset", record=Onset)
    discretisation: tuple[Piece, ...] = of("how each shaft segment was divided", "", "piece", record=Piece)
    mode_class: tuple[str, ...] = classes_over(
        "branch", note=", at the last speed at which it oscillates, as in a modal result; empty without planets"
    )
    class_energy: dict[str, np.ndarray] = class_energy_over("speed", "branch")
    carrier_frequency_hz: dict[str, np.ndarray] = carrier_frequency_over("speed", "branch")
    carrier_frequency_share: dict[str, np.ndarray] = carrier_share_over("speed", "branch")

    def __len__(self) -> int:
        return int(self.eigenvalues.shape[1])

    def whirl_word(self, speed: int, branch: int) -> str:
        """Sense of whirl of a branch at a speed, by their numbers from 0."""
        return WHIRL_WORDS[int(self.whirl[speed, branch])]

    def shapes(self, speed: int) -> np.ndarray:
        """Displacements x y z tx ty tz of all branches at a speed (number from 0), (p, 6, b) complex, modal mass 1."""
        return np.asarray(self.basis @ self.coordinates[speed])

    def tables(self, *, crossings: bool = False) -> Iterator[Block]:
        """Branches, margins and, where asked for, crossings."""
        first, last = self.speed_rpm[[0, -1]]
        yield Line(f"{self.model.title or 'Modes'}: {self.model.reference_shaft} at {first:.6g} to {last:.6g} rpm")
        small = exact(".4f")
        end = len(self.speeds) - 1
        columns = (
            Column("branch", lambda b: b + 1),
            Column(f"Hz at {first:.6g}", "frequency_hz", small, entry=(0,)),
            Column(f"Hz at {last:.6g}", "frequency_hz", small, entry=(end,)),
            Column("log dec.", "log_decrement", small, entry=(end,)),
            Column("whirl", lambda b: self.whirl_word(-1, b)),
        )
        caption = f"Branches; log dec., whirl and what moves at {last:.6g} rpm"
        yield table_over(self, "branch", *columns, "description", caption=caption, titled=True)
        if self.mode_class:
            hz, share = (
                {carrier: values[end] for carrier, values in every.items()}
                for every in (self.carrier_frequency_hz, self.carrier_frequency_share)
            )
            seen = (columns[0], columns[2], *carrier_columns(hz, share))
            caption = f"Classes of planetary motions at {last:.6g} rpm"
            yield table_over(self, "branch", *seen, "mode_class", caption=caption, titled=True)
        if self.operating_speed is not None and self.margins:
            at = f"Margins at {self.operating_speed * RPM_PER_RAD_S:.6g} rpm"
            hits = Column("", "branch", where=lambda one: one.branch > 0)
            part = Column("", "participation", where=lambda one: one.branch > 0)
            shown = ("line", "frequency_hz", hits, "mode_hz", "margin", "whirl", part, "crossing_speed")
            yield table_of(self, "margins", *shown, caption=at, titled=True)
        if crossings:
            # The most telling ones of a long list, in its order.
            numbers = range(len(self.crossings))
            kept = sorted(sorted(numbers, key=lambda k: -self.crossings[k].participation)[:_MOST_CROSSINGS])
            part = Column("", "participation", where=lambda one: one.excited, without="not excited")
            met = ("speed", "frequency_hz", "branch", "line", "whirl", "damping_ratio", part)
            yield table_of(self, "crossings", *met, keep=kept, titled=True)
        yield ""
        if crossings and len(self.crossings) > _MOST_CROSSINGS:
            rest = len(self.crossings) - _MOST_CROSSINGS
            yield f"{rest} more crossings take part less than these: --json has them all"
        if any(not item.branch for item in self.margins):
            yield "-: the line lies above all branches (--fmax follows more), or can't excite any"
        if not crossings:
            excited = f"{sum(item.excited for item in self.crossings)} of them of modes that the line can excite"
            yield f"{len(self.crossings)} crossings, {excited}; --crossings lists them"
        yield f"{self.dofs} dofs, {self.cost}; {self.method}"
        estimates = self.error_estimate[np.isfinite(self.error_estimate)]
        if estimates.size:
            yield f"error: estimated relative discretisation error of each frequency, largest {error_words(estimates.max(), 1)}"
        yield from (*self.remarks(), "")
