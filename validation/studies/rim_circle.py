"""Where teeth end and the mesh of a wheel begins: the total give for several circles between them.

    python -m validation.studies.rim_circle

The wheel of models/elastic_wheel.toml, its rim six modules thick below the roots, is meshed with a circle of nodes at several
depths in it, and the loaded teeth are held there. The give of the pair is r_b1 θ_1 + r_b2 θ_2 of the shafts less what their
centres move along the line of action. Inside of the circle the mesh gives, outside the teeth; their sum should not depend on
where it is.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

import rotorgear as rg
from validation.studies import elastic_wheel

MODEL = Path(__file__).resolve().parents[2] / "models" / "elastic_wheel.toml"
DEPTHS = (2.0, 3.0, 4.0, 5.0)  # modules
INSIDE = elastic_wheel.ROOT - 6.0 * elastic_wheel.MODULE


def gives(depth: float) -> tuple[float, float]:
    """Deflection of the teeth, and give of all between the shafts, in m."""
    held = elastic_wheel.ROOT - depth * elastic_wheel.MODULE
    *inner, _, outer = elastic_wheel.RADII
    radii = (*inner, INSIDE, held, outer)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        elastic_wheel.write(folder / "elastic_wheel.inp", held, radii)
        model = rg.loads(MODEL.read_text(encoding="utf-8"), folder=folder)
        found = rg.static(model.with_("meshes.pair.tooth_fe.rim_thickness", depth), elements=2)
    force = found.mesh_force_on_gear[0]
    normal = force / np.linalg.norm(force)
    turned = 0.0
    moved = []
    for gear in (model.layout.gear(name) for name in ("pinion", "wheel")):
        at = found.displacement[found.nodes.nearest(*gear.places[0])]
        turned += gear.base_radius * at[5]
        moved.append(at[:3])
    return float(found.mesh_deflection[0]), abs(turned) - float(normal @ (moved[1] - moved[0]))


def main() -> None:
    print("depth   teeth    teeth and wheel")
    rows = [(depth, *gives(depth)) for depth in DEPTHS]
    for depth, teeth, total in rows:
        print(f"{depth:4.1f} m  {1e6 * teeth:.3f}   {1e6 * total:.3f} um  {100.0 * (total / rows[1][2] - 1.0):+.1f} %")


if __name__ == "__main__":
    main()
