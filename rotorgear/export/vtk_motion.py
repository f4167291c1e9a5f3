"""The motion of a transient's last instants for ParaView: one file an instant, in a collection that plays them in time."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.export.files import filling, publish
from rotorgear.export.paraview import collection
from rotorgear.export.polydata import add_texts, import_pyvista, save_mesh, solids_mesh
from rotorgear.export.solids import build_solids
from rotorgear.export.vtk import check_amplitude
from rotorgear.progress import Progress, silent
from rotorgear.results.transient import TransientResult


def write_motion(
    result: TransientResult, directory: str | Path, *, amplitude: float | None = None, progress: Progress = silent
) -> list[Path]:
    """Write the kept motion as VTK files and return their paths: `motion.pvd` plays `motion/instant_NNNN.vtp`.

    Displacements are those about the mean of the window, drawn with one scale, which stands in the field data. Point data:
    `displacement` (scaled) and `displacement_m` (true, in m).

    Args:
        result: a transient with `frames`.
        directory: folder to write to; made if need be.
        amplitude: largest displacement shown, as a share of the size of the model; for None 0.05, or less where bodies turn far.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: no motion was kept, or an amplitude that is not positive.
        MissingExtraError: pyvista is not installed.
        WriteError: the folder can't be written.
    """
    check_amplitude(amplitude)
    if not result.motion_time.size:
        raise AnalysisError("this transient kept no motion to animate: run it with frames (--vtk)")
    pv = import_pyvista("VTK output")
    solids = build_solids(result.model, result.nodes)
    plain = solids_mesh(pv, solids)
    about = result.motion - result.motion.mean(axis=2, keepdims=True)
    # One scale for all instants: that of the largest.
    sizes = np.abs([solids.displacement(about[:, :, i]) for i in range(about.shape[2])]).max(axis=(1, 2))
    scale = solids.scaled(about[:, :, int(np.argmax(sizes))], amplitude)[1]
    steps = []
    with filling(directory) as scratch:
        (scratch / "motion").mkdir()
        for i, time in enumerate(result.motion_time):
            progress(i / result.motion_time.size, f"instant {i + 1}")
            raw = solids.displacement(about[:, :, i])
            mesh = plain.copy(deep=False)
            mesh.SetPoints(pv.vtk_points((solids.points + scale * raw).astype(np.float32)))
            mesh.point_data["displacement"] = (scale * raw).astype(np.float32)
            mesh.point_data["displacement_m"] = raw.astype(np.float32)
            mesh.field_data["displacement_scale"] = np.array([scale])
            mesh.field_data["time_s"] = np.array([time])
            add_texts(mesh, "title", [result.model.title])
            file = f"motion/instant_{i + 1:04d}.vtp"
            save_mesh(mesh, scratch / file)
            steps.append((float(time), file))
        (scratch / "motion.pvd").write_text(collection(steps), encoding="utf-8")
        written = publish(scratch, Path(directory), [*(file for _, file in steps), "motion.pvd"])
    progress(1.0, "done")
    return written
