"""python -m validation.seeds.pictures_pair12 [NAME ...]: draw studies of the pair of 12 degrees of freedom to docs/pictures/."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.plots.figure import COLOURS
from validation.seeds import kept, pair12
from validation.seeds.pictures import Picture, draw


def draw_pair12_impact(figure: Any) -> None:
    """Printed impact forces and computed vibration over the contact ratio, with the spread over random sets."""
    left, right = figure.subplots(1, 2)
    ratio = [row[1] for row in pair12.TABLE]
    left.plot(ratio, [row[2] for row in pair12.TABLE], "ks-", ms=4, mfc="none", lw=0.8, label="printed, reference")
    left.plot(ratio, [row[3] for row in pair12.TABLE], "k.--", ms=5, lw=0.8, label="printed, proposed")
    left.set_ylabel("impact force, kN")
    known = kept.values("pair12") | kept.values("pair12_trials")
    rows = [
        (
            pair12.TABLE[i - 1][1],
            *(float(known[f"{key}_{i}"]) for key in ("rms", "low", "high", "rms_rotation", "fe_force")),
        )
        for i in (1, 3, 5)
    ]
    x, chosen, low, high, rotation, teeth = np.array(rows).T
    left.plot(x, teeth, "^-", ms=4, color=COLOURS[2], lw=0.8, label="from loaded teeth")
    right.fill_between(x, low, high, color=COLOURS[4], alpha=0.4, lw=0, label="10 to 90 % of 40 random sets")
    right.plot(x, chosen, ".-", color=COLOURS[0], lw=1.0, label="along the flank normal")
    right.plot(x, rotation, ".--", color=COLOURS[1], lw=1.0, label="in the rows of rotation only")
    right.plot(x, [pair12.PRINTED_RMS[at][0] for at in x], "ks", ms=5, mfc="none", label="printed")
    right.set_ylabel("rms of the circumferential acceleration, m/s$^2$")
    for one in (left, right):
        one.set_xlabel("printed contact ratio")
        one.set_ylim(bottom=0.0)
        one.legend(fontsize=7)
        one.grid(alpha=0.25)


PICTURES: dict[str, Picture] = {
    "seeds_pair12_impact": (draw_pair12_impact, (9.0, 4.0)),
}

if __name__ == "__main__":
    draw(PICTURES)
