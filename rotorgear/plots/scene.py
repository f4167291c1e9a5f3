"""What pictures and windows share: smooth meshes of the solids, their motion, light and colours."""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np

from rotorgear.export.solids import KINDS, Solids
from rotorgear.results.modal import ModalResult

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
