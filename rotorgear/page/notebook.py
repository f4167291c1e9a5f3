"""What `result.show()` puts below a cell of a notebook: the turntable for modes, else the picture, which answers the mouse.

It is a page of its own in a frame that may run its script and reach nothing else. So it needs no package of Jupyter, works
in every notebook that shows HTML, and stays in pages that are made of notebooks.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from rotorgear.drawing import picture_of
from rotorgear.files.own import text_of
from rotorgear.results.modal import ModalResult
from rotorgear.results.result import Result

_FOLDER = Path(__file__).parent
# Modes below a cell, and letters of all their shapes together: a notebook may be larger than a report.
_MODES = 24
_LARGEST = 6_000_000
# Points of a picture that answer: more of them are as near to each other as dots of a screen.
_MOST = 20_000
_EDGE = 1e-6
_TURNTABLE = 500
_WIDTH = 900
_STYLE = """
body { margin: 0; font: 14px system-ui, sans-serif; background: #fff; color: #1b1f24; }
p { margin: .3rem; }
canvas { width: 100%; height: 440px; display: block; touch-action: none; }
.box { position: relative; }
.box > svg, .box > img { width: 100%; height: auto; display: block; }
.said { position: absolute; transform: translateY(-130%); background: #1b1f24; color: #fff; padding: .15rem .4rem;
  border-radius: 3px; white-space: pre; pointer-events: none; font-size: 12px; }
.dot { position: absolute; width: 9px; height: 9px; margin: -5px; border: 1.5px solid #1b1f24; border-radius: 50%;
  pointer-events: none; }
[hidden] { display: none; }
"""


class Shown:
    """A page in a frame, which notebooks show; elsewhere its text is that of the result.

    Attributes:
        page: the whole page, as HTML.
    """

    def __init__(self, page: str, height: int, text: str) -> None:
        self.page = page
        self._height = height
        self._text = text

    def __repr__(self) -> str:
        return self._text

    def _repr_html_(self) -> str:
        return (
            f'<iframe sandbox="allow-scripts" title="rotorgear" style="width:100%;height:{self._height}px;border:0" '
            f'srcdoc="{escape(self.page)}"></iframe>'
        )


def shown(result: Result) -> Shown:
    """A result as a page that moves or answers the mouse.

    Raises:
        AnalysisError: a kind of result without a picture. MissingExtraError: matplotlib is not installed.
    """
    body, height = (_turntable(result), _TURNTABLE) if isinstance(result, ModalResult) else _picture(result)
    page = f'<!doctype html><meta charset="utf-8"><title>rotorgear</title><style>{_STYLE}</style>\n{body}'
    return Shown(page, height, repr(result))


def _turntable(result: ModalResult) -> str:
    """Solids that turn and move in the modes of the result."""
    from rotorgear.page.turntable import scene

    script = text_of(_FOLDER / "turntable.js") + text_of(_FOLDER / "turntable_in_report.js")
    data = f'<script type="application/json" id="turntable-scene">{scene(result, _MODES, _LARGEST)}</script>'
    return f"{text_of(_FOLDER / 'turntable.html')}{data}<script>{script}</script>"


def _picture(result: Result) -> tuple[str, int]:
    """The picture of a kind of result with what its points say, and its height in dots of the screen."""
    from rotorgear.page.figures import svg_of

    axes = picture_of(result.kind)(result)
    picture = svg_of(axes, result.kind)
    figure = np.asarray(axes, dtype=object).flat[0].figure.figure
    width, height = figure.get_size_inches()
    points = json.dumps(_points(figure)).replace("<", "\\u003c")
    script = f"{text_of(_FOLDER / 'hover.js')}hover(document.querySelector('.box'), {points});"
    return f'<div class="box" style="max-width:{_WIDTH}px">{picture}</div><script>{script}</script>', round(
        _WIDTH * height / width
    ) + 10


def _curves(axes: Any) -> Iterator[tuple[str, np.ndarray]]:
    """Name and points (n, 2) of each curve; a line across all of the axes is none, since one end of it is in their shares."""
    from matplotlib.collections import LineCollection

    for line in axes.get_lines():
        if line.get_transform() == axes.transData and len(line.get_xdata()) > 1:
            yield str(line.get_label()), np.column_stack([np.asarray(one, float) for one in line.get_data(orig=False)])
    for lines in axes.collections:
        if isinstance(lines, LineCollection) and lines.get_transform() == axes.transData:
            yield from ((str(lines.get_label()), np.asarray(one, float)) for one in lines.get_segments())


def _points(figure: Any) -> list[tuple[float, float, str]]:
    """Points of all curves of a figure that is laid out: where they are, in shares of its width and height, and their words."""
    found = []
    for axes in figure.axes:
        x_name = axes.get_xlabel() or "x"
        y_name = axes.get_ylabel() or "y"
        within = axes.get_position()
        for name, curve in _curves(axes):
            head = "" if name.startswith("_") else f"{name}\n"
            places = figure.transFigure.inverted().transform(axes.transData.transform(curve))
            for (u, v), (one, other) in zip(places, curve, strict=True):
                if within.x0 - _EDGE <= u <= within.x1 + _EDGE and within.y0 - _EDGE <= v <= within.y1 + _EDGE:
                    words = f"{head}{x_name}: {one:.6g}\n{y_name}: {other:.6g}"
                    found.append((round(float(u), 4), round(1.0 - float(v), 4), words))
    return found[:: -(-len(found) // _MOST) or 1]
