"""python -m validation.seeds.pictures_pair16 [NAME ...]: draw studies of the pair of 16 degrees of freedom to docs/pictures/."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.plots.figure import COLOURS
from validation.seeds import pair16
from validation.seeds.models import loaded
from validation.seeds.pictures import Picture, draw


def draw_pair16_factors(figure: Any) -> None:
    """Dynamic factors of both pairs over random sets of what is not given, beside the stated set and the printed number."""
    axes = figure.subplots()
    printed = {"a": 1.23, "b": 1.18}
    for place, (name, (teeth, helix, impact)) in enumerate(pair16.PAIRS.items()):
        sample = np.sort(pair16.spread(teeth, helix, 0.054, impact, 40))
        stated = pair16.run(loaded(pair16.FILES[name]))[0]
        share = (np.arange(sample.size) + 0.5) / sample.size
        axes.step(
            sample, share, where="mid", color=COLOURS[place], lw=1.2, label=f"pair {name.upper()}: 40 random sets"
        )
        axes.axvline(
            stated, color=COLOURS[place], lw=1.0, ls="--", label=f"pair {name.upper()}: stated set {stated:.3f}"
        )
        axes.axvline(
            printed[name], color=COLOURS[place], lw=1.0, ls=":", label=f"pair {name.upper()}: printed {printed[name]}"
        )
    axes.set_xlabel("dynamic factor $K_v$")
    axes.set_ylabel("share of the sets below")
    axes.legend(fontsize=7)
    axes.grid(alpha=0.25)


PICTURES: dict[str, Picture] = {
    "seeds_pair16_factors": (draw_pair16_factors, (7.0, 4.5)),
}

if __name__ == "__main__":
    draw(PICTURES)
