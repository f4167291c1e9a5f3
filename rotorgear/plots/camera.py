"""Where to look from: the direction from which most of every shaft is seen, and a frame that the gearbox fills."""

from __future__ import annotations

import math
from types import ModuleType
from typing import Any

import numpy as np

from rotorgear.export.paraview import solids_mesh
from rotorgear.export.solids import LIGHT, build_solids
from rotorgear.model.model import Model
from rotorgear.results.modal import NodeTable

# Directions from the middle to the camera, y upwards; from the left (-x) the shafts run to the right.
_DIRECTIONS = (
    (-0.9, 0.45, 0.7), (-1.0, 0.4, 0.4), (-0.9, 0.45, -0.7), (-1.0, 0.4, -0.4),
    (0.9, 0.45, 0.7), (1.0, 0.4, 0.4), (0.9, 0.45, -0.7), (1.0, 0.4, -0.4),
    (-0.5, 0.4, 1.0), (-0.5, 0.4, -1.0), (0.5, 0.4, 1.0), (0.5, 0.4, -1.0),
)  # fmt: skip
_SMALL = (240, 150)
# The part of the picture to fill, from -1 to 1 each way: room for the title above and the colours below.
_LEFT = -0.92
_RIGHT = 0.92
_BOTTOM = -0.80
_TOP = 0.74


def best_direction(pv: ModuleType, model: Model, nodes: NodeTable) -> tuple[float, float, float]:
    """The direction with the largest sum over the shafts of sqrt(pixels seen): the root counts the hidden ones most."""
    mesh = solids_mesh(pv, build_solids(model, nodes, LIGHT))
    # A casing would hide what it is looked at for.
    mesh = mesh.remove_cells(np.flatnonzero(mesh.cell_data["shaft_id"] < 0)) if model.casings else mesh
    number = mesh.cell_data["shaft_id"].astype(int) + 1
    mesh.cell_data["paint"] = np.column_stack([number % 256, number // 256, np.zeros_like(number)]).astype(np.uint8)
    plotter = pv.Plotter(off_screen=True, window_size=list(_SMALL), lighting="none")
    try:
        plotter.set_background("white")
        plotter.add_mesh(mesh, scalars="paint", rgb=True, lighting=False)
        scores = []
        for direction in _DIRECTIONS:
            look(plotter, mesh.points, direction)
            picture = plotter.screenshot(None, return_img=True).astype(int)
            seen = (picture[..., 0] + 256 * picture[..., 1])[picture[..., 2] == 0]
            scores.append(np.sum(np.sqrt(np.unique(seen, return_counts=True)[1])))
    finally:
        plotter.close()
    return _DIRECTIONS[int(np.argmax(scores))]


def look(plotter: Any, points: np.ndarray, direction: tuple[float, float, float]) -> None:
    """Turn the camera to points (P, 3) from a direction, so that they fill the picture below its title."""
    middle = 0.5 * (np.min(points, axis=0) + np.max(points, axis=0))
    camera = plotter.camera
    camera.SetWindowCenter(0.0, 0.0)
    camera.view_angle = 30.0
    plotter.camera_position = [tuple(middle + np.array(direction)), tuple(middle), (0.0, 1.0, 0.0)]
    plotter.reset_camera(bounds=np.column_stack([np.min(points, axis=0), np.max(points, axis=0)]).ravel().tolist())
    low, high = _extent(plotter, points)
    zoom = min((_RIGHT - _LEFT) / (high[0] - low[0]), (_TOP - _BOTTOM) / (high[1] - low[1]))
    camera.view_angle = math.degrees(2.0 * math.atan(math.tan(math.radians(15.0)) / zoom))
    low, high = _extent(plotter, points)
    offset = 0.5 * (low + high) - 0.5 * np.array([_LEFT + _RIGHT, _BOTTOM + _TOP])
    camera.SetWindowCenter(*offset)


def _extent(plotter: Any, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Least and largest place of points in the picture, -1 to 1 each way."""
    width, height = plotter.window_size
    matrix = plotter.camera.GetCompositeProjectionTransformMatrix(width / height, -1.0, 1.0)
    projection = np.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(4)])
    seen = np.column_stack([points, np.ones(len(points))]) @ projection.T
    places = seen[:, :2] / seen[:, 3:]
    return places.min(axis=0), places.max(axis=0)
