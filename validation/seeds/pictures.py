"""What the pictures of the five published systems share; each system has its own in pictures_NAME.py."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

import rotorgear as rg
from rotorgear.plots.figure import new_figure, save

FOLDER = Path(__file__).resolve().parents[2] / "docs" / "pictures"
# What draws on a figure, and its size in inches.
Picture = tuple[Callable[[Any], None], tuple[float, float]]


def dots(axes: Any, x: np.ndarray, result: rg.SweepResult, contact: int, size: float = 0.8) -> None:
    """Poincare points of a contact in um over x (p,)."""
    y = 1e6 * result.section[:, 0, :, contact, 0]
    axes.plot(np.repeat(x, y.shape[1]), y.ravel(), "k.", ms=size, mew=0, rasterized=True)
    axes.grid(alpha=0.25)
    axes.margins(x=0.01)


def draw(pictures: Mapping[str, Picture]) -> None:
    """Draw the pictures that the command line names, or all."""
    parser = argparse.ArgumentParser(description="Pictures of a published system.")
    parser.add_argument("names", nargs="*", metavar="NAME", choices=[*pictures, []], help=", ".join(pictures))
    for name in parser.parse_args().names or pictures:
        on, size = pictures[name]
        figure = new_figure(size)
        on(figure)
        print(f"wrote {save(figure, FOLDER / f'{name}.png')}", flush=True)
