"""Pictures inside the page: curves as SVG, solids painted face by face, which needs no graphics driver.

Solids are seen along an isometric direction, their faces painted from the farthest to the nearest with the light of their slope.
"""

from __future__ import annotations

import base64
import re
from html import escape
from io import BytesIO, StringIO
from typing import Any

import numpy as np

from rotorgear.export.solids import Solids
from rotorgear.page.contents import Contents, error_of
from rotorgear.page.ticks import settle
from rotorgear.page.turntable import KIND_COLOURS
from rotorgear.plots.figure import COLOURS, beside, label, legend_below, name_axes, new_figure, values
from rotorgear.results.standards import StandardsResult

# Seen from the side of +x, +y and +z: columns are the picture's right, up, and towards the eye.
_EYE = np.array([-0.85, 0.45, 0.75])
_LIGHT = np.array([0.2, 0.8, 0.55])
_SHADE = 0.42
# Letters of an SVG above which a picture is an image.
_LARGEST = 600_000
_THROUGH = 0.16  # how much of a casing is seen
_DOTS = 96  # of a picture of solids, an inch
_FINER = 4  # each of its dots is the mean of so many by so many that were painted, which makes edges smooth
# An error of zero has no place on a logarithmic axis.
_LEAST = 1e-13
_LINKS = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'


def svg_of(picture: Any, shows: str) -> str:
    """Axes, or an array of them, as SVG whose letters are text: it can be read aloud, searched, and is small."""
    import matplotlib

    one = np.asarray(picture, dtype=object).flat[0]
    figure = one.figure.figure
    out = StringIO()
    # Ids of clip paths begin with the salt, so that no two pictures of the page share one.
    with matplotlib.rc_context({"svg.fonttype": "none", "svg.hashsalt": shows, "font.family": "DejaVu Sans"}):
        settle(figure)
        figure.savefig(out, format="svg", metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
    text = out.getvalue()
    if len(text) > _LARGEST:  # very many lines as SVG would make the page heavy
        pixels = BytesIO()
        figure.savefig(pixels, format="png", dpi=150)
        return _image(pixels.getvalue(), shows)
    text = text[text.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
    text = re.sub(r"(\d+\.\d\d)\d+", r"\1", text)
    prefix = re.sub(r"\W+", "_", shows)
    text = re.sub(r'\bid="', f'id="{prefix}-', text)
    text = re.sub(r'(xlink:href="|url\()#', rf"\1#{prefix}-", text)
    head = f'role="img" aria-label="{escape(shows)}" {_LINKS}'
    return re.sub(
        r'<svg [^>]*?viewBox="([^"]+)"[^>]*>', lambda found: f'<svg viewBox="{found[1]}" {head}>', text, count=1
    )


def _image(pixels: bytes, shows: str) -> str:
    """A picture (PNG) as an image element that holds its pixels."""
    data = base64.b64encode(pixels).decode("ascii")
    return f'<img alt="{escape(shows)}" src="data:image/png;base64,{data}">'


class Painter:
    """Draws solids, at rest or displaced, into one kind of picture."""

    def __init__(self, solids: Solids, size: tuple[float, float]) -> None:
        self.solids = solids
        self.size = size
        towards = _EYE / np.linalg.norm(_EYE)
        right = np.cross([0.0, 1.0, 0.0], towards)
        right /= np.linalg.norm(right)
        self.axes = np.array([right, np.cross(towards, right), towards]).T
        self.light = self.axes.T @ (_LIGHT / np.linalg.norm(_LIGHT))
        flat = solids.points @ self.axes
        self.middle = 0.5 * (flat.min(axis=0) + flat.max(axis=0))
        self.span = np.ptp(flat, axis=0)

    def image(self, shows: str, moved: np.ndarray | None = None, level: np.ndarray | None = None) -> str:
        """An image element.

        Args:
            shows: what it shows, for those who don't see it.
            moved: displacements (P, 3); none for the gearbox at rest.
            level: (P,) from 0 to 1, shown by colour in place of the kinds of parts.
        """
        solids = self.solids
        points = (solids.points if moved is None else solids.points + moved) @ self.axes - self.middle
        # Triangles have their last corner twice.
        corners = points[np.concatenate([solids.quads, solids.triangles[:, [0, 1, 2, 2]]])]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        lengths = np.linalg.norm(normals, axis=1)
        slope = np.abs(normals @ self.light) / np.where(lengths > 0.0, lengths, 1.0)
        colour = self._colours(level) * (_SHADE + (1.0 - _SHADE) * slope)[:, None]
        casing = "casing" in solids.kind_names and solids.kind == solids.kind_names.index("casing")
        alpha = np.where(casing, _THROUGH, 1.0)
        depth = np.concatenate([points[solids.quads, 2].mean(axis=1), points[solids.triangles, 2].mean(axis=1)])
        order = np.argsort(depth)
        # Faces that look away are hidden by those before them, but in casings, through which one sees.
        order = order[(normals[order, 2] > 0.0) | (alpha[order] < 1.0)]
        colours = np.column_stack([colour, np.broadcast_to(alpha, len(colour))])[order]
        wide, high = (round(_DOTS * inches) for inches in self.size)
        reach = 0.56 * max(self.span[0], self.span[1] * self.size[0] / self.size[1])
        dots = (0.5 * wide / reach) * np.array([1.0, -1.0]) * corners[order, :, :2] + 0.5 * np.array([wide, high])
        return _image(painted(dots, colours, (wide, high)), shows)

    def _colours(self, level: np.ndarray | None) -> np.ndarray:
        """Colours (C, 3) of the faces: those of the kinds of parts, or of a level at each point."""
        from matplotlib import colormaps
        from matplotlib.colors import to_rgb

        solids = self.solids
        if level is None:
            return np.array([to_rgb(KIND_COLOURS[name]) for name in solids.kind_names])[solids.kind]
        shown = np.concatenate([level[solids.quads].mean(axis=1), level[solids.triangles].mean(axis=1)])
        return colormaps["viridis"](shown)[:, :3]

    def mode(self, shows: str, shape: np.ndarray) -> str:
        """A mode at phase 0: deformed, coloured by displacement over the largest.

        Args:
            shows: what it shows. shape: displacements of the nodes (p, 6).
        """
        moved, _ = self.solids.scaled(shape)
        size = np.linalg.norm(np.abs(moved), axis=1)
        return self.image(shows, np.real(moved), size / (size.max(initial=0.0) or 1.0))


def painted(polygons: np.ndarray, colours: np.ndarray, size: tuple[int, int]) -> bytes:
    """A picture (PNG) of polygons on white, each painted over those before it.

    A list of polygons in matplotlib is stroked and smoothed one by one, which takes ten times as long.

    Args:
        polygons: corners (C, 4, 2) in dots from the upper left. colours: (C, 4) red, green, blue and alpha from 0 to 1.
        size: width and height in dots.
    """
    from PIL import Image, ImageDraw

    picture = Image.new("RGB", (_FINER * size[0], _FINER * size[1]), "white")
    draw = ImageDraw.Draw(picture, "RGBA")
    tint = [tuple(one) for one in np.round(255.0 * colours).astype(int).tolist()]
    for corners, colour in zip((_FINER * polygons).reshape(len(polygons), -1).tolist(), tint, strict=True):
        draw.polygon(corners, colour)
    out = BytesIO()
    picture.reduce(_FINER).save(out, format="png")
    return out.getvalue()


def draw_unbalance(result: StandardsResult) -> Any:
    """Major axis of the orbit over the speed of the input shaft, a curve for each shaft."""
    axis = new_figure((9.0, 3.8)).subplots()
    rpm = values(result, "curve_speeds")
    for k, (shaft, size) in enumerate(result.curves.items()):
        axis.semilogy(rpm, 1e6 * size, color=COLOURS[k % len(COLOURS)], lw=1.4, label=shaft)
    axis.axvline(result.operating_rpm, color="#444444", lw=0.8, ls="--")
    name_axes(axis, label(result, "curve_speeds"), label(result, "curves", "um"), grid=True)
    axis.set_xlim(rpm[0], rpm[-1])
    legend_below(axis, 6, 0.16)
    return axis


def draw_errors(found: Contents) -> Any:
    """Estimated error against CPU seconds; analyses without an estimate are not drawn."""
    axis = new_figure((9.0, 3.4)).subplots()
    for k, (name, result) in enumerate(found.results.items()):
        error = error_of(result)
        if error is None:
            continue
        x = max(found.seconds[name], 1e-3)
        y = max(error, _LEAST)
        axis.plot(x, y, "o", color=COLOURS[k % len(COLOURS)], ms=6)
        beside(axis, name, (x, y), (6, 4 if k % 2 else -11), fontsize=9)
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.margins(0.15)
    low, high = axis.get_ylim()
    if high < 100.0 * low:  # at least two decades, so that their ticks are powers of ten
        axis.set_ylim(low / 10.0, high * 10.0)
    name_axes(axis, "CPU seconds", "largest estimated relative error", grid=True)
    return axis
