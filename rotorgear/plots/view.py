"""An interactive window: the gearbox, and its modes in motion."""

from __future__ import annotations

import math
import os
import sys
from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.export.paraview import import_pyvista
from rotorgear.export.solids import DEFAULT_AMPLITUDE, LIGHT, build_solids
from rotorgear.model.model import Model
from rotorgear.plots.scene import INK, RenderError, Scene, add_headline, best_direction, can_render, look
from rotorgear.results.modal import ModalResult, NodeTable, body_name

_MILLISECONDS = 40
_FRAMES = 50
_HELP = "left, right: mode    space: stop, go    q: close"


def view(shown: ModalResult | Model, mode: int | None = None) -> None:
    """Open a window and return when it is closed.

    Keys: left and right change the mode, space stops and starts the motion, q closes. A slider sets the amplitude.

    Args:
        shown: a result, or a model to be seen at rest.
        mode: mode to begin with, counted from 0 (default: the first).

    Raises:
        AnalysisError: a mode that the result does not have.
        MissingExtraError: pyvista is not installed.
        RenderError: there is no display.
    """
    result = None if isinstance(shown, Model) else shown
    if result is not None and not 0 <= (mode or 0) < len(result):
        raise AnalysisError(f"there is no mode {(mode or 0) + 1}: the result has {len(result)}")
    pv = import_pyvista("The window")
    if sys.platform.startswith("linux"):
        # A broken display would crash this process, so another one tries it.
        remedy = "; use modal --plot for PNGs, or modal --vtk and ParaView on another machine"
        if not os.environ.get("DISPLAY"):
            raise RenderError(f"a window needs a display, and there is none here (DISPLAY is not set){remedy}")
        failure = can_render("vtkXOpenGLRenderWindow")
        if failure:
            raise RenderError(f"no window can open on the display {os.environ['DISPLAY']} ({failure}){remedy}")
    model, nodes = (shown, _nodes(shown)) if isinstance(shown, Model) else (shown.model, shown.nodes)
    plotter = pv.Plotter(title=f"rotorgear: {model.title}", window_size=[1400, 900], lighting="none")
    scene = Scene(pv, build_solids(model, nodes, LIGHT), result)
    scene.add_to(pv, plotter)
    look(plotter, scene.solids.points, best_direction(pv, model, nodes))
    if result is not None:
        Player(plotter, scene, mode or 0).listen()
    plotter.show()


class Player:
    """Shows a mode in motion: which, how large, at which phase, and whether it runs."""

    def __init__(self, plotter: Any, scene: Scene, mode: int) -> None:
        assert scene.result is not None
        self.plotter = plotter
        self.scene = scene
        self.count = len(scene.result)
        self.amplitude = DEFAULT_AMPLITUDE
        self.frame = 0
        self.running = True
        self.choose(mode)

    def choose(self, mode: int) -> None:
        """Show another mode; beyond the last comes the first."""
        self.mode = mode % self.count
        self.scaled = self.scene.shape(self.mode, None)
        add_headline(self.plotter, self.scene, self.mode)
        self.draw()

    def resize(self, amplitude: float) -> None:
        """Change the largest displacement, a share of the size of the model."""
        self.amplitude = amplitude
        self.draw()

    def step(self, _: Any = None) -> None:
        """Show the next frame, if the motion runs."""
        if self.running:
            self.frame = (self.frame + 1) % _FRAMES
            self.draw()

    def toggle(self) -> None:
        """Stop or start the motion."""
        self.running = not self.running

    def draw(self) -> None:
        """Show the shape at the present phase."""
        turn = np.exp(2j * math.pi * self.frame / _FRAMES)
        displacement = (self.scaled * turn).real * (self.amplitude / DEFAULT_AMPLITUDE)
        for layer in self.scene.layers:
            layer.move(displacement, shade=False)
        self.plotter.render()

    def listen(self) -> None:
        """Bind keys, slider and clock."""
        plotter = self.plotter
        plotter.add_key_event("Right", lambda: self.choose(self.mode + 1))
        plotter.add_key_event("Left", lambda: self.choose(self.mode - 1))
        plotter.add_key_event("space", self.toggle)
        plotter.add_slider_widget(
            self.resize,
            rng=[0.0, 0.2],
            value=self.amplitude,
            title="amplitude / size",
            color=INK,
            pointa=(0.77, 0.93),
            pointb=(0.97, 0.93),
            fmt="%.2f",
            style="modern",
        )
        plotter.add_text(_HELP, position=(0.35, 0.02), viewport=True, font_size=9, color=INK, name="help")
        plotter.add_timer_event(max_steps=2**31 - 1, duration=_MILLISECONDS, callback=self.step)


def _nodes(model: Model) -> NodeTable:
    """As many nodes as it takes to show a model at rest: ends of shafts, pedestals, surfaces of casings and gear bodies."""
    rows = [(name, z, "") for name, shaft in model.shafts.items() for z in dict.fromkeys((shaft.start, shaft.end))]
    for name, bearing in model.bearings.items():
        if bearing.pedestal is not None:
            rows.append((*model.layout.place(f"bearings.{name}"), name))
    shafts, z, pedestals = zip(*rows, strict=True)
    position = np.column_stack([np.zeros((len(rows), 2)), z])
    surfaces = {name: surface for name in model.casings if (surface := model.layout.casing(name).surface) is not None}
    points = {name: surface.points for name, surface in surfaces.items()}
    for gear, wheel in model.layout.elastic_bodies.items():
        if wheel.surface is not None:
            place = model.layout.gear(gear).places[0]
            frame = model.shafts[place.shaft].frame
            points[body_name(gear)] = wheel.surface.points @ frame.axes.T + frame.at(place.z)
    casings = [name for name, those in points.items() for _ in those]
    nothing = ("",) * len(casings)
    return NodeTable(
        (*shafts, *nothing),
        np.vstack([position, *points.values()]),
        (*pedestals, *nothing),
        (*(("",) * len(rows) if casings else ()), *casings),
    )
