"""A picture of each mode: the gearbox deformed, coloured by displacement, over its undeformed self."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.export.paraview import import_pyvista
from rotorgear.export.solids import FINE, build_solids
from rotorgear.export.vtk import check_amplitude, chosen_modes
from rotorgear.files.write import filling, publish
from rotorgear.plots.scene import GREY, Scene, add_headline, best_direction, look, rendering
from rotorgear.progress import Progress, silent
from rotorgear.results.modal import ModalResult

# Rendered this many times as wide and high: smoother, and much faster in software than VTK's own passes.
_SUPERSAMPLING = 2


def modal(result: ModalResult, plotter: Any = None, *, mode: int = 0, amplitude: float | None = None) -> Any:
    """Put a mode on a stage of pyvista: the gearbox deformed, coloured by displacement, over its undeformed self.

    The shape is that at phase 0, where the largest displacement is real; the colour is the amplitude relative to the largest.

    Args:
        result: modes of a model.
        plotter: pyvista plotter to fill; for None a new one without a window, for `screenshot`.
        mode: which, counted from 0.
        amplitude: largest displacement shown, as a share of the size of the model; for None 0.05, or less where bodies turn far.

    Returns:
        The plotter.

    Raises:
        AnalysisError: a mode that the result does not have, an amplitude that is not positive.
        MissingExtraError: pyvista is not installed.
        RenderError: nothing can be rendered on this machine.
    """
    (chosen,) = chosen_modes(result, [mode])
    check_amplitude(amplitude)
    pv = import_pyvista("Drawing modes")
    with rendering():
        if plotter is None:
            plotter = pv.Plotter(off_screen=True, window_size=[1600, 1000], lighting="none")
        _show(plotter, _stage(pv, plotter, result), chosen, amplitude)
    return plotter


def write_modes(
    result: ModalResult,
    directory: str | Path,
    modes: Sequence[int] | None = None,
    size: tuple[int, int] = (1600, 1000),
    *,
    amplitude: float | None = None,
    progress: Progress = silent,
) -> list[Path]:
    """Render `mode_NN.png` of each mode without a window and return the paths.

    The shape is that at phase 0, where the largest displacement is real; the colour is the amplitude relative to the largest.

    Args:
        result: modes of a model.
        directory: folder to write to; made if need be.
        modes: which, counted from 0; all for None.
        size: width and height in pixels.
        amplitude: largest displacement shown, as a share of the size of the model; for None 0.05, or less where bodies turn far.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: a mode that the result does not have, a size below 100 pixels, an amplitude that is not positive.
        MissingExtraError: pyvista is not installed.
        RenderError: nothing can be rendered on this machine.
        WriteError: the folder can't be written.
    """
    chosen = chosen_modes(result, modes)
    check_amplitude(amplitude)
    if min(size) < 100:
        raise AnalysisError(f"a picture needs at least 100 pixels each way, got {size[0]} x {size[1]}")
    pv = import_pyvista("Drawing modes")
    from PIL import Image  # comes with pyvista

    k = _SUPERSAMPLING
    names = []
    with filling(directory) as scratch, rendering():
        fine = [k * pixels for pixels in size]
        plotter = pv.Plotter(off_screen=True, window_size=fine, lighting="none")
        try:
            scene = _stage(pv, plotter, result)
            for count, mode in enumerate(chosen):
                progress(count / len(chosen), f"mode {mode + 1}")
                _show(plotter, scene, mode, amplitude)
                names.append(f"mode_{mode + 1:02d}.png")
                # Each pixel is the mean of those that were rendered for it.
                fine_picture = plotter.screenshot(None, return_img=True)[..., :3].astype(np.uint16)
                rows, columns = (pixels // k for pixels in fine_picture.shape[:2])
                blocks = fine_picture[: rows * k, : columns * k].reshape(rows, k, columns, k, 3)
                Image.fromarray((blocks.sum(axis=(1, 3)) // k**2).astype(np.uint8)).save(scratch / names[-1])
        finally:
            plotter.close()
        written = publish(scratch, Path(directory), names)
    progress(1.0, "done")
    return written


def _stage(pv: ModuleType, plotter: Any, result: ModalResult) -> Scene:
    """Put everything but the shape of a mode on a plotter."""
    scene = Scene(pv, build_solids(result.model, result.nodes, FINE), result)
    direction = best_direction(pv, result.model, result.nodes)
    scene.add_to(pv, plotter)
    if scene.moving.mesh.n_points:
        ghost = plotter.add_mesh(scene.moving.mesh.copy(), color=GREY, opacity=0.2, show_scalar_bar=False)
        # A little farther away, so that it does not shine through what has not moved.
        ghost.mapper.SetResolveCoincidentTopologyToPolygonOffset()
        ghost.mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(4.0, 4.0)
    look(plotter, scene.solids.points, direction)
    return scene


def _show(plotter: Any, scene: Scene, mode: int, amplitude: float | None) -> None:
    """Put a mode on the stage."""
    scaled = scene.shape(mode, amplitude)
    for layer in scene.layers:
        layer.move(scaled.real)
    add_headline(plotter, scene, mode)
    plotter.render()
