"""Result of a transient analysis: histories, statistics with their error, contact events, energies, cost."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.modal import NodeTable
from rotorgear.results.result import ModelResult
from rotorgear.results.schema import Record, Written, derived, of, part_of, rows
from rotorgear.results.table import TRANSMISSION_WORDS, Block, Line, Table, error_words, grid, short, table_of, written

# What a history of a contact is called, and the table it stands in.
_OF_CONTACTS = {
    "force": "mesh_force",
    "transmission_error": "transmission_error",
    "approach": "approach",
}


def is_listed(channel: str) -> bool:
    """Whether a table lists a channel; the others are only kept, saved and drawn."""
    return not channel.startswith("gears.") and not (channel.startswith("bearings.") and " displacement " in channel)


def is_shown(statistic: str) -> bool:
    """Whether a table shows a statistic, such as "rms force pair" or "mean bearings.front force x".

    None shows the smallest force of a contact: where a damper lets go it jumps, and is known to first order only.
    """
    return not statistic.startswith("smallest force ") and is_listed(statistic.partition(" ")[2])


# Statistics of a contact that its table shows, and their heads in the table of errors.
_SHOWN = {
    "mean force": "mean",
    "rms force": "rms",
    "largest force": "largest",
    "transmission error": "TE",
    "approach": "appr.",
    "contact loss": "loss",
    "coast contact": "coast",
}
# Below this share of the largest component of its vector a component is what rounding and iterations leave of a zero.
_ROUNDING = 1e-9


_SPEEDS = Written(
    "speed_rpm",
    lambda result, speed: RPM_PER_RAD_S * speed[[0, -1]],
    "rpm",
    ("end",),
    note=" at the start and at the end",
)


def _at_end(key: str, label: str | None = None) -> Written:
    return Written(key, lambda energy, values: float(values[-1]), axes=(), label=label)


class EnergyLedger(Record):
    """Energies at times (e,), all since t = 0: what came in, what is stored, what was dissipated, and the rest.

    numerical = stored - stored(0) - load_work - excitation_work + dissipated: what the integration itself made or lost.
    """

    time: np.ndarray = of("time", "s", "instant", json=None)
    kinetic: np.ndarray = of("kinetic energy", "J", "instant", json=None)
    strain: np.ndarray = of("strain energy", "J", "instant", json=None)
    contact: np.ndarray = of("energy in the contacts", "J", "instant", json=None)
    load_work: np.ndarray = of("work of the constant torques", "J", "instant", json=_at_end("load_work_j"))
    excitation_work: np.ndarray = of(
        "work of the excitation",
        "J",
        "instant",
        json=_at_end("excitation_work_j"),
        note=": transmission errors, stiffness variation, unbalances and torques that vary",
    )
    dissipated: np.ndarray = of("energy that dampers took", "J", "instant", json=_at_end("dissipated_j"))
    numerical: np.ndarray = of(
        "energy error", "J", "instant", json=_at_end("numerical_j"), note=": what the integration made, or lost"
    )
    share: float = of(
        "numerical energy", json="numerical_share", note=", its largest size over the largest of the other terms"
    )


class TransientResult(ModelResult, kind="transient"):
    """r recorded instants of c contacts and p channels.

    Statistics count from the time `settle` on, and are those of all steps, with a cubic between steps where a largest or least
    value is sought; the histories serve pictures and spectra. `transmission_error` is the rotation at the base circles, r_b1
    theta_1 + r_b2 theta_2; `approach` that of the flanks in the transverse plane, v.q / cos(beta_b), bending and axial motion
    included: both positive where the working flanks come together. Forces are positive on the working flank. One of `every` steps
    is recorded; ranges are of all steps. Where frames were asked for, `motion` holds the displacements of the nodes at the last w
    records.
    """

    speed: np.ndarray = of("speed of the input shaft", "rad/s", "record", json=_SPEEDS)
    angle: np.ndarray = of("angle of the input shaft", "rad", "record", json=None)
    time: np.ndarray = of(
        "time",
        "s",
        "record",
        json=(
            _at_end("time_s", "end of the run"),
            Written("records", lambda result, time: len(time), "", (), "number of recorded instants"),
        ),
    )
    settle: float = of("time from which statistics count", "s")
    step: float = of("time step", "s")
    steps: int = of("steps", note=" done")
    every: int = of("steps from one record to the next", json=None)
    mesh_frequency: dict[str, float] = of("mesh frequency", "Hz", "MESH", note=" of each mesh, at the first speed")
    transmission_error: np.ndarray = of("transmission error", "m", "record", "contact", json=None)
    approach: np.ndarray = of("approach", "m", "record", "contact", json=None)
    transmission_error_range: np.ndarray = of(
        "least and largest transmission error in the time that counts", "m", "contact", "end", json=None
    )
    approach_range: np.ndarray = of(
        "least and largest approach in the time that counts", "m", "contact", "end", json=None
    )
    mesh_force: np.ndarray = of("force along the flank normal", "N", "record", "contact", json=None)
    force_range: np.ndarray = of("least and largest force in the time that counts", "N", "contact", "end", json=None)
    impulse: np.ndarray = of(
        "impulse on the working and on the coast flank in the time that counts", "N s", "contact", "side", json=None
    )
    contact_time: np.ndarray = of(
        "share of the time on the working flank, apart, on the coast flank", "", "contact", "state", json=None
    )
    contacts = rows("contacts in the time that counts", "contact")
    contact: tuple[str, ...] = of(
        "name of the contact", "", "contact", note=": mesh and helix", json="name", column="contact"
    )
    mean_force: np.ndarray = of(
        "mean force",
        "N",
        "contact",
        json="static_force_n",
        note=": the static force along the flank normal; negative on the coast flank",
        form=short,
        column="static\nN",
    )
    force_mean: np.ndarray = of(
        "mean of the force in the time that counts", "N", "contact", json="mean_force_n", form=short, column="mean"
    )
    force_rms: np.ndarray = of(
        "root mean square of the force about that mean", "N", "contact", json="rms_force_n", form=short, column="rms"
    )

    largest_force = part_of("force_range", 1, "largest force", "N", "contact", form=short, column="largest")
    smallest_force = part_of("force_range", 0, "smallest force", "N", "contact", note="; negative on the coast flank")

    @derived("dynamic factor", "", "contact", note=": largest over static force", form=".3f", column="K_dyn")
    def dynamic_factor(self) -> np.ndarray:
        """(c,) largest mesh force over the static mean force; NaN where no load flows."""
        safe = np.where(self.mean_force > 0.0, self.mean_force, 1.0)
        return np.where(self.mean_force > 0.0, self.largest_force / safe, np.nan)

    @derived("transmission error, peak to peak", "m", "contact", form=".2f", column="TE\num")
    def peak_to_peak_transmission_error(self) -> np.ndarray:
        """(c,) of the rotation at the base circles."""
        return np.asarray(np.ptp(self.transmission_error_range, axis=1))

    @derived("approach, peak to peak", "m", "contact", form=".2f", column="appr.\num")
    def peak_to_peak_approach(self) -> np.ndarray:
        """(c,) of the flanks in the transverse plane."""
        return np.asarray(np.ptp(self.approach_range, axis=1))

    driving_impulse = part_of(
        "impulse", 0, "impulse on the working flank", "N s", "contact", json="driving_impulse_n_s"
    )
    back_impulse = part_of(
        "impulse", 1, "impulse on the coast flank", "N s", "contact", note=", positive", json="back_impulse_n_s"
    )
    driving = part_of("contact_time", 0, "share of the time on the working flank", "", "contact", json="driving_share")
    apart = part_of(
        "contact_time", 1, "contact-loss ratio", "", "contact", json="apart_share", form=".1f", column="loss\n%"
    )
    back = part_of(
        "contact_time",
        2,
        "share of the time on the coast flank",
        "",
        "contact",
        json="back_share",
        form=".1f",
        column="coast\n%",
    )
    contact_losses: np.ndarray = of("contact losses", "", "contact", json="losses", column="losses")
    values: np.ndarray = of("values", "", "record", "channel", json=None)
    value_range: np.ndarray = of(
        "least and largest values of the channels in the time that counts", "", "channel", "end", json=None
    )
    channels = rows("channels in the time that counts", "channel")
    channel: tuple[str, ...] = of(
        "name of the channel",
        "",
        "channel",
        note=": force of a bearing, motion of a part, or load inside a shaft",
        json="name",
    )
    unit: tuple[str, ...] = of("unit", "", "channel")
    value_mean: np.ndarray = of("mean in the time that counts", "", "channel", json="mean")
    value_rms: np.ndarray = of("root mean square about the mean", "", "channel", json="rms")

    largest_value = part_of("value_range", 1, "largest value", "", "channel", json="largest")
    smallest_value = part_of("value_range", 0, "smallest value", "", "channel", json="smallest")
    quantities = rows("statistics with an error", "quantity")
    quantity: tuple[str, ...] = of("name of the statistic whose error is estimated", "", "quantity", json="name")
    quantity_value: np.ndarray = of("value", "", "quantity", json="value")
    quantity_error: np.ndarray = of(
        "estimated error", "", "quantity", note=", absolute; `null` where none was asked for", json="error"
    )
    quantity_scale: np.ndarray = of(
        "sizes that the errors of the statistics are taken relative to", "", "quantity", json=None
    )
    error_estimate: float = of(
        "largest relative error of the statistics that are shown",
        note=", each relative to its own size",
        form=error_words,
    )
    error_source: str = of("where the errors of the statistics are from", note=", in words")
    energy: EnergyLedger = of("energies", record=EnergyLedger)
    reason: str = of("why the method was chosen")
    start: str = of(
        "where the run began",
        note=': `"equilibrium"` under the forces of t = 0, under their `"mean"`, or undeformed, at `"rest"`',
    )
    nodes: NodeTable = of("nodes", record=NodeTable, json=None)
    motion_time: np.ndarray = of("time of the frames", "s", "frame", json=None)
    motion: np.ndarray = of("displacements x y z tx ty tz", "m, rad", "node", "component", "frame", json=None)

    @property
    def counted(self) -> np.ndarray:
        """(r,) whether a record counts in the statistics."""
        return self.time >= self.settle * (1.0 - 1e-12)

    @property
    def spacing(self) -> float:
        """Time between two records in s."""
        return self.step * self.every

    def history(self, name: str) -> np.ndarray:
        """History (r,) of a channel, or of "force NAME", "transmission_error NAME" or "approach NAME" of a contact.

        "deflection NAME", the approach along the flank normal, is read for the last time.

        Raises:
            KeyError: no such history.
        """
        if name in self.channel:
            return np.asarray(self.values[:, self.channel.index(name)])
        what, _, contact = name.partition(" ")
        if contact in self.contact and what in _OF_CONTACTS:
            table = getattr(self, _OF_CONTACTS[what])
            return np.asarray(table[:, self.contact.index(contact)])
        raise KeyError(name)

    def tables(self) -> Iterator[Block]:
        """Contacts, channels and notes."""
        rpm = [f"{w * RPM_PER_RAD_S:.5g}" for w in (self.speed[0], self.speed[-1])]
        turns = rpm[0] if rpm[0] == rpm[1] else f"{rpm[0]} to {rpm[1]}"
        counted = f"{self.time[-1] - self.settle:.4g} s after {self.settle:.4g} s"
        if self.time[-1] <= self.settle:
            counted = (
                f"ended at {self.time[-1]:.4g} s, before the {self.settle:.4g} s that are discarded: nothing counts"
            )
        yield Line(f"{self.model.title or 'Transient'}: {self.model.reference_shaft} at {turns} rpm, {counted}")
        known = self.error_estimate == self.error_estimate
        if self.contact:
            yield from (table_of(self, "contacts", tight=True), "")
            if known:
                yield from ("Estimated errors, relative", self._errors(), "")
        channels = self._channels()
        if channels.rows:
            yield from (channels, "")
        if self.contact:
            yield f"TE: {TRANSMISSION_WORDS}; both peak to peak"
        cost = f"{self.dofs} dofs, {self.steps} steps of {self.step:.4g} s, {self.cost}"
        yield f"{cost}; {self.method} ({self.reason})"
        if known:
            within = f"error: statistics within {error_words(self.error_estimate, 1)}, each of its own size"
            yield f"{within}; {self.seconds.get('error estimate', 0.0):.2f} CPU s, from {self.error_source}"
        yield f"energy error: {error_words(self.energy.share, 1)} of the largest term"
        yield from (*self.remarks(), "")

    def error_of(self, statistic: str) -> float:
        """Estimated error of a statistic such as "rms force pair", relative to its own size; of shares absolute.

        Raises:
            KeyError: no such statistic.
        """
        if statistic not in self.quantity:
            raise KeyError(statistic)
        number = self.quantity.index(statistic)
        size = float(self.quantity_scale[number])
        error = float(self.quantity_error[number])
        return error / size if size > 0.0 else error

    def _errors(self) -> Table:
        """Errors of what the table of the contacts shows, relative to it."""
        rows = [
            [name, *(written(self.error_of(f"{what} {name}"), error_words) for what in _SHOWN)] for name in self.contact
        ]
        return grid(rows, "contact", *_SHOWN.values(), caption="Estimated errors of the contacts, relative")

    def _channels(self) -> Table:
        """Statistics of the channels, but of those that are only kept, and the largest of their relative errors."""
        shown = [row for row in self.channels if not row.name.startswith("gears.")]
        scale: dict[str, float] = {}
        for row in shown:
            vector = row.name.rpartition(" ")[0] or row.name
            sizes = [abs(value) for value in (row.largest, row.smallest) if math.isfinite(value)]
            scale[vector] = max([scale.get(vector, 0.0), *sizes])
        heads = ("channel", "mean", "rms", "largest", "smallest", "error", "unit")
        rows = []
        for row in shown:
            if not is_listed(row.name):
                continue
            least = _ROUNDING * scale[row.name.rpartition(" ")[0] or row.name]
            values = (row.mean, row.rms, row.largest, row.smallest)
            cells = ("0" if abs(value) < least else short(value) for value in values)
            errors = [self.error_of(f"{what} {row.name}") for what in heads[1:5]]
            rows.append((row.name.partition(".")[2], *cells, written(max(errors), error_words), row.unit))
        return grid(rows, *heads, last=True, caption="Channels in the time that counts")
