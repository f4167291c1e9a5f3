"""Mode shapes for ParaView (VTK XML files): solids of every mode, its motion over a period, and the beam model.

The motion is Re(u e^{+i phase}) = real cos(phase) - imag sin(phase). Displacements of surface points are scaled so that they are
seen; the factor stands in the field data. Reference: XML File Formats, https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.export.beam import beam_mesh
from rotorgear.export.files import filling, publish
from rotorgear.export.paraview import collection, readme
from rotorgear.export.polydata import add_texts, import_pyvista, save_mesh, solids_mesh
from rotorgear.export.solids import Solids, build_solids
from rotorgear.progress import Progress, silent
from rotorgear.results.modal import ModalResult

# Points and colours of frames are rounded to these shares of the model's size: invisible, and they compress to half.
_POINT_GRID = 2.0**-16
_COLOUR_GRID = 2.0**-13


def write_vtk(
    result: ModalResult,
    directory: str | Path,
    *,
    modes: Sequence[int] | None = None,
    frames: int = 16,
    amplitude: float | None = None,
    progress: Progress = silent,
) -> list[Path]:
    """Write mode shapes as VTK files and return their paths.

    `mode_NN.vtp` holds the undeformed solids with the point data `displacement_real` and `displacement_imag` (scaled) and
    `mass_normalised_real` and `mass_normalised_imag` (m, modal mass 1); `mode_NN.pvd` plays the motion over a period, from frames
    with displaced points and their `displacement`; `beam.vtp` holds all nodes with all six dofs of all modes; `model.vtp` the
    undeformed solids; `index.pvd` all modes, one a time step; `README.txt` says so. Other files in the folder are left alone.

    Args:
        result: modes of a model.
        directory: folder to write to; made if need be.
        modes: which, counted from 0; all for None. The names of the files count from 1, as the tables do.
        frames: pictures in a period.
        amplitude: largest displacement shown, as a share of the size of the model; for None 0.05, or less where bodies turn far.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: a mode that the result does not have, fewer than 2 frames, an amplitude that is not positive.
        MissingExtraError: pyvista is not installed.
        WriteError: the folder can't be written.
    """
    chosen = chosen_modes(result, modes)
    check_amplitude(amplitude)
    if frames < 2:
        raise AnalysisError(f"an animation needs at least 2 frames, got {frames}")
    pv = import_pyvista("VTK output")
    solids = build_solids(result.model, result.nodes)
    plain = solids_mesh(pv, solids)
    add_texts(plain, "part_names", solids.part_names)
    add_texts(plain, "kind_names", solids.kind_names)
    add_texts(plain, "shaft_names", solids.shaft_names)
    add_texts(plain, "title", [result.model.title])
    target = Path(directory)
    with filling(target) as scratch:
        save_mesh(plain, scratch / "model.vtp")
        save_mesh(beam_mesh(pv, result, solids), scratch / "beam.vtp")
        names = ["model.vtp", "beam.vtp"]
        for count, mode in enumerate(chosen):
            progress(count / len(chosen), f"mode {mode + 1}")
            names += _write_mode(pv, result, solids, plain, mode, frames, amplitude, scratch)
        index = [(mode + 1, f"mode_{mode + 1:02d}.vtp") for mode in chosen]
        (scratch / "index.pvd").write_text(collection(index), encoding="utf-8")
        (scratch / "README.txt").write_text(readme(result, chosen, frames), encoding="utf-8")
        written = publish(scratch, target, [*names, "index.pvd", "README.txt"])

        # Frames that an earlier run left beside the new ones of the same modes would be played among them.
        for mode in chosen:
            for path in (target / f"mode_{mode + 1:02d}").glob("phase_*.vtp"):
                if path not in written:
                    path.unlink()
    progress(1.0, "done")
    return written


def chosen_modes(result: ModalResult, modes: Sequence[int] | None) -> list[int]:
    """Modes to write, counted from 0; AnalysisError for one that the result does not have."""
    chosen = list(range(len(result))) if modes is None else [int(mode) for mode in modes]
    for mode in chosen:
        if not 0 <= mode < len(result):
            raise AnalysisError(f"there is no mode {mode + 1}: the result has {len(result)}")
    return list(dict.fromkeys(chosen))


def check_amplitude(amplitude: float | None) -> None:
    """AnalysisError unless positive and finite, or None."""
    if amplitude is not None and not 0.0 < amplitude < math.inf:
        raise AnalysisError(
            f"the amplitude must be a positive share of the model's size, such as 0.05, got {amplitude:g}"
        )


@dataclass(frozen=True)
class Motion:
    """Scaled displacement of the surface points of a shape, (P, 3) complex, and the scale."""

    scaled: np.ndarray
    scale: float

    def at(self, phase: float) -> np.ndarray:
        """Displacement at a phase in rad."""
        return self.scaled.real * math.cos(phase) - self.scaled.imag * math.sin(phase)


def _write_mode(
    pv: ModuleType,
    result: ModalResult,
    solids: Solids,
    plain: Any,
    mode: int,
    frames: int,
    amplitude: float | None,
    scratch: Path,
) -> list[str]:
    """Write one mode to the temporary folder and return the names of its files, what refers to others last."""
    motion = Motion(*solids.scaled(result.shapes[:, :, mode], amplitude))
    name = f"mode_{mode + 1:02d}"
    mesh = plain.copy(deep=False)  # the same points and cells, but data of its own
    for label, values in (("displacement", motion.scaled), ("mass_normalised", motion.scaled / motion.scale)):
        mesh.point_data[f"{label}_real"] = values.real.astype(np.float32)
        mesh.point_data[f"{label}_imag"] = values.imag.astype(np.float32)
    mesh.field_data["mode"] = np.array([mode + 1], dtype=np.int32)
    mesh.field_data["displacement_scale"] = np.array([motion.scale])
    mesh.field_data["frequency_hz"] = result.frequency_hz[[mode]]
    mesh.field_data["natural_frequency_hz"] = result.natural_frequency_hz[[mode]]
    mesh.field_data["damping_ratio"] = result.damping_ratio[[mode]]
    add_texts(mesh, "description", [result.description[mode]])
    save_mesh(mesh, scratch / f"{name}.vtp")
    (scratch / name).mkdir()
    steps = write_frames(pv, solids, plain, motion, frames, scratch, name)
    (scratch / f"{name}.pvd").write_text(collection(steps), encoding="utf-8")
    return [*dict.fromkeys(file for _, file in steps), f"{name}.vtp", f"{name}.pvd"]


def write_frames(
    pv: ModuleType, solids: Solids, plain: Any, motion: Motion, frames: int, scratch: Path, name: str
) -> list[tuple[float, str]]:
    """Write the frames of a motion to `name/`; return (phase in degrees, name of the file) for a whole period.

    Where all points move in phase, the second half of the period shows the files of the first one backwards.
    """
    in_phase = not np.any(motion.scaled.imag)
    steps = []
    for frame in range(frames + 1):
        number = frame % frames
        number = min(number, frames - number) if in_phase else number
        file = f"{name}/phase_{number:03d}.vtp"
        if not (scratch / file).exists():
            displacement = motion.at(2.0 * math.pi * number / frames)
            mesh = plain.copy(deep=False)  # the same cells, but points of its own
            mesh.clear_field_data()
            mesh.SetPoints(pv.vtk_points(_rounded(solids.points + displacement, _POINT_GRID * solids.size)))
            mesh.point_data["displacement"] = _rounded(displacement, _COLOUR_GRID * solids.size)
            save_mesh(mesh, scratch / file)
        steps.append((360.0 * frame / frames, file))
    return steps


def _rounded(values: np.ndarray, step: float) -> np.ndarray:
    """Multiples of the power of two next to a step, so that the last bits are 0, in single precision."""
    grid = 2.0 ** round(math.log2(step))
    return (np.round(values / grid) * grid).astype(np.float32)
