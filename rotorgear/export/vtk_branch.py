"""A branch of a Campbell diagram for ParaView: its shape at every speed on the solids, and a series over speed."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.export.files import filling, publish
from rotorgear.export.paraview import collection
from rotorgear.export.polydata import add_texts, import_pyvista, save_mesh, solids_mesh
from rotorgear.export.solids import build_solids
from rotorgear.export.vtk import check_amplitude
from rotorgear.progress import Progress, silent
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.campbell import CampbellResult


def write_branch(
    result: CampbellResult,
    directory: str | Path,
    branch: int,
    *,
    amplitude: float | None = None,
    progress: Progress = silent,
) -> list[Path]:
    """Write `branch_NN_KKK.vtp` for every speed and `branch_NN.pvd`, whose time is the speed in rpm; return the paths.

    Each file holds the undeformed solids with `displacement_real` and `displacement_imag`, scaled by `displacement_scale`, in the
    phase that goes on smoothly from the speed before, and frequency, log decrement and speed in the field data.

    Args:
        result: branches over speed.
        directory: folder to write to; made if need be.
        branch: which, counted from 0.
        amplitude: largest displacement shown, as a share of the size of the model.
        progress: is told fraction and step.

    Raises:
        AnalysisError: a branch that the result does not have, an amplitude that is not positive.
        MissingExtraError: pyvista is not installed.
        WriteError: the folder can't be written.
    """
    if not 0 <= branch < len(result):
        raise AnalysisError(f"there is no branch {branch + 1}: the result has {len(result)}")
    check_amplitude(amplitude)
    pv = import_pyvista("VTK output")
    solids = build_solids(result.model, result.nodes)
    plain = solids_mesh(pv, solids)
    names = []
    add_texts(plain, "part_names", solids.part_names)
    with filling(directory) as scratch:
        steps = []
        shapes = smooth_shapes(result, branch)
        for k, shape in shapes:
            progress(k / len(result.speeds), f"speed {k + 1}")
            scaled, scale = solids.scaled(shape, amplitude)
            mesh = plain.copy(deep=False)
            mesh.point_data["displacement_real"] = scaled.real.astype(np.float32)
            mesh.point_data["displacement_imag"] = scaled.imag.astype(np.float32)
            mesh.field_data["displacement_scale"] = np.array([scale])
            mesh.field_data["speed_rpm"] = result.speed_rpm[[k]]
            mesh.field_data["frequency_hz"] = result.frequency_hz[[k], branch]
            mesh.field_data["log_decrement"] = result.log_decrement[[k], branch]
            names.append(f"branch_{branch + 1:02d}_{k:03d}.vtp")
            save_mesh(mesh, scratch / names[-1])
            steps.append((float(result.speeds[k] * RPM_PER_RAD_S), names[-1]))
        names.append(f"branch_{branch + 1:02d}.pvd")
        (scratch / names[-1]).write_text(collection(steps), encoding="utf-8")
        written = publish(scratch, Path(directory), names)
    progress(1.0, "done")
    return written


def smooth_shapes(result: CampbellResult, branch: int) -> Sequence[tuple[int, np.ndarray]]:
    """(number of the speed, shape (p, 6)) of a branch where it oscillates, each in phase with the one before."""
    shapes: list[tuple[int, np.ndarray]] = []
    for k in np.flatnonzero(np.isfinite(result.eigenvalues[:, branch])):
        shape = result.basis @ result.coordinates[k, :, branch]
        # The phase of an eigenvector is free: the first shape has its largest component real, each other follows the one before.
        if shapes:
            turn = np.vdot(shape, shapes[-1][1])
        else:
            turn = np.conj(shape[np.unravel_index(np.argmax(np.abs(shape)), shape.shape)])
        shapes.append((int(k), shape * (turn / abs(turn) if turn else 1.0)))
    return shapes
