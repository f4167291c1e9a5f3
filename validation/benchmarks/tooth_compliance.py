"""Error of a loaded tooth's own compliance against run time: python -m validation.benchmarks.tooth_compliance

A gear's middle tooth of three pitches in plane strain is loaded by the Hertz strip of half-width a = 0.02 m_n at seven points
of its flank. The presets spread the load over a patch and add the closed form; the reference, 121056 dofs with rows about as
high as the strip is wide, carries the strip itself.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np

from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.loaded.contact_points import Slices, patch_loads
from rotorgear.gears.tooth_fe.compliance_model import compliance_key, gear_compliance
from rotorgear.gears.tooth_fe.gear_compliance import GearCompliance
from rotorgear.gears.tooth_fe.points import MeshSize
from rotorgear.gears.tooth_fe.settings import PRESETS, ToothFe

STRIP = 0.02
LEAST_PATCH = 0.08
NU = 0.3
POINTS = np.linspace(0.1, 0.9, 7)
REFERENCE = MeshSize(160, 10, 26, 6, 14)
GEARS = {
    "34 x 5 mm, 20 deg": GearGeometry(34, 5e-3, math.radians(20.0), 0.0),
    "29 x 2.75 mm, 25 deg, helix 30 deg": GearGeometry(29, 2.75e-3, math.radians(25.0), math.radians(30.0)),
}


@dataclass(frozen=True)
class Row:
    """Compliance (7,) for E = 1 at the points, dofs of the finite elements, and CPU seconds."""

    compliance: np.ndarray
    dofs: int
    seconds: float


def own_compliance(gear: GearGeometry, fe: ToothFe, largest_patch: float | None) -> Row:
    """Approach of a tooth's flank for a unit force in the strip; a patch of None is the strip itself."""
    start = time.process_time()
    found = gear_compliance(compliance_key(gear, fe, NU, 1.0, 0.0, space=False), fresh=True)
    seconds = time.process_time() - start
    least, most = (STRIP, STRIP) if largest_patch is None else (LEAST_PATCH, largest_patch)
    loads = patch_loads(_slices(found), 0, found, 1.0, np.full(7, least), most)
    K = 2.0 * (1.0 - NU**2) / math.pi
    P = loads.loads
    own = np.einsum("pi,ij,pj->p", P, found.response(0), P) + K * (0.25 + loads.log_width - math.log(STRIP))
    return Row(own, found.unknowns, seconds)


def _slices(found: GearCompliance) -> Slices:
    """One short contact line at each point: places by arc length along the flank, roll lengths in normal modules."""
    low = found.flank_start**2
    high = found.flank_end**2
    roll = np.sqrt(low + (high - low) * POINTS)[:, None]
    none = np.zeros(7, int)
    return Slices(
        none, none, np.zeros((7, 1)), np.ones(7), np.ones(1), np.stack([roll, roll]), np.zeros((7, 1)), none > 0
    )


def errors(gear: GearGeometry) -> dict[str, tuple[float, Row]]:
    """Largest relative error over the points, and the row, of each preset."""
    truth = own_compliance(gear, ToothFe(arc=3, size=REFERENCE), None).compliance
    found = {}
    for name in PRESETS:
        fe = ToothFe(name, arc=3)
        row = own_compliance(gear, fe, fe.patch_width)
        found[name] = float(np.abs(row.compliance / truth - 1.0).max()), row
    return found


def main() -> None:
    """Print both gears."""
    for title, gear in GEARS.items():
        print(title)
        for name, (error, row) in errors(gear).items():
            print(f"  {name:8} {row.dofs:6} dofs {row.seconds:6.3f} s   largest error {100.0 * error:.2f} %")


if __name__ == "__main__":
    main()
