"""Mode shapes for ParaView (VTK XML files): solids of every mode, its motion over a period, and the beam model.

The motion is Re(u e^{+i phase}) = real cos(phase) - imag sin(phase). Displacements of surface points are scaled so that they are
seen; the factor stands in the field data. Reference: XML File Formats, https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.export.attachment import in_space, nodes_in_order
from rotorgear.export.paraview import add_texts, save_mesh, save_shape, undeformed, write_collection
from rotorgear.export.solids import Solids
from rotorgear.export.turning import Motion, turning_of
from rotorgear.files.write import filling, publish
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
    with displaced points and their `displacement`; where carriers turn, these have planets at their places. `beam.vtp` holds all
    nodes with all six dofs of all modes; `model.vtp` the undeformed solids; `index.pvd` all modes, one a time step; `README.txt`
    says so. Other files in the folder are left alone.

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
    pv, solids, plain = undeformed(result)
    # Modes that are told as a carrier sees them are shown so: the pins stand still.
    seen_from_rest = bool(result.carrier_frequency_hz)
    turning = turning_of(result.model, result.nodes, solids, result.speed if seen_from_rest else None)
    target = Path(directory)
    with filling(target) as scratch:
        save_mesh(plain, scratch / "model.vtp")
        save_mesh(beam_mesh(pv, result, solids), scratch / "beam.vtp")
        names = ["model.vtp", "beam.vtp"]
        for count, mode in enumerate(chosen):
            progress(count / len(chosen), f"mode {mode + 1}")
            scaled, scale = solids.scaled(result.shapes[:, :, mode], amplitude)
            name = f"mode_{mode + 1:02d}"
            facts = {
                "mode": np.int32(mode + 1),
                "displacement_scale": scale,
                "frequency_hz": result.frequency_hz[mode],
                "natural_frequency_hz": result.natural_frequency_hz[mode],
                "damping_ratio": result.damping_ratio[mode],
                "description": result.description[mode],
            }
            shapes = {"displacement*": scaled, "mass_normalised*": scaled / scale}
            save_shape(plain, scratch / f"{name}.vtp", shapes, facts)
            motion = Motion(solids, result.shapes[:, :, mode], scaled, scale, turning)
            names += [f"{name}.vtp", *write_period(pv, motion, plain, frames, scratch, name)]
        index = [(mode + 1, f"mode_{mode + 1:02d}.vtp") for mode in chosen]
        write_collection(scratch / "index.pvd", index)
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
    chosen = dict.fromkeys(range(len(result)) if modes is None else map(int, modes))
    for mode in chosen:
        if not 0 <= mode < len(result):
            raise AnalysisError(f"there is no mode {mode + 1}: the result has {len(result)}")
    return list(chosen)


def check_amplitude(amplitude: float | None) -> None:
    """AnalysisError unless positive and finite, or None."""
    if amplitude is not None and not 0.0 < amplitude < math.inf:
        raise AnalysisError(f"the amplitude is a positive share of the model's size, such as 0.05, got {amplitude:g}")


def write_period(pv: ModuleType, motion: Motion, plain: Any, frames: int, scratch: Path, name: str) -> list[str]:
    """Write frames of a motion to `name/`, and `name.pvd`, which plays them; return their names, that one last.

    They go over a period, and over more where its picture comes again later. Where all points move in phase, the second half of
    the period shows the files of the first one backwards. The time is the phase in degrees.
    """
    (scratch / name).mkdir()
    size = motion.solids.size
    count = frames * motion.periods
    steps = []
    for frame in range(count + 1):
        number = frame % count
        number = min(number, count - number) if motion.is_in_phase else number
        file = f"{name}/phase_{number:03d}.vtp"
        if not (scratch / file).exists():
            points, displacement = motion.at(number / frames)
            mesh = plain.copy(deep=False)  # the same cells, but points of its own
            mesh.clear_field_data()
            mesh.SetPoints(pv.vtk_points(_rounded(points + displacement, _POINT_GRID * size)))
            mesh.point_data["displacement"] = _rounded(displacement, _COLOUR_GRID * size)
            save_mesh(mesh, scratch / file)
        steps.append((360.0 * frame / frames, file))
    write_collection(scratch / f"{name}.pvd", steps)
    return [*dict.fromkeys(file for _, file in steps), f"{name}.pvd"]


def _rounded(values: np.ndarray, step: float) -> np.ndarray:
    """Multiples of the power of two next to a step, so that the last bits are 0, in single precision."""
    grid = 2.0 ** round(math.log2(step))
    return (np.round(values / grid) * grid).astype(np.float32)


def beam_mesh(pv: ModuleType, result: ModalResult, solids: Solids) -> Any:
    """Return a pyvista.PolyData of the nodes, joined by a line along each shaft; nodes of pedestals are single points.

    Point data: `shaft_id`, `pedestal` (0 or 1), `outer_diameter` (m), and for each mode NN `mode_NN_translation_real`,
    `mode_NN_translation_imag` (m), `mode_NN_rotation_real` and `mode_NN_rotation_imag` (rad), mass-normalised.
    """
    nodes = result.nodes
    model = result.model
    lines = [nodes_in_order(nodes, name) for name in model.shafts]
    cells = [[len(line), *line] for line in lines if len(line) > 1]
    single = [*(line[0] for line in lines if len(line) == 1), *np.flatnonzero(nodes.pedestal)]
    # Points of casings come last, and are no nodes of a beam.
    count = sum(bool(shaft) for shaft in nodes.shaft)
    mesh = pv.PolyData()
    mesh.points = np.asarray(solids.node_positions[:count], float)
    if cells:
        mesh.lines = np.concatenate(cells)
    if single:
        mesh.verts = np.column_stack([np.ones(len(single), int), single]).ravel()
    names = list(model.shafts)
    mesh.point_data["shaft_id"] = np.array([names.index(shaft) for shaft in nodes.shaft[:count]], dtype=np.int16)
    mesh.point_data["pedestal"] = np.array(nodes.pedestal[:count], dtype=bool).astype(np.uint8)
    mesh.point_data["outer_diameter"] = np.array(
        [model.shafts[s].diameter_at(z) for s, z in zip(nodes.shaft[:count], nodes.along[:count], strict=True)]
    )
    for mode in range(len(result)):
        for what, dofs in (("translation", slice(0, 3)), ("rotation", slice(3, 6))):
            values = in_space(model, nodes, result.shapes[:, :, mode])[:count, dofs]
            for part in ("real", "imag"):
                name = f"mode_{mode + 1:02d}_{what}_{part}"
                mesh.point_data[name] = np.ascontiguousarray(getattr(values, part), float)
    add_texts(mesh, "shaft_names", names)
    mesh.field_data["frequency_hz"] = result.frequency_hz
    mesh.field_data["damping_ratio"] = result.damping_ratio
    add_texts(mesh, "description", result.description)
    return mesh


def readme(result: ModalResult, modes: Sequence[int], frames: int) -> str:
    """Text of README.txt: what the files are, and what to do in ParaView."""
    speed = "undamped, at standstill"
    if result.speed is not None:
        speed = f"damped and gyroscopic, reference shaft at {result.speed:.6g} rad/s"
    rows = [
        f"  mode_{mode + 1:02d}  {result.frequency_hz[mode]:10.3f} Hz  {100.0 * result.damping_ratio[mode]:7.3f} %  "
        f"{result.description[mode]}"
        for mode in modes
    ]
    turns = _CARRIERS if result.carrier_frequency_hz else ""
    title = result.model.title or "Mode shapes"
    return _README.format(title=title, speed=speed, frames=frames, rows="\n".join(rows), turns=turns)


_CARRIERS = """
CARRIERS
  From frame to frame go several periods: in a period that is shown, the pins of the carrier whose planets move most go on to the
  next place, and all shafts with them by their ratios. Motions that stay with each planet are shown over a turn of the carrier.
"""


_README = """{title}: mode shapes ({speed})

  mode      frequency      damping    what moves
{rows}

FILES
  mode_NN.pvd   the motion of a mode, {frames} frames a period; the time is the phase in degrees
  mode_NN.vtp   the undeformed gearbox with a mode's displacement, real and imaginary
  index.pvd     all mode_NN.vtp, one after the other; the time is the number of the mode
  beam.vtp      the beam model: nodes, sizes, all six degrees of freedom of all modes
  model.vtp     the undeformed gearbox
{turns}
IN PARAVIEW
  See a mode move: open mode_NN.pvd, Apply, colour by displacement, Play. (Animation View: mode Sequence, a loop.)
  See a mode as a still: open mode_NN.vtp, Apply, filter Warp By Vector with displacement_real.
  Any phase p: filter Calculator with  displacement_real*cos(p) - displacement_imag*sin(p),  then Warp By Vector.
  Tell the parts apart: colour by part_id, kind_id or shaft_id; the names stand in the field data (Information, Spreadsheet View).
  Smooth shafts: filter Generate Surface Normals.

UNITS
  Positions in m. displacement_real and displacement_imag are scaled so that they are seen, by displacement_scale in the field
  data; mass_normalised_real and mass_normalised_imag are the shape itself, scaled to a modal mass of 1.
"""
