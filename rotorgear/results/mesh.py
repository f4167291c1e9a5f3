"""Result of a mesh: stiffness, transmission error and load distribution of a pair of gears over the mesh cycle."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from rotorgear.gears.stiffness.cycle_curve import CycleCurve
from rotorgear.results.result import Result
from rotorgear.results.schema import Record, derived, of, plain
from rotorgear.results.table import Block, Line, Table, grid

PLANE = "transverse, along the line of action: base force over approach"
# So many orders are written where nothing else is asked for.
_ORDERS = 8


class MeshLoad(Record):
    """What a mesh carries, of all helices together."""

    pinion_torque_n_m: float = of("torque on the pinion about +z", "N m")
    base_force_n: float = of("tangential force F_bt at the base circle", "N")
    normal_force_n: float = of("force F_n along the flank normal", "N")
    source: str = of("where the load is from")


class LoadedPieces(Record):
    """The n pieces of contact lines that carry load."""

    position_number: np.ndarray = of(
        "index into `position`", "", "piece", note=" of each loaded piece of a contact line"
    )
    pair: np.ndarray = of("number of the tooth pair", "", "piece")
    z_m: np.ndarray = of("middle along the face", "m", "piece")
    pinion_roll_length_m: np.ndarray = of("roll length on the pinion", "m", "piece")
    gear_roll_length_m: np.ndarray = of("roll length on the gear", "m", "piece")
    line_load_n_per_m: np.ndarray = of("force per length of contact line", "N/m", "piece")
    half_width_m: np.ndarray = of("half-width of the contact", "m", "piece")
    pressure_pa: np.ndarray = of("largest contact pressure", "Pa", "piece")


class HelixContact(Record):
    """Loaded contact of one helix over p positions, in n slices of the contact lines; stiffness in the transverse plane."""

    stiffness: np.ndarray = of("stiffness", "N/m", "position", note=" of one helix over `position`")
    tangent: np.ndarray = of("tangent stiffness", "N/m", "position", json=None)
    transmission_error: np.ndarray = of("transmission error", "m", "position", json="ste_m", note=" under load")
    no_load_error: np.ndarray = of("transmission error without load", "m", "position", json="no_load_te_m")
    share: dict[int, np.ndarray] = of(
        "share of a tooth pair in the load", "", "PAIR", "position", json="load_share", note=" over `position`"
    )
    contact_ratio: float = of("mean number of pairs that carry load")
    geometric_contact_ratio: float = of(
        "total contact ratio without load", note=", of the involutes that are there: undercut shortens it"
    )
    path_of_contact: tuple[float, float, float] = of(
        "roll lengths of the pinion at A, C and E", "m", "points_a_c_e", note=": start of contact, pitch point and end"
    )
    position: np.ndarray = of("number of the position", "", "slice", json=None)
    pair: np.ndarray = of("number of the tooth pair", "", "slice", json=None)
    z: np.ndarray = of("place along the face", "m", "slice", json=None, note=" from its middle")
    length: np.ndarray = of("length of the contact line", "m", "slice", json=None)
    corner: np.ndarray = of("whether a tip corner touches there, off the line of action", "", "slice", json=None)
    roll: np.ndarray = of("roll lengths of both gears", "m", "slice", "pinion_and_gear", json=None)
    force: np.ndarray = of("force along the flank normal", "N", "slice", json=None)
    half_width: np.ndarray = of("half-width of the contact", "m", "slice", json=None)
    pressure: np.ndarray = of("largest contact pressure", "Pa", "slice", json=None)

    @property
    def line_load(self) -> np.ndarray:
        """Force per length of contact line (n,), N/m."""
        return np.asarray(self.force / self.length)

    @derived("largest force per length of contact line", "N/m")
    def largest_line_load_n_per_m(self) -> float:
        """Of all slices."""
        return float(self.line_load.max())

    @derived("largest contact pressure", "Pa")
    def largest_pressure_pa(self) -> float:
        """Of all slices."""
        return float(self.pressure.max())

    @derived("pieces that carry load", record=LoadedPieces)
    def contact(self) -> LoadedPieces:
        """The slices under load alone."""
        carrying = self.force > 0.0
        return LoadedPieces(
            position_number=self.position[carrying],
            pair=self.pair[carrying],
            z_m=self.z[carrying],
            pinion_roll_length_m=self.roll[carrying, 0],
            gear_roll_length_m=self.roll[carrying, 1],
            line_load_n_per_m=self.line_load[carrying],
            half_width_m=self.half_width[carrying],
            pressure_pa=self.pressure[carrying],
        )


class MeshErrors(Record):
    """Estimated relative errors: mean stiffness, its peak to peak over its own size, and the same of the transmission error."""

    mean_stiffness: float = of("relative error of the mean stiffness")
    peak_to_peak_stiffness: float = of("relative error of the peak to peak of the stiffness")
    ste_peak_to_peak: float = of("relative error of the peak to peak of the transmission error")
    ste_harmonics: float | None = of(
        "largest error of the first five mesh orders of the transmission error, over the strongest one", default=None
    )
    largest_pressure: float | None = of("relative error of the largest contact pressure", default=None)

    @property
    def worst(self) -> float:
        """The largest of stiffness, its peak to peak and that of the transmission error."""
        return max(self.mean_stiffness, self.peak_to_peak_stiffness, self.ste_peak_to_peak)


class LoadPoint(Record):
    """The same mesh at another load."""

    factor: float = of("factor", note=": multiple of the load, from `--load-factors`")
    mean_stiffness_n_per_m: float = of("mean stiffness", "N/m", note=" at that load")
    peak_to_peak_stiffness_n_per_m: float = of("peak to peak of the stiffness", "N/m", note=" at that load")
    ste_peak_to_peak_m: float = of("peak to peak of the transmission error", "m", note=" at that load")
    contact_ratio: float = of("mean number of pairs that carry load")
    ste_harmonics_m: tuple[float, ...] = of(
        "amplitudes of mesh orders 1 to 3 of the transmission error", "m", "order", note=" at that load", default=()
    )
    largest_pressure_pa: float | None = of("largest contact pressure", "Pa", note=" at that load", default=None)
    position: np.ndarray | None = of("position", "mesh periods", "position", note=" at that load", default=None)
    ste_m: np.ndarray | None = of("transmission error", "m", "position", note=" under that load", default=None)


class MeshOrder(Record):
    """One order of the mesh: k(u) = mean + sum amplitude cos(2 pi order u + phase)."""

    order: int = of("order", note=" of the mesh")
    stiffness_n_per_m: float = of(
        "amplitude of the stiffness", "N/m", note=": k(u) = mean + Σ amplitude · cos(2π order u + phase)"
    )
    stiffness_phase_deg: float = of("phase of the stiffness", "deg")
    ste_m: float | None = of("amplitude of the transmission error", "m")
    ste_phase_deg: float | None = of("phase of the transmission error", "deg")


class MeshResult(Result, kind="mesh"):
    """One mesh of a model over its mesh cycle, all helices together where nothing else is said.

    What a stiffness model doesn't know is None; `helix` is empty for a model without loaded contact.
    """

    title: str = of("title of the model")
    mesh: str = of("mesh", note=": its name")
    pinion: str = of("gear that the file calls the pinion")
    gear: str = of("gear that meshes with the pinion")
    stiffness_model: str = of("stiffness model", json="model", note=', or `"given"`')
    preset: str | None = of("preset of the finite elements")
    definition: str = of("definition of the stiffness", note=': `"secant"` or `"tangent"`')
    body: str = of("what the teeth stand on", note=", in words")
    helices: int = of("number of helices")
    face_width: float = of("common face width of one helix", "m")
    base_helix_angle: float = of("base helix angle", "rad")
    stagger: float = of("lead of the second helix in mesh periods")
    load: MeshLoad | None = of("load", record=MeshLoad)
    position: np.ndarray = of(
        "position", "mesh periods", "position", note=", rising, not evenly spaced for loaded teeth"
    )
    event: np.ndarray = of("whether a tooth pair comes or goes there", "", "position", note=": the curves have a kink")
    stiffness: np.ndarray = of("stiffness", "N/m", "position", note=" over `position`")
    tangent: np.ndarray | None = of(
        "tangent stiffness", "N/m", "position", json="tangent_stiffness_n_per_m", note=" over `position`"
    )
    transmission_error: np.ndarray | None = of(
        "transmission error", "m", "position", json="ste_m", note=" under load over `position`"
    )
    no_load_error: np.ndarray | None = of("transmission error without load", "m", "position", json="no_load_te_m")
    helix: tuple[HelixContact, ...] = of("loaded contact of each helix", "", "helix", record=HelixContact)
    errors: MeshErrors | None = of("estimated errors", record=MeshErrors, json="error_estimate")
    element_errors: MeshErrors | None = of("what the finite elements have of them", record=MeshErrors)
    slice_errors: MeshErrors | None = of(
        "what the slices of the contact lines have of them", record=MeshErrors, note="; `null` for spur teeth"
    )
    sampling_errors: MeshErrors | None = of("what the choice of positions has of them", record=MeshErrors)
    dofs: int = of("degrees of freedom", note=" of both gears' elements")
    memory_bytes: float | None = of("largest memory of the process", "B", note=", or `null`")
    loads: tuple[LoadPoint, ...] = of("the same mesh at other loads", "", "load", record=LoadPoint)

    @derived("plane and direction of the stiffness", note=", in words")
    def plane(self) -> str:
        """The same for all stiffness models."""
        return PLANE

    @derived("mean stiffness", "N/m")
    def mean_stiffness(self) -> float:
        """Mean of the transverse stiffness (N/m)."""
        return float(self._curve(self.stiffness).mean()[0])

    @derived("mean stiffness along the flank normal", "N/m")
    def mean_normal_stiffness(self) -> float:
        """Mean stiffness along the flank normal (N/m): what a model file takes as a number."""
        return self.mean_stiffness / float(np.cos(self.base_helix_angle)) ** 2

    @derived("peak to peak of the stiffness", "N/m")
    def peak_to_peak_stiffness(self) -> float:
        """Largest less smallest transverse stiffness (N/m)."""
        return float(np.ptp(self.stiffness))

    @derived("mean tangent stiffness", "N/m")
    def mean_tangent_stiffness(self) -> float | None:
        """Mean of the transverse tangent stiffness (N/m)."""
        return None if self.tangent is None else float(self._curve(self.tangent).mean_of_steps()[0])

    @derived("peak to peak of the transmission error", "m", note=" under load")
    def ste_peak_to_peak(self) -> float | None:
        """Largest less smallest transmission error under load (m)."""
        return None if self.transmission_error is None else float(np.ptp(self.transmission_error))

    @derived("mean transmission error", "m", json="mean_ste_m", note=" under load")
    def mean_transmission_error(self) -> float | None:
        """Mean of the transmission error under load (m)."""
        if self.transmission_error is None:
            return None
        return float(self._curve(self.transmission_error).mean()[0])

    def at(self, position: Any) -> tuple[np.ndarray, np.ndarray | None]:
        """Stiffness (n,) in N/m and transmission error (n,) in m at any positions (n,) in mesh periods, by the curves' cubics."""
        u = np.atleast_1d(np.asarray(position, float))
        e = self.transmission_error
        return self._curve(self.stiffness).at(u)[:, 0], None if e is None else self._curve(e).at(u)[:, 0]

    @property
    def periods(self) -> int:
        """Mesh periods that the positions span."""
        return int(self.position[-1]) + 1

    def _curve(self, values: np.ndarray) -> CycleCurve:
        return CycleCurve(self.position, values[:, None], float(self.periods), self.event)

    def _harmonics(self, values: np.ndarray, count: int) -> np.ndarray:
        # More orders than half of the positions are not in them.
        most = (len(self.position) // self.periods - 1) // 2
        return np.asarray(self._curve(values).harmonics(min(count, most))[:, 0])

    def harmonics(self, count: int = 8) -> np.ndarray:
        """Complex c_h (count,) in N/m: k(u) = mean + sum_h Re(c_h e^{2 pi i h u}), over whole mesh periods."""
        return self._harmonics(self.stiffness, count)

    def ste_harmonics(self, count: int = 8) -> np.ndarray | None:
        """The same of the transmission error under load, in m."""
        return None if self.transmission_error is None else self._harmonics(self.transmission_error, count)

    def orders(self, count: int = _ORDERS) -> tuple[MeshOrder, ...]:
        """The first orders of stiffness and transmission error by amplitude and phase."""
        k = self.harmonics(count)
        e = self.ste_harmonics(count)
        return tuple(
            MeshOrder(
                order=h + 1,
                stiffness_n_per_m=float(abs(k[h])),
                stiffness_phase_deg=float(np.degrees(np.angle(k[h]))),
                ste_m=None if e is None else float(abs(e[h])),
                ste_phase_deg=None if e is None else float(np.degrees(np.angle(e[h]))),
            )
            for h in range(len(k))
        )

    @derived("orders of the mesh", "", "order", record=MeshOrder, json="harmonics")
    def first_orders(self) -> tuple[MeshOrder, ...]:
        """The orders that are written."""
        return self.orders()

    def to_dict(self, harmonics: int = _ORDERS) -> dict[str, Any]:
        """Plain values for JSON with so many orders; the keys are on docs/commands.md."""
        return {**super().to_dict(), "harmonics": plain(self.orders(harmonics))}

    def tables(self, *, harmonics: int = 0) -> Iterator[Block]:
        """Stiffness, transmission error, loads and, where asked for, so many orders of the mesh."""
        yield Line(self.title or "Mesh", f": mesh '{self.mesh}', {self.pinion} and {self.gear}")
        preset = "" if self.preset is None else f", preset {self.preset}"
        yield f"stiffness model {self.stiffness_model}{preset}: {self.definition}, {PLANE}"
        yield f"body: {self.body}"
        if self.load is None:
            yield "no load"
        else:
            yield (
                f"load: {self.load.pinion_torque_n_m:.6g} N m on the pinion, F_bt {self.load.base_force_n:.6g} N, "
                f"F_n {self.load.normal_force_n:.6g} N ({self.load.source})"
            )
        helices = f"all {self.helices} helices" if self.helices > 1 else "one helix"
        heads = ("", helices, "per width of a helix", "est. error")
        yield from ("", grid(self._cycle(), *heads, caption="The mesh cycle", no_wrap=True))
        if harmonics:
            yield from ("", self._orders(harmonics))
        if self.loads:
            rows = [
                (
                    f"{point.factor:g}",
                    f"{point.mean_stiffness_n_per_m:.5g} N/m",
                    f"{point.peak_to_peak_stiffness_n_per_m:.4g} N/m",
                    f"{1e6 * point.ste_peak_to_peak_m:.4f} um",
                    f"{point.contact_ratio:.3f}",
                )
                for point in self.loads
            ]
            columns = ("load factor", "mean stiffness", "peak to peak", "STE peak to peak", "contact ratio")
            yield from ("", grid(rows, *columns, caption="Loads", no_wrap=True))
        yield from ("", *self.remarks())
        if self.dofs:
            # Teeth in the plane take nothing worth a word.
            told = self.memory_bytes is not None and any(np.ptp(helix.z) > 0.0 for helix in self.helix)
            memory = f", {1e-9 * (self.memory_bytes or 0.0):.1f} GB" if told else ""
            yield f"{self.dofs} dofs, {self.cost}{memory}"

    def _cycle(self) -> Iterator[tuple[str, str, str, str]]:
        """Rows of what the mesh does over its cycle: name, value, the same per width of a helix, estimated error."""
        per = 1e-9 / (self.face_width * self.helices) if self.face_width else None
        errors = self.errors

        def percent(error: float | None) -> str:
            return "-" if error is None else f"{100 * error:.2g} %"

        def stiffness(name: str, value: float, error: float | None = None) -> tuple[str, str, str, str]:
            width = f"{per * value:.4f} N/(mm um)" if per else "-"
            return (name, f"{value:.5g} N/m", width, percent(error))

        yield stiffness("mean stiffness", self.mean_stiffness, errors.mean_stiffness if errors else None)
        yield stiffness("peak to peak", self.peak_to_peak_stiffness, errors.peak_to_peak_stiffness if errors else None)
        if self.tangent is not None:
            yield stiffness("mean tangent stiffness", float(self.mean_tangent_stiffness or 0.0))
        yield stiffness("mean along the normal", self.mean_normal_stiffness)
        if self.transmission_error is not None and self.no_load_error is not None:
            varies = 1e6 * np.ptp(self.transmission_error)
            yield ("transmission error, mean", f"{1e6 * (self.mean_transmission_error or 0.0):.4f} um", "", "")
            yield ("peak to peak", f"{varies:.4f} um", "", percent(errors.ste_peak_to_peak if errors else None))
            yield ("peak to peak, no load", f"{1e6 * np.ptp(self.no_load_error):.4f} um", "", "")
        if self.helix:
            ratio = np.mean([item.contact_ratio for item in self.helix])
            share = max(float(values.max()) for item in self.helix for values in item.share.values())
            pressure = 1e-6 * max(item.pressure.max() for item in self.helix)
            geometric = f"{self.helix[0].geometric_contact_ratio:.3f} geometric"
            yield ("contact ratio under load", f"{ratio:.3f}", geometric, "")
            yield ("largest share of a pair", f"{100 * share:.1f} %", "", "")
            yield ("largest line load", f"{1e-3 * max(item.line_load.max() for item in self.helix):.4g} N/mm", "", "")
            yield ("largest pressure", f"{pressure:.4g} MPa", "", percent(errors.largest_pressure if errors else None))

    def _orders(self, count: int) -> Table:
        rows = []
        for one in self.orders(count):
            # Below this share of the mean an order is rounding.
            small = one.stiffness_n_per_m < 1e-9 * self.mean_stiffness
            cells = [str(one.order), "0 N/m" if small else f"{one.stiffness_n_per_m:.4g} N/m"]
            cells.append("-" if small else f"{one.stiffness_phase_deg:.1f} deg")
            if one.ste_m is not None:
                cells += [f"{1e6 * one.ste_m:.4f} um", "-" if small else f"{one.ste_phase_deg:.1f} deg"]
            rows.append(cells + [""] * (5 - len(cells)))
        heads = ("mesh order", "stiffness", "phase", "transmission error", "phase")
        return grid(rows, *heads, caption="Orders of the mesh", no_wrap=True)
