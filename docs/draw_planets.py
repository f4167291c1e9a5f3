"""Draws docs/pictures/planets.png: python docs/draw_planets.py

A mode of models/planetary.toml at four moments, from the frames that rotorgear modal --vtk writes.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
import pyvista as pv

import rotorgear as rg
from rotorgear.export.solids import KINDS
from rotorgear.plots.scene import INK, PAPER, colour_map, rendering

ROOT = Path(__file__).resolve().parents[1]
INPUTS = ("models/planetary.toml",)  # for docs/machinery/made.py
# Counted from 1 as in tables; frames of a period that are drawn, and which shafts.
MODE = 13
FRAMES = 16
DRAWN = (0, 3, 6, 9)
SHOWN = ("sun", "planet", "ring")
PIXELS = 520
SUPERSAMPLING = 2


def main() -> None:
    """Write the picture."""
    model = rg.load(ROOT / "models" / "planetary.toml")
    modes = rg.modal(model, speed="1800 rpm", modes=MODE)
    side = SUPERSAMPLING * PIXELS
    with tempfile.TemporaryDirectory() as folder, rendering():
        rg.write_vtk(modes, folder, modes=[MODE - 1], frames=FRAMES, amplitude=0.025)
        plotter = pv.Plotter(
            off_screen=True, shape=(1, len(DRAWN)), border=False, window_size=[len(DRAWN) * side, side]
        )
        for column, number in enumerate(DRAWN):
            mesh = pv.read(Path(folder) / f"mode_{MODE:02d}" / f"phase_{number:03d}.vtp")
            names = list(model.shafts)
            shown = [k for k, name in enumerate(names) if name.split("#")[0] in SHOWN]
            kinds = [KINDS.index(name) for name in ("gear", "shaft")]
            drawn = np.isin(mesh.cell_data["shaft_id"], shown) & np.isin(mesh.cell_data["kind_id"], kinds)
            mesh = mesh.extract_cells(drawn).extract_surface(algorithm="dataset_surface")
            mesh.point_data["size"] = np.linalg.norm(mesh.point_data["displacement"], axis=1)
            plotter.subplot(0, column)
            plotter.set_background(PAPER)
            plotter.add_mesh(
                mesh, scalars="size", clim=(0.0, 0.008), cmap=colour_map(), show_scalar_bar=False, ambient=0.3
            )
            first = mesh.extract_cells(mesh.cell_data["shaft_id"] == names.index("planet#1"))
            plotter.add_point_labels(
                [first.center],
                ["1"],
                font_size=16 * SUPERSAMPLING,
                text_color=INK,
                shape=None,
                always_visible=True,
                show_points=False,
            )
            plotter.add_text(f"{360.0 * number / FRAMES:.1f}°", font_size=10 * SUPERSAMPLING, color=INK)
            plotter.enable_parallel_projection()
            plotter.camera_position = [(0.0, 0.0, 1.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)]
            plotter.camera.parallel_scale = 0.135
        picture = plotter.screenshot(None, return_img=True)[..., :3].astype(float)
        plotter.close()
    rows, columns = (size // SUPERSAMPLING for size in picture.shape[:2])
    blocks = picture.reshape(rows, SUPERSAMPLING, columns, SUPERSAMPLING, 3)
    from PIL import Image  # comes with pyvista

    image = Image.fromarray(blocks.mean(axis=(1, 3)).astype(np.uint8)).quantize(256)
    image.save(ROOT / "docs" / "pictures" / "planets.png", optimize=True)


if __name__ == "__main__":
    main()
