"""Makes models/helicopter_casing.msh, the casing of the helicopter's gearbox, with Gmsh (pip install gmsh).

    python validation/studies/helicopter_casing.py models/helicopter_casing.msh

rotorgear itself does not need Gmsh. The casing is ours and plain: a drum around the bull gear, a box for bevel pair and branches,
a ring around the planets, the housing of the mast and the tube of the input at 80 degrees; decks carry the bearings, whose seats
are given as bores in the model file. Lengths in mm. The file has linear tetrahedra, so that it is small; rotorgear raises their
order.
"""

from __future__ import annotations

import math
import sys

import gmsh

# Apex of the bevel pair, and the direction of the input's axis from it.
APEX = (288.97956, 0.0, 50.0)
INPUT = (math.sin(math.radians(80.0)), 0.0, math.cos(math.radians(80.0)))
BRANCHES = ((222.992136, 72.4545372), (222.992136, -72.4545372))
SIZE = 80.0  # of the elements

Solid = tuple[int, int]


def cylinder(x: float, y: float, low: float, high: float, radius: float) -> Solid:
    """A cylinder along z."""
    return 3, gmsh.model.occ.addCylinder(x, y, low, 0.0, 0.0, high - low, radius)


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> Solid:
    """A box between two corners."""
    return 3, gmsh.model.occ.addBox(*low, *(b - a for a, b in zip(low, high, strict=True)))


def tube(near: float, far: float, radius: float) -> Solid:
    """A cylinder along the axis of the input, between two distances from the apex."""
    start = [a + near * d for a, d in zip(APEX, INPUT, strict=True)]
    return 3, gmsh.model.occ.addCylinder(*start, *((far - near) * d for d in INPUT), radius)


def casing() -> None:
    """Draw the casing: walls, then decks, then the bores of bearings and the room of gears."""
    occ = gmsh.model.occ
    outside = [
        cylinder(0, 0, -120, 8, 224),
        box((100, -165, -120), (425, 165, 160)),
        cylinder(0, 0, -172, -120, 190),
        cylinder(0, 0, -235, -172, 120),
        cylinder(0, 0, -420, -235, 85),
        tube(100, 235, 78),
    ]
    inside = [
        cylinder(0, 0, -102, -19, 206),
        box((118, -147, -102), (407, 147, 142)),
        cylinder(0, 0, -160, -120, 172),
        cylinder(0, 0, -160, -110, 100),
        cylinder(0, 0, -223, -150, 102),
        cylinder(0, 0, -430, -223, 67),
        tube(60, 245, 62),
    ]
    walls, _ = occ.cut(occ.fuse(outside[:1], outside[1:])[0], occ.fuse(inside[:1], inside[1:])[0])
    decks = [
        box((100, -150, -20), (410, 150, -2)),
        box((100, -150, 36), (410, 150, 54)),
        cylinder(0, 0, -210, -190, 105),
        cylinder(0, 0, -410, -390, 70),
        tube(119, 137, 65),
        tube(206, 224, 65),
        cylinder(0, 0, -19, -1, 210),
    ]
    x, y, _ = APEX
    bores = [
        *(cylinder(x, y, low, high, radius) for low, high, radius in ((-30, -1, 40), (30, 60, 75), (135, 170, 45))),
        *(
            cylinder(*branch, low, high, radius)
            for branch in BRANCHES
            for low, high, radius in ((30, 60, 36), (-25, 5, 60), (-125, -100, 36))
        ),
        *(cylinder(0, 0, low, high, 70) for low, high in ((-25, 10), (-125, -100))),
        *(cylinder(0, 0, low, high, 45) for low, high in ((-215, -185), (-425, -385))),
        tube(115, 140, 42),
        tube(205, 225, 42),
    ]
    occ.cut(occ.fuse(walls, decks)[0], bores)
    occ.synchronize()


def name_parts() -> None:
    """The body, and the outer face of the ring around the planets, where struts hold it."""
    bodies = [tag for _, tag in gmsh.model.getEntities(3)]
    held = []
    for dimension, tag in gmsh.model.getEntities(2):
        low_x, _, low_z, high_x, _, high_z = gmsh.model.getBoundingBox(dimension, tag)
        round_ring = abs(high_x - 190.0) < 1.0 and abs(low_x + 190.0) < 1.0 and low_z > -175.0 and high_z < -115.0
        if round_ring and gmsh.model.getType(dimension, tag) == "Cylinder":
            held.append(tag)
    assert len(bodies) == 1
    assert held
    gmsh.model.addPhysicalGroup(3, bodies, name="casing")
    gmsh.model.addPhysicalGroup(2, held, name="feet")


def main() -> None:
    """Write the mesh."""
    gmsh.initialize()
    casing()
    name_parts()
    gmsh.option.setNumber("Mesh.MeshSizeMax", SIZE)
    gmsh.option.setNumber("Mesh.MeshSizeMin", 0.3 * SIZE)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 8)
    gmsh.option.setNumber("Mesh.Binary", 1)
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.optimize("Netgen")
    gmsh.write(sys.argv[1])
    gmsh.finalize()


if __name__ == "__main__":
    main()
