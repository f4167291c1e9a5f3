"""Draws docs/pictures/walk.png, the walk of docs/architecture.md: python docs/draw_walk.py"""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

# Object, what it holds, and on the arrow to the next one what makes that.
WALK = (
    ("file", "what the\ndesigner writes", "load"),
    ("Model", "the parts, checked\nas a whole", "on demand"),
    ("Layout", "train, places,\ngears, meshes:\nbefore any load", "torque_flow\nstate_at"),
    ("State", "flanks and forces,\nfaces, teeth over\nthe cycle, tangents,\nfilms", "System(model,\nstate, plan)"),
    ("System", "nodes and dofs,\nM, C, G, K,\nlocal forces", "solvers"),
    ("Result", "numbers with error,\nwarnings, settings", ""),
)
BLUE = "#1f4e79"


def draw(path: Path) -> None:
    """Write the picture."""
    figure, axes = plt.subplots(figsize=(15.5, 2.6), dpi=110)
    width, gap, height = 2.0, 1.5, 1.5
    for k, (name, holds, maker) in enumerate(WALK):
        x = k * (width + gap)
        colour = "#fde9d9" if name == "State" else "#eef3f8"
        axes.add_patch(plt.Rectangle((x, 0.0), width, height, facecolor=colour, edgecolor=BLUE, linewidth=1.3))
        axes.text(
            x + 0.5 * width, height - 0.25, name, ha="center", va="center", fontsize=13, weight="bold", color=BLUE
        )
        axes.text(x + 0.5 * width, 0.5 * height - 0.2, holds, ha="center", va="center", fontsize=8.5)
        if maker:
            middle = 0.5 * height
            axes.annotate(
                "", (x + width + gap, middle), (x + width, middle), arrowprops={"arrowstyle": "->", "color": BLUE}
            )
            axes.text(
                x + width + 0.5 * gap, middle + 0.1, maker, ha="center", va="bottom", fontsize=7.5, family="monospace"
            )
    state = 3 * (width + gap) + 0.5 * width
    axes.annotate(
        "",
        (state - 0.5, 0.0),
        (state + 0.5, 0.0),
        arrowprops={"arrowstyle": "->", "color": BLUE, "connectionstyle": "arc3,rad=-0.9"},
    )
    axes.text(state, -0.62, "an equilibrium puts another State in its place", ha="center", fontsize=9, style="italic")
    axes.set_xlim(-0.1, len(WALK) * (width + gap) - gap + 0.1)
    axes.set_ylim(-0.75, height + 0.1)
    axes.axis("off")
    figure.savefig(path, bbox_inches="tight")


if __name__ == "__main__":
    draw(Path(__file__).parent / "pictures" / "walk.png")
