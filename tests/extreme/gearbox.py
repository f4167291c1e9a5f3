"""Small gearboxes for the extreme cases."""

from __future__ import annotations

import numpy as np

import rotorgear as rg


def gearbox(stiffness: float, torsion: tuple[float, float], on_shafts: bool = False) -> rg.Model:
    """A lumped spur pair in torsion only, each shaft held by a spring at its start; gears massless when on shafts."""
    section = (rg.Section(length=0.1, outer_diameter=0.02),) if on_shafts else ()
    inertia = (0.0, 0.0) if on_shafts else (1e-3, 2e-2)
    shafts = {name: rg.Shaft(sections=section) for name in ("a", "b")}
    gears = {
        name: rg.Gear(
            shaft=shaft,
            at="end",
            kind="spur",
            base_radius=radius,
            transverse_pressure_angle=np.radians(20.0),
            mass=0.0,
            polar_inertia=J,
            diametral_inertia=0.0,
        )
        for name, shaft, radius, J in zip(("pinion", "wheel"), shafts, (0.03, 0.075), inertia, strict=True)
    }
    supports = {
        f"hold_{name}": rg.Support(shaft=name, at="start", stiffness=rg.StiffnessMatrix(torsion=k))
        for name, k in zip(shafts, torsion, strict=True)
    }
    mesh = rg.Mesh(
        pinion="pinion", gear="wheel", stiffness=stiffness, centre_line_angle=0.0, pressure_angle=np.radians(20.0)
    )
    return rg.Model(
        shafts=shafts,
        gears=gears,
        meshes={"m": mesh},
        supports=supports,
        motions=("torsion",),
        operation=rg.Operation(input_shaft="a"),
    )


def helical_box(scale: float) -> rg.Model:
    """Two shafts and a helical pair, geometrically similar: lengths go with the scale, stiffness too, dampers with its square."""
    teeth = (24, 72)
    module = 2e-3 * scale
    beta = np.radians(20.0)
    distance = sum(teeth) * module / np.cos(beta) / 2.0
    shafts = {
        name: rg.Shaft(position=(x, 0.0), sections=(rg.Section(length=0.2 * scale, outer_diameter=d * scale),))
        for name, x, d in (("a", 0.0, 0.04), ("b", distance, 0.05))
    }
    gears = {
        name: rg.Gear(
            shaft=shaft,
            at=0.1 * scale,
            kind="helical",
            teeth=z,
            normal_module=module,
            helix_angle=beta,
            hand=hand,
            width=0.03 * scale,
        )
        for name, shaft, z, hand in zip(("pinion", "wheel"), shafts, teeth, ("right", "left"), strict=True)
    }
    stiffness = rg.StiffnessMatrix(radial=2e8 * scale, axial=5e7 * scale)
    damping = rg.DampingMatrix(radial=2e3 * scale**2)
    bearings = {
        f"{shaft}_{end}": rg.Bearing(shaft=shaft, at=end, stiffness=stiffness, damping=damping)
        for shaft in shafts
        for end in ("start", "end")
    }
    mesh = rg.Mesh(pinion="pinion", gear="wheel", stiffness=4e8 * scale, damping_ratio=0.05)
    return rg.Model(
        shafts=shafts, gears=gears, bearings=bearings, meshes={"m": mesh}, operation=rg.Operation(input_shaft="a")
    )
