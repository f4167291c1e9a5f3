"""What rendered pictures and windows share: meshes of the solids, light and colours, the camera, and whether VTK can render.

Rendering without a window is tried in a process of its own first: where graphics are broken, VTK does not raise, it crashes.
"""

from __future__ import annotations

import math
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from types import ModuleType
from typing import Any

import numpy as np

from rotorgear.errors import RotorgearError
from rotorgear.export.paraview import solids_mesh
from rotorgear.export.solids import KINDS, LIGHT, Solids, build_solids
from rotorgear.model.model import Model
from rotorgear.results.modal import ModalResult, NodeTable

# From what stands still to what moves most: light enough at both ends to show light and shade.
_STOPS = ((0.0, "c3ccd6"), (0.2, "5f9bd8"), (0.42, "3fc4a4"), (0.64, "f4d53f"), (0.84, "f0862b"), (1.0, "c4201f"))
INK, GREY, PAPER = "#202428", "#aab2ba", "white"
_SLATE, _PLAIN = "#6f7a86", "#b9c4cf"
_STYLE = {"smooth_shading": True, "ambient": 0.28, "specular": 0.2, "specular_power": 25.0}
# Lights by the camera: a key light over its left shoulder, a weak one from the right, one from the front.
_LIGHTS = (((-0.4, 0.8, 1.0), 0.70), ((1.0, 0.2, 0.6), 0.25), ((0.0, 0.0, 1.0), 0.35))
# A casing lets its shafts be seen.
_GLASS = 0.4
# Edges sharper than this stay sharp.
_EDGE_DEGREES = 25.0
# Kinds that move; the others hold them and are shown in grey.
_MOVING = ("shaft", "gear", "disk", "point mass", "coupling")


def colour_map() -> list[str]:
    """Colours of the displacement from 0 to 1."""
    places, colours = zip(*_STOPS, strict=True)
    rgb = np.array([[int(colour[k : k + 2], 16) for k in (0, 2, 4)] for colour in colours])
    table = np.column_stack([np.interp(np.linspace(0.0, 1.0, 256), places, rgb[:, k]) for k in range(3)])
    return [f"#{r:02x}{g:02x}{b:02x}" for r, g, b in np.rint(table).astype(int)]


@dataclass
class Layer:
    """Some of the solids as a mesh: its points in the order of the mesh, and which points of the solids they are."""

    mesh: Any
    numbers: np.ndarray
    rest: np.ndarray

    def move(self, displacement: np.ndarray, shade: bool = True) -> None:
        """Show the points displaced by displacements (P, 3) of all points of the solids; without `shade` the normals stay."""
        self.mesh.points = (self.rest + displacement[self.numbers]).astype(np.float32)
        if shade:
            self.mesh.compute_normals(
                cell_normals=False,
                split_vertices=False,
                consistent_normals=False,
                non_manifold_traversal=False,
                inplace=True,
            )


class Scene:
    """Surfaces of a model, ready to be drawn: what moves, the stripes along the shafts, and what holds them.

    Args:
        pv: pyvista.
        solids: the surfaces.
        result: the modes to show; None for the model alone.
    """

    def __init__(self, pv: ModuleType, solids: Solids, result: ModalResult | None = None) -> None:
        self.solids = solids
        self.result = result
        self.moving = _layer(pv, solids, _MOVING)
        self.stripes = _layer(pv, solids, ("stripe",))
        self.holding = _layer(pv, solids, ("bearing", "support"))
        self.casing = _layer(pv, solids, ("casing",))
        for layer in self.coloured:
            layer.mesh.point_data["amplitude"] = np.zeros(layer.mesh.n_points)

    @property
    def layers(self) -> list[Layer]:
        """The layers that are not empty."""
        return [layer for layer in (self.moving, self.stripes, self.holding, self.casing) if layer.mesh.n_points]

    @property
    def coloured(self) -> list[Layer]:
        """The layers whose colour says how far they move."""
        return [layer for layer in (self.moving, self.casing) if layer.mesh.n_points]

    def shape(self, mode: int, amplitude: float | None) -> np.ndarray:
        """Scaled complex displacements (P, 3) of all points in a mode; what moves is coloured by their relative size."""
        assert self.result is not None
        scaled, _ = self.solids.scaled(self.result.shapes[:, :, mode], amplitude)
        size = np.sqrt(np.sum(np.abs(scaled) ** 2, axis=1))
        for layer in self.coloured:
            layer.mesh.point_data["amplitude"] = (size / (np.max(size) or 1.0))[layer.numbers]
        return scaled

    def add_to(self, pv: ModuleType, plotter: Any) -> None:
        """Put everything on a plotter, with light and axes, and a colour bar if there are modes."""
        plotter.set_background(PAPER)
        for position, intensity in _LIGHTS:
            plotter.add_light(pv.Light(position=position, light_type="camera light", intensity=intensity))
        if self.moving.mesh.n_points:
            moving = self._colours(plotter.window_size[1] / 1000.0) if self.result else {"color": _PLAIN}
            plotter.add_mesh(self.moving.mesh, **moving, **_STYLE)
        for layer, colour in ((self.stripes, INK), (self.holding, _SLATE)):
            if layer.mesh.n_points:
                plotter.add_mesh(layer.mesh, color=colour, **_STYLE)
        if self.casing.mesh.n_points:
            shown: dict[str, Any] = {"color": _PLAIN}
            if self.result:
                shown = {**self._colours(1.0), "show_scalar_bar": not self.moving.mesh.n_points}
            plotter.add_mesh(self.casing.mesh, opacity=_GLASS, **shown, **_STYLE)
        width, height = plotter.window_size
        plotter.add_axes(color=INK, line_width=2, viewport=(0.0, 0.0, 0.12, 0.12 * width / height))

    def _colours(self, unit: float) -> dict[str, Any]:
        bar = {
            "title": "displacement, relative",
            "color": INK,
            "fmt": "%.1f",
            "n_labels": 2,
            "width": 0.18,
            "height": 0.075,
            "position_x": 0.79,
            "position_y": 0.03,
            "title_font_size": round(20 * unit),
            "label_font_size": round(18 * unit),
        }
        return {"scalars": "amplitude", "cmap": colour_map(), "clim": (0.0, 1.0), "scalar_bar_args": bar}


def _layer(pv: ModuleType, solids: Solids, kinds: tuple[str, ...]) -> Layer:
    """The cells of some kinds, with their points doubled along sharp edges."""
    chosen = np.isin(solids.kind, [KINDS.index(kind) for kind in kinds])
    quads, triangles = np.split(chosen, [len(solids.quads)])
    cells = (solids.quads[quads], solids.triangles[triangles])
    numbers, compact = np.unique(np.concatenate([block.ravel() for block in cells]), return_inverse=True)
    if not len(numbers):
        return Layer(pv.PolyData(), numbers, np.zeros((0, 3)))
    blocks = np.split(compact, [cells[0].size])
    faces = [np.insert(block.reshape(-1, k), 0, k, axis=1).ravel() for block, k in zip(blocks, (4, 3), strict=True)]
    mesh = pv.PolyData(solids.points[numbers].astype(np.float32), faces=np.concatenate(faces))
    mesh.point_data["number"] = numbers
    mesh = mesh.compute_normals(
        cell_normals=False, split_vertices=True, feature_angle=_EDGE_DEGREES, consistent_normals=False
    )
    numbers = np.asarray(mesh.point_data["number"], int)
    return Layer(mesh, numbers, solids.points[numbers])


def headline(result: ModalResult, mode: int) -> str:
    """Two lines about a mode: number, frequency, damping; what moves."""
    if result.rigid[mode]:
        first = f"Mode {mode + 1}:  rigid body, 0 Hz"
    else:
        first = f"Mode {mode + 1}:  {result.frequency_hz[mode]:.1f} Hz"
        if result.speed is not None:
            first += f",  damping {100.0 * result.damping_ratio[mode]:.2f} %"
    whirl = f"  ({result.whirl[mode]} whirl)" if result.whirl[mode] in ("forward", "backward") else ""
    return f"{first}\n{result.description[mode]}{whirl}"


def add_headline(plotter: Any, scene: Scene, mode: int) -> None:
    """Write the lines about a mode, and below them the model's title, into the upper left corner."""
    assert scene.result is not None
    unit = plotter.window_size[1] / 1000.0
    lines = headline(scene.result, mode)
    for text, height, points, colour, name in (
        (lines, 0.92, 14, INK, "mode"),
        (scene.result.model.title, 0.885, 11, "#606870", "title"),
    ):
        size = max(round(points * unit), 6)
        plotter.add_text(
            text, position=(0.025, height), viewport=True, font_size=size, color=colour, name=name, render=False
        )


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


# VTK takes its kind of render window from here (VTK 9.4 and later).
_VARIABLE = "VTK_DEFAULT_OPENGL_WINDOW"
# Without a display: a graphics driver by itself, or software rendering; else what VTK finds.
_WITHOUT_DISPLAY = ("vtkEGLRenderWindow", "vtkOSOpenGLRenderWindow", "")
_TIMEOUT = 60.0

# Draws a dark ball on white and ends well only if the picture holds both.
_TRIAL = """
import vtkmodules.vtkRenderingOpenGL2
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter
source, mapper, actor, renderer = vtkSphereSource(), vtkPolyDataMapper(), vtkActor(), vtkRenderer()
mapper.SetInputConnection(source.GetOutputPort())
actor.SetMapper(mapper)
actor.GetProperty().SetColor(0, 0, 0)
renderer.AddActor(actor)
renderer.SetBackground(1, 1, 1)
window = vtkRenderWindow()
window.SetOffScreenRendering(1)
window.SetSize(32, 32)
window.AddRenderer(renderer)
window.Render()
grab = vtkWindowToImageFilter()
grab.SetInput(window)
grab.Update()
low, high = grab.GetOutput().GetScalarRange()
raise SystemExit(0 if low < 50 and high > 200 else 3)
"""


class RenderError(RotorgearError):
    """Pictures can't be rendered here; the text says what to install, and what works without."""


@contextmanager
def rendering() -> Iterator[None]:
    """Let VTK render off screen with what works on this machine.

    Raises:
        RenderError: nothing does.
    """
    kind = working_window(os.environ.get("DISPLAY", ""), os.environ.get(_VARIABLE, ""))
    before = os.environ.get(_VARIABLE)
    if kind:
        os.environ[_VARIABLE] = kind
    try:
        yield
    finally:
        if before is None:
            os.environ.pop(_VARIABLE, None)
        else:
            os.environ[_VARIABLE] = before


@lru_cache(maxsize=4)
def working_window(display: str, wanted: str) -> str:
    """Name of the VTK window class with which a small picture came out; "" for VTK's own choice.

    Args:
        display: the display of the X server, "" for none.
        wanted: window class that the user has set, "" for none.

    Raises:
        RenderError: none does.
    """
    headless = sys.platform.startswith("linux") and not display
    kinds = (wanted,) if wanted else _WITHOUT_DISPLAY if headless else ("", *_WITHOUT_DISPLAY[:2])
    failures = []
    for kind in kinds:
        failure = can_render(kind)
        if not failure:
            return kind
        failures.append(f"{kind or 'default'}: {failure}")
    raise RenderError(
        f"pictures can't be rendered on this machine ({'; '.join(failures)}): install Mesa's EGL (Debian, Ubuntu: "
        "apt install libegl1 libgl1-mesa-dri), or write VTK files and look at them in ParaView elsewhere"
    )


def can_render(kind: str) -> str:
    """Render a small picture with a window class in a new process; return what went wrong, or ""."""
    environment = {**os.environ, _VARIABLE: kind} if kind else dict(os.environ)
    try:
        run = subprocess.run(
            [sys.executable, "-c", _TRIAL], env=environment, capture_output=True, timeout=_TIMEOUT, check=False
        )
    except subprocess.TimeoutExpired:
        return f"no answer in {_TIMEOUT:.0f} s"
    except OSError as error:
        return str(error)
    if run.returncode == 0:
        return ""
    return "a crash" if run.returncode < 0 else "no picture" if run.returncode == 3 else "an error"
