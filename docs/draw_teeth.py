"""Draws docs/pictures/mesh_stress.png: python docs/draw_teeth.py [FOLDER of rotorgear mesh --vtk]

The pinion of validation/cases/tooth_fe_contact/helical.toml,
deflected 200 times as much as it is, with its equivalent stress and its contact lines.
Without a folder the teeth are solved first, which takes a minute.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np
import pyvista as pv

ROOT = Path(__file__).parents[1]
PICTURE = ROOT / "docs" / "pictures" / "mesh_stress.png"
INPUTS = ("validation/cases/tooth_fe_contact/helical.toml",)  # for docs/machinery/made.py
ENLARGED = 200.0
# Equivalent stress in MPa at the end of the colours: the fillets have some 90, the ends of contact lines much more.
MOST = 120.0


def solve(folder: Path) -> None:
    """Write the fields of both gears."""
    import rotorgear as rg
    from rotorgear.analysis.teeth.inside_teeth import tooth_fields
    from rotorgear.export.vtk_parts import write_tooth_vtk

    write_tooth_vtk(tooth_fields(rg.load(ROOT / "validation" / "cases" / "tooth_fe_contact" / "helical.toml")), folder)


def draw(folder: Path) -> None:
    """Draw the pinion from a folder."""
    pinion = pv.read(folder / "pinion.vtu")
    pinion.point_data["equivalent stress, MPa"] = 1e-6 * pinion.point_data["von_mises"]
    skin = pinion.warp_by_vector("displacement", factor=ENLARGED).extract_surface(
        nonlinear_subdivision=2, algorithm="dataset_surface"
    )
    contact = pv.read(folder / "contact.vtp")
    carries = contact.extract_cells(np.flatnonzero(contact.cell_data["line_load"] > 0.0)).extract_surface(
        algorithm="dataset_surface"
    )
    # A contact line lies on the flank as it is at rest, where the nearest point of the flank tells how far that has moved.
    rest = pinion.extract_surface(algorithm="dataset_surface")
    moved = rest.point_data["displacement"][[rest.find_closest_point(point) for point in carries.points]]
    outward = carries.points * [1.0, 1.0, 0.0]
    outward /= np.linalg.norm(outward, axis=1)[:, None]
    carries.points = carries.points + ENLARGED * moved + 3e-4 * outward

    plotter = pv.Plotter(off_screen=True, window_size=[1300, 760])
    plotter.set_background("white")
    bar = {
        "title": "equivalent stress, MPa\n",
        "title_font_size": 24,
        "label_font_size": 22,
        "n_labels": 5,
        "fmt": "%.0f",
        "color": "black",
        "position_x": 0.05,
        "position_y": 0.02,
        "width": 0.42,
        "height": 0.11,
    }
    plotter.add_mesh(
        skin,
        scalars="equivalent stress, MPa",
        cmap="viridis",
        clim=[0.0, MOST],
        smooth_shading=True,
        split_sharp_edges=True,
        ambient=0.25,
        scalar_bar_args=bar,
    )
    plotter.add_mesh(carries.tube(radius=5e-4), color="red")
    middle = np.asarray(skin.center)
    plotter.camera_position = [tuple(middle + np.array([0.10, 0.12, 0.16])), tuple(middle), (0.0, 1.0, 0.0)]
    plotter.reset_camera(bounds=skin.bounds)
    plotter.camera.zoom(1.5)
    plotter.camera.SetWindowCenter(0.0, -0.12)
    plotter.screenshot(PICTURE)
    plotter.close()


def main(words: list[str]) -> None:
    """Draw, after the teeth have been solved where no folder is given."""
    if words:
        draw(Path(words[0]))
        return
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch) / "teeth"
        solve(folder)
        draw(folder)


if __name__ == "__main__":
    main(sys.argv[1:])
