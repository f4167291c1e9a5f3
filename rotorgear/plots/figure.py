"""Opens a matplotlib figure without a window, and writes it whole to a PNG or SVG."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rotorgear.errors import AnalysisError, MissingExtraError
from rotorgear.export.files import replacing

ENDINGS = (".png", ".svg", ".pdf")
# Told apart by colour-blind readers (Okabe and Ito), dark enough on white.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#555555", "#8B4513")


def new_figure(width: float, height: float) -> Any:
    """Return an empty figure of a size in inches.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise MissingExtraError("A plot", "matplotlib", "plots") from None
    return Figure(figsize=(width, height), layout="constrained")


def write_figure(figure: Any, path: str | Path) -> Path:
    """Write a figure and return its path.

    Raises:
        AnalysisError: a name that ends otherwise. WriteError: the file can't be written.
    """
    target = Path(path)
    if target.suffix.lower() not in ENDINGS:
        raise AnalysisError(f"a plot is written to a name that ends in {', '.join(ENDINGS)}, got '{target}'")
    kind = target.suffix.lower().removeprefix(".")
    with replacing(target) as scratch:
        figure.savefig(scratch, format=kind, dpi=120, metadata={"Date": None} if kind == "svg" else None)
    return target
