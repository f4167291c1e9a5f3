"""Rendering without a window, tried in a process of its own first: where graphics are broken, VTK does not raise, it crashes."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache

from rotorgear.errors import RotorgearError

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
