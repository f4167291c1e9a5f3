"""matplotlib figures without a window and without pyplot's global state, and files of them, written whole."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.export.files import filling, publish, replacing
from rotorgear.extras import require

FORMATS = (".png", ".svg", ".pdf")


def new_figure(size: tuple[float, float], title: str = "") -> Any:
    """An empty figure of a size in inches, with a title if there is one.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    require("matplotlib", "A plot")
    from matplotlib.figure import Figure

    figure = Figure(figsize=size, layout="constrained")
    if title:
        figure.suptitle(title, fontsize=11)
    return figure


def axes_for(ax: Any, size: tuple[float, float], title: str) -> Any:
    """The axes to draw on: those of the caller, whose title is the caller's too, or those of a new figure."""
    return ax if ax is not None else new_figure(size, title).subplots()


def figure_for(fig: Any, size: tuple[float, float], title: str) -> Any:
    """The figure (or subfigure) to draw several panels on: that of the caller, or a new one with a title."""
    return fig if fig is not None else new_figure(size, title)


def require_picture_name(path: str | Path) -> str:
    """The ending of a picture's name.

    Raises:
        AnalysisError: an ending that is no picture's.
    """
    kind = Path(path).suffix.lower()
    if kind not in FORMATS:
        raise AnalysisError(f"a plot is written as PNG, SVG or PDF by the ending of its name; got '{Path(path).name}'")
    return kind


def save(picture: Any, path: str | Path) -> Path:
    """Write a picture as PNG, SVG or PDF by the name's ending, whole or not at all.

    Args:
        picture: what a function of `rotorgear.plot` returned, axes or an array of them, or a figure.
        path: file to write.

    Returns:
        The path.

    Raises:
        AnalysisError: another ending. WriteError: the file can't be written.
    """
    kind = require_picture_name(path)
    one = np.asarray(picture, dtype=object).flat[0]
    figure = one.figure.figure  # of axes their figure or subfigure, of that the whole one
    target = Path(path)
    # Without a date the same result gives the same file.
    metadata = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}.get(kind)
    with replacing(target) as scratch:
        figure.savefig(scratch, dpi=130, format=kind[1:], metadata=metadata)
    return target


def save_all(pictures: Mapping[str, Callable[[], Any]], directory: str | Path) -> list[Path]:
    """Draw and write pictures by their file names into a folder, all of them or none; returns the paths.

    Raises:
        WriteError: the folder can't be written.
    """
    target = Path(directory)
    with filling(target) as scratch:
        for name, draw in pictures.items():
            save(draw(), scratch / name)
        return publish(scratch, target, list(pictures))
