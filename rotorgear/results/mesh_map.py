"""Result of a mesh over torque and misalignment: transmission error, pressure and load along the face."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rotorgear.results.result import Result
from rotorgear.results.schema import of
from rotorgear.results.table import Block, Line, grid


class OverLoads(Result):
    """One mesh at t torques and m misalignments; arrays are (t, m)."""

    title: str = of("title of the model")
    mesh: str = of("mesh", note=": its name")
    pinion: str = of("gear that the file calls the pinion")
    gear: str = of("gear that meshes with the pinion")
    preset: str = of("preset of the finite elements")
    positions: int = of("positions in the mesh period")
    pinion_torque: np.ndarray = of("torque on the pinion about +z", "N m", "torque")
    misalignment: np.ndarray = of(
        "misalignment over the face", "m", "misalignment", note=", positive where the flanks stand apart at larger z"
    )
    largest_pressure: np.ndarray = of("largest contact pressure", "Pa", "torque", "misalignment")

    def _head(self) -> Block:
        return Line(self.title or "Mesh", f": mesh '{self.mesh}', {self.pinion} and {self.gear}")

    def _points(self) -> Iterator[tuple[tuple[int, int], tuple[str, str]]]:
        """Numbers of torque and misalignment, and the words of both, of each point."""
        for i, torque in enumerate(self.pinion_torque):
            for j, misalignment in enumerate(self.misalignment):
                yield (i, j), (f"{torque:.5g}", f"{1e6 * misalignment:.4g}")


class MeshMap(OverLoads, kind="mesh_map"):
    """One mesh at t torques and m misalignments; arrays are (t, m)."""

    body: str = of("what the teeth stand on", note=", in words")
    helices: int = of("number of helices")
    ste_peak_to_peak: np.ndarray = of("peak to peak of the transmission error", "m", "torque", "misalignment")
    ste_harmonics: np.ndarray = of(
        "amplitudes of mesh orders 1 to 3 of the transmission error", "m", "torque", "misalignment", "order"
    )
    face_load_factor: np.ndarray = of(
        "face load factor", "", "torque", "misalignment", note=" K_Hbeta, mean of the mesh cycle"
    )
    mean_stiffness: np.ndarray = of("mean stiffness", "N/m", "torque", "misalignment", note=", transverse")
    dofs: int = of("degrees of freedom", note=" of both gears' elements")

    def tables(self) -> Iterator[Block]:
        """A row for each torque and misalignment."""
        yield from (self._head(), f"preset {self.preset}, {self.positions} positions", f"body: {self.body}", "")
        rows: list[tuple[str, ...]] = [("N m", "um", "um", "um", "um", "um", "MPa", "", "N/m")]
        for at, words in self._points():
            errors = (self.ste_peak_to_peak[at], *self.ste_harmonics[at])
            rows.append(
                (
                    *words,
                    *(f"{1e6 * value:.3f}" for value in errors),
                    f"{1e-6 * self.largest_pressure[at]:.4g}",
                    f"{self.face_load_factor[at]:.3f}",
                    f"{self.mean_stiffness[at]:.4g}",
                )
            )
        heads = ("torque", "misalignment", "STE pp", "order 1", "2", "3", "p_max", "K_Hbeta", "k mean")
        yield from (grid(rows, *heads, caption="Over torque and misalignment", no_wrap=True), "")
        yield from self.remarks()
        yield f"{self.dofs} dofs, {self.cost}"
