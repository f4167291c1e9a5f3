"""Deflections under load for ParaView: the static one, and the operating shape of every order, at rest and in motion."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from rotorgear.export.files import filling, publish
from rotorgear.export.paraview import collection
from rotorgear.export.polydata import add_texts, import_pyvista, save_mesh, solids_mesh
from rotorgear.export.solids import Solids, build_solids
from rotorgear.export.vtk import Motion, check_amplitude, write_frames
from rotorgear.progress import Progress, silent
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.response import ResponseResult
from rotorgear.results.static import StaticResult

FRAMES = 16


def write_deflections(
    result: StaticResult | ResponseResult,
    directory: str | Path,
    *,
    amplitude: float | None = None,
    progress: Progress = silent,
) -> list[Path]:
    """Write deflections as VTK files and return their paths.

    A static result becomes `static.vtp`: the undeformed solids with the point data `displacement` (scaled so that it is seen)
    and `displacement_m` (true, in m). A response becomes, for every order NN, `order_NN.vtp` with `displacement_real`,
    `displacement_imag` (scaled), `displacement_real_m` and `displacement_imag_m`, and `order_NN.pvd`, which plays a period.
    The scale, and for a response the speed, frequency and name of the order, stand in the field data.

    Args:
        result: a static result, or a response with its shapes at `shape_speed`.
        directory: folder to write to; made if need be. Other files in it are left alone.
        amplitude: largest displacement shown, as a share of the size of the model; for None 0.05, or less where bodies turn far.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: an amplitude that is not positive.
        MissingExtraError: pyvista is not installed.
        WriteError: the folder can't be written.
    """
    check_amplitude(amplitude)
    pv = import_pyvista("VTK output")
    solids = build_solids(result.model, result.nodes)
    plain = solids_mesh(pv, solids)
    for name, texts in (("part_names", solids.part_names), ("kind_names", solids.kind_names)):
        add_texts(plain, name, texts)
    add_texts(plain, "title", [result.model.title])
    with filling(directory) as scratch:
        if isinstance(result, StaticResult):
            scaled, scale = solids.scaled(result.displacement, amplitude)
            mesh = plain.copy(deep=False)
            mesh.point_data["displacement"] = scaled.astype(np.float32)
            mesh.point_data["displacement_m"] = (scaled / scale).astype(np.float32)
            mesh.field_data["displacement_scale"] = np.array([scale])
            save_mesh(mesh, scratch / "static.vtp")
            names = ["static.vtp"]
        else:
            names = list(_write_orders(pv, result, solids, plain, amplitude, scratch, progress))
        written = publish(scratch, Path(directory), names)
    progress(1.0, "done")
    return written


def _write_orders(
    pv: ModuleType,
    result: ResponseResult,
    solids: Solids,
    plain: Any,
    amplitude: float | None,
    scratch: Path,
    progress: Progress,
) -> Iterator[str]:
    """Write every order and yield the names of its files, what refers to others last."""
    rpm = result.shape_speed * RPM_PER_RAD_S
    for o, order in enumerate(result.orders):
        progress(o / len(result.orders), order)
        motion = Motion(*solids.scaled(result.shapes[:, :, o], amplitude))
        name = f"order_{o + 1:02d}"
        mesh = plain.copy(deep=False)
        for end, values in (("", motion.scaled), ("_m", motion.scaled / motion.scale)):
            mesh.point_data[f"displacement_real{end}"] = values.real.astype(np.float32)
            mesh.point_data[f"displacement_imag{end}"] = values.imag.astype(np.float32)
        mesh.field_data["displacement_scale"] = np.array([motion.scale])
        mesh.field_data["speed_rpm"] = np.array([rpm])
        mesh.field_data["frequency_hz"] = np.array([result.ratio[o] * abs(result.shape_speed) / (2.0 * np.pi)])
        add_texts(mesh, "order", [order])
        save_mesh(mesh, scratch / f"{name}.vtp")
        (scratch / name).mkdir()
        steps = write_frames(pv, solids, plain, motion, FRAMES, scratch, name)
        (scratch / f"{name}.pvd").write_text(collection(steps), encoding="utf-8")
        yield from dict.fromkeys(file for _, file in steps)
        yield f"{name}.vtp"
        yield f"{name}.pvd"
