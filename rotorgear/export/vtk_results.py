"""Deflections, branches of a Campbell diagram and the motion of a transient for ParaView, on the solids of the model."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.export.paraview import save_shape, undeformed, write_collection
from rotorgear.export.turning import Motion, turning_of
from rotorgear.export.vtk import check_amplitude, write_period
from rotorgear.files.write import filling, publish
from rotorgear.progress import Progress, silent
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.campbell import CampbellResult
from rotorgear.results.response import ResponseResult
from rotorgear.results.static import StaticResult
from rotorgear.results.transient import TransientResult

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
    pv, solids, plain = undeformed(result)
    with filling(directory) as scratch:
        if isinstance(result, StaticResult):
            scaled, scale = solids.scaled(result.displacement, amplitude)
            names = ["static.vtp"]
            shapes = {"displacement": scaled, "displacement_m": scaled / scale}
            save_shape(plain, scratch / names[0], shapes, {"displacement_scale": scale})
        else:
            names = []
            turning = turning_of(result.model, result.nodes, solids, result.shape_speed)
            for o, order in enumerate(result.orders):
                progress(o / len(result.orders), order)
                scaled, scale = solids.scaled(result.shapes[:, :, o], amplitude)
                name = f"order_{o + 1:02d}"
                facts = {
                    "displacement_scale": scale,
                    "speed_rpm": result.shape_speed * RPM_PER_RAD_S,
                    "frequency_hz": result.ratio[o] * abs(result.shape_speed) / (2.0 * np.pi),
                    "order": order,
                }
                shapes = {"displacement*": scaled, "displacement*_m": scaled / scale}
                save_shape(plain, scratch / f"{name}.vtp", shapes, facts)
                # The collection, which refers to the others, comes last.
                motion = Motion(solids, result.shapes[:, :, o], scaled, scale, turning)
                names += [f"{name}.vtp", *write_period(pv, motion, plain, FRAMES, scratch, name)]
        written = publish(scratch, Path(directory), names)
    progress(1.0, "done")
    return written


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
    _, solids, plain = undeformed(result)
    with filling(directory) as scratch:
        steps = []
        for k, shape in smooth_shapes(result, branch):
            progress(k / len(result.speeds), f"speed {k + 1}")
            scaled, scale = solids.scaled(shape, amplitude)
            facts = {
                "displacement_scale": scale,
                "speed_rpm": result.speed_rpm[k],
                "frequency_hz": result.frequency_hz[k, branch],
                "log_decrement": result.log_decrement[k, branch],
            }
            steps.append((float(result.speeds[k] * RPM_PER_RAD_S), f"branch_{branch + 1:02d}_{k:03d}.vtp"))
            save_shape(plain, scratch / steps[-1][1], {"displacement*": scaled}, facts)
        collection = f"branch_{branch + 1:02d}.pvd"
        write_collection(scratch / collection, steps)
        written = publish(scratch, Path(directory), [*(file for _, file in steps), collection])
    progress(1.0, "done")
    return written


def smooth_shapes(result: CampbellResult, branch: int) -> Sequence[tuple[int, np.ndarray]]:
    """(number of the speed, shape (p, 6)) of a branch where it oscillates, each in phase with the one before."""
    shapes: list[tuple[int, np.ndarray]] = []
    for k in np.flatnonzero(np.isfinite(result.eigenvalues[:, branch])):
        shape = result.basis @ result.coordinates[k, :, branch]
        # The phase of an eigenvector is free: the first shape has its largest component real, each other follows the one before.
        turn = np.vdot(shape, shapes[-1][1]) if shapes else np.conj(shape.flat[np.argmax(np.abs(shape))])
        shapes.append((int(k), shape * (turn / abs(turn) if turn else 1.0)))
    return shapes


def write_motion(
    result: TransientResult, directory: str | Path, *, amplitude: float | None = None, progress: Progress = silent
) -> list[Path]:
    """Write the kept motion as VTK files and return their paths: `motion.pvd` plays `motion/instant_NNNN.vtp`.

    Displacements are those about the mean of the window, drawn with one scale, which stands in the field data. Point data:
    `displacement` (scaled) and `displacement_m` (true, in m). Where carriers turn, everything stands where it is at that time.

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
    pv, solids, plain = undeformed(result)
    about = result.motion - result.motion.mean(axis=2, keepdims=True)
    turning = turning_of(result.model, result.nodes, solids, float(np.abs(result.speed).max()))
    angles = np.interp(result.motion_time, result.time, result.angle)
    # One scale for all instants: that of the largest.
    sizes = np.abs([solids.displacement(about[:, :, i]) for i in range(about.shape[2])]).max(axis=(1, 2))
    scale = solids.scaled(about[:, :, int(np.argmax(sizes))], amplitude)[1]
    steps = []
    with filling(directory) as scratch:
        (scratch / "motion").mkdir()
        for i, time in enumerate(result.motion_time):
            progress(i / result.motion_time.size, f"instant {i + 1}")
            now, shape = solids, about[:, :, i]
            if turning is not None:
                now, shape = turning.at_angle(shape, float(angles[i]))
            raw = now.displacement(shape)
            moved = plain.copy(deep=False)
            moved.SetPoints(pv.vtk_points((now.points + scale * raw).astype(np.float32)))
            steps.append((float(time), f"motion/instant_{i + 1:04d}.vtp"))
            shapes = {"displacement": scale * raw, "displacement_m": raw}
            save_shape(moved, scratch / steps[-1][1], shapes, {"displacement_scale": scale, "time_s": time})
        write_collection(scratch / "motion.pvd", steps)
        written = publish(scratch, Path(directory), [*(file for _, file in steps), "motion.pvd"])
    progress(1.0, "done")
    return written
