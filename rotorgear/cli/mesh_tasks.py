"""What `rotorgear mesh` does with one mesh: its cycle, a map over loads, root stresses, better flanks, the teeth in VTK."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rotorgear.cli.common import console, progress_bar, write_json

if TYPE_CHECKING:
    from rotorgear.model.model import Model
    from rotorgear.results.mesh import MeshResult
    from rotorgear.results.mesh_map import MeshMap


@dataclass(frozen=True)
class MeshCase:
    """The mesh of a model, and what is asked of it in place of what the file says; None: that of the file, or the default."""

    model: Model
    mesh: str | None
    torque: str | None
    preset: str | None
    body: str | None
    positions: int | None

    def asked(self, positions: int) -> dict[str, Any]:
        """Arguments that every analysis of a mesh takes, with so many positions unless others are asked for."""
        return {
            "torque": self.torque,
            "preset": self.preset,
            "body": self.body,
            "positions": positions if self.positions is None else self.positions,
        }


def show_cycle(
    case: MeshCase,
    *,
    stiffness: str | None,
    accuracy: float | None,
    periods: int | None,
    load_factors: Sequence[float],
    harmonics: int,
    plot: Path | None,
    json: Path | None,
) -> MeshResult:
    """Print the mesh cycle, and return it."""
    import rotorgear as rg

    with progress_bar("mesh") as progress:
        result = rg.mesh(
            case.model,
            case.mesh,
            stiffness=stiffness,
            accuracy=accuracy,
            periods=periods,
            load_factors=load_factors,
            **case.asked(64),
            progress=progress,
        )
    console().print(result.table(harmonics=harmonics))
    write_json(result.to_dict(max(harmonics, 8)), json)
    if plot:
        console().print(f"drawn: {rg.plot.save(rg.plot.mesh(result), plot)}")
    return result


def write_teeth(case: MeshCase, result: MeshResult, folder: Path, at: float) -> None:
    """Write both tooth meshes at one position of a cycle."""
    from rotorgear.analysis.teeth.tooth_field import tooth_fields
    from rotorgear.export.tooth_vtk import write_tooth_vtk

    with progress_bar("vtk") as progress:
        fields = tooth_fields(
            case.model, result.mesh, torque=case.torque, preset=result.preset, body=case.body, at=at, progress=progress
        )
    for path in write_tooth_vtk(fields, folder):
        console().print(f"wrote {path}")


def show_map(
    case: MeshCase, over: Mapping[str, Sequence[float]], csv: Path | None, plot: Path | None, json: Path | None
) -> None:
    """Print a map over torque and misalignment."""
    import rotorgear as rg

    with progress_bar("mesh") as progress:
        points = rg.mesh_map(case.model, case.mesh, over=over, **case.asked(64), progress=progress)
    console().print(points.table())
    write_json(points.to_dict(), json)
    if csv:
        from rotorgear.export.csv_file import write_csv

        console().print(f"wrote {write_csv(map_rows(points), csv)}")
    if plot:
        console().print(f"drawn: {rg.plot.save(rg.plot.mesh_map(points), plot)}")


def show_root_stress(case: MeshCase, plot: Path | None, json: Path | None) -> None:
    """Print the stress in the tooth roots over the cycle."""
    import rotorgear as rg

    with progress_bar("root stress") as progress:
        roots = rg.root_stress(case.model, case.mesh, **case.asked(24), progress=progress)
    console().print(roots.table())
    write_json(roots.to_dict(), json)
    if plot:
        console().print(f"drawn: {rg.plot.save(rg.plot.root_stress(roots), plot)}")


def show_best_flanks(case: MeshCase, variables: Sequence[str], *, json: Path | None, **wishes: Any) -> None:
    """Print the modifications with the least transmission error; `wishes` are those of `optimise_flanks`."""
    import rotorgear as rg

    with progress_bar("optimise") as progress:
        best = rg.optimise_flanks(
            case.model, case.mesh, variables=variables, **wishes, **case.asked(64), progress=progress
        )
    console().print(best.table())
    write_json(best.to_dict(), json)


def map_rows(points: MeshMap) -> Iterator[dict[str, float]]:
    """One row a point of a map, in the order of its table."""
    for i, torque in enumerate(points.pinion_torque):
        for j, misalignment in enumerate(points.misalignment):
            orders = {f"ste_order_{n + 1}_m": float(value) for n, value in enumerate(points.ste_harmonics[i, j])}
            yield {
                "pinion_torque_n_m": float(torque),
                "misalignment_m": float(misalignment),
                "ste_peak_to_peak_m": float(points.ste_peak_to_peak[i, j]),
                **orders,
                "largest_pressure_pa": float(points.largest_pressure[i, j]),
                "face_load_factor": float(points.face_load_factor[i, j]),
                "mean_stiffness_n_per_m": float(points.mean_stiffness[i, j]),
            }
