"""Height and length of the tip relief of a spur pair over three torques: `rotorgear optimise-flanks` beside a grid of 13 x 13.

Run `python -m validation.benchmarks.flank_optimum`. It prints both best flanks and CPU seconds of the search, and ends with 1
where the search is worse than the grid or takes 60 CPU seconds.
"""

from __future__ import annotations

import sys
import time
import tomllib
from pathlib import Path

import numpy as np

import rotorgear as rg

ROOT = Path(__file__).parents[2]
GRID = 13
TORQUES = [1000.0, 1500.0, 2000.0]
VARIABLES = ["tip_relief", "tip_relief_length"]


def grid_best(model: rg.Model, found: rg.MeshOptimum) -> tuple[float, float, float]:
    """Least mean of the peak to peak (m) on a grid over the same bounds, by models with these flanks, and its place (m)."""
    teeth = rg.gear(model).pairs["stage"]
    best = (np.inf, 0.0, 0.0)
    for relief in np.linspace(found.variables[0].low_m, found.variables[0].high_m, GRID):
        for length in np.linspace(found.variables[1].low_m, found.variables[1].high_m, GRID):
            changes: dict[str, float] = {}
            for name, g in (("pinion", teeth.first), ("wheel", teeth.second)):
                tip = np.sqrt((0.5 * g.effective_tip_diameter) ** 2 - g.base_radius**2)
                if relief:
                    changes[f"gears.{name}.tip_relief"] = float(relief)
                    changes[f"gears.{name}.tip_relief_diameter"] = float(2.0 * np.hypot(g.base_radius, tip - length))
            changed = model.with_(changes) if changes else model
            mean = float(np.mean(rg.mesh_map(changed, over={"torque": TORQUES}).ste_peak_to_peak))
            best = min(best, (mean, float(relief), float(length)))
    return best


def main() -> int:
    """Search, grid, comparison."""
    model = rg.Model(**tomllib.loads((ROOT / "models" / "relieved_pair.toml").read_text(encoding="utf-8")))
    # The bare pair: the model's own relief is what was found.
    model = model.with_(
        {f"gears.{name}.{key}": None for name in ("pinion", "wheel") for key in ("tip_relief", "tip_relief_diameter")}
    )
    start = time.process_time()
    found = rg.optimise_flanks(model, variables=VARIABLES, over={"torque": TORQUES}, samples=0)
    seconds = time.process_time() - start
    best, relief, length = grid_best(model, found)
    place = [1e6 * variable.best_m for variable in found.variables]
    print(f"search: {1e6 * found.mean:.4f} um at {place[0]:.2f} um over {place[1]:.0f} um")
    print(f"        {found.evaluations} flanks, {seconds:.1f} CPU s")
    print(f"grid:   {1e6 * best:.4f} um at {1e6 * relief:.2f} um over {1e6 * length:.0f} um")
    print(f"        {GRID * GRID} flanks")
    return 0 if found.mean <= best and seconds < 60.0 else 1


if __name__ == "__main__":
    sys.exit(main())
