"""Result of an optimisation of flanks: the best modifications, what they do at each operating point, and their tolerance band."""

from __future__ import annotations

import numpy as np

from rotorgear.results.result import Result
from rotorgear.results.schema import Record, derived, of


class FlankVariable(Record):
    """One number that was looked for."""

    name: str = of("name", note=": of both gears, or GEAR.NAME")
    low_m: float = of("lower bound", "m")
    high_m: float = of("upper bound", "m")
    best_m: float = of("best value", "m")
    tolerance_m: float = of("tolerance", "m", note=": up and down, for the band")


class MeshOptimum(Result, kind="mesh_optimum"):
    """Flanks with the smallest weighted peak to peak of the transmission error over t torques and m misalignments.

    The band holds 90 % of flanks whose modifications lie evenly within their tolerances: it runs from the 5 % to the 95 %
    quantile, at each operating point and of the weighted mean. It is None where no band was asked for.
    """

    title: str = of("title of the model")
    mesh: str = of("mesh", note=": its name")
    pinion: str = of("gear that the file calls the pinion")
    gear: str = of("gear that meshes with the pinion")
    preset: str = of("preset of the finite elements")
    positions: int = of("positions in the mesh period")
    variables: tuple[FlankVariable, ...] = of("what was looked for", "", "variable", record=FlankVariable)
    pinion_torque: np.ndarray = of("torque on the pinion about +z", "N m", "torque", json="pinion_torque_n_m")
    misalignment: np.ndarray = of(
        "misalignment over the face",
        "m",
        "misalignment",
        json="misalignment_m",
        note=", positive where the flanks stand apart at larger z",
    )
    weight: np.ndarray = of("share of an operating point in the mean", "", "torque", "misalignment")
    pressure_limit: float | None = of("largest contact pressure that is allowed", "Pa", json="pressure_limit_pa")
    mean_before: float = of("weighted mean of the peak to peak with the flanks of the model", "m", json="mean_before_m")
    mean: float = of("weighted mean of the peak to peak", "m", json="mean_m", note=" with the best flanks")
    mean_band: tuple[float, float] | None = of("its tolerance band", "m", "low_and_high", json="mean_band_m")
    before: np.ndarray = of(
        "peak to peak of the transmission error with the flanks of the model",
        "m",
        "torque",
        "misalignment",
        json="ste_before_m",
    )
    ste: np.ndarray = of(
        "peak to peak of the transmission error with the best flanks",
        "m",
        "torque",
        "misalignment",
        json="ste_peak_to_peak_m",
    )
    ste_low: np.ndarray | None = of("lower end of its tolerance band", "m", "torque", "misalignment", json="ste_low_m")
    ste_high: np.ndarray | None = of(
        "upper end of its tolerance band", "m", "torque", "misalignment", json="ste_high_m"
    )
    largest_pressure: np.ndarray = of(
        "largest contact pressure", "Pa", "torque", "misalignment", json="largest_pressure_pa"
    )
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
