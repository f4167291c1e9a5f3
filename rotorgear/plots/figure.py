"""matplotlib figures without a window and without pyplot's global state: axes, colours, and files of them, written whole."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.extras import require
from rotorgear.files.write import filling, publish, written
from rotorgear.results.schema import Record
from rotorgear.results.table import label_of, scale, unit_of

FORMATS = (".png", ".svg", ".pdf")
# Colours of lines and bars that colour-blind readers tell apart, dark enough on white (Okabe and Ito).
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#555555", "#8B4513")
# Dashes beside them, so that neighbours are told apart in grey, too; dots are left to limits.
DASHES: tuple[Any, ...] = ("-", (0, (7, 2)), (0, (9, 2, 2, 2)), (0, (3, 1.2)))
# What is told first, what is set against it, and what stands beside both.
BLUE, ORANGE, GREY = "#1f5fa8", "#b3541e", "#777777"


def new_figure(size: tuple[float, float], title: str = "") -> Any:
    """An empty figure of a size in inches, with a title if there is one.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    require("matplotlib", "A plot")
    # That fonts are listed for the first time, or that one is missing, is no news of a result.
    logging.getLogger("matplotlib").setLevel(logging.ERROR)
    from matplotlib.figure import Figure

    figure = Figure(figsize=size, layout="constrained")
    if title:
        figure.suptitle(title, fontsize=11, parse_math=False)  # of a model: a dollar is a dollar
    return figure


def axes_for(ax: Any, size: tuple[float, float], title: str) -> Any:
    """The axes to draw on: those of the caller, which get no title, or those of a new figure with one."""
    return ax if ax is not None else new_figure(size, title).subplots()


def figure_for(fig: Any, size: tuple[float, float], title: str) -> Any:
    """The figure (or subfigure) to draw several panels on: that of the caller, or a new one with a title."""
    return fig if fig is not None else new_figure(size, title)


def panels_of(figure: Any, count: int) -> list[Any]:
    """As many axes in a grid that is about square; none is left empty."""
    columns = int(np.ceil(np.sqrt(count)))
    grid = list(figure.subplots(int(np.ceil(count / columns)), columns, squeeze=False).flat)
    for axis in grid[count:]:
        axis.set_visible(False)
    return grid[:count]


def name_axes(axis: Any, x: str = "", y: str = "", *, title: str = "", grid: bool = False, legend: int = 0) -> None:
    """Say what axes show: labels along x and y, a title, a light grid, a legend with a number of columns; each where given."""
    if x:
        axis.set_xlabel(x)
    if y:
        axis.set_ylabel(y)
    if title:
        axis.set_title(title, fontsize=10, parse_math=False)
    if grid:
        axis.grid(True, alpha=0.25)
    if legend:
        axis.legend(frameon=False, fontsize=8, ncols=legend)


def label(of: Record | type[Record], field: str, shown: str = "") -> str:
    """What stands along an axis that shows a field: the label that the result declares, and the unit that is shown."""
    return label_of(of.declarations[field], shown)


def values(of: Record, field: str, shown: str = "") -> np.ndarray:
    """A field of a result, or of a record in it, in the unit that `label` says."""
    declared = of.declarations[field]
    return scale(declared.unit, shown or unit_of(declared)) * np.asarray(getattr(of, field))


def legend_below(axis: Any, columns: int, below: float = 0.12, **look: Any) -> None:
    """A legend below axes that curves fill, so many shares of their height down."""
    axis.legend(frameon=False, loc="upper center", bbox_to_anchor=(0.5, -below), ncols=columns, **look)


def beside(axis: Any, text: str, at: tuple[float, float], offset: tuple[float, float], **look: Any) -> None:
    """Write small words beside a point, so many points of type away from it."""
    axis.annotate(text, at, xytext=offset, textcoords="offset points", parse_math=False, **{"fontsize": 7} | look)


def plain_axis(axis: Any) -> None:
    """Light grid, no frame on top and right."""
    axis.grid(True, alpha=0.25)
    for side in ("top", "right"):
        axis.spines[side].set_visible(False)


def parameter_name(address: str, unit: str) -> str:
    """The address of a number in the model file with its unit, for an axis."""
    return f"{address}, {unit}" if unit else address


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
    with written(target) as scratch:
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
