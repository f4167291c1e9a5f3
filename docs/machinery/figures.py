"""What the drawings of the theory share: colours, letters, and files that are the same bytes each time."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

PICTURES = Path(__file__).resolve().parents[1] / "pictures"
COLOURS = ("#1f4e79", "#b0461f", "#3b7d3b", "#7a5195")

matplotlib.rcParams["svg.hashsalt"] = "theory"
matplotlib.rcParams["font.size"] = 9


def save(figure: plt.Figure, name: str) -> None:
    """Write a picture of the theory, the same bytes each time."""
    figure.savefig(PICTURES / f"theory_{name}.svg", bbox_inches="tight", metadata={"Date": None})
    plt.close(figure)
