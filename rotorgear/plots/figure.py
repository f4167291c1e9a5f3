"""matplotlib figures without a window, written whole."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rotorgear.errors import AnalysisError, MissingExtraError
from rotorgear.export.files import replacing

_FORMATS = (".png", ".svg", ".pdf")


def new_figure(size: tuple[float, float]) -> Any:
    """An empty figure of a size in inches.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise MissingExtraError("A plot", "matplotlib", "plots") from None
    return Figure(figsize=size, layout="constrained")


def write_figure(figure: Any, path: str | Path) -> Path:
    """Write a figure as PNG, SVG or PDF by the name's ending, and return its path.

    Raises:
        AnalysisError: another ending. WriteError: the file can't be written.
    """
    target = Path(path)
    kind = target.suffix.lower()
    if kind not in _FORMATS:
        raise AnalysisError(f"a plot is written as PNG, SVG or PDF by the ending of its name; got '{target.name}'")
    # Without a date the same result gives the same file.
    metadata = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}.get(kind)
    with replacing(target) as scratch:
        figure.savefig(scratch, dpi=130, format=kind[1:], metadata=metadata)
    return target
