"""Result of an optimisation of flanks: the best modifications, what they do at each operating point, and their tolerance band."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rotorgear.results.mesh_map import OverLoads
from rotorgear.results.schema import Record, derived, of
from rotorgear.results.table import Block, Table, grid


class FlankVariable(Record):
    """One number that was looked for."""

    name: str = of("name", note=": of both gears, or GEAR.NAME")
    low_m: float = of("lower bound", "m")
    high_m: float = of("upper bound", "m")
    best_m: float = of("best value", "m")
    tolerance_m: float = of("tolerance", "m", note=": up and down, for the band")


class MeshOptimum(OverLoads, kind="mesh_optimum"):
    """Flanks with the smallest weighted peak to peak of the transmission error over t torques and m misalignments.

    The band holds 90 % of flanks whose modifications lie evenly within their tolerances: it runs from the 5 % to the 95 %
    quantile, at each operating point and of the weighted mean. It is None where no band was asked for.
    """

    variables: tuple[FlankVariable, ...] = of("what was looked for", "", "variable", record=FlankVariable)
    weight: np.ndarray = of("share of an operating point in the mean", "", "torque", "misalignment")
    pressure_limit: float | None = of("largest contact pressure that is allowed", "Pa")
    mean_before: float = of("weighted mean of the peak to peak with the flanks of the model", "m")
    mean: float = of("weighted mean of the peak to peak", "m", note=" with the best flanks")
    mean_band: tuple[float, float] | None = of("its tolerance band", "m", "low_and_high")
    before: np.ndarray = of(
        "peak to peak of the transmission error before", "m", "torque", "misalignment", json="ste_before_m"
    )
    ste: np.ndarray = of(
        "peak to peak of the transmission error, best flanks", "m", "torque", "misalignment", json="ste_peak_to_peak_m"
    )
    ste_low: np.ndarray | None = of("lower end of its tolerance band", "m", "torque", "misalignment")
    ste_high: np.ndarray | None = of("upper end of its tolerance band", "m", "torque", "misalignment")
    evaluations: int = of("flanks that were tried", note=", without those of the band")
    samples: int = of("flanks of the tolerance band")
    changes: dict[str, str] = of("values for the model by address", "", "ADDRESS", note=": what `model.with_` takes")

    @derived("lines for the model file")
    def lines(self) -> str:
        """The best flanks in TOML, by table."""
        tables: dict[str, list[str]] = {}
        for address, text in self.changes.items():
            table, _, key = address.rpartition(".")
            tables.setdefault(table, []).append(f'{key} = "{text}"')
        return "\n\n".join("\n".join([f"[{table}]", *keys]) for table, keys in tables.items())

    def tables(self) -> Iterator[Block]:
        """The best modifications, what they do at each operating point, and their lines for the model file."""
        yield self._head()
        limit = "no limit" if self.pressure_limit is None else f"p_max up to {1e-6 * self.pressure_limit:.4g} MPa"
        yield f"preset {self.preset}, {self.positions} positions, {limit}, {self.evaluations} flanks tried"
        rows = [
            (
                variable.name,
                f"{1e6 * variable.low_m:.4g} ... {1e6 * variable.high_m:.4g}",
                f"{1e6 * variable.best_m:.2f}",
                f"+-{1e6 * variable.tolerance_m:.3g}",
            )
            for variable in self.variables
        ]
        heads = ("modification", "bounds um", "best um", "tolerance um")
        yield from ("", grid(rows, *heads, caption="Modifications", no_wrap=True), "", self._at_loads(), "")
        yield from self.remarks()
        if self.status != "success":
            yield f"Warning: {self.status}"
        yield from (f"{self.cost}", "", "for the model file:", *self.lines.splitlines())

    def _at_loads(self) -> Table:
        """What the best flanks do at each operating point, and in the mean."""

        def band(low: float | None, high: float | None) -> str:
            return "-" if low is None or high is None else f"{1e6 * low:.3f} ... {1e6 * high:.3f}"

        rows: list[tuple[str, ...]] = [("N m", "um", "", "um", "um", "um", "MPa")]
        for at, words in self._points():
            rows.append(
                (
                    *words,
                    f"{self.weight[at]:.3f}",
                    f"{1e6 * self.before[at]:.3f}",
                    f"{1e6 * self.ste[at]:.3f}",
                    band(*(None if ste is None else ste[at] for ste in (self.ste_low, self.ste_high))),
                    f"{1e-6 * self.largest_pressure[at]:.4g}",
                )
            )
        mean = band(*(self.mean_band or (None, None)))
        rows.append(("mean", "", "", f"{1e6 * self.mean_before:.3f}", f"{1e6 * self.mean:.3f}", mean, ""))
        heads = ("torque", "misalignment", "weight", "STE pp before", "best", "90 % band", "p_max")
        return grid(rows, *heads, caption="Operating points", no_wrap=True)
