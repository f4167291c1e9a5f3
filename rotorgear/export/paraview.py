"""What ParaView needs beside the meshes: collections of files over time (.pvd), and a page that says how to look at them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from xml.sax.saxutils import quoteattr

from rotorgear.results.modal import ModalResult


def collection(steps: Iterable[tuple[float, str]]) -> str:
    """Text of a .pvd file that shows one file at each time."""
    rows = [f'    <DataSet timestep="{time:.9g}" part="0" file={quoteattr(file)}/>' for time, file in steps]
    head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">\n  <Collection>'
    return "\n".join([head, *rows, "  </Collection>\n</VTKFile>\n"])


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
    return _README.format(title=result.model.title or "Mode shapes", speed=speed, frames=frames, rows="\n".join(rows))


_README = """{title}: mode shapes ({speed})

  mode      frequency      damping    what moves
{rows}

FILES
  mode_NN.pvd   the motion of a mode over a period, {frames} frames; the time is the phase in degrees
  mode_NN.vtp   the undeformed gearbox with a mode's displacement, real and imaginary
  index.pvd     all mode_NN.vtp, one after the other; the time is the number of the mode
  beam.vtp      the beam model: nodes, sizes, all six degrees of freedom of all modes
  model.vtp     the undeformed gearbox

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
